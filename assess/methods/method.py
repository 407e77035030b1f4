"""What a method is: one published way to find whether a piece of furniture overturns.

`MethodInfo` holds its texts and numbers, without functions, so that results can carry it; `Method` adds the functions.
"""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.methods.cases import Joint
from assess.rocking.block import MIDDLE
from assess.settings import Settings
from assess.units import ROUNDING

Role = Literal["best formula", "proposed OR", "simulation", "other"]
Side = Literal["", "above", "below"]

DECIMALS = 3
"""Of the errors of fitted models, as they are shown."""


@dataclass(frozen=True, slots=True)
class Range:
    """Where a method has been checked: both ends belong to it. `unit` is how the ends are written."""

    low: float
    high: float
    unit: str = ""

    def holds(self, values: Any) -> Any:
        """Tell for each of `values` (n,), in this range's own unit, whether it lies inside; NaN does not."""
        return (values >= self.low * (1 - ROUNDING)) & (values <= self.high * (1 + ROUNDING))


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """The publication: who, when, what and where; `doi` where one is known.

    `remark` is what is not bibliographic, in sentences: the place in the publication, or how it came to be known.
    Reports translate it; the rest stands as the publication has it.
    """

    title: str
    authors: str = ""
    year: str = ""
    source: str = ""
    doi: str = ""
    remark: str = ""

    @property
    def bibliographic(self) -> str:
        """The reference without its remark: the same in every language."""
        year = f" ({self.year})" if self.year else ""
        lead = f"{self.authors}{year}. " if self.authors else ""
        source = f" {self.source}." if self.source else ""
        return f"{lead}{self.title}.{source}" + (f" doi:{self.doi}" if self.doi else "")

    def __str__(self) -> str:
        return f"{self.bibliographic} {self.remark}".strip()


@dataclass(frozen=True, slots=True, kw_only=True)
class FittedOn:
    """What a model was fitted on, in words, and its root mean square errors where a building is left out [-].

    `spread` is the standard error of `error`; `constant` is the error of a constant, the mean chance of the others.
    """

    data: str
    error: float
    spread: float
    constant: float

    @property
    def is_no_better(self) -> bool:
        """Whether a constant does as well, to the decimals that are shown."""
        return round(self.error, DECIMALS) >= round(self.constant, DECIMALS)


@dataclass(frozen=True, slots=True)
class Column:
    """A result that a method gives in `Outcome.detail` beside its value.

    `name` is its key in results.json; `label` its heading in English; `unit` that of the values as they stand; `format`
    how Python formats one value. ``kind`` "truth" is 1, 0 or unknown; "text" has no format.
    """

    name: str
    label: str
    unit: str = ""
    format: str = ".3f"
    kind: Literal["number", "count", "truth", "text"] = "number"


@dataclass(frozen=True, slots=True)
class Parameter:
    """A field of `Settings` that a method reads: its symbol, and the name of the cell that holds it in workbooks."""

    setting: str
    symbol: str
    cell: str


FACTS: Mapping[str, str] = {
    "pfa_g": ".3f", "pfv_cm_s": ".1f", "breadth_to_height": ".3f", "height_cm": ".0f", "pfa_to_start": ".2f",
}  # fmt: skip
"""Numbers of a piece and its motion that a `Reason` may name, and their formats; ``pfa_to_start`` is PFA/(g·B/H)."""


BLOCK = (
    "The piece is free-standing, rigid and homogeneous, its centroid at mid-height; it does not slide; vertical motion "
    "is left out."
)
BY_RATIO = (
    "The chance that a free-standing piece overturns, from its breadth-to-height ratio and the peak floor "
    "acceleration alone."
)
BY_SIZE = (
    "The chance that a free-standing piece overturns, from its size and the peak acceleration and velocity "
    "of the floor."
)
CLIPPED = "the formula gave less than 0 or more than 1, and was set to 0 or 1"
"""What several methods assume, predict, and flag."""
PFV_FLAGS: Mapping[str, str] = {"pfv_unknown": "not evaluated: it needs the peak floor velocity, which is unknown here"}
"""The flag of methods that depend on velocity, and what it means."""


@dataclass(frozen=True, slots=True)
class Reason:
    """A typical reason why a method differs from another, with the conditions under which it applies.

    * `text`: a sentence with ``{names}``: of `FACTS`, of the method's columns, and ``{value}``, the method's
      probability as a percentage. A report fills them with numbers, or with ranges for several pieces.
    * `side` "above", "below" or "": applies where the method gives the higher or the lower class of the two; "": in
      both cases.
    * `flag`: applies where the method raised this flag; "": always.
    * `column`, `equals`: applies where the method's column has this text; "": always.
    * `can_rock`: applies where PFA exceeds g·B/H (True), or does not (False).
    """

    text: str
    side: Side = ""
    flag: str = ""
    column: str = ""
    equals: str = ""
    can_rock: bool | None = None

    def applies(self, side: Side, detail: Mapping[str, object], flags: Collection[str], *, can_rock: bool) -> bool:
        """Tell whether it applies to a piece on which the method is on `side`, with its `detail` and `flags`."""
        return (
            self.side in ("", side)
            and (not self.flag or self.flag in flags)
            and (not self.column or detail[self.column] == self.equals)
            and self.can_rock in (None, can_rock)
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class MethodInfo:
    """One method in texts and numbers.

    * `key`, `title`: name in results.json and in reports.
    * `short_title`: heading of a narrow column.
    * `symbol`: of its value in equations: "OR", "R", "P".
    * `role` "best formula", "proposed OR", "simulation" or "other": of the first two the one that `Settings.class_by`
      names is adopted where nothing was simulated; the simulation integrates the cases that have an ensemble. There is
      one of each.
    * `kind` "probability" or "criterion": a probability has a class; a criterion is met or not met.
    * `predicts`: one sentence: what a reader learns from it.
    * `needs`: fields of `Cases` it cannot do without.
    * `selects`: whether pieces of its classes high and very high are simulated with ``verify="high"``.
    * `selecting_flags`: flags that have a piece simulated with ``verify="high"`` whatever its class.
    * `is_live`: whether the workbook computes it (`Method.live`); tables of pieces and the map of risk show these
      methods.
    * `tells_rocking`: whether it is the criterion by which a piece can start to rock at all.
    * `valid`: where it has been checked, by quantity.
    * `equations`, `assumptions`, `departures`: in the symbols of the publication; for the methods appendix.
    * `flags`: every flag it can raise, and what that means.
    * `words`: a criterion's outcome in words: met, not met.
    * `columns`: every name in `Outcome.detail`, in the order of results.
    * `reasons`: why it typically differs from other methods, the most important first.
    * `fitted`: of a model that a study fitted; None of a published method.
    """

    key: str
    title: str
    short_title: str
    kind: Literal["probability", "criterion"]
    order: int
    predicts: str
    reference: Reference
    needs: frozenset[str]
    symbol: str = "R"
    role: Role = "other"
    selects: bool = False
    selecting_flags: tuple[str, ...] = ()
    is_live: bool = False
    tells_rocking: bool = False
    valid: Mapping[str, Range] = field(default_factory=dict)
    equations: tuple[str, ...] = ()
    assumptions: tuple[str, ...] = ()
    departures: tuple[str, ...] = ()
    flags: Mapping[str, str] = field(default_factory=dict)
    words: tuple[str, str] = ("", "")
    columns: tuple[Column, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    reasons: tuple[Reason, ...] = ()
    fitted: FittedOn | None = None

    @property
    def ruled_by(self) -> Literal["pfa", "pfv"]:
        """The peak of the floor motion with which its value rises, by which it tells the worse of several motions."""
        return "pfv" if "pfa" not in self.needs else "pfa"

    @property
    def tier(self) -> Literal["screening", "verification"]:
        """Whether it is evaluated at once for every case, or integrates those that have an ensemble."""
        return "verification" if self.role == "simulation" else "screening"

    @property
    def texts(self) -> tuple[str, ...]:
        """Every text that is translated, but those that are made by `assess.i18n.fill`, which are collected there."""
        own = (self.title, self.short_title, self.predicts, self.reference.remark)
        marks = (flag.replace("_", " ") for flag in self.flags)
        lists = (*self.equations, *self.assumptions, *self.departures, *self.flags.values(), *self.words)
        labels = (column.label for column in self.columns)
        found = (*own, *lists, *marks, *labels, *(reason.text for reason in self.reasons))
        return tuple(text for text in found if type(text) is str and any(character.isalpha() for character in text))


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """What a method says of a batch of n cases.

    * `value` (n,): for a probability: the chance of overturning in [0, 1]. For a criterion: 1 met, 0 not met. NaN: not
      evaluated.
    * `detail`: further results, such as ``raw`` or a median, under the name it has in results.json.
    * `flags` (n,): where a caution holds; the flag's meaning stands in `Method.flags`.
    * `joints`: what a method that integrates found, motion by motion.
    """

    value: FloatArray
    detail: Mapping[str, NDArray[np.generic]] = field(default_factory=dict)
    flags: Mapping[str, BoolArray] = field(default_factory=dict)
    joints: Sequence[Joint] = ()


Detail = float | str | bool | None
"""One value of `Outcome.detail`; None is unknown."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Example:
    """One case that is worked through in a report: sizes [cm], peaks [cm/s2] and [cm/s], NaN where unknown.

    `value`, `detail` and `flags` are what the method found; `restitution` is the building's own [-], NaN for Housner's;
    `centre` is the height of the centre of gravity as a share of the piece's [-].
    """

    breadth: float
    height: float
    pfa: float
    pfv: float
    restitution: float
    settings: Settings
    value: float
    detail: Mapping[str, Detail]
    flags: Collection[str]
    centre: float = MIDDLE

    def number(self, name: str) -> float:
        """Return a number of `detail`; NaN where it is unknown."""
        value = self.detail[name]
        return math.nan if value is None else float(value)


@dataclass(frozen=True, slots=True, kw_only=True)
class LiveCells:
    """What a live formula may read, as operands that accept operators and numpy functions.

    `parameters` are the method's own, by setting. A `pfv_cm_s` that is no number is unknown (`numpy.isnan`).
    """

    breadth_to_height: Any
    height_cm: Any
    pfa_g: Any
    pfv_cm_s: Any
    parameters: Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Method(MethodInfo):
    """One method: what it says of itself, and the functions that evaluate it.

    * `evaluate`: ``evaluate(cases, settings) -> Outcome``; inputs are left untouched. That of the simulation takes the
      keyword arguments ``threads: int = 1`` and ``stage: Stage | None = None`` as well, of which each ensemble is a
      part.
    * `steps`: ``steps(example) -> sequence of texts``: the calculation for one piece, with its numbers. A step that
      computes reads ``symbol = numbers = result [unit]``, so that a reader with a calculator finds the result again.
      Each is passed through `assess.i18n.gettext` where it is shown.
    * `live`: ``live(cells) -> mapping``: the expression of "value", and of columns, from `LiveCells`.
    """

    evaluate: Callable[..., Outcome]
    steps: Callable[[Example], Sequence[str]] | None = None
    live: Callable[[LiveCells], Mapping[str, Any]] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "is_live", self.live is not None)

    @property
    def info(self) -> MethodInfo:
        """The method without its functions: it can be pickled."""
        return MethodInfo(**{one.name: getattr(self, one.name) for one in fields(MethodInfo)})
