"""Pages of studies: how templates become lines of Markdown, and that no value is left out in silence."""

import math

import pytest
from jinja2 import UndefinedError

from assess.resources import templates
from assess.studies import all_studies, study


def test_paragraphs_and_items_are_joined_and_rows_are_not():
    text = "\n\nOne\n  and two.\n\n\n* an item\n  goes on\n* another\n\n| a |\n|---|\n| b |\n\n"
    lines = ["One and two.", "", "* an item goes on", "* another", "", "| a |", "|---|", "| b |"]
    assert study._join_lines(text) == lines
    assert study._join_lines("\n".join(lines)) == lines
    assert study._join_lines(" \n\n") == []


def test_every_study_has_a_template_with_its_summary_and_a_value_that_is_missing_is_an_error():
    with pytest.raises(UndefinedError, match="'missing' is undefined"):
        study.render_block("solver", "missing", side=0.16)
    for one in all_studies():
        text = (templates() / "studies" / f"{one.name}.md.j2").read_text(encoding="utf-8")
        assert "{% block page %}" in text
        assert "{% block summary %}" in text


def test_a_span_of_equal_numbers_is_one_number_and_an_unknown_share_a_dash():
    for values, shown in (([1.004, 1.0], "1.00"), ([0.5, 2.25, 1.0], "0.50 to 2.25"), ([-0.1], "-0.10")):
        assert study._span(values, 2) == shown
    assert (study.percent(math.nan), study.percent(0.255)) == ("-", "26 %")
    assert (study._points(math.nan), study._points(0.255, "+")) == ("-", "+25.5")
