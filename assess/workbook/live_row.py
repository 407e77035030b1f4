"""The formulas of the rows of Items, which show their classes as one types."""

from collections.abc import Mapping
from dataclasses import dataclass

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext
from assess.methods import Method, adopted_formula
from assess.model import NEAR_AXIS
from assess.rocking.block import MIDDLE
from assess.rocking.draws import STILL
from assess.settings import Settings
from assess.workbook import formulas as live
from assess.workbook.lists import LETTERS, NO_UNIT
from assess.workbook.schema import ITEMS, LIVE, NO, WORKINGS, YES

FIRST = len(ITEMS.columns)
"""Place of the first live column, right of the columns to fill in."""

ROW = "\x00"
"""Stands for the number of the row in the formulas of `LiveRow`, which are the same for every row."""

NO_FLOOR, NO_AXIS, WRONG = "floor?", "axis?", "check"
"""What the live columns show without a known floor, with an unknown axis, and with sizes that are not numbers."""


@dataclass(frozen=True, slots=True)
class LiveRow:
    """A row of Items; `last` holds the last row of each table."""

    last: Mapping[str, int]

    def formulas(self) -> list[str]:
        """Return a formula for each of `schema.LIVE` and `schema.WORKINGS`, with `ROW` for the number of the row."""
        cells = [f"${xl_col_to_name(FIRST + at)}{ROW}" for at in range(len(LIVE) + len(WORKINGS))]
        ratio, pfa, *risks, _, _, axis, pfv, height = cells
        no_floor, no_axis, wrong = (f'"{gettext(hint)}"' for hint in (NO_FLOOR, NO_AXIS, WRONG))
        served = f'IF({axis}={no_floor},{axis},IF({axis}="","",{no_axis}))'
        breadth = self._size("breadth")
        sizes = f'IFERROR(IF(OR({breadth}<=0,{height}<=0),"",{breadth}*100/{height}),{wrong})'
        references = {"breadth_to_height": ratio, "height_cm": height, "pfa_g": pfa, "pfv_cm_s": pfv}
        risk = risks[live.LIVE_METHODS.index(adopted_formula())]
        return [
            self._unless_blank(f'IF(sizes_unit<>"",sizes_unit,{sizes})'),
            self._unless_blank(self._on(axis, "pfa", served)),
            *(_ready(ratio, pfa, _write(method, references)) for method in live.LIVE_METHODS),
            f"=IF(ISNUMBER({risk}),{live.risk_class(risk, ratio, pfa)},{risk})",
            _ready(ratio, pfa, self._can_rock(ratio, pfa)),
            self._unless_blank(f"IFERROR({self._axis()},{no_floor})"),
            self._unless_blank(self._on(axis, "pfv", '""')),
            self._unless_blank(f"IFERROR({self._size('height')}*100,{wrong})"),
        ]

    def _own(self, name: str) -> str:
        return f"${LETTERS['Items', name]}{ROW}"

    def _unless_blank(self, formula: str) -> str:
        return f'=IF({self._own("item")}="","",{formula})'

    def _size(self, name: str) -> str:
        """Expression for a size in m: the row's own, else its type's, else 0."""
        own, column, last = self._own(name), LETTERS["Catalogue", name], self.last["Catalogue"]
        sheet = gettext("Catalogue")
        listed = f"INDEX({sheet}!${column}$2:${column}${last},MATCH({self._own('type')},list_catalogue,0))"
        return f'IF({own}="",IFERROR({listed}*unit_catalogue_{name},0),{own}*unit_items_{name})'

    def _can_rock(self, ratio: str, pfa: str) -> str:
        """Expression for whether the strongest motion that may be drawn can start it: PFA e^(3 beta) >= 0.85 g b/z."""
        units = [f"unit_{sheet}_centre_of_gravity" for sheet in ("items", "catalogue")]
        yes, no, no_unit, wrong = (f'"{gettext(hint)}"' for hint in (YES, NO, NO_UNIT, WRONG))
        starts = f"{pfa}*strongest>={STILL!r}*{ratio}/(2*{self._centre(*units)})"
        fault = f"IF(OR({','.join(f'ISTEXT({unit})' for unit in units)}),{no_unit},{wrong})"
        return f"IFERROR(IF({starts},{yes},{no}),{fault})"

    def _centre(self, own_unit: str, listed_unit: str) -> str:
        """Expression for the height of the centre of gravity [-]: the row's own, else its type's, else the middle."""
        own, column = self._own("centre_of_gravity"), LETTERS["Catalogue", "centre_of_gravity"]
        place, sheet = f"MATCH({self._own('type')},list_catalogue,0)", gettext("Catalogue")
        listed = f"INDEX({sheet}!${column}$2:${column}${self.last['Catalogue']},{place})"
        of_type = f'IF(ISNUMBER({place}),IF({listed}="",{MIDDLE!r},{listed}*{listed_unit}),{MIDDLE!r})'
        return f'IF({own}="",{of_type},{own}*{own_unit})'

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


def _write(method: Method, references: Mapping[str, str]) -> str:
    """Return the formula of a method with the default settings."""
    settings = Settings()
    parameters = {one.setting: f"{getattr(settings, one.setting):.12g}" for one in method.parameters}
    return live.write_live(method, references, parameters)["value"]


def _ready(ratio: str, pfa: str, formula: str) -> str:
    """Show a result once B/H and PFA are numbers; until then what they say instead."""
    return f"=IF(ISNUMBER({ratio}),IF(ISNUMBER({pfa}),{formula},{pfa}),{ratio})"
