"""What a format of recorded motion is."""

from collections.abc import Callable
from dataclasses import dataclass

from assess.motion.record import Record


@dataclass(frozen=True, slots=True)
class Format:
    """One way in which files hold recorded motion.

    Parameters
    ----------
    key : str
        Short name.
    title : str
        As shown to people.
    recognises : callable
        Tells from the first bytes of a file whether it is of this format. The name of a file decides nothing.
    read : callable
        From the whole file and its name to its channels; raises RecordError, and nothing else, whatever the bytes. The
        message need not name the file.
    """

    key: str
    title: str
    recognises: Callable[[bytes], bool]
    read: Callable[[bytes, str], tuple[Record, ...]]
