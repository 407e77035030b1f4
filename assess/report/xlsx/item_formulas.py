"""The live formulas of Items, and those that show there and in Floors that an input was edited since the run.

A class that rests on a simulation holds for the inputs that were integrated. Where one of them is edited the row says
that assess is to be run again, and leaves every count, list and chart: it never falls back to the formula. What
formulas write and compare is in the report's language.
"""

import string
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext as _
from assess.methods import MethodInfo
from assess.model import AXES
from assess.results import CANNOT_ROCK
from assess.risk import RiskClass
from assess.workbook import formulas as live
from assess.workbook.formulas import say_class

ANCHORED = "⚓ "
"""Mark before the class of an anchored piece, which is that of the piece without its anchor; it is not coloured."""
TOLERANCE = "1E-9"
"""How far a number may lie from the one as run [-] before it counts as edited."""
LIMITS = ("limit_medium", "limit_high", "limit_very_high")
"""Names of the cells that hold the limits of the classes."""
ROW = "\x00"
"""Stands for the number of the row in a formula."""
CLASS_WEIGHT, ROW_WEIGHT = 10, "1E-9"
"""In the order of the pieces a class weighs more than any chance; of equal chances the upper row comes first."""
ABOVE_ANY_PEAK = "1E5"
"""Weighs more than any peak [cm/s]."""
SAME = ("breadth_cm", "width_cm", "height_cm", "centre_of_gravity", "friction")
"""Numbers of a row that a simulated class holds for; a blank one must stay blank."""
SAME_WORDS = ("floor", "axis_given")
"""Texts of a row that a simulated class holds for."""
BRACKET = ("bracket_capacity_kn", "bracket_height_cm", "weight_kg")
"""Numbers of a row that decide whether its bracket holds: the capacity first, without which none of them does."""
AT_RUN = ("chance", "low", "high", "beside")
"""What simulation found: shown while the row is as run."""
FLOOR_KEYS = (
    "floor", "name", "pfa_X", "pfv_X", "source_X", "pfa_Y", "pfv_Y", "source_Y", "elevation", "edited_X", "edited_Y",
    "pfa_run_X", "pfv_run_X", "pfa_run_Y", "pfv_run_Y", "pfa_top_X", "pfv_top_X", "pfa_top_Y", "pfv_top_Y",
)  # fmt: skip
"""The columns of the sheet Floors, in order; the last four hold the peaks of the record of the largest ruling peak."""
FLOOR_AT: Mapping[str, int] = {key: at for at, key in enumerate(FLOOR_KEYS)}


# ---------------------------------------------------------------- texts in formulas


def literal(text: str) -> str:
    """Return a text as formulas write it."""
    return '"' + text.replace('"', '""') + '"'


def sentence(template: str, **expressions: str) -> str:
    """Return the expression of a sentence in the language in use: `expressions` take the places of their names."""
    parts = []
    for text, name, _spec, _conversion in string.Formatter().parse(template):
        parts += [literal(text)] if text else []
        parts += [expressions[name]] if name else []
    return "&".join(parts)


@dataclass(frozen=True, slots=True)
class Terms:
    """What formulas write and compare."""

    yes: str
    no: str
    partly: str
    edited: str
    check: str
    again: str
    bases: Mapping[str, str]
    labels: tuple[str, ...]

    def label(self, rank: str) -> str:
        """Return the expression for the label of a class by the expression of its place, 0 for low."""
        return f"CHOOSE({rank}+1,{','.join(map(literal, self.labels))})"


def build_terms() -> Terms:
    """Return the terms in the language in use."""
    return Terms(
        yes=_("yes"),
        no=_("no"),
        partly=_("partly"),
        edited=_("edited"),
        check=_("check"),
        again=_("run again"),
        bases={
            "simulated": _("simulated"),
            "formula": _("formula (not simulated)"),
            "unconfirmed": _("unconfirmed"),
            CANNOT_ROCK: _("cannot rock"),
        },
        labels=tuple(say_class(risk) for risk in RiskClass),
    )


# ---------------------------------------------------------------- Floors


def edited_motion(terms: Terms, motions: Sequence[tuple[Mapping[str, str], bool]]) -> str:
    """Return the formula that shows whether a floor's motion along an axis differs from the one as run.

    `motions` are those of its parallel records: cells, which hold pfa and pfv, and both as run, and whether PFV was
    known as run; where it was not, any value differs.
    """
    tests = []
    for cells, had_pfv in motions:
        tests.append(_differs(cells["pfa"], cells["pfa_run"]))
        tests.append(_differs(cells["pfv"], cells["pfv_run"]) if had_pfv else f'{cells["pfv"]}<>""')
    return f'=IF(IFERROR(OR({",".join(tests)}),TRUE),{literal(terms.edited)},"")'


def top_motion(ruling: Sequence[str], other: Sequence[str], top: str) -> tuple[str, str]:
    """Return the formulas of the largest peak that rules of parallel records, and of the other of the same record.

    `ruling` and `other` are their cells, `top` is the cell of the former formula.
    """
    if len(ruling) == 1:
        return f'=IF({ruling[0]}="","",{ruling[0]})', f'=IF({other[0]}="","",{other[0]})'
    found = '""'
    for peak, beside in zip(reversed(ruling), reversed(other), strict=True):
        found = f'IF({peak}={top},IF({beside}="","",{beside}),{found})'
    return f'=IF(COUNT({",".join(ruling)})=0,"",MAX({",".join(ruling)}))', f"={found}"


def _differs(now: str, as_run: str) -> str:
    return f"ABS({now}-{as_run})>{TOLERANCE}*{as_run}"


# ---------------------------------------------------------------- Items


@dataclass(frozen=True, slots=True)
class ItemFormulas:
    """The formulas of a row of Items.

    Parameters
    ----------
    cells : mapping of str to str
        The cells of the row by the keys of their columns.
    floors : str
        The sheet Floors as formulas write it, `last` the row of its last floor, `lowest` of its last record.
    formula, paper : MethodInfo
        The adopted formula, and the paper's.
    """

    cells: Mapping[str, str]
    floors: str
    last: int
    lowest: int
    terms: Terms
    formula: MethodInfo
    paper: MethodInfo

    def of(self, basis: str, *, is_run: bool) -> dict[str, str]:
        """Return the formulas of a row whose class rests on one of `assess.results.BASES`, by keys of columns.

        `is_run`: whether it holds for the inputs as run alone.
        """
        found = self._of_any(is_run=is_run) | (self._of_run(basis) if is_run else self._of_formula())
        return {key: f"={one}" for key, one in found.items()}

    def _of_formula(self) -> dict[str, str]:
        """Return the formulas of a row that follows its inputs, unless they may change whether its bracket holds."""
        risk, own, again = self.cells[self.formula.key], *map(literal, (self.terms.bases["formula"], self.terms.again))
        is_edited, stands = f"{self.cells['edited']}={literal(self.terms.edited)}", f"{self.cells['can_rock']}=0"
        cannot, low = literal(self.terms.bases[CANNOT_ROCK]), f"{self._mark()}&{literal(self.terms.labels[0])}"
        return {
            "edited": f'IF({self._bracket_decides()},{self._edited(*self._bracket_edits())},"")',
            # 1 while its sizes or its motion are no numbers
            "can_rock": f"IFERROR(IF({self._rocks_at(self.cells['pfa_g'])},1,0),1)",
            "basis": f"IF({is_edited},{again},IF({stands},{cannot},{own}))",
            "class": f"IF({is_edited},{again},IF({stands},{low},{self.cells['class_formula']}))",
            "order_formula": f'IF(OR({is_edited},{stands}),"",{self._order(risk, _rank(risk), risk)})',
        }

    def _rocks_at(self, pfa: str) -> str:
        """Return whether the piece may rock at a PFA [g]; an error while its sizes are no numbers."""
        return f"AND({pfa}>={self._start()},{self._is_slender()})"

    def _start(self) -> str:
        share, ratio, centre = (self.cells[key] for key in ("rocks_from_run", "breadth_to_height", "centre_of_gravity"))
        return f"{share}*{ratio}*50/{centre}"

    def _is_slender(self) -> str:
        return live.is_slender(self.cells["breadth_to_height"], f"{self.cells['centre_of_gravity']}/100")

    def _of_run(self, basis: str) -> dict[str, str]:
        """Return the formulas of a row whose class holds while its inputs are as run."""
        cells, rank, upper = self.cells, self.cells["rank"], self.cells["rank_upper"]
        own, again = literal(self.terms.bases[basis]), literal(self.terms.again)
        found = {
            "edited": self._edited(f"AND({self._bracket_decides()},OR({','.join(self._bracket_edits())}))"),
            "rank": self._rank_as_run(),
            "rank_upper": self._while_as_run(f"MAX({rank},{_rank(cells['upper_end'])})"),
            "basis": self._while_as_run(own, again),
            "class": self._while_as_run(f"{self._mark()}&{self.terms.label(rank)}", again),
            "class_upper": self._while_as_run(f"{self._mark()}&{self.terms.label(upper)}"),
            "class_notes": self._while_as_run(self._notes(is_settled=basis != "unconfirmed")),
            "rank_formula": self._while_as_run(rank if basis == CANNOT_ROCK else _rank(cells["formula_run"])),
            f"order_{basis}": self._order(rank, upper, cells["chance_run"]),
        }
        if basis == "simulated":
            found |= {key: self._while_as_run(cells[f"{key}_run"]) for key in AT_RUN}
            found["beside"] = self._while_as_run(f'IF({cells["beside_run"]}="","",{cells["beside_run"]})')
        return found

    def _of_any(self, *, is_run: bool) -> dict[str, str]:
        cells, check = self.cells, literal(self.terms.check)
        ratio, pfa = cells["breadth_to_height"], cells["pfa_g"]
        breadth, height = cells["breadth_cm"], cells["height_cm"]
        low = literal(self.terms.labels[0] + live.OUTSIDE)  # where FEMA P-58 has no value
        classed, by_paper = (
            f"IF(ISNUMBER({risk}),{live.risk_class(one, risk, ratio, pfa, LIMITS)},"
            f'IF(AND({risk}="",{live.is_stocky(ratio)}),{low},{check}))'
            for one in (self.formula, self.paper)
            for risk in (cells[one.key],)
        )
        as_run = live.risk_class(self.formula, cells["formula_run"], ratio, cells["formula_pfa_run"], LIMITS)
        methods = {
            key: f"IF(AND(ISNUMBER({ratio}),ISNUMBER({pfa})),{formula},{check})"
            for key, formula in live_formulas(cells).items()
        }
        return methods | {
            "breadth_to_height": f"IFERROR(IF(OR({breadth}<=0,{height}<=0),{check},{breadth}/{height}),{check})",
            "axis": self._while_unedited(cells["axis_run"], self._axis()) if is_run else self._axis(),
            "pfa_g": self._governing("pfa", is_run=is_run),
            "pfv_cm_s": self._governing("pfv", is_run=is_run),
            "class_formula": self._classed(self._while_unedited(as_run, classed) if is_run else classed),
            "class_or": self._classed(by_paper),
            "held": self._held(),
        }

    def _classed(self, found: str) -> str:
        """Return a class by formula: low where the piece cannot rock."""
        return f"{self._mark()}&IF({self.cells['can_rock']}=0,{literal(self.terms.labels[0])},{found})"

    def _floor(self, key: str) -> str:
        """Return the value in a column of Floors for the row's floor."""
        area, names = (self._area(one, self.last) for one in (key, "floor"))
        return f"INDEX({area},MATCH({self.cells['floor']},{names},0))"

    def _area(self, key: str, last: int) -> str:
        """Return the cells of a column of Floors."""
        letter = xl_col_to_name(FLOOR_AT[key])
        return f"{self.floors}${letter}$2:${letter}${last}"

    def _axis(self) -> str:
        """Return the axis given, else that of the larger ruling peak; by velocity first one along which it can rock."""
        given, ruling = self.cells["axis_given"], self.formula.ruled_by
        x, y = (f"MAX({self._floor(f'{ruling}_top_{axis}')})" for axis in AXES)  # of a reference: a blank counts as 0
        if ruling != "pfa":
            x, y = (
                f"IF({fastest}>0,{ABOVE_ANY_PEAK}+{fastest},{peak})"
                for peak, fastest in zip((x, y), map(self._fastest, AXES), strict=True)
            )
        return f'IF({given}<>"",{given},{live.worse_axis(x, y)})'

    def _fastest(self, axis: str) -> str:
        """Return the largest PFV of the motions along an axis that can rock the piece; 0 where none can."""
        if self.lowest > self.last:
            pfa, pfv, floors = (self._area(key, self.lowest) for key in (f"pfa_{axis}", f"pfv_{axis}", "floor"))
            largest = f"SUMPRODUCT(MAX(({floors}={self.cells['floor']})*({pfa}>={self._start()})*{pfv}))"
            return f"IFERROR(IF({self._is_slender()},{largest},0),0)"
        pfa, pfv = (self._floor(f"{peak}_top_{axis}") for peak in ("pfa", "pfv"))
        return f"IFERROR(IF({self._rocks_at(f'MAX({pfa})')},MAX({pfv}),0),0)"

    def _top(self, peak: str, axis: str) -> str:
        """Return the peak of the record along an axis that governs: by velocity, first of those that can rock it."""
        top = self._floor(f"{peak}_top_{axis}")
        if self.formula.ruled_by == "pfa" or self.lowest == self.last:
            return top
        fastest, found = self._fastest(axis), self._fastest(axis)
        if peak == "pfa":
            pfa, pfv, floors = (self._area(key, self.lowest) for key in (f"pfa_{axis}", f"pfv_{axis}", "floor"))
            found = f"SUMPRODUCT(MAX(({floors}={self.cells['floor']})*({pfv}={fastest})*{pfa}))"
        return f"IF({fastest}>0,{found},{top})"

    def _governing(self, peak: str, *, is_run: bool) -> str:
        """Return the peak that governs along the row's axis: of the record as run while that holds, else by `_top`."""
        floors = self._on_axis(*(self._top(peak, axis) for axis in AXES))
        if not is_run:
            return floors
        areas = (self._area(f"{peak}_{axis}", self.lowest) for axis in AXES)
        as_run = self._on_axis(*(f"INDEX({area},{self.cells['motion_run']})" for area in areas))
        return self._while_unedited(as_run, floors)

    def _on_axis(self, x: str, y: str) -> str:
        chosen = f'IF({self.cells["axis"]}="X",{x},{y})'
        return f'IF({chosen}="","",{chosen})'

    def _held(self) -> str:
        """Return whether the piece counts as anchored, by what its bracket does as run."""
        cells, (yes, no, partly) = self.cells, map(literal, (self.terms.yes, self.terms.no, self.terms.partly))
        word, if_partly = cells["anchored"], f"IF({cells['anchored']}={partly},{cells['held_partly']},0)"
        return f"IF(IF({word}={yes},{cells['held_yes']},{if_partly})=1,{yes},{no})"

    def _mark(self) -> str:
        return f'IF({self.cells["held"]}={literal(self.terms.yes)},{literal(ANCHORED)},"")'

    def _while_unedited(self, value: str, edited: str) -> str:
        return f"IF({self.cells['edited']}={literal(self.terms.edited)},{edited},{value})"

    def _bracket_decides(self) -> str:
        """Return whether it depends on a bracket of known capacity, now or as run, if the piece counts as anchored."""
        cells, capacity = self.cells, BRACKET[0]
        words = (f"{cells['anchored']}={literal(word)}" for word in (self.terms.yes, self.terms.partly))
        known = f'{cells[capacity]}<>"",{cells[f"{capacity}_run"]}<>""'
        return f"AND(OR({','.join(words)}),OR({known}))"

    def _bracket_edits(self) -> list[str]:
        return [_differs(self.cells[key], self.cells[f"{key}_run"]) for key in BRACKET]

    def _while_as_run(self, value: str, edited: str = '""') -> str:
        return f"IF(ISNUMBER({self.cells['rank']}),{value},{edited})"

    def _edited(self, *more: str) -> str:
        """Return whether piece, floor, axis or its motion differ from those as run; `more` are further tests."""
        cells, edited = self.cells, literal(self.terms.edited)
        axis = cells["axis_given"]
        tests = [
            *(_differs(cells[key], cells[f"{key}_run"]) for key in SAME),
            *(f"{cells[key]}<>{cells[f'{key}_run']}" for key in SAME_WORDS),
            *(f'IF({axis}="{other}",FALSE,{self._floor(f"edited_{own}")}={edited})' for own, other in ("XY", "YX")),
            *more,
        ]
        return f'IF(IFERROR(OR({",".join(tests)}),TRUE),{edited},"")'

    def _rank_as_run(self) -> str:
        cells = self.cells
        at_least = f"IF({cells['fell']}=1,{int(RiskClass.HIGH)},0)"
        edited = literal(self.terms.edited)
        return f'IF({cells["edited"]}={edited},"",MAX({_rank(cells["behind"])},{at_least}))'

    def _order(self, known: str, rank: str, chance: str) -> str:
        """Return what orders pieces by class and chance; nothing for anchored ones, or where `known` is no number."""
        free = f"AND({self.cells['held']}<>{literal(self.terms.yes)},ISNUMBER({known}))"
        return f'IF({free},{CLASS_WEIGHT}*{rank}+{chance}-ROW()*{ROW_WEIGHT},"")'

    def _notes(self, *, is_settled: bool) -> str:
        """Return what is to be said of a class that holds for the inputs as run."""
        rank, upper, formula = (self.cells[key] for key in ("rank", "rank_upper", "rank_formula"))
        could_be = sentence(", " + _("could be {risk}"), risk=self.terms.label(upper))
        lowered = sentence(", " + _("lowered by simulation (formula: {risk})"), risk=self.terms.label(formula))
        fell = literal(", " + _("as it overturns under the record itself"))
        notes = [(f"{upper}>{rank}", could_be), (f"{self.cells['fell']}=1", fell)]
        if is_settled:
            notes.insert(1, (f"{formula}>{rank}", lowered))
        texts = [] if is_settled else [f"{literal(', ')}&{self.cells['settle']}"]
        held = f'AND({self.cells["held"]}={literal(self.terms.yes)},{self.cells["bracket_held"]}<>"")'
        notes.append((held, f"{literal(', ')}&{self.cells['bracket_held']}"))
        texts += [f'IF({test},{text},"")' for test, text in notes]
        return f"MID({'&'.join(texts)},3,300)"


def live_formulas(cells: Mapping[str, str]) -> dict[str, str]:
    """Return the formulas of the live methods by the keys of `assess.fields.method_fields`, a method's value last."""
    names = ("breadth_to_height", "height_cm", "pfa_g", "pfv_cm_s")
    references = {name: cells.get(name, "A1") for name in names}
    found: dict[str, str] = {}
    for method in live.LIVE_METHODS:
        written = live.write_live(method, references, {one.setting: one.cell for one in method.parameters})
        found |= {f"{method.key}_{name}": formula for name, formula in written.items() if name != "value"}
        found[method.key] = written["value"]
    return found


def _rank(chance: str) -> str:
    """Return the place of a chance's class, 0 for low."""
    medium, high, very_high = LIMITS
    return f"IF({chance}>={very_high},3,IF({chance}>={high},2,IF({chance}>={medium},1,0)))"
