"""The paper done again, and its formulas held against direct integration: a file that defines STUDY is a study."""

import importlib
import pkgutil
from functools import cache

from assess.studies._study import Finding, Options, Study

__all__ = ["Finding", "Options", "Study", "all_studies"]


@cache
def all_studies() -> tuple[Study, ...]:
    """Return every study of this folder, in the order of the page."""
    names = [module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_")]
    modules = [importlib.import_module(f"{__name__}.{name}") for name in names]
    return tuple(sorted((module.STUDY for module in modules), key=lambda study: study.order))
