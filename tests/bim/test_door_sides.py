"""What lies on either side of doors, which of them lead out, and which storey is the ground."""

from collections import Counter
from dataclasses import replace

from assess.bim.building_model import BuildingModel, Storey
from assess.bim.draft_floor import find_ground, find_kinds, find_sides
from tests.bim.office_models import door, rectangle, room

TWO = room("a", 0, 0, 4, 4), room("b", 4.1, 0, 8, 4)


def model(*doors, spaces=TWO, elevations=(0.0,)) -> BuildingModel:
    storeys = tuple(Storey(str(at), f"Level {at}", z, z) for at, z in enumerate(elevations))
    return BuildingModel(source="a.ifc", schema="IFC4", storeys=storeys, spaces=spaces, doors=doors)


def count(found: BuildingModel) -> dict[str, Counter[str]]:
    kinds, names = find_kinds(found, find_sides(found)), {one.key: one.name for one in found.storeys}
    counts: dict[str, Counter[str]] = {}
    for one in found.doors:
        counts.setdefault(names[one.storey], Counter())[kinds[one.key]] += 1
    return counts


def test_doors_of_published_models(large, duplex):
    assert count(large) == {"Level 1": {"exit": 10, "inside": 8}}
    assert count(duplex) == {"Level 1": {"exit": 4, "inside": 2}, "Level 2": {"inside": 8}}
    assert find_ground(duplex).name == "Level 1"


def test_each_side_of_a_door_has_a_space_or_none_also_in_thick_walls_and_large_spaces():
    for at, kind, sides in (
        ((4.05, 2.0, 0.0), "inside", ("b", "a")), ((4.05, 2.0, 180.0), "inside", ("a", "b")),
        ((-0.05, 2.0, 0.0), "exit", ("a", "")), ((-0.05, 2.0, 180.0), "exit", ("", "a")),
        ((2.0, 2.0, 37.0), "same room", ("a", "a")), ((20.0, 2.0, 0.0), "no room", ("", "")),
    ):  # fmt: skip
        found = model(door("d", *at))
        assert (find_sides(found), find_kinds(found, find_sides(found))) == ({"d": sides}, {"d": kind}), (at, kind)
    # The wall is 1 m thick and not cut; the leaf is 6 cm and has no opening of its own.
    for x in (4.03, 4.97, 4.5):
        leaf = replace(door("d", x, 2.0, 0.0), thickness=0.06)
        found = model(leaf, spaces=(room("a", 0, 0, 4, 4), room("b", 5, 0, 9, 4)))
        walled = replace(found, walls={"0": (rectangle(4, -1, 5, 5),)})
        assert (find_sides(walled), find_kinds(walled, find_sides(walled))) == ({"d": ("b", "a")}, {"d": "inside"}), x
    # Some programs export a whole storey as a space, too.
    leaf, a, b = door("d", 4.05, 2.0, 0.0), room("a", 0, 0, 4, 4), room("b", 4.1, 0, 8, 4)
    assert find_sides(model(leaf, spaces=(room("zone", -1, -1, 9, 5), a, b))) == {"d": ("b", "a")}
    found = model(leaf, spaces=(a, replace(b, storey="1")), elevations=(0.0, 3.0))
    assert find_sides(found) == {"d": ("", "a")}
    leaf = replace(door("d", 4.03, 2.0, 0.0), thickness=0.06)
    found = replace(model(leaf, spaces=(room("a", 0, 0, 4, 4),)), walls={"0": (rectangle(4, -1, 5, 5),)})
    assert find_kinds(found, find_sides(found)) == {"d": "exit"}
    # Beyond a passage of 80 cm that has no space.
    leaf = door("d", 4.05, 2.0, 0.0)
    found = model(leaf, spaces=(room("a", 0, 0, 4, 4), room("b", 5.2, 0, 9, 4)))
    walled = replace(found, walls={"0": (rectangle(4, -1, 4.1, 5), rectangle(4.9, -1, 5.2, 5))})
    assert find_sides(walled) == {"d": ("", "a")}
    found = model(replace(door("d", 4.25, 2.0, 0.0), thickness=0.1),
                  spaces=(room("a", 0, 0, 4, 4), room("b", 4.7, 0, 8, 4)))  # fmt: skip
    assert find_sides(found) == {"d": ("b", "a")}
    foundation_and_slab = model(door("d", -0.05, 2.0, 0.0, "2"), spaces=(room("a", 0, 0, 4, 4, storey="2"),),
                                elevations=(-0.5, -0.1, 0.0))  # fmt: skip
    assert find_ground(foundation_and_slab).name == "Level 2"
    assert find_ground(model(spaces=())) is None
    assert find_ground(model()) is None


def test_the_ground_is_the_lowest_storey_with_doors_that_is_no_basement():
    for elevations, ground in (
        ((0.0, 3.0, 6.0), "Level 0"),
        ((-3.0, 0.0, 3.0), "Level 1"),
        ((-6.0, -3.0, -0.4), "Level 2"),  # a few steps down
        ((-9.0, -6.0, -3.0), "Level 2"),  # all below: the highest
        ((1.2, 4.0, 7.0), "Level 0"),
        ((520.0, 523.0, 526.0), "Level 0"),  # elevations above the sea
    ):
        keys = ("0", "1", "2")
        found = model(
            *(door(f"d{key}", -0.05, 2.0, 0.0, key) for key in keys),
            spaces=tuple(room(f"r{key}", 0, 0, 4, 4, storey=key) for key in keys),
            elevations=elevations,
        )
        assert find_ground(found).name == ground, (elevations, ground)
        kinds = find_kinds(found, find_sides(found))
        assert {key: kinds[f"d{key}"] for key in keys} == {
            key: "exit" if f"Level {key}" == ground else "outside" for key in keys
        }
