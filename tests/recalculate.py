"""Recalculates a workbook in LibreOffice, where it is installed.

LibreOffice keeps the results that a file stores unless its profile says otherwise, so that a comparison would compare
a file with itself; the profile written here says: always recalculate.
"""

import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

_SOFFICE = shutil.which("soffice") or shutil.which("libreoffice")

needs_libreoffice = pytest.mark.skipif(_SOFFICE is None, reason="LibreOffice is not installed")

_PROFILE = """<?xml version="1.0" encoding="UTF-8"?>
<oor:items xmlns:oor="http://openoffice.org/2001/registry">
<item oor:path="/org.openoffice.Office.Calc/Formula/Load"><prop oor:name="OOXMLRecalcMode" oor:op="fuse">
<value>0</value></prop></item>
</oor:items>
"""


def libreoffice(path: Path, out: Path) -> Path:
    """Open `path` in LibreOffice with every formula recalculated and save it as `out`."""
    with tempfile.TemporaryDirectory() as box:
        user = Path(box) / "profile" / "user"
        user.mkdir(parents=True)
        (user / "registrymodifications.xcu").write_text(_PROFILE, encoding="utf-8")
        command = [
            str(_SOFFICE), f"-env:UserInstallation=file://{user.parent}", "--headless",
            "--convert-to", "xlsx", "--outdir", str(Path(box) / "out"), str(path),
        ]  # fmt: skip
        subprocess.run(command, check=True, capture_output=True, timeout=180)
        shutil.copy(Path(box) / "out" / f"{path.stem}.xlsx", out)
    return out
