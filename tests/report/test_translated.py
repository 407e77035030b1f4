"""Whatever a report says can be said in another language, to its last word.

The language here has an x for every letter, in brackets: a word that still can be read did not go through a catalogue.
"""

import re
import shutil

import openpyxl
import pytest

import assess
from assess.i18n import Catalogue, gettext, speaking
from assess.motion.formats import read_records
from assess.report import statements, words
from assess.report.content import Content
from assess.report.say import ground
from assess.report.say.methods import find_disagreements
from assess.report.say.simulation import describe_trials
from assess.report.sections.methods import say_result
from docs.texts import collect
from tests.pictures import picture
from tests.report.test_verified import _assess
from tests.workbooks import RECORDS, write_sheets

SMC = "0165a_u.smc"
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
    (folder / "p.png").write_bytes(picture("PNG"))
    path = folder / "w.xlsx"
    rows = {"Building": [BUILDING], "Floors": [*FLOORS[:-1], FLOORS[-1] | last], "Items": ITEMS, "Routes": ROUTES}
    write_sheets(path, rows)
    book = openpyxl.load_workbook(path)
    book["Items"].cell(1, 40, "99")
    book["Items"].cell(90, 40, "stray")
    book["Building"].cell(60, 1, "99")
    book["Building"].cell(60, 2, "known to nobody")
    book.save(path)
    return path


@pytest.fixture(scope="module", params=["given", "ASCE 7-22"])
def odd(request, tmp_path_factory):
    """Return the results of a workbook that gives rise to many remarks."""
    last = {"pfa_x": 0.1} if request.param == "given" else {}
    return assess.run(_write(tmp_path_factory.mktemp("odd"), **last), scenario=request.param, verify="none")


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_every_warning_and_note_is_said(odd, spoken):
    assert len(odd.problem_rows) >= 10
    for problem in odd.problem_rows:
        for text in filter(None, (problem.message, problem.fix)):
            with speaking(spoken):
                said = gettext(text)
            assert said.startswith("⟦"), text
            assert said.endswith("⟧"), text
            assert not _left(said), text


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def test_what_shakes_the_floors_is_said(odd, spoken):
    with speaking(spoken):
        for motion in odd.motions:
            names = re.findall(r"[^\W\d_]+", f"{motion.station} {motion.record}")
            assert ground.describe_source(motion).startswith("⟦")
            assert not _left(ground.describe_source(motion))
            assert not _left(ground.describe_origin(motion), *names)
            assert not _left(ground.describe_treatment(motion))
        content = Content(odd)
        cautions = (text for one in content.cautions for text in (one.text, one.short))
        for text in (*ground.list_sources(odd.motions), *cautions):
            assert text.startswith("⟦")
            assert not _left(text), text
        for line in (*content.assumptions, *statements.list_flags(odd).items()):
            assert not _left(" ".join(line[1:]), "EXP", "sin"), line
        assert not _left(" ".join(statements.list_limits(odd)))
        for profile in odd.provenance.profiles:
            assert not _left(ground.profile_status(profile))


def test_why_methods_disagree_and_the_worked_example_are_said(example, spoken):
    with speaking(spoken):
        _summary, groups = find_disagreements(example, tuple(example))
        assert groups
        for group in groups:
            assert not _left(" ".join((*group.reasons, group.highest, group.lowest))), group.reasons
        methods = {one.key: one for one in example.methods}
        for one in example.worked:
            assert not _left(say_result(methods[one.key], one)), one


def test_what_reading_changed_of_a_record_is_said(spoken, tmp_path):
    lines = ["# maker: 1", "time [s], 1 [g]", *(f"{0.01 * at + 0.3 * (at > 200):g}, {at % 7}" for at in range(400))]
    (tmp_path / "r.csv").write_text("\n".join([*lines[:50], lines[48], *lines[50:]]), encoding="utf-8")
    (record,) = read_records(tmp_path / "r.csv")
    assert len(record.notes) == 4
    with speaking(spoken):
        for note in record.notes:
            assert not _left(gettext(note), "maker", "station", "event", "start", "location", "azimuth", "corrected")


def test_the_verification_is_said(spoken, tmp_path):
    results = _assess(tmp_path, [1.0] * 10 + [0.1] * 30, SLENDER_AND_STOCKY, scale_motions=True)
    with speaking(spoken):
        content = Content(results)
        verified = content.verified
        texts = [*verified.status, verified.footer, verified.interval, verified.adopted, *describe_trials(verified)]
        for text in (*texts, *(one.text for one in content.cautions), verified.sentence):
            assert text.startswith("⟦")
            assert not _left(text, "ours"), text
        for line in content.assumptions:
            assert not _left(" ".join(line), "sin"), line
        for one in results:
            assert not _left(f"{words.risk_words(one)} {words.under_record(one)} {words.chance(one)}")
