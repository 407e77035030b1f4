"""Pictures for tests: sound ones, and what is wrong with others."""

import io
import struct
import zlib
from typing import Any

from PIL import Image


def picture(kind: str, mode: str = "RGB", size: tuple[int, int] = (40, 30), **options: Any) -> bytes:
    """Return a picture of two colours."""
    drawn = Image.new(mode, size)
    drawn.paste(1, (0, 0, size[0] // 2, size[1] // 2)) if mode in {"1", "P", "L", "I;16"} else drawn.paste(
        (200, 30, 30, 255)[: len(mode)], (0, 0, size[0] // 2, size[1] // 2)
    )
    target = io.BytesIO()
    drawn.save(target, kind, **options)
    return target.getvalue()


def claim_size(png: bytes, width: int, height: int) -> bytes:
    """Return a PNG with another size in its header, and the sum of that header right."""
    header = b"IHDR" + struct.pack(">II", width, height) + png[24:29]
    return png[:12] + header + struct.pack(">I", zlib.crc32(header)) + png[33:]


def leave_out(png: bytes, name: bytes) -> bytes:
    """Return a PNG without its parts of a name."""
    at, kept = 8, png[:8]
    while at < len(png):
        end = at + 12 + int(struct.unpack_from(">I", png, at)[0])
        kept += b"" if png[at + 4 : at + 8] == name else png[at:end]
        at = end
    return kept
