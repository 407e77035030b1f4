"""Benchmark of a whole report: a PDF of 1,000 items against the sum of its own parts."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from tests.benchmarks.measuring import measure, write_thousand

MOST = 2
"""How many times the sum of its parts a PDF may take."""

IMPORTS = "import numpy, openpyxl, babel.messages.pofile, jinja2.sandbox, matplotlib.figure, weasyprint"
PARTS = """
import json, sys, time
import matplotlib.figure, weasyprint
import assess
from assess.report.fonts import print_fonts
from assess.report.pages import html
from assess.report.pages.pdf_layout import open_page
from assess.report.content import Content
from assess.report.cover import build_document
from assess.report.report_options import ReportOptions
from assess.report.view import View
found = assess.run(sys.argv[1], verify="none")
options, content = ReportOptions(), Content(found)
with options.spoken():
    start = time.perf_counter()
    build_document(View(content=content, for_print=True))
    figures = time.perf_counter() - start
    page = html.render(content, options, for_print=True)
start = time.perf_counter()
open_page(page, print_fonts()).write_pdf(pdf_variant="pdf/a-3u", pdf_tags=True)
print(json.dumps([figures, time.perf_counter() - start]))
"""


def rows(folder: Path) -> Iterator[str]:
    """Yield a table in Markdown; the workbook and its report are written into `folder`."""
    book = write_thousand(folder / "floors.xlsx")
    command = [sys.executable, "-m", "assess", "run", str(book), "--out", str(folder), "--verify", "none"]
    whole, *_ = measure([*command, "--formats", "pdf"])
    imports = min(measure([sys.executable, "-c", IMPORTS])[0] for _ in range(3))
    done = subprocess.run([sys.executable, "-c", PARTS, str(book)], check=True, capture_output=True, text=True)
    figures, layout = json.loads(done.stdout.splitlines()[-1])
    ratio = whole / (imports + figures + layout)
    yield "| 1,000 items, pdf | imports [s] | figures [s] | layout [s] | sum of these | whole process | ratio | aim |"
    yield "|---|---|---|---|---|---|---|---|"
    yield (f"| parts alone | {imports:.1f} | {figures:.1f} | {layout:.1f} | {imports + figures + layout:.1f} | "
           f"{whole:.1f} | {ratio:.2f} | at most {MOST} |")  # fmt: skip
