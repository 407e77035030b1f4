"""One channel of a file, or of an archive, is chosen by its name."""

from dataclasses import replace
from pathlib import Path

import pytest

from assess.errors import RecordError
from assess.motion.formats import read_records, rename_duplicates, select
from assess.motion.record import Record
from tests.motion.writers import EAST, NORTH, THREE, Signal, csmip_v1, csmip_v2, wave, zipped

RECORDS = Path(__file__).parents[2] / "samples" / "records"
SWEEP = read_records(RECORDS / "made-up-sweep.csv")


def test_select(tmp_path: Path) -> None:
    assert [record.channel for record in SWEEP] == ["north", "east", "up"]
    assert select(SWEEP, "East") is select(SWEEP, "2") is select(SWEEP, " east ") is SWEEP[1]
    assert select(SWEEP[:1]) is select(SWEEP[:1], "") is select(SWEEP[:1], "1") is SWEEP[0]
    records = read_records(RECORDS / "1103.HN2.NP.RE_a.smc")
    assert select(records, "1") is select(records, "171") is records[0], "the number of an only channel"
    for channel in ("west", "0", "4", "-1"):
        message = rf"made-up-sweep\.csv has no channel '{channel}'\. It holds: north, east, up"
        with pytest.raises(RecordError, match=message):
            select(SWEEP, channel)
    message = (
        r"made-up-sweep\.csv holds 3 channels: north, east, up\. Name one of them, such as made-up-sweep\.csv#north"
    )
    with pytest.raises(RecordError, match=message):
        select(SWEEP)


def test_a_number_is_a_name_where_channels_have_numbers(tmp_path: Path) -> None:
    path = tmp_path / "two.csv"
    path.write_bytes(b"time [s],2 [g],1 [g]\n" + b"".join(b"%.2f,%d,%d\n" % (t / 100, t, -t) for t in range(20)))
    records = read_records(path)
    assert select(records, "1").channel == "1"
    # Not the third channel of a recorder, but that which the drawings of the building call 3: there is none.
    made = read_set(tmp_path, csmip_v2(*THREE))
    with pytest.raises(RecordError, match=r"made has no channel '3'\. It holds: 11, 12, 13"):
        select(made, "3")


def read_set(folder: Path, data: bytes) -> tuple[Record, ...]:
    path = folder / "made"
    path.write_bytes(data)
    return read_records(path)


def test_select_from_an_archive(tmp_path: Path) -> None:
    inner = zipped({"CHAN01.V2": csmip_v2(EAST), "CHAN02.V2": csmip_v2(NORTH)})
    records = read_set(
        tmp_path, zipped({"Free Field.zip": inner, "CHAN01.V2": csmip_v2(EAST), "RAW.V1": csmip_v1(EAST)})
    )
    assert [record.file for record in records] == [
        "made/Free Field.zip/CHAN01.V2", "made/Free Field.zip/CHAN02.V2", "made/CHAN01.V2", "made/RAW.V1"
    ]  # fmt: skip
    assert select(records, "12") is records[1]
    assert select(records, "chan02.v2") is select(records, "CHAN02.V2/12") is records[1]
    assert select(records, "Free field.zip/CHAN01.V2/11") is select(records, "Free Field.zip/CHAN01.V2") is records[0]
    assert select(records, "RAW.V1/11") is records[3]
    message = r"made has 3 channels named '11'\. Name one of them: Free Field\.zip/CHAN01\.V2/11, "
    with pytest.raises(RecordError, match=message):
        select(records, "11")
    records = read_set(tmp_path, zipped({"A.V2": csmip_v2(EAST), "copy/A.V2": csmip_v2(EAST)}))
    assert select(records, "A.V2/11") is select(records, "A.V2") is records[0], "beside a folder of copies"
    assert select(records, "copy/A.V2") is records[1]


def test_every_name_that_is_listed_means_one_channel_and_long_lists_are_cut(tmp_path: Path) -> None:
    inner = zipped({"CHAN01.V2": csmip_v2(EAST)})
    records = read_set(tmp_path, zipped({"CHAN01.V2": csmip_v2(*THREE), "a.zip": inner, "b.zip": inner}))
    with pytest.raises(RecordError, match=r"made holds 5 channels: ") as caught:
        select(records)
    names = str(caught.value).partition("channels: ")[2].partition(". Name")[0].split(", ")
    assert [select(records, name).file for name in names] == [record.file for record in records]
    many = csmip_v2(*(Signal(wave(), 90.0, number) for number in range(1, 21)))
    with pytest.raises(
        RecordError, match=r"holds 20 channels: 11, .*, 22 and 8 more\. Name one of them, such as made#11$"
    ):
        select(read_set(tmp_path, many))


def test_channels_of_one_name_are_told_apart() -> None:
    twice = rename_duplicates([SWEEP[0], replace(SWEEP[1], channel="North"), SWEEP[2]])
    assert [record.channel for record in twice] == ["north", "North (2)", "up"]
    assert select(twice, "north (2)") is twice[1]


def test_a_number_is_no_position_in_an_archive() -> None:
    """A damaged member would be left out, and the number mean another channel."""
    inside = [replace(record, file="set.zip/a.csv") for record in SWEEP]
    with pytest.raises(RecordError, match=r"set\.zip has no channel '2'\. It holds: north, east, up"):
        select(inside, "2")
    assert select(inside, "east").channel == "east"
