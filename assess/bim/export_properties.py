"""Risk classes as property sets of a building model: STEP lines added to the file, of which every byte stays.

References
----------
ISO 10303-21. Industrial automation systems and integration: clear text encoding of the exchange structure.
ISO 16739-1. Industry Foundation Classes: GlobalId, a number of 128 bits in 22 digits of base 64.
"""

import re
import uuid
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import groupby

from assess.bim.export_camera import Pair
from assess.bim.export_model import PROPERTY_SET, ModelPart
from assess.bim.export_results import ExportPiece, ExportRun
from assess.bim.export_words import describe, list_routes, say_class, say_program, say_report, say_scenario
from assess.details import DETAILS
from assess.errors import ModelError
from assess.i18n import fill
from assess.i18n import gettext as _
from assess.report import words
from assess.text import plain_line

LONGEST_LABEL = 255
"""Characters of an IfcLabel."""
_DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$"
_NAMESPACE = uuid.UUID("07e57c2d-3231-4d20-9929-8e605d3154f5")
"""Of identifiers that are made from what they stand for, so that the same export gives the same ones."""
_END = re.compile(rb"ENDSEC\s*;(?:\s|/\*(?:[^*]|\*(?!/))*\*/)*END-ISO-10303-21\s*;")
_TAIL = 65536


def add_properties(data: bytes, name: str, part: ModelPart, found: ExportRun, pieces: Sequence[Pair]) -> bytes:
    """Return a building model with a property set on each of its pieces.

    `pieces`: the pieces with their elements: of several with one Source ID, the worst.
    Raises ModelError if the file does not end as an IFC file does.
    """
    what = write_text(_("Chance that the piece overturns in the earthquake named in Scenario, not per year. Forces are "
                        "for screening, not design."))  # fmt: skip
    lines: list[str] = []
    counts = Counter(one.source_id for one in found.pieces)
    for piece, element in pieces:
        properties = list(_list_properties(found, piece))
        alike = counts[piece.source_id]
        if alike > 1:
            several = _("{n:,} pieces with this Source ID, the worst", n=alike)
            own = _("2 pieces with this Source ID, the worse") if alike == 2 else several
            properties.append(("Of", write_label(own)))
        first = part.last_number + len(lines) + 1
        last = first + len(properties)
        owner = f"#{element.owner}" if element.owner else "$"
        for number, (key, value) in enumerate(properties, first):
            lines.append(f"#{number}=IFCPROPERTYSINGLEVALUE({write_text(key)},$,{value},$);")
        values = ",".join(f"#{number}" for number in range(first, last))
        set_key, relation_key = (make_global_id(kind, element.key) for kind in ("property set", "relation"))
        lines += [
            f"#{last}=IFCPROPERTYSET('{set_key}',{owner},{write_text(PROPERTY_SET)},{what},({values}));",
            f"#{last + 1}=IFCRELDEFINESBYPROPERTIES('{relation_key}',{owner},$,$,(#{element.number}),#{last});",
        ]
    return append_lines(data, lines, name)


def _list_properties(found: ExportRun, one: ExportPiece) -> Iterator[tuple[str, str]]:
    """Yield the properties of a piece: names, the same in every language, and values as STEP text.

    RiskClass is the class in the words of the report, so that what is outside its classes is no class here either.
    """
    run, chance, inputs = found.run, one.chance, one.inputs
    yield "RiskClass", write_label(say_class(run, one, one.upper, is_short=True))
    if one.upper != one.risk:
        yield "ClassUpper", write_label(words.risk_word(one.upper))
    yield "Probability", write_real(chance.probability)
    if chance.low is not None and chance.high is not None:
        yield "ProbabilityLow", write_real(chance.low)
        yield "ProbabilityHigh", write_real(chance.high)
    yield "Basis", write_label(_(words.BASES[one.basis]))
    yield "Item", write_label(one.item)
    yield "Description", write_label(describe(one))
    if inputs.get("anchored"):
        yield "Anchored", write_label(_(str(inputs["anchored"])))
    for key, name in (("Breadth_cm", "breadth_cm"), ("Height_cm", "height_cm"), ("PFA_g", "pfa_g")):
        value = inputs.get(name)
        if isinstance(value, int | float):
            yield key, write_real(value)
    if one.pfa_source:
        yield "PFASource", write_label(one.pfa_source)
    if routes := list_routes(found, [one.item]):
        yield "MayBlockRoutes", _write_long_text(", ".join(routes))
    if one.importance:
        yield "Importance", write_label(_(one.importance))
    if one.item in found.works:
        entry, work = found.works[one.item]
        yield "FixOrder", f"IFCINTEGER({entry.place})"
        yield "FixingDetail", write_label(_(DETAILS[work.detail].title))
        forces = {
            "FixingTension": work.tension_kn, "FixingTension84": work.tension_high_kn,
            "FixingTensionCode": work.tension_code_kn, "BaseShear": work.shear_kn,
        }  # fmt: skip
        yield from ((f"{key}_kN", write_real(force)) for key, force in forces.items() if force is not None)
    yield "Scenario", _write_long_text(say_scenario(run))
    yield "AssessedBy", write_label(say_program(run))
    yield "Report", _write_long_text(say_report(run))


def make_uuid(kind: str, *keys: str) -> uuid.UUID:
    """Return the identifier of what is made of something in a model: always the same for the same kind and keys."""
    return uuid.uuid5(_NAMESPACE, "\n".join((kind, *keys)))


def make_global_id(kind: str, *keys: str) -> str:
    """Return `make_uuid` as a GlobalId: 22 digits, the first of which holds 2 bits."""
    number = make_uuid(kind, *keys).int
    digits = [_DIGITS[(number >> shift) & 63] for shift in range(126, -1, -6)]
    return "".join(digits)


def write_text(text: str) -> str:
    r"""Return a text on one line in quotes: ' and \ doubled, what is not printable ASCII as \X2\ or \X4\."""
    found = []
    for kind, signs in groupby(
        plain_line(text), key=lambda one: 0 if " " <= one <= "~" else 2 if one <= "\uffff" else 4
    ):
        part = "".join(signs)
        if kind:
            digits = "".join(f"{ord(sign):0{2 * kind}X}" for sign in part)
            found.append(f"\\X{kind}\\{digits}\\X0\\")
        else:
            found.append(part.replace("\\", "\\\\").replace("'", "''"))
    return f"'{''.join(found)}'"


def write_label(text: str) -> str:
    """Return an IfcLabel, cut where it is too long."""
    text = plain_line(text)
    return f"IFCLABEL({write_text(text if len(text) <= LONGEST_LABEL else f'{text[: LONGEST_LABEL - 1]}…')})"


def _write_long_text(text: str) -> str:
    return f"IFCTEXT({write_text(text)})"


def write_real(value: float) -> str:
    """Return an IfcReal: a number with a decimal point."""
    mantissa, _mark, exponent = repr(float(value)).partition("e")
    whole = mantissa if "." in mantissa else f"{mantissa}."
    return f"IFCREAL({whole}{f'E{int(exponent)}' if exponent else ''})"


def append_lines(data: bytes, lines: Sequence[str], name: str) -> bytes:
    """Return a file with lines at the end of its data, whose other bytes all stay; line ends as those of the file.

    `lines`: entities in ASCII, each with its semicolon.
    Raises ModelError if its data do not end where the file does.
    """
    *_rest, last = [None, *_END.finditer(data, max(0, len(data) - _TAIL))]  # the ENDSEC of the last section
    if last is None:
        raise ModelError(
            fill("{name} does not end as an IFC file does: its last lines lack 'ENDSEC;' or 'END-ISO-10303-21;'. "
                 "Export it again from the program that made it.", name=name)
        )  # fmt: skip
    at = last.start()
    end = b"\r\n" if b"\r\n" in data[:4096] else b"\n"
    added = b"".join(line.encode("ascii") + end for line in lines)
    starts_line = data[at - 1 : at] in (b"\n", b"\r")
    return b"".join((data[:at], b"" if starts_line else end, added, data[at:]))
