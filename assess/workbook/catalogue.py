"""The built-in types of furniture, one row each in ``catalogue.csv``.

Sizes, weights (with what the piece holds) and centres of gravity are in cm, kg and percent of the height; what a
source does not print is blank or marked *assumed* in the column ``source``. ``uses`` names the uses of
`assess.workbook.schema.USES` that a type belongs to, ``contents`` one of `CONTENTS`: what it is mostly full of;
``fix_by`` and ``mobile`` how an installer fixes it, and whether it stands on castors: assumed, from its name.
"""

from csv import DictReader
from functools import cache
from importlib.resources import files
from io import StringIO
from typing import TYPE_CHECKING, Any

from assess.i18n import LANGUAGES, gettext, load_catalogue
from assess.text import natural_key
from assess.units import QUANTITIES
from assess.workbook.names import key
from assess.workbook.schema import CATALOGUE

if TYPE_CHECKING:
    from assess.workbook.lists import Units

CONTENTS = ("open", "storage", "equipment", "paper", "dense", "solid")
"""What a piece is, or is full of, by which its weight is estimated: lightest first."""
ASSUMED = "assumed"
"""How the source of a type begins where no citable source prints its sizes; such a source is translated."""
_NUMBERS = {"breadth": "breadth_cm", "width": "width_cm", "height": "height_cm", "weight": "weight_kg",
            "centre_of_gravity": "centre_percent"}  # fmt: skip
"""Columns of the file by field; each in the SI unit of the field's header."""
_DECIMALS = 2


def catalogue_rows() -> list[dict[str, str]]:
    """Return the rows of the file as they stand there."""
    return read_table("catalogue.csv")


def read_table(name: str) -> list[dict[str, str]]:
    """Return the rows of a CSV file of this package, each by its header."""
    text = (files("assess.workbook") / name).read_text(encoding="utf-8")
    return list(DictReader(StringIO(text)))


def read_catalogue(units: "Units" = "si", use: str = "") -> list[dict[str, Any]]:
    """Return the built-in types, or those of a use of `USES`, in the language in use and the units of the headers.

    They are sorted by name: the drop-down keeps this order.
    """
    rows = []
    for line in catalogue_rows():
        if use and use.lower() not in line["uses"].split():
            continue
        source = line["source"]
        row: dict[str, Any] = {"type": gettext(line["type"])}
        for name, header in _NUMBERS.items():
            if line[header]:
                column = CATALOGUE.column(name)
                factors = QUANTITIES[column.quantity]
                factor = 1.0 if units == "si" else factors[column.unit] / factors[column.imperial]
                row[name] = round(float(line[header]) * factor, _DECIMALS)
        row["fix_by"] = gettext(line["fix_by"])
        row |= {"mobile": gettext(line["mobile"])} if line["mobile"] else {}
        rows.append({**row, "source": gettext(source) if source.startswith(ASSUMED) else source})
    return sorted(rows, key=lambda row: natural_key(row["type"]))


def find_built_in(name: str) -> dict[str, str] | None:
    """Return the row of a built-in type by its name in any language, English first; None where it is none."""
    own = key(name)
    return next((row for code in LANGUAGES if own and (row := _by_name(code).get(own))), None)


@cache
def _by_name(language: str) -> dict[str, dict[str, str]]:
    find = load_catalogue(language).find
    return {key(find(line["type"])): line for line in catalogue_rows()}


def catalogue_texts() -> list[str]:
    """Return every text of the file that is translated, once: the types, and the sources that are assumed."""
    lines = catalogue_rows()
    sources = (line["source"] for line in lines if line["source"].startswith(ASSUMED))
    return [*(line["type"] for line in lines), *dict.fromkeys(sources)]


def is_assumed(source: str) -> bool:
    """Return whether the source of a type says, in any language, that its sizes are assumed."""
    return source.split(":", maxsplit=1)[0].strip().casefold() in _words_for_assumed()


@cache
def _words_for_assumed() -> frozenset[str]:
    sources = [one for one in catalogue_texts() if one.startswith(ASSUMED)]
    catalogues = [load_catalogue(code) for code in LANGUAGES]
    found = {one.find(source, "", 1).split(":")[0].casefold() for one in catalogues for source in sources}
    return frozenset({ASSUMED, *found})
