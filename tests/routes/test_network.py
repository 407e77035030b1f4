"""What a blockage cuts off, and which segments lie on a way out, against networkx on random networks."""

import networkx as nx
import numpy as np
from hypothesis import given, settings, strategies as st

from assess.routes.chances import to_array, to_sets
from assess.routes.network import Part, build_course, find_parts, find_rooms, find_ways
from tests.routes.buildings import place, stretch

QUICK = settings(max_examples=60, deadline=None)
NAMES = "abcdef"


@st.composite
def networks(draw, most=8):
    """Draw a network: its edges by number, and the kinds of places."""
    pair = st.lists(st.sampled_from(NAMES), min_size=2, max_size=2, unique=True)
    pairs = draw(st.lists(pair, min_size=1, max_size=most))
    graph: nx.MultiGraph[str] = nx.MultiGraph()
    for at, (one, other) in enumerate(pairs):
        graph.add_edge(one, other, key=at)
    kinds = {name: draw(st.sampled_from(["room", "", "door", "stair", "exit"])) for name in NAMES}
    return graph, kinds


@st.composite
def parts(draw):
    graph, kinds = draw(networks())
    return draw(st.sampled_from(list(find_parts(graph, kinds)))), kinds


@QUICK
@given(parts(), st.data())
def test_cut_off_is_what_networkx_cannot_reach(drawn, data):
    part, _ = drawn
    places = sorted({name for edge in part.edges for name in edge[:2]})
    width = max(part.segments) + 1
    rows = [data.draw(st.lists(st.booleans(), min_size=width, max_size=width)) for _ in range(5)]
    blocked = np.array(rows, dtype=np.bool_)
    sets = dict(enumerate(to_sets(blocked)))
    found = [to_array(lost, len(blocked)) for lost in part.cut_off(sets, places, 0b11111)]
    for row, lost in zip(blocked, np.transpose(found), strict=True):
        graph: nx.MultiGraph[str] = nx.MultiGraph()
        graph.add_nodes_from(places)
        graph.add_edges_from((one, other) for one, other, at in part.edges if not row[at])
        reached = {name for one in part.targets for name in nx.node_connected_component(graph, one)}
        assert lost.tolist() == [name not in reached for name in places]


@QUICK
@given(networks())
def test_rooms_keep_what_lies_on_simple_ways_out(drawn):
    """Against all simple paths from the room to a way out, with no other way out between."""
    graph, kinds = drawn
    places = [place(name, kinds[name]) for name in NAMES if name in graph]
    for room, part in find_rooms(places, list(find_parts(graph, kinds))):
        kept = {
            at
            for target in part.targets
            for path in nx.all_simple_edge_paths(graph, room.place, target)
            if not {name for edge in path[:-1] for name in edge[:2]} & part.targets
            for *_, at in path
        }
        assert set(part.segments) == kept


@QUICK
@given(networks())
def test_every_room_that_can_get_out_is_found(drawn):
    graph, kinds = drawn
    places = [place(name, kinds[name]) for name in NAMES]
    found = {room.place for room, _ in find_rooms(places, list(find_parts(graph, kinds)))}
    out = {name for name in graph if kinds[name] in ("exit", "stair")}
    rooms = [name for name in graph if kinds[name] == "room"]
    expected = {name for name in rooms if out & nx.node_connected_component(graph, name)}
    assert found == expected


@QUICK
@given(networks(), st.lists(st.floats(0, 0.9), min_size=8, max_size=8))
def test_ways_out(drawn, chances):
    """Each leads from the room to its end, none is safer than the first, and the second shares least with it."""
    graph, kinds = drawn
    chance = dict(enumerate(chances))
    places = [place(name, kinds[name]) for name in NAMES if name in graph]
    for room, part in find_rooms(places, list(find_parts(graph, kinds))):
        ways = list(find_ways(part, room.place, chance))
        assert ways
        assert len({segments for segments, _ in ways}) == len(ways)
        ends = {at: pair for *pair, at in graph.edges(keys=True)}
        for segments, end in ways:
            here = room.place
            for at in segments:
                assert here in ends[at]
                here = next(name for name in ends[at] if name != here)
            assert here == end
            assert end in part.targets
        paths = [
            {at for *_, at in path}
            for target in part.targets
            for path in nx.all_simple_edge_paths(graph, room.place, target)
        ]
        safest = min(1 - np.prod([1 - chance[at] for at in path]) for path in paths)
        first = set(ways[0][0])
        assert 1 - np.prod([1 - chance[at] for at in first]) <= safest + 1e-4
        others = [len(first & path) for path in paths if path != first]
        assert (len(ways) > 1) == any(shared < len(first) for shared in others)
        if len(ways) > 1:
            assert len(first.intersection(ways[1][0])) == min(others)


@QUICK
@given(networks(), st.data())
def test_a_route_is_blocked_where_one_of_its_rooms_is_cut_off(drawn, data):
    graph, kinds = drawn
    segments = {at: stretch(str(at), one, other) for one, other, at in graph.edges(keys=True)}
    width = max(segments) + 1
    row = np.array(data.draw(st.lists(st.booleans(), min_size=width, max_size=width)), dtype=np.bool_)
    is_blocked = bool(build_course(segments, kinds)({at: int(one) for at, one in enumerate(row)}, 1))
    open_graph: nx.MultiGraph[str] = nx.MultiGraph()
    open_graph.add_nodes_from(graph)
    open_graph.add_edges_from((one, other) for one, other, at in graph.edges(keys=True) if not row[at])
    for places in nx.connected_components(graph):
        exits, stairs = ({name for name in places if kinds[name] == kind} for kind in ("exit", "stair"))
        rooms = {name for name in places if kinds[name] == "room"}
        out = exits or stairs
        if out and any(not out & nx.node_connected_component(open_graph, name) for name in rooms):
            assert is_blocked
    if not row.any():
        assert not is_blocked


def test_a_part_without_a_way_out_joins_no_room():
    part = Part((("a", "b", 0),), frozenset(), by_stairs=False)
    assert list(find_rooms([place("a", "room")], [part])) == []
