"""The Word edition of the client's report: the same page as report.pdf, as paragraphs, tables and pictures to edit."""

from pathlib import Path

from assess.progress import SILENT, Progress
from assess.report.content import Content
from assess.report.report_options import ReportOptions


def write_word(content: Content, path: Path, options: ReportOptions, progress: Progress = SILENT) -> None:
    """Write report.docx: the client's edition.

    Raises InputError if a package or a template cannot be used; PdfUnavailableError if the native libraries that draw
    plans and charts are missing; OSError if the file cannot be written; CancelledError if the work was cancelled;
    nothing is written.
    """
    from assess.report.cover import build_document
    from assess.report.pages.html import build_style
    from assess.report.view import View
    from assess.report.word.document import Word
    from assess.report.word.writer import WordWriter

    view = View(content=content, edition="client", for_print=True, options=options, progress=progress)
    document = progress.wait_for(lambda: build_document(view))
    word = Word(document, options.spoken_language, progress)
    WordWriter(word).write(document, build_style(options, True, "edition.css"))
    word.save(path)
