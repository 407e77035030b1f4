"""The report's figures, as SVG with their text as outlines: they look the same wherever they are opened."""

import math
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from io import BytesIO
from typing import Any

import numpy as np

from assess.demand import Demand
from assess.inventory.model import Inventory
from assess.ranking import count_pieces
from assess.report import words
from assess.report.content import Content, Counts, FloorPage
from assess.results import ItemResult
from assess.risk import RiskClass
from assess.units import ACCELERATION

MOST_BARS = 40
MOST_POINTS = 1500
_UNDATED = {"svg": ("Date", "Creator"), "pdf": ("CreationDate", "Creator", "Producer"), "png": ("Software",)}
"""What is left out of each kind of file, so that the same figure has the same bytes."""


def draw(width: float, height: float, paint: Callable[[Any], None], kind: str = "svg") -> bytes:
    """Draw one figure [inches] and return it as "svg", "pdf" or "png"; nothing global of matplotlib is touched."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    style = mpl.rc_context({"svg.hashsalt": "assess", "svg.fonttype": "path", "font.size": 8})
    with style, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing")  # a character without a glyph shows as a box
        figure = Figure(figsize=(width, height), layout="constrained")
        paint(figure)
        file = BytesIO()
        figure.savefig(file, format=kind, dpi=150, metadata=dict.fromkeys(_UNDATED[kind]))
    return file.getvalue()


def draw_counts(counts: Sequence[Counts], axis_label: str) -> bytes:
    """Draw the pieces of each class as one bar a floor (or room), each class with its hatch and symbol."""
    shown = [one for one in counts if one.total][:MOST_BARS]
    return draw(7, 1.1 + 0.3 * max(1, len(shown)), partial(_paint_counts, shown, axis_label))


_HATCHES = {RiskClass.LOW: "", RiskClass.MEDIUM: "..", RiskClass.HIGH: "//", RiskClass.VERY_HIGH: ""}


def _paint_counts(shown: Sequence[Counts], axis_label: str, figure: Any) -> None:
    axes = figure.subplots()
    left = np.zeros(len(shown))
    for risk in RiskClass:
        values = np.array([one.by_class[risk] for one in shown], dtype=float)
        axes.barh(range(len(shown)), values, left=left, color=risk.fill, hatch=_HATCHES[risk], label=risk.label,
                  edgecolor="#444444", linewidth=0.5)  # fmt: skip
        for at, value in enumerate(values):
            if value:
                axes.text(left[at] + value / 2, at, f"{risk.symbol} {value:g}", ha="center", va="center",
                          color=risk.ink, fontsize=7)  # fmt: skip
        left += values
    anchored = np.array([one.anchored for one in shown], dtype=float)
    if anchored.any():
        axes.barh(
            range(len(shown)), anchored, left=left, color="#d0d0d0", label="anchored", edgecolor="#444444", lw=0.5
        )
    axes.set_yticks(range(len(shown)), [label(one.label) for one in shown])
    axes.invert_yaxis()
    axes.set_xlabel(axis_label)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(ncols=5, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, fontsize=7)


def label(text: str, longest: int = 28) -> str:
    """Return a text of the workbook for a figure: short, and not taken for mathematics."""
    return words.clip(text, longest).split("… (")[0].replace("$", r"\$")


def draw_rooms(page: FloorPage) -> bytes:
    """Draw the pieces of each room of a floor: what is shown where there are no positions."""
    rooms: dict[str, list[ItemResult]] = {}
    for one in page.results:
        rooms.setdefault(one.item.room or "no room named", []).append(one)
    counts = [Counts(room, *count_pieces(results)) for room, results in sorted(rooms.items())]
    return draw_counts(counts, "pieces")


def draw_plan(page: FloorPage, inventory: Inventory) -> bytes:
    """Draw the plan of a floor: every placed piece to scale with its class, the places and the routes between them."""
    points = _points(page, inventory)
    width = max(x for x, _ in points) - min(x for x, _ in points) + 4
    height = max(y for _, y in points) - min(y for _, y in points) + 4
    return draw(7, min(8.5, max(2.5, 7 * height / width)), partial(_paint_plan, page, inventory))


def _points(page: FloorPage, inventory: Inventory) -> list[tuple[float, float]]:
    placed = [(one.item.x, one.item.y) for one in page.results] + [
        (place.x, place.y) for place in inventory.places if place.floor == page.floor.floor
    ]
    return [(x, y) for x, y in placed if x is not None and y is not None]


def _paint_plan(page: FloorPage, inventory: Inventory, figure: Any) -> None:
    axes = figure.subplots()
    places = {place.place: (place.x, place.y) for place in inventory.places
              if place.floor == page.floor.floor and place.x is not None and place.y is not None}  # fmt: skip
    for segment in inventory.routes:
        if segment.start in places and segment.end in places:
            (x0, y0), (x1, y1) = places[segment.start], places[segment.end]
            axes.plot([x0, x1], [y0, y1], color="#2f6f4f", lw=2.5, ls=(0, (4, 1.5)), zorder=1)
    for one in page.results:
        if one.item.x is not None and one.item.y is not None:
            _paint_piece(axes, one)
    for name, (x, y) in places.items():
        axes.plot([x], [y], "o", color="#2f6f4f", ms=4, zorder=4)
        axes.annotate(label(name), (x, y), xytext=(3, 3), textcoords="offset points", fontsize=6, color="#1d4a34")
    axes.set_aspect("equal")
    for limit, values in zip((axes.set_xlim, axes.set_ylim), zip(*_points(page, inventory), strict=True), strict=True):
        limit(min(values) - 2, max(values) + 2)
    axes.set_xlabel("X [m]")
    axes.set_ylabel("Y [m]")
    axes.grid(color="#e4e4e4", lw=0.5)
    axes.set_axisbelow(True)


def _paint_piece(axes: Any, one: ItemResult) -> None:
    from matplotlib.patches import Rectangle

    item, risk = one.item, one.adopted.risk
    along, across = item.breadth, item.width or item.breadth
    angle = item.angle_deg if item.angle_deg is not None else (90.0 if item.axis == "Y" else 0.0)
    turn = math.radians(angle)
    x, y = item.x or 0.0, item.y or 0.0
    corner = (x - (along * math.cos(turn) - across * math.sin(turn)) / 2,
              y - (along * math.sin(turn) + across * math.cos(turn)) / 2)  # fmt: skip
    fill = "#d0d0d0" if one.is_anchored else risk.fill
    axes.add_patch(Rectangle(corner, along, across, angle=angle, facecolor=fill, edgecolor="#222222", lw=0.6, zorder=3))
    if not one.is_anchored:
        axes.text(x, y, risk.symbol, ha="center", va="center", fontsize=5, color=risk.ink, zorder=5)
        _mark(axes, one, x, y, (along, across) if abs(math.cos(turn)) > abs(math.sin(turn)) else (across, along))


def _mark(axes: Any, one: ItemResult, x: float, y: float, size: tuple[float, float]) -> None:
    """Write the marks of a class beside its piece, on the longer side, as pieces stand in rows."""
    marks, is_above = words.class_marks(one), size[0] > size[1]
    place, offset = ((x, y + size[1] / 2), (0, 0.8)) if is_above else ((x + size[0] / 2, y), (1, 0))
    if marks:
        sides = ("center", "bottom") if is_above else ("left", "center")
        mark = axes.annotate(marks, place, xytext=offset, textcoords="offset points", fontsize=5.5, ha=sides[0],
                             va=sides[1], zorder=6)  # fmt: skip
        mark.set_gid("class-marks")


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
    axes.annotate(f"PFA {abs(values[peak]):.3f} g", (times[peak], values[peak]), xytext=(6, 0),
                  textcoords="offset points", fontsize=7, va="center")  # fmt: skip
    axes.set_xlabel("time [s]")
    axes.set_ylabel("acceleration [g]")
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


def draw_all(content: Content) -> dict[str, bytes]:
    """Draw every figure of a report, by the name that the template asks for."""
    figures = {"counts": draw_counts([*content.by_floor], "pieces")} if content.total.total else {}
    for at, page in enumerate(content.floors):
        if page.placed:
            figures[f"plan-{at}"] = draw_plan(page, content.assessment.inventory)
        elif page.results:
            figures[f"rooms-{at}"] = draw_rooms(page)
        for which, demand in enumerate(page.demands):
            if demand.motion is not None and not demand.is_borrowed:
                figures[f"motion-{at}-{which}"] = draw_motion(demand)
    return figures
