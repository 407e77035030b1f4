"""Whatever a report says can be said in another language, to its last word.

The language here has an x for every letter, in brackets: a word that still can be read did not go through a catalogue.
"""

import re
import shutil

import openpyxl
import pytest

import assess
from assess.demand import Demand
from assess.inventory.blank import Content, write_workbook
from assess.language import Catalogue, gettext, speaking
from assess.motion.formats import read_records
from assess.motion.scenario import PROFILES
from assess.motion.suite import read_suite
from assess.report import words
from assess.report.findings import motions, trials
from assess.report.findings.cautions import list_cautions, list_short_cautions
from assess.report.findings.verified import build_verified, describe_verification, list_summary
from docs.texts import collect
from tests.report.test_verified import _assess
from tests.workbooks import RECORDS, write

SMC = "0165a_u.smc"
PNG = b"\x89PNG\r\n\x1a\n"
BUILDING = {"ground_pga": 0.3, "sds": 0.9, "height": 40, "storeys": 4, "period": 9, "azimuth_deg": 45}
FLOORS = [
    {"floor": "1", "elevation": 0, "record_x": SMC, "pfa_x": 0.9, "pfv_x": 900, "plan": "p.png"},
    {"floor": "2", "elevation": 2},
    {"floor": "3", "elevation": 4, "pfa_x": 2.5, "pfa_y": 0.2, "pfv_y": 45.0},
    {"floor": "4", "elevation": 12},
    {"floor": "5", "elevation": 99},
]
ITEMS = [
    {"item": "1", "floor": "1", "breadth": 90, "width": 90, "height": 60, "description": "\u202e1"},
    {"item": "2", "floor": "2", "breadth": 30, "height": 290, "axis": "Y", "angle_deg": 0},
    {"item": "3", "floor": "3", "breadth": 30, "height": 200, "x": 1},
    {"item": "4", "floor": "5", "breadth": 30, "height": 200},
]
SLENDER_AND_STOCKY = [
    {"item": "1", "floor": "1", "breadth": 30, "height": 200},
    {"item": "2", "floor": "2", "breadth": 90, "height": 60},
]
ROUTES = [{"route": "1", "segment": "1", "floor": "1"}]
DATA = {"SMC", "smc", "csv", "ASCE", "PFA", "PFV", "SDS"}
"""What is no word of ours: of names of files, codes and quantities."""


@pytest.fixture(scope="module")
def spoken():
    """Return a language that has every text, each letter of it an x."""
    texts = {}
    for message in collect():
        ids = message.id if isinstance(message.id, tuple) else (message.id,)
        if ids[0]:
            texts[ids[0]] = tuple(f"⟦{_cross_out(one)}⟧" for one in ids)
    return Catalogue("xx", texts)


def _cross_out(text):
    """Turn letters into x, but not those of ``{names}``."""
    return re.sub(r"(\{[^}]*\})|[^\W\d_]", lambda found: found[1] or "x", text)


def _left(text, *names):
    """Return the words that still can be read."""
    return set(re.findall(r"[^\W\d_]{3,}", re.sub("x+", " ", text))) - DATA - set(names)


def _write(folder, **last):
    shutil.copy(RECORDS / SMC, folder / SMC)
    (folder / "p.png").write_bytes(PNG)
    path = folder / "w.xlsx"
    rows = {"Building": [BUILDING], "Floors": [*FLOORS[:-1], FLOORS[-1] | last], "Items": ITEMS, "Routes": ROUTES}
    write_workbook(path, Content(rows=rows))
    book = openpyxl.load_workbook(path)
    book["Items"].cell(1, 40, "99")
    book["Items"].cell(90, 40, "stray")
    book["Building"].cell(60, 1, "99")
    book["Building"].cell(60, 2, "known to nobody")
    book.save(path)
    return path


@pytest.fixture(scope="module", params=["as filled", "given", "ASCE 7-22"])
def odd(request, tmp_path_factory):
    """Return the assessment of a workbook that gives rise to much that is remarked."""
    last = {"pfa_x": 0.1} if request.param == "given" else {}
    inventory = assess.read_inventory(_write(tmp_path_factory.mktemp("odd"), **last))
    return assess.run(inventory, assess.Settings(scenario=request.param, verify="none"))


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_every_warning_and_note_is_said(odd, spoken):
    assert len(odd.problems) >= 10
    for problem in odd.problems:
        for text in filter(None, (problem.message, problem.mend)):
            with speaking(spoken):
                said = gettext(text)
            assert said.startswith("⟦"), text
            assert said.endswith("⟧"), text
            assert not _left(said), text


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_what_shakes_the_floors_is_said(odd, spoken):
    demands = [demand for ones in odd.demands.values() for demand in ones]
    with speaking(spoken):
        for demand in demands:
            assert motions.describe_source(demand).startswith("⟦")
            assert not _left(motions.describe_source(demand))
            assert not _left(motions.describe_origin(demand), *_names(demand))
            assert not _left(motions.describe_treatment(demand))
        for text in (*motions.list_sources(odd.demands), *list_cautions(odd), *list_short_cautions(odd)):
            assert text.startswith("⟦")
            assert not _left(text), text
        for line in motions.list_assumptions(odd):
            assert not _left(" ".join(line)), line
        for profile in PROFILES.values():
            assert not _left(motions.profile_status(profile))


def _names(demand: Demand):
    record = demand.record
    return re.findall(r"[^\W\d_]+", f"{record.station} {demand.name}") if record else ()


def test_what_reading_changed_of_a_record_is_said(spoken, tmp_path):
    lines = ["# maker: 1", "time [s], 1 [g]", *(f"{0.01 * at + 0.3 * (at > 200):g}, {at % 7}" for at in range(400))]
    (tmp_path / "r.csv").write_text("\n".join([*lines[:50], lines[48], *lines[50:]]), encoding="utf-8")
    (record,) = read_records(tmp_path / "r.csv")
    assert len(record.notes) == 4
    with speaking(spoken):
        for note in record.notes:
            assert not _left(gettext(note), "maker", "station", "event", "start", "location", "azimuth", "corrected")


@pytest.mark.parametrize(("peaks", "more"), [([0.1] * 40, {}), ([1.0] * 10 + [0.1] * 30, {"scale_motions": True})])
def test_the_verification_is_said(peaks, more, spoken, tmp_path):
    assessment = _assess(tmp_path, peaks, SLENDER_AND_STOCKY, **more)
    with speaking(spoken):
        verified = build_verified(assessment, tuple(assessment))
        section = trials.build_trials(assessment, verified)
        texts = [*verified.status, verified.footer, verified.interval, verified.adopted, *section.paragraphs]
        texts += [*list_summary(verified), *list_cautions(assessment), describe_verification(assessment)]
        for text in texts:
            assert text.startswith("⟦")
            assert not _left(text, "ours"), text
        lines = [*trials.list_assumptions(assessment, verified), *((row.kind, row.source) for row in section.motions)]
        for line in lines:
            assert not _left(" ".join(line)), line
        for one in assessment:
            assert not _left(f"{words.risk_words(one)} {words.under_record(one)} {words.chance(one)}")


def test_what_is_remarked_of_the_users_own_motions_is_said(spoken, tmp_path):
    (tmp_path / "ours").mkdir()
    shutil.copy(RECORDS / SMC, tmp_path / "ours" / SMC)
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", SLENDER_AND_STOCKY, [
        {"floor": "1", "pfa_x": 0.9, "pfv_x": 90}, {"floor": "2", "pfa_x": 0.9},
    ]))  # fmt: skip
    assessment = assess.run(inventory, assess.Settings(verify="all"), suite=read_suite(tmp_path / "ours"), jobs=1)
    assert {problem.severity for problem in assessment.problems} >= {"warning", "note"}
    with speaking(spoken):
        for problem in assessment.problems:
            assert not _left(f"{gettext(problem.message)} {gettext(problem.mend)}", "ours"), problem


def test_words_are_said(spoken):
    with speaking(spoken):
        for noun in ("piece", "row", "floor", "motion", "impact"):
            assert [_left(words.plural(count, noun)) for count in (1, 2)] == [set(), set()]
        assert words.clip("1" * 500, 3) == "111… (⟦500 xxxxxxxxxx; xxxxx xx xxxxxx.xxxx⟧)"
        assert not _left(words.marks())
        assert not _left("".join(words.risk_label(risk) for risk in assess.risk.RiskClass))


def test_a_noun_without_a_plural_is_a_slip():
    with pytest.raises(KeyError, match="sheep"):
        words.plural(2, "sheep")


def test_numbers_are_those_of_the_language():
    with speaking(Catalogue("xx", {}, decimal=",", group=".")):
        assert (words.percent(0.0316), words.fixed(1.25, 2), words.in_g(9.80665)) == ("3,2 %", "1,25", "1,000")
        assert (words.in_m(3.5), words.in_cm(0.305), words.in_cm_s(0.5)) == ("3,5", "30,5", "50,0")
        assert (words.plural(1200, "row"), words.percent(None)) == ("1.200 rows", "–")
