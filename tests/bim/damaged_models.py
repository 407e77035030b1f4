"""A small house as a building model, and models whose lines are damaged at random."""

import random
import re
from pathlib import Path

from tests.bim.ifc_files import ModelWriter

SHELF = (0, 0, 0, 0.4, 0.8, 1.9)
_REFERENCE = re.compile(rb"(?<=[(,])#\d+")
_NUMBER = re.compile(rb"(?<=[(,])-?\d+(?:\.\d*)?(?:E[-+]?\d+)?(?=[,)])")
_CLASS = re.compile(rb"#\d+\s*=\s*(\w+)")
NUMBERS = (b"1.E300", b"-1.E300", b"1.E400", b"NAN", b"INF", b"$", b"*", b"0.", b"-1.", b"1.E-300", b"1.E7", b"''",
           b"99999999999999999999", b"()", b"#1", b".T.")  # fmt: skip
"""What takes the place of a number."""
CHARACTERS = b"#$*'(),;.=/\\-+EX0123456789 \n\t\x00\x7f\xe4\xff"
"""What takes the place of a character."""


def write_house(path: Path) -> Path:
    """Write a house of two storeys: a room on each, an assembly, pieces, a door in a wall with a hole, a stair."""
    model = ModelWriter(north=(0.0, 1.0))
    model.site.RefLatitude, model.site.RefLongitude = (45, 30, 0), (9, 12, 0)
    for number, level in enumerate((0.0, 3.0)):
        storey = model.storey(f"Level {number}", level)
        room = model.space(storey, (3, 2, level, 6, 4, 2.8), f"{number}01", "Office")
        shelves = [model.piece(f"Shelf {at}", SHELF, within=room, at=(at, 1, level), Tag="7") for at in (1, 2)]
        model.typed("IfcFurnitureType", "Shelf", *shelves)
        model.piece("Wall unit", SHELF, within=storey, at=(4, 1, level + 1))
        desk = model.piece("Desk", within=room, at=(3, 2, level))
        boxes = ((0, 0, 0.7, 0.8, 1.6, 0.04), (0, 0.7, 0, 0.7, 0.05, 0.7), (0, -0.7, 0, 0.7, 0.05, 0.7))
        model.aggregate(desk, *(model.piece(f"Part {at}", box, at=(3, 2, level)) for at, box in enumerate(boxes)))
        wall = model.element("IfcWall", "Wall", (3, -0.1, level, 6, 0.2, 2.8), within=storey)
        hole = model.element("IfcOpeningElement", "Hole", (2, -0.1, level, 0.9, 0.4, 2.1))
        door = model.element("IfcDoor", "Door", (2, -0.1, level, 0.9, 0.1, 2.1), within=storey, OverallWidth=0.9)
        model.root("IfcRelVoidsElement", None, RelatingBuildingElement=wall, RelatedOpeningElement=hole)
        model.root("IfcRelFillsElement", None, RelatingOpeningElement=hole, RelatedBuildingElement=door)
    stair = (5, 3, 0, 0.9, 2.4, 3.0)
    model.element("IfcStair", "Stair", stair, within=model.storeys["Level 0"], PredefinedType="STRAIGHT_RUN_STAIR")
    for number, one in enumerate(sorted(model.file.by_type("IfcRoot"), key=lambda one: one.id())):
        one.GlobalId = f"0{number:021}"  # the same file each time
    model.file.header.file_name.time_stamp = "2026-01-01T00:00:00"
    return model.write(path)


def damage(data: bytes, draw: random.Random) -> bytes:
    """Return a model after 1 to 4 of its lines were damaged."""
    lines = data.split(b"\n")
    for _ in range(draw.randint(1, 4)):
        at = _choose(lines, draw)
        lines[at] = draw.choice((_change, _change, _drop, _refer, _refer, _number, _number))(
            lines[at], len(lines), draw
        )
    return b"\n".join(lines)


def _choose(lines: list[bytes], draw: random.Random) -> int:
    """Return a line: every second time of a class that is drawn first, as most lines are points of shapes."""
    if draw.random() < 0.5:
        return draw.randrange(len(lines))
    classes: dict[bytes, list[int]] = {}
    for at, line in enumerate(lines):
        found = _CLASS.match(line)
        classes.setdefault(found[1] if found else b"", []).append(at)
    return draw.choice(classes[draw.choice(sorted(classes))])


def _change(line: bytes, _count: int, draw: random.Random) -> bytes:
    changed = bytearray(line)
    for _ in range(draw.choice((1, 1, 2, 8)) if line else 0):
        changed[draw.randrange(len(changed))] = draw.choice(CHARACTERS)
    return bytes(changed)


def _drop(_line: bytes, _count: int, _draw: random.Random) -> bytes:
    return b""


def _refer(line: bytes, count: int, draw: random.Random) -> bytes:
    """Return a line that refers to another entity, which may be itself or none."""
    return _exchange(line, _REFERENCE, b"#%d" % draw.randrange(1, count), draw)


def _number(line: bytes, _count: int, draw: random.Random) -> bytes:
    return _exchange(line, _NUMBER, draw.choice(NUMBERS), draw)


def _exchange(line: bytes, pattern: re.Pattern[bytes], text: bytes, draw: random.Random) -> bytes:
    found = list(pattern.finditer(line))
    if not found:
        return line
    one = draw.choice(found)
    return line[: one.start()] + text + line[one.end() :]
