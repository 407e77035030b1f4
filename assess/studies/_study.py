"""What a study is: one part of the paper, or of its comparison, done again on data that anyone may have."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from assess.settings import Settings

Row = Sequence[object]
Tell = Callable[[str], None]
"""Told in words what is being done."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What a study is run with.

    Parameters
    ----------
    out : Path
        Folder of its files; what takes long is kept there too, in `parts`, and taken up again by the next run.
    runs, seed : int
        Generated motions of each channel, and the seed of their phases.
    jobs : int
        Threads; they do not change a result.
    records : Path, optional
        Folder of the user's own records, for the studies that take one.
    breadth, height : float
        The piece of the studies that look at one [m].
    tell : callable
        Told what is being done.
    """

    out: Path
    runs: int = 100
    seed: int = 1
    jobs: int = 1
    records: Path | None = None
    breadth: float = 0.45
    height: float = 1.60
    tell: Tell = field(default=lambda _what: None, compare=False)

    @property
    def settings(self) -> Settings:
        """The settings of the methods: their defaults."""
        return Settings()


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A table of a study: its columns, with units, and its rows; numbers are written with all their digits."""

    columns: Sequence[str]
    rows: Sequence[Row]


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What a study found.

    Parameters
    ----------
    page : sequence of str
        Lines of Markdown: what was done, on what, and what came out, every number from the run.
    summary : sequence of str
        Sentences for the head of the page of all studies: how near.
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
    """One study.

    Parameters
    ----------
    name, title : str
        On the command line, and as a heading.
    order : int
        Its place on the page of all.
    of : str
        What of the paper it is.
    run : callable
        Does it.
    takes : frozenset of str
        Which of the options "records", "breadth" and "height" it looks at.
    """

    name: str
    order: int
    title: str
    of: str
    run: Callable[[Options], Finding]
    takes: frozenset[str] = frozenset()


def table_lines(columns: Sequence[str], rows: Sequence[Row]) -> list[str]:
    """Return a table in Markdown."""
    return [
        f"| {' | '.join(columns)} |",
        "|" + "---|" * len(columns),
        *(f"| {' | '.join(str(cell) for cell in row)} |" for row in rows),
    ]
