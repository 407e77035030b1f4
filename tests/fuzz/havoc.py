"""Bytes changed at random: what all targets share."""

import random
import re
from collections.abc import Sequence

LARGEST = 200_000
"""Bytes of an input: size is a matter of bounds, which have tests of their own."""
_NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
NUMBERS = [
    b"0", b"-1", b"1", b"2", b"nan", b"inf", b"-inf", b"1e999", b"-1e999", b"1e-320", b"9999999999", b"-32768",
    b"65536", b"2147483648", b"18446744073709551616", b"0.1", b"1_0", b"0x10", b"1,5", b"", b"1e5", b"00", b"+3",
    b".", b"e",
]  # fmt: skip


def mangle(draw: random.Random, data: bytes, pool: Sequence[bytes], tokens: Sequence[bytes], most: int = 6) -> bytes:
    """Return `data` after one to `most` small changes."""
    for _ in range(1 << draw.randrange(most.bit_length())):
        data = draw.choice(_CHANGES)(draw, data, pool, tokens)
    return data[:LARGEST]


def _place(draw: random.Random, data: bytes) -> int:
    """Return a place, mostly in the head, where formats have what decides."""
    return draw.randrange(min(len(data), draw.choice((60, 600, 4000, LARGEST))) + 1)


def _flip(draw: random.Random, data: bytes, *_: object) -> bytes:
    at = _place(draw, data)
    return data[:at] + draw.randbytes(draw.choice((1, 1, 2, 4))) + data[at + draw.choice((1, 1, 2, 4)) :]


def _bit(draw: random.Random, data: bytes, *_: object) -> bytes:
    at = _place(draw, data)
    return data[:at] + bytes([data[at] ^ (1 << draw.randrange(8))]) + data[at + 1 :] if at < len(data) else data


def _drop(draw: random.Random, data: bytes, *_: object) -> bytes:
    at = _place(draw, data)
    return data[:at] + data[at + draw.choice((1, 4, 80, 1000)) :]


def _cut(draw: random.Random, data: bytes, *_: object) -> bytes:
    return data[: draw.randrange(len(data) + 1)]


def _repeat(draw: random.Random, data: bytes, *_: object) -> bytes:
    at, size = _place(draw, data), draw.choice((1, 4, 80, 1000))
    return data[:at] + data[at : at + size] * draw.choice((2, 3, 50)) + data[at + size :]


def _token(draw: random.Random, data: bytes, _pool: Sequence[bytes], tokens: Sequence[bytes]) -> bytes:
    at, token = _place(draw, data), draw.choice(tokens)
    return data[:at] + token + data[at + draw.choice((0, len(token), 1)) :]


def _number(draw: random.Random, data: bytes, *_: object) -> bytes:
    """Exchange a number that is written in digits."""
    found = list(_NUMBER.finditer(data, 0, draw.choice((300, 4000, LARGEST))))
    if not found:
        return data
    one = draw.choice(found)
    near = [str(int(one[0]) + draw.choice((-1, 1))).encode()] if one[0].isdigit() and len(one[0]) < 30 else []
    return data[: one.start()] + draw.choice([*NUMBERS, *near * 5]) + data[one.end() :]


def _line(draw: random.Random, data: bytes, *_: object) -> bytes:
    """Leave out, repeat or exchange lines."""
    lines = data.split(b"\n")
    one, other = draw.randrange(len(lines)), draw.randrange(min(len(lines), 60))
    what = draw.randrange(3)
    if what == 0:
        del lines[other]
    elif what == 1:
        lines.insert(other, lines[one])
    else:
        lines[one], lines[other] = lines[other], lines[one]
    return b"\n".join(lines)


def _splice(draw: random.Random, data: bytes, pool: Sequence[bytes], *_: object) -> bytes:
    other = draw.choice(pool)
    at = draw.randrange(len(other) + 1)
    return data[: _place(draw, data)] + other[at : at + draw.choice((20, 500, LARGEST))]


_CHANGES = (_flip, _bit, _drop, _cut, _repeat, _token, _token, _number, _number, _line, _splice)
