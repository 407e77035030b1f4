"""What to do where two runs were computed by different code of the program: assess the older workbook again."""

import hashlib
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from assess.errors import InputError
from assess.input_file import read_input
from assess.settings import CLASS_BY, SCENARIOS, Settings
from assess.version import find_code

if TYPE_CHECKING:
    from assess.compare.past_run import PastRun

OPTIONS = (
    "scenario", "class_by", "verify", "runs", "seed", "scale", "anchor", "ideal", "scale_motions", "city", "route_risk",
)  # fmt: skip
"""Settings that `assess run` has an option for."""
_FILLED = (SCENARIOS[0], CLASS_BY[0])
"""What stands for the workbook's own, where that says nothing else."""
PDF = "report.pdf"
MOST_BYTES = 1 << 28
"""Size [bytes] above which a workbook is not looked at."""


def check_code(before: "PastRun", after: "PastRun") -> None:
    """Raise InputError where two runs were computed by different code, with the commands that make them comparable."""
    if before.code == after.code:
        return
    fault = (
        f"{before.path.parent} and {after.path.parent} were computed by different code of assess: what differs between "
        "them may come from the program, not from the furniture."
    )
    runs = {"BEFORE": before, "AFTER": after}
    ways = [way for name, run in runs.items() if run.code != find_code() for way in _list_ways(name, run)]
    raise InputError("\n".join((fault, *ways, "To compare them as they are: --as-is.")))


def _list_ways(name: str, run: "PastRun") -> Iterator[str]:
    """Yield the command that assesses the workbook of a run again, and where that workbook is."""
    folder, workbook = run.path.parent, Path(run.workbook).name  # a name alone: results.json may come from anybody
    places = (folder / workbook, folder.parent / workbook, Path(workbook))
    found = next((one for one in places if _is_file(one, run.workbook_sha256)), None)
    default = Settings().as_record()
    parts = ["assess", "run", str(found or workbook), "--out", f"{folder.resolve().name}-again"]
    for option in OPTIONS:
        value = run.settings.get(option)
        if value not in (None, default[option], *_FILLED):
            parts += [f"--{option.replace('_', '-')}", *(() if value is True else (str(value),))]
    yield f"Assess {name} again, and compare that: {shlex.join(parts)}"
    if found is None and (folder / PDF).is_file():
        yield f"{workbook} is attached to {folder / PDF}: save it from there."


def _is_file(path: Path, sha256: str) -> bool:
    try:
        return hashlib.sha256(read_input(path, MOST_BYTES)).hexdigest() == sha256
    except (OSError, ValueError):
        return False
