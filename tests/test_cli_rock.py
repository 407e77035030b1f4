"""`assess rock`: the document, the text and the figure of one block under one record, and what it says of bad input."""

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from assess.cli import app
from tests.motion.writers import THREE, csmip_v2, zipped

ROOT = Path(__file__).parents[1]
SAMPLES = ROOT / "samples" / "records"
MARKET = ROOT / "inventories" / "records" / "575-market"
FLOOR, ROOF, SWEEP = SAMPLES / "0165a_u.smc", MARKET / "891018_1.cra-1.0210a.smc", SAMPLES / "made-up-sweep.csv"
KEYS = {
    "overturned", "max_rotation_ratio", "impacts", "overturn_time_s", "pfa_g", "critical_angle_rad",
    "frequency_parameter_rad_s", "restitution",
}  # fmt: skip
USUAL = {"breadth": 40, "height": 180, "record": FLOOR}


def rock(*flags: object, **options: object):
    given = {**USUAL, **options}
    arguments = [str(part) for name, value in given.items() for part in (f"--{name}", value)]
    return CliRunner().invoke(app, ["rock", *arguments, *map(str, flags)])


def document(**options):
    done = rock("--json", **options)
    assert (done.exit_code, done.stderr) == (0, "")
    return json.loads(done.stdout)


def error(done):
    """The message of a run that failed as it should: status 2, nothing printed, no traceback."""
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.exception is None or isinstance(done.exception, SystemExit)
    assert "Traceback" not in done.stderr
    return " ".join(re.sub(r"[│╭╮╰╯─\n]", " ", done.stderr).split())


def test_the_document_has_the_keys_of_the_contract():
    falls, stands = document(pfa=0.5), document(pfa=0.3)
    assert set(falls) == set(stands) == KEYS
    assert (falls["overturned"], stands["overturned"]) == (True, False)
    assert 0 < falls["overturn_time_s"] < 31
    assert stands["overturn_time_s"] is None
    assert falls["max_rotation_ratio"] == pytest.approx(1.5707963267948966 / falls["critical_angle_rad"])
    assert 0 < stands["max_rotation_ratio"] < 1
    assert stands["critical_angle_rad"] == pytest.approx(0.21866894587)
    assert stands["frequency_parameter_rad_s"] == pytest.approx(2.82446526)
    assert stands["restitution"] == pytest.approx(0.92941176)
    assert isinstance(stands["impacts"], int)


def test_the_motion_is_scaled_to_the_peak_that_is_asked_for():
    own = json.loads(CliRunner().invoke(app, ["record", str(FLOOR), "--json"]).stdout)["channels"][0]["pfa_g"]
    assert document()["pfa_g"] == own
    assert document(pfa=0.31)["pfa_g"] == 0.31
    assert document(pfa=own) == document()
    ratios = [document(pfa=pfa)["max_rotation_ratio"] for pfa in (0.1, 0.25, 0.3, 0.5)]
    assert ratios == sorted(ratios)
    assert ratios[0] == 0


def test_restitution_and_baseline_change_the_outcome():
    usual = document(pfa=0.3)
    other = document(pfa=0.3, restitution=0.9)
    assert other["restitution"] == 0.9
    assert other["max_rotation_ratio"] != usual["max_rotation_ratio"]
    assert document(pfa=0.3, baseline="standard") == usual
    plain = document(pfa=0.3, baseline="none")
    assert plain["max_rotation_ratio"] != usual["max_rotation_ratio"]
    corrected = SAMPLES / "np01002p_4225a_a.smc"
    assert document(record=corrected, baseline="none") == document(record=corrected)


def test_the_text_tells_a_person():
    done = rock(pfa=0.5)
    assert (done.exit_code, done.stderr) == (0, "")
    assert (
        "Block    40 x 180 cm: B/H 0.2222, alpha 12.53 deg, p 2.824 rad/s, restitution 0.9294 (Housner's)"
        in done.stdout
    )
    assert "Record   0165a_u.smc (channel 90, floor 12, 90 deg, USGS SMC)" in done.stdout
    assert "Uncorrected: mean removed, then a Butterworth high-pass at 0.1 Hz" in done.stdout
    assert "Motion   PFA 0.2714 g, scaled by 1.842 to 0.5000 g, PFV 41.8 cm/s" in done.stdout
    assert "Rocks    above g B/H = 0.2222 g: exceeded" in done.stdout
    assert re.search(r"^Outcome  overturns at \d+\.\d\d s, after \d+ impacts$", done.stdout, re.MULTILINE)
    assert "Limits   one rigid block in plane motion: no sliding, no vertical motion" in done.stdout
    assert done.stdout.isascii()


def test_the_text_of_blocks_that_stand():
    text = rock(pfa=0.3).stdout
    assert re.search(r"Outcome  does not overturn: rotates to 0\.\d+ of the critical angle, \d+ impacts\n", text)
    text = rock(pfa=0.1).stdout
    assert "Outcome  does not start to rock: the peak 0.1000 g does not exceed its threshold 0.2222 g" in text
    assert "0.2222 g: not exceeded" in text
    text = rock(restitution=0.9, baseline="none").stdout
    assert "restitution 0.9000 (given)" in text
    assert "Uncorrected: mean removed, not filtered." in text
    assert "cm/s, not scaled" in text
    assert "note: unevenly sampled" in rock(record=ROOF).stdout


def test_a_channel_of_a_file_and_of_an_archive(tmp_path):
    assert document(record=f"{SWEEP}#north")["pfa_g"] == pytest.approx(0.3)
    assert (
        "Record   made-up-sweep.csv#east (channel east, 3rd floor, 90 deg, plain CSV)"
        in rock(record=f"{SWEEP}#east").stdout
    )
    (tmp_path / "set.zip").write_bytes(zipped({"CHAN.V2": csmip_v2(*THREE)}))
    assert "Record   set.zip#11 (channel 11, " in rock(record=f"{tmp_path / 'set.zip'}#11").stdout


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"breadth": 0}, "--breadth is 0 cm, expected 5 to 600 cm"),
        ({"breadth": -40}, "--breadth is -40 cm, expected 5 to 600 cm"),
        ({"breadth": "nan"}, "--breadth is nan cm, expected 5 to 600 cm"),
        ({"height": 1.8}, "--height is 1.8 cm, expected 5 to 600 cm"),
        ({"height": 1800}, "--height is 1800 cm, expected 5 to 600 cm"),
        ({"height": "inf"}, "--height is inf cm, expected 5 to 600 cm"),
        ({"breadth": 141, "height": 100}, "--breadth and --height: a block with B/H of 1.41 does not rock"),
        ({"pfa": 0}, "--pfa is 0 g, expected above 0 and at most 50 g"),
        ({"pfa": -0.5}, "--pfa is -0.5 g, expected above 0 and at most 50 g"),
        ({"pfa": 51}, "--pfa is 51 g, expected above 0 and at most 50 g"),
        ({"pfa": "nan"}, "--pfa is nan g, expected above 0 and at most 50 g"),
        ({"restitution": 1.01}, "--restitution is 1.01, expected 0 to 1"),
        ({"restitution": -0.1}, "--restitution is -0.1, expected 0 to 1"),
        ({"restitution": "nan"}, "--restitution is nan, expected 0 to 1"),
        ({"baseline": "strict"}, "--baseline is 'strict', expected one of: standard, none"),
        ({"breadth": "40cm"}, "Invalid value for '--breadth'"),
        ({"record": f"{SWEEP}#up"}, "made-up-sweep.csv#up is a vertical channel, which topples no furniture. Name"),
        ({"record": SAMPLES / "1103.HNZ.NP.BE_a.smc"}, "1103.HNZ.NP.BE_a.smc is a vertical channel, which topples no"),
        ({"record": SWEEP}, "made-up-sweep.csv holds 3 channels: north, east, up. Write which, as made-up-sweep.csv#n"),
        ({"record": f"{SWEEP}#west"}, "made-up-sweep.csv has no channel 'west'. It holds: north, east, up"),
        ({"record": "none.smc"}, "none.smc: there is no such file"),
        ({"record": SAMPLES / "README.md"}, "README.md: the content is of no known format"),
        ({"record": SAMPLES / "1103.HN2.NP.RE_v.smc"}, "1103.HN2.NP.RE_v.smc: it holds velocity"),
        ({"record": SAMPLES}, "records: this is a folder"),
        ({"record": "n" * 300}, "the file cannot be read"),
    ],
)  # fmt: skip
def test_bad_input_is_named(tmp_path, options, message):
    plot = tmp_path / "x.png"
    assert message in error(rock("--json", **options, plot=plot))
    assert not plot.exists()


@pytest.mark.parametrize("left_out", USUAL)
def test_what_is_missing_is_named(left_out):
    arguments = [str(part) for name, value in USUAL.items() if name != left_out for part in (f"--{name}", value)]
    assert f"Missing option '--{left_out}'" in error(CliRunner().invoke(app, ["rock", *arguments]))


@pytest.mark.parametrize("pfa", [0.1, 0.3, 0.5])
@pytest.mark.parametrize(("kind", "magic"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_the_figure_is_the_same_twice(tmp_path, kind, magic, pfa):
    first, second = tmp_path / f"a.{kind}", tmp_path / f"b.{kind}"
    for path in (first, second):
        done = rock("--json", pfa=pfa, plot=path)
        assert (done.exit_code, done.stderr) == (0, f"wrote {path}\n")
        assert set(json.loads(done.stdout)) == KEYS
    assert first.read_bytes().startswith(magic)
    assert first.read_bytes() == second.read_bytes()
    assert sorted(tmp_path.iterdir()) == [first, second]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("x.gif", "the figure x.gif is of no known kind: end its name in .png, .svg or .pdf"),
        ("none/x.png", "cannot be written there: name a file in a folder that exists"),
    ],
)
def test_figures_that_cannot_be_written(tmp_path, name, message):
    assert message in error(rock(plot=tmp_path / name))


def test_a_figure_that_cannot_be_put_in_its_place(tmp_path, monkeypatch):
    def forbid(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "replace", forbid)
    done = rock("--json", plot=tmp_path / "x.png")
    assert done.exit_code == 1
    assert "x.png could not be written: Permission denied. Name another file." in done.stderr
    assert set(json.loads(done.stdout)) == KEYS
    assert not list(tmp_path.iterdir())


def test_help_names_the_units():
    text = CliRunner().invoke(app, ["rock", "--help"]).output
    for words in ("--breadth", "[cm]", "--pfa", "[g]", "--restitution", "--baseline", "--json", "--plot"):
        assert words in text


def test_the_example_of_the_readme_is_what_is_printed(monkeypatch):
    monkeypatch.chdir(ROOT)
    found = re.search(r"^assess (rock .*)\n\n((?:.+\n)+?)```", (ROOT / "README.md").read_text("utf-8"), re.MULTILINE)
    assert found
    assert CliRunner().invoke(app, found[1].split()).stdout == found[2]
