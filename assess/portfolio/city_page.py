"""The page of a city: one HTML file with the answer, a map, a ranking and a page a building; nothing is fetched."""

from collections.abc import Collection, Sequence
from typing import Any

from assess.i18n import LANGUAGES
from assess.i18n import gettext as _
from assess.portfolio import city_method as made
from assess.portfolio import city_words as say
from assess.portfolio import piece_words as say_row
from assess.portfolio.background import Background
from assess.portfolio.building_signs import Sign, say_sign, share_of
from assess.portfolio.city_content import CityContent, build_content
from assess.portfolio.city_map import Isoline, draw_map, draw_sign
from assess.portfolio.city_totals import BUILDING_RULE, TYPE_RULE, CityView, Group
from assess.portfolio.page_data import STOREYS, list_heads, write_data
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.pages.html import build_style, hash_script
from assess.report.report_options import ReportOptions
from assess.report.templates import render_template
from assess.version import __version__

TEMPLATE, STYLE, SCRIPT = "city.html.j2", "city.css", "script/city.js"


def render_page(
    view: CityView,
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
    view : CityView
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
        content = progress.wait_for(lambda: build_content(view))
        context = progress.wait_for(lambda: build_context(content, background, isolines, options, is_live=True))
        script = options.read(SCRIPT)
        context |= {
            "for_print": False, "style": build_style(options, False, STYLE), "script": script,
            "script_hash": hash_script(script), "data": progress.wait_for(
                lambda: write_data(content, repeat, indexed)
            ),
        }  # fmt: skip
        return render_template(TEMPLATE, options, context, progress).encode()


def build_context(
    content: CityContent,
    background: Background | None,
    isolines: Sequence[Isoline],
    options: ReportOptions,
    *,
    is_live: bool,
) -> dict[str, Any]:
    """Return what the templates of the page and of the summary show; in the language in use."""
    view, totals = content.view, content.totals
    return {
        "language": options.language or LANGUAGES[0],
        "version": __version__,
        "title": say.say_title(view),
        "ground": say.say_ground(view),
        "facts": say.list_facts(view),
        "cautions": say.list_cautions(view, totals),
        "groups": [_show_group(group, content) for group in totals.groups],
        "total_heads": say.list_total_heads(),
        "total_rows": say.list_total_rows(totals),
        "basis": made.list_basis(view),
        "method": made.list_method(view, totals),
        "references": made.list_references(view, totals),
        "map": draw_map(
            content.points,
            background,
            title=_(
                "Map of {placed:,} buildings; the table of the buildings holds the same", placed=len(content.points)
            ),
            isolines=isolines,
            is_live=is_live,
        ),
        "background": background.file if background else "",
        "has_isolines": bool(isolines),
        "map_views": _list_map_views(content),
        "building_rule": _(BUILDING_RULE),
        "type_rule": _(TYPE_RULE),
        "heads": list_heads(),
        "filters": _list_filters(content),
        "skipped": _list_skipped(content),
        "count": len(content.buildings),
    }


def _show_group(group: Group, content: CityContent) -> dict[str, Any]:
    return {
        "name": say.name_group(group),
        "is_assumed": group.inventory == "assumed",
        "lines": say.list_group_lines(group),
        "nothing": say.say_nothing(group),
        "tiles": [
            (words.class_name(risk), words.risk_label(risk), say.say_whole(count))
            for risk, count in group.by_class.items()
        ],
        "apart": say.say_whole(group.unconfirmed + group.by_formula) if group.unconfirmed + group.by_formula else "",
        "anchored": say.say_whole(group.anchored),
        "buildings": [
            (say_row.mark_own_motions(words.cut(content.name_building(one.building, one.path), 80), one.own_motions),
             words.percent(share_of(one.expected_falls, one.in_classes)),
             say_row.say_falls(one.expected_falls, one.unconfirmed, one.by_formula, one.left_out),
             say_row.say_people(one.people_blocked, one.occupants, one.people_not_known),
             say_row.say_blocked(one.routes, one.routes_blocked, one.routes_not_known))
            for one in group.first_buildings
        ],
        "types": [
            (words.cut(_(one.label), 80), say.say_whole(one.pieces), say.say_whole(one.buildings),
             say.say_number(one.expected_falls))
            for one in group.first_types
        ],
    }  # fmt: skip


def _list_map_views(content: CityContent) -> list[tuple[str, str, list[tuple[str, str, str, str]], str]]:
    """Return what the signs of the map can show, the default first: key, label, legend, and what a sign stands for."""
    share = _("Each sign is a building, by the share of its free-standing pieces that is expected to fall: its "
              "expected falls over its pieces in the classes. A building with a small share can still have pieces of "
              "very high class.")  # fmt: skip
    return [
        ("share", _("share of the pieces expected to fall"), _list_legend(content.share_legend), share),
        ("kind", _("highest class of a piece"), _list_legend(content.class_legend),
         _("Each sign is a building, by the highest class that any of its pieces has.")),
        ("state", _("worst state of the routes"), _list_legend(content.route_legend),
         _("Each sign is a building, by the worst state that any of its routes has.")),
    ]  # fmt: skip


def _list_legend(signs: Sequence[tuple[Sign, int]]) -> list[tuple[str, str, str, str]]:
    """Return key, drawing, words and number of buildings of each sign."""
    return [(sign.key, draw_sign(sign), say_sign(sign), say.say_whole(count)) for sign, count in signs]


def _list_filters(content: CityContent) -> list[tuple[str, str, list[tuple[str, str]]]]:
    """Return the filters: key, label, and the choices that are in use as value and words."""
    uses = sorted({words.cut(content.spell_use(row), 60) for row in content.buildings if row["use"]})
    inventories = [
        one for one in ("surveyed", "handover", "assumed") if any(row["inventory"] == one for row in content.buildings)
    ]
    return [
        ("use", _("Use"), [(use, use) for use in uses]),
        ("kind", _("Highest class"), [(sign.key, say_sign(sign)) for sign, _count in content.class_legend]),
        ("state", _("Routes"), [(sign.key, say_sign(sign)) for sign, _count in content.route_legend]),
        ("inventory", _("Inventory"), [(one, say.name_inventory(one)) for one in inventories]),
        ("storeys", _("Storeys"), [(f"{low}-{high}", _say_storeys(low, high)) for low, high in STOREYS]),
    ]


def _say_storeys(low: int, high: int) -> str:
    if low == high:
        return str(low)
    return _("{low} or more", low=low) if high >= STOREYS[-1][1] else _("{low} to {high}", low=low, high=high)


def _list_skipped(content: CityContent) -> list[tuple[str, str]]:
    """Return name and reason of each building that could not be assessed; of several problems the first."""
    found = []
    for row in content.skipped:
        errors = [one for one in content.problems.get(row["path"], []) if one["severity"] == "error"]
        first = errors[0] if errors else None
        reason = (
            " ".join(str(first[name]) for name in ("sheet", "cell", "message", "fix") if first[name]) if first else ""
        )
        found.append((say_row.name_skipped(row["building"], row["path"]), " ".join(reason.split()) or words.DASH))
    return found
