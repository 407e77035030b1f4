"""The texts of the page in a language: of the catalogues, those that its modules name."""

import json
import re
from functools import cache
from pathlib import Path
from typing import Any

from assess.i18n import LANGUAGES, list_languages, load_catalogue
from assess.risk import LIMITS

COOKIE = "assess-language"
"""The cookie in which the page keeps the language that its user chose."""
PAGE = Path(__file__).with_name("page")
_STRING = r"""(?:"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'|`(?:[^`\\$]|\\.)*`)"""
_SUM = rf"{_STRING}(?:\s*\+\s*{_STRING})*"
_CALL = re.compile(rf"(?<![\w$.])(?:t\(\s*(?P<text>{_SUM})|tn\(\s*(?P<one>{_SUM})\s*,\s*(?P<many>{_SUM}))")
"""``t("...")`` and ``tn("...", "...", n)`` with plain literals, as docs/page.md asks for."""


def describe_texts(language: str) -> dict[str, Any]:
    """Return the texts of the page in a language, English where it is unknown, and how its numbers are written.

    Percentages are not rounded across the limits of the classes.
    """
    code = language if language in LANGUAGES else LANGUAGES[0]
    catalogue = load_catalogue(code)
    texts: dict[str, str | list[str]] = {}
    for one, many, _ in list_texts():
        texts[one] = [catalogue.find(one, many, n) for n in (1, 2)] if many else catalogue.find(one)
    return {
        "language": code,
        "languages": [list(pair) for pair in list_languages()],
        "texts": texts,
        "decimal": catalogue.decimal,
        "group": catalogue.group,
        "limits": list(LIMITS),
    }


def list_texts() -> list[tuple[str, str, str]]:
    """Return every text of the page, its other form for more than one, else blank, and the module that names it."""
    paths = sorted(PAGE.glob("*.mjs"))
    return list(_list_texts(tuple((path, path.stat().st_mtime_ns) for path in paths)))


@cache
def _list_texts(modules: tuple[tuple[Path, int], ...]) -> tuple[tuple[str, str, str], ...]:
    return tuple(
        (_evaluate(found["text"] or found["one"]), _evaluate(found["many"] or ""), path.relative_to(PAGE).as_posix())
        for path, _ in modules
        for found in _CALL.finditer(path.read_text(encoding="utf-8"))
    )


def _evaluate(source: str) -> str:
    """Return the text that a sum of literals is."""
    parts = []
    for literal in re.findall(_STRING, source):
        inner = literal[1:-1]
        if literal[0] != '"':
            inner = re.sub(r"\\(['`$])", r"\1", inner).replace('"', '\\"').replace("\n", "\\n")
        parts.append(str(json.loads(f'"{inner}"')))
    return "".join(parts)


def choose_language(chosen: str, of_book: str, accepted: str) -> str:
    """Return the language of an answer: the one that was chosen, else the workbook's, else the browser's."""
    wanted = [chosen, of_book, *(part.split(";")[0].strip()[:2].lower() for part in accepted[:200].split(","))]
    return next((code for code in wanted if code in LANGUAGES), LANGUAGES[0])
