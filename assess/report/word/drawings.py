"""What a page draws, as pictures for Word: laid out as the PDF lays it out, one drawing a page, and made points."""

import base64
import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from xml.etree import ElementTree

from assess.delivery.folders import private_folder
from assess.progress import Progress
from assess.report.blocks import Image

WIDEST, TALLEST = 166.0, 150.0
"""Largest size of a picture [mm]: a page of A4 has room for it with its heading, its caption and a short table."""
LEAST = 3.0
"""Least side of a picture [mm]."""
MILLIMETRES = {"": 25.4 / 96, "px": 25.4 / 96, "pt": 25.4 / 72, "mm": 1.0, "cm": 10.0, "in": 25.4}
"""Units of sizes in SVG and CSS [mm]."""
POINTS = 220 / 72
"""Pixels per point of the page: 220 dpi, which prints sharply."""
WIDE_FROM = 60.0
"""Width [mm] from which a drawing is no sign within a line, but fills the page's width."""
_SIZE = re.compile(r"\s*([\d.]+)\s*([a-z]*)\s*$", re.IGNORECASE)
_CORNERS = ("top-left", "top-center", "top-right", "bottom-left", "bottom-center", "bottom-right")


@dataclass(frozen=True, slots=True)
class Drawing:
    """A drawing of the page as SVG, with its size on paper [mm] and what it says in words."""

    svg: str
    width: float
    height: float
    alternative: str


def measure(image: Image) -> Drawing:
    """Return a drawing with its size: that which it states, else that of its view box in pixels."""
    svg = image.source
    if not image.is_drawn:
        svg = base64.b64decode(svg.partition(",")[2]).decode()
        svg = svg[svg.index("<svg") :]
    root = ElementTree.fromstring(_declare(svg))  # noqa: S314 - drawn by this program
    box = [float(one) for one in (root.get("viewBox") or "0 0 100 100").split()]
    stated = [_SIZE.match(root.get(name) or "") for name in ("width", "height")]
    width, height = (
        (float(one[1]) * MILLIMETRES.get(one[2].lower(), 0.0) if one else 0.0) or side * MILLIMETRES[""]
        for one, side in zip(stated, box[2:], strict=True)
    )
    if width >= WIDE_FROM:
        scale = min(WIDEST / width, TALLEST / height)
        width, height = scale * width, scale * height
    title = root.find("{*}title")
    words = image.alternative or root.get("aria-label") or (title.text if title is not None else "") or ""
    return Drawing(svg, max(width, LEAST), max(height, LEAST), words)


def _declare(svg: str) -> str:
    """Return the text of an inline drawing as a document of its own, which states its namespaces."""
    own = svg[: svg.index(">")]
    for name, space in (("xmlns:xlink", "http://www.w3.org/1999/xlink"), ("xmlns", "http://www.w3.org/2000/svg")):
        if f"{name}=" not in own:
            svg = svg.replace("<svg", f'<svg {name}="{space}"', 1)
    return svg


def draw_all(drawings: Sequence[Drawing], style: str, progress: Progress) -> list[bytes]:
    """Return the drawings as PNG, drawn with a style; raises PdfUnavailableError and CancelledError."""
    if not drawings:
        return []
    from assess.report.pages.pdf import start_layout

    empty, rules, sheets = " ".join(f"@{corner} {{ content: none }}" for corner in _CORNERS), [], []
    for at, one in enumerate(drawings):  # each on a sheet of its own size
        width, height = f"{one.width:.3f}mm", f"{one.height:.3f}mm"
        rules.append(f"@page d{at} {{ size: {width} {height}; margin: 0; {empty} }}")
        size = f"width:{width};height:{height}"
        look = f"{size};max-width:none;max-height:none;display:block;margin:0"
        has_style = any(mark in one.svg for mark in ("@font-face", "<style"))
        if has_style or "style=" in one.svg[: one.svg.index(">")]:
            coded = base64.b64encode(_declare(one.svg).encode()).decode()
            shown = f'<img alt="" style="{look}" src="data:image/svg+xml;base64,{coded}">'
        else:
            shown = one.svg.replace("<svg", f'<svg style="{escape(look)}"', 1)
        sheets.append(f'<div style="page:d{at};break-after:page;{size};overflow:hidden">{shown}</div>')
    styles = f"<style>{style}</style><style>{' '.join(rules)} body {{ margin: 0 }}</style>"
    head = f"<head><meta charset='utf-8'>{styles}</head>"
    page = f"<!DOCTYPE html><html lang='en'>{head}<body>{''.join(sheets)}</body></html>"
    with private_folder("assess-page-") as folder:
        path = folder / "drawings.pdf"
        with start_layout(page) as layout:
            layout.finish(path, progress=progress)
        return progress.wait_for(lambda: _read_pictures(path))


def _read_pictures(path: Path) -> list[bytes]:
    import io

    import pypdfium2

    pictures, document = [], pypdfium2.PdfDocument(path)
    try:
        for page in document:
            file = io.BytesIO()
            page.render(scale=POINTS).to_pil().save(file, "PNG", optimize=True)
            pictures.append(file.getvalue())
    finally:
        document.close()
    return pictures
