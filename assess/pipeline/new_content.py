"""What a new workbook starts with, with the results of its live columns."""

from dataclasses import replace

from assess.errors import WorkbookError
from assess.pipeline.live_values import with_live, without_shaking
from assess.workbook.example import example_content, room_content
from assess.workbook.template import Content, Units


def fill_content(units: Units, use: str, *, is_example: bool) -> Content:
    """Return what a new workbook holds: nothing, the types and a room of a use, or an example that can be run.

    Parameters
    ----------
    units : "si" or "imperial"
        Of the headers.
    use : str
        One of `assess.workbook.schema.USES`; blank: every type.
    is_example : bool
        Whether it can be run at once: a small office, or the room of `use` with a made-up shaking.
    """
    if use and not is_example:
        return without_shaking(room_content(use, units), units)
    if use or is_example:
        return with_live(room_content(use, units, is_shaken=True) if use else example_content(units), units)
    return Content()


def store_live(content: Content, units: Units) -> Content:
    """Return a content with its live columns as far as they are known; without them where it is not complete."""
    if not content.rows.get("Items"):
        return replace(content, live=())
    for work_out in (with_live, without_shaking):
        try:
            return work_out(content, units)
        except WorkbookError:
            continue
    return replace(content, live=())
