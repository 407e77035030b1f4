"""Equations drawn by matplotlib's mathtext as small SVG pictures, as large as the text around them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from assess.progress import SILENT
from assess.report.figures.draw import one_at_a_time

UNITS = 100
"""Size of the letters in a picture [units]: what `matplotlib.textpath.TextToPath` draws them in."""
MARGIN = 3
"""Around an equation [units]."""
INK = "#1c1c1c"
FACE = "stix"
"""STIX, a face for mathematics that matplotlib brings along."""
ENLARGED = 1.06
"""By how much its letters are enlarged, so that they look as large as those of the text."""
_LETTERS = {1: "M", 2: "L", 3: "Q", 4: "C", 79: "Z"}
"""What SVG calls the codes of `matplotlib.path.Path`."""
_POINTS = {1: 1, 2: 1, 3: 2, 4: 3, 79: 1}
"""How many points each of them takes."""


@dataclass(frozen=True, slots=True)
class MathFigure:
    """An equation as a picture: SVG, and its width, height and what of that is below the line of writing, in em."""

    svg: str
    width: float
    height: float
    depth: float


@cache
def draw_math(tex: str) -> MathFigure:
    """Return an equation, given in the TeX that mathtext reads, as a picture.

    Raises
    ------
    ValueError
        If it is no TeX that mathtext reads.
    """
    from matplotlib import rc_context
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    face, text = FontProperties(size=UNITS, math_fontfamily=FACE), f"${tex}$"
    with one_at_a_time(SILENT), rc_context({"mathtext.default": "it"}):
        width, height, depth, *_ = text_to_path.mathtext_parser.parse(text, text_to_path.DPI, face)
        glyphs, shapes, rules = text_to_path.get_glyphs_mathtext(face, text)
    names = {name: f"g{at}" for at, name in enumerate(shapes)}
    defined = "".join(f'<path id="{names[name]}" d="{_write_path(*shape)}"/>' for name, shape in shapes.items())
    used = "".join(_place(names[name], x, y, size) for name, x, y, size in glyphs)
    ruled = "".join(f'<path d="{_write_path(*rule)}"/>' for rule in rules)
    box = [-MARGIN, -(height - depth) - MARGIN, width + 2 * MARGIN, height + 2 * MARGIN]
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{" ".join(f"{one:.0f}" for one in box)}" fill="{INK}">'
        f"<defs>{defined}</defs>{used}{ruled}</svg>"
    )
    em = UNITS / ENLARGED
    return MathFigure(svg, box[2] / em, box[3] / em, (depth + MARGIN) / em)


def _place(name: str, x: float, y: float, size: float) -> str:
    """Return a letter at its place; coordinates of matplotlib run upwards."""
    if abs(size - 1) < 0.001:
        return f'<use href="#{name}" x="{x:.0f}" y="{-y:.0f}"/>'
    return f'<use href="#{name}" transform="translate({x:.0f} {-y:.0f})scale({size:.2g})"/>'


def _write_path(points: Sequence[Any], codes: Sequence[int]) -> str:
    """Return a path as SVG has it, y downwards, in whole units: a hundredth of a letter's size."""
    parts, at = [], 0
    while at < len(codes):
        code, count = int(codes[at]), _POINTS[int(codes[at])]
        numbers = [f"{round(value)}" for x, y in points[at : at + count] for value in (x, -y)]
        parts.append(_LETTERS[code] + ("" if code == 79 else " ".join(numbers)))
        at += count
    return "".join(parts)
