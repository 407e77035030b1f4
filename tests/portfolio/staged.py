"""Small cities, and a ground motion under which things go wrong where a test wants them to, in real processes."""

import os
import shutil
import signal
import time
from dataclasses import dataclass
from pathlib import Path

from assess.i18n import fill
from assess.motion.site_ground import SiteGround
from tests.workbooks import write_sheets

KILLS, KILLS_ONCE, HOLDS, FILLS = 1.0, 2.0, 3.0, 4.0
"""Latitudes at which the process dies each time, or once; waits; or cannot write any more."""
ITEMS = (
    {"item": "A1", "floor": "1", "breadth": 30, "width": 80, "height": 200, "type": "", "anchored": "no"},
    {"item": "A2", "floor": "2", "breadth": 60, "width": 60, "height": 200, "quantity": 3},
    {"item": "A3", "floor": "2", "breadth": 45, "width": 90, "height": 90, "anchored": "yes"},
)


@dataclass(frozen=True)
class StagedGround:
    """The same shaking everywhere; what goes wrong is told by the files in `folder`."""

    folder: Path
    file: str = "staged.csv"
    sha256: str = "0" * 64

    def at(self, latitude, longitude):
        if latitude == KILLS or (latitude == KILLS_ONCE and self._is_first("killed")):
            os.kill(os.getpid(), signal.SIGKILL)
        if latitude == HOLDS:
            (self.folder / f"held-{os.getpid()}").touch()
            while (self.folder / "hold").exists():
                time.sleep(0.02)
        if latitude == FILLS and (self.folder / "full").exists():
            import resource

            resource.setrlimit(resource.RLIMIT_FSIZE, (100, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))
        words = fill("made up for a test")
        return SiteGround(
            kind="shakemap", file=self.file, sha256=self.sha256, pga=3.0, pgv=0.3, dispersion=0.2,
            dispersion_source=words, shared=0.3,
        )  # fmt: skip

    def _is_first(self, name):
        try:
            (self.folder / name).touch(exist_ok=False)
        except FileExistsError:
            return False
        return True


def write_city(folder, latitudes, **building):
    """Write a workbook for each latitude: b00.xlsx and so on, made once and copied where they are alike."""
    folder.mkdir(parents=True, exist_ok=True)
    made: dict[float, Path] = {}
    for number, latitude in enumerate(latitudes):
        path = folder / f"b{number:02}.xlsx"
        if latitude in made:
            shutil.copyfile(made[latitude], path)
        else:
            made[latitude] = write_building(path, latitude=latitude, longitude=10.0, **building)
    return folder


def write_building(path, **building):
    """Write a small workbook whose shaking is not known."""
    floors = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 3.5}]
    return write_sheets(path, {"Building": [{"height": 7, **building}], "Floors": floors, "Items": list(ITEMS)})


def read_results(out):
    """Return the bytes of all results in a folder by their names."""
    return {path.name: path.read_bytes() for path in out.iterdir() if path.is_file()}
