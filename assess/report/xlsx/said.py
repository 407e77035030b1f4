"""Words and sheet names inside formulas: what a formula writes, compares and refers to is in the report's language."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from assess.inventory.live import say_class
from assess.language import gettext as _
from assess.risk import RiskClass

ANCHORED = "⚓ "
"""Mark before the class of an anchored piece, which is that of the piece without its anchor; it is not coloured."""

_LONGEST = 31
"""Characters of a sheet's name."""
_HOLES = 0xE000
"""First of the characters that stand for an expression in a sentence; of Unicode's private use."""


def name_sheets(titles: Mapping[str, str]) -> dict[str, str]:
    """Return the names of sheets by their keys: of 31 characters at most, without those that Excel forbids, unique."""
    names: dict[str, str] = {}
    for key, title in titles.items():
        plain = re.sub(r"[\[\]:*?/\\]", " ", title).strip().strip("'")[:_LONGEST].strip() or key
        names[key] = _unlike(plain, names.values())
    return names


def _unlike(name: str, taken: Iterable[str]) -> str:
    """Return a name with a number behind it where it is taken; letter case does not count."""
    known, at, found = {one.casefold() for one in taken}, 1, name
    while found.casefold() in known:
        at += 1
        found = f"{name[: _LONGEST - len(f' {at}')]} {at}"
    return found


def refer(name: str) -> str:
    """Return a sheet's name as formulas write it before a cell."""
    return "'" + name.replace("'", "''") + "'!"


def literal(text: str) -> str:
    """Return a text as formulas write it."""
    return '"' + text.replace('"', '""') + '"'


def hole(at: int) -> str:
    """Return what stands in a sentence for the expression number `at` of `join`."""
    return chr(_HOLES + at)


def join(text: str, *expressions: str) -> str:
    """Return the expression of a sentence whose holes are filled by expressions."""
    parts = re.split(f"([{hole(0)}-{hole(9)}])", text)
    said = (expressions[ord(one) - _HOLES] if hole(0) <= one[0] <= hole(9) else literal(one) for one in parts if one)
    return "&".join(said)


@dataclass(frozen=True, slots=True)
class Terms:
    """What formulas write and compare."""

    yes: str
    edited: str
    check: str
    not_verified: str
    void: str
    labels: tuple[str, ...]

    def label(self, rank: str) -> str:
        """Return the expression for the label of a class by the expression of its place, 0 for low."""
        return f"CHOOSE({rank}+1,{','.join(map(literal, self.labels))})"


def say_terms() -> Terms:
    """Return the terms in the language in use."""
    return Terms(
        yes=_("yes"),
        edited=_("edited"),
        check=_("check"),
        not_verified=_("not verified"),
        void=_("void: inputs changed"),
        labels=tuple(say_class(risk) for risk in RiskClass),
    )
