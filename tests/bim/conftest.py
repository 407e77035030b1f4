"""What many tests of building models look at, made once for all of them."""

from collections.abc import Callable, Iterator
from contextlib import nullcontext
from pathlib import Path

import pytest

from assess.bim.building_model import BuildingModel
from assess.bim.ifc_model import read_model
from tests.bim.export_runs import PLACES, ROUTES, SIMULATED, write_flat, write_results
from tests.bim.model_here import models_read_here
from tests.bim.update_books import first_book

MODELS = Path(__file__).parents[2] / "samples" / "models"


APART = ("test_damaged_models", "test_read_source")
"""Files whose tests are about the process in which models are read."""


@pytest.fixture(autouse=True, scope="module")
def _models_read_here(request: pytest.FixtureRequest) -> Iterator[None]:
    """Read models in the process of the tests; `model_process` has tests of its own."""
    with nullcontext() if request.module.__name__.endswith(APART) else models_read_here():
        yield


@pytest.fixture(scope="session")
def duplex(make_once: Callable[..., BuildingModel]) -> BuildingModel:
    """Return a published model of two storeys in IFC2X3."""
    return make_once("duplex", lambda _: read_model(MODELS / "duplex.ifc", "duplex.ifc"))


@pytest.fixture(scope="session")
def large(make_once: Callable[..., BuildingModel]) -> BuildingModel:
    """Return a published model in millimetres."""
    return make_once("large", lambda _: read_model(MODELS / "LargeBuilding.ifc", "LargeBuilding.ifc"))


@pytest.fixture(params=["duplex", "large"])
def published(request: pytest.FixtureRequest) -> BuildingModel:
    """Return each of both."""
    model: BuildingModel = request.getfixturevalue(request.param)
    return model


@pytest.fixture(scope="session")
def book() -> bytes:
    """Return the workbook of the first import of the house."""
    return first_book()


@pytest.fixture(scope="session")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the results of the cupboards, which block the way out of their room together."""
    return write_results(tmp_path_factory.mktemp("simulated"), settings=SIMULATED, places=PLACES, routes=ROUTES)


@pytest.fixture(scope="session")
def flat(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a small model with the same pieces."""
    return write_flat(tmp_path_factory.mktemp("flat") / "duplex.ifc")
