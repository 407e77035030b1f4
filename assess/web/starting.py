"""New workbooks: what they can be made of, a template by use, the worked example."""

from pathlib import Path
from typing import Any


def describe_start(home: Path | None) -> dict[str, Any]:
    """Return what a new workbook can be made of."""
    return {"start": True, "can_save": home is not None, "folder": home.name if home else ""}
