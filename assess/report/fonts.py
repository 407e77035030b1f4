"""The report's own fonts: their style rules, the characters that they hold, and what else of the machine helps out."""

import base64
from collections.abc import Collection
from functools import cache
from typing import Any

from assess import resources

REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


@cache
def font_faces() -> str:
    """Return the fonts as @font-face rules, each with its whole file: a machine without fonts makes the same PDF.

    Signs such as ⚓, which are emoji as well, are looked for in a family of the name emoji first: it is this font, too.
    """
    own = resources.fonts()
    emoji = {
        ("emoji", style): path for (family, style), path in own.items() if (family, style) == ("Report", "regular")
    }
    return "\n".join(
        f"@font-face {{ font-family: '{family}'; font-weight: {'bold' if style == 'bold' else 'normal'}; "
        f"font-style: {'italic' if style == 'italic' else 'normal'}; "
        f"src: url(data:font/ttf;base64,{base64.b64encode(path.read_bytes()).decode()}); }}"
        for (family, style), path in (own | emoji).items()
    )


def find_missing(text: str) -> str:
    """Return the characters of a text that the report's fonts do not hold, each once, in their order."""
    if text.isascii():
        return ""
    return "".join(sign for sign in dict.fromkeys(text) if not sign.isascii() and ord(sign) not in _held())


@cache
def _held() -> frozenset[int]:
    """Return the code points of the regular font; what another style lacks is taken from it."""
    path = resources.fonts().get(("Report", "regular"))
    return frozenset(_open_font(str(path)).get_charmap()) if path else frozenset()


def replace_signs(text: str, signs: Collection[str]) -> str:
    """Return a text with � in place of some characters."""
    return text.translate(dict.fromkeys(map(ord, signs), REPLACEMENT)) if signs else text


@cache
def find_nowhere(characters: str) -> frozenset[str]:
    """Return those of some characters that no font of this machine holds either."""
    if not characters:
        return frozenset()
    from matplotlib.font_manager import findSystemFonts

    left = set(characters)
    for path in sorted(findSystemFonts()):
        font = _open_font(path)
        left -= {sign for sign in left if font is not None and font.get_char_index(ord(sign))}
        if not left:
            break
    return frozenset(left)


def _open_font(path: str) -> Any:
    """Return a font; None of a file that cannot be read as one."""
    from matplotlib.ft2font import FT2Font

    try:
        return FT2Font(path)
    except (OSError, RuntimeError):
        return None
