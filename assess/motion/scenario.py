"""Peaks of floors without sensors: PFA by the profiles that codes give for design.

A profile gives the factor by which a rigid piece on a floor at height z of a building of height h is shaken more than
the ground: PFA = ground PGA x amplification. Ground PGA is 0.4 SDS (ASCE 7) or alpha S (EN 1998-1, NTC 2018). Codes
give design envelopes, not expected values: they mostly lie above what is recorded, but not at mid-height of tall
buildings.

References
----------
ASCE/SEI 7-22 and 7-16, section 13.3.1; EN 1998-1:2004, 4.3.5.2; NTC 2018 with Circolare 2019, C7.2.3.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

PGA_OF_SDS = 0.4
"""Ground PGA over SDS: ASCE 7's horizontal acceleration of the ground is 0.4 SDS."""

UNVERIFIED = "assumed: not checked against the code's own text"
"""Status of a profile that has not been checked."""

VERIFIED = "agrees with public implementations of the code"
"""Status of a profile that was checked against programs that others wrote."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """How one code lets the peak acceleration grow with height.

    * `key`, `title`: its name among the scenarios, and in full.
    * `clause`, `equation`: the clause of the code, and its equation for a rigid component.
    * `reference`: the code.
    * `verified`: whether the equation agrees with public implementations of the code.
    * `remark`: how many programs it was checked against, and what was left out of it, in whole sentences.
    * `factor`: height ratio [-], from 0 to 1, and T1 [s] or None to amplification [-].
    * `reduced`: whether the code divides by R_mu, for the ductility of the building.
    * `clause_without_period`: the clause of the equation that applies while T1 is unknown.
    """

    key: str
    title: str
    clause: str
    equation: str
    reference: str
    verified: bool
    remark: str
    factor: Callable[[float, float | None], float]
    reduced: bool = False
    clause_without_period: str = ""

    @property
    def status(self) -> str:
        """Whether it was checked, in words."""
        return VERIFIED if self.verified else UNVERIFIED

    def cite(self, period: float | None) -> str:
        """Return the clause with the equation that applies, T1 known or not."""
        return self.clause_without_period if period is None and self.clause_without_period else self.clause

    def amplification(
        self, height_ratio: float, period: float | None = None, *, ductility_reduction: float = 1.0
    ) -> float:
        """Return PFA over ground PGA [-].

        * `height_ratio`: z/h: height of the floor over that of the roof [-]; below 0 counts as 0, above 1 as 1.
        * `period`: first period T1 of the building [s].
        * `ductility_reduction`: R_mu, at least 1, by which ASCE 7-22 alone divides. A floor never gets less than the
          ground, which the code leaves unreduced.
        """
        factor = self.factor(min(max(height_ratio, 0.0), 1.0), period)
        return max(1.0, factor / ductility_reduction) if self.reduced else factor


def _asce_7_22(z_h: float, T_a: float | None) -> float:
    if T_a is None:
        # Equation (13.3-5)
        return 1 + 2.5 * z_h
    a_1 = min(1 / T_a, 2.5)
    a_2 = max(1 - (0.4 / T_a) ** 2, 0.0)
    # Equation (13.3-4)
    return 1 + a_1 * z_h + a_2 * z_h**10


def _asce_7_16(z_h: float, _: float | None) -> float:
    # Equation (13.3-1), with a_p = 1 and R_p/I_p = 1
    return 1 + 2 * z_h


def _en_1998_1(z_h: float, _: float | None) -> float:
    # Equation (4.25) with T_a = 0: 3 (1 + z/H) / (1 + 1) - 0.5
    return 3 * (1 + z_h) / 2 - 0.5


def _ntc_2018(z_h: float, _: float | None) -> float:
    # C7.2.3 with T_a = 0
    return 1 + z_h


_ALL = (
    Profile(
        key="ASCE 7-22",
        title="ASCE 7-22, amplification with height",
        clause="13.3.1.1, Eq. 13.3-4",
        clause_without_period="13.3.1.1, Eq. 13.3-5",
        equation="PFA = 0.4 S_DS H_f/R_μ; H_f = 1 + a₁ (z/h) + a₂ (z/h)¹⁰, a₁ = 1/T_a ≤ 2.5, a₂ = 1 − (0.4/T_a)² ≥ 0; "
        "T_a unknown (Eq. 13.3-5): H_f = 1 + 2.5 (z/h)",
        reference="ASCE/SEI 7-22, Minimum Design Loads and Associated Criteria for Buildings and Other Structures, "
        "American Society of Civil Engineers, 2022",
        verified=True,
        remark="Checked against three independent implementations. T1 is used for T_a, R_μ is 1 unless given, and the "
        "PFA is never below the ground's.",
        factor=_asce_7_22,
        reduced=True,
    ),
    Profile(
        key="ASCE 7-16",
        title="ASCE 7-16, amplification with height",
        clause="13.3.1, Eq. 13.3-1",
        equation="PFA = 0.4 S_DS (1 + 2 z/h)",
        reference="ASCE/SEI 7-16, Minimum Design Loads and Associated Criteria for Buildings and Other Structures, "
        "American Society of Civil Engineers, 2017",
        verified=True,
        remark="Checked against one implementation. This is the part of the equation for a rigid component: a_p = 1 "
        "and R_p/I_p = 1.",
        factor=_asce_7_16,
    ),
    Profile(
        key="EN 1998-1",
        title="EN 1998-1, seismic coefficient of non-structural elements",
        clause="4.3.5.2, Eq. (4.25)",
        equation="S_a = αS [3 (1 + z/H)/(1 + (1 − T_a/T₁)²) − 0.5]; rigid, T_a = 0: PFA = αS (1 + 1.5 z/H)",
        reference="EN 1998-1:2004, Eurocode 8: Design of structures for earthquake resistance, Part 1, CEN, 2004",
        verified=False,
        remark="T1 drops out for a rigid component.",
        factor=_en_1998_1,
    ),
    Profile(
        key="NTC 2018",
        title="NTC 2018, floor acceleration of framed buildings",
        clause="Circolare 21 gennaio 2019 n. 7, C7.2.3",
        equation="rigid component, T_a = 0: PFA = αS (1 + z/H)",
        reference="Norme tecniche per le costruzioni, D.M. 17 gennaio 2018, with Circolare 21 gennaio 2019 n. 7 "
        "C.S.LL.PP.",
        verified=False,
        remark="T1 drops out for a rigid component.",
        factor=_ntc_2018,
    ),
)

PROFILES: Mapping[str, Profile] = MappingProxyType({profile.key: profile for profile in _ALL})
"""The profiles by name."""
