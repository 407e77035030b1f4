"""What a portfolio writes: tables, reports and the file that lists them, all of them or none."""

import json
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from assess.delivery.deliver import deliver, explain_fault, stage_for
from assess.delivery.disk import find_digest, write_through
from assess.delivery.stages import NEW
from assess.errors import InputError, OutputError, PdfUnavailableError, Problem
from assess.i18n import fill
from assess.motion.site_ground import GroundField
from assess.plain_text import plain_line, plain_text
from assess.portfolio.building_rows import list_problems, to_row
from assess.portfolio.building_task import Summary
from assess.portfolio.part_files import FOLDER, Part, read_part
from assess.portfolio.sources import Source
from assess.portfolio.table_schemas import TABLES
from assess.progress import Progress
from assess.report.ownership import find_reports
from assess.report.report_options import ReportOptions
from assess.settings import Settings
from assess.version import __version__, find_code

if TYPE_CHECKING:
    from assess.portfolio.background import Background
    from assess.portfolio.city_tables import TableWriter
    from assess.portfolio.city_totals import CityView, RunGround

VERSION = "1"
"""Of the shape of portfolio.json."""
DATA = "portfolio.json"
Paths = tuple[Path, ...]
FILES: Mapping[str, str] = {"xlsx": "ranking.xlsx", "html": "city.html", "pdf": "city.pdf"}
"""Reports by their format; the format parquet gives files of the names of `TABLES`."""
FORMATS = ("parquet", *FILES)


@dataclass(frozen=True, slots=True, kw_only=True)
class Output:
    """What is written, from what, and where to.

    Parameters
    ----------
    sources : tuple of Source
        The buildings, in their order.
    out : Path
        The folder.
    settings, ground
        Of the run.
    formats : tuple of str
        Some of `FORMATS`.
    background : Background, optional
        Of the map.
    repeat : str
        Command that assesses one building alone, with ``{path}`` in place of its workbook.
    options : ReportOptions
        Language of the reports.
    progress : Progress
        Checked for a cancel, after which nothing is written.
    """

    sources: tuple[Source, ...]
    out: Path
    settings: Settings
    ground: GroundField | None
    formats: tuple[str, ...]
    background: "Background | None"
    repeat: str
    options: ReportOptions
    progress: Progress


def list_names(formats: Sequence[str]) -> list[str]:
    """Return the names of the files of some formats, where no table takes more than one."""
    tables = [f"{name}.parquet" for name in TABLES] if "parquet" in formats else []
    return [*tables, *(FILES[name] for name in formats if name in FILES), DATA]


def find_old(out: Path, wanted: Collection[str]) -> frozenset[str]:
    """Return the names of the files that an earlier run wrote into a folder; InputError as `find_reports`."""
    tables = "|".join(TABLES)
    written = re.compile(rf"(?:{tables})(?:-\d{{4}})?\.parquet|" + "|".join(map(re.escape, FILES.values())))
    return find_reports(out, wanted, lambda name: written.fullmatch(name) is not None, DATA)


def write_output(job: Output, summaries: Mapping[str, Summary]) -> "tuple[Paths, Paths, CityView]":
    """Write tables and reports; return the files, those that were removed, and the tables as frames.

    Raises
    ------
    OutputError
        If something cannot be written; all is as it was.
    PdfUnavailableError
        If the native libraries of the PDF are missing; all else has been written.
    CancelledError
        If the work was cancelled; all is as it was.
    """
    names = list_names(job.formats)
    try:
        with stage_for(job.out) as stage, job.progress.stage("rendering", ", ".join(job.formats)):
            from assess.portfolio.city_totals import CityView

            frames = {name: writer.frame for name, writer in _write_tables(job, summaries, stage / NEW).items()}
            view = CityView(**frames, settings=job.settings, ground=_describe_ground(job.ground, frames["buildings"]))
            missing = _write_reports(job, view, stage / NEW)
            names = sorted(path.name for path in (stage / NEW).iterdir())
            write_through(stage / NEW / DATA, _describe_run(job, view, stage / NEW, names))
            names.append(DATA)
            gone = deliver(stage, job.out, lambda target: find_old(target, names), DATA, job.progress)
    except OSError as error:
        raise explain_fault(job.out, error, names) from None
    if missing is not None:
        raise missing
    return tuple(job.out / name for name in names), tuple(job.out / name for name in gone), view


def _write_tables(job: Output, summaries: Mapping[str, Summary], folder: Path) -> "dict[str, TableWriter]":
    from assess.portfolio.city_tables import write_tables

    alike = find_alike(job.sources, summaries)
    parts = (
        _note_alike(_find_part(job.out, summaries[one.path]), alike.get(one.path))
        for one in job.progress.checked(job.sources)
    )
    return write_tables(parts, folder if "parquet" in job.formats else None)


def find_alike(sources: Sequence[Source], summaries: Mapping[str, Summary]) -> dict[str, str]:
    """Return the buildings whose workbook has the same bytes as that of an earlier one, with the path of the first."""
    first: dict[str, str] = {}
    found = {}
    for path, summary in ((one.path, summaries[one.path]) for one in sources):
        if summary.content and summary.status == "assessed":
            same = first.setdefault(summary.content, path)
            if same != path:
                found[path] = same
    return found


def _note_alike(part: Part, first: str | None) -> Part:
    """Return a part with a note where its workbook is a copy; what is kept on the disk has none."""
    if first is None:
        return part
    fault = fill("its workbook has the same content as {path}: it counts as a building of its own.",
                 path=plain_line(first))  # fmt: skip
    fix = fill("Remove one of them if they are the same building.")
    notes = [to_row("problems", one) for one in list_problems(part.path, [Problem("note", "", "", fault, fix)])]
    at = [column.name for column in TABLES["buildings"]].index("same_as")
    rows = [[*row[:at], first, *row[at + 1 :]] for row in part.rows("buildings")]
    return replace(part, tables={**part.tables, "buildings": rows, "problems": [*part.rows("problems"), *notes]})


def _find_part(out: Path, summary: Summary) -> Part:
    part = summary.part or read_part(out, summary.key)
    if part is None:
        raise OutputError(
            fill(
                "{folder}: what was found of {path} is gone, or damaged. Run the same command again.",
                folder=plain_line(str(out / FOLDER)),
                path=plain_line(summary.path),
            )
        )
    return part


def _write_reports(job: Output, view: "CityView", folder: Path) -> PdfUnavailableError | None:
    """Write the reports; return why there is no PDF, where one was to be written."""
    missing = None
    for name in job.formats:
        if name in FILES:
            try:
                write_through(folder / FILES[name], _RENDERERS[name](view, job))
            except PdfUnavailableError as error:
                missing = error
    return missing


# ---------------------------------------------------------------- the view


def _describe_ground(ground: GroundField | None, buildings: Any) -> "RunGround | None":
    """Return the ground motion of the run, with the facts that hold for all its buildings."""
    if ground is None:
        return None
    from assess.portfolio.city_totals import RunGround

    placed = buildings[buildings["ground_source"].isin(("shakemap", "scenarios"))]
    sites = []
    for latitude, longitude in zip(placed["latitude"], placed["longitude"], strict=True):
        with suppress(InputError):
            sites.append(ground.at(float(latitude), float(longitude)))
    common = [fact for fact in sites[0].facts if all(fact in one.facts for one in sites)] if sites else []
    kind = sites[0].kind if sites else "scenarios" if hasattr(ground, "event_count") else "shakemap"
    cautions = [text for text in sites[0].cautions if all(text in one.cautions for one in sites)] if sites else []
    return RunGround(
        kind=kind,
        file=ground.file,
        sha256=ground.sha256,
        facts=tuple(common),
        cautions=tuple(cautions),
        is_known=bool(sites) and not any(one.dispersion for one in sites),
    )


def list_skipped(view: "CityView") -> Iterator[tuple[str, str]]:
    """Yield the buildings that were skipped, each with its first problem and how to fix it."""
    skipped = view.buildings[view.buildings["status"] == "skipped"]
    first = view.problems.drop_duplicates("path").set_index("path")
    for path in skipped["path"]:
        if path in first.index:
            row = first.loc[path]
            place = "!".join(one for one in (row["sheet"], row["cell"]) if one)
            said = " ".join(str(row[name]) for name in ("message", "fix") if row[name])
            file = f"{plain_text(PurePath(path).name)} "
            said = f"it {said.removeprefix(file)}" if said.startswith(file) else said  # the path stands before it
            yield path, f"{place}: {said}" if place else said[:1].upper() + said[1:]
        else:
            yield path, ""


# ---------------------------------------------------------------- reports and portfolio.json

# What writes each format is imported only when it is wanted.


def _render_ranking(view: "CityView", job: Output) -> bytes:
    from assess.portfolio.ranking_workbook import render_ranking

    return render_ranking(view, options=job.options, progress=job.progress)


def _render_page(view: "CityView", job: Output) -> bytes:
    from assess.portfolio.city_isolines import list_isolines
    from assess.portfolio.city_page import render_page

    lines = list_isolines(view, job.ground)
    indexed = {one.path for one in job.sources if one.index is not None and one.index.as_building()}
    return render_page(
        view, job.background, options=job.options, isolines=lines, repeat=job.repeat, indexed=indexed,
        progress=job.progress,
    )  # fmt: skip


def _render_summary(view: "CityView", job: Output) -> bytes:
    from assess.portfolio.city_isolines import list_isolines
    from assess.portfolio.city_summary import render_summary

    lines = list_isolines(view, job.ground)
    return render_summary(view, job.background, options=job.options, isolines=lines, progress=job.progress)


_RENDERERS: Mapping[str, "Callable[[CityView, Output], bytes]"] = {
    "xlsx": _render_ranking,
    "html": _render_page,
    "pdf": _render_summary,
}


def _describe_run(job: Output, view: "CityView", folder: Path, names: Sequence[str]) -> bytes:
    """Return portfolio.json: what the run rests on, its files with their hashes, and the columns of the tables."""
    record = {
        "schema": VERSION,
        "assess": {
            "version": __version__,
            "code": find_code(),
            "settings": job.settings.as_record(),
            "ground": _describe_origin(view.ground),
            "files": {name: find_digest(folder / name) for name in names},
        },
        "buildings": {status: int((view.buildings["status"] == status).sum()) for status in ("assessed", "skipped")},
        "tables": {name: [[one.name, one.type, str(one.help)] for one in columns] for name, columns in TABLES.items()},
    }
    return (json.dumps(record, indent=1, ensure_ascii=False) + "\n").encode("utf-8", "replace")


def _describe_origin(ground: "RunGround | None") -> dict[str, Any] | None:
    if ground is None:
        return None
    facts = [[str(label), str(value)] for label, value in ground.facts]
    return {"kind": ground.kind, "file": ground.file, "sha256": ground.sha256, "facts": facts}
