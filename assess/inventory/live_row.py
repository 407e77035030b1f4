"""The formulas of one row of Items, which show its class as one types."""

from collections.abc import Mapping
from dataclasses import dataclass

from xlsxwriter.utility import xl_col_to_name

from assess.inventory import live
from assess.inventory.axes import NEAR_AXIS
from assess.inventory.columns import ITEMS, LIVE, WORKINGS
from assess.inventory.lists import LETTERS
from assess.language import gettext
from assess.settings import Settings

FIRST = len(ITEMS.columns)
"""Place of the first live column, right of the columns to fill in."""


NO_FLOOR, NO_AXIS, WRONG = "floor?", "axis?", "check"
"""What the live columns say of a row that names no floor, an axis that is none, and sizes that are no numbers."""


@dataclass(frozen=True, slots=True)
class LiveRow:
    """One row of Items; `last` tells the last row of each table."""

    row: int
    last: Mapping[str, int]

    def formulas(self) -> list[str]:
        """Return a formula for each of `columns.LIVE` and `columns.WORKINGS`."""
        cells = [f"${xl_col_to_name(FIRST + at)}{self.row}" for at in range(len(LIVE) + len(WORKINGS))]
        ratio, pfa, risk, _, _, axis, pfv, height = cells
        settings = Settings()
        zetas = (repr(settings.zeta_acceleration), repr(settings.zeta_velocity), repr(settings.slide_coefficient))
        no_floor, no_axis, wrong = (f'"{gettext(hint)}"' for hint in (NO_FLOOR, NO_AXIS, WRONG))
        served = f'IF({axis}={no_floor},{axis},IF({axis}="","",{no_axis}))'
        breadth = self._size("breadth")
        sizes = f'IFERROR(IF(OR({breadth}<=0,{height}<=0),"",{breadth}*100/{height}),{wrong})'
        return [
            self._unless_blank(f'IF(sizes_unit<>"",sizes_unit,{sizes})'),
            self._unless_blank(self._on(axis, "pfa", served)),
            _ready(ratio, pfa, live.proposed_or(ratio, pfa)),
            _ready(ratio, pfa, live.kaneko_hayashi(ratio, height, pfa, pfv, *zetas)),
            f"=IF(ISNUMBER({risk}),{live.risk_class(risk, ratio, pfa)},{risk})",
            self._unless_blank(f"IFERROR({self._axis()},{no_floor})"),
            self._unless_blank(self._on(axis, "pfv", '""')),
            self._unless_blank(f"IFERROR({self._size('height')}*100,{wrong})"),
        ]

    def _own(self, name: str) -> str:
        return f"${LETTERS['Items', name]}{self.row}"

    def _unless_blank(self, formula: str) -> str:
        return f'=IF({self._own("item")}="","",{formula})'

    def _size(self, name: str) -> str:
        """Expression for a size in m: the row's own, else its type's, else 0."""
        own, column, last = self._own(name), LETTERS["Catalogue", name], self.last["Catalogue"]
        sheet = gettext("Catalogue")
        listed = f"INDEX({sheet}!${column}$2:${column}${last},MATCH({self._own('type')},list_catalogue,0))"
        return f'IF({own}="",IFERROR({listed}*unit_catalogue_{name},0),{own}*unit_items_{name})'

    def _axis(self) -> str:
        """Expression for the axis that governs: the row's own, else its angle's, else the worse of the floor's."""
        axis, angle, near = f"TRIM({self._own('axis')})", self._own("angle_deg"), f"<={NEAR_AXIS:g}"
        worse = f"INDEX(floor_best,MATCH({self._own('floor')},list_floors,0))"
        turned = f'IF(ABS(MOD({angle}+90,180)-90){near},"X",IF(ABS(MOD({angle},180)-90){near},"Y",{worse}))'
        return f'IF({axis}<>"",{axis},IF({angle}="",{worse},{turned}))'

    def _on(self, axis: str, what: str, otherwise: str) -> str:
        """Expression for the PFA [g] or PFV [cm/s] along an axis, from the helper columns of Lists."""
        x, y = (f"INDEX(floor_{what}_{letter},MATCH({self._own('floor')},list_floors,0))" for letter in "xy")
        return f'IFERROR(IF({axis}="X",{x},IF({axis}="Y",{y},{otherwise})),"{gettext(NO_FLOOR)}")'


def _ready(ratio: str, pfa: str, formula: str) -> str:
    """Show a result once B/H and PFA are numbers; until then what they say instead."""
    return f"=IF(ISNUMBER({ratio}),IF(ISNUMBER({pfa}),{formula},{pfa}),{ratio})"
