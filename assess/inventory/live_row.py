"""The formulas of one row of Items, which show its class as one types."""

from collections.abc import Mapping
from dataclasses import dataclass

from xlsxwriter.utility import xl_col_to_name

from assess.inventory import live
from assess.inventory.axes import NEAR_AXIS
from assess.inventory.columns import ITEMS
from assess.inventory.lists import LETTERS
from assess.settings import Settings

FIRST = len(ITEMS.columns)
"""Place of the first live column, right of the columns to fill in."""


@dataclass(frozen=True, slots=True)
class LiveRow:
    """One row of Items; `last` tells the last row of each table."""

    row: int
    last: Mapping[str, int]

    def formulas(self) -> list[str]:
        """Return a formula for each of `columns.LIVE`."""
        item = self._own("item")
        ratio, pfa, risk = (f"${xl_col_to_name(FIRST + at)}{self.row}" for at in (0, 1, 2))
        settings = Settings()
        zetas = (repr(settings.zeta_acceleration), repr(settings.zeta_velocity), repr(settings.slide_coefficient))
        height = f"({self._size('height')}*100)"
        return [
            f'=IF({item}="","",{self._ratio()})',
            f'=IF({item}="","",IFERROR({self._serving("pfa")},"floor?"))',
            _ready(ratio, pfa, live.proposed_or(ratio, pfa)),
            _ready(ratio, pfa, live.kaneko_hayashi(ratio, height, pfa, self._serving("pfv"), *zetas)),
            f"=IF(ISNUMBER({risk}),{live.risk_class(risk, ratio, pfa)},{risk})",
        ]

    def _own(self, name: str) -> str:
        return f"${LETTERS['Items', name]}{self.row}"

    def _ratio(self) -> str:
        breadth, height = self._size("breadth"), self._size("height")
        units = ",".join(
            f"ISTEXT(unit_{sheet}_{name})" for sheet in ("items", "catalogue") for name in ("breadth", "height")
        )
        blank = f"OR({breadth}<=0,{height}<=0)"
        return f'IF(OR({units}),"unit?",IFERROR(IF({blank},"",{breadth}/{height}),"check"))'

    def _size(self, name: str) -> str:
        """Expression for a size in m: the row's own, else its type's, else 0."""
        own, column, last = self._own(name), LETTERS["Catalogue", name], self.last["Catalogue"]
        match = f"MATCH({self._own('type')},Catalogue!$A$2:$A${last},0)"
        listed = f"INDEX(Catalogue!${column}$2:${column}${last},{match})"
        return f'IF({own}="",IFERROR({listed}*unit_catalogue_{name},0),{own}*unit_items_{name})'

    def _serving(self, what: str) -> str:
        """Expression for the PFA [g] or PFV [cm/s] that governs a row, from the helper columns of Lists."""
        axis, angle = f"TRIM({self._own('axis')})", self._own("angle_deg")
        match = f"MATCH({self._own('floor')},Floors!$A$2:$A${self.last['Floors']},0)"
        near = f"<={NEAR_AXIS:g}"
        turned = f'IF(ABS(MOD({angle}+90,180)-90){near},"X",IF(ABS(MOD({angle},180)-90){near},"Y",""))'
        own = f'IF({axis}<>"",{axis},IF({angle}="","",{turned}))'
        chosen = f'IF({own}="",INDEX(floor_best,{match}),{own})'
        x, y = (f"INDEX(floor_{what}_{letter},{match})" for letter in "xy")
        return f'IF({chosen}="X",{x},IF({chosen}="Y",{y},"axis?"))'


def _ready(ratio: str, pfa: str, formula: str) -> str:
    """Show a result once B/H and PFA are numbers; until then what they say instead."""
    return f"=IF(ISNUMBER({ratio}),IF(ISNUMBER({pfa}),{formula},{pfa}),{ratio})"
