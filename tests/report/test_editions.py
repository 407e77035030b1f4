"""The edition for the client and the annex: their pages, what each holds, and that no page is half empty."""

import re
from dataclasses import replace

import numpy as np
import pypdfium2
import pytest

import assess
from assess.report.content import Content
from assess.report.sections.methods import list_facts
from assess.report.sections.pieces import choose_groups, say_chances
from assess.report.view import View, list_all_parts
from tests.pictures import picture
from tests.report.reading import changed, read_text, render
from tests.shaking import write_records
from tests.workbooks import ITEMS, assessed

MOST_PAGES = 12
"""Pages of the client's edition, besides one for each floor plan."""
UNCITABLE = re.compile(r"general knowledge|at hand|https?://|www\.|\bshop", re.I)
EVERY = {
    "building": "Town hall", "address": "1 Long Street, Town", "use": "Office", "client": "Client", "storeys": 9,
    "height": 30, "period": 1.1, "prepared_by": "Ann", "checked_by": "Ben", "approved_by": "Cid", "revision": "2",
    "organisation": "Us & Co", "logo": "logo.png", "ground_pga": 0.3, "friction": 0.5, "restitution": 0.9,
    "motion_uncertainty": 0.3, "piece_uncertainty": "yes",
    "scenario": "The strongest earthquake that was recorded within a hundred kilometres, at the distance of the site. "
    * 2,
}  # fmt: skip


def _read(path):
    document = pypdfium2.PdfDocument(path)
    pages = [" ".join(page.get_textpage().get_text_range().split()) for page in document]
    toc = [(mark.level, mark.get_title(), mark.get_dest().get_index()) for mark in document.get_toc()]
    document.close()
    return pages, toc


def _fill(path):
    """Return for each page the lowest ink as a share of the height between its margins."""
    shares = []
    for page in pypdfium2.PdfDocument(path):
        ink = np.asarray(page.render(scale=0.5).to_pil().convert("L")) < 200
        is_wide = ink.shape[1] > ink.shape[0]
        top, height = (16, 179) if is_wide else (20, 259)  # of 210 and 297 mm: the margins of print.css
        scale = ink.shape[0] / (210 if is_wide else 297)
        rows = np.nonzero(ink[int(top * scale) : int((top + height) * scale)].any(axis=1))[0]
        shares.append(rows.max() / (height * scale) if len(rows) else 0.0)
    return shares


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("editions")
    (folder / "logo.png").write_bytes(picture("PNG", size=(40, 30)))
    items = [dict(ITEMS[0], item=f"A-{at:02d}", x=float(at), y=1.0) for at in range(1, 8)]
    return assessed(folder / "w.xlsx", [*items, *ITEMS[1:]], **EVERY)


@pytest.fixture(scope="module")
def written(results, tmp_path_factory):
    return assess.write_reports(results, tmp_path_factory.mktemp("out"), ("pdf", "annex", "json"))


@pytest.mark.slow
def test_every_section_is_shown_in_its_order_and_no_two_have_a_place(results):
    both = {key for edition in ("client", "annex") for key in _keys(edition)}
    assert {*_keys("all"), "pieces"} == both | {"about"}
    content = Content(results)
    for edition in ("client", "annex", "all"):
        places = [part.places[edition] for part in list_all_parts() if edition in part.places]
        assert len(set(places)) == len(places)
        view = View(content=content, edition=edition, for_print=edition != "all")
        page = render(results, for_print=edition != "all", edition=edition)
        found = [one for one in re.findall(r'<section id="([^"]+)"', page) if one in both | {"about"}]
        assert found == [part.key for part in view.parts]


def _keys(edition):
    return {part.key for part in list_all_parts() if edition in part.places}


@pytest.mark.slow
def test_the_client_reads_no_more_pages_than_a_client_reads(results, written):
    pages, toc = _read(written["pdf"])
    assert len(pages) <= MOST_PAGES + len(Content(results).shown_floors)
    parts = [title for level, title, _page in toc if level == 0]
    assert parts[0] == "Summary"
    assert parts[-3:] == ["How the chances were computed", "Limits of the methods", "Assumptions and defaults"]
    starts = {title: page for level, title, page in toc if level == 0}
    assert starts["Summary"] == 1, "the cover is one page"
    assert min(page for page in starts.values() if page > 1) == 2, "the summary is one page"
    for text in ("Contents", "Prepared by", "Checked by", "Approved by", "Annex, on request"):
        assert text in pages[0]


@pytest.mark.slow
def test_both_carry_workbook_and_results_and_are_known_when_they_change(results, written):
    for name in ("pdf", "annex"):
        document = pypdfium2.PdfDocument(written[name])
        names = [document.get_attachment(at).get_name() for at in range(document.count_attachments())]
        assert names == ["results.json", "w.xlsx"]
        assert document.is_tagged()
        document.close()
    written["annex"].write_bytes(written["annex"].read_bytes() + b"\n% mine\n")
    with pytest.raises(assess.InputError, match=r"changed after they were written, .*: annex\.pdf\. Move"):
        assess.write_reports(results, written["pdf"].parent, ("json",))
    assert written["pdf"].is_file()


# ---------------------------------------------------------------- one number and its source

GRADE = [
    {"floor": "G", "elevation": 0.0, "pfa_x": 0.135, "pfa_y": 0.12},
    {"floor": "1", "elevation": 4.0, "pfa_x": 0.2, "pfa_y": 0.2},
]
RECORDED = [{"floor": "1", "elevation": 4.0, "record_x": "slow.csv"}]
OF_ANCHORS, KNOWN = "used for the code's force on anchors only", "the motion at grade is known"


@pytest.mark.parametrize(
    ("floors", "building", "pga", "sds"),
    [
        (GRADE, {"sds": 0.4}, f"0.135 g on floor G, given PFA; 0.139 g of the workbook is not used: {KNOWN}",
         f"0.4 g, {OF_ANCHORS}: {KNOWN}"),
        (GRADE[1:], {"sds": 0.4}, "0.139 g", f"0.4 g, {OF_ANCHORS}: Ground PGA is given"),
        (RECORDED, {}, f"0.139 g, {OF_ANCHORS}: every floor has a record", None),
        (RECORDED, {"sds": 0.4}, "0.139 g in the workbook, not used: every floor has a record", None),
    ],
)  # fmt: skip
def test_a_ground_motion_that_is_not_used_says_what_is(tmp_path, floors, building, pga, sds):
    write_records(tmp_path, "slow")
    results = assessed(tmp_path / "w.xlsx", [dict(ITEMS[0], floor="1")], floors, ground_pga=0.139, **building)
    rows = list_facts(View(content=Content(results))).groups[0]
    said = {row.cells[0].words: row.cells[1] for row in rows}
    assert said["Ground PGA"] == pga
    assert sds is None or said["SDS"] == sds


# ---------------------------------------------------------------- alike pieces


def test_alike_pieces_are_one_row(results):
    listed = render(results, for_print=True, edition="client").partition('<section id="pieces">')[2]
    text = read_text(listed)
    assert "A-01 to A-07 (7)" in text
    assert "A-03" not in text


def test_a_group_shows_the_chances_of_all_its_rows(results):
    one = next(iter(results))
    other = changed(one, adopted=replace(one.adopted, probability=0.5, low=0.4, high=0.6))
    simulated = changed(one, adopted=replace(one.adopted, probability=0.2, low=0.1, high=0.3))
    assert say_chances([simulated, other]).replace("\xa0", " ") == "20.0 to 50.0 % (10.0 to 60.0 %)"
    assert say_chances([one, other]).count("(") == 0, "one of them has no interval"


def test_of_too_many_groups_the_worst_are_shown_in_their_order(results):
    groups = [[one] for one in results]
    (worst,) = choose_groups(groups, 1)
    assert worst[0].adopted.upper == max(one.adopted.upper for one in results)
    shown = choose_groups(groups, 3)
    assert shown == [group for group in groups if group in shown]


# ---------------------------------------------------------------- the worked example


@pytest.mark.slow
def test_the_worked_example_has_its_pages_and_none_is_half_empty(verified_example, samples_now):
    pages, toc = _read(samples_now["pdf"])
    plans = [
        page for page in Content(verified_example).shown_floors if any(one.item.x_m is not None for one in page.results)
    ]
    assert len(pages) <= MOST_PAGES + len(plans) == 16
    assert _count_pages(toc, len(pages))["Evacuation routes"] == 1
    assert [at for at, share in enumerate(_fill(samples_now["pdf"])[:-1], 1) if share < 0.5] == []
    assert sum(share < 0.5 for share in _fill(samples_now["annex"])[:-1]) <= 1, "where its pages turn"
    text = " ".join(pages)
    assert "0.135 g on floor G, recorded motion; 0.139 g of the workbook is used for the code's force" in pages[0]
    assert UNCITABLE.findall(text) == []


def _count_pages(toc, count):
    """Return on how many pages each part begins and goes on."""
    parts = [(title, page) for level, title, page in toc if level == 0]
    ends = [page for _title, page in parts[1:]] + [count]
    return {title: max(1, end - page) for (title, page), end in zip(parts, ends, strict=True)}
