"""``assess open``: what it refuses before it serves anything; tests/web has the rest."""

import subprocess
import sys

import pytest

from assess.extras import say_install
from tests.cli.calling import run
from tests.waiting import PATIENCE


def test_a_file_that_is_no_workbook_is_refused(tmp_path):
    (tmp_path / "no.xlsx").write_bytes(b"junk")
    for name in ("no.xlsx", "none.xlsx"):
        done = run("open", tmp_path / name, "--no-browser")
        assert (done.exit_code, done.stdout) == (2, "")
        assert done.stderr.endswith("1 error; nothing was written.\n")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--host", "0.0.0.0"], "--host 0.0.0.0 can be reached from other machines: add --allowed-host and"),
        (["--host", "::"], "--host :: can be reached from other machines"),
        (["--host", "example.org"], "--host example.org can be reached from other machines"),
        (["--allowed-host", "a.test"], "--allowed-host and --user-header belong together"),
        (["--user-header", "X-User"], "--allowed-host and --user-header belong together"),
        (["w.xlsx", "--allowed-host", "a.test", "--user-header", "X-User"], "leave out the workbook"),
        (["--allowed-host", "http://a.test/", "--user-header", "X-User"], "--allowed-host 'http://a.test/'"),
        (["--allowed-host", "a.test", "--user-header", "X User"], "--user-header 'X User'"),
        (["--allowed-host", "a.test", "--user-header", "Cookie"], "--user-header 'Cookie'"),
        (["--language", "xx"], "--language 'xx' is unknown"),
    ],
)
def test_what_cannot_be_served_safely_is_refused_in_one_line(words, message):
    done = run("open", *words, "--no-browser")
    assert (done.exit_code, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert message in done.stderr


def test_without_the_extra_it_says_what_to_install():
    code = (
        "import sys\nsys.modules['uvicorn'] = None\nsys.argv = ['assess', 'open']\n"
        "from assess.cli.app import main\nmain()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == (f"error  the page needs uvicorn, which is not installed. {say_install('web')}\n")
