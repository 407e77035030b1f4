"""SVG plans: what is drawn of them, and that nothing else of a file comes through."""

import math

import numpy as np
import pytest

from assess.pictures import PictureError
from assess.plans import read_plan, svg as svg_file
from assess.plans.linework import unpack
from tests.plans.drawings import PLAN_SVG, read_apart, svg

UNREADABLE = "a path, a number or a transform in it cannot be read"


def lines_of(content, **head):
    return unpack(read_plan(svg(content, **head), 16.0).content)


def test_lines_are_in_shares_of_the_width_from_the_lower_left():
    drawing = read_plan(PLAN_SVG, 16.0)
    assert (drawing.is_lines, drawing.aspect, drawing.width, drawing.left_out) == (True, 0.75, None, ())
    box, path = unpack(drawing.content)
    np.testing.assert_allclose(box, [(0, 0.75), (1, 0.75), (1, 0), (0, 0), (0, 0.75)])
    np.testing.assert_allclose(path, [(0.5, 0.75), (0.5, 0.3125), (0, 0.3125)], rtol=1e-6)


@pytest.mark.parametrize(
    ("content", "last"),
    [
        ("<path d='M0,0 10-10.5.5'/>", None),  # an odd number of coordinates
        ("<path d='m100 100 200 0z m 0 100h50'/>", (150, 200)),
        ("<path d='M0 0C100 0 200 100 200 200S300 400 400 400'/>", (400, 400)),
        ("<path d='M0 0Q100 0 200 200T400 400'/>", (400, 400)),
        ("<path d='M100 100a50 50 0 01100 0'/>", (200, 100)),
        ("<path d='M1e2 1.5e+2L2E2.5'/>", (200, 0.5)),
        ("<line x1='0' y1='1in' x2='2in' y2='96px'/>", (192, 96)),
        ("<polyline points='0,0 10,10 20 30'/>", (20, 30)),
        ("<polygon points='0,0 10,10 20 30'/>", (0, 0)),
        ("<g transform='translate(100) rotate(90) scale(2 1)'><line x2='50' y2='0'/></g>", (100, 100)),
        ("<g transform='matrix(1 0 0 1 5 6)'><line x2='50' transform='skewX(45)' y2='10'/></g>", (65, 16)),
        ("<line x2='100' y2='0' transform='rotate(90 50 0)'/>", (50, 50)),
    ],
)  # fmt: skip
def test_shapes_and_transforms(content, last):
    if last is None:
        with pytest.raises(PictureError, match=UNREADABLE):
            lines_of(content)
        return
    x, y = lines_of(content)[-1][-1]
    assert (1600 * x, 1200 - 1600 * y) == pytest.approx(last, abs=2e-3)


def test_curves_are_chords_on_the_curve():
    (circle,) = lines_of("<circle cx='800' cy='600' r='400'/>")
    radius = np.hypot(circle[:, 0] - 0.5, circle[:, 1] - 0.375)
    assert len(circle) == 33
    np.testing.assert_allclose(radius, 0.25, rtol=1e-3)
    (ellipse,) = lines_of("<ellipse cx='800' cy='600' rx='400' ry='200'/>")
    assert np.ptp(ellipse, axis=0) == pytest.approx([0.5, 0.25], rel=1e-3)
    (arc,) = lines_of("<path d='M400 600A400 400 0 1 1 800 1000'/>")  # three quarters, clockwise as drawn
    np.testing.assert_allclose(np.hypot(arc[:, 0] - 0.5, arc[:, 1] - 0.375), 0.25, rtol=1e-5)
    turned = np.unwrap(np.arctan2(arc[:, 1] - 0.375, arc[:, 0] - 0.5))
    assert turned[-1] - turned[0] == pytest.approx(-1.5 * math.pi, rel=1e-4)


def test_what_is_hidden_or_beyond_the_frame_is_not_drawn():
    hidden = "<g display='none'><line x2='9' y2='9'/></g><line x2='9' y2='9' style='fill:none;display:none'/>"
    hidden += (
        "<rect width='50' height='50' fill='none'/><path d='M-100 10H-5'/><g visibility='hidden'><path d='M0 0H9'/></g>"
    )
    (line,) = lines_of(f"{hidden}<path d='M-800 600H2400'/>")
    np.testing.assert_allclose(line, [(0, 0.375), (1, 0.375)])


@pytest.mark.parametrize("off", ["display='none'", "style='display:none'"])
def test_a_layer_that_is_off_hides_all_in_it(off):
    shown = "<path style='display:inline;visibility:visible' stroke='#000' d='M0 0H9'/>"
    layer = f"<g {off}>{shown}<g display='inline'>{shown}</g></g>"
    (line,) = lines_of(f"{layer}<path d='M0 600H1600'/>")
    np.testing.assert_allclose(line, [(0, 0.375), (1, 0.375)])
    (line,) = lines_of(f"<g visibility='hidden'>{shown}</g>")  # unlike visibility, which a shape may take back
    np.testing.assert_allclose(line, [(0, 0.75), (9 / 1600, 0.75)])


def test_the_frame_is_the_viewbox_else_the_size_else_the_lines():
    size = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='50mm'>"
    assert read_plan(svg("<path d='M0 0L10 10'/>", size), None).aspect == pytest.approx(0.5)
    bare = "<svg xmlns='http://www.w3.org/2000/svg' width='100%'>"
    drawing = read_plan(svg("<path d='M10 10L30 20'/>", bare), None)
    assert drawing.aspect == pytest.approx(0.5)
    np.testing.assert_allclose(unpack(drawing.content)[0], [(0, 0.5), (1, 0)])


HOSTILE = (
    "<script>fetch('http://evil.example')</script><image href='http://evil.example/x.png' width='9' height='9'/>"
    "<use href='http://evil.example#a'/><foreignObject><iframe src='http://evil.example'/></foreignObject>"
    "<style>@import url(http://evil.example)</style><a href='javascript:alert(1)'><path d='M0 0H9'/></a>"
    "<text onclick='alert(1)'>name</text><path onload='alert(1)' style='fill:url(http://evil.example)' d='M0 0H800'/>"
)


def test_nothing_but_lines_comes_through():
    drawing = read_plan(svg(HOSTILE), 16.0)
    (line,) = unpack(drawing.content)
    np.testing.assert_allclose(line, [(0, 0.75), (0.5, 0.75)])
    assert set(drawing.left_out) == {"1 script", "1 image", "1 use", "1 foreignObject", "1 a", "1 text"}
    assert b"evil" not in drawing.content


BOMB = "".join(f'<!ENTITY e{n} "{10 * one}">' for n, one in enumerate((f"&e{n};" for n in range(9)), start=1))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (f'<!DOCTYPE svg [<!ENTITY e0 "x">{BOMB}]>'.encode() + svg("<text>&e9;</text>"), "declares XML entities"),
        (b'<!DOCTYPE svg [<!ENTITY x SYSTEM "file:///etc/passwd">]>' + svg("<text>&x;</text>"),
         "declares XML entities"),
        (svg("<g/>" * 100_001), "more than 100,000 elements"),
        (svg("<g>" * 1_000_000), "more than|damaged"),
        (svg("<g>" * 200 + "</g>" * 200), "damaged"),
        (svg("<path d='M0 0L1e300 5'/>"), UNREADABLE),
        (svg("<path d='M0 0L1e999 5'/>"), UNREADABLE),
        (svg("<path d='M0 0LNaN 5'/>"), UNREADABLE),
        (svg("<path d='L5 5'/>"), UNREADABLE),
        (svg("<path d='M0 0Z5 5'/>"), UNREADABLE),
        (svg("<path d='M0 0A5 5 0 2 0 9 9'/>"), UNREADABLE),
        (svg("<rect width='nan' height='5'/>"), UNREADABLE),
        (svg("<rect width='5furlongs' height='5'/>"), UNREADABLE),
        (svg("<g transform='scale(1e9)'><g transform='scale(1e9)'><line x2='1e9' y2='1'/></g></g>"), UNREADABLE),
        (svg("<g transform='url(#a)'/>"), UNREADABLE),
        (svg(f"<polyline points='{'1' * 100_000}x'/>"), UNREADABLE),
        (svg(f"<rect width='5{' ' * 100_000}!' height='5'/>"), UNREADABLE),
        (svg("<path d='M0 0H9'/>", "<svg viewBox='0 0 0 5'>"), UNREADABLE),
        (svg("<path d='M0 0H9'/>", "<svg viewBox='0 0 inf 5'>"), UNREADABLE),
        (svg("<path d='M0 0H9V9'/>", "<svg viewBox='0 0 1e-300 5'>"), "holds no lines"),
        (svg(""), "holds no lines"),
        (svg("<path d='M0 0H9'/>", "<svg>"), "holds no lines"),  # no frame, and no height
        (PLAN_SVG[:-4], "damaged"),
        (PLAN_SVG + b" " * (10 * 2**20), "larger than 10 MB"),
        (b"<html><svg/></html>", "no PNG, JPEG, SVG or DXF file"),
        (b"AC1032" + bytes(100), "is a DWG drawing, which cannot be read. Save it as DXF"),
        (b"%PDF-1.7", "no PNG, JPEG, SVG or DXF file"),
    ],
    ids=range(27),
)  # fmt: skip
def test_what_cannot_be_used(data, message):
    with pytest.raises(PictureError, match=message):
        read_plan(data, 16.0)


@pytest.mark.parametrize(
    "content",
    [
        f"<path d='M0 0{'l1 9-1-9' * 31_000}'/>",
        f"<path d='M0 0{'c1 1 2 2 3 3' * 3_000}'/>",
        f"<path d='M0 0 1 1{'z' * 25_000}'/>",
        f"<path d='M0 0 1 1{'z' * 4_500}'/>" * 5,
        f"<path d='{'M0 0' * 4_500}'/>" * 5,
        f"<polyline points='{'0 ' * 40_001}'/>",
    ],
    ids=range(6),
)
def test_more_points_than_are_read(monkeypatch, content):
    """With a twentieth of the limit, whose memory is measured below."""
    monkeypatch.setattr(svg_file, "MOST_RAW", 20_000)
    with pytest.raises(PictureError, match="60,000 points"):
        read_plan(svg(content), 16.0)


@pytest.mark.parametrize(
    ("before", "item"),
    [
        pytest.param("<polyline points='", "0 ", marks=pytest.mark.long),
        pytest.param("<path d='M0 0 1 1", "z", marks=pytest.mark.slow),
    ],
)
def test_memory_of_a_large_drawing(tmp_path, before, item):
    path = tmp_path / "x.svg"
    path.write_bytes(svg(f"{before}{item * (10_000_000 // len(item))}'/>"))
    assert "60,000 points" in read_apart(path)


def test_a_document_type_without_entities_is_read():
    kind = b'<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">'
    assert len(unpack(read_plan(b'<?xml version="1.0"?>' + kind + PLAN_SVG, 1.0).content)) == 2
