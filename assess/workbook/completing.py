"""What completes a workbook that lacks the shaking or the furniture, in words for those who are no engineers."""

from collections.abc import Sequence

from assess.errors import Gap, Problem
from assess.i18n import Text, fill

BETTER = (
    fill(
        "Hazard map: the geological survey or the building authority of your country publishes one. Look up the peak "
        "ground acceleration (PGA) at the address, mostly that with a return period of 475 years, and type it into "
        "Ground PGA in Building."
    ),
    fill(
        "ShakeMap of a past earthquake: the USGS (earthquake.usgs.gov) and many national services publish maps of "
        "how strongly the ground shook. Put its grid.xml beside the workbook and name it in ShakeMap file in "
        "Building, with Latitude and Longitude; or read the PGA at the address, often in % of g (25 % of g is 0.25 g), "
        "and type it into Ground PGA."
    ),
    fill(
        "Records: where instruments in the building or near it recorded an earthquake, ask those who run them for the "
        "files, put these beside the workbook and name them in Record X and Record Y in Floors."
    ),
)
"""The three ways to know how the ground shakes better than by an assumed intensity."""

ASSUME = fill(
    "If you know none of these: choose how strongly the ground shakes in Shaking in Building, such as 'MMI VII, very "
    "strong', and fill in the Elevation of every floor, or, where floors are called by their number, Height and "
    "Storeys in Building. The reports then say that the shaking is assumed."
)

LIST = fill(
    "Furniture: in Items, write one row for each piece. Give it a name, its floor, and a Type of the Catalogue, or its "
    "Breadth and Height."
)


def list_ways(problems: Sequence[Problem]) -> tuple[Text, ...]:
    """Return the ways to complete a workbook, from its problems: shaking, furniture, or none."""
    gaps = [one for one in problems if isinstance(one, Gap)]
    shaking = (*BETTER, ASSUME) if any(one.lacks == "shaking" for one in gaps) else ()
    return (*shaking, *((LIST,) if any(one.lacks == "furniture" for one in gaps) else ()))
