"""What the words of a header mean: numbers, units of acceleration, peaks, directions."""

import math
import re

from assess.errors import RecordError
from assess.i18n import fill
from assess.motion.formats._format import Direction
from assess.units import ACCELERATION, GRAVITY, read_unit

_MORE_UNITS = {"mm/s2": 0.001, "g/10": GRAVITY / 10, "mg": GRAVITY / 1000, "in/s2": 0.0254}
_UP = re.compile(r"(up|down|dn|dwn|ver|vert|vertical|v|z|ud|u-d|u)", re.IGNORECASE)
_DEGREES = re.compile(r"(\d{1,3}(?:\.\d*)?)\s*(?:deg\w*\.?|°)?", re.IGNORECASE | re.ASCII)
_QUADRANT = re.compile(r"([NS])\s*(\d{1,2}(?:\.\d*)?)\s*(?:deg\w*\.?|°)?\s*([EW])", re.IGNORECASE | re.ASCII)
_POINTS = {"n": 0.0, "north": 0.0, "ns": 0.0, "n-s": 0.0, "s": 180.0, "south": 180.0,
           "e": 90.0, "east": 90.0, "ew": 90.0, "e-w": 90.0, "w": 270.0, "west": 270.0}  # fmt: skip

_QUANTITIES = {"velocity": fill("velocities"), "displacement": fill("displacements")}


def read_real(text: str) -> float | None:
    """Return the number that `text` is, None where it is none."""
    try:
        return float(text)
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
        raise RecordError(fill("{unit!r} is not a known unit of acceleration. Get the file again", unit=text[:20]))
    return factor


def name_quantity(text: str) -> str:
    """Return what a file holds instead of accelerations, as messages call it; as in its header if it is not known."""
    return _QUANTITIES.get(text.lower(), text.lower())


def read_peak(number: str, unit: float | None) -> float | None:
    """Return the peak that a header prints, in `unit` [m/s2], as m/s2 without sign; None where there is none."""
    found = read_finite(number)
    return None if found is None or unit is None else abs(found) * unit


def read_direction(text: str) -> Direction:
    """Return the azimuth [deg] that `text` names, None where it names none, and whether it names the vertical."""
    text = text.strip()
    if _UP.fullmatch(text):
        return None, True
    quadrant = _QUADRANT.fullmatch(text)
    if quadrant:
        off = float(quadrant[2]) * (1 if quadrant[3].upper() == "E" else -1)
        return (off if quadrant[1].upper() == "N" else 180 - off) % 360, False
    degrees = _DEGREES.fullmatch(text)
    if degrees:
        return (float(degrees[1]) if float(degrees[1]) <= 360 else None), False
    return _POINTS.get(text.lower()), False


def direction_of_code(code: str) -> Direction:
    """Return azimuth [deg] and vertical of a SEED channel code (HNE): its last letter."""
    return read_direction(code[-1:]) if code[-1:] in {"N", "E", "Z"} else (None, False)
