"""What assumed shaking does to the furniture of a home, held against what the classes of intensity say.

JMA's explanation table (2009): at 4 hanging objects swing and unstable ornaments may fall; at 5 lower unstable
furniture may move or fall; at 5 upper unfixed furniture may fall; at 6 lower most of it moves and some falls; at 6
upper most of it moves and more falls. The MMI's words: V, unstable objects overturned; VIII, heavy furniture
overturned. The
limits are about what the 44 far-field components of FEMA P-695, scaled to the velocity of each class, do to them.
"""

from functools import cache

import pytest

import assess

TALL = {
    "shelf": (25, 180), "bookcase": (30, 180), "cupboard": (40, 180), "chest": (42, 136), "dresser": (45, 175),
    "wardrobe": (60, 180), "refrigerator": (65, 175),
}  # fmt: skip
FLOORS = [{"floor": "ground", "elevation": 0}, {"floor": "upper", "elevation": 3}]


@cache
def find_chances(shaking: str) -> dict[str, list[float]]:
    """Return the chances of the seven pieces in a house of 6 m, in percent, by floor."""
    items = [
        {"item": f"{floor['floor']} {name}", "floor": floor["floor"], "breadth": b, "height": h, "axis": "X"}
        for floor in FLOORS
        for name, (b, h) in TALL.items()
    ]  # fmt: skip
    building = {"building": "House", "storeys": 2, "height": 6, "shaking": shaking}
    inventory = assess.read_inventory({"Building": [building], "Floors": FLOORS, "Items": items})
    results = assess.run(inventory, assess.Settings(verify="all", runs=400), figures=False)
    found: dict[str, list[float]] = {}
    for one in results:
        found.setdefault(one.item.floor, []).append(100 * one.adopted.probability)
    return found


@pytest.mark.slow
def test_at_jma_4_nothing_tall_falls_on_the_ground_floor():
    assert max(find_chances("JMA 4")["ground"]) <= 3


@pytest.mark.parametrize(
    ("shaking", "least", "most"),
    [
        ("JMA 4", 0, 1), ("JMA 5-, lower", 0, 10), ("JMA 5+, upper", 8, 30), ("JMA 6-, lower", 30, 65),
        ("JMA 6+, upper", 65, 95), ("MMI V, moderate", 0, 3), ("MMI VII, very strong", 8, 30),
    ],
)  # fmt: skip
def test_the_mean_chance_on_the_ground_floor(shaking, least, most):
    found = find_chances(shaking)["ground"]
    assert least <= sum(found) / len(found) <= most


@pytest.mark.parametrize("shaking", ["JMA 5-, lower", "JMA 5+, upper", "MMI VII, very strong"])
def test_upstairs_more_falls_but_not_much_more(shaking):
    """Real records through the beams of such a house: 3 to 6, 17 to 24 and 14 to 19 % from the ground floor upwards."""
    ground, upper = (sum(found) / len(found) for found in find_chances(shaking).values())
    assert ground < upper < ground + 12
