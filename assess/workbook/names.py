"""The words of a workbook: headers taken apart, names compared, and sheets, labels and choices in every language.

The code knows the English words. Those of other languages stand in their catalogues, which are loaded only where an
English word does not match: whoever reads a workbook in English does not wait for them.
"""

import difflib
import re
import unicodedata
from collections.abc import Collection, Iterator
from dataclasses import replace
from functools import cache, lru_cache
from itertools import chain

from assess.i18n import LANGUAGES, gettext, load_catalogue
from assess.settings import match_choice
from assess.units import QUANTITIES, read_unit
from assess.workbook.schema import HELP, LISTS, LIVE, SHEETS, WALK_DOWN, WORKINGS, Column, Sheet

ENGLISH, *_OTHERS = LANGUAGES
DASHES = dict.fromkeys(map(ord, "\u2010\u2011\u2012\u2013\u2014\u2015\u2212\ufe58\ufe63\uff0d"), "-")
"""Signs that look like a hyphen or a minus sign."""
NEAR, NEAR_WORD = 0.75, 0.8
"""From these ratios on a name may be a slip of another, and one word of several a slip of another [-]."""
MOST_NEAR = 10
"""So many near names are compared word by word."""
_BRACKET = re.compile(r"^(?P<label>.*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?\s*$", re.DOTALL)


@lru_cache(maxsize=4096)
def split_header(header: str) -> tuple[str, str | None]:
    """Split ``Height [cm]`` into label and unit; the unit is None where there is no bracket."""
    match = _BRACKET.match(header.strip())
    return (match["label"], match["unit"]) if match else (header.strip(), None)


@lru_cache(maxsize=4096)  # the same floors and choices stand in row after row
def key(text: str) -> str:
    """Return a name as names are compared: letter case, the number of spaces and the kind of dash ignored."""
    plain_signs = text if text.isascii() else unicodedata.normalize("NFKC", text.translate(DASHES))
    return " ".join(plain_signs.split()).casefold()


def fold(text: str) -> str:
    """Return a label as labels of one language are compared: letter case and spaces ignored."""
    return "".join(key(text).split())


@lru_cache(maxsize=4096)  # the same labels stand in workbook after workbook
def plain(text: str) -> str:
    """Return a label as labels are compared in all languages: as `fold` does, and without accents."""
    return fold(_bare(text))


def _bare(text: str) -> str:
    """Leave out accents, and the apostrophes that are typed in their place: ``Profondita'``."""
    if text.isascii() and "'" not in text:
        return text
    parts = unicodedata.normalize("NFD", text)
    return "".join(sign for sign in parts if not unicodedata.combining(sign) and sign not in "'\u2019`\u00b4")


def find_near(word: str, words: Collection[str]) -> str | None:
    """Return the one of `words` that a word is most likely a slip of; None if none is near."""
    near = difflib.get_close_matches(word, words, 1, NEAR)
    return near[0] if near else None


def find_near_name(name: str, names: Collection[str]) -> str | None:
    """Return the name that a name is likely a slip of, word by word: Mystery cabinet is none of Tray cabinet."""
    for other in difflib.get_close_matches(name, names, MOST_NEAR, NEAR):
        if re.findall(r"\d+", name) != re.findall(r"\d+", other):
            continue  # Room 12 is no slip of Room 11
        words, others = name.split(), other.split()
        if len(words) != len(others) or min(len(words), len(others)) < 2:
            return other
        pairs = zip(words, others, strict=True)
        if all(difflib.SequenceMatcher(None, one, two).ratio() >= NEAR_WORD for one, two in pairs):
            return other  # South office is no slip of North office
    return None


@cache
def translate(sheet: Sheet, code: str) -> Sheet:
    """Return a sheet with its name and labels in a language; all else, choices too, stays as it is."""
    if code == ENGLISH:
        return sheet
    find = load_catalogue(code).find
    columns = tuple(
        replace(one, label=find(one.label), aliases=tuple(map(find, one.aliases)), language=code)
        for one in sheet.columns
    )
    return replace(sheet, name=find(sheet.name), columns=columns)


def versions(sheet: Sheet) -> Iterator[Sheet]:
    """Yield a sheet in every language, English first."""
    return (translate(sheet, code) for code in LANGUAGES)


def find_column(sheet: Sheet, label: str) -> Column | None:
    """Return the column that a label, or an earlier one, names in any language, with its label in that language."""
    wanted = plain(label)
    return next((found for code in LANGUAGES if (found := _columns_by_label(sheet, code).get(wanted))), None)


@cache
def _columns_by_label(sheet: Sheet, code: str) -> dict[str, Column]:
    pairs = [(plain(label), one) for one in translate(sheet, code).columns for label in one.labels]
    return dict(reversed(pairs))


def find_near_column(sheet: Sheet, own: Sheet, header: str, labels: Collection[str]) -> Column | None:
    """Return the column of which a header is most likely a slip: Weight [kg] next to Height [cm] is none.

    `own` is the sheet with the names that the workbook gives it, `labels` all labels of the header row.
    """
    label, unit = split_header(header)
    folded = plain(label)
    for one in chain(own.columns, *(version.columns for version in versions(sheet))):
        known, units = plain(one.label), QUANTITIES.get(one.quantity, {})
        bare = folded.removeprefix(known).strip("()_,;:-/.")  # Height (cm)
        if unit is None and folded.startswith(known) and read_unit(bare) in units:
            return one
        if unit is not None and read_unit(unit) not in units:
            continue
        if difflib.SequenceMatcher(None, folded, known).ratio() < 0.8:
            continue
        if known not in labels or folded[:1] == known[:1]:
            return one
    return None


def find_sheet(name: str) -> tuple[str, str] | None:
    """Return the English name and the language of the sheet that a name stands for, None for a sheet of one's own."""
    wanted = plain(name)
    if wanted in map(plain, (HELP, LISTS, WALK_DOWN)):
        return None
    return next(((names[wanted], code) for code in LANGUAGES if wanted in (names := _sheet_names(code))), None)


def is_cobie_list(names: Collection[str]) -> bool:
    """Tell whether the names of sheets are those of a COBie file: Type, Component and Space, but no Items."""
    found = {plain(name) for name in names}
    return {"component", "type", "space"} <= found and "items" not in found


@cache
def _sheet_names(code: str) -> dict[str, str]:
    return {plain(translate(sheet, code).name): sheet.name for sheet in SHEETS}


def is_live(sheet: Sheet, label: str) -> bool:
    """Tell whether a label is one of the columns that Excel computes, which reading leaves out."""
    if plain(label) in _live_labels(ENGLISH):
        return True
    return find_column(sheet, label) is None and find_live(label) is not None


def find_live(label: str) -> str | None:
    """Return the header, of `LIVE` or `WORKINGS`, of the column of Excel that a label means; None if none."""
    wanted = plain(label)
    return next((_live_labels(code)[wanted] for code in LANGUAGES if wanted in _live_labels(code)), None)


@cache
def _live_labels(code: str) -> dict[str, str]:
    names = {header: split_header(header)[0] for header in (*LIVE, *WORKINGS)}
    return {plain(name if code == ENGLISH else load_catalogue(code).find(name)): one for one, name in names.items()}


@lru_cache(maxsize=4096)  # the same choices stand in row after row
def find_choice(text: str, choices: tuple[str, ...]) -> str | None:
    """Return the choice, in English, that a text means in any language, or its part before a comma; None if none."""
    if (choice := match_choice(text, choices)) is not None:
        return choice
    for code in _OTHERS:
        words = {_bare(word): choice for word, choice in zip(translate_choices(choices, code), choices, strict=True)}
        if (word := match_choice(_bare(text), words)) is not None:
            return words[word]
    return next((choice for choice in choices if "," in choice and fold(choice.partition(",")[0]) == fold(text)), None)


def translate_choices(choices: tuple[str, ...], code: str) -> tuple[str, ...]:
    """Return choices in a language."""
    return choices if code == ENGLISH else tuple(load_catalogue(code).find(choice) for choice in choices)


def translate_header(label: str) -> str:
    """Return the header of a column that Excel computes in the language in use."""
    name, unit = split_header(label)
    return f"{gettext(name)} [{unit}]" if unit else gettext(name)
