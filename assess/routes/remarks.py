"""What a run remarks on the pieces beside routes: where the workbook contradicts itself, and what could not count."""

from collections.abc import Iterator, Sequence

from assess.errors import Problem
from assess.inventory.model import Inventory
from assess.language import fill
from assess.routes.model import Beside
from assess.routes.reach import Reached

MOST = 3
"""Pieces that a remark names."""


def remark_routes(inventory: Inventory, reached: Sequence[Reached]) -> Iterator[Problem]:
    """Yield warnings and notes on the pieces beside routes."""
    seen: set[tuple[str, int]] = set()
    for segment in reached:
        for one in segment.beside:
            for flag, tell in (("nearer_than_plan", _contradiction), ("standing_inside", _inside)):
                if flag in one.flags and (flag, one.item) not in seen:
                    seen.add((flag, one.item))
                    yield tell(inventory, segment, one)
    yield from _out_of_reach(inventory, reached)


def _contradiction(inventory: Inventory, _segment: Reached, one: Beside) -> Problem:
    message = fill(
        "Edge distance {distance:g} m of '{item}' is nearer to the route than its position on the plan says; the "
        "distance counts.",
        distance=one.distance,
        item=inventory.items[one.item].item,
    )
    return Problem("warning", "Items", _cell(inventory, one.item, "edge_distance"), message, _CORRECT)


_CORRECT = fill("Correct one of the two.")


def _inside(inventory: Inventory, segment: Reached, one: Beside) -> Problem:
    message = fill(
        "'{item}' stands {depth:.2f} m inside route '{route}', segment '{segment}', with nothing fallen.",
        item=inventory.items[one.item].item,
        depth=-one.distance,
        route=segment.segment.route,
        segment=segment.segment.segment,
    )
    field = "x" if one.by_plan else "edge_distance"
    mend = fill("Move it, or correct its position or the Clear width.")
    return Problem("warning", "Items", _cell(inventory, one.item, field), message, mend)


def _out_of_reach(inventory: Inventory, reached: Sequence[Reached]) -> Iterator[Problem]:
    """Say which pieces name a route that they cannot reach: it may be their distance, or the plan, that is wrong."""
    reaching = {(segment.segment.route, one.item) for segment in reached for one in segment.beside}
    lost = [at for at, item in enumerate(inventory.items) if item.route and (item.route, at) not in reaching]
    if lost:
        names = ", ".join(inventory.items[at].item for at in lost[:MOST]) + (", ..." if len(lost) > MOST else "")
        message = fill(
            "{count:,} rows name a route that their pieces cannot reach when they fall: {names}.",
            count=len(lost),
            names=names,
        )
        yield Problem("note", "Items", _cell(inventory, lost[0], "route"), message)


def _cell(inventory: Inventory, item: int, field: str) -> str:
    return f"{inventory.letters.get('Items', {}).get(field, 'A')}{inventory.items[item].row}"
