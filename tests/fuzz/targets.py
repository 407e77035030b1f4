"""What is fuzzed, by name, and the corpus of inputs that once broke something."""

from collections.abc import Mapping
from pathlib import Path

from tests.fuzz.engine import Target
from tests.fuzz.ground_target import GroundMotions
from tests.fuzz.plain_targets import Models, Pictures, Records, Xml
from tests.fuzz.plan_target import Plans
from tests.fuzz.workbook_target import Workbooks

TARGETS: Mapping[str, Target] = {
    "records": Records(),
    "xml": Xml(),
    "workbooks": Workbooks(),
    "models": Models(),
    "pictures": Pictures(),
    "plans": Plans(),
    "ground": GroundMotions(),
}
CORPUS = Path(__file__).parent / "corpus"
"""A folder for each target: every file broke a rule once, or reaches what the seeds do not."""


def list_corpus(name: str) -> list[Path]:
    """Return the files of a target's corpus."""
    return sorted(path for path in (CORPUS / name).glob("*") if path.suffix != ".md")
