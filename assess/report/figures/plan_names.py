"""Names on a plan: places, rooms and pieces, none over another; what finds no room gets a number, with a key to it."""

from collections.abc import Sequence
from dataclasses import dataclass

from assess.model import Place
from assess.report import words
from assess.report.figures.labels import LINE, Bounds, Label, Point, overlap, place_each
from assess.report.figures.underlay import Room

NAMED = 24
"""Characters of a place's name that are drawn."""
FEW = 30
"""Places on a plan up to which all are named: of more, mere points of routes are not, and doors where there is room."""
LARGE = ("exit", "stair")
"""Kinds of places whose sign is a large one, and whose names come first."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A place with its name, "" where there is no room for it, and the sign of its kind.

    The name begins or, if `is_before`, ends at `label`; `box` is the room that it takes; a line leads to it from the
    sign where `lead` is given.
    """

    name: str
    kind: str
    at: Point
    label: Point
    is_before: bool
    box: Bounds
    lead: tuple[Point, Point] | None = None


@dataclass(frozen=True, slots=True)
class Key:
    """A name that is not on the plan; `number` stands there in its place, None where there is no room for that."""

    number: int | None
    name: str
    at: Point


class Names:
    """Places names on a plan one group after another, none on a piece; `keys` are those that found no room."""

    def __init__(self, frame: Bounds, unit: float, pieces: Sequence[Bounds] = ()) -> None:
        self.frame, self.unit = frame, unit
        self.boxes: list[Bounds] = []
        self.pieces: tuple[Bounds, ...] = tuple(pieces)
        self.keys: list[Key] = []

    def place(self, named: Sequence[tuple[str, Bounds]], taken: Sequence[Bounds]) -> list[Label | None]:
        """Return the label of each name, a number in its place, or None."""
        found = place_each(named, taken, self.frame, self.unit, (*self.boxes, *self.pieces))
        self.boxes += [one.box for one in found if one is not None]
        for at, (text, box) in enumerate(named):
            if found[at] is None:
                number = sum(key.number is not None for key in self.keys) + 1
                (label,) = place_each([(str(number), box)], taken, self.frame, self.unit, (*self.boxes, *self.pieces))
                point = ((box[0] + box[2]) / 2, (box[1] + box[3]) / 2)
                self.keys.append(Key(None if label is None else number, text, point))
                self.boxes += [] if label is None else [label.box]
                found[at] = label
        return found

    def place_spots(self, places: Sequence[tuple[Place, Point]], taken: Sequence[Bounds]) -> list[Spot]:
        """Return each place with its name, as far as all are few; exits and stairs first."""
        rank = {"": 3, "door": 2} if len(places) > FEW else {}
        ordered = sorted(places, key=lambda pair: rank.get(pair[0].kind, pair[0].kind not in LARGE))
        ranks = [rank.get(one.kind, 0) for one, _at in ordered]
        named = [(words.cut(one.place, NAMED), self._sign(one, at)) for one, at in ordered]
        free = [*taken, *(box for _name, box in named)]
        labels = self.place(named[: ranks.count(0)], free)
        labels += self._place_free(named[ranks.count(0) : len(ranks) - ranks.count(3)], free)
        labels += [None] * ranks.count(3)
        return [self._spot(one, at, label) for (one, at), label in zip(ordered, labels, strict=True)]

    def _place_free(self, named: Sequence[tuple[str, Bounds]], taken: Sequence[Bounds]) -> list[Label | None]:
        """Return the label of each name that covers nothing and lies beside its place; the others are left out."""
        found: list[Label | None] = []
        for one in named:
            (label,) = place_each([one], taken, self.frame, self.unit, (*self.boxes, *self.pieces))
            is_free = label is not None and label.lead is None and not any(overlap(label.box, box) for box in taken)
            found.append(label if is_free else None)
            self.boxes += [label.box] if label is not None and is_free else []
        return found

    def place_rooms(self, rooms: Sequence[Room], taken: Sequence[Bounds]) -> list[Label]:
        """Return the names of the rooms that have no sign, in their middle."""
        named = [(words.cut(one.name, NAMED), (*one.centre, *one.centre)) for one in rooms if one.name]
        return [one for one in self.place(named, taken) if one is not None]

    def _sign(self, place: Place, at: Point) -> Bounds:
        off = (6 if place.kind in LARGE else 3) * self.unit
        return at[0] - off, at[1] - off, at[0] + off, at[1] + off

    def _spot(self, place: Place, at: Point, label: Label | None) -> Spot:
        if label is None:
            return Spot("", place.kind, at, at, False, self._sign(place, at))
        is_before = label.box[2] <= at[0]
        start = (label.box[2 if is_before else 0], label.box[1] + 0.2 * LINE * self.unit)
        return Spot(label.text, place.kind, at, start, is_before, label.box, label.lead)
