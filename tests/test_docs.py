"""The documentation: generated parts are current, links lead somewhere, examples run, the README keeps its promises."""

import ast
import importlib
import inspect
import re
from contextlib import suppress
from pathlib import Path

import pytest

import assess
from assess.methods.fitted import write_model
from assess.report.pages.pdf import DEBIAN
from docs.bounds import replace_table
from docs.reference import build_pages
from tests.methods.test_fitted import PROBIT
from tests.shaking import RECORDS, write_record

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = (ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted(DOCS.glob("*.md")))
README = (ROOT / "README.md").read_text(encoding="utf-8")
LINK = re.compile(r"\]\(([^)#]+?)(?:#[^)]*)?\)")
PLACE = re.compile(r"`((?:assess|templates|docs|samples|inventories|tests)/[\w./-]*)`")
PYTHON = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


def test_the_references_and_bounds_are_those_of_the_code():
    pages = build_pages()
    for name in ("workbook.md", "methods.md", "commands.md", "portfolio.md"):
        assert pages[name] == (DOCS / name).read_text(encoding="utf-8"), "run: python docs/reference.py"
    text = (DOCS / "limits.md").read_text(encoding="utf-8")
    assert replace_table(text) == text, "run: python docs/bounds.py"
    assert "| Record file: channels | 500 |" in text


def test_the_readme_is_short_and_has_two_commands():
    lines = README.splitlines()
    assert len(lines) <= 150
    assert [line for line in lines if line.lstrip().startswith("$ ")] == ["$ make example", "$ make test"]


def test_links_and_places_exist():
    missing = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        links = [(page.parent / link, link) for link in LINK.findall(text) if "://" not in link]
        places = [(ROOT / name, name) for name in PLACE.findall(text) if not name.startswith("assess/cli/command_NAME")]
        if page.name == "CHANGELOG.md":  # it tells of places that are gone
            places = []
        missing += [f"{page.name}: {name}" for path, name in (*links, *places) if not path.exists()]
    assert missing == []


@pytest.mark.slow
@pytest.mark.parametrize("page", [ROOT / "README.md", DOCS / "python.md"], ids=lambda page: page.name)
def test_examples_in_python_run(page, tmp_path, monkeypatch):
    for name in ("inventories", "samples"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)  # what they write stays out of the checkout
    space: dict[str, object] = {}
    for code in PYTHON.findall(page.read_text(encoding="utf-8")):
        exec(compile(code, page.name, "exec"), space)
    assert "results" in space


@pytest.mark.slow
def test_code_within_the_sentences_runs(tmp_path, monkeypatch):
    """What stands between words: an expression is evaluated; a call with ``...`` takes its arguments."""
    text = (DOCS / "python.md").read_text(encoding="utf-8")
    (tmp_path / "folder").mkdir()
    write_record(tmp_path / "folder" / "a.csv", RECORDS["fast"])
    (tmp_path / "fitted_probit.toml").write_text(write_model(PROBIT), encoding="utf-8")
    (tmp_path / "inventories").symlink_to(ROOT / "inventories")
    monkeypatch.chdir(tmp_path)
    blocks = [code for code in PYTHON.findall(text) if "inventory =" in code or "compute(" in code or "show" in code]
    space: dict[str, object] = {"error": assess.InputError("why"), "frame": None}
    for code in blocks:
        exec(compile(code, "python.md", "exec"), space)
    space["results"] = assess.run("inventories/market-street.xlsx", verify="none")
    sentences, tried = re.sub(r"```.*?```", "", text, flags=re.DOTALL), 0
    for name, module in re.findall(r"`(\w+)\([^`]*\)`\s+of\s+`([\w.]+)`", sentences):
        space[name] = getattr(importlib.import_module(module), name)
    for code in re.findall(r"`([^`\n]+)`", sentences):
        with suppress(SyntaxError):  # words and commands; a single word is a name in a table
            if code.isidentifier():
                continue
            expression = ast.parse(re.sub(r"^\w+=(?=[^=])", "", code), mode="eval").body
            tried += _try_code(expression, space)
    assert tried > 12


def _try_code(expression: ast.expr, space: dict[str, object]) -> int:
    """Evaluate an expression; of a call with ``...``, or of a writer, its arguments alone, by the signature."""

    def value(one: ast.expr) -> object:
        return eval(compile(ast.Expression(one), "python.md", "eval"), space)

    if not (isinstance(expression, ast.Call) and re.search(r"write_|\.\.\.", ast.unparse(expression))):
        value(expression)
        return 1
    given = {str(one.arg): value(one.value) for one in expression.keywords}
    places = [value(one) for one in expression.args]
    inspect.signature(value(expression.func)).bind(*places, **given)
    return 1


def _find(pattern, paths):
    """Return the places where a pattern stands, whatever the line breaks inside it."""
    texts = ((path, path.read_text(encoding="utf-8")) for path in paths)
    return [
        f"{path.relative_to(ROOT)}:{text.count(chr(10), 0, found.start()) + 1}: {found[0]}"
        for path, text in texts
        for found in re.finditer(pattern, text)
    ]


UNFINISHED = re.compile(r"^[\W_]*[A-Z]{4}[A-Z_]*[\W_]*$|\b(?:TODO|TBD|FIXME)\b", re.MULTILINE)


def test_no_placeholder_is_left():
    """A word in capitals alone on a line, or a mark of what is still to be written."""
    for line in ("COUNTS", "| MEASURED_LATER |", "* NUMBERS.", "takes TBD s", "TODO: say why"):
        assert UNFINISHED.search(f"One line.\n{line}\n"), line
    for line in ("ASCE 7-22", "SDS", "MMI VII", "The TODOS of it", "`MOST_LINES` is 5"):
        assert not UNFINISHED.search(f"One line.\n{line}\n"), line
    assert _find(UNFINISHED, [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]) == []


UNREAD = re.compile(
    r"(?:original|paper|publication|decree|standard|texts?)\s(?:itself\s)?(?:was|were)\snot(?:\s(?:at\shand|read)|\.)|"
    r"general\sknowledge"
)


def test_only_the_limits_tell_which_originals_were_not_consulted():
    """References of a report say where a number comes from; docs/limits.md says which of them are secondary."""
    pages = [one for one in (*(ROOT / "assess").rglob("*.py"), *PAGES) if one.name not in ("limits.md", "CHANGELOG.md")]
    templates = [*(ROOT / "templates").rglob("*.j2")]
    assert templates
    assert _find(UNREAD, sorted([*pages, *templates])) == []
    assert "## Sources that were read in secondary form\n" in (DOCS / "limits.md").read_text(encoding="utf-8")


def test_the_readme_installs_from_the_source_code_not_from_an_index():
    """On PyPI another project has the name."""
    install = README.partition("## Install\n")[2].partition("\n## ")[0]
    assert re.findall(r"^(?:pipx|uv|python) .*", install, re.MULTILINE) == [
        "pipx install .", "uv tool install .", "python -m pip install .",
    ]  # fmt: skip
    named = [text for text in re.findall(r"`([^`\n]+)`", README) if re.search(r"install .*\bassess\b", text)]
    assert named == ["pip install assess"]
    assert "`pip install assess` does not install this one" in README
    for package in ("pango", *DEBIAN.removeprefix("apt install ").split()):
        assert package in install
