"""Every format, found and not listed, keeps the contract; files and channels are chosen as they should be."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

from assess.errors import RecordError
from assess.motion.formats import HEAD, Format, all_formats, read_records
from assess.motion.record import Record, peak, treat
from tests.motion.damage import Damaged, damaged
from tests.motion.writers import EAST, SAMPLES, at2, csmip_v2, mseed, zipped

RECORDS = Path(__file__).parents[2] / "samples" / "records"
COMMITTED = sorted(path for path in RECORDS.iterdir() if path.suffix != ".md")
SHORT_CSV = b"time [s],2 [g],1 [g]\n" + b"".join(
    b"%.2f,%.3f,%.1f\n" % (row / 100, row / 50, row % 3) for row in range(20)
)
ALL_DATA = [*(path.read_bytes() for path in COMMITTED), SHORT_CSV, *(SAMPLES[name]().data for name in SAMPLES)]
MOST_DAMAGED = 50 if settings().derandomize else 150
"""Damaged files of each format: the same ones in the gate, others and more by `make test-long`."""


# --- the contract of every format ---


def test_each_sample_is_of_one_format() -> None:
    keys = [candidate.key for candidate in all_formats()]
    assert keys == sorted(set(keys))
    assert {"csv", "smc", *(SAMPLES[name]().key for name in SAMPLES)} == set(keys)
    for path in COMMITTED:
        head = path.read_bytes()[:HEAD]
        assert sum(candidate.recognises(head) for candidate in all_formats()) == 1, path.name
    for sample in (SAMPLES[name]() for name in SAMPLES):
        assert [one.key for one in all_formats() if one.recognises(sample.data[:HEAD])] == [sample.key]


@pytest.mark.parametrize("name", SAMPLES)
def test_what_is_written_is_read_back(name: str) -> None:
    sample = SAMPLES[name]()
    candidate = next(candidate for candidate in all_formats() if candidate.key == sample.key)
    records = candidate.read(sample.data, "made")
    assert len(records) == len(sample.signals)
    for record, signal in zip(records, sample.signals, strict=True):
        assert (record.file, record.format, record.corrected) == ("made", candidate.title, sample.corrected)
        assert record.acceleration == pytest.approx(signal.acceleration, abs=sample.within)
        assert record.time_step == pytest.approx(signal.step, rel=1e-9)
        assert record.vertical == (signal.azimuth is None)
        if signal.azimuth is not None:
            assert record.azimuth_deg is not None
            assert record.azimuth_deg % 360 == signal.azimuth % 360
        assert record.station
        assert record.header_pfa is None or record.header_pfa == pytest.approx(record.file_pfa, rel=1e-3, abs=0.005)


def read_or(candidate: Format, data: bytes, reason: str) -> tuple[Record, ...]:
    """Read a sample, or see that it is refused for `reason`."""
    try:
        return candidate.read(data, "sample")
    except RecordError as error:
        if not re.search(reason, f"{error}"):
            raise
        return ()


@pytest.mark.parametrize("candidate", all_formats(), ids=lambda candidate: candidate.key)
def test_each_format_has_a_sample_it_reads(candidate: Format) -> None:
    own = [data for data in ALL_DATA if candidate.recognises(data[:HEAD])]
    assert own
    for data in own:
        for record in read_or(candidate, data, r"velocities|raw (counts|data)"):
            values = record.acceleration
            assert (record.file, record.format) == ("sample", candidate.title)
            assert np.isfinite(treat(record).pfv)
            assert record.file_pfa in {peak(values), peak(values - values.mean())}


@pytest.mark.parametrize("candidate", all_formats(), ids=lambda candidate: candidate.key)
@settings(max_examples=MOST_DAMAGED, deadline=None, suppress_health_check=list(HealthCheck))
@given(draw=st.data())
def test_damage_is_a_record_error_at_worst(candidate: Format, draw: st.DataObject) -> None:
    own = [data for data in ALL_DATA if candidate.recognises(data[:HEAD])]
    data = draw.draw(
        st.one_of(damaged(own), damaged(own), damaged(ALL_DATA), st.binary(max_size=300).map(Damaged))
    ).data
    for odd in (data, b"\x0b"):
        candidate.recognises(odd[:HEAD])
    with pytest.raises(RecordError):
        candidate.read(b"\x0b", "damaged")
    try:
        records = candidate.read(data, "damaged")
    except RecordError:
        return
    for record in records:
        assert np.isfinite(treat(record).acceleration).all()


@settings(max_examples=MOST_DAMAGED, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    damage=st.one_of(
        damaged([zipped({"a.V2": csmip_v2(EAST), "in.zip": zipped({"b.AT2": at2()})}), at2(), mseed(EAST)]),
        st.binary(max_size=300).map(Damaged),
    )
)
def test_a_damaged_file_is_a_record_error_at_worst(tmp_path: Path, damage: Damaged) -> None:
    path = tmp_path / "any"
    path.write_bytes(damage.data)
    try:
        records = read_records(path)
    except RecordError as error:
        said = f"{error}"
    else:
        said = records[0].file
        assert all(np.isfinite(record.acceleration).all() for record in records)
    assert said.startswith("any")


# --- files ---


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", r"^x\.smc: the file is empty\. Get it again"),
        (
            b"hello\n",
            r"the file format is not supported \(supported: COSMOS, .*, USGS SMC; also in zip archives\)\. "
            r"Other .* plain CSV",
        ),
        (b"t,a\n0,1\n", r"time \[s\], north \[cm/s2\], east \[cm/s2\]"),
        (b"Timing,north [g]\n", r"the file format is not supported"),
        (b"PK\x03\x04....", r"the zip archive is damaged: its directory cannot be read\. Get it again"),
        ("time [s],a [g]".encode("utf-16"), r"It is saved as UTF-16: save it as CSV UTF-8"),
        (b"%PDF-1.7", r"It is a PDF"),
        (b"\x1f\x8b\x08\0", r"It is a gzip archive: unpack it"),
        (b"7z\xbc\xaf\x27\x1c", r"It is a 7z archive: unpack it"),
        (b"Rar!\x1a\x07", r"It is a RAR archive: unpack it"),
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

    (tmp_path / "secret.smc").write_bytes(b"")
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
