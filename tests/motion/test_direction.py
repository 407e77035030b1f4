"""Which way a channel points, whatever its format calls it."""

from pathlib import Path

import pytest

from assess.errors import RecordError
from assess.motion.formats import read_records
from assess.motion.formats._format import read_direction
from assess.motion.suite import read_suite

VERTICAL = (
    "UP|Down|A-UP|ABC-DWN|PET--V|HNZ|HNZ--|BHZ00|N5471HNZ|EHZ|HLZ|UD2|U-D|V1|VRT|vertical Z|az|acc_z|dwn|verticale|"
    "Düşey|上下"
)
LEVEL = {
    "N21W": 339, "S 45 deg E": 135, "S00E": 180, "090": 90, "360": 360, "I-ELC180": 180, "B-ICC090": 90,
    "H-E06230": 230, "HNE": 90, "N5471HNN": 0, "EW1": 90, "N-S": 0, "north": 0, "Nord": 0,
    "ovest": 270, "roof 90 deg": 90,
    "HN1": None, "roof, east": None, "acc_x": None, "Y": None, "Long.": None, "transv": None, "RADIAL": None,
}  # fmt: skip
NOT_KNOWN = ("", "1", "ch1", "acceleration", "400", "HN3", "zone", "Up-north")

TITLE = "PEER STRONG MOTION DATABASE RECORD\nMADE UP, 1/1/2000, {station}, {component}\n"
HEAD = f"{TITLE}ACCELERATION TIME SERIES IN UNITS OF G\n"


def _write_at2(path: Path, component: str, station: str = "TOWN HALL", step: str = ".01000 SEC") -> Path:
    values = " ".join(f"{(-1) ** at * at / 4000:.5f}" for at in range(400))
    path.write_text(HEAD.format(station=station, component=component) + f"NPTS= 400, DT= {step}\n{values}\n")
    return path


def test_words_for_directions() -> None:
    for text in VERTICAL.split("|"):
        assert read_direction(text) == read_direction(text.lower(), bare_degrees=False) == (None, True), text
    assert {text: read_direction(text) for text in LEVEL} == {text: (one, False) for text, one in LEVEL.items()}
    assert {read_direction(text, bare_degrees=False) for text in NOT_KNOWN} == {(None, None)}


def test_the_odd_one_out_of_three_components_is_vertical(tmp_path: Path) -> None:
    for name, component in (("a", "090"), ("b", "180"), ("c", "XYZ"), ("d", "ABC")):
        _write_at2(tmp_path / f"{name}.at2", component, station="ELSEWHERE" if name == "d" else "TOWN HALL")
    suite = read_suite(tmp_path)
    assert [name for name, _ in suite.motions] == ["a.at2", "b.at2"]
    assert suite.notes[0] == "vertical channels are left out: c.at2#XYZ"
    assert suite.notes[1].startswith("channels are left out because their direction is not known: d.at2#ABC (")


def test_beside_a_vertical_one_the_other_two_are_horizontal(tmp_path: Path) -> None:
    rows = "\n".join(f"{at / 100},{at % 7},{at % 5},{at % 3}" for at in range(100))
    (tmp_path / "three.csv").write_text(f"# station: Hall\ntime [s],one [cm/s2],two [cm/s2],up [cm/s2]\n{rows}\n")
    records = read_records(tmp_path / "three.csv")
    assert [record.vertical for record in records] == [False, False, True]
    assert "beside the vertical component it is a horizontal one" in records[0].notes[-1]
    assert [len(record.notes) for record in records] == [1, 1, 0]


def test_the_step_of_a_peer_file_is_read_to_its_end(tmp_path: Path) -> None:
    for step in ("0.1000E-01", "0.1000D-01 SEC", "1.0E-2,", ".01", ".01000SEC"):
        (record,) = read_records(_write_at2(tmp_path / "a.at2", "090", step=step))
        assert record.time_step == 0.01, step
    for step in ("0.01.5", "0.01X", "-.01"):
        with pytest.raises(RecordError, match="line 4 does not give the number of points and their time step"):
            read_records(_write_at2(tmp_path / "a.at2", "090", step=step))
