"""How files come to their place; failures, locks, and what killed runs leave."""

import contextlib
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from assess.delivery import folders
from assess.delivery.deliver import deliver, is_unfinished, name_aside, save, saving, stage_for
from assess.delivery.folders import NEW, PREFIX, FolderLock, staging, sweep
from assess.errors import CancelledError, InputError, OutputError
from assess.progress import Progress
from tests.delivery.killer import DATA, FRESH, OLD, fill, find_old, look


def _deliver(folder, find=find_old, **words):
    with stage_for(folder) as stage:
        fill(stage / NEW, FRESH)
        return deliver(stage, folder, find, DATA, **words)


def _hidden(*folders):
    return [path.name for folder in folders for path in folder.iterdir() if path.name[0] == "."]


@pytest.fixture
def out(tmp_path):
    folder = tmp_path / "parent" / "out"
    folder.mkdir(parents=True)
    fill(folder, OLD)
    return folder


def test_a_folder_that_is_missing_appears_whole(tmp_path):
    _deliver(tmp_path / "a" / "b")
    assert look(tmp_path / "a" / "b") == FRESH
    assert _hidden(tmp_path, tmp_path / "a") == []
    assert (tmp_path / "a" / "b").stat().st_mode == (tmp_path / "a").stat().st_mode


@pytest.mark.parametrize("place", ["itself", "a link", "the working folder"])
def test_files_are_moved_into_the_folder_and_nothing_else_is_touched(out, tmp_path, monkeypatch, place):
    (out / "mine").mkdir()
    (out / "mine.txt").write_text("mine")
    number, folder = out.stat().st_ino, out
    if place == "a link":
        folder = tmp_path / "link"
        folder.symlink_to(out)
    elif place == "the working folder":
        monkeypatch.chdir(out)
        folder = Path()
    assert _deliver(folder) == ["gone.pdf"]
    assert (look(out), out.stat().st_ino) == (FRESH | {"mine.txt": "mine"}, number)
    assert (out / "mine").is_dir()
    assert _hidden(out, out.parent) == []


def test_a_folder_that_was_left_unfinished_is_known_and_completed(out):
    old, new = name_aside(DATA)
    (out / DATA).rename(out / old)
    (out / new).write_text("new")
    (out / "added.xlsx").write_text("new")
    assert is_unfinished(out, DATA)
    _deliver(out)
    assert (look(out), is_unfinished(out, DATA)) == (FRESH, False)
    assert _hidden(out) == []


@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("failing", sorted(FRESH))
def test_a_move_that_fails_takes_all_back(out, monkeypatch, failing, links):
    (out / "mine.txt").write_text("mine")
    before, whole = look(out), Path.replace

    def replace(self, target):
        if self.name == failing and self.parent.name == NEW:
            raise PermissionError(13, "open in another program", str(self), None, str(target))
        return whole(self, target)

    def link(*_):
        raise PermissionError(1, "no links here")

    monkeypatch.setattr(Path, "replace", replace)
    if not links:
        monkeypatch.setattr(os, "link", link)
    with pytest.raises(PermissionError, match="open in another program"):
        _deliver(out)
    assert look(out) == before
    assert _hidden(out, out.parent) == []


def test_what_is_in_the_way_at_the_end_leaves_all_as_it_was(out):
    def refuse(_):
        raise InputError("mine")

    with pytest.raises(InputError):
        _deliver(out, refuse)
    assert look(out) == OLD
    (out / "added.xlsx").mkdir()
    with pytest.raises(IsADirectoryError):
        _deliver(out)
    assert look(out) == OLD
    assert _hidden(out, out.parent) == []


# ---------------------------------------------------------------- some files


def test_files_of_several_folders_come_together_or_not_at_all(tmp_path, monkeypatch):
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "one").write_text("old")
    files = {tmp_path / "a" / "one": b"new", tmp_path / "a" / "two": b"new", tmp_path / "b" / "c" / "three": b"new"}
    with monkeypatch.context() as patch:
        whole = Path.replace

        def replace(self, target):
            if self.name == "three":
                raise PermissionError(13, "no", str(self), None, str(target))
            return whole(self, target)

        patch.setattr(Path, "replace", replace)
        with pytest.raises(PermissionError):
            save(files)
    assert look(tmp_path / "a") == {"one": "old"}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a"]
    save(files)
    assert look(tmp_path / "a") == {"one": "new", "two": "new"}
    assert look(tmp_path / "b" / "c") == {"three": "new"}
    assert _hidden(tmp_path, tmp_path / "a", tmp_path / "b" / "c") == []


def test_a_file_that_is_not_finished_does_not_appear(tmp_path):
    (tmp_path / "book.xlsx").write_text("old")
    with contextlib.suppress(ZeroDivisionError), saving(tmp_path / "book.xlsx") as path:
        path.write_text("half")
        raise ZeroDivisionError
    assert look(tmp_path) == {"book.xlsx": "old"}
    with saving(tmp_path / "book.xlsx") as path:
        path.write_text("new")
    assert look(tmp_path) == {"book.xlsx": "new"}
    assert _hidden(tmp_path) == []


# ---------------------------------------------------------------- two runs, and killed ones


def lock_files_alone():
    """Have locks as on a system that locks no folders."""
    whole = FolderLock._open

    def open_file(self, path):
        if path == self._folder:
            raise PermissionError(13, "no folders")
        return whole(self, path)

    setattr(FolderLock, "_open", open_file)  # noqa: B010 - as type checkers allow it


@pytest.fixture(params=["folder", "file"])
def lock_of(request, monkeypatch):
    """The lock of a system that locks folders, and of one that locks files alone."""
    monkeypatch.setattr(FolderLock, "_open", FolderLock._open)  # put back at the end
    if request.param == "file":
        lock_files_alone()
    return FolderLock


def test_a_lock_is_held_by_one(tmp_path, lock_of):
    one, other = lock_of(tmp_path), lock_of(tmp_path)
    assert one.take()
    assert not other.take()
    other.release()
    one.release()
    assert other.take()
    other.release()
    assert _hidden(tmp_path) == []


def test_a_folder_in_use_is_named(out, lock_of, monkeypatch):
    monkeypatch.setattr(folders, "PATIENCE", 0.0)
    lock = lock_of(out)
    assert lock.take()
    try:
        with pytest.raises(OutputError, match=r"out is in use: another run is writing to it\. Wait"):
            _deliver(out)
        cancel = threading.Event()
        cancel.set()
        with pytest.raises(CancelledError):
            _deliver(out, progress=Progress(cancel=cancel))
    finally:
        lock.release()
    assert look(out) == OLD
    _deliver(out)
    assert look(out) == FRESH


HOLD = """
import sys
from pathlib import Path
from tests.delivery.test_deliver import FolderLock, lock_files_alone
if sys.argv[2] == "file":
    lock_files_alone()
lock = FolderLock(Path(sys.argv[1]))
print(lock.take(), flush=True)
input()
"""


def test_the_lock_of_a_killed_process_does_not_hold(out, lock_of, request):
    """On a system that locks files, that of the killed process is left until the next run."""
    kind = request.node.callspec.params["lock_of"]
    root = Path(__file__).parents[2]
    with subprocess.Popen(
        [sys.executable, "-c", HOLD, out, kind], cwd=root, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            assert process.stdout.readline() == "True\n"
            assert not lock_of(out).take()
        finally:
            process.kill()
            process.communicate()
    assert (out / folders.FILE).exists() == (kind == "file")
    _deliver(out)
    assert look(out) == FRESH
    assert _hidden(out) == []


def test_runs_side_by_side_do_not_mix(tmp_path):
    """Threads exclude each other as processes do: whatever the order, the folder is of one of them."""
    names = [*(f"{at}.txt" for at in range(5)), DATA]

    def work(text):
        for _ in range(10):
            with stage_for(tmp_path / "out") as stage:
                fill(stage / NEW, dict.fromkeys(names, text))
                deliver(stage, tmp_path / "out", lambda folder: [one for one in names if (folder / one).exists()], DATA)

    threads = [threading.Thread(target=work, args=(text,)) for text in "abc"]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert look(tmp_path / "out") in [dict.fromkeys(names, text) for text in "abc"]
    assert _hidden(tmp_path, tmp_path / "out") == []


def test_the_stage_of_a_living_process_is_left_and_that_of_a_dead_one_removed(tmp_path):
    (tmp_path / f"{PREFIX}dead" / NEW).mkdir(parents=True)
    (tmp_path / f"{PREFIX}mine.txt").write_text("mine")
    with staging(tmp_path) as stage:
        sweep(tmp_path)
        assert stage.is_dir()
        assert sorted(_hidden(tmp_path)) == sorted([stage.name, f"{PREFIX}mine.txt"])
    assert _hidden(tmp_path) == [f"{PREFIX}mine.txt"]
