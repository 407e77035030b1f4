"""Units: one constant of gravity, one table of factors to SI.

Inside the program every length is in m, every acceleration in m/s2, every velocity in m/s, masses in kg, forces in N.
Angles that describe how a thing lies (azimuths, the turn of a piece on the plan) stay in degrees and say so in their
names.
"""

from collections.abc import Mapping

GRAVITY = 9.80665  # standard gravity [m/s2], the one value used everywhere

ROUNDING = 1e-9
"""Relative: what lies nearer to a limit than this lies on it, so that a change of units moves nothing across."""

LENGTH: Mapping[str, float] = {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": 0.0254, "ft": 0.3048}
ACCELERATION: Mapping[str, float] = {"g": GRAVITY, "m/s2": 1.0, "cm/s2": 0.01, "gal": 0.01}
VELOCITY: Mapping[str, float] = {"cm/s": 0.01, "m/s": 1.0, "in/s": 0.0254}
ANGLE: Mapping[str, float] = {"deg": 1.0}
TIME: Mapping[str, float] = {"s": 1.0}
SHARE: Mapping[str, float] = {"%": 0.01}
MASS: Mapping[str, float] = {"kg": 1.0, "lb": 0.45359237}
FORCE: Mapping[str, float] = {"kN": 1000.0, "N": 1.0, "lbf": 4.4482216152605}

QUANTITIES: Mapping[str, Mapping[str, float]] = {
    "length": LENGTH,
    "acceleration": ACCELERATION,
    "velocity": VELOCITY,
    "angle": ANGLE,
    "time": TIME,
    "share": SHARE,
    "mass": MASS,
    "force": FORCE,
}


ALIASES: Mapping[str, str] = {
    "inch": "in", "inches": "in", "in.": "in", "feet": "ft", "foot": "ft", "ft.": "ft",
    "metre": "m", "metres": "m", "meter": "m", "meters": "m", "metri": "m", "mt": "m",
    "centimetres": "cm", "centimeters": "cm", "centimetri": "cm",
    "millimetres": "mm", "millimeters": "mm", "millimetri": "mm",
    "kn": "kN", "n": "N", "lbs": "lb", "kgs": "kg", "sec": "s", "°": "deg", "degrees": "deg",
    "m/s²": "m/s2", "m/s^2": "m/s2", "cm/s²": "cm/s2", "cm/s^2": "cm/s2",
}  # fmt: skip
"""Other spellings that are understood."""


def read_unit(text: str) -> str:
    """Return `text` as the tables above spell units: no spaces, no other spelling."""
    spelt = "".join(text.split()).lower()
    return ALIASES.get(spelt, spelt)


def to_edge(value: float, factor: float) -> float:
    """Convert an SI value to a unit with `factor`, without the noise of binary fractions (29 cm, not 28.999...)."""
    return float(f"{value / factor:.12g}")
