"""Motions that floors share: the same numbers whether they are shared or made anew, and no more kept than allowed."""

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from assess.arrays import Single
from assess.errors import CancelledError
from assess.motion import shared_motions
from assess.motion.generate import CALIBRATED, build_generator
from assess.motion.kept import Kept
from assess.motion.noise import Phases
from assess.motion.shared_motions import SharedMotions, share_motions
from assess.motion.target import Grid, Target, recorded_target
from assess.progress import Progress
from tests.motion.motions import cut
from tests.waiting import PATIENCE

GRID = Grid(0.005, 1601)
TARGET = recorded_target(cut("b", 8, 16), GRID)


@pytest.fixture(autouse=True)
def nothing_kept(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Start from an empty store; return the list that grows with every generator that is built."""
    monkeypatch.setattr(shared_motions, "KEPT", Kept(shared_motions.KEPT.most))
    built: list[int] = []

    def count(*given, **named):
        built.append(1)
        return build_generator(*given, **named)

    monkeypatch.setattr(shared_motions, "build_generator", count)
    return built


def share(target: Target = TARGET, factor: float = 1.0, axis: str = "X", threads: int = 1) -> SharedMotions:
    return share_motions(target, Phases(GRID, 1, axis), factor=factor, threads=threads)


@cache
def alone(first: int, count: int) -> Single:
    """Return motions of a generator of their own; they are not changed here."""
    return build_generator(TARGET, GRID, seed=1, axis="X").realise(first, count)


@pytest.mark.slow
def test_shared_motions_are_those_made_alone(nothing_kept: list[int]) -> None:
    one, other = share(), share(factor=2.5)
    assert len(nothing_kept) == 1
    for first, count in ((0, CALIBRATED + 30), (3, 2), (CALIBRATED - 5, 50), (170, 7)):
        np.testing.assert_array_equal(one.realise(first, count), alone(first, count))
        np.testing.assert_array_equal(other.realise(first, count), alone(first, count) * np.float32(2.5))
    assert one.generator.fit == other.generator.fit
    np.testing.assert_array_equal(other.spectra.ordinates, one.spectra.ordinates * np.float32(2.5))
    np.testing.assert_allclose(other.spectra.target, 2.5 * one.spectra.target)


def test_neither_the_order_of_floors_nor_changes_to_what_is_handed_out_change_anything() -> None:
    late = share(factor=0.3).realise(120, 20), share(factor=4.0).realise(0, 140)
    shared_motions.KEPT.forget()
    early = share(factor=4.0).realise(0, 140), share(factor=0.3).realise(120, 20)
    np.testing.assert_array_equal(late[0], early[1])
    np.testing.assert_array_equal(late[1], early[0])
    kept = share().realise(0, 130)
    share().realise(0, 130)[:] = 0.0
    share().spectra.ordinates[:] = 0.0
    np.testing.assert_array_equal(share().realise(0, 130), kept)
    assert share().spectra.ordinates.all()


@pytest.mark.slow
def test_targets_axes_seeds_and_signs_that_differ_at_all_share_nothing(nothing_kept: list[int]) -> None:
    first = share().realise(0, 2)
    others = (
        replace(TARGET, pseudo=TARGET.pseudo * 1.0001),
        replace(TARGET, pfa=TARGET.pfa * 1.0001),
        replace(TARGET, pfv=TARGET.pfv * 1.0001),
        replace(TARGET, envelopes=replace(TARGET.envelopes, values=TARGET.envelopes.values**2)),
    )
    for built, other in enumerate(others, 2):
        assert not np.array_equal(share(other).realise(0, 2), first)
        assert len(nothing_kept) == built
    share(axis="Y")
    share_motions(TARGET, Phases(GRID, 2, "X"), factor=1.0)
    share_motions(TARGET, Phases(GRID, 1, "X", (1, 1, 1, -1, 1, 1, 1, 1, 1)), factor=1.0)
    assert len(nothing_kept) == 8
    share_motions(TARGET, Phases(GRID, 1, "X", (1,) * 9), factor=1.0)  # signs that turn nothing
    assert len(nothing_kept) == 8


def test_threads_that_ask_at_once_wait_for_one(nothing_kept: list[int]) -> None:
    with ThreadPoolExecutor(6) as pool:
        found = list(pool.map(lambda at: share(factor=1.0 + at % 2).realise(0, 120), range(12)))
    assert len(nothing_kept) == 1
    for at, motions in enumerate(found):
        np.testing.assert_array_equal(motions, alone(0, 120) * np.float32(1.0 + at % 2))


def test_whoever_waits_can_stop(monkeypatch: pytest.MonkeyPatch) -> None:
    begun, go_on, cancel = threading.Event(), threading.Event(), threading.Event()

    def slow(*given, **named):
        begun.set()
        go_on.wait(PATIENCE)
        return build_generator(*given, **named)

    monkeypatch.setattr(shared_motions, "build_generator", slow)
    with ThreadPoolExecutor(1) as pool:
        first = pool.submit(share)
        assert begun.wait(PATIENCE)
        cancel.set()
        with pytest.raises(CancelledError):
            share_motions(TARGET, Phases(GRID, 1, "X"), factor=1.0, progress=Progress(cancel=cancel))
        go_on.set()
        np.testing.assert_array_equal(first.result().realise(0, 3), alone(0, 3))


def test_a_failure_is_not_kept(nothing_kept: list[int]) -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        share_motions(TARGET, Phases(GRID, 1, "X"), factor=1.0, progress=Progress(cancel=cancel))
    np.testing.assert_array_equal(share().realise(0, 3), alone(0, 3))


@pytest.mark.slow
def test_no_more_is_kept_than_allowed(monkeypatch: pytest.MonkeyPatch, nothing_kept: list[int]) -> None:
    size = 2_000_000  # room for the first 100 motions of two targets, not of three
    monkeypatch.setattr(shared_motions.KEPT, "most", size)
    first = share().realise(0, 140)
    for by in (1.1, 1.2, 1.3):
        share(replace(TARGET, pfa=TARGET.pfa * by)).realise(0, 140)
        assert 0 < shared_motions.KEPT.nbytes <= size
    built = len(nothing_kept)
    np.testing.assert_array_equal(share().realise(0, 140), first)
    assert len(nothing_kept) == built + 1
    shared_motions.KEPT.forget()
    monkeypatch.setattr(shared_motions.KEPT, "most", 1000)  # what exceeds the room alone is made all the same
    np.testing.assert_array_equal(share().realise(0, 120), alone(0, 120))
    assert shared_motions.KEPT.nbytes == 0


def test_only_the_first_motions_of_many_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared_motions, "MOST_GROUPS", 6)
    found = share().realise(0, 180)
    assert shared_motions.KEPT.nbytes < 140 * GRID.count * 4
    np.testing.assert_array_equal(share().realise(100, 80), found[100:])
