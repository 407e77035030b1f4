"""What is said of pieces: those that are counted apart, and alike ones as one line."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.natural import natural_key
from assess.report import words
from assess.report.row_order import by_chance, find_kind
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


# ---------------------------------------------------------------- alike pieces

MOST_GROUPS = 110
"""Groups that the client's edition has room for."""
NAMED_ALIKE, LONGEST_NAME = 4, 16
"""Runs of names that a group shows, and characters of a name."""


@dataclass(frozen=True, slots=True)
class PieceGroup:
    """Rows of Items that are alike: floor, description, type, sizes, anchoring and class, in natural order."""

    results: tuple[ItemResult, ...]

    @property
    def first(self) -> ItemResult:
        """The row that stands for all where they agree."""
        return self.results[0]

    @property
    def floor(self) -> str:
        """Their floor."""
        return self.first.item.floor

    @property
    def pieces(self) -> int:
        """How many pieces they are, quantities counted."""
        return sum(one.item.quantity for one in self.results)

    @property
    def names(self) -> str:
        """Their names with runs joined and the number of rows: ``25-07 to 25-09 (3)``."""
        text = words.name_pieces([one.item.item for one in self.results], NAMED_ALIKE, LONGEST_NAME)
        return f"{text} ({len(self.results)})" if len(self.results) > 1 else text

    @property
    def rooms(self) -> str:
        """Their rooms, as far as the workbook names them."""
        rooms = sorted({words.cut(one.item.room, 24) for one in self.results if one.item.room}, key=natural_key)
        return words.name_first(rooms, 2) or words.DASH

    @property
    def chance(self) -> str:
        """Their chance with its interval; where rows differ, from the least to the largest of both."""
        texts = {words.chance(one) for one in self.results}
        if len(texts) == 1:
            return texts.pop()
        chance = words.percents([one.adopted.probability for one in self.results])
        lows = [one.adopted.low for one in self.results if one.adopted.low is not None]
        highs = [one.adopted.high for one in self.results if one.adopted.high is not None]
        if len(lows) < len(self.results) or len(highs) < len(self.results):
            return chance
        interval = f"({words.percents([min(lows), max(highs)])})".replace(" ", words.NO_BREAK)
        return f"{chance} {interval}"

    @property
    def urgency(self) -> tuple[int, float]:
        """What groups are chosen by where there are too many: class by the upper estimate, then chance."""
        return int(self.first.adopted.upper), max(one.adopted.probability for one in self.results)


def group_rows(rows: Sequence[ItemResult]) -> list[PieceGroup]:
    """Return rows that stand in the order of the tables (`assess.report.row_order.order_rows`) as groups."""
    groups: dict[tuple[object, ...], list[ItemResult]] = {}
    for one in rows:
        groups.setdefault((*find_kind(one), one.item.anchored, words.say_bracket(one)), []).append(one)
    return [PieceGroup(tuple(own)) for own in groups.values()]


def choose_groups(groups: Sequence[PieceGroup], most: int = MOST_GROUPS) -> list[tuple[str, list[PieceGroup]]]:
    """Return groups floor by floor in their order; of too many, those most likely to fall."""
    if len(groups) > most:
        worst = sorted(range(len(groups)), key=lambda at: groups[at].urgency, reverse=True)[:most]
        groups = [groups[at] for at in sorted(worst)]
    return [(floor, list(own)) for floor, own in groupby(groups, key=lambda one: one.floor)]
