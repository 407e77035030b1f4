"""Progress that cancels."""

from assess.errors import CancelledError
from assess.progress import Progress


class StopsAt(Progress):
    """Cancels at the n-th check, and counts them."""

    def __init__(self, last: int) -> None:
        super().__init__()
        self.last, self.checks = last, 0

    def check(self) -> None:
        self.checks += 1
        if self.checks >= self.last:
            raise CancelledError
