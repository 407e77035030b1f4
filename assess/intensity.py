"""Macroseismic intensity to the peak motion of the ground: for those who know neither an acceleration nor a record.

A choice of `SHAKINGS` stands for the middle of a class of intensity. MMI classes give median PGA and PGV by Worden et
al. (2012), which are those that the legend of ShakeMap prints. JMA classes give PGV by Midorikawa et al. (1999); PGA
follows by the ratio of the two that is drawn. The scatter is that of PGV, which rules; a class adds its own width.

Departures: distance and magnitude terms are left out, as in ShakeMap's legend. Classes that are open above (MMI X and
JMA 7) are taken as one whole unit of intensity about their number: a lower limit would be on the unsafe side.

References
----------
Newmark NM, Hall WJ (1982). Earthquake Spectra and Design. Earthquake Engineering Research Institute.
Worden CB, Gerstenberger MC, Rhoades DA, Wald DJ (2012). Probabilistic relationships between ground-motion parameters
and Modified Mercalli intensity in California. BSSA 102(1):204-221. doi:10.1785/0120110156. Coefficients as
implemented in USGS ShakeMap (esi-shakelib 1.2.1, gmice/wgrw12.py).
Midorikawa S, Fujimoto K, Muramatsu I (1999). Correlation of new JMA instrumental seismic intensity with former JMA
seismic intensity and ground motion parameters. Journal of Social Safety Science 1:51-56. The equation as
implemented in public code that cites it.
JMA notice of 1996: class limits of instrumental intensity.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from assess.units import GRAVITY, VELOCITY, to_edge

RATIO = 1.05 / GRAVITY
"""Median PGV/PGA of the ground [s], where one of them alone is known: 105 cm/s per g, the geometric mean of the 122 on
firm soil and 91 on rock of Newmark and Hall (1982). Assumed: not compared with the print. The 44 far-field components
of FEMA P-695 have 103."""

WORDEN = (
    "Worden CB, Gerstenberger MC, Rhoades DA, Wald DJ (2012). Probabilistic relationships between ground-motion "
    "parameters and Modified Mercalli intensity in California. Bulletin of the Seismological Society of America "
    "102(1):204-221. doi:10.1785/0120110156. Coefficients as implemented in USGS ShakeMap (esi-shakelib 1.2.1)."
)
MIDORIKAWA = (
    "Midorikawa S, Fujimoto K, Muramatsu I (1999). Correlation of new JMA instrumental seismic intensity with former "
    "JMA seismic intensity and ground motion parameters. Journal of Social Safety Science 1:51-56. "
    "Equation as implemented in public code that cites it."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Bilinear:
    """MMI = c1 + c2 log10 Y up to MMI t2, c3 + c4 log10 Y above it: Worden et al. (2012).

    Y is a peak in cm/s2 or cm/s, from 2.8 % g or 1.4 cm/s (MMI IV) on: below, the authors have a third branch.
    `sigma_mmi` is the standard deviation of MMI given Y, `sigma_log` that of log10 Y given MMI [-].
    """

    c1: float
    c2: float
    c3: float
    c4: float
    t1: float
    t2: float
    sigma_mmi: float
    sigma_log: float

    def invert(self, mmi: float) -> float:
        """Return the median Y [cm/s2 or cm/s] given MMI [-], 4 or more."""
        return float(10 ** ((mmi - self.c1) / self.c2 if mmi <= self.t2 else (mmi - self.c3) / self.c4))

    def estimate(self, y: float) -> float:
        """Return MMI [-] given Y [cm/s2 or cm/s]; below MMI IV it is not theirs."""
        log = math.log10(y)
        return self.c1 + self.c2 * log if log <= self.t1 else self.c3 + self.c4 * log


WORDEN_PGA = Bilinear(c1=1.78, c2=1.55, c3=-1.60, c4=3.70, t1=1.57, t2=4.22, sigma_mmi=0.66, sigma_log=0.35)
"""PGA in cm/s2."""
WORDEN_PGV = Bilinear(c1=3.78, c2=1.47, c3=2.89, c4=3.16, t1=0.53, t2=4.56, sigma_mmi=0.63, sigma_log=0.38)
"""PGV in cm/s."""

JMA_0, JMA_1, JMA_SIGMA = 2.68, 1.72, 0.21
"""I = 2.68 + 1.72 log10 PGV [cm/s], for I of 4 or more, and the standard deviation of I: Midorikawa et al. (1999)."""


def invert_jma(intensity: float) -> float:
    """Return the median PGV [cm/s] given a JMA instrumental intensity [-], 4 or more: Midorikawa et al. (1999)."""
    return float(10 ** ((intensity - JMA_0) / JMA_1))


@dataclass(frozen=True, slots=True, kw_only=True)
class Shaking:
    """A class of intensity (`choice` as the workbook offers it, `name` in short) as the motion of the ground.

    `intensity` is what it is taken for, MMI or JMA; `pga` and `pgv` are medians [m/s2], [m/s], `scatter` the standard
    deviation of ln PGV given the class, rounded up to 0.01. `is_derived`: PGA follows from PGV, by the ratio that is
    drawn; `is_open`: the class has no upper limit.
    """

    choice: str
    name: str
    intensity: float
    pga: float
    pgv: float
    scatter: float
    sources: tuple[str, ...]
    references: tuple[str, ...]
    is_derived: bool = False
    is_open: bool = False

    @property
    def pga_g(self) -> float:
        """The median PGA [g]."""
        return to_edge(self.pga, GRAVITY)

    @property
    def pgv_cm_s(self) -> float:
        """The median PGV [cm/s]."""
        return to_edge(self.pgv, VELOCITY["cm/s"])


def _round_up(scatter_log: float) -> float:
    """Return a standard deviation of log10 Y as that of ln Y, rounded up, so that what is printed is what is used."""
    return math.ceil(100 * math.log(10) * scatter_log) / 100


def _from_mmi(choice: str, mmi: int) -> Shaking:
    return Shaking(
        choice=choice, name=choice.partition(",")[0], intensity=float(mmi), pga=WORDEN_PGA.invert(mmi) / 100,
        pgv=WORDEN_PGV.invert(mmi) / 100, scatter=_round_up(WORDEN_PGV.sigma_log), sources=("Worden et al. 2012",),
        references=(WORDEN,), is_open=mmi == 10,
    )  # fmt: skip


def _from_jma(choice: str, name: str, low: float, high: float, *, is_open: bool = False) -> Shaking:
    """Return a class of JMA intensity that reaches from `low` to `high`, within which every value is as likely."""
    middle, spread = (low + high) / 2, (high - low) / math.sqrt(12)
    pgv = invert_jma(middle)
    return Shaking(
        choice=choice, name=name, intensity=middle, pga=pgv / 100 / RATIO, pgv=pgv / 100,
        scatter=_round_up(math.hypot(spread, JMA_SIGMA) / JMA_1),
        sources=("Midorikawa et al. 1999",), references=(MIDORIKAWA,), is_derived=True, is_open=is_open,
    )  # fmt: skip


_ALL = (
    _from_mmi("MMI IV, light", 4),
    _from_mmi("MMI V, moderate", 5),
    _from_mmi("MMI VI, strong", 6),
    _from_mmi("MMI VII, very strong", 7),
    _from_mmi("MMI VIII, severe", 8),
    _from_mmi("MMI IX, violent", 9),
    _from_mmi("MMI X, extreme", 10),
    _from_jma("JMA 4", "JMA 4", 3.5, 4.5),
    _from_jma("JMA 5-, lower", "JMA 5-", 4.5, 5.0),
    _from_jma("JMA 5+, upper", "JMA 5+", 5.0, 5.5),
    _from_jma("JMA 6-, lower", "JMA 6-", 5.5, 6.0),
    _from_jma("JMA 6+, upper", "JMA 6+", 6.0, 6.5),
    _from_jma("JMA 7", "JMA 7", 6.5, 7.5, is_open=True),
)

SHAKINGS: Mapping[str, Shaking] = MappingProxyType({one.choice: one for one in _ALL})
"""The classes by their choice in the workbook: words of the legend of ShakeMap, and classes of the JMA."""


def name_mmi(pga: float, pgv: float | None) -> str:
    """Return the class of MMI of a ground motion [m/s2], [m/s], as a choice of `SHAKINGS`: by PGV, where it is known.

    "" below MMI IV; MMI X stands for all above.
    """
    mmi = WORDEN_PGV.estimate(100 * pgv) if pgv else WORDEN_PGA.estimate(100 * pga)
    named = {one.intensity: one.choice for one in _ALL if one.choice.startswith("MMI")}
    return named.get(min(round(mmi), 10), "")
