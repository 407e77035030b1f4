"""The PDFs are what they say they are: PDF/A-3u and PDF/UA-1, by veraPDF, the validator of the PDF Association.

Its jars come from Maven Central into build/verapdf. Without Java, Maven or a network these tests are skipped, but fail
where ASSESS_CI is set.
"""

import contextlib
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import weasyprint

from assess.compare.changes import compare
from assess.compare.comparison_files import write_comparison
from assess.compare.past_run import read_run
from assess.report.content import Content
from assess.report.pages.html import render
from assess.report.report_options import ReportOptions
from assess.settings import Settings
from tests.compare.past import write_routed_run
from tests.pictures import picture
from tests.report.reading import write_pdf
from tests.workbooks import UNVERIFIED, assessed

HERE = Path(__file__).parents[1] / "verapdf"
ROOT = HERE.parents[1]
JARS = ROOT / "build" / "verapdf"
DRAWS_EQUATIONS = True
pytestmark = [pytest.mark.verapdf, pytest.mark.slow]

JAPANESE = [
    {"item": "棚 1", "floor": "1", "room": "会議室", "description": "書棚 ντουλάπι", "breadth": 30, "height": 200,
     "x": 3, "y": 3, "photo": "p.png"}
]  # fmt: skip


@pytest.fixture(scope="module")
def jars():
    """The validator's folder, filled once; several processes may fill it at the same time."""
    if not (shutil.which("java") and shutil.which("mvn")):
        _go_without("Java or Maven is not installed")
    if not JARS.is_dir():
        JARS.parent.mkdir(exist_ok=True)
        folder = JARS.with_name(f"verapdf-{os.getpid()}")
        command = ["mvn", "-q", "-B", "dependency:copy-dependencies", f"-DoutputDirectory={folder}"]
        done = subprocess.run(command, cwd=HERE, capture_output=True, text=True, timeout=600, check=False)
        if done.returncode:
            shutil.rmtree(folder, ignore_errors=True)
            _go_without(f"Maven cannot fetch the validator: {done.stdout[-500:]}")
        with contextlib.suppress(OSError):  # another process was first
            folder.rename(JARS)
        shutil.rmtree(folder, ignore_errors=True)
    return JARS


def _go_without(reason):
    """Skip, but where the tests are to run for real: see .ci/run."""
    if os.environ.get("ASSESS_CI"):
        pytest.fail(reason)
    pytest.skip(reason)


def _validate(jars, *pairs):
    """Return what each file breaks, in a word with its clause."""
    words = [str(word) for pair in pairs for word in pair]
    command = ["java", "-cp", f"{jars}/*", str(HERE / "Validate.java"), *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    verdicts = re.findall(r"^(PASS|FAIL) \S+ (.+)\n((?:  .*\n)*)", done.stdout, re.MULTILINE)
    assert [file for _, file, _ in verdicts] == [str(file) for file, _ in pairs]
    for verdict, _, broken in verdicts:
        assert (verdict == "PASS") == (broken == "")
    return [broken for _, _, broken in verdicts]


def _write(results, path, *, accessible=False, language="en", edition="client"):
    options = ReportOptions(language=language, accessible=accessible)
    with options.spoken():
        write_pdf(Content(results), path, options, edition=edition)
    return path


def _strange(folder):
    """Editions for archives and for screen readers: in Italian, with signs that fonts lack and pictures."""
    (folder / "p.png").write_bytes(picture("PNG", "RGBA", (1600, 1200)))
    floors = [{"floor": "1", "pfa_x": 0.4, "plan": "p.png", "plan_left": 0, "plan_bottom": 0, "plan_width": 16}]
    results = assessed(folder / "表.xlsx", JAPANESE, floors, building="東京", organisation="Us & Co", logo="p.png")
    assert 'class="photo"' in render(Content(results))
    return [
        (_write(results, folder / "client.pdf", language="it"), "3u"),
        (_write(results, folder / "annex.pdf", accessible=True, language="it", edition="annex"), "ua1"),
        (_write(results, folder / "work.pdf", edition="work"), "3u"),
        (_write(results, folder / "work-ua.pdf", accessible=True, language="it", edition="work"), "ua1"),
    ]


def _comparison(folder):
    before = write_routed_run(folder / "weak", Settings(verify="none", scale=0.4))
    found = compare(read_run(before), read_run(write_routed_run(folder / "b", UNVERIFIED)))
    pairs = []
    for language, kind in (("it", "3u"), ("en", "ua1")):
        options = ReportOptions(language=language, accessible=kind == "ua1")
        pairs.append((write_comparison(found, folder / f"{language}-{kind}", ("pdf",), options)["pdf"], kind))
    return pairs


def test_reports_are_valid_and_the_validator_can_say_no(tmp_path, jars):
    strange = _strange(tmp_path)
    good = [*strange, *_comparison(tmp_path)]
    plain = tmp_path / "plain.pdf"
    weasyprint.HTML(string="<h1>Plain</h1>").write_pdf(plain)
    *found, archival_as_accessible, plain_as_archival = _validate(jars, *good, (strange[0][0], "ua1"), (plain, "3u"))
    assert found == [""] * 6
    assert re.search(r"^  5 test 1: .*PDF/UA", archival_as_accessible)
    assert "6.6" in plain_as_archival
