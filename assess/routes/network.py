"""The network of places that segments join: what a blockage cuts off, and the ways that are left."""

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, pairwise

import networkx as nx

from assess.model import Place, Segment
from assess.routes.chances import union
from assess.text import natural_key

MOST_WAYS = 3
"""Ways out of a room that are listed."""
EACH = 1e-6
"""What every segment adds to the cost of a way, so that of two that are as safe the shorter is taken."""
AGAIN = 100.0
"""What a segment costs more once a way has taken it: another shares it only where it must."""
BEYOND = "\0"
"""Stands for all the ways out together, where they are taken as one place."""

Blocked = Mapping[int, int]
"""For each segment the set of the draws in which it is blocked, as in `assess.routes.chances`."""
IsBlocked = Callable[[Blocked, int], int]
"""Returns the set of the draws in which segments count as blocked together, from `Blocked` and the set of all draws."""


@dataclass(frozen=True, slots=True)
class Part:
    """A connected part of the network: its edges (place, place, segment), and the places that count as ways out.

    `by_stairs`: these are stairs, as no exit can be reached.
    """

    edges: tuple[tuple[str, str, int], ...]
    targets: frozenset[str]
    by_stairs: bool

    @property
    def segments(self) -> tuple[int, ...]:
        """Its segments."""
        return tuple(sorted(at for _, _, at in self.edges))

    @property
    def places(self) -> set[str]:
        """Places that its segments join."""
        return {place for edge in self.edges for place in edge[:2]}

    def cut_off(self, blocked: Blocked, sources: Sequence[str], every: int) -> list[int]:
        """Return for each place the set of the draws, of all draws `every`, in which it reaches none of the targets."""
        reached = dict.fromkeys(self.places, 0) | dict.fromkeys(self.targets, every)
        passable = [(one, other, every & ~blocked[segment]) for one, other, segment in self.edges]
        changed = True
        while changed:
            changed = False
            for one, other, free in passable:
                more = (reached[one] ^ reached[other]) & free
                if more:
                    changed = True
                    reached[one] |= more
                    reached[other] |= more
        return [every & ~reached[place] for place in sources]

    def when_cut_off(self, place: str) -> IsBlocked:
        """Return when a place reaches none of the targets."""
        return lambda blocked, every: self.cut_off(blocked, [place], every)[0]


def build_graph(segments: Mapping[int, Segment]) -> "nx.MultiGraph[str]":
    """Return the graph of the segments that join two places; the key of an edge is the segment's number."""
    graph: nx.MultiGraph[str] = nx.MultiGraph()
    for at, one in segments.items():
        if one.start and one.end:
            graph.add_edge(one.start, one.end, key=at)
    return graph


def find_parts(graph: "nx.MultiGraph[str]", kinds: Mapping[str, str]) -> Iterator[Part]:
    """Yield the connected parts with what counts as their ways out: exits, else stairs, else nothing."""
    for places in sorted(nx.connected_components(graph), key=min):
        exits = frozenset(place for place in places if kinds.get(place) == "exit")
        stairs = frozenset(place for place in places if kinds.get(place) == "stair")
        targets = exits or (stairs if len(stairs) < len(places) else frozenset[str]())
        yield Part(_outward(graph.subgraph(places), targets), targets, by_stairs=bool(targets) and not exits)


def _outward(graph: "nx.MultiGraph[str]", targets: Collection[str]) -> tuple[tuple[str, str, int], ...]:
    """Return the edges, the nearest to the ways out first, so that what can be reached is found in few rounds."""
    far = nx.multi_source_dijkstra_path_length(graph, set(targets)) if targets else {}
    edges = [(one, other, int(at)) for one, other, at in graph.edges(keys=True)]
    return tuple(sorted(edges, key=lambda edge: (min(far.get(edge[0], 0), far.get(edge[1], 0)), edge[2])))


def build_course(segments: Mapping[int, Segment], kinds: Mapping[str, str]) -> IsBlocked:
    """Return when a route counts as blocked: a place that it serves is cut off, or a segment that joins nothing is.

    It serves its rooms and its open ends, and leads to its exits. Without an exit it leads to its stairs, down a flight
    that it includes to the end of that; without stairs, or where it is all stairs, to where its last segment ends.
    """
    parts, loose = [], [at for at, one in segments.items() if not (one.start and one.end)]
    for led, served in _list_led(segments, kinds):
        is_chain = len(led.targets) == 1 and len(led.edges) == len(led.places) - 1  # one way for all segments
        if served and not is_chain:
            parts.append((led, tuple(sorted(served))))
        else:  # without any that it serves, it is all ways out
            loose += led.segments

    def is_blocked(blocked: Blocked, every: int) -> int:
        lost = (part.cut_off(blocked, sources, every) for part, sources in parts)
        return union([*(blocked[at] for at in loose), *chain.from_iterable(lost)])

    return is_blocked


def find_ends(segments: Mapping[int, Segment], kinds: Mapping[str, str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the places that a route serves, and those that it leads to, as in `build_course`."""
    every = list(_list_led(segments, kinds))
    served = (place for _, own in every for place in sorted(own, key=natural_key))
    led = (place for part, _ in every for place in sorted(part.targets, key=natural_key))
    return tuple(dict.fromkeys(served)), tuple(dict.fromkeys(led))


def _list_led(segments: Mapping[int, Segment], kinds: Mapping[str, str]) -> Iterator[tuple[Part, list[str]]]:
    """Yield parts of a route, with what they lead to (the end of a flight of its own, not its top), and serve."""
    graph = build_graph(segments)
    for part in find_parts(graph, kinds):
        own, flights, stairs = graph.subgraph(part.places), [segments[at] for at in part.segments], part.targets
        tops = {one.start for one in flights if not one.floor and one.end in stairs and one.start != one.end}
        while more := {one.start for one in flights if one.end in tops and one.start in stairs} - tops:
            tops |= more
        targets, led = part.targets - tops, part
        if part.by_stairs and targets and targets != part.targets:
            led = Part(_outward(own, targets), targets, by_stairs=True)
        elif not part.targets:
            starts, ends = ({at: getattr(segments[at], end) for at in part.segments} for end in ("start", "end"))
            # the end from which no segment goes on; where they go round, that of the last segment
            last = next((end for end in reversed(ends.values()) if end not in starts.values()), [*ends.values()][-1])
            led = Part(part.edges, frozenset({last}), by_stairs=False)
        others = [place for place in own if place not in led.targets]
        served = [place for place in others if kinds.get(place) == "room" or own.degree(place) == 1]
        yield led, served or others


def find_rooms(
    places: Sequence[Place], parts: Sequence[Part], heights: Mapping[str, float] | None = None
) -> Iterator[tuple[Place, Part]]:
    """Yield every room that a part with a way out joins, with as much of that part as lies on any of its ways out.

    `heights` are the elevations of places, where known [m]: a way out does not climb above both the room and the exits,
    unless there is no other.
    """
    of_place, known = {place: part for part in parts for place in part.places}, heights or {}
    for place in places:
        part = of_place.get(place.place)
        if place.kind == "room" and part is not None and part.targets:
            roof = max((known[end] for end in (place.place, *part.targets) if end in known), default=math.inf)
            edges = (edge for edge in part.edges if all(known.get(end, roof) <= roof for end in edge[:2]))
            low = replace(part, edges=tuple(edges))
            yield place, _ways_part(low, place.place) or _ways_part(part, place.place) or low


def _ways_part(part: Part, room: str) -> Part | None:
    """Keep segments on simple ways from a room to a way out: those in a ring with an edge that joins both; or None."""
    graph: nx.Graph[str] = nx.Graph([(room, BEYOND)])
    joining: dict[frozenset[str], list[tuple[str, str, int]]] = {}
    for edge in part.edges:
        one, other = (BEYOND if place in part.targets else place for place in edge[:2])
        if one != other:
            graph.add_edge(one, other)
            joining.setdefault(frozenset((one, other)), []).append(edge)
    rings = ({frozenset(pair) for pair in ring} for ring in nx.biconnected_component_edges(graph))
    ring = next(pairs for pairs in rings if frozenset((room, BEYOND)) in pairs)
    own = {edge for pair in ring for edge in joining.get(pair, ())}
    return replace(part, edges=tuple(edge for edge in part.edges if edge in own)) if own else None


def find_ways(part: Part, room: str, chance: Mapping[int, float]) -> Iterator[tuple[tuple[int, ...], str]]:
    """Yield ways out of a room, the least likely to be blocked first, and where each ends.

    Others share as few segments with those before as may be. `chance` is that of a blockage by segment; those of a way
    are taken as independent for the choice.
    """
    graph: nx.MultiGraph[str] = nx.MultiGraph()
    graph.add_node(room)
    for one, other, at in part.edges:
        graph.add_edge(one, other, key=at, cost=EACH - math.log(max(1 - chance[at], 1e-9)))
    found: set[tuple[int, ...]] = set()
    for _ in range(MOST_WAYS):
        costs = nx.single_source_dijkstra_path_length(graph, room, weight="cost")
        end = min((cost, place) for place, cost in costs.items() if place in part.targets)[1]
        path = nx.dijkstra_path(graph, room, end, weight="cost")
        keys = tuple(
            min((edge["cost"], int(at)) for at, edge in graph[one][other].items())[1] for one, other in pairwise(path)
        )
        if keys in found:
            return
        found.add(keys)
        for (one, other), at in zip(pairwise(path), keys, strict=True):
            graph.edges[one, other, at]["cost"] += AGAIN
        yield keys, end
