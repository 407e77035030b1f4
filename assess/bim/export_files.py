"""The results of a run brought back to the building model that its workbook was imported from.

Risk classes become property sets of the model: STEP lines added to the file, of which every byte stays.

References
----------
ISO 10303-21. Industrial automation systems and integration: clear text encoding of the exchange structure.
ISO 16739-1. Industry Foundation Classes: GlobalId, a number of 128 bits in 22 digits of base 64.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from assess.bim.export_model import PROPERTY_SET, ModelPart, make_uuid, read_elements
from assess.bim.export_results import (
    ExportPiece,
    ExportRun,
    describe,
    describe_class,
    describe_report,
    describe_scenario,
    list_items,
    list_routes,
    name_program,
)
from assess.bim.export_topics import Pair, Topics, list_entries, write_topics
from assess.bim.ifc_model import check_installed, check_model, unreadable
from assess.bim.model_process import run_apart
from assess.details import DETAILS
from assess.errors import ModelError
from assess.i18n import fill, gettext as _
from assess.progress import Progress
from assess.report import words
from assess.resources import open_input
from assess.text import plain_line

LONGEST_LABEL = 255  # characters of an IfcLabel
_DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$"
_END = re.compile(rb"ENDSEC\s*;(?:\s|/\*(?:[^*]|\*(?!/))*\*/)*END-ISO-10303-21\s*;")
_TAIL = 65536


@dataclass(frozen=True, slots=True)
class Export:
    """The model with a property set on each of `written` pieces, and its topics; None if not asked for. Nothing is
    written for pieces without a Source ID, those `missing` in the model, and those `refused`, by their class there; of
    those that share a Source ID (`repeated`) the worse is written.
    """

    model: bytes | None
    topics: Topics | None
    written: int
    without_id: tuple[str, ...]
    missing: tuple[str, ...]
    refused: Mapping[str, tuple[str, ...]]
    repeated: tuple[str, ...]

    @property
    def is_complete(self) -> bool:
        """Whether every piece was found, and has an element of its own."""
        return not (self.without_id or self.missing or self.refused or self.repeated)


def build_export(
    found: ExportRun, model: Path, progress: Progress, *, with_properties: bool, with_topics: bool
) -> Export:
    """Bring results back to a building model: as property sets in a copy of it, as topics, or both. Raises ModelError
    if the model cannot be read, ifcopenshell is missing, no piece is in the model, or one was exported before.
    """
    check_installed()
    check_model(model, model.name)
    sharing: dict[str, list[ExportPiece]] = {}
    for one in found.pieces:
        if one.source_id:
            sharing.setdefault(one.source_id, []).append(one)
    placed = None
    if with_topics:
        keys = {one.item: one.source_id for one in found.pieces if one.source_id}
        placed = [keys[item] for entry in list_entries(found, keys) for item in list_items(entry) if item in keys]
    part = run_apart(model.name, progress, read_elements, model.resolve(), model.name, list(sharing), placed)
    elements = {one.key: one for one in part.elements}
    pairs = [(one, elements[one.source_id]) for one in found.pieces if one.source_id in elements]
    worst = [
        (max(own, key=lambda one: (one.upper, one.chance.probability)), elements[key])
        for key, own in sharing.items()
        if key in elements
    ]
    if not worst and part.refused:
        key, name = next(iter(part.refused.items()))
        raise ModelError(
            fill("None of the Source IDs in {results} is that of furniture in {model}: {id} is an {name}. Fill in "
                 "Source ID in Items with the GlobalIds of furniture.",
                 results=found.run.path, model=model.name, id=key, name=name)
        )  # fmt: skip
    if not worst:
        raise ModelError(
            fill("None of the Source IDs in {results} is that of an element of {model}. Name the model that the "
                 "workbook was imported from.", results=found.run.path, model=model.name)
        )  # fmt: skip
    done = [element.name or element.key for _, element in worst if element.has_set]
    if done and with_properties:
        raise ModelError(
            fill("{model} holds {set} already, on {n:,} of the pieces (the first is {name}): it was exported before. "
                 "Name the model without it, as it was before that export.",
                 model=model.name, set=PROPERTY_SET, n=len(done), name=done[0])
        )  # fmt: skip
    changed = None
    if with_properties:
        try:
            with open_input(model) as file:
                changed = add_properties(file.read(), model.name, part, found, worst)
        except OSError as error:
            raise unreadable(model.name, error) from None

    def list_names(keys: Iterable[str]) -> tuple[str, ...]:
        return tuple(one.item for key in keys for one in sharing[key])

    refused: dict[str, list[str]] = {}
    for key, name in part.refused.items():
        refused.setdefault(name, []).append(key)
    return Export(
        model=changed,
        topics=write_topics(model.name, part, found, pairs) if with_topics else None,
        written=len(worst),
        without_id=tuple(one.item for one in found.pieces if not one.source_id),
        missing=list_names(key for key in sharing if key not in elements and key not in part.refused),
        refused={name: list_names(own) for name, own in refused.items()},
        repeated=list_names(key for key, own in sharing.items() if key in elements and len(own) > 1),
    )


# ---------------------------------------------------------------- property sets


def add_properties(data: bytes, name: str, part: ModelPart, found: ExportRun, pieces: Sequence[Pair]) -> bytes:
    """Return a model with a property set on each of its pieces; ModelError if it does not end as an IFC file does."""
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
    """Yield the names, alike in every language, and values as STEP text; the class is in the words of the report."""
    run, chance, inputs = found.run, one.chance, one.inputs
    yield "RiskClass", write_label(describe_class(run, one, one.upper, is_short=True))
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
        yield "MayBlockRoutes", f"IFCTEXT({write_text(', '.join(routes))})"
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
    yield "Scenario", f"IFCTEXT({write_text(describe_scenario(run))})"
    yield "AssessedBy", write_label(name_program(run))
    yield "Report", f"IFCTEXT({write_text(describe_report(run))})"


def make_global_id(kind: str, *keys: str) -> str:
    """Return `make_uuid` as a GlobalId: 22 digits, the first of which holds 2 bits."""
    number = make_uuid(kind, *keys).int
    return "".join(_DIGITS[(number >> shift) & 63] for shift in range(126, -1, -6))


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


def write_real(value: float) -> str:
    """Return an IfcReal: a number with a decimal point."""
    mantissa, _mark, exponent = repr(float(value)).partition("e")
    whole = mantissa if "." in mantissa else f"{mantissa}."
    return f"IFCREAL({whole}{f'E{int(exponent)}' if exponent else ''})"


def append_lines(data: bytes, lines: Sequence[str], name: str) -> bytes:
    """Return a file with lines at the end of its data, whose other bytes all stay; line ends as those of the file.
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
