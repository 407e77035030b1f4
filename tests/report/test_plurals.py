"""One of everything is called one: no "1 rows" in a report, a table, a message or on the terminal."""

import re

from tests.cli.calling import run
from tests.nets.nets import SHOWN
from tests.report.routed import FLOORS, ITEMS, PLACES, ROUTES, write_routed

NOUNS = (
    "anchors|axes|cases|cautions|cells|channels|characters|checks|columns|corners|curves|draws|errors|exits|falls|files|"
    "floors|forms|impacts|items|lines|motions|notes|occupants|pages|people|pieces|places|points|problems|records|rooms|"
    "rows|runs|samples|segments|sheets|stairs|steps|storeys|types|values|warnings"
)
SINGULAR = "|".join(("of", "is", *(noun.removesuffix("s") for noun in NOUNS.split("|"))))
ONE = re.compile(rf"(?<![\d.,:/-])\b1 (?:(?!(?:{SINGULAR})\b)[a-z-]+ ){{0,2}}(?:{NOUNS}|routes)\b")
VERB = re.compile(r"(?<![\d.,:/-])\b1 (?:more |of \d+ )?(?:are|were|have|do|stand|fall|overturn)\b")

TALL, HELD, FLOOR = ITEMS[0], ITEMS[2] | {"floor": "1"}, FLOORS[0]
ONLY = {
    "Floors": [FLOOR],
    "Items": [TALL],
    "Places": [PLACES[0], {"place": "Street", "floor": "1", "x": 10.0, "y": 0.0, "kind": "exit"}],
    "Routes": [ROUTES[0] | {"end": "Street", "route": "Yard", "segment": "lane", "room": "Office"}],
}  # fmt: skip


def find_wrong(text):
    text = re.sub("from 0.25 to 1 (weak|the) motions", "", text)  # a range, and what follows it
    return [
        text[max(0, found.start() - 40) : found.end() + 10] for rule in (ONE, VERB) for found in rule.finditer(text)
    ]


def test_outputs_that_are_held_and_the_terminal_count_one_as_one(tmp_path, monkeypatch):
    english = [path for path in SHOWN.iterdir() if not re.search("-it|italiano|ospedale", path.name)]
    assert len(english) > 100
    for path in english:
        assert find_wrong(path.read_text(encoding="utf-8")) == [], path.name
    monkeypatch.chdir(tmp_path)
    path = write_routed(tmp_path / "w.xlsx", **ONLY)
    for command, *words in (
        ("check",),
        ("run", "--verify", "none", "--formats", "json"),
        ("run", "--runs", "1", "--formats", "json"),
        ("routes", "--pfa", "0.3:0.3", "--runs", "1"),
        ("fragility", "--levels", "0.3:0.3", "--runs", "1", "--formats", "csv"),
        ("fragility", "--by", "type", "--runs", "2", "--json"),
    ):
        done = run(command, path, *words)
        assert done.exit_code in (0, 1), done.output
        assert find_wrong(done.stdout) == find_wrong(done.stderr) == []
