"""What every request must satisfy, on a running server."""

import gzip
import re
import socket
from urllib.parse import urlsplit

import pytest

from tests.waiting import PATIENCE
from tests.web.serving import Client, start

PATHS = (
    "/", "/main.mjs", "/api/book", "/api/live?since=1", "/nothing", "/../etc/passwd", "/%2e%2e/guard.py",
    "/api/job/file/results.json", "//", "/%ff%fe", "/" + "a" * 4000, "/enter", "/enter?t=", "/enter?t=%00",
)  # fmt: skip
METHODS = ("GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "TRACE", "PATCH", "PROPFIND")


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    folder = tmp_path_factory.mktemp("guarded")
    server = start("--no-browser", "--port", "0", cwd=folder, temporary=folder)
    yield server
    server.stop()


@pytest.fixture(scope="module")
def client(running):
    return running.client


def _send_raw(server, text):
    """Return the status of the answer to bytes as they are."""
    parts = urlsplit(server.url)
    with socket.create_connection((parts.hostname, parts.port), timeout=PATIENCE) as line:
        line.sendall(text.replace(b"HOST", f"{parts.hostname}:{parts.port}".encode()))
        answer = b""
        while b"\r\n" not in answer and (part := line.recv(65536)):
            answer += part
    return int(answer.split()[1])


def test_without_the_cookie_every_path_answers_401(client):
    for cookie in (None, "", f"{client.headers['Cookie'].split('=')[0]}=", "assess=x", "a; b=c;;=;\xff=\xff"):
        stranger = Client(client.base)
        found = {
            (method, path): stranger.request(method, path, headers={"Cookie": cookie}).status
            for path in PATHS
            for method in METHODS
        }
        assert {key: status for key, status in found.items() if status != 401} == {}
    page = Client(client.base).get("/", Accept="text/html")
    assert page.status == 401
    assert b"Press Enter" in page.data  # how to open it again
    assert b"refresh" not in page.data
    assert b"refresh" in Client(client.base).get("/", Accept="text/html", **{"Sec-Fetch-Site": "cross-site"}).data


@pytest.mark.slow
def test_a_ticket_opens_the_page_once_and_becomes_a_strict_cookie(tmp_path):
    server = start("--no-browser", "--port", "0", cwd=tmp_path, temporary=tmp_path)
    try:
        path = server.url.removeprefix(server.base)
        stranger = Client(server.base)
        assert stranger.request("HEAD", path).status == 401  # a preview of a link does not use it up
        assert stranger.get(path, **{"Sec-Purpose": "prefetch"}).status == 401
        reply = stranger.get(path, **{"Sec-Fetch-Site": "none"})
        cookie = reply.headers["set-cookie"]
        port = urlsplit(server.url).port
        assert re.match(rf"assess-{port}=[\w-]{{40,}}; HttpOnly; SameSite=Strict; Path=/; Max-Age=\d+$", cookie)
        assert stranger.get(path).status == 401
        own = Client(server.base, cookie.split(";")[0])
        assert own.get("/api/state").status == 200
        assert own.get(path).status == 200  # the tab that still shows the address is reloaded
    finally:
        _, out, err = server.stop()
    assert server.url.split("=")[1] not in out + err  # nothing is logged after the address was printed


def test_other_names_of_the_host_and_changes_from_other_pages_are_refused(client):
    port = client.port
    for host in ("example.org", f"example.org:{port}", "127.0.0.1", "localhost", f"127.0.0.1:{port}.evil.org",
                 f"127.0.0.1:{port + 1}", f"127.0.0.1.nip.io:{port}", f"0.0.0.0:{port}", ""):  # fmt: skip
        assert client.get("/api/state", Host=host).status == 421, host
    for host in (f"127.0.0.1:{port}", f"localhost:{port}", f"LOCALHOST:{port}"):
        assert client.get("/api/state", Host=host).status == 200, host
    # A page of another origin, of another port of this machine, a form without our header, a browser that says so.
    for headers in (
        {"Origin": "https://example.org"}, {"Origin": None}, {"Origin": "null"},
        {"Origin": f"http://127.0.0.1:{client.port + 1}"}, {"Origin": client.base + "/"}, {"X-Assess": None},
        {"Sec-Fetch-Site": "cross-site"}, {"Sec-Fetch-Site": "same-site"}, {"Sec-Fetch-Site": "none"},
    ):  # fmt: skip
        assert client.post("/api/close", **headers).status == 403, headers
    assert client.post("/api/close").status == 404
    assert client.post("/api/close", **{"Sec-Fetch-Site": None}).status == 404  # browsers of 2022
    for site in ("cross-site", "same-site"):
        assert client.get("/api/download", **{"Sec-Fetch-Site": site}).status == 403
        assert client.get("/", **{"Sec-Fetch-Site": site, "Sec-Fetch-Dest": "document"}).status == 200  # a link


def test_every_answer_confines_the_page_and_its_files_alone_are_given_with_their_kind(client):
    stranger = Client(client.base)
    for reply in (client.get("/"), client.get("/api/state"), client.get("/nothing"), stranger.get("/"),
                  client.post("/api/edit"), client.get("/", Host="example.org")):  # fmt: skip
        policy = reply.headers["content-security-policy"]
        assert policy.startswith("default-src 'none'; script-src 'self'; style-src 'self';")
        assert "frame-ancestors 'none'" in policy
        assert "unsafe" not in policy
        assert "*" not in policy
        found = {name: reply.headers[name] for name in (
            "x-content-type-options", "cache-control", "referrer-policy", "cross-origin-opener-policy",
            "cross-origin-resource-policy")}  # fmt: skip
        kept = (
            "no-cache" if reply.headers["etag"] else "no-store"
        )  # a file of the page is asked for again, nothing else is kept
        assert list(found.values()) == ["nosniff", kept, "no-referrer", "same-origin", "same-origin"]
        assert reply.headers["server"] is None
    assert client.get("/").headers["content-type"] == "text/html; charset=utf-8"
    assert client.get("/main.mjs").headers["content-type"] == "text/javascript; charset=utf-8"
    assert client.get("/page.css").headers["content-type"] == "text/css; charset=utf-8"
    for path in ("/guard.py", "/../guard.py", "/..%2fguard.py", "/%2e%2e/guard.py", "/page/main.mjs", "/./main.mjs/..",
                 "/etc/passwd", "//etc/passwd", "/..%5cguard.py", "/main.mjs%00.html", "/C:/Windows/win.ini",
                 "/api/job/file/../../job.json", "/api/job/file/..%2f..%2fjob.json"):  # fmt: skip
        assert client.get(path).status == 404, path


def test_files_of_the_page_are_sent_once_and_answers_are_compressed_where_the_browser_takes_it(client):
    gzipped = {"Accept-Encoding": "deflate, gzip;q=0.8"}
    for path in ("/", "/main.mjs", "/page.css", "/fonts/IBMPlexSans-Regular.woff2"):
        plain, packed = client.get(path), client.get(path, **gzipped)
        assert (plain.headers["content-encoding"], plain.headers["cache-control"]) == (None, "no-cache")
        assert int(packed.headers["content-length"]) == len(packed.data)
        if path.startswith("/fonts"):  # compressed already
            assert (packed.headers["content-encoding"], packed.data[:4]) == (None, b"wOF2")
        else:
            assert (packed.headers["content-encoding"], packed.headers["vary"]) == ("gzip", "accept-encoding")
            assert gzip.decompress(packed.data) == plain.data
        mark = plain.headers["etag"]
        same = client.get(path, **{"If-None-Match": f'"x", {mark}'})
        assert (same.status, same.data, same.headers["etag"]) == (304, b"", mark)
        assert client.get(path, **{"If-None-Match": '"x"'}).status == 200
        assert Client(client.base).get(path, **{"If-None-Match": mark}).status == 401
        fixed = client.get(f"{path}?v={mark[3:11]}")
        assert "immutable" in fixed.headers["cache-control"]
        assert client.get(f"{path}?v=00000000").headers["cache-control"] == "no-cache"
    plain, packed = client.get("/api/start"), client.get("/api/start", **gzipped)
    assert packed.headers["content-encoding"] == "gzip"
    assert gzip.decompress(packed.data) == plain.data
    assert len(packed.data) < len(plain.data) / 3
    for path, accepted in (("/api/state", "gzip"), ("/api/start", "gzip;q=0"), ("/api/start", "br")):
        assert client.get(path, **{"Accept-Encoding": accepted}).headers["content-encoding"] is None


def test_what_is_too_large_cannot_be_read_or_is_no_workbook_is_refused(client):
    assert client.request("POST", "/api/edit", b"x" * (33 * 2**20)).status == 413
    assert client.request("POST", "/api/upload?name=a.xlsx", iter([b"x" * 2**20] * 70)).status == 413  # in pieces
    assert client.request("POST", "/api/upload?name=a.xlsx", b"x" * (65 * 2**20)).status == 413
    for body in (b"{", b"[]", b"1", b"\xff", b'{"a": NaN}', b'{"a": 1e999}', b"[" * 60_000, b'{"a": "\\ud800"}',
                 b'{"a": ' + b"9" * 5000 + b"}"):  # fmt: skip
        reply = client.request("POST", "/api/what-if", body)
        assert (reply.status, reply.json()["message"]) == (400, "The request cannot be read."), body[:20]
    for data in (b"", b"junk", b"PK\x03\x04" + b"\0" * 400):
        reply = client.send("/api/upload", "../../a.xlsx", data)
        assert reply.status == 422
        assert reply.json()["problems"][0]["message"]
    assert client.get("/api/state").json()["state"] is None


@pytest.mark.slow
def test_strange_requests_are_never_an_error_of_the_server(running, client):
    cookie = client.headers["Cookie"].encode()
    head = b"Host: HOST\r\nCookie: " + cookie + b"\r\nConnection: close\r\n"
    texts = {
        b"GET / HTTP/1.1\r\n" + head + b"Host: HOST\r\n\r\n": {400, 421},
        b"GET / HTTP/1.1\r\nHost: HOST\r\n" + b"Cookie: " + b"a=b;" * 20_000 + b"\r\n\r\n": {400, 401},
        b"GET /" + b"%ff" * 100 + b" HTTP/1.1\r\n" + head + b"\r\n": {404},
        b"GET /?since=%00&%ff=%fe&t=\xff HTTP/1.1\r\n" + head + b"\r\n": {200, 400},
        b"GET /api/texts?language=" + b"x" * 3000 + b" HTTP/1.1\r\n" + head + b"\r\n": {200},
        b"POST /api/edit HTTP/1.1\r\n" + head + b"Content-Length: -1\r\n\r\n": {400, 413},
        b"GET /api/state HTTP/1.1\r\n" + head + b"Accept-Language: " + b"\xff," * 500 + b"\r\n\r\n": {200, 400},
        b"GET /api/state HTTP/1.1\r\n" + head + b"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: "
        b"AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n": {200, 400},
        b"CONNECT example.org:443 HTTP/1.1\r\nHost: HOST\r\n\r\n": {400, 401},
        b"GET http://example.org/ HTTP/1.1\r\nHost: example.org\r\n\r\n": {400, 421},
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03": {400},
    }  # fmt: skip
    for text, expected in texts.items():
        assert _send_raw(running, text) in expected, text[:60]
    for method in METHODS[3:]:
        assert client.request(method, "/api/state").status == 405, method
    assert client.get("/api/live?since=%C2%B2").status == 404  # no workbook is open
    assert client.get("/api/state").status == 200
