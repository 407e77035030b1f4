"""The simulation of a session while one types: what is lacking is rocked in a thread of its own, in batches.

What pieces did is kept (`assess.methods.verdicts`), so that an edit costs the pieces that it changes. A batch is worked
on to its end as long as any of it is still asked for: else a newer version of the workbook cancels it.
"""

import logging
import threading
import time
from collections.abc import Callable, Hashable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.errors import AssessError, CancelledError
from assess.i18n import Text, fill
from assess.methods.cases import Cases
from assess.methods.simulate import run_side_by_side
from assess.methods.verdicts import Verdicts
from assess.pipeline.adopt import Assessment
from assess.progress import Progress
from assess.settings import Settings, count_processors

if TYPE_CHECKING:
    from assess.routes.evaluate import KeptRoutes

MOST_CASES = 300
"""Cases of a batch: less than a second once the motions of their floors are there."""
ASKED_EVERY = 0.5
"""Time after which a place among those that simulate is asked for again [s]."""
SECONDS = 600.0
"""Processor time that the simulation of one version may take by default [s]."""
LOG = logging.getLogger("assess.web")
Hold = Callable[[], AbstractContextManager[object] | None]
"""Takes a place among the sessions that simulate, to be left at its end; None where all are taken."""


@dataclass(frozen=True, slots=True)
class Simulation:
    """How far the simulation of an assessment is: items that are simulated, of those that are to be.

    `state` is "done", "running", "waiting" (for other sessions) or "failed", then `message` tells why.
    """

    state: str = "done"
    done: int = 0
    of: int = 0
    message: Text | str = ""


@dataclass(slots=True, eq=False)
class _Wanted:
    """What is to be simulated for a purpose: an assessment that may lack cases, and the processor time it has taken."""

    find: Callable[[], Assessment | None]
    settings: Settings
    of: Hashable
    needs: frozenset[Hashable] = frozenset()
    spent: float = 0.0
    fault: Text | str = ""


class Simulator:
    """Rocks what is lacking of the latest assessments, one for each purpose, in the order of the purposes' names."""

    def __init__(self) -> None:
        self.verdicts, self._threads = Verdicts(), count_processors()
        self.limit(nullcontext, SECONDS)
        self._wanted: dict[str, _Wanted] = {}
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None
        self._is_waiting = self._is_closed = False
        self._batch: tuple[frozenset[Hashable], threading.Event] | None = None
        self.routes: dict[Hashable, KeptRoutes] = {}
        """The rows of routes that were evaluated last, for a purpose."""
        self.routes_lock = threading.Lock()
        self.arrived = 0
        """How many batches have arrived: what was assessed before lacks them."""

    def limit(self, hold: Hold, seconds: float) -> None:
        """Have it take a place for each batch, and processor time [s] for each version."""
        self._hold, self._seconds = hold, seconds

    def want(
        self, purpose: str, of: Hashable, assessment: Assessment | None, find: Callable[[], Assessment | None]
    ) -> None:
        """Have what an assessment lacks be simulated, in place of what was wanted before for the purpose.

        `of` is what it is an assessment of; `find` returns it with all that has arrived, and is called in the thread.
        A batch that is worked on is cancelled where none of its motions is asked for any more.
        """
        needs = _find_motions(assessment)
        with self._changed:
            if self._is_closed:
                return
            if not needs or assessment is None:
                self._wanted.pop(purpose, None)
            else:
                before = self._wanted.get(purpose)
                if before is None or before.of != of:
                    before = self._wanted[purpose] = _Wanted(find, assessment.settings, of)
                before.needs = needs
            if self._batch and not any(self._batch[0] & one.needs for one in self._wanted.values()):
                self._batch[1].set()
            if not needs:
                return
            self._changed.notify_all()
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="assess-simulation", daemon=True)
                self._thread.start()

    def describe(self, purpose: str, assessment: Assessment | None) -> Simulation:
        """Return how far an assessment is that was wanted for a purpose."""
        if assessment is None or assessment.lacking is None:
            return Simulation()
        cases, waits = assessment.cases, int(assessment.waits.sum())
        done = np.unique(assessment.case_item[cases.ensemble >= 0]).size
        with self._changed:
            wanted = self._wanted.get(purpose)
            fault = wanted.fault if wanted else ""
            state = "failed" if fault else "waiting" if self._is_waiting else "running"
        return Simulation(state if waits else "done", done, done + waits, fault if waits else "")

    def wait(self, arrived: int, timeout: float) -> None:
        """Wait until more has arrived than so many batches, or for the time [s]."""
        with self._changed:
            self._changed.wait_for(lambda: self.arrived != arrived or self._thread is None, timeout)

    def close(self) -> None:
        """End at once."""
        with self._changed:
            self._is_closed = True
            self._wanted.clear()
            if self._batch:
                self._batch[1].set()
            thread = self._thread
            self._changed.notify_all()
        if thread is not None:
            thread.join()

    # ------------------------------------------------------------ in the thread

    def _run(self) -> None:
        while (work := self._find_work()) is not None:
            wanted, cases, own = work
            place = self._hold()
            with self._changed:
                if self._is_waiting != (place is None):
                    self._is_waiting = place is None
                if place is None:
                    self._changed.wait(ASKED_EVERY)
                    continue
            with place:
                self._rock(wanted, cases, own)

    def _find_work(self) -> tuple[_Wanted, Cases, NDArray[np.intp]] | None:
        """Return the next batch: of the pieces under the motions of one floor; None, and end, where nothing lacks."""
        while True:
            with self._changed:
                every = [one for _, one in sorted(self._wanted.items()) if not one.fault]
            for wanted in every:
                assessment = None
                try:
                    assessment = wanted.find()
                except AssessError as error:
                    wanted.fault = error.message
                lacking = None if assessment is None else assessment.lacking
                if assessment is not None and lacking is not None and (lacking.ensemble >= 0).any():
                    return wanted, lacking, _choose(assessment, lacking)
            with self._changed:
                if every == [one for _, one in sorted(self._wanted.items()) if not one.fault]:
                    self._thread = None
                    self._changed.notify_all()
                    return None

    def _rock(self, wanted: _Wanted, cases: Cases, own: NDArray[np.intp]) -> None:
        cancel, started = threading.Event(), time.process_time()
        numbers = np.unique(cases.ensemble[own]).tolist()
        progress = Progress(cancel=cancel)
        with self._changed:
            if self._is_closed:
                return
            self._batch = frozenset(cases.ensembles[number].key for number in numbers), cancel
        each = max(1, self._threads // len(numbers))

        def rock(number: int) -> None:
            here = own[cases.ensemble[own] == number]
            self.verdicts.rock(cases, here, wanted.settings, threads=each, progress=progress)

        try:
            list(run_side_by_side(rock, [(one,) for one in numbers], min(self._threads, len(numbers))))
        except CancelledError:
            pass
        except AssessError as error:
            wanted.fault = error.message
        except Exception:
            LOG.exception("a simulation failed")
            wanted.fault = fill("The simulation failed. The window of assess shows more.")
        wanted.spent += time.process_time() - started
        if wanted.spent > self._seconds:
            wanted.fault = fill(
                "The simulation takes more than {n:.0f} s of processor time: the classes left go by the formula. "
                "Make a report to simulate all of them.",
                n=self._seconds,
            )  # fmt: skip
        with self._changed:
            self._batch = None
            self.arrived += 1
            self._changed.notify_all()


def _find_motions(assessment: Assessment | None) -> frozenset[Hashable]:
    """Return by what the motions are told from others under which cases are still to be rocked."""
    cases = None if assessment is None else assessment.lacking
    if cases is None:
        return frozenset()
    return frozenset(cases.ensembles[at].key for at in np.unique(cases.ensemble[cases.ensemble >= 0]).tolist())


def _choose(assessment: Assessment, lacking: Cases) -> NDArray[np.intp]:
    """Return the lacking cases of some pieces of one floor, under all of their motions."""
    is_open = lacking.ensemble >= 0
    floors = [one.floor for one in assessment.inventory.items]
    of_case = [floors[item] for item in assessment.case_item.tolist()]
    first = of_case[int(is_open.argmax())]
    here = np.flatnonzero(is_open & np.array([one == first for one in of_case], dtype=np.bool_))
    items = assessment.case_item[here]
    return np.asarray(here[items <= items[min(MOST_CASES, here.size) - 1]])
