"""A portfolio from end to end: buildings found, assessed, and written as tables and reports, all of them or none.

What was done stays in the folder of parts, so that a run that was killed goes on where it was.
"""

import json
import re
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any

from assess.delivery.deliver import deliver, explain_fault, find_digest, stage_for, write_through
from assess.delivery.folders import NEW, FolderLock
from assess.errors import InputError, OutputError, PdfUnavailableError, Problem
from assess.i18n import fill
from assess.motion.site_ground import GroundField
from assess.portfolio.building_rows import list_problems
from assess.portfolio.building_task import ENDING, FOLDER, WRITING, Part, Summary, Task, read_part
from assess.portfolio.sources import Source, find_sources
from assess.portfolio.table_schemas import STATUSES, TABLES
from assess.progress import Listener, Progress, Report
from assess.report import check_folder
from assess.report.ownership import find_reports
from assess.report.report_options import ReportOptions
from assess.settings import AUTO, Settings, count_processors
from assess.text import plain_line
from assess.version import __version__, find_code

if TYPE_CHECKING:
    from assess.portfolio.background import Background
    from assess.portfolio.city import City, RunGround

STAGE = "buildings"
VERSION = "1"  # of the shape of portfolio.json
DATA = "portfolio.json"
FILES: Mapping[str, str] = {"xlsx": "ranking.xlsx", "html": "city.html", "pdf": "city.pdf"}
"""Reports by their format; the format parquet gives files of the names of `TABLES`."""
FORMATS = ("parquet", *FILES)
_KEY = re.compile(r"[0-9a-f]{64}")


@dataclass(frozen=True, slots=True, kw_only=True)
class PortfolioResult:
    """What a portfolio gave: the folder, files written to it and removed from an earlier run, and the city.

    `kept` counts buildings that an earlier run had assessed; `skipped` could not be assessed, with the reason.
    """

    folder: Path
    files: tuple[Path, ...]
    removed: tuple[Path, ...]
    kept: int
    skipped: tuple[tuple[str, str], ...]
    city: "City"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Job:
    sources: tuple[Source, ...]
    out: Path
    settings: Settings
    ground: GroundField | None
    formats: tuple[str, ...]
    background: "Background | None"
    repeat: str
    options: ReportOptions
    progress: Progress


def run_portfolio(
    source: str | Path, out: str | Path, settings: Settings | None = None, *, ground: GroundField | None = None,
    jobs: int | None = None, scheduler: str | None = None, formats: Sequence[str] = FORMATS,
    background: "Background | None" = None, language: str = "en", repeat: str = "",
    progress: "Progress | Listener | None" = None, cancel: Event | None = None,
) -> PortfolioResult:  # fmt: skip
    """Assess many buildings under one earthquake.

    * `source`: a folder of workbooks, or an index (.csv).
    * `out`: folder of the results. The files of an earlier run in it are replaced, other files are left alone;
      buildings that an earlier run has assessed in the same way are taken from it.
    * `settings`: of the run; `city` is set.
    * `ground`: a ShakeMap, or computed scenarios: they take the place of the ground motions of the workbooks.
    * `jobs`: processes, as many as there are processors by default: they do not change a result.
    * `scheduler`: address of a dask scheduler whose workers do the work.
    * `repeat`: command that assesses one building alone, with ``{path}`` in place of its workbook: the page shows it.
    * `cancel`: stops the work; what is done is kept for the next run.

    Raises InputError if a setting, the folder, the index or the scheduler cannot be used, or a format needs a package
    that is not installed; OutputError if the results cannot be written; those of an earlier run are left as they were;
    CancelledError if the work was cancelled; nothing was written, but the buildings that are done are kept.
    """
    source, out = Path(source), Path(out).absolute()
    check_extras(formats, scheduler)
    shown = plain_line(str(out))
    if out.exists() and not out.is_dir():
        raise InputError.about("out: {folder} is a file; name a folder.", folder=shown)
    if out.resolve() == source.resolve():
        raise InputError.about("out: {folder} holds the workbooks; name another folder.", folder=shown)
    check_folder(out)
    if out.is_dir():
        _find_old(out, _list_names(formats))
    sources = find_sources(source, out)
    settings = settings or Settings()
    if settings.verify != "none":
        if settings.runs == AUTO:
            raise InputError.about(
                "runs is {runs}: all buildings of a city need the same draws. Give a number, such as 200.", runs=AUTO
            )
        if scenarios := getattr(ground, "event_count", 0):
            from assess.pipeline.city_draws import choose_runs

            choose_runs(scenarios, settings.runs)  # raises if they do not fit
    path = getattr(ground, "path", None)  # other processes may be in another folder
    job = _Job(
        sources=sources, out=out, settings=replace(settings, city=True),
        ground=ground if path is None else replace(ground, path=path.resolve()),  # type: ignore[type-var]
        formats=tuple(name for name in FORMATS if name in formats),
        background=background, repeat=repeat, options=ReportOptions(language=language),
        progress=Progress.of(progress, cancel),
    )  # fmt: skip
    with _reserving(out):
        summaries = _assess_all(job, jobs or count_processors(), scheduler)
        files, removed, city = _write_output(job, summaries)
        keys = {one.key for one in summaries.values()}
        for place in (out / FOLDER).glob("??/*"):  # parts of buildings that are gone, or of other settings
            if _KEY.fullmatch(place.stem) and place.suffix in (ENDING, ".txt") and place.stem not in keys:
                with suppress(OSError):
                    place.unlink()
    from assess.portfolio.city_words import explain_skipped

    return PortfolioResult(
        folder=out, files=files, removed=removed, kept=sum(one.is_kept for one in summaries.values()),
        skipped=tuple((row["path"], explain_skipped(city, row["path"])) for row in city.skipped),
        city=city,
    )  # fmt: skip


def check_extras(formats: Sequence[str], scheduler: str | None) -> None:
    """Raise InputError if a format or the address is none, or a package is not installed that the run needs."""
    for name in formats:
        if name not in FORMATS:
            known = ", ".join(FORMATS)
            raise InputError.about("formats: {name!r} is unknown, expected some of: {known}", name=name, known=known)
    if "parquet" in formats:
        from assess.portfolio.city_tables import check_tables

        check_tables()
    if scheduler is not None:
        from assess.portfolio.cluster import check_cluster

        check_cluster(scheduler)


def _list_names(formats: Sequence[str]) -> list[str]:
    """Return the names of the files of some formats, where no table takes more than one."""
    tables = [f"{name}.parquet" for name in TABLES] if "parquet" in formats else []
    return [*tables, *(FILES[name] for name in formats if name in FILES), DATA]


def _find_old(out: Path, wanted: Collection[str]) -> frozenset[str]:
    """Return the names of the files that an earlier run wrote into a folder; InputError as `find_reports`."""
    tables = "|".join(TABLES)
    written = re.compile(rf"(?:{tables})(?:-\d{{4}})?\.parquet|" + "|".join(map(re.escape, FILES.values())))
    return find_reports(out, wanted, lambda name: written.fullmatch(name) is not None, DATA)


@contextmanager
def _reserving(out: Path) -> Iterator[None]:
    """Keep other runs from the folder of parts, and remove what killed ones left; raises OutputError if it cannot."""
    try:
        (out / FOLDER).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise explain_fault(out, error, ()) from None
    lock = FolderLock(out / FOLDER)
    if not lock.take():
        raise OutputError.about("{folder} is in use: another run is writing to it.", folder=plain_line(str(out)))
    try:
        if lock.is_held:  # what killed processes have left half written
            for path in (out / FOLDER).glob(f"*/{WRITING}*"):
                with suppress(OSError):
                    path.unlink()
        yield
    finally:
        lock.release()


def _assess_all(job: _Job, jobs: int, scheduler: str | None) -> dict[str, Summary]:
    tasks = [Task(source=one, settings=job.settings, ground=job.ground, out=job.out) for one in job.sources]
    if scheduler is None:
        from assess.portfolio.local_pool import run_local

        summaries = run_local(tasks, jobs, job.progress)
    else:
        from assess.portfolio.cluster import run_on_cluster

        summaries = run_on_cluster(tasks, scheduler, job.progress)
    found: dict[str, Summary] = {}
    start, total, kept, skipped = time.monotonic(), len(tasks), 0, 0

    def tell() -> None:
        done, computed = len(found), len(found) - kept
        left = (time.monotonic() - start) / computed * (total - done) if computed else None
        detail = f"{done:,} of {total:,} buildings; {skipped:,} skipped"
        job.progress.tell(Report(STAGE, min(done / total, 0.9999), detail, left))

    tell()
    for summary in summaries:
        found[summary.path] = summary
        kept += summary.is_kept
        skipped += summary.status == "skipped"
        tell()
    job.progress.check()
    return found


def _write_output(job: _Job, summaries: Mapping[str, Summary]) -> "tuple[tuple[Path, ...], tuple[Path, ...], City]":
    """Write tables and reports; return the files, those that were removed, and the city.

    What writes a format is imported only where it is wanted. Whatever it raises leaves all as it was; but
    PdfUnavailableError is raised once all else has been written.
    """
    from assess.portfolio.city import City
    from assess.portfolio.city_tables import write_tables

    names = _list_names(job.formats)
    missing: PdfUnavailableError | None = None
    try:
        with stage_for(job.out) as stage, job.progress.stage("rendering", ", ".join(job.formats)):
            folder = stage / NEW
            frames = write_tables(_list_parts(job, summaries), folder if "parquet" in job.formats else None)
            city = City(**frames, settings=job.settings, ground=_describe_ground(job.ground, frames["buildings"]))
            if "xlsx" in job.formats:
                from assess.portfolio.ranking_workbook import render_ranking

                write_through(folder / FILES["xlsx"], render_ranking(city, options=job.options, progress=job.progress))
            if {"html", "pdf"} & set(job.formats):
                from assess.portfolio.city_map import list_isolines
                from assess.portfolio.city_page import render_page, render_summary

                common: dict[str, Any] = {"options": job.options, "progress": job.progress,
                                          "isolines": list_isolines(city, job.ground)}  # fmt: skip
            if "html" in job.formats:
                indexed = {one.path for one in job.sources if one.index is not None and one.index.as_building()}
                page = render_page(city, job.background, repeat=job.repeat, indexed=indexed, **common)
                write_through(folder / FILES["html"], page)
            if "pdf" in job.formats:
                try:
                    write_through(folder / FILES["pdf"], render_summary(city, job.background, **common))
                except PdfUnavailableError as error:
                    missing = error
            names = sorted(path.name for path in folder.iterdir())
            write_through(folder / DATA, _describe_run(job, city, folder, names))
            names.append(DATA)
            gone = deliver(stage, job.out, lambda target: _find_old(target, names), DATA, job.progress)
    except OSError as error:
        raise explain_fault(job.out, error, names) from None
    if missing is not None:
        raise missing
    return tuple(job.out / name for name in names), tuple(job.out / name for name in gone), city


def _list_parts(job: _Job, summaries: Mapping[str, Summary]) -> Iterator[Part]:
    """Yield the parts in the order of paths; one whose workbook is a copy notes that, unlike the one on the disk."""
    first: dict[str, str] = {}
    for source in job.progress.checked(job.sources):
        summary = summaries[source.path]
        part = summary.part or read_part(job.out, summary.key)
        if part is None:
            raise OutputError.about(
                "{folder}: what was found of {path} is gone, or damaged. Run the same command again.",
                folder=plain_line(str(job.out / FOLDER)),
                path=plain_line(summary.path),
            )
        is_counted = summary.content and summary.status == "assessed"
        same = first.setdefault(summary.content, part.path) if is_counted else part.path
        if same != part.path:
            fault = fill("its workbook has the same content as {path}: it counts as a building of its own.",
                         path=plain_line(same))  # fmt: skip
            fix = fill("Remove one of them if they are the same building.")
            notes = list_problems(part.path, [Problem("note", "", "", fault, fix)])
            at = [field.key for field in TABLES["buildings"]].index("same_as")
            rows = [[*row[:at], same, *row[at + 1 :]] for row in part.rows("buildings")]
            changed = {"buildings": rows, "problems": [*part.rows("problems"), *notes]}
            part = replace(part, tables={**part.tables, **changed})
        yield part


def _describe_ground(ground: GroundField | None, buildings: Any) -> "RunGround | None":
    if ground is None:
        return None
    from assess.portfolio.city import RunGround

    placed = buildings[buildings["ground_source"].isin(("shakemap", "scenarios"))]
    sites = []
    for latitude, longitude in zip(placed["latitude"], placed["longitude"], strict=True):
        with suppress(InputError):
            sites.append(ground.at(float(latitude), float(longitude)))
    common = [fact for fact in sites[0].facts if all(fact in one.facts for one in sites)] if sites else []
    cautions = [text for text in sites[0].cautions if all(text in one.cautions for one in sites)] if sites else []
    return RunGround(
        kind=sites[0].kind if sites else "scenarios" if hasattr(ground, "event_count") else "shakemap",
        file=ground.file, sha256=ground.sha256, facts=tuple(common), cautions=tuple(cautions),
        is_known=bool(sites) and not any(one.dispersion for one in sites),
    )  # fmt: skip


def _describe_run(job: _Job, city: "City", folder: Path, names: Sequence[str]) -> bytes:
    ground: dict[str, Any] | None = None
    if city.ground is not None:
        facts = [[str(label), str(value)] for label, value in city.ground.facts]
        ground = {"kind": city.ground.kind, "file": city.ground.file, "sha256": city.ground.sha256, "facts": facts}
    record = {
        "schema": VERSION,
        "assess": {
            "version": __version__, "code": find_code(), "settings": job.settings.as_record(), "ground": ground,
            "files": {name: find_digest(folder / name) for name in names},
        },
        "buildings": {status: int((city.buildings["status"] == status).sum()) for status in STATUSES},
        "tables": {name: [[one.key, one.kind, str(one.help)] for one in columns] for name, columns in TABLES.items()},
    }  # fmt: skip
    return (json.dumps(record, indent=1, ensure_ascii=False) + "\n").encode("utf-8", "replace")
