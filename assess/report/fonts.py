"""The report's own fonts: their style rules, the characters that they hold, and what else of the machine helps out."""

from collections.abc import Collection, Mapping
from functools import cache
from typing import Any

from assess import resources
from assess.report.embedded import data_uri

FIGURE_FAMILY = "IBM Plex Sans"
"""The report's own face as its files call it."""
REPLACEMENT = "\N{REPLACEMENT CHARACTER}"
EAST_ASIAN = (
    "Noto Sans CJK JP", "Noto Sans JP", "Noto Sans CJK SC", "Noto Sans SC", "Source Han Sans", "Hiragino Sans",
    "Yu Gothic", "PingFang SC", "Microsoft YaHei", "Malgun Gothic", "WenQuanYi Micro Hei",
)  # fmt: skip
"""Families with Chinese, Japanese and Korean characters that systems bring along or offer, the best match first."""


@cache
def _print_fonts() -> dict[tuple[str, str], tuple[str, str]]:
    """Return the fonts of a PDF by family and style: the address under which its style rules name each, and its file.

    A machine without fonts makes the same PDF. Signs such as ⚓, which are emoji as well, are looked for in a family of
    the name emoji first: it is this font, too.
    """
    own = resources.fonts()
    signs = own.get(("Report Signs", "regular"))
    own |= {("emoji", "regular"): signs} if signs else {}
    return {key: (f"font:{'-'.join(key)}".replace(" ", "-"), str(path)) for key, path in own.items()}


def print_fonts() -> dict[str, str]:
    """Return the files of the fonts of a PDF by the address under which its style rules name them."""
    return dict(_print_fonts().values())


@cache
def font_faces() -> str:
    """Return the fonts of a PDF as @font-face rules that name `print_fonts`: as part of the CSS, files take seconds."""
    return _write_faces({key: address for key, (address, _path) in _print_fonts().items()})


@cache
def web_font_faces() -> str:
    """Return the compressed fonts of an HTML report as @font-face rules, each with its whole file."""
    fonts = resources.web_fonts()
    return _write_faces({key: data_uri(path.read_bytes(), f"font/{path.suffix[1:]}") for key, path in fonts.items()})


def _write_faces(addresses: Mapping[tuple[str, str], str]) -> str:
    return "\n".join(
        f"@font-face {{ font-family: '{family}'; font-weight: {'bold' if style == 'bold' else 'normal'}; "
        f"font-style: {'italic' if style == 'italic' else 'normal'}; src: url({address}); }}"
        for (family, style), address in addresses.items()
    )


@cache
def figure_families() -> tuple[str, ...]:
    """Return the families of a figure's text: the report's own, then one with East Asian characters, if any is here."""
    from matplotlib.font_manager import fontManager

    known = {font.name for font in fontManager.ttflist}
    listed = {font.fname for font in fontManager.ttflist}
    for (family, _style), path in resources.fonts().items():
        if family == "Report" and str(path) not in listed:
            fontManager.addfont(path)
    borrowed = [name for name in EAST_ASIAN if name in known]
    return (FIGURE_FAMILY, "DejaVu Sans", *borrowed[:1])


def find_undrawn(text: str) -> str:
    """Return the characters of a text that no font of figures holds, each once, in their order."""
    from matplotlib.font_manager import findfont

    borrowed = figure_families()[2:]
    held = [font for family in borrowed if (font := _open_font(findfont(family))) is not None]
    return "".join(sign for sign in find_missing(text) if not any(font.get_char_index(ord(sign)) for font in held))


def find_missing(text: str) -> str:
    """Return the characters of a text that the report's fonts do not hold, each once, in their order."""
    if text.isascii():
        return ""
    return "".join(sign for sign in dict.fromkeys(text) if not sign.isascii() and ord(sign) not in _held())


@cache
def _held() -> frozenset[int]:
    """Return the code points of the regular fonts; what another style lacks is taken from them."""
    own = (("Report", "regular"), ("Report Signs", "regular"))
    fonts = [path for key, path in resources.fonts().items() if key in own]
    return frozenset(code for path in fonts for code in _open_font(str(path)).get_charmap())


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
