"""Building models damaged at random: each ends in words, or in a workbook that lacks nothing but the shaking."""

import random
from collections.abc import Iterable
from pathlib import Path

import pytest

from assess.bim import model_process
from assess.bim.model_rows import Drafts
from assess.bim.read_source import read_source
from assess.errors import AssessError, WorkbookError
from assess.workbook.read import read_inventory, read_tables
from tests.bim.damaged_models import damage, write_house
from tests.bim.ifc_files import write_import

MODELS = Path(__file__).parents[2] / "samples" / "models"
QUICK = {"house": 2, "large": 1}
MANY = 60
"""Damaged models of each that are read by the slow tests and by the long ones."""
FOUND = {"house": (142, 143, 184, 315, 333, 344, 379, 496), "large": (1108,)}
"""Seeds that once broke something."""
ENDS = {"read", "refused"}
DRAFTS: tuple[Drafts, ...] = ("none", "draft")


@pytest.fixture(autouse=True)
def _limits(monkeypatch):
    """Bound the time of a model that the library does not come to an end with."""
    monkeypatch.setattr(model_process, "SECONDS", 20)


def read_damaged(data: bytes, seed: int, folder: Path) -> str:
    """Return how it ends to read a model after a damage by a seed: "refused", "read", or what is wrong with that."""
    draw = random.Random(seed)
    path = folder / "a.ifc"
    path.write_bytes(damage(data, draw))
    try:
        found = read_source(path, "a.ifc", routes=draw.choice(DRAFTS))
    except AssessError as error:
        return "refused" if error.message.startswith(("a.ifc", "The model")) else error.message
    book = write_import(found, folder)
    _, problems = read_tables(book.read_bytes(), book.name)
    errors = [str(one) for one in problems if one.severity == "error"]
    try:
        read_inventory(book)
    except WorkbookError as error:  # it lacks the shaking, and there may be no furniture
        errors += [] if error.is_incomplete else [error.message]
    return "\n".join(errors) or "read"


@pytest.fixture(scope="module")
def models(tmp_path_factory) -> dict[str, bytes]:
    house = write_house(tmp_path_factory.mktemp("house") / "house.ifc")
    return {"house": house.read_bytes(), "large": (MODELS / "LargeBuilding.ifc").read_bytes()}


@pytest.mark.parametrize(("name", "seed"), [(name, seed) for name, count in QUICK.items() for seed in range(count)])
@pytest.mark.slow
def test_a_damaged_model(tmp_path, models, name, seed):
    assert read_damaged(models[name], seed, tmp_path) in ENDS


def read_all(data: bytes, seeds: Iterable[int], folder: Path) -> set[str]:
    """Read a model after damages by seeds; return how they end, having checked that each does."""
    ends = {}
    for seed in seeds:
        own = folder / str(seed)
        own.mkdir()
        ends[seed] = read_damaged(data, seed, own)
    assert {seed: end for seed, end in ends.items() if end not in ENDS} == {}
    return {*ends.values()}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["house", pytest.param("large", marks=pytest.mark.long)])
def test_models_whose_damage_once_broke_something(tmp_path, models, name):
    assert "read" in read_all(models[name], FOUND[name], tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("name", FOUND)
def test_many_damaged_models(tmp_path, models, name):
    assert read_all(models[name], range(500, 500 + MANY), tmp_path) == ENDS


@pytest.mark.slow
def test_the_house_itself_is_read_whole(tmp_path):
    found = read_source(write_house(tmp_path / "a.ifc"), "a.ifc", routes="draft")
    assert [row["description"] for row in found.items] == ["Desk", "Shelf", "Shelf"] * 2
    assert {row["kind"] for row in found.places} >= {"room", "door", "exit", "stair"}
    assert [(one.type, one.count) for one in found.skipped] == [("IfcFurniture Wall unit", 2)]
    assert len(found.files) == 3  # two plans and the record
