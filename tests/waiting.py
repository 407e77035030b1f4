"""Waiting for an event, for as long as no passing test does, on a machine that is ten times busier too."""

import time

PATIENCE = 180.0
"""Time after which what is waited for is taken not to come [s]; it takes a fraction of a second, or a few seconds."""


def wait_until(ask, is_so=bool):
    """Ask again and again until an answer is so, and return it."""
    latest = time.monotonic() + PATIENCE
    while not is_so(answer := ask()):
        assert time.monotonic() < latest, f"what was waited for did not come; the last answer: {answer!r}"
        time.sleep(0.02)
    return answer
