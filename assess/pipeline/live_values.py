"""What the live columns of a workbook show, computed by the methods themselves.

The values are stored in a workbook next to the formulas, so that a viewer that does not calculate shows them too.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from assess.i18n import gettext
from assess.methods import Cases, adopted_formula
from assess.methods._method import ALIKE
from assess.model import AXES, Inventory, Item
from assess.pipeline.adopt import find_can_rock
from assess.pipeline.demand import Demand, Demands, build_demands, find_site
from assess.pipeline.verify import find_uncertainty
from assess.risk import classify
from assess.settings import SCENARIOS, Settings
from assess.units import GRAVITY
from assess.workbook.catalogue import read_catalogue
from assess.workbook.formulas import LIVE_METHODS, OUTSIDE, say_class
from assess.workbook.lists import NO_SHAKING, RUN_ASSESS
from assess.workbook.live_row import IS_ANCHORED
from assess.workbook.read import read_inventory
from assess.workbook.schema import CATALOGUE, CLASS, LIVE, NO, SHEETS, YES, Sheet
from assess.workbook.template import Content, Rows, Units


def live_values(inventory: Inventory, scenario: str | None = None) -> list[list[float | str]]:
    """Return what the columns `assess.workbook.schema.LIVE` show in the language in use, for each item.

    With the workbook's own scenario they equal the results of the formulas, which know the default settings only.

    Raises
    ------
    WorkbookError
        If nothing that the scenario asks for serves a floor.
    """
    settings = Settings()
    kind = scenario or inventory.building.scenario_kind or SCENARIOS[0]
    demands = build_demands(inventory, kind, ductility_reduction=settings.ductility_reduction)
    live = {"given", "profile"} if _is_assumed(kind, demands) else {"given"}
    governing = [_find_governing(item, demands, live) for item in inventory.items]
    cases = Cases.of(
        breadth=np.array([item.breadth for item in inventory.items], dtype=np.float64),
        height=np.array([item.height for item in inventory.items], dtype=np.float64),
        pfa=np.array([np.nan if one is None else one.pfa for one in governing], dtype=np.float64),
        pfv=np.array([np.nan if one is None else one.pfv for one in governing], dtype=np.float64),
        centre=np.array([item.centre_of_gravity for item in inventory.items], dtype=np.float64),
        scanned=np.array([item.is_scanned for item in inventory.items], dtype=np.bool_),
        uncertainty=find_uncertainty(inventory.building, demands),
    )
    outcomes = {method.key: method.evaluate(cases, settings) for method in LIVE_METHODS}
    formula = outcomes[adopted_formula().key]
    values = zip(*(outcome.value.tolist() for outcome in outcomes.values()), strict=True)
    outside = formula.flags["extrapolated"].tolist()
    classes = list(map(_say_class, inventory.items, governing, formula.value.tolist(), outside))
    rocks = [gettext(YES if one else NO) for one in find_can_rock(cases, settings)]
    if find_site(demands):  # the sheet does not know the scatter of a ShakeMap
        rocks = [gettext(RUN_ASSESS)] * len(rocks)
    rows = zip(cases.breadth_to_height.tolist(), governing, values, classes, rocks, strict=True)
    return [_write_row(*row) for row in rows]


def _is_assumed(kind: str, demands: Demands) -> bool:
    """Return whether every floor follows the default profile from an assumed intensity."""
    return kind == SCENARIOS[0] and all(one.shaking for parallel in demands.values() for one in parallel)


def _find_governing(item: Item, demands: Demands, live: Collection[str]) -> Demand | None:
    """Return the motion with the larger PFA, the first of equal ones; None where the sheet cannot know one."""
    every = [one for axis in ((item.axis,) if item.axis else AXES) for one in demands[item.floor, axis]]
    if any(one.source not in live or "assumed_elevation" in one.flags for one in every):
        return None
    return max(every, key=lambda one: round(one.pfa / GRAVITY, ALIKE))


def _say_class(item: Item, governing: Demand | None, adopted: float, is_outside: bool) -> str:
    if item.anchored == YES:
        return gettext(IS_ANCHORED if item.bracket_capacity is None else RUN_ASSESS)
    if governing is None:
        return gettext(RUN_ASSESS)
    risk = classify(adopted)
    return "" if risk is None else say_class(risk) + OUTSIDE * is_outside


def _write_row(
    ratio: float, governing: Demand | None, values: Sequence[float], label: str, rocks: str
) -> list[float | str]:
    if governing is None:
        return _write_unknown(ratio, label, gettext(RUN_ASSESS))
    return [ratio, governing.pfa / GRAVITY, *("" if np.isnan(value) else value for value in values), label, rocks]


def _write_unknown(ratio: float, label: str, hint: str) -> list[float | str]:
    """Return the row of a piece of whose shaking the sheet knows nothing; `label` stands for its class."""
    return [ratio, *[hint] * (LIVE.index(CLASS) - 1), label, hint]


def with_live(content: Content, units: Units = "si", folder: Path | None = None) -> Content:
    """Return a content with the results of its live columns.

    Parameters
    ----------
    content : Content
        The rows; its own `live` is replaced.
    units : "si" or "imperial"
        Of its values.
    folder : Path, optional
        The folder of the files that it names, such as records.

    Raises
    ------
    WorkbookError
        If the rows do not make an inventory.
    """
    return replace(content, live=live_values(_read(content.rows, units, folder)))


def without_shaking(content: Content, units: Units = "si") -> Content:
    """Return a content whose floors have no shaking, with its live columns: B/H, and that shaking is missing.

    Raises
    ------
    WorkbookError
        If the rows lack more than shaking.
    """
    floors = [{**row, "pfa_x": 1.0} for row in content.rows["Floors"]]  # of which no column shows anything
    items = _read({**content.rows, "Floors": floors}, units).items
    return replace(content, live=list(map(_write_unshaken, items)))


def _write_unshaken(item: Item) -> list[float | str]:
    hint = gettext(NO_SHAKING)
    label = _say_class(item, None, 0.0, is_outside=False) if item.anchored == YES else hint
    return _write_unknown(item.breadth / item.height, label, hint)


def _read(rows: Mapping[str, Rows], units: Units, folder: Path | None = None) -> Inventory:
    rows = {CATALOGUE.name: read_catalogue(units), **rows}
    headed = {sheet.name: [_head(sheet, row, units) for row in rows.get(sheet.name, ())] for sheet in SHEETS}
    return read_inventory(headed, records=folder)


def _head(sheet: Sheet, row: Mapping[str, Any], units: Units) -> dict[str, Any]:
    """Return a row by the headers of its columns, which name the units."""
    headers = {column.name: column.header(units) for column in sheet.columns}
    return {headers[name]: value for name, value in row.items()}
