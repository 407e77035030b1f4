"""Damaged files, of which nothing but RecordError comes, and the reading of one channel."""

from collections.abc import Sequence

from hypothesis import strategies as st

from assess.motion.formats import Format
from assess.motion.record import Record

TOKENS = st.sampled_from([
    b"", b"nan", b"1E999", b"-inf", b"\0", b"9999999999", b"-32768", b"0.17E+39", b"1_0", b"\xff", b"\n", b"|", b"[g]",
    b";",
])  # fmt: skip


def read_only(made: Format, data: bytes) -> Record:
    """Return the only channel of a file."""
    (record,) = made.read(data, "made")
    return record


def changed(data: bytes, old: bytes, new: bytes) -> bytes:
    assert old in data
    return data.replace(old, new, 1)


class Damaged:
    """Bytes that are too many to show where a test fails."""

    def __init__(self, data: bytes) -> None:
        self.data = data

    def __repr__(self) -> str:
        return f"{self.data[:80]!r}... ({len(self.data)} bytes)"


@st.composite
def damaged(draw: st.DrawFn, files: Sequence[bytes]) -> Damaged:
    """Draw a sample that is cut short, or has some bytes replaced, mostly in its header."""
    data = files[draw(st.integers(0, len(files) - 1))]
    for _ in range(draw(st.integers(0, 4))):
        at = draw(st.integers(0, draw(st.sampled_from([80, 2500, len(data)]))))
        piece = draw(st.one_of(TOKENS, st.binary(max_size=12)))
        data = data[:at] + piece + data[at + draw(st.sampled_from([0, len(piece), 1, 10])) :]
    return Damaged(data[: draw(st.integers(0, len(data)))] if draw(st.booleans()) else data)
