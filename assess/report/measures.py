"""Units of the reader: SI, or US customary ones where Building asks for them. Accelerations are in g for everybody."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar

from assess.i18n import number
from assess.units import FORCE, LENGTH, MASS, VELOCITY

_CUSTOMARY: Mapping[str, tuple[str, float, int, int]] = {
    "cm": ("in", LENGTH["cm"] / LENGTH["in"], 1, 1),
    "m": ("ft", LENGTH["m"] / LENGTH["ft"], 2, 2),
    "kN": ("lb", FORCE["kN"] / FORCE["lbf"], 2, 0),
    "kg": ("lb", MASS["kg"] / MASS["lb"], 0, 0),
    "cm/s": ("in/s", VELOCITY["cm/s"] / VELOCITY["in/s"], 1, 1),
}
"""US units for those of SI: sign, how many of it one of SI is, decimals shown in SI and in it."""
_READER: ContextVar[str] = ContextVar("reader", default="SI")


@contextmanager
def reading(units: str) -> Iterator[None]:
    """Have every quantity be in the units of a reader: "US", anything else is SI."""
    token = _READER.set(units)
    try:
        yield
    finally:
        _READER.reset(token)


def is_us() -> bool:
    """Tell whether quantities are in US customary units."""
    return _READER.get() == "US"


def unit(name: str) -> str:
    """Return the reader's unit for one of SI: cm, m, kN, kg or cm/s; any other stays."""
    return _CUSTOMARY[name][0] if is_us() and name in _CUSTOMARY else name


def convert(value: float, name: str) -> float:
    """Return a value of the unit `name` in the reader's unit."""
    return value * _CUSTOMARY[name][1] if is_us() and name in _CUSTOMARY else value


def show(value: float, name: str) -> str:
    """Return a value of the unit `name` as the reader's number; lengths without zeros at the end and never as -0."""
    _sign, _factor, in_si, in_us = _CUSTOMARY[name]
    decimals, shown = in_us if is_us() else in_si, convert(value, name)
    if name in ("cm", "m"):
        return number(round(shown, decimals) + 0.0, ".12g")
    least = 10**-decimals
    return f"< {number(least, f'.{decimals}f')}" if 0 < shown < least / 2 else number(shown, f",.{decimals}f")


def say(value: float, name: str) -> str:
    """Return a value of the unit `name` with the reader's unit: ``45 cm``, ``17.7 in``."""
    return f"{show(value, name)} {unit(name)}"
