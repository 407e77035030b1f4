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
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.bracket import find_code_demand, find_needed_friction, find_tension, find_tension_without_weight
from assess.model import Inventory, Item
from assess.motion.scenario import PGA_OF_SDS
from assess.pipeline.demand import find_ground, find_height_ratio
from assess.pipeline.weights import Weight, find_weight
from assess.results import AnchorRow
from assess.settings import Settings
from assess.units import FORCE, GRAVITY, LENGTH, to_edge

if TYPE_CHECKING:
    from assess.methods import Cases

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

BRACKET = 0.9
"""Height of a bracket over that of the piece, assumed where none is given [-]."""
UPWARD = 0.2
"""Vertical acceleration of the code over S_DS [-]."""


@dataclass(frozen=True, slots=True, eq=False)
class Anchors:
    """What the brackets of n pieces have to carry [N], and whether they do.

    Parameters
    ----------
    weights : sequence of Weight
        With contents.
    height : (n,) array
        Of the bracket above the floor [m].
    is_height_assumed : (n,) boolean array
        Where the workbook does not give it.
    capacity : (n,) array
        Tension that the bracket carries [N]; NaN where it is not known.
    tension, tension_low, tension_high, tension_without_weight, shear : (n,) arrays
        At the bracket, for PFA and for its 16 % and 84 %; without the help of the weight; and at the base, for PFA, in
        whichever direction [N].
    needed_friction : (n,) array
        Coefficient of friction below which the base slides at PFA [-].
    tension_code, shear_code : (n,) arrays
        The same for the code's F_p [N]; NaN where it is not known.
    held : (n,) boolean array
        Where a piece counts as anchored.
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

    def describe(self, at: int) -> AnchorRow:
        """Return the row of a piece by its index."""
        weight = self.weights[at]

        def known(forces: FloatArray) -> float | None:
            return None if np.isnan(forces[at]) else _in_kn(forces[at])

        def holds(tension: FloatArray) -> bool | None:
            demand, capacity = tension[at], self.capacity[at]
            is_open = np.isnan(demand) or np.isnan(capacity) or (weight.is_per_metre and 0 < demand <= capacity)
            return None if is_open else bool(demand <= capacity)

        return AnchorRow(
            weight_kn=_in_kn(weight.value),
            weight_source=weight.source,
            weight_words=weight.words,
            is_per_metre=weight.is_per_metre,
            bracket_height_cm=to_edge(float(self.height[at]), LENGTH["cm"]),
            is_height_assumed=bool(self.is_height_assumed[at]),
            bracket_capacity_kn=known(self.capacity),
            tension_kn=_in_kn(self.tension[at]),
            tension_low_kn=_in_kn(self.tension_low[at]),
            tension_high_kn=_in_kn(self.tension_high[at]),
            tension_without_weight_kn=_in_kn(self.tension_without_weight[at]),
            shear_kn=_in_kn(self.shear[at]),
            needed_friction=float(self.needed_friction[at]),
            tension_code_kn=known(self.tension_code),
            shear_code_kn=known(self.shear_code),
            holds=holds(self.tension),
            holds_high=holds(self.tension_high),
            holds_code=holds(self.tension_code),
        )


def _in_kn(force: float) -> float:
    return to_edge(float(force), FORCE["kN"])


def find_anchors(inventory: Inventory, cases: "Cases", governing: NDArray[np.intp], settings: Settings) -> Anchors:
    """Return what the brackets of all pieces have to carry under the motion that governs each."""
    items, weights = inventory.items, [find_weight(one, inventory.language) for one in inventory.items]
    piece = _list_pieces(items, weights)
    pfa, capacity = cases.pfa[governing], _list_numbers([one.bracket_capacity for one in items])
    low, middle, high = (find_tension(**piece, acceleration=k) for k in _scatter(pfa, cases.uncertainty.motion))
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
        held=find_held(inventory, pfa, cases.uncertainty.motion),
    )


def find_held(inventory: Inventory, pfa: FloatArray, dispersion: float) -> BoolArray:
    """Return which of n pieces count as anchored under their PFA (n,) [m/s2] with a dispersion of ln PFA [-]."""
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
        _, middle, high = (find_tension(**piece, acceleration=k) for k in _scatter(pfa[known], dispersion))
        held[known] = np.where(held[known], capacity >= middle, (capacity >= high) & ~(is_per_metre & (high > 0)))
    return held


def _scatter(pfa: FloatArray, dispersion: float) -> tuple[FloatArray, FloatArray, FloatArray]:
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
    """Return F_p/W of each piece and the code's vertical acceleration over g; NaN where S_DS is not known.

    Where the height of a floor, or of the roof, is not known, it is taken to be the roof, where F_p is largest.
    """
    building, ground = inventory.building, find_ground(inventory)
    peak = building.sds if building.sds is not None else building.ground_pga
    if peak is None:
        return np.full(len(inventory.items), np.nan), np.nan
    sds = peak / GRAVITY / (1.0 if building.sds is not None else PGA_OF_SDS)
    by_floor = {}
    for floor in inventory.floors:
        z, _ = ground.place(floor)
        ratio = 1.0 if z is None or not ground.roof else find_height_ratio(z, ground.roof)
        by_floor[floor.floor] = find_code_demand(
            sds=sds, height_ratio=ratio, resonance=settings.anchor_resonance, strength=settings.anchor_strength,
            importance=settings.anchor_importance, ductility=settings.ductility_reduction, period=building.period,
        )  # fmt: skip
    return np.array([by_floor[one.floor] for one in inventory.items], dtype=np.float64), UPWARD * sds
