"""Drawings of plans for tests: a plate of 16 x 12 m with two rooms, as SVG and DXF."""

import io
from pathlib import Path

import ezdxf.document
from ezdxf.filemanagement import new

from tests.apart import run_apart

MOST_MEMORY = 200
"""MB at the peak, 45 of them for Python and its libraries."""
_CHILD = """
import sys
from pathlib import Path
from assess.pictures import PictureError
from assess.plans import read_plan
try:
    print(len(read_plan(Path(sys.argv[1]).read_bytes(), None).content), "bytes")
except PictureError as error:
    print(error)
"""

SVG_HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1600 1200">'


def svg(content: str, head: str = SVG_HEAD) -> bytes:
    """Return an SVG of 1600 x 1200 with this content."""
    return f"{head}{content}</svg>".encode()


PLAN_SVG = svg('<rect width="1600" height="1200"/><path d="M800 0v700H0"/>')


def dxf(units: int = 4, *, xref: bool = False) -> bytes:
    """Return a DXF of the plate, 16,000 x 12,000 units; 4 are millimetres, 0 says nothing."""
    document = new()
    document.header["$INSUNITS"] = units
    space = document.modelspace()
    space.add_lwpolyline([(0, 0), (16000, 0), (16000, 12000), (0, 12000)], close=True)
    space.add_line((8000, 5000), (8000, 12000))
    space.add_arc((8000, 5000), 900, 0, 90)
    block = document.blocks.new("DOOR")
    block.add_line((0, 0), (100, 0))
    space.add_blockref("DOOR", (4000, 6000), dxfattribs={"xscale": 9})
    document.layers.add("OFF").off()
    space.add_line((-5000, 0), (0, 0), dxfattribs={"layer": "OFF"})
    space.add_text("Room")
    if xref:
        document.add_xref_def("secret/other.dxf", "OTHER")
        space.add_blockref("OTHER", (0, 0))
    return write(document)


def read_apart(path: Path) -> str:
    """Read a plan in a process of its own; return what it says, having checked how much memory it took."""
    return run_apart(_CHILD, path, most_memory=MOST_MEMORY, seconds=120)


def write(document: "ezdxf.document.Drawing") -> bytes:
    """Return the bytes of a DXF document."""
    target = io.StringIO()
    document.write(target)
    return target.getvalue().encode()
