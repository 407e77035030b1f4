"""Sums over the buildings of a city, apart by where their pieces come from and by what their numbers rest on.

Surveyed, handover and assumed inventories, and simulated and formula results, are never in one sum: each pair of them
is a `Group`. What falls is summed draw by draw (`assess.portfolio.city_spread`).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal

import pandas as pd

from assess.i18n import Text, fill
from assess.portfolio.city_spread import Spread, build_spread
from assess.portfolio.table_schemas import INVENTORIES, MADE_UP
from assess.results import CANNOT_ROCK
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.settings import Settings

BASES = ("simulated", "formula")
GROUPS = tuple((inventory, basis) for inventory in INVENTORIES for basis in BASES)
"""Inventory and basis of each group, in the order in which they are shown."""
FIRST = 10
"""Buildings, and types of furniture, that are named as those to start with."""
BUILDING_RULE = fill(
    "Ranked by the expected number of people on blocked routes (in whole people), then by expected falls."
)
PEOPLE_RULE = fill(
    "People are counted once for each route that they leave by, as the sheet Routes has them: who takes the route of a "
    "floor and then that of a stair is counted twice."
)
TYPE_RULE = fill("Ranked by expected falls; pieces without a Type are grouped by their size.")
CLASS_COLUMNS = {RiskClass.LOW: "low", RiskClass.MEDIUM: "medium", RiskClass.HIGH: "high",
                 RiskClass.VERY_HIGH: "very_high"}  # fmt: skip
STATE_COLUMNS = {RouteState.OPEN: "routes_open", RouteState.DOUBTFUL: "routes_doubtful",
                 RouteState.BLOCKED: "routes_blocked", RouteState.NOT_KNOWN: "routes_not_known"}  # fmt: skip
BREADTH_STEP, HEIGHT_STEP = 10, 20
"""Widths of the groups of sizes [cm]."""


RangeOver = Literal["earthquakes", "known ground", "own grounds", "motions"]
"""What a range is over: earthquakes like the one of the map; the buildings' own motions on a ground that is taken as
known; earthquakes in which every building has the ground motion of its own workbook; motions without uncertainty."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunGround:
    """The ground motion of the run: its kind, the name and hash of its file, and what a reader has to know of it.

    Facts and cautions are those that hold for all buildings; `is_known` tells that it has no scatter at any of them.
    """

    kind: Literal["shakemap", "scenarios"]
    file: str
    sha256: str
    facts: tuple[tuple[Text, Text], ...] = ()
    cautions: tuple[Text, ...] = ()
    is_known: bool = False


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CityView:
    """The tables of a portfolio with the columns and types of `table_schemas`, and what the run rests on.

    `ground` is None where every workbook has a ground motion of its own.
    """

    buildings: pd.DataFrame
    pieces: pd.DataFrame
    routes: pd.DataFrame
    problems: pd.DataFrame
    draws: pd.DataFrame
    settings: Settings
    ground: RunGround | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstBuilding:
    """A building to start with: pieces in the classes, and the expected number of people whose route is blocked.

    `own_motions` counts its floors that keep motions of their own.
    """

    path: str
    building: str
    in_classes: int
    expected_falls: float
    people_blocked: float
    occupants: int
    people_not_known: int
    routes: int
    routes_blocked: int
    routes_not_known: int
    unconfirmed: int
    by_formula: int
    left_out: int
    own_motions: int


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstType:
    """A type of furniture to start with: pieces in the classes, buildings that have them, and expected falls."""

    label: str | Text
    pieces: int
    buildings: int
    expected_falls: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Buildings whose pieces come from one kind of inventory, and whose numbers rest on one basis.

    Parameters
    ----------
    inventory, basis : str
        One of `GROUPS`.
    buildings, pieces : int
        How many; pieces by quantity.
    by_class : mapping of RiskClass to int
        Free-standing pieces of the basis.
    unconfirmed, by_formula, anchored : int
        Pieces outside the classes.
    left_out : int
        Components of handover files that may be furniture and were left out: in no number.
    range_over : str
        What differs from draw to draw, one of `RangeOver`: not every range is one over earthquakes.
    cannot_rock : int
        Pieces that are low as they cannot rock.
    falls : Spread
        Number of pieces that fall, of those in the classes.
    falls_low_inventory, falls_high_inventory : float, optional
        Expected falls with all 10 % and all 90 % quantities of assumed inventories, as if all buildings had few or
        many pieces together; None for others.
    falls_avoided : float
        Expected falls that the work lists avoid.
    people : Spread
        Number of people whose route is blocked, by `PEOPLE_RULE`.
    occupants, people_not_known : int
        People on all routes, and those on routes whose state is not known, who are in no other number.
    routes : mapping of RouteState to int
        Routes by state.
    works, works_without_cost : int
        Pieces on work lists, and those of which no cost is known.
    cost : float, optional
        Sum of the known costs; None where there are none.
    unplaced : int
        Buildings without latitude and longitude: their draws are fully correlated with one another.
    own_motions : int
        Buildings of which floors keep a record or a PFA of their own: these are not of this earthquake.
    own_motion_falls : float
        Expected falls in those buildings; they are part of `falls`.
    warnings : int
        Warnings on their workbooks.
    first_buildings, first_types
        What to start with, by `BUILDING_RULE` and `TYPE_RULE`.
    """

    inventory: str
    basis: str
    buildings: int
    pieces: int
    by_class: Mapping[RiskClass, int]
    unconfirmed: int
    by_formula: int
    anchored: int
    left_out: int
    range_over: RangeOver
    cannot_rock: int
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
    own_motion_falls: float
    warnings: int
    first_buildings: tuple[FirstBuilding, ...]
    first_types: tuple[FirstType, ...]

    @property
    def counted(self) -> int:
        """Pieces in the classes."""
        return sum(self.by_class.values())

    @property
    def people_known(self) -> int:
        """People on routes whose state is known: those that the expected number is out of."""
        return self.occupants - self.people_not_known


@dataclass(frozen=True, slots=True, kw_only=True)
class CityTotals:
    """Sums over a city: its groups that have buildings, how many were skipped, and what holds buildings together."""

    groups: tuple[Group, ...]
    skipped: int

    @property
    def assessed(self) -> int:
        """Buildings that were assessed."""
        return sum(one.buildings for one in self.groups)


def is_made_up(view: CityView) -> bool:
    """Tell whether all assessed buildings with a name are made up, as those of the worked city are."""
    names = view.buildings[view.buildings["status"] == "assessed"]["building"].dropna()
    return not names.empty and all(str(name).endswith(MADE_UP) for name in names)


def build_totals(view: CityView) -> CityTotals:
    """Return the sums over the buildings of a city.

    Raises
    ------
    ValueError
        If the table draws does not hold the same draws for all buildings of a group.
    """
    rows = view.buildings
    assessed = rows[rows["status"] == "assessed"]
    groups = []
    for inventory, basis in GROUPS:
        own = assessed[(assessed["inventory"] == inventory) & (assessed["basis"] == basis)]
        if not own.empty:
            groups.append(_build_group(view, own, inventory, basis))
    return CityTotals(groups=tuple(groups), skipped=int((rows["status"] == "skipped").sum()))


_ADDED = ("unconfirmed", "by_formula", "cannot_rock", "anchored", "left_out", "works", "works_without_cost", "warnings")
"""Fields of a group that are plain sums of a column of the same name."""


def _build_group(view: CityView, rows: pd.DataFrame, inventory: str, basis: str) -> Group:
    draws = _rows_of(view.draws, rows)
    routes = _rows_of(view.routes, rows)
    unknown = (routes["state"] == RouteState.NOT_KNOWN.value) | routes["probability"].isna()
    not_known = _count(routes[unknown], "occupants")
    by_class = {risk: _count(rows, column) for risk, column in CLASS_COLUMNS.items()}
    falls = build_spread(draws, "falls", _sum(rows, "expected_falls"), sum(by_class.values()))
    own, occupants = rows[_numbers(rows, "own_motions") > 0], _count(rows, "occupants")
    return Group(
        inventory=inventory,
        basis=basis,
        buildings=len(rows),
        pieces=_count(rows, "pieces"),
        by_class=by_class,
        range_over=_find_range(view),
        falls=replace(falls, apart=0.0)
        if falls.draws
        else falls,  # pieces alike have one chance, and draws of their own
        falls_low_inventory=_sum_known(rows, "falls_low_inventory"),
        falls_high_inventory=_sum_known(rows, "falls_high_inventory"),
        falls_avoided=_sum(rows, "falls_avoided"),
        people=build_spread(draws, "people_blocked", _sum(rows, "people_blocked"), occupants - not_known),
        occupants=occupants,
        people_not_known=not_known,
        routes={state: _count(rows, column) for state, column in STATE_COLUMNS.items()},
        cost=_sum_known(rows, "cost"),
        unplaced=int((~_flags(rows, "is_placed")).sum()),
        own_motions=len(own),
        own_motion_falls=_sum(own, "expected_falls"),
        first_buildings=tuple(_list_buildings(rows)),
        first_types=tuple(_list_types(_rows_of(view.pieces, rows), basis)),
        **{name: _count(rows, name) for name in _ADDED},
    )


def _find_range(view: CityView) -> RangeOver:
    if view.settings.ideal:
        return "motions"
    if view.ground is None:
        return "own grounds"
    return "known ground" if view.ground.is_known else "earthquakes"


def _rows_of(table: pd.DataFrame, buildings: pd.DataFrame) -> pd.DataFrame:
    return table[table["path"].isin(buildings["path"])]


def _numbers(rows: pd.DataFrame, column: str) -> "pd.Series[float]":
    """Return a column as numbers, 0 where nothing is known."""
    return pd.to_numeric(rows[column]).astype("Float64").fillna(0.0).astype("float64")


def _flags(rows: pd.DataFrame, column: str) -> "pd.Series[bool]":
    return rows[column].astype("boolean").fillna(False).astype("bool")


def _sum(rows: pd.DataFrame, column: str) -> float:
    return float(_numbers(rows, column).sum())


def _sum_known(rows: pd.DataFrame, column: str) -> float | None:
    """Return the sum of what is known; None where nothing is."""
    return _sum(rows, column) if rows[column].notna().any() else None


def _count(rows: pd.DataFrame, column: str) -> int:
    return round(_sum(rows, column))


def _text(value: object) -> str:
    return "" if pd.isna(value) else str(value)  # type: ignore[call-overload]


# ---------------------------------------------------------------- what to start with


_COUNTED = ("occupants", "people_not_known", "routes", "routes_blocked", "routes_not_known", "unconfirmed",
            "by_formula", "left_out", "own_motions")  # fmt: skip


def _list_buildings(rows: pd.DataFrame) -> Iterator[FirstBuilding]:
    """Yield the buildings to start with, by `BUILDING_RULE`; those of which nothing is expected are left out."""
    people, falls = _numbers(rows, "people_blocked"), _numbers(rows, "expected_falls")
    order = pd.DataFrame({"people": -people.round(), "falls": -falls.round(6), "path": rows["path"]})
    wanted = order[(people > 0) | (falls > 0)].sort_values(["people", "falls", "path"], kind="stable").index[:FIRST]
    for at in wanted:
        row = rows.loc[[at]]
        yield FirstBuilding(
            path=_text(row["path"].iloc[0]),
            building=_text(row["building"].iloc[0]),
            in_classes=sum(_count(row, risk.word.replace(" ", "_")) for risk in RiskClass),
            expected_falls=_sum(row, "expected_falls"),
            people_blocked=_sum(row, "people_blocked"),
            **{name: _count(row, name) for name in _COUNTED},
        )


def _list_types(pieces: pd.DataFrame, basis: str) -> Iterator[FirstType]:
    """Yield the types to start with, by `TYPE_RULE`, of pieces in the classes; those that never fall are left out."""
    counted = pieces[pieces["basis"].isin([basis, CANNOT_ROCK]) & ~_flags(pieces, "is_held")]
    quantity, probability = _numbers(counted, "quantity"), _numbers(counted, "probability")
    kinds = [
        _name_type(_text(name), breadth, height)
        for name, breadth, height in zip(
            counted["type"], _numbers(counted, "breadth_cm"), _numbers(counted, "height_cm"), strict=True
        )
    ]
    keyed = pd.DataFrame(
        {"key": [one[0] for one in kinds], "path": counted["path"].to_numpy(), "quantity": quantity.to_numpy(),
         "falls": (quantity * probability).to_numpy()}
    )  # fmt: skip
    labels = dict(reversed(kinds))  # the first spelling of a type is shown
    sums = keyed.groupby("key").agg(quantity=("quantity", "sum"), falls=("falls", "sum"), buildings=("path", "nunique"))
    order = sums.assign(order=-sums["falls"].round(6)).reset_index().sort_values(["order", "key"], kind="stable")
    for row in order[order["falls"] > 0].head(FIRST).itertuples():
        yield FirstType(
            label=labels[str(row.key)],
            pieces=round(float(row.quantity)),  # type: ignore[arg-type]
            buildings=int(row.buildings),  # type: ignore[arg-type]
            expected_falls=float(row.falls),  # type: ignore[arg-type]
        )


def _name_type(name: str, breadth: float, height: float) -> tuple[str, str | Text]:
    """Return what a type is sorted by, and its name; without one its size group."""
    if name.strip():
        return " ".join(name.casefold().split()), name
    b, h = (int(size // step * step) for size, step in ((breadth, BREADTH_STEP), (height, HEIGHT_STEP)))
    label = fill(
        "no Type: Breadth {b} to {b_end} cm, Height {h} to {h_end} cm",
        b=b, b_end=b + BREADTH_STEP, h=h, h_end=h + HEIGHT_STEP,
    )  # fmt: skip
    return f"\uffff{b:06d} {h:06d}", label
