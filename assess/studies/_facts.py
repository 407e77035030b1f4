"""Numbers that publications print, in the files of the folder `facts`, whose first lines name their source."""

import csv
from pathlib import Path


def read_facts(name: str) -> list[dict[str, str]]:
    """Return the rows of a table of published numbers by column; "" where nothing is printed."""
    file = Path(__file__).with_name("facts") / f"{name}.csv"
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))
