"""The formulas of the rows of Items, which show their classes as one types."""

from collections.abc import Mapping

from assess.i18n import gettext
from assess.methods import Method, adopted_formula, paper_formula
from assess.model import NEAR_AXIS
from assess.risk import RiskClass
from assess.rocking.block import MIDDLE
from assess.rocking.draws import BASE, CENTRE, CUT, HEIGHT, MARGIN, SCANNED_BASE, SCANNED_HEIGHT
from assess.settings import Settings
from assess.units import ROUNDING
from assess.workbook import formulas as live
from assess.workbook.formulas import find_row, is_among, trim
from assess.workbook.lists import LETTERS, NO_SHAKING, NO_UNIT, ROW, RUN_ASSESS, WRONG
from assess.workbook.schema import CLASS_OR, ITEMS, LIVE, NO, WORKINGS, YES

NO_FLOOR, NO_AXIS, NO_TYPE = "floor?", "axis?", "type?"
"""What the live columns show without a known floor, with an unknown axis, and where no known type gives the sizes."""

IS_ANCHORED = "anchored"
"""What they show in place of the class of a piece that is anchored."""


def list_live() -> dict[str, str]:
    """Return a formula for each of `schema.LIVE` and `schema.WORKINGS`, with `ROW` for the number of the row."""
    cells = {label: f"${LETTERS[ITEMS.name, label]}{ROW}" for label in (*LIVE, *WORKINGS)}
    ratio, pfa, *_ = (cells[label] for label in LIVE)
    floor, kind, axis, pfv, breadth, height = (cells[label] for label in WORKINGS)
    references = {"breadth_to_height": ratio, "height_cm": height, "pfa_g": pfa, "pfv_cm_s": pfv}
    return dict(zip((*LIVE, *WORKINGS), (
        _divide(breadth, height, _width(kind)),
        _unless_blank(_served(floor, axis, "pfa", f'IF({axis}={_say(WRONG)},{axis},{_say(NO_AXIS)})')),
        *(_ready(ratio, pfa, _write(method, references)) for method in live.LIVE_METHODS),
        _chosen_class(cells),
        _paper_class(cells),
        _ready(ratio, pfa, _can_rock(ratio, pfa, kind, floor)),
        _unless_blank(f"IFERROR({find_row(trim(_own('floor')), 'floor_key')},{_say(NO_FLOOR)})"),
        _unless_blank(_kind()),
        _unless_blank(f"IF(ISNUMBER({floor}),{_axis(floor)},{floor})"),
        _unless_blank(_served(floor, axis, "pfv", '""')),
        *(_unless_blank(_size(name, kind)) for name in ("breadth", "height")),
    ), strict=True))  # fmt: skip


def _own(name: str) -> str:
    return f"${LETTERS['Items', name]}{ROW}"


def _unless_blank(formula: str) -> str:
    return f'=IF({_own("item")}="","",{formula})'


def _chosen_class(cells: Mapping[str, str]) -> str:
    by_paper, risk = cells[CLASS_OR], cells[adopted_formula().short_title]
    is_held = ",".join(f"{by_paper}={_say(word)}" for word in (IS_ANCHORED, RUN_ASSESS))
    is_none = f'AND(ISNUMBER({cells[LIVE[0]]}),{live.is_stocky(cells[LIVE[0]])},{risk}="")'
    is_known = f"OR(ISNUMBER({risk}),{is_none})"
    found = f"IF(OR({is_held},NOT({is_known})),{by_paper},{_find_class(adopted_formula(), cells)})"
    return f"=IF(class_by=2,{by_paper},{found})"


def _paper_class(cells: Mapping[str, str]) -> str:
    risk = cells[paper_formula().short_title]
    is_anchored, is_known = is_among(_own("anchored"), "anchored_words"), _own("bracket_capacity")
    # whether a bracket of known capacity holds is for the program to say
    held = f'IF(TRIM({is_known})="",{_say(IS_ANCHORED)},{_say(RUN_ASSESS)})'
    either = f"IF({is_anchored},{held},IF(ISNUMBER({risk}),{_find_class(paper_formula(), cells)},{risk}))"
    is_ready = f"OR(ISNUMBER({risk}),{risk}={_say(RUN_ASSESS)},{risk}={_say(NO_SHAKING)})"
    return f"=IF({is_ready},{either},{risk})"


def _kind() -> str:
    own = _own("type")
    return f'IF(TRIM({own})="","",IFERROR({find_row(trim(own), "type_key")},{_say(NO_TYPE)}))'


def _size(name: str, kind: str) -> str:
    own, listed = _own(name), f"IF(ISNUMBER({kind}),INDEX(type_{name},{kind}),{kind})"
    number = f"IF(ISNUMBER({own}),{own}*unit_items_{name}*100,{_say(WRONG)})"
    return f'IF(sizes_unit<>"",sizes_unit,IF(TRIM({own})="",{listed},{number}))'


def _width(kind: str) -> str:
    own = _own("width")
    return f'IFERROR(IF(TRIM({own})="",INDEX(type_width,{kind}),{own}*unit_items_width*100),"")'


def _can_rock(ratio: str, pfa: str, kind: str, floor: str) -> str:
    """Expression for whether the strongest motion that may be drawn can start it: PFA e^(3 s) >= 0.65 g b/z.

    s is as in `assess.pipeline.adopt.find_can_rock`. One that is too stocky never rocks. Where either axis serves
    the larger PFA counts, though the motion of the larger PFV governs: a row is then never lower than in a run.
    """
    sizes = (SCANNED_BASE[1], SCANNED_HEIGHT), (BASE[1], HEIGHT)
    by_scan, usual = (f"{base**2 + height**2:.6g}" for base, height in sizes)
    fixed = f"IF({is_among(_own('sizes_from'), 'scanned_words')},{by_scan},{usual})"
    units = [f"unit_{sheet}_centre_of_gravity" for sheet in ("items", "catalogue")]
    centre = _centre(units[0], kind)
    spread = f"SQRT(INDEX(floor_spread,{floor})+{fixed}+({CENTRE!r}/({centre}))^2)"
    strongest = f"MAX(INDEX(floor_pfa_x,{floor}),INDEX(floor_pfa_y,{floor}))"
    pfa = f"IF({_is_free()},{strongest},{pfa})"
    starts = f"AND({pfa}*EXP({CUT:g}*{spread})>={MARGIN / 2!r}*{ratio}/({centre}),{live.is_slender(ratio, centre)})"
    unread = f"OR({','.join(f'ISTEXT({unit})' for unit in units)})"
    fault = f"IF({unread},{_say(NO_UNIT)},{_say(WRONG)})"
    return f"IFERROR(IF({starts},{_say(YES)},{_say(NO)}),{fault})"


def _centre(unit: str, kind: str) -> str:
    own = _own("centre_of_gravity")
    inside = live.between(f"{own}*{unit}", ITEMS.column("centre_of_gravity"))
    number = f"IF(ISNUMBER({own}),IF({inside},{own}*{unit},{_say(WRONG)}),{_say(WRONG)})"
    return f'IF(TRIM({own})="",IF(ISNUMBER({kind}),INDEX(type_centre_of_gravity,{kind}),{MIDDLE!r}),{number})'


def _is_free() -> str:
    angle = _own("angle_deg")
    turned = f"IF(ISNUMBER({angle}),ABS(MOD({angle},90)-45)<{45 - NEAR_AXIS:g},TRUE)"
    return f'IF(TRIM({_own("axis")})="",{turned},FALSE)'


def _axis(floor: str) -> str:
    axis, angle, near = trim(_own("axis")), _own("angle_deg"), f"<={NEAR_AXIS:g}"
    worse = f"INDEX(floor_best,{floor})"
    turned = f'IF(ABS(MOD({angle}+90,180)-90){near},"X",IF(ABS(MOD({angle},180)-90){near},"Y",{worse}))'
    by_angle = f'IF(TRIM({angle})="",{worse},IF(ISNUMBER({angle}),{turned},{_say(WRONG)}))'
    return f'IF(TRIM({_own("axis")})="",{by_angle},{axis})'


def _find_class(method: Method, cells: Mapping[str, str]) -> str:
    ratio, pfa, *_, rocks = (cells[label] for label in LIVE)
    found = live.risk_class(method, f"SUM({cells[method.short_title]})", ratio, pfa)  # of a text: 0
    return f'IF({rocks}={_say(NO)},"{live.say_class(RiskClass.LOW)}",{found})'


def _say(hint: str) -> str:
    return f'"{gettext(hint)}"'


def _divide(breadth: str, height: str, width: str) -> str:
    """Return the formula for B/H; where one of them is no size what is shown in its place, a wrong one first.

    Breadth is the shorter side of the plan: the program refuses one above the width. No number is above a text.
    """
    size = ITEMS.column("breadth")
    is_shorter = f"{breadth}*{1 - ROUNDING!r}<={width}"
    inside = f"AND({live.between(breadth, size, 100)},{live.between(height, size, 100)},{is_shorter})"
    ratio = f"IF({inside},{breadth}/{height},{_say(WRONG)})"
    other = f"IF({height}={_say(WRONG)},{height},IF(ISNUMBER({breadth}),{height},{breadth}))"
    return f"=IF(COUNT({breadth},{height})=2,{ratio},{other})"


def _served(floor: str, axis: str, what: str, otherwise: str) -> str:
    x, y = (f"INDEX(floor_{what}_{letter},{floor})" for letter in "xy")
    served = f'IF({axis}="X",{x},IF({axis}="Y",{y},{otherwise}))'
    return f"IF(ISNUMBER({floor}),IFERROR({served},{_say(WRONG)}),{floor})"


def _write(method: Method, references: Mapping[str, str]) -> str:
    settings = Settings()
    parameters = {one.setting: f"{getattr(settings, one.setting):.12g}" for one in method.parameters}
    return live.write_live(method, references, parameters)["value"]


def _ready(ratio: str, pfa: str, formula: str) -> str:
    return f"=IF(ISNUMBER({ratio}),IF(ISNUMBER({pfa}),{formula},{pfa}),{ratio})"
