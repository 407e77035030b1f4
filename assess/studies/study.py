"""What a study is: one part of the paper, or of its comparison, repeated on data that anyone may have."""

import csv
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

from assess.settings import Settings

Row = Sequence[object]
Item = TypeVar("Item")


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """The input of a study.

    Parameters
    ----------
    out : Path
        Folder of its files; the results of long work are kept there too, in `parts`, and loaded by the next run.
    runs, seed : int
        Number of generated motions per channel, and the seed of their phases.
    jobs : int
        Threads; the results do not depend on it.
    records : Path, optional
        Folder of the user's own records, for the studies that take one.
    breadth, height : float
        The piece of furniture, for the studies of a single piece [m].
    report_share : callable
        Called with the share of the study that is done [-]; raises CancelledError if the work is to stop.
    """

    out: Path
    runs: int = 100
    seed: int = 1
    jobs: int = 1
    records: Path | None = None
    breadth: float = 0.45
    height: float = 1.60
    report_share: Callable[[float], None] = field(default=lambda _share: None, compare=False)

    @property
    def settings(self) -> Settings:
        """The settings of the methods: their defaults."""
        return Settings()

    def narrow(self, start: float, end: float) -> "Options":
        """Return the options for the part of the work between two shares of it [-]."""
        return replace(self, report_share=lambda share: self.report_share(start + (end - start) * share))

    def each(self, items: Sequence[Item]) -> "Iterator[tuple[Item, Options]]":
        """Yield items, parts of the work of equal weight, each with the options for its part; report each."""
        for at, item in enumerate(items):
            part = self.narrow(at / len(items), (at + 1) / len(items))
            part.report_share(0.0)
            yield item, part


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A table of a study: its columns, with units, and its rows; numbers are written with all their digits."""

    columns: Sequence[str]
    rows: Sequence[Row]


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """The results of a study.

    Parameters
    ----------
    page : sequence of str
        Lines of Markdown: method, data and results, every number from the run.
    summary : sequence of str
        Sentences for the head of the page of all studies: how well formulas and reference agree.
    overview : sequence of str
        Lines of Markdown for that head.
    failures : sequence of str
        Sentences on where published formulas fail.
    tables : mapping of str to Table
        By the name of their .csv.
    figures : mapping of str to bytes
        By the name of their file.
    files : mapping of str to str
        Other files, as text.
    """

    page: Sequence[str]
    summary: Sequence[str] = ()
    overview: Sequence[str] = ()
    failures: Sequence[str] = ()
    tables: Mapping[str, Table] = field(default_factory=dict)
    figures: Mapping[str, bytes] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """One study: its name, its place on the page, its heading, the part `of` the paper, and the function that runs it.

    `of` is "" for a study that repeats no part of the paper. `takes` names which of the options "records", "breadth"
    and "height" it uses.
    """

    name: str
    order: int
    title: str
    of: str
    run: Callable[[Options], Finding]
    takes: frozenset[str] = frozenset()


def read_facts(name: str) -> list[dict[str, str]]:
    """Return a table of published numbers from the folder `facts`, by column; "" where nothing is printed."""
    file = Path(__file__).with_name("facts") / f"{name}.csv"
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))
