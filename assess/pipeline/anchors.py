"""What a bracket at the wall has to carry, for every piece, anchored or not: screening, not design.

The demand of the scenario: the piece turns about its toe under the peak floor acceleration that governs it, without
vertical motion, helped by its own weight; at 16 % and 84 % of the scatter of that acceleration too, and without the
help of the weight, which is an upper bound. The demand of the code that `find_anchor_code` tells: F_p of ASCE 7-22,
13.3.1, with 0.2 S_DS upward, or F_a of EN 1998-1, 4.3.5.2, or of NTC 2018, 7.2.3, without vertical motion; where SDS or
Ground PGA is known, or a code is chosen and a map or an intensity gives PGA. `assess.bracket` has the equations.

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

import re
from collections.abc import Collection, Sequence
from dataclasses import replace
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.bracket import (
    find_code_demand,
    find_european_demand,
    find_needed_friction,
    find_tension,
    find_tension_without_weight,
)
from assess.errors import Problem, SettingsError
from assess.i18n import Text, fill, join
from assess.model import Inventory, Item
from assess.motion.scenario import PGA_OF_SDS
from assess.pipeline.adopt import Assessment
from assess.pipeline.known_ground import find_ground
from assess.results import AnchorRow
from assess.rocking.draws import PEAK
from assess.schedule_results import ScheduleRow
from assess.settings import ANCHOR_CODES, Settings
from assess.units import FORCE, GRAVITY, LENGTH, to_edge
from assess.workbook.catalogue import find_built_in
from assess.workbook.names import key

if TYPE_CHECKING:
    from assess.methods import Cases

WIDTH = 1.0
"""Width that is assumed where none is given [m]: forces are then those of one metre of the piece."""


class Density(NamedTuple):
    """Weight with contents over the volume of the outline [kg/m3], what it stands for, and where it comes from."""

    density: float
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


class Weight(NamedTuple):
    """The weight of a piece with its contents [N]: "given", of its "type", or an "estimate", and the same in words.

    `is_per_metre`: whether it is that of one metre of the piece's width, as its own is not known.
    """

    value: float
    source: str
    words: Text
    is_per_metre: bool = False


def find_weight(item: Item) -> Weight:
    """Return the weight of a piece with its contents."""
    if item.weight is not None:
        source, words = ("type", _FROM_TYPE) if "weight" in item.assumed else ("given", _GIVEN)
        return Weight(item.weight * GRAVITY, source, words)
    contents = (find_built_in(item.type) or {}).get("contents", "")
    density, volume = DENSITIES[contents or UNKNOWN].density, item.breadth * (item.width or WIDTH) * item.height
    return Weight(density * volume * GRAVITY, "estimate", _ESTIMATES[contents], is_per_metre=item.width is None)


_FROM_TYPE, _GIVEN = fill("as its Type in the Catalogue has it"), fill("as the workbook gives it")


_ESTIMATES = {
    contents: fill("estimated: {density:g} kg/m³, {meaning} ({source})", **one._asdict())
    for contents, one in DENSITIES.items()
}
_ESTIMATES[""] = fill(
    "estimated: {density:g} kg/m³, assumed to be full of {meaning} ({source})", **DENSITIES[UNKNOWN]._asdict()
)

WHAT_IF = "what_if"
"""In `Item.more` of a piece that the settings anchor, not the workbook."""
BRACKET = 0.9
"""Height of a bracket over that of the piece, assumed where none is given [-]."""
UPWARD = 0.2
"""Vertical acceleration of the code over S_DS [-]."""


def build_anchors(
    inventory: Inventory, cases: "Cases", governing: NDArray[np.intp], settings: Settings
) -> list[AnchorRow]:
    """Return what the brackets of all pieces have to carry under the motion that governs each, and whether they do."""
    items, weights = inventory.items, [find_weight(one) for one in inventory.items]
    piece, capacity = _list_pieces(items, weights), _list_numbers([one.bracket_capacity for one in items])
    pfa, spread = cases.pfa[governing], find_spread(cases)[governing]
    low, middle, high = (find_tension(**piece, acceleration=k) for k in _scatter(pfa, spread))
    code, upward = _find_code(inventory, settings)
    by_code = find_tension(**piece, acceleration=code, vertical=upward)
    weight, body = piece["weight"], {name: one for name, one in piece.items() if name != "breadth"}
    is_per_metre = np.array([one.is_per_metre for one in weights], dtype=np.bool_)

    def holds(tension: FloatArray) -> list[bool | None]:
        can = tension <= capacity
        is_open = np.isnan(tension) | np.isnan(capacity) | (is_per_metre & (tension > 0) & can)
        return [None if unknown else found for unknown, found in zip(is_open.tolist(), can.tolist(), strict=True)]

    columns: dict[str, list[Any]] = {
        "weight_kn": [to_edge(one.value, FORCE["kN"]) for one in weights],
        "weight_source": [one.source for one in weights],
        "weight_words": [one.words for one in weights],
        "is_per_metre": is_per_metre.tolist(),
        "bracket_height_cm": [to_edge(one, LENGTH["cm"]) for one in piece["height"].tolist()],
        "is_height_assumed": [one.bracket_height is None for one in items],
        "bracket_capacity_kn": _in_kn(capacity),
        "tension_kn": _in_kn(middle),
        "tension_low_kn": _in_kn(low),
        "tension_high_kn": _in_kn(high),
        "tension_without_weight_kn": _in_kn(find_tension_without_weight(**body, acceleration=pfa / GRAVITY)),
        "shear_kn": _in_kn(np.abs(pfa / GRAVITY * weight - middle)),
        "needed_friction": find_needed_friction(weight=weight, acceleration=pfa / GRAVITY, tension=middle).tolist(),
        "tension_code_kn": _in_kn(by_code),
        "shear_code_kn": _in_kn(np.abs(code * weight - by_code)),
        "holds": holds(middle),
        "holds_high": holds(high),
        "holds_code": holds(by_code),
    }
    return [AnchorRow(**dict(zip(columns, row, strict=True))) for row in zip(*columns.values(), strict=True)]


def find_anchor_code(inventory: Inventory, settings: Settings) -> str:
    """Return the code that gives the force on anchors, one of `ANCHOR_CODES`; "" where no ground motion is known.

    A ShakeMap, scenarios or an intensity tell it only where the workbook chooses a code.
    """
    building, scenario = inventory.building, settings.scenario or inventory.building.scenario_kind
    if building.known_pga is None and not (building.anchor_code and find_ground(inventory).pga):
        return ""
    return building.anchor_code or (scenario if scenario in ANCHOR_CODES else ANCHOR_CODES[0])


def _find_code(inventory: Inventory, settings: Settings) -> tuple[FloatArray, float]:
    """Return the code's force over the weight of each piece, and its vertical acceleration over g; NaN without."""
    building, ground, by_floor = inventory.building, find_ground(inventory), dict[str, float]()
    code = find_anchor_code(inventory, settings)
    pga = (building.known_pga or ground.pga or np.nan) / GRAVITY
    sds = pga / PGA_OF_SDS if building.sds is None else building.sds / GRAVITY
    for floor in inventory.floors:
        place = ground.find_ratio(floor)
        ratio = 1.0 if place is None else place  # where a height is not known, as at the roof, where it is largest
        if code == ANCHOR_CODES[0]:
            by_floor[floor.floor] = find_code_demand(
                sds=sds, height_ratio=ratio, resonance=settings.anchor_resonance, strength=settings.anchor_strength,
                importance=settings.anchor_importance, ductility=settings.ductility_reduction, period=building.period,
            )  # fmt: skip
        elif code:
            by_floor[floor.floor] = find_european_demand(
                ground=pga, height_ratio=ratio, behaviour=settings.anchor_behaviour,
                importance=1.0 if code == "NTC 2018" else settings.anchor_importance,
                element_period=settings.anchor_period, period=ground.building.period,
            )  # fmt: skip
    forces = np.array([by_floor.get(one.floor, np.nan) for one in inventory.items], dtype=np.float64)
    return forces, UPWARD * sds if code == ANCHOR_CODES[0] else 0.0


def _in_kn(forces: FloatArray) -> list[float | None]:
    return [None if force != force else to_edge(force, FORCE["kN"]) for force in forces.tolist()]


def find_spread(cases: "Cases") -> FloatArray:
    """Return the dispersion of ln PFA of each case, (n,) [-]: of the earthquake and of the peak of its motion."""
    return np.asarray(np.hypot(cases.dispersion, np.where(cases.peak == PEAK, 0.0, cases.peak)))


def find_held(inventory: Inventory, pfa: FloatArray, dispersion: FloatArray) -> BoolArray:
    """Return which of n pieces count as anchored under their PFA (n,) [m/s2] with a dispersion of ln PFA (n,) [-]."""
    items = inventory.items
    held = np.array([one.anchored == "yes" for one in items], dtype=np.bool_)
    known = [
        at for at, one in enumerate(items) if one.bracket_capacity is not None and one.anchored in ("yes", "partly")
    ]
    if known:
        own = [items[at] for at in known]
        weights = [find_weight(one) for one in own]
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


def spell_names(inventory: Inventory, names: Sequence[str]) -> tuple[str, ...]:
    """Return names of items as the workbook spells them, each once; SettingsError for an unknown or malformed one."""
    known = {key(one.item): one.item for one in inventory.items} if names else {}
    for name in (one for one in names if key(one) not in known):
        if re.match(r"\s*first\s*(:|$)", name, re.IGNORECASE):
            raise SettingsError.about(
                "anchor is {name!r}, expected first:N with a whole number N of at least 1, alone, or names of items.",
                name=name,
            )
        fault = fill("anchor: there is no item {name!r} in Items.", name=name)
        near = get_close_matches(name, [one.item for one in inventory.items], 1, 0.6)
        raise SettingsError(join(" ", (fault, *(fill("Did you mean {name}?", name=repr(one)) for one in near))))
    return tuple(dict.fromkeys(known[key(name)] for name in names))


def anchor_named(inventory: Inventory, names: Sequence[str]) -> Inventory:
    """Return an inventory in which the items of these names are anchored, with brackets that hold.

    Its problems get a note on each that the workbook has as anchored already. Raises SettingsError as `spell_names`.
    """
    if not names:
        return inventory
    wanted = set(spell_names(inventory, names))
    indices = {at for at, one in enumerate(inventory.items) if one.item in wanted}
    already = [inventory.items[at].item for at in sorted(indices) if inventory.items[at].anchored == "yes"]
    texts = (fill("Item {name!r} is anchored already: its anchor is taken to hold.", name=name) for name in already)
    notes = [Problem("note", "Items", "", text) for text in texts]
    return replace(_anchor(inventory, indices), problems=(*inventory.problems, *notes))


def anchor_first(assessment: Assessment, rows: Sequence[ScheduleRow]) -> Assessment:
    """Return an assessment in which the pieces of the first entries of its schedule are anchored and hold.

    Nothing is simulated again: whether a piece is anchored changes no motion and no rocking. Raises SettingsError if
    the schedule has fewer entries.
    """
    wanted = assessment.settings.anchor
    if isinstance(wanted, int) and wanted > len(rows):
        raise SettingsError.about(
            "anchor: first:{wanted:,} is more than the {n:,} entries of the schedule", wanted=wanted, n=len(rows)
        )
    held = {index for row in rows[: wanted if isinstance(wanted, int) else 0] for index in row.item_indices}
    inventory = _anchor(assessment.inventory, held)
    cases, governing = assessment.cases, assessment.governing
    found = find_held(inventory, cases.pfa[governing], find_spread(cases)[governing])
    return replace(assessment, inventory=inventory, held=found)


def _anchor(inventory: Inventory, indices: Collection[int]) -> Inventory:
    items = (
        replace(one, anchored="yes", bracket_capacity=None, more={**one.more, WHAT_IF: True}) if at in indices else one
        for at, one in enumerate(inventory.items)
    )
    return replace(inventory, items=tuple(items))
