"""The lines of a DXF drawing, read with ezdxf (extra `plans`): what lies in its model space and is not switched off.

Source: Autodesk (2012), DXF Reference, HEADER ($INSUNITS), ENTITIES.
"""

import io
import logging
import math
from collections import Counter
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from assess.environment import say_install
from assess.pictures import PictureError, damaged
from assess.plans.linework import FARTHEST, MOST_ELEMENTS, MOST_RAW, describe_left_out, find_box, pack, too_many

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

DEEPEST = 16  # blocks inside each other
MOST_INSERTS = 20_000  # blocks that are inserted: each takes a tenth of a millisecond, and blocks may hold blocks
MOST_TAGS = 1_000_000
"""Pairs of a group code and its value: a line has about a dozen. Each takes some 7 microseconds."""
CHORDS = 8  # chords of each curve
DRAWN = frozenset({"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "SOLID", "TRACE", "3DFACE"})
"""Entities whose lines are drawn."""
SILENT = frozenset({"POINT", "VIEWPORT", "ATTDEF", "ATTRIB", "SEQEND"})
XREF = 4 | 8  # flags of a block that is another file: an external reference, and one laid over


def read_dxf(data: bytes) -> tuple[bytes, float, tuple[str, ...], float | None]:
    """Return the lines of a DXF as `pack` keeps them, its aspect, what is left out, and its width [m] if known.

    Its frame is the box round its lines. No other file is read: external references are left out, and named.

    Raises PictureError if ezdxf is missing, or the drawing is too large, damaged, or holds no lines.
    """
    document = _open(data)
    reader = _Reader(document)
    try:
        for entity in document.modelspace():
            reader.take(entity, 0)
    except PictureError:
        raise
    except Exception:  # what ezdxf raises of damaged entities is of many kinds
        raise damaged() from None
    from ezdxf.enums import InsertUnits
    from ezdxf.units import conversion_factor

    box = find_box(reader.lines)
    content, aspect = pack(reader.lines, box, is_down=False)
    code, factor = document.header.get("$INSUNITS", 0), 0.0
    with suppress(ValueError, TypeError, KeyError, ZeroDivisionError):
        factor = float(conversion_factor(InsertUnits(code), InsertUnits.Meters)) if code else 0.0
    width = factor * (box[2] - box[0]) if 0 < factor < math.inf else None
    return content, aspect, describe_left_out(reader.left_out), width


def _open(data: bytes) -> "Document":
    try:
        from ezdxf import recover
    except ImportError:
        raise PictureError.about(
            "DXF is read with ezdxf, which is not installed. Save the drawing as SVG or PNG, or install ezdxf. {how}",
            how=say_install("plans"),
        ) from None
    logging.getLogger("ezdxf").setLevel(logging.CRITICAL)
    try:
        elements = 0  # group code 0; tags are not kept meanwhile
        for at, tag in enumerate(recover.bytes_loader(io.BytesIO(data)), start=1):
            elements += tag.code == 0
            if elements > MOST_ELEMENTS:
                raise too_many()
            if at > MOST_TAGS:
                raise PictureError.about(
                    "it has more than {most:,} group codes. Save the walls and doors alone", most=MOST_TAGS
                )
        document, _auditor = recover.read(io.BytesIO(data))
    except PictureError:
        raise
    except Exception:  # whatever the library raises
        raise damaged() from None
    if b"EOF" not in data[-64:] and not data.startswith(b"AutoCAD Binary"):
        raise damaged()
    return document


class _Reader:
    def __init__(self, document: "Document") -> None:
        self.blocks = document.blocks
        self.hidden = {layer.dxf.name.lower() for layer in document.layers if layer.is_off() or layer.is_frozen()}
        self.lines: list[list[tuple[float, float]]] = []
        self.left_out: Counter[str] = Counter()
        self._entities = self._points = self._inserts = 0

    def take(self, entity: Any, depth: int) -> None:
        self._entities += 1
        if self._entities > MOST_ELEMENTS:
            raise too_many()
        if entity.dxf.get("layer", "0").lower() in self.hidden or entity.dxf.get("invisible", 0):
            return
        kind = entity.dxftype()
        if kind in DRAWN:
            self._draw(entity)
        elif kind == "INSERT":
            self._inserts += 1
            if self._inserts > MOST_INSERTS:
                raise too_many()
            block = self.blocks.get(entity.dxf.name)
            if block is None or depth >= DEEPEST:
                self.left_out["INSERT"] += 1
            elif block.block is not None and block.block.dxf.get("flags", 0) & XREF:
                self.left_out[f"XREF {entity.dxf.name}"] += 1
            elif entity.mcount > 1:
                for one in entity.multi_insert():
                    self.take(one, depth)
            else:
                for one in entity.virtual_entities():
                    self.take(one, depth + 1)
        elif kind not in SILENT:
            self.left_out[kind] += 1

    def _draw(self, entity: Any) -> None:
        from ezdxf.path import make_path

        try:
            path = make_path(entity)
        except TypeError:
            return
        for part in path.sub_paths():
            line = [(point.x, point.y) for point in part.approximate(CHORDS)]
            self._points += len(line)
            if self._points > MOST_RAW:
                raise too_many()
            if not all(abs(x) <= FARTHEST and abs(y) <= FARTHEST for x, y in line):
                raise damaged()
            if len(line) > 1:
                self.lines.append(line)
