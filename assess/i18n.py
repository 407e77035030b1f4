"""The language of what people read: English in the code, other languages in one catalogue file each.

A text stands in the code and in the templates in English, inside ``gettext`` (named ``_``) or ``ngettext``; the
catalogue of a language, ``templates/texts/<code>.po``, holds its translation. Modules below the reports know no
language: where they make a sentence of parts they return a `Text`, which is the English sentence and remembers its
parts, so that a report can say it in another language; the `message` of an error is one, too. ``make texts`` collects
all texts into the catalogues.
"""

import gettext as _standard
import string
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from assess import resources
from assess.errors import InputError
from assess.text import Text, count, fill, join, nfill, plain_text

__all__ = [
    "ENGLISH", "LANGUAGES", "Catalogue", "Text", "count", "fill", "find_language", "gettext", "join", "list_languages",
    "load_catalogue", "markup", "nfill", "ngettext", "nmarkup", "number", "placeholders", "speaking", "spoken",
]  # fmt: skip

_NAMES: Mapping[str, tuple[str, ...]] = {"en": ("English", "Inglese"), "it": ("Italiano", "Italian")}
LANGUAGES: tuple[str, ...] = tuple(_NAMES)  # codes of the languages of reports and workbooks


@dataclass(frozen=True, slots=True)
class Catalogue:
    """The texts of one language by their English ones, and how its numbers are written."""

    code: str
    messages: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    plural: Callable[[int], int] = lambda n: int(n != 1)
    decimal: str = "."
    group: str = ","

    def find(self, one: str, many: str = "", n: int = 1) -> str:
        """Return the text, or the English one where there is none."""
        found = self.messages.get(one)
        if found is None:
            return many if many and n != 1 else one
        return found[self.plural(n)] if many else found[0]

    def number(self, text: str) -> str:
        """Return a number that Python has formatted as this language writes it."""
        if (self.decimal, self.group) == (".", ","):
            return text
        return text.translate({ord("."): self.decimal, ord(","): self.group})


ENGLISH = Catalogue("en")
_SPOKEN: ContextVar[Catalogue] = ContextVar("spoken", default=ENGLISH)


def spoken() -> Catalogue:
    """Return the catalogue in use."""
    return _SPOKEN.get()


@contextmanager
def speaking(catalogue: Catalogue) -> Iterator[None]:
    """Have `gettext` and its like speak the language of a catalogue."""
    token = _SPOKEN.set(catalogue)
    try:
        yield
    finally:
        _SPOKEN.reset(token)


def gettext(text: str, /, **values: Any) -> str:
    """Return a text, a `Text` with its parts, in the language in use, with `values` put into its ``{}``."""
    return _say(_FORMATTER, text, "", 1, values)


def ngettext(one: str, many: str, n: int, /, **values: Any) -> str:
    """Return the text for one or for many in the language in use, with ``{n}`` and `values` put in."""
    return _say(_FORMATTER, one, many, n, {"n": n, **values})


def markup(text: str, /, **values: Any) -> Any:
    """Return `gettext` for a template: tags of the catalogue's text count, those of `values` are escaped."""
    from markupsafe import Markup

    return Markup(_say(_MARKUP, text, "", 1, values))  # noqa: S704 - the catalogue is part of the templates


def nmarkup(one: str, many: str, n: int, /, **values: Any) -> Any:
    """Return `ngettext` for a template, as `markup` does."""
    from markupsafe import Markup

    return Markup(_say(_MARKUP, one, many, n, {"n": n, **values}))  # noqa: S704 - likewise


def number(value: float, spec: str = "") -> str:
    """Return a number formatted by `spec` as the language in use writes it."""
    return spoken().number(format(value, spec))


def _say(formatter: "_Formatter", one: str, many: str, n: int, values: Mapping[str, Any]) -> str:
    if isinstance(one, Text):
        values = one.values
        many, n, one = one.many, values.get("n", 1), one.template
    found = spoken().find(one, many, n)
    if formatter is _MARKUP and "<" not in found:
        from markupsafe import escape

        found = str(escape(found))
    return formatter.vformat(found, (), values) if values else found


class _Formatter(string.Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:
        if isinstance(value, Text):
            value = gettext(value)
        text = format(value, format_spec)
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return spoken().number(text) if is_number else plain_text(text)


class _MarkupFormatter(_Formatter):
    """Likewise for HTML: everything is escaped but the tags of a text that has some."""

    def format_field(self, value: Any, format_spec: str) -> str:
        from markupsafe import escape

        return (
            str(value.__html__())
            if hasattr(value, "__html__")
            else str(escape(super().format_field(value, format_spec)))
        )


_FORMATTER, _MARKUP = _Formatter(), _MarkupFormatter()


def placeholders(text: str) -> set[str]:
    """Return the names in the ``{}`` of a text."""
    return {name for _, name, _, _ in string.Formatter().parse(text) if name}


def list_languages() -> Iterator[tuple[str, str]]:
    """Yield the code of every language, and how it calls itself."""
    yield from ((code, names[0]) for code, names in _NAMES.items())


def find_language(name: str) -> str:
    """Return the code of a language by its code or name; raises InputError for one that is unknown."""
    wanted = name.strip().casefold()
    for code, names in _NAMES.items():
        if wanted == code or wanted in (one.casefold() for one in names):
            return code
    known = ", ".join(LANGUAGES)
    raise InputError(fill("language {name!r} is unknown: expected one of {known}", name=name, known=known))


@cache
def load_catalogue(code: str, folder: Path | None = None) -> Catalogue:
    """Return the catalogue of a language; texts that `folder` has of its own come first.

    Raises InputError if a catalogue cannot be read, or a text lacks or invents a ``{name}``.
    """
    has_own = folder is not None and (folder / "texts" / f"{code}.po").is_file()
    if code == ENGLISH.code and not has_own:
        return ENGLISH  # the standard one says each text as it stands in the code
    from babel.numbers import get_decimal_symbol, get_group_symbol

    found, plural = _read(resources.templates() / "texts" / f"{code}.po")
    if folder is not None and has_own:
        found |= _read(folder / "texts" / f"{code}.po")[0]
    return Catalogue(code, found, plural, get_decimal_symbol(code), get_group_symbol(code))


def _read(path: Path) -> tuple[dict[str, tuple[str, ...]], Callable[[int], int]]:
    from babel.messages.pofile import PoFileError, read_po

    try:
        with path.open("rb") as file:
            catalogue = read_po(file, abort_invalid=True)
    except (OSError, ValueError, PoFileError) as error:
        raise InputError(fill("{path}: the texts cannot be read: {why}", path=path, why=str(error))) from None
    messages = {}
    for message in catalogue:
        ids, texts = _forms(message.id), _forms(message.string)
        if ids[0] and all(texts):
            counted = {"n"} if len(ids) > 1 else set()
            for text in texts:
                try:  # what is said of one may hold other names than what is said of many
                    off = min((placeholders(text) ^ placeholders(one) - counted for one in ids), key=len)
                except ValueError as error:
                    raise InputError(fill(
                        "{path}: {text!r}: the braces of its text do not match: {why}",
                        path=path, text=ids[0], why=str(error),
                    )) from None  # fmt: skip
                if off - {"n"}:
                    raise InputError(fill(
                        "{path}: {text!r}: its translation has to hold the same names in braces; check {names}",
                        path=path, text=ids[0], names=", ".join(sorted(off)),
                    ))  # fmt: skip
            messages[ids[0]] = texts
    return messages, _standard.c2py(catalogue.plural_expr)


def _forms(text: object) -> tuple[str, ...]:
    return tuple(str(one) for one in text) if isinstance(text, (tuple, list)) else (str(text or ""),)
