"""What can go wrong, as a tree.

::

AssessError
├── InputError          what the user gave cannot be used: nothing is written, exit status 2
│   ├── WorkbookError   ... in the workbook: every problem with its sheet and cell
│   └── RecordError     ... in a file of recorded motion
└── OutputError         a result could not be written, exit status 1
    └── PdfUnavailableError  the native libraries of the PDF are missing
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

Severity = Literal["error", "warning", "note"]


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing to tell the user about the input: where it is, what is the matter, and the mend."""

    severity: Severity
    sheet: str
    cell: str
    message: str
    mend: str = ""

    @property
    def place(self) -> str:
        """Sheet and cell, ``Items!H14``; the sheet alone, or nothing, where no single cell is to blame."""
        return f"{self.sheet}!{self.cell}" if self.cell else self.sheet

    def __str__(self) -> str:
        text = f"{self.message} {self.mend}".strip()
        return f"{self.place}: {text}" if self.place else text


class AssessError(Exception):
    """Whatever `assess` raises on purpose."""


class InputError(AssessError):
    """What the user gave cannot be used."""


class WorkbookError(InputError):
    """The workbook cannot be used; `problems` holds all that was found, errors first."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(sorted(problems, key=lambda problem: problem.severity != "error"))
        super().__init__("\n".join(str(problem) for problem in self.problems))


class RecordError(InputError):
    """A file of recorded motion cannot be used."""


class OutputError(AssessError):
    """A result could not be written; what was there before is left as it was."""


class PdfUnavailableError(OutputError):
    """The PDF needs native libraries that are not installed here."""
