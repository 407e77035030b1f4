"""Natural order of names: L3 before L11, 25-9 before 25-10."""

import re
import unicodedata

_NUMBER = re.compile(r"(\d+)")


def natural_key(name: str) -> tuple[tuple[tuple[int, str], ...], str]:
    """Return what names are sorted by: a whole number within a name counts by its value, capitals do not count.

    Of equal numbers the one with fewer digits comes first: 25-7 before 25-07. Names that differ in capitals alone keep
    one order as well, so that no order depends on that of the input.
    """
    plain = unicodedata.normalize("NFKC", name).casefold().strip()
    parts = _NUMBER.split(plain)
    values = [(len(one.lstrip("0")), one.lstrip("0")) if at % 2 else (0, one) for at, one in enumerate(parts)]
    return tuple(values), f"{len(plain):09}{plain}{name}"
