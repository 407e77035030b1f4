"""Parts of the page that are no plain text: its one script, with the hash by which a browser runs it, and equations."""

import base64
import hashlib
import re
from typing import Any

from assess.report.look import Look

SCRIPT = "script/report.js"


def read_script(look: Look, *, for_print: bool) -> str:
    """Return the script of the page; a PDF has none."""
    return "" if for_print else look.read(SCRIPT)


_INDEX = re.compile(r"(?<=[^\W\d_])_([^\W_]+\*?)")
_POWER = re.compile(r"\^(?:\((-?\d+(?:[.,]\d+)?)\)|(-?\d+(?:[.,]\d+)?))")


def write_equation(text: str) -> Any:
    """Return an equation of a method as HTML: what stands behind _ below the line, a number behind ^ above it."""
    from markupsafe import Markup, escape

    lowered = _INDEX.sub(r"<sub>\1</sub>", str(escape(text)))
    return Markup(_POWER.sub(lambda found: f"<sup>{found[1] or found[2]}</sup>", lowered))  # noqa: S704 - escaped above


def script_hash(text: str) -> str:
    """Return the source expression that allows an inline script of exactly this text.

    Source: W3C, Content Security Policy Level 3, section 2.3.1 (hash-source).
    """
    digest = hashlib.sha256(text.encode()).digest()
    return f"sha256-{base64.b64encode(digest).decode()}"
