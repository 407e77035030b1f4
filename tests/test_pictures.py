"""Pictures that users hand over: measured before they are decoded, decoded before a report needs them."""

import io
import struct
from itertools import product

import numpy as np
import pytest
from PIL import Image, ImageOps
from PIL.PngImagePlugin import PngInfo

from assess import pictures
from assess.pictures import (
    MOST_PIXELS,
    PHOTO,
    SHOWN,
    PictureError,
    check_picture,
    count_pixels,
    prepare_photo,
    prepare_picture,
    prepare_plan,
)
from tests.pictures import claim_size, leave_out, picture
from tests.refusals import check_refusals

PNG, JPEG = picture("PNG"), picture("JPEG")
DAMAGED = r"^it is damaged\. Open it in a graphics program and save it again$"


def read(data: bytes) -> Image.Image:
    shown = Image.open(io.BytesIO(data))
    shown.load()
    return shown


def test_sound_pictures_are_embedded_as_they_are() -> None:
    for data in (PNG, JPEG, picture("JPEG", progressive=True), picture("PNG", "P"), picture("PNG", "1")):
        check_picture(data)
        assert count_pixels(data) == 1200
        assert prepare_picture(data) == (data, "image/png" if data.startswith(b"\x89PNG") else "image/jpeg")


def test_the_size_of_a_jpeg_stands_behind_other_segments() -> None:
    other = b"\xff\xff\xff\xe1" + struct.pack(">H", 12) + b"\xff\xc0\0\x0b\x08\xff\xff\xff\xff\x03"
    padded = JPEG[:2] + other + JPEG[2:]
    assert count_pixels(padded) == 1200
    check_picture(padded)


WRONG = [
    (b"", r"it is no PNG or JPEG picture\. Save it as PNG or JPEG"),
    (b"GIF89a" + bytes(50), r"it is no PNG or JPEG picture"),
    (b"\x89PNG\r\n\x1a\n" + bytes(100), DAMAGED),
    (PNG[:20], DAMAGED),
    (PNG[:-20], DAMAGED),
    (PNG[:33], DAMAGED),
    (PNG[:50] + b"\0\0" + PNG[52:], DAMAGED),  # the sum of its data is wrong
    (PNG[:30] + b"\0\0" + PNG[32:], DAMAGED),  # and that of its header
    (claim_size(PNG, 0, 30), DAMAGED),
    (leave_out(picture("PNG", "P"), b"PLTE"), DAMAGED),  # no palette: browsers show nothing
    (PNG[:-16] + b"\0\0\0\0" + PNG[-12:], DAMAGED),
    (claim_size(PNG, 12_000, 12_000), r"it has 144 million pixels, expected at most 50\. Save it smaller"),
    (JPEG[:3], DAMAGED),
    (JPEG[: len(JPEG) // 2], DAMAGED),
    (b"\xff\xd8" + b"\xff\xe0\0\0" * 20, DAMAGED),
    (b"\xff\xd8\xff\xc0\0\x11\x08\xff\xff\xff\xff\x03", r"it has 4295 million pixels"),
    (PNG + bytes(10 * 2**20), r"it is larger than 10 MB\. Save it smaller"),
]


def test_what_is_wrong_is_told_and_nothing_is_decoded_beyond_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    for use in (check_picture, prepare_picture):
        check_refusals(PictureError, use, WRONG)
    for other in (prepare_photo, lambda data: prepare_plan(data, 300)):
        check_refusals(PictureError, other, ((data, "") for data, _ in WRONG))
    monkeypatch.setattr(Image, "open", pytest.fail)
    side = int(MOST_PIXELS**0.5) + 1
    with pytest.raises(PictureError, match="million pixels"):
        check_picture(claim_size(PNG, side, side))


def test_large_pictures_are_made_smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pictures, "STRIP", 7)
    for mode in ("RGB", "RGBA", "L", "LA", "1", "P", "I;16"):
        large = picture("PNG", mode, (2 * SHOWN + 50, 300))
        data, kind = prepare_picture(large)
        small = read(data)
        assert (small.format, kind, small.size) == ("PNG", "image/png", (1084, 100)), mode
        assert (small.mode in ("RGBA", "LA")) == (mode in ("RGBA", "LA")), mode
        if mode.startswith("RGB"):
            assert small.convert("RGB").getpixel((500, 40)) == (200, 30, 30)
            assert small.convert("RGB").getpixel((600, 60)) == (0, 0, 0)
        content, aspect = prepare_plan(large, 300)
        assert read(content).size[0] == 300
        assert aspect == pytest.approx(300 / (2 * SHOWN + 50), abs=2e-3)
        assert read(prepare_photo(large)).size[0] == PHOTO
    data, kind = prepare_picture(picture("JPEG", "RGB", (5000, 300)))
    assert (read(data).format, kind) == ("JPEG", "image/jpeg")
    assert max(read(data).size) <= SHOWN


def test_sixteen_bits_of_grey_become_eight() -> None:
    deep = Image.new("I;16", (20, 10), 30_000)
    target = io.BytesIO()
    deep.save(target, "PNG")
    data, _ = prepare_picture(target.getvalue())
    assert Image.open(io.BytesIO(data)).getpixel((3, 3)) == (117, 117, 117)


def _with_marks(kind: str, orientation: int | None = None) -> bytes:
    """Return a picture that tells its camera, its place and a comment."""
    exif = Image.Exif()
    exif[0x010F] = "SECRET CAMERA"
    if orientation is not None:
        exif[0x0112] = orientation
    told = PngInfo()
    told.add_text("Comment", "SECRET PLACE")
    more = {"pnginfo": told} if kind == "PNG" else {"comment": b"SECRET PLACE", "xmp": b"<x>SECRET AUTHOR</x>"}
    return picture(kind, exif=exif, **more)


def test_what_the_camera_wrote_is_left_out_and_nothing_else_changes() -> None:
    for kind, orientation in product(("PNG", "JPEG"), (None, 1, 6, 99)):
        marked = _with_marks(kind, orientation)
        assert b"SECRET" in marked
        data, _ = prepare_picture(marked)
        assert b"SECRET" not in data
        shown, meant = Image.open(io.BytesIO(data)), ImageOps.exif_transpose(Image.open(io.BytesIO(marked)))
        assert (shown.format, shown.size) == (kind, meant.size)
        off = np.abs(np.asarray(shown, int) - np.asarray(meant, int))
        assert off.max() <= (40 if kind == "JPEG" and orientation == 6 else 0), (kind, orientation)


# ---------------------------------------------------------------- photos and plans


def test_a_photo_is_small_and_upright_and_tells_nothing_of_the_camera() -> None:
    exif = Image.Exif()
    exif[0x0112], exif[0x010F] = 6, "Camera"  # turned to the right; its maker
    data = picture("JPEG", size=(2000, 1000), exif=exif)
    photo = prepare_photo(data)
    shown = read(photo)
    assert (shown.format, shown.size) == ("JPEG", (PHOTO // 2, PHOTO))
    assert b"Camera" not in photo
    assert not shown.getexif()
    quarters = [np.asarray(shown)[at[1], at[0], 0] for at in ((250, 50), (50, 50), (250, 550))]
    assert quarters[0] > 150  # what was on the upper left is on the upper right
    assert max(quarters[1:]) < 50
    assert read(prepare_photo(picture("PNG", size=(40, 30)))).size == (40, 30)  # not made larger


def test_a_plan_is_grey_on_white() -> None:
    content, aspect = prepare_plan(picture("PNG", size=(1600, 1200)), 400)
    shown = read(content)
    assert (shown.mode, shown.size, aspect) == ("L", (400, 300), 0.75)
    clear = Image.new("RGBA", (20, 10), (0, 0, 0, 0))
    target = io.BytesIO()
    clear.save(target, "PNG")
    assert read(prepare_plan(target.getvalue(), 400)[0]).getextrema() == (255, 255)
