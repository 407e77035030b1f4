"""What the files of a workbook may hold together: each cell that asks for more is named."""

from pathlib import Path

import pytest

from assess.workbook import kept_files
from tests.motion.writers import EAST, at2, zipped
from tests.workbook.books import errors_of, read, write

FEWER = "Name fewer files, with the channels that are needed, cut to the shaking."


def floors_with(*records: str) -> list[list[str]]:
    return [["Floor", "Record X"], *[[str(number), record] for number, record in enumerate(records, start=1)]]


@pytest.fixture
def three(tmp_path: Path) -> Path:
    """Return a workbook with a record on each of three floors; two of them are in archives."""
    (tmp_path / "a.at2").write_bytes(at2())
    for name in "bc":
        (tmp_path / f"{name}.zip").write_bytes(zipped({"r.at2": at2()}, 0))
    return write(tmp_path, floors=floors_with("a.at2", "b.zip", "c.zip"))


@pytest.mark.parametrize(
    ("limit", "most", "message"),
    [
        ("MOST_RECORD_BYTES", 2 * len(at2()) + 500, "the record files of this workbook have more than 0 MB"),
        (
            "MOST_RECORD_SAMPLES",
            2 * EAST.acceleration.size,
            "the record files of this workbook have more than 800 samples",
        ),
        ("MOST_ARCHIVES", 1, "this workbook names more than 1 zip archives"),
    ],
)
def test_records(three: Path, monkeypatch: pytest.MonkeyPatch, limit: str, most: int, message: str) -> None:
    monkeypatch.setattr(kept_files, limit, most)
    assert errors_of(three) == {f"Floors!B4: {message}. {FEWER}"}


def test_a_file_counts_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_files, "MOST_RECORD_SAMPLES", EAST.acceleration.size)
    (tmp_path / "a.at2").write_bytes(at2())
    assert len(read(tmp_path, floors=floors_with("a.at2", "a.at2#1", "a.at2")).floors) == 3
