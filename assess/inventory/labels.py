"""Labels and names: how headers are taken apart, and when two of them are the same."""

import re
import unicodedata
from functools import lru_cache

_BRACKET = re.compile(r"^(?P<label>.*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?\s*$", re.DOTALL)


def split_header(header: str) -> tuple[str, str | None]:
    """Split ``Height [cm]`` into label and unit; the unit is None where there is no bracket."""
    match = _BRACKET.match(header.strip())
    return (match["label"], match["unit"]) if match else (header.strip(), None)


@lru_cache(maxsize=4096)  # the same floors and choices stand in row after row
def key(text: str) -> str:
    """Return a name as names are compared: letter case and the number of spaces ignored."""
    return " ".join(unicodedata.normalize("NFKC", text).split()).casefold()


def fold(text: str) -> str:
    """Return a label as labels are compared: letter case and spaces ignored."""
    return "".join(key(text).split())
