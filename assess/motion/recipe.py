"""What turns the noise of a realisation into its motion: the same steps with the same numbers for all of them."""

from dataclasses import dataclass

import numpy as np

from assess.motion.bending import bend_rows, build_taper, lift_rows, shape_rows
from assess.motion.noise import Transforms, find_rates
from assess.motion.record import FloatArray
from assess.motion.sweep import Single
from assess.motion.target import Grid, Target
from assess.motion.wavelets import Correction
from assess.progress import Progress


@dataclass(frozen=True, slots=True)
class Bending:
    """Accelerations bent by `by_pfa` [-] about a PFA [m/s2]."""

    pfa: float
    by_pfa: float

    def apply(self, motions: Single) -> None:
        """Bend the peaks of motions (k, n), in place."""
        bend_rows(motions, self.pfa, self.by_pfa)


@dataclass(frozen=True, slots=True, eq=False)
class Recipe:
    """The steps from noise to motions.

    Parameters
    ----------
    grid : Grid
        The samples.
    gains : (f,) array
        The filter.
    pfv, by_pfv : float
        Velocities are bent by `by_pfv` [-] about `pfv` [m/s].
    steps : tuple of Bending or Correction
        What is done to the filtered motions, in this order.
    lift, scale : float
        Factor on PFA, and on the whole motion [-]; the second is other than 1 only where a generic spectrum and its PFA
        disagree.
    """

    grid: Grid
    gains: Single
    pfv: float
    by_pfv: float = 0.0
    steps: tuple[Bending | Correction, ...] = ()
    lift: float = 1.0
    scale: float = 1.0

    @classmethod
    def of(cls, target: Target, grid: Grid) -> "Recipe":
        """Return a recipe for a target, with no filter yet; no velocity is bent where PFV is unknown."""
        return cls(grid, np.ones(find_rates(grid).frequencies.size, np.float32), target.pfv if target.pfv > 0 else 1.0)

    def make(self, noise: Transforms, motions: Single, progress: Progress) -> None:
        """Fill `motions` (k, n) [m/s2]."""
        self.shape(noise, motions)
        for step in self.steps:
            progress.check()
            step.apply(motions)
        self.finish(motions)

    def shape(self, noise: Transforms, motions: Single) -> FloatArray:
        """Fill `motions` (k, n) with filtered noise whose velocity is bent and tapered.

        Returns
        -------
        (k, 2) array
            PFV before it is bent [m/s], and PFA after [m/s2].
        """
        from scipy.fft import irfft

        acceleration = irfft(noise * self.gains, find_rates(self.grid).length, axis=1, overwrite_x=True)
        taper, slope = build_taper(self.grid)
        peaks = np.empty((len(noise), 2))
        shape_rows(acceleration, taper, slope, self.grid.time_step, self.pfv, self.by_pfv, motions, peaks)
        return peaks

    def finish(self, motions: Single) -> None:
        """Lift and scale motions (k, n) in place, and leave no final velocity."""
        lift_rows(motions, self.lift, self.scale)
