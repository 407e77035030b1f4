"""How the ground shakes in many computed scenarios of an earthquake: ground-motion fields of the OpenQuake Engine.

A folder holds ``gmf-data.csv`` (``site_id`` or ``custom_site_id``, ``event_id``, ``gmv_PGA`` [g], and others such as
``gmv_PGV`` [cm/s] and ``gmv_SA(1.0)`` [g]) and ``sitemesh.csv`` or ``sites.csv`` (the same name of a site, ``lon``,
``lat`` [deg]). Lines that begin with # are comments. A building takes the values of the nearest site: the median is
exp of the mean of ln over the events. Each event is a scenario, with its ln PGV, or ln PGA where there is no PGV; the
dispersion is their standard deviation.

The engine leaves out an event at a site where its motion is below a minimum. The scenarios of such a site would be too
strong together, and are refused.

Reference: Pagani M et al. (2014). OpenQuake Engine: an open hazard (and risk) software for the Global Earthquake Model.
Seismological Research Letters 85(3):692-702. doi:10.1785/0220130087
"""

import csv
import hashlib
import io
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.arrays import FloatArray
from assess.errors import InputError
from assess.hazard import FAR, find_distance
from assess.i18n import fill, nfill
from assess.motion.site_ground import SiteGround, find_no_number, naming, read_again, read_ground_file
from assess.units import GRAVITY

VALUES = "gmf-data.csv"
SITES = ("sitemesh.csv", "sites.csv")
LARGEST_FILE = 256_000_000
"""Bytes; a million rows of one measure take about 30 million."""
MOST_ROWS = 5_000_000
MOST_COLUMNS = 50
MOST_HEAD = 100_000
"""Characters of the comments and the headings."""
FARTHEST = 50_000.0
"""Scenarios whose nearest site is farther from a building than this [m] do not cover it."""
FAR_CAUTION = "the nearest site of the scenarios is {km:.0f} km from the building"
LARGEST_PGA = 10.0
"""Accelerations above this [g] are a slip in the unit; 5 % damped spectra may be three times it."""
LARGEST_PGV = 1000.0
"""Velocities above this [cm/s] are a slip in the unit."""
_SA = re.compile(r"gmv_SA\((\d{1,3}(?:\.\d{1,6})?)\)", re.ASCII)
_TEXT = "custom_site_id"
_KEYS = ("site_id", _TEXT)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GroundScenarios:
    """Computed scenarios of the ground motion; it pickles as its folder and hash, and is read again, once a process.

    * `file`, `sites_file`: names of the files of the values and of the sites; `path` is their folder.
    * `hashes`: of the two; `sha256` is that of both.
    * `latitude`, `longitude` (n,): of the sites [deg].
    * `start` (n + 1,): rows of `values` of each site: those of the i-th from ``start[i]`` to ``start[i + 1]``.
    * `values` (rows, measures): by the order of `measures` [g, cm/s]; within a site by event.
    * `measures`: names of the columns: gmv_PGA first.
    * `event_count`: events that have a value anywhere.
    """

    file: str
    sha256: str
    sites_file: str
    hashes: tuple[str, str]
    path: Path
    latitude: FloatArray
    longitude: FloatArray
    start: NDArray[np.intp]
    values: FloatArray
    measures: tuple[str, ...]
    event_count: int

    def at(self, latitude: float, longitude: float) -> SiteGround:
        """Return the motion at the site nearest to a place [deg]; InputError if it is too far, or lacks events."""
        distances = find_distance(latitude, longitude, self.latitude, self.longitude)
        nearest = int(distances.argmin())
        distance = float(distances[nearest])
        if not distance <= FARTHEST:
            raise InputError.about(
                "{file}: the scenarios do not cover latitude {lat:.4f}, longitude {lon:.4f}: their nearest site is "
                "{km:,.0f} km away, expected at most {most:.0f} km. Check Latitude and Longitude, or compute the "
                "fields for sites near the building",
                file=self.file, lat=latitude, lon=longitude, km=distance / 1000, most=FARTHEST / 1000,
            )  # fmt: skip
        first, end = self.start[nearest : nearest + 2].tolist()
        if end - first < self.event_count:
            raise InputError.about(
                "{file}: the site at latitude {lat:.4f}, longitude {lon:.4f}, nearest to the building, has {count} "
                "of {events} events: the others lie below the engine's minimum. Compute the fields with "
                "minimum_intensity 0",
                file=self.file, count=end - first, events=self.event_count,
                lat=float(self.latitude[nearest]), lon=float(self.longitude[nearest]),
            )  # fmt: skip
        logs = np.log(self.values[first:end])
        medians = dict(zip(self.measures, np.exp(logs.mean(axis=0)).tolist(), strict=True))
        ruling = logs[:, self.measures.index("gmv_PGV") if "gmv_PGV" in medians else 0]
        dispersion = float(ruling.std()) if len(logs) > 1 else 0.0
        dispersion = dispersion if dispersion > 1e-9 else 0.0
        numbers = (ruling - ruling.mean()) / dispersion if dispersion else np.zeros(len(logs))
        cautions = [fill(FAR_CAUTION, km=distance / 1000)] if distance > FAR else []
        if not dispersion:
            cautions.append(
                fill(
                    "the scenarios do not differ at the building: the motion of the ground is taken as known, so that "
                    "ranges leave out how much it varies from one earthquake like this one to the next"
                )
            )
        return SiteGround(
            kind="scenarios", file=self.file, sha256=self.hashes[0], pga=medians["gmv_PGA"] * GRAVITY,
            pgv=medians["gmv_PGV"] / 100 if "gmv_PGV" in medians else None,
            psa=tuple((period, medians[name] * GRAVITY) for name, period in _list_psa(self.measures)),
            dispersion=dispersion, distance=distance, scenarios=tuple(numbers.tolist()), cautions=tuple(cautions),
            dispersion_source=nfill(
                "{file} holds {n:,} scenario alone", "standard deviation of {n:,} scenarios of {file}", len(logs),
                file=self.file,
            ),
            facts=(
                (fill("Scenarios"), nfill("{n:,} event", "{n:,} events", len(logs))),
                (fill("Distance to the nearest site"), fill("{km:.1f} km", km=distance / 1000)),
                (fill("File of sites"), fill("{file}, SHA-256 {sha256}", file=self.sites_file, sha256=self.hashes[1])),
            ),
        )  # fmt: skip

    def __reduce__(self) -> tuple[Any, ...]:
        return read_again, (read_scenarios, self.path, self.sha256)


def _list_psa(measures: Sequence[str]) -> list[tuple[str, float]]:
    """Return the columns of spectral acceleration with their periods [s], rising."""
    found = ((name, match) for name in measures if (match := _SA.fullmatch(name)))
    return sorted(((name, float(match[1])) for name, match in found), key=lambda one: one[1])


def read_scenarios(folder: Path) -> GroundScenarios:
    """Read the scenarios of a folder.

    Raises InputError if a file is missing, cut off or another one, or a number is impossible; it names file and line.
    """
    folder = folder.resolve()
    sites_file = next((name for name in SITES if (folder / name).is_file()), None)
    if sites_file is None or not (folder / VALUES).is_file():
        missing = " or ".join(SITES) if (folder / VALUES).is_file() else VALUES
        raise InputError.about("{folder}: the folder has no {file}", folder=folder.name, file=missing)
    texts: dict[str, int] = {}
    sites, data = (_read_table(folder / name, texts) for name in (sites_file, VALUES))
    with naming(VALUES):
        key = next((name for name in _KEYS if name in data.columns and name in sites.columns), None)
        if key is None:
            fault = "neither site_id nor custom_site_id is a column of both this file and {file}: one of them has to be"
            raise InputError.about(fault, file=sites_file)
        data.require("event_id", "gmv_PGA")
        pgv = ("gmv_PGV",) if "gmv_PGV" in data.columns else ()
        measures = ("gmv_PGA", *pgv, *(name for name, _ in _list_psa([*data.columns])))
        for name in measures:
            most = LARGEST_PGV if name == "gmv_PGV" else LARGEST_PGA if name == "gmv_PGA" else 3 * LARGEST_PGA
            values = data.columns[name]
            if (line := data.find_bad((values > 0) & (values <= most))) is not None:
                raise InputError.about(
                    "line {line}: {name} is {value:g}, expected above 0 and at most {most:g} {unit}",
                    line=data.lines[line], name=name, value=float(values[line]), most=most,
                    unit="cm/s" if name == "gmv_PGV" else "g",
                )  # fmt: skip
    with naming(sites_file):
        names, latitude, longitude = _read_sites(sites, key)
    with naming(VALUES):
        events, own = data.columns["event_id"], data.columns[key]
        is_whole = np.isfinite(events) & (np.abs(events) < 2**53) & (events == np.floor(events))
        if (line := data.find_bad(is_whole)) is not None:
            raise InputError.about("line {line}: event_id has to be a whole number", line=data.lines[line])
        at = np.searchsorted(names, own)
        if (line := data.find_bad(names[np.minimum(at, names.size - 1)] == own)) is not None:
            raise InputError.about(
                "line {line}: its {key} is not in {file}", line=data.lines[line], key=key, file=sites_file
            )
        order = np.lexsort((events, at))
        at, events = at[order], events[order].astype(np.int64)
        again = (np.diff(at) == 0) & (np.diff(events) == 0)
        if again.any():
            raise InputError.about("event {event} is there twice at a site", event=int(events[int(again.argmax())]))
    hashes = data.sha256, sites.sha256
    return GroundScenarios(
        file=VALUES, sha256=hashlib.sha256("".join(hashes).encode()).hexdigest(), sites_file=sites_file, hashes=hashes,
        path=folder, latitude=latitude, longitude=longitude, start=np.searchsorted(at, np.arange(len(names) + 1)),
        values=np.column_stack([data.columns[name][order] for name in measures]), measures=measures,
        event_count=int(np.unique(events).size),
    )  # fmt: skip


def _read_sites(sites: "_Table", key: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the numbers of the sites, rising, with latitude and longitude [deg]."""
    sites.require("lon", "lat")
    names, latitude, longitude = (sites.columns[name] for name in (key, "lat", "lon"))
    if (line := sites.find_bad((np.abs(latitude) <= 90) & (np.abs(longitude) <= 360))) is not None:
        raise InputError.about("line {line}: lon and lat are not a place on earth", line=sites.lines[line])
    if np.unique(names).size < names.size:
        raise InputError.about("a {key} is there twice", key=key)
    rising = np.argsort(names)
    return names[rising], latitude[rising], longitude[rising]


@dataclass(frozen=True, slots=True, eq=False)
class _Table:
    """A CSV file: its columns of numbers (rows,) by their headings, and the numbers of the lines of its rows."""

    columns: Mapping[str, FloatArray]
    lines: Sequence[int]
    sha256: str

    def require(self, *names: str) -> None:
        for name in names:
            if name not in self.columns:
                raise InputError.about("the column {name} is missing", name=name)

    def find_bad(self, good: NDArray[np.bool_]) -> int | None:
        """Return the first row that is not good; None where all are."""
        return None if good.all() else int(good.argmin())


def _read_table(path: Path, texts: dict[str, int]) -> _Table:
    """Return the table of a file; custom_site_id, which is a text, by the number that `texts` gives it."""
    data = read_ground_file(path, LARGEST_FILE)
    with naming(path.name):
        if len(data) > LARGEST_FILE:
            raise InputError.about("the file is larger than {most:.0f} MB", most=LARGEST_FILE / 1e6)
        if b"\0" in data or data.startswith((b"PK", b"\x89HDF", b"\x1f\x8b", b"\xff\xfe", b"\xfe\xff")):
            raise InputError.about("the file is not plain text. Export it from OpenQuake as CSV")
        if data.count(b"\n") + data.count(b"\r") > MOST_ROWS:
            raise InputError.about("the file has more than {most:,} rows: keep fewer events or sites", most=MOST_ROWS)
        head: tuple[str, ...] = ()
        start, line = 0, 0
        while start < min(len(data), MOST_HEAD) and not head:
            end = data.find(b"\n", start)
            end = len(data) if end < 0 else end
            text, start, line = data[start:end].decode("utf-8-sig", "replace").strip(), end + 1, line + 1
            if text and not text.startswith(("#", '"#')):
                try:
                    head = tuple(cell.strip() for cell in next(csv.reader([text])))
                except csv.Error:  # an end of line of its own in the middle
                    raise InputError.about("line {line}: the headings cannot be read", line=line) from None
        if not head:
            raise InputError.about("there is no table")
        first = line + 1  # that of the first row
        if len(head) > MOST_COLUMNS or len(set(head)) < len(head):
            raise InputError.about("the first row has a heading twice, or more than {most} headings", most=MOST_COLUMNS)
        rows = data[start:]
        if not rows.strip():
            raise InputError.about("there are no rows below the headings")
        if not data.endswith((b"\n", b"\r")):
            raise InputError.about("the last line has no end: the file is cut off. Export it again")
        numbers = _parse_rows(rows, head, first, lambda text: texts.setdefault(text.strip(), len(texts)))
        lines: Sequence[int] = range(first, first + len(numbers))
        if len(lines) < rows.count(b"\n"):  # some are blank
            lines = [line for line, row in enumerate(rows.splitlines(), first) if row.strip()]
        return _Table(dict(zip(head, numbers.T, strict=True)), lines, hashlib.sha256(data).hexdigest())


def _parse_rows(data: bytes, head: Sequence[str], first: int, number_text: Callable[[str], int]) -> FloatArray:
    texts = [head.index(_TEXT)] if _TEXT in head else []
    converters: dict[int | str, Callable[[str], Any]] = dict.fromkeys(texts, number_text)
    try:
        found: FloatArray = np.loadtxt(
            io.BytesIO(data), delimiter=",", ndmin=2, comments=None, encoding="utf-8", converters=converters or None
        )
        if found.shape[1] == len(head):
            return found
    except (ValueError, UnicodeDecodeError):
        pass
    for line, row in enumerate(data.decode("utf-8", "replace").splitlines(), first):
        cells = row.split(",") if row.strip() else []
        if cells and len(cells) != len(head):
            raise InputError.about(
                "line {line}: the number of cells is {cells}, but there are {headings} headings",
                line=line, cells=len(cells), headings=len(head),
            )  # fmt: skip
        numbers = [cell for at, cell in enumerate(cells) if at not in texts]
        if (bad := find_no_number(numbers)) >= 0:
            raise InputError.about("line {line}: {text!r} is not a number", line=line, text=numbers[bad].strip()[:40])
    raise InputError.about("the rows cannot be read")
