"""The simulation worked through for one piece: its block, the share of draws that overturn it, and its record."""

import math
from typing import Any

import numpy as np

from assess.i18n import Text, fill, nfill
from assess.methods._expression import number, show
from assess.methods._method import Example
from assess.methods._simulate import interval_width
from assess.risk import wilson_end
from assess.rocking.block import MIDDLE
from assess.units import GRAVITY, LENGTH


def steps(example: Example) -> list[Text]:
    """Work the numbers of the block, then the share of motions that overturn it, and its interval."""
    return [*_work_block(example), *_work_share(example), *_work_record(example)]


def _work_block(example: Example) -> list[Text]:
    B, H = (number(one * LENGTH["cm"], ".6g") for one in (example.breadth, example.height))
    steps, eta, limit = _uniform(B, H) if example.centre == MIDDLE else _any_body(B, H, example.centre)
    if not math.isnan(example.restitution):
        eta = fill("η = {eta:g}, as set for the building.", eta=example.restitution)
    starts = fill(
        "The piece starts to rock where the floor's acceleration exceeds {limit:.4f} m/s².", limit=limit.value
    )
    return [*steps, eta, starts]


def _uniform(B: Any, H: Any) -> tuple[list[Text], Text, Any]:
    """Work a uniform block, as published: its numbers, its restitution, and where rocking starts."""
    alpha, r, g = np.arctan(B / H), 0.5 * np.sqrt(B**2 + H**2), number(GRAVITY, ".5f")
    limit = g * B / H
    p = np.sqrt(3 * g / (4 * number(float(r.value), ".6g")))
    steps = [
        show("α = atan(B/H)", alpha, ".6f", "rad"),
        show("r = ½·√(B² + H²)", r, ".5f", "m"),
        show("p = √(3g/4r)", p, ".4f", "rad/s"),
        show("g·B/H", limit, ".4f", "m/s²"),
    ]
    return steps, show("η = 1 - 1.5·sin² α", 1 - 1.5 * np.sin(number(float(alpha.value), ".6f")) ** 2, ".4f"), limit


def _any_body(B: Any, H: Any, centre: float) -> tuple[list[Text], Text, Any]:
    """Work a body whose centre of gravity is not at mid-height: its numbers, restitution, and where rocking starts."""
    half, height = B / 2, number(centre, ".4g") * H
    b, z, g = number(float(half.value), ".6g"), number(float(height.value), ".6g"), number(GRAVITY, ".5f")
    limit, alpha, radius = g * b / z, np.arctan(b / z), np.sqrt(b**2 + z**2)
    R = number(float(radius.value), ".6g")
    inertia = (B**2 + H**2) / 12 + R**2
    I = number(float(inertia.value), ".6g")  # noqa: E741 - the symbol of mechanics
    steps = [
        show("b = B/2", half, ".5f", "m"),
        show("z_c", height, ".5f", "m"),
        show("α = atan(b/z_c)", alpha, ".6f", "rad"),
        show("R = √(b² + z_c²)", radius, ".5f", "m"),
        show("I₀/m = (B² + H²)/12 + R²", inertia, ".5f"),
        show("p = √(m·g·R/I₀)", np.sqrt(g * R / I), ".4f", "rad/s"),
        show("g·b/z_c", limit, ".4f", "m/s²"),
    ]
    return steps, show("η = 1 - 2·m·R²·sin² α/I₀", 1 - 2 * b**2 / I, ".4f"), limit


def _work_share(example: Example) -> list[Text]:
    k, n, draws = (example.number(name) for name in ("overturned", "runs", "draws"))
    z = interval_width(example.settings)
    share, runs, width = number(example.value, ".5f"), number(n, ".0f"), number(z, ".4f")
    numbers = {"low": example.number("low"), "high": example.number("high"), "z": z}
    return [
        nfill(
            "It overturned in {k:,} of {n:,} draw of an earthquake like this one.",
            "It overturned in {k:,} of {n:,} draws of an earthquake like this one.",
            int(n),
            k=int(k),
        )
        if draws == n
        else fill(
            "It and the pieces exactly like it on its floor overturned in {k:,} of {draws:,} draws of an earthquake "
            "like this one, {n:,} each.",
            k=int(k),
            draws=int(draws),
            n=int(n),
        ),
        show("R = k/n", number(k, ".0f") / number(draws, ".0f"), ".4f"),
        show("R_low", wilson_end(share, runs, width, is_high=False), ".4f"),
        show("R_high", wilson_end(share, runs, width, is_high=True), ".4f"),
        fill("The 95 % interval reaches from {low:.4f} to {high:.4f} (Wilson, z = {z:.2f}).", **numbers),
        *_work_ideal(example, int(n)),
    ]


def _work_ideal(example: Example, runs: int) -> list[Text]:
    fallen = example.number("ideal_overturned")
    if math.isnan(fallen):
        return []  # what is drawn cannot recur
    return [
        nfill(
            "If exactly this motion recurred and the piece were exactly as given, it would overturn under {k:,} of "
            "{n:,} motion.",
            "If exactly this motion recurred and the piece were exactly as given, it would overturn under {k:,} of "
            "{n:,} motions.",
            runs, k=int(fallen),
        )
    ]  # fmt: skip


def _work_record(example: Example) -> list[Text]:
    fell = example.number("record_overturned")
    if math.isnan(fell):
        return []
    if fell:
        return [fill("Under the recorded motion itself it overturns, so its class is at least high.")]
    return [fill("Under the recorded motion itself it does not overturn.")]
