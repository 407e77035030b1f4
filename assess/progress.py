"""Tells on standard error how far the verification is, or another rocking: pieces, floors and the time left."""

import sys
import threading
import time
from typing import TextIO

import numpy as np

from assess.verification import Work

SLOWEST = 0.2
"""A line is written again after this many seconds at the earliest."""
TOLD_FROM = 0.02
"""Share of the work [-] that has to be done before the time left is told."""


class Progress:
    """Writes one line that keeps changing on a terminal; elsewhere one line, once, that says what is begun."""

    def __init__(self, work: Work, stream: TextIO | None = None, doing: str = "Verifying") -> None:
        self._work = work
        self._doing = doing
        self._stream = stream or sys.stderr
        self._shares = np.zeros(len(work.items))
        self._start = self._written = time.monotonic()
        self._lock = threading.Lock()  # ensembles are worked on side by side
        self._is_terminal = self._stream.isatty()
        if not self._is_terminal:
            self._stream.write(f"{doing} {self._describe(work.pieces, len(set(work.floors)))}.\n")

    def __call__(self, what: str, number: int, share: float) -> None:
        """Note that a share of ensemble `number` is done."""
        with self._lock:
            self._shares[number] = share
            done, now = float(self._shares.mean()), time.monotonic()
            if self._is_terminal and (now - self._written > SLOWEST or done == 1.0):
                self._written = now
                self._stream.write("\r\x1b[K" + ("" if done == 1.0 else self._line(done, now)))
                self._stream.flush()

    def _line(self, done: float, now: float) -> str:
        left = "" if done < TOLD_FROM else f", about {_round((now - self._start) * (1 - done) / done)} left"
        finished = self._shares == 1.0
        going = {floor for floor, one in zip(self._work.floors, finished, strict=True) if not one}
        floors = set(self._work.floors) - going
        waiting = [items for items, one in zip(self._work.items, finished, strict=True) if not one]
        pieces = self._work.pieces - len(np.unique(np.concatenate(waiting))) if waiting else self._work.pieces
        total = self._describe(self._work.pieces, len(set(self._work.floors)))
        return f"{self._doing}: {self._describe(pieces, len(floors))} done of {total}{left}"

    @staticmethod
    def _describe(pieces: int, floors: int) -> str:
        return f"{pieces:,} piece{'s' if pieces != 1 else ''} on {floors:,} floor{'s' if floors != 1 else ''}"


def _round(seconds: float) -> str:
    """Return a time for people: no more digits than can be known."""
    if seconds < 90:
        return f"{max(1, round(seconds))} s"
    return f"{round(seconds / 60)} min"
