"""The live formulas of the sheet Items, and of what tells there and in Floors that an input was edited since the run.

A verified class holds for the inputs that were integrated. Where one of them is edited it is void, and the class of the
formula is in force again until assess is run anew.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from assess.inventory import live
from assess.language import gettext as _
from assess.report.xlsx.said import ANCHORED, Terms, hole, join, literal
from assess.risk import RiskClass

TOLERANCE = "1E-9"
"""How far a number may lie from the one as run [-] before it counts as edited."""

EDITED_LETTERS = {"X": "J", "Y": "K"}
"""Columns of the sheet Floors that say whether the motion along an axis was edited."""

LIMITS = ("limit_medium", "limit_high", "limit_very_high")
"""Names of the cells that hold the limits of the classes."""

ROW = "\x00"
"""Stands for the number of the row in a formula."""

CLASS_WEIGHT, ROW_WEIGHT = 10, "1E-9"
"""In the order of the pieces a class weighs more than any chance; of equal chances the upper row comes first."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where formulas look: the cells of a row of Items by the keys of their columns, and Floors with its last row."""

    cells: Mapping[str, str]
    floors: str
    last: int
    terms: Terms

    def floor(self, letter: str) -> str:
        """Return the value in a column of Floors for the row's floor."""
        area, names = (f"{self.floors}${one}$2:${one}${self.last}" for one in (letter, "A"))
        return f"INDEX({area},MATCH({self.cells['floor']},{names},0))"


def item_formulas(place: Place) -> dict[str, str]:
    """Return the formulas of a row of Items by the keys of their columns."""
    cells, check = place.cells, literal(place.terms.check)
    ratio, pfa, pfv, risk = (cells[key] for key in ("ratio", "pfa", "pfv", "or"))
    breadth, height, rank = cells["breadth"], cells["height"], cells["rank"]

    def checked(formula: str) -> str:
        return f"IF(AND(ISNUMBER({ratio}),ISNUMBER({pfa})),{formula},{check})"

    classed = f"IF(ISNUMBER({risk}),{live.risk_class(risk, ratio, pfa, LIMITS)},{check})"
    formulas = {
        "ratio": f"IFERROR(IF(OR({breadth}<=0,{height}<=0),{check},{breadth}/{height}),{check})",
        "axis": _axis(place),
        "pfa": _on_axis(place, "C", "F"),
        "pfv": _on_axis(place, "D", "G"),
        "raw": checked(live.equation_9(ratio, pfa)),
        "or": checked(live.proposed_or(ratio, pfa)),
        "kh": checked(live.kaneko_hayashi(ratio, height, pfa, pfv, "zeta_a", "zeta_v", "slide_alpha")),
        "class_formula": f"{_mark(place)}&{classed}",
        "class_verified": _verified_class(place),
        "class": f"IF(ISNUMBER({rank}),{_mark(place)}&{place.terms.label(rank)},{cells['class_formula']})",
        "chance": f"IF(ISNUMBER({rank}),{cells['chance_run']},{risk})",
        "edited": _edited(place),
        "rank": _rank_verified(place),
        "rank_upper": f"MAX({rank},{_rank(cells['upper_end'])})",
        "rank_formula": f'IF(ISNUMBER({risk}),{_rank(risk)},"")',
        "order": _order(place),
    }
    return {key: f"={formula}" for key, formula in formulas.items()}


def unverified(formulas: Mapping[str, str], cells: Mapping[str, str], terms: Terms) -> dict[str, str]:
    """Return the formulas of the rows that were not verified: what is in force there is the formula's."""
    risk = cells["or"]
    order = _ordered(cells, terms, _rank(risk))
    return dict(formulas) | {"class": f"={cells['class_formula']}", "chance": f"={risk}", "order": f"={order}"}


def edited_motion(terms: Terms, cells: tuple[str, str, str, str], *, counts_pfv: bool, had_pfv: bool) -> str:
    """Return the formula that tells whether a floor's motion along an axis is another than as run.

    `cells` hold PFA and PFV, and both as run. PFV counts where the motions were made for it; where it was blank as run,
    any value is another.
    """
    pfa, pfv, pfa_as_run, pfv_as_run = cells
    tests = [_differs(pfa, pfa_as_run)]
    if counts_pfv:
        tests.append(_differs(pfv, pfv_as_run) if had_pfv else f'{pfv}<>""')
    return f'=IF(IFERROR(OR({",".join(tests)}),TRUE),{literal(terms.edited)},"")'


def _differs(now: str, as_run: str) -> str:
    return f"ABS({now}-{as_run})>{TOLERANCE}*{as_run}"


def _axis(place: Place) -> str:
    given, x, y = place.cells["axis_given"], place.floor("C"), place.floor("F")
    return f'IF({given}<>"",{given},{live.worse_axis(x, y)})'


def _on_axis(place: Place, for_x: str, for_y: str) -> str:
    chosen = f'IF({place.cells["axis"]}="X",{place.floor(for_x)},{place.floor(for_y)})'
    return f'IF({chosen}="","",{chosen})'


def _mark(place: Place) -> str:
    return f'IF({place.cells["anchored"]}={literal(place.terms.yes)},{literal(ANCHORED)},"")'


def _edited(place: Place) -> str:
    """Tell whether the size, the floor, the axis or the motion along it is another than as run."""
    cells, edited = place.cells, literal(place.terms.edited)
    axis = cells["axis_given"]
    tests = [
        _differs(cells["breadth"], cells["breadth_run"]),
        _differs(cells["height"], cells["height_run"]),
        f"{cells['floor']}<>{cells['floor_run']}",
        f"{axis}<>{cells['axis_given_run']}",
        *(
            f'IF({axis}="{other}",FALSE,{place.floor(EDITED_LETTERS[own])}={edited})'
            for own, other in (("X", "Y"), ("Y", "X"))
        ),
    ]
    return f'IF(IFERROR(OR({",".join(tests)}),TRUE),{edited},"")'


def _rank(chance: str) -> str:
    """Return the place of a chance's class, 0 for low."""
    medium, high, very_high = LIMITS
    return f"IF({chance}>={very_high},3,IF({chance}>={high},2,IF({chance}>={medium},1,0)))"


def _rank_verified(place: Place) -> str:
    cells = place.cells
    at_least = f"IF({cells['fell']}=1,{int(RiskClass.HIGH)},0)"
    return f'IF({cells["edited"]}={literal(place.terms.edited)},"",MAX({_rank(cells["behind"])},{at_least}))'


def _order(place: Place) -> str:
    """Return the number by which pieces stand in order of their class and chance; nothing for anchored ones."""
    rank = place.cells["rank"]
    return _ordered(
        place.cells,
        place.terms,
        f"IF(ISNUMBER({rank}),{place.cells['rank_upper']},{_rank(place.cells['or'])})",
    )


def _ordered(cells: Mapping[str, str], terms: Terms, rank: str) -> str:
    free = f"AND({cells['anchored']}<>{literal(terms.yes)},ISNUMBER({cells['chance']}))"
    return f'IF({free},{CLASS_WEIGHT}*{rank}+{cells["chance"]}-ROW()*{ROW_WEIGHT},"")'


def _verified_class(place: Place) -> str:
    rank, upper, formula = (place.cells[key] for key in ("rank", "rank_upper", "rank_formula"))
    may_be = join(", " + _("may be {risk}", risk=hole(0)), place.terms.label(upper))
    lowered = join(
        ", " + _("lowered by verification (formula: {risk})", risk=hole(0)),
        place.terms.label(formula),
    )
    notes = f'IF({upper}>{rank},{may_be},"")&IF({formula}>{rank},{lowered},"")'
    return f"IF(ISNUMBER({rank}),{_mark(place)}&{place.terms.label(rank)}&{notes},{literal(place.terms.void)})"
