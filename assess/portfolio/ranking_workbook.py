"""ranking.xlsx: the sums, every building, types, the pieces to fix first, routes, what was skipped, and notes.

Numbers are numbers, and every text stays text: no name becomes a formula or a link.
"""

from collections.abc import Callable, Sequence
from functools import partial
from operator import attrgetter, itemgetter
from typing import Any

from assess.delivery.folders import private_folder
from assess.environment import find_source_date
from assess.i18n import fill, gettext as _
from assess.portfolio import city_words as say
from assess.portfolio.city import BUILDING_RULE, TYPE_RULE, City, Group, Row
from assess.portfolio.city_map import find_share, sign_of_class
from assess.progress import SILENT, Progress
from assess.report.report_options import ReportOptions
from assess.report.xlsx.pen import CHANCE, COUNT, Column, Pen, write_sheets
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.workbook.template import CREATED

SUM = "#,##0.0"
"""How Excel shows an expected number."""
MOST_PIECES = 500  # pieces that the sheet of what to fix first holds; the tables of the portfolio have all
MOST_PROBLEMS = 5_000  # problems that the sheet of skipped buildings holds


def render_ranking(city: City, *, options: ReportOptions | None = None, progress: Progress = SILENT) -> bytes:
    """Return the ranking of a city as a workbook, the same for the same tables; OSError if there is no room."""
    options = options or ReportOptions()
    with options.spoken(), private_folder("assess-page-") as folder:
        progress.wait_for(lambda: city.groups)
        title = say.say_title(city)
        sheets = [(key, _(name), partial(_write_list, find, city)) for key, name, find in LISTS]
        write_sheets(
            folder / "ranking.xlsx",
            [("summary", _("Summary"), partial(_write_summary, city)), *sheets],
            title=title, created=(find_source_date() or CREATED).replace(tzinfo=None),
            texts=(title, "", say.say_ground(city)[:120]), progress=progress,
        )  # fmt: skip
        return (folder / "ranking.xlsx").read_bytes()


def _write_list(find: Callable[[City], "Listing"], city: City, pen: Pen, page: Any) -> None:
    pen.listing(page, *find(city))


def _write_summary(city: City, pen: Pen, page: Any) -> None:
    page.set_column(0, 0, 62)
    page.set_column(1, 1 + len(city.groups), 24)
    texts = [(say.say_title(city), "title"), (say.say_ground(city), "plain")]
    texts += [(f"{label}: {value}", "plain") for label, value in say.list_facts(city)]
    texts += [(text, "warning") for text in say.list_cautions(city)]
    for group in city.groups:
        texts.append((say.name_group(group), "heading"))
        texts += [(text, "plain") for text in say.list_group_lines(group)]
    for row, (text, look) in enumerate(texts):
        pen.put(page, row, 0, text, pen.style(look))
    top = len(texts) + 1
    labels = [_("Sums, kept apart"), *map(say.name_group, city.groups)]
    pen.heads(page, labels, [62, *(24 for _group in city.groups)], top)
    for row, (label, read, form) in enumerate(_list_sums(), top + 1):
        pen.put(page, row, 0, label, pen.style("plain"))
        for at, group in enumerate(city.groups, 1):
            pen.put(page, row, at, read(group), pen.style("plain", form))


def _list_sums() -> list[tuple[str, Callable[[Group], float | None], str]]:
    return [
        (_("Buildings"), attrgetter("buildings"), COUNT),
        (_("Pieces"), attrgetter("pieces"), COUNT),
        (_("Pieces of class low"), lambda group: group.by_class[RiskClass.LOW], COUNT),
        (_("Pieces of class medium"), lambda group: group.by_class[RiskClass.MEDIUM], COUNT),
        (_("Pieces of class high"), lambda group: group.by_class[RiskClass.HIGH], COUNT),
        (_("Pieces of class very high"), lambda group: group.by_class[RiskClass.VERY_HIGH], COUNT),
        (_("Unconfirmed pieces, in no class"), attrgetter("unconfirmed"), COUNT),
        (_("Pieces by formula only, in no class"), attrgetter("by_formula"), COUNT),
        (_("Pieces on castors, in no class"), attrgetter("rolls"), COUNT),
        (_("Anchored pieces, in no class"), attrgetter("anchored"), COUNT),
        (_("Components left out of COBie files, in no number"), attrgetter("left_out"), COUNT),
        (_("Expected falls"), attrgetter("falls.expected"), SUM),
        (_("Falls that 5 % of the earthquakes do not exceed"), attrgetter("falls.low"), COUNT),
        (_("Falls that 95 % of the earthquakes do not exceed"), attrgetter("falls.high"), COUNT),
        (_("Expected falls, sampling interval, low"), attrgetter("falls.sampling_low"), SUM),
        (_("Expected falls, sampling interval, high"), attrgetter("falls.sampling_high"), SUM),
        (_("Expected falls that are in no range"), attrgetter("falls.apart"), SUM),
        (_("Expected falls with few pieces (10 % quantities)"), attrgetter("falls_low_inventory"), SUM),
        (_("Expected falls with many pieces (90 % quantities)"), attrgetter("falls_high_inventory"), SUM),
        (_("Falls that the work lists avoid"), attrgetter("falls_avoided"), SUM),
        (_("People on routes whose state is known"), attrgetter("people_known"), COUNT),
        (
            _("Expected people on blocked routes"),
            lambda group: group.people.expected if group.people_known else None,
            SUM,
        ),
        (
            _("People that 5 % of the earthquakes do not exceed"),
            lambda group: group.people.low if group.people_known else None,
            COUNT,
        ),
        (
            _("People that 95 % of the earthquakes do not exceed"),
            lambda group: group.people.high if group.people_known else None,
            COUNT,
        ),
        (_("People on routes whose state is not known"), attrgetter("people_not_known"), COUNT),
        (_("Routes open"), lambda group: group.routes[RouteState.OPEN], COUNT),
        (_("Routes doubtful"), lambda group: group.routes[RouteState.DOUBTFUL], COUNT),
        (_("Routes blocked"), lambda group: group.routes[RouteState.BLOCKED], COUNT),
        (_("Routes not known"), lambda group: group.routes[RouteState.NOT_KNOWN], COUNT),
        (_("Pieces on the work lists"), attrgetter("works"), COUNT),
        (_("Known costs of the work"), attrgetter("cost"), COUNT),
        (_("Pieces on the work lists without a cost"), attrgetter("works_without_cost"), COUNT),
    ]


Listing = tuple[list[Column], Sequence[Any]]  # the columns of a sheet, and its rows


def _list_buildings(city: City) -> Listing:
    def find_blocked(row: Row) -> int | str | None:
        """Return the routes that are blocked, as a number; what is not known is said where it is so of all routes."""
        if row["routes"] and row["routes_not_known"] < row["routes"]:
            return int(row["routes_blocked"])
        return say.say_blocked(row) if row["status"] == "assessed" else None

    return [
        Column(_("File"), 28, itemgetter("path")),
        Column(_("Building"), 30, itemgetter("building")),
        Column(_("Inventory"), 16, lambda row: say.name(row["inventory"])),
        Column(_("Results"), 14, lambda row: say.name(row["basis"])),
        Column(_("Use"), 12, itemgetter("use")),
        Column(_("Storeys"), 8, itemgetter("storeys"), COUNT),
        Column(_("Highest class"), 14, lambda row: f"{sign_of_class(row).symbol} {_(sign_of_class(row).label)}"),
        Column(_("Share expected to fall"), 10, find_share, CHANCE),
        Column(_("Expected falls"), 10, itemgetter("expected_falls"), SUM),
        Column(_("Unconfirmed"), 12, itemgetter("unconfirmed"), COUNT),
        Column(_("By formula only"), 10, itemgetter("by_formula"), COUNT),
        Column(_("Left out of the COBie file"), 10, itemgetter("left_out"), COUNT),
        Column(_("Falls, 5 % of earthquakes"), 11, itemgetter("falls_p05"), COUNT),
        Column(_("Falls, 95 % of earthquakes"), 11, itemgetter("falls_p95"), COUNT),
        Column(_("People on blocked routes, expected"), 12, itemgetter("people_blocked"), SUM),
        Column(_("People on routes whose state is known"), 11, lambda row: None if row["occupants"] is None
               else row["occupants"] - (row["people_not_known"] or 0), COUNT),
        Column(_("People on routes not known"), 10, itemgetter("people_not_known"), COUNT),
        Column(_("Routes blocked"), 9, find_blocked, COUNT),
        Column(_("Routes not known"), 9, itemgetter("routes_not_known"), COUNT),
        Column(_("Pieces"), 8, itemgetter("pieces"), COUNT),
        Column(_("Pieces, very high"), 8, itemgetter("very_high"), COUNT),
        Column(_("Pieces, high"), 8, itemgetter("high"), COUNT),
        Column(_("Pieces, medium"), 8, itemgetter("medium"), COUNT),
        Column(_("Pieces, low"), 8, itemgetter("low"), COUNT),
        Column(_("Anchored"), 10, itemgetter("anchored"), COUNT),
        Column(_("Falls avoided by the work list"), 11, itemgetter("falls_avoided"), SUM),
        Column(_("Known costs"), 10, itemgetter("cost"), COUNT),
        Column(_("Pieces without a cost"), 10, itemgetter("works_without_cost"), COUNT),
        Column(_("Ground PGA [g]"), 9, itemgetter("ground_pga_g"), "0.000"),
        Column(_("Largest PFA [g]"), 9, itemgetter("largest_pfa_g"), "0.000"),
        Column(_("Latitude [deg]"), 10, itemgetter("latitude"), "0.00000"),
        Column(_("Longitude [deg]"), 11, itemgetter("longitude"), "0.00000"),
        Column(_("Floors with motions of their own"), 10, itemgetter("own_motions"), COUNT),
        Column(_("Warnings"), 9, itemgetter("warnings"), COUNT),
    ], city.ranked  # fmt: skip


def _list_types(city: City) -> Listing:
    return [
        Column(_("Inventory and basis"), 36, lambda one: say.name_group(one[0])),
        Column(_("Type"), 36, lambda one: _(one[1].label)),
        Column(_("Pieces"), 10, lambda one: one[1].pieces, COUNT),
        Column(_("Buildings"), 10, lambda one: one[1].buildings, COUNT),
        Column(_("Expected falls"), 12, lambda one: one[1].expected_falls, SUM),
    ], [(group, one) for group in city.groups for one in group.first_types]


def _list_pieces(city: City) -> Listing:
    return [
        Column(_("File"), 28, itemgetter("path")),
        Column(_("Building"), 30, itemgetter("building")),
        Column(_("Inventory"), 16, lambda row: say.name(row["inventory"])),
        Column(_("Place on its work list"), 9, itemgetter("work_place"), COUNT),
        Column(_("Item"), 12, itemgetter("item")),
        Column(_("Floor"), 8, itemgetter("floor")),
        Column(_("Room"), 16, itemgetter("room")),
        Column(_("What"), 26, lambda row: row["description"] or row["type"]),
        Column(_("Size [cm]"), 16, say.say_size),
        Column(_("Pieces"), 8, itemgetter("quantity"), COUNT),
        Column(_("Class"), 18, lambda row: say.label_piece(row, row["main_basis"])),
        Column(_("Chance"), 9, itemgetter("probability"), CHANCE),
        Column(_("Interval, low"), 9, itemgetter("probability_low"), CHANCE),
        Column(_("Interval, high"), 9, itemgetter("probability_high"), CHANCE),
        Column(_("Route"), 16, itemgetter("route")),
        Column(_("How to fix it"), 24, itemgetter("detail")),
        Column(_("Unit cost"), 10, itemgetter("unit_cost"), COUNT),
    ], list_first_pieces(city)


def list_first_pieces(city: City) -> list[Row]:
    """Return the first piece of every work list, then the second, in the order of the ranking, with its building."""
    ranked = [
        (row["work_place"], at, row, building)
        for at, building in enumerate(city.ranked)
        for row in city.pieces_of.get(building["path"], [])
        if row["work_place"] is not None
    ]
    ranked.sort(key=lambda one: one[:2])
    return [
        {**row, "building": one["building"], "inventory": one["inventory"], "main_basis": one["basis"]}
        for _place, _at, row, one in ranked[:MOST_PIECES]
    ]


def _list_routes(city: City) -> Listing:
    rows = [row for building in city.ranked for row in city.routes_of.get(building["path"], [])]
    no_chance = dict.fromkeys(("probability", "probability_low", "probability_high"))  # it would leave out something
    return [
        Column(_("File"), 28, itemgetter("path")),
        Column(_("Route"), 22, itemgetter("route")),
        Column(_("State"), 14, lambda row: say.label_state(row["state"])),
        Column(_("Chance of a blockage"), 10, itemgetter("probability"), CHANCE),
        Column(_("Interval, low"), 9, itemgetter("probability_low"), CHANCE),
        Column(_("Interval, high"), 9, itemgetter("probability_high"), CHANCE),
        Column(_("People"), 8, itemgetter("occupants"), COUNT),
        Column(_("Pieces that may block it"), 40, itemgetter("blockers")),
        Column(_("To fill in"), 40, itemgetter("to_fill_in")),
    ], [{**row, **no_chance} if row["state"] == RouteState.NOT_KNOWN else row for row in rows]


def _list_skipped(city: City) -> Listing:
    names = {row["path"]: row["building"] for row in city.skipped}
    return [
        Column(_("File"), 36, itemgetter("path")),
        Column(_("Building"), 30, lambda row: names[row["path"]]),
        Column(_("Severity"), 10, lambda row: say.name(row["severity"])),
        Column(_("Place"), 16, say.say_spot),
        Column(_("What"), 70, itemgetter("message")),
        Column(_("How to fix it"), 50, itemgetter("fix")),
    ], [row for path in names for row in city.problems_of.get(path, [])][:MOST_PROBLEMS]


def _list_notes(city: City) -> Listing:
    rule = _(
        "Pieces to fix first: the first piece of every building's work list, in the order of the buildings, then the "
        "second ones; {most:,} rows at most, all are in the table pieces.", most=MOST_PIECES,
    )  # fmt: skip
    texts = [
        _(BUILDING_RULE), _(TYPE_RULE), rule, *(f"{label}: {value}" for label, value in say.list_basis(city)),
        *say.list_method(city), *say.list_references(city),
    ]  # fmt: skip
    return [Column(_("Note"), 140, str)], texts


LISTS: Sequence[tuple[str, str, Callable[[City], Listing]]] = (
    ("buildings", fill("Buildings"), _list_buildings),
    ("types", fill("Types"), _list_types),
    ("pieces", fill("Pieces to fix first"), _list_pieces),
    ("routes", fill("Routes"), _list_routes),
    ("skipped", fill("Skipped"), _list_skipped),
    ("notes", fill("Notes"), _list_notes),
)
"""The sheets that are one table: key, title in English, and what returns it."""
