"""Results as they were found once, kept in a file and read back: outputs are rendered from the same on any machine.

A file is a zip of arrays: ``results`` holds all else, as JSON in which what is no plain value says what it is.
"""

import base64
import dataclasses
import datetime
import enum
import importlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from assess.i18n import Text
from assess.motion.scenario import PROFILES, Profile
from assess.results import Results, Series

_CURVES = ("example/", "spectra_g", "acceleration_g", "contours/")
KIND = "$"
"""The entry that says what a record is."""
MOVED = dict.fromkeys(("assess.methods._info", "assess.methods._method"), "assess.methods")
"""Modules of which results were kept before their types moved, and where these are now."""


def write_results(results: Results, path: Path) -> None:
    """Write results with their series but for the workbook; curves of figures are of the same length, and zero."""
    arrays: dict[str, np.ndarray] = {}
    text = json.dumps(_encode(results, arrays), ensure_ascii=False, separators=(",", ":"))
    with np.load(results.series.path, allow_pickle=False) as series:
        for name in series.files:
            if name != "workbook":
                values = series[name]
                arrays[f"series/{name}"] = np.zeros_like(values) if any(one in name for one in _CURVES) else values
    np.savez_compressed(path, results=np.frombuffer(text.encode(), dtype=np.uint8), **arrays)


def read_results(path: Path, box: Path) -> Results:
    """Return results; their series are written into the folder `box`, as those of a run lie in a folder."""
    with np.load(path, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    series = box / "series.npz"
    np.savez(
        series, **{name.removeprefix("series/"): one for name, one in arrays.items() if name.startswith("series/")}
    )
    found = _decode(json.loads(arrays["results"].tobytes()), arrays)
    assert isinstance(found, Results)
    return dataclasses.replace(found, series=Series(series))


def _encode(value: Any, arrays: dict[str, np.ndarray]) -> Any:
    match value:
        case Text():
            parts = {"template": value.template, "many": value.many, "values": _encode(value.values, arrays)}
            return {KIND: "text", "text": str(value), **parts}
        case Series():
            return None
        case enum.Enum():
            return {KIND: "enum", "of": _name(type(value)), "name": value.name}
        case Profile():
            return {KIND: "profile", "key": value.key}
        case None | bool() | int() | float() | str():
            return value
        case np.generic():
            return _encode(value.item(), arrays)
        case np.ndarray():
            name = f"array/{len(arrays)}"
            arrays[name] = value.astype(str) if value.dtype.kind == "O" else value
            return {KIND: "array", "name": name, "is_object": value.dtype.kind == "O"}
        case bytes():
            return {KIND: "bytes", "base64": base64.b64encode(value).decode()}
        case Path():
            return {KIND: "path", "path": value.name}
        case datetime.date():
            return {KIND: "date", "date": value.isoformat()}
        case Mapping():
            return {
                KIND: "map",
                "pairs": [[_encode(one, arrays), _encode(other, arrays)] for one, other in value.items()],
            }
    if dataclasses.is_dataclass(value) or hasattr(value, "_fields"):
        names = [one.name for one in dataclasses.fields(value)] if dataclasses.is_dataclass(value) else value._fields
        return {KIND: _name(type(value)), **{name: _encode(getattr(value, name), arrays) for name in names}}
    if isinstance(value, (list, tuple)):
        return [_encode(one, arrays) for one in value]
    if isinstance(value, (set, frozenset)):
        return {KIND: "set", "of": sorted(_encode(one, arrays) for one in value)}
    raise TypeError(f"{type(value)} cannot be kept")


def _decode(value: Any, arrays: Mapping[str, np.ndarray]) -> Any:
    if isinstance(value, list):
        return tuple(_decode(one, arrays) for one in value)
    if not isinstance(value, dict):
        return value
    fields = {name: _decode(one, arrays) for name, one in value.items() if name != KIND}
    match value[KIND]:
        case "text":
            text = Text(fields["text"])
            text.template, text.many, text.values = fields["template"], fields["many"], fields["values"]
            return text
        case "enum":
            return _find(fields["of"])[fields["name"]]
        case "profile":
            return PROFILES[fields["key"]]
        case "array":
            found = arrays[fields["name"]]
            return found.astype(object) if fields["is_object"] else found
        case "bytes":
            return base64.b64decode(fields["base64"])
        case "path":
            return Path(fields["path"])
        case "date":
            return datetime.date.fromisoformat(fields["date"])
        case "map":
            return dict(fields["pairs"])
        case "set":
            return frozenset(fields["of"])
    kind = _find(value[KIND])
    given = {one.name for one in dataclasses.fields(kind) if one.init} if dataclasses.is_dataclass(kind) else fields
    return kind(**{name: one for name, one in fields.items() if name in given})


def _name(kind: type) -> str:
    return f"{kind.__module__}:{kind.__qualname__}"


def _find(name: str) -> Any:
    module, _, kind = name.partition(":")
    return getattr(importlib.import_module(MOVED.get(module, module)), kind)
