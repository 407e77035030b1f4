"""The processes of sessions: what one user sends stands in nobody's way, and what is too much is refused with words."""

import io
import json
import re
import socket
import zipfile
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from threading import Event
from urllib.parse import urlsplit

import pytest

from tests.waiting import PATIENCE, wait_until
from tests.web import serving
from tests.web.model_reader import find_worker, linux
from tests.web.test_sessions import OPTIONS, _come
from tests.workbooks import write

MANY = 45
"""Requests that a user sends at once who wants all of the server."""


def _limit(**limits):
    return [word for name, value in limits.items() for word in ("--limit", f"{name}={value}")]


def _write_heavy(path, sheet):
    """Return a workbook of some hundred kB one sheet of which has millions of cells."""
    stream = io.BytesIO()
    with zipfile.ZipFile(write(path)) as old, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            data = old.read(name)
            if name.endswith(f"sheet{sheet}.xml"):
                rows = (b'<row r="%d">' % row + b"<c><v>1.5</v></c>" * 70 + b"</row>" for row in range(1, 60_000))
                cells = b"<sheetData>" + b"".join(rows) + b"</sheetData>"
                data = re.sub(rb"<sheetData>.*</sheetData>", cells, data, flags=re.DOTALL)
            new.writestr(name, data)
    return stream.getvalue()


def _measure(pid, name):
    """Return a number of the memory of a process [MB]."""
    return int(re.findall(rf"{name}:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())[0]) / 1024


def _open_line(client, head, data=b""):
    """Return a line on which a request was begun."""
    parts = urlsplit(client.base)
    headers = "".join(f"{name}: {value}\r\n" for name, value in ({"Host": parts.netloc} | client.headers).items())
    line = socket.create_connection((parts.hostname, parts.port), timeout=PATIENCE)
    line.sendall(f"{head}\r\n{headers}".encode() + data)
    return line


@pytest.mark.slow
def test_a_hostile_user_keeps_nobody_waiting(served, tmp_path):
    """Uploads that take long to be read, and JSON that does."""
    server = served(None, *OPTIONS)
    ann, ben = (_come(server, user)[0] for user in ("ann", "ben"))
    ben.send("/api/upload", "ben.xlsx", write(tmp_path / "ben.xlsx").read_bytes())
    heavy, deep = _write_heavy(tmp_path / "heavy.xlsx", 3), b'{"version": 1, "edits": [' + b"[]," * 1_300_000 + b"[]]}"
    with ThreadPoolExecutor(2 * MANY) as pool:
        asked = [pool.submit(ann.send, "/api/upload", "h.xlsx", heavy) for _ in range(MANY)]
        asked += [pool.submit(ann.request, "POST", "/api/edit", deep) for _ in range(MANY)]
        wait_until(lambda: any(one.done() for one in asked))
        for value in range(20):
            book = ben.get("/api/book").json()
            edits = [["Items", 2, 0, f"Z{value}"]]
            assert ben.post("/api/edit", {"version": book["version"], "edits": edits}).status == 200
            assert ben.get("/api/state").status == 200
            assert ben.get("/").status == 200
        assert not all(one.done() for one in asked)
        server.process.kill()
    statuses = {one.result().status for one in asked if one.exception() is None}
    assert 429 in statuses
    assert statuses <= {200, 404, 422, 429, 503}


@linux
@pytest.mark.slow
def test_bodies_that_are_being_sent_take_no_memory_of_the_server(served):
    server = served(None, *OPTIONS)
    ann, ben = (_come(server, user)[0] for user in ("ann", "ben"))

    before, lines, size = _measure(server.pid, "VmRSS"), [], 60 * 2**20
    for _ in range(16):
        lines.append(
            _open_line(ann, "POST /api/upload?name=a.xlsx HTTP/1.1", b"Content-Length: %d\r\n\r\n" % (size + 1))
        )
        lines[-1].setblocking(False)
    sent = dict.fromkeys(lines, 0)

    def send():
        for line in lines:
            try:
                while sent[line] < size:
                    sent[line] += line.send(b"x" * min(2**18, size - sent[line]))
            except BlockingIOError:
                continue
        return sorted(sent.values())

    wait_until(send, lambda now: now[-2] == size)  # two are in work; all others wait, and are not read
    assert ben.get("/api/start").status == 200
    assert sorted(sent.values())[-3] < size
    assert _measure(server.pid, "VmRSS") - before < 60
    for line in lines:
        line.close()
    wait_until(lambda: serving.list_named(server.folder.parent / "tmp", "body-"), lambda left: left == [])


def test_bodies_have_limits_by_their_address_however_they_are_sent(served_here):
    client = served_here().client
    small, edit = 64 * 2**10, 4 * 2**20
    paths = dict.fromkeys(("what-if", "undo", "redo", "save", "job", "start", "close", "nothing"), small) | {
        "edit": edit
    }
    for path, most in paths.items():
        for size, is_taken in ((most, True), (most + 1, False)):
            body = b" " * (size - 2) + b"{}"
            for data in (body, iter([body[:1000], body[1000:]])):
                reply = client.request("POST", f"/api/{path}", data)
                assert (reply.status != 413) is is_taken, (path, size)
    said = client.request("POST", "/api/undo", b" " * (small + 1)).json()["message"]
    assert said == "It is larger than 64 kB."


def test_few_requests_are_in_work_some_wait_and_edits_wait_for_none(served_here, tmp_path, monkeypatch):
    client, asked, go_on = served_here(write(tmp_path / "w.xlsx")).client, [], Event()
    answer = serving.LocalWorker.ask

    def hold(self, call):
        asked.append(call.path)
        if call.path == "/api/catalogue":
            go_on.wait()
        return answer(self, call)

    monkeypatch.setattr(serving.LocalWorker, "ask", hold)
    with ThreadPoolExecutor(30) as pool, ExitStack() as stack:
        stack.callback(go_on.set)
        slow = [pool.submit(client.get, "/api/catalogue") for _ in range(30)]
        wait_until(lambda: sum(one.done() for one in slow), lambda done: done == 8)
        assert {one.result().status for one in slow if one.done()} == {429}
        assert asked == ["/api/catalogue"] * 2
        edit = {"version": 1, "edits": [["Items", 2, 0, "Z9"]]}
        assert client.post("/api/edit", edit).status == 429  # it would have to wait, and too many do
        go_on.set()
        assert {one.result().status for one in slow} == {200, 429}
        go_on.clear()
        slow = [pool.submit(client.get, "/api/catalogue") for _ in range(10)]
        wait_until(lambda: asked[22:], lambda now: len(now) == 2)
        assert client.post("/api/edit", edit).status == 200
        go_on.set()
        assert {one.result().status for one in slow} == {200}


@pytest.mark.slow
def test_connections_that_keep_silent_are_closed(served):
    server = served(None, *_limit(silence=0.5))
    lines = [_open_line(server.client, "GET /api/state HTTP/1.1") for _ in range(50)]
    lines += [_open_line(server.client, "POST /api/edit HTTP/1.1", b"Content-Length: 50\r\n\r\n{") for _ in range(5)]
    parts = urlsplit(server.base)
    lines += [socket.create_connection((parts.hostname, parts.port), timeout=PATIENCE)]
    for line in lines:
        answer = b""
        with line:
            while part := line.recv(65536):
                answer += part
        assert answer == b"" or answer.split(b" ")[1] == b"408", answer
    assert server.client.get("/api/state").status == 200


@linux
@pytest.mark.slow
def test_a_request_that_takes_too_long_or_too_much_memory_is_ended_with_words(served, tmp_path):
    data, heavy = write(tmp_path / "w.xlsx").read_bytes(), _write_heavy(tmp_path / "heavy.xlsx", 3)
    server = served(None, *OPTIONS, *_limit(seconds=2))
    client = _come(server, "ann")[0]
    reply = client.send("/api/upload", "h.xlsx", heavy)
    assert (reply.status, reply.json()["message"]) == (503, "It takes more than 2 s, which is the limit here.")
    assert client.get("/api/book").status == 200  # of another process
    most = _measure(find_worker(server, b"assess.web.worker"), "VmPeak") + 60
    server.stop()
    server = served(None, *OPTIONS, *_limit(memory=most * 2**20))
    client = _come(server, "ann")[0]
    reply = client.send("/api/upload", "h.xlsx", heavy)
    assert reply.status in (422, 503)
    assert "memory" in reply.json()["message"]
    assert client.send("/api/upload", "w.xlsx", data).status == 200


def test_limits_that_cannot_be_are_refused_with_their_names(tmp_path):
    from assess.cli.command_open import _change_limits
    from assess.errors import InputError
    from assess.web.limits import HOSTED

    changed = _change_limits(HOSTED, ["users=3", "seconds=1.5", "memory=1e9"])
    assert (changed.users, changed.seconds, changed.memory, changed.workers) == (3, 1.5, 1e9, HOSTED.workers)
    for text in ("users", "users=", "users=0", "users=1.5", "seconds=-1", "seconds=nan", "colour=3"):
        with pytest.raises(InputError, match="NAME of users, workers") as found:
            _change_limits(HOSTED, [text])
        assert repr(text) in json.dumps(str(found.value.message)).replace('\\"', '"')
