"""Files to read: those that users name, and those that come with the package.

The latter, such as templates, lie next to the package in a checkout and inside it once installed.
"""

import errno
import importlib.util
import io
import stat
from pathlib import Path

from assess.text import fill


def templates() -> Path:
    """Return the folder of the report's templates."""
    inside = Path(__file__).with_name("templates")
    return inside if inside.is_dir() else Path(__file__).parents[1] / "templates"


_RECORDS = ("inventories/records/575-market", "samples/buildings/berkeley-1103", "samples/records")


def record(name: str) -> Path:
    """Return a file of recorded motion that comes along: in a checkout beside the package, once installed inside it."""
    inside = Path(__file__).with_name("records")
    beside = [Path(__file__).parents[1] / folder for folder in _RECORDS]
    folders = sorted(inside.iterdir()) if inside.is_dir() else beside
    return next((folder / name for folder in folders if (folder / name).is_file()), inside / name)


def example() -> Path:
    """Return the workbook of the worked example: in a checkout beside the package, once installed inside it."""
    inside = Path(__file__).with_name("examples") / "market-street.xlsx"
    return inside if inside.is_file() else Path(__file__).parents[1] / "inventories" / "market-street.xlsx"


def example_file(name: str) -> Path:
    """Return a file that the worked example names: ``records/575-market/...``."""
    beside = example().parent / name
    return beside if beside.is_file() else Path(__file__).parent / name


_CITY = {
    "grid.xml": "samples/shakemaps/loma-prieta-1989-bay/grid.xml",
    "coast.geojson": "samples/backgrounds/san-francisco-bay.geojson",
}


def city_file(name: str) -> Path:
    """Return a file of the worked city, ``grid.xml`` or ``coast.geojson``: in a checkout among the samples."""
    inside = Path(__file__).with_name("examples") / "city" / name
    return inside if inside.is_file() else Path(__file__).parents[1] / _CITY[name]


def fonts() -> dict[tuple[str, str], Path]:
    """Return the report's fonts by family and style.

    "Report" is IBM Plex Sans; "Report Signs", what it lacks, and "Report Mono" are DejaVu fonts of matplotlib.
    """
    plex = Path(__file__).with_name("fonts")
    found = {
        ("Report", "regular"): plex / "IBMPlexSans-Regular.ttf",
        ("Report", "bold"): plex / "IBMPlexSans-SemiBold.ttf",
        ("Report", "italic"): plex / "IBMPlexSans-Italic.ttf",
    }
    spec = importlib.util.find_spec("matplotlib")
    if spec is not None and spec.origin is not None:
        signs = Path(spec.origin).parent / "mpl-data" / "fonts" / "ttf"
        found |= {
            ("Report Signs", "regular"): signs / "DejaVuSans.ttf",
            ("Report Signs", "bold"): signs / "DejaVuSans-Bold.ttf",
            ("Report Signs", "italic"): signs / "DejaVuSans-Oblique.ttf",
            ("Report Mono", "regular"): signs / "DejaVuSansMono.ttf",
            ("Report Mono", "bold"): signs / "DejaVuSansMono-Bold.ttf",
        }
    return {style: path for style, path in found.items() if path.is_file()}


def web_fonts() -> dict[tuple[str, str], Path]:
    """Return the compressed fonts of an HTML report by family and style; slanted letters are made of these."""
    plex = Path(__file__).with_name("fonts")
    found = {
        ("Report", "regular"): plex / "IBMPlexSans-Regular.woff2",
        ("Report", "bold"): plex / "IBMPlexSans-SemiBold.woff2",
    }
    return {style: path for style, path in found.items() if path.is_file()}


def open_input(path: Path) -> io.BufferedReader:
    """Open a file to read its bytes; OSError if it is a pipe or a device, which may never end, or cannot be opened."""
    mode = path.stat().st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise OSError(errno.EINVAL, fill("it is a pipe or a device, not a file"), str(path))
    return path.open("rb")


def read_input(path: Path, most: int) -> bytes:
    """Return the bytes of a file, just more than `most` of a larger one; OSError, or ValueError by its name."""
    with open_input(path) as file:
        return file.read(most + 1)
