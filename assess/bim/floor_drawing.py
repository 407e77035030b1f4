"""The plan of a storey as an SVG: walls, windows, doors and rooms, in metres, to lie under the pieces of a report."""

import math
import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, count

from assess.bim.building_model import Area, BuildingModel, Point, Storey
from assess.bim.plan_shapes import direction_of

MARGIN = 0.5  # room round what is drawn [m]
LONGEST_NAME = 60  # characters of the name of a plan's file
STYLE = (
    ".wall{fill:#4d4d4d;stroke:#333}.window{fill:#cfe3ef;stroke:#4a7d9b}.room{fill:none;stroke:#bbb}"
    ".door{fill:none;stroke:#8a5a00}"
)
LINE = 0.02  # width of lines [m]
_HEAD = re.compile(rb'<svg xmlns="http://www\.w3\.org/2000/svg" viewBox="0 0 [\d.]+ [\d.]+"><style>\.wall\{')


def draw_storey(model: BuildingModel, storey: Storey) -> tuple[bytes, dict[str, float]] | None:
    """Return the plan of a storey as an SVG, and the fields of Floors that place it [m]; None if nothing is known."""
    walls, windows = model.walls.get(storey.key, ()), model.windows.get(storey.key, ())
    rooms = [one.area for one in model.spaces if one.storey == storey.key]
    doors = []
    for one in (one for one in model.doors if one.storey == storey.key):
        dx, dy = (part * one.width / 2 for part in direction_of(one.normal_deg + 90))
        doors.append(((one.x - dx, one.y - dy), (one.x + dx, one.y + dy)))
    points = [point for ring in (*(area[0] for area in (*walls, *windows, *rooms)), *doors) for point in ring]
    if not points:
        return None
    for piece in (one for one in model.pieces if one.storey == storey.key):
        reach = math.hypot(piece.breadth, piece.width) / 2
        points += [(piece.x - reach, piece.y - reach), (piece.x + reach, piece.y + reach)]
    (left, bottom), (right, top) = (tuple(end(axis) for axis in zip(*points, strict=True)) for end in (min, max))
    left, bottom = (math.floor(100 * (one - MARGIN)) / 100 for one in (left, bottom))
    width, height = math.ceil(100 * (right + MARGIN - left)) / 100, math.ceil(100 * (top + MARGIN - bottom)) / 100

    def line(points: Sequence[Point]) -> str:
        """Return a line as path data; Y of the SVG runs downwards from the top."""
        numbers = chain.from_iterable((x - left, bottom + height - y) for x, y in points)
        return "M" + " ".join(f"{number:.3f}".rstrip("0").rstrip(".") for number in numbers)

    def path(area: Area) -> str:
        return "".join(f"{line(ring)}Z" for ring in area)

    parts = [
        *(f'<path class="room" d="{path(one[:1])}"/>' for one in rooms),
        *(f'<path class="window" d="{path(one)}"/>' for one in windows),
        *(f'<path class="wall" fill-rule="evenodd" d="{path(one)}"/>' for one in walls),
        *(f'<path class="door" d="{line(one)}"/>' for one in doors),
    ]
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.3f} {height:.3f}"><style>{STYLE}</style>'
    svg = f'{head}<g stroke-width="{LINE}">{"".join(parts)}</g></svg>\n'
    return svg.encode(), {"plan_left": left, "plan_bottom": bottom, "plan_width": width}


def is_drawn(data: bytes) -> bool:
    """Tell whether a file begins as `draw_storey` begins a plan: programs that save a plan begin it otherwise."""
    return _HEAD.match(data) is not None


def name_plan(source: str, storey: str) -> str:
    """Return the name of a plan's file: of the model and its storey, in letters that every system takes."""
    stem = re.sub(r"\.[^.]*$", "", source)
    plain = unicodedata.normalize("NFKD", f"{stem} {storey}").encode("ascii", "ignore").decode()
    return (re.sub(r"[^A-Za-z0-9]+", "-", plain).strip("-")[:LONGEST_NAME].strip("-") or "plan") + ".svg"


def name_plans(source: str, storeys: Iterable[str]) -> list[str]:
    """Return the names of the plans of storeys, each its own in any letter case: ``a-1.svg``, ``a-1-2.svg``."""
    found: list[str] = []
    taken: set[str] = set()
    for storey in storeys:
        found.append(next(one for one in number_plan(name_plan(source, storey)) if one.casefold() not in taken))
        taken.add(found[-1].casefold())
    return found


def number_plan(name: str) -> Iterator[str]:
    """Yield the name of a plan, then the same with numbers: ``a-1.svg``, ``a-1-2.svg``."""
    yield name
    yield from (f"{name.removesuffix('.svg')}-{number}.svg" for number in count(2))
