"""What the summary says of the routes, the list of what to fix, and what was assumed of them."""

import io
from contextlib import redirect_stdout
from dataclasses import replace

import pypdfium2
import pytest

import assess
from assess.console import print_result
from assess.ranking import fix_first, list_steps
from assess.report import statements, words
from assess.report.content import build_content
from assess.report.findings import at_risk
from assess.report.look import Look
from assess.report.pages.html import render
from assess.report.pages.pdf import load_weasyprint
from assess.report.summary import FIXES
from assess.risk import RiskClass
from assess.routes.model import RouteState
from assess.settings import Settings
from tests.report.routed import FLOORS, ITEMS, PLACES, ROUTES, assess_routed
from tests.workbooks import assessed


@pytest.fixture(scope="module")
def routed(tmp_path_factory):
    return assess_routed(tmp_path_factory.mktemp("at_risk") / "w.xlsx")


def _flat(text):
    return " ".join(text.replace(words.NO_BREAK, " ").split())


def test_routes_at_risk_stand_worst_first(routed):
    found = at_risk.list_routes_at_risk(routed)
    assert [(one.route, one.floors, one.blocker) for one in found] == [("West", "1, G", "tall"), ("Back", "1", "calm")]
    assert [one.state for one in found] == ["✕ may be blocked"] * 2
    chance = routed.routes.routes[1].outlook.blocked
    expected = (
        f"{words.percent(chance.probability)} ({words.in_percent(chance.low)} to {words.in_percent(chance.high)} %)"
    )
    assert _flat(found[1].chance) == expected


def test_the_summary_counts_what_the_assessment_holds(routed):
    routes, said = routed.routes, " ".join(at_risk.say_routes(routed))
    assert said.startswith("Routes that may be blocked or reduced: 2 of 3, at the chosen risk of 3 %.")
    expected = (routes.blocked_routes, routes.cut_off_rooms)
    assert "{:.2f} blocked routes, {:.2f} rooms that lose every exit".format(*expected) in said
    worst = max(one.loses.probability for one in routes.rooms)
    assert f"Rooms that may lose every exit: 2 of 2, the worst Office with {words.percent(worst)}." in said
    assert "If anchors fail, 1 more may be blocked: Yard." in said
    assert "Of evaluated routes, 1 segment is not: nothing tells what can reach it." in said
    assert "1 piece is not counted: whether it falls onto a route is not known." in said
    assert "1 segment is too narrow for its occupants as it stands." in said


def test_the_page_names_them(routed):
    html = _flat(render(routed))
    for one in at_risk.list_routes_at_risk(routed):
        cells = (one.route, one.floors, one.state, _flat(one.chance))
        assert "".join(f"<td>{cell}</td>" for cell in cells[:3]) + f'<td class="num">{cells[3]}</td>' in html
    assert "not evaluated by this version" not in html.partition('id="floors"')[0]


def test_what_is_not_excluded_is_counted_apart(routed):
    routes = routed.routes
    doubtful = [replace(one, outlook=replace(one.outlook, state=RouteState.OPEN)) for one in routes.routes]
    assessment = replace(routed, routes=replace(routes, routes=tuple(doubtful)))
    told = at_risk.say_routes(assessment)
    assert told[0].startswith("Routes that may be blocked or reduced: 0 of 3")
    assert told[1] == "For 2 more it is not excluded."
    assert len(at_risk.list_routes_at_risk(assessment)) == 2


def test_several_pieces_of_a_row_are_told(routed):
    names = [at_risk.say_row(routed.result(at)) for at in range(2)]
    assert names == ["tall", "calm (2 pieces)"]
    (back,) = (one for one in at_risk.list_routes_at_risk(routed) if one.route == "Back")
    assert back.needed == "calm (2 pieces)"


def test_a_route_that_is_not_evaluated_is_not_said_to_be_safe(tmp_path):
    assessment = assess_routed(tmp_path / "w.xlsx", Items=ITEMS[3:])
    assert [one.is_evaluated for one in assessment.routes.routes] == [True, True, False]
    told = at_risk.say_routes(assessment)
    assert "1 route is not evaluated: nothing tells what can reach it." in told


def test_where_none_is_at_risk_that_is_said_with_the_chosen_risk(tmp_path):
    assessment = assess_routed(tmp_path / "w.xlsx", Settings(verify="none", route_risk=0.9))
    assert at_risk.list_routes_at_risk(assessment) == []
    said = at_risk.say_routes(assessment)
    assert said[0].startswith("None of the 3 routes is at risk")
    assert "below the chosen 90 %, also at the upper end" in said[0]
    assert said[3] == "No room comes to that risk of losing every exit."


def test_without_routes_nothing_is_said(tmp_path):
    assessment = assessed(tmp_path / "w.xlsx")
    assert at_risk.say_routes(assessment) == []
    assert "The workbook names no routes." in render(assessment).partition('id="floors"')[0]
    assert not [line for line in statements.list_assumptions(assessment) if line[0].startswith("Routes")]


def test_a_piece_that_reaches_a_route_by_the_plan_is_urgent(routed):
    found = {one.item.item: one for one in routed}
    assert (found["tall"].item.route, found["tall"].routes) == ("", ("West",))
    assert {name for name, one in found.items() if one.is_urgent} == {"tall", "calm", "held"}
    assert found["held"].routes == ("Yard",)


@pytest.fixture(scope="module")
def many(tmp_path_factory):
    """Four pieces of low class that together bring a route over the risk, and one of medium class away from it."""
    low = {"floor": "1", "breadth": 95, "height": 80, "anchored": "no", "route": "Back", "edge_distance": 0.0}
    items = [low | {"item": f"low {at}"} for at in range(4)]
    items.append({"item": "far", "floor": "1", "breadth": 80, "height": 110, "anchored": "no"})
    items.append({"item": "vital", "floor": "1", "breadth": 80, "height": 110, "anchored": "no",
                  "importance": "life safety"})  # fmt: skip
    return assess_routed(tmp_path_factory.mktemp("many") / "w.xlsx", Items=items)


def test_pieces_of_low_class_that_a_route_needs_fixed_are_in_the_list(many):
    classes = {one.item.item: one.adopted.upper for one in many}
    assert classes["low 0"] is RiskClass.LOW
    steps = list_steps(many.routes)
    assert {step.route for step in steps} == {"Back"}
    fixes = build_content(many).summary.fixes
    names = [fix.result.item.item for fix in fixes]
    assert len(steps) == 3
    mended = [many.inventory.items[step.item].item for step in steps]
    assert names == ["vital", *sorted(mended), "far"]
    assert names[0] == "vital"
    for fix in fixes[1:-1]:
        (step,) = fix.steps
        assert fix.reason == at_risk.say_step(step)
        assert fix.reason.startswith("route Back: ")
    last = next(fix for fix in fixes if fix.steps and fix.steps[0].place == len(steps))
    before, after = words.percent(steps[-1].before), words.percent(steps[-1].after)
    assert last.reason == f"route Back: {before} → {after} (step {len(steps)} of {len(steps)})"
    assert steps[-1].after < many.routes.risk <= steps[-1].before


def test_without_a_need_low_class_stays_out(many):
    assert [one.item.item for one in fix_first(iter(many))] == ["vital", "far"]


def test_a_step_that_gains_with_the_others_alone_says_so(many):
    step = replace(list_steps(many.routes)[0], before=0.155, after=0.155, at_last=0.0, place=1, steps=3)
    assert at_risk.say_step(step) == "route Back: 15.5 % → 0.0 % (with all 3 steps)"


def test_what_was_assumed_of_routes(routed):
    lines = statements.list_assumptions(routed)
    assert ("Routes: the chosen risk", "3 %") in lines
    assert ("Routes: 2 segments", "no Required width is given: 0.9 m is taken") in lines
    assert (
        "Routes: where more than 4,096 outcomes are too many to go through",
        f"{routed.routes.draws:,} draws with seed 1",
    ) in lines
    assert any(where == "Routes: pieces that enter by the formula's chance alone" for where, _ in lines)
    limits = " ".join(statements.list_limits(has_verified=False, has_routes=True))
    assert "Evacuation routes are screened, by a rule of ours" in limits
    assert "screened" not in " ".join(statements.list_limits(has_verified=False, has_routes=False))


def test_floors_whose_motions_have_nothing_in_common_are_told(tmp_path):
    """The three pieces stand by motions that are given and by ones that are interpolated: two sources."""
    floors = [
        FLOORS[0] | {"elevation": 8.0},
        {"floor": "M", "elevation": 4.0},
        FLOORS[1] | {"pfa_x": 0.3, "pfa_y": 0.3},
    ]
    routes = [*ROUTES, {"route": "West", "segment": "mid", "floor": "M", "clear_width": 1.2}]
    middle = {"item": "mid", "floor": "M", "breadth": 28, "height": 210, "anchored": "no", "route": "West",
              "segment": "mid", "edge_distance": 0.0}  # fmt: skip
    sheets = {"Floors": floors, "Routes": routes, "Items": [*ITEMS, middle]}
    assessment = assess_routed(tmp_path / "w.xlsx", Settings(verify="all", runs=10), **sheets)
    lines = statements.list_assumptions(assessment)
    chances = [one.outlook.blocked for one in assessment.routes.routes]
    expected = any(not one.is_joint and one.pieces > one.unverified for one in chances)
    assert expected
    assert any("different sources" in where for where, _ in lines)


def test_the_command_line_ends_with_the_routes(routed, tmp_path):
    def printed(assessment):
        out = io.StringIO()
        with redirect_stdout(out):
            print_result(assessment, [])
        return out.getvalue()

    held = "1 may be blocked if anchors fail"
    expected = f"{held}; {routed.routes.blocked_routes:.2f} are expected to be blocked."
    assert f"Evacuation routes: of 3, 2 may be blocked and 0 reduced at a risk of 3 %; {expected}" in printed(routed)
    blind = assess_routed(tmp_path / "blind.xlsx", Items=ITEMS[3:])
    assert "Evacuation routes: of 2, 0 may be" in printed(blind)
    assert "; 1 more is not evaluated; " in printed(blind)
    assert "Evacuation routes" not in printed(assessed(tmp_path / "w.xlsx"))


@pytest.fixture(scope="module")
def crowded(tmp_path_factory):
    """Twelve floors, each with a route that may be blocked, and every caution there is."""
    floors, items, routes = [], [], []
    for at in range(12):
        motion = {"pfa_x": 0.3 + 0.02 * at, "pfv_x": 40.0} if at % 3 != 1 else {}
        floors.append({"floor": f"F{at}", "name": f"Level {at} of the building", "elevation": 3.0 * at, **motion})
        route = {"route": f"Long name of route {at}", "segment": "aisle"}
        routes.append(route | {"floor": f"F{at}", "clear_width": 1.2, "required_width": 0.9, "occupants": 300})
        piece = {"floor": f"F{at}", "room": "Conference room", "description": "Bookcase of metal", "breadth": 30,
                 "width": 80, "height": 200, "anchored": "partly", "importance": "life safety",
                 "edge_distance": 0.1}  # fmt: skip
        items += [piece | route | {"item": f"Piece-{at}-{number}"} for number in range(3)]
    settings = assess.Settings(verify="high", runs=10)
    sheets = {"Floors": floors, "Items": items, "Routes": routes, "Places": PLACES[:0]}
    return assess_routed(tmp_path_factory.mktemp("crowded") / "w.xlsx", settings, **sheets)


@pytest.mark.parametrize("language", ["en", "it"])
def test_the_summary_stays_on_one_page(crowded, language, tmp_path):
    weasyprint = load_weasyprint()
    look = Look(language=language)
    with look.spoken():
        html = render(crowded, look, for_print=True)
    head, _, rest = html.partition('<section id="summary">')
    summary, end, _ = rest.partition("</section>")
    (tmp_path / "s.html").write_text(f'{head}<section id="summary">{summary}{end}</body></html>', encoding="utf-8")
    weasyprint.HTML(filename=str(tmp_path / "s.html")).write_pdf(tmp_path / "s.pdf")
    pages = [page.get_textpage().get_text_range() for page in pypdfium2.PdfDocument(tmp_path / "s.pdf")]
    titles = {"en": "Summary", "it": "Sintesi"}
    assert sum(page.lstrip().startswith(titles[language]) for page in pages) == 1
    assert pages[-1].lstrip().startswith(titles[language])
    assert "Long name of route" in pages[-1]
    assert len(build_content(crowded).summary.fixes) > FIXES
