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
    """One row of furniture.

    `is_held`: it counts as anchored, and so has no class. `basis` is one of `assess.results.BASES`; `risk` and
    `chance` are those adopted. `inputs` is what the run was given or used for it, by the fields of `INPUTS`.
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
    """A route (`floor` is "") or a room.

    `state` is that of the route, or of the best way from the room to the street, in the words of its run; `chance`
    that of being blocked, or of losing every exit, None where that was not evaluated.
    """

    name: str
    floor: str
    state: str
    chance: PastChance | None


@dataclass(frozen=True, slots=True, kw_only=True)
class PastRun:
    """One run, as its results.json has it.

    Parameters
    ----------
    path, sha256, written
        Its results.json, the hash of that file, and when it was last changed, in UTC.
    schema, version, code : str
        Of results.json and of the program; SHA-256 of its code, "" where an earlier version did not write it.
    platform : mapping of str to str
        Versions of Python and its packages, system and processor.
    settings, building, uncertainty : mapping of str to object
        Settings as given, lines of the sheet Building, and what the draws of the simulation vary.
    shaking : str
        Name of an assumed intensity; "" where none is assumed.
    site_ground : str
        File, PGA at the building and hash of a ShakeMap or of scenarios; "" where the motion rests on none.
    workbook, workbook_sha256 : str
        Name and hash of the inventory.
    motions : mapping of str to str
        Hashes of the recorded motions, by the names of their files.
    is_simulated : bool
        Whether any piece was simulated: then pieces by formula alone stand outside its classes.
    route_risk : float
        Limit on the chance that a route is blocked [-].
    blocked_routes, cut_off_rooms : float
        Expected number of routes that are blocked and of rooms that lose every exit, among those known.
    unknown_routes, unknown_rooms : int
        Those that are not known.
    unjoined_rooms : tuple of str
        Rooms that no segment joins to an exit or a stair.
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
