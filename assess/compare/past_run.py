"""What a comparison knows of a run: the part of its results.json that is compared, as typed rows."""

import datetime
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from assess.fields import item_fields
from assess.results import CANNOT_ROCK
from assess.risk import RiskClass
from assess.table import Field

CLASSES: Mapping[str, RiskClass] = {risk.word: risk for risk in reversed(RiskClass)}
"""The classes by their words, the highest first."""
UNCONFIRMED, BY_FORMULA, ANCHORED = "unconfirmed", "by formula", "anchored"
APART = (UNCONFIRMED, BY_FORMULA, ANCHORED)
"""What stands outside the classes of a run."""
_EVERY = {one.key: one for one in item_fields(())}
INPUTS: Mapping[str, Field] = {
    key: _EVERY[key]
    for key in (
        "floor", "room", "type", "quantity", "breadth_cm", "width_cm", "height_cm", "sizes_from", "centre_of_gravity",
        "weight_kg", "friction", "anchored", "bracket_height_cm", "bracket_capacity_kn", "against_wall", "axis",
        "pfa_g", "pfv_cm_s",
    )
}  # fmt: skip
"""Inputs of a piece, whose change explains that of its chance."""


@dataclass(frozen=True, slots=True)
class PastChance:
    """A chance [-] with the ends of its interval, None where there is none."""

    probability: float
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class PastPiece:
    """One row of furniture with what was adopted for it; one that `is_held` counts as anchored, and has no class.

    `inputs` is what the run was given or used for it, by the fields of `INPUTS`.
    """

    item: str
    floor: str
    room: str
    description: str
    quantity: int
    is_held: bool
    basis: str
    risk: RiskClass
    chance: PastChance
    inputs: Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class PastState:
    """A route (`floor` is "") or a room, whose state is that of its best way to the street.

    `chance` is that of being blocked, or of losing every exit, None where that was not evaluated.
    """

    name: str
    floor: str
    state: str
    chance: PastChance | None


@dataclass(frozen=True, slots=True, kw_only=True)
class PastRun:
    """One run, as its results.json has it.

    `sha256` is that of the file, `written` when it was last changed, in UTC; `code` the SHA-256 of the program's code,
    "" where an earlier version did not write it. `uncertainty` is what the draws of the simulation vary, `shaking` the
    name of an assumed intensity, `site_ground` file, PGA and hash of a ShakeMap or of scenarios, "" where there is
    none; `motions` are hashes of the recorded motions by the names of their files. Where any piece was simulated, those
    by formula alone stand outside the classes. Expected numbers of routes and rooms are of those that are known; a room
    that no segment joins to an exit or a stair is unjoined.
    """

    path: Path
    sha256: str
    written: datetime.datetime
    schema: str
    version: str
    code: str
    platform: Mapping[str, str]
    settings: Mapping[str, Any]
    building: Mapping[str, Any]
    uncertainty: Mapping[str, Any]
    shaking: str
    site_ground: str
    workbook: str
    workbook_sha256: str
    motions: Mapping[str, str]
    is_simulated: bool
    pieces: tuple[PastPiece, ...]
    routes: tuple[PastState, ...]
    rooms: tuple[PastState, ...]
    route_risk: float
    blocked_routes: float
    cut_off_rooms: float
    unknown_routes: int
    unknown_rooms: int
    unjoined_rooms: tuple[str, ...]

    @property
    def name(self) -> str:
        """Name of the building; "" where it has none."""
        return str(self.building.get("building") or "")

    @property
    def main_basis(self) -> str:
        """What its classes, counts and sums rest on: "simulated" or "formula"."""
        return "simulated" if self.is_simulated else "formula"

    def is_counted(self, piece: PastPiece) -> bool:
        """Whether a piece is in the classes and sums: free-standing, and of the basis of the run or unable to rock."""
        return not piece.is_held and piece.basis in (self.main_basis, CANNOT_ROCK)

    def standing(self, piece: PastPiece) -> str:
        """Return the class of a piece in words, or one of `APART`."""
        if piece.is_held:
            return ANCHORED
        if self.is_counted(piece):
            return piece.risk.word
        return UNCONFIRMED if piece.basis == UNCONFIRMED else BY_FORMULA
