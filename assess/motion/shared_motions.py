"""Motions that several floors share, of one building or of many: made once in a process, and scaled.

What a generator finds for a target holds for every target in proportion to it: a spectrum twice as high has the same
motions twice as large. So floors whose targets have one shape, and whose motions have the same samples, phases and
signs, take the same motions, each by a factor of its own. Whether they are shared or made anew, and in which order,
does not change a number: the target of one shape is always made at one height.

The latest are kept, in so many bytes. Several threads may ask at once; one of them makes what the others wait for.
"""

import hashlib
import threading
from dataclasses import dataclass, field, replace

import numpy as np

from assess.arrays import Single
from assess.motion.generate import Generator, build_generator
from assess.motion.kept import Kept, waiting
from assess.motion.noise import Phases
from assess.motion.rows import GROUP
from assess.motion.target import Target
from assess.motion.target_fit import Spectra
from assess.progress import SILENT, Progress

MOST_GROUPS = 25
"""Groups of motions that are kept of one target; whoever wants more has them made anew."""


@dataclass(slots=True, eq=False)
class _Entry:
    """A generator, and the groups of motions that it made after its first, by their number."""

    generator: Generator
    groups: dict[int, Single] = field(default_factory=dict)
    lock: threading.Lock = field(default_factory=threading.Lock)

    @property
    def nbytes(self) -> int:
        """Bytes."""
        made = self.generator.made.nbytes + self.generator.spectra.ordinates.nbytes
        return made + self.generator.recipe.gains.nbytes + sum(one.nbytes for one in [*self.groups.values()])


KEPT: Kept[_Entry] = Kept(160_000_000)
"""Motions for further floors: 200 motions of 30 s take 5 million bytes."""


@dataclass(frozen=True, slots=True, eq=False)
class SharedMotions:
    """The motions of one floor along one axis: those of its shape, multiplied by a factor [-].

    `generator` is that of the shape, in the threads and under the progress of the caller.
    """

    generator: Generator
    factor: float
    _key: bytes
    _entry: _Entry

    @property
    def spectra(self) -> Spectra:
        """The spectra of the first realisations [m/s2], and their target."""
        found, factor = self.generator.spectra, self.factor
        target = None if found.target is None else factor * found.target
        return replace(found, ordinates=found.ordinates * np.float32(factor), target=target)

    def realise(self, first: int, count: int) -> Single:
        """Return realisations `first` to `first + count - 1`: accelerations [m/s2], (count, n), in single precision.

        They may be changed. Errors as of `Generator.realise`.
        """
        start, end = first // GROUP, -(-(first + count) // GROUP)
        known, own = self._entry.groups, self.generator.made
        with waiting(self._entry.lock, self.generator.progress):
            made = len(own) // GROUP
            lacking = [at for at in range(start, end) if at >= made and at not in known]
            if lacking or start == end:
                motions = self.generator.realise(start * GROUP, (end - start) * GROUP)
                for at in (one for one in lacking if one < MOST_GROUPS):
                    known[at] = motions[(at - start) * GROUP :][:GROUP].copy()
            else:
                groups = [own[at * GROUP :][:GROUP] if at < made else known[at] for at in range(start, end)]
                motions = np.concatenate(groups)
        KEPT.keep(self._key, self._entry)
        motions *= np.float32(self.factor)
        return motions[first - start * GROUP :][:count]


def share_motions(
    target: Target, phases: Phases, *, factor: float, threads: int = 1, progress: Progress = SILENT
) -> SharedMotions:
    """Return the motions of a floor whose target is `factor` [-] times `target`, which floors share.

    `threads`, `progress` and errors are those of `assess.motion.generate.build_generator`.
    """

    def make() -> _Entry:
        found = build_generator(
            target, phases.grid, seed=phases.seed, axis=phases.axis, threads=threads, progress=progress,
            signs=phases.signs,
        )  # fmt: skip
        found.made.flags.writeable = False
        return _Entry(replace(found, threads=1, progress=SILENT))

    envelopes, digest = target.envelopes, hashlib.sha256(repr(phases).encode())
    numbers = target.pfa, target.pfv, envelopes.half_time
    arrays = target.periods, target.pseudo, envelopes.centres, envelopes.values, target.acceleration
    for one in (numbers, *arrays):
        values = np.ascontiguousarray(one, np.float64)
        digest.update(repr(values.shape).encode())
        digest.update(values.tobytes())
    key = digest.digest()
    entry = KEPT.find_or_make(key, make, progress)
    return SharedMotions(replace(entry.generator, threads=threads, progress=progress), factor, key, entry)
