"""Units of the reader: SI, or US customary ones where Building asks for them. Accelerations are in g for everybody."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple

from assess.i18n import number
from assess.units import FORCE, LENGTH, MASS, VELOCITY


class _Customary(NamedTuple):
    """A US unit for one of SI: its sign, how many of it one of SI is, and decimals shown in SI and in it."""

    sign: str
    factor: float
    si_decimals: int
    decimals: int


_CUSTOMARY: Mapping[str, _Customary] = {
    "cm": _Customary("in", LENGTH["cm"] / LENGTH["in"], 1, 1),
    "m": _Customary("ft", LENGTH["m"] / LENGTH["ft"], 2, 2),
    "kN": _Customary("lb", FORCE["kN"] / FORCE["lbf"], 2, 0),
    "kg": _Customary("lb", MASS["kg"] / MASS["lb"], 0, 0),
    "cm/s": _Customary("in/s", VELOCITY["cm/s"] / VELOCITY["in/s"], 1, 1),
}
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
    return _CUSTOMARY[name].sign if is_us() and name in _CUSTOMARY else name


def convert(value: float, name: str) -> float:
    """Return a value of the unit `name` in the reader's unit."""
    return value * _CUSTOMARY[name].factor if is_us() and name in _CUSTOMARY else value


def show(value: float, name: str) -> str:
    """Return a value of the unit `name` as the reader's number; lengths without zeros at the end and never as -0."""
    found = _CUSTOMARY[name]
    decimals = found.decimals if is_us() else found.si_decimals
    shown = convert(value, name)
    if name in ("cm", "m"):
        return number(round(shown, decimals) + 0.0, ".12g")
    least = 10**-decimals
    return f"< {number(least, f'.{decimals}f')}" if 0 < shown < least / 2 else number(shown, f",.{decimals}f")


def say(value: float, name: str) -> str:
    """Return a value of the unit `name` with the reader's unit: ``45 cm``, ``17.7 in``."""
    return f"{show(value, name)} {unit(name)}"
