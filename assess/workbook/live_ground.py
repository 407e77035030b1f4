"""The live columns of floors without a record: Excel formulas for the sheet Lists.

They serve a floor of which PFA is typed, of which PFV may be, and, as long as no floor has a motion of its own, floors
that follow from the ground: from Ground PGA and Ground PGV, SDS, or an assumed intensity. PFA and PFV are those of
`assess.motion.floor_medians`, the table of which stands in the sheet. Beside a floor with a record, or one with a typed
motion, the others are the program's task, as is a ShakeMap.
"""

from collections.abc import Iterator, Mapping

from assess.intensity import RATIO
from assess.motion.assumed import CODE_FACTOR, CODE_POWER, LONGER, RATIO_SCATTER, STIFFNESS, STOREY
from assess.motion.floor_medians import ALIKE, PERIODS, PLACES, RATIOS, SCATTER, STRUCTURES, read_table
from assess.motion.scenario import PGA_OF_SDS
from assess.rocking.draws import MOTION
from assess.units import GRAVITY
from assess.workbook.formulas import between, find_row, trim
from assess.workbook.schema import BUILDING, FLOORS

HELPERS = ("z", "at_grade", "place", "place_at", "place_part")
"""Columns of Lists by floor: Elevation [m], whether it has a motion of its own at grade, z/h, and where that lies in
the table."""
SERVED = ("pfv_own_x", "pfv_own_y", "beam_pfa", "beam_pfv", "spread")
"""Further ones: PFV of a typed PFA, what follows from the ground, and the variance of ln of what is drawn."""
_SPEED = 100 * GRAVITY
"""From s to cm/s per g."""
_COLUMNS = len(PLACES) + 1
BLANK_ROWS = len(RATIOS) + 1
"""Blank rows that belong to the table of floor medians."""
_BLOCK = len(RATIOS) * (len(PERIODS) + 1)
_NUMBERS = ("ground_pga", "ground_pgv", "sds", "height", "storeys", "period", "motion_uncertainty")
"""Numbers of Building that are read."""
_NAMED = ("shakemap", "shaking")
_OWNING = '(floor_key<>0)*(1-(floor_own_pfa_x="")*(floor_own_pfa_y=""))'
"""Which floors have a motion of their own."""


def list_scales() -> Iterator[tuple[str, str, tuple[float, ...]]]:
    """Yield the columns that the table of floor medians is read by, each with its name: also its header."""
    ratios = tuple(one * _SPEED for one in RATIOS)
    blocks = tuple(STRUCTURES.index(ALIKE.get(one, one)) * _BLOCK for one in STIFFNESS)
    yield "structure_rows", "structure_rows", blocks
    yield "table_periods", "table_periods", PERIODS
    yield "table_ratios", "table_ratios", ratios
    yield "table_places", "table_places", (0.0, *PLACES)


def list_medians() -> list[list[float]]:
    """Return the rows of the table of floor medians: by structure, period and PGV/PGA of the ground."""
    return [row.T.ravel().tolist() for one in STRUCTURES for by_ratio in read_table()[one] for row in by_ratio]


def list_names(building: Mapping[str, str], run_assess: str, wrong: str) -> Iterator[tuple[str, str]]:
    """Yield names and the formulas that they stand for, each from those before it.

    * `building`: Cells of the sheet Building, by field.
    * `run_assess`, `wrong`: Literals of what is shown where the program alone knows, and of what is no number.
    """
    yield from ((f"given_{name}", _read_number(name, building[name], wrong)) for name in _NUMBERS)
    yield from _list_ground(building, run_assess)
    # The helper columns of the floors begin with their headers, which count as neither.
    yield "floors_owning", f"SUMPRODUCT({_OWNING})"
    yield "floors_recorded", f"COUNTIF(floor_own_pfa_x,{run_assess})+COUNTIF(floor_own_pfa_y,{run_assess})"
    yield "grade_row", "IFERROR(MATCH(1,floor_at_grade,0),0)"
    yield from ((f"ratio_{axis}", _find_ratio(axis, run_assess)) for axis in "xy")
    by_storeys = f"IF(ISNUMBER(given_storeys),MAX(0,floor_z,{STOREY!r}*given_storeys),given_storeys)"
    by_floors = f'IF(given_storeys="",MAX(0,floor_z),{by_storeys})'
    yield "building_roof", f'IF(given_height="",{by_floors},given_height)'
    by_height = f'IF(building_roof>0,{LONGER * CODE_FACTOR!r}*building_roof^{CODE_POWER!r},"")'
    found = f"IF(ISNUMBER(building_roof),{by_height},building_roof)"
    yield "building_period", f'IF(given_period="",{found},given_period)'
    structure, formula = (find_row(trim(building[name]), f"list_{name}") for name in ("structure", "class_by"))
    found = f"IFERROR(INDEX(structure_rows,{structure}),{wrong})"
    yield "structure_row", f'IF({trim(building["structure"])}="",0,{found})'
    yield "class_by", f'IF({trim(building["class_by"])}="",1,IFERROR({formula},{wrong}))'
    is_wrong = 'AND(ISTEXT(building_period),building_period<>"")'
    yield "building_fault", f"IF({is_wrong},building_period,{wrong})"
    last = len(PERIODS)
    between = f"MIN(IFERROR(MATCH(building_period,table_periods,1),1),{last - 1})-1"
    yield "period_at", f'IF(building_period="",{last},{between})'
    yield "period_part", f'IF(building_period="",0,{_find_part("building_period", "table_periods", "period_at")})'
    for axis in "xy":
        ratio = f"ratio_{axis}"
        yield f"ratio_{axis}_at", f"MIN(IFERROR(MATCH({ratio},table_ratios,1),1),{len(RATIOS) - 1})-1"
        yield f"ratio_{axis}_part", _find_part(ratio, "table_ratios", f"ratio_{axis}_at")
    named = ",".join(f'TRIM({building[name]})<>""' for name in ("ground_pga", "ground_pgv", "sds", *_NAMED))
    yield "ground_named", f"OR({named})"
    yield "storeys_serve", 'AND(given_storeys<>"",COUNTIF(floor_z,">0")=0)'


def _read_number(name: str, cell: str, wrong: str) -> str:
    column, unit = BUILDING.column(name), f"unit_building_{name}"
    number = f"{cell}*{unit}" if column.quantity else cell
    found = f"IF({between(number, column)},{number},{wrong})"
    read = f"IFERROR({found},{unit})" if column.quantity else found
    return f'IF(TRIM({cell})="","",IF(ISNUMBER({cell}),{read},{wrong}))'


def _list_ground(building: Mapping[str, str], run_assess: str) -> Iterator[tuple[str, str]]:
    is_blank = 'AND(given_ground_pga="",given_sds="")'
    yield "shakemap_named", f'AND({is_blank},TRIM({building["shakemap"]})<>"")'
    typed = trim(building["shaking"])
    # A choice that is not found may be one that the program knows.
    chosen = f'IF({typed}="",0,IFERROR({find_row(typed, "list_shaking")},{run_assess}))'
    yield "shaking_at", f"IF(AND({is_blank},NOT(shakemap_named)),{chosen},0)"
    by_class = 'IF(shaking_at>0,INDEX(shakings_pgv,shaking_at),"")'
    in_cm = "IF(ISNUMBER(given_ground_pgv),given_ground_pgv*100,given_ground_pgv)"
    yield "ground_pgv", f'IF(given_ground_pgv="",IF(ISNUMBER(shaking_at),{by_class},shaking_at),{in_cm})'
    in_g = f"IF(ISNUMBER(given_ground_pga),given_ground_pga/{GRAVITY!r},given_ground_pga)"
    by_sds = f"IF(ISNUMBER(given_sds),{PGA_OF_SDS!r}*given_sds/{GRAVITY!r},given_sds)"
    by_class = 'IF(shaking_at>0,IF(INDEX(shakings_derived,shaking_at)=1,"",INDEX(shakings_pga,shaking_at)),"")'
    assumed = f"IF(ISNUMBER(shaking_at),{by_class},shaking_at)"
    yield "known_pga", f'IF({is_blank},{assumed},IF(given_ground_pga="",{by_sds},{in_g}))'
    usual = f"{RATIO * _SPEED!r}"
    by_ratio = f"IF(ISNUMBER(ground_pgv),ground_pgv/{usual},ground_pgv)"
    yield "ground_pga", f'IF(shakemap_named,{run_assess},IF(known_pga="",{by_ratio},known_pga))'
    paired = "IF(ISNUMBER(known_pga),IF(ISNUMBER(ground_pgv),ground_pgv/known_pga,ground_pgv),known_pga)"
    yield "ground_ratio", f'IF(OR(known_pga="",ground_pgv=""),{usual},{paired})'
    yield "own_spread", 'IF(given_motion_uncertainty="",0,given_motion_uncertainty)'
    by_class = "IF(shaking_at>0,INDEX(shakings_scatter,shaking_at),0)"
    known = f"IF(ISNUMBER(shaking_at),MAX(own_spread,{by_class}),shaking_at)"
    yield "ground_spread", f"IF(ISNUMBER(own_spread),{known},own_spread)"
    yield "ground_peak", f'IF(known_pga="",{RATIO_SCATTER!r},0)'


def _find_ratio(axis: str, run_assess: str) -> str:
    other = "yx"["xy".index(axis)]
    own = f'INDEX(floor_own_pfa_{axis},grade_row)=""'
    pfa, pfv = (
        f"IF({own},INDEX(floor_{name}_{other},grade_row),INDEX(floor_{name}_{axis},grade_row))"
        for name in ("own_pfa", "own_pfv")
    )
    paired = f'IF({pfv}="",{RATIO * _SPEED!r},IF(ISNUMBER({pfv}),{pfv}/({pfa}),{pfv}))'
    at_grade = f"IF(ISNUMBER({pfa}),{paired},{pfa})"
    return f"IF(shakemap_named,{run_assess},IF(grade_row=0,ground_ratio,{at_grade}))"


def _find_part(value: str, nodes: str, at: str) -> str:
    low, high = f"LN(INDEX({nodes},{at}+1))", f"LN(INDEX({nodes},{at}+2))"
    return f"MAX(0,MIN(1,(LN({value})-{low})/({high}-{low})))"


def list_nodes(axis: str) -> Iterator[str]:
    """Yield the expressions for PFA/PGA at each z/h of the table and of an unknown one, and then for PFV/PGV.

    Each begins with that at grade, which is 1.
    """
    row = f"structure_row+period_at*{len(RATIOS)}+ratio_{axis}_at+1"
    for quantity in range(2):
        yield "1"
        for number in range(_COLUMNS):
            column = quantity * _COLUMNS + number + 1
            cell = f"INDEX(floor_table,{row}{{}},{column})"
            near, far = (
                f"((1-ratio_{axis}_part)*{cell.format(f'+{low}')}+ratio_{axis}_part*{cell.format(f'+{low + 1}')})"
                for low in (0, len(RATIOS))
            )
            yield f"(1-period_part)*{near}+period_part*{far}"


def list_places(elevation: str, cells: Mapping[str, str], run_assess: str, wrong: str) -> Iterator[str]:
    """Yield the expressions of `HELPERS` for a floor, its cell Elevation and its cells of Lists."""
    z, place, at, unit = cells["z"], cells["place"], cells["place_at"], "unit_floors_elevation"
    number = f"{elevation}*{unit}"
    found = f"IFERROR(IF({between(number, FLOORS.column('elevation'))},{number},{wrong}),{unit})"
    typed = f'IF(ISNUMBER({elevation}),{found},IF(TRIM({elevation})="","",{wrong}))'
    yield f'IF({cells["key"]}=0,"",{typed})'
    own = f'OR({cells["own_pfa_x"]}<>"",{cells["own_pfa_y"]}<>"")'
    yield f"IF(AND(ISNUMBER({z}),{own}),IF({z}<=0,1,0),0)"
    above = f"IF(ISNUMBER(building_roof),MIN({z}/building_roof,1),building_roof)"
    blank = f'IF({z}="",IF(storeys_serve,{run_assess},""),{z})'
    yield f"IF(ISNUMBER({z}),IF({z}<=0,0,{above}),{blank})"
    yield f'IF(ISNUMBER({place}),MIN(MATCH({place},table_places,1),{len(PLACES)}),"")'
    low, high = f"INDEX(table_places,{at})", f"INDEX(table_places,{at}+1)"
    yield f'IF(ISNUMBER({place}),({place}-{low})/({high}-{low}),"")'


def list_served(cells: Mapping[str, str]) -> Iterator[str]:
    """Yield the expressions of `SERVED` for a floor, by its cells of Lists."""
    place = cells["place"]
    fault = f'IF(AND(ISTEXT({place}),{place}<>""),{place},building_fault)'
    for axis, other in ("xy", "yx"):
        own, others = cells[f"own_pfa_{axis}"], cells[f"own_pfa_{other}"]
        pfa = f'IF({own}="",{others},{own})'
        pfv = f'IF({own}="",{cells[f"own_pfv_{other}"]},{cells[f"own_pfv_{axis}"]})'
        speed = f"ratio_{axis}*({_read('v', axis, cells)})/({_read('a', axis, cells)})"
        found = f"IF(ISNUMBER(ratio_{axis}),IFERROR({pfa}*{speed},{fault}),ratio_{axis})"
        yield f'IF(ISNUMBER({pfa}),IF({pfv}="",{found},{pfv}),"")'
    for peak, ground in (("a", "ground_pga"), ("v", "ground_pga*ratio_x")):
        serves = 'AND(floors_owning=0,scenario_kind<>"recorded",scenario_kind<>"given",scenario_is_own=1)'
        found = f"IF(ISNUMBER(ratio_x),IFERROR({ground}*({_read(peak, 'x', cells)}),{fault}),ratio_x)"
        yield f'IF({serves},IF(ISNUMBER(ground_pga),{found},ground_pga),"")'
    typed = f'IF(given_motion_uncertainty="",IF(floors_recorded>0,{MOTION!r},0),own_spread)^2'
    beam = f"ground_spread^2+IF({place}=0,ground_peak,{SCATTER!r})^2"
    yield f"IF(ISNUMBER({cells['beam_pfa']}),{beam},{typed})"


def _read(peak: str, axis: str, cells: Mapping[str, str]) -> str:
    """Expression for PFA/PGA ("a") or PFV/PGV ("v") of a floor; an error where its z/h is a word."""
    nodes, at = f"nodes_{axis}_{peak}", cells["place_at"]
    along = f"INDEX({nodes},{at})+{cells['place_part']}*(INDEX({nodes},{at}+1)-INDEX({nodes},{at}))"
    return f'IF({cells["place"]}="",INDEX({nodes},{_COLUMNS + 1}),{along})'


def could_serve(z: str) -> str:
    """Return an expression for whether the ground or other floors could serve a floor that has no motion of its own.

    What is filled in counts, be it usable or not: what is wrong with it is the program's to say.
    """
    placed = f'{_OWNING}*(floor_z<>"")'
    # A floor at grade is the ground of those below it, too.
    limits = f"<=MAX(0,{z})", f">={z}"
    below, above = (f"SUMPRODUCT({placed}*(ISTEXT(floor_z)+(floor_z{limit})>0))" for limit in limits)
    by_code = f'AND(ground_named,OR({z}<>"",storeys_serve))'
    by_storeys = f'AND({z}="",storeys_serve,ground_named,floors_owning>0)'
    between_floors = f'OR({by_storeys},AND({z}<>"",{above}>0,OR(ground_named,{below}>0)))'
    by_number = "AND(storeys_serve,floors_owning>0)"
    beside_floors = f'OR(ground_named,grade_row>0,{by_number},AND({z}<>"",SUMPRODUCT({placed})>0))'
    is_own = 'OR(scenario_kind="recorded",scenario_kind="given")'
    return f"IF(scenario_is_own=0,{by_code},IF({is_own},{between_floors},{beside_floors}))"
