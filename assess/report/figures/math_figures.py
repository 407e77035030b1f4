"""Equations drawn by matplotlib's mathtext as small SVG pictures, as large as the text around them.

What is drawn is kept for the next process: most equations are those of the methods, and a hundred take two seconds.
"""

import contextlib
import hashlib
import importlib.metadata
import json
import os
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

from assess.compiled import cache_folder, examine_folder
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
MOST_KEPT = 1000
"""Equations that are kept, 3 kB each: those of the methods, and of some worked examples."""
_UNNAMED = re.compile(r"[^A-Za-z0-9]+")
_CODES = {1: ("M", 1), 2: ("L", 1), 3: ("Q", 2), 4: ("C", 3), 79: ("Z", 1)}
"""What SVG calls the codes of `matplotlib.path.Path`, and how many points each takes."""


@dataclass(frozen=True, slots=True)
class MathFigure:
    """An equation as a picture.

    * `letters`: the outline of each letter as an SVG path, by a name that is the same in every equation.
    * `placed`: SVG elements that use the letters, and rules.
    * `box`: left, top, width and height [units].
    * `depth`: what of the height is below the line of writing [units].
    """

    letters: Mapping[str, str]
    placed: str
    box: tuple[float, float, float, float]
    depth: float

    @property
    def view(self) -> str:
        """The viewBox."""
        return " ".join(f"{one:.0f}" for one in self.box)

    @property
    def style(self) -> str:
        """The measures in em of the text around it."""
        width, height, depth = (value * ENLARGED / UNITS for value in (*self.box[2:], self.depth))
        return f"width: {width:.2f}em; aspect-ratio: {width:.2f} / {height:.2f}; vertical-align: {-depth:.2f}em"


def write_letters(letters: Mapping[str, str]) -> str:
    """Return the outlines of letters as SVG definitions, which equations use."""
    outlines = [f'<path id="{name}" d="{path}"/>' for name, path in letters.items()]
    return f"<defs>{''.join(outlines)}</defs>"


@cache
def draw_math(tex: str) -> MathFigure:
    """Return an equation, given in TeX, as a picture; ValueError if mathtext cannot read it."""
    folder = cache_folder() / "equations"
    drawn_by = f"{FACE} {MARGIN} {importlib.metadata.version('matplotlib')} {tex}"
    name = hashlib.sha256(drawn_by.encode()).hexdigest()[:32]
    place = None if examine_folder(folder) else folder / f"{name}.json"  # of a folder that others could change
    with contextlib.suppress(OSError, ValueError, TypeError, LookupError):  # none is kept, or a damaged one
        kept: Any = json.loads(place.read_text(encoding="utf-8")) if place else None
        return MathFigure(**{**kept, "box": tuple(map(float, kept["box"]))})
    drawn = _draw(tex)
    with contextlib.suppress(OSError):
        if place and len(list(place.parent.iterdir())) < MOST_KEPT:
            new = place.with_suffix(f".{os.getpid()}")
            new.write_text(json.dumps(asdict(drawn)), encoding="utf-8")
            new.replace(place)
    return drawn


def _draw(tex: str) -> MathFigure:
    from matplotlib import rc_context, rcParamsDefault
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    face, text = FontProperties(size=UNITS, math_fontfamily=FACE), f"${tex}$"
    with one_at_a_time(SILENT), rc_context({"mathtext.default": rcParamsDefault["mathtext.default"]}):
        width, height, depth, *_ = text_to_path.mathtext_parser.parse(text, text_to_path.DPI, face)
        glyphs, shapes, rules = text_to_path.get_glyphs_mathtext(face, text)
    names = {shape: _UNNAMED.sub("-", f"math-{shape}") for shape in shapes}
    placed = []
    for shape, x, y, size in glyphs:  # coordinates of matplotlib run upwards
        where = f'x="{x:.0f}" y="{-y:.0f}"'
        if abs(size - 1) >= 0.001:
            where = f'transform="translate({x:.0f} {-y:.0f})scale({size:.2g})"'
        placed.append(f'<use href="#{names[shape]}" {where}/>')
    placed += [f'<path d="{_write_path(*rule)}"/>' for rule in rules]
    return MathFigure(
        letters={names[shape]: _write_path(*outline) for shape, outline in shapes.items()},
        placed="".join(placed),
        box=(-MARGIN, -(height - depth) - MARGIN, width + 2 * MARGIN, height + 2 * MARGIN),
        depth=depth + MARGIN,
    )


def _write_path(points: Any, codes: Any) -> str:
    """Return a path as SVG has it, y downwards, in whole units: a hundredth of a letter's size."""
    parts, at = "", 0
    while at < len(codes):
        letter, count = _CODES[int(codes[at])]
        numbers = [f"{round(value)}" for x, y in points[at : at + count] for value in (x, -y)]
        parts += letter + ("" if letter == "Z" else " ".join(numbers))
        at += count
    return parts
