"""Which furniture overturns in an earthquake, and what to fix first.

>>> import assess
>>> results = assess.run("inventories/market-street.xlsx", verify="none")
>>> results["42-01"].adopted.risk.word
'medium'
>>> files = assess.write_reports(results, "out", formats=("json", "csv"))

Names are loaded when first used, so that ``import assess`` costs next to nothing.
"""

import importlib

from assess.version import __version__

TYPE_CHECKING = False  # as type checkers know it: importing `typing` takes milliseconds

if TYPE_CHECKING:
    from assess.errors import (  # noqa: I001 - on one line each they are seven imports
        AssessError as AssessError, CancelledError as CancelledError, InputError as InputError,
        OutputError as OutputError, Problem as Problem, RecordError as RecordError, WorkbookError as WorkbookError,
    )  # fmt: skip
    from assess.methods.fitted import read_model as read_model
    from assess.model import Inventory as Inventory
    from assess.pipeline.run import run as run
    from assess.progress import Progress as Progress
    from assess.report import write_reports as write_reports
    from assess.report.report_options import ReportOptions as ReportOptions
    from assess.results import Results as Results
    from assess.settings import Settings as Settings
    from assess.workbook.read import read_inventory as read_inventory

_NAMES = {
    "assess.errors": (
        "AssessError", "CancelledError", "InputError", "OutputError", "Problem", "RecordError", "WorkbookError",
    ),
    "assess.methods.fitted": ("read_model",),
    "assess.model": ("Inventory",),
    "assess.pipeline.run": ("run",),
    "assess.progress": ("Progress",),
    "assess.report": ("write_reports",),
    "assess.report.report_options": ("ReportOptions",),
    "assess.results": ("Results",),
    "assess.settings": ("Settings",),
    "assess.workbook.read": ("read_inventory",),
}  # fmt: skip
_HOME = {name: module for module, names in _NAMES.items() for name in names}

__all__ = [*_HOME, "__version__"]  # noqa: PLE0604


def __getattr__(name: str) -> object:
    if name in _HOME:
        return getattr(importlib.import_module(_HOME[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
