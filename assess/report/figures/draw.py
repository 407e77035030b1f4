"""The report's figures, as SVG with their text as outlines: they look the same wherever they are opened."""

import math
import re
import warnings
from collections.abc import Callable
from functools import partial
from io import BytesIO
from typing import Any

import numpy as np

from assess.demand import Demand
from assess.language import gettext as _
from assess.language import spoken
from assess.report import words
from assess.risk import RiskClass
from assess.units import ACCELERATION

MOST_POINTS = 1500
_UNDATED = {"svg": ("Date", "Creator"), "pdf": ("CreationDate", "Creator", "Producer"), "png": ("Software",)}
"""What is left out of each kind of file, so that the same figure has the same bytes."""


def draw(width: float, height: float, paint: Callable[[Any], None], kind: str = "svg") -> bytes:
    """Draw one figure [inches] and return it as "svg", "pdf" or "png"; nothing global of matplotlib is touched.

    Numbers along the axes are written as the language in use writes them.
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    style = mpl.rc_context({"svg.hashsalt": "assess", "svg.fonttype": "path", "font.size": 8, "hatch.linewidth": 0.5})
    with style, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing")  # a character without a glyph shows as a box
        figure = Figure(figsize=(width, height), layout="constrained")
        paint(figure)
        _write_numbers(figure)
        file = BytesIO()
        figure.savefig(file, format=kind, dpi=150, metadata=dict.fromkeys(_UNDATED[kind]))
    return _shorten(file.getvalue()) if kind == "svg" else file.getvalue()


def _write_numbers(figure: Any) -> None:
    """Have numbers along axes written as the language in use does; ticks with words are as they were set."""
    from matplotlib.ticker import LogFormatter, ScalarFormatter

    if spoken().number("1.5") == "1.5":
        return
    formatters = [axis.get_major_formatter() for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)]
    numeric: dict[int, Any] = {id(one): one for one in formatters if isinstance(one, (ScalarFormatter, LogFormatter))}
    for formatter in numeric.values():  # axes that share a scale share its formatter
        formatter.format_ticks = partial(_write_ticks, formatter.format_ticks, spoken().number)


def _write_ticks(write: Callable[[Any], list[str]], say: Callable[[str], str], values: Any) -> list[str]:
    return [say(text) for text in write(values)]


_PATH, _DIGITS = re.compile(rb'(?<= d=")[^"]+'), re.compile(rb"(\.\d\d)\d+")


def _shorten(svg: bytes) -> bytes:
    """Cut the coordinates of paths to hundredths of a point, which nobody sees: curves take half the bytes."""
    return _PATH.sub(lambda path: _DIGITS.sub(rb"\1", path[0]), svg)


HATCHES = {RiskClass.LOW: "", RiskClass.MEDIUM: r"\\", RiskClass.HIGH: "//", RiskClass.VERY_HIGH: ""}


def label(text: str, longest: int = 28) -> str:
    """Return a text of the workbook for a figure: short, and not taken for mathematics."""
    return words.cut(text, longest).replace("$", r"\$")


def draw_motion(demand: Demand) -> bytes:
    """Draw the treated acceleration of a recorded motion."""
    return draw(7, 1.6, partial(_paint_motion, demand))


def _paint_motion(demand: Demand, figure: Any) -> None:
    motion = demand.motion
    if motion is None:
        raise ValueError("the demand has no motion to draw")
    axes = figure.subplots()
    values = motion.acceleration / ACCELERATION["g"]
    times = np.arange(values.size) * motion.time_step
    times, values = thin_out(times, values)
    axes.plot(times, values, lw=0.5, color="#1f3a4d")
    peak = int(np.abs(values).argmax())
    axes.plot([times[peak]], [values[peak]], "o", ms=4, mfc="none", color="#8c1d3f")
    axes.annotate(_("PFA {pfa:.3f} g", pfa=abs(values[peak])), (times[peak], values[peak]), xytext=(6, 0),
                  textcoords="offset points", fontsize=7, va="center")  # fmt: skip
    axes.set_xlabel(_("time [s]"))
    axes.set_ylabel(_("acceleration [g]"))
    axes.margins(x=0.01)
    axes.spines[["top", "right"]].set_visible(False)


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
