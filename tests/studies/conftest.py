"""Studies stand alone, and nothing else rests on them: their slow tests run in `make test-long`."""

from pathlib import Path

import pytest


def pytest_collection_modifyitems(items):
    """Mark the slow tests of this folder as long."""
    for item in items:
        if item.path.is_relative_to(Path(__file__).parent) and item.get_closest_marker("slow"):
            item.add_marker(pytest.mark.long)
