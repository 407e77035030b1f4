"""Evacuation routes drafted from a building model: from every room to an exit, one route for each exit and stair.

A draft is not a finding: the model does not tell whether a door is locked, or people may pass through a room. So the
names of drafted routes end in "(draft)" until a person has walked them (`assess.workbook.draft_names`).

A route is the union of the ways of all rooms that leave their storey by one exit or one end of a stair, each segment
once. The route to a stair ends with the flight, at whose other end the route of that storey goes on.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import networkx as nx
import shapely

from assess.bim.building_model import BuildingModel, Point
from assess.bim.draft_floor import (
    DOOR_LESS,
    JAMB,
    NARROWEST_OPENING,
    DoorKind,
    FloorPlan,
    Link,
    Sides,
    build_plan,
    build_rooms,
    find_ground,
    find_kinds,
    find_openings,
    link_door,
    link_stairs,
)
from assess.bim.draft_paths import find_ways
from assess.bim.plan_shapes import box_at, list_polygons
from assess.i18n import Text, fill, gettext, nfill
from assess.text import natural_key
from assess.workbook.draft_names import DRAFT, mark_draft
from assess.workbook.habits import name_some
from assess.workbook.names import key
from assess.workbook.schema import DEFAULT_WIDTH, ROUTES

Rows = Sequence[Mapping[str, Any]]

IN_ROOM = 0.3  # a segment runs through a room if it is longer than this there [m]
FALLS_OVER = 3.0
"""A piece of the next room may fall through an opening up to this far from a segment [m]."""
BEHIND_WALL = 1.0
"""A piece of the next room that is so near to a segment, but behind a wall, would seem to stand in it [m]."""
MOST_NAMED = 10
SHORT = 40  # characters that are kept of a long name which a number tells apart
NARROWEST = ROUTES.column("clear_width").low or 0.0  # least clear width that a workbook takes [m]
BESIDE = 1.5  # walls and columns up to this far to the left and to the right of a segment bound it [m]
SLIVER = 1e-4  # area below which what stands next to a segment is an error of rounding [m2]
SHORTEST = 0.02  # a part of a segment that is shorter than this has no sides [m]
AT_STAIR = 0.5  # around a stair, and so far from it, no width is measured: ways lead to it from any side [m]
PER_RISE = 2.5  # length of the way on a stair to each metre that it rises [-]


# ---------------------------------------------------------------- the network of all ways


@dataclass(frozen=True, slots=True)
class Node:
    """A point of the network: its position, its storey, and the key of its place; "" for one that routes add."""

    at: Point
    storey: str
    place: str = ""
    link: Link | None = None


@dataclass(slots=True)
class Network:
    """The ways in a building: `graph` joins nodes by name, with the cost, the space and the width of each way. `plans`
    are by storeys, `rooms` the nodes of rooms by their spaces; ways lead to `exits` and `stairs`. `sides` and `kinds`
    are those of doors, `places` the positions of rooms.
    """

    sides: Mapping[str, Sides]
    kinds: Mapping[str, DoorKind]
    places: Mapping[str, Point]

    graph: "nx.Graph[str]" = field(default_factory=nx.Graph)
    nodes: dict[str, Node] = field(default_factory=dict)
    plans: dict[str, FloorPlan] = field(default_factory=dict)
    rooms: dict[str, str] = field(default_factory=dict)
    openings: list[Link] = field(default_factory=list)
    exits: list[str] = field(default_factory=list)
    stairs: list[str] = field(default_factory=list)

    def join(self, one: str, other: str, space: str = "", **way: Any) -> None:
        """Add a way with its cost and width, unless there is a cheaper one."""
        if not self.graph.has_edge(one, other) or self.graph.edges[one, other]["cost"] > way["cost"]:
            self.graph.add_edge(one, other, space=space, **way)


def _build_network(model: BuildingModel, sides: Mapping[str, Sides], places: Mapping[str, Point]) -> Network:
    network = Network(sides, find_kinds(model, sides), places)
    for storey in model.storeys:
        plan = build_plan(model, storey)
        if not plan.spaces:
            continue
        network.plans[storey.key] = plan
        doors = [door for door in model.doors if door.storey == storey.key]
        links: list[Link] = []
        for door in (door for door in doors if network.kinds[door.key] in ("inside", "exit")):
            link = link_door(door, network.sides[door.key])
            links.append(link)
            network.nodes[link.name] = Node(link.at, storey.key, door.key, link)
            if network.kinds[door.key] == "exit":
                network.exits.append(link.name)
        openings, stairs = find_openings(plan, doors), link_stairs(model, plan)
        for link in stairs:
            network.nodes[link.name] = Node(link.at, storey.key, link.name.removeprefix("stair "), link)
            network.stairs.append(link.name)
        network.nodes |= {link.name: Node(link.at, storey.key, "", link) for link in openings}
        network.openings += openings
        for space, room in build_rooms(plan, [*links, *openings, *stairs]).items():
            own = network.rooms[space] = f"room {space}"
            network.nodes[own] = Node(network.places[space], storey.key, space)
            ways = find_ways(room, own, network.places[space])
            network.nodes |= {name: Node(at, storey.key) for name, at in ways.points.items()}
            for one, other, way in ways.found:
                network.join(one, other, space, **way)
    levels = {storey.key: storey.level for storey in model.storeys}
    for stair in dict.fromkeys(one.key for one in model.stairs):
        foot, head = (network.nodes.get(f"stair {stair} {end}") for end in ("foot", "head"))
        if foot is not None and head is not None and foot.storey != head.storey:
            rise = abs(levels[head.storey] - levels[foot.storey])
            cost = math.hypot(math.dist(foot.at, head.at), PER_RISE * rise)
            network.join(f"stair {stair} foot", f"stair {stair} head", cost=cost, width=None)
    return network


@dataclass(frozen=True, slots=True)
class Step:
    """The next step out from a node, the way left to the end [m], and at which exit or stair that leaves the storey."""

    start: str
    end: str
    far: float
    target: str


def _find_steps(network: Network) -> dict[str, Step]:
    """Return the steps of the ways out of all rooms, by the node from which each leads: way by way, the longest first.

    Each is the shortest way to an exit, or, where no exit can be reached, to the end of a stair. A way ends where it
    meets one before it.
    """
    graph, tree, reached = network.graph, dict[str, Step](), set[str]()
    for ends in (network.exits, network.stairs):
        targets = {name: name for name in ends if name in graph and name not in reached}
        if not targets:
            continue
        rest = graph.subgraph([name for name in graph if name not in reached])
        shortest: Any = nx.multi_source_dijkstra(rest, dict.fromkeys(targets), weight="cost")
        far, paths = shortest
        for name in sorted(far, key=lambda one: (far[one], len(paths[one]))):
            if name in targets:
                continue
            following = paths[name][-2]
            is_flight = not graph.edges[name, following]["space"]
            targets[name] = name if is_flight else targets[following]
            tree[name] = Step(name, following, float(far[name]), targets[name])
        reached |= targets.keys()
    found: dict[str, Step] = {}
    for first in sorted((tree[room] for room in network.rooms.values() if room in tree), key=lambda one: -one.far):
        name = first.start
        while name in tree and name not in found:
            found[name] = tree[name]
            name = tree[name].end
    return found


def measure_gap(plan: FloorPlan, space: str, ends: tuple[Point, Point], links: Iterable[Link]) -> float | None:
    """Return the least distance between what stands to the left and to the right of a segment in a space [m].

    Walls and windows bound it, and what is outside all rooms; furniture does not, nor is a wall met in the links at its
    ends. It is None where nothing stands on one of its sides up to `BESIDE`.
    """
    line = shapely.LineString(ends)
    wide = line.buffer(BESIDE, cap_style="flat")
    rooms = shapely.union_all([plan.polygons[at] for at in sorted(plan.tree.query(wide))])
    solids = plan.solids_near(wide)
    floor = plan.by_key[space].difference(solids)
    passages = []
    for link in links:
        at = shapely.Point(link.at)
        reach = floor.distance(at) if not floor.is_empty else 0.0
        is_stair = link.normal == (0.0, 0.0)
        through = box_at(link.at, link.normal, reach + JAMB / 2, link.width / 2)
        passages.append(at.buffer(reach + AT_STAIR) if is_stair else through)
    stands = shapely.union_all([wide.difference(rooms), wide.intersection(solids)])
    stands = stands.difference(shapely.union_all(passages))
    parts = [one for one in shapely.get_parts(line.difference(stands)) if one.length > SHORTEST]
    gaps = []
    for part in parts:
        sides = (part.buffer(far, single_sided=True).intersection(stands) for far in (BESIDE, -BESIDE))
        left, right = (shapely.union_all([one for one in list_polygons(side) if one.area > SLIVER]) for side in sides)
        if not (left.is_empty or right.is_empty):
            gaps.append(float(left.distance(right)))
    return min(gaps, default=None)


def _set_widths(links: Sequence[Link], between_walls: float | None, gap: float | None) -> dict[str, Any]:
    """Return the widths of a segment and what is assumed of them. `between_walls`: the free width of a corridor in
    whose middle it lies. `gap`: from `measure_gap`: it counts next to others, and where less than must stay free
    otherwise.
    """
    narrow = [link for link in links if link.overall > 0 or 0 < link.clear < DEFAULT_WIDTH]
    known = [link.clear for link in narrow] + ([] if between_walls is None else [between_walls])
    if gap is not None and (known or gap < DEFAULT_WIDTH):
        known.append(gap)
    if not known:
        return {}
    clear = min(known)
    tightest = next((link for link in narrow if link.clear == clear), None)
    clear = max(int(100 * clear + 1e-6) / 100, NARROWEST)
    notes = gettext("Clear width: between the walls of the model.")
    if tightest is not None and tightest.overall > 0:
        notes = gettext("Clear width: the door's {overall:.2f} m in the model less {less:g} m for frame and leaf, "
                        "assumed.", overall=tightest.overall, less=DOOR_LESS)  # fmt: skip
    if clear >= DEFAULT_WIDTH:
        return {"clear_width": clear, "notes": notes}
    same = gettext("Required width: the same, as that is less than {default:g} m.", default=DEFAULT_WIDTH)
    return {"clear_width": clear, "required_width": clear, "notes": f"{notes} {same}"}


# ---------------------------------------------------------------- routes


@dataclass(frozen=True, slots=True, kw_only=True)
class DraftRoutes:
    """Rows of Routes and of the Places that they add; rooms without a way out; what is assumed or to be checked."""

    places: Rows = ()
    routes: Rows = ()
    unreached: tuple[str, ...] = ()
    remarks: tuple[Text, ...] = ()


def draft_routes(
    model: BuildingModel, names: Mapping[str, str], sides: Mapping[str, Sides], places: Mapping[str, Point]
) -> DraftRoutes:
    """Draft the evacuation routes of a building; remarks say why where there are none. `names`: of rooms and doors by
    their keys, of ends of stairs by key and end (``KEY foot``), of floors where they are not those of the model.
    `sides` of doors and `places` of rooms are from `draft_floor`.
    """
    network = _build_network(model, sides, places)
    steps = _find_steps(network)
    sheet = _Sheet(model, network, steps, names)
    routes = list(sheet.list_routes())
    lost = tuple(
        names[space.key] for space in model.spaces if space.key in names and network.rooms.get(space.key) not in steps
    )
    remarks = tuple(_list_remarks(model, network, routes, lost))
    return DraftRoutes(places=sheet.places, routes=routes, unreached=lost, remarks=remarks)


@dataclass(slots=True)
class _Sheet:
    model: BuildingModel
    network: Network
    steps: Mapping[str, Step]
    names: Mapping[str, str]
    places: list[dict[str, Any]] = field(default_factory=list)
    _named: dict[str, str] = field(default_factory=dict)
    _taken: set[str] = field(default_factory=set)
    _floors: dict[str, str] = field(default_factory=dict)

    def list_routes(self) -> Iterator[dict[str, Any]]:
        self._taken = {key(name) for name in self.names.values()}
        self._floors = {one.key: self.names.get(one.key) or one.name for one in self.model.storeys}
        of_target: dict[str, list[Step]] = {}
        for step in self.steps.values():
            of_target.setdefault(step.target, []).append(step)
        order = {storey.key: at for at, storey in enumerate(self.model.storeys)}
        nodes = self.network.nodes

        def place(target: str) -> tuple[Any, ...]:
            return order[nodes[target].storey], natural_key(self._name(target)), target

        routes = set[str]()
        for target in sorted(of_target, key=place):
            to = gettext("To {place}", place=self._name(target))
            route, numbers = mark_draft(to), count(2)
            while key(route) in routes:  # two long names that are alike where they are cut
                route = mark_draft(f"{to[:SHORT]} {next(numbers)}")
            routes.add(key(route))
            for number, step in enumerate(of_target[target], start=1):
                yield {"route": route, "segment": str(number), **self._describe(step)}

    def _name(self, node: str) -> str:
        own = self.network.nodes[node]
        if own.place:
            return self.names[own.place]
        if node not in self._named:
            floor = self._floors[own.storey]
            names = (
                gettext("{floor} opening {number}", floor=floor, number=number) if own.link
                else gettext("{floor} point {number}", floor=floor, number=number)
                for number in count(1)
            )  # fmt: skip
            name = self._named[node] = next(name for name in names if key(name) not in self._taken)
            self._taken.add(key(name))
            x, y = (round(one, 2) for one in own.at)
            self.places.append({"place": name, "floor": floor, "x": x, "y": y})
        return self._named[node]

    def _describe(self, step: Step) -> dict[str, Any]:
        """Return the row of a segment without its route.

        Its rooms are those that it runs through, and those that are open to it there. Not where a piece of the other
        room is next to the segment behind a wall: Room cannot tell the two apart.
        """
        start, end = self.network.nodes[step.start], self.network.nodes[step.end]
        row: dict[str, Any] = {"start": self._name(step.start), "end": self._name(step.end)}
        way, plan = self.network.graph.edges[step.start, step.end], self.network.plans[start.storey]
        if not way["space"]:
            return row | {"notes": gettext("Stair: fill in Clear width.")}
        line = shapely.LineString([start.at, end.at])
        near = sorted(plan.tree.query(line))
        spaces = [way["space"]]
        spaces += [plan.spaces[at].key for at in near if plan.polygons[at].intersection(line).length > IN_ROOM]
        for opening in (one for one in self.network.openings if way["space"] in one.spaces):
            if line.distance(shapely.Point(opening.at)) <= FALLS_OVER:
                spaces += [one for one in opening.spaces if not plan.hides(line, one, BEHIND_WALL)]
        rooms = [self.names[one] for one in dict.fromkeys(spaces)]
        row["floor"] = self._floors[start.storey]
        row["room"] = "" if any(";" in room for room in rooms) else "; ".join(rooms)
        links = [node.link for node in (start, end) if node.link is not None]
        row |= _set_widths(links, way["width"], measure_gap(plan, way["space"], (start.at, end.at), links))
        return {name: value for name, value in row.items() if value not in ("", None)}


def _list_remarks(model: BuildingModel, network: Network, routes: Rows, lost: Sequence[str]) -> Iterator[Text]:
    if routes:
        yield nfill(
            "{n} evacuation route was drafted from the rooms and doors of the model: walk it, correct it, and take "
            "'{mark}' off its name.",
            "{n} evacuation routes were drafted from the rooms and doors of the model: walk them, correct them, and "
            "take '{mark}' off their names.",
            len({row["route"] for row in routes}), mark=DRAFT,
        )  # fmt: skip
    elif not network.rooms:
        yield fill("No evacuation routes were drafted: the model has no rooms.")
        return
    elif not model.doors and not model.stairs:
        yield fill("No evacuation routes were drafted: the model has no doors and no stairs.")
        return
    else:
        yield fill("No evacuation routes were drafted: no way leads from a room to a door with a room on one side "
                   "only, or to a stair.")  # fmt: skip
    ground = find_ground(model)
    if ground is not None:
        yield fill("{storey} is taken as the ground storey: doors there with a room on one side only count as exits.",
                   storey=ground.name)  # fmt: skip
    others = sum(kind == "outside" for kind in network.kinds.values())
    if others:
        yield nfill(
            "{n} door of other storeys has a room on one side only: it does not count as an exit.",
            "{n} doors of other storeys have a room on one side only: they do not count as exits.", others,
        )  # fmt: skip
    if not routes:
        return
    doors = sum("required_width" in row for row in routes)
    if doors:
        yield nfill(
            "{n} drafted segment at a door or in a passage is narrower than {default:g} m: its Required width is its "
            "Clear width. Fill in the width that must stay free.",
            "{n} drafted segments at doors or in passages are narrower than {default:g} m: their Required width is "
            "their Clear width. Fill in the width that must stay free.", doors, default=DEFAULT_WIDTH,
        )  # fmt: skip
    blind = [plan.storey.name for plan in network.plans.values() if len(plan.spaces) > 1 and not plan.solids]
    if blind:
        yield fill(
            "No walls on {storeys}: openings without doors, of {least:g} m and more, are not found there.",
            storeys=", ".join(blind[:MOST_NAMED]), least=NARROWEST_OPENING,
        )  # fmt: skip
    if lost:
        yield nfill(
            "No way out of {n} room was found in the model: {names}.",
            "No way out of {n} rooms was found in the model: {names}.", len(lost), names=name_some(lost, MOST_NAMED),
        )  # fmt: skip
