"""How wide a route must stay: the default, what codes and guidance ask for, and what its occupants need."""

from dataclasses import dataclass

from assess.methods import Reference
from assess.model import Place, Segment

NARROWER = 1e-6
"""By how much [m] a width must be under another to count as narrower: less is rounding."""


@dataclass(frozen=True, slots=True)
class WidthRule:
    """A width that a code or a guidance asks for: `width` [m], where it holds, and the publication."""

    width: float
    holds: str
    reference: Reference


_IBC = Reference(
    authors="International Code Council", year="2021", title="International Building Code",
    source="sections 1005.3 and 1020.3", remark="Assumed: widths as given in summaries, not compared with the code.",
)  # fmt: skip
_JAPAN = Reference(
    title="Building Standards Law Enforcement Order (Japan)", source="Article 119",
    remark="Assumed: widths as given in a summary, not compared with the order.",
)  # fmt: skip
_TOKYO = Reference(
    authors="Tokyo Metropolitan Government", title="Guidance on preventing the fall of furniture in offices",
    source="bousai.metro.tokyo.lg.jp",
    remark="It asks that the main route be straight, with nothing that falls or moves easily beside it or its exits.",
)  # fmt: skip
_ITALY = Reference(
    authors="Ministero dell'Interno (Italy)", year="2015", title="D.M. 3 agosto 2015, Codice di prevenzione incendi",
    source="section S.4.8", remark="Assumed: widths as commonly quoted, not compared with the decree.",
)  # fmt: skip

RULES = (
    WidthRule(1.2, "main evacuation route of an office", _TOKYO),
    WidthRule(1.118, "corridor, 44 in", _IBC),
    WidthRule(0.914, "corridor for fewer than 50 occupants, 36 in", _IBC),
    WidthRule(0.813, "clear width of a door, 32 in", _IBC),
    WidthRule(2.3, "corridor of a school with rooms on both sides", _JAPAN),
    WidthRule(1.8, "corridor of a school with rooms on one side", _JAPAN),
    WidthRule(1.6, "hospital, shared or other large corridor with rooms on both sides", _JAPAN),
    WidthRule(1.2, "hospital, shared or other large corridor with rooms on one side", _JAPAN),
    WidthRule(0.9, "up to 300 occupants", _ITALY),
    WidthRule(1.0, "up to 1,000 occupants", _ITALY),
    WidthRule(1.2, "more than 1,000 occupants", _ITALY),
)
"""Widths that codes and guidance ask for, for the reader to choose from; which applies, the workbook has to say."""

LEVEL, STAIR = 0.00508, 0.00762
"""Width that an occupant needs [m]: 0.2 in, on stairs 0.3 in. Assumed: the International Building Code, section 1005.3,
as given in summaries."""


def needed_width(segment: Segment, kinds: dict[str, str]) -> float | None:
    """Return the width that the occupants of a segment need [m], None where their number is unknown.

    A segment from stair to stair is taken as stairs; `kinds` are those of the places.
    """
    if segment.occupants is None:
        return None
    is_stair = kinds.get(segment.start) == kinds.get(segment.end) == "stair"
    return segment.occupants * (STAIR if is_stair else LEVEL)


def kinds_of(places: tuple[Place, ...]) -> dict[str, str]:
    """Return the kind of every place by its name."""
    return {place.place: place.kind for place in places}
