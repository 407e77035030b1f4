"""New workbooks: what they can be made of, a template by use, the worked example."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from assess import resources
from assess.delivery.folders import private_folder
from assess.errors import OutputError
from assess.i18n import LANGUAGES, Text, fill, gettext, list_languages, load_catalogue, speaking, spoken
from assess.intensity import SHAKINGS
from assess.model import STRUCTURES, split_names
from assess.motion.assumed import HIGH_STOREY, find_number, guess_elevation, is_below_ground
from assess.units import QUANTITIES
from assess.web.file_names import check_name, clean_name
from assess.web.request_errors import CONFLICT, UNUSABLE, RequestError
from assess.workbook.habits import CellError
from assess.workbook.names import key
from assess.workbook.schema import BUILDING, CATALOGUE, FLOORS, ITEMS, USES
from assess.workbook.values import cell_reader, understand

if TYPE_CHECKING:
    from assess.workbook.template import Content

EXAMPLE = "market-street.xlsx"
MOST_PIECES = 200
"""Pieces that a new workbook begins with."""
LONGEST = 200
"""Characters of a text that goes into a new workbook."""
CENTIMETRES = 100.0
ROOMS: Mapping[str, tuple[Text, ...]] = {
    "Office": (fill("Open office"), fill("Meeting room"), fill("Archive"), fill("Kitchen")),
    "Hospital": (fill("Ward"), fill("Pharmacy"), fill("Nurses' station"), fill("Store room")),
    "School": (fill("Classroom"), fill("Library"), fill("Staff room"), fill("Store room")),
    "Laboratory": (fill("Laboratory"), fill("Store room"), fill("Cold room"), fill("Office")),
    "Library": (fill("Reading room"), fill("Stacks"), fill("Office"), fill("Entrance hall")),
    "Home": (fill("Living room"), fill("Kitchen"), fill("Bedroom"), fill("Study")),
    "Shop": (fill("Sales floor"), fill("Store room"), fill("Office")),
}
"""Names that are offered for the first room, by use."""
TYPED = ("address", "latitude", "longitude", "storeys", "height", "structure", "ground_pga", "ground_pgv")
"""Lines of Building that are typed as in their cells."""
RANGED = ("latitude", "longitude", "storeys", "height", "ground_pga", "ground_pgv")
GROUND_FLOOR = fill("Ground floor")
ASSUMED = fill("elevation assumed")
"""Name of a floor whose elevation follows from `HIGH_STOREY`: reports show it."""
MOST_FLOORS = 300
"""Number of the highest floor that is made with those below it."""
MOST_RECORDS = 2
"""Records of the ground: along X, and along Y."""
Units = Literal["si", "imperial"]
UNITS: tuple[Units, ...] = ("si", "imperial")
Choice = TypeVar("Choice", bound=str)


def describe_start(home: Path | None) -> dict[str, Any]:
    """Return what a new workbook can be made of, in the language in use; `home` is the folder that it is made in."""
    from assess.workbook.catalogue import read_catalogue

    types: dict[str, list[dict[str, Any]]] = {use: [] for use in USES}
    for use, listed in types.items():
        for row in read_catalogue("si", use):
            sizes = {name: row[name] / CENTIMETRES if name in row else None for name in ("breadth", "width", "height")}
            listed.append({"type": row["type"], **sizes})
    return {
        "start": True,
        "can_save": home is not None,
        "folder": (home.name or str(home)) if home else "",
        "uses": [[use, gettext(use)] for use in USES],
        "shakings": [[one, gettext(one)] for one in SHAKINGS],
        "structures": [[one, gettext(one)] for one in STRUCTURES],
        "storey": HIGH_STOREY,
        "ranges": {one: {name: _describe_range(name, one) for name in RANGED} for one in UNITS},
        "languages": [list(pair) for pair in list_languages()],
        "rooms": {use: [gettext(room) for room in ROOMS[use]] for use in USES},
        "types": types,
    }


def _describe_range(name: str, units: "Units") -> list[Any]:
    """Return the least and the largest number of a line of Building, and its unit."""
    column = BUILDING.column(name)
    unit = column.imperial if units == "imperial" else column.unit
    factor = column.factor / QUANTITIES[column.quantity][unit] if column.quantity else 1.0
    return [*(float(f"{(limit or 0.0) * factor:.4g}") for limit in (column.low, column.high)), unit]


def describe_map() -> dict[str, Any]:
    """Return the map that comes along: its edges (west, south, east, north), and the rings of its land [deg]."""
    found = json.loads(resources.city_file("coast.geojson").read_bytes())["features"][0]["geometry"]["coordinates"]
    rings = [ring for polygon in found for ring in polygon]
    edges = [pick(point[at] for ring in rings for point in ring) for pick in (min, max) for at in (0, 1)]
    return {"edges": edges, "land": rings}


@dataclass(frozen=True, slots=True)
class Made:
    """A new workbook: its name, its bytes, and the files that it names."""

    name: str
    data: bytes
    files: Mapping[str, Path | bytes] = field(default_factory=dict)


def build_workbook(request: Mapping[str, Any]) -> Made:
    """Return a new workbook; raises RequestError if the request asks for something that there is not."""
    kind = choose(request, "kind", ("template", "blank", "example"))
    called = request.get("name") or (EXAMPLE if kind == "example" else request.get("building") or gettext("building"))
    name, units = check_name(called), choose(request, "units", UNITS)
    language = choose(request, "language", LANGUAGES)
    if kind == "example":
        return _build_example(name, language)
    from assess.pipeline.live_values import store_live
    from assess.workbook.catalogue import read_catalogue
    from assess.workbook.template import Content

    use = choose(request, "use", ("", *USES))
    building = {"building": _text(request, "building"), "use": use, "shaking": choose_shaking(request)}
    typed = _read_typed(request, units)
    building = {field: value for field, value in building.items() if value} | {one: typed[one][0] for one in typed}
    size: dict[str, float] = {one: typed[one][1] for one in ("height", "storeys") if one in typed}
    pieces = list(_list_pieces(request.get("pieces") or []))
    place = {"room": _text(request, "room")} if request.get("room") else {}
    with speaking(load_catalogue(language)):
        rows: dict[str, list[dict[str, Any]]] = {
            CATALOGUE.name: read_catalogue(units, use), BUILDING.name: [building], FLOORS.name: [], ITEMS.name: []
        }  # fmt: skip
        if kind == "template":
            rows[FLOORS.name], floor = _list_floors(_text(request, "floor"), size, units)
            rows[FLOORS.name][0] |= zip(("record_x", "record_y"), _list_records(request), strict=False)
            place["floor"] = floor
            rows[ITEMS.name] = [{"item": f"A{n}", **place, "type": gettext(one)} for n, one in enumerate(pieces, 1)]
        return Made(name, _write(store_live(Content(rows), units), units))


def _build_example(name: str, language: str) -> Made:
    """Return the worked example: in English as it comes along, else made anew in the language."""
    from assess.workbook.read import read_tables
    from assess.workbook.worked_example import worked_content

    data = resources.example().read_bytes()
    tables, _ = read_tables(data, name)
    cells = [row.get(f"record_{axis}") for row in tables[FLOORS.name].rows for axis in "xy"]
    names = {one.partition("#")[0].strip() for cell in cells if cell for one in split_names(cell)}
    if language != LANGUAGES[0]:
        with speaking(load_catalogue(language)):
            data = _write(worked_content(), "si")
    return Made(name, data, {one: resources.example_file(one) for one in sorted(names)})


def _write(content: "Content", units: "Units") -> bytes:
    from assess.workbook.template import write_workbook

    with private_folder("assess-new-") as folder:
        write_workbook(folder / EXAMPLE, content, units)
        return (folder / EXAMPLE).read_bytes()


def _read_typed(request: Mapping[str, Any], units: "Units") -> dict[str, tuple[Any, Any]]:
    """Return what is typed of the lines `TYPED`, in the units of the headers and in SI; RequestError if it is wrong."""
    found: dict[str, tuple[Any, Any]] = {}
    for name in TYPED:
        column, text = BUILDING.column(name), _text(request, name)
        column = replace(column, label=gettext(column.label), language=spoken().code)
        unit = column.imperial if units == "imperial" else column.unit
        if text:
            try:
                meant, _ = understand(column, text, unit)
                value, _ = cell_reader(column, unit)(text)
            except CellError as error:
                raise RequestError(error.message, UNUSABLE, error.fix, {"field": name}) from None
            found[name] = value if column.kind in ("text", "choice") else meant, value
    return found


def _list_floors(asked: str, size: Mapping[str, float], units: "Units") -> tuple[list[dict[str, Any]], str]:
    """Return the rows of Floors, from the ground floor 0 up to the roof or at least the floor that is asked for.

    The name of the latter is returned, too; `size` are height [m] and storeys, as far as they are known.
    """
    number = None if is_below_ground(asked) else find_number(asked or "0")
    number = number if number is None or number <= MOST_FLOORS else None
    storeys, height = int(size.get("storeys", 0)), size.get("height")
    factor = QUANTITIES["length"]["ft"] if units == "imperial" else 1.0
    rows: list[dict[str, Any]] = []
    for at in range(max(storeys, (number or 0) + 1)):
        z = guess_elevation(str(at), (), height, storeys)
        name = GROUND_FLOOR if at == 0 else "" if height and storeys else ASSUMED
        rows.append(
            {"floor": str(at), "elevation": round((z or 0.0) / factor, 2)} | ({"name": gettext(name)} if name else {})
        )
    if number is None:
        rows.append({"floor": asked})
    return rows, asked if number is None else str(number)


def _list_records(request: Mapping[str, Any]) -> list[str]:
    """Return the names of the records of the ground, as the workbook has them."""
    names = request.get("records") or []
    if not isinstance(names, list) or len(names) > MOST_RECORDS or not all(isinstance(one, str) for one in names):
        raise RequestError(fill("Records are at most {most} files.", most=MOST_RECORDS), UNUSABLE)
    return [clean_name(one).replace("#", "-").replace(";", "-") for one in names]


def choose_shaking(request: Mapping[str, Any]) -> str:
    """Return the shaking that is chosen, blank where none is; RequestError where there is no such choice."""
    return choose(request, "shaking", ("", *SHAKINGS))


def _text(request: Mapping[str, Any], name: str) -> str:
    value = request.get(name)
    text = " ".join(str(value).split()) if isinstance(value, str | int) and not isinstance(value, bool) else ""
    if len(text) > LONGEST:
        raise RequestError(fill("{name} has more than {most} characters.", name=name, most=LONGEST), UNUSABLE)
    return text


def choose(request: Mapping[str, Any], name: str, choices: tuple[Choice, ...]) -> Choice:
    """Return one of the choices, the first where nothing is asked for; RequestError where there is no such choice."""
    value = _text(request, name) or choices[0]
    for choice in choices:
        if choice == value:
            return choice
    known = ", ".join(filter(None, choices))
    text = fill("{name} is {value!r}, expected one of: {known}", name=name, value=value[:40], known=known)
    raise RequestError(text, UNUSABLE)


def _list_pieces(pieces: object) -> Iterator[str]:
    listed = pieces if isinstance(pieces, list) else [None]
    total = 0
    for piece in listed:
        kind, count = (piece.get("type"), piece.get("count", 1)) if isinstance(piece, dict) else (None, 0)
        english = _types().get(key(kind)) if isinstance(kind, str) else None
        if english is None:
            raise RequestError(fill("{type} is not a type of the catalogue.", type=repr(kind)[:LONGEST]), UNUSABLE)
        if isinstance(count, bool) or not isinstance(count, int) or count < 0 or (total := total + count) > MOST_PIECES:
            text = fill("The pieces are more than {most}: add others on the page.", most=MOST_PIECES)
            raise RequestError(text, UNUSABLE)
        yield from [english] * count


@cache
def _types() -> Mapping[str, str]:
    from assess.workbook.catalogue import catalogue_rows

    names = [line["type"] for line in catalogue_rows()]
    return {key(load_catalogue(code).find(name)): name for code in LANGUAGES for name in names}


def place_workbook(made: Made, folder: Path) -> Path:
    """Write a new workbook and its files, never over a file; RequestError if the name is taken, or OutputError."""
    path = folder / made.name
    if path.exists() or path.is_symlink():
        fix = fill("Choose another name, or open it.")
        raise RequestError(fill("{name} exists already.", name=made.name), CONFLICT, fix)
    try:
        place_files(made, folder)
        with path.open("xb") as file:
            file.write(made.data)
    except OSError as error:
        why = error.strerror or str(error)
        raise OutputError.about("{name} cannot be written: {why}.", name=made.name, why=why) from None
    return path


def place_files(made: Made, folder: Path) -> None:
    """Write the files that a new workbook names into a folder; one that is there stays as it is."""
    for name, source in made.files.items():
        target = folder / name
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            with target.open("xb") as file:
                file.write(source if isinstance(source, bytes) else source.read_bytes())
