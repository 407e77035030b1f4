"""Benchmark of cancelling: the longest time between two looks at whether to stop, in each stage of large jobs."""

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import assess
from assess.motion.formats import LARGEST_FILE
from assess.progress import Progress
from assess.report_formats import DEFAULT
from tests.benchmarks.measuring import ROOT, list_items, write_thousand
from tests.benchmarks.routes import FLOORS, write_tower
from tests.workbooks import UNVERIFIED, write

AIM, ITEMS, RUNS = 0.5, 20_000, 20


class _Looks(threading.Event):
    """An event that nobody sets; it keeps the longest time between two looks of the thread that waits for the work."""

    def __init__(self) -> None:
        super().__init__()
        self.most = [0.0, 0.0]
        self._thread, self._last = threading.get_ident(), self._now()

    @staticmethod
    def _now() -> tuple[float, float]:
        return time.process_time(), time.perf_counter()

    def look(self) -> None:
        """Note a look."""
        now = self._now()
        gaps = (after - before for before, after in zip(self._last, now, strict=True))
        self.most = [max(pair) for pair in zip(self.most, gaps, strict=True)]
        self._last = now

    def is_set(self) -> bool:
        """Return False."""
        if threading.get_ident() == self._thread:
            self.look()
        return False


def rows(folder: Path) -> Iterator[str]:
    """Yield a table in Markdown; workbooks, records and reports are written into `folder`.

    What is compiled is compiled anew where NUMBA_CACHE_DIR names an empty folder.
    """
    market, tower = ROOT / "inventories" / "market-street.xlsx", write_tower(folder / "tower.xlsx")
    many, thousands = write(folder / "many.xlsx", list_items(ITEMS)), write_thousand(folder / "5000.xlsx", 5000)
    long = write(folder / "long.xlsx", list_items(1), [{"floor": "1", "record_x": _write_record(folder / "long.csv")}])
    yield "| stage | job | longest time between two looks, processor [s] | wall [s] | aim |"
    yield "|---|---|---|---|---|"
    for book, name in ((many, f"{ITEMS:,} items"), (long, f"a record of {LARGEST_FILE / 1e6:.0f} MB")):
        yield _row("reading", name, lambda progress, book=book: assess.read_inventory(book, progress=progress))
    for book, name, options in (
        (market, f"121 items, {RUNS} motions", {"verify": "high", "runs": RUNS}),
        (many, f"{ITEMS:,} items, not verified", {"verify": "none"}),
        (tower, f"{5 * FLOORS} segments of routes, not verified", {"verify": "none"}),
    ):
        found = assess.read_inventory(book)
        yield _row("run", name, lambda progress, found=found, options=options: assess.run(
            found, progress=progress, **options))  # fmt: skip
    for book, name in ((market, "121 items, all formats"), (thousands, "5,000 items, all formats")):
        results = assess.run(book, UNVERIFIED)
        yield _row("rendering", name, lambda progress, results=results: assess.write_reports(
            results, folder / "out", (*DEFAULT, "annex", "npz"), progress=progress))  # fmt: skip


def _row(stage: str, name: str, work: Callable[..., Any]) -> str:
    looks = _Looks()
    work(Progress(cancel=looks))
    looks.look()
    processor, wall = looks.most
    return f"| {stage} | {name} | {processor:.2f} | {wall:.2f} | at most {AIM} s |"


def _write_record(path: Path) -> str:
    """Write a record of as many bytes as are read; return its name."""
    block = "".join(f"{{:7d}}.{at:02d},{3 * at % 41 - 20:+.7e},{7 * at % 43 - 21:+.7e}\n" for at in range(0, 100, 5))
    count = LARGEST_FILE // len(block.format(*range(20))) - 1
    with path.open("w", encoding="utf-8") as file:
        file.write("time [s],north [cm/s2],east [cm/s2]\n")
        file.writelines(block.format(*[at] * 20) for at in range(count))
    return f"{path.name}#north"
