"""The map of risk over breadth and PFA: what is chosen, what is computed, what is drawn."""

import math
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from assess.i18n import Catalogue, speaking
from assess.methods import Cases, all_methods
from assess.pipeline import series
from assess.report.figures.draw import draw
from assess.report.figures.risk_contours import build_contours, draw_contours
from assess.report.figures.risk_map import (
    GAP,
    LETTER,
    LINE,
    LINES,
    MOST_NAMES,
    box_around,
    find_clearest,
    find_room,
)
from assess.settings import Settings
from assess.units import GRAVITY
from tests.workbooks import assessed

FLOORS = [{"floor": "1", "pfa_x": 0.5, "pfv_x": 60}, {"floor": "2", "pfa_x": 0.3}]
TALL = {"breadth": 40, "height": 200}
SETTINGS = Settings()


def _items(*sizes):
    return [{"item": f"i{at}", "floor": "1", "axis": "X", **size} for at, size in enumerate(sizes)]


def _build(folder, items, floors=FLOORS, **building):
    """Return the results, which hold the series while they live, and what is drawn of them."""
    results = assessed(folder / "w.xlsx", items, floors, **building)
    return results, build_contours(results)


def _chosen(folder, *sizes, **building):
    return _build(folder, _items(*sizes), **building)[1]


def _ids(contours, name):
    drawn = ET.fromstring(draw_contours(contours))
    return [one for one in drawn.iter() if one.get("id", "") == name]


@pytest.fixture(scope="module")
def mixed(tmp_path_factory):
    """Two high tall pieces and one nearly as tall, three stout ones, and one that is anchored."""
    sizes = [{**TALL, "quantity": 2}, {"breadth": 50, "height": 185}, {"breadth": 120, "height": 60, "quantity": 9}]
    items = [*_items(*sizes), {"item": "fixed", "floor": "1", **TALL, "anchored": "yes"}]
    return _build(tmp_path_factory.mktemp("mixed"), items)[1]


# --- what is chosen ---


def test_the_height_that_most_risky_pieces_share(mixed):
    assert mixed.height_cm == 200
    assert [one.item.item for one in mixed.pieces] == ["i0", "i1"], "free-standing, within 10 %, the worst first"
    for one in mixed.pieces:
        assert mixed.breadth_cm[0] < one.item.breadth_cm < mixed.breadth_cm[-1]
        assert mixed.pfa_g[0] < one.governing.motion.pfa_g < mixed.pfa_g[-1]


def test_of_heights_as_common_the_larger(tmp_path):
    slim = {"breadth": 30, "height": 150}
    assert _chosen(tmp_path, TALL, slim).height_cm == 200
    assert _chosen(tmp_path, TALL, slim, {**slim, "breadth": 25}).height_cm == 150


def test_without_risky_pieces_the_commonest_height(tmp_path):
    chosen = _chosen(tmp_path, {"breadth": 300, "height": 200}, {"breadth": 300, "height": 90, "quantity": 3})
    assert chosen.height_cm == 90


@pytest.mark.parametrize(("height", "rounded"), [(5.2, 5), (49.4, 49), (204.9, 200)])
def test_every_piece_lies_on_the_map_of_its_own_height(tmp_path, height, rounded):
    chosen = _chosen(tmp_path, {"breadth": 5, "height": height})
    assert (chosen.height_cm, len(chosen.pieces)) == (rounded, 1)


def test_nothing_without_free_standing_pieces(tmp_path):
    items = [{"item": "fixed", "floor": "1", **TALL, "anchored": "yes"}]
    assert _build(tmp_path, items)[1] is None


# --- what is computed ---


@pytest.mark.parametrize("pfv", [60, None])
def test_the_map_is_that_of_the_methods(tmp_path, pfv):
    results, chosen = _build(tmp_path, _items(TALL), [{"floor": "1", "pfa_x": 0.5, "pfv_x": pfv}])
    known = results.motions_of("1", "X")[0].pfv_cm_s
    assert pfv in (None, known)
    assert [method.key for method, _risk in chosen.panels] == ["fema_p58", "proposed_or", "kaneko_hayashi"]
    for method, risk in chosen.panels:
        evaluate = next(one.evaluate for one in all_methods() if one.key == method.key)
        assert risk.shape == (chosen.pfa_g.size, chosen.breadth_cm.size)
        for row, column in ((0, 0), (3, 70), (60, 20), (120, 120)):
            pfa = chosen.pfa_g[row]
            speed = pfa / 0.5 * known / 100
            case = Cases.of(breadth=chosen.breadth_cm[column] / 100, height=2.0, pfa=pfa * GRAVITY, pfv=speed)
            assert risk[row, column] == pytest.approx(evaluate(case, SETTINGS).value[0], rel=1e-6)


@pytest.mark.slow
def test_pieces_too_stocky_to_rock_have_no_chance_on_the_map(tmp_path):
    """FEMA P-58 gives them no value."""
    chosen = _chosen(tmp_path, {"breadth": 300, "height": 100}, {"breadth": 20, "height": 100})
    risk = next(risk for method, risk in chosen.panels if method.key == "fema_p58")
    assert not risk[:, chosen.breadth_cm >= 141].any()
    assert risk[:, chosen.breadth_cm < 141].all()
    assert len(_ids(chosen, "lines")) == 3


def test_without_a_pfv_that_goes_with_a_pfa_there_is_no_map_by_it(tmp_path, monkeypatch):
    monkeypatch.setattr(series, "_velocity_ratio", lambda _worst: math.nan)
    chosen = _chosen(tmp_path, TALL)
    assert [method.key for method, _risk in chosen.panels] == ["proposed_or", "kaneko_hayashi"]
    assert len(_ids(chosen, "piece")) == 2
    assert "the panel Kaneko-Hayashi formula shows the largest chance that any PFV gives" in " ".join(chosen.caption)


# --- what is drawn ---


@pytest.mark.slow
def test_each_piece_is_drawn_in_every_panel(mixed):
    assert len(_ids(mixed, "piece")) == 3 * 2
    assert len(_ids(mixed, "name")) == 3 * 2
    assert len(_ids(mixed, "checked")) == 2, "only FEMA P-58 and the formula of the paper have a checked range"
    assert 3 * 4 <= len(_ids(mixed, "chance")) <= 3 * len(LINES)


@pytest.mark.slow
def test_one_piece_and_many(tmp_path):
    one = _chosen(tmp_path, TALL)
    assert (len(_ids(one, "piece")), len(_ids(one, "name"))) == (3, 3)
    many = _chosen(tmp_path, *[{"breadth": 20 + 3 * at, "height": 200} for at in range(24)], TALL, TALL)
    assert len(many.pieces) == 26
    assert len(_ids(many, "piece")) == 3 * len({one.item.breadth_cm for one in many.pieces})
    assert 3 <= len(_ids(many, "name")) <= 3 * MOST_NAMES
    assert len(draw_contours(many)) < 250_000


@pytest.mark.slow
def test_a_strange_name_and_a_chance_that_is_everywhere_one(tmp_path):
    items = [{"item": "棚 $x$ \u0628", "floor": "1", "axis": "X", "breadth": 5, "height": 300}]
    chosen = _build(tmp_path, items, [{"floor": "1", "pfa_x": 4.0, "pfv_x": 900}])[1]
    assert len(_ids(chosen, "piece")) == 3


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


# --- where texts go ---


def test_a_text_goes_beside_its_symbol_where_there_is_room():
    panel, wide = (100.0, 50.0), LETTER * 3
    first = find_room((50, 25), "abc", panel, [])
    assert first is not None
    assert first == pytest.approx((50 + GAP, 25 - LINE / 2, 50 + GAP + wide, 25 + LINE / 2))
    second = find_room((50, 25), "abc", panel, [first])
    assert second == pytest.approx((50 - GAP - wide, 25 - LINE / 2, 50 - GAP, 25 + LINE / 2))
    assert find_room((99, 25), "abc", panel, []) == pytest.approx((99 - GAP - wide, 21.5, 99 - GAP, 28.5))
    assert find_room((50, 25), "abc", panel, [box_around(50, 25, 90, 60)]) is None


def test_the_clearest_place_on_a_line():
    line = np.column_stack([np.linspace(0, 100, 11), np.full(11, 20.0)])
    assert find_clearest(line, (100.0, 50.0), np.array([[20.0, 20.0]]), 10) == 9
    assert find_clearest(line, (100.0, 50.0), np.array([[20.0, 20.0], [90.0, 20.0]]), 10) in (5, 6)
    assert find_clearest(line, (100.0, 50.0), np.empty((0, 2)), 10) == 1
    assert find_clearest(line, (100.0, 50.0), np.empty((0, 2)), 25) is None
