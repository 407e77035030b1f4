"""Pages one and two of the report: the consequence, the building with a dot a piece, the plan, and how sure it is."""

import re

import pytest
from lxml import html

from assess.report.content import Content
from assess.report.figures.building import draw_building
from assess.report.pages.html import render
from assess.report.report_options import ReportOptions
from assess.report.say.simulation import list_effects
from assess.report.sections.certainty import SURVEY
from assess.results import count_pieces
from assess.risk import RiskClass, classify
from assess.settings import Settings
from tests.workbooks import assessed

TALL = {"type": "Bookcase 6 shelves", "anchored": "no"}
ITEMS = [
    {"item": "A1", "floor": "2", "room": "Archive", "quantity": 3, "importance": "life safety", **TALL},
    {"item": "A2", "floor": "2", "room": "Archive", **TALL},
    {"item": "A3", "floor": "1", "room": "Office", "breadth": 45, "width": 90, "height": 180, "anchored": "no"},
    {"item": "A4", "floor": "1", "room": "Office", "breadth": 30, "width": 90, "height": 200, "anchored": "yes"},
    {"item": "A5", "floor": "1", "room": "Ward", "breadth": 90, "width": 200, "height": 95, "mobile": "yes"},
]
FLOORS = [{"floor": "2", "elevation": 8.0, "pfa_x": 0.5, "pfv_x": 50.0},
          {"floor": "1", "elevation": 4.0, "pfa_x": 0.3, "pfv_x": 30.0}]  # fmt: skip
BUILDING = {"scenario": "A strong quake, of 1999", "surveyed_by": "A. Surveyor", "extent": "Floors 1 and 2",
            "prepared_by": "B. Engineer"}  # fmt: skip


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    path = tmp_path_factory.mktemp("decision") / "w.xlsx"
    return assessed(path, ITEMS, FLOORS, settings=Settings(runs=50), **BUILDING)


@pytest.fixture(scope="module")
def page(results):
    options = ReportOptions(language="en")
    with options.spoken():
        return html.fromstring(render(Content(results), options, for_print=True, edition="client"))


def _read(page, section):
    return " ".join(page.get_element_by_id(section).text_content().split())


def test_page_one_says_the_consequence_first_and_what_the_first_phase_takes_away(results, page):
    text, total = _read(page, "summary"), Content(results).total
    assert re.match(r"Summary In an earthquake like this one \(A strong quake\), about [\d.]+ of 5 free-standing", text)
    first = results.schedule.phases[0]
    share = 100 * first.falls_avoided / results.schedule.before.falls
    assert f"Fixing {first.pieces} pieces in {first.places} place" in text
    assert f"takes {share:.0f} % of the falls away" in text
    assert "1 piece stands on castors" in text
    assert f"of {total.free} free-standing pieces" in text
    for name in ("B. Engineer", "Signature", "Status: Simulated", "A: now"):
        assert name in text


def test_every_piece_is_a_dot_in_the_shape_of_its_class_and_floors_are_stacked(results):
    content = Content(results)
    drawing = draw_building(content.floors, results.route_tables)
    assert drawing is not None
    image, about = drawing
    assert about == "Each dot is 1 piece."
    drawn = html.fromstring(image.source)
    squares, triangles, diamonds = (
        image.source.count(shape) for shape in ("M-3.6 -3.6H3.6V3.6H-3.6Z", "M0 -4L4 3.4H-4Z", "M0 -4L4 0L0 4L-4 0Z")
    )
    total = content.total
    by_class = total.by_class
    assert (squares, triangles, diamonds) == tuple(
        by_class[risk] for risk in (RiskClass.VERY_HIGH, RiskClass.HIGH, RiskClass.MEDIUM)
    )
    dots = squares + triangles + diamonds + len(drawn.xpath("//circle"))
    assert dots == count_pieces(results)
    labels = drawn.xpath("//text/text()")
    assert labels.index("Floor 2") < labels.index("Floor 1")


def test_a_dot_stands_for_more_pieces_where_there_are_many(tmp_path):
    many = [{"item": "A1", "floor": "2", "quantity": 900, **TALL}]
    content = Content(assessed(tmp_path / "w.xlsx", many, FLOORS[:1]))
    drawing = draw_building(content.floors, content.run.route_tables)
    assert drawing is not None
    image, about = drawing
    (per,) = map(int, re.findall(r"up to (\d+) pieces", about))
    assert len(re.findall(r'transform="translate', image.source)) == -(-900 // per)


def test_page_two_counts_what_each_method_calls_high_and_what_moves_the_result(results, page):
    rows = {
        row[0].text_content(): row[1].text_content()
        for row in page.get_element_by_id("certainty").xpath(".//table[contains(@class, 'methods-count')]/tbody/tr")
    }
    loose = [one for one in results if not one.is_anchored and one.apart != "rolls"]
    adopted = count_pieces(one for one in loose if one.adopted.risk >= RiskClass.HIGH)
    assert rows["Simulated: an earthquake like this one"] == f"{adopted} of 5"
    formula = count_pieces(
        one for one in loose
        if one.adopted.can_rock and (classify(one.worst("fema_p58") or 0.0) or 0) >= RiskClass.HIGH
    )  # fmt: skip
    assert rows["FEMA P-58 contents"] == f"{formula} of 5"
    effects = list_effects(results, list(results))
    assert len(effects) == 2
    now = Content(results).total.expected
    for _label, low, high in effects:
        assert low <= now + 1e-9
        assert high >= now - 1e-9
    slow, sizes = effects
    assert slow[1] < slow[2]
    assert sizes[1:] == pytest.approx((min(now, *results.size_falls), max(now, *results.size_falls)))
    assert results.size_falls[0] <= results.size_falls[1]


def test_page_two_says_who_surveyed_and_what_is_not_stated(page):
    text = _read(page, "certainty")
    assert "Surveyed byA. Surveyor" in text
    assert "ExtentFloors 1 and 2" in text
    left = re.findall(r"Not stated: ([^.]*)\.", text)[0].split(", ")
    assert len(left) == len(SURVEY) - 2
    assert "Survey date" in left
