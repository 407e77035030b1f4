"""How the shaking of one earthquake differs from place to place: a normal number at every place, alike at near ones.

The correlation of the numbers of two places falls with their distance h as exp(-3 h/b). The field of an earthquake is a
sum of plane waves whose directions, lengths and phases are drawn (random Fourier features), so that its number at a
place follows from the seed, the number of the draw and the place alone: other places do not change it. The correlation
is met exactly on average over draws, and the numbers are normal but for an excess kurtosis of -1.5/WAVES.

References
----------
Jayaram N, Baker JW (2009). Correlation model for spatially distributed ground-motion intensities. Earthquake
Engineering and Structural Dynamics 38(15):1687-1708. doi:10.1002/eqe.922 (eqs. 17 to 20: b of PGA is 8.5 km, or 40.7 km
where soil conditions are clustered; the longer one is taken here, as it makes sums over a city more uncertain. PGV is
taken as spectral acceleration at 1 s, 22.0 + 3.7 km, as in OpenQuake from 3.26 on)
Boore DM, Stewart JP, Seyhan E, Atkinson GM (2014). NGA-West2 equations for predicting PGA, PGV, and 5% damped PSA for
shallow crustal earthquakes. Earthquake Spectra 30(3):1057-1085. doi:10.1193/070113EQS184M (tau and phi of PGA and PGV,
each linear in magnitude from 4.5 to 5.5, before the terms of phi for distance and Vs30)
Rahimi A, Recht B (2007). Random features for large-scale kernel machines. NIPS 20.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from assess.arrays import FloatArray

Measure = Literal["PGA", "PGV"]
MAGNITUDES = 4.5, 5.5


@dataclass(frozen=True, slots=True)
class Scatter:
    """How a peak of the ground scatters.

    * `between`, `within`: standard deviations of its ln [-] from one earthquake to the next, tau, and from place to
      place in one, phi: up to the first and from the second of `MAGNITUDES` on.
    * `range_km`: b: the distance at which the correlation has fallen to exp(-3).
    """

    between: tuple[float, float]
    within: tuple[float, float]
    range_km: float

    def at(self, magnitude: float) -> tuple[float, float]:
        """Return tau and phi at a magnitude [-]."""
        tau, phi = (float(np.interp(magnitude, MAGNITUDES, values)) for values in (self.between, self.within))
        return tau, phi

    @property
    def shared(self) -> float:
        """Share of the variance that is common to all places in one earthquake of magnitude 5.5 or more [-]."""
        return self.between[1] ** 2 / (self.between[1] ** 2 + self.within[1] ** 2)


SCATTERS: dict[Measure, Scatter] = {
    "PGA": Scatter((0.398, 0.348), (0.695, 0.495), 40.7),
    "PGV": Scatter((0.401, 0.346), (0.644, 0.552), 25.7),
}
WAVES = 64
"""Plane waves of the field of one draw."""
EARTH = 6371.0
"""Mean radius of the earth [km]."""
_STREAM = 3
"""Stream of random numbers of a seed; 1 and 2 are those of `assess.rocking.draws`."""
_AT_ONCE = 256
"""Draws that have one generator, so that late ones do not wait for all before them."""


def draw_field(
    seed: int, first: int, count: int, latitude: float, longitude: float, range_km: float = SCATTERS["PGA"].range_km
) -> FloatArray:
    """Return the normal numbers of draws `first` to `first + count - 1` at a place [deg], (count,)."""
    waves = [_draw_waves(seed, block) for block in range(first // _AT_ONCE, -(-(first + count) // _AT_ONCE))]
    directions, phases = (np.concatenate(parts) for parts in zip(*waves, strict=True))
    # In space: at the scale of a city chords are as long as ways.
    phi, lam = math.radians(latitude), math.radians(longitude)
    place = (EARTH * np.array([math.cos(phi) * math.cos(lam), math.cos(phi) * math.sin(lam), math.sin(phi)])) / range_km
    values = math.sqrt(2 / WAVES) * np.cos(directions @ place + phases).sum(axis=1)
    start = first - first // _AT_ONCE * _AT_ONCE
    return np.asarray(values[start : start + count])


@lru_cache(maxsize=64)
def _draw_waves(seed: int, block: int) -> tuple[FloatArray, FloatArray]:
    """Return the wave numbers over a range [rad], (256, WAVES, 3), and phases, (256, WAVES), of a block of draws.

    Wave numbers of an exponential correlation in space have a Cauchy distribution in three dimensions: a normal vector
    over the size of a normal number.
    """
    from scipy.special import ndtri

    uniform = np.random.default_rng([seed, _STREAM, block]).random((_AT_ONCE, WAVES, 5))
    normal = ndtri(np.clip(uniform[..., :4], 1e-12, 1 - 1e-12))
    scale = np.maximum(np.abs(normal[..., 3:]), 1e-9) / 3
    return normal[..., :3] / scale, 2 * np.pi * uniform[..., 4]
