"""Named cell styles, as Excel lists them under Cell Styles.

XlsxWriter writes formats, but can name none. The file of styles that it has written is therefore completed before it
is packed: each style's own entry, its name, and the number of the style in the formats that belong to it. It has a few
kilobytes, whatever the length of the sheets. Should a later XlsxWriter write that file otherwise it stays as it is: the
cells look the same, without names.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

from assess.language import gettext as _
from assess.risk import RiskClass
from assess.routes.model import RouteState

PART = "xl/styles.xml"
_FORMAT = re.compile(r"<xf [^>]*?(?:/>|(?<!/)>.*?</xf>)")
_LISTS = ("cellStyleXfs", "cellXfs", "cellStyles")


@dataclass(frozen=True, slots=True)
class Style:
    """A named style: `builtin` is Excel's number of one of its own, `formats` the places of those that belong to it."""

    name: str
    builtin: int | None
    formats: Sequence[int]


LOOKS: dict[str, tuple[int | None, dict[str, Any]]] = {
    "Title": (15, {"bold": True, "font_size": 15, "font_color": "#1f3a4d"}),
    "Heading 1": (16, {"bold": True, "bg_color": "#1f3a4d", "font_color": "#ffffff", "text_wrap": True, "valign": "top",
                       "border": 1}),
    "Heading 2": (17, {"bold": True, "font_size": 12, "font_color": "#1f3a4d"}),
    "Input": (20, {"font_color": "#0000c0", "bg_color": "#fffbe6", "valign": "top"}),
    "Calculation": (22, {"font_color": "#1f3a4d", "valign": "top"}),
    "Percent": (5, {"num_format": "0.0%", "valign": "top"}),
    "Total": (25, {"bold": True, "top": 1, "valign": "top"}),
    "Warning Text": (11, {"font_color": "#a03000", "italic": True}),
    "Explanatory Text": (53, {"text_wrap": True, "valign": "top"}),
}  # fmt: skip
"""Excel's number and the look of each style that has a name of Excel's own, which Excel shows in its language."""


def class_looks() -> dict[RiskClass, tuple[str, dict[str, Any]]]:
    """Return the name and the look of the style of each class."""
    names = (_("Class low"), _("Class medium"), _("Class high"), _("Class very high"))
    looks = ({"bg_color": risk.fill, "font_color": risk.ink, "text_wrap": True, "valign": "top"} for risk in RiskClass)
    return dict(zip(RiskClass, zip(names, looks, strict=True), strict=True))


def state_looks() -> dict[RouteState, tuple[str, dict[str, Any]]]:
    """Return the name and the look of the style of each state of a route: bold, so that none is that of a class."""
    names = (_("Route open"), _("Route reduced"), _("Route blocked"))
    inks = ("#1a1a1a", "#1a1a1a", "#ffffff")
    looks = (
        {"bold": True, "bg_color": state.fill, "font_color": ink, "text_wrap": True, "valign": "top"}
        for state, ink in zip(RouteState, inks, strict=True)
    )
    return dict(zip(RouteState, zip(names, looks, strict=True), strict=True))


def write_names(book: Any, styles: Callable[[], Sequence[Style]]) -> None:
    """Have a workbook of XlsxWriter name its styles when it is closed."""
    make = getattr(book, "_get_packager", None)
    if make is None:
        return

    def named() -> Any:
        packager = make()
        create = getattr(packager, "_create_package", None)
        if create is None:
            return packager

        def create_named() -> Any:
            parts = create()
            for file, part, *_rest in parts:
                if part == PART:
                    path = Path(file)
                    path.write_text(
                        name_styles(path.read_text(encoding="utf-8"), styles()), encoding="utf-8", newline="\n"
                    )
            return parts

        packager._create_package = create_named
        return packager

    book._get_packager = named


def name_styles(text: str, styles: Sequence[Style]) -> str:
    """Return the file of styles with names; as it is where it is not written as expected."""
    found = {name: re.search(rf"<{name} [^>]*>(.*?)</{name}>", text, re.S) for name in _LISTS}
    formats = _FORMAT.findall(found["cellXfs"][1]) if found["cellXfs"] else []
    places = [place for style in styles for place in style.formats]
    if not all(found.values()) or max(places, default=0) >= len(formats):
        return text
    own = _FORMAT.findall(found["cellStyleXfs"][1])  # type: ignore[index]
    names = re.findall(r"<cellStyle [^>]*/>", found["cellStyles"][1])  # type: ignore[index]
    for style in styles:
        number = len(own)
        own.append(formats[style.formats[0]].replace(' xfId="0"', ""))
        builtin = "" if style.builtin is None else f' builtinId="{style.builtin}" customBuiltin="1"'
        names.append(f'<cellStyle name={quoteattr(style.name)} xfId="{number}"{builtin}/>')
        for place in style.formats:
            formats[place] = formats[place].replace(' xfId="0"', f' xfId="{number}"')
    for name, entries in zip(_LISTS, (own, formats, names), strict=True):
        whole = f'<{name} count="{len(entries)}">{"".join(entries)}</{name}>'
        text = re.sub(rf"<{name} [^>]*>.*?</{name}>", lambda _, whole=whole: whole, text, count=1, flags=re.S)  # type: ignore[misc]
    return text
