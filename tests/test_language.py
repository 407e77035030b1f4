"""Texts in another language: catalogues that are complete, sentences made of parts, numbers."""

import pickle
import re
from pathlib import Path

import pytest
from babel.messages.pofile import read_po

from assess import resources
from assess.errors import CancelledError, InputError, RecordError
from assess.i18n import (
    LANGUAGES,
    Catalogue,
    fill,
    find_language,
    gettext,
    join,
    load_catalogue,
    markup,
    nfill,
    ngettext,
    nmarkup,
    number,
    placeholders,
    speaking,
)  # fmt: skip
from assess.report.provenance import say_date
from docs.texts import collect


def read(code):
    with (resources.templates() / "texts" / f"{code}.po").open("rb") as file:
        return read_po(file, locale=code, abort_invalid=True)


def write(folder: Path, lines: str, code="it"):
    (folder / "texts").mkdir(exist_ok=True)
    head = (
        'msgid ""\nmsgstr ""\n"Content-Type: text/plain; charset=utf-8\\n"\n'
        '"Plural-Forms: nplurals=2; plural=(n != 1);\\n"\n\n'
    )
    (folder / "texts" / f"{code}.po").write_text(head + lines, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def collected():
    """Every text of the program and of its templates."""
    return {message.id for message in collect() if message.id}


@pytest.mark.parametrize("code", LANGUAGES)
def test_every_text_stands_in_every_catalogue(code, collected):
    head = (resources.templates() / "texts" / f"{code}.po").read_text(encoding="utf-8").partition("\n\n")[0]
    assert not re.search("fuzzy|@", head), "the head names nobody"
    found = {message.id: message for message in read(code) if message.id}
    assert found.keys() == collected, "run: make texts, then fill in what is empty"
    for message in found.values():
        ids = message.id if isinstance(message.id, tuple) else (message.id,)
        texts = message.string if isinstance(message.string, tuple) else (message.string,)
        assert all(texts), f"{ids[0]!r} has no translation in {code}.po"
        assert not message.fuzzy, ids[0]
        for text in texts:
            assert placeholders(text) | {"n"} in [placeholders(one) | {"n"} for one in ids], ids[0]
            assert text.count("<") == ids[0].count("<"), ids[0]


def test_a_sentence_of_parts_is_english_and_can_be_said_otherwise(tmp_path):
    lines = 'msgid "{what} is {size:.1f} m"\nmsgstr "{size:.1f} m: {what}"\n\nmsgid "a desk"\nmsgstr "una scrivania"\n'
    catalogue = load_catalogue("it", write(tmp_path, lines))
    text = fill("{what} is {size:.1f} m", what=fill("a desk"), size=1.25)
    assert text == "a desk is 1.2 m"
    with speaking(catalogue):
        assert gettext(text) == "1,2 m: una scrivania"
    assert gettext(text) == "a desk is 1.2 m"


def test_an_error_is_english_and_its_message_can_be_said_otherwise():
    inner = RecordError(fill("{text!r} is not a number", text="x"))
    error = pickle.loads(pickle.dumps(RecordError(join(": ", ("a.csv", inner.message)))))
    assert (str(error), type(str(error))) == ("a.csv: 'x' is not a number", str)
    with speaking(load_catalogue("it")):
        assert gettext(error.message) == "a.csv: 'x' non è un numero"
        assert str(error) == "a.csv: 'x' is not a number"
    assert (InputError().message, CancelledError().message) == ("", "the work was cancelled; nothing was written.")


def test_one_and_many_and_numbers():
    assert [nfill("{n:,} box", "{n:,} boxes", n) for n in (0, 1, 2000)] == ["0 boxes", "1 box", "2,000 boxes"]
    texts = {"{n:,} box": ("{n:,} scatola", "{n:,} scatole")}
    with speaking(Catalogue("it", texts, decimal=",", group=".")):
        found = [ngettext("{n:,} box", "{n:,} boxes", n) for n in (0, 1, 2000)]
        assert found == ["0 scatole", "1 scatola", "2.000 scatole"]
        assert gettext(nfill("{n:,} box", "{n:,} boxes", 1)) == "1 scatola"
        assert number(1234.5, ",.2f") == "1.234,50"
    assert number(1234.5, ",.2f") == "1,234.50"


def test_values_are_escaped_and_tags_of_the_text_are_not():
    assert str(markup("<b>{name}</b> & {n}", name="<i>", n=1)) == "<b>&lt;i&gt;</b> & 1"
    assert str(markup('a "{name}"', name="x")) == "a &#34;x&#34;"
    assert str(nmarkup("<b>{n}</b> box", "<b>{n}</b> boxes", 2)) == "<b>2</b> boxes"


def test_a_spoilt_catalogue_is_told(tmp_path):
    for lines, told in (
        ('msgid "{n} of {all}"\nmsgstr "{n} di {tutti}"\n', "the same names in braces; check all, tutti"),
        ('msgid "{n} of {all}"\nmsgstr "{n di {all}"\n', "braces of its text do not match"),
        ("msgid no quotes\n", "the texts cannot be read"),
    ):
        load_catalogue.cache_clear()
        with pytest.raises(InputError, match=told):
            load_catalogue("it", write(tmp_path, lines))
    load_catalogue.cache_clear()


def test_languages_have_names():
    for name in ("it", "Italiano", "italian", " Inglese "):
        assert find_language(name) == ("en" if "Ing" in name else "it")
    with pytest.raises(InputError, match="language 'Klingon' is unknown: expected one of en, it"):
        find_language("Klingon")


def test_dates_are_written_as_the_language_does():
    for given, english, italian in (
        ("2026-11-21", "November 21, 2026", "21 novembre 2026"),
        (" 2026-01-02 ", "January 2, 2026", "2 gennaio 2026"),
        *((same, same, same) for same in ("2026-02-30", "20261121", "spring 2026", "")),
    ):
        assert say_date(given) == english
        with speaking(load_catalogue("it")):
            assert say_date(given) == italian
