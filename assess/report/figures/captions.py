"""Captions and alternative texts of the figures of the verification."""

from collections.abc import Sequence
from dataclasses import dataclass

from assess.language import gettext as _
from assess.language import ngettext
from assess.report import words
from assess.report.content import Content
from assess.report.figures.verification import Traced


@dataclass(frozen=True, slots=True)
class Caption:
    """A figure by its name, what it shows in words, and what it shows for those who cannot see it."""

    name: str
    caption: str
    alternative: str


def caption_traced(content: Content, traced: Sequence[Traced]) -> list[Caption]:
    """Return the captions of the figures that `assess.report.figures.verification.draw_traced` draws."""
    if not traced:
        return []
    names = ", ".join(one.name for one in traced)
    return [_motions(traced[0]), _convergence(content, names), _rotations(names)]


def _motions(worst: Traced) -> Caption:
    floor, axis = words.cut(worst.demand.floor.floor, 20), worst.demand.axis
    spectra, examples = worst.joint.spectra, len(worst.joint.examples)
    texts = [_("Floor {floor} along {axis}, where {item} stands, the worst verified piece.",
               floor=floor, axis=axis, item=worst.name)]  # fmt: skip
    if worst.demand.motion is not None:
        texts.append(
            ngettext(
                "Left: the recorded motion and the first of those made for it.",
                "Left: the recorded motion and the first {n:,} of those made for it.",
                examples,
            )
        )
    else:
        texts.append(ngettext("Left: the first of the motions.", "Left: the first {n:,} of the motions.", examples))
    if spectra is not None:
        texts.append(ngettext(
            "Right: the 5 % response spectrum of {n:,} motion, with the one wanted.",
            "Right: the 5 % response spectra of {n:,} motions, their mean and the band from the 16th to the 84th "
            "percentile, with the one wanted.", len(spectra.ordinates),
        ))  # fmt: skip
    shown = _("Acceleration against time and 5 % response spectra of the motions of floor {floor}, {axis}",
              floor=floor, axis=axis)  # fmt: skip
    return Caption("motions", " ".join(texts), shown)


def _convergence(content: Content, names: str) -> Caption:
    which = _("the worst verified pieces")
    if content.verified.undecided:
        which = _("the worst verified pieces and those left undecided")
    text = _("Chance of overturning against the number of motions: {names} ({which}). Band: the interval; dashed: the "
             "limits of the classes, 3, 30 and 70 %. The upright scale is stretched towards 0.",
             names=names, which=which)  # fmt: skip
    shown = _("Chance of overturning against the number of motions, with its interval, of {names}", names=names)
    return Caption("convergence", text, shown)


def _rotations(names: str) -> Caption:
    text = _("How far the same pieces turned: largest rotation over the critical angle in each motion. White bar: they "
             "stay at rest; hatched bar: they overturn; beyond the dashed line: past the critical angle, yet they came "
             "back.")  # fmt: skip
    shown = _("Bars: share of the motions by the largest rotation over the critical angle, and overturned, of {names}",
              names=names)  # fmt: skip
    return Caption("rotations", text, shown)
