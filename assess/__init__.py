"""Which furniture falls in an earthquake, and what to fix first.

>>> import assess
>>> inventory = assess.read_inventory("inventories/market-street.xlsx")
>>> assessment = assess.run(inventory, assess.Settings())
>>> assess.write_reports(assessment, "out", formats=("pdf", "xlsx"))

Names are loaded when first used, so that ``import assess`` costs next to nothing.
"""

import importlib
from typing import TYPE_CHECKING

from assess.version import __version__

if TYPE_CHECKING:
    from assess.assessment import run
    from assess.errors import AssessError, InputError, OutputError, Problem, RecordError, WorkbookError
    from assess.inventory.model import Inventory
    from assess.inventory.workbook import read_inventory
    from assess.methods._fitted import read_model
    from assess.report import write_reports
    from assess.results import Assessment
    from assess.settings import Settings

_HOME = {
    "Assessment": "assess.results",
    "run": "assess.assessment",
    "AssessError": "assess.errors",
    "InputError": "assess.errors",
    "OutputError": "assess.errors",
    "Problem": "assess.errors",
    "RecordError": "assess.errors",
    "WorkbookError": "assess.errors",
    "Inventory": "assess.inventory.model",
    "read_inventory": "assess.inventory.workbook",
    "read_model": "assess.methods._fitted",
    "write_reports": "assess.report",
    "Settings": "assess.settings",
}

__all__ = [
    "AssessError",
    "Assessment",
    "InputError",
    "Inventory",
    "OutputError",
    "Problem",
    "RecordError",
    "Settings",
    "WorkbookError",
    "__version__",
    "read_inventory",
    "read_model",
    "run",
    "write_reports",
]


def __getattr__(name: str) -> object:
    if name in _HOME:
        return getattr(importlib.import_module(_HOME[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
