"""What the files of three comparisons say, and the terminal: of routes, of simulated pieces, and of other bases."""

import os
import re

import pytest

from assess.cli.command_compare import describe_comparison
from assess.compare.changes import compare
from assess.compare.comparison_files import write_comparison
from assess.compare.past_run import read_run
from assess.report.report_options import ReportOptions
from assess.settings import Settings
from tests.compare.past import change, item, write_routed_run, write_run
from tests.nets.lines import read_excel, read_html, read_json
from tests.report.routed import PLACES
from tests.workbooks import ITEMS, UNVERIFIED

CASES = [("routes", "en"), ("routes", "it"), ("simulated", "en"), ("simulated", "it"), ("bases", "en")]
CHANGED = 1767225600
"""When all results were changed last [s]."""
_DIGITS = re.compile(r"\d+\.\d{9,}(e-\d+)?")
"""Of numbers whose last digits differ between processors."""


def _save(source, target, edit):
    """Write a copy of a run with what differs between machines left out."""

    def edit_all(record):
        record["assess"].update(version="1.0", code="c" * 64, platform={"python": "3.11"})
        record["assess"]["inputs"]["sha256"] = "w" * 64
        edit(record)

    change(source, target, edit_all)
    os.utime(target / "results.json", (CHANGED, CHANGED))
    return read_run(target)


def _simulate(record, probabilities, **more):
    record["assess"]["settings"].update(verify="all", **more)
    for name, (risk, low, probability, high) in probabilities.items():
        item(record, name)["adopted"].update(
            {"basis": "simulated", "class": risk, "probability": probability, "low": low, "high": high}
        )
        item(record, name)["verification"] = {"runs": 200}


def _edit_routed(record):
    item(record, "calm").update(item="<script>alert(1)</script>", description="=1+1")
    record["building"]["building"] = "</h1><b>Hall & Co"
    record["routes"]["risk"] = 0.1


def _edit_before(record):
    _simulate(record, {"A1": ("low", 0.0, 0.02, 0.04), "A2": ("medium", 0.1, 0.15, 0.2),
                       "A3": ("low", 0.0, 0.02, 0.05)}, anchor="first:2")  # fmt: skip
    record["assess"]["uncertainty"]["motion"] = 0.3


def _edit_after(record):
    _simulate(record, {"A1": ("medium", 0.01, 0.06, 0.11), "A2": ("medium", 0.3, 0.35, 0.4),
                       "A3": ("low", 0.01, 0.03, 0.05), "A5": ("high", 0.4, 0.5, 0.6)},
              ideal=True, scale=1.5)  # fmt: skip
    item(record, "A3").update(quantity=5, floor="2", weight_kg=None)
    item(record, "A4")["friction"] = 0.3
    item(record, "A4")["anchor"].update(
        counts_as_anchored=False, bracket_height_cm=150, is_height_assumed=False, bracket_capacity_kn=0.1
    )
    item(record, "A5")["adopted"]["basis"] = "unconfirmed"
    record["items"].append({**item(record, "A2"), "item": "new"})
    record["assess"].update(shaking={"name": "JMA 5+"}, code="d" * 64)
    record["assess"]["inputs"]["motions"]["quake.csv"] = "0" * 64
    record["assess"]["site_ground"] = {"file": "grid.xml", "pga_g": 0.1525, "sha256": "0123456789abcdef" * 4}
    record["building"]["client"] = "Another client"


def build(name, folder):
    """Return one of the comparisons."""
    if name == "routes":
        cellar = {"place": "Cellar", "floor": "G", "kind": "room"}
        runs = (write_routed_run(folder / "weak", Settings(verify="none", scale=0.4)),
                write_routed_run(folder / "strong", UNVERIFIED, Places=[*PLACES, cellar]))  # fmt: skip
        edits = (lambda record: None), _edit_routed
    elif name == "simulated":
        runs = (write_run(folder / "a", UNVERIFIED), write_run(folder / "b", UNVERIFIED, items=ITEMS))
        edits = _edit_before, _edit_after
    else:
        runs = (write_run(folder / "a", UNVERIFIED), write_run(folder / "b", UNVERIFIED))
        edits = (lambda record: record["building"].update(building="Library")), _edit_before
    return compare(*(_save(run, folder / side, edit)
                     for run, side, edit in zip(runs, ("before", "after"), edits, strict=True)))  # fmt: skip


def show(found, language, folder):
    """Return the lines of each output."""
    written = write_comparison(found, folder / language, ("html", "xlsx"), ReportOptions(language=language))
    cells = [_DIGITS.sub(lambda one: f"{float(one[0]):.9g}", line) for line in read_excel(written["xlsx"])]
    outputs = {"html": read_html(written["html"]), "xlsx": cells}
    if language == "en":
        data = [line for line in read_json(written["json"]) if "results_sha256" not in line]
        outputs |= {"json": data, "txt": list(describe_comparison(found))}
    return outputs


@pytest.mark.parametrize(("name", "language"), CASES)
def test_outputs_say_what_they_said(name, language, tmp_path, differ):
    outputs = show(build(name, tmp_path), language, tmp_path)
    assert [line for kind, one in outputs.items() for line in differ(f"{name}.{language}.{kind}", one)] == []
