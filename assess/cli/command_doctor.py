"""``assess doctor``: what works on this machine, what does not, and how to fix it."""

import platform
import re
import tomllib
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

import typer

from assess import resources
from assess.cli.console import say
from assess.compiled import choose_folder
from assess.environment import say_install
from assess.errors import PdfUnavailableError
from assess.version import __version__

ORDER = 9
EXAMPLES = ("assess doctor", "assess doctor > doctor.txt")

FONTS = 8  # fonts of the reports
_REQUIREMENT = re.compile(
    r"(?P<name>[A-Za-z0-9._-]+)[^;>]*(>=\s*(?P<least>[0-9.]+))?[^;]*(;.*extra\s*==\s*['\"](?P<extra>[^'\"]+))?"
)


def command() -> None:
    """Show what works on this machine, and how to fix the rest.

    Versions of the dependencies, native libraries of the PDF, fonts and templates.
    """
    from assess.report.pages.pdf import find_weasyprint

    findings = [Finding("assess", True, f"{__version__}, Python {platform.python_version()}, {platform.platform()}")]
    findings += map(examine_package, list_requirements())
    templates = resources.templates()
    findings.append(Finding("templates", (templates / "page.html.j2").is_file(), str(templates)))
    fonts = [path.name for path in resources.fonts().values()]
    fix = "pip install --force-reinstall assess matplotlib"
    findings.append(Finding("fonts", len(fonts) == FONTS, ", ".join(fonts) if len(fonts) == FONTS else fix))
    try:
        findings.append(Finding("PDF", True, f"WeasyPrint {find_weasyprint()} with its native libraries"))
    except PdfUnavailableError as error:
        findings.append(Finding("PDF", False, str(error)))
    folder, fault = choose_folder()  # one that others can write to is not used
    used = f"kept in {folder}" if folder else "not kept: every run compiles anew, which takes half a minute"
    fix = "Give the folder to yourself alone (chmod go-w), or name another one with NUMBA_CACHE_DIR"
    findings.append(Finding("compiled code", not fault, f"{fault}. {used}. {fix}" if fault else used))
    for finding in findings:
        say(f"{'ok     ' if finding.works else 'missing'}  {finding.what}: {finding.detail}")
    if not all(finding.works for finding in findings):
        raise typer.Exit(1)


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was examined; `detail` is its version or place, or how to fix it."""

    what: str
    works: bool
    detail: str


@dataclass(frozen=True, slots=True)
class Requirement:
    """A package that the project declares: its lowest version, "" for any, and its extra, "" where it is required."""

    name: str
    least: str
    extra: str


def list_requirements() -> list[Requirement]:
    """Return the declared dependencies: those of the installed distribution, in a checkout those of pyproject.toml."""
    try:
        lines = metadata.requires("assess") or []
    except metadata.PackageNotFoundError:
        file = Path(__file__).parents[2] / "pyproject.toml"
        project = tomllib.loads(file.read_text(encoding="utf-8"))["project"] if file.is_file() else {}
        extras = project.get("optional-dependencies", {})
        own = (f'{line}; extra == "{extra}"' for extra, lines in extras.items() for line in lines)
        lines = [*project.get("dependencies", []), *own]
    found: dict[str, Requirement] = {}
    for line in lines:
        parts = _REQUIREMENT.match(line)
        if parts and parts["extra"] != "dev":  # that only developers need
            one = Requirement(parts["name"], parts["least"] or "", parts["extra"] or "")
            found.setdefault(one.name.lower(), one)  # two extras may need the same package
    return list(found.values())


def examine_package(one: Requirement) -> Finding:
    """Return whether a package is there in a version that serves; an optional one may be missing."""
    wanted = f"{one.name}>={one.least}" if one.least else one.name
    try:
        found = metadata.version(one.name)
    except metadata.PackageNotFoundError:
        if one.extra:
            return Finding(one.name, True, f"optional, not installed. {say_install(one.extra)}")
        return Finding(one.name, False, f'not installed: pip install "{wanted}"')
    if _numbers(found) < _numbers(one.least):
        return Finding(one.name, False, f'{found} is too old: pip install "{wanted}"')
    return Finding(one.name, True, f"{found} (optional: {one.extra})" if one.extra else found)


def _numbers(version: str) -> tuple[int, ...]:
    """Return the leading numbers of a version, without zeros at the end: (2, 10) for "2.10.0rc1"."""
    numbers = [int(part) for part in re.findall(r"\d+", re.sub(r"[^0-9.].*", "", version))]
    while numbers and numbers[-1] == 0:
        numbers.pop()
    return tuple(numbers)
