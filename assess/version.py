"""The version, and the code of the package, once; what the numbers of a run were computed with."""

import hashlib
import platform
from collections.abc import Mapping
from functools import cache
from pathlib import Path

__version__ = "0.1.0"


@cache
def find_code() -> str:
    """Return the SHA-256 [hex] over the modules and tables of the package: two builds of one version differ in it."""
    root, digest = Path(__file__).parent, hashlib.sha256()
    for file in sorted(one for one in root.rglob("*") if one.suffix in (".py", ".csv")):
        digest.update(f"{file.relative_to(root).as_posix()}\0".encode() + file.read_bytes())
    return digest.hexdigest()


@cache
def versions(*, has_rocked: bool = False, has_routes: bool = False) -> Mapping[str, str]:
    """Return what the numbers were computed with; the simulation also depends on the kind of processor."""
    import numpy as np

    found = {
        "python": platform.python_version(), "numpy": np.__version__, "system": platform.system(),
        "machine": platform.machine(),
    }  # fmt: skip
    if not (has_rocked or has_routes):
        return found
    from importlib.metadata import version  # here: it takes a tenth of the time of a small run by formulas

    if has_rocked:
        from llvmlite.binding import get_host_cpu_name
        from numba import config

        processor = getattr(config, "CPU_NAME", None) or get_host_cpu_name()
        found |= {"scipy": version("scipy"), "numba": version("numba"), "processor": processor}
    if has_routes:
        found |= {name: version(name) for name in ("shapely", "networkx")}
    return found
