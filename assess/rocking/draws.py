"""What is not known of an earthquake and of a piece of furniture, drawn: one scale an earthquake, one body a piece.

A simulation of one record's spectrum asks what would happen if exactly that motion recurred. The next earthquake of its
kind will be stronger or weaker, and pieces differ from their nominal sizes. Draw k scales the motions of the whole
building by one factor, exp(dispersion x a normal number), which is the real dependence between floors; each piece draws
its base, height, centre of gravity and restitution. Draws come from the seed and the piece alone: neither other pieces
nor their order nor the number of draws change them. The factors of earthquakes are stratified: each 25 draws in turn
have one factor in each 25th of its distribution, so that a run of few draws has its share of strong ones.

The dispersions are assumed, not measured on furniture; normal distributions are cut at 3 standard deviations.

Sizes by a phone's scan are less certain: base and height of such a piece are drawn with larger standard deviations. No
accuracy of the boxes that phones put round furniture is published; these are assumed, too: each face of a box within
about 5 cm, which is 0.10 of a base of 50 cm and 0.05 of a height of 1 m.
"""

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from assess.arrays import FloatArray
from assess.motion.spatial_field import SCATTERS, Measure, draw_field
from assess.motion.stratified import draw_normal, to_normal
from assess.rocking import block

MOTION = 0.4
"""Assumed standard deviation of the natural logarithm of the motion's amplitude [-]."""
TRIED = (0.2, 0.6)
"""Other standard deviations, for which a report states how many classes would change [-]."""
BASE = (0.97, 0.05)
"""Mean and standard deviation of the base over the nominal one [-]: feet stand inside the plan rather than outside."""
HEIGHT, CENTRE, RESTITUTION = 0.02, 0.05, 0.04
"""Standard deviations of the height over the nominal one, of the centre of gravity as a share of the height, and of
the restitution [-], about their nominal values."""
SCANNED_BASE, SCANNED_HEIGHT = (0.97, 0.10), 0.05
"""`BASE` and `HEIGHT` of a piece whose sizes were measured by a phone's scan."""
CUT = 3.0
"""Standard deviations beyond which nothing is drawn."""
STILL = 0.85
"""Share of the acceleration at which rocking starts [-] below which a piece is taken not to start: the peak of a motion
may be somewhat above the floor's PFA, and the piece more slender than given."""
STILL_SCANNED = 0.64
"""The same of a piece measured by a scan: `STILL` times how much more slender than another its slenderest draw is,
(0.67 / 1.15) / (0.82 / 1.06)."""
PEAK = 0.25
"""Standard deviation of ln of a generated motion's peak over a recorded floor's PFA [-]: measured, 0.12 to 0.28 on the
floors of the worked example."""
MARGIN = 0.65
"""Share of the acceleration at which rocking starts [-] below which not even the strongest motion that may be drawn is
taken to start a piece: so chosen that in 10,000 draws none overturns that stands just below."""
_EARTHQUAKE, _PIECE = 1, 2
"""Streams of random numbers of a seed; 3 is that of `assess.motion.spatial_field`."""
_AT_ONCE = 256
"""Draws that have one generator, so that late ones do not wait for all before them."""
_TINY = 1e-6


@dataclass(frozen=True, slots=True)
class Uncertainty:
    """What is taken to be uncertain.

    * `motion`: standard deviation of ln of the motion's amplitude from one earthquake to the next [-].
    * `piece`: whether base, height, centre of gravity and restitution of a piece are drawn.
    """

    motion: float = MOTION
    piece: bool = True

    base: ClassVar[tuple[float, float]] = BASE
    height: ClassVar[float] = HEIGHT
    scanned_base: ClassVar[tuple[float, float]] = SCANNED_BASE
    scanned_height: ClassVar[float] = SCANNED_HEIGHT
    centre: ClassVar[float] = CENTRE
    restitution: ClassVar[float] = RESTITUTION
    cut: ClassVar[float] = CUT
    """What is the same in every run, as reports state it."""

    def largest_start(
        self, centre: FloatArray, scanned: NDArray[np.bool_], dispersion: FloatArray, peak: FloatArray
    ) -> FloatArray:
        """Return the factor on PFA over b/z that no draw is taken to exceed [-], of n pieces.

        Three standard deviations of earthquake (`dispersion`), `peak`, base, height and centre of gravity together.
        """
        size = np.where(scanned, math.hypot(SCANNED_BASE[1], SCANNED_HEIGHT), math.hypot(BASE[1], HEIGHT))
        together = dispersion**2 + peak**2 + self.piece * (size**2 + (CENTRE / centre) ** 2)
        return np.asarray(np.exp(CUT * np.sqrt(together)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Earthquakes:
    """Which normal number scales the motions of a building in each draw of an earthquake.

    * `place`: latitude and longitude [deg] of a building of a city: part of the number is common to all places, the
      rest differs from place to place as `assess.motion.spatial_field` tells. None: all of it is common.
    * `shared`: share of the variance that is common to all places [-].
    * `measure`: whose correlation between places the rest has.
    * `given`: numbers of scenarios that were computed elsewhere, mean 0 and standard deviation 1 over all of them; draw
      k takes number k modulo their count. Empty where there are none.
    * `given_share`: share of the variance that those numbers carry [-]; the rest is drawn.
    """

    place: tuple[float, float] | None = None
    shared: float = SCATTERS["PGA"].shared
    measure: Measure = "PGA"
    given: tuple[float, ...] = ()
    given_share: float = 0.0

    def draw(self, seed: int, first: int, count: int) -> FloatArray:
        """Return the numbers of draws `first` to `first + count - 1`, (count,), within 3 standard deviations."""
        drawn = draw_earthquakes(seed, first, count)
        if self.place is not None:
            field = draw_field(seed, first, count, *self.place, SCATTERS[self.measure].range_km)
            drawn = math.sqrt(self.shared) * drawn + math.sqrt(1 - self.shared) * field
        if self.given:
            given = np.array(self.given)[(first + np.arange(count)) % len(self.given)]
            drawn = math.sqrt(self.given_share) * given + math.sqrt(1 - self.given_share) * drawn
        return np.clip(drawn, -CUT, CUT)


@dataclass(frozen=True, slots=True, eq=False)
class DrawnBodies:
    """Bodies of m pieces, one a draw, (m, k) each: sizes [m], centre of gravity [share of height] and restitution."""

    breadth: FloatArray
    height: FloatArray
    centre: FloatArray
    restitution: FloatArray


@lru_cache(maxsize=1 << 16)
def name_number(name: str) -> int:
    """Return the number by which a piece of this name draws: the same wherever it stands."""
    return int.from_bytes(hashlib.sha256(name.encode()).digest()[:7], "big")


def draw_earthquakes(seed: int, first: int, count: int) -> FloatArray:
    """Return the normal numbers of draws `first` to `first + count - 1`, (count,), cut at 3 standard deviations."""
    return draw_normal([seed, _EARTHQUAKE], first, count, CUT)


def draw_bodies(
    breadth: FloatArray,
    height: FloatArray,
    centre: FloatArray,
    restitution: FloatArray,
    names: Sequence[int] | NDArray[np.int64],
    *,
    seed: int,
    first: int,
    count: int,
    scanned: NDArray[np.bool_] | None = None,
) -> DrawnBodies:
    """Draw the bodies of m pieces.

    * `breadth`, `height` (m,): nominal sizes [m].
    * `centre` (m,): nominal height of the centre of gravity as a share of the height [-].
    * `restitution` (m,): nominal [-]; NaN is that of the drawn body by equal angular momentum.
    * `names` (m,): from `name_number`; pieces of one name draw alike.
    * `seed`, `first`, `count`: draws `first` to `first + count - 1`.
    * `scanned` (m,): which sizes were measured by a scan; None: none. The draws of the others do not depend on it.

    Returned: (m, count) each. Restitution is 0 where nearly every one would be negative: a body about too stocky.
    """
    every, which = np.unique(np.asarray(names), return_inverse=True)
    blocks, start = range(first // _AT_ONCE, -(-(first + count) // _AT_ONCE)), first % _AT_ONCE
    drawn = [
        [np.random.default_rng([seed, _PIECE, int(one), block]).random((_AT_ONCE, 4)) for block in blocks]
        for one in every
    ]
    u = np.stack([np.concatenate(own)[start : start + count] for own in drawn])[which.ravel()]  # (m, count, 4)
    by_scan = np.zeros((len(names), 1), dtype=np.bool_) if scanned is None else scanned[:, None]
    mean, deviation = (np.where(by_scan, one, other) for one, other in zip(SCANNED_BASE, BASE, strict=True))
    b = breadth[:, None] * (mean + deviation * to_normal(u[..., 0], -CUT, CUT))
    h = height[:, None] * (1 + np.where(by_scan, SCANNED_HEIGHT, HEIGHT) * to_normal(u[..., 1], -CUT, CUT))
    z = np.clip(centre[:, None] + CENTRE * to_normal(u[..., 2], -CUT, CUT), 0.01, 0.99)
    given = np.where(np.isnan(restitution)[:, None], block.restitution(b, h, z), restitution[:, None])
    low, high = np.maximum(-CUT, (0 - given) / RESTITUTION), np.minimum(CUT, (1 - given) / RESTITUTION)
    eta = given + RESTITUTION * to_normal(u[..., 3], np.minimum(low, high), high)
    return DrawnBodies(b, h, z, np.clip(eta, _TINY, 1 - _TINY))
