"""Results in a notebook: pandas tables, and short views in HTML."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

from assess.errors import Problem
from assess.fields import ADOPTED_FIELDS, PIECE_FIELDS, Field, Kind, Shape, case_fields, floor_fields, item_fields
from assess.results import ItemResult, Results
from assess.risk import RiskClass
from assess.route_fields import row_fields
from assess.route_results import RoomRow, RouteRow, SegmentRow

if TYPE_CHECKING:
    import pandas as pd

_DTYPES: Mapping[Kind, str] = {
    "text": "string", "class": "string", "number": "float64", "share": "float64", "count": "Int64", "flag": "boolean",
}  # fmt: skip
"""Of the columns of a table by what a field holds: the same whatever the rows are, also where there are none."""


def build_frame(results: Results, name: str) -> "pd.DataFrame":
    """Return one table of `results` for a notebook: items, cases, floors, segments, routes, rooms or problems."""
    import pandas as pd

    routes = results.route_tables
    tables: Mapping[str, Callable[[], tuple[Iterable[Any], Iterable[Field]]]] = {
        "items": lambda: (results, item_fields(results)),
        "cases": lambda: ((case for one in results for case in one.cases), case_fields(results)),
        "floors": lambda: (results.motions, floor_fields(results)),
        "segments": lambda: (routes.segments, row_fields(SegmentRow)),
        "routes": lambda: (routes.routes, row_fields(RouteRow)),
        "rooms": lambda: (routes.rooms, row_fields(RoomRow)),
        "problems": lambda: (results.problem_rows, row_fields(Problem)),
    }
    rows, chosen = tables[name]()
    shape = Shape(chosen)
    flat = [shape.flatten(row) for row in rows]
    types = {one.key: _DTYPES.get(one.kind, "object") for one in shape.fields}
    return pd.DataFrame({key: pd.Series([row[key] for row in flat], dtype=one) for key, one in types.items()})


# ---------------------------------------------------------------- for a notebook


def results_html(results: Results, most: int = 10) -> str:
    """Return a short table: pieces by class, and the first rows."""
    words = [risk.word for risk in reversed(RiskClass)]
    counts = dict.fromkeys((*words, "unconfirmed", "by formula only"), 0)
    for one in results:
        if not one.is_anchored:
            counts[one.apart.replace("formula", "by formula only") or one.adopted.risk.word] += one.item.quantity
    classes = ", ".join(f"{word} {count:,}" for word, count in counts.items() if count or word in words)
    head = f"<p>{escape(repr(results))}<br>Free-standing pieces by class: {classes}</p>"
    shown = ("item", "floor", "description", "breadth_cm", "height_cm", "pfa_g", "adopted_probability", "adopted_class")
    chosen = [field for field in item_fields(results) if field.key in shown]
    return head + _html([Shape(chosen).flatten(results.result(at)) for at in range(min(most, len(results)))])


def item_html(one: ItemResult) -> str:
    """Return one row of furniture as a table of two columns."""
    chosen = (*PIECE_FIELDS, *ADOPTED_FIELDS)
    rows = [{"field": field.key, "value": value} for field in chosen if (value := field.flatten(one)) not in (None, "")]
    return _html(rows)


def _html(rows: Sequence[Mapping[str, Any]]) -> str:
    if not rows:
        return ""
    head = "".join(f"<th>{escape(name)}</th>" for name in rows[0])
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(_short(value))}</td>" for value in row.values()) + "</tr>" for row in rows
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _short(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(map(str, value))
    return f"{value:.4g}" if isinstance(value, float) else "" if value is None else str(value)
