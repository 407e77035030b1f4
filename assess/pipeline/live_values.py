"""What the live columns of a workbook show, computed by the methods themselves; what a new workbook starts with.

The values are stored in a workbook next to the formulas, so that a viewer that does not calculate shows them too.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from assess.errors import WorkbookError
from assess.i18n import gettext
from assess.methods import ALIKE, Cases, adopted_formula, paper_formula
from assess.model import AXES, Inventory, Item
from assess.pipeline.adopt import find_can_rock, find_rolling, list_mobile
from assess.pipeline.demand import Demand, build_demands
from assess.pipeline.known_ground import find_ground
from assess.pipeline.verify import find_peak
from assess.risk import RiskClass, classify
from assess.settings import SCENARIOS, Settings
from assess.units import GRAVITY, VELOCITY
from assess.workbook.catalogue import read_catalogue
from assess.workbook.example import example_content, room_content
from assess.workbook.formulas import LIVE_METHODS, OUTSIDE, say_class
from assess.workbook.lists import NO_SHAKING, RUN_ASSESS
from assess.workbook.live_row import IS_ANCHORED, IS_ROLLING
from assess.workbook.read import read_inventory
from assess.workbook.schema import CATALOGUE, CLASS, CLASS_OR, LIVE, NO, SHEETS, YES
from assess.workbook.template import Content, Rows, Units


def live_values(inventory: Inventory, scenario: str | None = None) -> list[list[float | str]]:
    """Return what the columns `assess.workbook.schema.LIVE` show in the language in use, for each item.

    With the workbook's own scenario they equal the results of the formulas, which know the default settings only.
    Raises WorkbookError if nothing that the scenario asks for serves a floor.
    """
    settings = Settings()
    kind = scenario or inventory.building.scenario_kind or SCENARIOS[0]
    demands = build_demands(inventory, kind, ductility_reduction=settings.ductility_reduction)
    # the sheet knows the demands of typed peaks, and of the ground where no floor has its own motion
    all_demands = [one for parallel in demands.values() for one in parallel]
    given = [one for one in all_demands if one.source == "given" and one.drawn]
    live = [one for one in given if one.drawn and one.drawn.target.meets == "peaks"]
    if find_ground(inventory).site is None:
        followed = [one for one in given if one.drawn and one.drawn.record is None]
        by_beam = all_demands if all(one.source == "beam" for one in all_demands) else []
        is_numbered = inventory.building.storeys and not any((one.elevation or 0.0) > 0 for one in inventory.floors)
        live += [one for one in (*followed, *by_beam) if not is_numbered or one.floor.elevation is not None]
    is_live, formula = set(map(id, live)), adopted_formula(inventory.building.class_by)
    name, unit = formula.ruled_by, {"pfa": GRAVITY, "pfv": VELOCITY["cm/s"]}[formula.ruled_by]  # as the sheet compares
    options: list[list[Demand]] = []  # the motions of each piece; none where the sheet cannot know one of them
    for item in inventory.items:
        every = [one for axis in ((item.axis,) if item.axis else AXES) for one in demands[item.floor, axis]]
        options.append(every if all(id(one) in is_live for one in every) else [])
    governing = [
        max(own, key=lambda one: round(float(getattr(one, name)) / unit, ALIKE), default=None) for own in options
    ]
    cases = _build_cases(inventory.items, governing)
    outcomes = {method.key: method.evaluate(cases, settings) for method in LIVE_METHODS}
    values = zip(*(outcome.value.tolist() for outcome in outcomes.values()), strict=True)
    strongest = np.array([max((one.pfa for one in own), default=np.nan) for own in options], dtype=np.float64)
    can_rock = find_can_rock(replace(cases, pfa=strongest), settings).tolist()
    rolls, classes = find_rolling(cases, list_mobile(inventory)).tolist(), []
    for method in (formula, paper_formula()):
        chances, flags = outcomes[method.key].value.tolist(), outcomes[method.key].flags
        outside = flags["extrapolated"].tolist()
        classes.append(list(map(_show_class, inventory.items, governing, chances, outside, can_rock, rolls)))
    rows, ratios = [], cases.breadth_to_height.tolist()
    found = zip(ratios, governing, values, zip(*classes, strict=True), can_rock, strict=True)
    for ratio, motion, own, shown, rocks in found:
        if motion is None:
            rows.append(_write_unknown(ratio, shown[0], gettext(RUN_ASSESS)))
        else:
            chances = ("" if np.isnan(value) else value for value in own)
            rows.append([ratio, motion.pfa / GRAVITY, *chances, *shown, gettext(YES if rocks else NO)])
    return rows


def _build_cases(items: Sequence[Item], motions: Sequence[Demand | None]) -> Cases:
    known = [(one.pfa, one.pfv, one.dispersion, find_peak(one)) if one else (np.nan, np.nan, 0, 0) for one in motions]
    pfa, pfv, spread, peak = np.array(known, dtype=np.float64).reshape(-1, 4).T
    cases = Cases.of(
        breadth=np.array([item.breadth for item in items], dtype=np.float64),
        height=np.array([item.height for item in items], dtype=np.float64),
        pfa=pfa, pfv=pfv,
        centre=np.array([item.centre_of_gravity for item in items], dtype=np.float64),
        scanned=np.array([item.is_scanned for item in items], dtype=np.bool_),
    )  # fmt: skip
    return replace(cases, dispersion=spread, peak=peak)


def _show_class(
    item: Item,
    governing: Demand | None,
    adopted: float,
    is_outside: bool = False,
    can_rock: bool = True,
    rolls: bool = False,
) -> str:
    if item.anchored == YES:
        return gettext(IS_ANCHORED if item.bracket_capacity is None else RUN_ASSESS)
    if governing is None:
        return gettext(RUN_ASSESS)
    if rolls:
        return gettext(IS_ROLLING)
    risk = classify(adopted) if can_rock else RiskClass.LOW
    return say_class(RiskClass.LOW if risk is None else risk) + OUTSIDE * (is_outside and can_rock)


def _write_unknown(ratio: float, label: str, hint: str) -> list[float | str]:
    """Return the row of a piece of whose shaking the sheet knows nothing; `label` stands for its classes."""
    return [ratio, *(label if one in (CLASS, CLASS_OR) else hint for one in LIVE[1:])]


def with_live(content: Content, units: Units = "si", folder: Path | None = None) -> Content:
    """Return a content with the results of its live columns; its own `live` is replaced.

    `units` are those of its values, `folder` that of the files that it names, such as records. Raises WorkbookError if
    the rows do not make an inventory.
    """
    return replace(content, live=live_values(_read(content.rows, units, folder)))


def without_shaking(content: Content, units: Units = "si") -> Content:
    """Return a content with live columns but no shaking: B/H, and that it is missing; WorkbookError if more is."""
    floors = [{**row, "pfa_x": 1.0} for row in content.rows["Floors"]]  # of which no column shows anything
    items, hint = _read({**content.rows, "Floors": floors}, units).items, gettext(NO_SHAKING)
    labels = [_show_class(one, None, 0.0) if one.anchored == YES else hint for one in items]
    live = [_write_unknown(one.breadth / one.height, label, hint) for one, label in zip(items, labels, strict=True)]
    return replace(content, live=live)


def fill_content(units: Units, use: str, *, is_example: bool) -> Content:
    """Return what a new workbook holds: nothing, the types and a room of a use, or an example that can be run.

    `use` is one of `assess.workbook.schema.USES`; blank: every type. The example is a small office, or the room of
    `use` with a made-up shaking.
    """
    if use and not is_example:
        return without_shaking(room_content(use, units), units)
    if use or is_example:
        return with_live(room_content(use, units, is_shaken=True) if use else example_content(units), units)
    return Content()


def store_live(content: Content, units: Units) -> Content:
    """Return a content with its live columns as far as they are known; without them where it is not complete."""
    if not content.rows.get("Items"):
        return replace(content, live=())
    for work_out in (with_live, without_shaking):
        try:
            return work_out(content, units)
        except WorkbookError:
            continue
    return replace(content, live=())


def _read(rows: Mapping[str, Rows], units: Units, folder: Path | None = None) -> Inventory:
    rows = {CATALOGUE.name: read_catalogue(units), **rows}
    headed = {}
    for sheet in SHEETS:
        headers = {column.name: column.header(units) for column in sheet.columns}
        headed[sheet.name] = [{headers[name]: value for name, value in row.items()} for row in rows.get(sheet.name, ())]
    return read_inventory(headed, records=folder)
