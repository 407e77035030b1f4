"""The same run writes the same bytes where SOURCE_DATE_EPOCH is set, whatever the clock, place and hash seed."""

import os
import subprocess
import sys

import pytest

from assess.report_formats import DEFAULT, FILES
from tests.workbooks import write

EVERY = [name for name in FILES if name != "npz"]
EPOCH = "1700000000"


def _run(book, out, formats, **environment):
    return subprocess.Popen(
        [sys.executable, "-m", "assess", "run", book, "--out", out, "--runs", "5", "--formats", ",".join(formats)],
        env=os.environ | environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("formats", [DEFAULT, pytest.param(EVERY, marks=pytest.mark.long)])
def test_two_runs_write_the_same_bytes(tmp_path, formats):
    book = write(tmp_path / "w.xlsx", building="Town hall", language="Italiano")
    first = _run(book, tmp_path / "a", formats, SOURCE_DATE_EPOCH=EPOCH, PYTHONHASHSEED="1", TZ="Pacific/Kiritimati")
    assert first.communicate(timeout=600)[0]
    second = _run(book, tmp_path / "b", formats, SOURCE_DATE_EPOCH=EPOCH, PYTHONHASHSEED="2", TZ="America/Los_Angeles")
    assert second.communicate(timeout=600)[0]
    assert (first.returncode, second.returncode) == (0, 0)
    names = sorted(path.name for path in (tmp_path / "a").iterdir())
    assert names == sorted(FILES[name] for name in formats)
    different = [name for name in names if (tmp_path / "a" / name).read_bytes() != (tmp_path / "b" / name).read_bytes()]
    assert different == []
