"""The worked city: made-up buildings around San Francisco Bay under the ShakeMap of Loma Prieta.

The ShakeMap and the coastline are real; every building, its place and all its furniture are made up, by random numbers
that are the same on every machine.
"""

import csv
import shutil
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from random import Random
from typing import Any

from assess import resources
from assess.delivery.deliver import find_digest
from assess.delivery.folders import NEW, moving, staging
from assess.errors import InputError
from assess.portfolio.background import read_background
from assess.portfolio.sources import COLUMNS
from assess.portfolio.table_schemas import MADE_UP
from assess.text import plain_line
from assess.workbook.catalogue import read_catalogue
from assess.workbook.schema import CATALOGUE
from assess.workbook.template import Content, write_workbook

INDEX, GRID, COAST, README = "index.csv", "grid.xml", "coast.geojson", "README.md"
BUILDINGS, UNSURVEYED = 220, 8
"""Buildings of the city, and those of them that stand in the index alone, without a survey."""
SEED = 19891017
SCENARIO = "Loma Prieta, 17 October 1989, by the ShakeMap of the U.S. Geological Survey. The building is made up."
DRAWN: Mapping[str, Any] = tomllib.loads(files("assess.portfolio").joinpath("example_city.toml").read_text("utf-8"))
"""What the buildings and their furniture are drawn from."""
GRID_STEP, ACROSS = 2.4, 12  # distance between pieces on a plan [m], and pieces in a row of it
OFFSHORE = 0.004  # least distance to the coastline [deg], which is a generalised one


@dataclass(frozen=True, slots=True)
class Building:
    """One made-up building; `path` is "" where it has no workbook."""

    number: int
    path: str
    name: str
    town: str
    latitude: float
    longitude: float
    use: str
    storeys: int
    height: float
    area: int


def write_example_city(folder: Path, buildings: int = BUILDINGS) -> bool:
    """Write workbooks, index.csv, the ShakeMap grid.xml, coast.geojson and README.md, whole or not at all.

    They have the same bytes every time; a few of the `buildings` have no workbook. Returns False where the folder holds
    exactly this city already. Raises InputError if it holds anything else; OSError if a file cannot be written.
    """
    folder = folder.resolve()
    folder.parent.mkdir(parents=True, exist_ok=True)
    city = list_buildings(buildings)
    is_filled = folder.exists() and (not folder.is_dir() or any(folder.iterdir()))
    names = {*(one.path for one in city if one.path), INDEX, GRID, COAST, README}
    if not is_filled or set(_find_digests(folder)) == names:
        with staging(folder.parent) as stage:
            made = stage / NEW
            for one in city:
                if one.path:
                    (made / one.path).parent.mkdir(exist_ok=True)
                    write_workbook(made / one.path, _fill_workbook(one), spare=10)
            with (made / INDEX).open("w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(COLUMNS)
                for one in city:  # of a building with a workbook its floor area alone, which the workbook does not hold
                    known = (one.name, one.latitude, one.longitude, one.use, one.storeys, one.height)
                    writer.writerow((one.path, *(("",) * len(known) if one.path else known), one.area, ""))
            for name in (GRID, COAST):
                shutil.copyfile(resources.city_file(name), made / name)
            text = DRAWN["readme"].format(buildings=len(city), unsurveyed=sum(not one.path for one in city))
            (made / README).write_text(text, encoding="utf-8", newline="\n")
            if not is_filled:
                with moving():
                    if not folder.exists():
                        made.replace(folder)
                    else:  # it is empty and stays, as it may be the current folder of a terminal
                        for path in sorted(made.iterdir()):
                            path.replace(folder / path.name)
                return True
            if _find_digests(folder) == _find_digests(made):
                return False
    raise InputError.about(
        "{folder} is not empty, and not the worked city as it was written; name a folder that does not exist yet.",
        folder=plain_line(str(folder)),
    )


def _find_digests(folder: Path) -> dict[str, str | None]:
    """Return the digests of all files in a folder by their names, without those that the system hides."""
    found = [one for one in folder.rglob("*") if not (one.is_dir() or one.name.startswith("."))]
    return {one.relative_to(folder).as_posix(): find_digest(one) for one in found}


def list_buildings(count: int) -> list[Building]:
    """Return the buildings of the city; one more changes none of the others."""
    import shapely

    coast = read_background(resources.city_file(COAST))
    land = shapely.union_all([shapely.Polygon(area[0], area[1:]) for area in coast.areas]).buffer(-OFFSHORE)
    shapely.prepare(land)
    towns = [(one, one[3]) for one in DRAWN["towns"]]
    uses = [(use, one["share"]) for use, one in DRAWN["uses"].items()]
    buildings = []
    for number in range(1, count + 1):
        draw = Random(SEED + number)  # noqa: S311 - an example, no secret
        is_surveyed = number % (BUILDINGS // UNSURVEYED) != 0
        town, latitude_of, longitude_of, _share, spread = _choose(draw, towns)
        use = _choose(draw, uses if is_surveyed else DRAWN["unsurveyed"])
        kind = DRAWN["uses"].get(use, {"storeys": (2, 5), "storey_height": 3.8, "storey_area": 300})
        low, high = kind["storeys"]
        storeys = low + int((high - low + 1) * draw.random() ** 1.8)
        for _attempt in range(200):
            latitude, longitude = latitude_of + spread * _bell(draw), longitude_of + spread * 1.26 * _bell(draw)
            if land.contains(shapely.Point(longitude, latitude)):
                break
        name = f"{use.capitalize()} {number:03}, {town} {MADE_UP}"
        path = f"{town.lower().replace(' ', '-')}/{use.lower()}-{number:03}.xlsx" if is_surveyed else ""
        height = round(storeys * (kind["storey_height"] + 0.4 * draw.random()), 1)
        area = storeys * kind["storey_area"] * (1 + int(4 * draw.random()))
        buildings.append(
            Building(number, path, name, town, round(latitude, 5), round(longitude, 5), use, storeys, height, area)
        )
    return buildings


def _choose(draw: Random, weighted: Any) -> Any:
    """Return one of several by their weights, of one draw: the same with every version of Python."""
    left = draw.random() * sum(weight for _one, weight in weighted)
    for one, weight in weighted:
        left -= weight
        if left < 0:
            return one
    return weighted[-1][0]


def _bell(draw: Random) -> float:
    """Return a number of mean 0 and standard deviation 1 about: the sum of twelve uniform ones, less six."""
    return sum(draw.random() for _at in range(12)) - 6.0


def _fill_workbook(one: Building) -> Content:
    """Return what stands in the workbook of a building: nothing of the shaking, which the ShakeMap gives."""
    draw = Random(SEED * 7 + one.number)  # noqa: S311 - an example, no secret
    furnished = tuple(range(1, one.storeys + 1))
    if one.storeys > 4:  # four storeys at most have been surveyed, the top one among them
        furnished = tuple(sorted({1, one.storeys} | {2 + int((one.storeys - 2) * draw.random()) for _at in range(2)}))
    rise = one.height / one.storeys
    has_routes, is_drawn, has_costs = (draw.random() < share for share in (0.7, 0.7, 0.6))
    corridors = furnished if has_routes else ()
    building = {
        "building": one.name, "address": f"{one.town}, California", "latitude": one.latitude,
        "longitude": one.longitude, "use": one.use, "storeys": one.storeys, "height": one.height,
        "scenario": SCENARIO,
    }  # fmt: skip
    floors = [
        {"floor": str(at), "name": f"Storey {at}", "elevation": round((at - 1) * rise, 2)} for at in furnished
    ]  # fmt: skip
    items = [*_list_pieces(one, furnished, corridors, draw)]
    use = DRAWN["uses"][one.use]
    named = {name for _room, types in use["rooms"] for name in types} | set(use["corridor"])
    rows = {
        "Building": [building], "Floors": floors, "Items": list(_place(items)) if is_drawn else items,
        CATALOGUE.name: [row for row in read_catalogue("si") if row["type"] in named],
    }  # fmt: skip
    if has_routes:
        rows["Places"], rows["Routes"] = [], []
        for floor in corridors:
            way_out = f"{'Exit' if floor == 1 else 'Stair'} {floor}"  # to the street, or to a stair
            ends = {"start": f"Corridor end {floor}", "end": way_out, "room": "Corridor"}
            rows["Routes"].append({
                "route": f"Way out, storey {floor}", "segment": "corridor", "floor": str(floor),
                "clear_width": round(use["clear_width"] + 0.8 * draw.random(), 2),
                "occupants": 1 + int(use["people"] * (0.5 + draw.random())),
                **(ends if is_drawn else {}),
            })  # fmt: skip
            if is_drawn:
                end = {"kind": "exit" if floor == 1 else "stair", "x": 30.0, "y": 1.0}
                rows["Places"] += [
                    {"place": ends["start"], "floor": str(floor), "kind": "door", "x": 1.0, "y": 1.0},
                    {"place": way_out, "floor": str(floor), **end},
                ]
    prices = DRAWN["costs"].items()
    costs = [{"detail": detail, "unit_cost": cost, "source": "made-up price"} for detail, cost in prices]
    return Content({**rows, **({"Costs": costs} if has_costs else {})})


def _place(items: Iterable[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """Yield pieces with a position each, in rows of `ACROSS` behind the corridor; those of a route stay beside it."""
    taken: Counter[str] = Counter()
    for row in items:
        if "route" in row:
            yield row
            continue
        for at in range(row["quantity"]):
            cell = taken[row["floor"]]
            taken[row["floor"]] += 1
            x, y = 2 + GRID_STEP * (cell % ACROSS), 6 + GRID_STEP * (cell // ACROSS)
            name = row["item"] if row["quantity"] == 1 else f"{row['item']}{chr(ord('a') + at)}"
            yield row | {"item": name, "quantity": 1, "x": round(x, 1), "y": round(y, 1), "angle_deg": 90 * (cell % 2)}


def _list_pieces(
    one: Building, floors: tuple[int, ...], corridors: tuple[int, ...], draw: Random
) -> Iterator[dict[str, Any]]:
    """Yield rows of Items until the pieces are as many as were drawn, 12 to 36, then those next to some ways out."""
    left, number, rooms = 12 + int(25 * draw.random()), 0, DRAWN["uses"][one.use]["rooms"]
    while left > 0:
        number += 1
        floor = floors[int(len(floors) * draw.random())]
        room, types = rooms[int(len(rooms) * draw.random())]
        quantity = min(left, _choose(draw, DRAWN["quantities"]))
        left -= quantity
        yield {
            "item": f"{floor}-{number:02}", "floor": str(floor), "room": room,
            "type": types[int(len(types) * draw.random())], "quantity": quantity,
            "anchored": _choose(draw, DRAWN["anchored"]),
            "importance": _choose(draw, DRAWN["importance"]),
        }  # fmt: skip
    for floor in corridors:
        if draw.random() < 0.6:
            yield {
                "item": f"{floor}-R1", "floor": str(floor), "room": "Corridor",
                "type": DRAWN["uses"][one.use]["corridor"][int(3 * draw.random())], "quantity": 1,
                "axis": "X" if draw.random() < 0.5 else "Y", "anchored": _choose(draw, DRAWN["anchored"]),
                "route": f"Way out, storey {floor}", "segment": "corridor",
                "edge_distance": round(0.6 * draw.random(), 2), "importance": "life safety",
            }  # fmt: skip
