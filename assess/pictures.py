"""Pictures that users hand over: PNG and JPEG, whose size is read from their headers before anything is decoded.

Sources: W3C (2003), Portable Network Graphics, second edition, 11.2.2 (IHDR); ITU-T T.81 (1992), JPEG, B.1 and B.2.2
(markers, frame header).
"""

import io
import math
import struct
from typing import TYPE_CHECKING

from assess.errors import InputError
from assess.i18n import fill

if TYPE_CHECKING:
    from PIL.Image import Image

MOST_BYTES = 10 * 2**20  # bytes of a picture's file
MOST_PIXELS = 50_000_000  # pixels of a picture [-]: they take up to 200 MB while it is decoded
SHOWN = 1600  # pixels [-] of the longer side that a report shows: 300 to the inch of a logo of 13 cm
PHOTO = 600  # pixels of the longer side of a photo
STRIP = 64  # rows of pixels of the smaller picture that are made at once

PNG, JPEG = b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff"  # the first bytes of each
_FORMATS = ("PNG", "JPEG")
_FRAMES = frozenset({*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC})
"""Markers of JPEG's frame headers; the three are of tables."""
_ALONE = frozenset({0x01, *range(0xD0, 0xD9)})  # markers without a length
_ORIENTATION = 0x0112  # tag of Exif: how a camera was held
_PRIVATE = frozenset({"exif", "xmp", "XML:com.adobe.xmp", "comment", "photoshop"})
"""What may tell who took a picture, where and when."""
_PRIVATE_CHUNKS = frozenset({b"tEXt", b"zTXt", b"iTXt", b"eXIf", b"tIME"})
_PRIVATE_SEGMENTS = frozenset({0xE1, *range(0xE3, 0xEE), 0xEF, 0xFE})
"""Markers of application data but JFIF, colour profile and Adobe's transform, and of comments."""
_SCAN, _FILL = 0xDA, 0xFF
_SHOWN_BY = frozenset({"transparency", "gamma", "icc_profile", "dpi"})  # what the look of a picture rests on


class PictureError(InputError):
    """A picture cannot be used."""


def count_pixels(data: bytes) -> int:
    """Return how many pixels a picture has by its header; PictureError if that is damaged, none, or too large."""
    size = _read_size(data)
    if math.prod(size) > MOST_PIXELS:
        message = fill(
            "it has {pixels:.0f} million pixels, expected at most {most:.0f}. Save it smaller",
            pixels=math.prod(size) / 1e6,
            most=MOST_PIXELS / 1e6,
        )
        raise PictureError(message)
    return math.prod(size)


def check_picture(data: bytes) -> None:
    """Decode a picture as reports do; PictureError, with how to fix it, if it is none, too large or damaged."""
    _decode(data)


def prepare_picture(data: bytes) -> tuple[bytes, str]:
    """Return the bytes of a picture as a report embeds it, and their media type; PictureError as `check_picture`.

    Large ones are made smaller; what the camera or the author wrote into it (place, date, comments) is left out.
    """
    picture = _decode(data)
    kind = "PNG" if data.startswith(PNG) else "JPEG"
    if max(_read_size(data)) > SHOWN or picture.mode.startswith("I"):  # 16 bits of grey, which the PDF does not show
        target = io.BytesIO()
        _reduce(picture, math.ceil(max(picture.size) / SHOWN)).save(target, kind, quality=90)
        data = target.getvalue()
    elif _PRIVATE.intersection(picture.info) or getattr(picture, "text", None):
        data = _without_private(data, picture, kind)
    return data, f"image/{kind.lower()}"


def _without_private(data: bytes, picture: "Image", kind: str) -> bytes:
    """Return a picture without its texts and what a camera wrote, upright; as few of its bytes change as can be."""
    from PIL import ImageOps

    is_turned = _is_turned(picture)
    if not is_turned and kind == "PNG":
        kept, at = [data[: len(PNG)]], len(PNG)
        while at < len(data):
            end = at + 12 + int.from_bytes(data[at : at + 4])
            kept += [] if data[at + 4 : at + 8] in _PRIVATE_CHUNKS else [data[at:end]]
            at = end
        return b"".join(kept)
    if not is_turned:
        kept, at = [data[:2]], 2
        while at + 4 <= len(data) and data[at] == _FILL:
            marker = data[at + 1]
            if marker == _SCAN:
                return b"".join((*kept, data[at:]))
            size = 0 if marker in _ALONE else int.from_bytes(data[at + 2 : at + 4])
            end = at + 1 if marker == _FILL else at + 2 + size
            kept += [] if marker in _PRIVATE_SEGMENTS else [data[at:end]]
            at = end
    # turned, or its segments do not follow each other
    upright, target = ImageOps.exif_transpose(picture) if is_turned else picture, io.BytesIO()
    upright.info = {name: value for name, value in picture.info.items() if name in _SHOWN_BY}
    upright.save(target, kind, quality=90, exif=b"")
    return target.getvalue()


def _is_turned(picture: "Image") -> bool:
    try:
        return picture.getexif().get(_ORIENTATION) in range(2, 9)
    except Exception:  # damaged Exif data, which change nothing else
        return False


def prepare_photo(data: bytes) -> bytes:
    """Return a photo as a small upright JPEG, without what the camera wrote; PictureError as `check_picture`."""
    return _write_jpeg(_shrink(data, PHOTO), 75)


def prepare_plan(data: bytes, most: int) -> tuple[bytes, float]:
    """Return a plan as a grey JPEG of at most `most` pixels on its longer side, and its height over its width [-].

    Raises PictureError as `check_picture`.
    """
    picture = _shrink(data, most).convert("L")
    return _write_jpeg(picture, 70), picture.height / picture.width


def _shrink(data: bytes, most: int) -> "Image":
    from PIL import Image, ImageOps

    picture = _decode(data, most)
    orientation = picture.getexif().get(_ORIENTATION) if _is_turned(picture) else None
    small = _reduce(picture, max(1, max(picture.size) // most))
    if small.mode == "RGBA":
        ground = Image.new("RGB", small.size, "white")
        ground.paste(small, mask=small.getchannel("A"))
        small = ground
    small.thumbnail((most, most))
    if orientation in range(2, 9):
        small.getexif()[_ORIENTATION] = orientation
        ImageOps.exif_transpose(small, in_place=True)
    return small


def _write_jpeg(picture: "Image", quality: int) -> bytes:
    target = io.BytesIO()
    picture.save(target, "JPEG", quality=quality, exif=b"")
    return target.getvalue()


def _decode(data: bytes, shown: int = SHOWN) -> "Image":
    from PIL import Image

    count_pixels(data)
    try:
        Image.open(io.BytesIO(data), formats=_FORMATS).verify()  # the sums of a PNG, which load() does not look at
        picture = Image.open(io.BytesIO(data), formats=_FORMATS)
        if picture.size != _read_size(data):
            raise ValueError("two sizes")
        picture.draft(None, (shown, shown))
        picture.load()
        if picture.mode == "P" and picture.palette is None:  # browsers show nothing of it
            raise ValueError("no palette")
    except Exception:  # what Pillow raises of damaged pictures is any of ten kinds
        raise damaged() from None
    return picture


def _reduce(picture: "Image", factor: int) -> "Image":
    """Return the picture smaller by a factor, made strip by strip: whole, a copy of it would be held next to it."""
    from PIL import Image

    width, height = picture.size
    mode = "RGBA" if picture.has_transparency_data else "RGB"
    small = Image.new(mode, (math.ceil(width / factor), math.ceil(height / factor)))
    for top in range(0, height, STRIP * factor):
        strip = picture.crop((0, top, width, min(top + STRIP * factor, height)))
        if picture.mode.startswith("I"):
            strip = strip.convert("I").point(lambda value: value * (1 / 256)).convert("L")
        small.paste(strip.convert(mode).reduce(factor), (0, top // factor))
    return small


def damaged() -> PictureError:
    """Build the error for a damaged file."""
    return PictureError(fill("it is damaged. Open it in a graphics program and save it again"))


def _read_size(data: bytes) -> tuple[int, int]:
    if len(data) > MOST_BYTES:
        raise PictureError(fill("it is larger than {most} MB. Save it smaller", most=MOST_BYTES >> 20))
    size = (0, 0)
    if data.startswith(PNG):
        if data[12:16] == b"IHDR" and len(data) >= 24:
            width, height = struct.unpack_from(">II", data, 16)
            size = width, height
    elif data.startswith(JPEG):
        at = 2
        while at + 9 <= len(data) and data[at] == 0xFF and data[at + 1] not in {0xD9, 0xDA}:
            marker = data[at + 1]
            if marker in _FRAMES:
                height, width = struct.unpack_from(">HH", data, at + 5)
                size = width, height
                break
            if marker == 0xFF or marker in _ALONE:  # the first fills up
                at += 1 if marker == 0xFF else 2
            else:
                at += 2 + int(struct.unpack_from(">H", data, at + 2)[0])
    else:
        raise PictureError(fill("it is no PNG or JPEG picture. Save it as PNG or JPEG"))
    if not (size[0] and size[1]):
        raise damaged()
    return size
