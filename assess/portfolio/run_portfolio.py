"""A portfolio from end to end: buildings found, assessed, and written as tables and reports, all of them or none.

What was done stays in the folder of parts, so that a run that was killed goes on where it was.
"""

import re
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING

from assess.delivery.deliver import explain_fault
from assess.delivery.folder_lock import FolderLock
from assess.errors import InputError, OutputError
from assess.i18n import fill
from assess.motion.site_ground import GroundField
from assess.plain_text import plain_line
from assess.portfolio.building_task import Summary, Task
from assess.portfolio.part_files import ENDING, FOLDER, sweep_parts
from assess.portfolio.portfolio_output import FORMATS, Output, find_old, list_names, list_skipped, write_output
from assess.portfolio.sources import find_sources
from assess.progress import Listener, Progress, Report
from assess.report import check_folder
from assess.report.report_options import ReportOptions
from assess.settings import AUTO, Settings, count_processors

if TYPE_CHECKING:
    from assess.portfolio.background import Background
    from assess.portfolio.city_totals import CityView

STAGE = "buildings"
_KEY = re.compile(r"[0-9a-f]{64}")


@dataclass(frozen=True, slots=True, kw_only=True)
class PortfolioResult:
    """What a portfolio gave.

    Parameters
    ----------
    folder : Path
        Of the results.
    files, removed : tuple of Path
        What was written, and what of an earlier run was not replaced.
    kept : int
        Buildings whose part of an earlier run was there.
    skipped : tuple of pairs of str
        Buildings that could not be assessed, with the reason.
    view : CityView
        The tables, and what the run rests on.
    """

    folder: Path
    files: tuple[Path, ...]
    removed: tuple[Path, ...]
    kept: int
    skipped: tuple[tuple[str, str], ...]
    view: "CityView"


def run_portfolio(
    source: str | Path,
    out: str | Path,
    settings: Settings | None = None,
    *,
    ground: GroundField | None = None,
    jobs: int | None = None,
    scheduler: str | None = None,
    formats: Sequence[str] = FORMATS,
    background: "Background | None" = None,
    language: str = "en",
    repeat: str = "",
    progress: "Progress | Listener | None" = None,
    cancel: Event | None = None,
) -> PortfolioResult:
    """Assess many buildings under one earthquake.

    Parameters
    ----------
    source : str or Path
        A folder of workbooks, or an index (.csv).
    out : str or Path
        Folder of the results. The files of an earlier run in it are replaced, other files are left alone; buildings
        that an earlier run has assessed in the same way are taken from it.
    settings : Settings, optional
        Of the run; `city` is set.
    ground : GroundField, optional
        A ShakeMap, or computed scenarios: they take the place of the ground motions of the workbooks.
    jobs : int, optional
        Processes; as many as there are processors by default. They do not change a result.
    scheduler : str, optional
        Address of a dask scheduler whose workers do the work.
    formats : sequence of str
        Some of `FORMATS`.
    background : Background, optional
        Of the map.
    language : str
        Code of the language of the reports.
    repeat : str
        Command that assesses one building alone, with ``{path}`` in place of its workbook: the page shows it.
    progress : Progress or callable, optional
        Notified of how far the work is.
    cancel : threading.Event, optional
        Stops the work; what is done is kept for the next run.

    Raises
    ------
    InputError
        If a setting, the folder, the index or the scheduler cannot be used, or a format needs a package that is not
        installed.
    OutputError
        If the results cannot be written; those of an earlier run are left as they were.
    CancelledError
        If the work was cancelled; nothing was written, but the buildings that are done are kept.
    """
    source, out = Path(source), Path(out).absolute()
    check_extras(formats, scheduler)
    _check_out(source, out, formats)
    job = Output(
        sources=find_sources(source, out),
        out=out,
        settings=_check_settings(settings or Settings(), ground),
        ground=_locate(ground),
        formats=tuple(name for name in FORMATS if name in formats),
        background=background,
        repeat=repeat,
        options=ReportOptions(language=language),
        progress=Progress.of(progress, cancel),
    )
    with _reserving(out):
        summaries = _assess_all(job, jobs or count_processors(), scheduler)
        files, removed, view = write_output(job, summaries)
        _remove_unused(out, {one.key for one in summaries.values()})
    return PortfolioResult(
        folder=out,
        files=files,
        removed=removed,
        kept=sum(one.is_kept for one in summaries.values()),
        skipped=tuple(list_skipped(view)),
        view=view,
    )


# ---------------------------------------------------------------- before the work


def check_extras(formats: Sequence[str], scheduler: str | None) -> None:
    """Raise InputError if a format or the address is none, or a package is not installed that the run needs."""
    check_formats(formats)
    if scheduler is not None:
        from assess.portfolio.cluster import check_address, check_cluster

        check_address(scheduler)
        check_cluster()


def check_formats(formats: Sequence[str]) -> None:
    """Raise InputError if a format is unknown, or needs a package that is not installed."""
    for name in formats:
        if name not in FORMATS:
            known = ", ".join(FORMATS)
            raise InputError(fill("formats: {name!r} is unknown, expected some of: {known}", name=name, known=known))
    if "parquet" in formats:
        from assess.portfolio.city_tables import check_tables

        check_tables()


def _check_out(source: Path, out: Path, formats: Sequence[str]) -> None:
    """Raise unless results can be written to the folder."""
    shown = plain_line(str(out))
    if out.exists() and not out.is_dir():
        raise InputError(fill("out: {folder} is a file; name a folder.", folder=shown))
    if out.resolve() == source.resolve():
        raise InputError(fill("out: {folder} holds the workbooks; name another folder.", folder=shown))
    check_folder(out)
    if out.is_dir():
        find_old(out, list_names(formats))


def _check_settings(settings: Settings, ground: GroundField | None) -> Settings:
    """Return the settings of all buildings; InputError if none of them could be assessed with their draws."""
    if settings.runs == AUTO and settings.verify != "none":
        raise InputError(
            fill("runs is {runs}: all buildings of a city need the same draws. Give a number, such as 200.", runs=AUTO)
        )
    scenarios = getattr(ground, "event_count", 0)
    if scenarios and settings.verify != "none":
        from assess.pipeline.city_draws import choose_runs

        choose_runs(scenarios, settings.runs)
    return replace(settings, city=True)


def _locate(ground: GroundField | None) -> GroundField | None:
    """Return the ground motion with the whole path of its file, as other processes may stand elsewhere."""
    path = getattr(ground, "path", None)
    return ground if path is None else replace(ground, path=path.resolve())  # type: ignore[type-var]


@contextmanager
def _reserving(out: Path) -> Iterator[None]:
    """Keep other runs from the folder of parts, and remove what killed ones left; raises OutputError if it cannot."""
    try:
        (out / FOLDER).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise explain_fault(out, error, ()) from None
    lock = FolderLock(out / FOLDER)
    if not lock.take():
        raise OutputError(fill("{folder} is in use: another run is writing to it.", folder=plain_line(str(out))))
    try:
        if lock.is_held:
            sweep_parts(out)
        yield
    finally:
        lock.release()


# ---------------------------------------------------------------- the work


@dataclass(slots=True)
class _Count:
    """How far the buildings are."""

    total: int
    start: float = field(default_factory=time.monotonic)
    done: int = 0
    kept: int = 0
    skipped: int = 0

    def take(self, summary: Summary) -> None:
        self.done += 1
        self.kept += summary.is_kept
        self.skipped += summary.status == "skipped"

    def report(self) -> Report:
        detail = f"{self.done:,} of {self.total:,} buildings; {self.skipped:,} skipped"
        computed, spent = self.done - self.kept, time.monotonic() - self.start
        left = spent / computed * (self.total - self.done) if computed > 0 else None
        return Report(STAGE, min(self.done / self.total, 0.9999), detail, left)


def _assess_all(job: Output, jobs: int, scheduler: str | None) -> dict[str, Summary]:
    """Return the summary of every building by its path."""
    tasks = [Task(source=one, settings=job.settings, ground=job.ground, out=job.out) for one in job.sources]
    found: dict[str, Summary] = {}
    count = _Count(len(tasks))
    job.progress.tell(count.report())
    for summary in _run(tasks, jobs, scheduler, job):
        found[summary.path] = summary
        count.take(summary)
        job.progress.tell(count.report())
    job.progress.check()
    return found


def _run(tasks: Sequence[Task], jobs: int, scheduler: str | None, job: Output) -> Iterator[Summary]:
    if scheduler is None:
        from assess.portfolio.local_pool import run_local

        return run_local(tasks, jobs, job.progress)
    from assess.portfolio.cluster import run_on_cluster

    is_simulated = job.settings.verify != "none"
    return run_on_cluster(tasks, scheduler, is_simulated=is_simulated, progress=job.progress)


def _remove_unused(out: Path, keys: set[str]) -> None:
    """Remove parts that this run has no use for: of buildings that are gone, or of other settings."""
    for path in (out / FOLDER).glob("??/*"):
        if _KEY.fullmatch(path.stem) and path.suffix in (ENDING, ".txt") and path.stem not in keys:
            with suppress(OSError):
                path.unlink()
