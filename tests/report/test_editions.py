"""The edition for the client and the annex: their pages, what each holds, and that no page is half empty."""

import re

import numpy as np
import pypdfium2
import pytest

from assess.report.content import Content
from assess.report.view import View, list_all_parts
from tests.pictures import picture
from tests.report.reading import render
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


@pytest.mark.slow
def test_every_section_is_shown_in_its_order_and_no_two_have_a_place(results):
    both = {key for edition in ("client", "annex") for key in _keys(edition)}
    assert {*_keys("all")} == both | {"about"}
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


@pytest.mark.long
def test_the_worked_example_has_its_pages_and_none_is_half_empty(verified_example, samples_now):
    document = pypdfium2.PdfDocument(samples_now["pdf"])
    pages = [" ".join(page.get_textpage().get_text_range().split()) for page in document]
    toc = [(mark.get_title(), mark.get_dest().get_index()) for mark in document.get_toc() if mark.level == 0]
    document.close()
    plans = [
        page for page in Content(verified_example).shown_floors if any(one.item.x_m is not None for one in page.results)
    ]
    assert len(pages) <= MOST_PAGES + len(plans) == 16
    ends = [page for _title, page in toc[1:]] + [len(pages)]
    lengths = {title: max(1, end - page) for (title, page), end in zip(toc, ends, strict=True)}
    assert lengths["Evacuation routes"] == 1, "pages on which it begins and goes on"
    assert [at for at, share in enumerate(_fill(samples_now["pdf"])[:-1], 1) if share < 0.5] == []
    assert sum(share < 0.5 for share in _fill(samples_now["annex"])[:-1]) <= 1, "where its pages turn"
    text = " ".join(pages)
    assert pages[0].count("Signature") == 1, "who answers for it stands on page one"
    assert UNCITABLE.findall(text) == []
