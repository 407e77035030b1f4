"""Write the sample reports of the example building into samples/reports: ``make samples``.

They are made as on one fixed day, so that only a change of the report changes them.
"""

import os
import shutil
import sys
import tempfile
from pathlib import Path

import assess

ROOT = Path(__file__).parents[1]
SAMPLES = ROOT / "samples" / "reports"
WORKBOOK = ROOT / "inventories" / "market-street.xlsx"
DAY = "1767225600"
"""1 January 2026 as SOURCE_DATE_EPOCH."""
NAMES = {"pdf": "market-street.pdf", "annex": "market-street-annex.pdf", "html": "market-street.html",
         "xlsx": "market-street.xlsx"}  # fmt: skip
"""The formats of the samples, and the name of each."""


def write_samples(folder: Path) -> dict[str, Path]:
    """Write the reports of the example into a folder, and return them by format."""
    os.environ["SOURCE_DATE_EPOCH"] = DAY
    with tempfile.TemporaryDirectory() as box:
        written = assess.write_reports(assess.run(assess.read_inventory(WORKBOOK)), box, tuple(NAMES))
        return {kind: Path(shutil.move(written[kind], folder / name)) for kind, name in NAMES.items()}


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    from docs.screenshot import take_screenshot

    SAMPLES.mkdir(parents=True, exist_ok=True)
    take_screenshot(write_samples(SAMPLES)["html"], SAMPLES / "market-street.png")
