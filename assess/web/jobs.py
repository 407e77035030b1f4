"""The simulation of a session: a process of its own, how far it is, and what it leaves."""

from typing import Any


class Job:
    """One simulation."""

    def summarise(self) -> dict[str, Any]:
        """Return what the page shows of it wherever it is."""
        return {}

    def close(self) -> None:
        """End it, and remove what it left."""
