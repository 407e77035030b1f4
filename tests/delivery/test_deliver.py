"""Where a folder is exchanged, where its files are moved; failures, locks, and what killed runs leave."""

import contextlib
import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from assess.delivery import deliver as delivering
from assess.delivery import folder_lock
from assess.delivery.deliver import check_moves, deliver, exchange, save, saving, stage_for
from assess.delivery.folder_lock import FolderLock
from assess.delivery.stages import JOURNALS, NEW, PREFIX, staging, sweep
from assess.errors import CancelledError, InputError, OutputError
from assess.progress import Progress
from tests.delivery.killer import FRESH, OLD, fill, look


def _find_old(folder):
    return [name for name in OLD if (folder / name).is_file()]


def _deliver(folder, find_old=_find_old, **words):
    with stage_for(folder) as stage:
        fill(stage / NEW, FRESH)
        deliver(stage, folder, find_old, **words)


def _hidden(*folders):
    return [path.name for folder in folders for path in folder.iterdir() if path.name[0] == "."]


@pytest.fixture
def out(tmp_path):
    folder = tmp_path / "parent" / "out"
    folder.mkdir(parents=True)
    fill(folder, OLD)
    return folder


@pytest.fixture
def swaps(monkeypatch):
    """What came of each attempt to exchange a folder."""
    found, whole = list[bool](), delivering._swap

    def swap(*words):
        found.append(whole(*words))
        return found[-1]

    monkeypatch.setattr(delivering, "_swap", swap)
    return found


def test_a_folder_that_is_missing_appears_whole(tmp_path):
    _deliver(tmp_path / "a" / "b")
    assert look(tmp_path / "a" / "b") == FRESH
    assert _hidden(tmp_path, tmp_path / "a") == []
    assert (tmp_path / "a" / "b").stat().st_mode == (tmp_path / "a").stat().st_mode


@pytest.mark.skipif(sys.platform != "linux", reason="not every file system of macOS can exchange folders")
def test_a_folder_of_old_files_alone_is_exchanged(out, swaps):
    out.chmod(0o711)
    _deliver(out)
    assert (swaps, look(out), out.stat().st_mode & 0o777) == ([True], FRESH, 0o711)
    assert _hidden(out, out.parent) == []


@pytest.mark.skipif(sys.platform != "linux", reason="not every file system of macOS can exchange folders")
def test_a_link_to_a_folder_stays_a_link(out, swaps, tmp_path):
    link = tmp_path / "link"
    link.symlink_to(out)
    _deliver(link)
    assert (swaps, link.is_symlink(), look(out)) == ([True], True, FRESH)


def test_beside_a_file_of_the_users_the_files_are_moved(out, swaps):
    (out / "mine").mkdir()
    number = out.stat().st_ino
    _deliver(out)
    assert (swaps, look(out), out.stat().st_ino) == ([False], FRESH, number)
    assert (out / "mine").is_dir()
    assert _hidden(out, out.parent) == []


@pytest.mark.parametrize("who", ["this process", "another one"])
def test_a_folder_that_a_process_works_in_stays_where_it_is(out, swaps, monkeypatch, who):
    """A shell would be left in a folder that is gone."""
    if who == "this process":
        monkeypatch.chdir(out)
        _deliver(Path())
    elif not Path("/proc/self/cwd").exists():
        pytest.skip("not known here")
    else:
        with subprocess.Popen([sys.executable, "-c", "input()"], cwd=out, stdin=subprocess.PIPE) as process:
            _deliver(out)
            process.communicate(b"\n")
    assert (swaps, look(out)) == ([False], FRESH)


@pytest.mark.parametrize("why", ["system", "parent"])
def test_where_folders_cannot_be_exchanged_the_files_are_moved(out, monkeypatch, why):
    if why == "system":
        monkeypatch.setattr(delivering, "exchange", lambda *_: False)
    else:  # a parent in which nothing can be made
        whole = staging
        monkeypatch.setattr(delivering, "staging", lambda where: whole(where if where == out else where / "missing"))
    _deliver(out)
    assert look(out) == FRESH
    assert _hidden(out, out.parent) == []


def test_a_stage_on_another_file_system_is_copied(out, monkeypatch):
    (out / "mine.txt").write_text("mine")
    whole = Path.rename

    def rename(self, target):
        if self.parent.name == NEW:
            raise OSError(18, "Invalid cross-device link")
        return whole(self, target)

    monkeypatch.setattr(Path, "rename", rename)
    _deliver(out)
    assert look(out) == FRESH | {"mine.txt": "mine"}


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


@pytest.mark.skipif(sys.platform != "linux", reason="not every file system of macOS can exchange folders")
def test_a_file_that_comes_at_the_last_moment_is_kept(out, monkeypatch):
    def late(one, other):
        (out / "mine.txt").write_text("mine")
        return exchange(one, other)

    monkeypatch.setattr(delivering, "exchange", late)
    _deliver(out)
    assert look(out) == FRESH | {"mine.txt": "mine"}


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
    monkeypatch.setattr(folder_lock, "PATIENCE", 0.0)
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
    assert (out / folder_lock.FILE).exists() == (kind == "file")
    _deliver(out)
    assert look(out) == FRESH
    assert _hidden(out) == []


def test_runs_side_by_side_do_not_mix(tmp_path):
    """Threads exclude each other as processes do: whatever the order, the folder is of one of them."""
    names = [f"{at}.txt" for at in range(5)]

    def work(text):
        for _ in range(10):
            with stage_for(tmp_path / "out") as stage:
                fill(stage / NEW, dict.fromkeys(names, text))
                deliver(stage, tmp_path / "out", lambda folder: [path.name for path in folder.glob("*.txt")])
            if text == "a":  # from now on the files are moved
                (tmp_path / "out" / "mine").write_text("mine")

    threads = [threading.Thread(target=work, args=(text,)) for text in "abc"]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert look(tmp_path / "out") in [dict.fromkeys(names, text) | {"mine": "mine"} for text in "abc"]
    assert _hidden(tmp_path, tmp_path / "out") == []


def test_the_stage_of_a_living_process_is_left_and_that_of_a_dead_one_removed(tmp_path):
    (tmp_path / f"{PREFIX}dead" / NEW).mkdir(parents=True)
    (tmp_path / f"{PREFIX}mine.txt").write_text("mine")
    with staging(tmp_path) as stage:
        sweep(tmp_path)
        assert stage.is_dir()
        assert sorted(_hidden(tmp_path)) == sorted([stage.name, f"{PREFIX}mine.txt"])
    assert _hidden(tmp_path) == [f"{PREFIX}mine.txt"]


@pytest.mark.parametrize(
    "journal",
    [
        "", "[]", "{}", "null",
        {"about": "", "stage": f"{PREFIX}x", "new": {"../mine.txt": "0"}, "old": {}},
        {"about": "", "stage": f"{PREFIX}x", "new": {}, "old": {"/etc/hosts": "0"}},
        {"about": "", "stage": f"{PREFIX}x/../..", "new": {}, "old": {}},
        {"about": "", "stage": "out", "new": {}, "old": {}},
        {"about": "", "stage": f"{PREFIX}x", "new": {"link/mine.txt": "0"}, "old": {}},
        {"about": "", "stage": f"{PREFIX}x", "new": [], "old": {}},
        {"about": "", "stage": f"{PREFIX}x", "new": {"a": 1}, "old": {}},
    ],
)  # fmt: skip
@pytest.mark.parametrize("name", JOURNALS)
def test_a_journal_of_someone_else_leads_out_of_no_folder(tmp_path, out, name, journal):
    (tmp_path / "mine.txt").write_text("mine")
    (out / "link").symlink_to(tmp_path)
    (out / name).write_text(journal if isinstance(journal, str) else json.dumps(journal))
    with pytest.raises(InputError, match="is damaged: remove it, or choose another folder"):
        check_moves(out)
    assert (look(out), (tmp_path / "mine.txt").read_text()) == (OLD, "mine")


def test_a_file_that_was_changed_since_the_kill_stops_the_recovery(out):
    digest = "0" * 64
    journal = {"about": "", "stage": f"{PREFIX}x", "new": {"report.html": digest}, "old": {"report.html": digest}}
    (out / JOURNALS[0]).write_text(json.dumps(journal))
    with pytest.raises(InputError, match=r"html was changed while an earlier run was being finished\. Move"):
        _deliver(out)
    assert look(out) == OLD
    (out / "report.html").unlink()
    _deliver(out)
    assert look(out) == FRESH
