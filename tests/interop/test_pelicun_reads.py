"""pelicun itself, in an environment of its own, gives the chances that were fitted: `make test-long`."""

import json
import math
import subprocess
import sys
import venv
from pathlib import Path

import pytest

import assess
from assess.fragility import lognormal_chance
from assess.pipeline.piece_fragility import BY, MEASURES, find_piece_fragilities
from assess.pipeline.run import compute
from assess.report.interchange.pelicun import write_pelicun
from tests.interop.pelicun_reader import FACTORS, SAMPLES

ROOT = Path(__file__).parents[2]
READER = Path(__file__).with_name("pelicun_reader.py")
SIZES = {"pfa": 9.80665, "pfv": 1.0}
"""g and m/s, in m/s2 and m/s."""
WANTED = "pelicun>=3.10,<3.11"


def build_environment() -> Path:
    """Return the interpreter of an environment with pelicun (588 MB), which is kept in build/."""
    folder = ROOT / "build" / "venv-pelicun"
    python = folder / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
    if not python.is_file():
        venv.create(folder, with_pip=True)
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", WANTED], check=True)
    return python


@pytest.mark.long
def test_pelicun_gives_the_chances_that_were_fitted(tmp_path):
    """Items and types of the worked example, against PFA and PFV, in one direction and in the larger of two."""
    python = build_environment()
    inventory = assess.read_inventory(ROOT / "inventories" / "market-street.xlsx")
    assessment = compute(inventory, assess.Settings(verify="none", runs=200))
    read = 0
    for by in BY:
        for im in MEASURES:
            found = find_piece_fragilities(assessment, by=by, im=im)
            files = write_pelicun(assessment, found).files
            for name, data in files.items():
                (tmp_path / name).write_bytes(data)
            curves = [one.curve for one in found.curves if one.curve.is_lognormal]
            medians = tmp_path / "medians.json"
            medians.write_text(json.dumps([one.median / SIZES[im] for one in curves]), encoding="utf-8")
            for direction in ("1", "0"):
                command = [python, READER, tmp_path / "market-street-pelicun.csv", medians, direction]
                done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
                shares = json.loads(done.stdout.splitlines()[-1])
                check(shares, curves)
                read += len(shares)
    assert read > 400


def check(shares, curves):
    """Hold the share of each component against its own curve, within four standard errors of the samples."""
    assert len(shares) == len(curves) > 0
    for (name, own), curve in zip(shares.items(), curves, strict=True):
        for factor in FACTORS:
            chance = float(lognormal_chance(factor, 1.0, curve.dispersion))
            error = 4 * math.sqrt(max(chance * (1 - chance), 1e-4) / SAMPLES) + 1e-3
            assert own[str(factor)] == pytest.approx(chance, abs=error), (name, factor)
