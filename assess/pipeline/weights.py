"""The weight of a piece: as the workbook gives it, its type's, or an estimate from what it is mostly full of.

An estimate is a density times the piece's outline. Only two of the densities come from weighed pieces; the others are
assumed, on the high side for what is usual: a bracket that is chosen by them is rather too strong than too weak.

References
----------
Tokyo Metropolitan Government (2015). Product test of devices against the overturning of furniture. March 2015: a chest
and a cupboard with contents, 160 and 157 kg/m3.
Krakower M (2000). Tests of the California Office of the State Architect. Mailing list of the Structural Engineers
Association International: double-faced library shelving of 21 in by 7.5 ft, books alone 350 lb/ft, 427 kg/m3.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

from assess.i18n import Text, fill
from assess.model import Item
from assess.units import GRAVITY
from assess.workbook.catalogue import find_contents

WIDTH = 1.0
"""Width that is assumed where none is given [m]: forces are then those of one metre of the piece."""


class Density(NamedTuple):
    """Weight with contents over the volume of the outline [kg/m3], what it stands for, and where it comes from."""

    value: float
    meaning: Text
    source: Text


_ASSUMED = fill("assumed")
DENSITIES = {
    "open": Density(80.0, fill("open furniture"), _ASSUMED),
    "storage": Density(
        160.0, fill("storage with usual contents"), fill("Tokyo Metropolitan Government 2015, two pieces with contents")
    ),
    "equipment": Density(250.0, fill("equipment and appliances"), _ASSUMED),
    "paper": Density(430.0, fill("books and files"), fill("Krakower 2000, library shelving full of books")),
    "dense": Density(600.0, fill("dense equipment and heavy stock"), _ASSUMED),
    "solid": Density(1000.0, fill("solid pieces"), _ASSUMED),
}
"""Densities by what a piece is mostly full of, one of `assess.workbook.catalogue.CONTENTS`."""
UNKNOWN = "paper"
"""What a piece of no known type is taken to be full of."""


@dataclass(frozen=True, slots=True)
class Weight:
    """The weight of a piece with its contents [N], where it comes from, and whether any part of it is assumed.

    `source` is "given", "type" or "estimate"; `words` say it. `is_per_metre`: whether it is that of one metre of the
    piece's width, as its own is not known.
    """

    value: float
    source: str
    words: Text
    is_assumed: bool
    is_per_metre: bool = False


def find_weight(item: Item, language: str = "en") -> Weight:
    """Return the weight of a piece with its contents; `language` is that of the workbook, in which it names types."""
    if item.weight is not None:
        is_type = "weight" in item.assumed
        words = _FROM_TYPE if is_type else _GIVEN
        return Weight(item.weight * GRAVITY, "type" if is_type else "given", words, is_assumed=False)
    contents = find_contents(item.type, language)
    density, words = DENSITIES[contents or UNKNOWN].value, _describe_estimate(contents)
    volume = item.breadth * (item.width or WIDTH) * item.height
    return Weight(density * volume * GRAVITY, "estimate", words, is_assumed=True, is_per_metre=item.width is None)


_FROM_TYPE, _GIVEN = fill("as its Type in the Catalogue has it"), fill("as the workbook gives it")


@cache  # the same few sentences for every row
def _describe_estimate(contents: str) -> Text:
    density = DENSITIES[contents or UNKNOWN]
    filled: dict[str, Any] = {"density": density.value, "meaning": density.meaning, "source": density.source}
    if not contents:
        return fill("estimated: {density:g} kg/m³, assumed to be full of {meaning} ({source})", **filled)
    return fill("estimated: {density:g} kg/m³, {meaning} ({source})", **filled)
