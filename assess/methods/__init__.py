"""The methods, found by looking into this folder: a file that defines METHOD is a method."""

import importlib
import pkgutil
from functools import cache

from assess.methods._method import Cases, Method, Outcome, Range, Reference

__all__ = ["Cases", "Method", "Outcome", "Range", "Reference", "all_methods"]


@cache
def all_methods() -> tuple[Method, ...]:
    """Return every method of this folder, in the order of reports."""
    names = [module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_")]
    modules = [importlib.import_module(f"{__name__}.{name}") for name in names]
    return tuple(sorted((module.METHOD for module in modules), key=lambda method: method.order))
