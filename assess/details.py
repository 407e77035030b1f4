"""Generic ways to fix furniture: what each is, where it belongs, its known weakness, and capacities that are printed.

Screening, not design: whoever fixes a piece checks wall, fixings and the body of the piece itself. Capacities stand
here only where a source prints them; what none prints is marked assumed. Sources disagree on rigid brackets: the Tokyo
Fire Department measures other devices by L-brackets that are screwed to the wall, the Earthquake Country Alliance
advises nylon straps to two studs instead.

References
----------
American Wood Council. National Design Specification for Wood Construction, 12.2: withdrawal of wood screws,
2850 G^2 D [lb/in of thread], and of lag screws, 1800 G^1.5 D^0.75. G is the specific gravity of the wood.
Earthquake Country Alliance. Step 1: secure your space. Pages on bookcases and on filing cabinets.
FEMA (2008). How-to sheets on bracing bookcases: screws at least 2 in into wall and stud, six brackets for a bookcase of
3 x 6 ft.
Tokyo Fire Department. Survey of furniture overturning in the Kumamoto earthquake of 2016, houses.
Tokyo Metropolitan Government (2015). Product test of devices against the overturning of furniture. March 2015.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from assess.i18n import LANGUAGES, Text, fill, load_catalogue
from assess.units import FORCE

SCREW = 2 * 96 * FORCE["lbf"]
"""Withdrawal of a No. 10 wood screw, 2 in of thread in spruce-pine-fir of G 0.42, by the NDS equation [N]."""
LEAST_FIXINGS = 2  # brackets or straps a piece has at least: each to a stud of its own


@dataclass(frozen=True, slots=True)
class Detail:
    """A generic way to fix a piece: how it is done, what is known against it, and where that is printed.

    `capacity` is that of one fixing [N], None where no source prints one; `is_at_base`: it holds the piece at its base,
    where the lever of its fixings is the piece's breadth.
    """

    key: str
    title: Text
    what: Text
    weakness: Text
    source: Text
    fixing: Text
    capacity: float | None = None
    is_at_base: bool = False


_SCREW = fill(
    "No. 10 wood screw, 2 in of thread in a stud of spruce-pine-fir: 0.85 kN in withdrawal (NDS equation, before the "
    "factor for the duration of load)"
)
DETAILS: Mapping[str, Detail] = {
    one.key: one
    for one in (
        Detail(
            "bracket", fill("L-bracket to studs"),
            fill(
                "steel L-brackets near the top, screwed into studs or a solid wall, at least 2 in deep; FEMA (2008) "
                "shows six for a bookcase of 3 x 6 ft"
            ),
            fill(
                "rigid, assumed to load the screws at every impact. In houses 8.9 % overturned with it, 33.5 % "
                "without (Kumamoto 2016, n = 79, Tokyo Fire Department); the Earthquake Country Alliance advises "
                "straps instead"
            ),
            fill("FEMA 2008; Tokyo Fire Department, Kumamoto 2016"), _SCREW, SCREW,
        ),
        Detail(
            "strap", fill("straps to two studs"),
            fill("flexible nylon straps near the top, to two studs, drawn tight"),
            fill(
                "assumed: a slack strap lets the piece rock; stick-on ends hold no better than the face that they "
                "stick to"
            ),
            fill("Earthquake Country Alliance"), _SCREW, SCREW,
        ),
        Detail(
            "base_angle", fill("base angle"),
            fill(
                "angles 2 x 2 x 3/16 in at the base, with lag screws 1/4 x 3 in into wood, or expansion bolts 3/8 x 2 "
                "in into concrete"
            ),
            fill("it holds at the base, where the lever is short: the tension there is larger than at the top"),
            fill("Earthquake Country Alliance"), fill("no capacity is printed"), is_at_base=True,
        ),
        Detail(
            "gang", fill("gang the row together"),
            fill("bolt neighbours in a row, or back to back, together near the top and at the base"),
            fill("it only helps where the row is broader than one piece: back to back, or with a return"),
            fill("assumed: no citable source"), fill("no capacity is printed"),
        ),
        Detail(
            "pole", fill("ceiling pole"),
            fill("poles between the top and a solid ceiling, with wedges or mats at the base"),
            fill(
                "alone it failed in every shake-table test at JMA 6+ (Tokyo Metropolitan Government 2015); it needs a "
                "ceiling that carries it, and a wedge or mat below"
            ),
            fill("Tokyo Metropolitan Government 2015"), fill("no capacity is printed"),
        ),
    )
}  # fmt: skip
"""Generic details by their key."""

AT_WALL, AT_BASE = "bracket", "base_angle"
"""Keys of the details that the schedule prices; the others are alternatives to them."""


def count_fixings(detail: Detail, tension: float) -> int:
    """Return how many fixings a tension [N] needs, `LEAST_FIXINGS` at least and where no capacity is printed."""
    return LEAST_FIXINGS if detail.capacity is None else max(LEAST_FIXINGS, math.ceil(tension / detail.capacity))


def find_detail(name: str) -> Detail | None:
    """Return the detail of this key, or of this title in any language; None where there is none."""
    wanted = name.strip().casefold()
    for code in LANGUAGES:
        said = load_catalogue(code)
        for one in DETAILS.values():
            if wanted in (one.key, said.find(str(one.title)).casefold()):
                return one
    return None
