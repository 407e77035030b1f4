"""docs/validation.md is what the code gives: its words, and its numbers within their sampling error."""

import re
from pathlib import Path

import pytest

from assess.studies import Options, all_studies, build_page, describe, run_all
from assess.studies.agreement import FORMULAS
from assess.studies.buildings import all_buildings
from assess.studies.study import render_block
from assess.studies.table2 import collect_published
from assess.version import __version__
from docs.machine import START
from docs.validation import split_page
from tests.alike import differences

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "validation.md").read_text(encoding="utf-8")


def figure_texts(svg: bytes) -> list[str]:
    """Return the texts drawn in a figure; how its curves are written depends on the version of matplotlib."""
    return re.findall(r"<!-- (.*) -->", svg.decode("utf-8"))


def compare_figures(findings) -> None:
    for finding in findings:
        for name, data in finding.figures.items():
            texts = figure_texts(data)
            assert texts
            assert differences(texts, figure_texts((DOCS / "figures" / name).read_bytes())) == [], "run: make docs"


@pytest.mark.parametrize("name", ["table1", "table3"])
@pytest.mark.slow
def test_quick_studies_are_on_the_page(name, tmp_path):
    """These two integrate nothing: their rounded numbers are the same on every processor."""
    study = next(one for one in all_studies() if one.name == name)
    finding = study.run(Options(out=tmp_path))
    assert "\n".join(describe(study, finding, "figures/")) in PAGE
    for sentence in (*finding.summary, *finding.failures):
        assert sentence in PAGE
    compare_figures([finding])


def test_the_page_has_every_study_and_its_figures():
    for study in all_studies():
        assert f"\n## {study.title}\n" in PAGE
        assert f"`assess study {study.name}`" in PAGE
    links = [line.partition("](")[2].rstrip(")") for line in PAGE.splitlines() if line.startswith("![")]
    assert len(links) >= len(all_studies())
    for link in links:
        assert (DOCS / link).is_file()


def test_the_page_says_with_what_it_was_made():
    made = Options(out=DOCS)
    assert f"`assess study all` with {made.runs} motions per channel and seed {made.seed}" in PAGE
    assert f"(assess {__version__})" in PAGE
    for page in ("validation.md", "motions.md", "rocking.md"):
        *_, last = (DOCS / page).read_text(encoding="utf-8").splitlines()
        assert last.startswith(START), f"{page}: the machine it was made on, run: make docs"
        assert "processor " in last


def test_every_building_and_formula_has_a_row():
    for building in all_buildings():
        for title in FORMULAS.values():
            assert PAGE.count(f"\n| {building.name} | {title} | ") == 1


def test_the_print_of_the_paper_stands_on_the_page():
    assert "\n".join(render_block("table2", "published", **collect_published())) in PAGE


@pytest.mark.long
def test_the_whole_page_comes_out_again(tmp_path):
    options = Options(out=tmp_path, jobs=2)
    findings = run_all(all_studies(), options)
    page = build_page(all_studies(), findings, options, "figures/")
    kept, _ = split_page(PAGE[: PAGE.index(f"\n{START}")])
    assert differences(page.splitlines(), kept.splitlines()) == [], "run: make docs"
    compare_figures(findings.values())
