"""Names that are written otherwise than where they are defined, with look-alike dashes or wide letters."""

from dataclasses import replace

from assess.errors import Correction, Problem
from assess.i18n import fill
from assess.workbook.habits import note
from assess.workbook.names import key
from assess.workbook.parse import Table, Tables
from assess.workbook.resolve import defined
from assess.workbook.schema import Column
from assess.workbook.values import shorten


def correct_names(tables: Tables) -> tuple[Tables, list[Problem]]:
    """Return the tables with corrections of names of other sheets, and the notes on them.

    Letter case alone is no difference: a spreadsheet's look-ups ignore it, too.
    """
    found: dict[str, Table] = {}
    notes: list[Problem] = []
    for sheet, table in tables.items():
        corrections: list[Correction] = []
        for column in table.sheet.columns:
            if column.source and column.name in table.places:
                _correct_column(table, column, defined(tables[column.source]), notes, corrections)
        found[sheet] = replace(table, corrections=(*table.corrections, *corrections)) if corrections else table
    return found, notes


def _correct_column(
    table: Table, column: Column, known: dict[str, str], notes: list[Problem], corrections: list[Correction]
) -> None:
    spellings = {None, *known.values()}
    for row in (row for row in table.rows if row.values[column.name] not in spellings):
        typed = row.get(column.name)
        spelt = known.get(key(typed), typed)
        if spelt.casefold() == typed.casefold():
            continue
        remark = note("signs", fill(table.label(column.name)), shorten(typed), shorten(spelt), spelt)
        problem = table.problem(column.name, row, remark.message, severity=remark.severity)
        notes.append(replace(problem, group=f"{column.name}: {remark.habit}"))
        if table.source is not None and table.source.title:
            corrections.append(Correction(table.source.title, problem.cell, typed, spelt, remark.why))
