"""Counts as stacked bars: symbols and numbers stand in the bars, so that no colour is needed."""

from collections.abc import Sequence

from markupsafe import escape

from assess.i18n import number
from assess.report import words
from assess.report.blocks import Image
from assess.report.counts import Counts

MOST = 30
"""Bars that one picture shows."""
LABEL, WIDTH, ROW, BAR = 150.0, 480.0, 17.0, 13.0
"""Width of the labels and of the bars, height of a row and of a bar, in the picture's own units."""
LEAST = 13.0
"""Width below which a part of a bar holds no number."""


def draw_bars(counts: Sequence[Counts], title: str, most: int = MOST) -> tuple[Image, int] | None:
    """Return a bar for each room or floor, and how many have none; None where there is nothing to show."""
    there = [one for one in counts if one.total]
    shown = there[:most]
    if not shown:
        return None
    scale = (WIDTH - 40) / max(one.total for one in shown)
    bars = []
    for at, one in enumerate(shown):
        y = at * ROW + 2
        below, label = f'y="{y + 9.5:.1f}"', escape(words.cut(one.label, 30))
        bars.append(f'<text x="{LABEL - 6:.1f}" {below} text-anchor="end" fill="#1c1c1c">{label}</text>')
        looks = [(risk.symbol, risk.fill, risk.ink, pieces) for risk, pieces in one.by_class.items()]
        looks += [
            (words.UNCONFIRMED, words.APART_FILL, words.INK, one.unconfirmed),
            (words.BY_FORMULA, words.APART_FILL, words.INK, one.by_formula),
            (words.ROLLING, words.APART_FILL, words.INK, one.rolls),
            (words.ANCHORED, words.ANCHORED_FILL, words.INK, one.anchored),
        ]
        x = LABEL
        for symbol, fill, ink, pieces in looks:
            width = pieces * scale
            if pieces:
                bars.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{BAR:.1f}" fill="{fill}" '
                            'stroke="#444444" stroke-width="0.5"/>')  # fmt: skip
            if width >= LEAST:
                text = f"{symbol} {pieces}" if width >= 2 * LEAST else f"{pieces}"
                bars.append(f'<text x="{x + width / 2:.1f}" {below} text-anchor="middle" fill="{ink}">{text}</text>')
            x += width
        bars.append(f'<text x="{x + 4:.1f}" {below} fill="#1c1c1c">{number(one.total, ",d")}</text>')
    lines = "\n".join(bars)
    heading = escape(title)
    drawn = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="bars" role="img" aria-label="{heading}" '
        f'viewBox="0 0 {LABEL + WIDTH:.0f} {len(shown) * ROW + 4:.0f}" '
        'font-family="Report, Report Signs, DejaVu Sans, sans-serif" font-size="8.5">'
        f"<title>{heading}</title>\n{lines}\n</svg>"
    )
    return Image(drawn), len(there) - len(shown)
