"""The map of risk over breadth and PFA: what is chosen, what is computed, what is drawn."""

import base64
import xml.etree.ElementTree as ET

import pytest

from assess.i18n import Catalogue, speaking
from assess.methods import Cases, all_methods
from assess.report.figures.draw import draw
from assess.report.figures.risk_map import LINES, MOST_NAMES, draw_contours
from assess.settings import Settings
from assess.units import GRAVITY
from tests.workbooks import assessed

FLOORS = [{"floor": "1", "pfa_x": 0.5, "pfv_x": 60}, {"floor": "2", "pfa_x": 0.3}]
TALL = {"breadth": 40, "height": 200}


def _choose(folder, *sizes, floors=FLOORS):
    return assessed(
        folder / "w.xlsx",
        [{"item": f"i{at}", "floor": "1", "axis": "X", **size} for at, size in enumerate(sizes)],
        floors,
    )


def _ids(results, *names):
    """Return how many elements of the figure have each id."""
    source = draw_contours(results).image.source
    drawn = list(ET.fromstring(base64.b64decode(source.partition(",")[2])).iter())
    return [sum(one.get("id", "") == name for one in drawn) for name in names]


def test_the_height_that_most_risky_pieces_share_and_of_those_as_common_the_larger(tmp_path):
    slim, stout = {"breadth": 30, "height": 150}, {"breadth": 300, "height": 200}
    for sizes, height in (
        ((TALL, slim), 200),
        ((TALL, slim, {**slim, "breadth": 25}), 150),
        ((stout, {**stout, "height": 90, "quantity": 3}), 90),
        (({"breadth": 5, "height": 5.2},), 5),
        (({"breadth": 5, "height": 204.9},), 200),
    ):
        assert _choose(tmp_path, *sizes).series["contours/height_cm"] == height
    assert "contours/items" not in _choose(tmp_path, {**TALL, "anchored": "yes"}).series


@pytest.mark.parametrize("pfv", [60, None])
def test_the_map_is_that_of_the_methods(tmp_path, pfv):
    results = _choose(tmp_path, TALL, floors=[{"floor": "1", "pfa_x": 0.5, "pfv_x": pfv}])
    known, series = results.motions_of("1", "X")[0].pfv_cm_s, results.series
    breadth, peaks = series["contours/breadth_cm"], series["contours/pfa_g"]
    for key in ("fema_p58", "proposed_or", "kaneko_hayashi"):
        risk = series[f"contours/{key}"]
        evaluate = next(one.evaluate for one in all_methods() if one.key == key)
        assert risk.shape == (peaks.size, breadth.size)
        for row, column in ((0, 0), (3, 70), (60, 20), (120, 120)):
            speed = peaks[row] / 0.5 * known / 100
            case = Cases.of(breadth=breadth[column] / 100, height=2.0, pfa=peaks[row] * GRAVITY, pfv=speed)
            assert risk[row, column] == pytest.approx(evaluate(case, Settings()).value[0], rel=1e-6)


@pytest.mark.slow
def test_one_piece_many_and_one_of_a_strange_name_whose_chance_is_everywhere_one(tmp_path):
    assert _ids(_choose(tmp_path, TALL), "piece", "name", "checked") == [3, 3, 2], "of FEMA P-58 and of the paper"
    many = _choose(tmp_path, *[{"breadth": 20 + 3 * at, "height": 200} for at in range(24)], TALL, TALL)
    pieces, names, chances = _ids(many, "piece", "name", "chance")
    assert pieces == 3 * len({one.item.breadth_cm for one in many})
    assert 3 <= names <= 3 * MOST_NAMES
    assert 3 * 4 <= chances <= 3 * len(LINES)
    assert len(draw_contours(many).image.source) < 340_000
    size = {"item": "棚 $x$ \u0628", "breadth": 5, "height": 300}
    assert _ids(_choose(tmp_path, size, floors=[{"floor": "1", "pfa_x": 4.0, "pfv_x": 900}]), "piece") == [3]


@pytest.mark.parametrize("shares", [False, True])
def test_ticks_are_written_once_with_the_decimal_sign_of_the_language(shares):
    found = []

    def paint(figure):
        panels = figure.subplots(1, 2, sharey=shares)
        for axes in panels:
            axes.plot([0, 1], [0, 0.5])
        panels[1].set_xticks([0, 1], ["J.P. Room", "1,5"])
        found.append(panels)

    with speaking(Catalogue("it", decimal=",", group=".")):
        draw(4, 2, paint)
        labels = [[text.get_text() for text in axes.get_yticklabels()] for axes in found[0]]
        assert "0,2" in labels[0]
        assert not any("." in text for one in labels for text in one)
        assert [text.get_text() for text in found[0][1].get_xticklabels()] == ["J.P. Room", "1,5"]
