"""Files that are not code: templates beside the package in a checkout, inside it once installed."""

import importlib.util
from pathlib import Path


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


def fonts() -> dict[tuple[str, str], Path]:
    """Return the report's fonts by family and style: the DejaVu fonts that matplotlib brings along."""
    spec = importlib.util.find_spec("matplotlib")
    if spec is None or spec.origin is None:
        return {}
    folder = Path(spec.origin).parent / "mpl-data" / "fonts" / "ttf"
    names = {
        ("Report", "regular"): "DejaVuSans.ttf",
        ("Report", "bold"): "DejaVuSans-Bold.ttf",
        ("Report", "italic"): "DejaVuSans-Oblique.ttf",
        ("Report Mono", "regular"): "DejaVuSansMono.ttf",
        ("Report Mono", "bold"): "DejaVuSansMono-Bold.ttf",
    }
    return {style: folder / name for style, name in names.items() if (folder / name).is_file()}
