"""ranking.xlsx: the sums, every building, types, the pieces to fix first, routes, what was skipped, and notes.

Numbers are numbers, and every text stays text: no name becomes a formula or a link.
"""

from collections.abc import Callable, Sequence
from typing import Any

from assess.delivery.private_folder import private_folder
from assess.environment import find_source_date
from assess.i18n import fill
from assess.i18n import gettext as _
from assess.portfolio import city_method as made
from assess.portfolio import city_words as say
from assess.portfolio.building_signs import Row, find_share, say_sign, sign_of_class
from assess.portfolio.city_content import CityContent, build_content
from assess.portfolio.city_totals import BUILDING_RULE, TYPE_RULE, CityView
from assess.portfolio.piece_words import (
    label_piece,
    label_state,
    say_blocked,
    say_kind,
    say_severity,
    say_size,
    say_spot,
)
from assess.portfolio.ranking_sums import LINES, SUM
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.report_options import ReportOptions
from assess.report.xlsx.pen import CHANCE, COUNT, Column, Pen, name_sheets, set_page
from assess.route_results import RouteState
from assess.workbook.template import CREATED
from assess.workbook.writer import write_book

MOST_PIECES = 500
"""Pieces that the sheet of what to fix first holds; the tables of the portfolio have all."""
MOST_PROBLEMS = 5_000
"""Problems that the sheet of skipped buildings holds."""


def render_ranking(view: CityView, *, options: ReportOptions | None = None, progress: Progress = SILENT) -> bytes:
    """Return the ranking of a city as a workbook; the same tables give the same bytes.

    Raises
    ------
    OSError
        If there is no room for its parts.
    CancelledError
        If the work was cancelled.
    """
    options = options or ReportOptions()
    with options.spoken(), private_folder("assess-page-") as folder:
        content = progress.wait_for(lambda: build_content(view))
        path = folder / "ranking.xlsx"

        def write(book: Any) -> None:
            moment = (find_source_date() or CREATED).replace(tzinfo=None)
            book.set_properties({"title": say.say_title(view), "created": moment})
            names = name_sheets({key: _(title) for key, title, _write in SHEETS})
            pen = Pen(book, names, progress)
            pages = {key: book.add_worksheet(name) for key, name in names.items()}
            for key, _title, write_sheet in SHEETS:
                set_page(pages[key], say.say_title(view), names[key], "", say.say_ground(view)[:120])
                write_sheet(pen, pages[key], content)

        write_book(path, write, by_row=True, progress=progress)
        return path.read_bytes()


# ---------------------------------------------------------------- sums


def _write_summary(pen: Pen, page: Any, content: CityContent) -> None:
    """Write the answer in words, then the table of the groups."""
    page.set_column(0, 0, 62)
    page.set_column(1, 1 + len(content.totals.groups), 24)
    texts = [(say.say_title(content.view), "title"), (say.say_ground(content.view), "plain")]
    texts += [(f"{label}: {value}", "plain") for label, value in say.list_facts(content.view)]
    texts += [(text, "warning") for text in say.list_cautions(content.view, content.totals)]
    for group in content.totals.groups:
        texts.append((say.name_group(group), "heading"))
        texts += [(text, "plain") for text in say.list_group_lines(group)]
    for row, (text, look) in enumerate(texts):
        pen.put(page, row, 0, text, pen.style(look))
    top = len(texts) + 1
    labels = [_("Sums, kept apart"), *map(say.name_group, content.totals.groups)]
    pen.heads(page, labels, [62, *(24 for _group in content.totals.groups)], top)
    for row, line in enumerate(LINES, top + 1):
        pen.put(page, row, 0, _(line.label), pen.style("plain"))
        for at, group in enumerate(content.totals.groups, 1):
            pen.put(page, row, at, line.read(group), pen.style("plain", line.format))


# ---------------------------------------------------------------- rows


def _write_buildings(pen: Pen, page: Any, content: CityContent) -> None:
    pen.listing(page, [*_list_building_columns(), *_list_further_columns()], content.buildings)


def _of(name: str) -> Callable[[Row], Any]:
    return lambda row: row[name]


def _of_known(name: str) -> Callable[[Row], Any]:
    """Return what reads a chance of a route; a route whose state is not known has none, as it leaves out something."""
    return lambda row: None if row["state"] == RouteState.NOT_KNOWN else row[name]


def _find_known_people(row: Row) -> int | None:
    return None if row["occupants"] is None else row["occupants"] - (row["people_not_known"] or 0)


def _find_blocked(row: Row) -> int | str | None:
    """Return how many routes are blocked, as a number; what is not known is said where it is so of all routes."""
    if row["routes"] and row["routes_not_known"] < row["routes"]:
        return int(row["routes_blocked"])
    is_assessed = row["status"] == "assessed"
    return say_blocked(row["routes"], row["routes_blocked"], row["routes_not_known"]) if is_assessed else None


def _list_building_columns() -> list[Column]:
    def counted(row: Row) -> str:
        sign = sign_of_class(row)
        return f"{sign.symbol} {say_sign(sign)}"

    return [
        Column(_("File"), 28, _of("path")),
        Column(_("Building"), 30, _of("building")),
        Column(_("Inventory"), 16, lambda row: say.name_inventory(row["inventory"])),
        Column(_("Results"), 14, lambda row: say.name_basis(row["basis"])),
        Column(_("Use"), 12, _of("use")),
        Column(_("Storeys"), 8, _of("storeys"), COUNT),
        Column(_("Highest class"), 14, counted),
        Column(_("Share expected to fall"), 10, find_share, CHANCE),
        Column(_("Expected falls"), 10, _of("expected_falls"), SUM),
        Column(_("Unconfirmed"), 12, _of("unconfirmed"), COUNT),
        Column(_("By formula only"), 10, _of("by_formula"), COUNT),
        Column(_("Left out of the COBie file"), 10, _of("left_out"), COUNT),
        Column(_("Falls, 5 % of earthquakes"), 11, _of("falls_p05"), COUNT),
        Column(_("Falls, 95 % of earthquakes"), 11, _of("falls_p95"), COUNT),
        Column(_("People on blocked routes, expected"), 12, _of("people_blocked"), SUM),
        Column(_("People on routes whose state is known"), 11, _find_known_people, COUNT),
        Column(_("People on routes not known"), 10, _of("people_not_known"), COUNT),
        Column(_("Routes blocked"), 9, _find_blocked, COUNT),
        Column(_("Routes not known"), 9, _of("routes_not_known"), COUNT),
    ]


def _list_further_columns() -> list[Column]:
    """Return the columns of a building by which it is seldom sorted."""
    return [
        Column(_("Pieces"), 8, _of("pieces"), COUNT),
        Column(_("Pieces, very high"), 8, _of("very_high"), COUNT),
        Column(_("Pieces, high"), 8, _of("high"), COUNT),
        Column(_("Pieces, medium"), 8, _of("medium"), COUNT),
        Column(_("Pieces, low"), 8, _of("low"), COUNT),
        Column(_("Anchored"), 10, _of("anchored"), COUNT),
        Column(_("Falls avoided by the work list"), 11, _of("falls_avoided"), SUM),
        Column(_("Known costs"), 10, _of("cost"), COUNT),
        Column(_("Pieces without a cost"), 10, _of("works_without_cost"), COUNT),
        Column(_("Ground PGA [g]"), 9, _of("ground_pga_g"), "0.000"),
        Column(_("Largest PFA [g]"), 9, _of("largest_pfa_g"), "0.000"),
        Column(_("Latitude [deg]"), 10, _of("latitude"), "0.00000"),
        Column(_("Longitude [deg]"), 11, _of("longitude"), "0.00000"),
        Column(_("Floors with motions of their own"), 10, _of("own_motions"), COUNT),
        Column(_("Warnings"), 9, _of("warnings"), COUNT),
    ]


def _write_types(pen: Pen, page: Any, content: CityContent) -> None:
    columns = [
        Column(_("Inventory and basis"), 36, lambda one: say.name_group(one[0])),
        Column(_("Type"), 36, lambda one: _(one[1].label)),
        Column(_("Pieces"), 10, lambda one: one[1].pieces, COUNT),
        Column(_("Buildings"), 10, lambda one: one[1].buildings, COUNT),
        Column(_("Expected falls"), 12, lambda one: one[1].expected_falls, SUM),
    ]
    pen.listing(page, columns, [(group, one) for group in content.totals.groups for one in group.first_types])


def _write_pieces(pen: Pen, page: Any, content: CityContent) -> None:
    """Write the pieces at the head of the buildings' work lists, building by building in the order of the ranking."""
    columns = [
        Column(_("File"), 28, lambda one: one[0]["path"]),
        Column(_("Building"), 30, lambda one: one[0]["building"]),
        Column(_("Inventory"), 16, lambda one: say.name_inventory(one[0]["inventory"])),
        Column(_("Place on its work list"), 9, lambda one: one[1]["work_place"], COUNT),
        Column(_("Item"), 12, lambda one: one[1]["item"]),
        Column(_("Floor"), 8, lambda one: one[1]["floor"]),
        Column(_("Room"), 16, lambda one: one[1]["room"]),
        Column(_("What"), 26, lambda one: say_kind(one[1])),
        Column(_("Size [cm]"), 16, lambda one: say_size(one[1])),
        Column(_("Pieces"), 8, lambda one: one[1]["quantity"], COUNT),
        Column(_("Class"), 18, lambda one: label_piece(one[1], one[0]["basis"])[0]),
        Column(_("Chance"), 9, lambda one: one[1]["probability"], CHANCE),
        Column(_("Interval, low"), 9, lambda one: one[1]["probability_low"], CHANCE),
        Column(_("Interval, high"), 9, lambda one: one[1]["probability_high"], CHANCE),
        Column(_("Route"), 16, lambda one: one[1]["route"]),
        Column(_("How to fix it"), 24, lambda one: one[1]["detail"]),
        Column(_("Unit cost"), 10, lambda one: one[1]["unit_cost"], COUNT),
    ]
    pen.listing(page, columns, list_first_pieces(content))


def list_first_pieces(content: CityContent) -> list[tuple[Row, Row]]:
    """Return building and piece: the first of every work list, then the second, in the order of the ranking."""
    ranked = [
        (row["work_place"], at, building, row)
        for at, building in enumerate(content.buildings)
        for row in content.pieces.get(building["path"], [])
        if row["work_place"] is not None
    ]
    ranked.sort(key=lambda one: one[:2])
    return [(building, row) for _place, _at, building, row in ranked[:MOST_PIECES]]


def _write_routes(pen: Pen, page: Any, content: CityContent) -> None:
    columns = [
        Column(_("File"), 28, _of("path")),
        Column(_("Route"), 22, _of("route")),
        Column(_("State"), 14, lambda row: label_state(row["state"])),
        Column(_("Chance of a blockage"), 10, _of_known("probability"), CHANCE),
        Column(_("Interval, low"), 9, _of_known("probability_low"), CHANCE),
        Column(_("Interval, high"), 9, _of_known("probability_high"), CHANCE),
        Column(_("People"), 8, _of("occupants"), COUNT),
        Column(_("Pieces that may block it"), 40, _of("blockers")),
        Column(_("To fill in"), 40, _of("to_fill_in")),
    ]
    rows = [row for building in content.buildings for row in content.routes.get(building["path"], [])]
    pen.listing(page, columns, rows)


def _write_skipped(pen: Pen, page: Any, content: CityContent) -> None:
    names = {building["path"]: building["building"] for building in content.skipped}
    columns = [
        Column(_("File"), 36, _of("path")),
        Column(_("Building"), 30, lambda row: names[row["path"]]),
        Column(_("Severity"), 10, lambda row: say_severity(row["severity"] or "")),
        Column(_("Place"), 16, say_spot),
        Column(_("What"), 70, _of("message")),
        Column(_("How to fix it"), 50, _of("fix")),
    ]
    rows = [row for building in content.skipped for row in content.problems.get(building["path"], [])]
    pen.listing(page, columns, rows[:MOST_PROBLEMS])


def _write_notes(pen: Pen, page: Any, content: CityContent) -> None:
    rule = _(
        "Pieces to fix first: the first piece of every building's work list, in the order of the buildings, then the "
        "second ones; {most:,} rows at most, all are in the table pieces.", most=MOST_PIECES,
    )  # fmt: skip
    texts = [
        _(BUILDING_RULE), _(TYPE_RULE), rule, *(f"{label}: {value}" for label, value in made.list_basis(content.view)),
        *made.list_method(content.view, content.totals), *made.list_references(content.view, content.totals),
        words.marks(),
    ]  # fmt: skip
    pen.listing(page, [Column(_("Note"), 140, lambda text: text)], texts)


Write = Callable[[Pen, Any, CityContent], None]
SHEETS: Sequence[tuple[str, str, Write]] = (
    ("summary", fill("Summary"), _write_summary),
    ("buildings", fill("Buildings"), _write_buildings),
    ("types", fill("Types"), _write_types),
    ("pieces", fill("Pieces to fix first"), _write_pieces),
    ("routes", fill("Routes"), _write_routes),
    ("skipped", fill("Skipped"), _write_skipped),
    ("notes", fill("Notes"), _write_notes),
)
"""Key, title in English, and what writes it."""
