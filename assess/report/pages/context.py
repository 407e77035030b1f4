"""What the templates of a report see: its content, figures, lists, and the words for numbers."""

import base64
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from assess.language import gettext as _
from assess.language import markup, nmarkup, number
from assess.motion.scenario import PROFILES
from assess.report import summary, words
from assess.report.content import Content, has_worse_motion
from assess.report.counts import build_bars
from assess.report.example.worked import choose_example, work_example
from assess.report.figures.captions import caption_traced
from assess.report.figures.contours import choose_contours, draw_contours
from assess.report.figures.draw import draw_motion
from assess.report.figures.plan import build_plan
from assess.report.figures.verification import choose_traced, draw_traced
from assess.report.figures.ways import build_stretches
from assess.report.findings import motions, route_rows, routes, trials, verified
from assess.report.findings.disagreements import find_disagreements, group_disagreements, summarise_disagreements
from assess.report.look import Look
from assess.report.pages import compact
from assess.report.pages.parts import read_script, script_hash, write_equation
from assess.report.provenance import say_reference

FULL_ROWS = 150
"""Rows up to which a PDF shows whole tables of all pieces; longer ones go to the appendix in a compact form."""
LIMITS: Mapping[str, int] = {
    "most_rows": 5000, "most_lines": compact.MOST_LINES, "most_routes": 100, "most_segments": 150,
    "most_rooms": 150, "most_beside": 300, "most_steps": 120, "most_problems": 120, "most_notes": 150,
    "most_motions": 60, "most_groups": 15, "most_risky": 60, "listed": trials.LISTED,
    "most_fixes": summary.FIXES, "most_cautions": summary.CAUTIONS, "most_at_risk": summary.ROUTES,
}  # fmt: skip
"""What the lists of HTML and PDF show at most; the Excel report holds all."""
MOST_RECORDS = 16
"""Recorded motions that are drawn; the others are described."""


def build_context(content: Content, look: Look, *, for_print: bool) -> dict[str, Any]:
    """Return the names that the templates use."""
    is_long = len(content.results) > FULL_ROWS
    is_compact = is_long and for_print and not look.accessible
    script = read_script(look, for_print=for_print)
    context = {
        **LIMITS,
        "content": content,
        "language": look.language,
        "for_print": for_print,
        "is_long": is_long,
        "is_compact": is_compact,
        "parts": _parts(content, is_compact),
        "listings": _listings(content) if is_compact else {},
        "logo": _logo(content),
        "script": script,
        "script_hash": script_hash(script),
    }
    parts = (
        _of_summary(content),
        _of_floors(content),
        _of_routes(content, for_print=for_print),
        _of_methods(content),
        _of_figures(content),
    )
    return context | {name: value for part in parts for name, value in part.items()}


def _parts(content: Content, is_compact: bool) -> list[tuple[str, str]]:
    """Return the parts of a report in their order: file of the template, which is the anchor as well, and heading."""
    parts = {
        "summary": _("Summary"),
        "floors": _("Floors"),
        "routes": _("Evacuation routes"),
        "items": _("All pieces"),
        "comparison": _("Comparison of the methods"),
        "verification": _("Verification"),
        "contours": _("Risk over breadth and acceleration"),
        "methods": _("Methods"),
        "limits": _("Limits of the methods"),
        "assumptions": _("Assumptions and defaults"),
        "quality": _("Data-quality log"),
        "references": _("References"),
        "appendix": _("Appendix"),
        "lists": _("Appendix: all pieces"),
    }
    if not content.results:
        del parts["contours"]
    if not is_compact:
        del parts["lists"]
    return list(parts.items())


def _listings(content: Content) -> dict[str, Sequence[compact.Block]]:
    return {
        "pieces": compact.list_pieces(content.results, has_verified=bool(content.verified.done)),
        "methods": compact.list_methods(content.results, content.methods),
    }


def _of_summary(content: Content) -> dict[str, Any]:
    return {
        "floor_bars": build_bars(content.worst_floors),
        "summary_lines": verified.list_summary(content.verified),
        "verification_sentence": verified.describe_verification(content.assessment),
        "marks": words.marks(),
        "risky": summary.list_risky(content.results),
    }


def _of_floors(content: Content) -> dict[str, Any]:
    inventory = content.assessment.inventory
    ways = build_stretches(inventory, content.assessment.routes)
    plans = {
        page.floor.floor: build_plan(page, inventory, ways.get(page.floor.floor, ())) for page in content.shown_floors
    }
    return {"plans": plans, "source": motions.describe_source, "origin": motions.describe_origin}


def _of_routes(content: Content, *, for_print: bool) -> dict[str, Any]:
    """Return the evacuation routes, and the rows of each of their tables as far as they are shown: fewer in print."""
    found = content.assessment.routes
    if found is None:
        return {"routes": None, "segment_rows": ()}
    segments = route_rows.list_segments(found, LIMITS["most_segments"], is_short=for_print)
    return {
        "routes": found,
        "shown_routes": route_rows.choose_rows(
            found.routes, LIMITS["most_routes"], lambda one: one.outlook.blocked.probability
        ),
        "shown_segments": segments,
        "left_out": sum(map(route_rows.is_untouched, found.segments)) if for_print else 0,
        "segment_rows": {number for number, _segment in segments},
        "shown_rooms": route_rows.choose_rows(found.rooms, LIMITS["most_rooms"], lambda one: one.loses.probability),
        "beside": route_rows.list_beside(found),
        "steps": route_rows.list_steps(found),
        "unmended": routes.list_unmended(found),
        "untouched": route_rows.name_untouched(found),
        "route_lines": route_rows.describe_routes(found),
        "uncounted": route_rows.say_uncounted(found),
        "route_cautions": routes.list_cautions(found),
        "route_flags": route_rows.list_flags(found),
        "floor_names": {page.floor.floor: page.title for page in content.floors},
        "widths": routes.list_widths(),
        "default_width": routes.say_default_width(),
    }


def _of_methods(content: Content) -> dict[str, Any]:
    assessment = content.assessment
    example = choose_example(content.results)
    found = find_disagreements(content.results, content.methods)
    types = {item.type for item in assessment.inventory.items}
    return {
        "example": example,
        "worked": work_example(
            example,
            assessment.settings,
            restitution=assessment.inventory.building.restitution,
            methods=content.methods,
        )
        if example
        else (),
        "disagreement": summarise_disagreements(found, len(content.results)),
        "disagreements": group_disagreements(found),
        "more": has_worse_motion,
        "quantities": {"breadth_to_height": "B/H", "pfa": "PFA", "height": "H", "pfv": "PFV"},
        "name_ranges": words.name_ranges,
        "profiles": tuple(PROFILES.values()),
        "used_profiles": motions.used_profiles(assessment.demands),
        "used_types": [one for one in assessment.inventory.catalogue if one.source and one.type in types],
        "status": motions.profile_status,
        "clauses": motions.list_clauses,
        "envelopes": _(motions.ENVELOPES),
        "treatment": motions.describe_treatment,
    }


def _of_figures(content: Content) -> dict[str, Any]:
    """Draw the figures: the motions of the verification, contours and records."""
    traced, contours = choose_traced(content), choose_contours(content)
    drawn = draw_traced(content, traced)
    figures = {"contours": _svg(draw_contours(contours, content.assessment.settings))} if contours else {}
    captions = [
        {"image": _svg(drawn[one.name]), "caption": one.caption, "alternative": one.alternative}
        for one in caption_traced(content, traced)
    ]
    return {"contours": contours, "figures": figures, "traced_figures": captions, "recorded": _recorded(content)}


def _recorded(content: Content) -> list[tuple[str, Any, str]]:
    """Return every record with its floor, and the figures of those of the floors that are shaken most."""
    found = [
        (page.title, demand)
        for page in content.floors
        for demand in page.demands
        if demand.motion is not None and demand.record is not None and not demand.is_borrowed
    ]
    strongest = sorted(range(len(found)), key=lambda at: -found[at][1].pfa)[:MOST_RECORDS]
    return [
        (title, demand, _svg(draw_motion(demand)) if at in strongest else "")
        for at, (title, demand) in enumerate(found)
    ]


def _svg(drawing: bytes) -> str:
    return _data_uri(drawing, "image/svg+xml")


def _data_uri(data: bytes, kind: str) -> str:
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"


def _logo(content: Content) -> str:
    path: Path | None = content.assessment.inventory.building.logo
    if path is None:
        return ""
    data = path.read_bytes()
    return _data_uri(data, "image/png" if data.startswith(b"\x89PNG") else "image/jpeg")


def _share(value: float) -> str:
    return f"{number(100 * value, '.0f')} %"


FILTERS: Mapping[str, Any] = {
    "chance": words.chance,
    "class_marks": words.class_marks,
    "class_name": words.class_name,
    "clip": words.clip,
    "cut": words.cut,
    "equation": write_equation,
    "described": summary.describe,
    "first_names": routes.name_few,
    "fixed": words.fixed,
    "flag_name": lambda flag: _(flag.replace("_", " ")),
    "has_evaluated_way": route_rows.has_evaluated_way,
    "in_cm_s": words.in_cm_s,
    "in_g": words.in_g,
    "in_m": words.in_m,
    "in_whole": lambda value: number(value, ",d"),
    "is_blocked_standing": routes.is_blocked_standing,
    "percent": words.percent,
    "plural": words.plural,
    "reference": say_reference,
    "risk_label": words.risk_label,
    "risk_notes": words.risk_notes,
    "risk_word": words.risk_word,
    "say": _,
    "say_basis": routes.say_basis,
    "say_bounds": routes.say_bounds,
    "say_chance": routes.say_chance,
    "say_left_out": routes.say_left_out,
    "say_other_rooms": routes.say_other_rooms,
    "say_risk": routes.say_risk,
    "say_occupants": routes.say_occupants,
    "say_recorded": routes.say_recorded,
    "say_route_state": routes.say_route_state,
    "say_segment": routes.say_segment,
    "say_segment_state": routes.say_segment_state,
    "say_way": routes.say_way,
    "share": _share,
    "size": words.size,
    "under_record": words.under_record,
}
"""Filters of the templates, which show numbers and texts in the language in use."""
GLOBALS: Mapping[str, Any] = {"_": markup, "ngettext": nmarkup}
"""Functions of the templates: texts by their English ones."""
