"""Benchmark of the page's live answers: after an edit, against reading the workbook's bytes and simulating them anew.

An answer is the edit, what is read of the changed cells, the simulated classes of all rows, the problems, and the rows
that changed as JSON. Of 20,000 rows it is the answer at once, in which the edited row goes by the formula.
"""

import gc
import json
import statistics
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from assess.motion import beam, noise, shared_motions
from assess.pipeline.ensembles import TARGETS
from assess.pipeline.run import compute
from assess.settings import Settings
from assess.web.book import Book
from assess.web.evaluation import evaluate, wait_for_simulation
from assess.web.live import LiveView
from assess.web.route_states import describe_routes
from assess.web.what_if_answer import try_out
from assess.web.worker import COLLECTED
from assess.workbook.read import read_inventory
from assess.workbook.template import Content, write_workbook
from tests.benchmarks.measuring import list_items, timed
from tests.workbooks import FLOORS, UNVERIFIED

MARKET = Path(__file__).parents[2] / "inventories" / "market-street.xlsx"
ROUNDS = 9
LONG = 3600.0
"""Time that a simulation is waited for [s]."""
PASTED = 1_000
AIMS = {
    "edited, 1,000 rows": 150, "edited, worked example": 150, "edited, 20,000 rows": 300, "what if": 700,
    "pasted": 4_000, "opened": 5_000,
}  # fmt: skip
"""Longest time [ms]: of one edited row, simulated, at 1,000 rows and in the worked example; of the answer at 20,000
rows; of a step of the what-if slider in the worked example; until 1,000 pasted rows, and all of the worked example
after it is opened, are simulated."""


def rows(folder: Path) -> Iterator[str]:
    """Yield two tables in Markdown; workbooks are written into `folder`."""
    before = gc.get_threshold()
    gc.set_threshold(*COLLECTED)  # as in the process of a session
    try:
        yield from _rows(folder)
    finally:
        gc.set_threshold(*before)


def _rows(folder: Path) -> Iterator[str]:
    yield (
        "| after one edit | answer [ms] | of these reading [ms] | read and simulated anew [ms] | ratio (median) | aim |"
        "\n|---|---|---|---|---|---|"
    )
    paths = {count: folder / f"live-{count}.xlsx" for count in (1_000, 20_000)}
    for count, path in paths.items():
        write_workbook(path, Content({"Floors": FLOORS, "Items": list_items(count)}))
    yield _compare("edited, 1,000 rows", paths[1_000], Settings())
    yield _compare("edited, worked example", MARKET, Settings())
    yield _compare("edited, 20,000 rows", paths[20_000], UNVERIFIED)
    yield "\n| | wall [ms] | processor [ms] | aim |\n|---|---|---|---|"
    book = _hold(MARKET)
    for kept in (shared_motions.KEPT, noise.KEPT, beam.KEPT, TARGETS):  # as in a new process
        kept.forget()
    yield _line("opened", lambda: _simulate(book))
    scale = iter(range(1, 1000))
    steps = [_measure(lambda: _try(book, 1 + next(scale) / 1000)) for _ in range(ROUNDS)][1:]
    yield _show("what if", *(statistics.median(one) for one in zip(*steps, strict=True)))
    edits = [_measure(lambda: _route_states(book, next(scale))) for _ in range(ROUNDS)][1:]
    yield _show("states of routes after an edit", *(statistics.median(one) for one in zip(*edits, strict=True)))
    book.simulator.close()
    large = _hold(paths[1_000])
    _simulate(large)
    yield _line("pasted", lambda: _paste(large))
    large.simulator.close()


def _hold(path: Path) -> Book:
    return Book.hold(path.name, path.read_bytes(), path.parent)


def _simulate(book: Book) -> None:
    wait_for_simulation(book.snapshot(), seconds=LONG)


def _measure(work: Callable[[], object]) -> tuple[float, float]:
    """Return time and processor time [ms]."""
    start = time.process_time()
    wall = timed(work)
    return 1e3 * wall, 1e3 * (time.process_time() - start)


def _line(name: str, work: Callable[[], object]) -> str:
    return _show(name, *_measure(work))


def _show(name: str, wall: float, processor: float) -> str:
    aim = f"at most {AIMS[name]:,} ms" if name in AIMS else ""
    return f"| {name} | {wall:.0f} | {processor:.0f} | {aim} |"


def _compare(name: str, path: Path, settings: Settings) -> str:
    """`settings` are those of the rival; where it does not simulate, neither does the page yet."""
    book, view, data = _hold(path), LiveView(), path.read_bytes()
    if settings == UNVERIFIED:
        book.simulator.close()
    _answer(book, view, 90)
    _simulate(book) if settings != UNVERIFIED else None
    found = []
    for at in range(ROUNDS + 1):
        reading, answer = _answer(book, view, 100 + at)
        if settings != UNVERIFIED:  # where the answer does not have it yet, until the next one may
            answer += 1e3 * timed(lambda: _simulate(book))
            assert evaluate(book.snapshot(), routes=False).is_simulated
        found.append((answer, reading))
    anew = statistics.median([1e3 * timed(lambda: _anew(data, path.parent, settings)) for _ in range(3)])
    own, reading = (statistics.median(times) for times in zip(*found[1:], strict=True))
    book.simulator.close()
    return f"| {name} | {own:.0f} | {reading:.0f} | {anew:.0f} | {own / anew:.3f} | at most {AIMS[name]:,} ms |"


def _edit(book: Book, height: int) -> None:
    place = book.sheets["Items"].place("height", 5)
    assert place is not None
    book.edit(book.version, [["Items", *place, height]], "benchmark")


def _answer(book: Book, view: LiveView, height: int) -> tuple[float, float]:
    """Return the time of reading what was changed, and of a whole answer after an edit [ms]."""
    start, stamp = time.perf_counter(), book.snapshot().stamp
    _edit(book, height)
    _ = book.snapshot().inventory
    read = time.perf_counter()
    json.dumps(view.answer(book, stamp))
    return 1e3 * (read - start), 1e3 * (time.perf_counter() - start)


def _anew(data: bytes, folder: Path, settings: Settings) -> None:
    compute(read_inventory(data, records=folder, strict=False), settings)


def _try(book: Book, scale: float) -> None:
    while try_out(book.snapshot(), {"scale": scale})["simulation"]["state"] != "done":
        pass


def _route_states(book: Book, height: int) -> None:
    _edit(book, height)
    describe_routes(book.snapshot())


def _paste(book: Book) -> None:
    """Change the height of every piece, and wait until all are simulated again."""
    at = book.sheets["Items"].place("height", 2)
    assert at is not None
    edits = [["Items", row, at[1], 120 + row % 97] for row in range(2, 2 + PASTED)]
    book.edit(book.version, edits, "paste")
    _simulate(book)
