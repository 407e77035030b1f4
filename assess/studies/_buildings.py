"""The instrumented buildings whose records come along: what shook where, and along which axis."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from assess.errors import InputError
from assess.motion.formats import read_records
from assess.motion.record import Motion, treat
from assess.resources import record


@dataclass(frozen=True, slots=True)
class Channel:
    """One horizontal channel: its file, where it hung, and the axis of the building that it records.

    Two channels of one axis may look in opposite directions.
    """

    building: str
    level: str
    axis: str
    name: str
    file: Path

    def read(self) -> Motion:
        """Return its motion as treated everywhere (`assess.motion.record.treat`)."""
        return _read(self.file)

    def __str__(self) -> str:
        return f"{self.building}, {self.level}, {self.name}"


@lru_cache(maxsize=64)
def _read(file: Path) -> Motion:
    return treat(read_records(file)[0])


@dataclass(frozen=True, slots=True)
class Building:
    """An instrumented building: its name, the earthquake, and its horizontal channels, floor by floor."""

    name: str
    place: str
    event: str
    channels: tuple[Channel, ...]

    @property
    def levels(self) -> tuple[str, ...]:
        """Its levels with a channel, the lowest first."""
        return tuple(dict.fromkeys(one.level for one in self.channels))


MARKET = (
    ("ground", "Y", "k"), ("25th floor", "X", "g"), ("25th floor", "X", "h"), ("25th floor", "Y", "i"),
    ("34th floor", "X", "d"), ("34th floor", "X", "e"),
    ("42nd floor", "X", "a"), ("42nd floor", "X", "b"), ("42nd floor", "Y", "c"),
)  # fmt: skip
BERKELEY = (
    ("basement", "X", "HN2.NP.BE"), ("basement", "X", "HN2.NP.BW"), ("basement", "Y", "HN3.NP.BE"),
    ("basement", "Y", "HN3.NP.BW"), ("4th floor", "X", "HN2.NP.4E"), ("4th floor", "X", "HN2.NP.4W"),
    ("roof", "X", "HN2.NP.RC"), ("roof", "X", "HN2.NP.RE"), ("roof", "X", "HN2.NP.RS"), ("roof", "Y", "HN3.NP.RE"),
    ("roof", "Y", "HN3.NP.RS"),
)  # fmt: skip
"""Level, axis and name of every horizontal channel, the lowest first."""


def all_buildings() -> tuple[Building, ...]:
    """Return the three buildings.

    Raises
    ------
    InputError
        If their records are not there.
    """
    return (
        Building(
            "575 Market Street", "San Francisco", "Loma Prieta, 18 October 1989 UTC",
            tuple(_find("575 Market Street", "891018_1.cra-1.0210{}.smc", MARKET)),
        ),
        Building(
            "Great Western Savings", "Berkeley", "Berkeley, 4 January 2018",
            tuple(_find("Great Western Savings", "1103.{}_a.smc", BERKELEY)),
        ),
        Building(
            "LACPW headquarters", "Alhambra", "Whittier Narrows, 1 October 1987",
            tuple(_find("LACPW headquarters", "{}.smc", (("12th floor", "X", "0165a_u"),))),
        ),
    )  # fmt: skip


def _find(building: str, pattern: str, rows: tuple[tuple[str, str, str], ...]) -> Iterator[Channel]:
    for level, axis, name in rows:
        file = record(pattern.format(name))
        if not file.is_file():
            raise InputError(f"{file} is not there: the records of {building} belong to the package; install it again")
        yield Channel(building, level, axis, name, file)
