"""What the workbook leaves open of a segment: which furniture could reach it, and how wide it is.

What is assumed on the safe side, such as a Clear width as small as the required one, does not count as missing. Pieces
count where they could change the state: free-standing ones that may fall at the chosen risk or above, on the floor of
the segment, and not in another room than those that it runs through.
"""

from collections.abc import Iterator

from assess.model import Inventory, Segment
from assess.route_results import MissingRow
from assess.routes.chances import Falls
from assess.routes.obstructions import Obstructions, is_walled_off


def find_missing(one: Obstructions, inventory: Inventory, falls: Falls, risk: float) -> tuple[MissingRow, ...]:
    """Return what is missing of a segment; nothing where it is too narrow with nothing fallen.

    Parameters
    ----------
    one : Obstructions
        The segment with the pieces that reach it.
    inventory : Inventory
        The building.
    falls : Falls
        How its pieces fall.
    risk : float
        The chosen risk [-]: a piece of which the upper end of the chance is below it does not count.
    """
    if one.is_blocked_standing:
        return ()
    if one.is_stair:
        return () if one.segment.clear_width is not None else tuple(_of_stair(one, inventory))
    left_out = [inventory.items[at] for at in list_left_out(one, inventory) if could_fall(falls, at, risk)]
    unplaced = [item for item in left_out if item.x is None or item.y is None]
    is_blank = not one.is_evaluated and not any(item.floor == one.segment.floor for item in inventory.items)
    plan = _of_plan(one.segment, inventory) if one.band is None and (left_out or is_blank) else None
    is_needed = len(unplaced) < len(left_out) or is_blank
    found = [plan] if plan and (is_needed or plan.what == "stair_floor") else []
    if unplaced:
        cells = tuple(_cell(inventory, "Items", item.row, "x") for item in unplaced)
        found.append(MissingRow(what="positions", names=tuple(item.item for item in unplaced), cells=cells))
    return tuple(found)


def list_left_out(one: Obstructions, inventory: Inventory) -> Iterator[int]:
    """Yield the pieces, by their index, of which it is not known whether they fall onto a segment of a floor."""
    for at, item in enumerate(inventory.items):
        is_placed = item.x is not None and item.y is not None and one.band is not None
        is_there = item.floor == one.segment.floor and not is_walled_off(item, one.segment)
        if is_there and not item.route and not is_placed:
            yield at


def could_fall(falls: Falls, at: int, risk: float) -> bool:
    """Tell whether a piece may fall at a chance [-] or above, or did under the recorded motion, and is not anchored."""
    return not falls.anchored[at] and bool(falls.high[at] >= risk or falls.in_record[at] == 1)


def _of_stair(one: Obstructions, inventory: Inventory) -> Iterator[MissingRow]:
    segment = one.segment
    yield MissingRow(
        what="clear_width",
        names=(_name(segment),),
        cells=(_cell(inventory, "Routes", segment.row, "clear_width"),),
    )
    if one.pieces:
        yield MissingRow(
            what="stair_pieces",
            names=tuple(near.item for near in one.pieces),
            cells=tuple(_cell(inventory, "Items", near.row, "route") for near in one.pieces),
        )


def _of_plan(segment: Segment, inventory: Inventory) -> MissingRow:
    """Return why it is not known where a segment lies."""
    places = [one for name in (segment.start, segment.end) for one in inventory.places if name and one.place == name]
    if not (segment.start and segment.end and places):
        return MissingRow(
            what="ends", names=(_name(segment),), cells=(_cell(inventory, "Routes", segment.row, "start"),)
        )
    if len({one.floor for one in places}) > 1:
        cells = (_cell(inventory, "Routes", segment.row, "floor"),)
        return MissingRow(what="stair_floor", names=(_name(segment),), cells=cells)
    without = [one for one in places if one.x is None or one.y is None] or places
    return MissingRow(
        what="places",
        names=tuple(one.place for one in without),
        cells=tuple(_cell(inventory, "Places", one.row, "x") for one in without),
    )


def _name(segment: Segment) -> str:
    return f"{segment.route}: {segment.segment}"


def _cell(inventory: Inventory, sheet: str, row: int, field: str) -> str:
    return f"{sheet}!{inventory.letters.get(sheet, {}).get(field, 'A')}{row}"
