"""Lines of a STEP physical file, added to one of which every byte stays: texts, numbers, identifiers.

References
----------
ISO 10303-21. Industrial automation systems and integration: clear text encoding of the exchange structure.
ISO 16739-1. Industry Foundation Classes: GlobalId, a number of 128 bits in 22 digits of base 64.
"""

import re
import uuid
from collections.abc import Sequence
from itertools import groupby

from assess.errors import ModelError
from assess.i18n import fill
from assess.plain_text import plain_line

LONGEST_LABEL = 255
"""Characters of an IfcLabel."""
_DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$"
_NAMESPACE = uuid.UUID("07e57c2d-3231-4d20-9929-8e605d3154f5")
"""Of identifiers that are made from what they stand for, so that the same export gives the same ones."""
_END = re.compile(rb"ENDSEC\s*;(?:\s|/\*(?:[^*]|\*(?!/))*\*/)*END-ISO-10303-21\s*;")
_TAIL = 65536


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
    for kind, signs in groupby(plain_line(text), key=_find_kind):
        part = "".join(signs)
        if kind:
            digits = "".join(f"{ord(sign):0{2 * kind}X}" for sign in part)
            found.append(f"\\X{kind}\\{digits}\\X0\\")
        else:
            found.append(part.replace("\\", "\\\\").replace("'", "''"))
    return f"'{''.join(found)}'"


def _find_kind(sign: str) -> int:
    if " " <= sign <= "~":
        return 0
    return 2 if ord(sign) <= 0xFFFF else 4


def write_label(text: str) -> str:
    """Return an IfcLabel, cut where it is too long."""
    text = plain_line(text)
    return f"IFCLABEL({write_text(text if len(text) <= LONGEST_LABEL else f'{text[: LONGEST_LABEL - 1]}…')})"


def write_long_text(text: str) -> str:
    """Return an IfcText."""
    return f"IFCTEXT({write_text(text)})"


def write_real(value: float) -> str:
    """Return an IfcReal: a number with a decimal point."""
    mantissa, _mark, exponent = repr(float(value)).partition("e")
    whole = mantissa if "." in mantissa else f"{mantissa}."
    return f"IFCREAL({whole}{f'E{int(exponent)}' if exponent else ''})"


def write_integer(value: int) -> str:
    """Return an IfcInteger."""
    return f"IFCINTEGER({value})"


def append_lines(data: bytes, lines: Sequence[str], name: str) -> bytes:
    """Return a file with lines at the end of its data, whose other bytes all stay; line ends as those of the file.

    `lines`: entities in ASCII, each with its semicolon.
    Raises ModelError if its data do not end where the file does.
    """
    at = _find_end(data, name)
    end = b"\r\n" if b"\r\n" in data[:4096] else b"\n"
    added = b"".join(line.encode("ascii") + end for line in lines)
    starts_line = data[at - 1 : at] in (b"\n", b"\r")
    return b"".join((data[:at], b"" if starts_line else end, added, data[at:]))


def _find_end(data: bytes, name: str) -> int:
    """Return where the last section ends: the place of its ENDSEC."""
    start = max(0, len(data) - _TAIL)
    *_, last = [None, *_END.finditer(data, start)]
    if last is None:
        raise ModelError(
            fill("{name} does not end as an IFC file does: its last lines lack 'ENDSEC;' or 'END-ISO-10303-21;'. "
                 "Export it again from the program that made it.", name=name)
        )  # fmt: skip
    return last.start()
