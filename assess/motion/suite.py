"""A suite: a folder of the user's own floor records, which stand in for generated motions."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import groupby, islice
from pathlib import Path

import numpy as np

from assess.arrays import FloatArray
from assess.errors import RecordError
from assess.i18n import fill, join, nfill
from assess.motion.formats import read_records, settle_directions
from assess.motion.record import Motion, Record, treat
from assess.motion.target_fit import Spectra
from assess.progress import SILENT, Progress

MOST_SPECTRA = 100
"""Motions whose spectra are found."""
FEW = 30
"""Below this number of motions a note says that they are few: with 0 of 30 fallen, the interval reaches to 11 %."""
TEXTS = frozenset({".md", ".html", ".htm", ".pdf", ".rst", ".ini", ".db"})
"""Endings of files next to records that are passed over."""


@dataclass(frozen=True, eq=False)
class Suite:
    """Motions of the user's own, as treated; motion k is one earthquake, the same on every floor and axis.

    * `motions`: every horizontal channel, by file and channel, in the order of time steps and then of names.
    * `files`: hashes (SHA-256) of the files.
    * `notes`: what was left out, and why.
    """

    folder: str
    motions: tuple[tuple[str, Motion], ...]
    files: Mapping[str, str]
    notes: tuple[str, ...] = ()
    _found: list[tuple[FloatArray, FloatArray]] = field(default_factory=list, init=False, repr=False)
    """The spectra once they have been found: scaling keeps their shape."""

    def __len__(self) -> int:
        return len(self.motions)

    def realise(self, first: int, count: int, pfa: float | None = None) -> list[tuple[FloatArray, float]]:
        """Return motions `first` to `first + count - 1` in batches of one time step: (k, n) [m/s2], step [s].

        Shorter ones are followed by rest. Where a `pfa` [m/s2] is given each is scaled to it.
        """
        chosen, batches = [motion for _, motion in self.motions[first : first + count]], []
        for step, group in groupby(chosen, key=lambda motion: motion.time_step):
            alike = list(group)
            batch = np.zeros((len(alike), max(motion.acceleration.size for motion in alike)))
            for row, motion in zip(batch, alike, strict=True):
                row[: motion.acceleration.size] = motion.acceleration * (1.0 if pfa is None else pfa / motion.pfa)
            batches.append((batch, step))
        return batches

    def scaled_spectra(self, pfa: float | None = None, *, progress: Progress = SILENT) -> Spectra:
        """Return the spectra of the first 100 motions, each scaled to a `pfa` [m/s2] where one is given."""
        from assess.motion.spectrum import build_periods, response_spectrum

        if not self._found:
            periods = build_periods(0.05, 10.0, 120)
            batches = self.realise(0, MOST_SPECTRA)
            found = [response_spectrum(batch, step, periods, progress=progress).pseudo for batch, step in batches]
            self._found.append((periods, np.concatenate(found)))
        periods, ordinates = self._found[0]
        if pfa is not None:
            ordinates = ordinates * np.array([[pfa / motion.pfa] for _, motion in self.motions[:MOST_SPECTRA]])
        return Spectra(periods=periods, ordinates=ordinates.astype(np.float32))


def read_suite(folder: Path | str, *, progress: Progress = SILENT) -> Suite:
    """Read every record of a folder, but not of folders within it.

    Raises RecordError if there is no such folder, no horizontal channel in it, or a file cannot be read as a record:
    the message names it. Texts (.md, .html, .pdf, .rst), .ini and .db, and hidden files are passed over.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise RecordError.about("{folder}: there is no such folder. Name a folder of floor records", folder=folder)
    paths = [path for path in sorted(folder.iterdir()) if path.is_file() and not path.name.startswith(".")]
    paths = [path for path in paths if path.suffix.lower() not in TEXTS]
    return progress.wait_for(lambda: _read_suite(folder, paths, progress))


def _read_suite(folder: Path, paths: list[Path], progress: Progress) -> Suite:
    found: dict[Path, tuple[Record, ...]] = {}
    for path in paths:
        try:
            found[path] = read_records(path, progress=progress)
        except RecordError as error:
            raise RecordError.about("{why}. Correct it, or move it out of the folder", why=error.message) from None
    settled = iter(settle_directions([record for records in found.values() for record in records]))
    found = {path: tuple(islice(settled, len(records))) for path, records in found.items()}
    motions = []
    vertical, unknown = list[str](), list[str]()
    for path, records in found.items():
        for record in records:
            progress.check()
            name = f"{path.name}#{record.channel}"
            if record.vertical is False:
                motions.append((name if len(records) > 1 else path.name, treat(record)))
            else:
                (vertical if record.vertical else unknown).append(name)
    notes = [fill("vertical channels are left out: {channels}", channels=", ".join(vertical))] if vertical else []
    if unknown:
        notes.append(
            fill(
                "channels are left out because their direction is not known: {channels} (where they are horizontal, "
                "give them as plain CSV, with x or y as the heading)",
                channels=", ".join(unknown),
            )
        )
    if not motions:
        why = fill("{folder}: the folder holds no horizontal channel. Put floor records into it", folder=folder)
        raise RecordError(join("; ", (why, *notes)))
    if len(motions) < FEW:
        notes.append(
            nfill(
                "only {n} motion: the probabilities have wide intervals",
                "{n} motions are few: the probabilities have wide intervals",
                len(motions),
            )
        )
    return Suite(
        folder=folder.name, motions=tuple(sorted(motions, key=lambda one: (one[1].time_step, one[0]))),
        files={path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in found}, notes=tuple(notes),
    )  # fmt: skip
