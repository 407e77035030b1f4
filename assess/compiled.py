"""Compiles functions to machine code when they are first called. Importing this imports numba: a third of a second."""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar, cast

from numba import config, njit

from assess.cache_folder import choose_folder

_Function = TypeVar("_Function", bound=Callable[..., object])


OPTIONS: Mapping[str, Any] = {
    "nogil": True,  # threads run side by side
    "error_model": "numpy",
    "fastmath": {"nnan", "nsz", "contract", "arcp"},  # what vector lanes need; sums keep their order
}


def compiled(function: _Function) -> _Function:
    """Compile `function` when it is first called, and keep that for the next process in the user's cache folder.

    A folder that NUMBA_CACHE_DIR names is used instead. Where neither is safe (`assess.cache_folder`), each process
    compiles anew.
    """
    settings = cast("Any", config)
    before = settings.CACHE_DIR
    folder, _ = choose_folder(before)
    if folder is None:
        return cast("_Function", njit(**OPTIONS)(function))
    try:
        # numba has no argument for this folder, and takes it at this moment; so only this function is kept there.
        settings.CACHE_DIR = str(folder)
        return cast("_Function", njit(cache=True, **OPTIONS)(function))
    except (RuntimeError, OSError):
        return cast("_Function", njit(**OPTIONS)(function))
    finally:
        settings.CACHE_DIR = before


def compiled_into(function: _Function) -> _Function:
    """Compile `function` as a part of the compiled functions that call it, often; it may make no arrays.

    numba does not count references to arrays in it, which would cost more than the work of a small function.
    """
    try:
        return cast("_Function", cast("Any", njit)(_nrt=False, **OPTIONS)(function))
    except (KeyError, TypeError):  # numba does not promise to keep this option
        return cast("_Function", njit(**OPTIONS)(function))
