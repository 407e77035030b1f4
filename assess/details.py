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
FEMA (2012). Reducing the Risks of Nonstructural Earthquake Damage, E-74: kinds of details, non-engineered (NE),
prescriptive (PR) and engineering required (ER). Which of them a detail below is, is assumed.
Tokyo Fire Department. Survey of furniture overturning in the Kumamoto earthquake of 2016, houses.
Tokyo Metropolitan Government (2015). Product test of devices against the overturning of furniture. March 2015.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from assess.i18n import LANGUAGES, Text, fill, load_catalogue
from assess.units import FORCE

SCREW = 2 * 96 * FORCE["lbf"]
"""Withdrawal of a No. 10 wood screw, 2 in of thread in spruce-pine-fir of G 0.42, by the NDS equation [N]."""
LEAST_FIXINGS = 2  # brackets or straps a piece has at least: each to a stud of its own
WHO: Mapping[str, Text] = {
    "NE": fill("anyone who is handy"),
    "PR": fill("a trained installer, by a standard drawing"),
    "ER": fill("an installer, after an engineer's design"),
}
"""Who may do a detail, by FEMA E-74: non-engineered, prescriptive, engineering required."""


@dataclass(frozen=True, slots=True)
class Fixing:
    """What one fixing is in a kind of wall, in SI and in US units; `capacity` [N], None where no source prints one."""

    si: Text
    us: Text
    capacity: float | None = None


WALLS: Mapping[str, Fixing] = {
    "studs": Fixing(
        fill("No. 10 wood screw (4.8 mm), 50 mm of thread in a stud of spruce-pine-fir: 0.85 kN in withdrawal (NDS "
             "equation, before the factor for the duration of load)"),
        fill("No. 10 wood screw, 2 in of thread in a stud of spruce-pine-fir: 192 lbf in withdrawal (NDS equation, "
             "before the factor for the duration of load)"),
        SCREW,
    ),
    "concrete": Fixing(
        fill("expansion anchor M8, set as its maker says; no capacity is printed"),
        fill("expansion anchor 5/16 in, set as its maker says; no capacity is printed"),
    ),
    "masonry": Fixing(
        fill("sleeve anchor or resin anchor M8 with a perforated sleeve; no capacity is printed"),
        fill("sleeve anchor or resin anchor 5/16 in with a screen tube; no capacity is printed"),
    ),
}  # fmt: skip
"""What a fixing to a wall is, by the kind of wall."""


@dataclass(frozen=True, slots=True)
class Detail:
    """A generic way to fix a piece: how it is done, what is known against it, and where that is printed.

    `word` is what the column *Fix by* calls it, "" where it cannot be chosen there; `least` how many fixings a piece
    has at least, 0 where none is counted. `is_at_wall`: its fixings are one of `WALLS`; `is_at_base`: it holds the
    piece at its base, where the lever of its fixings is the piece's breadth. `who` is a key of `WHO`; `hours` are those
    of work on one piece, of all people together, assumed.
    """

    key: str
    title: Text
    what: Text
    weakness: Text
    source: Text
    fixing: Text = WALLS["studs"].si
    is_at_base: bool = False
    word: str = ""
    who: str = "NE"
    hours: float = 0.5
    least: int = LEAST_FIXINGS
    is_at_wall: bool = False
    what_us: Text | None = None

    def say_what(self, *, us: bool = False) -> Text:
        """Return what is done, in SI or in US units."""
        return self.what if self.what_us is None or not us else self.what_us

    @property
    def capacity(self) -> float | None:
        """What one fixing in studs holds [N]; None where no source prints it."""
        return WALLS["studs"].capacity if self.is_at_wall else None

    @property
    def drawing(self) -> str:
        """The name of its drawing in templates/details; "" where it has none."""
        return "" if self.key == "pole" else f"{self.key}.svg"

    def say_fixing(self, wall: str = "studs", *, us: bool = False) -> Text:
        """Return what one fixing is in a wall, one of `WALLS`, in SI or in US units."""
        one = WALLS[wall]
        return (one.us if us else one.si) if self.is_at_wall else self.fixing


_NONE, _ASSUMED = fill("no fixing is counted"), fill("assumed: no citable source")
_NOT_PRINTED = fill("no capacity is printed")
DETAILS: Mapping[str, Detail] = {
    one.key: one
    for one in (
        Detail("bracket", fill("L-bracket to studs"),
            fill("steel L-brackets near the top, screwed into studs or a solid wall, at least 50 mm deep; FEMA (2008) "
                 "shows six for a bookcase of 0.9 x 1.8 m"),
            fill("rigid, assumed to load the screws at every impact. In houses 8.9 % overturned with it, 33.5 % "
                 "without (Kumamoto 2016, n = 79, Tokyo Fire Department); the Earthquake Country Alliance advises "
                 "straps instead"),
            fill("FEMA 2008; Tokyo Fire Department, Kumamoto 2016"), word="wall bracket", hours=0.75, is_at_wall=True,
            what_us=fill("steel L-brackets near the top, screwed into studs or a solid wall, at least 2 in deep; FEMA "
                         "(2008) shows six for a bookcase of 3 x 6 ft")),
        Detail("strap", fill("straps to two studs"),
            fill("flexible nylon straps near the top, to two studs, drawn tight"),
            fill("assumed: a slack strap lets the piece rock; stick-on ends hold no better than the face that they "
                 "stick to"),
            fill("Earthquake Country Alliance"), word="strap", is_at_wall=True),
        Detail("base_angle", fill("base angle"),
            fill("angles 50 x 50 x 5 mm at the base, with lag screws 6 x 75 mm into wood, or expansion bolts 10 x 50 "
                 "mm into concrete; the source has inches"),
            fill("it holds at the base, where the lever is short: the tension there is larger than at the top"),
            fill("Earthquake Country Alliance"), _NOT_PRINTED, is_at_base=True, word="base angle", who="PR", hours=1.0,
            what_us=fill("angles 2 x 2 x 3/16 in at the base, with lag screws 1/4 x 3 in into wood, or expansion bolts "
                         "3/8 x 2 in into concrete")),
        Detail("gang", fill("gang the row together"),
            fill("bolt neighbours in a row, or back to back, together near the top and at the base"),
            fill("it only helps where the row is broader than one piece: back to back, or with a return"),
            _ASSUMED, _NOT_PRINTED),
        Detail("pole", fill("ceiling pole"),
            fill("poles between the top and a solid ceiling, with wedges or mats at the base"),
            fill("alone it failed in every shake-table test at JMA 6+ (Tokyo Metropolitan Government 2015); it needs "
                 "a ceiling that carries it, and a wedge or mat below"),
            fill("Tokyo Metropolitan Government 2015"), _NOT_PRINTED),
        Detail("chain", fill("chains round the cylinder"),
            fill("two chains or straps round each cylinder, above and below its middle, to a wall, a bench or a rack "
                 "that is itself fixed"),
            fill("assumed: one chain alone lets the foot kick out; a chain that is left open holds nothing"),
            _ASSUMED, word="chain", is_at_wall=True),
        Detail("castors", fill("lockable castors and a tether"),
            fill("castors that lock, kept locked while it is parked, and a tether with a hook to the wall at its "
                 "parking place"),
            fill("assumed: it holds only while it is hooked and locked; no shake-table test of it is known"),
            _ASSUMED, _NONE, word="castors", hours=0.25, least=0),
        Detail("rack", fill("rack braced at the top and bolted down"),
            fill("bolts through the feet into the floor, and a brace at the top to a wall or the structure above"),
            fill("assumed: feet and posts may fail before the bolts; the brace needs something solid to go to"),
            _ASSUMED, _NOT_PRINTED, word="rack", who="ER", hours=2.0),
        Detail("ceiling", fill("fixed to the ceiling"),
            fill("rods or struts from its top to the structure above, braced in both directions"),
            fill("assumed: a suspended ceiling carries nothing; the structure above it has to"),
            _ASSUMED, _NOT_PRINTED, word="ceiling", who="ER", hours=2.0),
        Detail("maker", fill("fixed by its maker"),
            fill("the maker's own anchorage, fitted by the maker or as its manual says"),
            fill("assumed: drilling or bolting by others may damage it or end its warranty"),
            _ASSUMED, _NONE, word="by the maker", who="PR", hours=1.0, least=0),
        Detail("clear", fill("keep out of the way"),
            fill("nothing is fixed: it stands where it blocks no way out and where nobody sits or sleeps beside it"),
            fill("assumed: it may still slide, roll or fall"),
            _ASSUMED, _NONE, word="keep clear", hours=0.25, least=0),
        Detail("check", fill("check the anchor"),
            fill("its anchor is found, looked at and tried; number and kind of fixings go into the workbook"),
            fill("assumed: what a wall hides, such as a missing stud, is not seen"),
            _ASSUMED, _NONE, who="PR", hours=0.25, least=0),
        Detail("complete", fill("complete the anchor"),
            fill("what is there is checked, and fixings are added until there are as many as the force needs"),
            fill("assumed: old and new fixings share the force only where they are alike"),
            _ASSUMED, _NOT_PRINTED, who="PR", hours=0.75),
    )
}  # fmt: skip
"""Generic details by their key."""

_CASTORS = re.compile(
    r"\b(castors?|casters?|wheels|wheeled|rollers|trolleys?|carts?|ruote|rotelle|carrell[oi])\b", re.IGNORECASE
)
FIX_BY: Mapping[str, str] = {one.word: one.key for one in DETAILS.values() if one.word}
"""Keys of the details that the Catalogue offers, by the words of its column *Fix by*."""
AT_WALL, AT_BASE, CHECK = "bracket", "base_angle", "check"
ALTERNATIVES = ("gang", "pole")
"""Keys of the details that no schedule prices, as they are alternatives to others."""


def count_fixings(detail: Detail, tension: float) -> int:
    """Return how many fixings a tension [N] needs: the detail's least at least, and where no capacity is printed."""
    return detail.least if detail.capacity is None else max(detail.least, math.ceil(tension / detail.capacity))


def says_castors(*texts: str) -> bool:
    """Return whether any text says, in a language of the workbook, that a piece stands on castors."""
    return any(map(_CASTORS.search, texts))


def find_detail(name: str) -> Detail | None:
    """Return the detail of this key, or of this title in any language; None where there is none."""
    wanted = name.strip().casefold()
    for code in LANGUAGES:
        said = load_catalogue(code)
        for one in DETAILS.values():
            if wanted in (one.key, said.find(str(one.title)).casefold()):
                return one
    return None
