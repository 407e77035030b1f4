"""What the server and the process of a session send each other: a request, its answer; as bytes with their lengths."""

import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, BinaryIO

HEAD = struct.Struct(">II")
"""Bytes of the header, which is JSON, and of the data behind it."""


@dataclass(frozen=True, slots=True)
class Call:
    """A request: its body or the file that holds it, and which languages it asks for.

    `chosen`: the language that the user chose, `accepted`: those of the browser, `encoding`: how it takes answers.
    """

    method: str
    path: str
    query: Mapping[str, str] = field(default_factory=dict)
    data: bytes = b""
    file: str = ""
    chosen: str = ""
    accepted: str = ""
    encoding: str = ""


@dataclass(frozen=True, slots=True)
class Reply:
    """An answer: its data or the file that holds them; `language` is that of the open workbook, blank without."""

    status: int
    headers: Sequence[tuple[str, str]] = ()
    data: bytes = b""
    file: str = ""
    language: str = ""


def write_frame(stream: BinaryIO, header: Mapping[str, Any], data: bytes = b"") -> None:
    """Write a header and data, at once."""
    text = json.dumps(header).encode()
    stream.write(HEAD.pack(len(text), len(data)) + text + data)
    stream.flush()


def read_frame(stream: BinaryIO) -> tuple[dict[str, Any], bytes] | None:
    """Return the next header and data; None where the stream ends, also in the middle of them."""
    head = stream.read(HEAD.size)
    if len(head) < HEAD.size:
        return None
    sizes = HEAD.unpack(head)
    text, data = (stream.read(size) for size in sizes)
    return (json.loads(text), data) if (len(text), len(data)) == sizes else None


def pack(one: Call | Reply, number: int) -> tuple[dict[str, Any], bytes]:
    """Return the header and the data of a request or an answer; `number` is what they have in common."""
    header = {**asdict(one), "number": number}
    return header, header.pop("data")
