"""`assess fragility`: its table, document, files and figure, and what it says of bad input."""

import csv
import io
import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from matplotlib.figure import Figure

import assess
from assess.cli.curve_figures import CURVES_A_PANEL, MOST_CURVE_PANELS, choose_curves, paint_curves
from assess.cli.fragility_output import FORMATS, MOST_LINES, Curves
from assess.fragility import fit_fragility, lognormal_chance
from assess.model import Floor, Item
from assess.pipeline.demand import Demand
from assess.pipeline.piece_fragility import FloorMotions, PieceFragilities, PieceFragility, find_piece_fragilities
from assess.pipeline.run import compute
from assess.units import GRAVITY
from tests.cli.calling import error, run
from tests.shaking import write_records
from tests.workbooks import write_sheets

SHAPE = {"width": 80, "axis": "X", "height": 180}
ITEMS = [
    {"item": "a1", "floor": "1", "breadth": 40, "type": "=Shelf", "quantity": 2, **SHAPE},
    {"item": "a2", "floor": "2", "breadth": 30, "type": "=Shelf", "anchored": "yes", **SHAPE},
    {"item": "@b", "floor": "1", "breadth": 60, **SHAPE},
    {"item": "stout", "floor": "1", "breadth": 160, "width": 160, "height": 110},
]
FLOORS = [{"floor": "1", "record_x": "slow.csv"}, {"floor": "2", "pfa_x": 0.5, "pfv_x": 60}]
SWEEP = ("--levels", "0.1:0.9:0.1", "--runs", "20", "--seed", "3")
LEVELS = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]


def write(folder: Path, **rows: Any) -> Path:
    write_records(folder, "slow")
    path = folder / "w.xlsx"
    content = {"Building": [{}], "Floors": FLOORS, "Items": ITEMS, "Catalogue": [{"type": "=Shelf"}], **rows}
    write_sheets(path, content)
    return path


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The folder of one run by type with everything that it can write, and its document."""
    folder = tmp_path_factory.mktemp("fragility")
    path, out = write(folder), folder / "out"
    done = run("fragility", path, *SWEEP, "--by", "type", "--json", "--out", out, "--plot", folder / "f.svg")
    assert (done.exit_code, done.exception) == (0, None)
    names = ("fragility.csv", "fragility_table.csv", "fragility.json")
    assert [line for line in done.stderr.splitlines() if line.startswith("wrote")] == [
        *(f"wrote {out / name}" for name in names), f"wrote {folder / 'f.svg'}",
    ]  # fmt: skip
    assert sorted(one.name for one in out.iterdir()) == sorted(names)
    document = json.loads(done.stdout)
    assert json.loads((out / "fragility.json").read_text(encoding="utf-8")) == document
    rows = list(csv.DictReader((out / "fragility.csv").read_text("utf-8-sig").splitlines()))
    assert [row["name"] for row in rows] == ["'=Shelf", "60 x 180 cm"], "no text is taken for a formula"
    return folder, document


def test_it_is_what_the_library_finds(made):
    folder, document = made
    settings = assess.Settings(verify="none", runs=20, seed=3)
    assessment = compute(assess.read_inventory(folder / "w.xlsx"), settings)
    found = find_piece_fragilities(assessment, by="type", levels=[one * GRAVITY for one in LEVELS])
    for one, curve in zip(document["curves"], found.curves, strict=True):
        assert [row["fallen"] for row in one["table"]] == curve.curve.fallen.tolist()
        assert one["kind"] == curve.curve.kind == "fitted"
        assert one["median_pfa_g"] == curve.curve.median / GRAVITY
        assert (one["beta"], one["misfit"]) == (curve.curve.dispersion, curve.curve.misfit)
        levels = np.array([row["pfa_g"] for row in one["table"]])
        assert [row["fitted"] for row in one["table"]] == pytest.approx(
            lognormal_chance(levels, one["median_pfa_g"], one["beta"]).tolist()
        )


# --- curves that are made up ---


DEMAND = Demand(floor=Floor(row=2, floor="1"), axis="X", source="given", pfa=3.0, pfv=0.4)


def curves_of(*shares: list[float], weak: bool = False) -> Curves:
    """Curves over 0.1, 0.2, ... g with these shares of 100 draws."""
    motions = FloorMotions(demand=DEMAND, mean_pfa=3.0, mean_pfv=0.45, is_assumed=True, is_unknown=weak, is_weak=False)
    every = []
    for number, one in enumerate(shares):
        levels = [GRAVITY * (1 + at) / 10 for at in range(len(one))]
        curve = fit_fragility(levels, [100 * share for share in one], [100] * len(one))
        item = Item(row=2, item=f"p{number}", floor="1", breadth=0.4, height=1.8)
        every.append(PieceFragility(name=item.item, type="", items=(item,), curve=curve, motions=(motions,)))
    found = PieceFragilities(
        by="item", im="pfa", runs=100, seed=1, has_drawn_pieces=True, curves=tuple(every), stocky=()
    )
    floors = (SimpleNamespace(floor="1"),)
    inventory = SimpleNamespace(file_name="w.xlsx", sha256="", floors=floors)
    return Curves(cast("Any", SimpleNamespace(inventory=inventory, scenario="given")), found)


def test_where_nothing_is_fitted_the_reason_stands():
    curves = curves_of([0, 0, 0], [0, 0, 1], weak=True)
    none, apart = curves.describe()["curves"]
    assert [one["kind"] for one in (none, apart)] == ["none fell", "separated"]
    assert [none[name] for name in ("median_pfa_g", "beta", "misfit", "is_lognormal")] == [None, None, None, False]
    assert none["why"] == "not fitted: nothing fell at any level"
    assert [row["fitted"] for row in none["table"]] == [None] * 3
    text = " ".join(curves.to_text().split())
    assert " - - - 0.15 not fitted: nothing fell at any level; may be too low " in text
    (row, _) = csv.DictReader(io.StringIO(curves.to_csv()))
    assert (row["median_pfa_g"], row["beta"]) == ("", "")
    assert set(FORMATS["csv"](curves).files) == {"fragility.csv", "fragility_table.csv"}


def test_a_long_text_is_cut_the_document_is_not_and_the_figure_draws_the_lowest_medians_first():
    curves = curves_of(*[[0.1, 0.5, 0.9]] * (MOST_LINES + 3))
    assert "\n... and 3 more, which files and --json hold.\n" in curves.to_text()
    assert len(curves.describe()["curves"]) == MOST_LINES + 3
    flat, early, late = [0.0, 0.0, 0.0, 0.0], [0.1, 0.6, 0.9, 1.0], [0.0, 0.1, 0.6, 0.9]
    curves = curves_of(flat, late, early)
    panels, left = choose_curves(curves.found.curves)
    assert ([one.name for one in panels[0]], len(panels), left) == (["p2", "p1", "p0"], 1, 0)
    panels, left = choose_curves(curves_of(*[early] * 40).found.curves)
    assert [len(one) for one in panels] == [CURVES_A_PANEL] * MOST_CURVE_PANELS
    assert left == 40 - CURVES_A_PANEL * MOST_CURVE_PANELS
    assert [len(one) for one in choose_curves(curves_of(*[early] * 8).found.curves)[0]] == [4, 4]


def test_the_figure_holds_the_shares_and_the_fits():
    curves = curves_of([0.1, 0.6, 0.9, 1.0], [0.0, 0.0, 0.0, 0.0], weak=True)
    panels, _ = choose_curves(curves.found.curves)
    figure = Figure(figsize=(8, 4.6))
    paint_curves(curves, panels, figure)
    (axes,) = figure.axes
    points, fitted, _, still, dots, _ = axes.lines
    assert list(points.get_xdata()) == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert list(points.get_ydata()) == [0.1, 0.6, 0.9, 1.0]
    one = curves.found.curves[0].curve
    x, y = (np.asarray(values, dtype=float) for values in (fitted.get_xdata(), fitted.get_ydata()))
    assert y == pytest.approx(lognormal_chance(x, one.median / GRAVITY, one.dispersion))
    assert list(still.get_ydata()) == list(dots.get_ydata()) == [0, 0, 0, 0]
    legend = axes.get_legend()
    assert legend is not None
    texts = [text.get_text() for text in legend.get_texts()]
    assert texts[0].startswith(f"p0 *\nmedian {one.median / GRAVITY:.3g} g, beta {one.dispersion:.2f}")
    assert texts[1] == "p1 *\nnone fell"
    title = " ".join(figure.get_suptitle().split())
    assert "the uncertainty of the motion is not in it" in title
    assert "PFV/PFA 0.15 to 0.15 s" in title
    assert "* Its motions may be too weak" in title


# --- what is wrong ---


def test_files_appear_all_or_none(tmp_path, monkeypatch):
    """The second file cannot be written: the first one is as it was."""
    path, out = write(tmp_path), tmp_path / "out"
    out.mkdir()
    (out / "fragility.csv").write_text("before", encoding="utf-8")
    written = Path.open

    def forbid(self: Path, *words: Any, **named: Any):
        if self.name.startswith("fragility_table"):
            raise OSError(28, "No space left on device")
        return written(self, *words, **named)

    monkeypatch.setattr(Path, "open", forbid)
    done = run("fragility", path, *SWEEP, "--out", out)
    assert done.exit_code == 1
    assert "fragility_table.csv could not be written: No space left on device." in done.stderr
    assert [(one.name, one.read_text(encoding="utf-8")) for one in out.iterdir()] == [("fragility.csv", "before")]


GROUND = [{"ground_pga": 0.25, "height": 9}]


@pytest.mark.slow
def test_files_for_pelicun_and_openquake(tmp_path):
    """What a format has no place for is named with its reason, and the exit status tells; the files are written."""
    path, out = write(tmp_path, Building=GROUND), tmp_path / "out"
    done = run("fragility", path, "--by", "type", "--runs", 200, "--formats", "pelicun,nrml", "--out", out)
    assert done.exit_code == 1
    assert sorted(one.name for one in out.iterdir()) == ["w-nrml.xml", "w-pelicun.csv", "w-pelicun.json"]
    table = csv.DictReader(io.StringIO((out / "w-pelicun.csv").read_text(encoding="utf-8")))
    assert [row["ID"] for row in table] == ["assess.w.Shelf.pfa"]
    (left,) = json.loads((out / "w-pelicun.json").read_text(encoding="utf-8"))["_GeneralInformation"]["LeftOut"]
    assert left["Name"] == "60 x 180 cm"
    lines = [line for line in done.stderr.splitlines() if line.startswith("left out of ")]
    assert lines == [f"left out of w-pelicun.csv: 1 curve (60 x 180 cm): {left['Reason']}"]
    taxonomies = re.findall(r'fragilityFunction id="(.+?)" format="(.+?)"', (out / "w-nrml.xml").read_text("utf-8"))
    assert taxonomies == [
        ("Shelf|1", "continuous"), ("Shelf|2", "continuous"), ("60_x_180_cm|1", "discrete"),
    ]  # fmt: skip


def test_nothing_is_written_where_a_format_has_no_curve_at_all(tmp_path):
    path = write(tmp_path)
    words = ("--levels", "0.01:0.02:0.01", "--runs", 5, "--formats", "csv,pelicun", "--out", tmp_path / "out")
    text = error(run("fragility", path, *words))
    said = "none of the 3 curves can be written for pelicun. The first is a1: not fitted: nothing fell"
    assert f"--formats: {said}" in text
    assert not (tmp_path / "out").exists()
