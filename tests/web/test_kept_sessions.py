"""What a session holds outlives its process, and the server: a kill at any moment loses nothing that was answered."""

import os
import random
import signal
import threading
import time
from contextlib import suppress
from http.client import HTTPException

import pytest
from openpyxl import load_workbook

from tests.waiting import wait_until
from tests.web.model_reader import find_worker, linux
from tests.web.serving import Client, start
from tests.web.test_sessions import OPTIONS, _come
from tests.web.test_workers import _limit
from tests.workbooks import write

pytestmark = [pytest.mark.slow, linux]
KILLED, KILLED_ALL = 40, 10
"""How often the process of a session is killed, and with it the server."""
HEIGHT, WORKER = "height", b"assess.web.worker"


def _get(client, address):
    """Return an answer; a process that is killed twice in one request is asked again, as the page does."""
    return wait_until(lambda: client.get(address), lambda reply: reply.status != 503).json()


def _place(client):
    """Return where the height of the first piece stands."""
    items = next(one for one in _get(client, "/api/book")["sheets"] if one["name"] == "Items")
    return ["Items", 2, next(one["at"] for one in items["columns"] if one["field"] == HEIGHT)]


def _value(client, place):
    items = next(one for one in _get(client, "/api/book")["sheets"] if one["name"] == place[0])
    return dict(map(tuple, items["rows"]))[place[1]][place[2]]


def _edit(client, place, value):
    """Change a cell as the page does: after another version, or a process that ended, it looks and tries again."""
    while True:
        state = _get(client, "/api/state")["state"]
        body = {"version": state["version"], "server": state["server"], "edits": [[*place, value]], "label": "typing"}
        reply = client.post("/api/edit", body)
        if reply.status == 200:
            return reply.json()["state"]["version"]
        assert reply.status in (409, 503), reply.data
        if _value(client, place) == value:
            return None


def test_a_process_of_a_session_that_is_killed_at_any_moment_loses_nothing_and_can_undo(served, tmp_path):
    random.seed(18)
    path = write(tmp_path / "office.xlsx")
    server = served(path)
    client, ended = server.client, threading.Event()
    place = _place(client)
    before = _value(client, place)

    typed: list[int] = []

    def kill():
        """Kill it at any moment after an edit was answered, however long the process takes to start again."""
        for at in range(KILLED):
            wait_until(lambda at=at: len(typed) > at)
            time.sleep(random.random() / 4)
            if pid := find_worker(server, WORKER):
                with suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        ended.set()

    killer = threading.Thread(target=kill)
    killer.start()
    while not ended.is_set():
        typed.append(150 + len(typed) % 60)
        _edit(client, place, typed[-1])
        assert _value(client, place) == typed[-1]
    killer.join()
    assert len(typed) >= KILLED
    state = _get(client, "/api/state")["state"]
    for _ in range(min(len(typed), 150)):
        reply = client.post("/api/undo", {"version": state["version"], "server": state["server"]})
        assert reply.status == 200, reply.data
        state = reply.json()["state"]
        if not state["can_undo"]:
            break
    assert len(typed) > 150 or _value(client, place) == before
    last = _edit(client, place, 201) and 201
    wait_until(lambda: _get(client, "/api/state")["state"], lambda one: not one["unsaved"])
    server.stop()
    assert load_workbook(path)["Items"].cell(place[1], place[2] + 1).value == last


def test_a_server_that_is_killed_with_all_its_processes_loses_nothing(folders):
    random.seed(7)
    path = write(folders / "office.xlsx")
    value = 150
    for at in range(KILLED_ALL):
        server = start(path, "--no-browser", cwd=folders / "home", temporary=folders / "tmp")
        client = server.client
        place = _place(client)
        assert at == 0 or _value(client, place) == value, at
        until = time.monotonic() + random.random() * 1.5
        while time.monotonic() < until:
            value = 150 + (value - 149) % 60
            _edit(client, place, value)
        worker = find_worker(server, WORKER)
        for pid in random.sample([worker, server.pid], 2):
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        server.process.communicate()
    server = start(path, "--no-browser", cwd=folders / "home", temporary=folders / "tmp")
    assert _value(server.client, place) == value
    status, _, err = server.stop()
    assert (status, "Stopped" in err) == (0, True)
    assert load_workbook(path)["Items"].cell(place[1], place[2] + 1).value == value
    assert list((folders / "tmp").iterdir()) == []


def test_changes_of_a_killed_server_never_overwrite_what_another_program_wrote(folders):
    path = write(folders / "office.xlsx")
    server = start(path, "--no-browser", cwd=folders / "home", temporary=folders / "tmp")
    place = _place(server.client)
    _edit(server.client, place, 177)
    for pid in (find_worker(server, WORKER), server.pid):
        os.kill(pid, signal.SIGKILL)
    server.process.communicate()
    book = load_workbook(path)
    book["Items"].cell(place[1], place[2] + 1).value = 99
    book.save(path)
    server = start(path, "--no-browser", cwd=folders / "home", temporary=folders / "tmp")
    assert _value(server.client, place) == 99
    _, _, err = server.stop()
    assert load_workbook(path)["Items"].cell(place[1], place[2] + 1).value == 99
    kept = folders / "office-changes.xlsx"
    assert str(kept) in err or kept.exists() or "not been saved" not in err
    if kept.exists():
        assert load_workbook(kept)["Items"].cell(place[1], place[2] + 1).value == 177


def test_users_find_their_work_again_after_the_server_was_killed_or_their_process_slept(folders):
    options = [*OPTIONS, "--sessions", str(folders / "kept"), "--no-browser", "--port", "0"]
    sleeping = _limit(sleep=0.5, workers=1)
    server = start(*options, cwd=folders / "home", temporary=folders / "tmp")
    (ann, _), (ben, _) = _come(server, "ann"), _come(server, "ben")
    data = write(folders / "w.xlsx").read_bytes()
    for one in (ann, ben):
        assert one.send("/api/upload", "w.xlsx", data).status == 200
    place = _place(ann)
    version = _edit(ann, place, 166)
    os.kill(server.pid, signal.SIGKILL)
    server.process.communicate()

    server = start(*options, *sleeping, cwd=folders / "home", temporary=folders / "tmp")
    again = Client(server.base)
    again.headers |= {**ann.headers, "Cookie": f"assess-{again.port}={ann.headers['Cookie'].partition('=')[2]}"}
    assert again.get("/api/book").json()["version"] == version
    assert _value(again, place) == 166
    again.get("/api/state")
    wait_until(lambda: find_worker(server, WORKER), lambda found: not found)
    state = again.get("/api/state").json()["state"]
    assert (state["version"], find_worker(server, WORKER)) == (version, 0), "it sleeps on"
    other, _ = _come(server, "ben")
    assert _value(other, place) != 166  # the only process is that of the other user now
    reply = again.post("/api/undo", {"version": state["version"], "server": state["server"]})
    assert reply.status == 200, reply.data
    assert _value(again, place) == _value(other, place)
    status, _, err = server.stop()
    assert (status, "gone" in err) == (0, False)
    with suppress(HTTPException, OSError):
        ann.get("/")


def test_an_idle_process_ends_where_memory_is_short_and_its_workbook_is_there_again(folders):
    options = [*OPTIONS, "--no-browser", "--port", "0", *_limit(total=1)]
    server = start(*options, cwd=folders / "home", temporary=folders / "tmp")
    ann, _ = _come(server, "ann")
    assert ann.send("/api/upload", "w.xlsx", write(folders / "w.xlsx").read_bytes()).status == 200
    place = _place(ann)
    _edit(ann, place, 166)
    wait_until(lambda: find_worker(server, WORKER), lambda found: not found)
    assert _value(ann, place) == 166
    assert server.stop()[0] == 0
