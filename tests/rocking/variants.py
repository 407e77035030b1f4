"""The kernel with another constant, compiled anew: to see what a choice costs, or that it changes nothing."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

from numba import njit

from assess.compiled import OPTIONS, compiled_into
from assess.rocking import kernel

KEPT = "from assess.compiled import compiled, compiled_into\n"
"""`compiled` keeps machine code on disk, where the kernel as it is would be found."""


def kernel_with(**constants: float) -> Callable[..., int]:
    """Return the kernel's `rock` with other constants, such as REST=1e-6."""
    source = Path(kernel.__file__).read_text(encoding="utf-8")
    if KEPT not in source:
        raise ValueError("the kernel imports its compilers in another way")
    source = source.replace(KEPT, "")
    for name, value in constants.items():
        source, count = re.subn(rf"(?m)^{name} = .*$", f"{name} = {value!r}", source)
        if count != 1:
            raise ValueError(f"the kernel has {count} lines that set {name}")
    own: dict[str, Any] = {"compiled": cast("Any", njit)(**OPTIONS), "compiled_into": compiled_into}
    exec(compile(source, kernel.__file__, "exec"), own)
    return own["rock"]  # type: ignore[no-any-return]
