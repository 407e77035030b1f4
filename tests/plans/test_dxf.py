"""DXF plans, read with ezdxf."""

import sys

import numpy as np
import pytest
from ezdxf import recover
from ezdxf.filemanagement import new

from assess.pictures import PictureError
from assess.plans import read_plan
from assess.plans.linework import unpack
from tests.plans.drawings import dxf, read_apart, write


def test_lines_with_the_width_that_the_units_tell():
    drawing = read_plan(dxf(), None)
    assert (drawing.width, drawing.aspect, drawing.left_out) == (16.0, 0.75, ("1 TEXT",))
    frame, wall, arc, door = unpack(drawing.content)
    np.testing.assert_allclose(frame, [(0, 0), (1, 0), (1, 0.75), (0, 0.75), (0, 0)])
    np.testing.assert_allclose(wall, [(0.5, 0.3125), (0.5, 0.75)])
    np.testing.assert_allclose(np.hypot(arc[:, 0] - 0.5, arc[:, 1] - 0.3125), 900 / 16000, rtol=1e-3)
    np.testing.assert_allclose(door, [(0.25, 0.375), (0.25 + 900 / 16000, 0.375)])  # what a block holds, scaled


@pytest.mark.parametrize(("units", "width"), [(0, None), (1, 406.4), (4, 16.0), (6, 16000.0), (999, None)])
def test_units(units, width):
    assert read_plan(dxf(units), None).width == (None if width is None else pytest.approx(width))


def test_other_files_are_never_read_and_named():
    assert set(read_plan(dxf(xref=True), None).left_out) == {"1 TEXT", "1 XREF OTHER"}


def test_a_truncated_drawing_is_damaged():
    whole = dxf()
    for share in (0.3, 0.6, 0.9, 0.99):
        with pytest.raises(PictureError, match="damaged"):
            read_plan(whole[: int(share * len(whole))], None)


def nested(document):
    """Blocks of two blocks each, 30 deep: a thousand million inserts."""
    document.blocks.new("B0")
    for at in range(1, 31):
        block = document.blocks.new(f"B{at}")
        block.add_blockref(f"B{at - 1}", (0, 0))
        block.add_blockref(f"B{at - 1}", (1, 1))
    document.modelspace().add_blockref("B30", (0, 0))


def repeated(document):
    document.blocks.new("B").add_line((0, 0), (1, 1))
    document.modelspace().add_blockref(
        "B", (0, 0), dxfattribs={"row_count": 30000, "column_count": 30000, "row_spacing": 2, "column_spacing": 2}
    )


def far(document):
    document.modelspace().add_line((0, 0), (1e300, 5))


def flat(document):
    document.modelspace().add_line((0, 0), (5, 0))


@pytest.mark.parametrize(
    ("fill", "message"),
    [(nested, "more than 100,000"), (repeated, "more than 100,000"), (far, "damaged"), (flat, "no lines")],
)  # fmt: skip
@pytest.mark.slow
def test_what_cannot_be_used(fill, message):
    document = new()
    fill(document)
    with pytest.raises(PictureError, match=message):
        read_plan(write(document), None)


def text_dxf(content):
    return b"0\nSECTION\n2\nENTITIES\n" + content + b"0\nENDSEC\n0\nEOF\n"


@pytest.mark.parametrize(
    ("content", "message"),
    [(b"0\nX\n" * 100_000, "more than 100,000 elements"), (b" 000 \r\nX\r\n" * 100_000, "more than 100,000 elements"),
     (b"0\nTEXT\n" + b"1\nX\n" * 1_000_000, "more than 1,000,000 group codes"),
     (b"999\nnote\n" * 1_200_000, "larger than 10 MB")],
    ids=["elements", "other zeros", "tags", "bytes"],
)  # fmt: skip
def test_a_large_drawing_is_refused_before_ezdxf_builds_it(content, message, monkeypatch):
    built = []
    monkeypatch.setattr(recover, "read", lambda *_: built.append(1))
    with pytest.raises(PictureError, match=message):
        read_plan(text_dxf(content), None)
    assert not built


@pytest.mark.slow
def test_values_of_zero_are_no_elements():
    lines = b"0\nLINE\n8\n0\n10\n0\n20\n0\n11\n9\n21\n9\n" + b"62\n0\n" * 100_001
    assert len(unpack(read_plan(text_dxf(lines), None).content)) == 1


def test_memory_of_a_large_drawing(tmp_path):
    path = tmp_path / "x.dxf"
    path.write_bytes(text_dxf(b"0\nX\n" * 1_000_000))
    assert "more than 100,000 elements" in read_apart(path)


def test_without_ezdxf_one_line_says_what_to_install(monkeypatch):
    data = dxf()
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(PictureError, match=r"Save the drawing as SVG or PNG.* pip install '\.\[plans\]'"):
        read_plan(data, None)
