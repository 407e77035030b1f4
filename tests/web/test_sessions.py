"""A server for several users: behind a proxy that names them, sessions apart; what a session may take."""

import tempfile
from pathlib import Path

import pytest
from starlette.requests import HTTPConnection

from assess.web.limits import Limits
from assess.web.request_errors import RequestError
from assess.web.sessions import Session
from assess.web.users import Keys, User
from tests.web.serving import Client, wait_for_job
from tests.workbooks import write

NAME = "assess.test"
OPTIONS = ("--allowed-host", NAME, "--user-header", "X-Remote-User")


def _come(server, user, **headers):
    """Return a client as the proxy hands on what a user's browser sends, and the answer to its first request."""
    client = Client(server.base)
    client.headers |= {"Host": NAME, "Origin": f"https://{NAME}", "X-Remote-User": user, **headers}
    reply = client.get("/")
    if cookie := reply.headers["set-cookie"]:
        client.headers["Cookie"] = cookie.split(";")[0]
    return client, reply


@pytest.mark.slow
def test_users_have_sessions_of_their_own(served, tmp_path):
    server = served(None, *OPTIONS)
    ann, first = _come(server, "ann", **{"X-Forwarded-Proto": "https"})
    assert first.headers["set-cookie"].endswith("; Secure")
    ben, _ = _come(server, "ben")
    assert ann.headers["Cookie"] != ben.headers["Cookie"]
    mine, other = (write(tmp_path / f"{name}.xlsx").read_bytes() for name in ("ann", "ben"))
    assert ann.send("/api/upload", "ann.xlsx", mine).status == 200
    assert ben.get("/api/book").json()["start"] is True
    assert ben.send("/api/upload", "ben.xlsx", other).json()["name"] == "ben.xlsx"
    assert ann.post("/api/job", {"verify": "none", "formats": ["json"]}).status == 200
    assert [ben.get("/api/job").json()[name] for name in ("job", "runs")] == [None, []]
    wait_for_job(ann)
    assert ben.get("/api/job/file/results.json").status == 404
    version = ann.get("/api/book").json()["version"]
    ann.post("/api/edit", {"version": version, "edits": [["Items", 2, 0, "Z9"]], "label": "edit"})
    assert ben.get("/api/download").data == other
    again, _ = _come(server, "ann")  # another browser of the same user
    assert again.get("/api/book").json()["name"] == "ann.xlsx"

    status, _, err = server.stop()
    assert status == 0
    assert "Changes of ann.xlsx were not downloaded and are gone." in err
    assert list((tmp_path / "tmp").iterdir()) == []


@pytest.mark.slow
def test_neither_a_cookie_nor_a_name_alone_lets_anyone_in(served):
    server = served(None, *OPTIONS)
    ann, _ = _come(server, "ann")
    ben, _ = _come(server, "ben")
    assert ann.get("/api/state").status == 200
    for headers in (
        {"X-Remote-User": None}, {"X-Remote-User": ""}, {"X-Remote-User": " "}, {"X-Remote-User": "ben"},
        {"X-Remote-User": "x" * 300}, {"Cookie": None}, {"Cookie": ben.headers["Cookie"]},
    ):  # fmt: skip
        assert ann.get("/api/state", **headers).status == 401, headers
    for host in (f"127.0.0.1:{ann.port}", f"{NAME}:{ann.port}", "other.test"):
        assert ann.get("/api/state", Host=host).status == 421
    assert ann.post("/api/close", Origin="https://other.test").status == 403
    _, reply = _come(server, "")
    assert (reply.status, reply.headers["set-cookie"]) == (401, None)
    start = ann.post("/api/start", {"kind": "template", "use": "Office", "name": "new.xlsx"}).json()
    assert start["mode"] == "held"  # nothing is made on the disk of the server
    assert list((server.folder).iterdir()) == []


def _start(_folder):
    raise NotImplementedError


@pytest.fixture
def make(tmp_path):
    return lambda: User(Path(tempfile.mkdtemp(dir=tmp_path)), _start)


def _visit(user, cookie=""):
    names = (user,) if isinstance(user, str) else user
    headers = [(b"cookie", f"assess-80={cookie}".encode()), *((b"x-user", name.encode()) for name in names)]
    return HTTPConnection({"type": "http", "path": "/", "query_string": b"", "headers": headers})


def test_a_name_that_comes_twice_is_not_the_proxys_and_sessions_and_their_files_are_limited(make, tmp_path):
    """A proxy that adds its header to the one of the browser lets that one name anybody."""
    keys = Keys("X-User", 80, make)
    assert keys.admit(_visit(("ann", "ben"))) is None
    session = keys.admit(_visit("ann"))
    assert keys.find(_visit("ann", session.key)) is session
    assert keys.find(_visit(("ann", "ann"), session.key)) is None
    keys = Keys("X-User", 80, make, Limits(users=2, idle=100.0))
    ann, ben = (keys.admit(_visit(user)) for user in ("ann", "ben"))
    with pytest.raises(RequestError, match="Too many users") as found:
        keys.admit(_visit("cat"))
    assert found.value.status == 429
    (ann.folder / "file").write_bytes(b"x")
    ben.seen = ann.seen + 60
    keys.expire(ann.seen + 101)
    assert keys.users() == (ben,)
    assert not ann.folder.exists()
    assert keys.find(_visit("ann", ann.key)) is None
    assert keys.admit(_visit("cat")) is not None
    data = write(tmp_path / "w.xlsx").read_bytes()
    own = Session(Path(tempfile.mkdtemp(dir=tmp_path)), limits=Limits(bytes=4 * len(data) + 1000))
    own.hold("w.xlsx", data)
    (own.folder / "more").write_bytes(data)
    (own.book.folder / "plan.png").write_bytes(data)
    with pytest.raises(RequestError, match="have more than") as found:
        own.hold("other.xlsx", data * 2)
    assert found.value.status == 429
    assert own.book.name == "w.xlsx"
    own.hold("again.xlsx", data)  # in place of the first, whose folder is removed
    assert len(list(own.folder.glob("files-*"))) == 1
