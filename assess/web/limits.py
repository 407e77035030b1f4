"""What the page may take: settings of the server, the bytes of each kind of request, the room of a session's files."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from assess.i18n import Text, fill
from assess.web.request_errors import TOO_LARGE, TOO_MANY, RequestError

INF = float("inf")
PREFIX = "assess-open-"
"""Beginning of the name of the folder of a server, in which each session has its own."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What one session and all of them may take; by default what the one session of the own machine may.

    * `users`, `workers`, `simulations`, `models`: sessions, their processes, simulations and building models that are
      read, at once.
    * `bytes`: the files of one session, `memory`: addresses of its process, `total`: memory of all these processes.
    * `seconds`: time for the answer to a request, `job_seconds`: processor time of a simulation.
    * `wait`: time that a request waits for a process, `sleep`: time without a request of its user after which the
      process of a session ends, `idle`: the session itself, `end`: time that a process has once the server ends.
    * `silence`: time after which a connection is closed that sends nothing of what it has begun.
    """

    users: int = 1
    workers: int = 1
    simulations: int = 1
    models: int = 1
    bytes: int = 1_000_000_000
    memory: float = INF
    total: float = INF
    seconds: float = INF
    job_seconds: float = INF
    wait: float = 30.0
    sleep: float = INF
    idle: float = INF
    end: float = INF
    silence: float = 20.0


OWN = Limits()
HOSTED = Limits(
    users=50, workers=12, simulations=2, models=2, bytes=300_000_000, memory=4e9, total=3e9, seconds=120.0,
    job_seconds=7200.0, sleep=600.0, idle=12 * 3600.0, end=20.0,
)  # fmt: skip
"""Limits of a server for several users."""

SMALL = 64 * 2**10
"""Bytes of a body in JSON, and of any that is held in memory; a larger one goes to a file."""
MODELS = "/api/import"
"""Where building models are sent."""
MOST_MODEL = 256 * 2**20
"""Bytes of the largest building model."""
MOST: Mapping[str, int] = {
    "/api/edit": 4 * 2**20, "/api/upload": 64 * 2**20, "/api/file": 64 * 2**20, MODELS: MOST_MODEL,
}  # fmt: skip
"""Bytes that a body may have by its address, `SMALL` for all others."""


def find_room(folder: Path, limits: Limits) -> float:
    """Return how many bytes more a session may have in its folder; what is removed meanwhile does not count."""
    used = 0
    for path in folder.rglob("*"):
        try:
            used += path.stat().st_size if path.is_file() else 0
        except OSError:
            continue
    return limits.bytes - used


def check_room(size: float, room: float, limits: Limits) -> None:
    """Raise RequestError where so many bytes more are too many for one session."""
    if size > room:
        most = limits.bytes / 1e6
        raise RequestError(fill("The files of this session have more than {most:.0f} MB.", most=most), TOO_MANY)


def check_size(size: int, most: int) -> None:
    """Raise RequestError where a body is larger than its address allows."""
    if size > most:
        raise RequestError(say_large(most), TOO_LARGE)


def say_large(most: int) -> Text:
    """Return what is said of a body that is too large."""
    if most < 2**20:
        return fill("It is larger than {most:.0f} kB.", most=most / 2**10)
    return fill("It is larger than {most:.0f} MB.", most=most / 2**20)
