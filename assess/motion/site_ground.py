"""How strongly the ground shakes at a place: what a ShakeMap and computed scenarios have in common."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Literal, Protocol, TypeVar

from assess.errors import InputError
from assess.i18n import Text, join
from assess.motion.spatial_field import Measure
from assess.resources import read_input
from assess.units import GRAVITY, VELOCITY, to_edge


@dataclass(frozen=True, slots=True, kw_only=True)
class SiteGround:
    """How the ground shakes at one place by a ShakeMap, or in many scenarios that another program computed.

    It takes the place of Ground PGA, SDS, Ground PGV and Shaking.

    * `file`, `sha256`: name of its file, and hash of the file's bytes.
    * `pga`, `pgv`: medians [m/s2], [m/s]; `pgv` is None where it is not known.
    * `psa`: period [s] and median 5 % spectral acceleration [m/s2], as far as they are known.
    * `dispersion`: standard deviation of ln of `measure` at this place [-].
    * `dispersion_source`: where that comes from, in words.
    * `shared`: share of its variance that is common to all places in one earthquake [-]; None where that is not known.
    * `distance`: from the place to the site of the scenarios [m].
    * `scenarios`: ln of `measure` of each scenario, less their mean, over their standard deviation [-]; draw k takes
      number k.
    * `facts`: what a reader has to know of its origin: the event, version and status of the map, and the like.
    * `cautions`: what makes it less certain than `dispersion` tells: a map that nobody has reviewed, a site that is far
      away.
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

    @property
    def measure(self) -> Measure:
        """The peak that rules, whose scatter is drawn: PGV where it is known."""
        return "PGA" if self.pgv is None else "PGV"

    @property
    def pga_g(self) -> float:
        """The median PGA [g]."""
        return to_edge(self.pga, GRAVITY)

    @property
    def pgv_cm_s(self) -> float | None:
        """The median PGV [cm/s]."""
        return None if self.pgv is None else to_edge(self.pgv, VELOCITY["cm/s"])

    @property
    def psa_g(self) -> tuple[tuple[float, float], ...]:
        """The periods [s] and spectral accelerations [g]."""
        return tuple((period, to_edge(value, GRAVITY)) for period, value in self.psa)

    @property
    def distance_km(self) -> float | None:
        """The distance [km]."""
        return None if self.distance is None else self.distance / 1000

    @property
    def count(self) -> int:
        """The number of scenarios; 0 of a map."""
        return len(self.scenarios)


class GroundField(Protocol):
    """What gives the shaking of the ground at any place that it covers."""

    @property
    def file(self) -> str:
        """Name of its file, as shown to people."""

    @property
    def sha256(self) -> str:
        """Hash of its bytes."""

    def at(self, latitude: float, longitude: float) -> SiteGround:
        """Return the shaking at a place [deg]; InputError where it does not cover the place."""


Field = TypeVar("Field", bound=GroundField)


@lru_cache(maxsize=2)
def read_again(read: Callable[[Path], Field], path: Path, sha256: str) -> Field:
    """Return what `read` makes of a path, once a process; InputError where its hash is another one by now."""
    found = read(path)
    if found.sha256 != sha256:
        raise InputError.about("{file} has changed since the run began: start it again.", file=path.name)
    return found


def find_no_number(cells: Sequence[str]) -> int:
    """Return the place of the first cell that is no number; -1 where all are."""
    for place, cell in enumerate(cells):
        try:
            float(cell)
        except ValueError:
            return place
    return -1


@contextmanager
def naming(file: str) -> Iterator[None]:
    """Have errors name a file."""
    try:
        yield
    except InputError as error:
        raise InputError(join(": ", (file, error.message))) from None


def read_ground_file(path: Path, most: int) -> bytes:
    """Return the bytes of a file, but no more than show that it has over `most`; InputError if it cannot be read."""
    try:
        return read_input(path, most)
    except (OSError, ValueError) as error:  # ValueError: a zero character in the name
        why = getattr(error, "strerror", None) or str(error)
        raise InputError.about("{file}: the file cannot be read ({why})", file=path.name, why=why) from None
