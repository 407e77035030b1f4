"""The page and the summary of a city, of the same parts.

The page is one HTML file with the answer, a map, a ranking and a page a building; nothing is fetched. The summary is a
PDF: the answer, the map, what to start with, what is not in it, method and references.
"""

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from assess.delivery.folders import private_folder
from assess.environment import find_source_date
from assess.i18n import LANGUAGES
from assess.i18n import gettext as _
from assess.portfolio import city_method as made
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
from assess.report.pages.html import build_style, hash_script
from assess.report.pages.pdf import print_page
from assess.report.report_options import ReportOptions
from assess.report.templates import render_template
from assess.version import __version__
from assess.workbook.template import CREATED

STYLE, SCRIPT = "city.css", "script/city.js"
LARGE = ((10.0, 1.6), (3.0, 1.25))
"""Expected falls from which a mark on the map is larger, and by how much."""
MOST_SKIPPED = 12
"""Skipped buildings that the summary names; the ranking names all."""


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
        context = progress.wait_for(lambda: _build_context(city, background, isolines, options, is_live=True))
        script = options.read(SCRIPT)
        context |= {
            "for_print": False,
            "style": build_style(options, False, STYLE),
            "script": script,
            "script_hash": hash_script(script),
            "data": progress.wait_for(lambda: write_data(city, repeat, indexed)),
        }
        return render_template("city.html.j2", options, context, progress).encode()


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

    def render() -> str:
        context = _build_context(city, background, isolines, options, is_live=False)
        context |= {
            "for_print": True,
            "style": build_style(options, True, STYLE),
            "most_skipped": MOST_SKIPPED,
            "building_heads": [_("Building"), _("Share expected to fall"), _("Expected falls"),
                               _("People on blocked routes"), _("Routes blocked")],
        }  # fmt: skip
        return render_template("city_summary.html.j2", options, context)

    with options.spoken(), private_folder("assess-page-") as folder:
        html, path = progress.wait_for(render), folder / "city.pdf"
        print_page(html, path, (), options, progress, moment=find_source_date() or CREATED)
        return path.read_bytes()


def _build_context(
    city: City, background: Background | None, isolines: Sequence[Isoline], options: ReportOptions, *, is_live: bool
) -> dict[str, Any]:
    """Return what the templates of the page and of the summary show; in the language in use."""
    points = list_points(city)
    legends = {key: list_legend(city, key) for key in _SIGNS}
    return {
        "language": options.language or LANGUAGES[0],
        "version": __version__,
        "title": say.say_title(city),
        "ground": say.say_ground(city),
        "facts": say.list_facts(city),
        "cautions": say.list_cautions(city),
        "groups": [_show_group(group, city) for group in city.groups],
        "total_heads": say.list_total_heads(),
        "total_rows": say.list_total_rows(city),
        "basis": made.list_basis(city),
        "method": made.list_method(city),
        "references": made.list_references(city),
        "map": draw_map(
            points,
            background,
            title=_("Map of {placed:,} buildings; the table of the buildings holds the same", placed=len(points)),
            isolines=isolines,
            is_live=is_live,
        ),
        "background": background.file if background else "",
        "has_isolines": bool(isolines),
        "map_views": _list_map_views(legends),
        "building_rule": _(BUILDING_RULE),
        "type_rule": _(TYPE_RULE),
        "heads": list_heads(),
        "filters": _list_filters(city, legends),
        "skipped": [_describe_skipped(row, city) for row in city.skipped],
        "count": len(city.ranked),
    }


def _show_group(group: Group, city: City) -> dict[str, Any]:
    apart = group.unconfirmed + group.by_formula
    return {
        "name": say.name_group(group),
        "is_assumed": group.inventory == "assumed",
        "lines": say.list_group_lines(group),
        "nothing": say.say_nothing(group),
        "tiles": [
            (words.class_name(risk), words.risk_label(risk), say.say_whole(count))
            for risk, count in group.by_class.items()
        ],
        "apart": say.say_whole(apart) if apart else "",
        "anchored": say.say_whole(group.anchored),
        "buildings": [
            (say.mark_own_motions(words.cut(city.name_building(row), 80), row), words.percent(find_share(row)),
             say.say_falls(row), say.say_people(row), say.say_blocked(row))
            for row in group.first_buildings
        ],
        "types": [
            (words.cut(_(one.label), 80), say.say_whole(one.pieces), say.say_whole(one.buildings),
             say.say_number(one.expected_falls))
            for one in group.first_types
        ],
    }  # fmt: skip


# ---------------------------------------------------------------- the map and the filters

_SIGNS: Mapping[str, tuple[Callable[[Row], Sign], Mapping[str, Sign]]] = {
    "share": (sign_of_share, BY_SHARE),
    "kind": (sign_of_class, BY_CLASS),
    "state": (sign_of_routes, BY_ROUTES),
}
"""What the signs of the map can show, the default first."""


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
    find_sign, known = _SIGNS[key]
    counts = Counter(find_sign(row).key for row in city.ranked)
    return [(sign, counts[sign.key]) for sign in reversed([*known.values()]) if counts[sign.key]]


def _list_map_views(
    legends: Mapping[str, list[tuple[Sign, int]]],
) -> list[tuple[str, str, list[tuple[str, str, str, str]], str]]:
    """Return the views of the map: key, label, legend (key, drawing, words, number), and what a sign stands for."""
    texts = {
        "share": (
            _("share of the pieces expected to fall"),
            _("Each sign is a building, by the share of its free-standing pieces that is expected to fall: its "
              "expected falls over its pieces in the classes. A building with a small share can still have pieces of "
              "very high class."),
        ),
        "kind": (
            _("highest class of a piece"),
            _("Each sign is a building, by the highest class that any of its pieces has."),
        ),
        "state": (
            _("worst state of the routes"),
            _("Each sign is a building, by the worst state that any of its routes has."),
        ),
    }  # fmt: skip
    return [
        (key, label, [(sign.key, draw_sign(sign), say_sign(sign), say.say_whole(n)) for sign, n in legends[key]], note)
        for key, (label, note) in texts.items()
    ]


def _list_filters(
    city: City, legends: Mapping[str, list[tuple[Sign, int]]]
) -> list[tuple[str, str, list[tuple[str, str]]]]:
    """Return the filters: key, label, and the choices that are in use as value and words."""
    uses = sorted({words.cut(city.spell_use(row), 60) for row in city.ranked if row["use"]})
    used = {row["inventory"] for row in city.ranked}
    return [
        ("use", _("Use"), [(use, use) for use in uses]),
        ("kind", _("Highest class"), [(sign.key, say_sign(sign)) for sign, _count in legends["kind"]]),
        ("state", _("Routes"), [(sign.key, say_sign(sign)) for sign, _count in legends["state"]]),
        ("inventory", _("Inventory"), [(one, say.name_inventory(one)) for one in INVENTORIES if one in used]),
        ("storeys", _("Storeys"), [(f"{low}-{high}", _say_storeys(low, high)) for low, high in STOREYS]),
    ]


def _say_storeys(low: int, high: int) -> str:
    if low == high:
        return str(low)
    return _("{low} or more", low=low) if high >= STOREYS[-1][1] else _("{low} to {high}", low=low, high=high)


def _describe_skipped(row: Row, city: City) -> tuple[str, str]:
    """Return name and reason of a building that could not be assessed; of several problems the first."""
    errors = [one for one in city.problems_of.get(row["path"], []) if one["severity"] == "error"]
    parts = [str(one[name]) for one in errors[:1] for name in ("sheet", "cell", "message", "fix") if one[name]]
    return say.name_skipped(row["building"], row["path"]), " ".join(" ".join(parts).split()) or words.DASH
