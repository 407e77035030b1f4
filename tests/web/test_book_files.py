"""The file of a workbook on the disk, and the files that it names: nothing of the user's is lost or replaced."""

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from assess.errors import InputError, OutputError, WorkbookError
from assess.web.book import Book, ChangedOutsideError
from assess.workbook.lists import PLACES
from assess.workbook.read import read_inventory
from tests.pictures import picture
from tests.web.opened import write_template

HEIGHT = PLACES["Items", "height"]
ROWS = {
    "Building": [{"logo": "logo.png", "ground_pga": 0.2}],
    "Floors": [{"floor": "1", "record_x": "records/a.smc#1; records/a.smc", "plan": "plan 1.png"},
               {"floor": "2", "pfa_x": 0.2, "plan": "../outside.png"}],
    "Items": [{"item": "A1", "floor": "1", "breadth": 40, "height": 180, "photo": "p.png"},
              {"item": "A2", "floor": "1", "breadth": 40, "height": 180, "photo": "p.png"}],
}  # fmt: skip
PLAIN = {
    "Floors": [{"floor": "1", "pfa_x": 0.3}],
    "Items": [{"item": name, "floor": "1", "breadth": 40, "height": 180} for name in ("A1", "A2")],
}
RECORD = Path(__file__).parents[2] / "inventories" / "records" / "575-market" / "891018_1.cra-1.0210a.smc"


@pytest.fixture
def path(tmp_path):
    """A workbook that names no files, in a folder of its own."""
    (tmp_path / "own").mkdir()
    return write_template(tmp_path / "own" / "office.xlsx", PLAIN)


@pytest.fixture
def named(path):
    """One that names files, which are missing."""
    return write_template(path, ROWS)


def set_height(book, value, row=2):
    return book.edit(book.version, [["Items", row, HEIGHT, value]], "test")


def heights(path):
    return [item.height for item in read_inventory(path, strict=False).items]


def test_a_save_replaces_the_file_and_can_be_undone(path):
    path.chmod(0o640)
    filled, book = path.read_bytes(), Book.open_disk(path)
    set_height(book, 150)
    assert book.state()["unsaved"]
    assert path.read_bytes() == filled
    book.save()
    assert not book.state()["unsaved"]
    assert heights(path) == [1.5, 1.8]
    assert path.stat().st_mode & 0o777 == 0o640
    assert path.read_bytes() == book.write()
    book.undo(book.version)
    assert book.state()["unsaved"]
    book.save()
    assert heights(path) == [1.8, 1.8]
    book.redo(book.version)
    set_height(book, 120, row=3)
    book.save()
    assert heights(path) == [1.5, 1.2]
    assert [one.name for one in path.parent.iterdir()] == ["office.xlsx"]  # no other file is left


@pytest.mark.skipif(not hasattr(os, "setxattr"), reason="attributes of files are those of Linux")
def test_a_save_keeps_owner_group_and_attributes(path):
    path.chmod(0o664)
    try:
        os.setxattr(path, "user.project", b"school")
    except OSError:
        pytest.skip("this file system keeps no attributes")
    if os.geteuid() == 0:  # saved by another user
        os.chown(path, 1234, 2345)
    before = path.stat()
    book = Book.open_disk(path)
    set_height(book, 150)
    book.save()
    after = path.stat()
    assert (after.st_uid, after.st_gid, after.st_mode) == (before.st_uid, before.st_gid, before.st_mode)
    assert os.getxattr(path, "user.project") == b"school"
    assert after.st_mtime_ns > before.st_mtime_ns


def test_nothing_to_save_writes_nothing_and_edits_while_it_is_saved_are_not_lost(path):
    before = path.stat()
    book = Book.open_disk(path)
    book.save()
    set_height(book, 150)
    book.undo(book.version)
    book.save()
    assert (path.stat().st_mtime_ns, path.stat().st_ino) == (before.st_mtime_ns, before.st_ino)
    # Three that save and one that edits: what is edited is in the file, or counts as unsaved.
    book = Book.open_disk(path)
    with ThreadPoolExecutor(3) as pool:
        savers = []
        for height in range(100, 112):
            set_height(book, height, row=2 + height % 2)
            savers.append(pool.submit(book.save))
            if height % 5 == 0:
                book.undo(book.version)
        for one in savers:
            one.result()
    held = [item.height for item in book.snapshot().inventory.items]
    assert book.state()["unsaved"] == (heights(path) != held)
    book.save()
    assert not book.state()["unsaved"]
    assert heights(path) == held


def test_a_link_stays_its_file_is_replaced_and_what_a_killed_save_left_is_removed(path, tmp_path):
    left = path.parent / ".assess-writing-left"
    (left / "new").mkdir(parents=True)
    (left / "new" / path.name).write_bytes(path.read_bytes())
    link = tmp_path / "link.xlsx"
    link.symlink_to(path)
    book = Book.open_disk(link)
    set_height(book, 150)
    book.save()
    assert link.is_symlink()
    assert heights(path) == [1.5, 1.8]
    assert [one.name for one in path.parent.iterdir()] == ["office.xlsx"]


def test_a_file_that_was_changed_outside_is_left(path):
    filled, book = path.read_bytes(), Book.open_disk(path)
    set_height(book, 150)
    os.utime(path, ns=(1, 1))
    assert not book.check_outside()  # touched, not changed
    other = Book.open_disk(path)
    set_height(other, 120, row=3)
    other.save()
    theirs = path.read_bytes()
    for _ in range(2):
        with pytest.raises(ChangedOutsideError, match=r"office\.xlsx was changed by another program"):
            book.save()
    assert path.read_bytes() == theirs
    assert book.check_outside()
    assert book.state()["changed_outside"]
    assert book.state()["unsaved"]  # what was edited is still there
    book.undo(book.version)
    book.save()  # nothing to save
    assert book.state()["changed_outside"]
    version = book.version
    book.reload()
    assert book.version > version
    assert [item.height for item in book.snapshot().inventory.items] == [1.8, 1.2]
    state = book.state()
    assert not any(state[name] for name in ("unsaved", "changed_outside", "can_undo", "can_redo", "save_error"))
    set_height(book, 160)
    book.save()
    assert heights(path) == [1.6, 1.2]
    path.write_bytes(filled)
    assert book.check_outside()
    path.write_bytes(book.write())
    assert not book.check_outside()


def test_a_reload_of_what_is_no_workbook_changes_nothing(path):
    book = Book.open_disk(path)
    set_height(book, 150)
    path.write_bytes(b"no workbook")
    with pytest.raises(WorkbookError):
        book.reload()
    assert book.state()["can_undo"]
    assert book.snapshot().inventory.items[0].height == 1.5
    with pytest.raises(ChangedOutsideError):
        book.save()


def test_a_file_that_cannot_be_written_loses_nothing(path, monkeypatch):
    def refuse(*_):
        raise OSError(28, "No space left on device")

    filled, book = path.read_bytes(), Book.open_disk(path)
    set_height(book, 150)
    with monkeypatch.context() as patch:
        patch.setattr("assess.web.disk_file.os.fsync", refuse)
        book.save()
    assert "No space left on device" in book.state()["save_error"]
    assert path.read_bytes() == filled
    assert [one.name for one in path.parent.iterdir()] == ["office.xlsx"]
    path.chmod(0o444)
    book.save()
    assert "office.xlsx is read-only" in book.state()["save_error"]
    path.chmod(0o644)
    path.rename(path.with_name("moved.xlsx"))
    book.save()
    assert "no longer in its folder" in book.state()["save_error"]
    assert book.state()["unsaved"]
    assert not path.exists()
    assert not book.check_outside()
    path.with_name("moved.xlsx").rename(path)
    book.save()
    assert book.state()["save_error"] == ""
    assert heights(path) == [1.5, 1.8]


def test_missing_files_are_listed_and_none_is_replaced_or_added_that_the_workbook_does_not_name(named, tmp_path):
    missing = {one["name"]: one for one in Book.open_disk(named).describe()["missing"]}
    lines = {one["field"]: one["row"] for one in Book.open_disk(named).describe()["sheets"][0]["columns"]}
    photo = PLACES["Items", "photo"]
    assert {name: one["kind"] for name, one in missing.items()} == {
        "logo.png": "logo", "plan 1.png": "plan", "records/a.smc": "record", "p.png": "photo",
    }  # fmt: skip
    assert missing["p.png"]["cells"] == [["Items", 2, photo], ["Items", 3, photo]]
    assert missing["records/a.smc"]["cells"] == [["Floors", 2, PLACES["Floors", "record_x"]]]
    assert missing["logo.png"]["cells"] == [["Building", lines["logo"], 1]]
    book, before = Book.open_disk(named), sorted(tmp_path.rglob("*"))
    for name in ("other.png", "../outside.png", "office.xlsx", "/etc/passwd", "", "p.png\x00", "P.PNG"):
        with pytest.raises(InputError):
            book.add_file(name, b"x")
    assert sorted(tmp_path.rglob("*")) == before
    (named.parent / "p.png").write_bytes(b"theirs")
    with pytest.raises(InputError):
        book.add_file("p.png", b"x")
    assert (named.parent / "p.png").read_bytes() == b"theirs"
    (named.parent / "records").write_bytes(b"a file where the folder belongs")
    with pytest.raises((OutputError, InputError)):
        book.add_file("records/a.smc", b"x")
    (named.parent / "logo.png").symlink_to(tmp_path / "elsewhere.png")  # leads out of the folder
    with pytest.raises(InputError):
        book.add_file("logo.png", b"x")
    assert not (tmp_path / "elsewhere.png").exists()


@pytest.mark.parametrize("mode", ["disk", "held"])
def test_a_missing_file_is_taken_in(named, tmp_path, mode):
    folder = named.parent if mode == "disk" else tmp_path / "private"
    folder.mkdir(exist_ok=True)
    book = Book.open_disk(named) if mode == "disk" else Book.hold("office.xlsx", named.read_bytes(), folder)
    assert book.mode == mode
    assert not book.snapshot().inventory.items
    version = book.version
    book.add_file("records/a.smc", RECORD.read_bytes())
    book.add_file("p.png", picture("PNG"))
    assert book.version == version + 2
    assert (folder / "records" / "a.smc").read_bytes() == RECORD.read_bytes()
    assert {one["name"] for one in book.describe()["missing"]} == {"logo.png", "plan 1.png"}
    assert {*book.snapshot().inventory.photos} == {"p.png"}
    assert not book.state()["unsaved"]
    column = PLACES["Floors", "plan"]
    found = book.edit(book.version, [["Floors", 2, column, None], ["Floors", 3, column, None]], "clear")
    assert {one["name"] for one in found["missing"]} == {"logo.png"}
    assert [one.name for one in book.snapshot().inventory.floors[0].records["X"]] == [
        "records/a.smc#1", "records/a.smc",
    ]  # fmt: skip
