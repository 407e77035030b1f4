"""Opening a finished report in the browser or viewer of the user."""

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
    import webbrowser

    if not _has_display():
        return f"There is no display here. The report is {path.resolve()}"
    try:
        is_open = webbrowser.open(path.resolve().as_uri())
    except (webbrowser.Error, OSError, ValueError):  # no program, one that does not start, a BROWSER that is garbled
        is_open = False
    return "" if is_open else f"No browser could be started. The report is {path.resolve()}"


def _has_display() -> bool:
    """Whether a program with a window can be shown; a text browser would take the terminal over."""
    if os.environ.get("BROWSER") or sys.platform in ("win32", "darwin", "cygwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
