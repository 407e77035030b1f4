"""What the templates of a report see: its content, figures, lists, and the words for numbers."""

from collections.abc import Callable, Mapping, Sequence, Set
from typing import Any

from assess.errors import Problem
from assess.i18n import fill, markup, nmarkup, number
from assess.i18n import gettext as _
from assess.progress import SILENT, Progress
from assess.report import summary, words
from assess.report.content import Content
from assess.report.counts import build_bars
from assess.report.embedded import Photos, data_uri, embed_logo
from assess.report.figures.motion_figures import choose_traced, draw_motion, draw_traced, get_acceleration
from assess.report.figures.plan import Plan, build_plan
from assess.report.figures.risk_contours import Contours, build_contours, draw_contours
from assess.report.figures.ways import build_stretches
from assess.report.findings import (
    annual_chances,
    motions,
    route_page,
    route_rows,
    route_words,
    schedule_words,
    trials,
)
from assess.report.findings.approach import list_approach, list_sources
from assess.report.findings.floor_lines import say_counts, say_motions
from assess.report.findings.uncertain import say_condition
from assess.report.groups import choose_groups, group_rows
from assess.report.pages import compact
from assess.report.pages.editions import MOST_ASSUMPTIONS, Edition, list_parts
from assess.report.pages.page_columns import (
    PageColumn,
    list_columns,
    list_flags,
    motion_columns,
    route_columns,
    short_columns,
)
from assess.report.provenance import say_reference
from assess.report.report_options import ReportOptions
from assess.results import MotionRow
from assess.schedule_fields import schedule_fields
from assess.schedule_results import WorkRow

FULL_ROWS = 150
"""Rows up to which a PDF shows whole tables of all pieces; longer ones go to the appendix in a compact form."""
LIMITS: Mapping[str, int] = {
    "most_rows": 5000, "most_lines": compact.MOST_LINES, "most_routes": 100, "most_segments": 150,
    "most_rooms": 150, "most_beside": 300, "most_steps": 120, "most_problems": 120, "most_notes": 150,
    "most_motions": 60, "most_groups": 15, "most_risky": 60, "listed": trials.LISTED,
    "most_annual": annual_chances.LISTED, "most_entries": 150,
    "most_fixes": summary.FIXES, "most_cautions": summary.CAUTIONS, "most_at_risk": summary.ROUTES,
}  # fmt: skip
"""What the lists of HTML and PDF show at most; the Excel report holds all."""
MOST_RECORDS = 16
"""Recorded motions that are drawn; the others are described."""


def build_context(
    content: Content,
    options: ReportOptions,
    *,
    for_print: bool,
    edition: Edition = "all",
    progress: Progress = SILENT,
) -> dict[str, Any]:
    """Return the names that the templates use; figures are cancelled while they are drawn.

    Of another edition than all, figures are drawn as far as its sections show them.
    """
    aside = progress.wait_for(
        lambda: _of_content(content, options, for_print=for_print, edition=edition, progress=progress)
    )
    return {**aside, **_of_figures(content, frozenset(name for name, _heading in aside["parts"]), progress)}


def _of_content(
    content: Content, options: ReportOptions, *, for_print: bool, edition: Edition, progress: Progress
) -> dict[str, Any]:
    is_long = len(content.results) > FULL_ROWS
    is_compact = is_long and for_print and not options.accessible
    parts = list_parts(edition, content, options, is_compact=is_compact)
    names = frozenset(name for name, _heading in parts)
    annex = list_parts("annex", content, options, is_compact=is_compact) if edition == "client" else []
    return {
        "edition": edition,
        "parts": parts,
        "annex_parts": annex,
        "shown_parts": names,
        **LIMITS,
        "content": content,
        "language": options.language,
        "for_print": for_print,
        "is_long": is_long,
        "is_compact": is_compact,
        "tables": _list_tables(content),
        "listings": _listings(content) if is_compact else {},
        "logo": embed_logo(content.run),
        "first_photo": Photos(content.run).first_photo,
        "floor_bars": build_bars(content.worst_floors),
        "marks": words.marks(),
        "symbols": {"unconfirmed": words.UNCONFIRMED, "by_formula": words.BY_FORMULA},
        "apart_legend": words.apart_legend(),
        "has_apart": bool(content.total.unconfirmed or content.total.by_formula),
        "schedule": _of_schedule(content),
        **_of_floors(content, progress if "floors" in names else None),
        **_of_client(content),
        "shown_assumptions": content.assumptions[: MOST_ASSUMPTIONS if edition == "client" else None],
        **_of_routes(content, for_print=for_print),
        **_of_methods(content),
    }


def _list_tables(content: Content) -> dict[str, Sequence[PageColumn]]:
    run = content.run
    return {
        "pieces": list_columns(run, "pieces"),
        "risky": list_columns(run, "risky"),
        "methods": list_columns(run, "methods"),
        "changed": short_columns(
            run, "item", "floor", "description", "quantity", "formula", "ideal", "adopted_probability", "adopted_class"
        ),
        "apart": short_columns(run, "piece", "room_short", "size", "quantity", "formula", "class"),
        "short": short_columns(run, "piece", "room_short", "size", "quantity", "chance", "class"),
        "worst": short_columns(run, "piece", "place", "chance", "class"),
        "demand": motion_columns("axis", "source", "pfa_g", "pfv_cm_s", "origin"),
    }


def _of_schedule(content: Content) -> dict[str, Any]:
    """Return the schedule by room as far as it is shown, the details that it uses, and what it changes."""
    schedule, shown = content.run.schedule, content.summary.fixes[: LIMITS["most_entries"]]
    titles = {page.floor.floor: page.title for page in content.floors}
    works = schedule_words.list_work(shown, list(titles))
    used, others = schedule_words.list_details(schedule)
    return {
        "rooms": schedule_words.list_rooms(works, titles),
        "left_out": len(schedule.rows) - len(shown),
        "has_code": any(one.row.tension_code_kn is not None for one in works),
        "has_cost": schedule.cost is not None,
        "has_held": any(one.is_held_by_weight for one in works),
        "used": used,
        "alternatives": others,
        "lead": schedule_words.say_effect_of_all(schedule),
        "marks": schedule_words.list_marks(schedule),
        "changes": schedule_words.list_changes(schedule),
        "rooms_at_risk": schedule_words.say_rooms_at_risk(schedule),
        "screening": schedule_words.say_screening(),
        "order": schedule_words.say_order(),
        "checks": schedule_words.say_checks(),
        "disagreement": schedule_words.say_disagreement(),
        "held": schedule_words.say_held(),
        "held_mark": schedule_words.HELD,
        "heads": {key: field.short_heading() for key, field in schedule_fields(WorkRow).items()},
    }


def _listings(content: Content) -> dict[str, Sequence[compact.Block]]:
    return {name: compact.list_lines(content.listed, list_columns(content.run, name)) for name in ("pieces", "methods")}


def _of_client(content: Content) -> dict[str, Any]:
    """Return what the client's edition says in short: groups of pieces, the approach and its sources."""
    groups = group_rows(content.listed)
    return {
        "all_groups": groups,
        "groups": choose_groups(groups),
        "approach": list_approach(content),
        "approach_sources": list_sources(content),
        "floor_titles": {page.floor.floor: page.title for page in content.floors},
        "condition": say_condition(content.run),
        "say_motions": say_motions,
        "say_counts": say_counts,
    }


def _of_floors(content: Content, progress: Progress | None) -> dict[str, Any]:
    """Return the plans of the floors, none without `progress`: of an edition that has no floors."""
    stretches = build_stretches(content.run.route_tables)
    plans: dict[str, Plan | None] = {}
    for page in progress.checked(content.shown_floors) if progress else ():
        name = f"plan {page.floor.floor}"
        if name not in content.drawn:  # HTML, PDF and Word show the same
            content.drawn[name] = build_plan(page, content.run, stretches.get(page.floor.floor, ()))
        plans[page.floor.floor] = content.drawn[name]
    return {"plans": plans, "source": motions.describe_source, "origin": motions.describe_origin}


def _of_routes(content: Content, *, for_print: bool) -> dict[str, Any]:
    """Return the evacuation routes, and the rows of each of their tables as far as they are shown: fewer in print."""
    found = content.run.route_tables
    if not content.run.has_routes:
        return {"routes": None, "segment_rows": ()}
    segments = route_rows.list_segments(found, LIMITS["most_segments"], is_short=for_print)
    return {
        "routes": found,
        "route_tables": route_columns(
            has_anchors=any(one.blocked_if_anchors_fail for one in found.routes),
            has_unknown=any(one.unknown_segments or one.unknown_routes or one.unknown_rooms for one in found.floors),
        ),
        "shown_routes": route_rows.choose_rows(found.routes, LIMITS["most_routes"], route_words.find_chance),
        "shown_segments": segments,
        "left_out": sum(map(route_rows.is_untouched, found.segments)) if for_print else 0,
        "segment_rows": {number for number, _segment in segments},
        "shown_rooms": route_rows.choose_rows(
            found.rooms, LIMITS["most_rooms"], lambda one: one.loses_every_exit.probability
        ),
        "beside": route_rows.list_beside(found),
        "steps": route_rows.list_steps(found),
        "fixes_bound": route_rows.say_fixes_bound(found),
        "unfixable": route_words.list_unfixable(found),
        "untouched": route_rows.name_untouched(found),
        "way_lines": route_page.list_route_lines(found, content.run.item_rows),
        "room_lines": route_page.list_room_lines(found, content.run.item_rows),
        "most_way_lines": route_page.MOST_LINES,
        "state_rules": route_words.list_rules(found.risk),
        "route_lines": route_rows.describe_routes(found),
        "draft_lines": route_rows.say_drafts(found),
        "uncounted": route_rows.say_uncounted(found),
        "route_cautions": route_words.list_cautions(found),
        "route_flags": route_rows.list_flags(found),
        "floor_names": {page.floor.floor: page.title for page in content.floors},
        "widths": route_words.list_widths(),
        "default_width": route_words.say_default_width(),
    }


def _of_methods(content: Content) -> dict[str, Any]:
    types = {item.type for item in content.run.item_rows}
    return {
        "quantities": {"breadth_to_height": "B/H", "pfa": "PFA", "height": "H", "pfv": "PFV"},
        "name_ranges": words.name_ranges,
        "used_profiles": motions.used_profiles(content.run),
        "used_types": [one for one in content.run.catalogue if one.source and one.type in types],
        "status": motions.profile_status,
        "clauses": motions.list_clauses,
        "envelopes": _(motions.ENVELOPES),
        "treatment": motions.describe_treatment,
    }


# ---------------------------------------------------------------- figures


def _of_figures(content: Content, names: Set[str], progress: Progress) -> dict[str, Any]:
    """Draw the figures of these sections: the map of risk, the motions of the simulation, and the records."""

    def once(section: str, draw: Callable[[], Any], otherwise: Any) -> Any:
        """Return what a section shows; HTML and annex show the same figures."""
        if section in names and section not in content.drawn:
            content.drawn[section] = draw()
        return content.drawn[section] if section in names else otherwise

    contours, figures = once("contours", lambda: _draw_contours(content, progress), (None, {}))
    traced = once("verification", lambda: _draw_traced(content, progress), [])
    recorded = once("appendix", lambda: _recorded(content, progress), [])
    return {"contours": contours, "figures": figures, "traced_figures": traced, "recorded": recorded}


def _draw_contours(content: Content, progress: Progress) -> tuple[Contours | None, dict[str, str]]:
    contours = progress.wait_for(lambda: build_contours(content.run))
    return contours, {"contours": _svg(draw_contours(contours, progress))} if contours else {}


def _draw_traced(content: Content, progress: Progress) -> list[dict[str, Any]]:
    return [
        {"image": _svg(one.drawing), "caption": one.caption, "alternative": one.alternative}
        for one in draw_traced(content, choose_traced(content), progress)
    ]


def _list_recorded(content: Content) -> list[tuple[str, MotionRow]]:
    return [
        (page.title, one) for page in content.floors for one in page.motions if one.has_record and not one.is_borrowed
    ]


def _recorded(content: Content, progress: Progress) -> list[tuple[str, MotionRow, str]]:
    """Return every record with its floor, and the figures of those of the floors that are shaken most."""
    found, drawn = _list_recorded(content), {}
    for _title, motion in sorted(found, key=lambda one: -one[1].pfa_g)[:MOST_RECORDS]:
        values, step = get_acceleration(content.run, motion), motion.time_step_s or 0.0
        drawn[motion.index] = "" if values is None else _svg(draw_motion(values, step, progress))
    return [(title, motion, drawn.get(motion.index, "")) for title, motion in found]


def list_missing_figures(content: Content) -> list[Problem]:
    """Return a note that names the figures which are left out because the file with their series is gone."""
    if content.run.series.is_there:
        return []
    named = {
        _("risk over breadth and acceleration"): any(not one.is_anchored for one in content.results),
        _("motions and rotations of simulated pieces"): bool(content.verified.done),
        _("recorded motions"): bool(_list_recorded(content)),
        _("the logo"): content.run.building.logo is not None,
        _("plans under the pieces"): any(floor.plan for floor in content.run.floor_rows),
        _("photos of pieces"): any("photo" in item.more for item in content.run.item_rows),
    }
    names = ", ".join(name for name, is_there in named.items() if is_there)
    if not names:
        return []
    return [Problem("note", "", "", fill("Figures are left out, as the file of series of this run is gone: {names}.",
                                         names=names))]  # fmt: skip


def _svg(drawing: bytes) -> str:
    return data_uri(drawing, "image/svg+xml")


FILTERS: Mapping[str, Any] = {
    "apart_note": words.apart_note,
    "apart_words": words.apart_words,
    "chance": words.chance,
    "class_label": words.class_label,
    "class_marks": words.class_marks,
    "class_name": words.class_name,
    "clip": words.clip,
    "cut": words.cut,
    "described": summary.describe,
    "first_names": route_words.name_few,
    "deviation": words.deviation,
    "fixed": words.fixed,
    "flag_name": lambda flag: _(flag.replace("_", " ")),
    "name_rooms": route_words.name_rooms,
    "has_doubtful_bracket": words.has_doubtful_bracket,
    "in_cm_s": words.in_cm_s,
    "in_g": words.in_g,
    "in_m": words.in_m,
    "in_whole": lambda value: number(value, ",d"),
    "list_beside": words.list_beside,
    "list_flags": list_flags,
    "is_blocked_standing": route_words.is_blocked_standing,
    "percent": words.percent,
    "plural": words.plural,
    "reference": say_reference,
    "risk_label": words.risk_label,
    "risk_notes": words.risk_notes,
    "risk_word": words.risk_word,
    "say": _,
    "say_basis": route_words.say_basis,
    "say_bracket": words.say_bracket,
    "say_blocked": route_words.say_blocked,
    "say_bounds": route_words.say_bounds,
    "cost": schedule_words.say_cost,
    "fixings": schedule_words.say_fixings,
    "force": schedule_words.say_force,
    "say_chance": route_words.say_chance,
    "say_missing_after": route_words.say_missing_after,
    "say_left_out": route_words.say_left_out,
    "say_lost": route_words.say_lost,
    "say_missing": route_words.say_missing,
    "say_room_state": route_words.say_room_state,
    "say_state": route_words.say_state,
    "say_other_rooms": route_words.say_other_rooms,
    "say_risk": route_words.say_risk,
    "say_occupants": route_words.say_occupants,
    "say_recorded": route_words.say_recorded,
    "say_route_state": route_words.say_route_state,
    "say_segment": route_words.say_segment,
    "say_segment_state": route_words.say_segment_state,
    "say_taken": route_words.say_taken,
    "say_way": route_words.say_way,
    "share": lambda value: f"{number(100 * value, '.0f')} %",
    "size": words.size,
    "style_name": words.style_name,
    "under_record": words.under_record,
}
"""Filters of the templates, which show numbers and texts in the language in use."""
GLOBALS: Mapping[str, Any] = {"_": markup, "ngettext": nmarkup}
"""Functions of the templates: texts by their English ones."""
