"""How strongly the ground shakes at a place: what a ShakeMap and computed scenarios have in common."""

from dataclasses import dataclass
from typing import Literal, Protocol

from assess.i18n import Text


@dataclass(frozen=True, slots=True, kw_only=True)
class SiteGround:
    """How the ground shakes at one place by a ShakeMap, or in many scenarios that another program computed.

    It takes the place of Ground PGA, SDS, Ground PGV and Shaking.

    Parameters
    ----------
    kind : "shakemap" or "scenarios"
        What it comes from.
    file : str
        Name of its file.
    sha256 : str
        Hash of the file's bytes.
    pga, pgv : float
        Medians [m/s2], [m/s]; `pgv` is None where it is not known.
    psa : tuple of pairs
        Period [s] and median 5 % spectral acceleration [m/s2], as far as they are known.
    dispersion : float
        Standard deviation of ln PGA at this place [-].
    dispersion_source : Text
        Where that comes from, in words.
    shared : float, optional
        Share of its variance that is common to all places in one earthquake [-]; None where that is not known.
    distance : float, optional
        From the place to the site of the scenarios [m].
    scenarios : tuple of float
        ln PGA of each scenario, less their mean, over their standard deviation [-]; draw k takes number k.
    facts : tuple of pairs of Text
        What a reader has to know of its origin: the event, version and status of the map, and the like.
    cautions : tuple of Text
        What makes it less certain than `dispersion` tells: a map that nobody has reviewed, a site that is far away.
    """

    kind: Literal["shakemap", "scenarios"]
    file: str
    sha256: str
    pga: float
    pgv: float | None = None
    psa: tuple[tuple[float, float], ...] = ()
    dispersion: float
    dispersion_source: Text
    shared: float | None = None
    distance: float | None = None
    scenarios: tuple[float, ...] = ()
    facts: tuple[tuple[Text, Text], ...] = ()
    cautions: tuple[Text, ...] = ()


class GroundField(Protocol):
    """What gives the shaking of the ground at any place that it covers."""

    @property
    def file(self) -> str:
        """Name of its file, as shown to people."""
        ...

    @property
    def sha256(self) -> str:
        """Hash of its bytes."""
        ...

    def at(self, latitude: float, longitude: float) -> SiteGround:
        """Return the shaking at a place [deg]; InputError where it does not cover the place."""
        ...
