"""Zip archives: what is read of them, and that no archive unpacks beyond the limits."""

import tracemalloc
import zipfile
from pathlib import Path

import pytest

from assess.errors import RecordError
from assess.motion.formats import _archive, read_records
from assess.motion.record import Record
from tests.motion.writers import EAST, NORTH, THREE, at2, csmip_v1, csmip_v2, zipped

RECORDS = Path(__file__).parents[2] / "samples" / "records"
README = {"README.txt": b"Please acknowledge."}


def read_set(folder: Path, data: bytes, name: str = "set.zip") -> tuple[Record, ...]:
    path = folder / name
    path.write_bytes(data)
    return read_records(path)


def test_members_also_raw_and_corrected_ones_side_by_side(tmp_path: Path) -> None:
    records = read_set(tmp_path, zipped({**README, "a/CHAN1.V2": csmip_v2(*THREE), "b.at2": at2(), "empty.txt": b""}))
    assert [(record.file, record.channel) for record in records] == [
        ("set.zip/a/CHAN1.V2", "11"), ("set.zip/a/CHAN1.V2", "12"), ("set.zip/a/CHAN1.V2", "13"),
        ("set.zip/b.at2", "090"),
    ]  # fmt: skip
    (alone,) = read_set(tmp_path, at2(), "alone.at2")
    assert (records[3].acceleration == alone.acceleration).all()
    records = read_set(tmp_path, zipped({"C.V1": csmip_v1(EAST), "C.V2": csmip_v2(EAST)}))
    assert [record.corrected for record in records] == [False, True]


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
def test_archives_in_archives(tmp_path: Path, method: int) -> None:
    data = zipped({"r.V2": csmip_v2(NORTH)}, method)
    for depth in (1, 2):
        data = zipped({f"in{depth}.zip": data}, method)
    (record,) = read_set(tmp_path, data)
    assert record.file == "set.zip/in2.zip/in1.zip/r.V2"
    with pytest.raises(RecordError, match=r"in1\.zip: the zip archives are nested more than 3 deep: unpack them"):
        read_set(tmp_path, zipped({"in3.zip": data}, method))


def test_velocities_and_damaged_members_are_left_out(tmp_path: Path) -> None:
    members = {name: (RECORDS / f"1103.HN2.NP.RE_{name}.smc").read_bytes() for name in ("a", "v")}
    (record,) = read_set(tmp_path, zipped(members))
    assert (record.file, record.format) == ("set.zip/a", "USGS SMC")
    data = zipped({"a.V2": csmip_v2(EAST), "b.V2": csmip_v2(NORTH)}, zipfile.ZIP_STORED)
    at = data.index(b"POINTS OF ACCEL")
    (record,) = read_set(tmp_path, data[:at] + b"x" + data[at + 1 :])
    assert record.file == "set.zip/b.V2"


def test_windows_paths(tmp_path: Path) -> None:
    # Some programs for Windows write them against the standard.
    (record,) = read_set(tmp_path, zipped({"a/C.V2": csmip_v2(EAST)}).replace(b"a/C.V2", b"a\\C.V2"))
    assert record.file == "set.zip/a/C.V2"
    (record,) = read_set(tmp_path, zipped({"d/" * 20_000 + "r.at2": at2()}))
    assert len(record.file) < 300, "long names are cut"


def test_nothing_to_read(tmp_path: Path) -> None:
    message = (
        r"^set\.zip: nothing in the zip archive can be read as a record: README\.txt: unsupported file format; "
        r"v\.smc: the file holds velocities"
    )
    with pytest.raises(RecordError, match=message):
        read_set(tmp_path, zipped({**README, "v.smc": (RECORDS / "1103.HN2.NP.RE_v.smc").read_bytes()}))
    with pytest.raises(RecordError, match=r"; and 2 more$"):
        read_set(tmp_path, zipped({f"{number}.txt": b"text" for number in range(10)}))
    with pytest.raises(RecordError, match=r"the zip archive is empty\. Get it again"):
        read_set(tmp_path, zipped({}))


def test_workbooks(tmp_path: Path) -> None:
    message = r"set\.xlsx: the file is a workbook or another office file, .*: save the sheet as CSV"
    for name in ("[Content_Types].xml", "META-INF/manifest.xml"):
        with pytest.raises(RecordError, match=message):
            read_set(tmp_path, zipped({name: b"<Types/>", "xl/workbook.xml": b"<workbook/>"}), "set.xlsx")


def test_locked_and_damaged(tmp_path: Path) -> None:
    locked = bytearray(zipped({"a.V2": csmip_v2(EAST)}))
    for start, flags in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        locked[locked.index(start) + flags] |= 1
    with pytest.raises(RecordError, match=r"a\.V2 is locked with a password: unpack the archive"):
        read_set(tmp_path, bytes(locked))
    data = zipped({"a.V2": csmip_v2(EAST)})
    with pytest.raises(RecordError, match=r"the zip archive is damaged: its directory cannot be read\. Get it again"):
        read_set(tmp_path, data[:-40])
    with pytest.raises(RecordError, match=r"a\.V2: the file is damaged: its data cannot be unpacked\. Get it again"):
        read_set(tmp_path, data[:100] + b"????" + data[104:])
    message = r"a\.V2: the file is compressed by a method that is not supported \(14\): unpack the archive"
    with pytest.raises(RecordError, match=message):
        read_set(tmp_path, zipped({"a.V2": csmip_v2(EAST)}, zipfile.ZIP_LZMA))


def test_a_member_without_a_name(tmp_path: Path) -> None:
    """The directory gives it no name, its own header does; what zipfile says of that differs from Python to Python."""
    data = zipped({"x": b"hello"})
    at, end = data.index(b"PK\x01\x02"), data.index(b"PK\x05\x06")
    entry = bytearray(data[at:end].removesuffix(b"x"))
    entry[28:30] = bytes(2)
    tail = bytearray(data[end:])
    tail[12:16] = len(entry).to_bytes(4, "little")
    with pytest.raises(RecordError) as caught:
        read_set(tmp_path, data[:at] + bytes(entry) + bytes(tail))
    assert caught.value.message.endswith(
        "nothing in the zip archive can be read as a record: member without a name: the file is damaged: its header "
        "and the directory of the zip archive differ. Get it again"
    )
    assert "File name" not in caught.value.message


# --- bombs ---


def peak_memory(data: bytes, message: str) -> int:
    tracemalloc.start()
    try:
        with pytest.raises(RecordError, match=message):
            _archive.read_archive(data, "set.zip", lambda _data, _name: ())
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_members_that_unpack_to_too_much_or_lie_about_their_size() -> None:
    data = zipped({"zeros": bytes(50_000_000)})
    message = r"zeros unpacks to more than 200 times its size, which no record does\. Get the archive again"
    assert peak_memory(data, message) < 5_000_000
    inner = data
    assert peak_memory(zipped({"in.zip": inner, **README}), r"unpacks to more than 200 times") < 5_000_000
    size = (50_000_000).to_bytes(4, "little")
    assert data.count(size) == 2
    lie = data.replace(size, (1000).to_bytes(4, "little"))
    assert peak_memory(lie, r"zeros: the file is damaged") < 5_000_000


def test_limits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    data, inner = zipped({"a.V2": csmip_v2(EAST), "b.V2": csmip_v2(NORTH)}), zipped({"a.V2": csmip_v2(EAST), "b": b"b"})
    for limit, value, made, message in (
        ("LARGEST_MEMBER", 10_000, data, "holds more than 256 MB, or 0 MB in one member: unpack it, and name the file"),
        ("MOST_UNPACKED", 20_000, data, "the zip archive holds more than 0 MB"),
        ("MOST_MEMBERS", 1, data, "the zip archive has more than 1 members: unpack it"),
        (
            "MOST_MEMBERS",
            3,
            zipped({"1.zip": inner, "2.zip": inner}),
            "the zip archive has more than 3 members: unpack it",
        ),
    ):
        monkeypatch.setattr(_archive, limit, value)
        with pytest.raises(RecordError, match=message):
            read_set(tmp_path, made)
        monkeypatch.undo()


def test_what_is_left_out_is_said_once(tmp_path: Path) -> None:
    cut = csmip_v2(EAST)[:4000]
    first, *others = read_set(tmp_path, zipped({"A.V2": csmip_v2(*THREE), "B.V2": cut, **README}))
    (note,) = first.notes
    assert note.startswith("left out of the archive: B.V2: ")
    assert note.endswith("README.txt: unsupported file format")
    assert not any(record.notes for record in others)
