"""Workbooks in Italian: written, read, mixed with English, and wrong."""

import subprocess
import sys
from collections.abc import Iterable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

from assess.cli.command_new import write_new_workbook
from assess.i18n import LANGUAGES, gettext, load_catalogue, speaking
from assess.model import Inventory
from assess.workbook.names import plain, translate, translate_choices, translate_header
from assess.workbook.read import read_inventory
from assess.workbook.schema import LISTS, LIVE, SHEETS, WORKINGS
from assess.workbook.template import describe
from tests.motion.writers import zipped
from tests.workbook.books import Sheet as Rows, errors_of, problems_of, remarks, write_book

ITALIAN = [translate(sheet, "it") for sheet in SHEETS]
NAMES = [sheet.name for sheet in SHEETS]
COLUMNS = [column for sheet in SHEETS for column in sheet.columns]

FLOORS: Rows = [["Piano", "PFA X [g]"], ["1", 0.5]]
ITEMS: Rows = [["Elemento", "Piano", "Profondità [cm]", "Altezza [cm]"], ["A1", "1", 40, 180]]


def write(folder: Path, items: Rows = ITEMS, floors: Rows = FLOORS, **others: Rows) -> Path:
    return write_book(folder / "cartella.xlsx", {"Arredi": items, "Piani": floors, **others})


def read(folder: Path, items: Rows = ITEMS, floors: Rows = FLOORS, **others: Rows) -> Inventory:
    return read_inventory(write(folder, items, floors, **others))


def example(folder: Path, language: str) -> Path:
    path = folder / f"{language}.xlsx"
    write_new_workbook(path, "si", language=language, example=True)
    return path


def test_labels_can_be_told_apart_and_fit_the_spreadsheet() -> None:
    with speaking(load_catalogue("it")):
        for sheet, italian in zip(SHEETS, ITALIAN, strict=True):
            english, labels = ([plain(one.label) for one in said.columns] for said in (sheet, italian))
            assert len(set(english)) == len(set(labels)) == len(labels)
            for at, label in enumerate(labels):
                assert label not in english or english.index(label) == at, label
            for column in sheet.columns:
                assert len(gettext(column.label)) <= 32
                assert len(describe(column)) <= 255
                words = translate_choices(column.choices, "it")
                assert len({plain(word) for word in words}) == len(words)
        names = [*(sheet.name for sheet in ITALIAN), gettext("Help"), gettext(LISTS)]
        live = {plain(translate_header(label).split(" [")[0]) for label in (*LIVE, *WORKINGS)}
    assert all(name.isascii() and name.isalpha() for name in names), "formulas need not quote them"
    assert len({plain(name) for name in (*names, *NAMES, "Help", LISTS)}) == 2 * len(names)
    items = next(sheet for sheet in ITALIAN if sheet.name == "Arredi")
    assert len(live) == len(LIVE) + len(WORKINGS)
    assert not live & {plain(column.label) for column in items.columns}


@pytest.mark.slow
def test_the_example_says_the_same_in_both_languages_and_in_english_loads_no_catalogue(tmp_path: Path) -> None:
    paths = [example(tmp_path, language) for language in LANGUAGES]
    english, italian = map(read_inventory, paths)
    assert (english.language, italian.language) == ("en", "it")
    find = load_catalogue("it").find
    types = {one.type: one for one in italian.catalogue}
    assert len(types) == len(english.catalogue)
    pairs: dict[str, Iterable[Any]] = {
        name: zip(getattr(english, name.lower()), getattr(italian, name.lower()), strict=True)
        for name in ("Floors", "Items", "Places", "Routes")
    }
    # Types stand in the alphabetical order of each language.
    pairs["Catalogue"] = ((replace(one, row=0), replace(types[find(one.type)], row=0)) for one in english.catalogue)
    texts = {column.name for column in COLUMNS if column.kind == "text"}
    for one, other in (pair for own in pairs.values() for pair in own):
        for name in (field.name for field in fields(one) if field.name not in texts):
            assert getattr(one, name) == getattr(other, name), (one, name)
    assert italian.items[0].description == "Vetrina accanto alla via di uscita"
    code = (
        f"import sys, assess\nassess.read_inventory({str(paths[0])!r})\n"
        "print([name for name in sys.modules if name.startswith('babel')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300, check=False)
    assert (done.stdout.strip(), done.stderr) == ("[]", "")


def test_the_language_is_that_of_most_sheets_and_the_report_may_have_another(tmp_path: Path) -> None:
    items: Rows = [
        ["Item", "Piano", "Breadth [cm]", "Altezza [cm]", "Ancorato", "Anything"],
        ["A1", "1", 40, 180, "yes", 1],
    ]
    sheets = {"Items": items, "Piani": [["Floor", "PFA X [g]"], ["1", 0.5]], "Luoghi": [["Place", "Piano"], ["P", "1"]]}
    inventory = read_inventory(write_book(tmp_path / "mixed.xlsx", sheets))
    assert (inventory.items[0].breadth, inventory.items[0].anchored) == (0.4, "yes")
    assert inventory.places[0].place == "P"
    assert inventory.language == "it", "two sheets of three"
    assert remarks(inventory, "note") == {"Items!F1: the column 'Anything' is not known; it is kept, not used."}
    # The names of the sheets decide, not those of the columns.
    for names, language in ((("Items", "Piani"), "en"), (("Arredi", "Floors"), "en"), (("Arredi", "Piani"), "it")):
        book = write_book(tmp_path / "book.xlsx", dict(zip(names, (ITEMS, FLOORS), strict=True)))
        assert read_inventory(book).language == language
    for typed, chosen, code in (
        ("italian", "Italiano", "it"), ("IT", "Italiano", "it"), ("English", "English", "en"),
        ("inglese", "English", "en"), (None, "", "it"),
    ):  # fmt: skip
        inventory = read(tmp_path, Edificio=[["Edificio", "Municipio"], ["Lingua del rapporto", typed]])
        assert (inventory.building.language, inventory.report_language) == (chosen, code)


def test_errors_name_the_workbooks_own_sheets_cells_and_labels(tmp_path: Path) -> None:
    items: Rows = [
        ["Elemento", "Piano", "Profondità [cm]", "Altezza [cm]", "Ancorato", "Angolo [rad]", "Percorso", "Larghezza [cm]",
         "Quantità", "X [m]", "Y [m]", "Tratto"],
        ["A1", "1", 40, 1.8, "forse"],
        ["A1", "9", "largo", 180, "sii", None, "R"],
        ["A3", "1", 90, 180, None, None, None, 40, 2, 1, 1, "T"],
        ["A4", "1", 40],
    ]  # fmt: skip
    found = errors_of(
        write(tmp_path, items, Percorsi=[["Percorso", "Tratto"]], Edificio=[["Tipo di scenario", "registrata"]])
    )
    assert found == {
        "Arredi!D2: Altezza is 1.8 cm, expected 5 to 600 cm. Did you mean 1.8 m = 180 cm?",
        "Arredi!E2: Ancorato is 'forse', expected one of: no, sì, in parte, non noto. Choose from the list.",
        "Arredi!E3: Ancorato is 'sii', expected one of: no, sì, in parte, non noto. Did you mean sì?",
        "Arredi!A3: duplicate Elemento 'A1', also in A2. Give each its own name.",
        "Arredi!B3: Piano '9' is not in the Piani sheet. Choose one of the Piani sheet, or add it there.",
        "Arredi!C3: Profondità is the text 'largo', expected a number [cm]. Type the number alone.",
        "Arredi!F1: the unit 'rad' of Angolo is not known. Write the unit that the numbers are in, such as Angolo [deg]; "
        "known units: deg.",
        "Arredi!G3: Percorso 'R' is not in the Percorsi sheet. Choose one of the Percorsi sheet, or add it there.",
        "Arredi!C4: Profondità 90 cm is greater than Larghezza 40 cm. Profondità is the shorter plan side: exchange the two.",
        "Arredi!I4: Quantità is 2 on a row with a position. Write one row a piece, or clear X and Y.",
        "Arredi!L4: a Tratto is named without its Percorso. Fill in Percorso.",
        "Arredi!D5: Altezza is blank and no Tipo gives it. Fill it in, or choose a Tipo that has one.",
        "Edificio!B1: Tipo di scenario is 'registrata', expected one of: come compilato, registrato, assegnato, ASCE 7-22, "
        "ASCE 7-16, EN 1998-1, NTC 2018. Did you mean registrato?",
    }


SAMPLE = Path(__file__).parents[2] / "samples" / "records" / "1103.HN2.NP.RE_v.smc"

FAULTY_RECORDS = {
    "passo.csv": (
        b"time [s],NS [g]\n" + b"".join(b"%d,%d\n" % (at, at % 2) for at in range(20)),
        "canale 'NS': l'intervallo di campionamento è 1 s, atteso da 1e-05 a 0,1 s: il tempo è in secondi?",
    ),
    "cella.csv": (b"time [s],NS [g]\n0,0.5\n0.01,abc\n", "riga 3: 'abc' non è un numero"),
    "velocità.smc": (
        SAMPLE.read_bytes(),
        "il file contiene velocità (3 VELOCITY), non accelerazioni. Fornire il file delle accelerazioni dello stesso "
        "canale (tipo 1 o 2)",
    ),
    "serie.zip": (
        zipped({"LEGGIMI.txt": b"testo", "v.smc": SAMPLE.read_bytes()}, 0),
        "nell'archivio zip nulla può essere letto come registrazione: LEGGIMI.txt: formato di file non supportato; "
        "v.smc: il file contiene velocità (3 VELOCITY), non accelerazioni. Fornire il file delle accelerazioni dello "
        "stesso canale (tipo 1 o 2)",
    ),
}
"""Bytes of records that cannot be read, and why not, in Italian."""


def test_what_is_wrong_with_a_record_is_said_in_italian_and_did_you_mean_in_both_languages(tmp_path: Path) -> None:
    for name, (data, why) in FAULTY_RECORDS.items():
        (tmp_path / name).write_bytes(data)
        (problem,) = problems_of(write(tmp_path, floors=[["Piano", "Registrazione X"], ["1", name]]))
        assert problem.place == "Piani!B2"
        assert problem.message.startswith(f"the record cannot be read: {name}: ")
        with speaking(load_catalogue("it")):
            assert gettext(problem.message) == f"la registrazione non può essere letta: {name}: {why}."
    # And headers that are no slip.
    slips = {
        "Profondta [cm]": "Profondità [cm]", "Quantitta": "Quantità", "Altezza (cm)": "Altezza [cm]",
        "Descripion": "Descrizione", "Anchoredd": "Anchored",
    }  # fmt: skip
    own = ["Massa [kg]", "Colore", "Proprietario", "Anno", "Z [m]", "Marca"]
    items = [[*ITEMS[0][:2], "Tipo", *slips, *own], ["A1", "1", "T"]]
    types: Rows = [["Tipo", "Profondità [cm]", "Altezza [cm]"], ["T", 40, 180]]
    assert errors_of(write(tmp_path, items, Catalogo=types)) == {
        f"Arredi!{letter}1: the column '{header}' is not known. Did you mean {meant}?"
        for letter, (header, meant) in zip("DEFGH", slips.items(), strict=True)
    }
    assert read(tmp_path, [[*ITEMS[0], *own], [*ITEMS[1], 80]]).extra_columns == tuple(own)
    english: Rows = [["Item", "Floor", "Breadth [cm]", "Height [cm]", "Ancoratto"], ["A1", "1", 40, 180, "no"]]
    path = write_book(tmp_path / "book.xlsx", {"Items": english, "Floors": FLOORS})
    assert errors_of(path) == {"Items!E1: the column 'Ancoratto' is not known. Did you mean Ancorato?"}
