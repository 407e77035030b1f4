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
from pathlib import Path
from typing import Any

from assess.cache_folder import cache_folder, examine_folder
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
_LETTERS = {1: "M", 2: "L", 3: "Q", 4: "C", 79: "Z"}
"""What SVG calls the codes of `matplotlib.path.Path`."""
_POINTS = {1: 1, 2: 1, 3: 2, 4: 3, 79: 1}
"""How many points each of them takes."""


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

    def write_alone(self) -> str:
        """Return it as an SVG file, with its letters."""
        head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{self.view}" fill="{INK}">'
        return f"{head}{write_letters(self.letters)}{self.placed}</svg>"


def write_letters(letters: Mapping[str, str]) -> str:
    """Return the outlines of letters as SVG definitions, which equations use."""
    outlines = [f'<path id="{name}" d="{path}"/>' for name, path in letters.items()]
    return f"<defs>{''.join(outlines)}</defs>"


@cache
def draw_math(tex: str) -> MathFigure:
    """Return an equation, given in the TeX that mathtext reads, as a picture.

    Raises ValueError if it is no TeX that mathtext reads.
    """
    place = _find_place(tex)
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


def _find_place(tex: str) -> Path | None:
    """Return the file that an equation is kept in; None where nothing can be kept, or others could change it."""
    folder = cache_folder() / "equations"
    drawn_by = f"{FACE} {MARGIN} {importlib.metadata.version('matplotlib')} {tex}"
    name = hashlib.sha256(drawn_by.encode()).hexdigest()
    return None if examine_folder(folder) else folder / f"{name[:32]}.json"


def _draw(tex: str) -> MathFigure:
    from matplotlib import rc_context, rcParamsDefault
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    face, text = FontProperties(size=UNITS, math_fontfamily=FACE), f"${tex}$"
    with one_at_a_time(SILENT), rc_context({"mathtext.default": rcParamsDefault["mathtext.default"]}):
        width, height, depth, *_ = text_to_path.mathtext_parser.parse(text, text_to_path.DPI, face)
        glyphs, shapes, rules = text_to_path.get_glyphs_mathtext(face, text)
    names = {shape: _UNNAMED.sub("-", f"math-{shape}") for shape in shapes}
    placed = [_place(names[shape], x, y, size) for shape, x, y, size in glyphs]
    ruled = [f'<path d="{_write_path(*rule)}"/>' for rule in rules]
    return MathFigure(
        letters={names[shape]: _write_path(*outline) for shape, outline in shapes.items()},
        placed="".join([*placed, *ruled]),
        box=(-MARGIN, -(height - depth) - MARGIN, width + 2 * MARGIN, height + 2 * MARGIN),
        depth=depth + MARGIN,
    )


def _place(name: str, x: float, y: float, size: float) -> str:
    """Return a letter at its place; coordinates of matplotlib run upwards."""
    if abs(size - 1) < 0.001:
        return f'<use href="#{name}" x="{x:.0f}" y="{-y:.0f}"/>'
    return f'<use href="#{name}" transform="translate({x:.0f} {-y:.0f})scale({size:.2g})"/>'


def _write_path(points: Any, codes: Any) -> str:
    """Return a path as SVG has it, y downwards, in whole units: a hundredth of a letter's size."""
    parts, at = [], 0
    while at < len(codes):
        code, count = int(codes[at]), _POINTS[int(codes[at])]
        numbers = [f"{round(value)}" for x, y in points[at : at + count] for value in (x, -y)]
        parts.append(_LETTERS[code] + ("" if code == 79 else " ".join(numbers)))
        at += count
    return "".join(parts)
