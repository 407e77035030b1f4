"""Names that must fit together: each defined once, each use spelt as where it is defined."""

import difflib

from assess.inventory.cells import shorten
from assess.inventory.labels import key
from assess.inventory.tables import Table
from assess.language import fill


def defined_names(table: Table, name: str) -> dict[str, str]:
    """Return the names that a column defines, by how they are compared."""
    named = [row.values[name] for row in reversed(table.rows) if row.values.get(name) is not None]
    return {key(one): one for one in named}


def check_unique(table: Table, name: str) -> None:
    """Report every name that a column defines a second time."""
    first: dict[str, int] = {}
    label = table.sheet.column(name).label
    for row in table.rows:
        value = row.values.get(name)
        if value is None:
            continue
        if key(value) in first:
            message = f"{label} {shorten(value)} is here twice, also in {table.cell(name, first[key(value)])}."
            table.report(table.cell(name, row.number), message, "Give each its own name.")
        first.setdefault(key(value), row.number)


def check_wildcards(table: Table, name: str) -> None:
    """Warn of names that a spreadsheet's look-up takes for patterns, so that a live column may take another row."""
    label = table.sheet.column(name).label
    for row in table.rows:
        value = row.values.get(name)
        if value is not None and any(sign in value for sign in "*?~"):
            message = fill(
                "{column} {name} holds *, ? or ~, which Excel's look-ups read as patterns.",
                column=fill(label),
                name=shorten(value),
            )
            mend = fill("Rename it: the live columns may show another row's values.")
            table.report(table.cell(name, row.number), message, mend, "warning")


def spell_alike(table: Table, name: str) -> None:
    """Spell every name of a column as where it stands first."""
    found = defined_names(table, name)
    for row in table.rows:
        if row.values.get(name) is not None:
            row.values[name] = found[key(row.values[name])]


def check_named(table: Table, name: str, source: Table, defining: str) -> None:
    """As `check_references`; where the workbook lacks the sheet, that is said once for the whole column."""
    named = [row for row in table.rows if row.values.get(name) is not None]
    if source.found:
        if defining in source.letters:  # else the missing column has been reported
            check_references(table, name, source, defining)
    elif named:
        others = len(named) - 1
        more = f" (and {others} more row{'s' if others > 1 else ''})" if others else ""
        what = f"{table.label(name)} {shorten(named[0].values[name])}{more}"
        message = f"{what} is named, but there is no {source.sheet.name} sheet."
        table.report(table.cell(name, named[0].number), message, "Add the sheet, or clear the column.")


def check_references(table: Table, name: str, source: Table, defining: str) -> None:
    """Spell every name of a column as `source` does; report those that it does not define."""
    if source.sheet.required and not (source.found and defining in source.letters):
        return  # the missing sheet or column has been reported
    label, sheet = table.sheet.column(name).label, source.sheet.name
    found = defined_names(source, defining)
    for row in table.rows:
        value = row.values.get(name)
        if value is not None and key(value) in found:
            row.values[name] = found[key(value)]
        elif value is not None:
            near = difflib.get_close_matches(key(value), found, 1, 0.75)
            hint = f" Did you mean {found[near[0]]}?" if near else ""
            mend = f"Choose one of the {sheet} sheet, or add it there.{hint}"
            table.report(table.cell(name, row.number), f"{label} {shorten(value)} is not in the {sheet} sheet.", mend)
