"""The formats of a run's reports: what the command, the page and `assess` write.

They are known without loading what writes them.
"""

import importlib.util
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from assess.environment import say_install
from assess.errors import InputError

if TYPE_CHECKING:
    from assess.progress import Progress
    from assess.report.content import Content
    from assess.report.pages.pdf import Layout
    from assess.report.report_options import ReportOptions
    from assess.results import Results


@dataclass(frozen=True)
class Job:
    """One set of reports that is written into a stage; the content is built once for all of them.

    `listed` are the files of the run but for results.json, with their SHA-256, None of one that carries results.json;
    `layouts` are the PDFs that were begun, by the names of their files.
    """

    results: "Results"
    options: "ReportOptions"
    progress: "Progress"
    stage: Path
    listed: dict[str, str | None] = field(default_factory=dict)
    layouts: dict[str, "Layout"] = field(default_factory=dict)

    @property
    def data(self) -> Path:
        """results.json as it stands in the stage."""
        return self.stage / FILES["json"]

    @cached_property
    def content(self) -> "Content":
        """What HTML, PDF and Excel show, in the language of the reports."""
        from assess.report.content import Content

        return self.progress.wait_for(lambda: Content(self.results))

    def write_data(self) -> None:
        """Write results.json, with the list of the other files."""
        from assess.report.data import write_json

        write_json(self.results, self.data, self.progress, files=dict(sorted(self.listed.items())))


@dataclass(frozen=True, slots=True, kw_only=True)
class Format:
    """A format of reports; a PDF's `edition` is begun before all others and written last, as it carries results.json.

    `needs` are packages beyond those of every report, by the modules that they bring, and `extra` brings them.
    """

    key: str
    file: str
    is_default: bool = True
    edition: Literal["client", "annex", "work"] | None = None
    needs: Mapping[str, str] = field(default_factory=dict)
    extra: str = ""

    @property
    def missing(self) -> list[str]:
        """The packages that are not installed."""
        return [package for module, package in self.needs.items() if importlib.util.find_spec(module) is None]

    def check(self) -> None:
        """Raise InputError, with what to install, if a package is missing."""
        if missing := self.missing:
            raise InputError.about(
                "the format {format} needs {packages}, which is not installed. {how}",
                format=self.key, packages=", ".join(missing), how=say_install(self.extra),
            )  # fmt: skip

    def write(self, job: Job, path: Path) -> None:
        """Write the file; what writes it is imported only now."""
        if self.edition is not None:
            from assess.report.pages.pdf import finish_pdf

            finish_pdf(job.layouts[path.name], job.results, path, job.options, job.progress, data=job.data)
        elif self.key == "xlsx":
            from assess.report.xlsx import write_xlsx

            write_xlsx(job.content, path, job.progress)
        elif self.key == "html":
            from assess.report.pages.html import write_html

            write_html(job.content, path, job.options, job.progress)
        elif self.key == "json":
            job.write_data()
        elif self.key == "docx":
            from assess.report.word.writer import write_word

            write_word(job.content, path, job.options, job.progress)
        else:
            from assess.report import data

            if self.key == "parquet":
                job.progress.wait_for(lambda: data.write_parquet(job.results, path))
            else:
                (data.write_csv if self.key == "csv" else data.write_npz)(job.results, path, job.progress)


FORMATS: Mapping[str, Format] = {
    one.key: one for one in (
        Format(key="pdf", file="report.pdf", edition="client"),
        Format(key="annex", file="annex.pdf", edition="annex", is_default=False),
        Format(key="work", file="work.pdf", edition="work", is_default=False),
        Format(key="xlsx", file="report.xlsx"),
        Format(key="html", file="report.html"),
        Format(key="json", file="results.json"),
        Format(key="csv", file="items.csv"),
        Format(key="docx", file="report.docx", is_default=False, extra="word",
               needs={"docx": "python-docx", "pypdfium2": "pypdfium2"}),
        Format(key="npz", file="outcomes.npz", is_default=False),
        Format(key="parquet", file="items.parquet", is_default=False, extra="parquet", needs={"duckdb": "duckdb"}),
    )
}  # fmt: skip
FILES: Mapping[str, str] = {one.key: one.file for one in FORMATS.values()}
DEFAULT = tuple(one.key for one in FORMATS.values() if one.is_default)
ALL = "all"  # in place of formats: every one, of those that need more packages where these are installed
