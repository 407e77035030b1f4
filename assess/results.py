"""What a run found: typed tables, small, without waveforms. Every report, the command line and a notebook read them.

Units stand in the names. What is unknown is None in a row and NaN in a column. A table is a tuple of rows, but for the
cases, which are held as columns (there are many) and read case by case. Series for figures and the outcomes of every
motion lie in one file, to which `Results.series` refers.
"""

import difflib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from assess.annual_results import AnnualRow, AnnualTables
from assess.errors import InputError, Problem
from assess.i18n import Text, count, fill, join, nfill
from assess.intensity import Shaking
from assess.methods import ALIKE, MethodInfo, Outcome
from assess.model import MEASURED, Building, CatalogueType, FloorPlan, Place
from assess.motion.scenario import Profile
from assess.motion.site_ground import SiteGround
from assess.risk import RiskClass, classify, classify_all
from assess.rocking.draws import TRIED, Uncertainty
from assess.route_results import RouteTables
from assess.schedule_results import NOTHING, Schedule
from assess.settings import CLASS_BY, Settings
from assess.table import PART, Columns, Table

if TYPE_CHECKING:
    import pandas as pd

    from assess.motion.target_fit import Fit

Detail = float | str | bool | None

CANNOT_ROCK, ROLLS = "cannot rock", "rolls"
BASES = ("formula", "simulated", "unconfirmed", CANNOT_ROCK, ROLLS)
"""What an adopted risk rests on: the formula, where nothing was simulated; the simulation; the formula, where
simulation gave a lower class that cannot be relied on; that the piece cannot rock, so that it is low; or nothing, as it
stands on castors and rolls, which no method here covers: its chance is that of a piece without them. Lists, counts and
sums do not mix them, but for "cannot rock", which counts with those of the run."""
BRANCHES: tuple[str, ...] = (fill("rest"), fill("slide"), fill("rock"), fill("slide and rock"))
"""How a piece starts to move, in words."""
PIECE_FLAGS = (
    "does_not_rock", "slides", "shenton_extended", "wall_higher", "fell_in_record", "ideal_higher", "either_axis",
    "assumed_motion", "unknown_building", "weak_motions", "undecided", "unconfirmed", "rolls",
)  # fmt: skip
"""Flags that belong to a piece rather than to one method, in the order in which they are listed."""
PIECE_FLAG_TEXTS: Mapping[str, str] = {
    "slides": fill(
        "at the floor's PFA the piece slides, or slides and rocks (Shenton 1996); that lowers neither its chance nor "
        "its class"
    ),
    "unconfirmed": fill(
        "nothing is known of the building: its class is at least that of the faster third of the draws; or the motions "
        "are weaker than the floor's, and the formula's class stands, as simulation gave a lower one"
    ),
    "rolls": fill(
        "on castors, and so slender that it may overturn at a kerb or with its castors locked: it has a class as if it "
        "stood without them"
    ),
    "either_axis": fill(
        "nearly square on plan, and its axis is blank: the chance is that of a fall along either axis in one earthquake"
    ),
    "ideal_higher": fill(
        "its class would be higher if exactly this motion recurred and the piece were exactly as given"
    ),
}
"""Meanings of those flags that no method explains."""
MAY_BE_LOWER = fill(
    "may be lower than the truth: on floor 25 of 575 Market Street, left out as a test, it gives 0.149 g where 0.223 g "
    "was recorded"
)
"""The caution that goes with interpolation between floors."""
MOTION_FLAGS: Mapping[str, str] = {
    "one_axis_only": fill("known in one direction; used for both"),
    "interpolated": fill(
        "no motion of this floor is known: PFA and PFV are interpolated over height; this {caution}",
        caution=MAY_BE_LOWER,
    ),
    "code_profile": fill("PFA by a code's design profile: an envelope, not an expected value"),
    "assumed_shaking": fill(
        "the ground motion is the published median of an assumed intensity (Shaking), not a value known for this site"
    ),
    "shakemap": fill("the ground motion is the median of a ShakeMap at the building: estimated, not recorded there"),
    "scenarios": fill("the ground motion is the median of computed scenarios of one earthquake"),
    "assumed_elevation": fill(
        "Elevation is blank: assumed as the floor's number, counted from the ground floor, times Height over Storeys"
    ),
    "drawn_building": fill(
        "no motion of this floor is known: PFA and PFV are medians over drawn buildings on the ground motion"
    ),
    "unknown_height": fill("the height of the floor in the building is not known: z/h is drawn from 0.25 to 1"),
    "unknown_building": fill(
        "neither T1, Height, Storeys nor an Elevation is known: T1 is drawn from 0.15 to 3 s and z/h from 0.25 to 1"
    ),
    "beyond_table": fill(
        "T1 or PGV/PGA lies beyond the table of floor medians, 0.06 to 6.5 s and 12 to 400 cm/s per g: the nearest "
        "entry is taken"
    ),
}
"""Flags of a floor's motion, and their meanings."""
CARRIED = ("fell_in_record", "ideal_higher", "undecided")
"""Flags that count for a piece under whichever of its motions they were raised."""
MOST_KEPT = 2000
"""Items up to which what was read of them is kept; that of a larger inventory would fill the memory."""


# ---------------------------------------------------------------- rows


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorRow:
    """One floor of the workbook; `cells` tells in which cell of the sheet a field stands.

    The content of `plan` is left out: it is in `Results.series` as ``plan/<place of the floor in floor_rows>``.
    """

    row: int
    floor: str
    name: str
    elevation_m: float | None
    cells: Mapping[str, str]
    plan: FloorPlan | None = None

    def cell(self, name: str) -> str:
        """Address of a field; the first column where the sheet lacks it."""
        return self.cells.get(name, f"A{self.row}")


@dataclass(frozen=True, slots=True, kw_only=True)
class EnsembleRow:
    """The motions that pieces were simulated under on a floor: how many at most and at least, of what kind, their fit.

    `cases` is the number of pieces (rows) that were simulated, `fell_in_record` of how many it is known that they
    overturn under the record itself, None where there is no record. `is_generated` is False for the user's own motions.
    `bands` are the factors above and below PFA/(2 pi PFV) by which drawn motions were brought to the floor's peaks [-].
    `signs` tells by octave, with centres of 0.1 to 25.6 Hz, whether they move as the shared phases say (1) or against
    them (-1); None where that is not known, and they move as the phases say.
    """

    motions: int
    least_motions: int
    assumed_motion: bool
    unknown_building: bool
    weak_motions: bool
    is_generated: bool
    cases: int
    fell_in_record: int | None
    fit: "Fit | None"
    signs: tuple[int, ...] | None = None
    bands: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionRow:
    """One motion of one floor along one axis (`assess.fields.MOTION_FIELDS`); parallel records give several.

    `index` is its place in `Results.motions`, `label` its source in short: the record's name, "given", the profile's
    code, the two floors, or what shakes the beam. `flags` are keys of `MOTION_FLAGS`. `record` is as the workbook names
    it, "" where there is none; what its file says stands behind it. `ensemble` is None where nothing was simulated.
    """

    index: int
    floor: str
    axis: str
    source: str
    label: str
    pfa_g: float
    pfv_cm_s: float | None
    flags: tuple[str, ...] = ()
    between: tuple[str, ...] = ()
    profile: Profile | None = None
    clause: str = ""
    height_ratio: float | None = None
    amplification: float | None = None
    record: str = ""
    pfa_file_g: float | None = None
    format: str = ""
    station: str = ""
    location: str = ""
    channel: str = ""
    event: str = ""
    azimuth_deg: float | None = None
    corrected: bool | None = None
    time_step_s: float | None = None
    samples: int | None = None
    treatment: str = ""
    notes: tuple[str, ...] = ()
    pfv_follows: bool = False
    dispersion: float = 0.0
    ensemble: EnsembleRow | None = None

    @property
    def has_record(self) -> bool:
        """Whether it is a recorded motion."""
        return self.samples is not None

    @property
    def recorded(self) -> "MotionRow | None":
        """The row itself, if it is a recorded motion."""
        return self if self.has_record else None

    @property
    def is_level(self) -> bool:
        """Whether it is the motion of another floor at the same height."""
        return len(set(self.between)) == 1

    @property
    def is_borrowed(self) -> bool:
        """Whether it is the motion of the floor's other axis."""
        return "one_axis_only" in self.flags and not self.between


@dataclass(frozen=True, slots=True, kw_only=True)
class AnchorRow:
    """What a bracket at the wall has to carry to hold a piece (`assess.fields.ANCHOR_FIELDS`): screening, not design.

    `weight_source` is "given", "type" or "estimate", which `weight_words` say. `tension_low_kn` and `tension_high_kn`
    are those at 16 % and 84 % of PFA. What is by the code is None where neither SDS nor Ground PGA is known. Where
    `is_per_metre`, `holds` and its like are False where the bracket does not carry the tension of one metre, and None
    where it carries one above 0.
    """

    weight_kn: float
    weight_source: str
    weight_words: Text
    is_per_metre: bool
    bracket_height_cm: float
    is_height_assumed: bool
    bracket_capacity_kn: float | None
    tension_kn: float
    tension_low_kn: float
    tension_high_kn: float
    tension_without_weight_kn: float
    shear_kn: float
    needed_friction: float
    tension_code_kn: float | None
    shear_code_kn: float | None
    holds: bool | None
    holds_high: bool | None
    holds_code: bool | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ItemRow:
    """One row of furniture as it was assessed: what the workbook says, with blanks filled in from where `assumed` says.

    `friction` is the one that was used: the piece's own, else the building's. `extra` holds the texts of the columns
    that `assess` does not know, `more` the values of those that nothing is computed with, by their fields. `routes` are
    those that it names, or has a segment of which it can reach. `falls_toward_deg` is the direction in which a piece
    against a wall falls, anticlockwise from X, None where it is not known on which side its wall is. `governing`,
    `first_case` and `last_case` are places in `Results.cases`: the case that governs, and those of the item.
    `annual` is how often a year it falls if it stands free, None where that was not evaluated. `is_held` is whether it
    counts as anchored: it says so and its bracket is not known to fail, or it is partly anchored by one that holds.
    """

    index: int
    row: int
    item: str
    floor: str
    room: str
    description: str
    type: str
    quantity: int
    breadth_cm: float
    width_cm: float | None
    height_cm: float
    centre_of_gravity: float
    weight_kg: float | None
    breadth_to_height: float
    axis_given: str | None
    angle_deg: float | None
    x_m: float | None
    y_m: float | None
    friction: float | None
    importance: str
    anchored: str
    route: str
    segment: str
    edge_distance_m: float | None
    notes: str
    assumed: tuple[str, ...]
    extra: tuple[str, ...]
    more: Mapping[str, Any]
    mobile: bool | None
    fix_by: str
    routes: tuple[str, ...]
    governing: int
    first_case: int
    last_case: int
    anchor: AnchorRow
    is_held: bool
    against_wall: bool | None = None
    falls_toward_deg: float | None = None
    annual: AnnualRow | None = None
    sizes_from: str = MEASURED

    def field(self, key: str) -> Any:
        """Return one field by its key, whether or not anything is computed with it: None where that is blank."""
        return getattr(self, key) if key in ItemRow.__slots__ else self.more.get(key)


class MethodResult(NamedTuple):
    """What one method gives for one case; `value` is None where it was not evaluated.

    A tuple, as there are many: a frozen dataclass takes three times as long to make.
    """

    value: float | None
    detail: Mapping[str, Detail]
    flags: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Ideal:
    """What direct integration found of a piece exactly as given if exactly this motion recurred.

    `overturned` counts motions, `probability` is its ratio to their number, `low` and `high` its sampling interval [-].
    """

    runs: int
    overturned: int
    probability: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Simulation:
    """What direct integration found of one case.

    * `runs`, `draws`, `overturned`: Draws of an earthquake and of the piece; those of all pieces exactly alike on the
      floor; and those of the latter in which the piece overturned.
    * `probability`, `low`, `high`: The ratio of the last two, and its sampling interval [-].
    * `ideal`: The same without uncertainty of the motion and of the piece; None where ground motion and building are
      drawn, which cannot recur, unless the run leaves uncertainty out.
    * `tried`: The ratio at other dispersions of the motion, by the dispersion [-]; empty where ground and building are
      drawn.
    * `if_slower`, `if_faster`: There: the ratio in the third of the draws with the least PFV/PFA, and in that with the
      most [-].
    * `record_overturned`, `record_max_rotation_ratio`: Whether it overturns under the recorded motion itself, and the
      largest |theta| over the critical angle there [-]; None where no record is known.
    """

    runs: int
    draws: int
    overturned: int
    probability: float
    low: float
    high: float
    ideal: Ideal | None
    tried: Mapping[float, float]
    if_slower: float | None
    if_faster: float | None
    record_overturned: bool | None
    record_max_rotation_ratio: float | None


@dataclass(frozen=True, slots=True)
class Sliding:
    """How a piece of known friction starts to move, and how far it slides.

    * `branch`: What it does first at the floor's PFA by Shenton's limits: rest, slide, rock, slide and rock.
    * `slip_median_cm`, `slip_84_cm`: Peak slip that half, and 84 %, of the draws do not exceed [cm]; None where it
      cannot slide, or no motions were there.
    """

    branch: str
    slip_median_cm: float | None
    slip_84_cm: float | None


@dataclass(frozen=True, slots=True)
class Adopted:
    """The risk that a report goes by.

    `basis` is one of `BASES`. `low` and `high` bound the sampling interval of a simulated chance, and are None where
    the formula's is adopted. `upper` is the class by the upper bound. `lowered_from` is the class by formula where
    simulation lowered it, which it may not where `is_doubtful`; None of an unconfirmed class. `method` is "" where the
    piece cannot rock; `rocks_from` is the share of g b/z that PFA has to reach for it to rock in any draw [-].
    """

    method: str
    basis: str
    probability: float
    low: float | None
    high: float | None
    risk: RiskClass
    upper: RiskClass
    lowered_from: RiskClass | None
    is_doubtful: bool
    rocks_from: float
    flags: tuple[str, ...]

    @property
    def lower(self) -> RiskClass:
        """The class by the lower end of the interval; at least high where it overturns under the record itself."""
        least = RiskClass.HIGH if "fell_in_record" in self.flags else RiskClass.LOW
        found = None if self.low is None else classify(self.low)
        return self.risk if found is None else min(self.risk, max(found, least))

    @property
    def is_simulated(self) -> bool:
        """Whether the simulation's chance is adopted."""
        return self.basis == "simulated"

    @property
    def is_unconfirmed(self) -> bool:
        """Whether nothing is known of the building, or the formula's class stands for a lower simulated one."""
        return self.basis == "unconfirmed"

    @property
    def has_simulated(self) -> bool:
        """Whether the chance is that of the simulation, confirmed or, where nothing is known of the building, not."""
        return self.is_simulated or (self.is_unconfirmed and "unknown_building" in self.flags)

    @property
    def can_rock(self) -> bool:
        """Whether it is not too stocky to rock, and the strongest motion that may be drawn can start it."""
        return self.basis != CANNOT_ROCK


@dataclass(frozen=True, slots=True)
class CaseRow:
    """One piece under one motion: every method's result by key, the simulation where one ran, and the adopted risk.

    `sliding` is None where no friction is given. `one_sided` is the simulated chance with a wall at its back [-], None
    where there is no wall or no simulation.
    """

    index: int
    item: ItemRow
    motion: MotionRow
    methods: Mapping[str, MethodResult]
    simulation: Simulation | None
    adopted: Adopted
    sliding: Sliding | None
    one_sided: float | None

    @property
    def governs(self) -> bool:
        """Whether it is the case that governs."""
        return self.index == self.item.governing


class ItemResult:
    """One row of furniture with the risk adopted for it, and its cases, which are made when they are asked for."""

    def __init__(self, part: "ItemColumns", at: int) -> None:
        self._part, self._at = part, at
        self.item: ItemRow = part.items[at]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ItemResult):
            return NotImplemented
        return (self.item, self.adopted, self.cases) == (other.item, other.adopted, other.cases)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<ItemResult of {self.item.item}: {self.adopted.risk.word}, {self.adopted.basis}>"

    @cached_property
    def adopted(self) -> Adopted:
        """The risk that reports go by."""
        return self._part.adopted(self._at)

    @cached_property
    def cases(self) -> tuple[CaseRow, ...]:
        """The piece under every motion."""
        first = self.item.first_case - self._part.first_case
        return tuple(map(self._part.cases.row, range(first, first + self.item.last_case - self.item.first_case)))

    @property
    def governing(self) -> CaseRow:
        """The case that governs."""
        return self.cases[self.item.governing - self.item.first_case]

    @property
    def formula_key(self) -> str:
        """Key of the adopted formula."""
        return self._part.run.formula.key

    @property
    def paper_key(self) -> str:
        """Key of the paper's formula."""
        return self._part.run.paper_formula.key

    @property
    def main_basis(self) -> str:
        """The basis of the run: `Results.main_basis`."""
        return self._part.main_basis

    @property
    def fell(self) -> NDArray[np.bool_] | None:
        """In which draws it falls; None where that is not known."""
        return self._part.run.draws.read(self.item.index)

    @cached_property
    def apart(self) -> str:
        """Its basis where that is not the one of the run's counts, by which it stands apart in lists and sums: else "".

        One of "unconfirmed", "rolls" and, in a run that simulated other pieces, "formula".
        """
        return "" if self.adopted.basis in (self.main_basis, CANNOT_ROCK) else self.adopted.basis

    @property
    def sheet(self) -> str:
        """The workbook's name of the sheet Items."""
        return self._part.sheet

    @property
    def routes(self) -> tuple[str, ...]:
        """The routes that it names, or can reach."""
        return self.item.routes

    @property
    def by_formula(self) -> CaseRow:
        """The case that the formula alone would have govern, of those under which it can rock if there are any."""
        return min(self.cases, key=self._formula_first)

    def _formula_first(self, case: CaseRow) -> tuple[float, float]:
        value = (case.methods[self.formula_key].value or 0.0) if case.adopted.can_rock else -1.0
        return -round(value, ALIKE), -round(case.motion.pfa_g, ALIKE)

    @property
    def formula(self) -> MethodResult:
        """What the adopted formula gives under the motion that it alone would have govern."""
        return self.by_formula.methods[self.formula_key]

    @property
    def formula_class(self) -> RiskClass:
        """The highest class that the formula gives under any of its motions; low where the piece cannot rock."""
        found: RiskClass = self._part.column("formula_class")[self._at]
        return found

    @property
    def paper_class(self) -> RiskClass:
        """The class by the paper's formula under the governing motion; low where the piece cannot rock."""
        found: RiskClass = self._part.column("paper_class")[self._at]
        return found

    @property
    def ideal_class(self) -> RiskClass:
        """The highest class of the piece as given under exactly its motions; low where none was simulated."""
        found: RiskClass = self._part.column("ideal_class")[self._at]
        return found

    @property
    def simulation(self) -> Simulation | None:
        """What direct integration found under the governing motion; None where it was not simulated."""
        return self.governing.simulation if self.is_simulated else None

    @property
    def is_simulated(self) -> bool:
        """Whether its rocking was integrated under the governing motion."""
        return bool(self._part.cases.is_simulated[self.item.governing - self._part.first_case])

    @property
    def is_anchored(self) -> bool:
        """Anchored pieces stand outside the classes: their risk depends on the anchor."""
        return self.item.is_held

    @property
    def is_urgent(self) -> bool:
        """Whether its fall endangers life or a route, which comes first in the list of what to fix."""
        return self.item.importance == "life safety" or bool(self.routes)

    @property
    def fell_in_record(self) -> bool:
        """Whether it overturns under any recorded motion itself."""
        return any(case.simulation is not None and bool(case.simulation.record_overturned) for case in self.cases)

    def worst(self, key: str) -> float | None:
        """Return the largest value of a method over all motions, which may be above that of the governing one."""
        values = [value for case in self.cases if (value := case.methods[key].value) is not None]
        return max(values, default=None)

    def _repr_html_(self) -> str:
        from assess.fields import item_html

        return item_html(self)


@dataclass(frozen=True, slots=True)
class WorkedMethod:
    """What one method computes for the piece of the worked example: steps with the numbers put in, and its value."""

    key: str
    steps: tuple[str, ...]
    value: float


# ---------------------------------------------------------------- draws


@dataclass(frozen=True, slots=True, eq=False)
class DrawTable:
    """In which draws of an earthquake each of m items falls.

    * `draws`: Draws that all simulated items have in common, the first ones; 0 where nothing was simulated.
    * `packed` (m, ceil(draws/8)): One bit a draw, the first in the highest bit.
    * `is_known` (m,): Which items have draws: those that were simulated, and those that cannot rock.
    """

    draws: int
    packed: NDArray[np.uint8]
    is_known: NDArray[np.bool_]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, DrawTable):
            return NotImplemented
        pairs = (self.packed, other.packed), (self.is_known, other.is_known)
        return self.draws == other.draws and all(np.array_equal(*pair) for pair in pairs)

    __hash__ = None  # type: ignore[assignment]

    def read(self, item: int) -> NDArray[np.bool_] | None:
        """Return in which draws an item falls, (draws,); None where that is not known."""
        if not self.draws or not self.is_known[item]:
            return None
        return np.unpackbits(self.packed[item], count=self.draws).astype(np.bool_)


NO_DRAWS = DrawTable(0, np.zeros((0, 0), dtype=np.uint8), np.zeros(0, dtype=np.bool_))


def count_pieces(rows: Iterable[ItemResult]) -> int:
    """Return how many pieces, not rows, there are."""
    return sum(one.item.quantity for one in rows)


def sum_falls(counted: Iterable[ItemResult]) -> NDArray[np.int64] | None:
    """Return how many pieces of some rows fall in each draw; None where that is not known of all of them."""
    total: NDArray[np.int64] | None = None
    for one in counted:
        if one.fell is None:
            return None
        falls = one.item.quantity * one.fell.astype(np.int64)
        total = falls if total is None else total + falls
    return total


# ---------------------------------------------------------------- cases


@dataclass(frozen=True, slots=True, eq=False)
class CaseTable:
    """n pairs of piece and motion as columns; the cases of an item stand together.

    * `item`, `motion` (n,): Places in `Results.item_rows` and `Results.motions`.
    * `outcomes`: Every method's values, details and flags, (n,) each, by its key.
    * `adopted` (mapping of str to (n,) array): probability, low, high, rocks_from [-]; risk, upper (classes); basis
      (place in `BASES`); doubtful, ideal_higher, either_axis, rolls (boolean).
    """

    item: NDArray[np.int32]
    motion: NDArray[np.int32]
    outcomes: Mapping[str, Outcome]
    adopted: Mapping[str, NDArray[Any]]

    def __len__(self) -> int:
        return len(self.item)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, CaseTable):
            return NotImplemented
        mine, theirs = dict(self.columns()), dict(other.columns())
        return mine.keys() == theirs.keys() and all(_same(mine[name], theirs[name]) for name in mine)

    __hash__ = None  # type: ignore[assignment]

    def columns(self) -> Iterator[tuple[str, NDArray[Any]]]:
        """Yield every column by its name."""
        yield "item", self.item
        yield "motion", self.motion
        for key, outcome in self.outcomes.items():
            yield key, outcome.value
            yield from ((f"{key}_{name}", array) for name, array in outcome.detail.items())
            yield from ((f"{key}:{flag}", array) for flag, array in outcome.flags.items())
        yield from ((f"adopted_{name}", array) for name, array in self.adopted.items())


def _same(one: NDArray[Any], other: NDArray[Any]) -> bool:
    is_number = one.dtype.kind == "f" and other.dtype.kind == "f"
    return one.dtype == other.dtype and bool(np.array_equal(one, other, equal_nan=is_number))


def known(array: NDArray[Any]) -> list[Any]:
    """Return an array as a list, None in place of NaN; words pass through."""
    return [None if value != value else value for value in array.tolist()]


_DETAILS: Mapping[str, str] = {
    "simulation.record_max_rotation_ratio": "record_rotation", "simulation.ideal.runs": "runs",
    "simulation.ideal.probability": "ideal", "sliding.branch": "sliding_branch",
}  # fmt: skip
"""Names of what simulation found, by the attributes of a case, where they are not those of the attributes."""
_TYPES: Mapping[str, type] = {"runs": int, "draws": int, "overturned": int, "ideal_overturned": int,
                              "record_overturned": bool}  # fmt: skip
_RISKS = tuple(RiskClass)


class _Maker:
    """Makes rows of a type out of the columns that its fields name; None where that of `key` is None."""

    def __init__(self, columns: Columns, make: type, group: str, key: str) -> None:
        self._make, self._key = make, columns.column(f"{group}.{key}")
        self._columns = [columns.column(f"{group}.{one.name}") for one in fields(make)]

    def __call__(self, at: int) -> Any:
        return None if self._key[at] is None else self._make(*[column[at] for column in self._columns])


class CaseColumns(Columns):
    """Cases that follow each other, as columns by the attributes of `CaseRow`; `cut` is where they are in the table."""

    def __init__(self, run: "Results", cut: slice) -> None:
        super().__init__(range(cut.start, cut.stop))
        self._run, self.cut, self._found = run, cut, run.cases_table.outcomes[run.simulation.key]
        self.is_simulated = ~np.isnan(self._found.value[cut])
        self.exact = self._found.detail["ideal"][cut].astype(np.float64)

    def row(self, at: int) -> CaseRow:
        """Return one of the cases."""
        methods = {key: MethodResult(values[at], {name: column[at] for name, column in detail}, flags[at])
                   for key, values, detail, flags in self._methods}  # fmt: skip
        simulation, adopted, sliding = (make(at) for make in self._makers)
        item, motion = self.column("item")[at], self.column("motion")[at]
        return CaseRow(
            self._rows[at], item, motion, methods, simulation, adopted, sliding, self.column("one_sided")[at]
        )

    @cached_property
    def _methods(self) -> list[tuple[str, list[Any], list[tuple[str, list[Any]]], list[Any]]]:
        outcomes = self._run.cases_table.outcomes
        details = {one.key: () if one.role == "simulation" else outcomes[one.key].detail for one in self._run.methods}
        return [
            (
                key,
                self.column(f"methods.{key}.value"),
                [(name, self.column(f"methods.{key}.detail.{name}")) for name in detail],
                self.column(f"methods.{key}.flags"),
            )
            for key, detail in details.items()
        ]

    @cached_property
    def _makers(self) -> tuple[_Maker, ...]:
        simulation = _Maker(self, Simulation, "simulation", "probability")
        return simulation, _Maker(self, Adopted, "adopted", "basis"), _Maker(self, Sliding, "sliding", "branch")

    def _make(self, source: str) -> list[Any]:
        table, (group, _dot, name) = self._run.cases_table, source.partition(".")
        if source == "item":
            return [self._run.item_rows[at] for at in table.item[self.cut].tolist()]
        if source == "motion":
            return [self._run.motions[at] for at in table.motion[self.cut].tolist()]
        if source == "governs":
            return [at == one.governing for at, one in zip(self._rows, self.column("item"), strict=True)]
        if group == "methods":
            return self._of_method(*name.split(".", 1))
        if group in ("simulation", "sliding", "one_sided"):
            return self._of_simulation(source)
        return self._of_adoption(name) if group == "adopted" else super()._make(source)

    def _of_method(self, key: str, name: str) -> list[Any]:
        outcome = self._run.cases_table.outcomes[key]
        if name == "value":
            return known(outcome.value[self.cut])
        if name == "flags":
            raised = {flag: array[self.cut] for flag, array in outcome.flags.items()}
            return _name_raised({flag: array for flag, array in raised.items() if array.any()}, len(self))
        return known(outcome.detail[name.removeprefix("detail.")][self.cut])

    def _of_simulation(self, source: str) -> list[Any]:
        if source == "simulation.probability":
            return known(self._found.value[self.cut])
        if source == "simulation.ideal":
            return list(map(_Maker(self, Ideal, source, "probability"), range(len(self))))
        if source == "simulation.tried":
            columns = [(one, known(self._found.detail[f"dispersion_{one:g}"][self.cut])) for one in TRIED]
            return [{one: column[at] for one, column in columns if column[at] is not None} for at in range(len(self))]
        name = _DETAILS.get(source) or source.rpartition("simulation.")[2].removeprefix("sliding.").replace(".", "_")
        values = known(self._found.detail[name][self.cut])
        if source.startswith("simulation."):
            is_known = self.is_simulated
            if source.startswith("simulation.ideal."):
                is_known = is_known & ~np.isnan(self.exact)
            convert = _TYPES.get(name, float)
            pairs = zip(values, is_known.tolist(), strict=True)
            return [convert(value) if is_there and value is not None else None for value, is_there in pairs]
        if source == "sliding.branch":
            return [value or None for value in values]
        return values

    def _of_adoption(self, name: str) -> list[Any]:
        run = self._run
        adopted = {one: array[self.cut] for one, array in run.cases_table.adopted.items()}
        if name == "basis":
            return [BASES[at] for at in adopted["basis"].tolist()]
        if name in ("risk", "upper"):
            return [_RISKS[at] for at in adopted[name].tolist()]
        if name == "is_doubtful":
            return list(adopted["doubtful"].tolist())
        if name == "lowered_from":
            return [None] * len(self)
        if name == "method":
            is_unknown = self._raise("unknown_building").tolist()
            bases = zip(self.column("adopted.basis"), is_unknown, self.is_simulated.tolist(), strict=True)
            keys = {"formula": run.formula.key, "simulated": run.simulation.key, CANNOT_ROCK: ""}
            doubted = (keys["formula"], keys["simulated"])
            return [keys[one] if one in keys else doubted[has_run if one == ROLLS else unknown]
                    for one, unknown, has_run in bases]  # fmt: skip
        if name == "flags":
            return self._list_flags()
        if name == "probability" and np.isnan(adopted[name]).any():
            raise ValueError("the adopted formula gave no value")
        return known(adopted[name])

    def _raise(self, flag: str) -> NDArray[np.bool_]:
        table = self._run.cases_table
        raised = [one.flags[flag][self.cut] for one in table.outcomes.values() if flag in one.flags]
        if flag in ("ideal_higher", "either_axis", "rolls"):
            raised.append(table.adopted[flag][self.cut])
        if flag == "unconfirmed":
            raised.append(table.adopted["basis"][self.cut] == BASES.index(flag))
        return np.logical_or.reduce(raised) if raised else np.zeros(len(self), dtype=np.bool_)

    def _list_flags(self) -> list[tuple[str, ...]]:
        own, motions = self.column(f"methods.{self._run.formula.key}.flags"), self.column("motion.flags")
        piece = _name_raised({flag: self._raise(flag) for flag in PIECE_FLAGS}, len(self))
        kept: dict[tuple[tuple[str, ...], ...], tuple[str, ...]] = {}
        found = []
        for basis, *parts in zip(self.column("adopted.basis"), own, motions, piece, strict=True):
            key = (() if basis == CANNOT_ROCK else parts[0], *parts[1:])
            if key not in kept:
                kept[key] = tuple(dict.fromkeys(flag for part in key for flag in part))
            found.append(kept[key])
        return found


def _name_raised(raised: Mapping[str, NDArray[np.bool_]], count: int) -> list[tuple[str, ...]]:
    numbers = np.zeros(count, dtype=np.int64)
    for at, array in enumerate(raised.values()):
        numbers |= array.astype(np.int64) << at
    names = {
        number: tuple(flag for at, flag in enumerate(raised) if number >> at & 1) for number in set(numbers.tolist())
    }
    return [names[number] for number in numbers.tolist()]


class ItemColumns(Columns):
    """Rows of furniture that follow each other, as columns by the attributes of `ItemResult`.

    The adopted risk of a piece is the governing chance, with the highest classes under any motion of the piece. A class
    that is lower than the highest that the formula gives under any of them is marked, if it is confirmed.
    """

    def __init__(self, run: "Results", start: int, stop: int) -> None:
        items = run.item_rows[start:stop]
        super().__init__(items)
        self.run, self.items, self.first_case = run, items, items[0].first_case
        self.sheet, self.main_basis = run.provenance.sheets.get("Items", "Items"), run.main_basis
        self.cases = CaseColumns(run, slice(self.first_case, items[-1].last_case))
        self._governing = [one.governing - self.first_case for one in items]

    def results(self) -> Iterator[ItemResult]:
        """Yield the rows."""
        return (ItemResult(self, at) for at in range(len(self)))

    @cached_property
    def adopted(self) -> Callable[[int], Adopted]:
        """Makes the adopted risk of one of the rows."""
        return _Maker(self, Adopted, "adopted", "basis")

    def inner(self, source: str) -> tuple[Columns, Sequence[int]]:
        """Return the cases, and how many each row has."""
        return self.cases, [one.last_case - one.first_case for one in self.items]

    def _make(self, source: str) -> list[Any]:
        group, _dot, name = source.partition(".")
        if source == "item":
            return list(self.items)
        if source == "sheet":
            return [self.sheet] * len(self)
        if group == "item":
            return super()._make(source)
        if source in self._worst:
            return self._worst[source]
        if source == "adopted.flags":
            return self._carry_flags()
        if group not in ("governing", "adopted"):
            return [getattr(one, source) for one in self.results()]
        values = self.cases.column(name if group == "governing" else source)
        return [values[at] for at in self._governing]

    @cached_property
    def _is_simulated(self) -> list[bool]:
        found: list[bool] = self._join(np.logical_or, self.cases.is_simulated).tolist()
        return found

    def _join(self, how: np.ufunc, values: NDArray[Any]) -> NDArray[Any]:
        """Return what becomes of the values of the cases of each row."""
        return np.asarray(how.reduceat(values, [one.first_case - self.first_case for one in self.items]))

    @cached_property
    def _worst(self) -> Mapping[str, list[RiskClass | None]]:
        run, cut, governing = self.run, self.cases.cut, self._governing
        table, is_simulated = run.cases_table, np.array(self._is_simulated)
        can_rock = table.adopted["basis"][cut] != BASES.index(CANNOT_ROCK)

        def adopted(name: str) -> NDArray[Any]:
            own = table.adopted[name][cut]
            return np.where(is_simulated, self._join(np.maximum, own), own[governing])

        def by_formula(key: str) -> NDArray[Any]:
            return np.where(can_rock, classify_all(table.outcomes[key].value[cut]), -1).clip(RiskClass.LOW)

        risk, formula = adopted("risk"), self._join(np.maximum, by_formula(run.formula.key))
        doubted = [BASES.index(one) for one in ("unconfirmed", ROLLS)]
        is_confirmed = ~np.isin(table.adopted["basis"][cut][governing], doubted)
        is_lowered = is_simulated & (risk < formula) & can_rock[governing] & is_confirmed
        exact = np.where(self.cases.is_simulated, classify_all(self.cases.exact), -1).clip(RiskClass.LOW)
        lists = {
            "adopted.risk": risk, "adopted.upper": adopted("upper"), "formula_class": formula,
            "paper_class": by_formula(run.paper_formula.key)[governing], "ideal_class": self._join(np.maximum, exact),
        }  # fmt: skip
        found: dict[str, list[RiskClass | None]] = {
            name: [_RISKS[at] for at in array.tolist()] for name, array in lists.items()
        }
        pairs = zip(found["formula_class"], is_lowered.tolist(), strict=True)
        return found | {"adopted.lowered_from": [one if is_lower else None for one, is_lower in pairs]}

    def _carry_flags(self) -> list[tuple[str, ...]]:
        flags = self.cases.column("adopted.flags")
        found = [flags[at] for at in self._governing]
        for at in np.flatnonzero(self._is_simulated).tolist():
            item, start = self.items[at], self.first_case
            cases = flags[item.first_case - start : item.last_case - start]
            carried = [flag for flag in CARRIED if any(flag in one for one in cases)]
            is_higher = self.column("ideal_class")[at] > self.column("adopted.risk")[at]
            dropped = () if is_higher else ("ideal_higher",)
            found[at] = tuple(dict.fromkeys(flag for flag in (*found[at], *carried) if flag not in dropped))
        return found


# ---------------------------------------------------------------- series


class Series:
    """A file (.npz) of arrays by name: series of figures, the outcomes of every motion, the bytes of the workbook.

    It may be gone by the time that it is read, as it lies in a temporary folder where the caller named none: then
    `is_there` is False, and figures are left out.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._arrays: Any = None

    def __reduce__(self) -> tuple[type["Series"], tuple[Path]]:
        return Series, (self.path,)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Series) and self.path == other.path

    def __hash__(self) -> int:
        return hash(self.path)

    @property
    def is_there(self) -> bool:
        """Whether the file can be read."""
        return self.path.is_file()

    def __contains__(self, name: str) -> bool:
        return self.is_there and name in self._open()

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return an array; raises KeyError where there is none of this name, or the file is gone."""
        if not self.is_there:
            raise KeyError(name)
        return np.asarray(self._open()[name])

    def _open(self) -> Any:
        if self._arrays is None:
            with np.load(self.path, allow_pickle=False) as arrays:
                self._arrays = dict(arrays)
        return self._arrays


# ---------------------------------------------------------------- the whole


@dataclass(frozen=True, slots=True, kw_only=True)
class SuiteInfo:
    """The user's own motions, where they stood in for generated ones: names, hashes of their files, and own peaks."""

    folder: str
    names: tuple[str, ...]
    files: Mapping[str, str]
    is_scaled: bool
    pfa_g: tuple[float, ...]
    pfv_cm_s: tuple[float, ...]

    def __len__(self) -> int:
        return len(self.names)

    @property
    def median_pfa_g(self) -> float:
        """The median of their PFA, before scaling."""
        return float(np.median(self.pfa_g))


@dataclass(frozen=True, slots=True, kw_only=True)
class EarthquakeDraws:
    """How the number by which a draw of an earthquake scales the motions depends on the place and on scenarios.

    * `is_city`: Whether it depends on the place where that is known, as buildings of a portfolio need it.
    * `is_placed`: Whether the place is known, and it does.
    * `shared`: Share of its variance that is common to all places [-]; what scenarios carry is left out.
    * `is_shared_given`: Whether the ShakeMap gives that share; else it is that of Boore et al. (2014).
    * `measure` ("PGA" or "PGV"): The peak of the ground whose share and correlation they are.
    * `range_km`: Distance at which the correlation of the rest has fallen to exp(-3).
    * `scenarios`: Scenarios of the ground that were computed elsewhere; 0 for none.
    * `scenario_share`: Share of the variance that they carry [-].
    """

    is_city: bool
    is_placed: bool
    shared: float
    is_shared_given: bool
    measure: Literal["PGA", "PGV"]
    range_km: float
    scenarios: int
    scenario_share: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Provenance:
    """What a run is made again from.

    * `version`, `code`, `platform`: Of `assess`, the SHA-256 of its code, and versions of what the numbers were
      computed with.
    * `workbook`, `sha256`, `files`: The workbook, its hash, and the hashes of the other files by name.
    * `scenario`: Where the floor motion came from, one of `assess.settings.SCENARIOS`.
    * `anchor_code`: The code of the force on anchors, one of `assess.settings.ANCHOR_CODES`; "" where it is not known.
    * `uncertainty`: What was drawn of the earthquake and of the pieces; `earthquakes` how that depends on the place and
      on scenarios, None where it does not.
    * `shaking`, `site_ground`, `suite`: The intensity that was assumed, the ShakeMap or scenarios, and the user's own
      motions; None where nothing rests on them.
    * `sheets`, `letters`: The workbook's own names of its sheets by the English ones, and in which column a field
      stands.
    * `interval_z`: Half width of the sampling intervals, in standard deviations [-].
    * `looks`: Numbers of motions at which "auto" looks whether a class is resolved.
    * `profiles`: Every code's design profile, used or not.
    """

    version: str
    code: str
    platform: Mapping[str, str]
    workbook: str
    sha256: str
    files: Mapping[str, str]
    scenario: str
    anchor_code: str
    uncertainty: Uncertainty
    earthquakes: EarthquakeDraws | None
    shaking: Shaking | None
    site_ground: SiteGround | None
    suite: SuiteInfo | None
    language: str
    sheets: Mapping[str, str]
    letters: Mapping[str, Mapping[str, str]]
    extra_columns: tuple[str, ...]
    interval_z: float
    looks: tuple[int, ...]
    profiles: tuple[Profile, ...]


class Frame:
    """A table of the results, by its name, for a notebook."""

    def __init__(self, text: str) -> None:
        self.__doc__ = text

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, results: "Results | None", owner: type) -> "pd.DataFrame":
        """Return the table as pandas has it; the descriptor where it is asked of the class."""
        return cast("pd.DataFrame", self) if results is None else results.table(self._name).to_frame()


@dataclass(frozen=True, kw_only=True)
class Results:
    """The result of `assess.run`.

    Iterating gives an `ItemResult` a row of furniture, ``results["42-01"]`` that of one name. `items`, `cases`,
    `floors`, `segments`, `routes`, `rooms` and `problems` are pandas tables with the columns of items.csv, for
    notebooks.

    * `cases_table`: Every piece under every motion of its axis, or of both where its axis is blank; `draws` tells in
      which draws each row falls.
    * `route_tables`: Evacuation routes; its tables are empty where the workbook names none.
    * `annual`: What annual chances rest on, and those of the building; None where the workbook names no hazard file.
    * `problem_rows`: Warnings and notes about the input; `underestimates` warn that more shaking is known than is used.
    * `worked`: What each method computes for the piece `worked_item` (its index), step by step.
    * `series`: Where series for figures lie.
    * `schedule`: What to fix, with what, and what is to be expected before and after.
    * `texts`: The surveyor's own paragraphs, each with its section of the report: data, never markup.
    * `size_falls`: Expected falls if the pieces whose sizes are the Catalogue's are all broader, and all narrower, than
      it has them (thirds of their draws); None where that was not simulated.
    """

    settings: Settings
    provenance: Provenance
    building: Building
    floor_rows: tuple[FloorRow, ...]
    motions: tuple[MotionRow, ...]
    item_rows: tuple[ItemRow, ...]
    cases_table: CaseTable
    route_tables: RouteTables
    annual: AnnualTables | None
    places: tuple[Place, ...]
    catalogue: tuple[CatalogueType, ...]
    problem_rows: tuple[Problem, ...]
    underestimates: tuple[str, ...]
    methods: tuple[MethodInfo, ...]
    worked: tuple[WorkedMethod, ...]
    worked_item: int | None
    series: Series
    schedule: Schedule = NOTHING
    texts: tuple[tuple[str, str], ...] = ()
    draws: DrawTable = field(default_factory=lambda: NO_DRAWS)
    size_falls: tuple[float, float] | None = None

    items: ClassVar = Frame("One row an item, with the columns of items.csv.")
    cases: ClassVar = Frame("One row a piece and motion.")
    floors: ClassVar = Frame("One row a floor, axis and motion.")
    segments: ClassVar = Frame("One row a segment of a route.")
    routes: ClassVar = Frame("One row an evacuation route.")
    rooms: ClassVar = Frame("One row a room of the network.")
    problems: ClassVar = Frame("One row a warning or note about the input.")

    def __len__(self) -> int:
        return len(self.item_rows)

    def __iter__(self) -> Iterator[ItemResult]:
        return (
            iter(self._kept) if len(self) <= MOST_KEPT else chain.from_iterable(one.results() for one in self.parts())
        )

    def __getitem__(self, name: str) -> ItemResult:
        """Return the row of a name; raises InputError where there is none."""
        found = self._by_name.get(name)
        if found is None:
            near = difflib.get_close_matches(name, self._by_name, 1, 0.6)
            fault = nfill(
                "there is no item {name!r}: there is only one.",
                "there is no item {name!r} among the {n:,} items.",
                len(self),
                name=name,
            )
            raise InputError(join(" ", (fault, *(fill("Did you mean {name}?", name=repr(one)) for one in near))))
        return self.result(found)

    def __repr__(self) -> str:
        name, items = self.provenance.workbook, count(len(self), "item")
        return f"<Results of {name}: {items}, scenario {self.provenance.scenario!r}>"

    def _repr_html_(self) -> str:
        from assess.fields import results_html

        return results_html(self)

    def __getstate__(self) -> dict[str, Any]:
        return {one.name: getattr(self, one.name) for one in fields(self)}

    def result(self, index: int) -> ItemResult:
        """Return the result of the item at `index`; raises IndexError beyond it."""
        is_kept = len(self) <= MOST_KEPT
        return self._kept[index] if is_kept else next(ItemColumns(self, index, index + 1).results())

    def parts(self) -> Iterator[ItemColumns]:
        """Return the rows of furniture as columns, at most `PART` at a time."""
        return iter(self._kept_parts) if len(self) <= MOST_KEPT else self._make_parts()

    def _make_parts(self) -> Iterator[ItemColumns]:
        return (ItemColumns(self, start, start + PART) for start in range(0, len(self), PART))

    @cached_property
    def _kept_parts(self) -> list[ItemColumns]:
        return list(self._make_parts())

    @property
    def formula(self) -> MethodInfo:
        """The method whose value is adopted where nothing was simulated."""
        return next(one for one in self.methods if one.role == (self.settings.class_by or CLASS_BY[0]))

    @property
    def paper_formula(self) -> MethodInfo:
        """The formula that the paper proposes: its class is shown beside that of the adopted one."""
        return next(one for one in self.methods if one.role == "proposed OR")

    @property
    def simulation(self) -> MethodInfo:
        """The method by which pieces are simulated."""
        return next(one for one in self.methods if one.role == "simulation")

    @cached_property
    def has_simulated(self) -> bool:
        """Whether any piece was simulated."""
        return any(one.ensemble is not None for one in self.motions)

    @property
    def main_basis(self) -> str:
        """The basis of counts, lists and sums, one of `BASES`: simulated where any piece was, else the formula."""
        return "simulated" if self.has_simulated else "formula"

    @property
    def has_routes(self) -> bool:
        """Whether the workbook names evacuation routes."""
        return bool(self.route_tables.segments)

    def motions_of(self, floor: str, axis: str) -> list[MotionRow]:
        """Return the motions of a floor along an axis: parallel records give several."""
        return [one for one in self.motions if one.floor == floor and one.axis == axis]

    @cached_property
    def _kept(self) -> list[ItemResult]:
        return [one for part in self.parts() for one in part.results()]

    @cached_property
    def _by_name(self) -> Mapping[str, int]:
        return {one.item: one.index for one in reversed(self.item_rows)}

    # ------------------------------------------------------------ tables

    def table(self, name: str) -> Table:
        """Return a table of the fields of `assess.fields`.

        * `name` ("items", "cases", "floors", "segments", "routes", "rooms", "schedule" or "problems"): A row an item; a
          piece and motion; a floor, axis and motion; a segment; a route; a room of the network; an entry of what to
          fix; a warning or note about the input.
        """
        from assess.fields import build_table

        return build_table(self, name)
