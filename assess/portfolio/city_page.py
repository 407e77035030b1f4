"""The page and the summary of a city: one document of blocks.

The page is one HTML file with the answer, a map, a ranking and a page a building; nothing is fetched. The summary is a
PDF: the answer, the map, what to start with, what is not in it, method and references.
"""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import NamedTuple

from assess.delivery.folders import private_folder
from assess.environment import find_source_date
from assess.i18n import Text, fill, ngettext
from assess.i18n import gettext as _
from assess.portfolio import city_words as say
from assess.portfolio.background import Background
from assess.portfolio.building_signs import (
    BY_CLASS,
    BY_ROUTES,
    BY_SHARE,
    Sign,
    find_share,
    say_sign,
    sign_of_class,
    sign_of_routes,
    sign_of_share,
)
from assess.portfolio.city import BUILDING_RULE, TYPE_RULE, City, Group, Row
from assess.portfolio.city_map import Isoline, MapPoint, draw_map, draw_sign
from assess.portfolio.page_data import STOREYS, list_heads, write_data
from assess.portfolio.table_schemas import INVENTORIES
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.blocks import (
    DASH,
    Block,
    Box,
    Bullets,
    Cell,
    Column,
    Document,
    Figure,
    Heading,
    Image,
    Paragraph,
    Section,
    Table,
    Tile,
    Tiles,
    Title,
    Words,
    head,
    list_columns,
    table,
)
from assess.report.pages.html import render_document
from assess.report.pages.pdf import print_page
from assess.report.report_options import ReportOptions
from assess.risk import RiskClass
from assess.version import __version__
from assess.workbook.template import CREATED

LARGE = ((10.0, 1.6), (3.0, 1.25))
"""Expected falls from which a mark on the map is larger, and by how much."""
MOST_SKIPPED, MOST_PRINTED = 200, 12
"""Skipped buildings that the page and the summary name; the ranking names all."""


def render_page(
    city: City,
    background: Background | None = None,
    *,
    options: ReportOptions | None = None,
    isolines: Sequence[Isoline] = (),
    repeat: str = "",
    indexed: Collection[str] = (),
    progress: Progress = SILENT,
) -> bytes:
    """Return the page of a city as HTML, in the language of the options.

    Parameters
    ----------
    city : City
        The tables of the portfolio.
    background : Background, optional
        What lies behind the map.
    options : ReportOptions, optional
        Language and templates.
    isolines : sequence of Isoline
        Lines of equal shaking on the map.
    repeat : str
        Command that assesses one building alone, with ``{path}`` in place of its workbook.
    indexed : collection of str
        Paths of the buildings of which an index fills in something.

    Raises
    ------
    InputError
        If a template cannot be used.
    CancelledError
        If the work was cancelled.
    """
    options = options or ReportOptions()
    with options.spoken():
        document = progress.wait_for(lambda: _build_document(city, background, isolines, is_live=True))
        more = {
            "data": progress.wait_for(lambda: write_data(city, repeat, indexed)),
            "filters": _list_filters(city),
            "map_views": [(key, _(view.label)) for key, view in VIEWS.items()] if list_points(city) else [],
        }
        script = options.read("script/city.js")
        return render_document(
            document, options, "city.css", script=script, template="city.html.j2", more=more, progress=progress
        ).encode()


def render_summary(
    city: City,
    background: Background | None = None,
    *,
    options: ReportOptions | None = None,
    isolines: Sequence[Isoline] = (),
    progress: Progress = SILENT,
) -> bytes:
    """Return the summary of a city as PDF/A-3u, or PDF/UA-1 where the options ask for it.

    Its date is SOURCE_DATE_EPOCH or a fixed one: the same tables give the same bytes.

    Raises
    ------
    PdfUnavailableError
        If WeasyPrint's native libraries are missing.
    InputError
        If a template cannot be used.
    CancelledError
        If the work was cancelled.
    """
    options = options or ReportOptions()
    with options.spoken(), private_folder("assess-page-") as folder:
        document = progress.wait_for(lambda: _build_document(city, background, isolines, is_live=False))
        html, path = render_document(document, options, "city.css", for_print=True, progress=progress), folder / "a.pdf"
        print_page(html, path, (), options, progress, moment=find_source_date() or CREATED)
        return path.read_bytes()


def _build_document(
    city: City, background: Background | None, isolines: Sequence[Isoline], *, is_live: bool
) -> Document:
    """Return the document in the language in use; the page's template puts its controls behind sections by their id."""
    kind, title, ground = ("" if is_live else "run-on"), say.say_title(city), say.say_ground(city)
    about = _("Overturning of furniture in an earthquake: many buildings")
    status = " ".join((_("In this scenario, not per year."), words.cut(ground, 120)))
    facts = "; ".join(f"{label}: {value}" for label, value in say.list_facts(city)[:3])
    cautions: list[Block] = [Paragraph(text, "caution") for text in say.list_cautions(city)]
    groups: list[Block] = [*map(_show_group, city.groups)]
    groups = groups or [Paragraph(_("No building could be assessed."))]
    answer = [*cautions, *groups] if is_live else [*groups, *cautions]
    sections = [Section(answer, kind, "answer", _("What is expected"))]
    sections += _show_map(city, background, isolines, kind, is_live=is_live)
    if is_live:
        sections += _list_ranking(city)
    for group in city.groups:
        types = _tabulate_types(group)
        if is_live and types:
            heading = _("Types to start with: {group}", group=say.name_group(group))
            sections.append(Section([types], "types", "", heading))
        elif not is_live:
            buildings = _tabulate_first(city, group) or Paragraph(say.say_nothing(group))
            heading = _("Where to start: {group}", group=say.name_group(group))
            sections.append(Section([buildings, *([types] if types else [])], "first run-on", "", heading))
    if city.skipped:
        most = MOST_SKIPPED if is_live else MOST_PRINTED
        sections.append(Section(list(_list_skipped(city, most)), kind, "skipped", _("Skipped buildings")))
    if is_live:
        name = _("Sums, kept apart")
        sections.append(Section([Box([_tabulate_sums(city)], "scroll", label=name)], "", "sums", name))
    method = list(_describe_method(city, is_live=is_live))
    sections.append(Section(method, kind, "method", _("How these numbers were made")))
    return Document(
        title=title,
        cover=[
            Paragraph(about, "kind"), Title(title, title, status), Paragraph(f"{ground} {facts}." if facts else ground),
        ],
        sections=sections,
        author="",
        description=about,
        kind="city",
    )  # fmt: skip


def _show_group(group: Group) -> Box:
    apart = group.unconfirmed + group.by_formula
    tiles = [
        Tile(words.class_name(risk), words.risk_label(risk), say.say_whole(count), _("pieces"))
        for risk, count in group.by_class.items()
    ]
    if apart:
        name = " ".join((words.UNCONFIRMED, words.BY_FORMULA, _("not counted")))
        tiles.append(Tile("apart-formula", name, say.say_whole(apart), _("unconfirmed or by formula only")))
    name = " ".join((words.ANCHORED, _("anchored")))
    tiles.append(Tile("anchored", name, say.say_whole(group.anchored), _("not classified")))
    first, *lines = say.list_group_lines(group)
    blocks: list[Block] = [Heading(say.name_group(group)), Paragraph(first, "lead"), Tiles(tiles), Bullets(lines)]
    return Box(blocks, "group assumed" if group.inventory == "assumed" else "group", "article")


# ---------------------------------------------------------------- the map and the filters


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
) -> Iterator[Section]:
    """Yield the map with its legends; on the page two sections, as its controls stand between heading and drawing."""
    points = list_points(city)
    if not points:
        nothing = Paragraph(_("No building has Latitude and Longitude: there is nothing to draw."))
        yield from [Section([nothing], "", "map", _("Map"))] if is_live else []
        return
    title = _("Map of {placed:,} buildings; the table of the buildings holds the same", placed=len(points))
    drawn = draw_map(points, background, title=title, isolines=isolines, is_live=is_live)
    views = [_show_legend(city, key, 20 if is_live else 14) for key in VIEWS]
    notes = [
        _("The numbers beside the signs count all buildings, whatever the filters leave.") if is_live else "",
        _("Larger from 3 and from 10 expected falls. The worst lie on top."),
        _("Dashed lines: equal PGA of the ground.") if isolines else "",
        _("Background: {file}.", file=background.file) if background else "",
        _("Choose a sign to see its building. Click the map first, then the wheel zooms; drag to move. The keys + and "
          "- zoom, arrows move.") if is_live else "",
    ]  # fmt: skip
    legend = Box([*(views if is_live else views[:1]), Paragraph(" ".join(filter(None, notes)), "map-note")], "map-side")
    figure = Figure(Image(drawn), kind="map", legend=[legend])
    if is_live:
        yield Section([], "", "map", _("Map"))
    yield Section([figure], kind, "map-drawing" if is_live else "map", "" if is_live else _("Map"))


def _show_legend(city: City, key: str, size: int) -> Box:
    lines: list[Words] = []
    for sign, count in list_legend(city, key):
        box = f'width="{size}" height="{size}" viewBox="-9 -9 18 18" aria-hidden="true"'
        drawn = Image(f'<svg {box} data-key="{escape(sign.key)}">{draw_sign(sign)}</svg>')
        lines.append([drawn, f" {say_sign(sign)}: {say.say_whole(count)}"])
    kind = "map-view chosen" if key == next(iter(VIEWS)) else "map-view"
    return Box([Bullets(lines, "map-legend"), Paragraph(_(VIEWS[key].note), "map-note")], kind, id=f"legend-{key}")


def _list_filters(city: City) -> list[tuple[str, str, list[tuple[str, str]]]]:
    """Return the filters: key, label, and the choices that are in use as value and words."""

    def say_storeys(low: int, high: int) -> str:
        if low == high:
            return str(low)
        return _("{low} or more", low=low) if high >= STOREYS[-1][1] else _("{low} to {high}", low=low, high=high)

    uses = sorted({words.cut(city.spell_use(row), 60) for row in city.ranked if row["use"]})
    used = {row["inventory"] for row in city.ranked}
    signs = {key: [(sign.key, say_sign(sign)) for sign, _count in list_legend(city, key)] for key in ("kind", "state")}
    return [
        ("use", _("Use"), [(use, use) for use in uses]),
        ("kind", _("Highest class"), signs["kind"]),
        ("state", _("Routes"), signs["state"]),
        ("inventory", _("Inventory"), [(one, say.name_inventory(one)) for one in INVENTORIES if one in used]),
        ("storeys", _("Storeys"), [(f"{low}-{high}", say_storeys(low, high)) for low, high in STOREYS]),
    ]


# ---------------------------------------------------------------- tables


def _list_ranking(city: City) -> list[Section]:
    """Return the head of the ranking, behind which the page has its filters, and the table that its script fills."""
    apart = _("Buildings of different inventories and bases stand in one list and are marked; their numbers are not "
              "added up.")  # fmt: skip
    without = _("This list, the filters and the pages of the buildings need JavaScript. ranking.xlsx holds the same.")
    note = Box([Paragraph(without, "caution")], tag="noscript")
    columns = [Column(text, is_number=at > 3) for at, text in enumerate(list_heads())]
    return [
        Section(
            [Paragraph(f"{_(BUILDING_RULE)} {apart}"), note], "", "ranking", _("Buildings, those to start with first")
        ),
        Section([Table(columns, [[]], "ranked", id="ranked")], "", "ranking-list"),
    ]


def _tabulate(columns: list[Column], rows: Iterable[Sequence[str]], caption: str = "") -> Table | None:
    """Return a table whose rows begin with a name; None without rows."""
    found: list[Sequence[Cell | Words]] = [(head(first), *cells) for first, *cells in rows]
    return table(columns, found, "named", caption, is_named=True) if found else None


def _tabulate_first(city: City, group: Group) -> Table | None:
    columns = list_columns(
        (_("Building"), ""), (_("Share expected to fall"), "w12", "num"), (_("Expected falls"), "w12", "num"),
        (_("People on blocked routes"), "w15", "num"), (_("Routes blocked"), "w12", "num"),
    )  # fmt: skip
    rows = [
        (say.mark_own_motions(words.cut(city.name_building(row), 80), row), words.percent(find_share(row)),
         say.say_falls(row), say.say_people(row), say.say_blocked(row))
        for row in group.first_buildings
    ]  # fmt: skip
    return _tabulate(columns, rows, _(BUILDING_RULE))


def _tabulate_types(group: Group) -> Table | None:
    columns = list_columns((_("Type"), ""), (_("Pieces"), "w15", "num"), (_("Buildings"), "w15", "num"),
                           (_("Expected falls"), "w15", "num"))  # fmt: skip
    rows = [
        (words.cut(_(one.label), 80), say.say_whole(one.pieces), say.say_whole(one.buildings),
         say.say_number(one.expected_falls))
        for one in group.first_types
    ]  # fmt: skip
    return _tabulate(columns, rows, _(TYPE_RULE))


def _list_skipped(city: City, most: int) -> Iterator[Block]:
    yield Paragraph(_("These could not be assessed. Nothing of them is in any number above."))
    columns = list_columns((_("Building"), "w30"), (_("First problem"), ""))
    rows = [
        (say.name_skipped(row["building"], row["path"]), explained or DASH)
        for row in city.skipped[:most]
        for explained in (" ".join(say.explain_skipped(city, row["path"]).split()),)
    ]
    yield from filter(None, [_tabulate(columns, rows)])
    if (left := len(city.skipped) - most) > 0:
        yield Paragraph(ngettext("{n:,} more is in ranking.xlsx.", "{n:,} more are in ranking.xlsx.", left))


def _tabulate_sums(city: City) -> Table:
    """Return the table of groups; there is no line of all, as groups are never added up."""
    numbers = [
        _("Buildings"), _("Pieces"), *map(words.risk_label, RiskClass), _("unconfirmed or by formula only"),
        _("anchored"), _("Expected falls"), _("5 to 95 % of draws"), _("People on blocked routes"),
        _("People on routes of known state"), _("5 to 95 % of draws"), _("People on routes of unknown state"),
    ]  # fmt: skip
    rows: list[Sequence[Cell | Words]] = [
        [
            head(say.name_group(group)),
            *map(say.say_whole, (group.buildings, group.pieces, *group.by_class.values())),
            say.say_whole(group.unconfirmed + group.by_formula),
            say.say_whole(group.anchored),
            say.say_number(group.falls.expected),
            say.say_range(group.falls.low, group.falls.high),
            say.say_number(group.people.expected) if group.people_known else DASH,
            say.say_whole(group.people_known or None),
            say.say_range(group.people.low, group.people.high) if group.people_known else DASH,
            say.say_whole(group.people_not_known),
        ]
        for group in city.groups
    ]
    columns = [Column(_("Buildings by inventory and basis")), *(Column(one, is_number=True) for one in numbers)]
    return table(columns, rows, "sums")


def _describe_method(city: City, *, is_live: bool) -> Iterator[Block]:
    basis = [(head(label), value) for label, value in say.list_basis(city)]
    yield table([Column(), Column()], basis, "facts")
    yield from map(Paragraph, say.list_method(city))
    if references := say.list_references(city):
        yield Heading(_("References"))
        yield Bullets(references)
    made = (
        _("Made with assess {version}.", version=__version__)
        if is_live
        else _("Made with assess {version}. The page city.html has a page of every building, ranking.xlsx the whole "
               "ranking.", version=__version__)
    )  # fmt: skip
    yield Paragraph(made, "small")
