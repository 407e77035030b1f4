"""How an extra is installed: never by the name `assess`, which is another project on PyPI."""

import re
import tomllib
from pathlib import Path

from assess.extras import say_install

ROOT = Path(__file__).resolve().parents[1]


def test_the_line_is_one_and_installs_from_the_source_code():
    said = say_install("parquet")
    assert "\n" not in said
    assert "python -m pip install '.[parquet]'" in said
    assert "pipx install --force '.[parquet]'" in said


def test_no_text_of_the_program_installs_assess_by_name_and_every_extra_named_exists():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    named = set()
    for path in (ROOT / "assess").rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"pip install [\"']?assess\[", text), path
        named |= set(re.findall(r"say_install\([\"'](\w+)[\"']\)", text))
    assert {"parquet", "cluster", "web", "word", "plans"} <= named <= set(extras)
