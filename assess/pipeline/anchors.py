"""What a bracket at the wall has to carry, for every piece, anchored or not: screening, not design.

The demand of the scenario: the piece turns about its toe under the peak floor acceleration that governs it, without
vertical motion, helped by its own weight; at 16 % and 84 % of the scatter of that acceleration too, and without the
help of the weight, which is an upper bound. The demand of the code: F_p of ASCE 7-22, 13.3.1, with 0.2 S_DS upward,
where SDS or Ground PGA is known. `assess.bracket` has the equations.

A partly anchored piece with a known capacity counts as anchored where its bracket carries the demand of 84 %, and
stands free where it does not (elastic-brittle, after Majdalaweyh and Pang 2022). An anchored piece whose bracket does
not carry the demand of the scenario stands free too.

Where neither weight nor width of a piece is known, forces are those of one metre of it. A bracket that does not carry
these counts as one that does not hold, which is the safe side for a narrower piece; of one that does it is not known
whether it holds, unless the weight alone holds the piece, whatever its width. So a partly anchored piece stands free,
and an anchored one, not known to fail, stays anchored.

The weight of a piece is as the workbook gives it, its type's, or an estimate from what it is mostly full of. An
estimate is a density times the piece's outline. Only two of the densities come from weighed pieces; the others are
assumed, on the high side for what is usual: a bracket that is chosen by them is rather too strong than too weak.

References
----------
Tokyo Metropolitan Government (2015). Product test of devices against the overturning of furniture. March 2015: a chest
and a cupboard with contents, 160 and 157 kg/m3.
Krakower M (2000). Tests of the California Office of the State Architect. Mailing list of the Structural Engineers
Association International: double-faced library shelving of 21 in by 7.5 ft, books alone 350 lb/ft, 427 kg/m3.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from assess.bracket import find_code_demand, find_needed_friction, find_tension, find_tension_without_weight
from assess.i18n import Text, fill
from assess.model import Inventory, Item
from assess.motion.scenario import PGA_OF_SDS
from assess.pipeline.known_ground import find_ground
from assess.results import AnchorRow
from assess.rocking.draws import PEAK
from assess.settings import Settings
from assess.units import FORCE, GRAVITY, LENGTH, to_edge
from assess.workbook.catalogue import find_contents

if TYPE_CHECKING:
    from assess.methods import Cases

WIDTH = 1.0
"""Width that is assumed where none is given [m]: forces are then those of one metre of the piece."""


class Density(NamedTuple):
    """Weight with contents over the volume of the outline [kg/m3], what it stands for, and where it comes from."""

    value: float
    meaning: Text
    source: Text


_ASSUMED = fill("assumed")
DENSITIES = {
    "open": Density(80.0, fill("open furniture"), _ASSUMED),
    "storage": Density(
        160.0, fill("storage with usual contents"), fill("Tokyo Metropolitan Government 2015, two pieces with contents")
    ),
    "equipment": Density(250.0, fill("equipment and appliances"), _ASSUMED),
    "paper": Density(430.0, fill("books and files"), fill("Krakower 2000, library shelving full of books")),
    "dense": Density(600.0, fill("dense equipment and heavy stock"), _ASSUMED),
    "solid": Density(1000.0, fill("solid pieces"), _ASSUMED),
}
"""Densities by what a piece is mostly full of, one of `assess.workbook.catalogue.CONTENTS`."""
UNKNOWN = "paper"
"""What a piece of no known type is taken to be full of."""


@dataclass(frozen=True, slots=True)
class Weight:
    """The weight of a piece with its contents [N], where it comes from, and whether any part of it is assumed.

    `source` is "given", "type" or "estimate"; `words` say it. `is_per_metre`: whether it is that of one metre of the
    piece's width, as its own is not known.
    """

    value: float
    source: str
    words: Text
    is_assumed: bool
    is_per_metre: bool = False


def find_weight(item: Item, language: str = "en") -> Weight:
    """Return the weight of a piece with its contents; `language` is that of the workbook, in which it names types."""
    if item.weight is not None:
        is_type = "weight" in item.assumed
        words = _FROM_TYPE if is_type else _GIVEN
        return Weight(item.weight * GRAVITY, "type" if is_type else "given", words, is_assumed=False)
    contents = find_contents(item.type, language)
    density, words = DENSITIES[contents or UNKNOWN].value, _describe_estimate(contents)
    volume = item.breadth * (item.width or WIDTH) * item.height
    return Weight(density * volume * GRAVITY, "estimate", words, is_assumed=True, is_per_metre=item.width is None)


_FROM_TYPE, _GIVEN = fill("as its Type in the Catalogue has it"), fill("as the workbook gives it")


@cache  # the same few sentences for every row
def _describe_estimate(contents: str) -> Text:
    density = DENSITIES[contents or UNKNOWN]
    filled: dict[str, Any] = {"density": density.value, "meaning": density.meaning, "source": density.source}
    if not contents:
        return fill("estimated: {density:g} kg/m³, assumed to be full of {meaning} ({source})", **filled)
    return fill("estimated: {density:g} kg/m³, {meaning} ({source})", **filled)


FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

BRACKET = 0.9
"""Height of a bracket over that of the piece, assumed where none is given [-]."""
UPWARD = 0.2
"""Vertical acceleration of the code over S_DS [-]."""


@dataclass(frozen=True, slots=True, eq=False)
class Anchors:
    """What the brackets of n pieces have to carry [N], and whether they do.

    * `weights`: with contents.
    * `height` (n,): of the bracket above the floor [m].
    * `is_height_assumed` (n,): where the workbook does not give it.
    * `capacity` (n,): tension that the bracket carries [N]; NaN where it is not known.
    * `tension`, `tension_low`, `tension_high`, `tension_without_weight`, `shear` (n,): at the bracket, for PFA and for
      its 16 % and 84 %; without the help of the weight; and at the base, for PFA, in whichever direction [N].
    * `needed_friction` (n,): coefficient of friction below which the base slides at PFA [-].
    * `tension_code`, `shear_code` (n,): the same for the code's F_p [N]; NaN where it is not known.
    * `held` (n,): where a piece counts as anchored.
    """

    weights: Sequence[Weight]
    height: FloatArray
    is_height_assumed: BoolArray
    capacity: FloatArray
    tension: FloatArray
    tension_low: FloatArray
    tension_high: FloatArray
    tension_without_weight: FloatArray
    shear: FloatArray
    needed_friction: FloatArray
    tension_code: FloatArray
    shear_code: FloatArray
    held: BoolArray

    def describe(self) -> list[AnchorRow]:
        """Return the rows of all pieces."""
        is_per_metre = np.array([one.is_per_metre for one in self.weights], dtype=np.bool_)

        def holds(tension: FloatArray) -> list[bool | None]:
            can = tension <= self.capacity
            is_open = np.isnan(tension) | np.isnan(self.capacity) | (is_per_metre & (tension > 0) & can)
            return [None if unknown else found for unknown, found in zip(is_open.tolist(), can.tolist(), strict=True)]

        columns: dict[str, list[Any]] = {
            "weight_kn": [to_edge(one.value, FORCE["kN"]) for one in self.weights],
            "weight_source": [one.source for one in self.weights],
            "weight_words": [one.words for one in self.weights],
            "is_per_metre": is_per_metre.tolist(),
            "bracket_height_cm": [to_edge(one, LENGTH["cm"]) for one in self.height.tolist()],
            "is_height_assumed": self.is_height_assumed.tolist(),
            "bracket_capacity_kn": _in_kn(self.capacity),
            "tension_kn": _in_kn(self.tension),
            "tension_low_kn": _in_kn(self.tension_low),
            "tension_high_kn": _in_kn(self.tension_high),
            "tension_without_weight_kn": _in_kn(self.tension_without_weight),
            "shear_kn": _in_kn(self.shear),
            "needed_friction": self.needed_friction.tolist(),
            "tension_code_kn": _in_kn(self.tension_code),
            "shear_code_kn": _in_kn(self.shear_code),
            "holds": holds(self.tension),
            "holds_high": holds(self.tension_high),
            "holds_code": holds(self.tension_code),
        }
        return [AnchorRow(**dict(zip(columns, row, strict=True))) for row in zip(*columns.values(), strict=True)]


def _in_kn(forces: FloatArray) -> list[float | None]:
    return [None if force != force else to_edge(force, FORCE["kN"]) for force in forces.tolist()]


def find_anchors(inventory: Inventory, cases: "Cases", governing: NDArray[np.intp], settings: Settings) -> Anchors:
    """Return what the brackets of all pieces have to carry under the motion that governs each."""
    items, weights = inventory.items, [find_weight(one, inventory.language) for one in inventory.items]
    piece = _list_pieces(items, weights)
    pfa, capacity = cases.pfa[governing], _list_numbers([one.bracket_capacity for one in items])
    spread = np.hypot(cases.dispersion, np.where(cases.peak == PEAK, 0.0, cases.peak))[governing]
    low, middle, high = (find_tension(**piece, acceleration=k) for k in _scatter(pfa, spread))
    code, upward = _find_code(inventory, settings)
    tension_code = find_tension(**piece, acceleration=code, vertical=upward)
    weight, body = piece["weight"], {name: one for name, one in piece.items() if name != "breadth"}
    return Anchors(
        weights=weights,
        height=piece["height"],
        is_height_assumed=np.array([one.bracket_height is None for one in items], dtype=np.bool_),
        capacity=capacity,
        tension=middle,
        tension_low=low,
        tension_high=high,
        tension_without_weight=find_tension_without_weight(**body, acceleration=pfa / GRAVITY),
        shear=np.abs(pfa / GRAVITY * weight - middle),
        needed_friction=find_needed_friction(weight=weight, acceleration=pfa / GRAVITY, tension=middle),
        tension_code=tension_code,
        shear_code=np.abs(code * weight - tension_code),
        held=find_held(inventory, pfa, spread),
    )


def find_held(inventory: Inventory, pfa: FloatArray, dispersion: FloatArray) -> BoolArray:
    """Return which of n pieces count as anchored under their PFA (n,) [m/s2] with a dispersion of ln PFA (n,) [-]."""
    items = inventory.items
    held = np.array([one.anchored == "yes" for one in items], dtype=np.bool_)
    known = [
        at for at, one in enumerate(items) if one.bracket_capacity is not None and one.anchored in ("yes", "partly")
    ]
    if known:
        own = [items[at] for at in known]
        weights = [find_weight(one, inventory.language) for one in own]
        piece, is_per_metre = _list_pieces(own, weights), np.array([one.is_per_metre for one in weights])
        capacity = _list_numbers([one.bracket_capacity for one in own])
        _, middle, high = (find_tension(**piece, acceleration=k) for k in _scatter(pfa[known], dispersion[known]))
        held[known] = np.where(held[known], capacity >= middle, (capacity >= high) & ~(is_per_metre & (high > 0)))
    return held


def _scatter(pfa: FloatArray, dispersion: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return PFA over g at 16 %, 50 % and 84 %."""
    k = pfa / GRAVITY
    return k * np.exp(-dispersion), k, k * np.exp(dispersion)


def _list_pieces(items: Sequence[Item], weights: Sequence[Weight]) -> dict[str, FloatArray]:
    """Return the arguments of `find_tension` that describe pieces (n,)."""
    tall, given = _list_numbers([one.height for one in items]), _list_numbers([one.bracket_height for one in items])
    return {
        "weight": _list_numbers([one.value for one in weights]),
        "breadth": _list_numbers([one.breadth for one in items]),
        "centre": tall * _list_numbers([one.centre_of_gravity for one in items]),
        "height": np.where(np.isnan(given), BRACKET * tall, given),
    }


def _list_numbers(values: Sequence[float | None]) -> FloatArray:
    return np.array(values, dtype=np.float64)


def _find_code(inventory: Inventory, settings: Settings) -> tuple[FloatArray, float]:
    """Return F_p/W of each piece and the code's vertical acceleration over g; NaN where S_DS is not known."""
    building, ground = inventory.building, find_ground(inventory)
    peak = building.sds if building.sds is not None else building.ground_pga
    if peak is None:
        return np.full(len(inventory.items), np.nan), np.nan
    sds = peak / GRAVITY / (1.0 if building.sds is not None else PGA_OF_SDS)
    by_floor = {}
    for floor in inventory.floors:
        place = ground.find_ratio(floor)
        ratio = 1.0 if place is None else place  # where a height is not known, as at the roof, where F_p is largest
        by_floor[floor.floor] = find_code_demand(
            sds=sds, height_ratio=ratio, resonance=settings.anchor_resonance, strength=settings.anchor_strength,
            importance=settings.anchor_importance, ductility=settings.ductility_reduction, period=building.period,
        )  # fmt: skip
    return np.array([by_floor[one.floor] for one in inventory.items], dtype=np.float64), UPWARD * sds
