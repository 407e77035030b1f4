"""A grid of a ShakeMap as its XML holds it: the fields by name on a regular grid of places.

Reference: Worden CB, Wald DJ (2016). ShakeMap manual online: technical manual, user's guide, and software guide. U.S.
Geological Survey, doi:10.5066/F7D21VPQ (file grid.xml).
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from assess.errors import InputError
from assess.i18n import Text, fill
from assess.plain_text import plain_text

FloatArray = NDArray[np.float64]

LARGEST_FILE = 64_000_000
"""Bytes; a grid of 241 x 193 points takes 3 million."""
MOST_POINTS = 2_000_000
MOST_FIELDS = 100
MOST_ELEMENTS = 5_000
_PIECE = 500_000
"""Bytes of numbers that are made into floats at once."""
_ROUND = 2e-4
"""By how much printed coordinates may be off a regular grid [deg]: they have four decimals."""
_LONGEST = 200
"""Characters of a text of the file that are kept."""

_FOREIGN = (b"\x89HDF", b"PK\x03\x04", b"\x1f\x8b", b"{", b"[", b"%PDF", b"\xff\xfe", b"\xfe\xff")
"""How files begin that are not XML of ShakeMap: HDF, zip, gzip, JSON, PDF, UTF-16."""


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """The fields of a grid of ShakeMap.

    * `header`, `event`: attributes of the file's root and of its event.
    * `latitude`, `longitude` (m,): rising [deg].
    * `fields`: values as in the file, by the name of the field.
    * `units`: units as in the file, by the name of the field.
    """

    header: Mapping[str, str]
    event: Mapping[str, str]
    latitude: FloatArray
    longitude: FloatArray
    fields: Mapping[str, FloatArray]
    units: Mapping[str, str]


def parse_grid(data: bytes) -> Grid:
    """Read a grid from the bytes of its file.

    Raises
    ------
    InputError
        If it is not XML of ShakeMap, is cut off, claims more points than it has rows or than can be read, declares
        entities, holds something that is not a number, or its places are not a regular grid.
    """
    if len(data) > LARGEST_FILE:
        raise InputError(fill("the file is larger than {most:.0f} MB", most=LARGEST_FILE / 1e6))
    if not data.strip():
        raise InputError(fill("the file is empty"))
    if data.startswith(_FOREIGN):
        raise InputError(fill("the file is not XML. {hint}", hint=_HINT))
    reader = _Reader()
    try:
        reader.parser.Parse(data, True)
    except (expat.ExpatError, ValueError, LookupError) as error:  # an encoding that is not known
        raise _damaged(error, reader) from None
    return _build(reader)


_HINT = fill("Download grid.xml from the products of the event's ShakeMap at earthquake.usgs.gov")


def _damaged(error: Exception, reader: "_Reader") -> InputError:
    line = getattr(error, "lineno", None)
    if not reader.is_shakemap:
        return InputError(fill("the file is not the XML of a ShakeMap. {hint}", hint=_HINT))
    if line is None:
        return InputError(fill("the XML cannot be read. Download it again"))
    return InputError(fill("line {line}: the XML is damaged or cut off. Download it again", line=line))


class _Reader:
    """Takes in the elements of a grid.xml; everything else of the file is left out."""

    def __init__(self) -> None:
        self.parser = expat.ParserCreate()
        self.parser.buffer_text, self.parser.buffer_size = True, _PIECE
        self.parser.StartElementHandler, self.parser.EndElementHandler = self._enter, self._leave
        self.parser.CharacterDataHandler, self.parser.EntityDeclHandler = self._take, self._refuse
        self.is_shakemap = False
        self.found: dict[str, dict[str, str]] = {}
        self.names: list[tuple[str, str, str]] = []
        self.texts: list[str] = []
        self._elements, self._is_data = 0, False

    def _enter(self, tag: str, attributes: dict[str, str]) -> None:
        name, self._elements = tag.rpartition(":")[2], self._elements + 1
        if self._elements == 1 and name != "shakemap_grid":
            text = fill("its first element is {name}, expected shakemap_grid. {hint}", name=_shorten(name), hint=_HINT)
            raise InputError(text)
        self.is_shakemap = True
        if self._elements > MOST_ELEMENTS:
            raise InputError(fill("the file has more than {most:,} elements", most=MOST_ELEMENTS))
        clean = {key: _shorten(value) for key, value in attributes.items()}
        if name == "grid_field":
            self.names.append((clean.get("index", ""), clean.get("name", ""), clean.get("units", "")))
        elif name in self.found:
            raise InputError(fill("the element {name} is there twice", name=name))
        elif name in ("shakemap_grid", "event", "grid_specification", "grid_data"):
            self.found[name] = clean
        self._is_data = name == "grid_data"

    def _leave(self, _tag: str) -> None:
        self._is_data = False

    def _take(self, text: str) -> None:
        if self._is_data:
            self.texts.append(text)

    def _refuse(self, *_: object) -> None:
        raise InputError(fill("the file declares XML entities, which no ShakeMap does. {hint}", hint=_HINT))


def _shorten(text: str) -> str:
    return plain_text(" ".join(text.split()))[:_LONGEST]


# ---------------------------------------------------------------- elements to arrays


def _build(reader: _Reader) -> Grid:
    for name in ("event", "grid_specification", "grid_data"):
        if name not in reader.found:
            raise InputError(fill("the element {name} is missing", name=name))
    names = _name_fields(reader.names)
    columns, rows = (_read_count(reader.found["grid_specification"], name) for name in ("nlon", "nlat"))
    if columns * rows > MOST_POINTS:
        raise InputError(
            fill(
                "grid_specification: {columns:,} x {rows:,} points are more than {most:,}",
                columns=columns,
                rows=rows,
                most=MOST_POINTS,
            )
        )
    table = _read_numbers(reader.texts, len(names), rows * columns)
    fields = {name: table[:, at] for at, (name, _) in enumerate(names)}
    latitude, longitude, order = _arrange(fields.pop("LAT"), fields.pop("LON"), rows, columns)
    return Grid(
        header=reader.found["shakemap_grid"],
        event=reader.found["event"],
        latitude=latitude,
        longitude=longitude,
        fields={name: values[order].reshape(rows, columns) for name, values in fields.items()},
        units=dict(names),
    )


def _name_fields(listed: Sequence[tuple[str, str, str]]) -> list[tuple[str, str]]:
    """Return name and unit of the fields in the order of their columns."""
    if len(listed) > MOST_FIELDS:
        raise InputError(fill("the file has more than {most} fields", most=MOST_FIELDS))
    indices = [index for index, *_ in listed]
    if sorted(indices) != sorted(str(at + 1) for at in range(len(listed))):
        raise InputError(fill("the fields (grid_field) are not numbered from 1 on, each once"))
    names = [(name.upper(), unit) for _, name, unit in sorted(listed, key=lambda one: int(one[0]))]
    spelt = [name for name, _ in names]
    twice = next((name for name in spelt if spelt.count(name) > 1), None)
    if twice is not None:
        raise InputError(fill("the field {name} is there twice", name=twice))
    missing = next((name for name in ("LON", "LAT") if name not in spelt), None)
    if missing is not None:
        raise InputError(fill("the field {name} is missing", name=missing))
    return names


def _read_count(specification: Mapping[str, str], name: str) -> int:
    text = specification.get(name, "")
    if not (text.isascii() and text.isdigit() and len(text) < 20 and int(text) > 1):
        raise InputError(fill("grid_specification: {name} is {text!r}, expected 2 or more", name=name, text=text))
    return int(text)


def _read_numbers(texts: Sequence[str], width: int, rows: int) -> FloatArray:
    """Return the numbers of the grid, (rows, width)."""
    found = np.empty(rows * width)
    at = 0
    for cells in _split(texts):
        if at + len(cells) > found.size:
            raise InputError(fill("there are more than {rows:,} rows, which nlon x nlat gives", rows=rows))
        try:
            found[at : at + len(cells)] = np.fromiter(map(float, cells), dtype=float, count=len(cells))
        except ValueError:
            raise _describe_text(cells, at, width) from None
        at += len(cells)
    if at < found.size:
        raise InputError(
            fill(
                "there are {found:,} whole rows of {width} numbers, expected {rows:,} (nlon x nlat): the file is cut "
                "off or damaged. Download it again",
                found=at // width,
                width=width,
                rows=rows,
            )
        )
    return found.reshape(rows, width)


def _split(texts: Sequence[str]) -> Iterator[list[str]]:
    """Yield the cells of the texts, none cut in two."""
    rest = ""
    for text in texts:
        if len(rest) > _LONGEST or "_" in text or not text.isascii():
            raise InputError(fill("grid_data holds something that is not a number"))
        cells = (rest + text).split()
        rest = cells.pop() if cells and not text[-1].isspace() else ""
        yield cells
    yield rest.split()


def _describe_text(cells: Sequence[str], at: int, width: int) -> InputError:
    for place, cell in enumerate(cells, at):
        try:
            float(cell)
        except ValueError:
            row, column = divmod(place, width)
            return _describe_cell(row, column, cell)
    return InputError(fill("the XML cannot be read. Download it again"))  # pragma: no cover - one is not a number


def _describe_cell(row: int, column: int, cell: str) -> InputError:
    places = {"row": row + 1, "column": column + 1, "text": _shorten(cell)[:40]}
    return InputError(fill("grid_data, row {row:,}: number {column} is {text!r}, which is not a number", **places))


# ---------------------------------------------------------------- places


def _arrange(
    latitudes: FloatArray, longitudes: FloatArray, rows: int, columns: int
) -> tuple[FloatArray, FloatArray, NDArray[np.intp]]:
    """Return the rising latitudes and longitudes of the grid [deg], and the order in which its rows follow them."""
    is_place = (np.abs(latitudes) <= 90) & (np.abs(longitudes) <= 540)
    if not is_place.all():
        row = int((~is_place).argmax())
        places = {"lat": float(latitudes[row]), "lon": float(longitudes[row])}
        raise InputError(
            fill("grid_data, row {row:,}: LON {lon:g} and LAT {lat:g} are not a place on earth", row=row + 1, **places)
        )
    longitudes = _unwrap(longitudes)
    order = np.lexsort((longitudes, latitudes))
    north, east = (values[order].reshape(rows, columns) for values in (latitudes, longitudes))
    is_regular = (north == north[:, :1]).all() and (east == east[:1]).all()
    if not (is_regular and _is_even(north[:, 0]) and _is_even(east[0])):
        raise InputError(fill("LON and LAT are not those of a regular grid of nlon x nlat points"))
    return north[:, 0].copy(), east[0].copy(), order


def _unwrap(longitudes: FloatArray) -> FloatArray:
    """Return longitudes [deg] of which those beyond the date line go on rising."""
    if np.ptp(longitudes) <= 180:
        return longitudes
    eastern = np.where(longitudes < 0, longitudes + 360, longitudes)
    return eastern if np.ptp(eastern) < np.ptp(longitudes) else longitudes


def _is_even(values: FloatArray) -> bool:
    steps = np.diff(values)
    step = float(values[-1] - values[0]) / (values.size - 1)
    return step > 0 and bool((np.abs(steps - step) <= _ROUND + 0.01 * step).all())


def find_turn(longitude: float, grid: Grid) -> float:
    """Return a longitude [deg] by a multiple of 360 where that lies within those of a grid, else as it is."""
    west, east = float(grid.longitude[0]), float(grid.longitude[-1])
    turned = longitude + 360 * math.ceil((west - longitude) / 360 - 1e-12)
    return turned if turned <= east else longitude


def describe_place(latitude: float, longitude: float) -> Text:
    """Return a place [deg] in words."""
    return fill("latitude {latitude:.4f}, longitude {longitude:.4f}", latitude=latitude, longitude=longitude)
