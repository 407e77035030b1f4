"""Benchmark of the page's live answers: after an edit, against reading the workbook's bytes and assessing them anew.

An answer is the edit, what is read of the changed cells, the
classes of all rows, the problems, and the rows that changed as JSON.
"""

import json
import statistics
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from assess.pipeline.run import compute
from assess.web.book import Book
from assess.web.live import LiveView
from assess.web.route_states import describe_routes
from assess.web.what_if_answer import try_out
from assess.workbook.read import read_inventory
from assess.workbook.template import Content, write_workbook
from tests.benchmarks.measuring import list_items, timed
from tests.workbooks import FLOORS, UNVERIFIED

MARKET = Path(__file__).parents[2] / "inventories" / "market-street.xlsx"
ROUNDS = 9
AIMS = {1_000: 100, 20_000: 1_500}
"""Longest median time of an answer [ms], by the rows of furniture."""
AIM_WHAT_IF = 1_000
"""Longest median time of a change of the scale, routes included [ms]."""


def rows(folder: Path) -> Iterator[str]:
    """Yield two tables in Markdown; workbooks are written into `folder`."""
    yield (
        "| after one edit | answer [ms] | of these reading [ms] | rival | read and assessed anew [ms] | ratio (median) "
        "| aim |\n|---|---|---|---|---|---|---|"
    )
    for count, aim in AIMS.items():
        path = folder / f"live-{count}.xlsx"
        write_workbook(path, Content({"Floors": FLOORS, "Items": list_items(count)}))
        yield _compare(f"{count:,} pieces", path, f"at most {aim:,} ms")
    yield _compare("121 pieces, 3 recorded floors", MARKET, "")
    yield "\n| 121 pieces, 80 segments | median [ms] | aim |\n|---|---|---|"
    book = _hold(MARKET)
    scale = iter(range(1, 1000))
    snapshot = book.snapshot()
    try_out(snapshot, {})
    median = _median(lambda: try_out(snapshot, {"scale": 1 + next(scale) / 1000}))
    yield f"| what if: another scale | {median:.0f} | at most {AIM_WHAT_IF:,} ms |"
    yield f"| states of routes after an edit | {_median(lambda: _route_states(book, next(scale))):.0f} | |"


def _hold(path: Path) -> Book:
    return Book.hold(path.name, path.read_bytes(), path.parent)


def _compare(name: str, path: Path, aim: str) -> str:
    book, view, data = _hold(path), LiveView(), path.read_bytes()
    _answer(book, view, 90)
    found = []
    for at in range(ROUNDS + 1):
        reading, answer = _answer(book, view, 100 + at)
        found.append((answer, reading, 1e3 * timed(lambda: _anew(data, path.parent))))
    own, reading, anew = (statistics.median(times) for times in zip(*found[1:], strict=True))
    ratio = statistics.median(one / other for one, _, other in found[1:])
    rival = "the bytes"
    return f"| {name} | {own:.0f} | {reading:.0f} | {rival} | {anew:.0f} | {ratio:.3f} | {aim} |"


def _edit(book: Book, height: int) -> None:
    place = book.sheets["Items"].place("height", 5)
    assert place is not None
    book.edit(book.version, [["Items", *place, height]], "benchmark")


def _answer(book: Book, view: LiveView, height: int) -> tuple[float, float]:
    """Return the time of reading what was changed, and of a whole answer after an edit [ms]."""
    start, version = time.perf_counter(), book.version
    _edit(book, height)
    _ = book.snapshot().inventory
    read = time.perf_counter()
    json.dumps(view.answer(book, version))
    return 1e3 * (read - start), 1e3 * (time.perf_counter() - start)


def _anew(data: bytes, folder: Path) -> None:
    compute(read_inventory(data, records=folder, strict=False), UNVERIFIED)


def _route_states(book: Book, height: int) -> None:
    _edit(book, height)
    describe_routes(book.snapshot())


def _median(work: Callable[[], object]) -> float:
    return statistics.median([1e3 * timed(work) for _ in range(ROUNDS)][1:])
