"""What works on this machine, what does not, and the exact mend."""

import platform
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from assess import resources
from assess.errors import PdfUnavailableError
from assess.version import __version__

_PACKAGES = (
    "numpy",
    "scipy",
    "numba",
    "openpyxl",
    "defusedxml",
    "XlsxWriter",
    "jinja2",
    "matplotlib",
    "weasyprint",
    "shapely",
    "networkx",
    "typer",
    "pandas",
)


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was looked at."""

    what: str
    works: bool
    detail: str


def examine() -> list[Finding]:
    """Look at versions, templates, fonts and the libraries of the PDF."""
    findings = [Finding("assess", True, f"{__version__}, Python {platform.python_version()}, {platform.platform()}")]
    findings += [_package(name) for name in _PACKAGES]
    findings.append(_obspy())
    templates = resources.templates() / "report.html.j2"
    findings.append(Finding("templates", templates.is_file(), str(templates.parent)))
    fonts = resources.fonts()
    mend = "pip install --force-reinstall matplotlib"
    findings.append(
        Finding("fonts", len(fonts) == 5, ", ".join(path.name for path in fonts.values()) if fonts else mend)
    )
    findings.append(_pdf())
    return findings


def _package(name: str) -> Finding:
    try:
        return Finding(name, True, version(name))
    except PackageNotFoundError:
        return Finding(name, False, f"pip install {name}")


def _obspy() -> Finding:
    try:
        return Finding("obspy", True, version("obspy"))
    except PackageNotFoundError:
        return Finding(
            "obspy", True, 'not installed, and needed for SAC and miniSEED only: pip install "assess[obspy]"'
        )


def _pdf() -> Finding:
    from assess.report.pages.pdf import load_weasyprint

    try:
        weasyprint = load_weasyprint()
    except PdfUnavailableError as error:
        return Finding("PDF", False, str(error))
    return Finding("PDF", True, f"WeasyPrint {weasyprint.__version__} with its native libraries")
