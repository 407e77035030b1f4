import math

import pytest

import assess
from assess.errors import SettingsError
from assess.settings import SCENARIOS, Settings, change_settings, match_choice
from tests.refusals import check_refusals

WRONG = [
    ("scenario", "ASCE 7-10", "scenario is 'ASCE 7-10', expected one of: as filled, recorded, given, ASCE 7-22"),
    ("scenario", 7, "scenario is 7, expected one of: as filled"),
    ("verify", "maybe", "verify is 'maybe', expected one of: none, high, all"),
    ("verify", None, "verify is None, expected one of"),
    *(("runs", n, f"runs is {n!r}, expected 1 to 100,000, or auto") for n in (0, -1, 100_001, "x", None, True)),
    ("runs", 2.5, "runs is 2.5, expected 1 to 100,000, or auto"),
    ("runs", "9" * 5000, "runs is '999999999999999999999999999999999999999..., expected 1 to"),
    ("seed", -1, "seed is -1, expected a whole number, 0 or above"),
    ("seed", 1.0, "seed is 1.0, expected a whole number"),
    ("scale_motions", "yes", "scale_motions is 'yes', expected True or False"),
    *(("ideal", one, f"ideal is {one!r}, expected True or False") for one in (1, None)),
    *(("scale", one, f"scale is {one}, expected above 0 and at most 10") for one in (0, -0.5, 10.01, math.nan, True)),
    ("scale", "0.9", "scale is '0.9', expected above 0 and at most 10"),
    *(("zeta_velocity", zeta, "expected above 0, and finite") for zeta in (0.0, -1.0, math.nan, math.inf, "0.5")),
    ("zeta_acceleration", 0, "zeta_acceleration is 0, expected above 0, and finite"),
    ("slide_coefficient", 1.01, "slide_coefficient is 1.01, expected 0 to 1"),
    *(("ductility_reduction", one, "expected at least 1, and finite") for one in (0.99, 0.0, -2.0, math.nan, math.inf)),
    *(("route_risk", risk, "expected above 0 and below 1 (write 3 % as 0.03)") for risk in (0, 1, 3.0, math.nan)),
]


def test_a_value_that_cannot_be_used_is_named():
    assert issubclass(SettingsError, (assess.InputError, ValueError))
    for name, value, message in WRONG:
        with pytest.raises(SettingsError, match=f"^{name} is ") as caught:
            Settings(**{name: value})
        assert message in str(caught.value), (name, value)
        assert "--" not in str(caught.value)


def test_choices_are_matched_in_any_spelling():
    spellings = {
        "ASCE 7-22": "ASCE 7-22", "asce7-22": "ASCE 7-22", "ASCE 7\u201322": "ASCE 7-22", "en_1998_1": "EN 1998-1",
        "ntc2018": "NTC 2018", "As-Filled": "as filled", " RECORDED ": "recorded",
    }  # fmt: skip
    assert {text: match_choice(text, SCENARIOS) for text in spellings} == spellings
    assert {text: Settings(scenario=text).scenario for text in spellings} == spellings
    assert match_choice("ASCE 7-10", SCENARIOS) is match_choice("", SCENARIOS) is None


def test_settings_are_changed_by_keyword():
    assert change_settings(None, {}) == Settings()
    assert change_settings(Settings(seed=3), {"verify": "none"}) == Settings(seed=3, verify="none")
    check_refusals(SettingsError, lambda change: change_settings(None, change), [
        ({"verfy": "none"}, r"^verfy is an unknown setting\. Did you mean verify\?$"),
        ({"xyz": 1}, "xyz is an unknown setting; expected one of: scenario, class_by"),
        ({"runs": 0}, "runs is 0, expected"),
    ])  # fmt: skip


def test_the_package_offers_its_names_before_they_are_loaded():
    assert {"run", "Settings", "read_inventory", "write_reports"} <= set(dir(assess))
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        assess.nonsense  # noqa: B018
