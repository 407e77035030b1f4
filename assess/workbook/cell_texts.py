"""Names and choices in cells, as formulas compare them: as the program does, letter case and stray spaces ignored.

A formula compares less freely than the program in what is rare (accents, signs of full width): it then shows that it
does not know the name, never the class of another.
"""

from collections.abc import Iterator

from assess.i18n import LANGUAGES
from assess.workbook.names import fold, plain, say_choices

_SPACE = "\u00a0"
"""The space that breaks no line, which texts from documents and pages hold; TRIM leaves it."""

_WILD = "~*?"
"""Signs that MATCH takes for other signs unless a tilde stands before them."""


def trim(cell: str) -> str:
    """Return an expression for the text of a cell without leading, trailing and repeated spaces."""
    return f'TRIM(SUBSTITUTE({cell},"{_SPACE}"," "))'


def find_row(name: str, keys: str) -> str:
    """Return an expression for the place of a trimmed name among `keys`, an error where it is none of them."""
    for sign in _WILD:
        name = f'SUBSTITUTE({name},"{sign}","~{sign}")'
    return f"MATCH({name},{keys},0)"


def is_among(cell: str, words: str) -> str:
    """Return an expression for whether a cell holds one of `words`, written by `list_words`."""
    return f'ISNUMBER(FIND("|"&LOWER({trim(cell)})&"|",{words}))'


def list_words(choices: tuple[str, ...], choice: str) -> str:
    """Return the ways to type a choice, in every language and short, as one text: ``|yes|y|``."""
    return f"|{'|'.join(dict.fromkeys(_spell(choices, choice)))}|"


def _spell(choices: tuple[str, ...], choice: str) -> Iterator[str]:
    for code in LANGUAGES:
        said = dict(zip(choices, say_choices(choices, code), strict=True))
        word, others = said.pop(choice), [fold(other) for other in said.values()]
        yield from (fold(word), plain(word), f"{plain(word)}'")
        if not any(other.startswith(plain(word)[0]) for other in others):
            yield plain(word)[0]
