"""How the ground shook in an earthquake by a ShakeMap of the U.S. Geological Survey, read from its grid.xml.

The values of the map are medians; they hold the effect of the ground (Vs30), which is not applied again. Between the
points of the grid ln of a value is interpolated linearly along both axes; nothing is taken beyond the grid. The
standard deviation of ln PGV is the field STDPGV of the grid, else that of uncertainty.xml in the same folder, else that
of PGA, STDPGA, else that of Boore et al. (2014); a field that is 0 at every point counts as none. Where the map has no
PGV, that of PGA rules. It mixes what a whole earthquake and what single places have of their own; where uncertainty.xml
holds the parts of the ground-motion model (GMPE_INTER_STDPGV, GMPE_INTRA_STDPGV), their share is taken from there.

References
----------
Worden CB, Wald DJ (2016). ShakeMap manual online. U.S. Geological Survey, doi:10.5066/F7D21VPQ
Boore DM, Stewart JP, Seyhan E, Atkinson GM (2014): see `assess.motion.spatial_field`.
"""

import hashlib
import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from assess.errors import InputError
from assess.i18n import Text, fill, join, nfill
from assess.input_file import read_input
from assess.motion.shake_grid import LARGEST_FILE, FloatArray, Grid, describe_place, find_turn, parse_grid
from assess.motion.site_ground import SiteGround
from assess.motion.spatial_field import MAGNITUDES, SCATTERS, Measure
from assess.units import GRAVITY

LARGEST_SIGMA = 3.0
"""Standard deviations of ln of a peak above this are a slip."""
LARGEST_PGA = 10 * GRAVITY
"""Accelerations above this [m/s2] are a slip in the unit; 5 % damped spectra may be three times it."""
LARGEST_PGV = 10.0
"""Velocities above this [m/s] are a slip in the unit."""

SIGMAS = frozenset({"STDPGA", "STDPGV"})
PARTS = frozenset({"GMPE_INTER_STDPGA", "GMPE_INTRA_STDPGA", "GMPE_INTER_STDPGV", "GMPE_INTRA_STDPGV"})
_PSA = re.compile(r"(?:PSA|SA)(\d)(\d)", re.ASCII)
_PER_CENT_G = frozenset({"", "pctg", "%g", "pct_g", "%_g"})
_CM_PER_S = frozenset({"", "cms", "cm/s", "cm/sec"})
_LN = frozenset({"", "ln(pctg)", "ln(%g)", "ln(g)", "ln", "ln(cms)", "ln(cm/s)"})


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShakeMap:
    """The map of an earthquake: what `at` gives at any place of its grid.

    Read from a file, it pickles as the file's path and hash and is read again, once a process.

    * `file`: name of the file of the grid.
    * `sha256`: hash of its bytes; with an uncertainty.xml, of the hashes of both files.
    * `grid_sha256`: hash of the grid's bytes alone.
    * `grid`: what the grid holds.
    * `uncertainty_file`, `uncertainty_sha256`: name and hash of the file of uncertainties; "" where there is none.
    * `uncertainty`: what that holds.
    * `path`: where the grid was read from.
    * `gaps`: points of the grid at which a field that is used is not a number.
    """

    file: str
    sha256: str
    grid_sha256: str
    grid: Grid
    uncertainty_file: str = ""
    uncertainty_sha256: str = ""
    uncertainty: Grid | None = None
    path: Path | None = None
    gaps: int = 0

    @property
    def title(self) -> Text:
        """The earthquake in words."""
        event = self.grid.event
        name = event.get("event_description") or self.event_id or self.file
        magnitude = event.get("magnitude", "")
        if not magnitude:
            return fill("{name}", name=name)
        return fill("{name}, magnitude {magnitude}", name=name, magnitude=magnitude)

    @property
    def event_id(self) -> str:
        """How its maker numbers the earthquake."""
        return _find_event(self.grid)

    def at(self, latitude: float, longitude: float) -> SiteGround:
        """Return the shaking at a place [deg].

        Raises
        ------
        InputError
            If the grid does not cover the place, or has no PGA there; the message names the place and the grid.
        """
        try:
            read = _locate(self.grid, latitude, longitude)
            pga = read("PGA", logarithmic=True)
            if math.isnan(pga):
                message = fill(
                    "the PGA of the map is 0 or not a number (NaN) at {place}",
                    place=describe_place(latitude, longitude),
                )
                raise InputError(message)
        except InputError as error:
            raise InputError(join(": ", (self.file, error.message))) from None
        return self._describe(read, pga, latitude, longitude)

    def _describe(self, read: "_Reading", pga: float, latitude: float, longitude: float) -> SiteGround:
        pgv = read("PGV", logarithmic=True) / 100 if "PGV" in self.grid.fields else math.nan
        psa = ((period, read(name, logarithmic=True) * GRAVITY / 100) for name, period in _list_psa(self.grid))
        measure: Measure = "PGA" if math.isnan(pgv) else "PGV"
        sigma, source, shared = self._find_sigma(measure, read, latitude, longitude)
        return SiteGround(
            kind="shakemap",
            file=self.file,
            sha256=self.grid_sha256,
            pga=pga * GRAVITY / 100,
            pgv=None if math.isnan(pgv) else pgv,
            psa=tuple((period, value) for period, value in psa if not math.isnan(value)),
            dispersion=sigma,
            dispersion_source=source,
            shared=shared,
            facts=tuple(self._list_facts(read)),
            cautions=tuple(self._list_cautions(read)),
        )

    def _find_sigma(
        self, measure: Measure, read: "_Reading", latitude: float, longitude: float
    ) -> tuple[float, Text, float | None]:
        """Return the standard deviation of ln of a peak [-], where it comes from, and its share common to all places.

        That of PGA stands in for that of PGV: both are small near a station, and far from one alike.
        """
        beside = self._look_beside(latitude, longitude)
        shared = next((one for name in (measure, "PGA") if (one := _find_shared(beside, name)) is not None), None)
        why = fill("the map has none at this place")
        for name in dict.fromkeys((f"STD{measure}", "STDPGA")):
            for reading, file in ((read, self.file), (beside, self.uncertainty_file)):
                sigma = reading(name) if reading and name in reading.fields else math.nan
                if sigma == 0 and reading and not (reading.fields[name] > 0).any():
                    why = fill("the map's {name} is 0 everywhere", name=name)
                elif not math.isnan(sigma):
                    return sigma, fill("{name} of {file}", name=name, file=file), shared
        magnitude = _read_magnitude(self.grid)
        between, within = SCATTERS[measure].at(magnitude)
        source = fill("assumed, as {why}: the total of Boore et al. 2014 for this magnitude", why=why)
        if magnitude >= MAGNITUDES[1]:
            source = fill("assumed, as {why}: the total of Boore et al. 2014 for magnitude 5.5 or more", why=why)
        return math.hypot(between, within), source, between**2 / (between**2 + within**2)

    def _look_beside(self, latitude: float, longitude: float) -> "_Reading | None":
        """Return what uncertainty.xml holds at a place [deg]; None where there is none, or it does not reach there."""
        if self.uncertainty is None:
            return None
        try:
            return _locate(self.uncertainty, latitude, longitude)
        except InputError:
            return None

    def _list_facts(self, read: "_Reading") -> Iterator[tuple[Text, Text]]:
        header, event = self.grid.header, self.grid.event
        version = join(", ", [text for text in (header.get("shakemap_version"), header.get("code_version")) if text])
        listed = (
            (fill("Earthquake"), self.title),
            (fill("Time of the earthquake"), event.get("event_timestamp", "")),
            (fill("Event ID"), self.event_id),
            (fill("Status of the map"), header.get("map_status", "")),
            (fill("Kind of event"), header.get("shakemap_event_type", "")),
            (fill("Version of the map, version of ShakeMap"), version),
            (fill("Map computed"), header.get("process_timestamp", "")),
            (fill("File of uncertainties"), self._cite_uncertainty()),
        )
        yield from ((label, fill("{text}", text=text)) for label, text in listed if text)
        speed = read("SVEL", logarithmic=True) if "SVEL" in self.grid.fields else math.nan
        if speed > 0:
            value = fill("{speed:.0f} m/s; its effect is in the map and is not applied again", speed=speed)
            yield fill("Vs30 of the map at the building"), value

    def _cite_uncertainty(self) -> Text | str:
        if not self.uncertainty_file:
            return ""
        return fill("{file}, SHA-256 {sha256}", file=self.uncertainty_file, sha256=self.uncertainty_sha256)

    def _list_cautions(self, read: "_Reading") -> Iterator[Text]:
        status = self.grid.header.get("map_status", "").upper()
        if status == "AUTOMATIC":
            yield fill("the ShakeMap is AUTOMATIC: nobody had reviewed it when it was computed; a later one may differ")
        if status in ("CANCELLED", "CANCELED"):
            yield fill("the ShakeMap is marked as {status}: its maker has withdrawn it", status=status)
        missing = [name for name in read.fields if math.isnan(read(name))]
        if missing:
            yield fill(
                "the ShakeMap holds no value (NaN) of {fields} next to the building: it is taken as not known there",
                fields=join(", ", missing),
            )
        elif self.gaps:
            yield nfill(
                "{n:,} point of the ShakeMap's grid holds no value (NaN); it is not next to the building",
                "{n:,} points of the ShakeMap's grid hold no value (NaN); none of them is next to the building",
                self.gaps,
            )

    def __reduce__(self) -> tuple[Any, ...]:
        if self.path is not None:
            return _read_again, (self.path, self.sha256)
        kept = {name: getattr(self, name) for name in self.__dataclass_fields__}
        return partial(ShakeMap, **kept), ()


@lru_cache(maxsize=2)
def _read_again(path: Path, sha256: str) -> ShakeMap:
    found = read_shakemap(path)
    if found.sha256 != sha256:
        raise InputError(fill("{file} has changed since the run began: start it again.", file=path.name))
    return found


# ---------------------------------------------------------------- files


def read_shakemap(path: Path) -> ShakeMap:
    """Read the map of a grid.xml, with the uncertainty.xml in its folder.

    Raises
    ------
    InputError
        If a file cannot be read or used; the message names it.
    """
    path = path.resolve()
    beside = next(
        (path.with_name(name) for name in name_uncertainty(path.name) if path.with_name(name).is_file()), None
    )
    return parse_shakemap(
        read_file(path),
        path.name,
        uncertainty=None if beside is None else read_file(beside),
        uncertainty_name="" if beside is None else beside.name,
        path=path,
    )


def name_uncertainty(name: str) -> tuple[str, ...]:
    """Return how the file of uncertainties beside a grid may be called, the name of the grid given."""
    renamed = re.sub("grid", "uncertainty", name, count=1, flags=re.IGNORECASE)
    return tuple(one for one in dict.fromkeys((renamed, "uncertainty.xml")) if one != name)


def read_file(path: Path) -> bytes:
    """Return the bytes of a file, but no more than show that it is too large; InputError if it cannot be read."""
    try:
        return read_input(path, LARGEST_FILE)
    except (OSError, ValueError) as error:  # ValueError: a zero character in the name
        why = getattr(error, "strerror", None) or str(error)
        raise InputError(fill("{file}: the file cannot be read ({why})", file=path.name, why=why)) from None


def parse_shakemap(
    data: bytes, name: str, *, uncertainty: bytes | None = None, uncertainty_name: str = "", path: Path | None = None
) -> ShakeMap:
    """Return the map of the bytes of a grid.xml, and of an uncertainty.xml; names are how messages call them.

    Raises
    ------
    InputError
        If one is not such a file, is damaged or cut off, lacks PGA, has an unknown unit, or holds a number that is
        impossible; if the two are of different earthquakes.
    """
    grid = _named(name, lambda: _read_grid(data))
    digest = hashlib.sha256(data).hexdigest()
    if uncertainty is None:
        return ShakeMap(file=name, sha256=digest, grid_sha256=digest, grid=grid, path=path, gaps=_count_gaps(grid))
    beside = _read_uncertainty(
        uncertainty, grid, uncertainty_name if path is None else str(path.with_name(uncertainty_name)), name
    )
    its = hashlib.sha256(uncertainty).hexdigest()
    return ShakeMap(
        file=name,
        sha256=hashlib.sha256((digest + its).encode()).hexdigest(),
        grid_sha256=digest,
        grid=grid,
        uncertainty_file=uncertainty_name,
        uncertainty_sha256=its,
        uncertainty=beside,
        path=path,
        gaps=_count_gaps(grid),
    )


def _count_gaps(grid: Grid) -> int:
    """Return at how many points a field is not a number."""
    return int(np.logical_or.reduce([np.isnan(values) for values in grid.fields.values()]).sum())


@lru_cache(maxsize=2)  # workbooks of one folder name the same map
def _read_grid(data: bytes) -> Grid:
    grid = parse_grid(data)
    if "PGA" not in grid.fields:
        raise InputError(fill("the field PGA is missing: give the file grid.xml of a ShakeMap"))
    psa = [name for name, _ in _list_psa(grid)]
    _check_field(grid, "PGA", _PER_CENT_G, "%g", 100 * LARGEST_PGA / GRAVITY)
    for name in psa:
        _check_field(grid, name, _PER_CENT_G, "%g", 300 * LARGEST_PGA / GRAVITY)
    if "PGV" in grid.fields:
        _check_field(grid, "PGV", _CM_PER_S, "cm/s", 100 * LARGEST_PGV)
    _check_sigmas(grid, SIGMAS)
    return _keep(grid, {"PGA", "PGV", *SIGMAS, "SVEL", *psa})


def _read_uncertainty(data: bytes, grid: Grid, name: str, grid_name: str) -> Grid:
    """Return what a file of uncertainties holds; InputError, which says what the map gives without it."""
    try:
        return _named(name, lambda: _check_uncertainty(parse_grid(data), grid))
    except InputError as error:
        way = fill(
            "You can remove the file: the STDPGV or STDPGA of {grid} is then used, or an assumed one where it has none",
            grid=grid_name,
        )
        raise InputError(join(". ", (error.message, way))) from None


def _named(name: str, read: Callable[[], Grid]) -> Grid:
    try:
        return read()
    except InputError as error:
        raise InputError(join(": ", (name, error.message))) from None


# ---------------------------------------------------------------- fields


def _check_uncertainty(beside: Grid, grid: Grid) -> Grid:
    """Return a grid of uncertainties with the fields that are used."""
    own, other = _find_event(grid), _find_event(beside)
    if own != other:
        message = fill(
            "it is of the event {other!r}, but the grid of {own!r}: name the right grid", own=own, other=other
        )
        raise InputError(message)
    _check_sigmas(beside, SIGMAS | PARTS)
    return _keep(beside, set(SIGMAS | PARTS))


def _check_sigmas(grid: Grid, names: frozenset[str]) -> None:
    for name in sorted(names & grid.fields.keys()):
        _check_field(grid, name, _LN, "ln(cm/s)" if name.endswith("PGV") else "ln(%g)", LARGEST_SIGMA)


def _check_field(grid: Grid, name: str, units: frozenset[str], unit: str, most: float) -> None:
    own = grid.units[name]
    if own.replace(" ", "").lower() not in units:
        message = fill("the field {name} has the unit {own!r}, expected {unit}", name=name, own=own[:40], unit=unit)
        raise InputError(message)
    values = grid.fields[name]
    bad = (values < 0) | (values > most)  # NaN is refused only next to a building
    if bad.any():
        row, column = divmod(int(bad.argmax()), values.shape[1])
        place = describe_place(float(grid.latitude[row]), float(grid.longitude[column]))
        value = float(values[row, column])
        raise InputError(
            fill(
                "the field {name} is {value:g} at {place}, expected 0 to {most:g} {unit}",
                name=name,
                value=value,
                place=place,
                most=most,
                unit=unit,
            )
        )


def _keep(grid: Grid, names: set[str]) -> Grid:
    fields = {name: values for name, values in grid.fields.items() if name in names}
    return Grid(grid.header, grid.event, grid.latitude, grid.longitude, fields, grid.units)


def _list_psa(grid: Grid) -> list[tuple[str, float]]:
    """Return the fields of spectral acceleration with their periods [s], rising: PSA03 is that of 0.3 s."""
    found = [(name, match) for name in grid.fields if (match := _PSA.fullmatch(name))]
    return sorted(((name, int(match[1] + match[2]) / 10) for name, match in found), key=lambda one: one[1])


def _find_event(grid: Grid) -> str:
    return grid.header.get("event_id") or grid.event.get("event_id", "")


def _read_magnitude(grid: Grid) -> float:
    """Return the magnitude of the earthquake; infinite where it is not known."""
    try:
        magnitude = float(grid.event.get("magnitude", ""))
    except ValueError:
        return math.inf
    return magnitude if math.isfinite(magnitude) else math.inf


def _find_shared(beside: "_Reading | None", measure: str) -> float | None:
    """Return the share of the variance of the ground-motion model that lies between earthquakes [-]."""
    parts = f"GMPE_INTER_STD{measure}", f"GMPE_INTRA_STD{measure}"
    if beside is None or not set(parts) <= beside.fields.keys():
        return None
    between, within = (beside(name) ** 2 for name in parts)
    return between / (between + within) if between + within > 0 else None


# ---------------------------------------------------------------- values at a place


@dataclass(frozen=True, slots=True, eq=False)
class _Reading:
    """The fields of a grid at one place: the weights of the points around it, which add up to 1."""

    fields: Mapping[str, FloatArray]
    rows: tuple[int, int]
    columns: tuple[int, int]
    weights: FloatArray

    def __call__(self, name: str, *, logarithmic: bool = False) -> float:
        """Return a field interpolated linearly, or by its logarithm; NaN where that is of 0."""
        values = self.fields[name][np.ix_(self.rows, self.columns)]
        counted = self.weights > 0
        values, weights = values[counted], self.weights[counted]
        if not logarithmic:
            return float(weights @ values)
        return math.exp(float(weights @ np.log(values))) if (values > 0).all() else math.nan


def _locate(grid: Grid, latitude: float, longitude: float) -> _Reading:
    """Return the points around a place [deg] with their weights; InputError where it lies outside the grid."""
    turned = find_turn(longitude, grid) if math.isfinite(longitude) else math.nan
    limits = [float(grid.latitude[0]), float(grid.latitude[-1]), float(grid.longitude[0]), float(grid.longitude[-1])]
    if not (limits[0] <= latitude <= limits[1] and limits[2] <= turned <= limits[3]):
        place = describe_place(latitude, longitude)
        south, north, west, east = limits
        raise InputError(
            fill(
                "{place} is outside the map, which covers latitude {south:.4f} to {north:.4f} and longitude {west:.4f} "
                "to {east:.4f}",
                place=place,
                south=south,
                north=north,
                west=west,
                east=east,
            )
        )
    rows, north = _find_cell(grid.latitude, latitude)
    columns, east = _find_cell(grid.longitude, turned)
    return _Reading(grid.fields, rows, columns, np.outer([1 - north, north], [1 - east, east]))


def _find_cell(points: FloatArray, value: float) -> tuple[tuple[int, int], float]:
    """Return the two points between which a value lies, and how far from the first to the second it is [-]."""
    lower = min(int(np.searchsorted(points, value, side="right")) - 1, points.size - 2)
    return (lower, lower + 1), float((value - points[lower]) / (points[lower + 1] - points[lower]))
