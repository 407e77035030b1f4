"""What the workbook leaves open of segments: which furniture could reach them, and how wide they are.

What is assumed on the safe side, such as a Clear width as small as the required one, does not count as missing. Pieces
are left out where it is not known whether they reach a segment: free-standing ones that may fall, on the floor of the
segment, and not in another room than those that it runs through. Whether they matter depends on how likely any of them
falls, all of them together: `combine` bounds the chance of a blockage by that.
"""

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from assess.model import Inventory, Segment
from assess.risk import wilson_interval
from assess.route_results import Chance, MissingRow
from assess.routes.chances import Falls
from assess.routes.obstructions import Obstructions, is_walled_off


def find_missing(one: Obstructions, inventory: Inventory, left_out: Collection[int]) -> tuple[MissingRow, ...]:
    """Return what is missing of a segment; nothing where it is too narrow with nothing fallen.

    `left_out`: the pieces, by their index, that may fall and of which it is not known whether they reach it.
    """
    if one.is_blocked_standing:
        return ()
    segment = one.segment
    if one.is_stair:
        if not is_unknown(one, inventory):
            return ()
        name, pieces = f"{segment.route}: {segment.segment}", [(near.item, near.row) for near in one.pieces]
        width = _row("clear_width", [(name, segment.row)], inventory, "Routes", "clear_width")
        return width, *([_row("stair_pieces", pieces, inventory, "Items", "route")] if pieces else [])
    items = [inventory.items[at] for at in left_out]
    unplaced = [(item.item, item.row) for item in items if item.x is None or item.y is None]
    is_needed = one.band is None and (items or is_unknown(one, inventory))
    found = [_of_plan(segment, inventory)] if is_needed else []
    if unplaced:
        found.append(_row("positions", unplaced, inventory, "Items", "x"))
    if not inventory.items:
        found.append(MissingRow(what="furniture", cells=(f"Items!{inventory.locate('Items', 2, 'item')}",)))
    return tuple(found)


def is_unknown(one: Obstructions, inventory: Inventory) -> bool:
    """Tell whether nothing is known of a segment, whatever furniture falls: its width, its floor or its furniture."""
    if one.is_blocked_standing:
        return False
    if one.is_stair:
        return one.segment.clear_width is None
    if not inventory.items or one.band is not None:
        return not inventory.items
    is_listed = one.is_evaluated or any(item.floor == one.segment.floor for item in inventory.items)
    return not one.segment.floor or not is_listed


def list_left_out(one: Obstructions, inventory: Inventory, falls: Falls) -> Iterator[int]:
    """Yield the pieces, by their index, that may fall and of which it is not known whether they reach a segment."""
    if one.is_blocked_standing or not one.segment.floor:
        return
    for at, item in enumerate(inventory.items):
        is_placed = item.x is not None and item.y is not None and one.band is not None
        is_there = item.floor == one.segment.floor and not is_walled_off(item, one.segment)
        if is_there and not item.route and not is_placed and _could_fall(falls, at):
            yield at


def _could_fall(falls: Falls, at: int) -> bool:
    is_free = not (falls.anchored[at] or falls.stands[at])
    return is_free and bool(falls.high[at] > 0 or falls.in_record[at] == 1)


def find_any_falls(falls: Falls, items: Collection[int], z: float) -> tuple[float, float]:
    """Return the chance that any of some pieces falls, and its upper end [-].

    As of pieces that reach a segment: from the joint outcomes where all were simulated in the same number of draws;
    else the larger one of that, with all others independent, and of all of them independent. 1 where any fell under the
    recorded motion itself.
    """
    if any(falls.in_record[at] == 1 for at in items):
        return 1.0, 1.0
    simulated: dict[int, list[int]] = {}
    for at in items:
        if at in falls.fell:
            simulated.setdefault(falls.fell[at].size, []).append(at)
    none, none_high = _none_falls(falls, [at for at in items if at not in falls.fell])
    for runs, own in simulated.items():
        count = np.column_stack([falls.fell[at] for at in own]).any(axis=1).sum()
        none, none_high = none * (1 - count / runs), none_high * (1 - float(wilson_interval(count, runs, z)[1]))
    if len(simulated) == 1 and all(at in falls.fell for at in items):
        return float(1 - none), 1 - none_high
    alone, alone_high = _none_falls(falls, list(items))
    return float(1 - min(none, alone)), 1 - min(none_high, alone_high)


def _none_falls(falls: Falls, items: Sequence[int]) -> tuple[float, float]:
    """Return the chance that no piece of some rows falls, all of them independently, and its lower end [-]."""
    count = falls.quantity[items]
    return float(np.prod((1 - falls.probability[items]) ** count)), float(np.prod((1 - falls.high[items]) ** count))


def combine(known: Chance, worst: Chance, any_falls: tuple[float, float]) -> Chance:
    """Return the chance of a blockage at worst, as far as left-out pieces can raise it.

    `known` is without them, `worst` with every segment blocked that they may reach, `any_falls` how likely any of them
    falls and its upper end [-]: a blockage needs one of them, or happens without. That is the sum at most, less the
    product where falls are independent or positively correlated, as they are in one earthquake.
    """
    chance, high = any_falls
    return replace(
        worst,
        probability=min(worst.probability, known.probability + (1 - known.probability) * chance),
        high=min(worst.high, known.high + (1 - known.high) * high),
    )


def _row(what: str, named: Iterable[tuple[str, int]], inventory: Inventory, sheet: str, field: str) -> MissingRow:
    """Return what is to be filled in, of things by their names and rows of a sheet."""
    own = tuple(named)
    cells = tuple(f"{sheet}!{inventory.locate(sheet, row, field)}" for _, row in own)
    return MissingRow(what=what, names=tuple(name for name, _ in own), cells=cells)


def _of_plan(segment: Segment, inventory: Inventory) -> MissingRow:
    """Return why it is not known where a segment lies."""
    own = [(f"{segment.route}: {segment.segment}", segment.row)]
    places = [one for name in (segment.start, segment.end) for one in inventory.places if name and one.place == name]
    if not (segment.start and segment.end and places):
        return _row("ends", own, inventory, "Routes", "start")
    if len({one.floor for one in places}) > 1:
        return _row("stair_floor", own, inventory, "Routes", "floor")
    without = [one for one in places if one.x is None or one.y is None] or places
    return _row("places", ((one.place, one.row) for one in without), inventory, "Places", "x")
