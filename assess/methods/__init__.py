"""The methods, found in this folder: a file that defines METHOD is one. Consumers ask for roles, never for keys.

In: `Cases`, equal-length arrays in SI units, NaN for unknown. Out: `Outcome`, a value in [0, 1] or NaN for each case.
May import: `rocking`, `motion` and what stands below. One publication is one file.

`cases` is what they are evaluated on, `method` how one describes itself; `expression` writes their formulas, `simulate`
is what simulations share, and `fitted` makes a method of a model that a study fitted.
"""

import importlib
import pkgutil
from functools import cache

from assess.methods.cases import ALIKE, NO_WALL, SIDE_UNKNOWN, Alike, Cases, Ensemble, Joint, Motions
from assess.methods.method import (
    FACTS,
    PFV_FLAGS,
    Column,
    Example,
    FittedOn,
    LiveCells,
    Method,
    MethodInfo,
    Outcome,
    Parameter,
    Range,
    Reason,
    Reference,
)

__all__ = [
    "ALIKE", "FACTS", "NO_WALL", "PFV_FLAGS", "SIDE_UNKNOWN", "Alike", "Cases", "Column", "Ensemble", "Example",
    "FittedOn", "Joint", "LiveCells", "Method", "MethodInfo", "Motions", "Outcome", "Parameter", "Range", "Reason",
    "Reference", "adopted_formula", "all_methods", "paper_formula", "simulation",
]  # fmt: skip


@cache
def all_methods() -> tuple[Method, ...]:
    """Return every method of this folder, in the order of reports."""
    modules = [importlib.import_module(f"{__name__}.{found.name}") for found in pkgutil.iter_modules(__path__)]
    return tuple(sorted((one.METHOD for one in modules if hasattr(one, "METHOD")), key=lambda method: method.order))


def adopted_formula(class_by: str | None = None) -> Method:
    """Return the formula of `assess.settings.CLASS_BY` that is adopted where nothing was simulated: the best one."""
    return _find(class_by or "best formula")


def paper_formula() -> Method:
    """Return the formula that the paper proposes: its class is shown next to that of the adopted one."""
    return _find("proposed OR")


def simulation() -> Method:
    """Return the method that integrates the rocking of pieces."""
    return _find("simulation")


@cache
def _find(role: str) -> Method:
    (found,) = (method for method in all_methods() if method.role == role)
    return found
