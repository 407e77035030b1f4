"""A city: the tables of a portfolio, its rows in the order of the ranking, and its sums.

Buildings are summed apart by where their pieces come from and by what their numbers rest on: surveyed, handover and
assumed inventories, and simulated and formula results, are never in one sum. Each pair of them is a `Group`.

Draw k is one earthquake for all buildings, so that what falls is added draw by draw before anything is said of the sum.
What the sum would spread if buildings were independent of each other is found by shuffling the draws of each: it shows
how much too narrow a range is that ignores the earthquake they share.
"""

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np
import pandas as pd

from assess.arrays import FloatArray
from assess.i18n import Text, fill
from assess.portfolio.table_schemas import CLASS_COLUMNS, INVENTORIES, MADE_UP, STATE_COLUMNS
from assess.results import CANNOT_ROCK
from assess.risk import NORMAL_95, RiskClass, find_ends, wilson_interval
from assess.rocking.draws import name_number
from assess.route_results import RouteState
from assess.settings import Settings

FEW = 10  # draws with anything in them below which the normal distribution of a mean is not relied on


@dataclass(frozen=True, slots=True)
class Spread:
    """A sum over buildings; where nothing was drawn there are no draws and no ranges.

    `apart` is the part of what is expected that is in no draw, of formulas and of routes without joint outcomes: the
    ranges leave it out. `low` and `high` are what 5 and 95 % of the draws do not exceed, `independent` ones if
    buildings were independent of each other, which they are not. `sampling`: 95 % interval of the expected value
    without `apart`.
    """

    expected: float
    apart: float
    draws: int = 0
    low: float | None = None
    high: float | None = None
    sampling_low: float | None = None
    sampling_high: float | None = None
    independent_low: float | None = None
    independent_high: float | None = None


def build_spread(draws: pd.DataFrame, column: str, expected: float, most: float) -> Spread:
    """Return the spread of a column of the table draws, summed over the buildings in it.

    `expected` is that of all buildings, those without draws too; `most` is what the sum cannot exceed: all pieces, or
    all people. Raises ValueError if a building lacks draws that another one has.
    """
    if draws.empty:
        return Spread(expected=expected, apart=expected)
    ordered = draws.sort_values(["path", "draw"], kind="stable")
    paths, firsts = np.unique(ordered["path"].to_numpy(dtype=str), return_index=True)
    values = ordered[column].to_numpy(dtype=np.float64)
    runs = values.size // paths.size
    numbers = ordered["draw"].to_numpy(dtype=np.int64).reshape(-1, runs) if values.size % paths.size == 0 else None
    if numbers is None or (firsts != runs * np.arange(paths.size)).any() or (numbers != numbers[0]).any():
        raise ValueError("the table draws does not hold the same draws for all buildings")
    every = values.reshape(-1, runs)
    total = every.sum(axis=0)
    shuffled = np.zeros(runs)  # the draws of each building in an order of its own
    for path, own in zip(paths.tolist(), every, strict=True):
        shuffled += np.random.default_rng(name_number(path)).permutation(own)
    apart = expected - float(total.mean())
    ends = (*find_ends(total), *find_sampling(total, most), *find_ends(shuffled))
    is_rounding = abs(apart) <= 1e-9 * max(1.0, abs(expected))
    return Spread(expected, 0.0 if is_rounding else apart, runs, *ends)


def find_sampling(total: FloatArray, most: float) -> tuple[float, float]:
    """Return the 95 % interval of the mean of a sum by its number of draws.

    Normal; where fewer than 10 draws hold anything, Wilson's of the share of such draws, times the largest sum seen: of
    none at all, times `most`, as whatever falls in a draw that was not made could be everything.
    """
    mean, runs = float(total.mean()), total.size
    half = NORMAL_95 * float(total.std(ddof=1)) / math.sqrt(runs) if runs > 1 else 0.0
    low, high = max(0.0, mean - half), mean + half
    held = int((total > 0).sum())
    if held < FEW:
        _, share = wilson_interval(held, runs, NORMAL_95)
        low, high = 0.0, max(high, float(share) * (float(total.max()) if held else most))
    return low, min(high, max(most, mean))


BASES = ("simulated", "formula")
GROUPS = tuple((inventory, basis) for inventory in INVENTORIES for basis in BASES)
"""Inventory and basis of each group, in the order in which they are shown."""
FIRST = 10  # buildings, and types of furniture, that are named as those to start with
BUILDING_RULE = fill(
    "Ranked by the expected number of people on blocked routes (in whole people), then by expected falls."
)
PEOPLE_RULE = fill(
    "People are counted once for each route that they leave by, as the sheet Routes has them: who takes the route of a "
    "floor and then that of a stair is counted twice."
)
TYPE_RULE = fill("Ranked by expected falls; pieces without a Type are grouped by their size.")
BREADTH_STEP, HEIGHT_STEP = 10, 20  # widths of the groups of sizes [cm]

Row = Mapping[str, Any]  # one row of a table: values by column, None for what is not known
_MOTIONS = fill(
    "In nine of ten motions like the given ones, without the uncertainty of the earthquake: between {low} and {high}.",
    low="", high="",
)  # fmt: skip
_OWN_GROUNDS = fill(
    "In nine of ten draws, as if the ground motions of all workbooks were of one earthquake: between {low} and {high}.",
    low="", high="",
)  # fmt: skip
_KNOWN_GROUND = fill(
    "In nine of ten draws, with the motion of the ground taken as known: between {low} and {high}.", low="", high=""
)
_EARTHQUAKES = fill("In nine of ten earthquakes like this one between {low} and {high}.", low="", high="")


@dataclass(frozen=True, slots=True, kw_only=True)
class RunGround:
    """The ground motion of the run, with what holds for all buildings; `is_known`: it has no scatter at any of them."""

    kind: Literal["shakemap", "scenarios"]
    file: str
    sha256: str
    facts: tuple[tuple[Text, Text], ...] = ()
    cautions: tuple[Text, ...] = ()
    is_known: bool = False


class FirstType(NamedTuple):
    """A type of furniture to start with: pieces in the classes, buildings that have them, and expected falls."""

    label: str | Text
    pieces: int
    buildings: int
    expected_falls: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Buildings whose pieces come from one kind of inventory, and whose numbers rest on one basis.

    Numbers with the name of a column of the table buildings are the sums of that column; a cost is None where none is
    known. `by_class` counts free-standing pieces of the basis; `range_over` says what a range is over. `falls` and
    `people` are those of pieces in the classes, and of routes whose state is known. `falls_low_inventory` and
    `falls_high_inventory` are expected with all 10 % and all 90 % quantities of assumed inventories. `unplaced` counts
    buildings without latitude and longitude, whose draws are fully correlated; `own_motions` those of which floors keep
    a record or a PFA of their own, not of this earthquake. What to start with is without what is never expected to
    fail.
    """

    inventory: str
    basis: str
    buildings: int
    pieces: int
    by_class: Mapping[RiskClass, int]
    unconfirmed: int
    by_formula: int
    rolls: int
    anchored: int
    left_out: int
    cannot_rock: int
    range_over: Text
    falls: Spread
    falls_low_inventory: float | None
    falls_high_inventory: float | None
    falls_avoided: float
    people: Spread
    occupants: int
    people_not_known: int
    routes: Mapping[RouteState, int]
    works: int
    works_without_cost: int
    cost: float | None
    unplaced: int
    own_motions: int
    first_buildings: tuple[Row, ...]
    first_types: tuple[FirstType, ...]

    @property
    def counted(self) -> int:
        """Pieces in the classes."""
        return sum(self.by_class.values())

    @property
    def people_known(self) -> int:
        """People on routes whose state is known: those that the expected number is out of."""
        return self.occupants - self.people_not_known


@dataclass(frozen=True, eq=False, kw_only=True)
class City:
    """The tables of a portfolio, and what the run rests on; `ground` is None where each workbook has its own motion."""

    buildings: pd.DataFrame
    pieces: pd.DataFrame
    routes: pd.DataFrame
    problems: pd.DataFrame
    draws: pd.DataFrame
    settings: Settings
    ground: RunGround | None = None

    @cached_property
    def ranked(self) -> list[Row]:
        """The buildings in the order of `BUILDING_RULE`, over all groups; skipped ones come last, by path."""

        def rank(row: Row) -> tuple[Any, ...]:
            people, falls = row["people_blocked"] or 0.0, row["expected_falls"] or 0.0
            return row["status"] != "assessed", -round(people), -round(falls, 6), row["path"]

        return sorted(list_records(self.buildings), key=rank)

    @property
    def skipped(self) -> list[Row]:
        """The buildings that could not be assessed, by path."""
        return [row for row in self.ranked if row["status"] != "assessed"]

    @property
    def is_made_up(self) -> bool:
        """Whether all assessed buildings with a name are made up, as those of the worked city are."""
        names = [row["building"] for row in self.ranked if row["status"] == "assessed" and row["building"]]
        return bool(names) and all(name.endswith(MADE_UP) for name in names)

    @cached_property
    def pieces_of(self) -> Mapping[str, list[Row]]:
        """Rows of the table pieces by the path of their building."""
        return _group(self.pieces)

    @cached_property
    def routes_of(self) -> Mapping[str, list[Row]]:
        """Rows of the table routes likewise."""
        return _group(self.routes)

    @cached_property
    def problems_of(self) -> Mapping[str, list[Row]]:
        """Rows of the table problems likewise."""
        return _group(self.problems)

    @cached_property
    def groups(self) -> tuple[Group, ...]:
        """The sums over the buildings that were assessed, in the order of `GROUPS`.

        Raises ValueError if the table draws does not hold the same draws for all buildings of a group.
        """
        assessed = [row for row in self.ranked if row["status"] == "assessed"]
        own = {pair: [row for row in assessed if (row["inventory"], row["basis"]) == pair] for pair in GROUPS}
        return tuple(self._build_group(rows, *pair) for pair, rows in own.items() if rows)

    def _build_group(self, rows: list[Row], inventory: str, basis: str) -> Group:
        paths = [row["path"] for row in rows]
        draws, pieces = (table[table["path"].isin(paths)] for table in (self.draws, self.pieces))

        def add(column: str) -> float:
            return math.fsum(row[column] or 0.0 for row in rows)

        def add_known(column: str) -> float | None:
            return add(column) if any(row[column] is not None for row in rows) else None

        by_class = {risk: round(add(column)) for risk, column in CLASS_COLUMNS.items()}
        falls = build_spread(draws, "falls", add("expected_falls"), sum(by_class.values()))
        if falls.draws:
            falls = replace(falls, apart=0.0)  # pieces alike have one chance, and draws of their own
        known = round(add("occupants") - add("people_not_known"))
        if self.settings.ideal:
            range_over = _MOTIONS
        elif self.ground is None:
            range_over = _OWN_GROUNDS
        else:
            range_over = _KNOWN_GROUND if self.ground.is_known else _EARTHQUAKES
        return Group(
            inventory=inventory, basis=basis, buildings=len(rows), by_class=by_class, range_over=range_over,
            falls=falls, falls_low_inventory=add_known("falls_low_inventory"),
            falls_high_inventory=add_known("falls_high_inventory"),
            falls_avoided=add("falls_avoided"),
            people=build_spread(draws, "people_blocked", add("people_blocked"), known),
            routes={state: round(add(column)) for state, column in STATE_COLUMNS.items()},
            cost=add_known("cost"), unplaced=sum(not row["is_placed"] for row in rows),
            own_motions=sum(bool(row["own_motions"]) for row in rows),
            first_buildings=tuple([row for row in rows if row["people_blocked"] or row["expected_falls"]][:FIRST]),
            first_types=_list_types(pieces, basis),
            **{name: round(add(name)) for name in _ADDED},
        )  # fmt: skip

    def name_building(self, row: Row) -> str:
        """Return the name of a building, its path where it has none, and both where others have the same name."""
        name, path = str(row["building"] or row["path"]), row["path"]
        return name if self._names[name] < 2 or name == path else f"{name} ({path})"

    @cached_property
    def _names(self) -> Mapping[str, int]:
        return Counter(str(row["building"] or row["path"]) for row in self.ranked)

    def spell_use(self, row: Row) -> str:
        """Return the use of a building as the first building with it spells it: letter case makes no other use."""
        use = str(row["use"] or "").strip()
        return self._uses.get(use.casefold(), use)

    @cached_property
    def _uses(self) -> Mapping[str, str]:
        uses = [str(use).strip() for use in self.buildings["use"].dropna()]
        return {use.casefold(): use for use in reversed(uses)}


def list_records(frame: pd.DataFrame) -> list[Row]:
    """Return the rows of a table as mappings, None for what is not known."""
    names = [str(name) for name in frame.columns]
    columns = [frame[name].astype(object).where(frame[name].notna(), None).tolist() for name in names]
    return [dict(zip(names, values, strict=True)) for values in zip(*columns, strict=True)]


def _group(frame: pd.DataFrame) -> dict[str, list[Row]]:
    found: dict[str, list[Row]] = {}
    for row in list_records(frame):
        found.setdefault(row["path"], []).append(row)
    return found


_ADDED = (
    "pieces", "unconfirmed", "by_formula", "rolls", "cannot_rock", "anchored", "left_out", "works",
    "works_without_cost", "occupants", "people_not_known",
)  # fmt: skip
"""Fields of a group that are plain sums of a column of the same name."""


def _numbers(rows: pd.DataFrame, column: str) -> "pd.Series[float]":
    """Return a column as numbers, 0 where nothing is known."""
    return pd.to_numeric(rows[column]).astype("Float64").fillna(0.0).astype("float64")


def _list_types(pieces: pd.DataFrame, basis: str) -> tuple[FirstType, ...]:
    """Return the types to start with, by `TYPE_RULE`, of pieces in the classes; those that never fall are left out."""
    counted = pieces[pieces["basis"].isin([basis, CANNOT_ROCK]) & ~pieces["is_held"].astype("boolean").fillna(False)]
    names = counted["type"].astype(object).where(counted["type"].notna(), "")
    quantity = _numbers(counted, "quantity")
    keys: list[str] = []
    labels: dict[str, str | Text] = {}
    for name, *sizes in zip(names, _numbers(counted, "breadth_cm"), _numbers(counted, "height_cm"), strict=True):
        label: str | Text = name
        sorted_by = " ".join(name.casefold().split())
        if not sorted_by:
            b, h = (int(size // step * step) for size, step in zip(sizes, (BREADTH_STEP, HEIGHT_STEP), strict=True))
            label = fill("no Type: Breadth {b} to {b_end} cm, Height {h} to {h_end} cm",
                         b=b, b_end=b + BREADTH_STEP, h=h, h_end=h + HEIGHT_STEP)  # fmt: skip
            sorted_by = f"\uffff{b:06d} {h:06d}"
        keys.append(sorted_by)
        labels.setdefault(sorted_by, label)  # the first spelling of a type is shown
    sums = (
        counted.assign(key=keys, n=quantity, falls=quantity * _numbers(counted, "probability"))
        .groupby("key")
        .agg(pieces=("n", "sum"), buildings=("path", "nunique"), falls=("falls", "sum"))
    )
    rows = [(key, *row) for key, row in zip(sums.index, sums.to_numpy().tolist(), strict=True)]
    rows.sort(key=lambda one: (-round(one[3], 6), one[0]))
    first = [one for one in rows if one[3] > 0][:FIRST]
    return tuple(FirstType(labels[key], round(n), int(count), falls) for key, n, count, falls in first)
