"""Targets whose input is a drawing of a plan: SVG and DXF."""

import random
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from assess.pictures import PictureError
from assess.plans import read_plan
from assess.plans.linework import MOST_POINTS, unpack
from tests.fuzz.engine import BrokenRuleError
from tests.fuzz.havoc import NUMBERS, mangle
from tests.fuzz.plain_targets import FURTHER, check_message, keep
from tests.plans.drawings import PLAN_SVG, dxf, svg


class Plans:
    """SVG and DXF files, told apart by how they begin."""

    suffix, most_seconds, further = ".bin", 10.0, FURTHER
    tokens = (
        *NUMBERS, b"<g transform='", b"matrix(1 0 0 1 9 9)", b"rotate(", b"scale(1e8)", b"skewX(90)", b"M",
        b"a1 1 0 01",
        b"c", b"T", b"z", b"<svg ", b"viewBox='0 0 1 1'", b"width='1mm'", b"<!ENTITY a 'b'>", b"&a;", b"]]>", b"<!--",
        b"display:none", b"\xff\xfe", b"\0", b"\n 10\n", b"\n 0\nINSERT\n", b"\n 2\nDOOR\n", b"\n 70\n", b"$INSUNITS",
        b"\nENDSEC\n", b"EOF\n", b"SPLINE", b"LWPOLYLINE", b"ELLIPSE", b"HATCH", b"\n 43\n", b"*U1",
    )  # fmt: skip

    def seeds(self) -> Sequence[bytes]:
        """Return drawings with every shape."""
        shapes = "<g transform='rotate(9 1 2) skewY(3)'><circle r='9'/><ellipse rx='4' ry='5'/>"
        shapes += "<polygon points='0 0 9 9 9 0'/><path style='fill:none' stroke='red' "
        shapes += "d='M0 0c1 1 2 2 3 3S4 4 5 5Q6 6 7 7T8 8A3 4 5 0 1 9 9H5v1z'/></g>"
        return [PLAN_SVG, svg(shapes), svg("<line x2='3in'/>", "<svg width='9cm' height='5cm'>"), dxf()]

    def mutate(self, draw: random.Random, data: bytes, pool: Sequence[bytes]) -> bytes:
        """Change bytes."""
        return mangle(draw, data, pool, self.tokens, 3)

    def check(self, data: bytes, folder: Path, *, deep: bool) -> str:
        """Read it as `assess check` does; what is kept of it are lines inside its frame."""
        del folder, deep
        try:
            found = read_plan(data, 10.0)
        except PictureError as error:
            check_message(error, "")
            return "refused"
        if not found.is_lines:
            raise BrokenRuleError("a picture out of a drawing")
        lines = unpack(found.content)
        points = np.concatenate(lines)
        keep(0 < len(points) <= MOST_POINTS, "no lines, or too many")
        keep(0 < found.aspect < np.inf, "no height")
        keep(bool((points > -1e-6).all() and (points[:, 0] < 1 + 1e-6).all()), "points outside the frame")
        keep(bool((points[:, 1] <= found.aspect * (1 + 1e-6)).all()), "points above the frame")
        keep(found.width is None or 0 < found.width < np.inf, "no width")
        return "read"
