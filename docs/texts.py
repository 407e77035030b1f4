"""Collect every text of the reports, the workbook and the page into the catalogues: ``make texts``.

Texts are the arguments of `_`, `gettext`, `ngettext`, `fill`, `nfill` and of the `about` of errors in the code and in
the templates, of `t` and `tn` in the modules of the page, and the texts of methods, profiles, flags and columns.
Translations are kept; texts that are no longer used are removed.
"""

import sys
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.extract import extract_from_dir
from babel.messages.pofile import read_po, write_po

from assess import resources
from assess.i18n import LANGUAGES
from assess.web.texts import list_texts

ROOT = Path(__file__).parents[1]
KEYWORDS = {"_": None, "gettext": None, "fill": None, "about": None, "ngettext": (1, 2), "nfill": (1, 2)}
HEAD = """# Texts of assess in {name}. Made by: make texts. {purpose}
msgid ""
msgstr ""
"Project-Id-Version: assess\\n"
"Language: {code}\\n"
"Plural-Forms: {plural}\\n"
"MIME-Version: 1.0\\n"
"Content-Type: text/plain; charset=utf-8\\n"
"Content-Transfer-Encoding: 8bit\\n"

"""
"""The head of every catalogue: it holds no dates and no names, so that only texts make a difference."""
TRANSLATED = "Fill in what is empty; keep the names in {}."
ENGLISH = """Every text stands for itself here.
# This is the list of all texts: to word some otherwise, copy them, with this head, to texts/en.po in a folder of
# templates of your own, and edit them there; keep the names in {}."""
"""Why there is a catalogue of English, the language of the code."""


def collect() -> Catalog:
    """Return every text, with where it stands."""
    catalogue = Catalog(charset="utf-8")
    for folder, rules in ((ROOT / "assess", [("**.py", "python")]), (ROOT / "templates", [("**.j2", "jinja2")])):
        for name, _, message, comments, _ in extract_from_dir(
            folder, rules, keywords=KEYWORDS, options_map={"**.j2": {"trimmed": "true", "silent": "false"}}
        ):
            catalogue.add(message, locations=[(f"{folder.name}/{name}", 0)], auto_comments=comments)
    for one, many, name in list_texts():
        catalogue.add((one, many) if many else one, locations=[(f"assess/web/page/{name}", 0)])
    for text, where in _of_themselves():
        catalogue.add(text, locations=[(where, 0)])
    return catalogue


def _of_themselves() -> Iterator[tuple[str, str]]:
    """Yield the texts that are not inside a call, and where they stand."""
    yield from _of_methods()
    yield from _of_columns()
    yield from _of_the_workbook()


def _of_methods() -> Iterator[tuple[str, str]]:
    from assess.methods import all_methods
    from assess.methods.fitted import REASONS
    from assess.motion.scenario import PROFILES, UNVERIFIED, VERIFIED
    from assess.results import MOTION_FLAGS, PIECE_FLAGS
    from assess.risk import RiskClass
    from assess.route_results import FLAGS as ROUTE_FLAGS, RouteState
    from assess.routes.widths import RULES

    for method in all_methods():
        yield from ((text, f"assess/methods/{method.key}.py") for text in method.texts)
    yield from ((text, "assess/methods/fitted.py") for text in REASONS)
    for rule in RULES:
        yield rule.holds, "assess/routes/widths.py"
        yield rule.reference.remark, "assess/routes/widths.py"
    for flag in (*PIECE_FLAGS, *MOTION_FLAGS):
        yield flag.replace("_", " "), "assess/results.py"
    for flag, text in ROUTE_FLAGS.items():
        yield flag.replace("_", " "), "assess/route_results.py"
        yield text, "assess/route_results.py"
    for profile in PROFILES.values():
        yield from ((text, "assess/motion/scenario.py") for text in (profile.remark, profile.equation) if text)
    yield from ((text, "assess/motion/scenario.py") for text in (VERIFIED, UNVERIFIED))
    yield from ((risk.word, "assess/risk.py") for risk in RiskClass)
    yield from ((str(state), "assess/route_results.py") for state in RouteState)
    yield from ((severity, "assess/errors.py") for severity in ("warning", "note"))


def _of_columns() -> Iterator[tuple[str, str]]:
    from assess.workbook.schema import GROUPS, LIVE, SHEETS, WORKING_GROUP, WORKINGS

    for sheet in SHEETS:
        yield sheet.name, "assess/workbook/schema.py"
        for column in sheet.columns:
            for text in (*column.labels, column.help, column.default, *column.choices, *column.offered):
                if any(character.isalpha() for character in text):
                    yield text, "assess/workbook/schema.py"
    for label in (*LIVE, *WORKINGS, *(name for name, _ in GROUPS), WORKING_GROUP):
        yield label.split(" [")[0], "assess/workbook/schema.py"


def _of_the_workbook() -> Iterator[tuple[str, str]]:
    """Yield what the empty workbook and the example hold beside the names of the columns."""
    from assess.workbook import lists, live_row, template
    from assess.workbook.catalogue import catalogue_texts
    from assess.workbook.example import example_texts, room_texts
    from assess.workbook.schema import HELP, LISTS, WALK_DOWN
    from assess.workbook.worked_example import worked_texts

    texts = (
        template.TITLE,
        *template.HEADS,
        *template.FIRST_LINES,
        template.CLASS_NOTE,
        template.ROCK_NOTE,
        template.COPY_TITLE,
        template.COPY_NOTE,
        template.FOOTER,
    )
    yield from ((text, "assess/workbook/template.py") for text in texts)
    yield from ((text, "assess/workbook/schema.py") for text in (HELP, LISTS, WALK_DOWN))
    yield from (
        (text, "assess/workbook/lists.py")
        for text in (lists.LISTS_NOTE, lists.RUN_ASSESS, lists.NO_SHAKING, lists.NO_UNIT, *lists.LISTED)
    )
    hints = (live_row.NO_FLOOR, live_row.NO_AXIS, lists.WRONG, live_row.IS_ANCHORED)
    yield from ((text, "assess/workbook/live_row.py") for text in hints)
    yield from ((text, "assess/workbook/example.py") for text in example_texts())
    yield from ((text, "assess/workbook/rooms.csv") for text in room_texts())
    yield from ((text, "inventories/market-street.xlsx") for text in worked_texts())
    yield from ((text, "assess/workbook/catalogue.csv") for text in catalogue_texts())


def _head(catalogue: Catalog, code: str) -> str:
    name = catalogue.locale.english_name if catalogue.locale else code
    purpose = ENGLISH if code == "en" else TRANSLATED
    return HEAD.format(name=name, purpose=purpose, code=code, plural=catalogue.plural_forms)


def _body(catalogue: Catalog) -> bytes:
    buffer = BytesIO()
    write_po(buffer, catalogue, sort_output=True, omit_header=True, width=120, include_lineno=False)
    return buffer.getvalue()


def update(code: str) -> None:
    """Bring the catalogue of a language up to date."""
    path = resources.templates() / "texts" / f"{code}.po"
    old = Catalog(locale=code, charset="utf-8")
    if path.is_file():
        with path.open("rb") as file:
            old = read_po(file, locale=code)
    old.update(collect(), no_fuzzy_matching=True)
    old.obsolete.clear()
    if code == "en":
        for message in old:
            message.string = message.string if message.string and all(message.string) else message.id
    path.write_bytes(_head(old, code).encode() + _body(old))
    empty = sum(1 for one in old if one.id and not all(one.string if isinstance(one.string, tuple) else (one.string,)))
    sys.stdout.write(f"{path.name}: {len(old)} texts, {empty} without a translation\n")


if __name__ == "__main__":
    for code in LANGUAGES:
        update(code)
