"""The live formulas of the sheet Items, and of what tells there and in Floors that an input was edited since the run.

A verified class holds for the inputs that were integrated. Where one of them is edited it is void, and the class of the
formula is in force again until assess is run anew.
"""

from collections.abc import Callable, Mapping

from assess.inventory import live
from assess.risk import RiskClass

ANCHORED = "⚓ "
"""Mark before the class of an anchored piece, which is that of the piece without its anchor; it is not coloured."""

EDITED = "edited"
"""What stands where an input was edited since the run."""

NOT_VERIFIED, VOID = "not verified", "void: inputs changed"
"""What stands for a class by verification where there is none."""

MAY_BE, LOWERED = ", may be ", ", lowered by verification (formula: "
"""What is said behind a class by verification."""

TOLERANCE = "1E-9"
"""How far a number may lie from the one as run [-] before it counts as edited."""

EDITED_LETTERS = {"X": "J", "Y": "K"}
"""Columns of the sheet Floors that say whether the motion along an axis was edited."""

LIMITS = ("limit_medium", "limit_high", "limit_very_high")
"""Names of the cells that hold the limits of the classes."""


def item_formula(which: str, cells: Mapping[str, str], last: int) -> str:
    """Return a formula of `ItemColumn` for the cells of one row; `last` is the last row of Floors."""
    ratio, pfa, pfv = cells["B/H"], cells["PFA used [g]"], cells["PFV used [cm/s]"]
    breadth, height, risk = cells["Breadth [cm]"], cells["Height [cm]"], cells["OR"]

    def shown() -> str:
        return f'IF(ISNUMBER({risk}),{live.risk_class(risk, ratio, pfa, LIMITS)},"check")'

    def checked(formula: str) -> str:
        return f'IF(AND(ISNUMBER({ratio}),ISNUMBER({pfa})),{formula},"check")'

    formulas: dict[str, Callable[[], str]] = {
        "ratio": lambda: f'IFERROR(IF(OR({breadth}<=0,{height}<=0),"check",{breadth}/{height}),"check")',
        "axis": lambda: _axis(cells, last),
        "pfa": lambda: _on_axis(cells, "C", "F", last),
        "pfv": lambda: _on_axis(cells, "D", "G", last),
        "raw": lambda: checked(live.equation_9(ratio, pfa)),
        "or": lambda: checked(live.proposed_or(ratio, pfa)),
        "kh": lambda: checked(live.kaneko_hayashi(ratio, height, pfa, pfv, "zeta_a", "zeta_v", "slide_alpha")),
        "class": lambda: f"{_mark(cells)}&{shown()}",
        "verified": lambda: _verified_class(cells),
        "in_force": lambda: _class_in_force(cells),
        "edited": lambda: _edited(cells, last),
        "rank": lambda: _rank_verified(cells),
        "rank_upper": lambda: f"MAX({cells['Rank']},{_rank(cells['Upper end as run'])})",
        "rank_formula": lambda: f'IF(ISNUMBER({risk}),{_rank(risk)},"")',
    }
    return f"={formulas[which]()}"


def edited_motion(pfa: str, pfv: str, pfa_as_run: str, pfv_as_run: str, *, counts_pfv: bool, had_pfv: bool) -> str:
    """Return the formula that tells whether a floor's motion along an axis is another than as run.

    PFV counts where the motions were made for it; where it was blank as run, any value is another.
    """
    tests = [_differs(pfa, pfa_as_run)]
    if counts_pfv:
        tests.append(_differs(pfv, pfv_as_run) if had_pfv else f'{pfv}<>""')
    return f'=IF(IFERROR(OR({",".join(tests)}),TRUE),"{EDITED}","")'


def _differs(now: str, as_run: str) -> str:
    return f"ABS({now}-{as_run})>{TOLERANCE}*{as_run}"


def _floor_value(cells: Mapping[str, str], letter: str, last: int) -> str:
    return f"INDEX(Floors!${letter}$2:${letter}${last},MATCH({cells['Floor']},Floors!$A$2:$A${last},0))"


def _axis(cells: Mapping[str, str], last: int) -> str:
    given, x, y = cells["Axis given"], _floor_value(cells, "C", last), _floor_value(cells, "F", last)
    return f'IF({given}<>"",{given},{live.worse_axis(x, y)})'


def _on_axis(cells: Mapping[str, str], for_x: str, for_y: str, last: int) -> str:
    x, y = _floor_value(cells, for_x, last), _floor_value(cells, for_y, last)
    chosen = f'IF({cells["Axis"]}="X",{x},{y})'
    return f'IF({chosen}="","",{chosen})'


def _mark(cells: Mapping[str, str]) -> str:
    return f'IF({cells["Anchored"]}="yes","{ANCHORED}","")'


def _edited(cells: Mapping[str, str], last: int) -> str:
    """Tell whether the size, the floor, the axis or the motion along it is another than as run."""
    axis = cells["Axis given"]
    tests = [
        _differs(cells["Breadth [cm]"], cells["Breadth as run [cm]"]),
        _differs(cells["Height [cm]"], cells["Height as run [cm]"]),
        f"{cells['Floor']}<>{cells['Floor as run']}",
        f"{axis}<>{cells['Axis given as run']}",
        *(
            f'IF({axis}="{other}",FALSE,{_floor_value(cells, EDITED_LETTERS[own], last)}="{EDITED}")'
            for own, other in (("X", "Y"), ("Y", "X"))
        ),
    ]
    return f'IF(IFERROR(OR({",".join(tests)}),TRUE),"{EDITED}","")'


def _rank(chance: str) -> str:
    """Return the place of a chance's class, 0 for low."""
    medium, high, very_high = LIMITS
    return f"IF({chance}>={very_high},3,IF({chance}>={high},2,IF({chance}>={medium},1,0)))"


def _rank_verified(cells: Mapping[str, str]) -> str:
    at_least = f'IF({cells["Fell under the record"]}="yes",{int(RiskClass.HIGH)},0)'
    return f'IF({cells["Edited"]}="{EDITED}","",MAX({_rank(cells["Chance behind the class"])},{at_least}))'


def _label(rank: str) -> str:
    return f"CHOOSE({rank}+1,{_LABELS})"


_LABELS = ",".join(f'"{risk.label}"' for risk in RiskClass)


def _verified_class(cells: Mapping[str, str]) -> str:
    rank, upper, formula = cells["Rank"], cells["Rank, upper"], cells["Rank, formula"]
    may_be = f'IF({upper}>{rank},"{MAY_BE}"&{_label(upper)},"")'
    lowered = f'IF({formula}>{rank},"{LOWERED}"&{_label(formula)}&")","")'
    return f'IF(ISNUMBER({rank}),{_mark(cells)}&{_label(rank)}&{may_be}&{lowered},"{VOID}")'


def _class_in_force(cells: Mapping[str, str]) -> str:
    rank = cells["Rank"]
    return f"IF(ISNUMBER({rank}),{_mark(cells)}&{_label(rank)},{cells['Class (formula)']})"
