"""The live formulas of Items, and those that show there and in Floors that an input was edited since the run.

A class that rests on a simulation holds for the inputs that were integrated. Where one of them is edited the row says
that assess is to be run again, and leaves every count, list and chart: it never falls back to the formula. What
formulas write and compare is in the report's language.
"""

import string
from collections.abc import Mapping
from dataclasses import dataclass

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext as _
from assess.methods import MethodInfo
from assess.model import AXES
from assess.report import words
from assess.results import CANNOT_ROCK, ROLLS
from assess.risk import RiskClass
from assess.workbook import formulas as live
from assess.workbook.formulas import say_class

ANCHORED, ROLLING = "⚓ ", f"{words.ROLLING} "
"""Marks before the class of a piece that is anchored, or rolls: that of it without anchor or castors; uncoloured."""
LIMITS = ("limit_medium", "limit_high", "limit_very_high")
"""Names of the cells that hold the limits of the classes."""
ROW = "\x00"
"""Stands for the number of the row in a formula."""
CLASS_WEIGHT = 10
"""In the order of the pieces a class weighs more than any chance; of equal chances the upper row comes first."""
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


def differs(now: str, as_run: str) -> str:
    """Return whether a number is not the one as run, but for its last digits."""
    return f"ABS({now}-{as_run})>1E-9*{as_run}"


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
    bases = {
        "simulated": _("simulated"), "formula": _("formula (not simulated)"), "unconfirmed": _("unconfirmed"),
        CANNOT_ROCK: _("cannot rock"), ROLLS: _(words.BASES[ROLLS]),
    }  # fmt: skip
    return Terms(
        yes=_("yes"), no=_("no"), partly=_("partly"), edited=_("edited"), check=_("check"), again=_("run again"),
        bases=bases, labels=tuple(map(say_class, RiskClass)),
    )  # fmt: skip


class ItemFormulas:
    """The formulas of a row of Items: templates, in which a cell stands by the key of its column.

    Names in capitals are words, and expressions that several formulas have. `cells` are those of the row by the keys of
    their columns, `floors` is the sheet Floors as formulas write it, `last` the row of its last floor, `lowest` of its
    last record; `formula` is the adopted one, `paper` the paper's.
    """

    def __init__(
        self, cells: Mapping[str, str], floors: str, last: int, lowest: int, terms: Terms, formula: MethodInfo,
        paper: MethodInfo,
    ) -> None:  # fmt: skip
        self._cells, self._floors, self._last, self._lowest = cells, floors, last, lowest
        self._terms, self._formula, self._paper = terms, formula, paper
        texts = {
            "YES": terms.yes, "NO": terms.no, "PARTLY": terms.partly, "EDITED": terms.edited, "CHECK": terms.check,
            "AGAIN": terms.again, "LOW": terms.labels[0], "CANNOT_ROCK": terms.bases[CANNOT_ROCK],
            "BY_FORMULA": terms.bases["formula"], "ANCHORED": ANCHORED,
        }  # fmt: skip
        self._known = {**cells, **{name: literal(word) for name, word in texts.items()}}
        self._known |= {
            "START": self._fill("{rocks_from_run}*{breadth_to_height}*50/{centre_of_gravity}"),
            "IS_SLENDER": live.is_slender(cells["breadth_to_height"], f"{cells['centre_of_gravity']}/100"),
            # whether it depends on a bracket of known capacity, now or as run, if the piece counts as anchored
            "BRACKET_DECIDES": self._fill(
                "AND(OR({anchored}={YES},{anchored}={PARTLY}),"
                'OR({bracket_capacity_kn}<>"",{bracket_capacity_kn_run}<>""))'
            ),
            "BRACKET_TESTS": ",".join(differs(cells[key], cells[f"{key}_run"]) for key in BRACKET),
        }

    def _fill(self, template: str, **more: str) -> str:
        return template.format_map({**self._known, **more})

    def of(self, basis: str, *, is_run: bool) -> dict[str, str]:
        """Return the formulas of a row whose class rests on one of `assess.results.BASES`, by keys of columns.

        `is_run`: whether it holds for the inputs as run alone; else it follows its inputs, unless they may change
        whether its bracket holds.
        """
        mark = literal(ROLLING if basis == ROLLS else "")
        self._known["MARK"] = self._fill("IF({held}={YES},{ANCHORED},{mark})", mark=mark)
        found = self._of_any(is_run=is_run)
        if is_run:
            found |= self._of_run(basis)
        else:
            risk = self._cells[self._formula.key]
            templates = {
                "edited": 'IF({BRACKET_DECIDES},{found},"")',
                "can_rock": "IFERROR(IF({rocks},1,0),1)",  # 1 while its sizes or its motion are no numbers
                "basis": "IF({edited}={EDITED},{AGAIN},IF({can_rock}=0,{CANNOT_ROCK},{BY_FORMULA}))",
                "class": "IF({edited}={EDITED},{AGAIN},IF({can_rock}=0,{MARK}&{LOW},{class_formula}))",
                "order_formula": 'IF(OR({edited}={EDITED},{can_rock}=0),"",{order})',
            }
            more = {
                "found": self._edited(self._known["BRACKET_TESTS"]),
                "rocks": self._rocks_at(self._cells["pfa_g"]),
                "order": self._order(risk, _rank(risk), risk),
            }
            found |= {key: self._fill(template, **more) for key, template in templates.items()}
        return {key: f"={one}" for key, one in found.items()}

    def _of_run(self, basis: str) -> dict[str, str]:
        cells, mark, label = self._cells, self._known["MARK"], self._terms.label
        rank, upper, formula = cells["rank"], cells["rank_upper"], cells["rank_formula"]
        again, is_settled = self._known["AGAIN"], basis != "unconfirmed"

        def while_as_run(value: str, edited: str = '""') -> str:
            return f"IF(ISNUMBER({rank}),{value},{edited})"

        lowered = sentence(", " + _("lowered by simulation (formula: {risk})"), risk=label(formula))
        notes = [
            (f"{upper}>{rank}", sentence(", " + _("could be {risk}"), risk=label(upper))),
            *([(f"{formula}>{rank}", lowered)] if is_settled else []),
            (self._fill("{fell}=1"), literal(", " + _("as it overturns under the record itself"))),
            (self._fill('AND({held}={YES},{bracket_held}<>"")'), self._fill('", "&{bracket_held}')),
        ]
        texts = [] if is_settled else [self._fill('", "&{settle}')]
        texts += [f'IF({test},{text},"")' for test, text in notes]
        found = {
            "edited": self._edited(self._fill("AND({BRACKET_DECIDES},OR({BRACKET_TESTS}))")),
            "rank": self._fill(
                'IF({edited}={EDITED},"",MAX({of_chance},IF({fell}=1,{high},0)))',
                of_chance=_rank(cells["behind"]), high=str(int(RiskClass.HIGH)),
            ),
            "rank_upper": while_as_run(f"MAX({rank},{_rank(cells['upper_end'])})"),
            "basis": while_as_run(literal(self._terms.bases[basis]), again),
            "class": while_as_run(f"{mark}&{label(rank)}", again),
            "class_upper": while_as_run(f"{mark}&{label(upper)}"),
            "class_notes": while_as_run(f"MID({'&'.join(texts)},3,300)"),
            "rank_formula": while_as_run(rank if basis in (CANNOT_ROCK, ROLLS) else _rank(cells["formula_run"])),
            f"order_{basis}": self._order(rank, upper, cells["chance_run"]),
        }  # fmt: skip
        if basis == "simulated":
            found |= {key: while_as_run(cells[f"{key}_run"]) for key in AT_RUN}
            found["beside"] = while_as_run(self._fill('IF({beside_run}="","",{beside_run})'))
        return found

    def _of_any(self, *, is_run: bool) -> dict[str, str]:
        cells, check = self._cells, self._known["CHECK"]
        ratio, pfa = cells["breadth_to_height"], cells["pfa_g"]
        low = literal(self._terms.labels[0] + live.OUTSIDE)  # where FEMA P-58 has no value

        def classed(method: MethodInfo) -> str:
            risk = cells[method.key]
            known = live.risk_class(method, risk, ratio, pfa, LIMITS)
            return f'IF(ISNUMBER({risk}),{known},IF(AND({risk}="",{live.is_stocky(ratio)}),{low},{check}))'

        # the axis given, else that of the larger ruling peak; by velocity first one along which the piece can rock
        ruling = self._formula.ruled_by
        x, y = (f"MAX({self._floor(f'{ruling}_top_{axis}')})" for axis in AXES)  # of a reference: a blank counts as 0
        if ruling != "pfa":  # 1E5 weighs more than any peak [cm/s]
            x, y = (
                f"IF({fastest}>0,1E5+{fastest},{peak})"
                for peak, fastest in zip((x, y), map(self._fastest, AXES), strict=True)
            )
        axis = self._fill('IF({axis_given}<>"",{axis_given},{worse})', worse=live.worse_axis(x, y))
        found = {
            "axis": (cells["axis_run"], axis),
            "pfa_g": self._peaks("pfa"),
            "pfv_cm_s": self._peaks("pfv"),
            "class_formula": (
                live.risk_class(self._formula, cells["formula_run"], ratio, cells["formula_pfa_run"], LIMITS),
                classed(self._formula),
            ),
        }
        now = {
            key: self._fill("IF({edited}={EDITED},{now},{as_run})", now=edited, as_run=as_run) if is_run else edited
            for key, (as_run, edited) in found.items()
        }
        mark = "{MARK}&IF({can_rock}=0,{LOW},{found})"  # low where the piece cannot rock
        return {
            **{
                key: f"IF(AND(ISNUMBER({ratio}),ISNUMBER({pfa})),{formula},{check})"
                for key, formula in live_formulas(cells).items()
            },
            "breadth_to_height": self._fill(
                "IFERROR(IF(OR({breadth_cm}<=0,{height_cm}<=0),{CHECK},{breadth_cm}/{height_cm}),{CHECK})"
            ),
            **now,
            "class_formula": self._fill(mark, found=now["class_formula"]),
            "class_or": self._fill(mark, found=classed(self._paper)),
            "held": self._fill(
                "IF(IF({anchored}={YES},{held_yes},IF({anchored}={PARTLY},{held_partly},0))=1,{YES},{NO})"
            ),
        }

    def _edited(self, *more: str) -> str:
        """Return whether piece, floor, axis or its motion differ from those as run; `more` are further tests."""
        cells = self._cells
        tests = [
            *(differs(cells[key], cells[f"{key}_run"]) for key in SAME),
            *(f"{cells[key]}<>{cells[f'{key}_run']}" for key in SAME_WORDS),
            *(
                self._fill('IF({axis_given}="{other}",FALSE,{found}={EDITED})', other=other,
                           found=self._floor(f"edited_{own}"))
                for own, other in ("XY", "YX")
            ),
            *more,
        ]  # fmt: skip
        return self._fill('IF(IFERROR(OR({tests}),TRUE),{EDITED},"")', tests=",".join(tests))

    def _order(self, known: str, rank: str, chance: str) -> str:
        """Return the number that orders pieces by class and chance; "" if anchored, or if `known` is not a number."""
        template = 'IF(AND({held}<>{YES},ISNUMBER({known})),{weight}*{rank_}+{chance_}-ROW()*1E-9,"")'
        return self._fill(template, known=known, weight=str(CLASS_WEIGHT), rank_=rank, chance_=chance)

    def _area(self, key: str, last: int) -> str:
        letter = xl_col_to_name(FLOOR_AT[key])
        return f"{self._floors}${letter}$2:${letter}${last}"

    def _floor(self, key: str) -> str:
        """Return the value in a column of Floors for the row's floor."""
        return f"INDEX({self._area(key, self._last)},MATCH({self._cells['floor']},{self._area('floor', self._last)},0))"

    def _rocks_at(self, pfa: str) -> str:
        """Return whether the piece may rock at a PFA [g]; an error while its sizes are no numbers."""
        return self._fill("AND({pfa}>={START},{IS_SLENDER})", pfa=pfa)

    def _fastest(self, axis: str) -> str:
        """Return the largest PFV of the motions along an axis that can rock the piece; 0 where none can."""
        if self._lowest > self._last:
            largest = self._among(axis, "({pfa}>={START})*{pfv}")
            return self._fill("IFERROR(IF({IS_SLENDER},{largest},0),0)", largest=largest)
        pfa, pfv = (self._floor(f"{peak}_top_{axis}") for peak in ("pfa", "pfv"))
        return f"IFERROR(IF({self._rocks_at(f'MAX({pfa})')},MAX({pfv}),0),0)"

    def _among(self, axis: str, template: str, **more: str) -> str:
        """Return the largest of an expression over the records of the row's floor."""
        pfa, pfv, floors = (self._area(key, self._lowest) for key in (f"pfa_{axis}", f"pfv_{axis}", "floor"))
        return self._fill(
            "SUMPRODUCT(MAX(({floors}={floor})*" + template + "))", floors=floors, pfa=pfa, pfv=pfv, **more
        )

    def _peaks(self, peak: str) -> tuple[str, str]:
        """Return the peak along the row's axis of the record that governed the run, and of the one that governs now.

        By velocity, those that can rock the piece come first.
        """
        found = []
        for axis in AXES:
            as_run = f"INDEX({self._area(f'{peak}_{axis}', self._lowest)},{self._cells['motion_run']})"
            now = self._floor(f"{peak}_top_{axis}")
            if self._formula.ruled_by != "pfa" and self._lowest != self._last:
                fastest = own = self._fastest(axis)
                if peak != "pfv":
                    own = self._among(axis, "({pfv}={fastest})*{pfa}", fastest=fastest)
                now = f"IF({fastest}>0,{own},{now})"
            found.append((as_run, now))
        of_axis = (self._fill('IF({axis}="X",{x},{y})', x=x, y=y) for x, y in zip(*found, strict=True))
        first, second = (f'IF({one}="","",{one})' for one in of_axis)
        return first, second


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
