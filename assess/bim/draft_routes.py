"""Evacuation routes drafted from a building model: from every room to an exit, one route for each exit and stair.

A draft is no finding: the model does not tell whether a door is locked, or whether people may pass through a room. So
the names of drafted routes end in "(draft)" until a person has walked them (`assess.workbook.draft_names`).

A route is the union of the ways of all rooms that leave their storey by one exit or one end of a stair, each segment
once. The route to a stair ends with the flight, at whose other end the route of that storey goes on.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import shapely

from assess.bim.building_model import BuildingModel
from assess.bim.door_sides import find_ground, find_kinds
from assess.bim.draft_floor import Link
from assess.bim.draft_network import Network, Node, Step, build_network, find_steps
from assess.bim.draft_openings import NARROWEST_OPENING
from assess.bim.draft_widths import measure_gap, set_widths
from assess.i18n import Text, fill, gettext, nfill
from assess.natural import natural_key
from assess.workbook.draft_names import DRAFT, mark_draft
from assess.workbook.names import key
from assess.workbook.schema import DEFAULT_WIDTH

Rows = Sequence[Mapping[str, Any]]

IN_ROOM = 0.3
"""A segment runs through a room if it is longer than this there [m]."""
FALLS_OVER = 3.0
"""A piece of the next room may fall through an opening that is no farther from a segment than this [m]."""
BEHIND_WALL = 1.0
"""A piece of the next room that is so near to a segment, but behind a wall, would seem to stand in it [m]."""
MOST_NAMED = 10
SHORT = 40
"""Characters that are kept of a long name which a number tells apart."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DraftRoutes:
    """Drafted routes.

    Attributes
    ----------
    places, routes : sequence of mapping
        Rows of Places, those alone that the segments add to rooms, doors and stairs; and of Routes: by field of
        `assess.workbook.schema`, in metres, in the language in use.
    unreached : tuple of str
        Names of the rooms from which no way leads to an exit or a stair.
    remarks : tuple of Text
        What was assumed, and what is to be checked.
    """

    places: Rows = ()
    routes: Rows = ()
    unreached: tuple[str, ...] = ()
    remarks: tuple[Text, ...] = ()


def draft_routes(model: BuildingModel, names: Mapping[str, str]) -> DraftRoutes:
    """Draft the evacuation routes of a building.

    `names`: the names of places: of rooms and doors by their keys, of ends of stairs by key and end (``KEY foot``).
    Rooms lie at `assess.bim.draft_floor.find_room_points`. Names of floors by the keys of storeys, where they are not
    those of the model.

    The draft is empty, with remarks that say why, where there is nothing to draft.
    """
    network = build_network(model)
    steps = find_steps(network)
    sheet = _Sheet(model, network, steps, names)
    routes = list(sheet.list_routes())
    lost = tuple(
        names[space.key] for space in model.spaces if space.key in names and network.rooms.get(space.key) not in steps
    )
    remarks = _note_draft(model, network, routes, lost) if routes else _note_none(model, network)
    return DraftRoutes(places=sheet.places, routes=routes, unreached=lost, remarks=tuple(remarks))


@dataclass(slots=True)
class _Sheet:
    """Rows of a draft in the making; `places` are those that the segments add."""

    model: BuildingModel
    network: Network
    steps: Mapping[str, Step]
    names: Mapping[str, str]
    places: list[dict[str, Any]] = field(default_factory=list)
    _named: dict[str, str] = field(default_factory=dict)
    _taken: set[str] = field(default_factory=set)
    _openings: dict[str, list[Link]] = field(default_factory=dict)

    def list_routes(self) -> Iterator[dict[str, Any]]:
        """Yield the rows of Routes: by storey, and from the farthest room to the end of each route."""
        self._taken = {key(name) for name in self.names.values()}
        for opening in self.network.openings:
            for space in opening.spaces:
                self._openings.setdefault(space, []).append(opening)
        of_target: dict[str, list[Step]] = {}
        for step in self.steps.values():
            of_target.setdefault(step.target, []).append(step)
        order = {storey.key: at for at, storey in enumerate(self.model.storeys)}
        nodes = self.network.nodes

        def place(target: str) -> tuple[Any, ...]:
            return order[nodes[target].storey], natural_key(self._name(target)), target

        routes = set[str]()
        for target in sorted(of_target, key=place):
            route = self._name_route(target, routes)
            for number, step in enumerate(of_target[target], start=1):
                yield {"route": route, "segment": str(number), **self._describe(step)}

    def _name_route(self, target: str, routes: set[str]) -> str:
        to = gettext("To {place}", place=self._name(target))
        name, number = mark_draft(to), count(2)
        while key(name) in routes:  # two long names that are alike where they are cut
            name = mark_draft(f"{to[:SHORT]} {next(number)}")
        routes.add(key(name))
        return name

    def _name(self, node: str) -> str:
        own = self.network.nodes[node]
        if own.place:
            return self.names[own.place]
        if node not in self._named:
            self._named[node] = self._add(own)
        return self._named[node]

    def _add(self, node: Node) -> str:
        floor = self._floor(node.storey)
        names = (
            gettext("{floor} opening {number}", floor=floor, number=number) if node.link
            else gettext("{floor} point {number}", floor=floor, number=number)
            for number in count(1)
        )  # fmt: skip
        name = next(name for name in names if key(name) not in self._taken)
        self._taken.add(key(name))
        x, y = (round(one, 2) for one in node.at)
        self.places.append({"place": name, "floor": floor, "x": x, "y": y})
        return name

    def _floor(self, storey: str) -> str:
        own = {one.key: one.name for one in self.model.storeys}
        return self.names.get(storey) or own[storey]

    def _describe(self, step: Step) -> dict[str, Any]:
        ends = self.network.nodes[step.start], self.network.nodes[step.end]
        row: dict[str, Any] = {"start": self._name(step.start), "end": self._name(step.end)}
        way = self.network.graph.edges[step.start, step.end]
        if not way["space"]:
            return row | {"notes": gettext("Stair: fill in Clear width.")}
        row |= {"floor": self._floor(ends[0].storey), "room": self._list_rooms(ends, way["space"])}
        links = [node.link for node in ends if node.link is not None]
        gap = measure_gap(self.network.plans[ends[0].storey], way["space"], (ends[0].at, ends[1].at), links)
        row |= set_widths(links, way["width"], gap)
        return {name: value for name, value in row.items() if value not in ("", None)}

    def _list_rooms(self, ends: tuple[Node, Node], space: str) -> str:
        """Return the names of the rooms that a segment runs through, and of those that are open to it there.

        Not where a piece of the other room is next to the segment behind a wall: Room cannot tell the two apart.
        """
        line = shapely.LineString([ends[0].at, ends[1].at])
        plan = self.network.plans[ends[0].storey]
        found = [space, *plan.spaces_along(line, IN_ROOM)]
        for opening in self._openings.get(space, ()):
            if line.distance(shapely.Point(opening.at)) <= FALLS_OVER:
                found += [one for one in opening.spaces if not plan.hides(line, one, BEHIND_WALL)]
        rooms = [self.names[one] for one in dict.fromkeys(found)]
        return "" if any(";" in room for room in rooms) else "; ".join(rooms)


def _note_draft(model: BuildingModel, network: Network, routes: Rows, lost: Sequence[str]) -> Iterator[Text]:
    yield nfill(
        "{n} evacuation route was drafted from the rooms and doors of the model: walk it, correct it, and take "
        "'{mark}' off its name.",
        "{n} evacuation routes were drafted from the rooms and doors of the model: walk them, correct them, and take "
        "'{mark}' off their names.",
        len({row["route"] for row in routes}),
        mark=DRAFT,
    )
    yield from _note_exits(model)
    doors = sum("required_width" in row for row in routes)
    if doors:
        yield nfill(
            "{n} drafted segment at a door or in a passage is narrower than {default:g} m: its Required width is its "
            "Clear width. Fill in the width that must stay free.",
            "{n} drafted segments at doors or in passages are narrower than {default:g} m: their Required width is "
            "their Clear width. Fill in the width that must stay free.",
            doors,
            default=DEFAULT_WIDTH,
        )
    blind = [plan.storey.name for plan in network.plans.values() if len(plan.spaces) > 1 and not plan.solids]
    if blind:
        yield fill(
            "No walls on {storeys}: openings without doors, of {least:g} m and more, are not found there.",
            storeys=", ".join(blind[:MOST_NAMED]), least=NARROWEST_OPENING,
        )  # fmt: skip
    yield from _note_lost(lost)


def _note_exits(model: BuildingModel) -> Iterator[Text]:
    ground = find_ground(model)
    if ground is not None:
        yield fill(
            "{storey} is taken as the ground storey: doors there with a room on one side only count as exits.",
            storey=ground.name,
        )
    others = sum(kind == "outside" for kind in find_kinds(model).values())
    if others:
        yield nfill(
            "{n} door of other storeys has a room on one side only: it does not count as an exit.",
            "{n} doors of other storeys have a room on one side only: they do not count as exits.",
            others,
        )


def _note_lost(lost: Sequence[str]) -> Iterator[Text]:
    if lost:
        names = ", ".join(lost[:MOST_NAMED]) + (", ..." if len(lost) > MOST_NAMED else "")
        yield nfill(
            "No way out of {n} room was found in the model: {names}.",
            "No way out of {n} rooms was found in the model: {names}.",
            len(lost),
            names=names,
        )


def _note_none(model: BuildingModel, network: Network) -> Iterator[Text]:
    if not network.rooms:
        yield fill("No evacuation routes were drafted: the model has no rooms.")
    elif not model.doors and not model.stairs:
        yield fill("No evacuation routes were drafted: the model has no doors and no stairs.")
    else:
        yield fill("No evacuation routes were drafted: no way leads from a room to a door with a room on one side "
                   "only, or to a stair.")  # fmt: skip
        yield from _note_exits(model)
