"""Every output of 25 workbooks says what it said."""

import pytest

from tests.alike import list_differences
from tests.nets.lines import PDFS
from tests.nets.nets import NAMES, PRINTED, SHOWN, STORED, find_shown, read_stored, show

IN_SLOW = {
    ("everything", "pdf"), ("everything", "annex"), ("everything-it", "pdf"), ("doubted", "pdf"), ("city-1", "pdf"),
}  # fmt: skip
"""The PDFs that are held in the slow tests; the others in the long ones."""
pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")


def test_there_are_25_workbooks_and_nothing_is_kept_of_others():
    assert len(set(NAMES)) == len(NAMES) == 25
    assert {path.stem for path in STORED.iterdir()} == set(NAMES)
    assert {path.name.split(".")[0] for path in SHOWN.iterdir()} == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_outputs_say_what_they_said(name, tmp_path, differ):
    found = show(name, read_stored(name, tmp_path), tmp_path / "out")
    assert [line for kind, lines in found.items() for line in differ(f"{name}.{kind}", lines)] == []
    kept = {path.name for path in SHOWN.glob(f"{name}.*")} - {find_shown(name, kind).name for kind in PDFS}
    assert {find_shown(name, kind).name for kind in found} == kept


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        pytest.param(name, kind, marks=pytest.mark.slow if (name, kind) in IN_SLOW else pytest.mark.long)
        for name in PRINTED
        for kind in PDFS
    ],
)
def test_pdfs_say_what_they_said(name, kind, tmp_path, differ):
    found = show(name, read_stored(name, tmp_path), tmp_path / "out", (kind,))
    assert differ(f"{name}.{kind}", found[kind]) == []


def test_a_number_a_sentence_and_a_column_that_change_are_named(tmp_path):
    """The nets hold: what is changed on purpose turns red, and the difference shows the line before and after."""
    name = "one-piece"
    results = read_stored(name, tmp_path)
    text = "How sure this is"
    shown = show(name, results, tmp_path / "out")
    for kind, before, after in (
        ("html", text, "How certain this is"),
        ("json", "breadth_cm 30", "breadth_cm 31"),
        ("csv", "item,", ""),
    ):
        changed = [line.replace(before, after) for line in shown[kind]]
        difference = list_differences(changed, find_shown(name, kind).read_text(encoding="utf-8").splitlines())
        assert any(line.startswith("-") and before in line for line in difference), kind
        assert any(line.startswith("+") and before not in line for line in difference), kind
