"""Where a floor lies whose elevation is not known: the number in its name times the height of a storey.

It is an assumption: storeys are taken as of one height, and floors as numbered from the ground floor, which is 0. Where
the ground floor is 1, elevations come out one storey too high, which is on the safe side; where lower storeys are
higher than others, elevations may come out too low.
"""

import re

_NUMBERED = re.compile(r"(?:floor|level|storey|story|piano|livello|[lfp])?[ .]*(\d{1,3})(?:°|st|nd|rd|th)?(?: floor)?")
_BELOW = re.compile(r"(?:b|-)[ .]*\d{1,2}|(?:basement|interrato)[ .]*\d{0,2}")
_GROUND = frozenset({"g", "gf", "ground", "ground floor", "pt", "p.t.", "terra", "piano terra", "eg", "rdc"})


def find_storey(name: str) -> int | None:
    """Return the number of storeys that a floor lies above the ground floor, from its name; None where it has none."""
    plain = " ".join(name.split()).casefold()
    if plain in _GROUND or _BELOW.fullmatch(plain):
        return 0
    found = _NUMBERED.fullmatch(plain)
    return int(found[1]) if found else None


def assume_elevation(name: str, height: float | None, storeys: int | None) -> float | None:
    """Return the elevation [m] of a floor from its name, and the height [m] and the storeys of its building.

    None where the building or the name does not tell; at most the height.
    """
    storey = find_storey(name)
    if storey is None or height is None or storeys is None:
        return None
    return min(storey * height / storeys, height)
