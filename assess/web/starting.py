"""New workbooks: what they can be made of, a template by use, the worked example."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Literal, TypeVar

from assess import resources
from assess.delivery.folders import private_folder
from assess.errors import OutputError
from assess.i18n import LANGUAGES, Text, fill, gettext, list_languages, load_catalogue, speaking
from assess.intensity import SHAKINGS
from assess.model import split_names
from assess.web.file_names import check_name
from assess.web.request_errors import CONFLICT, UNUSABLE, RequestError
from assess.workbook.names import key
from assess.workbook.schema import BUILDING, CATALOGUE, FLOORS, ITEMS, USES

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
GROUND = ("1", "0", "g", "gf", "t", "pt", "ground", "ground floor", "piano terra")
"""Names of a floor that lies on the ground; of any other the height is not known until one fills it in."""
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
        "languages": [list(pair) for pair in list_languages()],
        "rooms": {use: [gettext(room) for room in ROOMS[use]] for use in USES},
        "types": types,
    }


@dataclass(frozen=True, slots=True)
class Made:
    """A new workbook: its name, its bytes, and the files that it names."""

    name: str
    data: bytes
    files: Mapping[str, Path | bytes] = field(default_factory=dict)


def build_workbook(request: Mapping[str, Any]) -> Made:
    """Return a new workbook; raises RequestError if the request asks for something that there is not."""
    from assess.workbook.read import read_tables

    kind = choose(request, "kind", ("template", "blank", "example"))
    called = request.get("name") or (EXAMPLE if kind == "example" else request.get("building") or gettext("building"))
    name, units = check_name(called), choose(request, "units", UNITS)
    use, language = choose(request, "use", ("", *USES)), choose(request, "language", LANGUAGES)
    building = {
        "building": _text(request, "building"), "address": _text(request, "town"), "use": use,
        "shaking": choose_shaking(request),
    }  # fmt: skip
    building = {field: value for field, value in building.items() if value}
    floor, room = _text(request, "floor") or "1", _text(request, "room")
    pieces = list(_list_pieces(request.get("pieces") or []))
    if kind == "example":
        data = resources.example().read_bytes()
        tables, _ = read_tables(data, name)
        cells = [row.get(f"record_{axis}") for row in tables[FLOORS.name].rows for axis in "xy"]
        names = {one.partition("#")[0].strip() for cell in cells if cell for one in split_names(cell)}
        return Made(name, data, {one: resources.example_file(one) for one in sorted(names)})
    from assess.pipeline.live_values import store_live
    from assess.workbook.catalogue import read_catalogue
    from assess.workbook.template import Content, write_workbook

    with speaking(load_catalogue(language)), private_folder("assess-new-") as folder:
        rows: dict[str, list[dict[str, Any]]] = {
            CATALOGUE.name: read_catalogue(units, use), BUILDING.name: [building], FLOORS.name: [], ITEMS.name: []
        }  # fmt: skip
        if kind == "template":
            place = {"floor": floor} | ({"room": room} if room else {})
            rows[FLOORS.name] = [{"floor": floor} | ({"elevation": 0} if floor.casefold() in GROUND else {})]
            rows[ITEMS.name] = [{"item": f"A{n}", **place, "type": gettext(one)} for n, one in enumerate(pieces, 1)]
        write_workbook(folder / name, store_live(Content(rows), units), units)
        return Made(name, (folder / name).read_bytes())


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
