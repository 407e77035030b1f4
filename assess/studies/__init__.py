"""The paper repeated on open data, and its formulas compared with direct integration. It stands alone.

In: the records that come along, tables of the paper (`facts`). Out: tables, figures, files and a page for each study.
May import: the core, and methods by name, which nothing else may. Nothing imports a study but its command.

A study is a module of this folder, or a folder in it, that defines STUDY. Running one writes its tables, figures, files
and page; there is a page of all as well.
"""

import csv
import importlib
import io
import pkgutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache

from assess.progress import SILENT, Progress
from assess.risk import LIMITS, RiskClass
from assess.studies.released_blocks import describe_released
from assess.studies.study import PARTS, Finding, Options, Study, check_folder, render_page, write_files
from assess.version import __version__

__all__ = [
    "PAGE", "PARTS", "Finding", "Options", "Study", "all_studies", "build_page", "check_folder", "run_all", "run_study",
    "write_files",
]  # fmt: skip

PAGE = "validation.md"


@cache
def all_studies() -> tuple[Study, ...]:
    """Return every study of this folder, in the order of the page."""
    modules = [importlib.import_module(f"{__name__}.{module.name}") for module in pkgutil.iter_modules(__path__)]
    return tuple(sorted((one.STUDY for one in modules if hasattr(one, "STUDY")), key=lambda study: study.order))


def run_all(studies: Sequence[Study], options: Options, progress: Progress = SILENT) -> dict[str, Finding]:
    """Run studies one after the other; return their findings by name."""
    return {study.name: run_study(study, options, progress) for study in studies}


def run_study(study: Study, options: Options, progress: Progress = SILENT) -> Finding:
    """Run a study as one stage of `progress`, and write its tables, figures, files and page to `options.out`."""
    with progress.stage(study.name, study.title) as stage:
        finding = study.run(replace(options, report_share=stage.at))
        texts = dict(finding.files)
        for name, table in finding.tables.items():
            csv.writer(file := io.StringIO(), lineterminator="\n").writerows([table.columns, *table.rows])
            texts[f"{name}.csv"] = file.getvalue()
        texts[f"{study.name}.md"] = render_page("study", study=study, finding=finding, describe=describe)
        write_files(options.out, {name: text.encode() for name, text in texts.items()} | dict(finding.figures))
    return finding


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
