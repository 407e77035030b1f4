"""A hazard curve: how often a year the ground's peak acceleration is exceeded at a site.

Two kinds of files are read: a table with the columns ``pga_g,annual_rate``, and ``hazard_curve-mean-PGA.csv`` as the
OpenQuake Engine writes it, with a row for each site.
"""

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from assess.arrays import FloatArray
from assess.errors import InputError
from assess.i18n import Text, fill, join, nfill
from assess.motion.formats.plain_csv import decode, is_comment
from assess.resources import read_input
from assess.text import split_text
from assess.units import GRAVITY

COLUMNS = ("pga_g", "annual_rate")
SHORTEST_TIME, LONGEST_TIME = 0.01, 1e6  # span of the time for which chances of exceedance hold [years]
LARGEST_FILE = 64_000_000  # bytes; a curve takes some hundreds, a national map of sites some millions
MOST_CELLS = 1_500_000  # cells, and ends of lines: 50,000 sites of 28 levels
MOST_PGA = 50.0  # peaks above this [g] are a slip in the unit
FAR = 10_000.0  # distance from the site of the curve [m] above which it is remarked on
EARTH = 6_371_000.0  # mean radius of the earth [m]

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE | re.ASCII)
_LEVEL = re.compile(r"poe-(\S+)", re.IGNORECASE)
_TIME = re.compile(r"investigation_time\s*=\s*['\"]?([^,'\"\s]+)")
_IMT = re.compile(r"\bimt\s*=\s*['\"]?([^,'\"]+)")
_KIND = re.compile(r"\bkind\s*=\s*['\"]?([^,'\"]+)")

Line = tuple[int, list[str]]  # the number of a line, from 1 on, and its cells


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HazardCurve:
    """Annual rates at which peak ground accelerations are exceeded at a site.

    * `pga`, `rate` (n,): rising accelerations [m/s2] and how often each is exceeded [1/year], above 0, nowhere rising.
    * `latitude`, `longitude`, `distance`: of its site [deg], and from there to the building [m], as far as known.
    * `notes`: what reading left out or found unusual.
    """

    file: str
    pga: FloatArray
    rate: FloatArray
    latitude: float | None = None
    longitude: float | None = None
    distance: float | None = None
    notes: tuple[Text, ...] = ()

    @property
    def is_far(self) -> bool:
        """Whether its site is farther from the building than `FAR`."""
        return self.distance is not None and self.distance > FAR

    @property
    def remarks(self) -> tuple[Text, ...]:
        """What a reader has to know of it: its notes, and whether its site is far."""
        if self.distance is None or not self.is_far:
            return self.notes
        far = fill("the site of the hazard curve is {km:.0f} km from the building", km=self.distance / 1000)
        return (*self.notes, far)


def read_bytes(path: Path) -> bytes:
    """Return the bytes of a file, but no more than show that it is too large; InputError if it cannot be read."""
    try:
        return read_input(path, LARGEST_FILE)
    except (OSError, ValueError) as error:  # ValueError: a zero character in the name
        why = getattr(error, "strerror", None) or str(error)
        raise InputError(fill("{file}: the file cannot be read ({why})", file=path.name, why=why)) from None


def parse_hazard(
    data: bytes, name: str, *, latitude: float | None = None, longitude: float | None = None
) -> HazardCurve:
    """Read a hazard curve from the bytes of a file; `name` is how messages call it.

    The file is a table ``pga_g,annual_rate``, or one of OpenQuake; cells are separated by commas, semicolons or tabs,
    with the last two also with decimal commas. Of several sites the nearest to the building [deg] is taken. A chance P
    in T years becomes the rate -ln(1 - P)/T.

    Raises InputError, with file and line, if it is no such file, a number is damaged or impossible, rates rise with
    PGA, fewer than two points remain, or there are several sites and the building's place is not known.
    """
    try:
        if len(data) > LARGEST_FILE:
            raise InputError(fill("the file is larger than {most:.0f} MB", most=LARGEST_FILE / 1e6))
        if sum(data.count(mark) for mark in (b",", b";", b"\t", b"\n", b"\r")) > MOST_CELLS:
            text = fill("the file has more than {most:,} cells: cut it to the sites near the building", most=MOST_CELLS)
            raise InputError(text)
        if b"\0" in data or data.startswith((b"PK", b"\xff\xfe", b"\xfe\xff")):
            raise InputError(fill("the file is not plain text. Save it as CSV UTF-8"))
        lines = split_text(decode(data))
        rows = list(_split(lines))
        if not rows:
            raise InputError(fill("there is no table. Its first row has to be: {columns}", columns=",".join(COLUMNS)))
        heading = [cell.lower() for cell in rows[0][1]]
        if {"lon", "lat"} <= set(heading):
            comments = "\n".join(line for line in lines if is_comment(line))
            return _read_sites(name, heading, rows, comments, latitude, longitude)
        return _read_table(name, heading, rows, is_ended=not lines[-1].strip())
    except InputError as error:
        raise InputError(join(": ", (name, error.message))) from None


def find_distance(latitude: float, longitude: float, latitudes: FloatArray, longitudes: FloatArray) -> FloatArray:
    """Return great-circle distances [m] from a place to others [deg], (n,)."""
    phi, others = math.radians(latitude), np.radians(latitudes)
    half = np.sin((others - phi) / 2) ** 2
    half += math.cos(phi) * np.cos(others) * np.sin(np.radians(longitudes - longitude) / 2) ** 2
    return np.asarray(2 * EARTH * np.arcsin(np.sqrt(np.minimum(half, 1))))


def _split(lines: Sequence[str]) -> Iterator[Line]:
    separator = ""
    for number, line in enumerate(lines, 1):
        if is_comment(line) or not line.strip(' \t,;"'):
            continue
        separator = separator or next((mark for mark in "\t;" if mark in line), ",")
        cells = [cell.strip().strip('"').strip() for cell in line.split(separator)]
        if separator != ",":
            cells = [cell.replace(",", ".") for cell in cells]
        while cells and not cells[-1]:
            cells.pop()
        yield number, cells


def _read_number(text: str, line: int, column: str) -> float:
    value = float(text) if _NUMBER.fullmatch(text) else math.nan
    if not math.isfinite(value):
        message = fill("line {line}: {column} is {text!r}, not a number", line=line, column=column[:40], text=text[:40])
        raise InputError(message)
    return value


def _read_table(name: str, heading: Sequence[str], rows: Sequence[Line], *, is_ended: bool) -> HazardCurve:
    if sorted(heading) != sorted(COLUMNS):
        raise InputError(fill(
            "line {line}: the first row has to be {columns}, or that of hazard_curve-mean-PGA.csv of OpenQuake",
            line=rows[0][0], columns=",".join(COLUMNS),
        ))  # fmt: skip
    places = [heading.index(column) for column in COLUMNS]
    points = []
    for line, cells in rows[1:]:
        if len(cells) != len(COLUMNS):
            raise InputError(fill("line {line}: the number of cells is {cells}, not 2", line=line, cells=len(cells)))
        points.append([_read_number(cells[place], line, heading[place]) for place in places])
    numbers = [line for line, _ in rows[1:]]
    if len(points) < 2:
        raise InputError(fill("the number of rows is {rows}: a curve needs two or more", rows=len(points)))
    for line, (pga, rate) in zip(numbers, points, strict=True):
        if not 0 < pga <= MOST_PGA:
            raise InputError(fill(
                "line {line}: pga_g is {pga:g}, expected above 0 and at most {most:g}, in g",
                line=line, pga=pga, most=MOST_PGA,
            ))  # fmt: skip
        if not rate > 0:
            raise InputError(fill("line {line}: annual_rate is {rate:g}, expected above 0", line=line, rate=rate))
    for line, (before, after) in zip(numbers[1:], pairwise(points), strict=True):
        if not after[0] > before[0]:
            raise InputError(fill(
                "line {line}: pga_g {pga:g} does not rise from {before:g} in the row before",
                line=line, pga=after[0], before=before[0],
            ))  # fmt: skip
        if after[1] > before[1]:
            raise InputError(fill(
                "line {line}: annual_rate rises from {before:g} to {rate:g}, but it has to fall as PGA rises: give "
                "rates, not return periods",
                line=line, before=before[1], rate=after[1],
            ))  # fmt: skip
    if points[0][1] == points[-1][1]:
        raise InputError(fill("the annual rate is the same in every row: it has to fall as PGA rises"))
    notes = () if is_ended else (_NO_END,)
    peaks, rates = np.array(points).T
    return HazardCurve(file=name, pga=peaks * GRAVITY, rate=rates, notes=notes)


_NO_END = fill("the last line of the hazard file has no end: see that its last rate is whole, and no row is missing")
"""A number that is cut off is a smaller number; programs end their last line, people may not."""


def _read_sites(
    name: str, heading: Sequence[str], rows: Sequence[Line], comments: str, latitude: float | None,
    longitude: float | None,
) -> HazardCurve:  # fmt: skip
    imt, time, kind = (pattern.search(comments) for pattern in (_IMT, _TIME, _KIND))
    if imt is not None and imt[1].strip() != "PGA":
        raise InputError(fill("the curve is of {imt}, expected PGA", imt=imt[1].strip()[:40]))
    text = "" if time is None else time[1]
    years = float(text) if _NUMBER.fullmatch(text) else math.nan
    if not 0 < years < math.inf:
        raise InputError(fill("the first line has no investigation_time above 0, in years"))
    if not SHORTEST_TIME <= years <= LONGEST_TIME:
        raise InputError(fill(
            "investigation_time is {years:g}, expected {least:g} to {most:g} years",
            years=years, least=SHORTEST_TIME, most=LONGEST_TIME,
        ))  # fmt: skip
    of = "mean" if kind is None else kind[1].strip()
    notes = [] if of == "mean" else [fill("the curve is {kind!r}, not the mean", kind=of[:40])]
    found = [(place, _LEVEL.fullmatch(cell)) for place, cell in enumerate(heading)]
    places = [place for place, match in found if match]
    levels = np.array([_read_number(match[1], rows[0][0], heading[place]) for place, match in found if match])
    if levels.size < 2 or not (levels > 0).all() or not (np.diff(levels) > 0).all() or levels[-1] > MOST_PGA:
        raise InputError(
            fill("line {line}: expected two or more columns poe-LEVEL with rising levels in g", line=rows[0][0])
        )
    (line, cells), site, distance = _choose_site(heading, rows[1:], latitude, longitude)
    chances = np.array([_read_number(cells[place], line, heading[place]) for place in places])
    for level, chance in zip(levels, chances, strict=True):
        if not 0 <= chance <= 1:
            raise InputError(fill(
                "line {line}: the chance of exceeding {level:g} g is {chance:g}, expected 0 to 1",
                line=line, level=float(level), chance=float(chance),
            ))  # fmt: skip
    rises = np.flatnonzero(np.diff(chances) > 0)
    if rises.size:
        raise InputError(fill(
            "line {line}: the chance of exceeding {level:g} g is larger than that of the level before",
            line=line, level=float(levels[rises[0] + 1]),
        ))  # fmt: skip
    known = (chances > 0) & (chances < 1)
    left_out = int((~known).sum())
    if known.sum() < 2:
        raise InputError(fill("line {line}: fewer than two chances are between 0 and 1", line=line))
    if left_out:
        notes.append(nfill("{n} level whose chance is 0 or 1 was left out",
                           "{n} levels whose chance is 0 or 1 were left out", left_out))  # fmt: skip
    return HazardCurve(
        file=name, pga=levels[known] * GRAVITY, rate=-np.log1p(-chances[known]) / years, latitude=site[0],
        longitude=site[1], distance=distance, notes=tuple(notes),
    )  # fmt: skip


def _choose_site(
    heading: Sequence[str], rows: Sequence[Line], latitude: float | None, longitude: float | None
) -> tuple[Line, tuple[float, float], float | None]:
    if not rows:
        raise InputError(fill("there are no sites below the headings"))
    sites = []
    for line, cells in rows:
        if len(cells) != len(heading):
            raise InputError(fill(
                "line {line}: the number of cells is {cells}, but there are {headings} headings",
                line=line, cells=len(cells), headings=len(heading),
            ))  # fmt: skip
        lat, lon = (_read_number(cells[heading.index(column)], line, column) for column in ("lat", "lon"))
        if abs(lat) > 90 or abs(lon) > 360:
            raise InputError(
                fill("line {line}: lon {lon:g} and lat {lat:g} are not a place on earth", line=line, lon=lon, lat=lat)
            )
        sites.append((lat, lon))
    if latitude is None or longitude is None:
        if len(rows) > 1:
            raise InputError(
                fill("the file has {count} sites: the building's latitude and longitude are needed", count=len(rows))
            )
        return rows[0], sites[0], None
    distances = find_distance(latitude, longitude, *np.array(sites).T)
    nearest = int(distances.argmin())
    return rows[nearest], sites[nearest], float(distances[nearest])
