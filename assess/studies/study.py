"""What a study is: one part of the paper, or of its comparison, repeated on data that anyone may have.

Pages come from templates, `templates/studies/<name>.md.j2`, whose blocks are the texts of a `Finding`. A paragraph or
an item of a list may stand on several lines of a template; a row of a table stands on one. The files of a study are
written each whole or not at all; the results of long work are kept for the next run.
"""

import csv
import hashlib
import io
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import NDArray

from assess.delivery.deliver import save
from assess.errors import OutputError
from assess.resources import templates
from assess.settings import Settings
from assess.version import __version__

if TYPE_CHECKING:
    from jinja2 import Environment

Row = Sequence[object]
Item = TypeVar("Item")


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """The input of a study.

    * `out`: folder of its files; the results of long work are kept there too, in `parts`, and loaded by the next run.
    * `runs`, `seed`: number of generated motions per channel, and the seed of their phases.
    * `jobs`: threads; the results do not depend on it.
    * `records`: folder of the user's own records, for the studies that take one.
    * `breadth`, `height`: the piece of furniture, for the studies of a single piece [m].
    * `report_share`: called with the share of the study that is done [-]; raises CancelledError if the work is to stop.
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

    * `page`: lines of Markdown: method, data and results, every number from the run.
    * `summary`, `overview`: sentences and lines for the head of the page of all studies: how well formulas agree.
    * `failures`: sentences on where published formulas fail.
    * `tables`, `figures`, `files`: by the names of their files; other files are text.
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


STARTS = ("|", "* ", "#", "![")
"""Beginnings of lines that do not continue a paragraph: rows of tables, items of lists, headings, pictures."""


def write_finding(
    study: str, values: Mapping[str, object], *, tables: Mapping[str, Table], figures: Mapping[str, bytes],
    files: Mapping[str, str] | None = None,
) -> Finding:  # fmt: skip
    """Return the results of a study: its tables, figures and files, and the blocks of its template for `values`."""
    blocks = {name: render_block(study, name, **values) for name in ("page", "overview", "summary", "failures")}
    blocks |= {name: [line for line in blocks[name] if line] for name in ("summary", "failures")}
    return Finding(**blocks, tables=tables, figures=figures, files=files or {})


def render_block(name: str, block: str, /, **values: object) -> list[str]:
    """Return the lines of one block of a template; none if the template does not define it."""
    template = _environment().get_template(f"{name}.md.j2")
    if block not in template.blocks:
        return []
    return _join_lines("".join(template.blocks[block](template.new_context(values))))


def render_page(name: str, /, **values: object) -> str:
    """Return the whole of a template."""
    return "\n".join(_join_lines(_environment().get_template(f"{name}.md.j2").render(values))) + "\n"


def _join_lines(text: str) -> list[str]:
    """Return paragraphs and items on one line each, with one empty line where there are several."""
    lines = [""]
    for line in map(str.strip, text.split("\n")):
        if line and lines[-1] and not line.startswith(STARTS):
            lines[-1] += f" {line}"
        elif line or lines[-1]:
            lines.append(line)
    return lines[1 : len(lines) - (not lines[-1])] if len(lines) > 1 else []


@cache
def _environment() -> "Environment":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(  # noqa: S701 - the pages are Markdown
        loader=FileSystemLoader(templates() / "studies"), trim_blocks=True, lstrip_blocks=True,
        undefined=StrictUndefined,
    )  # fmt: skip
    made.filters |= {"form": format, "percent": percent, "points": _points, "span": _span}
    made.filters["forms"] = lambda values, form, separator="/": separator.join(format(one, form) for one in values)
    made.globals |= {"zip": zip}
    return made


def percent(share: float) -> str:
    """Return a share [-] as pages write it; "-" for NaN."""
    return "-" if share != share else f"{100 * share:.0f} %"


def _points(share: float, sign: str = "") -> str:
    """Return a share or a difference of shares [-] in percentage points; "-" for NaN."""
    return "-" if share != share else f"{100 * share:{sign}.1f}"


def _span(values: Sequence[float], decimals: int) -> str:
    low, high = f"{min(values):.{decimals}f}", f"{max(values):.{decimals}f}"
    return low if low == high else f"{low} to {high}"


# ---------------------------------------------------------------- files

Arrays = Mapping[str, NDArray[np.generic]]
PARTS = "parts"
"""Folder of kept results, within that of a study's files."""
SOURCES = (
    "motion", "rocking", "compiled.py", "units.py", "methods/simulate.py", "studies/buildings.py",
    "studies/calibration.py",
)  # fmt: skip
"""The code that kept results depend on: if it changes, they are computed again."""
MARK = "made_of"
"""Array within a kept file that identifies what its numbers were computed from."""


def check_folder(folder: Path) -> None:
    """Raise OutputError unless a folder can be written to; it need not exist, and nothing is left behind."""
    try:
        there = next(one for one in (folder, *folder.absolute().parents) if one.exists())
        with tempfile.TemporaryDirectory(prefix=".assess-writing-", dir=there):
            pass
    except OSError as error:
        raise _fault(folder, error) from None


def write_files(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write files into a folder, which is made if missing; a name may include a folder within.

    Each file appears whole, and if one cannot be written, none is: see `assess.delivery`.

    Raises OutputError if a file cannot be written.
    """
    taken = next((name for name in files if (folder / name).is_dir()), None)
    if taken is not None:
        raise OutputError(f"{folder / taken} could not be written: it is a folder. Move it away.")
    try:
        save({folder / name: data for name, data in files.items()})
    except OSError as error:
        raise _fault(folder, error) from None


def load_or_compute(folder: Path, inputs: object, compute: Callable[[], Arrays]) -> Arrays:
    """Return the result kept in `folder` for these inputs, or compute it and keep it there.

    The name of its file is a hash of `inputs`, the code in `SOURCES` and the versions of the numerical libraries. Only
    plain arrays are loaded, never pickles: a folder may come from someone else.

    `inputs` are everything else that the numbers depend on, identified by their `repr`. Raises OutputError if the
    result cannot be kept.
    """
    name = hashlib.sha256(repr((inputs, _state())).encode()).hexdigest()[:24]
    file = folder / f"{name}.npz"
    with suppress(Exception):  # missing, damaged, or made of something else: it is computed again
        with file.open("rb") as stored, np.load(stored) as kept:
            arrays = {key: kept[key] for key in kept.files}
        if str(arrays.pop(MARK)) == name:
            return arrays
    found, stream = compute(), io.BytesIO()
    np.savez(stream, **found, **{MARK: np.array(name)})  # type: ignore[arg-type]
    write_files(folder, {file.name: stream.getvalue()})
    return found


def _fault(folder: Path, error: OSError) -> OutputError:
    return OutputError(f"{folder} could not be written: {error.strerror or error}. Make room, or name another folder.")


@cache
def _state() -> tuple[str, ...]:
    root, code = Path(__file__).parents[1], hashlib.sha256()
    for source in SOURCES:
        own = root / source
        for file in sorted(own.rglob("*.py")) if own.is_dir() else [own]:
            code.update(file.read_bytes())
    return __version__, np.__version__, version("scipy"), version("numba"), code.hexdigest()
