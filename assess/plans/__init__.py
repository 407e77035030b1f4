"""Plans of floors that users hand over: pictures, and drawings of which the lines alone are kept.

Nothing of a user's file reaches a report as it is: a picture is decoded and written anew in grey, and of a drawing
(SVG, DXF) the lines that are understood are kept as points.
"""

from dataclasses import dataclass

from assess.pictures import JPEG, PNG, PictureError, prepare_plan

DOTS = 100.0  # pixels to a metre of a plan that a report embeds
LEAST, MOST = 600, 2400  # pixels of its longer side: at least where the file has as many, and at most
MOST_FILE = 10 * 2**20  # bytes of a DXF drawing; an SVG and a picture may have as many


@dataclass(frozen=True, slots=True)
class Drawing:
    """What is kept of a plan's file.

    `content` is a grey JPEG or, if `is_lines`, points of lines as `assess.plans.linework.pack` keeps them; `aspect` is
    height over width [-], `width` that of the whole [m] where the file tells its units. `left_out` is not drawn.
    """

    content: bytes
    aspect: float
    is_lines: bool = False
    width: float | None = None
    left_out: tuple[str, ...] = ()


def read_plan(data: bytes, width: float | None) -> Drawing:
    """Return what is kept of a PNG, JPEG, SVG or DXF file, by its content; of a picture 100 pixels to each metre of
    `width`. Raises PictureError if it is none of these, is too large or damaged, or cannot be read here; with how to
    fix it.
    """
    if is_picture(data):
        content, aspect = prepare_plan(data, count_side(width))
        return Drawing(content, aspect)
    if data.startswith(b"AC10"):
        raise PictureError.about("it is a DWG drawing, which cannot be read. Save it as DXF")
    # a DXF begins in binary form, or as text after comments (999)
    lines = [line.strip() for line in data[:4096].removeprefix(b"\xef\xbb\xbf").splitlines()]
    while len(lines) > 1 and lines[0] == b"999":
        lines = lines[2:]
    if data.startswith(b"AutoCAD Binary DXF") or lines[:2] == [b"0", b"SECTION"]:
        if len(data) > MOST_FILE:
            raise PictureError.about("it is larger than {most} MB. Save it smaller", most=MOST_FILE >> 20)
        from assess.plans.dxf import read_dxf

        content, aspect, left_out, drawn_width = read_dxf(data)
    elif b"<svg" in data[:65536] or "<svg".encode("utf-16-le") in data[:65536]:
        from assess.plans.svg import read_svg

        (content, aspect, left_out), drawn_width = read_svg(data), None
    else:
        raise PictureError.about("it is no PNG, JPEG, SVG or DXF file. Save it as one of them")
    return Drawing(content, aspect, is_lines=True, width=drawn_width, left_out=left_out)


def count_side(width: float | None) -> int:
    """Return how many pixels the longer side of a picture has at most, by the width of the plan [m]."""
    return MOST if width is None else round(min(max(DOTS * width, LEAST), MOST))


def is_picture(data: bytes) -> bool:
    """Tell whether a file begins as PNG or JPEG does."""
    return data.startswith((PNG, JPEG))
