"""The worked example as a run gives it by default, verified, and its reports: made once for all workers."""

from pathlib import Path

import pytest

import assess
from assess.report import html_blocks
from docs import samples
from tests.report.reading import leave_room


@pytest.fixture(scope="module", autouse=True)
def _equations_without_letters(request):
    """Leave room for equations, but in a module that sets `DRAWS_EQUATIONS`: drawn they take half the time of a PDF."""
    with pytest.MonkeyPatch.context() as patch:
        if not getattr(request.module, "DRAWS_EQUATIONS", False):
            patch.setattr(html_blocks, "draw_math", leave_room)
        yield


@pytest.fixture(scope="session")
def verified_example(make_once, example_inventory):
    """Return the worked example, run on the day of the samples."""

    def run(folder: Path) -> assess.Results:
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("SOURCE_DATE_EPOCH", samples.DAY)
            return assess.run(example_inventory, series_folder=folder)

    return make_once("verified-example", run)


@pytest.fixture(scope="session")
def samples_now(make_once, verified_example):
    """Return the files of samples/reports as they are written now, by format. No test changes them."""

    def write(folder: Path) -> dict[str, Path]:
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("SOURCE_DATE_EPOCH", samples.DAY)  # set by what writes them, and put back here
            patch.setattr(assess, "run", lambda _inventory: verified_example)
            return samples.write_samples(folder)

    return make_once("samples-now", write)


@pytest.fixture(scope="session")
def small():
    from tests.report.made_fragilities import assess_small

    return assess_small()
