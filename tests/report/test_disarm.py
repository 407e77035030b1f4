"""No part of a text of a CSV file is a formula, whatever the program that opens it takes as separator."""

import csv
import io
import re

import pytest
from hypothesis import given, strategies as st

from assess.report.data import disarm, write_csv
from tests.cli.calling import run
from tests.workbooks import assessed, write

SIGNS = "=+-@＝＋－＠"


def test_a_sign_that_begins_a_part_gets_an_apostrophe_however_long_the_text() -> None:
    for text, disarmed in (
        ("=1+1", "'=1+1"), ("＝1+1", "'＝1+1"), ("－2", "'－2"), (" @SUM(A1)", " '@SUM(A1)"), ("\t=1", "\t'=1"),
        ("cabinet;=cmd|'/C calc'!A0", "cabinet;'=cmd|'/C calc'!A0"), ("a|+1", "a|'+1"), ("a\n=1", "a\n'=1"),
        ('x";"=1', "x\";\"'=1"), ('"=1"', "\"'=1\""), ("a, -b", "a, '-b"), ("'=1", "''=1"), ("; ; =1", "; ; '=1"),
        ("a =1", "a =1"), ("low-rise - B+C", "low-rise - B+C"), ("me@home", "me@home"), ("don't-", "don't-"), ("", ""),
        ("-", "'-"), (-0.5, -0.5), (True, True), (None, None), (["-1", "B"], "'-1; B"), (["B", "-1"], "B; '-1"),
    ):  # fmt: skip
        assert disarm(text) == disarmed, (text, disarmed)
    for run_of in (" ", "'", '"', ";", "=", "a"):
        assert disarm(run_of * 200_000 + "x") is not None


def undo(text: str) -> str:
    """What docs/commands.md says restores a text."""
    places = re.finditer(rf"(?:^|[;,|\t\r\n\"])[\s\"';,|]*?(?='[{re.escape(SIGNS)}])", text)
    gone = {found.end() for found in places}
    return "".join(sign for at, sign in enumerate(text) if at not in gone)


TEXTS = st.text(st.sampled_from([*SIGNS, *";,|\t\r\n\"' ab\u00a0\u3000"]), max_size=14)


@given(TEXTS)
def test_it_can_be_undone(text: str) -> None:
    assert undo(str(disarm(text))) == text


@given(st.lists(TEXTS, min_size=1, max_size=3), st.sampled_from(";,|\t"), st.booleans())
def test_no_cell_is_a_formula(texts: list[str], separator: str, knows_quotes: bool) -> None:
    file = io.StringIO(newline="")
    csv.writer(file).writerow(["a", *map(disarm, texts)])
    if knows_quotes:
        cells = [
            one for row in csv.reader(io.StringIO(file.getvalue(), newline=""), delimiter=separator) for one in row
        ]
    else:
        cells = re.split(rf"[\r\n{separator}]", file.getvalue())
    assert [one for one in cells if one.strip().strip('"').strip()[:1] in tuple(SIGNS)] == []


def test_items_csv(tmp_path) -> None:
    items = [{"item": "A1", "floor": "1", "description": "cabinet;=cmd|'/C calc'!A0", "breadth": 30, "height": 200,
              "edge_distance": -0.4, "notes": "＝1+1"}]  # fmt: skip
    write_csv(assessed(tmp_path / "w.xlsx", items), tmp_path / "items.csv")
    lines = (tmp_path / "items.csv").read_text(encoding="utf-8-sig").splitlines()
    assert [cell for line in lines for cell in line.split(";") if cell[:1] in SIGNS] == []
    (row,) = csv.DictReader(lines)
    assert (row["description"], row["notes"]) == ("cabinet;'=cmd|'/C calc'!A0", "'＝1+1")
    assert row["edge_distance_m"] == "-0.4"


@pytest.mark.slow
def test_curves_of_fragility(tmp_path) -> None:
    items = [{"item": "a;=1", "floor": "1", "breadth": 30, "height": 200}]
    path = write(tmp_path / "w.xlsx", items)
    done = run("fragility", path, "--runs", 20, "--formats", "csv", "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    texts = [one.read_text(encoding="utf-8-sig") for one in (tmp_path / "out").rglob("*.csv")]
    assert any("a;'=1" in text for text in texts)
    assert not any(";=1" in text for text in texts)
