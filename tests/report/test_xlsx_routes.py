"""The sheets of the routes in the Excel report: every number is that of the results, and cells are texts."""

from typing import Any

import openpyxl
import pytest

from assess.i18n import Catalogue, load_catalogue, speaking
from assess.report.findings import at_risk
from assess.report.findings.route_words import say_basis, say_missing, say_segment_state
from assess.report.summary import ROUTES as MOST
from assess.route_results import RouteState
from assess.settings import Settings
from tests.recalculate import compare_formulas, write_report
from tests.report.routed import DOUBTED, ITEMS, KNOWN, PARTLY, assess_routed

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")


@pytest.fixture(scope="module", params=["formulas", "verified", "unconfirmed"])
def written(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("routes")
    simulated = {"settings": Settings(verify="all", runs=20)}
    more = {"formulas": {}, "verified": {**simulated, **KNOWN}, "unconfirmed": {**simulated, **DOUBTED}}[request.param]
    results = assess_routed(folder / "w.xlsx", **more)
    write_report(results, folder / "r.xlsx")
    return results, openpyxl.load_workbook(folder / "r.xlsx"), folder / "r.xlsx"


def _is(value):
    return pytest.approx(value) if isinstance(value, float) else (value or None if value != 0 else 0)


def _tables(sheet):
    """Return the tables of a sheet, by the title above each: rows by heading; "" is the first."""
    found: dict[str, list[dict[str, Any]]] = {}
    title, heads = "", None
    for row in sheet.iter_rows(values_only=True):
        cells = list(row)
        while cells and cells[-1] is None:
            cells.pop()
        if not cells:
            heads = None
        elif heads is None and len(cells) == 1:
            title = cells[0]
        elif heads is None:
            heads = cells
            found[title] = []
        else:
            found[title].append(dict(zip(heads, [*cells, *[None] * len(heads)], strict=False)))
    return found


def test_a_row_a_segment(written):
    results, book, _ = written
    rows = _tables(book["Routes"])[""]
    assert len(rows) == len(results.route_tables.segments)
    for row, one in zip(rows, results.route_tables.segments, strict=True):
        assert [row[name] for name in ("Route", "Segment", "Floor", "From", "To", "Notes")] == [
            text or None for text in (one.route, one.segment, one.floor, one.from_place, one.to_place, one.notes)
        ]
        assert _is(one.standing_width_m) == row["Width now [m]"]
        assert row["State"] == say_segment_state(one, results.route_tables.risk)
        if not one.evaluated:
            continue
        blocked, at_most = one.blocked, one.blocked_if_unconfirmed_fall
        assert row["Blocked if unconfirmed pieces fall"] == _is(at_most and at_most.probability)
        assert row["To fill in"] == (say_missing(one.missing) or None)
        if one.state == RouteState.NOT_KNOWN:
            assert {value for name, value in row.items() if name.startswith(("Chance b", "Interval"))} == {None}
            continue
        for name, value in {
            "Chance blocked": blocked.probability, "Interval low": blocked.low, "Interval high": blocked.high,
            "Chance narrowed or blocked": one.blocked_or_reduced.probability,
            "Blocked, all independent": blocked.independent,
            "Blocked, fully correlated": blocked.correlated, "Clear width [m]": one.clear_width_used_m,
            "Required width [m]": one.required_width_used_m, "Width if all fall [m]": one.least_width_m,
            "Width that they need [m]": one.needed_width_m, "Pieces": blocked.pieces,
            "By the formula alone": blocked.unverified, "Occupants": one.occupants,
        }.items():  # fmt: skip
            assert row[name] == _is(value), name
        anchors = one.blocked_if_anchors_fail
        assert row["Blocked if anchors fail"] == _is(anchors.probability if anchors else None)
        assert row["Most likely piece"] == (one.most_likely_piece and one.most_likely_piece.item)
        assert row["Basis"] == say_basis(blocked)
        assert row["Insufficient for occupants"] == (
            None if one.needed_width_m is None else "yes" if one.insufficient_for_occupants else "no"
        )
    assert [row["Insufficient for occupants"] for row in rows] == ["no", "yes", None, None, None]
    assert "0.9 m is used" in rows[3]["Remarks"]


def test_routes_and_floors_below(written):
    results, book, _ = written
    tables = _tables(book["Routes"])
    for row, one in zip(tables["Routes"], results.route_tables.routes, strict=True):
        assert (row["Route"], row["Segments"]) == (one.route, len(one.segment_indices))
        is_known = one.state != RouteState.NOT_KNOWN
        assert row["Chance blocked"] == _is(one.blocked.probability if is_known else None)
        fixed = ", ".join(results.item_rows[fix.item_index].item for fix in one.fixes)
        assert row["Pieces to anchor or move"] == (fixed or None)
        assert row["Chance left then"] == _is(one.fixes[-1].left if one.fixes else None)
    for row, floor in zip(tables["To be expected floor by floor"], results.route_tables.floors, strict=True):
        assert row["Blocked routes expected"] == _is(floor.blocked_routes_expected)
        assert row["Rooms expected to lose every exit"] == _is(floor.cut_off_rooms_expected)
        assert row["Routes not known"] == floor.unknown_routes
        assert row["Rooms not known"] == floor.unknown_rooms
        assert row["Pieces not counted"] == floor.uncounted_pieces
        assert row["Chance that any room does"] == _is(
            floor.any_room_cut_off.probability if floor.any_room_cut_off else None
        )


def test_pieces_beside_and_steps(written):
    results, book, _ = written
    tables = _tables(book["Route pieces"])
    expected = [(one, near) for one in results.route_tables.segments for near in one.pieces]
    assert len(tables[""]) == len(expected) == 3
    for row, (one, near) in zip(tables[""], expected, strict=True):
        result = results.result(near.item_index)
        assert (row["Segment"], row["Item"], row["Pieces"]) == (
            one.segment, result.item.item, result.item.quantity,
        )  # fmt: skip
        assert row["Chance of overturning"] == _is(result.adopted.probability)
        assert row["Falls and blocked"] == _is(near.falls_while_blocked)
        assert row["Width left beside it alone [m]"] == _is(near.left_m)
        assert row["Known by"] == ("plan" if near.by_plan else "Edge distance")
    assert tables[""][2]["Class (as run)"].startswith("⚓ depends on its anchor")
    assert tables[""][2]["Remarks"].startswith("anchored: its chances are those without the anchor")
    steps = tables["What to anchor or move for each route, step by step"]
    given = [(one, fix) for one in results.route_tables.routes for fix in one.fixes]
    for row, (one, fix) in zip(steps, given, strict=True):
        assert (row["Route"], row["Item"]) == (one.route, results.item_rows[fix.item_index].item)
        assert row["Chance blocked before"] == _is(fix.left + fix.gain)
        assert row["Chance blocked after"] == _is(fix.left)


def test_rooms_with_their_ways(written):
    results, book, _ = written
    rows = _tables(book["Route rooms"])[""]
    for row, one in zip(rows, results.route_tables.rooms, strict=True):
        assert (row["Room"], row["Exits that can be reached"]) == (one.room, "Street")
        lost = one.loses_every_exit
        values = (lost.probability, lost.low, lost.high) if one.is_known else (None,) * 3
        names = ("Chance of losing every exit", "Interval low", "Interval high")
        assert [row[name] for name in names] == [_is(value) for value in values]
        way = one.ways[0]
        assert row["Safest way: chance of a blockage"] == _is(way.blocked.probability if way.is_known else None)
        assert row["Ways out"] == 1
    assert rows[0]["Safest way: by"] == "West: aisle, West: flight, West: hall"
    assert rows[0].get("Alternative: to") is None


@pytest.fixture(scope="module")
def partly(tmp_path_factory):
    folder = tmp_path_factory.mktemp("partly")
    write_report(assess_routed(folder / "w.xlsx", **PARTLY), folder / "r.xlsx")
    return openpyxl.load_workbook(folder / "r.xlsx")


def test_what_is_not_evaluated_has_no_chance(partly):
    tables = _tables(partly["Routes"])
    segments = {row["Segment"]: row for row in tables[""]}
    routes = {row["Route"]: row for row in tables["Routes"]}
    for row in (segments["ladder"], segments["tunnel"], segments["gap"], routes["Cellar"]):
        assert row["State"] == "? not known"
        assert row["To fill in"].startswith("fill in ")
        told = [name for name, value in row.items() if value is not None and name.startswith(("Chance b", "Interval"))]
        assert not told
        assert {row[name] for name in ("Blocked, all independent", "Pieces", "By the formula alone", "Basis")} == {None}
    assert segments["tunnel"]["Remarks"] == "its places have no positions: only pieces that name it count"
    assert (segments["tunnel"]["Width now [m]"], segments["tunnel"]["Width if all fall [m]"]) == (1.2, None)
    assert segments["tunnel"]["Chance too narrow for occupants"] is None
    assert segments["gap"]["Chance too narrow for occupants"] == 1
    assert segments["ahead"]["Width if all fall [m]"] == 0
    assert routes["Out"]["State"] == "? not known"
    assert (routes["Out"]["Segments not evaluated"], routes["Cellar"]["Segments not evaluated"]) == (
        "ladder", "tunnel, gap",
    )  # fmt: skip


def test_what_is_not_counted_is_told(partly):
    tables = _tables(partly["Routes"])
    assert [row["Not counted, in another room"] for row in tables[""]] == ["behind", *[None] * 5]
    assert [row["Pieces not counted"] for row in tables["To be expected floor by floor"]] == [3]


def test_an_alternative_says_what_it_shares_with_the_safest_way(partly):
    (lab,) = _tables(partly["Route rooms"])[""]
    assert lab["Safest way: by"] != lab["Alternative: by"]
    assert lab["Alternative: by"].startswith("Out: aisle, Out: ")
    assert lab["Alternative: shared with the safest way"] == "Out: aisle"
    assert lab["Segments not evaluated, taken as open"] == "Out: ladder"


def test_a_way_of_which_nothing_is_evaluated_has_no_chance(tmp_path):
    ladder = {"route": "Up", "segment": "ladder", "floor": "G", "start": "Lab", "end": "Shaft", "clear_width": 1.2}
    write_report(assess_routed(tmp_path / "w.xlsx", **PARTLY | {"Routes": [ladder]}), tmp_path / "r.xlsx")
    (lab,) = _tables(openpyxl.load_workbook(tmp_path / "r.xlsx")["Route rooms"])[""]
    assert (lab["Safest way: by"], lab["Safest way: chance of a blockage"]) == ("Up: ladder", None)
    assert lab["Segments not evaluated, taken as open"] == "Up: ladder"


def _colour(state):
    return f"FF{state.fill.removeprefix('#').upper()}"


def test_states_have_sign_and_colour(written):
    results, book, _ = written
    for at, one in enumerate(results.route_tables.segments, 2):
        cell = book["Routes"].cell(at, 6)
        assert cell.value.startswith(f"{one.state.symbol} ")
        assert cell.fill.fgColor.rgb == _colour(one.state)
    worst = max((one.state for one in results.route_tables.segments), key=lambda state: state.severity)
    assert worst in (RouteState.BLOCKED, RouteState.NOT_KNOWN)
    assert _colour(worst) in {cell.fill.fgColor.rgb for row in book["Routes"].iter_rows() for cell in row}


def test_the_sheets_are_set_up(written):
    _, book, _ = written
    for name, frozen, area in (("Routes", "C2", "A1:AF6"), ("Route pieces", "A2", "A1:P4"),
                               ("Route rooms", "B2", "A1:Z3")):  # fmt: skip
        sheet = book[name]
        assert sheet.freeze_panes == frozen
        assert sheet.auto_filter.ref == area
        assert sheet.print_title_rows == "$1:$1"
        assert sheet.page_setup.orientation == "landscape"
        assert sheet["A1"].fill.fgColor.rgb == "FF1F3A4D"
    assert book["Routes"]["G2"].number_format == "0.0%"
    assert book["Routes"]["U2"].number_format == "0.00"


def test_no_text_is_a_formula(written):
    _, book, path = written
    for name in ("Routes", "Route pieces", "Route rooms"):
        for row in book[name].iter_rows():
            assert all(cell.data_type != "f" and cell.hyperlink is None for cell in row)
    assert book["Routes"]["AF2"].value == "=1+1"
    assert not [sheet for sheet in book for row in sheet.iter_rows(values_only=True) for cell in row
                if "not evaluated by this version" in str(cell)]  # fmt: skip
    assert compare_formulas(path) > len(ITEMS)


def test_the_summary_sheet_says_what_the_page_says(written):
    results, book, _ = written
    lines = [str(row[0]) for row in book["Summary"].iter_rows(max_row=20, max_col=1, values_only=True)]
    text = next(line for line in lines if line.startswith("Evacuation routes: "))
    for said in at_risk.say_routes(results):
        assert said in text
    for one in at_risk.list_routes_at_risk(results)[:MOST]:
        assert at_risk.describe_at_risk(one) in lines


def test_what_to_fix_first_says_for_which_route(written):
    results, book, _ = written
    rows = {row[5]: row for row in book["Work list"].iter_rows(min_row=2, values_only=True)}
    west = results.route_tables.routes[0]
    at_most = west.blocked_if_unconfirmed_fall
    before = f"{100 * west.blocked.probability:.1f} %" if at_most is None else "up to 100.0 %"
    said = rows["tall"][7].replace("\N{NO-BREAK SPACE}", " ")
    assert said.endswith(f"; route West: {before} → 0.0 % (step 1 of 1)")


def test_methods_tell_the_rule_and_the_widths_that_codes_ask_for(written):
    _, book, _ = written
    rows = [row for row in book["Methods"].values if row[0] == "Evacuation routes"]
    assert any(row[1] == "What was done" and "screening" in row[2] for row in rows)
    assert any(row[1] == "Required width" and "1.2 m: main evacuation route of an office" in row[2] for row in rows)
    assert any("0.9 m is taken" in row[2] for row in rows)


@pytest.mark.parametrize("language", ["it", "marked"])
def test_headings_in_another_language_stay_apart(written, language, tmp_path):
    """Columns are told apart by their headings: two with the same translation would be one."""
    texts = {"Clear width": ("Larghezza",), "Route": ("Via",)}
    with speaking(load_catalogue("it") if language == "it" else Catalogue("xx", texts)):
        write_report(written[0], tmp_path / "r.xlsx")
    book = openpyxl.load_workbook(tmp_path / "r.xlsx")
    own = [sheet for sheet in book.worksheets if sheet.title not in written[1].sheetnames] or book.worksheets
    for sheet in own:
        heads = [cell.value for cell in sheet[1] if cell.value]
        assert len(heads) == len(set(heads)), sheet.title
    widths = {len([cell for cell in sheet[1] if cell.value]) for sheet in book.worksheets}
    assert {32, 16, 26} <= widths
