"""The page and the summary of a city: one document of blocks.

The page is one HTML file with the answer, a map, a ranking and a page a building; nothing is fetched. The summary is a
PDF: the answer, the map, what to start with, what is not in it, method and references.

The data of the page hold every building in short, and its rows, with texts each only once. Its script makes rows of
them when a building is opened, as text alone: nothing of it is ever read as HTML.
"""

import json
import shlex
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import Any, NamedTuple

from assess.delivery.folders import private_folder
from assess.environment import find_source_date
from assess.i18n import Text, fill, gettext as _, ngettext, number
from assess.intensity import name_mmi
from assess.portfolio import city_words as say
from assess.portfolio.background import Background
from assess.portfolio.city import BUILDING_RULE, TYPE_RULE, City, Group, Row
from assess.portfolio.city_map import (
    BY_CLASS,
    BY_ROUTES,
    BY_SHARE,
    Isoline,
    MapPoint,
    Sign,
    draw_map,
    draw_sign,
    find_share,
    sign_of_class,
    sign_of_routes,
    sign_of_share,
)
from assess.portfolio.table_schemas import INVENTORIES
from assess.progress import SILENT, Progress
from assess.report import blocks, words
from assess.report.pages.html import render_document
from assess.report.pages.pdf import print_page
from assess.report.report_options import ReportOptions
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.units import GRAVITY
from assess.version import __version__
from assess.workbook.template import CREATED

LARGE = ((10.0, 1.6), (3.0, 1.25))  # expected falls from which a mark on the map is larger, and by how much
MOST_SKIPPED, MOST_PRINTED = 200, 12
"""Skipped buildings that the page and the summary name; the ranking names all."""


def render_page(
    city: City, background: Background | None = None, *, options: ReportOptions | None = None,
    isolines: Sequence[Isoline] = (), repeat: str = "", indexed: Collection[str] = (), progress: Progress = SILENT,
) -> bytes:  # fmt: skip
    """Return the page of a city as HTML, in the language of the options.

    `repeat` is the command that assesses one building alone, with ``{path}`` in place of its workbook; `indexed` are
    the buildings of which an index fills in something.
    """
    options = options or ReportOptions()
    with options.spoken():
        document = progress.wait_for(lambda: _build_document(city, background, isolines, is_live=True))
        uses = sorted({words.cut(city.spell_use(row), 60) for row in city.ranked if row["use"]})
        used = {row["inventory"] for row in city.ranked}
        signs = {key: [(one.key, _(one.label)) for one, _count in list_legend(city, key)] for key in ("kind", "state")}
        storeys = []
        for low, high in STOREYS:
            label = _("{low} to {high}", low=low, high=high) if high < STOREYS[-1][1] else _("{low} or more", low=low)
            storeys.append((f"{low}-{high}", str(low) if low == high else label))
        more = {
            "data": progress.wait_for(lambda: write_data(city, repeat, indexed)),
            "filters": [
                ("use", _("Use"), [(use, use) for use in uses]),
                ("kind", _("Highest class"), signs["kind"]),
                ("state", _("Routes"), signs["state"]),
                ("inventory", _("Inventory"), [(one, say.name(one)) for one in INVENTORIES if one in used]),
                ("storeys", _("Storeys"), storeys),
            ],
            "map_views": [(key, _(view.label)) for key, view in VIEWS.items()] if list_points(city) else [],
        }
        return render_document(
            document, options, "city.css", script=options.read("script/city.js"), template="city.html.j2", more=more,
            progress=progress,
        ).encode()  # fmt: skip


def render_summary(
    city: City, background: Background | None = None, *, options: ReportOptions | None = None,
    isolines: Sequence[Isoline] = (), progress: Progress = SILENT,
) -> bytes:  # fmt: skip
    """Return the summary of a city as PDF/A-3u, or PDF/UA-1 if asked for: the same bytes for the same tables.

    Raises PdfUnavailableError if WeasyPrint's native libraries are missing.
    """
    options = options or ReportOptions()
    with options.spoken(), private_folder("assess-page-") as folder:
        document = progress.wait_for(lambda: _build_document(city, background, isolines, is_live=False))
        html, path = render_document(document, options, "city.css", for_print=True, progress=progress), folder / "a.pdf"
        print_page(html, path, (), options, progress, moment=find_source_date() or CREATED)
        return path.read_bytes()


def _build_document(
    city: City, background: Background | None, isolines: Sequence[Isoline], *, is_live: bool
) -> blocks.Document:
    """Return the document in the language in use; the page's template puts its controls behind sections by their id."""
    kind, title, ground = ("" if is_live else "run-on"), say.say_title(city), say.say_ground(city)
    about = _("Overturning of furniture in an earthquake: many buildings")
    status = " ".join((_("In this scenario, not per year."), words.cut(ground, 120)))
    facts = "; ".join(f"{label}: {value}" for label, value in say.list_facts(city)[:3])
    cautions: list[blocks.Block] = [blocks.Paragraph(text, "caution") for text in say.list_cautions(city)]
    groups: list[blocks.Block] = [*map(_show_group, city.groups)]
    groups = groups or [blocks.Paragraph(_("No building could be assessed."))]
    answer = [*cautions, *groups] if is_live else [*groups, *cautions]
    sections = [blocks.Section(answer, kind, "answer", _("What is expected"))]
    sections += _show_map(city, background, isolines, kind, is_live=is_live)
    if is_live:
        sections += _list_ranking(city)
    for group in city.groups:
        sections += _list_first(city, group, is_live=is_live)
    if city.skipped:
        skipped = list(_list_skipped(city, MOST_SKIPPED if is_live else MOST_PRINTED))
        sections.append(blocks.Section(skipped, kind, "skipped", _("Skipped buildings")))
    if is_live:
        name = _("Sums, kept apart")
        sections.append(blocks.Section([blocks.Box([_tabulate_sums(city)], "scroll", label=name)], "", "sums", name))
    basis = [(blocks.head(label), value) for label, value in say.list_basis(city)]
    method: list[blocks.Block] = [blocks.table([blocks.Column(), blocks.Column()], basis, "facts"),
                                  *map(blocks.Paragraph, say.list_method(city))]  # fmt: skip
    if references := say.list_references(city):
        method += [blocks.Heading(_("References")), blocks.Bullets(references)]
    made = (
        _("Made with assess {version}.", version=__version__)
        if is_live
        else _("Made with assess {version}. The page city.html has a page of every building, ranking.xlsx the whole "
               "ranking.", version=__version__)
    )  # fmt: skip
    method.append(blocks.Paragraph(made, "small"))
    sections.append(blocks.Section(method, kind, "method", _("How these numbers were made")))
    return blocks.Document(
        title=title,
        cover=[
            blocks.Paragraph(about, "kind"),
            blocks.Title(title, title, status),
            blocks.Paragraph(f"{ground} {facts}." if facts else ground),
        ],
        sections=sections,
        author="",
        description=about,
        kind="city",
    )  # fmt: skip


def _show_group(group: Group) -> blocks.Box:
    apart = group.unconfirmed + group.by_formula
    tiles = [
        blocks.Tile(words.class_name(risk), words.risk_label(risk), say.say_whole(count), _("pieces"))
        for risk, count in group.by_class.items()
    ]
    if apart:
        name = " ".join((words.UNCONFIRMED, words.BY_FORMULA, _("not counted")))
        tiles.append(blocks.Tile("apart-formula", name, say.say_whole(apart), _("unconfirmed or by formula only")))
    name = " ".join((words.ANCHORED, _("anchored")))
    tiles.append(blocks.Tile("anchored", name, say.say_whole(group.anchored), _("not classified")))
    first, *lines = say.list_group_lines(group)
    found: list[blocks.Block] = [
        blocks.Heading(say.name_group(group)),
        blocks.Paragraph(first, "lead"),
        blocks.Tiles(tiles),
        blocks.Bullets(lines),
    ]
    return blocks.Box(found, "group assumed" if group.inventory == "assumed" else "group", "article")


class SignView(NamedTuple):
    """What the signs of the map can show: how one is found, all in their order, what they show, what one stands for."""

    find: Callable[[Row], Sign]
    signs: Mapping[str, Sign]
    label: Text
    note: Text


VIEWS: Mapping[str, SignView] = {
    "share": SignView(
        sign_of_share, BY_SHARE, fill("share of the pieces expected to fall"),
        fill("Each sign is a building, by the share of its free-standing pieces that is expected to fall: its "
             "expected falls over its pieces in the classes. A building with a small share can still have pieces of "
             "very high class."),
    ),
    "kind": SignView(sign_of_class, BY_CLASS, fill("highest class of a piece"),
                     fill("Each sign is a building, by the highest class that any of its pieces has.")),
    "state": SignView(sign_of_routes, BY_ROUTES, fill("worst state of the routes"),
                      fill("Each sign is a building, by the worst state that any of its routes has.")),
}  # fmt: skip
"""Views of the map, the default first."""


def list_points(city: City) -> list[MapPoint]:
    """Return the buildings that have a place, with their signs by the share that is expected to fall."""
    return [
        MapPoint(
            at,
            city.name_building(row),
            row["latitude"],
            row["longitude"],
            sign_of_share(row),
            next((size for least, size in LARGE if (row["expected_falls"] or 0.0) >= least), 1.0),
        )
        for at, row in enumerate(city.ranked)
        if row["latitude"] is not None and row["longitude"] is not None
    ]


def list_legend(city: City, key: str) -> list[tuple[Sign, int]]:
    """Return the signs of a view of the map that are in use, the worst first, with the number of buildings."""
    counts = Counter(VIEWS[key].find(row).key for row in city.ranked)
    return [(sign, counts[sign.key]) for sign in reversed([*VIEWS[key].signs.values()]) if counts[sign.key]]


def _show_map(
    city: City, background: Background | None, isolines: Sequence[Isoline], kind: str, *, is_live: bool
) -> Iterator[blocks.Section]:
    """Yield the map with its legends; on the page two sections, as its controls stand between heading and drawing."""
    points = list_points(city)
    if not points:
        nothing = blocks.Paragraph(_("No building has Latitude and Longitude: there is nothing to draw."))
        yield from [blocks.Section([nothing], "", "map", _("Map"))] if is_live else []
        return
    title = _("Map of {placed:,} buildings; the table of the buildings holds the same", placed=len(points))
    drawn = draw_map(points, background, title=title, isolines=isolines, is_live=is_live)
    views: list[blocks.Block] = []
    for key, view in list(VIEWS.items())[: None if is_live else 1]:
        size = 20 if is_live else 14
        box = f'width="{size}" height="{size}" viewBox="-9 -9 18 18" aria-hidden="true"'
        lines: list[blocks.Words] = [
            [
                blocks.Image(f'<svg {box} data-key="{escape(sign.key)}">{draw_sign(sign)}</svg>'),
                f" {_(sign.label)}: {say.say_whole(count)}",
            ]
            for sign, count in list_legend(city, key)
        ]
        note = blocks.Paragraph(_(view.note), "map-note")
        kind_of = "map-view" if views else "map-view chosen"
        views.append(blocks.Box([blocks.Bullets(lines, "map-legend"), note], kind_of, id=f"legend-{key}"))
    notes = [
        _("The numbers beside the signs count all buildings, whatever the filters leave.") if is_live else "",
        _("Larger from 3 and from 10 expected falls. The worst lie on top."),
        _("Dashed lines: equal PGA of the ground.") if isolines else "",
        _("Background: {file}.", file=background.file) if background else "",
        _("Choose a sign to see its building. Click the map first, then the wheel zooms; drag to move. The keys + and "
          "- zoom, arrows move.") if is_live else "",
    ]  # fmt: skip
    legend = blocks.Box([*views, blocks.Paragraph(" ".join(filter(None, notes)), "map-note")], "map-side")
    figure = blocks.Figure(blocks.Image(drawn), kind="map", legend=[legend])
    if is_live:
        yield blocks.Section([], "", "map", _("Map"))
    yield blocks.Section([figure], kind, "map-drawing" if is_live else "map", "" if is_live else _("Map"))


def _list_ranking(city: City) -> list[blocks.Section]:
    """Return the head of the ranking, behind which the page has its filters, and the table that its script fills."""
    apart = _("Buildings of different inventories and bases stand in one list and are marked; their numbers are not "
              "added up.")  # fmt: skip
    without = _("This list, the filters and the pages of the buildings need JavaScript. ranking.xlsx holds the same.")
    note = blocks.Box([blocks.Paragraph(without, "caution")], tag="noscript")
    texts = _("Building"), _("Use"), _("Inventory"), _("Highest class")
    numbers = (_("Pieces"), _("Share expected to fall"), _("Expected falls"), _("5 to 95 % of earthquakes"),
               _("People on blocked routes"), _("Routes blocked"))  # fmt: skip
    columns = [*map(blocks.Column, texts), *(blocks.Column(one, is_number=True) for one in numbers)]
    return [
        blocks.Section(
            [blocks.Paragraph(f"{_(BUILDING_RULE)} {apart}"), note],
            "",
            "ranking",
            _("Buildings, those to start with first"),
        ),
        blocks.Section([blocks.Table(columns, [[]], "ranked", id="ranked")], "", "ranking-list"),
    ]


def _tabulate(columns: list[blocks.Column], rows: Iterable[Sequence[str]], caption: str = "") -> blocks.Table | None:
    found: list[Sequence[blocks.Cell | blocks.Words]] = [(blocks.head(first), *cells) for first, *cells in rows]
    return blocks.table(columns, found, "named", caption, is_named=True) if found else None


def _list_first(city: City, group: Group, *, is_live: bool) -> Iterator[blocks.Section]:
    """Yield what to start with: types on the page, whose ranking has the buildings, and both in the summary."""
    type_columns = blocks.list_columns((_("Type"), ""), (_("Pieces"), "w15", "num"), (_("Buildings"), "w15", "num"),
                                       (_("Expected falls"), "w15", "num"))  # fmt: skip
    type_rows = [
        (words.cut(_(one.label), 80), say.say_whole(one.pieces), say.say_whole(one.buildings),
         say.say_number(one.expected_falls))
        for one in group.first_types
    ]  # fmt: skip
    types = _tabulate(type_columns, type_rows, _(TYPE_RULE))
    if is_live:
        heading = _("Types to start with: {group}", group=say.name_group(group))
        yield from [blocks.Section([types], "types", "", heading)] if types else []
        return
    columns = blocks.list_columns(
        (_("Building"), ""), (_("Share expected to fall"), "w12", "num"), (_("Expected falls"), "w12", "num"),
        (_("People on blocked routes"), "w15", "num"), (_("Routes blocked"), "w12", "num"),
    )  # fmt: skip
    rows = [
        (say.mark_own_motions(words.cut(city.name_building(row), 80), row), words.percent(find_share(row)),
         say.say_falls(row), say.say_people(row), say.say_blocked(row))
        for row in group.first_buildings
    ]  # fmt: skip
    buildings = _tabulate(columns, rows, _(BUILDING_RULE)) or blocks.Paragraph(say.say_nothing(group))
    heading = _("Where to start: {group}", group=say.name_group(group))
    yield blocks.Section([buildings, *([types] if types else [])], "first run-on", "", heading)


def _list_skipped(city: City, most: int) -> Iterator[blocks.Block]:
    yield blocks.Paragraph(_("These could not be assessed. Nothing of them is in any number above."))
    columns = blocks.list_columns((_("Building"), "w30"), (_("First problem"), ""))
    rows = [
        (say.name_skipped(row["building"], row["path"]), explained or blocks.DASH)
        for row in city.skipped[:most]
        for explained in (" ".join(say.explain_skipped(city, row["path"]).split()),)
    ]
    yield from filter(None, [_tabulate(columns, rows)])
    if (left := len(city.skipped) - most) > 0:
        yield blocks.Paragraph(ngettext("{n:,} more is in ranking.xlsx.", "{n:,} more are in ranking.xlsx.", left))


def _tabulate_sums(city: City) -> blocks.Table:
    numbers = [
        _("Buildings"), _("Pieces"), *map(words.risk_label, RiskClass), _("unconfirmed or by formula only"),
        _("anchored"), _("Expected falls"), _("5 to 95 % of draws"), _("People on blocked routes"),
        _("People on routes of known state"), _("5 to 95 % of draws"), _("People on routes of unknown state"),
    ]  # fmt: skip
    rows: list[Sequence[blocks.Cell | blocks.Words]] = [
        [
            blocks.head(say.name_group(group)),
            *map(say.say_whole, (group.buildings, group.pieces, *group.by_class.values())),
            say.say_whole(group.unconfirmed + group.by_formula),
            say.say_whole(group.anchored),
            say.say_number(group.falls.expected),
            say.say_range(group.falls.low, group.falls.high),
            say.say_number(group.people.expected) if group.people_known else blocks.DASH,
            say.say_whole(group.people_known or None),
            say.say_range(group.people.low, group.people.high) if group.people_known else blocks.DASH,
            say.say_whole(group.people_not_known),
        ]
        for group in city.groups
    ]
    columns = [
        blocks.Column(_("Buildings by inventory and basis")),
        *(blocks.Column(one, is_number=True) for one in numbers),
    ]
    return blocks.table(columns, rows, "sums")


MOST_ROWS = 150  # rows of one table of a building that the page holds; the tables of the portfolio have all
LONGEST = 300  # characters of a text that the page holds
STOREYS = ((1, 1), (2, 3), (4, 7), (8, 300))  # groups of storeys in the filter


def write_data(city: City, repeat: str, indexed: Collection[str] = ()) -> str:
    """Return the data of the page as JSON that may stand inside a script element; parameters as `render_page`."""
    buildings = []
    for row in city.ranked:
        # the cells of the ranking after the first, in its columns; the class is written by its sign
        cells = [str(row["use"] or ""), "", "", *("" for _at in range(6))]
        command = ""
        if row["status"] == "assessed":
            basis = "" if row["basis"] == "simulated" else f", {say.name(row['basis'])}"
            cells = [
                words.cut(str(row["use"] or ""), 60),
                say.mark_own_motions(f"{say.name(row['inventory'])}{basis}", row), "",
                say.say_whole(row["pieces"]), words.percent(find_share(row)), say.say_falls(row),
                say.say_range(row["falls_p05"], row["falls_p95"]), say.say_people(row), say.say_blocked(row),
            ]  # fmt: skip
            if repeat and row["inventory"] == "surveyed" and row["path"].isprintable():
                command = repeat.replace("{path}", shlex.quote(row["path"]))
        buildings.append({
            "name": words.cut(city.name_building(row), LONGEST), "path": words.cut(row["path"], LONGEST),
            "share": sign_of_share(row).key, "kind": sign_of_class(row).key, "state": sign_of_routes(row).key,
            "use": words.cut(city.spell_use(row), 60), "inventory": row["inventory"] or "",
            "basis": row["basis"] or "", "storeys": row["storeys"], "cells": cells,
            "facts": [words.cut(text, LONGEST) for text in _list_facts(row)],
            "command": command, "indexed": row["path"] in indexed,
        })  # fmt: skip
    apart = {words.ANCHORED: "anchored", words.UNCONFIRMED: "apart-unconfirmed", words.BY_FORMULA: "apart-formula"}
    data = {
        "heads": [
            _("File"), _("Inventory"), _("Results"), _("Use"), _("Place"), _("Storeys"), _("Height [m]"),
            _("Ground motion"), _("Largest PFA of its floors [g]"), _("Standard deviation of ln PFA"),
            _("Pieces by class"), _("Expected falls"), _("Share of its pieces in the classes that is expected to fall"),
            _("Falls with few and with many pieces (10 and 90 % quantities)"), _("People on blocked routes"),
            _("Falls that the work list avoids"), _("Known costs"),
        ],
        "buildings": buildings,
        "tables": _pack_tables(city),
        "styles": {
            **dict(zip("○◇▲■", ("low", "medium", "high", "very-high"), strict=True)),
            **apart,
            **{state.symbol: f"way-state {state.replace(' ', '-')}" for state in RouteState},
        },
    }  # fmt: skip
    text = json.dumps(data, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _list_facts(row: Row) -> list[str]:
    """Return what the page of a building says of it, in the order of the heads of `write_data`; nothing if skipped."""
    if row["status"] != "assessed":
        return []
    ground = _("the floors have motions of their own")
    if (pga_g := row["ground_pga_g"]) is not None:
        source = {
            "shakemap": _("ShakeMap"), "scenarios": _("scenarios"), "ground_pga": _("Ground PGA as given"),
            "sds": _("SDS as given"), "shaking": _("assumed from the intensity"),
        }.get(row["ground_source"] or "", "")  # fmt: skip
        own = _("; {floors} floors keep a motion of their own", floors=row["own_motions"]) if row["own_motions"] else ""
        pgv = row["ground_pgv_cm_s"]
        intensity = name_mmi(pga_g * GRAVITY, None if pgv is None else pgv / 100)
        peaks = [_("PGA {pga} g", pga=words.in_g(pga_g))]
        peaks += [] if pgv is None else [_("PGV {pgv} cm/s", pgv=words.fixed(pgv, 1))]
        peaks += [_("about {intensity}", intensity=_(intensity))] if intensity else []
        ground = _("{peaks} ({source}){own}", peaks=", ".join(peaks), source=source, own=own)
    named = {
        "low": _("low"), "medium": _("medium"), "high": _("high"), "very_high": _("very high"),
        "unconfirmed": _("unconfirmed"), "by_formula": _("by formula only"), "anchored": _("anchored"),
        "left_out": _("left out of the COBie file"),
    }  # fmt: skip
    falls = say.say_falls(row)
    if row["falls_p05"] is not None and row["falls_p95"] is not None:
        falls = _("{expected}; in nine of ten earthquakes like this one {range}",
                  expected=falls, range=say.say_range(row["falls_p05"], row["falls_p95"]))  # fmt: skip
    assumed = ""
    if row["inventory"] == "assumed":
        assumed = say.say_range(row["falls_low_inventory"], row["falls_high_inventory"], say.say_number)
    if row["cost"] is None:
        cost = _("not known") if row["works"] else ""
    else:
        missing = say.say_whole(row["works_without_cost"]) if row["works_without_cost"] else ""
        cost = say.say_whole(row["cost"]) + (
            _(" and {pieces} pieces without a cost", pieces=missing) if missing else ""
        )
    is_placed = row["latitude"] is not None and row["longitude"] is not None
    return [
        str(row["path"]),
        say.name(row["inventory"]),
        say.name(row["basis"]),
        str(row["use"] or words.DASH),
        f"{number(row['latitude'], '.5f')}, {number(row['longitude'], '.5f')}" if is_placed else words.DASH,
        say.say_whole(row["storeys"]),
        words.fixed(row["height_m"], 1),
        ground,
        words.in_g(row["largest_pfa_g"]),
        words.fixed(row["motion_uncertainty"], 2),
        "; ".join(f"{label} {say.say_whole(row[name])}" for name, label in named.items() if row[name]),
        falls,
        words.percent(find_share(row)),
        assumed,
        say.say_people(row),
        say.say_number(row["falls_avoided"]),
        cost,
    ]


def _pack_tables(city: City) -> dict[str, Any]:
    """Return the rows of all buildings by table: per column its distinct texts, and per row their numbers."""

    def order(row: Row) -> tuple[float, float, int]:
        """Pieces as the building's work list has them, then the others, the likeliest to fall first."""
        place = float("inf") if row["work_place"] is None else row["work_place"]
        return place, -(row["probability"] or 0.0), row["row"] or 0

    def read_piece(row: Row, basis: str | None) -> list[str]:
        place = "" if row["work_place"] is None else say.say_whole(row["work_place"])
        return [
            row["item"] or "", row["floor"] or "", row["room"] or "", row["description"] or row["type"] or "",
            say.say_size(row), say.say_whole(row["quantity"]), say.label_piece(row, basis), say.say_probability(row),
            place, row["detail"] or "",
        ]  # fmt: skip

    pieces = {path: sorted(rows, key=order) for path, rows in city.pieces_of.items()}
    packed: dict[str, Any] = {}
    for name, heads, numeric, rows_of, read in (
        ("pieces", [_("Item"), _("Floor"), _("Room"), _("What"), _("Size [cm]"), _("Pieces"), _("Class"), _("Chance"),
                    _("Fix: place"), _("How to fix it")], [5, 7, 8], pieces, read_piece),
        ("routes", [_("Route"), _("State"), _("Chance of a blockage"), _("People"), _("Pieces that may block it"),
                    _("To fill in")], [2, 3], city.routes_of,
         lambda row, _basis: [
             row["route"] or "", say.label_state(row["state"]), say.say_probability(row),
             say.say_whole(row["occupants"]), row["blockers"] or "", row["to_fill_in"] or "",
         ]),
        ("problems", [_("Severity"), _("Place"), _("What"), _("How to fix it")], [], city.problems_of,
         lambda row, _basis: [say.name(row["severity"]), say.say_spot(row), row["message"] or "", row["fix"] or ""]),
    ):  # fmt: skip
        known: list[dict[str, int]] = [{} for _head in heads]
        columns: list[list[int]] = [[] for _head in heads]
        starts, left = [0], []
        for building in city.ranked:
            rows = rows_of.get(building["path"], [])
            for row in rows[:MOST_ROWS]:
                for texts, column, text in zip(known, columns, read(row, building["basis"]), strict=True):
                    column.append(texts.setdefault(words.cut(text, LONGEST), len(texts)))
            starts.append(len(columns[0]))
            left.append(max(0, len(rows) - MOST_ROWS))
        packed[name] = {"heads": heads, "numeric": numeric, "texts": [list(one) for one in known], "columns": columns,
                        "starts": starts, "left": left}  # fmt: skip
    return packed
