"""What stands apart from the simulated pieces: those that are unconfirmed, with what settles them, and by formula."""

from collections.abc import Iterable, Sequence

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.report import words
from assess.report.row_order import by_chance
from assess.results import ItemResult
from assess.risk import RiskClass
from assess.workbook.schema import BUILDING

NAMED = 3
"""Pieces that a sentence names; the rest are counted."""


def list_apart(results: Iterable[ItemResult], basis: str) -> list[ItemResult]:
    """Return the free-standing pieces that stand apart with a basis, the worst by formula first."""
    found = [one for one in results if not one.is_anchored and one.apart == basis]
    return sorted(found, key=by_chance)


def list_parts(results: Sequence[ItemResult]) -> list[tuple[str, list[ItemResult]]]:
    """Return the rows of a list by their basis, each part in their order: the first has no heading."""
    heads = {"": "", "unconfirmed": _("Unconfirmed: nothing is known of the building, or the motions may be too weak"),
             "formula": _("By formula only: not simulated")}  # fmt: skip
    parts = {basis: [one for one in results if one.apart == basis] for basis in heads}
    return [(heads[basis], own) for basis, own in parts.items() if own]


def say_apart(results: Sequence[ItemResult]) -> list[str]:
    """Return sentences on the free-standing pieces that stand apart, with what settles them; none where none do."""
    texts = []
    if unconfirmed := list_apart(results, "unconfirmed"):
        texts.append(f"{_say_unconfirmed(unconfirmed)} {' '.join(list_ways_to_settle(unconfirmed))}")
    if left := list_apart(results, "formula"):
        text = ngettext(
            "{n:,} piece was not simulated and is counted apart, by formula only.",
            "{n:,} pieces were not simulated and are counted apart, by formula only.",
            _pieces(left),
        )
        texts.append(_add_risky(text, left))
    return texts


def _say_unconfirmed(unconfirmed: Sequence[ItemResult]) -> str:
    names = words.name_pieces([one.item.item for one in unconfirmed], NAMED)
    text = ngettext(
        "{n:,} piece is unconfirmed and counted apart, as nothing is known of its building or its motions may be too "
        "weak ({names}).",
        "{n:,} pieces are unconfirmed and counted apart, as nothing is known of their building or their motions may be "
        "too weak ({names}).",
        _pieces(unconfirmed), names=names,
    )  # fmt: skip
    return _add_risky(text, unconfirmed)


def _add_risky(text: str, pieces: Sequence[ItemResult]) -> str:
    """Return a text on pieces followed by how many of them would be high or very high by the formula, if any."""
    risky = _pieces(one for one in pieces if one.adopted.risk >= RiskClass.HIGH)
    if not risky:
        return text
    return text + " " + ngettext(
        "{n:,} of them would be high or very high.",
        "{n:,} of them would be high or very high.",
        risky,
    )  # fmt: skip


def list_ways_to_settle(unconfirmed: Iterable[ItemResult]) -> list[str]:
    """Return what to fill in, or to use, so that unconfirmed pieces get a class of their own."""
    flags = {flag for one in unconfirmed for flag in one.adopted.flags}
    ways = []
    if "unknown_building" in flags:
        storeys, period = (_(BUILDING.column(name).label) for name in ("storeys", "period"))
        ways.append(_("To settle this, fill in {storeys} or {period} in the sheet Building, or records of the floors.",
                      storeys=storeys, period=period))  # fmt: skip
    if "weak_motions" in flags:
        ways.append(_("To settle this, simulate under stronger motions: records of your own whose PFV reaches the "
                      "floor's, or scaled to it."))  # fmt: skip
    return ways


def _pieces(results: Iterable[ItemResult]) -> int:
    return sum(one.item.quantity for one in results)
