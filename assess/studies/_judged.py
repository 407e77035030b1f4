"""What the blocks did under the motions of every channel, with what the formulas say of them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import BoolArray, FloatArray
from assess.studies._agreement import Agreement, find_agreement
from assess.studies._buildings import Building, Channel, all_buildings
from assess.studies._formulas import evaluate_formulas
from assess.studies._study import Options
from assess.studies._trials import LEVELS, Trials, rock_building
from assess.units import GRAVITY

TOGETHER = (0.3, 0.5, 0.7)
"""PFA of the strongest channel of a floor [g] at which the channels of the floor are held against each other."""
RECORDED, FIRST_TOGETHER = len(LEVELS), len(LEVELS) + 1
"""Place of the recorded PFA among the values of a channel, after the common ones, and of the first of `TOGETHER`."""


@dataclass(frozen=True, slots=True, eq=False)
class Judged:
    """The trials of a channel with what the formulas say, by key: (a, b) each."""

    building: Building
    trials: Trials
    formulas: Mapping[str, FloatArray]

    @property
    def factors(self) -> FloatArray:
        """By how much the record is scaled at each PFA [-], (a,)."""
        return np.asarray(self.trials.pfa / self.trials.channel.read().pfa)

    @property
    def ratio(self) -> float:
        """PFV/PFA of the record [s]: the slower the motion, the larger."""
        return float(self.trials.pfv[0] / self.trials.pfa[0])


Chosen = Callable[[Judged], BoolArray]
"""Chooses cases of a channel: (a, b)."""


def every_case(one: Judged) -> BoolArray:
    """Choose all of them at the common values of PFA."""
    return _choose_rows(one, slice(0, len(LEVELS)))


def as_recorded(one: Judged) -> BoolArray:
    """Choose those under the record as it is."""
    return _choose_rows(one, RECORDED)


def _choose_rows(one: Judged, rows: int | slice) -> BoolArray:
    chosen = np.zeros(one.trials.fallen.shape, dtype=np.bool_)
    chosen[rows] = True
    return chosen


def judge(building: Building, trials: Trials, options: Options) -> Judged:
    """Return trials with what the formulas say of them."""
    said = evaluate_formulas(trials.cases, options.settings)
    return Judged(building, trials, {key: values.reshape(trials.fallen.shape) for key, values in said.items()})


@lru_cache(maxsize=1)
def rock_all(options: Options) -> tuple[Judged, ...]:
    """Rock the blocks in all buildings; the same for every study that asks for it."""
    return tuple(
        judge(building, trials, options)
        for building in all_buildings()
        for trials in rock_building(building, find_levels(building), options)
    )


def find_levels(building: Building) -> dict[Channel, list[float]]:
    """Return the values of PFA of each channel [g]: `LEVELS`, its own as recorded, and those of `TOGETHER`.

    For the latter all channels of a floor are scaled by the factor that gives the strongest of them such a PFA.
    """
    found = {}
    for channel in building.channels:
        own = channel.read().pfa
        strongest = max(one.read().pfa for one in building.channels if one.level == channel.level)
        found[channel] = [*LEVELS, own / GRAVITY, *(own / strongest * value for value in TOGETHER)]
    return found


def pool(judged: Sequence[Judged], key: str, chosen: Chosen = every_case) -> tuple[FloatArray, NDArray[np.int64]]:
    """Return chances by a formula, and under how many motions the block fell, of the chosen cases, (n,) each."""
    said = [one.formulas[key][chosen(one)] for one in judged]
    return np.concatenate(said), np.concatenate([one.trials.fallen[chosen(one)] for one in judged])


def agree(judged: Sequence[Judged], key: str, chosen: Chosen = every_case) -> Agreement:
    """Return how a formula agrees with integration on some channels."""
    return find_agreement(*pool(judged, key, chosen), judged[0].trials.runs)


def by_building(judged: Sequence[Judged]) -> dict[str, list[Judged]]:
    """Return the channels of each building, by its name."""
    found: dict[str, list[Judged]] = {}
    for one in judged:
        found.setdefault(one.building.name, []).append(one)
    return found
