"""What commands print and write: words exactly, numbers within their error; and what they refuse, in one message.

What is refused is a line ``$ assess ...`` of `shown/refused.txt`.
"""

import contextlib
import json
import math
import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from assess.cli.app import list_names
from tests.alike import differences, strip_numbers
from tests.cli.calling import run
from tests.nets.lines import read_excel, read_html
from tests.shaking import write_records
from tests.workbooks import address, edited, write, write_sheets

SHOWN = Path(__file__).parent / "shown"
SAMPLES = Path(__file__).parents[2] / "samples"
SWEEP, FLOOR = SAMPLES / "records" / "made-up-sweep.csv", SAMPLES / "records" / "0165a_u.smc"
LACKING = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 4}]
SHAKING = {"shaking": "MMI VII, very strong"}
CORRIDOR = {"segment": "corridor", "clear_width": 1.5, "required_width": 0.9}
SHAPE = {"width": 80, "axis": "X", "height": 180}
ROUTED: dict[str, list[dict[str, Any]]] = {
    "Building": [{"period": 1.0}],
    "Floors": [{"floor": "1", "record_x": "slow.csv"}, {"floor": "2", "pfa_x": 0.5}, {"floor": "3", "pfa_x": 0.5}],
    "Catalogue": [{"type": "=Shelf"}],
    "Items": [
        {"item": "a1", "floor": "1", "breadth": 40, "type": "=Shelf", "route": "Aula", "edge_distance": 0, **SHAPE},
        {"item": "a2", "floor": "1", "breadth": 30, "type": "=Shelf", "route": "Aula", "edge_distance": 0,
         "anchored": "yes", **SHAPE},
        {"item": "@b", "floor": "2", "breadth": 50, "route": "=Bar", "quantity": 2, "edge_distance": 0, **SHAPE},
        {"item": "stout", "floor": "1", "breadth": 160, "width": 160, "height": 110, "quantity": 3},
    ],
    "Routes": [{"route": name, "floor": floor, **CORRIDOR} for name, floor in (("Aula", "1"), ("=Bar", "2"),
                                                                              ("Closet", "3"))],
}  # fmt: skip
BLOCK = ("rock", "--breadth", 40, "--height")
SIDES = ("--pfa", 0.29, "--vertical", SWEEP, "--wall", "--friction", 0.3)
SMALL = ("--runs", 20, "--seed", 3)
CALLS: dict[str, list[tuple[Any, ...]]] = {
    "help": [("--help",), *((name, "--help") for name in list_names())],
    "methods": [("methods",)],
    "record": [("record", SWEEP), ("record", FLOOR)],
    "rock": [
        (*BLOCK, 190, "--record", FLOOR, "--pfa", 0.19, "--cg", 60),
        *((*BLOCK, 180, "--record", FLOOR, "--pfa", pfa) for pfa in (0.5, 0.3, 0.1)),
        (*BLOCK, 180, "--record", FLOOR, "--restitution", 0.9, "--baseline", "none"),
        (*BLOCK, 180, "--record", f"{SWEEP}#north", *SIDES),
        (*BLOCK, 180, "--record", f"{SWEEP}#north", *SIDES, "--json"),
    ],
    "routes": [
        ("routes", "routed.xlsx", "--pfa", "0.1:0.9:0.2", *SMALL, "--csv", "routes.csv"),
        ("routes", "routed.xlsx", "--pfa", "0.1:0.9:0.2", *SMALL, "--json"),
    ],
    "fragility": [
        ("fragility", "routed.xlsx", "--levels", "0.1:0.9:0.2", *SMALL, "--by", "type", "--out", "curves"),
        ("fragility", "routed.xlsx", "--levels", "20:200:60", "--im", "pfv", "--ideal", *SMALL),
    ],
    "check": [("check", f"{name}.xlsx") for name in ("unshaken", "unfurnished", "assumed", "not-placed", "routed")]
    + [("check", "typed.xlsx", "--fix", "corrected.xlsx", *forced) for forced in ((), ("--force",))]
    + [("check", "before.xlsx", "--fix", "unchanged.xlsx")],
    "new": [
        ("new", "a b.xlsx"), ("new", "a b.xlsx", "--force"), ("new", "c.xlsx", "--example", "--units", "imperial"),
        ("new", "clinica.xlsx", "--for", "hospital", "--language", "it"), ("check", "clinica.xlsx"),
    ],
    "compare": [
        ("run", "before.xlsx", "--verify", "none", "--formats", "json", "--out", "before"),
        ("run", "before.xlsx", "--verify", "none", "--formats", "json", "--scale", 1.5, "--anchor", "A1,A3",
         "--out", "after"),
        ("compare", "before", "after", "--formats", "html,xlsx", "--out", "compared"),
    ],
    "import": [("import", SAMPLES / "models" / "duplex.ifc", "-o", "duplex.xlsx", "--routes", "draft")],
}  # fmt: skip
VARYING = re.compile(r"\b[0-9a-f]{12,64}\b|\d+\.\d+\.\d+\S*|20\d\d-\d\d-\d\d \d\d:\d\d(:\d\d)?")
"""Hashes, versions and times."""
SIMULATED = ("routes", "fragility")
"""What of few draws decides which rows there are: their words alone are compared."""
WRITTEN = {
    "routes": ("routes.csv",),
    "fragility": ("curves/fragility.csv", "curves/fragility_table.csv", "curves/fragility.json"),
    "compare": ("compared/compare.html", "compared/compare.xlsx"),
}


RECORDS = {
    "floor.smc": FLOOR.name, "sweep.csv": SWEEP.name, "upright.smc": "1103.HNZ.NP.BE_a.smc",
    "velocity.smc": "1103.HN2.NP.RE_v.smc", "README.md": "README.md",
}  # fmt: skip


def make(folder: Path) -> None:
    """Write what the calls name."""
    write_records(folder, "slow")
    write_sheets(folder / "routed.xlsx", ROUTED)
    write(folder / "unshaken.xlsx", floors=LACKING)
    write(folder / "unfurnished.xlsx", items=[])
    write(folder / "assumed.xlsx", floors=LACKING, **SHAKING)
    write(folder / "not-placed.xlsx", floors=[{"floor": "1"}, {"floor": "2"}], **SHAKING)
    write(folder / "before.xlsx", building="Town hall", period=0.8)
    habits = {address("breadth", 2): "30 cm", address("height", 2): "2 m", address("anchored", 4): "N"}
    typed = write(folder / "typed.xlsx")
    typed.write_bytes(edited(typed.read_bytes(), {"Items": habits}))


def make_refused(folder: Path) -> None:
    """Write what the calls name that are refused."""
    folder.mkdir(exist_ok=True)
    make(folder)
    write(folder / "book.xlsx")
    write(folder / "stranger.xlsx", [{"item": "a", "floor": "9", "breadth": 30, "height": 180}])
    write(folder / "stout.xlsx", [{"item": "a", "floor": "1", "breadth": 160, "width": 160, "height": 110}])
    for name in ("taken.xlsx", "taken.ifc"):
        (folder / name).write_text("mine")
    for name, sample in RECORDS.items():
        (folder / name).write_bytes((SAMPLES / "records" / sample).read_bytes())
    (folder / "model.ifc").write_bytes((SAMPLES / "models" / "duplex.ifc").read_bytes())
    rows = [f"{at / 100}, {math.sin(at / 10):.4f}, {math.cos(at / 10):.4f}" for at in range(1201)]
    for name, heads in (("level.csv", "north [g], east [g]"), ("double.csv", "up [g], down [g]")):
        (folder / name).write_text("\n".join([f"time [s], {heads}", *rows]), encoding="utf-8")
    with contextlib.chdir(folder):
        run("run", "book.xlsx", "--verify", "none", "--formats", "json", "--out", "base")
        run("compare", "base", "base", "--formats", "json", "--out", "compared")


def refuse() -> list[str]:
    """Return the calls that are refused with their messages; nothing is printed to be kept, and no file changes."""
    lines: list[str] = []
    there = {path: path.stat().st_mtime_ns for path in Path().rglob("*")}
    for call in (SHOWN / "refused.txt").read_text(encoding="utf-8").splitlines():
        if call.startswith("$ assess "):
            done = run(*shlex.split(call)[2:])
            assert done.exit_code in (1, 2), call
            assert (done.stdout, type(done.exception)) == ("", SystemExit), call
            assert {path: path.stat().st_mtime_ns for path in Path().rglob("*")} == there, call
            said = [line for line in done.stderr.splitlines() if not line.startswith(("Usage: ", "Try "))]
            said = [line.replace(f"{Path.cwd()}", "here") for line in said if line]
            lines += [call, *said, *([f"[{done.exit_code}]"] if done.exit_code != 2 else [])]
    return lines


def read(path: Path) -> Iterator[str]:
    """Yield the lines of a file."""
    if path.suffix == ".html":
        return iter(read_html(path))
    return iter(read_excel(path) if path.suffix == ".xlsx" else path.read_text("utf-8-sig").splitlines())


def show(name: str) -> list[str]:
    """Return what calls print and write, in the folder in which one stands, without versions, hashes and times."""
    lines: list[str] = []
    for words in CALLS[name]:
        done = run(*words)
        printed = done.stdout
        if "--json" in words:
            document = json.loads(printed)
            document.pop("assess", None)
            printed = json.dumps(document, indent=1)
        lines += [f"$ assess {' '.join(str(word) for word in words)}", *printed.splitlines()]
        lines += [*done.stderr.splitlines(), f"[{done.exit_code}]"]
    for file in WRITTEN.get(name, ()):
        lines += [f"$ {file}", *read(Path(file))]
    return [VARYING.sub("…", line).replace(f"{SAMPLES}", "samples")
            for line in lines if not re.search("ISO|platform|processor", line)]  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("printed")
    make(folder)
    return folder


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.slow] * (name == "import")) for name in CALLS])
def test_commands_print_what_they_printed(folder, monkeypatch, differ, name):
    def differ_in_words(now: list[str], kept: list[str]) -> list[str]:
        return sorted({strip_numbers(line) for line in now} ^ {strip_numbers(line) for line in kept})

    monkeypatch.chdir(folder)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1767225600")
    assert differ(name, show(name), differ_in_words if name in SIMULATED else differences) == []


def test_what_is_refused_is_named_and_nothing_is_written(tmp_path, monkeypatch, differ):
    make_refused(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert differ("refused", refuse()) == []
