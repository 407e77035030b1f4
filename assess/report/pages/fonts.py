"""The report's fonts inside its style: a machine without any renders the same PDF."""

import base64
from functools import cache

from assess import resources


@cache
def font_faces() -> str:
    """Return the fonts as @font-face rules, each with its whole file.

    Signs such as ⚓, which are emoji as well, are looked for in a family of the name emoji first: that is ours, too.
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
