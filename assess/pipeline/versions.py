"""What the numbers of a run were computed with."""

import platform
from collections.abc import Mapping
from functools import cache


@cache
def versions(*, has_rocked: bool = False, has_routes: bool = False) -> Mapping[str, str]:
    """Return what the numbers were computed with; the simulation also depends on the kind of processor."""
    import numpy as np

    found = {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": platform.system(),
        "machine": platform.machine(),
    }
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
