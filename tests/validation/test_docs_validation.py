"""docs/validation.md is what the code gives."""

from pathlib import Path

import pytest

from assess.studies import Options, all_studies
from assess.studies._buildings import all_buildings
from assess.studies._formulas import FORMULAS
from assess.studies._run import run_all
from assess.studies._table2_print import describe_print
from assess.studies._write import build_page, describe
from assess.version import __version__

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "validation.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["table1", "table3"])
def test_quick_studies_stand_on_the_page_as_they_are(name, tmp_path):
    study = next(one for one in all_studies() if one.name == name)
    finding = study.run(Options(out=tmp_path))
    assert "\n".join(describe(study, finding, "figures/")) in PAGE
    for sentence in (*finding.summary, *finding.failures):
        assert sentence in PAGE
    for figure, data in finding.figures.items():
        assert (DOCS / "figures" / figure).read_bytes() == data


def test_the_page_has_every_study_and_its_figures():
    for study in all_studies():
        assert f"\n## {study.title}\n" in PAGE
        assert f"`assess study {study.name}`" in PAGE
    links = [line.partition("](")[2].rstrip(")") for line in PAGE.splitlines() if line.startswith("![")]
    assert len(links) >= len(all_studies())
    for link in links:
        assert (DOCS / link).is_file()


def test_the_page_says_with_what_it_was_made():
    assert f"`assess study all --runs {Options(out=DOCS).runs} --seed {Options(out=DOCS).seed}`" in PAGE
    assert f"(assess {__version__})" in PAGE


def test_every_building_and_formula_has_a_row():
    for building in all_buildings():
        for title in FORMULAS.values():
            assert PAGE.count(f"\n| {building.name} | {title} | ") == 1


def test_the_print_of_the_paper_stands_on_the_page():
    assert "\n".join(describe_print()) in PAGE


@pytest.mark.slow
def test_the_whole_page_and_every_figure_come_out_again(tmp_path):
    options = Options(out=tmp_path, jobs=2)
    findings = run_all(all_studies(), options)
    assert build_page(all_studies(), findings, options, "figures/") == PAGE
    for finding in findings.values():
        for figure, data in finding.figures.items():
            assert (DOCS / "figures" / figure).read_bytes() == data
