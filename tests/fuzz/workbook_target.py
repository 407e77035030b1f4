"""Workbooks that were accepted, changed in value and structure, read, assessed and reported.

An input is the content of the sheets as JSON, ``{"Items": [["Item", ...], ["A1", ...]]}``: it is written as a workbook
when it is checked.
"""

import functools
import io
import json
import random
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import xlsxwriter

import assess
from assess.errors import WorkbookError
from assess.i18n import gettext, load_catalogue, speaking
from assess.model import Inventory
from assess.results import Results
from assess.workbook.catalogue import read_catalogue
from assess.workbook.example import example_content
from assess.workbook.schema import SHEETS
from assess.workbook.template import Units
from docs.results_schema import build_schema
from tests.fuzz.engine import BrokenRuleError
from tests.fuzz.plain_targets import check_problems, keep
from tests.motion.writers import THREE, at2, csmip_v2
from tests.workbooks import FLOORS, ITEMS, UNVERIFIED

Cell = str | float | bool | None
Sheets = dict[str, list[list[Cell]]]

RECORDS = {"r.at2": at2(), "s.v2": csmip_v2(*THREE)}
HAZARD = b"pga_g,annual_rate\n0.02,0.05\n0.1,0.01\n0.4,0.001\n1.2,0.0001\n"
STRONGER = 1.25
"""Factor on every motion under which no chance may come out lower."""
WITHIN = 1e-9
WORDS = [
    "45 cm", "1.80 m", "0,15", "15 %", "12 kg", "N", "y", "sì", "no", "yes", "partly", "unknown", "", " ",
    "\u00a0", "-", "–", "n/a", "?", "0", "1", "1,500", "1.5", "1e3", "=1+1", "＝1+1", "#REF!", "#N/A", "Hall", "1",
    "2", "X", "Y", "x ", "both", "Way out", "aisle", "exit", "room", "stair", "life safety", "property",
    "31/02/2026", "2026-02-03", "A" * 300, "é", "e\u0301", "\u202e", "\x1b[31m", "<b>", "&amp;", "'", '"', "a;b",
    "a|b", "r.at2", "s.v2#1", "r.at2; s.v2#2", "nobody.csv", "../r.at2", "ASCE 7-22", "EN 1998-1", "as filled",
    "it", "en", "Bookcase 5 shelves", "Desk", "(0,0) (5,0) (5,5) (0,5)", "L3", "L11", "B1",
]  # fmt: skip
NUMBERS = [0, 1, 2, 3, 12, -1, 0.5, 1e-6, 0.01, 1e6, 1e300, 44_000.5, 360, 90, 45, 0.4, 20, 300, 1000]
SUFFIXES = [" [cm]", " [m]", " [in]", " [ft]", " [g]", " [m/s2]", " [%]", "", " ", " (cm)", "?"]


def pack(sheets: Mapping[str, Sequence[Sequence[Cell]]]) -> bytes:
    """Return an input."""
    return json.dumps(sheets, ensure_ascii=True, separators=(",", ":")).encode()


def build(sheets: Mapping[str, Sequence[Sequence[Cell]]]) -> bytes:
    """Return the workbook of an input."""
    target = io.BytesIO()
    with xlsxwriter.Workbook(
        target, {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}
    ) as book:
        for name, rows in sheets.items():
            page = book.add_worksheet(name)
            for number, row in enumerate(rows):
                for at, value in enumerate(row):
                    if isinstance(value, bool):
                        page.write_boolean(number, at, value)
                    elif isinstance(value, int | float):
                        page.write_number(number, at, value)
                    elif value is not None:
                        page.write_string(number, at, value)
    return target.getvalue()


# ---------------------------------------------------------------- sound workbooks


def _sheets(rows: Mapping[str, Sequence[Mapping[str, Any]]], units: Units = "si") -> Sheets:
    """Return the sheets of rows by field, in the language in use, with the types that the pieces name."""
    types = {row.get("type") for row in rows["Items"]}
    rows = {**rows, "Catalogue": [row for row in read_catalogue(units) if row["type"] in types]}
    found: Sheets = {}
    for sheet in (one for one in SHEETS if one.name in rows):
        own = rows[sheet.name]
        named = [one for one in sheet.columns if any(row.get(one.name) is not None for row in own)]
        heads: list[Cell] = [replace(one, label=gettext(one.label)).header(units) for one in named]
        cells: list[list[Cell]] = [
            [gettext(row[one.name]) if one.choices and one.name in row else row.get(one.name) for one in named]
            for row in own
        ]
        is_form = sheet.layout == "form"
        found[gettext(sheet.name)] = (
            [list(pair) for pair in zip(heads, cells[0], strict=True)] if is_form else [heads, *cells]
        )
    return found


@functools.cache
def _sound() -> tuple[bytes, ...]:
    recorded = [
        {"floor": "1", "record_x": "r.at2", "record_y": "s.v2#3"},
        {"floor": "2", "pfa_x": 0.3, "elevation": 3.5},
    ]
    hazard = {"ground_pga": 0.2, "hazard": "h.csv", "height": 12, "latitude": 41.9, "longitude": 12.5}
    profile = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 3.5}, {"floor": "3", "elevation": 7}]
    given = {"ground_pga": 0.3, "period": 0.5, "height": 10.5, "scenario_kind": "ASCE 7-22", "sds": 1.0}
    plain = [
        {"Building": [{"building": "A"}], "Floors": FLOORS, "Items": ITEMS},
        {"Building": [{"building": "R"}], "Floors": recorded, "Items": ITEMS},
        {"Building": [hazard], "Floors": FLOORS, "Items": ITEMS},
        {"Building": [given], "Floors": profile, "Items": ITEMS},
    ]
    found = [_sheets(rows) for rows in plain]
    found += [_sheets(example_content().rows), _sheets(example_content("imperial").rows, "imperial")]
    with speaking(load_catalogue("it")):
        found.append(_sheets(example_content().rows))
    return tuple(pack(one) for one in found)


# ---------------------------------------------------------------- changes


def _pick(draw: random.Random, rows: list[list[Cell]], first: int = 0) -> tuple[int, int]:
    """Return a row and a column that are there."""
    at = draw.randrange(min(first, len(rows) - 1), len(rows))
    return at, draw.randrange(max(len(rows[at]), 1))


def _change_value(draw: random.Random, rows: list[list[Cell]]) -> None:
    """Make a number a little other, exchange two cells of a column, or put in what people type."""
    row, at = _pick(draw, rows, 1)
    if at >= len(rows[row]):
        return
    old, what = rows[row][at], draw.random()
    if isinstance(old, int | float) and not isinstance(old, bool) and what < 0.6:
        new = old * draw.choice((0.5, 0.9, 1.1, 2, 10, 0.01, 100, -1))
        rows[row][at] = draw.choice((new, round(new), str(new), str(new).replace(".", ","), f"{new} cm"))
    elif what < 0.75:
        other = draw.choice(rows[1:] or rows)
        if at < len(other):
            rows[row][at] = other[at]
    elif what < 0.85:
        rows[row][at] = None
    else:
        rows[row][at] = draw.choice((draw.choice(WORDS), draw.choice(NUMBERS), draw.random() < 0.5))


def _space(draw: random.Random, rows: list[list[Cell]]) -> None:
    """Put signs around a text that nobody sees."""
    row, at = _pick(draw, rows)
    if at < len(rows[row]) and isinstance(rows[row][at], str):
        text = str(rows[row][at])
        rows[row][at] = draw.choice((text + " ", "\u00a0" + text, text.upper(), text.replace("-", "–"), text + "\n"))


def _change_row(draw: random.Random, rows: list[list[Cell]]) -> None:
    row, what = draw.randrange(len(rows)), draw.randrange(6)
    if what == 0 and len(rows) > 2:
        del rows[row]
    elif what == 1:
        other = draw.randrange(len(rows))
        rows[row], rows[other] = rows[other], rows[row]
    elif what == 2:
        rows.insert(row, [None] * draw.randrange(3))
    elif what == 3:
        rows.insert(row, [draw.choice(("Total", "Ground floor", "SECTION B", draw.choice(WORDS)))])
    else:
        copy = list(rows[row])
        if copy and copy[0] is not None:
            copy[0] = f"{copy[0]}-{draw.randrange(100)}"
        rows.extend([copy] * draw.choice((1, 1, 1, 30)))


def _change_column(draw: random.Random, rows: list[list[Cell]]) -> None:
    width = max(len(row) for row in rows)
    one, other, what = draw.randrange(max(width, 1)), draw.randrange(max(width, 1)), draw.randrange(4)
    for row in rows:
        row.extend([None] * (width - len(row)))
        if what == 0 and width > 3:
            row.pop(one)
        elif what == 1 and width:
            row[one], row[other] = row[other], row[one]
        elif what == 2:
            row.insert(one, draw.choice(("Inventory no.", "x", 3, None)))
        elif what == 3 and width:
            row.insert(other, row[one])


def _change_header(draw: random.Random, rows: list[list[Cell]]) -> None:
    if rows[0]:
        at = draw.randrange(len(rows[0]))
        text = str(rows[0][at])
        bare = text.partition(" [")[0]
        rows[0][at] = draw.choice((bare + draw.choice(SUFFIXES), text.lower(), text[:-1], text + " ", bare + "\n[cm]"))


_IN_SHEET: tuple[Callable[[random.Random, list[list[Cell]]], None], ...] = (
    *[_change_value] * 6, _space, _space, _change_row, _change_row, _change_column, _change_header,
)  # fmt: skip


def _change_sheets(draw: random.Random, sheets: Sheets) -> None:
    """Leave out, rename, add or exchange sheets."""
    name, what = draw.choice(list(sheets)), draw.randrange(5)
    if what == 0 and len(sheets) > 2:
        del sheets[name]
    elif what == 1:
        sheets[draw.choice((name.upper(), name + " ", "Notes", "Sheet1"))[:31]] = sheets.pop(name)
    elif what == 2:
        sheets[draw.choice(("Log", "Calc", "Places", "Routes", "Catalogue"))] = draw.choice(list(sheets.values()))
    else:
        sheets[name] = sheets.pop(name)


def _rename(draw: random.Random, sheets: Sheets) -> None:
    """Exchange a text wherever it stands, so that what refers to it still does."""
    texts = [value for rows in sheets.values() for row in rows[1:] for value in row if isinstance(value, str) and value]
    if not texts:
        return
    old, new = draw.choice(texts), draw.choice((draw.choice(WORDS), f"{draw.choice(texts)} {draw.randrange(9)}"))
    for rows in sheets.values():
        for row in rows[1:]:
            row[:] = [new if value == old else value for value in row]


# ---------------------------------------------------------------- the target


class Workbooks:
    """Workbooks of sound content with a few changes, most of which can be assessed."""

    suffix, most_seconds = ".json", 20.0
    further = frozenset({"assessed", "assessed, simulated"})

    def seeds(self) -> Sequence[bytes]:
        """Return workbooks with typed motions, records, a hazard curve, a profile; with routes, feet, Italian."""
        return _sound()

    def mutate(self, draw: random.Random, data: bytes, pool: Sequence[bytes]) -> bytes:
        """Change a sound workbook in one to four places."""
        sheets: Sheets = json.loads(data)
        for _ in range(draw.choice((1, 1, 1, 2, 2, 4))):
            what = draw.random()
            if what < 0.06:
                _change_sheets(draw, sheets)
            elif what < 0.14:
                _rename(draw, sheets)
            else:
                rows = sheets[draw.choice(list(sheets))]
                if rows:
                    draw.choice(_IN_SHEET)(draw, rows)
        found = pack(sheets)
        # An input that grew with each change is given up for a fresh one.
        return found if len(found) < 60_000 else draw.choice(_sound())

    def check(self, data: bytes, folder: Path, *, deep: bool) -> str:
        """Read the workbook; what can be read is assessed and reported."""
        try:
            content = build(json.loads(data))
        except (xlsxwriter.exceptions.XlsxWriterException, ValueError):
            return "no workbook"
        records = {**RECORDS, "h.csv": HAZARD}
        try:
            inventory, outcome = assess.read_inventory(content, records=records), "assessed"
        except WorkbookError as error:
            check_problems(error)
            inventory, outcome = assess.read_inventory(content, records=records, strict=False), "assessed in part"
        _check_names(inventory)
        try:
            results = assess.run(inventory, UNVERIFIED, figures=False)
        except WorkbookError as error:
            check_problems(error)
            return "refused by run" if outcome == "assessed" else "refused"
        _check_results(results, inventory, folder)
        _check_stronger(results, inventory)
        if deep and zlib.crc32(data) % 50 == 0:
            _check_results(assess.run(inventory, verify="all", runs=10, figures=False), inventory, folder)
            return f"{outcome}, simulated"
        return outcome


@functools.cache
def _validator() -> jsonschema.Draft202012Validator:
    return jsonschema.Draft202012Validator(build_schema())


def _check_names(inventory: Inventory) -> None:
    """Check that no row names one that was left out."""
    floors, places = {one.floor for one in inventory.floors}, {one.place for one in inventory.places}
    named = {one.floor for one in inventory.items} | {one.floor for one in inventory.places}
    keep(named <= floors, "a floor that is not there")
    keep({name for one in inventory.routes for name in (one.start, one.end) if name} <= places, "a place not there")


def _check_results(results: Results, inventory: Inventory, folder: Path) -> None:
    """Check that reports are whole and valid, and chances are chances."""
    keep(len(results.items) == len(inventory.items), "a row without a result")
    written = assess.write_reports(results, folder / "out", ("json", "csv"))
    there = {path.name for path in (folder / "out").iterdir()}
    keep(there == {path.name for path in written.values()}, f"files that are no reports: {sorted(there)}")
    found = json.loads(written["json"].read_text(encoding="utf-8"))
    for wrong in _validator().iter_errors(found):
        raise BrokenRuleError(f"results.json breaks its schema at {wrong.json_path}: {wrong.message[:150]}")
    keep(all(0 <= one.adopted.probability <= 1 for one in results), "a chance beyond 0 to 1")


def _check_stronger(results: Results, inventory: Inventory) -> None:
    stronger = assess.run(inventory, UNVERIFIED, scale=STRONGER, figures=False)
    for one, other in zip(results, stronger, strict=True):
        keep(other.adopted.probability >= one.adopted.probability - WITHIN, "stronger shaking came out safer")
