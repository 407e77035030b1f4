"""Places of a workbook that follow a building model: rooms, doors, stairs and exits, which have no identifier there.

Points that drafted routes pass have no kind. They do not follow: their names are numbers of one draft, by which another
draft calls other points, and routes are drafted into new workbooks only.
"""

from collections.abc import Callable, Sequence
from math import hypot
from typing import Any

from assess.bim.import_workbook import name_apart
from assess.bim.update_cells import RENAMED, SheetUpdate
from assess.bim.update_names import Named, match_alike
from assess.bim.update_rows import BookUpdate, Rows
from assess.workbook.names import key
from assess.workbook.parse import Row

FOLLOWED = ("x", "y", "outline")
"""Fields that the model owns."""
NEAR = 0.05
"""Distance up to which two places are at one position [m]."""


def update_places(
    book: BookUpdate, rows: Rows, find_floor: Callable[[str], str], find_room: Callable[[str, str], str]
) -> None:
    """Move the places that both have, and add those of the model alone.

    `rows`: the places of the model; those without a kind, which routes pass, are not used.
    `find_floor` and `find_room`: what people call a floor of the model, and a room of it on such a floor.
    """
    sheet = book.sheets.get("Places")
    own = sheet.table.with_all("place") if sheet else []
    named = {key(row.get("place")) for row in own}
    model = [{**row, "floor": find_floor(row["floor"])} for row in rows if row.get("kind")]
    for row in model:
        renamed = find_room(row["floor"], row["place"])
        row["place"] = renamed if key(renamed) in named else row["place"]
    found = match_alike(
        [Named(row["place"], (key(row["floor"]), row.get("x"), row.get("y"))) for row in model],
        [Named(row.get("place"), (key(row.get("floor") or ""), row.get("x"), row.get("y"))) for row in own],
        _is_near,
        by_content=True,
    )
    if sheet:
        sheet.note_columns(FOLLOWED, model)
        for at, other in found.items():
            _update_place(sheet, own[other], model[at])
    new = [row for at, row in enumerate(model) if at not in found]
    taken = [str(row.get("place")) for row in own]
    names = name_apart([*taken, *(row["place"] for row in new)])[len(taken) :]
    book.add("Places", [{**row, "place": name} for name, row in zip(names, new, strict=True)])


def _update_place(sheet: SheetUpdate, row: Row, model: dict[str, Any]) -> None:
    if key(row.get("floor") or "") != key(model["floor"]):
        sheet.keep(row, "floor", model["floor"])
        return
    sheet.keep(row, "place", model["place"], RENAMED)
    for name in FOLLOWED:
        sheet.replace(row, name, model.get(name))


def _is_near(one: Sequence[Any], other: Sequence[Any]) -> bool:
    if one[0] != other[0] or None in (*one, *other):
        return False
    return hypot(one[1] - other[1], one[2] - other[2]) <= NEAR
