"""The paper's 50 monitored buildings, floor by floor, on the PGA of their base: their records are not published."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from assess.intensity import RATIO
from assess.motion.assumed import UNKNOWN, estimate_period
from assess.motion.floor_medians import find_medians
from assess.risk import LIMITS, RiskClass, classify
from assess.studies.studied_methods import CRITERIA, FORMULAS, METHODS, Cases, FloatArray, evaluate_formulas
from assess.studies.study import Options, read_facts
from assess.units import GRAVITY, LENGTH

SHOWN = {key: one for key, one in METHODS.items() if key in FORMULAS or key in CRITERIA}
"""The formulas and criteria of the tables, in the order of reports."""
METHOD_COLUMNS = tuple(name for key in SHOWN for name in (key, f"{key}_class"))
"""Columns of a .csv: the value of each method, and its class or, for a criterion, its outcome in words."""
DIRECTIONS = ("transverse", "longitudinal")


@dataclass(frozen=True, slots=True, kw_only=True)
class Station:
    """One line of the paper's Table 1.

    * `number`, `name`, `earthquake`: as printed.
    * `storeys`: above the ground.
    * `height`: of the building [m].
    * `pga`: at the base, by direction [m/s2]; empty where it is not printed.
    """

    number: str
    name: str
    earthquake: str
    storeys: int
    height: float
    pga: Mapping[str, float]

    @property
    def period(self) -> float:
        """T1 as estimated from the height [s]."""
        return estimate_period(self.height) or 0.0


def read_stations() -> list[Station]:
    """Return the 50 lines of Table 1."""
    return [
        Station(
            number=row["id"], name=row["station"], earthquake=row["earthquake"], storeys=int(row["storeys"]),
            height=float(row["height_in"]) * LENGTH["in"],
            pga={one: float(row[f"pga_{one}_g"]) * GRAVITY for one in DIRECTIONS if row[f"pga_{one}_g"]},
        )
        for row in read_facts("table1_buildings")
    ]  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """One floor of a building in one direction, with z/h [-] and its median peaks [m/s2], [m/s].

    `number` is that of the paper's Table 2: 1 is the ground, the number of storeys plus one the roof.
    """

    station: Station
    direction: str
    number: int
    place: float
    pfa: float
    pfv: float

    @property
    def is_roof(self) -> bool:
        """Whether it is the roof."""
        return self.number == self.station.storeys + 1


def climb(station: Station, period: float) -> Iterator[Level]:
    """Yield every floor of a building with T1 [s] in both directions; storeys are assumed to be of one height."""
    for direction, pga in station.pga.items():
        for number in range(1, station.storeys + 2):
            place = (number - 1) / station.storeys
            by_pga, by_pgv = find_medians(period, place, UNKNOWN, RATIO)
            yield Level(station, direction, number, place, pga * by_pga, pga * RATIO * by_pgv)


@dataclass(frozen=True, slots=True, eq=False)
class Climbed:
    """Values (n,) of the formulas and criteria for a piece on every floor, by key, in the order of `levels`."""

    levels: Sequence[Level]
    values: Mapping[str, FloatArray]

    def find_worst(self, key: str) -> dict[str, float]:
        """Return the value [-] at the roof in the worse direction, by building; NaN: unknown."""
        found: dict[str, float] = {}
        for level, value in zip(self.levels, self.values[key].tolist(), strict=True):
            if level.is_roof:
                number = level.station.number
                found[number] = float(np.fmax(found.get(number, math.nan), value))
        return found


def climb_all(stations: Sequence[Station], periods: Sequence[float], options: Options) -> Climbed:
    """Evaluate the piece of the options on every floor of buildings with the given T1 [s]."""
    levels = [level for one, period in zip(stations, periods, strict=True) for level in climb(one, period)]
    cases = Cases.of(
        breadth=options.breadth,
        height=options.height,
        pfa=[level.pfa for level in levels],
        pfv=[level.pfv for level in levels],
    )
    return Climbed(levels, evaluate_formulas(cases, options.settings))


def method_cells(values: Mapping[str, FloatArray], at: int) -> list[object]:
    """Return the cells of case `at` for `METHOD_COLUMNS`; "" where a method was not evaluated."""
    cells: list[object] = []
    for key, method in SHOWN.items():
        value = float(values[key][at])
        risk = classify(value)
        words = method.words[0 if value else 1] if method.kind == "criterion" else "" if risk is None else risk.word
        cells += ["", ""] if math.isnan(value) else [value, words]
    return cells


# ---------------------------------------------------------------- the figure


def paint_climbed(climbed: Climbed, names: Mapping[str, str], figure: Any) -> None:
    """Paint the risk by each formula (its key and name) over the buildings: every floor, and the roofs."""
    panels = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (key, name) in zip(panels, names.items(), strict=True):
        axes.plot(*_dashes(climbed, key), linewidth=1, color="#8fb3cc", label="every floor, both directions")
        roofs = {int(number): value for number, value in climbed.find_worst(key).items()}
        axes.plot(list(roofs), list(roofs.values()), "D", ms=3, color="#8c1d3f", label="roof, worse direction")
        for limit in LIMITS:
            axes.axhline(limit, color="#444444", linewidth=0.6, linestyle="--")
        axes.set_yscale("function", functions=(_root, np.square))
        axes.set_ylim(0, 1)
        axes.set_yticks([0, *LIMITS, 1], [f"{tick:g}" for tick in (0, *LIMITS, 1)])
        axes.set_title(name, loc="left", fontsize=8)
        axes.tick_params(labelsize=6)
        edges = np.sqrt([0, *LIMITS, 1])
        for risk, middle in zip(RiskClass, (edges[1:] + edges[:-1]) / 2, strict=True):
            axes.text(1.01, middle, risk.label, transform=axes.transAxes, fontsize=6, va="center")
    panels[-1].set_xlim(0, 51)
    panels[-1].set_xticks([1, *range(5, 51, 5)], [f"{number:03d}" for number in (1, *range(5, 51, 5))])
    panels[-1].set_xlabel("building (ID of Table 1)", fontsize=7)
    figure.supylabel("risk R (square-root scale)", fontsize=7)
    panels[0].legend(fontsize=6, framealpha=1, edgecolor="none", loc="upper right")


def _dashes(climbed: Climbed, key: str) -> tuple[FloatArray, FloatArray]:
    every = zip(climbed.levels, climbed.values[key].tolist(), strict=True)
    dashes = sorted({(int(one.station.number), round(value, 3)) for one, value in every if value == value})
    points = np.array([((at - 0.3, risk), (at + 0.3, risk), (at, np.nan)) for at, risk in dashes]).reshape(-1, 2)
    return points[:, 0], points[:, 1]


def _root(values: Any) -> Any:
    return np.sqrt(np.maximum(values, 0))
