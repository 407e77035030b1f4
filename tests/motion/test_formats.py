"""Every format, found and not listed, keeps the contract; files and channels are chosen as they should be."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from assess.errors import RecordError
from assess.motion.formats import HEAD, Format, all_formats, read_records, select
from assess.motion.record import peak, treat

RECORDS = Path(__file__).parents[2] / "samples" / "records"
SAMPLES = sorted(path for path in RECORDS.iterdir() if path.suffix != ".md")
SHORT_CSV = b"time [s],2 [g],1 [g]\n" + b"".join(
    b"%.2f,%.3f,%.1f\n" % (row / 100, row / 50, row % 3) for row in range(20)
)


# --- the contract of every format ---


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.name)
def test_each_sample_is_of_one_format(path: Path) -> None:
    head = path.read_bytes()[:HEAD]
    assert sum(candidate.recognises(head) for candidate in all_formats()) == 1


@pytest.mark.parametrize("candidate", all_formats(), ids=lambda candidate: candidate.key)
def test_each_format_has_a_sample_it_reads(candidate: Format) -> None:
    own = [path for path in SAMPLES if candidate.recognises(path.read_bytes()[:HEAD]) and not path.stem.endswith("_v")]
    assert own
    for path in own:
        for record in candidate.read(path.read_bytes(), path.name):
            assert (record.file, record.format) == (path.name, candidate.title)
            assert np.isfinite(treat(record).pfv)
            assert record.file_pfa == peak(record.acceleration)


def test_formats_are_told_apart_by_key() -> None:
    keys = [candidate.key for candidate in all_formats()]
    assert keys == sorted(set(keys))
    assert {"csv", "smc"} <= set(keys)


TOKENS = st.sampled_from(
    [
        b"",
        b"nan",
        b"1E999",
        b"-inf",
        b"\0",
        b"9999999999",
        b"-32768",
        b"0.17E+39",
        b"1_0",
        b"\xff",
        b"\n",
        b"|",
        b"[g]",
        b";",
    ]
)


@st.composite
def damaged(draw: st.DrawFn) -> bytes:
    """Draw a sample that is cut short, or has some bytes replaced, mostly in its header."""
    data = draw(st.sampled_from([path.read_bytes() for path in SAMPLES] + [SHORT_CSV]))
    for _ in range(draw(st.integers(0, 4))):
        at = draw(st.integers(0, draw(st.sampled_from([80, 2500, len(data)]))))
        piece = draw(st.one_of(TOKENS, st.binary(max_size=12)))
        data = data[:at] + piece + data[at + draw(st.sampled_from([0, len(piece), 1, 10])) :]
    return data[: draw(st.integers(0, len(data)))] if draw(st.booleans()) else data


@pytest.mark.parametrize("candidate", all_formats(), ids=lambda candidate: candidate.key)
@settings(max_examples=200, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.one_of(damaged(), st.binary(max_size=300)))
@example(data=b"\x0b")
def test_damage_is_a_record_error_at_worst(candidate: Format, data: bytes) -> None:
    candidate.recognises(data[:HEAD])
    try:
        records = candidate.read(data, "damaged")
    except RecordError:
        return
    for record in records:
        assert np.isfinite(treat(record).acceleration).all()


@settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.binary(max_size=300))
def test_any_file_is_a_record_error_at_worst(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "any"
    path.write_bytes(data)
    with pytest.raises(RecordError, match=r"^any: "):
        read_records(path)


# --- files ---


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", r"^x\.smc: the file is empty\. Get it again"),
        (
            b"hello\n",
            r"of no known format \(known: plain CSV, USGS SMC\)\. Other .* plain CSV, whose first row names time",
        ),
        (b"t,a\n0,1\n", r"time \[s\], north \[cm/s2\], east \[cm/s2\]"),
        (b"Timing,north [g]\n", r"no known format"),
        (b"PK\x03\x04....", r"It is a zip archive or a workbook: unpack it"),
        ("time [s],a [g]".encode("utf-16"), r"It is saved as UTF-16: save it as CSV UTF-8"),
        (b"%PDF-1.7", r"It is a PDF"),
    ],
)
def test_files_of_no_format(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "x.smc"
    path.write_bytes(content)
    with pytest.raises(RecordError, match=message):
        read_records(path)


def test_files_that_cannot_be_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(RecordError, match=r"^none\.smc: there is no such file\. Check the name and the folder"):
        read_records(tmp_path / "none.smc")
    with pytest.raises(RecordError, match=r"this is a folder\. Name one of the files in it"):
        read_records(tmp_path)
    with pytest.raises(RecordError, match=r"the file cannot be read \("):
        read_records(tmp_path / "a\0b")

    def forbid(*_args: object) -> None:
        raise PermissionError

    monkeypatch.setattr(Path, "open", forbid)
    with pytest.raises(RecordError, match=r"you have no right to read it"):
        read_records(tmp_path / "secret.smc")


def test_large_files_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("assess.motion.formats.LARGEST_FILE", 1_000_000)
    path = tmp_path / "large.csv"
    path.write_bytes(bytes(1_000_001))
    with pytest.raises(RecordError, match=r"^large\.csv: the file is larger than 1 MB\. Cut it to the shaking"):
        read_records(path)


def test_the_name_of_a_file_decides_nothing(tmp_path: Path) -> None:
    (tmp_path / "roof.csv").write_bytes((RECORDS / "1103.HN2.NP.RE_a.smc").read_bytes())
    assert read_records(tmp_path / "roof.csv")[0].format == "USGS SMC"


# --- one channel of a file ---


def test_select() -> None:
    records = read_records(RECORDS / "made-up-sweep.csv")
    assert [record.channel for record in records] == ["north", "east", "up"]
    assert select(records, "East") is select(records, "2") is select(records, " east ") is records[1]
    assert select(records[:1]) is select(records[:1], "") is select(records[:1], "1") is records[0]


def test_select_takes_names_before_numbers(tmp_path: Path) -> None:
    path = tmp_path / "two.csv"
    path.write_bytes(SHORT_CSV)
    assert select(read_records(path), "1").channel == "1"


@pytest.mark.parametrize("channel", ["west", "0", "4", "-1"])
def test_select_an_unknown_channel(channel: str) -> None:
    records = read_records(RECORDS / "made-up-sweep.csv")
    with pytest.raises(
        RecordError, match=rf"made-up-sweep\.csv has no channel '{channel}'\. It holds: north, east, up"
    ):
        select(records, channel)


def test_select_needs_a_channel() -> None:
    message = r"made-up-sweep\.csv holds 3 channels: north, east, up\. Write which, as made-up-sweep\.csv#north"
    with pytest.raises(RecordError, match=message):
        select(read_records(RECORDS / "made-up-sweep.csv"))
