"""The network of all ways in a building: inside each room, through doors and openings, and over stairs; and its tree.

The tree holds the shortest way from every node to an exit, or, where no exit can be reached, to the end of a stair.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import networkx as nx

from assess.bim.building_model import BuildingModel, Point, Stair, Storey
from assess.bim.door_sides import DoorKind, Sides, find_kinds, find_sides
from assess.bim.draft_floor import (
    FloorPlan,
    Link,
    build_plan,
    build_rooms,
    link_door,
    link_stairs,
    measure,
    place_rooms,
)
from assess.bim.draft_openings import find_openings
from assess.bim.draft_paths import find_ways

PER_RISE = 2.5
"""Length of the way on a stair to each metre that it rises [-]."""


@dataclass(frozen=True, slots=True)
class Node:
    """A point of the network: its position, its storey, and the key of its place; "" for one that routes add."""

    at: Point
    storey: str
    place: str = ""
    link: Link | None = None


@dataclass(slots=True)
class Network:
    """The ways in a building: `graph` joins nodes by name, with the cost, the space and the width of each way.

    `plans` are those of storeys by their keys, `rooms` the nodes of rooms by the keys of their spaces, `openings` those
    of openings, and `exits` and `stairs` the nodes to which ways lead.
    """

    graph: "nx.Graph[str]" = field(default_factory=nx.Graph)
    nodes: dict[str, Node] = field(default_factory=dict)
    plans: dict[str, FloorPlan] = field(default_factory=dict)
    rooms: dict[str, str] = field(default_factory=dict)
    openings: list[Link] = field(default_factory=list)
    exits: list[str] = field(default_factory=list)
    stairs: list[str] = field(default_factory=list)


def build_network(model: BuildingModel) -> Network:
    """Return the network of a building."""
    sides = find_sides(model)
    kinds = find_kinds(model, sides)
    network = Network()
    for storey in model.storeys:
        _add_storey(network, model, storey, sides, kinds)
    levels = {storey.key: storey.level for storey in model.storeys}
    _add_stairs(network, model.stairs, levels)
    return network


def _add_storey(
    network: Network, model: BuildingModel, storey: Storey, sides: Mapping[str, Sides], kinds: Mapping[str, DoorKind]
) -> None:
    plan = build_plan(model, storey)
    if not plan.spaces:
        return
    network.plans[storey.key] = plan
    doors = [door for door in model.doors if door.storey == storey.key]
    passed = [door for door in doors if kinds[door.key] in ("inside", "exit")]
    openings, stairs = find_openings(plan, doors), link_stairs(model, plan)
    leaves = [link_door(door, sides[door.key]) for door in passed]
    for door, link in zip(passed, leaves, strict=True):
        network.nodes[link.name] = Node(link.at, storey.key, door.key, link)
        if kinds[door.key] == "exit":
            network.exits.append(link.name)
    for link in stairs:
        network.nodes[link.name] = Node(link.at, storey.key, link.name.removeprefix("stair "), link)
        network.stairs.append(link.name)
    network.nodes |= {link.name: Node(link.at, storey.key, "", link) for link in openings}
    network.openings += openings
    _add_rooms(network, model, plan, [*leaves, *openings, *stairs])


def _add_rooms(network: Network, model: BuildingModel, plan: FloorPlan, links: Sequence[Link]) -> None:
    rooms = build_rooms(plan, links)
    places = place_rooms(model, plan, rooms)
    for key, room in rooms.items():
        own = f"room {key}"
        network.rooms[key] = own
        network.nodes[own] = Node(places[key], plan.storey.key, key)
        ways = find_ways(room, own, places[key])
        network.nodes |= {name: Node(at, plan.storey.key) for name, at in ways.points.items()}
        for way in ways.found:
            _join(network.graph, way.start, way.end, cost=way.cost, space=key, width=way.width)


def _join(graph: "nx.Graph[str]", one: str, other: str, *, cost: float, space: str, width: float | None) -> None:
    """Add a way, unless there is a cheaper one."""
    if not graph.has_edge(one, other) or graph.edges[one, other]["cost"] > cost:
        graph.add_edge(one, other, cost=cost, space=space, width=width)


def _add_stairs(network: Network, stairs: Iterable[Stair], levels: Mapping[str, float]) -> None:
    ends: dict[str, dict[str, str]] = {}
    for stair in stairs:
        name = f"stair {stair.key} {stair.end}"
        if name in network.nodes:
            ends.setdefault(stair.key, {})[stair.end] = name
    for own in ends.values():
        if len(own) > 1 and network.nodes[own["foot"]].storey != network.nodes[own["head"]].storey:
            foot, head = network.nodes[own["foot"]], network.nodes[own["head"]]
            rise = abs(levels[head.storey] - levels[foot.storey])
            cost = math.hypot(measure(foot.at, head.at), PER_RISE * rise)
            _join(network.graph, own["foot"], own["head"], cost=cost, space="", width=None)


@dataclass(frozen=True, slots=True)
class Step:
    """The next step out from a node: to which node, how far it is from there to the end [m], and where that leads.

    `target` is the exit or the stair end at which the way out leaves the storey.
    """

    start: str
    end: str
    far: float
    target: str


def find_steps(network: Network) -> dict[str, Step]:
    """Return the steps of the ways out of all rooms, by the node from which each leads: way by way, the longest first.

    A way ends where it meets one before it.
    """
    found: dict[str, Step] = {}
    reached: set[str] = set()
    for ends in (network.exits, network.stairs):
        open_ends = [name for name in ends if name in network.graph and name not in reached]
        tree = _grow(network.graph, open_ends, reached)
        reached |= tree.keys() | set(open_ends)
        found |= tree
    starts = sorted((found[room] for room in network.rooms.values() if room in found), key=lambda one: -one.far)
    return {one.start: one for one in _follow(found, [one.start for one in starts])}


def _grow(graph: "nx.Graph[str]", ends: Sequence[str], without: Collection[str]) -> dict[str, Step]:
    if not ends:
        return {}
    rest = graph.subgraph([name for name in graph if name not in without])
    found: Any = nx.multi_source_dijkstra(rest, dict.fromkeys(ends), weight="cost")
    far, paths = found
    targets = {name: name for name in ends}
    steps = {}
    for name in sorted(far, key=lambda one: (far[one], len(paths[one]))):
        if name in targets:
            continue
        following = paths[name][-2]
        is_flight = not graph.edges[name, following]["space"]
        targets[name] = name if is_flight else targets[following]
        steps[name] = Step(name, following, float(far[name]), targets[name])
    return steps


def _follow(steps: Mapping[str, Step], starts: Iterable[str]) -> Iterator[Step]:
    seen: set[str] = set()
    for start in starts:
        name = start
        while name in steps and name not in seen:
            seen.add(name)
            yield steps[name]
            name = steps[name].end
