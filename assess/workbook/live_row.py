"""The formulas of the rows of Items, which show their classes as one types."""

from collections.abc import Mapping

from assess.methods import adopted_formula, paper_formula
from assess.model import NEAR_AXIS
from assess.risk import RiskClass
from assess.rocking.block import MIDDLE, ROLLS_FROM
from assess.rocking.draws import BASE, CENTRE, CUT, HEIGHT, MARGIN, SCANNED_BASE, SCANNED_HEIGHT
from assess.settings import Settings
from assess.units import ROUNDING
from assess.workbook import formulas as live
from assess.workbook.formulas import find_row, is_among, quote, trim
from assess.workbook.lists import EMPTY, LETTERS, NO_SHAKING, NO_UNIT, ROW, RUN_ASSESS, WRONG
from assess.workbook.schema import CLASS, CLASS_OR, ITEMS, LIVE, NO, WORKINGS, YES

NO_FLOOR, NO_AXIS, NO_TYPE = "floor?", "axis?", "type?"
"""What the live columns show without a known floor, with an unknown axis, and where no known type gives the sizes."""
IS_ANCHORED, IS_ROLLING = "anchored", "rolls"
"""What they show in place of the class of a piece that is anchored, or that stands on castors and rolls."""


def list_live() -> dict[str, str]:
    """Return a formula for each of `schema.LIVE` and `schema.WORKINGS`, with `ROW` for the number of the row."""
    cells = {label: f"${LETTERS[ITEMS.name, label]}{ROW}" for label in (*LIVE, *WORKINGS)}
    own = {column.name: f"${LETTERS[ITEMS.name, column.name]}{ROW}" for column in ITEMS.columns}
    ratio, pfa, *_ = (cells[label] for label in LIVE)
    floor, kind, axis, pfv, breadth, height = (cells[label] for label in WORKINGS)
    wrong, settings = quote(WRONG), Settings()

    row_of_type = f"IFERROR({find_row(trim(own['type']), 'type_key')},{quote(NO_TYPE)})"
    angle, near, worse = own["angle_deg"], f"<={NEAR_AXIS:g}", f"INDEX(floor_best,{floor})"
    turned = f'IF(ABS(MOD({angle}+90,180)-90){near},"X",IF(ABS(MOD({angle},180)-90){near},"Y",{worse}))'
    by_angle = f'IF(TRIM({angle})="",{worse},IF(ISNUMBER({angle}),{turned},{wrong}))'
    used = f'IF(TRIM({own["axis"]})="",{by_angle},{trim(own["axis"])})'
    inputs = {
        "Row in Floors": f"IFERROR({find_row(trim(own['floor']), 'floor_key')},{quote(NO_FLOOR)})",
        "Row in Catalogue": f'IF(TRIM({own["type"]})="","",{row_of_type})',
        "Axis used": f"IF(ISNUMBER({floor}),{used},{floor})",
    }
    for label, what, otherwise in (
        ("PFA used [g]", "pfa", f"IF({axis}={wrong},{axis},{quote(NO_AXIS)})"), ("PFV used [cm/s]", "pfv", EMPTY),
    ):  # fmt: skip
        x, y = (f"INDEX(floor_{what}_{letter},{floor})" for letter in "xy")
        served = f'IF({axis}="X",{x},IF({axis}="Y",{y},{otherwise}))'
        inputs[label] = f"IF(ISNUMBER({floor}),IFERROR({served},{wrong}),{floor})"
    for label, name in (("Breadth used [cm]", "breadth"), ("Height used [cm]", "height")):
        listed = f"IF(ISNUMBER({kind}),INDEX(type_{name},{kind}),{kind})"
        number = f"IF(ISNUMBER({own[name]}),{own[name]}*unit_items_{name}*100,{wrong})"
        inputs[label] = f'IF(sizes_unit<>"",sizes_unit,IF(TRIM({own[name]})="",{listed},{number}))'

    # B/H; where one of them is no size what is shown in its place, a wrong one first. Breadth is the shorter plan side:
    # the program refuses one above the width. No number is above a text.
    width = f'IFERROR(IF(TRIM({own["width"]})="",INDEX(type_width,{kind}),{own["width"]}*unit_items_width*100),"")'
    in_range = (live.between(size, ITEMS.column("breadth"), 100) for size in (breadth, height))
    inside = f"AND({','.join(in_range)},{breadth}*{1 - ROUNDING!r}<={width})"
    other = f"IF({height}={wrong},{height},IF(ISNUMBER({breadth}),{height},{breadth}))"
    share = f"IF({inside},{breadth}/{height},{wrong})"

    references = {"breadth_to_height": ratio, "height_cm": height, "pfa_g": pfa, "pfv_cm_s": pfv}
    results = {"Can rock": _can_rock(cells, own)}
    for method in live.LIVE_METHODS:
        parameters = {one.setting: f"{getattr(settings, one.setting):.12g}" for one in method.parameters}
        results[method.short_title] = live.write_live(method, references, parameters)["value"]
    ready = {name: f"=IF(ISNUMBER({ratio}),IF(ISNUMBER({pfa}),{one},{pfa}),{ratio})" for name, one in results.items()}
    filled = {name: f'=IF({own["item"]}="","",{one})' for name, one in inputs.items()}
    by_class = _write_classes(cells, own)
    formulas = ready | filled | by_class | {LIVE[0]: f"=IF(COUNT({breadth},{height})=2,{share},{other})"}
    return {label: formulas[label] for label in (*LIVE, *WORKINGS)}


def _write_classes(cells: Mapping[str, str], own: Mapping[str, str]) -> dict[str, str]:
    """Return the formulas of the classes: by the paper, and by the formula that the sheet Building chooses."""
    adopted, paper, (ratio, pfa, *_, rocks) = adopted_formula(), paper_formula(), (cells[label] for label in LIVE)
    words = {}
    for method in (adopted, paper):
        found = live.risk_class(method, f"SUM({cells[method.short_title]})", ratio, pfa)  # of a text: 0
        words[method.key] = f'IF({rocks}={quote(NO)},"{live.say_class(RiskClass.LOW)}",{found})'
    risk = cells[paper.short_title]
    # whether a bracket of known capacity holds is for the program to say
    held = f'IF(TRIM({own["bracket_capacity"]})="",{quote(IS_ANCHORED)},{quote(RUN_ASSESS)})'
    is_anchored = is_among(own["anchored"], "anchored_words")
    kind, blank = cells["Row in Catalogue"], f'TRIM({own["mobile"]})=""'
    mobile = f"IF({blank},INDEX(type_mobile,{kind}),{is_among(own['mobile'], 'mobile_words')})"
    rolls = f"IFERROR(AND({mobile},{ratio}/(2*{_centre(cells, own)})>={ROLLS_FROM * (1 - ROUNDING)!r}),FALSE)"
    classed = f"IF({rolls},{quote(IS_ROLLING)},{words[paper.key]})"
    either = f"IF({is_anchored},{held},IF(ISNUMBER({risk}),{classed},{risk}))"
    is_ready = f"OR(ISNUMBER({risk}),{risk}={quote(RUN_ASSESS)},{risk}={quote(NO_SHAKING)})"
    by_paper, chosen = cells[CLASS_OR], cells[adopted.short_title]
    is_held = ",".join(f"{by_paper}={quote(word)}" for word in (IS_ANCHORED, IS_ROLLING, RUN_ASSESS))
    is_none = f'AND(ISNUMBER({ratio}),{live.is_stocky(ratio)},{chosen}="")'
    is_known = f"OR(ISNUMBER({chosen}),{is_none})"
    found = f"IF(OR({is_held},NOT({is_known})),{by_paper},{words[adopted.key]})"
    return {CLASS: f"=IF(class_by=2,{by_paper},{found})", CLASS_OR: f"=IF({is_ready},{either},{risk})"}


def _centre(cells: Mapping[str, str], own: Mapping[str, str]) -> str:
    """Expression for the height of the centre of gravity as a share of the piece's: its own, else its type's."""
    kind, wrong = cells[WORKINGS[1]], quote(WRONG)
    typed, unit = own["centre_of_gravity"], "unit_items_centre_of_gravity"
    inside = live.between(f"{typed}*{unit}", ITEMS.column("centre_of_gravity"))
    number = f"IF(ISNUMBER({typed}),IF({inside},{typed}*{unit},{wrong}),{wrong})"
    of_type = f"IF(ISNUMBER({kind}),INDEX(type_centre_of_gravity,{kind}),{MIDDLE!r})"
    return f'IF(TRIM({typed})="",{of_type},{number})'


def _can_rock(cells: Mapping[str, str], own: Mapping[str, str]) -> str:
    """Expression for whether the strongest motion that may be drawn can start it: PFA e^(3 s) >= 0.65 g b/z.

    s is as in `assess.pipeline.adopt.find_can_rock`. One that is too stocky never rocks. Where either axis serves
    the larger PFA counts, though the motion of the larger PFV governs: a row is then never lower than in a run.
    """
    ratio, pfa, *_ = (cells[label] for label in LIVE)
    floor, angle, wrong, centre = cells[WORKINGS[0]], own["angle_deg"], quote(WRONG), _centre(cells, own)
    units = [f"unit_{sheet}_centre_of_gravity" for sheet in ("items", "catalogue")]
    sizes = (SCANNED_BASE[1], SCANNED_HEIGHT), (BASE[1], HEIGHT)
    by_scan, usual = (f"{base**2 + height**2:.6g}" for base, height in sizes)
    fixed = f"IF({is_among(own['sizes_from'], 'scanned_words')},{by_scan},{usual})"
    spread = f"SQRT(INDEX(floor_spread,{floor})+{fixed}+({CENTRE!r}/({centre}))^2)"
    turned = f"IF(ISNUMBER({angle}),ABS(MOD({angle},90)-45)<{45 - NEAR_AXIS:g},TRUE)"
    is_free = f'IF(TRIM({own["axis"]})="",{turned},FALSE)'
    strongest = f"IF({is_free},MAX(INDEX(floor_pfa_x,{floor}),INDEX(floor_pfa_y,{floor})),{pfa})"
    starts = f"{strongest}*EXP({CUT:g}*{spread})>={MARGIN / 2!r}*{ratio}/({centre})"
    rocks = f"AND({starts},{live.is_slender(ratio, centre)})"
    unread = f"OR({','.join(f'ISTEXT({unit})' for unit in units)})"
    return f"IFERROR(IF({rocks},{quote(YES)},{quote(NO)}),IF({unread},{quote(NO_UNIT)},{wrong}))"
