"""A school under the map of a small near earthquake: the same by the map as with its PGA and PGV typed in.

A scenario of magnitude 5.8 under New York: 0.547 g, but 13.6 cm/s, a tenth of what a spectrum by PGA alone would have.
"""

import pytest

from assess.settings import Settings
from tests.motion.grids import build_grid
from tests.pipeline.rows import assessed

PGA, PGV, SIGMA_PGA, SIGMA_PGV = 0.547, 13.6, 0.725, 0.65
SIZES = {"cabinet": (45, 90, 195), "shelf": (30, 100, 215), "bookcase": (30, 90, 200), "piano": (60, 150, 125)}
FLOORS = [{"floor": str(at + 1), "elevation": 3.6 * at} for at in range(4)]
ITEMS = [
    {"item": f"{floor['floor']} {name}", "floor": floor["floor"], "breadth": b, "width": w, "height": h}
    for floor in FLOORS
    for name, (b, w, h) in SIZES.items()
]
SCHOOL = {"latitude": 40.629, "longitude": -73.900, "height": 14.4}


def chances(items, floors, folder=None, **building):
    results = assessed(items, floors, folder, settings=Settings(runs=100), **building, **SCHOOL)
    return {one.item.item: one.adopted.probability for one in results}


@pytest.fixture(scope="module")
def by_map(tmp_path_factory):
    folder = tmp_path_factory.mktemp("school")
    fields = {"PGA": ("pctg", 100 * PGA), "PGV": ("cms", PGV), "STDPGA": ("", SIGMA_PGA), "STDPGV": ("", SIGMA_PGV)}
    spread = {name: (unit, (value,) * 4) for name, (unit, value) in fields.items()}
    (folder / "grid.xml").write_bytes(build_grid(spread, (41.0, 40.0), (-74.5, -73.5)))
    return chances(ITEMS, FLOORS, folder, shakemap="grid.xml")


@pytest.mark.slow
def test_a_map_and_its_typed_peaks_are_one_motion(by_map):
    ground = {"ground_pga": PGA, "ground_pgv": PGV, "motion_uncertainty": SIGMA_PGV}
    assert chances(ITEMS, FLOORS, **ground) == by_map


def test_on_the_ground_it_is_what_the_floor_s_own_peaks_give(by_map):
    """Expected falls of the ground floor within 20 %."""
    floors = [FLOORS[0] | {"pfa_x": PGA, "pfa_y": PGA, "pfv_x": PGV, "pfv_y": PGV}]
    items = [one for one in ITEMS if one["floor"] == "1"]
    found = chances(items, floors, motion_uncertainty=SIGMA_PGV)
    for name, chance in found.items():
        assert chance == pytest.approx(by_map[name], abs=0.03)
    assert sum(found.values()) == pytest.approx(sum(by_map[one] for one in found), rel=0.2)


@pytest.mark.slow
def test_a_low_velocity_topples_little_on_the_ground_and_more_of_it_more(by_map):
    """With the velocity of a large earthquake, 105 cm/s per g, most of what stands on the ground floor falls."""
    ground = {"ground_pga": PGA, "ground_pgv": 105 * PGA, "motion_uncertainty": SIGMA_PGV}
    found = chances(ITEMS, FLOORS, **ground)
    low, high = (sum(of[f"1 {name}"] for name in SIZES) for of in (by_map, found))
    assert low < 0.2
    assert high > 1.5
