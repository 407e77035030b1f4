"""Running studies, and the pages of their results: one for each study, and one of all."""

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from assess.progress import SILENT, Progress
from assess.risk import LIMITS, RiskClass
from assess.studies.released_blocks import describe_released
from assess.studies.study import Finding, Options, Study, Table, render_page
from assess.studies.study_files import write_files
from assess.version import __version__

PAGE = "validation.md"


def run_all(studies: Sequence[Study], options: Options, progress: Progress = SILENT) -> dict[str, Finding]:
    """Run studies one after the other; return their findings by name."""
    return {study.name: run_study(study, options, progress) for study in studies}


def run_study(study: Study, options: Options, progress: Progress = SILENT) -> Finding:
    """Run a study as one stage of `progress`, and write its tables, figures, files and page to `options.out`."""
    with progress.stage(study.name, study.title) as stage:
        finding = study.run(replace(options, report_share=stage.at))
        texts = {f"{name}.csv": _to_csv(table) for name, table in finding.tables.items()} | dict(finding.files)
        texts[f"{study.name}.md"] = render_page("study", study=study, finding=finding, describe=describe)
        write_files(options.out, {name: text.encode() for name, text in texts.items()} | dict(finding.figures))
    return finding


def _to_csv(table: Table) -> str:
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerows([table.columns, *table.rows])
    return file.getvalue()


def describe(study: Study, finding: Finding, folder: str) -> Iterator[str]:
    """Yield the section of a study; figures lie in `folder`, as links name it."""
    place = f"{study.of} of the paper" if study.of else "no part of the paper"
    yield from (f"`assess study {study.name}`, {place}.", "", *finding.page)
    for name in finding.figures:
        yield from ("", f"![{study.title}]({folder}{name})")


def build_page(studies: Sequence[Study], findings: Mapping[str, Finding], options: Options, folder: str = "") -> str:
    """Return the page of all studies: the results first, then where formulas fail, then each study."""
    return render_page(
        "validation",
        found=[(study, findings[study.name]) for study in studies],
        options=options, version=__version__, classes=list(RiskClass), limits=LIMITS, folder=folder, describe=describe,
        **describe_released(),
    )  # fmt: skip
