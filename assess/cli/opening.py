"""Opening a finished report, or a page, in the browser or viewer of the user."""

import os
import sys
from pathlib import Path


def open_file(path: Path) -> str:
    """Open a file with the default browser, which hands a kind that it does not show to its viewer; never an error.

    The environment variable ``BROWSER`` names another program, as `webbrowser` has it.

    Returns
    -------
    str
        Empty where a program was started; else one line that says where the file is.
    """
    if not _has_display():
        return f"There is no display here. The report is {path.resolve()}"
    return "" if _start(path.resolve().as_uri()) else f"No browser could be started. The report is {path.resolve()}"


def open_address(address: str) -> str:
    """Open an address in the default browser; never an error. As `open_file`."""
    if not _has_display():
        return "There is no display here. Open the address in a browser of this machine."
    return "" if _start(address) else "No browser could be started. Open the address in one."


def _start(address: str) -> bool:
    import webbrowser

    try:
        return webbrowser.open(address)
    except (webbrowser.Error, OSError, ValueError):  # no program, one that does not start, a BROWSER that is garbled
        return False


def _has_display() -> bool:
    """Whether a program with a window can be shown; a text browser would take the terminal over."""
    if os.environ.get("BROWSER") or sys.platform in ("win32", "darwin", "cygwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
