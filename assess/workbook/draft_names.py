"""The mark of routes that were drafted from a building model and that nobody has walked yet: "(draft)" at the end.

It is part of the Route's name, so that every list, plan and page that names the route carries it, until a person who
has reviewed the route takes it off.
"""

from collections.abc import Iterator
from functools import cache

from assess.errors import Problem
from assess.i18n import LANGUAGES, fill, gettext, load_catalogue, nfill
from assess.workbook.habits import shorten
from assess.workbook.names import key
from assess.workbook.parse import Row, Tables
from assess.workbook.schema import DEFAULT_WIDTH

DRAFT = fill("(draft)")
"""The mark, in English; it is known in every language."""
LONGEST = 60
"""Characters of a marked name: a longer one would be cut in messages, and lose its mark there."""


def mark_draft(name: str) -> str:
    """Return the name of a drafted route with the mark of the language in use; a long one is cut before it."""
    mark = f" {gettext(DRAFT)}"
    return name[: LONGEST - len(mark)].rstrip() + mark


@cache
def _marks() -> tuple[str, ...]:
    return tuple({key(load_catalogue(code).find(DRAFT)) for code in LANGUAGES})


def is_draft(name: str) -> bool:
    """Tell whether a Route's name ends in the mark, in any language; each is a word in brackets."""
    return name.rstrip().endswith(")") and key(name).endswith(_marks())


def check_drafts(tables: Tables) -> Iterator[Problem]:
    """Warn, once a workbook, of routes that still carry the mark."""
    table = tables["Routes"]
    drafts: dict[str, Row] = {}
    for row in table.with_all("route"):
        if is_draft(row.get("route")):
            drafts.setdefault(key(row.get("route")), row)
    if not drafts:
        return
    first = next(iter(drafts.values()))
    name = first.get("route")
    message = nfill("Route {route} was drafted from a building model.",
                    "{n} routes were drafted from a building model, such as {route}.", len(drafts),
                    route=shorten(name))  # fmt: skip
    fix = nfill("Walk it, correct it, and take '{mark}' off its name.",
                "Walk them, correct them, and take '{mark}' off their names.", len(drafts),
                mark=name[name.rindex("(") :].strip())  # fmt: skip
    yield table.problem("route", first, message, fix, "warning")
    given = [row for row in table.with_all("route", "required_width") if is_draft(row.get("route"))]
    if narrow := [row for row in given if row.get("required_width") < DEFAULT_WIDTH]:
        message = nfill(
            "{n} drafted segment asks for less than {width:g} m: its Required width is that of its door.",
            "{n} drafted segments ask for less than {width:g} m: their Required width is that of their doors.",
            len(narrow), width=DEFAULT_WIDTH,
        )  # fmt: skip
        fix = fill("Fill in the width that must stay free.")
        yield table.problem("required_width", narrow[0], message, fix, "warning")
