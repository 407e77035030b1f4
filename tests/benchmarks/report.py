"""Benchmark of whole reports: the example with all its figures, 1,000 items, and the PDF against its own parts."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pypdfium2

from assess.workbook.template import Content, write_workbook
from tests.benchmarks.measuring import measure

ROOT = Path(__file__).parents[2]
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
from assess.report.content import build_content
from assess.report.cover import build_document
from assess.report.report_options import ReportOptions
from assess.report.view import View
found = assess.run(sys.argv[1], verify="none")
options, content = ReportOptions(), build_content(found)
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
    """Yield tables in Markdown; workbooks and reports are written into `folder`."""
    assess = str(Path(sys.executable).with_name("assess"))
    market, thousand = ROOT / "inventories" / "market-street.xlsx", write_thousand(folder / "floors.xlsx")
    yield "| one report, whole process | seconds | peak memory [MB] | pages |"
    yield "|---|---|---|---|"
    for name, book, options in (
        ("121 items, verified, all formats", market, []),
        ("121 items, not verified, all formats", market, ["--verify", "none"]),
        ("1,000 items on 10 floors, not verified, all formats", thousand, ["--verify", "none"]),
        ("1,000 items on 10 floors, not verified, pdf", thousand, ["--verify", "none", "--formats", "pdf"]),
    ):
        out = folder / "report"
        seconds, _, peak = measure([assess, "run", str(book), "--out", str(out), *options])
        yield f"| {name} | {seconds:.1f} | {peak:.0f} | {len(pypdfium2.PdfDocument(out / 'report.pdf'))} |"
    yield ""
    yield from _of_parts(seconds, thousand)


def _of_parts(whole: float, book: Path) -> Iterator[str]:
    """Yield how the time of the last report compares with those of its parts measured alone."""
    imports = min(measure([sys.executable, "-c", IMPORTS])[0] for _ in range(3))
    done = subprocess.run([sys.executable, "-c", PARTS, str(book)], check=True, capture_output=True, text=True)
    figures, layout = json.loads(done.stdout.splitlines()[-1])
    ratio = whole / (imports + figures + layout)
    yield "| 1,000 items, pdf | imports [s] | figures [s] | layout [s] | sum of these | whole process | ratio | aim |"
    yield "|---|---|---|---|---|---|---|---|"
    yield (f"| parts alone | {imports:.1f} | {figures:.1f} | {layout:.1f} | {imports + figures + layout:.1f} | "
           f"{whole:.1f} | {ratio:.2f} | at most {MOST} |")  # fmt: skip


def write_thousand(path: Path, count: int = 1000, floors: int = 10) -> Path:
    """Write a workbook of `count` pieces on as many floors, half of them with a position on the plan."""
    kinds = ("Bookcase", "Filing cabinet with four drawers", "Server rack in the corner", "Wardrobe", "Display cabinet")
    levels = [
        {"floor": str(at), "elevation": 3.5 * at, "pfa_x": 0.12 + 0.03 * at, "pfv_x": 18.0 + 4 * at, "pfa_y": 0.3}
        for at in range(1, floors + 1)
    ]
    pieces = [
        {"item": f"P{at:04d}", "floor": str(1 + at % floors), "room": f"Room {at % 23}",
         "description": kinds[at % len(kinds)], "breadth": 28 + at % 37, "width": 90, "height": 110 + at % 97,
         "axis": "XY"[at % 2], "anchored": "yes" if at % 11 == 0 else "no",
         "x": float(at * 7 % 31) if at % 20 < 10 else None, "y": float(at * 3 % 23) if at % 20 < 10 else None}
        for at in range(count)
    ]  # fmt: skip
    write_workbook(path, Content(rows={"Building": [{"building": "Ten floors"}], "Floors": levels, "Items": pieces}))
    return path
