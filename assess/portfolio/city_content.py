"""What the outputs of a city share: its sums, its buildings in the order of their ranking, their places on the map."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from assess.portfolio.building_signs import (
    BY_CLASS,
    BY_ROUTES,
    BY_SHARE,
    Row,
    Sign,
    list_records,
    sign_of_class,
    sign_of_routes,
    sign_of_share,
)
from assess.portfolio.city_map import MapPoint
from assess.portfolio.city_totals import CityTotals, CityView, build_totals

LARGE = ((10.0, 1.6), (3.0, 1.25))
"""Expected falls from which a mark is larger, and by how much."""


@dataclass(frozen=True, eq=False)
class CityContent:
    """The tables of a city and its sums; rows are mappings, in the order of the ranking."""

    view: CityView
    totals: CityTotals

    @cached_property
    def buildings(self) -> list[Row]:
        """The buildings in the order in which they are to be looked at.

        It is the rule of `city_totals.BUILDING_RULE`, over all groups; skipped ones come last.
        """
        return sorted(list_records(self.view.buildings), key=_rank)

    @cached_property
    def skipped(self) -> list[Row]:
        """The buildings that could not be assessed, by path."""
        return [row for row in self.buildings if row["status"] != "assessed"]

    @cached_property
    def pieces(self) -> Mapping[str, list[Row]]:
        """Pieces by the path of their building."""
        return _group(list_records(self.view.pieces))

    @cached_property
    def routes(self) -> Mapping[str, list[Row]]:
        """Routes likewise."""
        return _group(list_records(self.view.routes))

    @cached_property
    def problems(self) -> Mapping[str, list[Row]]:
        """Problems likewise."""
        return _group(list_records(self.view.problems))

    def name_building(self, building: str | None, path: str) -> str:
        """Return the name of a building, its path where it has none, and both where others have the same name."""
        name = str(building or path)
        return name if self._names[name] < 2 or name == path else f"{name} ({path})"

    @cached_property
    def _names(self) -> Mapping[str, int]:
        return Counter(str(row["building"] or row["path"]) for row in self.buildings)

    def spell_use(self, row: Row) -> str:
        """Return the use of a building as the first building with it spells it: letter case makes no other use."""
        use = str(row["use"] or "").strip()
        return self._uses.get(use.casefold(), use)

    @cached_property
    def _uses(self) -> Mapping[str, str]:
        found: dict[str, str] = {}
        for row in list_records(self.view.buildings):
            use = str(row["use"] or "").strip()
            found.setdefault(use.casefold(), use)
        return found

    @cached_property
    def points(self) -> list[MapPoint]:
        """The buildings that have a place, with their signs by the share that is expected to fall."""
        placed = [
            (at, row)
            for at, row in enumerate(self.buildings)
            if row["latitude"] is not None and row["longitude"] is not None
        ]
        return [MapPoint(at, self.name_building(row["building"], row["path"]), row["latitude"], row["longitude"],
                         sign_of_share(row), _find_size(row)) for at, row in placed]  # fmt: skip

    @cached_property
    def share_legend(self) -> list[tuple[Sign, int]]:
        """The signs by share that are in use, the worst first, with the number of buildings."""
        return _count_signs([sign_of_share(row) for row in self.buildings], BY_SHARE)

    @cached_property
    def class_legend(self) -> list[tuple[Sign, int]]:
        """The signs by class that are in use, likewise."""
        return _count_signs([sign_of_class(row) for row in self.buildings], BY_CLASS)

    @cached_property
    def route_legend(self) -> list[tuple[Sign, int]]:
        """The signs by routes that are in use, likewise."""
        return _count_signs([sign_of_routes(row) for row in self.buildings], BY_ROUTES)


def build_content(view: CityView, totals: CityTotals | None = None) -> CityContent:
    """Return what the outputs of a city share; `totals` where they are there already.

    Raises
    ------
    ValueError
        If the table draws is not whole.
    """
    return CityContent(view, totals or build_totals(view))


def _rank(row: Row) -> tuple[Any, ...]:
    people, falls = row["people_blocked"] or 0.0, row["expected_falls"] or 0.0
    return row["status"] != "assessed", -round(people), -round(falls, 6), row["path"]


def _group(rows: Sequence[Row]) -> dict[str, list[Row]]:
    found: dict[str, list[Row]] = {}
    for row in rows:
        found.setdefault(row["path"], []).append(row)
    return found


def _find_size(row: Row) -> float:
    falls = row["expected_falls"] or 0.0
    return next((size for least, size in LARGE if falls >= least), 1.0)


def _count_signs(signs: Sequence[Sign], known: Mapping[str, Sign]) -> list[tuple[Sign, int]]:
    counts = {key: sum(one.key == key for one in signs) for key in known}
    return [(known[key], counts[key]) for key in reversed(list(known)) if counts[key]]
