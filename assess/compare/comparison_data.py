"""compare.json: a comparison for other programs, the same in every language; units stand in the names.

Its first two entries are those of results.json, so that a later comparison knows which files beside it are its own
(`assess.report.ownership`). Standings, directions and states are the words of `assess.compare`; null is what a run
lacks.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from assess.compare.changes import Comparison, PieceChange, StateChange, Total, count_states, list_states
from assess.compare.past_run import PastChance, PastPiece, PastRun, PastState
from assess.compare.read_results import COMPARISON
from assess.version import __version__

SCHEMA = "1.1"
"""Version of the shape of compare.json."""


def write_data(comparison: Comparison, path: Path, files: Mapping[str, str | None]) -> None:
    """Write compare.json, with the list of the other files and their SHA-256; raises OSError if it cannot be."""
    path.write_text(dump(describe(comparison, files)), encoding="utf-8")


def dump(record: Mapping[str, Any]) -> str:
    """Return a document in JSON."""
    return json.dumps(record, ensure_ascii=False, allow_nan=False, indent=1) + "\n"


def describe(found: Comparison, files: Mapping[str, str | None] | None = None) -> dict[str, Any]:
    """Return the document; `files` are listed where it is written among them."""
    return {
        "schema": SCHEMA,
        "assess": {"version": __version__, **({} if files is None else {"files": dict(files)})},
        COMPARISON: {
            "same_code": found.has_same_code,
            "same_basis": found.has_same_basis,
            "same_results": found.is_same_file,
            "other_building": found.is_other_building,
        },
        "before": _run(found.before),
        "after": _run(found.after),
        "counts": _counts(found),
        "moves": [
            {"before": was or None, "after": now or None, "pieces": count} for (was, now), count in found.moves.items()
        ],
        "items": [_piece(one) for one in found.pieces],
        "routes": [_state(one, "route") for one in found.routes],
        "rooms": [_state(one, "room") | {"floor": one.floor} for one in found.rooms],
    }


def _run(run: PastRun) -> dict[str, Any]:
    return {
        "results": run.path.name,
        "results_sha256": run.sha256,
        "results_written": f"{run.written:%Y-%m-%dT%H:%M:%SZ}",
        "schema": run.schema,
        "version": run.version,
        "code": run.code or None,
        "building": run.name,
        "workbook": run.workbook,
        "workbook_sha256": run.workbook_sha256,
        "basis": run.main_basis,
        "settings": dict(run.settings),
        "unjoined_rooms": list(run.unjoined_rooms),
    }


def _counts(found: Comparison) -> dict[str, Any]:
    runs = (found.before, found.after)
    return {
        "pieces": {one: _total(found.count_standing(one)) for one in found.standings()},
        "expected_falls": _total(found.falls),
        "expected_falls_counted_in_both": found.falls_of_both and _total(found.falls_of_both),
        "routes": _states(*(run.routes for run in runs)),
        "blocked_routes_expected": {"before": runs[0].blocked_routes, "after": runs[1].blocked_routes},
        "rooms": _states(*(run.rooms for run in runs)),
        "unknown_routes": {"before": runs[0].unknown_routes, "after": runs[1].unknown_routes},
        "unknown_rooms": {"before": runs[0].unknown_rooms, "after": runs[1].unknown_rooms},
        "unjoined_rooms": {"before": len(runs[0].unjoined_rooms), "after": len(runs[1].unjoined_rooms)},
        "cut_off_rooms_expected": {"before": runs[0].cut_off_rooms, "after": runs[1].cut_off_rooms},
    }


def _total(total: Total) -> dict[str, Any]:
    return {
        "before": total.before,
        "after": total.after,
        "comparable": total.is_comparable,
        "within_sampling_interval": total.is_within,
    }


def _states(before: Sequence[PastState], after: Sequence[PastState]) -> dict[str, Any]:
    was, now = count_states(before), count_states(after)
    return {one: {"before": was[one], "after": now[one]} for one in list_states(before, after)}


def _piece(one: PieceChange) -> dict[str, Any]:
    return {
        "item": one.piece.item,
        "change": one.direction.value,
        "within_sampling_interval": one.is_within,
        "before": _side(one.before, one.standing_before),
        "after": _side(one.after, one.standing_after),
        "inputs": {name: {"before": was, "after": now} for name, (was, now) in one.inputs.items()},
    }


def _side(piece: PastPiece | None, standing: str) -> dict[str, Any] | None:
    if piece is None:
        return None
    return {
        "floor": piece.floor,
        "room": piece.room,
        "quantity": piece.quantity,
        "standing": standing,
        "class": piece.risk.word,
        "basis": piece.basis,
        **_chance(piece.chance),
    }


def _chance(chance: PastChance) -> dict[str, Any]:
    return {"probability": chance.probability, "low": chance.low, "high": chance.high}


def _state(one: StateChange, kind: str) -> dict[str, Any]:
    sides = [
        run and {"state": run.state, "chance": run.chance and _chance(run.chance)} for run in (one.before, one.after)
    ]
    return {
        kind: one.name,
        "change": one.direction.value,
        "within_sampling_interval": one.is_within,
        "before": sides[0],
        "after": sides[1],
    }
