"""One worked example: what each method computes for one piece, step by step with its numbers."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from assess.language import gettext as _
from assess.methods import Method, all_methods
from assess.report.example.formulas import work_kaneko_hayashi, work_proposed_or
from assess.report.example.others import work_fema_p58, work_housner, work_ishiyama, work_japan_rule, work_static
from assess.report.example.steps import Piece, Worked, chance, fill_in, show_acceleration, show_ratio
from assess.results import ItemResult
from assess.settings import Settings
from assess.units import ACCELERATION, LENGTH, VELOCITY, to_edge

WORKING: Mapping[str, Callable[[Piece], Worked]] = {
    "proposed_or": work_proposed_or,
    "kaneko_hayashi": work_kaneko_hayashi,
    "static": work_static,
    "ishiyama": work_ishiyama,
    "japan_rule": work_japan_rule,
    "fema_p58": work_fema_p58,
    "housner_monte_carlo": work_housner,
}
"""How the numbers of each published method are shown; `_work_fitted` shows those of fitted models."""


@dataclass(frozen=True, slots=True)
class WorkedMethod:
    """What one method computes for the piece: `steps` with the numbers put in, and the `result` in words."""

    key: str
    title: str
    steps: Sequence[str]
    result: str


def choose_example(results: Iterable[ItemResult]) -> ItemResult | None:
    """Return the piece that is worked through, the worst that is free-standing and verified; None of no pieces.

    One that is free-standing comes before one that is verified, and that before one of a higher risk.
    """
    return min(results, key=_example_first, default=None)


def _example_first(one: ItemResult) -> tuple[bool, bool, int, float]:
    return one.is_anchored, not one.is_verified, -int(one.adopted.upper), -one.adopted.probability


def work_example(
    one: ItemResult,
    settings: Settings,
    *,
    restitution: float | None = None,
    methods: Sequence[Method] | None = None,
) -> Sequence[WorkedMethod]:
    """Return the calculation of every method that was evaluated for a piece, under the motion that governs it.

    Parameters
    ----------
    one : ItemResult
        The piece.
    settings : Settings
        Of the assessment.
    restitution : float, optional
        The building's own restitution [-]; None is Housner's.
    methods : sequence of Method, optional
        Those that are worked; by default the published ones.

    Returns
    -------
    sequence of WorkedMethod
        In the order of reports; a published method without an entry in `WORKING` is left out.
    """
    case = one.governing
    piece = Piece(
        B=to_edge(one.item.breadth, LENGTH["cm"]),
        H=to_edge(one.item.height, LENGTH["cm"]),
        PFA=case.demand.pfa / ACCELERATION["cm/s2"],
        PFV=case.demand.pfv / VELOCITY["cm/s"],
        case=case,
        settings=settings,
        restitution=math.nan if restitution is None else restitution,
    )
    worked = []
    for method in all_methods() if methods is None else methods:
        work = _find_working(method)
        if work is not None and case.methods[method.key].value is not None:
            with np.errstate(all="ignore"):
                steps, result = work(piece)
            worked.append(WorkedMethod(method.key, _(method.title), tuple(steps), result))
    return tuple(worked)


def _find_working(method: Method) -> Callable[[Piece], Worked] | None:
    """Return how the numbers of a method are shown; None for a published one that nothing shows."""
    return WORKING.get(method.key) if method.fitted is None else partial(_work_fitted, method)


def _work_fitted(method: Method, piece: Piece) -> Worked:
    """Put what a fitted model reads beside its equation, which holds for any piece, and its coefficients."""
    velocity = [] if math.isnan(piece.PFV) else [fill_in("PFV = {PFV:.6g} cm/s", **piece.put)]
    raw = fill_in("R = {raw:.4f}", raw=piece.detail(method, "raw"))
    steps = [show_ratio(piece), show_acceleration(piece), *velocity, *map(_, method.equations), raw]
    return steps, chance("R", piece.value(method))
