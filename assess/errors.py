"""What can go wrong, as a tree.

::

AssessError
├── InputError          what the user gave cannot be used: nothing is written, exit status 2
│   ├── SettingsError   ... in a setting; also a ValueError
│   ├── WorkbookError   ... in the workbook: every problem with its sheet and cell
│   ├── RecordError     ... in a file of recorded motion
│   └── ModelError      ... in a building model, or another file that an inventory is imported from
├── OutputError         a result could not be written, exit status 1
│   └── PdfUnavailableError  the native libraries of the PDF are missing
└── CancelledError      the caller stopped the work; nothing was written
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self

from assess.text import fill

Severity = Literal["error", "warning", "note"]

_ADDRESS = re.compile(r"[A-Z]{1,3}\d+(:[A-Z]{1,3}\d+)?")


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing to tell the user about the input: where it is, what is the matter, and how to fix it.

    Problems of one `group` in a column of a sheet are of one habit and are shown as one; "" for a problem by itself.
    """

    severity: Severity
    sheet: str
    cell: str
    message: str
    fix: str = ""
    group: str = ""

    @property
    def place(self) -> str:
        """Sheet and cell, ``Items!H14``, or ``Items row 3 Height``; less where no single cell is to blame."""
        mark = "!" if _ADDRESS.fullmatch(self.cell) else " "
        return f"{self.sheet}{mark}{self.cell}" if self.cell else self.sheet

    def __str__(self) -> str:
        text = f"{self.message} {self.fix}".strip()
        return f"{self.place}: {text}" if self.place else text


class Gap(Problem):
    """A problem that is no mistake: the workbook does not say yet how a floor shakes."""

    __slots__ = ()
    lacks: ClassVar[Literal["shaking", "furniture"]] = "shaking"


class FurnitureGap(Gap):
    """A problem that is no mistake: the workbook lists no furniture yet."""

    __slots__ = ()
    lacks = "furniture"


@dataclass(frozen=True, slots=True)
class Correction:
    """A cell that was understood although it is not typed as its column asks.

    `was` is what it shows, `value` what belongs there: a number in the unit of its header, a text or a choice in the
    language of the workbook, None for blank. `why` says what was done, such as "the unit cm is in the header".
    """

    sheet: str
    cell: str
    was: str
    value: float | str | None
    why: str


class AssessError(Exception):
    """Whatever `assess` raises on purpose."""

    @property
    def message(self) -> str:
        """The English text that `str` returns; as the `assess.i18n.Text` that it is, it can be translated."""
        return self.args[0] if self.args else ""

    @classmethod
    def about(cls, template: str, /, **values: Any) -> Self:
        """Return the error whose message is `template` with `values` put in, a text that can be translated."""
        return cls(fill(template, **values))


class InputError(AssessError):
    """What the user gave cannot be used."""


class SettingsError(InputError, ValueError):
    """A setting cannot be used; the message begins with the setting's name."""


class ModelError(InputError):
    """A building model, or another file that an inventory is imported from, cannot be used."""


class WorkbookError(InputError):
    """The workbook, in the language of this code, cannot be used; `problems` holds all that was found, errors first."""

    def __init__(self, problems: Sequence[Problem], language: str = "en") -> None:
        self.language = language
        self.problems = tuple(sorted(problems, key=lambda problem: problem.severity != "error"))
        super().__init__("\n".join(str(problem) for problem in self.problems))

    def __reduce__(self) -> tuple[type[Self], tuple[Sequence[Problem], str]]:
        return type(self), (self.problems, self.language)

    @property
    def is_incomplete(self) -> bool:
        """Whether nothing that is filled in is wrong, and something is still to be filled in."""
        return all(isinstance(one, Gap) for one in self.problems if one.severity == "error")


class RecordError(InputError):
    """A file of recorded motion cannot be used."""


class OutputError(AssessError):
    """A result could not be written; what was there before is left as it was."""


class PdfUnavailableError(OutputError):
    """The PDF needs native libraries that are not installed here."""


class CancelledError(AssessError):
    """The caller stopped the work; nothing was written."""

    def __init__(self) -> None:
        super().__init__("the work was cancelled; nothing was written.")
