"""`assess record`: what it prints, as text and as JSON, what it draws, and what it says of files it cannot read."""

import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from assess.motion.formats import read_channels
from tests.cli.calling import run
from tests.motion.writers import THREE, csmip_v2, zipped

RECORDS = Path(__file__).parents[2] / "samples" / "records"
ROOF, SWEEP, VELOCITY = (
    RECORDS / name for name in ("1103.HN2.NP.RE_a.smc", "made-up-sweep.csv", "1103.HN2.NP.RE_v.smc")
)


def record(*arguments: object):
    return run("record", *arguments)


def test_the_document_is_the_one_of_the_contract():
    done = record(ROOF, "--json")
    assert (done.exit_code, done.stderr) == (0, "")
    document = json.loads(done.stdout)
    (channel,) = document["channels"]
    assert (document["file"], document["format"]) == (ROOF.name, "USGS SMC")
    assert (channel["channel"], channel["location"], channel["azimuth_deg"]) == ("171", "Roof, east core", 171.0)
    assert (channel["time_step_s"], channel["samples"], channel["corrected"]) == (0.005, 8200, True)
    assert channel["pfa_file_g"] == pytest.approx(0.51404 / 9.80665)
    assert channel["pfa_header_g"] == pytest.approx(0.514 / 9.80665)
    assert channel["pfa_g"] == channel["pfa_file_g"]
    assert channel["pfv_cm_s"] == pytest.approx(2.2956, rel=0.002)
    spectrum = channel["spectrum"]
    assert spectrum["pseudo_acceleration_g"][0] > channel["pfa_g"]
    assert len(spectrum["periods_s"]) == len(spectrum["pseudo_acceleration_g"])


def test_channels_of_files_and_of_a_set_in_a_zip_archive(tmp_path):
    one, several = json.loads(record(f"{SWEEP}#east", SWEEP, "--json").stdout)
    assert [(each["channel"], each["name"]) for each in one["channels"]] == [("east", "made-up-sweep.csv#east")]
    assert len(several["channels"]) == 3
    (tmp_path / "set.zip").write_bytes(zipped({"CHAN.V2": csmip_v2(*THREE), "README.txt": b"hello"}))
    done = record(tmp_path / "set.zip")
    assert "set.zip: CSMIP V2, 3 channels" in done.stdout
    assert "set.zip#11 (channel 11, " in done.stdout
    assert "note: left out of the archive: README.txt" in done.stdout


def test_a_file_that_cannot_be_read_is_named_and_the_others_are_told(tmp_path):
    done = record(VELOCITY, ROOF)
    assert done.exit_code == 1
    assert "error  1103.HN2.NP.RE_v.smc: the file holds velocities" in done.stderr
    assert ROOF.name in done.stdout
    done = record(VELOCITY, tmp_path / "none.v2", "--json")
    assert (done.exit_code, done.stdout) == (2, "")
    assert "none.v2: there is no such file" in done.stderr
    assert record(f"{SWEEP}#west").exit_code == 2


@pytest.mark.slow
def test_the_figure_has_three_panels_a_channel_of_the_first_ones(tmp_path):
    path = tmp_path / "figure.svg"
    done = record(SWEEP, "--plot", path)
    assert (done.exit_code, done.stderr) == (0, f"wrote {path}\n")
    assert sum(1 for one in ET.parse(path).iter() if str(one.get("id", "")).startswith("axes_")) == 9
    done = record(*[SWEEP] * 5, "--plot", tmp_path / "many.png")
    assert "3 more channels not drawn" in done.stderr


def test_a_name_with_a_hash_is_a_file_first_and_names_are_what_finds_the_channels_again(tmp_path):
    path = tmp_path / "set#1.csv"
    path.write_bytes(SWEEP.read_bytes())
    assert len(read_channels(str(path))) == 3
    both = {"a/CHAN.V2": csmip_v2(*THREE), "b/CHAN.V2": csmip_v2(*THREE)}
    (tmp_path / "set.zip").write_bytes(zipped(both))
    channels = read_channels(str(tmp_path / "set.zip"))
    assert len({one.name for one in channels}) == 6
    for one in channels:
        (again,) = read_channels(str(tmp_path / one.name))
        assert (again.record.file, again.record.channel) == (one.record.file, one.record.channel)
