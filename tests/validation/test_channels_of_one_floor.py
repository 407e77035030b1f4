"""The paper's claim (section 3.2.2) that direct integration makes the channels of one floor agree.

It is re-checked on docs/verification.md; one floor is computed again, so that the page is what the code gives.
"""

import importlib.util
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"


def load_script():
    spec = importlib.util.spec_from_file_location("docs_verification", DOCS / "verification.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
def test_the_rows_of_the_34th_floor():
    script = load_script()
    pairs = script.compare({"34th floor": "de"})
    page = (DOCS / "verification.md").read_text(encoding="utf-8").splitlines()
    assert len(pairs) == len(script.SCALES)
    for pair in pairs:
        assert script.describe_pair(pair) in page
        assert pair.apart("direct integration").mean() < pair.apart("Kaneko-Hayashi").mean()
