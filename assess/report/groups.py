"""Alike pieces as one line: what a report for a client lists in place of every row."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from assess.natural import natural_key
from assess.report import words
from assess.report.row_order import find_kind
from assess.results import ItemResult

MOST_GROUPS = 110
"""Groups that the client's edition has room for."""
NAMED, LONGEST_NAME = 4, 16
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
        text = words.name_pieces([one.item.item for one in self.results], NAMED, LONGEST_NAME)
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
