"""Types of a workbook's Catalogue that follow a building model, and what people call a type in Items."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from assess.bim.import_workbook import name_apart
from assess.bim.update_cells import TOLERANCE
from assess.bim.update_names import Named, match_alike, match_rooms
from assess.bim.update_rows import BookUpdate, Rows
from assess.i18n import LANGUAGES, fill, load_catalogue, speaking
from assess.workbook.catalogue import read_catalogue
from assess.workbook.names import key
from assess.workbook.parse import Row
from assess.workbook.schema import CATALOGUE

SIZES = ("breadth", "width", "height")


@dataclass(slots=True)
class TypeUpdate:
    """The types of a model in a workbook.

    Attributes
    ----------
    book : BookUpdate
        The workbook.
    rows : sequence of mapping
        The types of the model.
    names : dict of str to str
        What the Catalogue calls a type of the model, or will call it, by its name as names are compared.
    renamed : dict of str to str
        Likewise what Items calls it, where that is another type.
    """

    book: BookUpdate
    rows: Rows
    names: dict[str, str] = field(default_factory=dict)
    renamed: dict[str, str] = field(default_factory=dict)
    _own: Sequence[Row] = ()
    _found: Mapping[int, int] = field(default_factory=dict)

    def match(self, pairs: Iterable[tuple[str, str]]) -> None:
        """Find out which types are which.

        `pairs`: the types, in the model and in the workbook, of every piece that both have.
        """
        sheet = self.book.sheets.get("Catalogue")
        self._own = sheet.table.with_all("type") if sheet else ()
        own = [Named(row.get("type"), tuple(row.get(name) for name in SIZES)) for row in self._own]
        model = [Named(row["type"], _find_sizes(row)) for row in self.rows]
        self._found = match_alike(model, own, _is_same)
        taken = [one.name for one in own]
        new = [one for at, one in enumerate(model) if at not in self._found]
        added = iter(name_apart([*taken, *(one.name for one in new)])[len(taken) :])
        for at, kind in enumerate(model):
            self.names[key(kind.name)] = own[self._found[at]].name if at in self._found else next(added)
        known = {*self.names, *map(key, self.names.values())}
        found = match_rooms((("", one, other) for one, other in pairs), known)
        sizes = {key(one.name): one.content for one in model}
        for (_, one), other in found.items():
            if self._is_of_people(other, sizes.get(one, ())):
                self.renamed[one] = other

    def find(self, name: str) -> str:
        """Return what Items calls a type of the model."""
        return self.renamed.get(key(name)) or self.names.get(key(name), name)

    def update(self) -> None:
        """Update the sizes of the types that both have, and add those of the model alone."""
        sheet = self.book.sheets.get("Catalogue")
        for at, other in self._found.items():
            row, model = self._own[other], self.rows[at]
            for name in SIZES:
                if sheet is None:
                    continue
                if _is_built_in(row):
                    sheet.keep(row, name, model.get(name), fill("the type comes with the program"))
                else:
                    sheet.replace(row, name, model.get(name))
        new = [row for at, row in enumerate(self.rows) if at not in self._found]
        self.book.add("Catalogue", [{**row, "type": self.names[key(row["type"])]} for row in new])

    def _is_of_people(self, name: str, sizes: Sequence[float | None]) -> bool:
        """Tell whether people chose a type for pieces of a model, rather than the model that gave it another before."""
        row = next((row for row in self._own if key(row.get("type")) == key(name)), None)
        return row is None or _is_built_in(row) or _is_same(sizes, [row.get(one) for one in SIZES])


def _find_sizes(row: Mapping[str, Any]) -> tuple[float | None, ...]:
    return tuple(None if row.get(name) is None else row[name] * CATALOGUE.column(name).factor for name in SIZES)


def _is_same(sizes: Sequence[float | None], others: Sequence[float | None]) -> bool:
    pairs = list(zip(sizes, others, strict=False))
    return bool(pairs) and all(one == other if one is None or other is None else abs(one - other) <= TOLERANCE["length"]
                               for one, other in pairs)  # fmt: skip


def _is_built_in(row: Row) -> bool:
    return (key(row.get("type")), key(row.get("source") or "")) in _list_built_in()


@cache
def _list_built_in() -> frozenset[tuple[str, str]]:
    found = set()
    for code in LANGUAGES:
        with speaking(load_catalogue(code)):
            found |= {(key(row["type"]), key(row.get("source") or "")) for row in read_catalogue()}
    return frozenset(found)
