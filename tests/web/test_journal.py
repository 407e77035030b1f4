"""What is on the disk of a session at each moment at which its process or the server may be killed."""

import asyncio
import io
import json
import pickle
import tempfile
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from threading import Event

import pytest
from openpyxl import load_workbook
from starlette.requests import Request

from assess.bim.import_workbook import ImportedBuilding
from assess.delivery import folders
from assess.delivery.folders import FolderLock, sweep
from assess.errors import AssessError, OutputError
from assess.i18n import fill
from assess.web import importing
from assess.web.book import Book, ChangedOutsideError
from assess.web.endpoints import answer
from assess.web.frames import Call, Reply
from assess.web.front import Front
from assess.web.journal import TAKEN, Journal, put_back, set_aside
from assess.web.limits import HOSTED, OWN, PREFIX, Limits
from assess.web.request_errors import UNAVAILABLE, RequestError
from assess.web.server import Place, Server, bind
from assess.web.sessions import Session
from assess.web.users import User
from assess.web.workers import Process, WorkerGoneError, ask_own
from tests.waiting import wait_until
from tests.web.opened import edit
from tests.web.test_sessions import _visit
from tests.workbooks import write

HEIGHT = ("Items", 2, "height")


class Killed(BaseException):
    """The process ends here."""


@pytest.fixture
def folder(tmp_path):
    (own := tmp_path / "session-1").mkdir()
    return own


@pytest.fixture
def book(tmp_path, folder):
    book = Book.open_disk(write(tmp_path / "office.xlsx"))
    book.keep_in(Journal(folder))
    return book


def _read(book):
    sheet, at = book.sheets["Items"], book.sheets["Items"].place("height", 2)
    return book.snapshot().workbook.sheets[sheet.sheet.name].value(at)


def _read_bytes(data):
    sheet = load_workbook(io.BytesIO(data))["Items"]
    at = next(cell.column for cell in sheet[1] if str(cell.value).startswith("Height"))
    return sheet.cell(2, at).value


# ---------------------------------------------------------------- steps


def test_a_step_that_cannot_be_written_is_not_taken_and_leaves_nothing_behind(book, folder, monkeypatch):
    edit(book, (*HEIGHT, 151))
    edit(book, (*HEIGHT, 152))
    book.undo(book.version)
    before = book.state()

    class Full(io.FileIO):
        """A file on a disk that has room for five bytes."""

        def write(self, data):
            return super().write(data[:5])

    monkeypatch.setattr(Path, "open", lambda self, mode, buffering: Full(self, "ab"))
    acts = (
        lambda: edit(book, (*HEIGHT, 153)), lambda: book.undo(book.version), lambda: book.redo(book.version),
        lambda: book.change_rows(book.version, "Items", "delete", 3, 1),
    )  # fmt: skip
    for act in acts:
        with pytest.raises(RequestError, match="No space left") as raised:
            act()
        assert raised.value.status == UNAVAILABLE, "the page sends it again, and reads nothing anew"
        assert (book.state(), _read(book)) == (before, 151)
    monkeypatch.undo()
    book.redo(book.version)
    again = Book.restore(Journal(folder))
    assert (again.version, _read(again), again.state()) == (book.version, 152, book.state())


def test_a_line_that_a_kill_has_torn_does_not_count(book, folder):
    edit(book, (*HEIGHT, 151))
    (steps,) = folder.glob("steps-*")
    whole = steps.read_bytes()
    edit(book, (*HEIGHT, 152))
    added = steps.read_bytes()[len(whole) :]
    for end in range(len(added)):
        steps.write_bytes(whole + added[:end])
        again = Book.restore(Journal(folder))
        assert (again.version, _read(again), steps.read_bytes()) == (2, 151, whole)


def test_what_is_refused_is_not_written(book, folder):
    (steps,) = folder.glob("steps-*")
    for act in (
        lambda: book.edit(1, [["Items", 1, 0, "x"]], ""), lambda: book.edit(7, [], ""),
        lambda: book.change_rows(1, "Items", "delete", 1, 1), lambda: book.undo(1), lambda: book.redo(1),
    ):  # fmt: skip
        with suppress(AssessError):
            act()
    assert steps.read_bytes() == b""


# ---------------------------------------------------------------- the file of the user


def _kill_at(monkeypatch, book, what):
    """Save, in a process that is killed before `what` is noted, or before the file is replaced."""
    note = Journal.note

    def end(self, *step):
        if step[0] == what:
            raise Killed
        note(self, *step)
        if what == "replaced" and step[0] == "saving":
            raise Killed

    with monkeypatch.context() as context:
        context.setattr(Journal, "note", end)
        with pytest.raises(Killed):
            book.save()


def test_a_kill_after_the_file_was_replaced_is_no_change_by_another_program(book, folder, monkeypatch):
    edit(book, (*HEIGHT, 151))
    _kill_at(monkeypatch, book, "saved")
    assert _read_bytes(book.path.read_bytes()) == 151
    again = Book.restore(Journal(folder))
    state = again.state()
    assert (state["unsaved"], state["saved_version"], again.check_outside()) == (False, 2, False)
    assert again.write() == book.path.read_bytes()
    edit(again, (*HEIGHT, 152))
    again.save()
    assert _read_bytes(book.path.read_bytes()) == 152


def test_a_kill_before_the_file_is_replaced_leaves_it_to_be_saved(book, folder, monkeypatch):
    edit(book, (*HEIGHT, 151))
    for what in ("saving", "replaced"):
        _kill_at(monkeypatch, book, what)
        assert _read_bytes(book.path.read_bytes()) != 151
        again = Book.restore(Journal(folder))
        assert (again.state()["unsaved"], again.state()["saved_version"], again.check_outside()) == (True, 1, False)
    again.save()
    assert _read_bytes(book.path.read_bytes()) == 151
    assert not again.state()["unsaved"]


@pytest.mark.parametrize("moment", ["saved", "replaced", None])
def test_what_another_program_wrote_is_neither_overwritten_nor_taken_for_ours(book, folder, monkeypatch, moment):
    edit(book, (*HEIGHT, 151))
    if moment is None:
        book.save()
    else:
        _kill_at(monkeypatch, book, moment)
    theirs = Book.open_disk(book.path)
    edit(theirs, (*HEIGHT, 99))
    theirs.save()
    data = book.path.read_bytes()
    again = Book.restore(Journal(folder))
    assert (again.check_outside(), again.state()["unsaved"]) == (True, moment is not None)
    assert _read_bytes(again.write()) == 151
    edit(again, (*HEIGHT, 152))
    with pytest.raises(ChangedOutsideError):
        again.save()
    assert book.path.read_bytes() == data


def _refuse(*_given, **_named):
    raise OSError(28, "No space left")


def test_a_file_that_is_read_again_without_room_for_it_is_not_mixed_with_earlier_steps(book, folder, monkeypatch):
    edit(book, (*HEIGHT, 151))
    book.save()
    theirs = Book.open_disk(book.path)
    edit(theirs, (*HEIGHT, 99))
    theirs.save()
    with monkeypatch.context() as context:
        context.setattr(Path, "touch", _refuse)
        book.follow_outside()
    assert (_read(book), list(folder.iterdir())) == (99, [])
    edit(book, (*HEIGHT, 152))
    book.save()
    assert (_read_bytes(book.path.read_bytes()), list(folder.iterdir())) == (152, [])


def test_a_file_beside_the_workbook_that_cannot_be_noted_makes_no_version(book, folder, monkeypatch):
    edit(book, ("Floors", 2, "record_x", "a.smc"))
    with monkeypatch.context() as context:
        context.setattr(Journal, "note", _refuse)
        with pytest.raises(RequestError, match="No space left"):
            book.add_file("a.smc", b"x")
    edit(book, (*HEIGHT, 151))
    book.save()
    edit(book, (*HEIGHT, 152))
    again = Book.restore(Journal(folder))
    assert (again.version, again.state()["unsaved"], _read(again)) == (book.version, True, 152)


def test_a_journal_that_cannot_be_written_does_not_keep_the_file_from_being_saved(book, monkeypatch):
    edit(book, (*HEIGHT, 151))
    monkeypatch.setattr(Journal, "note", _refuse)
    book.save()
    assert (book.state()["unsaved"], _read_bytes(book.path.read_bytes())) == (False, 151)


# ---------------------------------------------------------------- requests that come again


def _post(session, path, **body):
    reply = answer(session, Call("POST", path, data=json.dumps(body).encode()))
    return reply.status_code, json.loads(reply.body)


def test_a_request_that_comes_again_after_a_kill_is_answered_again_and_taken_once(tmp_path, folder):
    session = Session(folder, tmp_path)
    session.take(Book.open_disk(write(tmp_path / "office.xlsx")))
    place = session.book.sheets["Items"].place("height", 2)
    assert place is not None
    cell = ["Items", *place]
    requests: list[tuple[str, dict[str, object]]] = [
        ("/api/edit", {"edits": [[*cell, "151 cm"]], "label": "typing"}), ("/api/undo", {}), ("/api/redo", {}),
        ("/api/rows", {"sheet": "Items", "do": "insert", "at": 3, "count": 2}),
    ]  # fmt: skip
    for at, (path, body) in enumerate(requests, 1):
        sent = {"id": f"request{at}", "version": at, **body}
        status, first = _post(session, path, **sent)
        assert (status, first["state"]["version"]) == (200, at + 1)
        session = Session(folder, tmp_path)
        session.restore()
        status, second = _post(session, path, **sent)
        assert status == 200
        assert {**second, "state": 0} == {**first, "state": 0}
        assert second["state"]["version"] == session.book.version == at + 1
        assert _post(session, path, **{**sent, "id": ""})[0] == 409
    _post(session, "/api/edit", id="other", version=5, edits=[[*cell, 99]])
    assert _post(session, path, **sent)[0] == 409  # more has changed since: the page has to read it again
    assert _post(session, "/api/undo", version=6)[1]["cells"] == [[*cell, 151]]


# ---------------------------------------------------------------- sessions of a server


def test_a_process_on_its_way_has_its_place(tmp_path):
    class Ready:
        is_gone = False

        def ask(self, _call):
            raise WorkerGoneError

    started, go_on = [], Event()

    def begin(folder):
        started.append(folder.name)
        go_on.wait()
        return Ready()

    async def come():
        users = []
        for name in ("ann", "ben"):
            (tmp_path / name).mkdir()
            users.append(User(tmp_path / name, begin))
        front = Front(Limits(users=2, workers=1, wait=0.0), lambda: users)
        first = asyncio.ensure_future(front._wake(users[0]))
        while not started:
            await asyncio.sleep(0)
        with pytest.raises(RequestError, match="Too many users are at work"):
            await front._wake(users[1])
        go_on.set()
        await first
        assert [one.is_awake for one in users] == [True, False]

    asyncio.run(come())
    assert started == ["ann"]


def test_what_a_page_asks_by_itself_wakes_a_process_that_was_killed_and_none_that_sleeps(folder):
    class Link:
        is_gone = False

        def ask(self, call):
            return Reply(200, [], json.dumps(call.path).encode())

        def close(self):
            self.is_gone = True

        kill = close

    started = []

    def start(_folder):
        started.append(Link())
        return started[-1]

    user = User(folder, start)
    front = Front(Limits(), lambda: [user])

    async def empty():
        return {"type": "http.request", "body": b"", "more_body": False}

    async def ask():
        scope = {"type": "http", "method": "GET", "path": "/api/state", "headers": [], "query_string": b""}
        return await front._answer(Request(scope, empty), user)

    async def come():
        await ask()
        started[-1].is_gone = True  # killed
        await ask()
        assert len(started) == 2
        user._end()
        await ask()
        assert len(started) == 2

    asyncio.run(come())


def test_bodies_of_requests_that_a_kill_has_left_are_removed_at_the_start(folder):
    for name in ("body-0123", "opened-0123"):
        (folder / name).write_bytes(b"x")
    User(folder, Process, stays=True)
    assert [one.name for one in folder.iterdir()] == ["opened-0123"]


def test_two_processes_never_have_one_session(tmp_path, folder):
    order = {"home": "", "limits": asdict(OWN), "language": "", "server": 0}
    first = Process(folder, order)
    ask_own(first, "hello")
    assert not FolderLock(folder).take()
    second = Process(folder, order)
    first.close()
    ask_own(second, "hello")
    assert not FolderLock(folder).take()
    second.close()
    assert FolderLock(folder).take()
    for one in (first, second):
        one._process.stdout.close()


def test_processes_that_do_not_end_are_killed_at_the_end_of_a_server_for_several(tmp_path):
    class Hung:
        is_gone = False

        def __init__(self):
            self.killed = Event()

        def ask(self, _call):
            self.killed.wait()
            raise WorkerGoneError

        def kill(self):
            self.killed.set()

        close = kill

    place = Place(allowed=("assess.test",), user_header="X-User", limits=replace(HOSTED, end=0.0))
    with bind(place) as listening:
        server = Server(listening, place, tmp_path, tmp_path)
        users = [server._keys.admit(_visit(name)) for name in ("ann", "ben")]
        for user in users:
            user.link = Hung()
        server._end()
    assert all(user.link.killed.is_set() for user in users)


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    (folder := tmp_path / "tmp").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def _leave(temporary, book, value, *, is_own=True):
    """Have a server be killed that had a workbook open, and a change of it."""
    session = Path(tempfile.mkdtemp(prefix=PREFIX)) / "session-1"
    session.mkdir()
    book.keep_in(Journal(session, is_own=is_own))
    if value:
        edit(book, (*HEIGHT, value))
    return session


def test_all_that_killed_servers_have_left_unsaved_waits_until_it_is_opened(tmp_path, temporary):
    paths = [write(tmp_path / f"{name}.xlsx") for name in "abc"]
    for path, values in zip(paths, ((151, 152), (153,), (None,)), strict=True):
        for value in values:
            _leave(temporary, Book.open_disk(path), value)
    _leave(temporary, Book.hold("held.xlsx", paths[0].read_bytes(), tmp_path), 154)
    _leave(temporary, Book.hold("user.xlsx", paths[0].read_bytes(), tmp_path), 155, is_own=False)
    in_use = FolderLock(_leave(temporary, Book.open_disk(paths[1]), 156).parent)
    assert in_use.take()
    for _ in range(2):  # each server does so at its start
        set_aside(None)
        sweep(temporary, PREFIX)
    assert len(list(temporary.glob(f"{PREFIX}*"))) == 1
    assert len(list(temporary.glob(f"{TAKEN}*/*"))) == 4

    def take(path):
        folder = Path(tempfile.mkdtemp(dir=tmp_path))
        return _read(Book.restore(Journal(folder))) if put_back(path, folder) else None

    claimed = next(one for one in temporary.glob(f"{TAKEN}*/*") if "held.xlsx" in (one / "book.json").read_text())
    lock = FolderLock(claimed.parent)
    assert lock.take()
    assert take(None) is None  # another server takes it at this moment
    lock.release()
    assert [take(None), take(None)] == [154, None]
    assert [take(paths[0]) for _ in range(3)] == [152, 151, None]
    assert [take(paths[1]), take(paths[1]), take(paths[2])] == [153, None, None]
    assert list(temporary.glob(f"{TAKEN}*")) == []


def test_a_process_of_a_killed_server_that_does_not_end_keeps_only_its_own_workbook(tmp_path, temporary, monkeypatch):
    monkeypatch.setattr(folders, "PATIENCE", 0.0)
    path = write(tmp_path / "a.xlsx")
    busy = FolderLock(_leave(temporary, Book.open_disk(path), 151))
    assert busy.take()
    with pytest.raises(OutputError, match="xlsx is still being saved"):
        set_aside(path)
    set_aside(write(tmp_path / "b.xlsx"))
    sweep(temporary, PREFIX)
    busy.release()
    (folder := tmp_path / "new").mkdir()
    assert put_back(path, folder)
    assert _read(Book.restore(Journal(folder))) == 151


def test_what_waits_and_has_lost_its_steps_keeps_no_workbook_closed(tmp_path, temporary):
    path = write(tmp_path / "a.xlsx")
    _leave(temporary, Book.open_disk(path), 151)
    set_aside(None)
    for steps in temporary.glob(f"{TAKEN}*/*/steps-*"):
        steps.unlink()
    (folder := tmp_path / "new").mkdir()
    assert not put_back(path, folder)
    assert folder.is_dir()


# ---------------------------------------------------------------- building models


def test_a_building_model_that_was_read_is_there_in_the_next_process_until_it_is_a_workbook(tmp_path, monkeypatch):
    found, asked = ImportedBuilding(source="m.ifc", items=({"item": "A"},), remarks=(fill("a remark"),)), []

    def read(*_args, **_named):
        asked.append(1)
        if len(asked) == 1:
            raise Killed
        return found

    monkeypatch.setattr("assess.bim.read_source.read_source", read)
    monkeypatch.setattr("threading.excepthook", lambda _args: None)  # of the thread that is killed
    (folder := tmp_path / "server" / "session-1").mkdir(parents=True)

    def begin_again():
        session = Session(folder, tmp_path)
        session.restore()
        wait_until(lambda: session.reading.state, lambda state: state == "done")
        return session

    session = Session(folder, tmp_path)
    session.read_model(b"model", "m.ifc")
    session.reading._thread.join()
    (left,) = folder.glob("import-*")
    assert {one.name for one in left.iterdir()} == {importing.SOURCE, importing.ORDER}
    session.reading._slot.release()  # the system does
    first = begin_again()
    assert (len(asked), first.reading.id) == (2, session.reading.id)
    assert {one.name for one in left.iterdir()} == {importing.FOUND, importing.ORDER}
    first.close()
    again = begin_again()
    assert (len(asked), again.reading.describe()["found"]) == (2, first.reading.describe()["found"])
    assert pickle.loads((left / importing.FOUND).read_bytes()) == found
    again.cancel_import()
    assert list(folder.glob("import-*")) == []
