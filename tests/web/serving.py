"""The page as users have it: the command in a process of its own, or its server here; a client of its requests."""

import http.client
import json
import os
import re
import signal
import subprocess
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Thread, Timer
from urllib.parse import quote, urlsplit

from assess.delivery.folders import private_folder
from assess.web.limits import PREFIX
from assess.web.server import Place, Server, bind
from assess.web.worker import Worker
from tests.waiting import PATIENCE, wait_until

ADDRESS = re.compile(r"https?://\S+")


@dataclass
class Reply:
    status: int
    headers: http.client.HTTPMessage
    data: bytes

    def json(self):
        return json.loads(self.data)


class Client:
    """Sends requests as the page does: with the cookie and what a browser says of itself; each can be overwritten."""

    def __init__(self, base, cookie=""):
        parts = urlsplit(base)
        self.base, self.host, self.port = base, parts.hostname, parts.port
        self.headers = {"Origin": base, "Sec-Fetch-Site": "same-origin", "X-Assess": "1"}
        if cookie:
            self.headers["Cookie"] = cookie

    def request(self, method, path, body=None, headers=None):
        """Send a request; a header that is None is left out."""
        said = {name: value for name, value in (self.headers | (headers or {})).items() if value is not None}
        connection = http.client.HTTPConnection(self.host, self.port, timeout=PATIENCE)
        try:
            connection.request(method, path, body, said)
            answer = connection.getresponse()
            return Reply(answer.status, answer.headers, answer.read())
        finally:
            connection.close()

    def get(self, path, **headers):
        return self.request("GET", path, headers=headers)

    def post(self, path, body=None, **headers):
        return self.request("POST", path, json.dumps(body or {}), headers)

    def send(self, path, name, data):
        return self.request("POST", f"{path}?name={quote(name)}", data)


@dataclass
class Opened:
    """A page that is served: its address, which serves once, and a client that enters when it is first asked for."""

    url: str
    folder: Path
    entered: Client | None = None

    @property
    def pid(self):
        """The process that answers."""
        return os.getpid()

    @property
    def base(self):
        return "{0.scheme}://{0.netloc}".format(urlsplit(self.url))

    @property
    def client(self):
        if self.entered is None:
            self.entered = enter(self.url)
        return self.entered


@dataclass
class Served(Opened):
    """A running `assess open`, with the address that it printed."""

    process: subprocess.Popen[str] | None = None

    @property
    def pid(self):
        return self.process.pid

    def stop(self, number=signal.SIGTERM):
        """Send a signal, and return the exit status, what was printed, and the messages."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        out, err = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, out, err


def enter(url):
    """Open an address with a ticket; return a client with the cookie."""
    parts = urlsplit(url)
    client = Client(f"{parts.scheme}://{parts.netloc}")
    reply = client.get(f"{parts.path}?{parts.query}")
    assert reply.status == 200, reply.data
    return Client(client.base, reply.headers["set-cookie"].split(";")[0])


def start(*words, cwd, temporary=None, environment=None, before=()):
    """Start `assess open` in a folder, by another command where there is one `before`, and wait for its address."""
    variables = os.environ | ({"TMPDIR": str(temporary)} if temporary else {}) | (environment or {})
    process = subprocess.Popen(
        [*before, sys.executable, "-m", "assess", "open", *map(str, words)],
        cwd=cwd, env=variables, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    with end_late(process):
        for line in process.stdout:
            if found := ADDRESS.fullmatch(line.strip()):
                return Served(found[0], cwd, process=process)
    _, err = process.communicate(timeout=PATIENCE)
    raise AssertionError(f"no address was printed, exit status {process.returncode}: {err}")


class LocalWorker(Worker):
    """What answers the requests of a session, in this process."""

    is_gone = False

    def kill(self):
        """Do nothing: it ends with the tests."""


@contextmanager
def serve_here(workbook, cwd):
    """Serve a workbook, or none, as `assess open` does, in a thread: what a process imports is here already."""
    place, ready = Place(), Event()
    with bind(place) as listening, private_folder(PREFIX) as folder:
        server = Server(listening, place, folder, cwd, LocalWorker)
        if workbook is not None:
            server.open(Path(workbook))
        thread = Thread(target=server.run, args=((), ready.set))
        thread.start()
        try:
            assert ready.wait(PATIENCE)
            yield Opened(server.issue_address(), cwd)
        finally:
            server._uvicorn.should_exit = server._uvicorn.force_exit = True
            thread.join(PATIENCE)


@contextmanager
def end_late(process):
    """Kill a process whose line is waited for in vain: its output ends then."""
    timer = Timer(PATIENCE, process.kill)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def list_named(folder, start):
    """Return the sorted names below a folder that start so; what a server removes meanwhile is no fault."""
    return sorted(name for _, *found in os.walk(folder) for names in found for name in names if name.startswith(start))


def wait_for_job(client):
    return wait_until(lambda: client.get("/api/job").json()["job"], lambda job: job["state"] != "running")
