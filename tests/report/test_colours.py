"""The colours of the classes and of the pages, for eyes of every kind and for grey printers.

Sources: Machado GM, Oliveira MM, Fernandes LAF (2009). A physiologically-based model for simulation of color vision
deficiency. IEEE Transactions on Visualization and Computer Graphics 15(6):1291-1298. doi:10.1109/TVCG.2009.113
(matrices of severity 1.0, for linear RGB). CIE 15:2004, Colorimetry (L*a*b* and its distance of 1976). W3C, Web
Content Accessibility Guidelines 2.2, success criterion 1.4.3 (contrast).
"""

import re
from itertools import combinations, pairwise

import numpy as np
import pytest

from assess import resources
from assess.report.figures.plan import ANCHORED
from assess.risk import RiskClass

SIGHT = {
    "normal": np.eye(3),
    "protanopia": np.array([
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998],
    ]),
    "deuteranopia": np.array([
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881],
    ]),
}  # fmt: skip
TO_XYZ = np.array([
    [0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041],
])  # fmt: skip
WHITE = np.array([0.95047, 1.0, 1.08883])
"""Of sRGB: CIE D65."""

APART = 20.0
"""Least distance of two classes in L*a*b*: about ten times what an eye tells apart side by side."""
APART_FROM_GREY = 10.0
"""Likewise from the grey of anchored pieces, which bear no symbol."""
STEP = 9.0
"""Least step in lightness L* from class to class, so that a grey print keeps their order."""
CONTRAST = 4.5
CLASSES = [risk.fill for risk in RiskClass]


def _linear(colour):
    """Return linear RGB of ``#rrggbb`` or ``#rgb``."""
    digits = colour.lstrip("#")
    digits = "".join(2 * digit for digit in digits) if len(digits) == 3 else digits
    values = np.array([int(digits[at : at + 2], 16) for at in (0, 2, 4)]) / 255
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def _lab(colour, sight="normal"):
    seen = TO_XYZ @ np.clip(SIGHT[sight] @ _linear(colour), 0, 1) / WHITE
    f = np.where(seen > 216 / 24389, np.cbrt(seen), (24389 / 27 * seen + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def _apart(one, other, sight):
    return float(np.linalg.norm(_lab(one, sight) - _lab(other, sight)))


def _contrast(one, other):
    dark, light = sorted(float(TO_XYZ[1] @ _linear(colour)) for colour in (one, other))
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("sight", SIGHT)
def test_classes_are_told_apart(sight):
    for one, other in combinations(CLASSES, 2):
        assert _apart(one, other, sight) >= APART, f"{one} and {other}"
    for one in CLASSES:
        assert _apart(one, ANCHORED, sight) >= APART_FROM_GREY, one


@pytest.mark.parametrize("sight", SIGHT)
def test_classes_grow_darker_step_by_step(sight):
    lightness = [_lab(colour, sight)[0] for colour in CLASSES]
    assert all(before - after >= STEP for before, after in pairwise(lightness)), lightness


@pytest.mark.parametrize("risk", RiskClass)
def test_text_on_a_class_is_readable(risk):
    assert _contrast(risk.fill, risk.ink) >= CONTRAST


def _rules(css):
    """Return the declarations of every rule, without comments and at-rules, with custom properties put in."""
    css = re.sub(r"/\*.*?\*/", "", css, flags=re.DOTALL)
    variables = dict(re.findall(r"(--[\w-]+):\s*([^;}]+)", css))
    rules = re.findall(r"([^{}]+)\{([^{}]*)\}", css)
    return [
        (
            selector.strip(),
            {
                name: re.sub(r"var\((--[\w-]+)\)", lambda found: variables[found[1]], value).strip()
                for name, value in re.findall(r"([\w-]+):\s*([^;]+)", body)
            },
        )
        for selector, body in rules
    ]


def _colour(value):
    found = re.search(r"#(?:[0-9a-f]{6}|[0-9a-f]{3})\b", value or "", re.IGNORECASE)
    return found[0] if found else None


@pytest.mark.parametrize("sheets", [("base", "screen"), ("base", "print")], ids=["screen", "print"])
def test_text_is_readable_on_every_ground_it_may_stand_on(sheets):
    """Every text colour on every ground that sets no colour of its own, and on its own where it sets both."""
    rules = _rules("".join((resources.templates() / "style" / f"{name}.css").read_text("utf-8") for name in sheets))
    inks, grounds, pairs = {"#1c1c1c"}, {"#ffffff"}, []
    for selector, body in rules:
        ink = _colour(body.get("color"))
        ground = _colour(body.get("background") or body.get("background-color"))
        if ink and ground:
            pairs.append((selector, ink, ground))
        elif ink:
            inks.add(ink)
        elif ground:
            grounds.add(ground)
    pairs += [("any", ink, ground) for ink in inks for ground in grounds]
    assert len(pairs) > 6
    for selector, ink, ground in pairs:
        assert _contrast(ink, ground) >= CONTRAST, f"{selector}: {ink} on {ground}"
