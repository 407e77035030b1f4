"""The report's figures, as SVG with their text as outlines: they look the same wherever they are opened."""

import importlib
import math
import re
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from io import BytesIO
from typing import Any

import numpy as np

from assess.i18n import spoken
from assess.progress import ASKED_EVERY, SILENT, Progress
from assess.report import words
from assess.report.blocks import Figure, Image, Words
from assess.report.embedded import data_uri
from assess.report.fonts import figure_families, find_undrawn, replace_signs
from assess.risk import RiskClass

MOST_POINTS = 1500
_UNDATED = {"svg": ("Date", "Creator"), "pdf": ("CreationDate", "Creator", "Producer"), "png": ("Software",)}
"""What is left out of each kind of file, so that the same figure has the same bytes."""
_STYLE: dict[Any, Any] = {
    "svg.hashsalt": "assess", "svg.fonttype": "path", "hatch.linewidth": 0.5,
    "font.size": 8, "axes.titlesize": 8.5, "axes.labelsize": 8, "axes.edgecolor": "#767c82", "axes.linewidth": 0.6,
    "axes.spines.top": False, "axes.spines.right": False, "xtick.color": "#767c82", "ytick.color": "#767c82",
    "xtick.labelcolor": "#1c1c1c", "ytick.labelcolor": "#1c1c1c", "xtick.major.width": 0.6,
    "ytick.major.width": 0.6, "xtick.labelsize": 7.5, "ytick.labelsize": 7.5, "legend.fontsize": 7.5,
    "grid.color": "#dfe3e6", "grid.linewidth": 0.5,
}  # fmt: skip
"""Of every figure, in the report's face: thin grey axes without a box, a light grid."""
_PATH, _DIGITS = re.compile(rb'(?<= d=")[^"]+'), re.compile(rb"(\.\d\d)\d+")
_DRAWING = threading.Lock()
"""One figure at a time: while one is drawn, defaults of matplotlib are set, and then set back."""


def draw(
    width: float, height: float, paint: Callable[[Any], None], kind: str = "svg", progress: Progress = SILENT
) -> bytes:
    """Draw one figure [inches] and return it as "svg", "pdf" or "png".

    Numbers along the axes are written as the language in use writes them; a character without a glyph shows as �.
    It can be cancelled with each object put into it, and before each panel is laid out and drawn. It is not made in a
    thread that is left behind, as the defaults of matplotlib have to be set back by then.
    """
    for name in ("font_manager", "backends.backend_svg", "figure"):  # its fonts are listed, what writes SVG is loaded
        progress.wait_for(partial(importlib.import_module, f"matplotlib.{name}"))
    import matplotlib as mpl

    with one_at_a_time(progress), mpl.rc_context({**_STYLE, "font.family": list(figure_families())}):
        figure = mpl.figure.Figure(figsize=(width, height), layout="constrained")
        figure.stale_callback = lambda *_: progress.check()  # called with each object put into it
        paint(figure)
        for one in figure.findobj(mpl.text.Text):
            if missing := find_undrawn(one.get_text()):
                one.set_text(replace_signs(one.get_text(), missing))
        say = spoken().number
        if say("1.5") != "1.5":  # along axes, but for ticks with words; those that share a scale share its formatter
            from matplotlib.ticker import LogFormatter, ScalarFormatter

            formatters = [axis.get_major_formatter() for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)]
            numbers = [one for one in formatters if isinstance(one, (ScalarFormatter, LogFormatter))]
            numeric: dict[int, Any] = {id(one): one for one in numbers}
            for shared in numeric.values():
                shared.format_ticks = lambda values, ticks=shared.format_ticks: [say(text) for text in ticks(values)]
        file = BytesIO()
        figure.savefig(file, format=kind, dpi=150, metadata=dict.fromkeys(_UNDATED[kind]))
    progress.check()
    drawn = file.getvalue()
    if kind == "svg":  # paths to hundredths of a point: curves take half the bytes
        drawn = _PATH.sub(lambda path: _DIGITS.sub(rb"\1", path[0]), drawn)
    return drawn


@contextmanager
def one_at_a_time(progress: Progress) -> Iterator[None]:
    """Wait until no other figure is drawn; CancelledError."""
    while not _DRAWING.acquire(timeout=ASKED_EVERY):
        progress.check()
    try:
        yield
    finally:
        _DRAWING.release()


def build_figure(drawing: bytes, alternative: str, caption: Words = "") -> Figure:
    """Return a drawing in SVG as a figure of a document."""
    return Figure(Image(data_uri(drawing, "image/svg+xml"), alternative), caption)


HATCHES = {RiskClass.LOW: "", RiskClass.MEDIUM: r"\\", RiskClass.HIGH: "//", RiskClass.VERY_HIGH: ""}


def label(text: str, longest: int = 28) -> str:
    """Return a text of the workbook for a figure: short, and not taken for mathematics."""
    return words.cut(text, longest).replace("$", r"\$")


def thin_out(times: Any, values: Any, most: int = MOST_POINTS) -> tuple[Any, Any]:
    """Thin a long curve out to the lowest and highest point of each stretch, so that no peak is lost, and its end."""
    stretch = math.ceil(values.size / (most / 2))
    if stretch <= 2:
        return times, values
    whole = np.pad(values, (0, -values.size % stretch), mode="edge").reshape(-1, stretch)
    starts = np.arange(len(whole)) * stretch
    extremes = np.concatenate([starts + whole.argmin(axis=1), starts + whole.argmax(axis=1), [values.size - 1]])
    kept = np.unique(np.minimum(extremes, values.size - 1))
    return times[kept], values[kept]
