"""What became of the recommendations of the last report: done, open, no longer recommended, new."""

import json

import openpyxl
import pytest

from assess.cli.command_compare import describe_comparison
from assess.compare.changes import compare
from assess.compare.comparison_files import write_comparison
from assess.compare.past_run import read_run
from tests.compare.past import change, item, read_changed, write_run
from tests.workbooks import UNVERIFIED


@pytest.fixture(scope="module")
def before(tmp_path_factory):
    return write_run(tmp_path_factory.mktemp("status") / "before", UNVERIFIED)


def entry(*items, place=1, phase="A", detail="bracket"):
    works = [{"items": [*items], "detail": detail}]
    return {"place": place, "phase": phase, "floor": "1", "room": "Hall", "works": works}


def edit(*entries, held=(), gone=()):
    def apply(record):
        record["schedule"]["entries"] = [*entries]
        for name in held:
            item(record, name)["anchor"]["counts_as_anchored"] = True
        record["items"] = [one for one in record["items"] if one["item"] not in gone]

    return apply


def statuses(found):
    return [(one.status.value, one.items) for one in found.recommendations]


def test_an_entry_is_done_once_its_pieces_hold_or_are_gone_and_open_while_any_is_recommended(before, tmp_path):
    names = [one.item for one in read_run(before).pieces]
    first, second, third = names[:3]
    was = read_changed(before, tmp_path / "was", edit(entry(first, second), entry(third, place=2, phase="C")))

    def follow(name, *entries, **more):
        return statuses(compare(was, read_changed(before, tmp_path / name, edit(*entries, **more))))

    assert follow("done", held=[first, second]) == [("done", ())]
    assert follow("gone", held=[second], gone=[first]) == [("done", ())]
    assert follow("open", entry(second), held=[first]) == [("open", (second,))]
    assert follow("left", held=[first]) == [("no longer recommended", (second,))], "neither fixed nor recommended"
    assert follow("listed", entry(second, phase="C"), held=[first]) == [("no longer recommended", (second,))]
    both = entry(second), entry(third, place=2)
    assert follow("known", *both, held=[first]) == [("open", (second,)), ("open", (third,))], "it was listed"
    assert follow("new", *both, entry(names[3], place=3), held=[first])[-1] == ("new", (names[3],))


def test_the_counts_come_first_and_every_file_has_the_table(before, tmp_path):
    names = [one.item for one in read_run(before).pieces]
    was = read_changed(before, tmp_path / "was", edit(entry(names[0]), entry(names[1], place=2)))
    now = read_changed(before, tmp_path / "now", edit(entry(names[1]), entry(names[2], place=2), held=names[:1]))
    found = compare(was, now)
    said = "1 of 2 recommendations of the last report is done, 1 still open, 1 new."
    assert next(describe_comparison(found)) == said.replace(" is ", " are ")
    written = write_comparison(found, tmp_path / "out", ["html", "xlsx", "json"])
    page = written["html"].read_text(encoding="utf-8")
    assert page.index("1 of 2 recommendations") < page.index("What gets worse")
    record = json.loads(written["json"].read_text(encoding="utf-8"))
    assert [one["status"] for one in record["recommendations"]] == ["open", "new", "done"]
    rows = list(openpyxl.load_workbook(written["xlsx"])["Recommendations"].iter_rows(values_only=True))
    assert [row[:2] for row in rows[1:]] == [("still open", names[1]), ("new", names[2]), ("done", names[0])]


def test_earlier_results_have_no_phase_or_no_schedule(before, tmp_path):
    def older(record):
        edit({key: value for key, value in entry("A1").items() if key != "phase"})(record)

    assert [one.phase for one in read_changed(before, tmp_path / "old", older).entries] == [""]
    oldest = read_run(change(before, tmp_path / "oldest", lambda record: record.pop("schedule")))
    assert oldest.entries == ()
    assert statuses(compare(oldest, oldest)) == []
