"""The one script of the HTML report, and the hash by which a browser runs it and nothing else."""

import base64
import hashlib

from assess.report.look import Look

SCRIPT = "script/report.js"


def read_script(look: Look, *, for_print: bool) -> str:
    """Return the script of the page; a PDF has none."""
    return "" if for_print else look.read(SCRIPT)


def script_hash(text: str) -> str:
    """Return the source expression that allows an inline script of exactly this text.

    Source: W3C, Content Security Policy Level 3, section 2.3.1 (hash-source).
    """
    digest = hashlib.sha256(text.encode()).digest()
    return f"sha256-{base64.b64encode(digest).decode()}"
