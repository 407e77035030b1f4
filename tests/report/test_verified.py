"""What the HTML and PDF reports say of runs that are verified, partly verified, or not."""

import base64
import re
import shutil
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pypdfium2
import pytest

import assess
from assess import ensembles
from assess.adoption import VERIFICATION, adopt
from assess.motion.record import Motion
from assess.motion.suite import Suite
from assess.report import words
from assess.report.content import build_content
from assess.report.figures.verification import choose_traced, draw_traced
from assess.report.findings.cautions import list_cautions
from assess.report.findings.verified import describe_verification
from assess.report.pages.html import render
from assess.risk import RiskClass
from assess.settings import Settings
from assess.units import GRAVITY
from tests.report.test_html import _read
from tests.workbooks import RECORDS, UNVERIFIED, write

SCRIPT = "<b>$x$</b>"
FLOORS = [{"floor": "1", "pfa_x": 0.2, "pfv_x": 40}, {"floor": "2", "pfa_x": 0.1, "pfv_x": 20}]
ITEMS = [
    {"item": SCRIPT, "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 1, "y": 1, "axis": "X"},
    {"item": "twin", "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 1, "y": 3, "axis": "X",
     "quantity": 1},
    {"item": "fixed", "floor": "1", "breadth": 30, "width": 80, "height": 200, "anchored": "yes"},
    {"item": "stout", "floor": "2", "breadth": 60, "width": 60, "height": 200, "axis": "X", "quantity": 4},
    {"item": "cube", "floor": "2", "breadth": 90, "width": 90, "height": 60},
]  # fmt: skip


def _pulses(*peaks):
    """Return a suite of five waves of 1 s each [g]."""
    times = np.arange(0, 8, 0.01)
    wave = np.where(times < 5, np.sin(2 * np.pi * times), 0.0)
    motions = []
    for at, peak in enumerate(peaks):
        acceleration = peak * GRAVITY * wave
        velocity = np.cumsum(acceleration) * 0.01
        motions.append((f"m{at}.csv", Motion(acceleration, velocity, np.cumsum(velocity) * 0.01, 0.01)))
    return Suite("ours", tuple(motions), {})


def _assess(folder, peaks, items=ITEMS, floors=FLOORS, building=(), **settings):
    inventory = assess.read_inventory(write(folder / "w.xlsx", items, floors, **dict(building)))
    with pytest.MonkeyPatch.context() as patch:  # weak motions may lower classes here: that is what is to be shown
        patch.setattr(ensembles, "WEAK_PFA", 0.0)
        patch.setattr(ensembles, "WEAK_PFV", 0.0)
        return assess.run(inventory, Settings(**settings), suite=_pulses(*peaks), jobs=1)


def _text(assessment):
    text = _read(render(assessment))
    return re.sub(r" (?=[,.;:)])", "", text)


def _figures(assessment):
    """Return the SVG figures of the verification."""
    html = render(assessment)
    part = html[html.index('<section id="verification"') :]
    found = re.findall(r'<img src="data:image/svg\+xml;base64,([^"]+)"', part[: part.index("</section>")])
    return [ET.fromstring(base64.b64decode(one)) for one in found]


def _ids(figure, name):
    return [one for one in figure.iter() if one.get("id", "") == name]


@pytest.fixture(scope="module")
def lowered(tmp_path_factory):
    """Motions so weak that nothing falls: partly verified, and every class lowered that was verified."""
    return _assess(tmp_path_factory.mktemp("lowered"), [0.1] * 40)


@pytest.fixture(scope="module")
def some(tmp_path_factory):
    """All verified; of 40 motions 10 overturn what is slender."""
    return _assess(tmp_path_factory.mktemp("some"), [1.0] * 10 + [0.1] * 30, ITEMS[:4], verify="all")


def test_an_unverified_report_says_so_everywhere(tmp_path):
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", ITEMS, FLOORS))
    assessment = assess.run(inventory, UNVERIFIED)
    text = _text(assessment)
    assert "Status Not verified: classes are those of a published formula; no direct integration has been run" in text
    assert "the interval covers the number of records only, and there is none yet: nothing has been verified" in text
    assert "The adopted risk is that of the proposed OR formula; the others stand beside it for comparison." in text
    assert "Not verified. The risks in this report are those of published formulas." in text
    assert "Chance: the adopted risk, here that of the proposed OR formula, OR; in brackets as printed" in text
    assert "Under the record" not in text
    assert 'data-status="Chance of overturning in this scenario, not per year. Not verified."' in render(assessment)
    assert _figures(assessment) == []
    assert describe_verification(assessment) == "Not verified."


def test_a_partly_verified_report_tells_what_is_and_what_is_not(lowered):
    text = _text(lowered)
    status = "Partly verified: 3 of 5 rows by direct integration, 40 motions of the user's own"
    assert text.count(f"{status}; the classes of the other rows are those of a published formula") == 2
    assert "A chance without an interval is the formula's: it is not verified." in text
    assert (
        "direct integration) where a piece was verified, and that of the proposed OR formula where it was not" in text
    )
    assert "Not verified, chance and class are the formula's: 5 pieces in 2 rows." in text
    assert "verified where an interval stands beside it (95 %, of the number of records only), else that of" in text
    assert "The rocking of 3 of 5 rows was integrated step by step" in text
    assert "nothing has been verified" not in text


def test_a_lowered_class_is_marked_wherever_it_stands(lowered):
    text = _text(lowered)
    rows = [one for one in lowered if one.adopted.lowered_from is not None]
    assert len(rows) == 3
    said = "○ low, may be medium, lowered by verification (formula: high)"
    assert text.count(said) == 2 * 2  # all pieces, classes lowered
    assert text.count("○ low ?↓") == 2 * 2  # on one line: the worst, what to fix first
    assert text.count("depends on its anchor (free-standing: low, may be medium, lowered by verification") == 2
    assert "Class lowered by verification: 3 pieces in 3 rows (1 of them anchored): 3 from high." in text
    assert "May be of a higher class, as the interval reaches into it: 3 pieces in 3 rows (1 of them anchored)." in text
    assert "0.0 % (0.0 to 8.8 %)" in text
    assert "Verification lowered the class of 2 free-standing pieces of this floor" in text
    said = describe_verification(lowered)
    assert "class lowered by it: 3 pieces in 3 rows (1 of them anchored)" in said
    assert build_content(lowered).total.lowered == 3 - 1
    assert "2 were lowered by verification, 2 may be of a higher class." in text


def test_the_plan_marks_what_was_lowered_or_may_be_higher(lowered):
    html = render(lowered)
    assert "?: may be of a higher class; ↓: lowered by verification" in html
    assert re.findall(r'<text class="class-marks"[^>]*>([^<]*)<', html) == ["?↓", "?↓"]
    assert [words.class_marks(one) for one in lowered][:2] == ["?↓", "?↓"]


def test_a_verified_report_has_chance_formula_and_record_side_by_side(some):
    text = _text(some)
    assert "Status Verified: 4 of 4 rows by direct integration, 40 motions of the user's own" in text
    assert "not the formula, the motion of the floor or the earthquake." in text
    assert "A chance without an interval" not in text
    one = some.result(0)
    assert one.adopted.probability == 0.25
    assert words.chance(one).replace(words.NO_BREAK, " ") == "25.0 % (14.2 to 40.2 %)"
    formula = one.governing.methods["proposed_or"]
    assert f"{100 * formula.value:.1f} % ({formula.detail['raw']:.3f})" in text
    assert "25.0 % (14.2 to 40.2 %) – ◇ medium, may be high, lowered by verification (formula: high)" in text
    assert "25.0 %" in text[text.index("What every method says of each row") :]
    assert f"{SCRIPT} (and 1 alike)" in text


def test_footers_of_the_pdf_tell_the_status(some, tmp_path):
    written = assess.write_reports(some, tmp_path, ("pdf",))
    document = pypdfium2.PdfDocument(written["pdf"])
    pages = [" ".join(document[at].get_textpage().get_text_range().split()) for at in range(len(document))]
    document.close()
    footer = "not per year. Verified: 4 of 4 rows; the interval covers the number of records only."
    assert all(footer in page for page in pages)


def test_a_raised_class_is_told_and_comes_first(tmp_path):
    assessment = _assess(tmp_path, [2.0] * 30, verify="all")
    text = _text(assessment)
    assert "Class raised by verification: 7 pieces in 4 rows (1 of them anchored): 7 to very high." in text
    assert "raised by it" in describe_verification(assessment)
    changed = build_content(assessment).trials.changed
    assert [one.adopted.risk for one in changed] == [RiskClass.VERY_HIGH] * len(changed)
    assert "1 row is too stocky to rock (B/H of 1.41 or more)." in text


def test_a_piece_that_overturns_under_the_record_is_named(tmp_path):
    shutil.copy(RECORDS / "made-up-sweep.csv", tmp_path)
    floors = [{"floor": "1", "record_x": "made-up-sweep.csv#north"}]
    assessment = _assess(tmp_path, [0.02] * 20, [ITEMS[0], ITEMS[3] | {"floor": "1"}], floors, verify="all")
    found = assessment.outcomes[VERIFICATION]
    detail = {"record_overturned": np.array([1.0, 0.0]), "record_rotation": np.array([3.0, 0.334])}
    found = replace(
        found, detail={**found.detail, **detail}, flags={**found.flags, "fell_in_record": np.array([True, False])}
    )
    outcomes = {**assessment.outcomes, VERIFICATION: found}
    again = replace(assessment, outcomes=outcomes, adoption=adopt(outcomes, assessment.cases))
    text = _text(again)
    assert f"Overturn under the recorded motion itself, and so are at least high: 1 piece in 1 row: {SCRIPT}." in text
    assert "▲ high, as it overturns under the record itself" in text
    assert "overturns ▲ high" in text
    assert "0.33 of critical" in text
    assert "1 row overturns under the record itself" in describe_verification(again)


@pytest.fixture(scope="module")
def generic(tmp_path_factory):
    """One floor of which only peaks are known, with generated motions."""
    path = write(tmp_path_factory.mktemp("generic") / "w.xlsx", ITEMS[:1], FLOORS[:1], restitution=0.9)
    return assess.run(assess.read_inventory(path), Settings(runs=20), jobs=1)


def test_a_generic_floor_is_told(generic):
    text = _text(generic)
    caution = "Floor 1: motions follow a generic spectrum; verification may raise a class there, never lower it."
    assert text.count(caution) == 1
    assert text.count("Floor 1: generic spectrum; verification may raise a class there, never lower it.") == 1
    assert caution in list_cautions(generic)
    assert "On each floor and axis 20 motions were generated (seed 1)." in text
    assert "At each impact a piece keeps 0.9 of its angular velocity, as the workbook sets." in text
    assert "generic spectrum 20 1" in text
    kept = [one for one in generic if "not_lowered" in one.adopted.flags]
    assert ("of 1 row the formula's higher class is kept" in text) == bool(kept)
    assert ("or verification gave a lower class, which is not adopted" in text) == bool(kept)
    fit = next(iter(generic.joints.values())).fit
    assert f"{100 * fit.mean_deviation:.1f} %; {100 * fit.worst_deviation:+.1f} % at {fit.worst_period:.2f} s" in text
    for what, assumed in (("Restitution", "0.9, the workbook's"), ("Motions of the verification", "with seed 1"),
                          ("Interval of a verified chance", "Wilson's, z = 1.96: 95 %")):  # fmt: skip
        assert any(name.startswith(what) and assumed in told for name, told in build_content(generic).assumptions)
    assert "Wilson EB (1927)" in text


def test_a_large_misfit_is_told(generic):
    cases = generic.outcomes[VERIFICATION]
    (joint,) = cases.joints
    joint = replace(joint, fit=replace(joint.fit, mean_deviation=0.15, worst_deviation=-0.4, worst_period=2.0))
    again = replace(generic, outcomes={**generic.outcomes, VERIFICATION: replace(cases, joints=(joint,))})
    text = _text(again)
    assert (
        "Floor 1 X: PFA and the spectrum cannot both be met. PFA wins; the mean spectrum is met within 15.0 % on"
        in text
    )
    assert "average, and within 40.0 % at 2.00 s, where it is worst." in text


def test_the_stopping_rule_names_the_undecided(some):
    cases = some.outcomes[VERIFICATION]
    is_first = np.arange(cases.value.size) == 0
    found = replace(cases, flags={**cases.flags, "undecided": is_first})
    again = replace(some, suite=None, settings=Settings(runs="auto"), outcomes={**some.outcomes, VERIFICATION: found})
    text = _text(again)
    assert "looked at after 125, 250, 500, 1,000, 2,500 and 5,000 motions, with an interval (z = 2.64)" in text
    assert f"Undecided after 5,000: {SCRIPT}." in text
    assert f"one class after 5,000 motions: 1 piece in 1 row: {SCRIPT}." in text
    assert "1 row still undecided" in describe_verification(again)
    decided = replace(again, outcomes=some.outcomes)
    assert "No piece is left undecided." in _text(decided)


def test_the_users_own_motions_are_named_and_held_against_the_floor(some, lowered, tmp_path):
    cautions = list_cautions(some)
    assert cautions[-2].startswith(
        "Verification uses 40 motions of the folder ours, as they are, not scaled: m0.csv, m1"
    )
    median = "The median PFA of these motions, 0.100 g, is not that of floor 1 X (0.200 g), 50 % below; floor 1 Y"
    assert cautions[-1].startswith(median)
    weak = list_cautions(lowered)[-1]
    assert weak.startswith("The median PFA of these motions, 0.100 g, is not that of floor 1 X (0.200 g), 50 % below;")
    assert weak.endswith("Where it is below, chances come out too low; they lower no class.")
    assert "floor 2" not in weak
    scaled = _assess(tmp_path, [0.1] * 20, ITEMS[:1], scale_motions=True)
    assert "of the folder ours, scaled to each floor's PFA" in list_cautions(scaled)[-1]
    assert "own, scaled to PFA" in _text(scaled)
    assert "1.00 ± 0.00" in _text(scaled)


def test_the_figures_show_each_piece_once_and_hold_no_markup(some):
    traced = choose_traced(build_content(some))
    assert [one.name for one in traced] == [f"{SCRIPT} (and 1 alike)", "stout"]
    motions, convergence, rotations = _figures(some)
    assert len(_ids(convergence, "chance")) == len(_ids(convergence, "interval")) == 2
    assert len(_ids(convergence, "class-limit")) == 2 * 3
    assert len(_ids(rotations, "overturned")) == 2
    for number in (1, 2, 3):
        (line,) = _ids(motions, f"motion-{number}")
        assert any(len(path.get("d", "")) > 1000 for path in line.iter())
    assert _ids(motions, "record") == []
    html = render(some)
    assert SCRIPT not in html
    assert "&lt;b&gt;$x$&lt;/b&gt;" in html
    assert all(re.search(r'alt="[^"]{10,}"', image) for image in re.findall(r"<img [^>]*>", html))


def _drawn(assessment):
    content = build_content(assessment)
    traced = choose_traced(content)
    return traced[0], {name: ET.fromstring(svg) for name, svg in draw_traced(content, traced).items()}


def _subpaths(figure, name):
    """Count the curves of a line: the pen is lifted between two."""
    (group,) = _ids(figure, name)
    return sum(path.get("d", "").count("M") for path in group.iter())


def test_the_spectra_of_the_users_motions_are_drawn(some):
    first, figures = _drawn(some)
    assert first.joint.spectra.ordinates.shape[0] == 40
    assert _subpaths(figures["motions"], "spectra") == 40
    assert len(_ids(figures["motions"], "band")) == len(_ids(figures["motions"], "mean")) == 1
    assert _ids(figures["motions"], "wanted") == [], "neither a record nor a target"
    assert len(_ids(figures["convergence"], "class")) == 4


def test_a_generic_target_is_drawn_dotted(generic):
    _, figures = _drawn(generic)
    (wanted,) = _ids(figures["motions"], "wanted")
    assert "stroke-dasharray" in next(path.get("style") for path in wanted.iter() if path.get("d"))
    assert _subpaths(figures["motions"], "spectra") == 20, "of the motions that were run, not of those made"


def test_the_record_is_the_target(tmp_path):
    shutil.copy(RECORDS / "made-up-sweep.csv", tmp_path)
    floors = [{"floor": "1", "record_x": "made-up-sweep.csv#north"}]
    own = _assess(tmp_path, [1.0] * 3, ITEMS[:1], floors, verify="all")
    first, figures = _drawn(own)
    assert first.joint.spectra.target is None
    assert len(_ids(figures["motions"], "wanted")) == 1, "the record's own"
    inventory = assess.read_inventory(write(tmp_path / "x.xlsx", ITEMS[:1], floors))
    first, figures = _drawn(assess.run(inventory, Settings(verify="all", runs=100), jobs=1))
    assert _subpaths(figures["motions"], "spectra") == 100
    (wanted,) = _ids(figures["motions"], "wanted")
    assert "stroke-dasharray" not in next(path.get("style") for path in wanted.iter() if path.get("d"))
    assert sum(len(ET.tostring(one)) for one in figures.values()) < 450_000
    assert len(ET.tostring(figures["motions"])) < 250_000


def test_a_joint_without_spectra_is_drawn_without_them(some):
    found = some.outcomes[VERIFICATION]
    joints = tuple(replace(joint, spectra=None) for joint in found.joints)
    again = replace(some, outcomes={**some.outcomes, VERIFICATION: replace(found, joints=joints)})
    _, figures = _drawn(again)
    assert _ids(figures["motions"], "spectra") == []
    assert len(_ids(figures["motions"], "motion-1")) == 1


def test_the_convergence_ends_at_the_chance(some):
    (first, *_) = choose_traced(build_content(some))
    assert first.fell.mean() == first.one.adopted.probability
    assert first.rotation.shape == first.fell.shape == (40,)
