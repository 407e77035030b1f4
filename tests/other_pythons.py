"""The other versions of Python that this machine has and `assess` supports: one interpreter of each, a line each.

A version is used where a python3.X runs, or where pyenv has installed one without putting it on the path.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]


def list_versions() -> list[str]:
    """Return the versions that pyproject.toml names, but for the one that runs this."""
    named = re.findall(r"Python :: (3\.\d+)", (ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    return [one for one in named if one != "{}.{}".format(*sys.version_info)]


def find_pythons() -> dict[str, str]:
    """Return the interpreter of each other version that is installed and can make environments."""
    found = {}
    for version in list_versions():
        pyenv = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv")
        code = f"import sys, venv, ensurepip; sys.exit('%d.%d' % sys.version_info[:2] != {version!r})"
        for python in (shutil.which(f"python{version}"), *sorted(pyenv.glob(f"versions/{version}.*/bin/python"))):
            if python and not subprocess.run([python, "-c", code], stderr=subprocess.DEVNULL, check=False).returncode:
                found[version] = str(python)
                break
    return found


if __name__ == "__main__":
    for version, python in find_pythons().items():
        print(version, python)
