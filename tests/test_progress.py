"""Cancelling: it is obeyed in whatever the work is doing, leaves nothing behind, and the rest of the work ends soon."""

import threading
from contextlib import closing
from threading import Event

import matplotlib as mpl
import pytest

import assess
from assess.errors import CancelledError, InputError
from assess.i18n import gettext, load_catalogue, speaking
from assess.motion.formats import plain_csv, read_records
from assess.progress import SILENT, Progress, Report, check_waits
from assess.report.figures.draw import draw
from assess.report_formats import DEFAULT
from tests.waiting import PATIENCE
from tests.workbooks import UNVERIFIED, write

ROWS = 2000


class Blocked:
    """Work that sets a cancel, and then does not look at it until it is let go, as a compilation does."""

    def __init__(self, cancel: Event) -> None:
        self.cancel, self.released, self.ended = cancel, Event(), Event()
        self.threads: list[threading.Thread] = []

    def __call__(self, *_given, **_named):
        self.threads.append(threading.current_thread())
        self.cancel.set()
        self.released.wait(PATIENCE)
        try:
            check_waits()
        finally:
            self.ended.set()

    def close(self) -> None:
        self.released.set()
        for thread in self.threads:
            thread.join()


@pytest.fixture
def blocked():
    with closing(Blocked(Event())) as work:
        yield work


def _join() -> None:
    """Wait for work that was left behind."""
    for thread in threading.enumerate():
        if thread.name == "assess-aside":
            thread.join()


# ---------------------------------------------------------------- waiting


def test_nothing_is_begun_or_reported_after_a_cancel():
    for progress in (SILENT, Progress(print)):  # without an event work is just called
        assert progress.wait_for(threading.current_thread) is threading.current_thread()
    cancel, reports = Event(), list[Report]()
    progress = Progress(reports.append, cancel)
    rows = progress.checked(range(10))
    assert [next(rows), next(rows)] == [0, 1]
    with progress.stage("reading"):
        cancel.set()
        progress.tell(Report("reading", 0.5, "", None))
        with pytest.raises(CancelledError):
            next(rows)
        with pytest.raises(CancelledError):
            progress.wait_for(lambda: pytest.fail("it was begun"))
    assert [one.share for one in reports] == [0.0]


def test_work_aside_returns_raises_and_speaks_as_it_would_here():
    progress = Progress(cancel=Event())
    assert progress.wait_for(threading.current_thread) is not threading.current_thread()
    with speaking(load_catalogue("it")):
        assert progress.wait_for(lambda: gettext("Summary")) == gettext("Summary") != "Summary"
    error = InputError("no")
    with pytest.raises(InputError) as caught:
        progress.wait_for(lambda: (_ for _ in ()).throw(error))
    assert caught.value is error


def test_work_that_does_not_look_is_left_at_once_and_ends_at_its_next_look(blocked):
    with pytest.raises(CancelledError):
        Progress(cancel=blocked.cancel).wait_for(blocked)
    assert not blocked.ended.is_set()
    blocked.close()
    assert blocked.ended.is_set()
    check_waits()  # nobody has cancelled what this thread does


# ---------------------------------------------------------------- reading


def _after(number: int, real, cancel: Event, calls: list[int]):
    """Return `real`, which sets `cancel` on its call of a number."""

    def counted(*given):
        calls.append(1)
        if len(calls) == number:
            cancel.set()
        return real(*given)

    return counted


def test_a_long_record_of_plain_csv_is_not_read_to_its_end(tmp_path, monkeypatch):
    path, cancel, blocks = tmp_path / "long.csv", Event(), list[int]()
    lines = (f"{at / 100:.2f},{at % 7}" for at in range(ROWS))
    path.write_text("time [s],north [cm/s2]\n" + "\n".join(lines), encoding="utf-8")
    monkeypatch.setattr(plain_csv, "CHECKED_EVERY", 10)
    monkeypatch.setattr(plain_csv, "BLOCK", 100)
    (whole,) = read_records(path, progress=Progress(cancel=Event()))
    assert whole.acceleration.size == ROWS
    monkeypatch.setattr(plain_csv, "_read_block", _after(5, plain_csv._read_block, cancel, blocks))
    with pytest.raises(CancelledError):
        read_records(path, progress=Progress(cancel=cancel))
    _join()
    assert 5 <= len(blocks) <= 6


# ---------------------------------------------------------------- a run, reports


def test_work_is_left_in_its_midst_and_leaves_nothing(tmp_path, monkeypatch):
    """The checks of a workbook, a compilation, the end of a run, the packing of outcomes."""
    path, out, temporary = write(tmp_path / "w.xlsx"), tmp_path / "out", tmp_path / "temporary"
    inventory, results = assess.read_inventory(path), assess.run(path, UNVERIFIED)
    monkeypatch.setattr("assess.pipeline.run.make_folder", lambda *_: temporary.mkdir() or temporary)
    for place, work in {
        "assess.workbook.read._check": lambda one: assess.read_inventory(path, progress=Progress(cancel=one)),
        "assess.pipeline.run.verify": lambda one: assess.run(inventory, cancel=one, series_folder=out),
        "assess.pipeline.run.build_series": lambda one: assess.run(inventory, UNVERIFIED, cancel=one),
        "assess.report.data._pack_outcomes": lambda one: assess.write_reports(
            results, out, "npz", progress=Progress(cancel=one)
        ),
    }.items():
        blocked = Blocked(Event())
        with monkeypatch.context() as patch, closing(blocked):
            patch.setattr(place, blocked)
            with pytest.raises(CancelledError):
                work(blocked.cancel)
            assert not blocked.ended.is_set(), place
            assert [one.name for one in tmp_path.iterdir()] == ["w.xlsx"], place


def test_no_format_leaves_a_file(tmp_path, monkeypatch):
    """Cancelled at an early look of each format, whatever it is at."""
    results, out = assess.run(write(tmp_path / "w.xlsx"), UNVERIFIED), tmp_path / "out"
    for name in (*DEFAULT, "annex", "npz"):
        for number in (2, 4):
            cancel, looks = Event(), list[int]()
            progress = Progress(cancel=cancel)
            monkeypatch.setattr(progress, "check", _after(number, progress.check, cancel, looks))
            with pytest.raises(CancelledError):
                assess.write_reports(results, out, name, progress=progress)
            assert [path.name for path in tmp_path.iterdir()] == ["w.xlsx"], name


def test_a_figure_is_left_with_the_next_thing_put_into_it():
    before, cancel, put = dict(mpl.rcParams), Event(), []

    def paint(figure):
        axes = figure.subplots()
        for at in range(10):
            if at == 3:
                cancel.set()
            axes.plot([0, 1], [0, at])
            put.append(at)

    def paint_late(figure):
        figure.subplots().text(0.5, 0.5, "text")
        cancel.set()  # what is left is matplotlib's own work

    with pytest.raises(CancelledError):
        draw(3, 2, paint, progress=Progress(cancel=cancel))
    assert put == [0, 1, 2]
    cancel.clear()
    with pytest.raises(CancelledError):
        draw(3, 2, paint_late, progress=Progress(cancel=cancel))
    assert dict(mpl.rcParams) == before
    whole = draw(3, 2, lambda figure: figure.subplots(), progress=Progress(cancel=Event()))
    assert whole == draw(3, 2, lambda figure: figure.subplots())
