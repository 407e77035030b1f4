"""What the page of a city holds as data: every building in short, and its rows, with texts each only once.

The page's script makes rows of it when a building is opened, as text alone: nothing of it is ever read as HTML.
"""

import json
import shlex
from collections.abc import Callable, Collection, Iterable, Sequence
from functools import partial
from typing import Any

from assess.i18n import gettext as _
from assess.intensity import name_mmi
from assess.portfolio import city_words as say
from assess.portfolio.building_signs import find_share, sign_of_class, sign_of_routes, sign_of_share
from assess.portfolio.city import City, Row
from assess.report import words
from assess.route_results import RouteState
from assess.units import GRAVITY

MOST_ROWS = 150
"""Rows of one table of a building that the page holds; the tables of the portfolio have all."""
LONGEST = 300
"""Characters of a text that the page holds."""
STOREYS = ((1, 1), (2, 3), (4, 7), (8, 300))
"""Groups of storeys in the filter."""
Cells = Sequence[str]


class Table:
    """Rows of all buildings: per column its distinct texts, and per row their numbers."""

    def __init__(self, heads: Cells, numeric: Iterable[int]) -> None:
        self.heads, self.numeric = heads, sorted(numeric)
        self.known: list[dict[str, int]] = [{} for _head in heads]
        self.columns: list[list[int]] = [[] for _head in heads]
        self.starts, self.left_out = [0], list[int]()

    def add(self, rows: Sequence[Any], read: Callable[[Any], Cells]) -> None:
        """Add the rows of the next building."""
        for row in rows[:MOST_ROWS]:
            for known, column, text in zip(self.known, self.columns, read(row), strict=True):
                column.append(known.setdefault(words.cut(text, LONGEST), len(known)))
        self.starts.append(len(self.columns[0]))
        self.left_out.append(max(0, len(rows) - MOST_ROWS))

    def pack(self) -> dict[str, Any]:
        """Return what the page holds of it."""
        return {
            "heads": self.heads, "numeric": self.numeric, "texts": [list(known) for known in self.known],
            "columns": self.columns, "starts": self.starts, "left": self.left_out,
        }  # fmt: skip


def write_data(city: City, repeat: str, indexed: Collection[str] = ()) -> str:
    """Return the data of the page as JSON that may stand inside a script element.

    `repeat` is the command that assesses one building alone, with ``{path}`` in it; "" where there is none. `indexed`
    are the paths of the buildings of which an index fills in something.
    """
    facts = _list_facts()
    data = {
        "heads": [label for label, _read in facts],
        "buildings": [
            {
                "name": words.cut(city.name_building(row), LONGEST),
                "path": words.cut(row["path"], LONGEST),
                "share": sign_of_share(row).key,
                "kind": sign_of_class(row).key,
                "state": sign_of_routes(row).key,
                "use": words.cut(city.spell_use(row), 60),
                "inventory": row["inventory"] or "",
                "basis": row["basis"] or "",
                "storeys": row["storeys"],
                "cells": _list_cells(row),
                "facts": [words.cut(read(row), LONGEST) for _label, read in facts if row["status"] == "assessed"],
                "command": _write_command(row, repeat),
                "indexed": row["path"] in indexed,
            }
            for row in city.ranked
        ],
        "tables": _pack_tables(city),
        "styles": _list_styles(),
        "texts": _list_texts(),
    }
    text = json.dumps(data, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _write_command(row: Row, repeat: str) -> str:
    """Return the command that assesses a building alone; "" of one that was skipped or has no inventory workbook."""
    is_workbook = row["status"] == "assessed" and row["inventory"] == "surveyed"
    if not repeat or not is_workbook or not row["path"].isprintable():
        return ""
    return repeat.replace("{path}", shlex.quote(row["path"]))


def list_heads() -> list[str]:
    """Return the headings of the ranking, whose cells `write_data` holds for each building."""
    return [_("Building"), _("Use"), _("Inventory"), _("Highest class"), _("Pieces"), _("Share expected to fall"),
            _("Expected falls"), _("5 to 95 % of earthquakes"), _("People on blocked routes"),
            _("Routes blocked")]  # fmt: skip


def _list_cells(row: Row) -> list[str]:
    """Return the cells of the ranking after the first; the class is written by its sign."""
    if row["status"] != "assessed":
        return [str(row["use"] or ""), "", "", *("" for _at in range(6))]
    inventory = say.name_inventory(row["inventory"])
    basis = "" if row["basis"] == "simulated" else f", {say.name_basis(row['basis'])}"
    return [
        words.cut(str(row["use"] or ""), 60), say.mark_own_motions(f"{inventory}{basis}", row), "",
        say.say_whole(row["pieces"]), words.percent(find_share(row)), say.say_falls(row),
        say.say_range(row["falls_p05"], row["falls_p95"]), say.say_people(row), say.say_blocked(row),
    ]  # fmt: skip


def _list_facts() -> list[tuple[str, Callable[[Row], str]]]:
    """Return what the page of a building says of it: label, and how it is read from its row."""
    return [
        (_("File"), lambda row: str(row["path"])),
        (_("Inventory"), lambda row: say.name_inventory(row["inventory"])),
        (_("Results"), lambda row: say.name_basis(row["basis"])),
        (_("Use"), lambda row: str(row["use"] or words.DASH)),
        (_("Place"), say.say_place),
        (_("Storeys"), lambda row: say.say_whole(row["storeys"])),
        (_("Height [m]"), lambda row: words.fixed(row["height_m"], 1)),
        (_("Ground motion"), _say_ground),
        (_("Largest PFA of its floors [g]"), lambda row: words.in_g(row["largest_pfa_g"])),
        (_("Standard deviation of ln PFA"), lambda row: words.fixed(row["motion_uncertainty"], 2)),
        (_("Pieces by class"), _say_classes),
        (_("Expected falls"), _say_falls),
        (_("Share of its pieces in the classes that is expected to fall"), lambda row: words.percent(find_share(row))),
        (_("Falls with few and with many pieces (10 and 90 % quantities)"), _say_assumed),
        (_("People on blocked routes"), say.say_people),
        (_("Falls that the work list avoids"), lambda row: say.say_number(row["falls_avoided"])),
        (_("Known costs"), _say_cost),
    ]


def _say_ground(row: Row) -> str:
    if row["ground_pga_g"] is None:
        return _("the floors have motions of their own")
    source = {
        "shakemap": _("ShakeMap"), "scenarios": _("scenarios"), "ground_pga": _("Ground PGA as given"),
        "sds": _("SDS as given"), "shaking": _("assumed from the intensity"),
    }.get(row["ground_source"] or "", "")  # fmt: skip
    own = _("; {floors} floors keep a motion of their own", floors=row["own_motions"]) if row["own_motions"] else ""
    pga_g, pgv = row["ground_pga_g"], row["ground_pgv_cm_s"]
    intensity = name_mmi(pga_g * GRAVITY, None if pgv is None else pgv / 100)
    peaks = [_("PGA {pga} g", pga=words.in_g(pga_g))]
    peaks += [] if pgv is None else [_("PGV {pgv} cm/s", pgv=words.fixed(pgv, 1))]
    peaks += [_("about {intensity}", intensity=_(intensity))] if intensity else []
    return _("{peaks} ({source}){own}", peaks=", ".join(peaks), source=source, own=own)


def _say_classes(row: Row) -> str:
    named = {
        "low": _("low"), "medium": _("medium"), "high": _("high"), "very_high": _("very high"),
        "unconfirmed": _("unconfirmed"), "by_formula": _("by formula only"), "anchored": _("anchored"),
        "left_out": _("left out of the COBie file"),
    }  # fmt: skip
    return "; ".join(f"{label} {say.say_whole(row[name])}" for name, label in named.items() if row[name])


def _say_falls(row: Row) -> str:
    expected = say.say_falls(row)
    if row["falls_p05"] is None or row["falls_p95"] is None:
        return expected
    return _("{expected}; in nine of ten earthquakes like this one {range}",
             expected=expected,
             range=say.say_range(row["falls_p05"], row["falls_p95"]))  # fmt: skip


def _say_assumed(row: Row) -> str:
    is_assumed = row["inventory"] == "assumed"
    return say.say_range(row["falls_low_inventory"], row["falls_high_inventory"], say.say_number) if is_assumed else ""


def _say_cost(row: Row) -> str:
    if row["cost"] is None:
        return _("not known") if row["works"] else ""
    missing = say.say_whole(row["works_without_cost"]) if row["works_without_cost"] else ""
    return say.say_whole(row["cost"]) + (_(" and {pieces} pieces without a cost", pieces=missing) if missing else "")


# ---------------------------------------------------------------- rows of a building


def _pack_tables(city: City) -> dict[str, Any]:
    pieces = Table([_("Item"), _("Floor"), _("Room"), _("What"), _("Size [cm]"), _("Pieces"), _("Class"), _("Chance"),
                    _("Fix: place"), _("How to fix it")], (5, 7, 8))  # fmt: skip
    routes = Table([_("Route"), _("State"), _("Chance of a blockage"), _("People"), _("Pieces that may block it"),
                    _("To fill in")], (2, 3))  # fmt: skip
    problems = Table([_("Severity"), _("Place"), _("What"), _("How to fix it")], ())
    for building in city.ranked:
        path, basis = building["path"], building["basis"]
        pieces.add(sorted(city.pieces_of.get(path, []), key=_order), partial(_read_piece, basis))
        routes.add(city.routes_of.get(path, []), _read_route)
        problems.add(city.problems_of.get(path, []), _read_problem)
    return {"pieces": pieces.pack(), "routes": routes.pack(), "problems": problems.pack()}


def _order(row: Row) -> tuple[float, float, int]:
    """Pieces as the building's work list has them, then the others, the likeliest to fall first."""
    place = float("inf") if row["work_place"] is None else row["work_place"]
    return place, -(row["probability"] or 0.0), row["row"] or 0


def _read_piece(basis: str | None, row: Row) -> list[str]:
    place = "" if row["work_place"] is None else say.say_whole(row["work_place"])
    return [
        row["item"] or "", row["floor"] or "", row["room"] or "", row["description"] or row["type"] or "",
        say.say_size(row), say.say_whole(row["quantity"]), say.label_piece(row, basis), say.say_probability(row), place,
        row["detail"] or "",
    ]  # fmt: skip


def _read_route(row: Row) -> list[str]:
    return [row["route"] or "", say.label_state(row["state"]), say.say_probability(row),
            say.say_whole(row["occupants"]), row["blockers"] or "", row["to_fill_in"] or ""]  # fmt: skip


def _read_problem(row: Row) -> list[str]:
    return [say.say_severity(row["severity"] or ""), say.say_spot(row), row["message"] or "", row["fix"] or ""]


def _list_styles() -> dict[str, str]:
    """Return the style of a cell by the sign that it begins with."""
    risks = ("low", "medium", "high", "very-high")
    signs = dict(zip("○◇▲■", risks, strict=True))
    apart = {words.ANCHORED: "anchored", words.UNCONFIRMED: "apart-unconfirmed", words.BY_FORMULA: "apart-formula"}
    states = {state.symbol: f"way-state {state.replace(' ', '-')}" for state in RouteState}
    return signs | apart | states


def _list_texts() -> dict[str, str]:
    """Return what the script says."""
    return {
        "all": _("Buildings: {total}, all shown"),
        "some": _("Buildings: {shown} of {total}; {filters}"),
        "more": _("Show {count} more"),
        "fixes": _("What to fix first"),
        "pieces": _("All pieces"),
        "routes": _("Evacuation routes"),
        "problems": _("Problems of the workbook"),
        "left": _("{count} more rows are in the tables of the portfolio."),
        "alone": _("To assess this building alone, to the same numbers"),
        "index": _("What the index fills in has to be typed into its workbook before."),
        "skipped": _("This building could not be assessed."),
        "assumed": _("The furniture of this building is assumed; no piece of it has been seen."),
        "kilometres": _("{length} km"),
        "metres": _("{length} m"),
        "title": _("Building {place} of {total} in the ranking"),
        "text": _("Text"),
    }
