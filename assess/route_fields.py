"""Every shown field of the evacuation routes, once: the rows of `assess.route_results` with label, unit and format.

The tables of a notebook, the sheets of the Excel report and the tables of the pages derive from them; results.json and
its schema follow from the rows themselves.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import cache, partial
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

from assess.fields import Field, Kind
from assess.i18n import fill
from assess.route_results import Chance, PieceRef

_LABELS: Mapping[str, tuple[str, str]] = {
    "route": (fill("Route"), ""),
    "segment": (fill("Segment"), ""),
    "floor": (fill("Floor"), ""),
    "floors": (fill("Floors"), fill("Floor")),
    "from_place": (fill("From"), fill("From – to")),
    "to_place": (fill("To"), ""),
    "room": (fill("Room"), ""),
    "occupants": (fill("Occupants"), ""),
    "notes": (fill("Notes"), ""),
    "flags": (fill("Remarks"), fill("Marks")),
    "segment_indices": (fill("Segments"), ""),
    "unevaluated_segments": (fill("Segments not evaluated"), ""),
    "unevaluated_indices": (fill("Segments not evaluated, taken as open"), ""),
    # widths
    "clear_width_used_m": (fill("Clear width"), fill("Clear")),
    "required_width_used_m": (fill("Required width"), fill("Required")),
    "standing_width_m": (fill("Width now"), ""),
    "least_width_m": (fill("Width if all fall"), fill("All fallen")),
    "needed_width_m": (fill("Width that they need"), fill("Occupants need; marks")),
    "insufficient_for_occupants": (fill("Insufficient for occupants"), ""),
    "insufficient_after_falls_probability": (fill("Chance too narrow for occupants"), ""),
    "other_rooms": (fill("Not counted, in another room"), ""),
    # state and chances of a segment or route
    "state": (fill("State"), ""),
    "blocked_probability": (fill("Chance blocked"), fill("Blocked")),
    "blocked_low": (fill("Interval low"), ""),
    "blocked_high": (fill("Interval high"), ""),
    "blocked_independent": (fill("Blocked, all independent"), fill("Bounds")),
    "blocked_correlated": (fill("Blocked, fully correlated"), ""),
    "blocked_pieces": (fill("Pieces"), ""),
    "blocked_unverified": (fill("By the formula alone"), ""),
    "blocked_unconfirmed": (fill("Unconfirmed pieces"), ""),
    "blocked_if_unconfirmed_fall_probability": (fill("Blocked if unconfirmed pieces fall"), ""),
    "missing": (fill("To fill in"), ""),
    "missing_after": (fill("To fill in once these are done"), ""),
    "decisive_segment": (fill("Decisive segment"), ""),
    "from_places": (fill("From"), ""),
    "to_places": (fill("To"), ""),
    "fixes": (fill("Pieces to anchor or move"), ""),
    "blocked_is_joint": (fill("Basis"), fill("Bounds; rests on")),
    "blocked_or_reduced_probability": (fill("Chance narrowed or blocked"), fill("Narrowed or blocked")),
    "blocked_if_anchors_fail_probability": (fill("Blocked if anchors fail"), ""),
    "under_record": (fill("Under the record"), ""),
    "most_likely_piece": (fill("Most likely piece"), fill("Likeliest piece")),
    # rooms
    "exits": (fill("Exits that can be reached"), fill("Exits")),
    "loses_every_exit_probability": (fill("Chance of losing every exit"), fill("Loses all exits")),
    "loses_every_exit_low": (fill("Interval low"), ""),
    "loses_every_exit_high": (fill("Interval high"), ""),
    "loses_every_exit_independent": (fill("All independent"), ""),
    "loses_every_exit_correlated": (fill("Fully correlated"), ""),
    "loses_every_exit_is_joint": (fill("Basis"), ""),
    "loses_if_unconfirmed_fall_probability": (fill("If unconfirmed pieces fall"), ""),
    "loses_if_anchors_fail_probability": (fill("If anchors fail"), ""),
    "ways": (fill("Ways out"), fill("Ways out and the chance that each is blocked")),
    # floors
    "segments": (fill("Segments"), ""),
    "blocked_segments_expected": (fill("Blocked segments expected"), fill("Expected blocked")),
    "unknown_segments": (fill("Segments not known"), fill("Not known")),
    "routes": (fill("Routes"), ""),
    "blocked_routes_expected": (fill("Blocked routes expected"), fill("Expected blocked")),
    "unknown_routes": (fill("Routes not known"), fill("Not known")),
    "rooms": (fill("Rooms"), ""),
    "cut_off_rooms_expected": (fill("Rooms expected to lose every exit"), fill("Expected cut off")),
    "unknown_rooms": (fill("Rooms not known"), fill("Not known")),
    "any_room_cut_off_probability": (fill("Chance that any room does"), fill("Any room loses all exits")),
    "any_room_cut_off_low": (fill("Interval low"), ""),
    "any_room_cut_off_high": (fill("Interval high"), ""),
    "uncounted_pieces": (fill("Pieces not counted"), fill("Left out")),
    # a piece beside a segment
    "item": (fill("Item"), fill("Piece")),
    "by_plan": (fill("Known by"), ""),
    "distance_m": (fill("From the edge of the route"), fill("Distance")),
    "reach_m": (fill("Reaches into it"), fill("Reach")),
    "left_m": (fill("Width left beside it alone"), fill("Leaves")),
    "blocks_alone": (fill("Blocks alone"), ""),
    "falls_while_blocked": (fill("Falls and blocked"), ""),
}  # fmt: skip
"""Label, and a shorter one for the tables of pages, by the column of a notebook's table."""

_KINDS: Mapping[Any, Kind] = {float: "number", int: "count", bool: "flag"}
_FORMATS: Mapping[str, str] = {"share": "0.0%", "number": "0.00", "count": "#,##0"}
_SHARES = frozenset(("falls_while_blocked", "gain", "left"))


@cache
def route_fields(row: type) -> Mapping[str, Field]:
    """Return the fields of one of the rows of `assess.route_results` by their keys."""
    return {one.key: one for one in row_fields(row)}


def row_fields(row: Any, path: tuple[str, ...] = ()) -> Iterator[Field]:
    """Yield the fields of the rows of a dataclass: chances as columns, pieces and ways by their names."""
    hints = get_type_hints(row)
    for one in fields(row):
        hint, names = hints[one.name], (*path, one.name)
        hint = next((part for part in get_args(hint) if NoneType in get_args(hint)), hint)
        if hint is PieceRef:
            yield _field(names, (*names, "item"))
        elif is_dataclass(hint):
            yield from row_fields(hint, names)
        elif get_origin(hint) is tuple:
            yield _field(names, names, "list")
        else:
            is_share = hint is float and (row is Chance or one.name in _SHARES)
            yield _field(names, names, "share" if is_share else _KINDS.get(hint, "text"))


def _field(names: Sequence[str], path: Sequence[str], kind: Kind = "text") -> Field:
    key = "_".join(names)
    label, short = _LABELS.get(key, ("", ""))
    return Field(
        key=key, read=partial(_read_path, tuple(path)), label=label, short=short, kind=kind,
        unit="m" if key.endswith("_m") else "", format=_FORMATS.get(kind, ""),
        flat=_name_each if kind == "list" else None,
    )  # fmt: skip


def _read_path(names: Sequence[str], row: Any) -> Any:
    for name in names:
        row = None if row is None else getattr(row, name)
    return row


def _name_each(values: Sequence[Any]) -> list[Any]:
    return [getattr(one, "item", getattr(one, "end", getattr(one, "what", one))) for one in values]
