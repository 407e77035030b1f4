"""How far a verification is, as it is told on standard error."""

import io
import re
import threading

import numpy as np
import pytest

from assess import progress
from assess.progress import Progress
from assess.verification import Work


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Clock:
    """Time that passes when it is told to."""

    def __init__(self):
        self.now = 0.0

    def monotonic(self):
        return self.now


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(progress, "time", clock)
    return clock


def work():
    """Piece 1 stands under two motions of floor 1; two ensembles are of floor 1, one of floor 2."""
    return Work((np.array([0, 1]), np.array([1]), np.array([2, 3, 4])), ("1", "1", "2"))


def shown(stream):
    """Return what a terminal shows now, and how many lines it has."""
    lines = stream.getvalue().split("\n")
    return lines[-1].split("\r\x1b[K")[-1], len(lines)


def test_without_a_terminal_there_is_one_line(clock):
    stream = io.StringIO()
    tell = Progress(work(), stream)
    for number in range(3):
        clock.now += 10
        tell("rocking", number, 0.5)
        tell("done", number, 1.0)
    assert stream.getvalue() == "Verifying 5 pieces on 2 floors.\n"


def test_one_piece_on_one_floor():
    stream = io.StringIO()
    Progress(Work((np.array([3]),), ("1",)), stream)
    assert stream.getvalue() == "Verifying 1 piece on 1 floor.\n"


def test_what_is_done_can_be_something_else(clock):
    stream = io.StringIO()
    Progress(work(), stream, doing="Rocking")
    assert stream.getvalue() == "Rocking 5 pieces on 2 floors.\n"
    stream = Terminal()
    tell = Progress(work(), stream, "Rocking")
    clock.now = 1.0
    tell("motions", 0, 0.01)
    assert shown(stream)[0].startswith("Rocking: 0 pieces on 0 floors done of 5 pieces")


def test_on_a_terminal_the_line_has_pieces_floors_and_the_time_left(clock):
    stream = Terminal()
    tell = Progress(work(), stream)
    clock.now = 30.0
    tell("rocking", 0, 0.6)
    assert shown(stream) == ("Verifying: 0 pieces on 0 floors done of 5 pieces on 2 floors, about 2 min left", 1)
    clock.now = 60.0
    tell("done", 0, 1.0)
    assert shown(stream)[0] == "Verifying: 1 piece on 0 floors done of 5 pieces on 2 floors, about 2 min left"
    clock.now = 90.0
    tell("done", 1, 1.0)
    assert shown(stream)[0] == "Verifying: 2 pieces on 1 floor done of 5 pieces on 2 floors, about 45 s left"
    clock.now = 91.0
    tell("done", 2, 1.0)
    assert shown(stream) == ("", 1), "the line is gone when all is done"


def test_at_first_the_time_left_is_not_known(clock):
    stream = Terminal()
    tell = Progress(work(), stream)
    clock.now = 1.0
    tell("motions", 0, 0.01)
    assert shown(stream)[0] == "Verifying: 0 pieces on 0 floors done of 5 pieces on 2 floors"


def test_the_line_is_not_written_more_often_than_one_can_read(clock):
    stream = Terminal()
    tell = Progress(work(), stream)
    for step in range(1, 1000):
        clock.now = step / 1000
        tell("rocking", step % 3, step / 2000)
    assert stream.getvalue().count("\r") == 4


def test_threads_tell_at_once(monkeypatch):
    monkeypatch.setattr(progress, "SLOWEST", -1.0)
    stream, count = Terminal(), 8
    tell = Progress(Work(tuple(np.array([at]) for at in range(count)), tuple(map(str, range(count)))), stream)

    def run(number):
        for step in range(200):
            tell("rocking", number, step / 200)
        tell("done", number, 1.0)

    threads = [threading.Thread(target=run, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    lines = stream.getvalue().split("\r\x1b[K")
    assert lines[0] == lines[-1] == ""
    assert all(
        re.fullmatch(r"Verifying: \d pieces? on \d floors? done of 8 pieces on 8 floors.*", one) for one in lines[1:-1]
    )
    assert len(lines) == count * 201 + 1


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.1, "1 s"), (1.6, "2 s"), (89, "89 s"), (95, "2 min"), (3600, "60 min")]
)
def test_times_are_rounded(seconds, text):
    assert progress._round(seconds) == text
