"""One set of reports that is written: what every format reads."""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from assess.progress import Progress
from assess.report.ownership import DATA
from assess.report.report_options import ReportOptions
from assess.results import Results

if TYPE_CHECKING:
    from assess.report.content import Content
    from assess.report.pages.pdf import Layout


@dataclass(frozen=True)
class Job:
    """One set of reports that is written; the content is built once for all of them."""

    results: Results
    options: ReportOptions
    progress: Progress
    stage: Path
    listed: dict[str, str | None] = field(default_factory=dict)
    """The files of the run but for results.json, with their SHA-256; None of one that carries results.json."""

    layouts: dict[str, "Layout"] = field(default_factory=dict)
    """The PDFs that were begun, by the names of their files."""

    @property
    def data(self) -> Path:
        """results.json as it stands in the stage."""
        return self.stage / DATA

    @property
    def written(self) -> list[str]:
        """The names of the files of the run."""
        return [*self.listed, DATA]

    @cached_property
    def content(self) -> "Content":
        """What HTML, PDF and Excel show, in the language of the reports."""
        from assess.report.content import Content

        return self.progress.wait_for(lambda: Content(self.results))

    def write_data(self) -> None:
        """Write results.json, with the list of the other files."""
        from assess.report.data import write_json

        write_json(self.results, self.data, self.progress, files=dict(sorted(self.listed.items())))
