"""The paper repeated on open data, and its formulas compared with direct integration.

A study is a module of this folder, or a folder in it, that defines STUDY.
"""

import importlib
import pkgutil
from functools import cache

from assess.studies.run_studies import PAGE, build_page, run_all, run_study
from assess.studies.study import Finding, Options, Study
from assess.studies.study_files import PARTS, check_folder, write_files

__all__ = [
    "PAGE", "PARTS", "Finding", "Options", "Study", "all_studies", "build_page", "check_folder", "run_all", "run_study",
    "write_files",
]  # fmt: skip


@cache
def all_studies() -> tuple[Study, ...]:
    """Return every study of this folder, in the order of the page."""
    modules = [importlib.import_module(f"{__name__}.{module.name}") for module in pkgutil.iter_modules(__path__)]
    return tuple(sorted((one.STUDY for one in modules if hasattr(one, "STUDY")), key=lambda study: study.order))
