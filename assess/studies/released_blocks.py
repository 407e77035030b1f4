"""Blocks that were tilted and released in experiments, and how Housner's model lets them rock.

The measured rotations are not part of the package: what stands here is computed, and compared with nothing.

Reference: Cocuzza Avellino G, Cannizzaro F, Impollonia N (2022). Shaking table seismic experimental investigation of
lightweight rigid bodies. Buildings 12(7):915. doi:10.3390/buildings12070915.
"""

import math
from dataclasses import dataclass

from assess.rocking.draws import BASE, CUT
from assess.studies.study import read_facts
from assess.units import GRAVITY

RELEASE = 0.5
"""Rotation from which a block is released, over its critical angle [-]."""
FADED = 0.1
"""A block has come to rest, as far as is counted, once its peaks are below this share of the release [-]."""


@dataclass(frozen=True, slots=True)
class Rocker:
    """A body that rocks on a base which may be narrower than its plan.

    * `half_base`, `centre`: half the base on which it rocks, and the height of its centre of gravity [m].
    * `critical_angle`, `frequency_parameter`: alpha at which it falls over [rad], and p [rad/s], p2 = m g R / I0.
    * `restitution`: angular velocity after an impact over that before it [-]: 1 - 2 m R2 sin2(alpha) / I0.
    """

    half_base: float
    centre: float
    critical_angle: float
    frequency_parameter: float
    restitution: float

    @classmethod
    def of(cls, half_base: float, centre: float, inertia: float) -> "Rocker":
        """Build one; `inertia` is the moment of inertia about the centre of gravity over the mass [m2]."""
        squared_radius = half_base**2 + centre**2
        p = math.sqrt(GRAVITY * squared_radius**0.5 / (inertia + squared_radius))
        restitution = 1 - 2 * half_base**2 / (inertia + squared_radius)
        return cls(half_base, centre, math.atan(half_base / centre), p, restitution)

    @property
    def first_rebound(self) -> float:
        """First peak after a release from `RELEASE`, over it [-]."""
        release = RELEASE * self.critical_angle
        return self.rebound(release) / release

    @property
    def impacts(self) -> int:
        """Impacts after a release from `RELEASE` until the peaks are below `FADED` of it."""
        peak, count = RELEASE * self.critical_angle, 0
        while peak >= FADED * RELEASE * self.critical_angle:
            peak, count = self.rebound(peak), count + 1
        return count

    def rebound(self, peak: float) -> float:
        """Return the peak of the rotation after an impact [rad] from the one before it, by the energy that is left."""
        edge = math.cos(self.critical_angle)
        left = self.restitution**2 * (math.cos(self.critical_angle - peak) - edge)
        return self.critical_angle - math.acos(edge + left)


@dataclass(frozen=True, slots=True)
class ReleasedBlock:
    """A block of the experiments: `nominal` with the base of its plan, `corrected` with the fitted one."""

    name: str
    correction: float
    nominal: Rocker
    corrected: Rocker

    @property
    def size(self) -> str:
        """Base and height [mm]."""
        return f"{2000 * self.nominal.half_base:.0f} x {2000 * self.nominal.centre:.0f}"

    def compare(self, name: str, form: str) -> str:
        """Return a property of `Rocker` of the nominal and of the corrected block."""
        return " / ".join(format(getattr(one, name), form) for one in (self.nominal, self.corrected))


def list_released() -> list[ReleasedBlock]:
    """Return the four blocks of which sizes and base correction are published."""
    found = []
    for row in read_facts("released_blocks"):
        b, h, share = (float(row[name]) for name in ("half_base_m", "half_height_m", "base_correction"))
        inertia = (b**2 + h**2) / 3  # of the uniform block: (B2 + H2) / 12
        found.append(ReleasedBlock(row["block"], share, Rocker.of(b, h, inertia), Rocker.of(share * b, h, inertia)))
    return found


def describe_released() -> dict[str, object]:
    """Return what the page of all studies says of them."""
    blocks, (mean, deviation) = list_released(), BASE
    least = mean - CUT * deviation
    return {
        "released": blocks, "release": RELEASE, "faded": FADED, "base": BASE, "least": least,
        "lowered": [1 - one.correction for one in blocks], "outside": sum(one.correction < least for one in blocks),
    }  # fmt: skip
