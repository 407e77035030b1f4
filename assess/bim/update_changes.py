"""What an update of a workbook from a building model has changed, left and found missing, one entry a cell or row."""

from dataclasses import dataclass
from typing import Literal

from assess.i18n import Text, fill
from assess.workbook.patch import Value
from assess.workbook.values import shorten

Kind = Literal["changed", "added", "missing", "kept", "left_out"]
RENAMED = fill("it seems to have been renamed")
"""Why a name stays."""


@dataclass(frozen=True, slots=True)
class Change:
    """One thing that an update did, or deliberately did not do.

    Attributes
    ----------
    kind : str
        "changed": the cell got another value. "added": the row is new. "missing": the model no longer has what the row
        was imported from; the row stays. "kept": the model has another value, and the workbook's stays. "left_out":
        what the model has was not written.
    sheet, cell : str
        As the workbook calls the sheet, and the address; of a row that of its name. `cell` is "" where there is none.
    item : str
        Name of the piece, floor, place or type; "" for a line of Building.
    label : str
        Header of the column as the workbook has it, with its unit; "" for a row.
    was, now : float, str, bool or None
        What the cell held, and what it holds now; of "kept" what the model has. Numbers are in the header's unit.
    reason : Text
        Why something was kept or left out, where that does not go without saying.
    """

    kind: Kind
    sheet: str
    cell: str
    item: str = ""
    label: str = ""
    was: Value = None
    now: Value = None
    reason: Text | str = ""


def describe(change: Change) -> Text:
    """Return a change as a sentence: "Items H14 Breadth [cm] of Wardrobe 3: 54.5 -> 60"."""
    if change.kind == "changed":
        return fill("{what}: {was} -> {now}", what=_name(change), was=_say(change.was), now=_say(change.now))
    if change.kind == "added":
        return fill("{what} was added", what=_name(change))
    if change.kind == "missing":
        return fill("{what} is missing in the model; its row stays", what=_name(change))
    return _with_reason(_describe_kept(change), change.reason)


def _describe_kept(change: Change) -> Text:
    if change.kind == "left_out":
        return fill("{what} of the model was left out", what=_name(change))
    if not change.label:
        return fill("{what} stays as it is", what=_name(change))
    return fill(
        "{what} stays {was}; the model has {now}", what=_name(change), was=_say(change.was), now=_say(change.now)
    )


def _with_reason(text: Text, reason: Text | str) -> Text:
    return fill("{text}: {reason}", text=text, reason=reason) if reason else text


def _name(change: Change) -> Text:
    """Return where something is and what it is: "Items H14 Breadth [cm] of Wardrobe 3"."""
    place = f"{change.sheet} {change.cell}".strip()
    if change.label and change.item:
        return fill("{place} {label} of {name}", place=place, label=change.label, name=change.item)
    return fill("{place} {name}", place=place, name=change.label or change.item)


def _say(value: Value) -> Text | str:
    if value is None:
        return fill("blank")
    if isinstance(value, int | float) and not isinstance(value, bool):
        return fill("{number:.10g}{unit}", number=value, unit="")
    return shorten(value)
