"""Friction and walls through a whole run: what is reported beside the chance, and that no chance or class changes."""

from dataclasses import replace

import pytest

import assess
from assess.settings import Settings
from tests.pipeline.rows import read_sheets
from tests.shaking import write_records

SETTINGS = Settings(runs=40)
FLOORS = [{"floor": "1", "record_x": "pulse.csv"}, {"floor": "2", "pfa_x": 0.4, "pfv_x": 50, "pfa_y": 0.4, "pfv_y": 50}]
SIZES = {"slender": (30, 180), "usual": (45, 180), "low": (60, 80), "stocky": (145, 100), "top-heavy": (45, 180)}
OUTLINE = "0 1.1; 8 1.1; 8 6; 0 6"


def pieces(floor="1", axis="X", **more):
    top_heavy = {"top-heavy": {"centre_of_gravity": 60}}
    return [
        {"item": f"{name} {floor}", "floor": floor, "breadth": b, "width": max(b, 90), "height": h, "axis": axis}
        | more
        | top_heavy.get(name, {})
        for name, (b, h) in SIZES.items()
    ]


def run(folder, items=None, places=(), settings=SETTINGS, routes=(), **building):
    write_records(folder, "pulse")
    sheets = {
        "Building": [{"period": 0.8} | building], "Floors": FLOORS, "Items": items or [*pieces(), *pieces("2")],
        "Places": list(places), "Routes": list(routes),
    }  # fmt: skip
    return assess.run(read_sheets(folder, **sheets), settings, figures=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("slip")


@pytest.fixture(scope="module")
def plain(folder):
    return run(folder)


@pytest.fixture(scope="module")
def smooth(folder):
    return run(folder, friction=0.2)


@pytest.fixture(scope="module")
def walled(folder):
    return run(folder, [*pieces(against_wall="yes"), *pieces("2", against_wall="yes")], friction=0.2)


def without_beside(results):
    """Everything that is adopted of every piece, and what the methods give, but for the flags of sliding and walls."""
    beside = {"slides", "shenton_extended", "wall_higher"}
    return [
        (replace(one.adopted, flags=tuple(flag for flag in one.adopted.flags if flag not in beside)),
         one.governing.simulation, {key: found.value for key, found in one.governing.methods.items()})
        for one in results
    ]  # fmt: skip


def test_sliding_and_walls_change_no_probability_and_no_class(plain, smooth, walled):
    assert without_beside(plain) == without_beside(smooth) == without_beside(walled)
    assert max(one.adopted.probability for one in plain) > 0.3, "there is something to change"
    assert smooth.settings.slide_coefficient == 1


@pytest.mark.parametrize("options", [{"ideal": True}, {"verify": "none"}, {"runs": "auto"}])
def test_nor_in_other_runs(tmp_path, options):
    settings = replace(SETTINGS, **options)
    items = pieces("2")[2:3]
    before = run(tmp_path, items, settings=settings)
    after = run(tmp_path, [one | {"against_wall": "yes"} for one in items], settings=settings, friction=0.15)
    assert without_beside(before) == without_beside(after)
    assert [one.governing.sliding.branch for one in after] == ["slide"]
    has_motions = options.get("verify") != "none"
    assert {one.governing.sliding.slip_84_cm is not None for one in after} == {has_motions}
    assert {one.governing.one_sided is not None for one in after} == {has_motions}


def test_branch_at_the_floors_pfa_and_its_flag(smooth):
    """Shenton 1996 at 0.40 g: B/H 1/6 slides and rocks at a friction of 0.2 (mu* 0.23), B/H 1/4 and more slide."""
    found = {name: smooth[f"{name} 2"] for name in SIZES}
    assert [one.governing.sliding.branch for one in found.values()] == [
        "slide and rock", "slide", "slide", "slide", "slide",
    ]  # fmt: skip
    assert all("slides" in one.adopted.flags for one in found.values())
    assert [name for name, one in found.items() if "shenton_extended" in one.adopted.flags] == ["top-heavy"]


def test_rest_and_rock_are_not_flagged(tmp_path):
    items = pieces("2", friction=0.5)
    found = list(run(tmp_path, items, settings=Settings(verify="none")))
    assert [one.governing.sliding.branch for one in found] == ["rock", "rock", "rest", "rest", "rock"]
    assert not any("slides" in one.adopted.flags for one in found)


def test_slip_is_of_those_that_may_slide_alone(plain, smooth, tmp_path):
    assert all(one.governing.sliding is None for one in plain)
    slips = {one.item.item: one.governing.sliding for one in smooth}
    assert all(one.slip_median_cm <= one.slip_84_cm for one in slips.values())
    assert slips["usual 2"].slip_84_cm == slips["low 2"].slip_84_cm == slips["stocky 2"].slip_84_cm > 1
    assert slips["usual 1"] != slips["usual 2"], "floors differ"
    rough = run(tmp_path, pieces("2", friction=1.9))
    assert {one.governing.sliding.slip_84_cm for one in rough} == {None}


def test_slip_grows_with_less_friction_and_with_the_motion(tmp_path):
    items = [
        one | {"item": f"{at}", "friction": mu} for at, mu in enumerate((0.1, 0.2, 0.3)) for one in pieces("2")[2:3]
    ]
    weak, strong = (run(tmp_path, items, settings=replace(SETTINGS, scale=scale)) for scale in (1.0, 1.5))
    for results in (weak, strong):
        slips = [one.governing.sliding.slip_median_cm for one in results]
        assert slips == sorted(slips, reverse=True)
        assert slips[0] > slips[2]
    for before, after in zip(weak, strong, strict=True):
        assert after.governing.sliding.slip_median_cm > before.governing.sliding.slip_median_cm


def test_slip_does_not_depend_on_other_pieces_and_needs_no_simulation(smooth, tmp_path):
    alone = run(tmp_path, pieces("2")[3:4], friction=0.2)
    (one,) = alone
    assert one.governing.sliding == smooth["stocky 2"].governing.sliding
    assert one.governing.sliding.slip_84_cm > 1
    assert (one.governing.simulation, alone.has_simulated) == (None, False)


# --- walls ---


def test_the_one_sided_chance_stands_beside(plain, walled):
    assert all(one.governing.one_sided is None for one in plain)
    found = {one.item.item: one.governing.one_sided for one in walled}
    assert found["stocky 2"] is None
    assert 0 < found["slender 2"] < walled["slender 2"].adopted.probability
    assert all(one.item.against_wall and one.item.falls_toward_deg is None for one in walled)


def test_the_outline_of_the_room_tells_the_side(tmp_path):
    """Along one wall it falls one way, along the other the other way; in the middle of the room that is not known."""
    at = {"against_wall": "yes", "angle_deg": 90, "x": 4, "room": "Office", "axis": None}
    names = {"south": 1.25, "north": 5.85, "middle": 3.0}
    (shape, *_) = pieces("2")
    items = [shape | at | {"item": name, "y": y} for name, y in names.items()]
    found = run(tmp_path, items, [{"place": "Office", "floor": "2", "outline": OUTLINE}])
    assert [one.item.falls_toward_deg for one in found] == [90, 270, None]
    assert [one.governing.motion.axis for one in found] == ["Y"] * 3
    notes = [one for one in found.problem_rows if "against a wall" in one.message]
    assert [(one.severity, one.sheet) for one in notes] == [("note", "Items")]
    assert "within 0.30 m" in notes[0].message


@pytest.mark.parametrize(("outline", "wall", "blocks"), [(OUTLINE, "yes", False), (None, "yes", True)])
def test_a_piece_that_falls_away_from_the_corridor_does_not_block_it(tmp_path, outline, wall, blocks):
    (shape, *_) = pieces("2", axis=None)
    item = shape | {"x": 4, "y": 1.3, "angle_deg": 90, "room": "Office"} | ({"against_wall": wall} if wall else {})
    places = [
        {"place": "Office", "floor": "2", **({"outline": outline} if outline else {})},
        {"place": "West", "floor": "2", "x": 0, "y": 0, "kind": "room"},
        {"place": "East", "floor": "2", "x": 8, "y": 0, "kind": "exit"},
    ]
    way = {"route": "Way", "segment": "a", "floor": "2", "start": "West", "end": "East", "clear_width": 1.8}
    found = run(tmp_path, [item], places, routes=[way])
    (segment,) = found.route_tables.segments
    assert (segment.blocked.probability > 0.3) is blocks
    assert bool(segment.pieces) is blocks
    (one,) = found
    assert one.adopted.probability > 0.3, "its own chance is the same"
