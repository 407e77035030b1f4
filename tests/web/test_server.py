"""A server from its start to its end: what it saves, what it says, what it leaves."""

import os
import signal
import socket
import subprocess
import sys

import openpyxl
import pytest

from tests.waiting import PATIENCE, wait_until
from tests.web.serving import end_late
from tests.workbooks import write

pytestmark = pytest.mark.slow
posix = pytest.mark.skipif(os.name == "nt", reason="signals")


def _edit(client, value=77):
    book = client.get("/api/book").json()
    at = next(one["at"] for one in book["sheets"][2]["columns"] if one["field"] == "breadth")
    reply = client.post("/api/edit", {"version": book["version"], "edits": [["Items", 2, at, value]], "label": "edit"})
    assert reply.status == 200, reply.data
    return at


def _read(path, at):
    return openpyxl.load_workbook(path)["Items"].cell(2, at + 1).value


@posix
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP])
def test_a_signal_ends_it_after_the_last_edit_is_saved(served, tmp_path, number):
    path = write(tmp_path / "office.xlsx")
    server = served(path)
    at = _edit(server.client)
    assert server.stop(number) == (0, "", "Stopped. All changes are saved in office.xlsx.\n")
    assert _read(path, at) == 77
    assert list((tmp_path / "tmp").iterdir()) == []
    assert sorted(one.name for one in tmp_path.iterdir()) == ["home", "office.xlsx", "tmp"]


def test_a_file_that_another_program_changed_is_not_overwritten(served, tmp_path):
    path = write(tmp_path / "office.xlsx")
    server = served(path)
    assert server.client.get("/api/download").data == path.read_bytes()
    at = _edit(server.client)
    state = wait_until(lambda: server.client.get("/api/state").json()["state"], lambda state: not state["unsaved"])
    assert (state["save_error"], _read(path, at)) == ("", 77), "edits are saved by themselves"
    write(path, [])
    state = wait_until(lambda: server.client.get("/api/state").json()["state"], lambda state: state["read_version"] > 2)
    assert not state["changed_outside"]  # nothing was unsaved: it has been read again
    write(path, [{"item": "B1"}])
    theirs = path.read_bytes()
    at = _edit(server.client, 78)
    assert server.client.post("/api/save").status == 409
    assert path.read_bytes() == theirs
    kept = tmp_path / "office-changes.xlsx"
    assert server.stop() == (0, "", f"Changes of office.xlsx that were not saved in it are kept in {kept}.\nStopped.\n")
    assert path.read_bytes() == theirs
    assert _read(kept, at) == 78


def test_a_workbook_that_another_server_has_open_is_told(served, tmp_path):
    path = write(tmp_path / "office.xlsx")
    first = served(path)
    second = served(path)
    remark = second.client.get("/api/book").json()["remark"]
    assert remark.startswith("office.xlsx is also open in another window")
    assert f"(process {first.pid})" in remark
    assert second.stop()[2] == f"warning  {remark}\nStopped. All changes are saved in office.xlsx.\n"
    assert first.client.get("/api/book").json()["remark"] == ""
    first.stop(signal.SIGKILL)
    assert served(path).client.get("/api/book").json()["remark"] == ""


def test_changes_of_a_held_workbook_that_are_not_downloaded_are_kept_at_the_end(served, tmp_path):
    data = write(tmp_path / "mine.xlsx").read_bytes()
    for is_downloaded in (False, True):
        server = served()
        assert server.client.send("/api/upload", "C:\\folder\\mine.xlsx", data).json()["name"] == "mine.xlsx"
        at = _edit(server.client)
        if is_downloaded:
            assert server.client.get("/api/download").headers["content-disposition"].endswith("''mine.xlsx")
            assert not server.client.get("/api/state").json()["state"]["unsaved"]
        _, _, err = server.stop()
        kept = tmp_path / "home" / "mine-changes.xlsx"
        if is_downloaded:
            assert err == "Stopped.\n"
            assert not kept.exists()
        else:
            assert err == f"Changes of mine.xlsx that were not saved in it are kept in {kept}.\nStopped.\n"
            assert _read(kept, at) == 77
            kept.unlink()


def test_stopping_does_not_wait_for_a_silent_browser_and_a_port_that_is_taken_is_named(served, tmp_path):
    server = served()
    line = socket.create_connection((server.client.host, server.client.port))
    line.sendall(b"POST /api/edit HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 1000\r\n\r\n{")
    status, _, err = server.stop()
    line.close()
    assert (status, err) == (0, "Stopped.\n")
    port = str(served().client.port)
    words = [sys.executable, "-m", "assess", "open", "--no-browser", "--port", port]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, timeout=PATIENCE, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"error  --port: 127.0.0.1:{port} cannot be used: ")


@posix
def test_enter_in_the_terminal_opens_the_page_again(tmp_path):
    import pty

    leader, follower = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "assess", "open", "--no-browser"],
        cwd=tmp_path, stdin=follower, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env=os.environ | {"TMPDIR": str(tmp_path)},
    )  # fmt: skip
    try:
        with end_late(process):
            first = process.stdout.readline()
            os.write(leader, b"\n")
            second = process.stdout.readline()
        assert first.split("=")[0] == second.split("=")[0]
        assert first != second
    finally:
        process.terminate()
        process.communicate(timeout=PATIENCE)
        os.close(leader)
        os.close(follower)


def test_saving_is_not_put_off_by_one_edit_after_the_other(served, tmp_path):
    client = served(write(tmp_path / "office.xlsx")).client
    values = iter(range(60, 10**6))

    def look():
        _edit(client, next(values))
        return client.get("/api/state").json()["state"]

    wait_until(look, lambda state: state["saved_version"] > 1)
