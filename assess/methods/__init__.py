"""The methods, found in this folder: a file that defines METHOD is one. Consumers ask for roles, never for keys."""

import importlib
import pkgutil
from functools import cache

from assess.methods._alike import Alike
from assess.methods._info import Column, FittedOn, MethodInfo, Parameter, Range, Reason, Reference
from assess.methods._method import Cases, Example, Joint, LiveCells, Method, Outcome
from assess.methods._simulate import (
    LOOKS,
    LOOKS_Z,
    interval_width,
    make_batches,
    rock_cases,
    rock_draws,
    run_side_by_side,
)

__all__ = [
    "LOOKS", "LOOKS_Z", "Alike", "Cases", "Column", "Example", "FittedOn", "Joint", "LiveCells", "Method",
    "MethodInfo", "Outcome", "Parameter", "Range", "Reason", "Reference", "adopted_formula", "all_methods",
    "interval_width", "make_batches", "paper_formula", "rock_cases", "rock_draws", "run_side_by_side", "simulation",
]  # fmt: skip


@cache
def all_methods() -> tuple[Method, ...]:
    """Return every method of this folder, in the order of reports."""
    names = [module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_")]
    modules = [importlib.import_module(f"{__name__}.{name}") for name in names]
    return tuple(sorted((module.METHOD for module in modules), key=lambda method: method.order))


def adopted_formula(class_by: str | None = None) -> Method:
    """Return the formula of `assess.settings.CLASS_BY` that is adopted where nothing was simulated: the best one."""
    return _find(class_by or "best formula")


def paper_formula() -> Method:
    """Return the formula that the paper proposes: its class is shown beside that of the adopted one."""
    return _find("proposed OR")


def simulation() -> Method:
    """Return the method that integrates the rocking of pieces."""
    return _find("simulation")


@cache
def _find(role: str) -> Method:
    (found,) = (method for method in all_methods() if method.role == role)
    return found
