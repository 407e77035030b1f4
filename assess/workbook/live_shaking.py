"""The live columns of a building of which only an intensity is known: Excel formulas for the sheet Lists.

They serve where Shaking is chosen, Ground PGA, SDS and ShakeMap file are blank, and no floor has a motion of its own:
every floor then follows the default profile, ASCE 7-22, from its Elevation. With a floor that has a motion of its own
others may be interpolated, which is the program's task, as is a ShakeMap.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext
from assess.intensity import SHAKINGS
from assess.motion.scenario import (
    HIGHER_MODES_FROM,
    HIGHER_MODES_POWER,
    HIGHEST_FLOOR_FREQUENCY,
    STEEPEST_GROWTH,
    cap_pfv,
)
from assess.units import GRAVITY
from assess.workbook.schema import LISTS

HELPERS = ("height_ratio", "assumed_pfa", "assumed_pfv")
"""Columns of Lists by floor."""


def write_shakings(book: Any, page: Any, at: int) -> int:
    """Write median PGA [g] and PGV [cm/s] and the scatter of every choice, in their order; return the next column."""
    values = [(one.pga / GRAVITY, 100 * one.pgv, one.scatter) for one in SHAKINGS.values()]
    for place, name in enumerate(("pga", "pgv", "scatter")):
        page.write_column(2, at + place, (f"shaking {name}", *(row[place] for row in values)))
        letter = xl_col_to_name(at + place)
        book.define_name(f"shakings_{name}", f"={gettext(LISTS)}!${letter}$4:${letter}${3 + len(values)}")
    return at + 3


def list_names(building: Mapping[str, str], elevations: str) -> Iterator[tuple[str, str]]:
    """Yield names and the formulas that they stand for, each from those before it.

    Parameters
    ----------
    building : mapping of str to str
        Cells of the sheet Building, by field.
    elevations : str
        The column Elevation of Floors.
    """
    blank = f'{building["ground_pga"]}="",{building["sds"]}="",OR(scenario_kind="",scenario_kind="asfilled")'
    yield "shakemap_named", f'TRIM({building["shakemap"]})<>""'
    chosen = f"IFERROR(MATCH(TRIM({building['shaking']}),list_shaking,0),0)"
    yield "shaking_at", f"IF(AND({blank},NOT(shakemap_named)),{chosen},0)"
    # The helper columns of the floors begin with their headers, which count as neither.
    yield "floors_owning", 'SUMPRODUCT((floor_key<>0)*(1-(floor_own_pfa_x="")*(floor_own_pfa_y="")))'
    yield "floors_lacking", 'SUMPRODUCT((floor_key<>0)*(floor_own_pfa_x="")*(floor_own_pfa_y=""))'
    yield "shaking_scatter", "IF(AND(shaking_at>0,floors_lacking>0),INDEX(shakings_scatter,shaking_at),0)"
    # The program alone reads the map and its scatter, which counts for every floor of the building.
    yield "shakemap_serves", f"AND({blank},shakemap_named,floors_lacking>0)"
    yield "shaking_pga", 'IF(AND(shaking_at>0,floors_owning=0),INDEX(shakings_pga,shaking_at),"")'
    highest = f"MAX(0,MAX({elevations})*unit_floors_elevation)"
    height = f"{building['height']}*unit_building_height"
    yield "shaking_roof", f'IFERROR(IF({building["height"]}="",{highest},{height}),"")'
    yield "shaking_has_cap", f"NOT(ISNUMBER({building['ground_pgv']}))"
    yield "shaking_largest", f'IF(shaking_at>0,INDEX(shakings_pgv,shaking_at)*{cap_pfv(1)!r},"")'
    given = ",".join(f'TRIM({building[name]})<>""' for name in ("ground_pga", "sds", "shakemap", "shaking"))
    yield "profile_serves", f'AND(scenario_kind<>"recorded",scenario_kind<>"given",OR({given}))'
    numbered = ",".join(f'TRIM({building[name]})<>""' for name in ("height", "storeys"))
    yield "storeys_serve", f"AND({numbered},COUNT({elevations})=0)"


def list_formulas(elevation: str, cells: Mapping[str, str]) -> Sequence[str]:
    """Return the expressions of `HELPERS` for a floor: z/h, PFA [g] and PFV [cm/s], "" where they are not known.

    Parameters
    ----------
    elevation : str
        The floor's cell.
    cells : mapping of str to str
        The floor's cells of Lists, by name.
    """
    ratio, pfa, period = cells["height_ratio"], cells["assumed_pfa"], "(period*unit_building_period)"
    z = f"{elevation}*unit_floors_elevation"
    # ASCE 7-22, Equations (13.3-4) and, T1 unknown, (13.3-5)
    a_1 = f"MIN(1/{period},{STEEPEST_GROWTH!r})"
    a_2 = f"MAX(1-({HIGHER_MODES_FROM!r}/{period})^2,0)"
    known = f"1+{a_1}*{ratio}+{a_2}*{ratio}^{HIGHER_MODES_POWER}"
    factor = f"IF(ISNUMBER(period),{known},1+{STEEPEST_GROWTH!r}*{ratio})"
    frequency = f"MIN(1/{period},{HIGHEST_FLOOR_FREQUENCY!r})"
    estimate = f"{pfa}*{GRAVITY * 100!r}/(2*PI()*{frequency})"
    largest = "IF(AND(shaking_has_cap,ISNUMBER(shaking_largest)),shaking_largest,largest_estimate)"
    return (
        f'IF(ISNUMBER({elevation}),IFERROR(IF({z}>0,MIN({z}/shaking_roof,1),0),""),"")',
        f'IF(AND(ISNUMBER(shaking_pga),ISNUMBER({ratio})),IFERROR(shaking_pga*({factor}),""),"")',
        f'IF(AND(ISNUMBER({pfa}),ISNUMBER(period)),MIN({estimate},{largest}),"")',
    )


def could_serve(elevation: str) -> str:
    """Return an expression for whether a profile or floors above and below could serve a floor with nothing of its own.

    What is filled in counts, be it usable or not: what is wrong with it is the program's to say.
    """
    owning = '(floor_key<>0)*(1-(floor_own_pfa_x="")*(floor_own_pfa_y=""))*(typed_elevation<>"")'
    below, above = (
        f"SUMPRODUCT({owning}*((typed_elevation{sign}{elevation})+ISTEXT(typed_elevation)>0))" for sign in ("<=", ">=")
    )
    between = f"IF(ISNUMBER({elevation}),AND({below}>0,{above}>0),floors_owning>0)"
    return f'IF(TRIM({elevation})="",AND(profile_serves,storeys_serve),IF(profile_serves,TRUE,{between}))'
