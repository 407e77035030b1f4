"""Every number of every item in the PDF is that of results.json: read back, formatted anew, compared."""

import json
import re

import pypdfium2
import pytest

import assess
from assess.risk import classify
from assess.settings import Settings
from tests.shaking import write_records
from tests.workbooks import FLOORS, ITEMS, UNVERIFIED, assessed

pytestmark = pytest.mark.slow

VERIFIED = Settings(verify="all", runs=20)
SYMBOLS = {"low": "○ low", "medium": "◇ medium", "high": "▲ high", "very high": "■ very high"}


def read_pages(path):
    """Return the text of every page, with what the reader of a PDF does to spaces and hyphens undone."""
    document = pypdfium2.PdfDocument(path)
    texts = [page.get_textpage().get_text_range() for page in document]
    return [re.sub(r"\s+", " ", text.replace("\ufffe", "-").replace("\xa0", " ")) for text in texts]


def read_section(path, heading, following=""):
    """Return the text from the page of a heading of the outline to another text, or to the end."""
    (start,) = [
        mark.get_dest().get_index() for mark in pypdfium2.PdfDocument(path).get_toc() if mark.get_title() == heading
    ]
    text = " ".join(read_pages(path)[start:])
    return text[: text.index(following)] if following else text


def percent(value):
    """As many decimals as it takes to stay below the limit of a class."""
    if value is None:
        return "–"
    texts = [f"{100 * value:.{decimals}f}" for decimals in range(1, 7)]
    return next(text for text in texts if classify(float(text) / 100) == classify(value)) + " %"


def chance(adopted):
    if adopted["low"] is None:
        return percent(adopted["probability"])
    return f"{percent(adopted['probability'])} ({percent(adopted['low'])[:-2]} to {percent(adopted['high'])})"


def of_row(item):
    """Return what the table of all pieces shows of an item, in order."""
    methods = item["methods"]
    size = " × ".join(
        "–" if item[f"{side}_cm"] is None else f"{round(item[f'{side}_cm'], 1):g}"
        for side in ("breadth", "width", "height")
    )
    return [
        str(item["quantity"]), size, f"{item['breadth_to_height']:.3f}", item["axis"], f"{item['pfa_g']:.3f}",
        percent(methods["fema_p58"]["value"]),
        f"{percent(methods['proposed_or']['value'])} ({methods['proposed_or']['raw']:.3f})",
        percent(methods["kaneko_hayashi"]["value"]), chance(item["adopted"]),
    ]  # fmt: skip


def of_comparison(item):
    methods = item["methods"]
    pfv = item["pfv_cm_s"]
    return [f"{item['breadth_to_height']:.3f}", f"{item['pfa_g']:.3f}", "–" if pfv is None else f"{pfv:.1f}",
            percent(methods["fema_p58"]["value"]), percent(methods["proposed_or"]["value"]),
            percent(methods["kaneko_hayashi"]["value"]), percent(methods["housner_monte_carlo"]["value"])]  # fmt: skip


def assert_rows(text, items, cells):
    """Have every item's row, from its name to the next one's, hold its cells in order; return the items as shown."""
    starts = {text.index(f" {item['item']} {item['floor']} "): item for item in items}
    assert len(starts) == len(items)
    shown = sorted(starts)
    for start, end in zip(shown, [*shown[1:], shown[-1] + 600], strict=True):
        row, place = text[start:end], 0
        for cell in cells(starts[start]):
            found = row.find(cell, place)
            assert found >= 0, f"{starts[start]['item']}: {cell!r} is not in {row!r} behind {row[:place]!r}"
            place = found + len(cell)
    return [starts[start] for start in shown]


@pytest.fixture(scope="module", params=[pytest.param("formulas", marks=pytest.mark.long), "verified"])
def small(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("numbers")
    items = [dict(one, item=f"{one['item']}-{copy}") for copy in range(8) for one in ITEMS]
    settings = VERIFIED if request.param == "verified" else UNVERIFIED
    write_records(folder, "slow")
    floors = [{"floor": "1", "record_x": "slow.csv"}, FLOORS[1]]
    results = assessed(folder / "w.xlsx", items, floors, settings=settings)
    written = assess.write_reports(results, folder / "out", ("annex", "json"))
    return written["annex"], json.loads(written["json"].read_text(encoding="utf-8"))


PARTS = {"unconfirmed": "Unconfirmed: nothing is known of the building", "formula": "By formula only: not simulated"}
"""Headings of what stands apart in a run that simulated pieces."""


def basis_of(items):
    """Return the bases of items where they stand apart."""
    found = {item["adopted"]["basis"] for item in items}
    return found if "simulated" in found else set()


def test_the_table_of_all_pieces(small):
    path, results = small
    text = read_section(path, "All pieces", "Where the methods disagree by more than one class")
    shown = [
        ("simulated", *PARTS).index(one["adopted"]["basis"]) for one in assert_rows(text, results["items"], of_row)
    ]
    assert shown == sorted(shown) or not basis_of(results["items"])
    parts = [heading for basis, heading in PARTS.items() if basis in basis_of(results["items"])]
    assert [text.count(heading) for heading in parts] == [1] * len(parts)


def test_the_comparison_of_the_methods(small):
    path, results = small
    text = read_section(path, "Comparison of the methods")
    assert_rows(text[text.index("Results of every method for each row") :], results["items"], of_comparison)


def span(items, name):
    """Return how many pieces are of a class: by the intervals of their chances at least and at most."""
    order, sure, most = list(SYMBOLS), 0, 0
    for one in items:
        adopted = one["adopted"]
        ends = [order.index(adopted["class"])] * 2
        if adopted["low"] is not None:
            least = order.index("high") if "fell_in_record" in adopted["flags"] else 0
            ends = [max(int(classify(adopted["low"])), least), order.index(adopted["class_upper"])]
        sure += one["quantity"] * (set(ends) == {order.index(name)})
        most += one["quantity"] * (ends[0] <= order.index(name) <= ends[1])
    return str(sure) if sure == most else f"{sure}–{most}"


def test_the_counts(small):
    path, results = small
    text = next(page for page in read_pages(path) if "All floors" in page)
    free = [one for one in results["items"] if one["anchored"] != "yes"]
    anchored = sum(one["quantity"] for one in results["items"]) - sum(one["quantity"] for one in free)
    bases = basis_of(free)
    apart = [sum(one["quantity"] for one in free if one["adopted"]["basis"] == basis) for basis in PARTS if bases]
    free = [one for one in free if not bases or one["adopted"]["basis"] == "simulated"]
    by_class = {name: sum(one["quantity"] for one in free if one["adopted"]["class"] == name) for name in SYMBOLS}
    total = sum(by_class.values())
    shown = " ".join(f"{span(free, name)} ({100 * count / total:.0f} %)" for name, count in by_class.items())
    assert f"All floors {shown}" in text
    expected = sum(one["adopted"]["probability"] * one["quantity"] for one in free)
    shown = " ".join(str(count) for count in apart if count)
    falls = rf"{expected:.1f}( \([^)]*\))?" + (f" and up to {apart[0]}" if bases else "")
    assert re.search(rf"All floors .*{shown} {anchored} {total + sum(apart) + anchored} {falls}", text)


@pytest.mark.long
def test_a_long_list_in_the_appendix(tmp_path):
    items = [dict(one, item=f"{one['item']}-{copy}") for copy in range(40) for one in ITEMS]
    written = assess.write_reports(assessed(tmp_path / "w.xlsx", items, FLOORS), tmp_path / "out", ("annex", "json"))
    results = json.loads(written["json"].read_text(encoding="utf-8"))
    text = " ".join(read_pages(written["annex"]))
    at = (
        text.rindex("Appendix: all pieces Piece")
        if "Appendix: all pieces Piece" in text
        else text.rindex("One line for each row")
    )
    pieces, _, methods = text[at:].partition("Results of every method for each row under its governing motion")

    def compact(item):
        cells = of_row(item)
        return [*cells[:6], cells[6].split(" (")[0], *cells[7:]]

    assert_rows(pieces, results["items"], compact)
    assert_rows(methods, results["items"], of_comparison)
