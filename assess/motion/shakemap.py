"""How the ground shook in an earthquake by a ShakeMap of the U.S. Geological Survey, read from its grid.xml.

The values of the map are medians; they hold the effect of the ground (Vs30), which is not applied again. Between the
points of the grid ln of a value is interpolated linearly along both axes; nothing is taken beyond the grid. The
standard deviation of ln PGV is the field STDPGV of the grid, else that of uncertainty.xml in the same folder, else that
of PGA, STDPGA, else that of Boore et al. (2014); a field that is 0 at every point counts as none. Where the map has no
PGV, that of PGA rules. It mixes what a whole earthquake and what single places have of their own; where uncertainty.xml
holds the parts of the ground-motion model (GMPE_INTER_STDPGV, GMPE_INTRA_STDPGV), their share is taken from there.

References
----------
Worden CB, Wald DJ (2016). ShakeMap manual online: technical manual, user's guide, and software guide. U.S. Geological
Survey, doi:10.5066/F7D21VPQ
Boore DM, Stewart JP, Seyhan E, Atkinson GM (2014): see `assess.motion.spatial_field`.
"""

import hashlib
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from assess.arrays import FloatArray
from assess.errors import InputError
from assess.i18n import Text, fill, join, nfill
from assess.motion.site_ground import SiteGround, find_no_number, naming, read_again, read_ground_file
from assess.motion.spatial_field import MAGNITUDES, SCATTERS, Measure
from assess.text import plain_text
from assess.units import GRAVITY

LARGEST_FILE = 64_000_000
"""Bytes; a grid of 241 x 193 points takes 3 million."""
MOST_POINTS = 2_000_000
MOST_FIELDS = 100
MOST_ELEMENTS = 5_000
_LONGEST = 200
"""Characters of a text of the file that are kept."""

_FOREIGN = (b"\x89HDF", b"PK\x03\x04", b"\x1f\x8b", b"{", b"[", b"%PDF", b"\xff\xfe", b"\xfe\xff")
"""How files begin that are not XML of ShakeMap: HDF, zip, gzip, JSON, PDF, UTF-16."""
LARGEST_SIGMA = 3.0
"""Standard deviations of ln of a peak above this are a slip."""
LARGEST_PGA = 10 * GRAVITY
"""Accelerations above this [m/s2] are a slip in the unit; 5 % damped spectra may be three times it."""
LARGEST_PGV = 10.0
"""Velocities above this [m/s] are a slip in the unit."""

SIGMAS = frozenset({"STDPGA", "STDPGV"})
PARTS = frozenset({"GMPE_INTER_STDPGA", "GMPE_INTRA_STDPGA", "GMPE_INTER_STDPGV", "GMPE_INTRA_STDPGV"})
_PSA = re.compile(r"(?:PSA|SA)(\d)(\d)", re.ASCII)
_PER_CENT_G = "%g", frozenset({"", "pctg", "%g", "pct_g", "%_g"})
_CM_PER_S = "cm/s", frozenset({"", "cms", "cm/s", "cm/sec"})
_LN = frozenset({"", "ln(pctg)", "ln(%g)", "ln(g)", "ln", "ln(cms)", "ln(cm/s)"})
"""Units, as messages call them and as files spell them."""


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """The fields of a grid of ShakeMap.

    * `header`, `event`: attributes of the file's root and of its event.
    * `latitude`, `longitude` (m,): rising [deg].
    * `fields`, `units`: as in the file, by the name of the field.
    """

    header: Mapping[str, str]
    event: Mapping[str, str]
    latitude: FloatArray
    longitude: FloatArray
    fields: Mapping[str, FloatArray]
    units: Mapping[str, str]

    @property
    def event_id(self) -> str:
        """How its maker numbers the earthquake."""
        return self.header.get("event_id") or self.event.get("event_id", "")

    @property
    def psa(self) -> dict[str, float]:
        """The fields of spectral acceleration with their periods [s], rising: PSA03 is that of 0.3 s."""
        found = ((name, match) for name in self.fields if (match := _PSA.fullmatch(name)))
        return dict(sorted(((name, int(match[1] + match[2]) / 10) for name, match in found), key=lambda one: one[1]))

    def keep(self, names: Iterable[str]) -> "Grid":
        """Return the grid with these fields only, as far as it has them."""
        return replace(self, fields={name: values for name, values in self.fields.items() if name in {*names}})

    def check(self, name: str, unit: str, units: frozenset[str], most: float) -> None:
        """Raise InputError where a field has another unit, or a value below 0 or above `most`; NaN is let pass."""
        own, values = self.units[name], self.fields[name]
        if own.replace(" ", "").lower() not in units:
            raise InputError.about(
                "the field {name} has the unit {own!r}, expected {unit}", name=name, own=own[:40], unit=unit
            )
        bad = (values < 0) | (values > most)
        if bad.any():
            row, column = divmod(int(bad.argmax()), values.shape[1])
            place = _describe_place(float(self.latitude[row]), float(self.longitude[column]))
            raise InputError.about(
                "the field {name} is {value:g} at {place}, expected 0 to {most:g} {unit}",
                name=name, value=float(values[row, column]), place=place, most=most, unit=unit,
            )  # fmt: skip

    def check_sigmas(self, names: frozenset[str]) -> None:
        """Raise InputError where a standard deviation cannot be one."""
        for name in sorted(names & self.fields.keys()):
            self.check(name, "ln(cm/s)" if name.endswith("PGV") else "ln(%g)", _LN, LARGEST_SIGMA)

    def locate(self, latitude: float, longitude: float) -> "_Reading":
        """Return the fields at a place [deg]; InputError where it lies outside the grid."""
        south, north, west, east = (float(one[end]) for one in (self.latitude, self.longitude) for end in (0, -1))
        turned = longitude
        if math.isfinite(longitude):  # by a multiple of 360 where that lies within the grid
            turned = longitude + 360 * math.ceil((west - longitude) / 360 - 1e-12)
            turned = turned if turned <= east else longitude
        if not (south <= latitude <= north and west <= turned <= east):
            raise InputError.about(
                "{place} is outside the map, which covers latitude {south:.4f} to {north:.4f} and longitude {west:.4f} "
                "to {east:.4f}",
                place=_describe_place(latitude, longitude), south=south, north=north, west=west, east=east,
            )  # fmt: skip
        (row, rows), (column, columns) = _find_cell(self.latitude, latitude), _find_cell(self.longitude, turned)
        return _Reading(self.fields, row, column, np.outer(rows, columns))


def _find_cell(points: FloatArray, value: float) -> tuple[int, tuple[float, float]]:
    """Return the point below a value, and the weights of that and of the next one [-]."""
    low = min(int(np.searchsorted(points, value, side="right")) - 1, points.size - 2)
    share = float((value - points[low]) / (points[low + 1] - points[low]))
    return low, (1 - share, share)


@dataclass(frozen=True, slots=True, eq=False)
class _Reading:
    """The fields of a grid at one place: its cell, and the weights of the points around it, which add up to 1."""

    fields: Mapping[str, FloatArray]
    row: int
    column: int
    weights: FloatArray

    def __call__(self, name: str, *, logarithmic: bool = False) -> float:
        """Return a field interpolated linearly, or by its logarithm; NaN where it is not known, or that is of 0."""
        if name not in self.fields:
            return math.nan
        values, counted = self.fields[name][self.row : self.row + 2, self.column : self.column + 2], self.weights > 0
        values, weights = values[counted], self.weights[counted]
        if not logarithmic:
            return float(weights @ values)
        return math.exp(float(weights @ np.log(values))) if (values > 0).all() else math.nan


@lru_cache(maxsize=2)
def _count_gaps(grid: Grid) -> int:
    """Return at how many points a field is not a number."""
    return int(np.logical_or.reduce([np.isnan(values) for values in grid.fields.values()]).sum())


def _describe_place(latitude: float, longitude: float) -> Text:
    return fill("latitude {latitude:.4f}, longitude {longitude:.4f}", latitude=latitude, longitude=longitude)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShakeMap:
    """The map of an earthquake: what `at` gives at any place of its grid.

    Read from a file, it pickles as the file's path and hash and is read again, once a process.

    * `file`, `grid_sha256`: name and hash of the file of the grid.
    * `sha256`: that hash; with an uncertainty.xml, of the hashes of both files.
    * `uncertainty_file`, `uncertainty_sha256`: name and hash of the file of uncertainties; "" where there is none.
    * `path`: where the grid was read from.
    """

    file: str
    sha256: str
    grid_sha256: str
    grid: Grid
    uncertainty_file: str = ""
    uncertainty_sha256: str = ""
    uncertainty: Grid | None = None
    path: Path | None = None

    @property
    def title(self) -> Text:
        """The earthquake in words."""
        event = self.grid.event
        name = event.get("event_description") or self.grid.event_id or self.file
        if magnitude := event.get("magnitude", ""):
            return fill("{name}, magnitude {magnitude}", name=name, magnitude=magnitude)
        return fill("{name}", name=name)

    def at(self, latitude: float, longitude: float) -> SiteGround:
        """Return the shaking at a place [deg]; InputError if the grid does not cover it, or has no PGA there."""
        with naming(self.file):
            read = self.grid.locate(latitude, longitude)
            pga = read("PGA", logarithmic=True)
            if math.isnan(pga):
                place = _describe_place(latitude, longitude)
                raise InputError.about("the PGA of the map is 0 or not a number (NaN) at {place}", place=place)
        extra = None
        if self.uncertainty is not None:
            with suppress(InputError):  # it does not reach there
                extra = self.uncertainty.locate(latitude, longitude)
        pgv = read("PGV", logarithmic=True) / 100
        psa = ((period, read(name, logarithmic=True) * GRAVITY / 100) for name, period in self.grid.psa.items())
        sigma, source, shared = self._find_sigma("PGA" if math.isnan(pgv) else "PGV", read, extra)
        header, event, its_file = self.grid.header, self.grid.event, self.uncertainty_file
        version = join(", ", [text for text in (header.get("shakemap_version"), header.get("code_version")) if text])
        cited = fill("{file}, SHA-256 {sha256}", file=its_file, sha256=self.uncertainty_sha256) if its_file else ""
        listed = (
            (fill("Earthquake"), self.title),
            (fill("Time of the earthquake"), event.get("event_timestamp", "")),
            (fill("Event ID"), self.grid.event_id),
            (fill("Status of the map"), header.get("map_status", "")),
            (fill("Kind of event"), header.get("shakemap_event_type", "")),
            (fill("Version of the map, version of ShakeMap"), version),
            (fill("Map computed"), header.get("process_timestamp", "")),
            (fill("File of uncertainties"), cited),
        )
        facts = [(label, fill("{text}", text=text)) for label, text in listed if text]
        if (speed := read("SVEL", logarithmic=True)) > 0:
            value = fill("{speed:.0f} m/s; its effect is in the map and is not applied again", speed=speed)
            facts.append((fill("Vs30 of the map at the building"), value))
        return SiteGround(
            kind="shakemap", file=self.file, sha256=self.grid_sha256, pga=pga * GRAVITY / 100,
            pgv=None if math.isnan(pgv) else pgv,
            psa=tuple((period, value) for period, value in psa if not math.isnan(value)),
            dispersion=sigma, dispersion_source=source, shared=shared,
            facts=tuple(facts), cautions=tuple(self._list_cautions(read)),
        )  # fmt: skip

    def _find_sigma(self, measure: Measure, read: _Reading, extra: _Reading | None) -> tuple[float, Text, float | None]:
        """Return the standard deviation of ln of a peak [-], where it comes from, and its share common to all places.

        That of PGA stands in for that of PGV: both are small near a station, and far from one alike.
        """
        shared = None
        if extra:
            for own in ("PGA", measure):
                between, within = (extra(f"GMPE_{part}_STD{own}") ** 2 for part in ("INTER", "INTRA"))
                shared = between / (between + within) if between + within > 0 else shared
        why = fill("the map has none at this place")
        for name in dict.fromkeys((f"STD{measure}", "STDPGA")):
            for reading, file in ((read, self.file), (extra, self.uncertainty_file)):
                sigma = reading(name) if reading else math.nan
                if sigma == 0 and reading and not (reading.fields[name] > 0).any():
                    why = fill("the map's {name} is 0 everywhere", name=name)
                elif not math.isnan(sigma):
                    return sigma, fill("{name} of {file}", name=name, file=file), shared
        magnitude = math.inf  # where it is not known
        with suppress(ValueError):
            magnitude = float(self.grid.event.get("magnitude", ""))
        magnitude = magnitude if math.isfinite(magnitude) else math.inf
        between, within = SCATTERS[measure].at(magnitude)
        source = fill("assumed, as {why}: the total of Boore et al. 2014 for this magnitude", why=why)
        if magnitude >= MAGNITUDES[1]:
            source = fill("assumed, as {why}: the total of Boore et al. 2014 for magnitude 5.5 or more", why=why)
        return math.hypot(between, within), source, between**2 / (between**2 + within**2)

    def _list_cautions(self, read: _Reading) -> Iterator[Text]:
        status = self.grid.header.get("map_status", "").upper()
        if status == "AUTOMATIC":
            yield fill("the ShakeMap is AUTOMATIC: nobody had reviewed it when it was computed; a later one may differ")
        if status in ("CANCELLED", "CANCELED"):
            yield fill("the ShakeMap is marked as {status}: its maker has withdrawn it", status=status)
        missing = [name for name in read.fields if math.isnan(read(name))]
        gaps = _count_gaps(self.grid)
        if missing:
            yield fill(
                "the ShakeMap holds no value (NaN) of {fields} next to the building: it is taken as not known there",
                fields=join(", ", missing),
            )
        elif gaps:
            yield nfill(
                "{n:,} point of the ShakeMap's grid holds no value (NaN); it is not next to the building",
                "{n:,} points of the ShakeMap's grid hold no value (NaN); none of them is next to the building",
                gaps,
            )

    def __reduce__(self) -> tuple[Any, ...]:
        if self.path is not None:
            return read_again, (read_shakemap, self.path, self.sha256)
        kept = {name: getattr(self, name) for name in self.__dataclass_fields__}
        return partial(ShakeMap, **kept), ()


# ---------------------------------------------------------------- files


read_file = partial(read_ground_file, most=LARGEST_FILE)
"""Returns the bytes of a file; InputError if it cannot be read."""


def name_uncertainty(name: str) -> tuple[str, ...]:
    """Return how the file of uncertainties beside a grid may be called, the name of the grid given."""
    renamed = re.sub("grid", "uncertainty", name, count=1, flags=re.IGNORECASE)
    return tuple(one for one in dict.fromkeys((renamed, "uncertainty.xml")) if one != name)


def read_shakemap(path: Path) -> ShakeMap:
    """Read the map of a grid.xml, with the uncertainty.xml in its folder; InputError as of `parse_shakemap`."""
    path = path.resolve()
    extra = next((one for name in name_uncertainty(path.name) if (one := path.with_name(name)).is_file()), None)
    own = {} if extra is None else {"uncertainty": read_file(extra), "uncertainty_name": extra.name}
    return parse_shakemap(read_file(path), path.name, path=path, **own)  # type: ignore[arg-type]


def parse_shakemap(
    data: bytes, name: str, *, uncertainty: bytes | None = None, uncertainty_name: str = "", path: Path | None = None
) -> ShakeMap:
    """Return the map of the bytes of a grid.xml, and of an uncertainty.xml; names are how messages call them.

    Raises InputError if one is not such a file, is damaged or cut off, lacks PGA, has an unknown unit, or holds a
    number that is impossible; if the two are of different earthquakes.
    """
    with naming(name):
        grid = _read_grid(data)
    digest = hashlib.sha256(data).hexdigest()
    found = ShakeMap(file=name, sha256=digest, grid_sha256=digest, grid=grid, path=path)
    if uncertainty is None:
        return found
    try:
        with naming(uncertainty_name if path is None else str(path.with_name(uncertainty_name))):
            extra = _parse_grid(uncertainty)
            if extra.event_id != grid.event_id:
                raise InputError.about(
                    "it is of the event {other!r}, but the grid of {own!r}: name the right grid",
                    own=grid.event_id, other=extra.event_id,
                )  # fmt: skip
            extra.check_sigmas(SIGMAS | PARTS)
    except InputError as error:
        way = fill(
            "You can remove the file: the STDPGV or STDPGA of {grid} is then used, or an assumed one where it has none",
            grid=name,
        )
        raise InputError(join(". ", (error.message, way))) from None
    its = hashlib.sha256(uncertainty).hexdigest()
    return replace(
        found, sha256=hashlib.sha256((digest + its).encode()).hexdigest(), uncertainty_file=uncertainty_name,
        uncertainty_sha256=its, uncertainty=extra.keep(SIGMAS | PARTS),
    )  # fmt: skip


@lru_cache(maxsize=2)  # workbooks of one folder name the same map
def _read_grid(data: bytes) -> Grid:
    grid = _parse_grid(data)
    if "PGA" not in grid.fields:
        raise InputError.about("the field PGA is missing: give the file grid.xml of a ShakeMap")
    for name in ("PGA", *grid.psa):
        grid.check(name, *_PER_CENT_G, (100 if name == "PGA" else 300) * LARGEST_PGA / GRAVITY)
    if "PGV" in grid.fields:
        grid.check("PGV", *_CM_PER_S, 100 * LARGEST_PGV)
    grid.check_sigmas(SIGMAS)
    return grid.keep({"PGA", "PGV", *SIGMAS, "SVEL", *grid.psa})


# ---------------------------------------------------------------- the XML of a grid

_HINT = fill("Download grid.xml from the products of the event's ShakeMap at earthquake.usgs.gov")


def _parse_grid(data: bytes) -> Grid:
    if len(data) > LARGEST_FILE:
        raise InputError.about("the file is larger than {most:.0f} MB", most=LARGEST_FILE / 1e6)
    if not data.strip():
        raise InputError.about("the file is empty")
    if data.startswith(_FOREIGN):
        raise InputError.about("the file is not XML. {hint}", hint=_HINT)
    reader = _Reader()
    try:
        reader.parser.Parse(data, True)
    except (expat.ExpatError, ValueError, LookupError) as error:  # an encoding that is not known
        line = getattr(error, "lineno", None)
        if not reader.found:
            raise InputError.about("the file is not the XML of a ShakeMap. {hint}", hint=_HINT) from None
        if line is None:
            raise InputError.about("the XML cannot be read. Download it again") from None
        raise InputError.about("line {line}: the XML is damaged or cut off. Download it again", line=line) from None
    for name in ("event", "grid_specification", "grid_data"):
        if name not in reader.found:
            raise InputError.about("the element {name} is missing", name=name)
    return _build(reader)


class _Reader:
    """Takes in the elements of a grid.xml; everything else of the file is left out."""

    def __init__(self) -> None:
        self.parser = expat.ParserCreate()
        self.parser.buffer_text, self.parser.buffer_size = True, 500_000
        self.parser.StartElementHandler, self.parser.EndElementHandler = self._enter, self._leave
        self.parser.EntityDeclHandler = self._refuse
        self.found: dict[str, dict[str, str]] = {}
        self.names: list[tuple[str, str, str]] = []
        self.texts: list[str] = []
        self._elements = 0

    def _enter(self, tag: str, attributes: dict[str, str]) -> None:
        name, self._elements = tag.rpartition(":")[2], self._elements + 1
        if self._elements == 1 and name != "shakemap_grid":
            raise InputError.about(
                "its first element is {name}, expected shakemap_grid. {hint}", name=_shorten(name), hint=_HINT
            )
        if self._elements > MOST_ELEMENTS:
            raise InputError.about("the file has more than {most:,} elements", most=MOST_ELEMENTS)
        clean = {key: _shorten(value) for key, value in attributes.items()}
        if name == "grid_field":
            self.names.append((clean.get("index", ""), clean.get("name", ""), clean.get("units", "")))
        elif name in self.found:
            raise InputError.about("the element {name} is there twice", name=name)
        elif name in ("shakemap_grid", "event", "grid_specification", "grid_data"):
            self.found[name] = clean
        self.parser.CharacterDataHandler = self.texts.append if name == "grid_data" else None

    def _leave(self, _tag: str) -> None:
        self.parser.CharacterDataHandler = None

    def _refuse(self, *_: object) -> None:
        raise InputError.about("the file declares XML entities, which no ShakeMap does. {hint}", hint=_HINT)


def _shorten(text: str) -> str:
    return plain_text(" ".join(text.split()))[:_LONGEST]


def _build(reader: _Reader) -> Grid:
    if len(reader.names) > MOST_FIELDS:
        raise InputError.about("the file has more than {most} fields", most=MOST_FIELDS)
    if sorted(index for index, *_ in reader.names) != sorted(str(at + 1) for at in range(len(reader.names))):
        raise InputError.about("the fields (grid_field) are not numbered from 1 on, each once")
    units: dict[str, str] = {}  # by the names of the fields, in the order of their columns
    for _, name, unit in sorted(reader.names, key=lambda one: int(one[0])):
        if name.upper() in units:
            raise InputError.about("the field {name} is there twice", name=name.upper())
        units[name.upper()] = unit
    for name in ("LON", "LAT"):
        if name not in units:
            raise InputError.about("the field {name} is missing", name=name)
    counts = []
    for name in ("nlon", "nlat"):
        text = reader.found["grid_specification"].get(name, "")
        if not (text.isascii() and text.isdigit() and len(text) < 20 and int(text) > 1):
            raise InputError.about("grid_specification: {name} is {text!r}, expected 2 or more", name=name, text=text)
        counts.append(int(text))
    columns, rows = counts
    if columns * rows > MOST_POINTS:
        raise InputError.about(
            "grid_specification: {columns:,} x {rows:,} points are more than {most:,}",
            columns=columns, rows=rows, most=MOST_POINTS,
        )  # fmt: skip
    fields = dict(zip(units, _read_numbers(reader.texts, len(units), rows * columns).T, strict=True))
    latitudes, longitudes = fields.pop("LAT"), fields.pop("LON")
    is_place = (np.abs(latitudes) <= 90) & (np.abs(longitudes) <= 540)
    if not is_place.all():
        row = int((~is_place).argmax())
        places = {"lat": float(latitudes[row]), "lon": float(longitudes[row])}
        raise InputError.about(
            "grid_data, row {row:,}: LON {lon:g} and LAT {lat:g} are not a place on earth", row=row + 1, **places
        )
    if np.ptp(longitudes) > 180:  # beyond the date line they go on rising
        eastern = np.where(longitudes < 0, longitudes + 360, longitudes)
        longitudes = eastern if np.ptp(eastern) < np.ptp(longitudes) else longitudes
    order = np.lexsort((longitudes, latitudes))  # of rising latitudes and longitudes
    north, east = (values[order].reshape(rows, columns) for values in (latitudes, longitudes))
    is_regular = bool((north == north[:, :1]).all() and (east == east[:1]).all())
    for values in (north[:, 0], east[0]):  # printed with four decimals
        step = float(values[-1] - values[0]) / (values.size - 1)
        is_regular &= step > 0 and bool((np.abs(np.diff(values) - step) <= 2e-4 + 0.01 * step).all())
    if not is_regular:
        raise InputError.about("LON and LAT are not those of a regular grid of nlon x nlat points")
    return Grid(
        reader.found["shakemap_grid"], reader.found["event"], north[:, 0].copy(), east[0].copy(),
        {name: values[order].reshape(rows, columns) for name, values in fields.items()}, units,
    )  # fmt: skip


def _read_numbers(texts: Sequence[str], width: int, rows: int) -> FloatArray:
    """Return the numbers of the grid, (rows, width), text by text, so that few are words at a time."""
    found, at, rest = np.empty(rows * width), 0, ""
    for text in (*texts, " "):
        if len(rest) > _LONGEST or "_" in text or not text.isascii():
            raise InputError.about("grid_data holds something that is not a number")
        cells = (rest + text).split()
        rest = cells.pop() if cells and not text[-1].isspace() else ""  # it goes on in the next text
        if at + len(cells) > found.size:
            raise InputError.about("there are more than {rows:,} rows, which nlon x nlat gives", rows=rows)
        try:
            found[at : at + len(cells)] = np.fromiter(map(float, cells), dtype=float, count=len(cells))
        except ValueError:
            bad = find_no_number(cells)
            row, column = divmod(at + bad, width)
            raise InputError.about(
                "grid_data, row {row:,}: number {column} is {text!r}, which is not a number",
                row=row + 1, column=column + 1, text=_shorten(cells[bad])[:40],
            ) from None  # fmt: skip
        at += len(cells)
    if at < found.size:
        raise InputError.about(
            "there are {found:,} whole rows of {width} numbers, expected {rows:,} (nlon x nlat): the file is cut off "
            "or damaged. Download it again",
            found=at // width, width=width, rows=rows,
        )  # fmt: skip
    return found.reshape(rows, width)
