"""What was edited, step by step, so that it can be undone and done again."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

MOST_STEPS, MOST_CELLS = 200, 1_000_000
"""Steps, and cells of all of them together, that are kept; the oldest are forgotten first."""

CellPlace = tuple[str, int, int]
"""English name of the sheet, row from 1, column from 0."""
Contents = Mapping[CellPlace, Any]
"""What reading finds in cells."""


@dataclass(frozen=True, slots=True)
class Step:
    """One edit: the cells that it changed, before and after."""

    label: str
    before: Contents
    after: Contents


@dataclass(slots=True)
class History:
    """The steps up to `at` have been done, those behind it undone."""

    steps: list[Step] = field(default_factory=list)
    at: int = 0

    def add(self, step: Step) -> None:
        """Take in a step that has been done; those that were undone are forgotten."""
        self.steps[self.at :] = [step]
        cells = sum(len(one.after) for one in self.steps)
        while len(self.steps) > MOST_STEPS or (cells > MOST_CELLS and len(self.steps) > 1):
            cells -= len(self.steps.pop(0).after)
        self.at = len(self.steps)

    def back(self) -> Step | None:
        """Return the step to undo, None where there is none; it counts as undone."""
        if self.at == 0:
            return None
        self.at -= 1
        return self.steps[self.at]

    def forward(self) -> Step | None:
        """Return the step to do again, None where there is none; it counts as done."""
        if self.at == len(self.steps):
            return None
        self.at += 1
        return self.steps[self.at - 1]
