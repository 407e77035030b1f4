"""What is said of pieces: what each is, their order, and those that are counted apart."""

from collections.abc import Iterable, Sequence

from assess.i18n import gettext as _, ngettext
from assess.report import words
from assess.results import ROLLS, ItemResult, count_pieces
from assess.risk import RiskClass
from assess.text import natural_key
from assess.workbook.schema import BUILDING


def describe(one: ItemResult, longest: int = 80) -> str:
    """Return the piece in the workbook's words, and that it is partly anchored or its bracket fails."""
    text = one.item.description or one.item.type or _("no description")
    is_failing = one.item.anchored == "yes" and not one.is_anchored
    if one.item.anchored != "partly" and not is_failing:
        return words.cut(text, longest)
    note = _("bracket fails") if is_failing else _("partly anchored")
    return f"{words.cut(text, max(12, longest - len(note) - 2))}, {note}"


def by_chance(one: ItemResult) -> tuple[object, ...]:
    """Return what sorts rows by their class and chance, the worst first, then by name."""
    return -one.adopted.upper, -one.adopted.probability, natural_key(one.item.item)


def find_kind(one: ItemResult) -> tuple[object, ...]:
    """Return what identical rows share: floor, description, type, sizes, anchoring and class."""
    item, adopted = one.item, one.adopted
    sizes = (item.breadth_cm, item.width_cm, item.height_cm)
    return item.floor, item.description, item.type, sizes, one.is_anchored, one.apart, adopted.risk, adopted.upper


def order_rows(rows: Sequence[ItemResult], floors: Sequence[str]) -> list[ItemResult]:
    """Return rows by `floors` and then in natural order of their names; identical ones where the first of them is."""
    rank = {floor: at for at, floor in enumerate(floors)}
    groups: dict[tuple[object, ...], list[ItemResult]] = {}
    for one in sorted(rows, key=lambda row: natural_key(row.item.item)):
        groups.setdefault(find_kind(one), []).append(one)
    return [one for own in sorted(groups.values(), key=lambda own: rank[own[0].item.floor]) for one in own]


def list_apart(results: Iterable[ItemResult], basis: str) -> list[ItemResult]:
    """Return the free-standing pieces counted apart on a basis ("": those of the run's own basis), the worst first."""
    found = [one for one in results if not one.is_anchored and one.apart == basis]
    return sorted(found, key=by_chance)


def list_risky(results: Iterable[ItemResult], basis: str = "") -> list[ItemResult]:
    """Return those of them that reach high by the upper estimate."""
    return [one for one in list_apart(results, basis) if one.adopted.upper >= RiskClass.HIGH]


def say_apart(results: Sequence[ItemResult]) -> list[str]:
    """Return sentences on the free-standing pieces that are counted apart, and on what settles them."""
    texts = []
    if unconfirmed := list_apart(results, "unconfirmed"):
        text = ngettext("{n:,} piece is unconfirmed and counted apart, as nothing is known of its building or its "
                        "motions may be too weak ({names}).",
                        "{n:,} pieces are unconfirmed and counted apart, as nothing is known of their building or "
                        "their motions may be too weak ({names}).", count_pieces(unconfirmed),
                        names=words.name_pieces([one.item.item for one in unconfirmed], 3))  # fmt: skip
        texts.append(f"{_add_risky(text, unconfirmed)} {' '.join(list_ways_to_settle(unconfirmed))}")
    if left := list_apart(results, "formula"):
        text = ngettext("{n:,} piece was not simulated and is counted apart, by formula only.",
                        "{n:,} pieces were not simulated and are counted apart, by formula only.",
                        count_pieces(left))  # fmt: skip
        texts.append(_add_risky(text, left))
    if rolling := list_apart(results, ROLLS):
        texts.append(ngettext(
            "{n:,} piece stands on castors and rolls, which is not covered: it is in no class and no sum ({names}).",
            "{n:,} pieces stand on castors and roll, which is not covered: they are in no class and no sum ({names}).",
            count_pieces(rolling), names=words.name_pieces([one.item.item for one in rolling], 3)))  # fmt: skip
    return texts


def _add_risky(text: str, pieces: Sequence[ItemResult]) -> str:
    """Return a text on pieces followed by how many of them would be high or very high by the formula, if any."""
    risky = count_pieces(one for one in pieces if one.adopted.risk >= RiskClass.HIGH)
    more = ngettext("{n:,} of them would be high or very high.", "{n:,} of them would be high or very high.", risky)
    return f"{text} {more}" if risky else text


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
