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
    from assess.errors import AssessError, CancelledError, InputError, OutputError, Problem, RecordError, WorkbookError
    from assess.methods.fitted import read_model
    from assess.model import Inventory
    from assess.pipeline.run import run
    from assess.progress import Progress
    from assess.report import write_reports
    from assess.report.report_options import ReportOptions
    from assess.results import Results
    from assess.settings import Settings
    from assess.workbook.read import read_inventory

_HOME = {
    "AssessError": "assess.errors",
    "CancelledError": "assess.errors",
    "InputError": "assess.errors",
    "Inventory": "assess.model",
    "OutputError": "assess.errors",
    "Problem": "assess.errors",
    "Progress": "assess.progress",
    "RecordError": "assess.errors",
    "ReportOptions": "assess.report.report_options",
    "Results": "assess.results",
    "Settings": "assess.settings",
    "WorkbookError": "assess.errors",
    "read_inventory": "assess.workbook.read",
    "read_model": "assess.methods.fitted",
    "run": "assess.pipeline.run",
    "write_reports": "assess.report",
}

__all__ = [
    "AssessError",
    "CancelledError",
    "InputError",
    "Inventory",
    "OutputError",
    "Problem",
    "Progress",
    "RecordError",
    "ReportOptions",
    "Results",
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
