"""What the words of a header mean: numbers, units of acceleration, peaks."""

import math
import re

from assess.errors import RecordError
from assess.i18n import fill
from assess.units import ACCELERATION, GRAVITY, read_unit

_MORE_UNITS = {"mm/s2": 0.001, "g/10": GRAVITY / 10, "mg": GRAVITY / 1000, "in/s2": 0.0254}
NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[ED][-+]?\d+)?"
"""A number of a header, without sign, with the exponent that Fortran prints; whatever the case of its letters."""
END = r"(?=[\s,;]|$)"
"""Where such a number ends, if no unit follows it."""

_EXPONENT = re.compile(r"(?<=[\d.])D(?=[-+\d])", re.IGNORECASE)
_QUANTITIES = {"velocity": fill("velocities"), "displacement": fill("displacements")}


def read_real(text: str) -> float | None:
    """Return the number that `text` is, None where it is none; Fortran's D stands for E."""
    try:
        return float(_EXPONENT.sub("E", text))
    except ValueError:
        return None


def read_finite(text: str | None) -> float | None:
    """Return the finite number that `text` is, None where it is none."""
    number = read_real(text or "")
    return number if number is not None and math.isfinite(number) else None


def read_acceleration_unit(text: str) -> float | None:
    """Return the factor from the unit that `text` names to m/s2, None where it is no unit of acceleration."""
    spelt = read_unit(text.replace("**", "").replace("^", "")).replace("sec", "s").replace("/s/s", "/s2").strip(".")
    return ACCELERATION.get(spelt, _MORE_UNITS.get(spelt))


def require_unit(text: str) -> float:
    """Return the factor from the unit that `text` names to m/s2; RecordError where it is no unit of acceleration."""
    factor = read_acceleration_unit(text)
    if factor is None:
        raise RecordError.about("{unit!r} is not a known unit of acceleration. Get the file again", unit=text[:20])
    return factor


def name_quantity(text: str) -> str:
    """Return what a file holds instead of accelerations, as messages call it; as in its header if it is not known."""
    return _QUANTITIES.get(text.lower(), text.lower())


def read_peak(number: str, unit: float | None) -> float | None:
    """Return the peak that a header prints, in `unit` [m/s2], as m/s2 without sign; None where there is none."""
    found = read_finite(number)
    return None if found is None or unit is None else abs(found) * unit
