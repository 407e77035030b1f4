"""The formats of a run's reports: what the command, the page and `assess` write; each is found in this folder.

They are known without loading what writes them.
"""

import importlib
import importlib.util
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from assess.errors import InputError
from assess.extras import say_install
from assess.i18n import fill

if TYPE_CHECKING:
    from assess.report.job import Job


@dataclass(frozen=True, slots=True, kw_only=True)
class Format:
    """A format of reports.

    Parameters
    ----------
    key, file : str
        What it is called, and the name of its file.
    place : int
        Where it stands in lists of formats.
    write : callable
        Writes the file; it imports what it needs when it is called.
    is_default : bool
        Whether it is written where no format is named.
    edition : {"client", "annex"}, optional
        Of a PDF, which is begun before all others and written last, as it carries results.json.
    needs : mapping of str to str
        Packages beyond those of every report, by the modules that they bring, and `extra` which brings them.
    """

    key: str
    file: str
    place: int
    write: Callable[["Job", Path], None]
    is_default: bool = True
    edition: Literal["client", "annex"] | None = None
    needs: Mapping[str, str] = field(default_factory=dict)
    extra: str = ""

    @property
    def missing(self) -> list[str]:
        """The packages that are not installed."""
        return [package for module, package in self.needs.items() if importlib.util.find_spec(module) is None]

    def check(self) -> None:
        """Raise InputError, with what to install, if a package is missing."""
        if missing := self.missing:
            text = fill("the format {format} needs {packages}, which is not installed. {how}", format=self.key,
                        packages=", ".join(missing), how=say_install(self.extra))  # fmt: skip
            raise InputError(text)


def _find_formats() -> list[Format]:
    modules = [importlib.import_module(f"{__name__}.{one.name}") for one in pkgutil.iter_modules(__path__)]
    return sorted((one for module in modules for one in module.FORMATS), key=lambda one: one.place)


FORMATS: Mapping[str, Format] = {one.key: one for one in _find_formats()}
FILES: Mapping[str, str] = {one.key: one.file for one in FORMATS.values()}
DEFAULT = tuple(one.key for one in FORMATS.values() if one.is_default)
ALL = "all"
"""In place of formats: every one, of those that need more packages where these are installed."""
