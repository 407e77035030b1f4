"""The simulation of a session, on a running server: its results, its end, and what is left of it."""

import io
import json
import os
import signal
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from assess.web.jobs import list_stale
from tests.waiting import wait_until
from tests.web.model_reader import find_worker, is_gone, linux
from tests.web.opened import write_one_floor
from tests.web.serving import list_named, start, wait_for_job
from tests.workbooks import write

LONG = {"verify": "all", "runs": 100_000, "formats": ["json"]}
"""A job that takes minutes."""


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    """A server with a workbook of five rows, and the date of its reports fixed."""
    folder = tmp_path_factory.mktemp("jobs")
    (folder / "tmp").mkdir()
    (folder / "home").mkdir()
    path = write(folder / "home" / "office.xlsx", period=1.0)
    server = start(
        path, "--no-browser", cwd=folder / "home", temporary=folder / "tmp", environment={"SOURCE_DATE_EPOCH": "0"}
    )
    yield server
    server.stop()


def _list_left(server):
    return list_named(server.folder.parent / "tmp", "job-")


def _find_end(row, key, end):
    """Return an end of the range of a row: of what is not known on assumed motion, else of the sampling interval."""
    found, adopted = row["verification"], row["adopted"]
    if adopted["method"] != "housner_monte_carlo" or found["if_slower"] is None:
        return adopted[key]
    return end(found["if_slower"], found["if_faster"], adopted["probability"])


@pytest.mark.slow
def test_results_are_those_of_the_command(served_here, tmp_path, monkeypatch):
    """Byte for byte: the same calls on a copy of the same bytes."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    path = write_one_floor(tmp_path / "office.xlsx", period=1.0)
    client, out = served_here(path).client, tmp_path / "out"
    formats = ["xlsx", "json", "csv"]
    asked = {"verify": "high", "runs": 20, "seed": 3, "first": 1, "formats": formats}
    assert client.post("/api/job", asked).status == 200
    words = ["run", "office.xlsx", "--verify", "high", "--runs", "20", "--seed", "3", "--anchor", "first:1"]
    subprocess.run(
        [sys.executable, "-m", "assess", *words, "--formats", ",".join(formats), "--out", str(out)],
        cwd=tmp_path, check=True, capture_output=True,
    )  # fmt: skip
    job = wait_for_job(client)
    assert (job["state"], job["message"], job["is_old"], job["stale"]) == ("done", "", False, [])
    names = [one["name"] for one in job["files"]]
    assert names == ["items.csv", "report.xlsx", "results.json", "report.zip"]
    files = {name: client.get(f"/api/job/file/{name}").data for name in names}
    assert {name for name in names[:-1] if files[name] != (out / name).read_bytes()} == set()
    with zipfile.ZipFile(io.BytesIO(files["report.zip"])) as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == {name: files[name] for name in names[:-1]}

    rows = json.loads(files["results.json"])["items"]
    assert job["items"]["row"] == [2, 3, 4, 5, 6]
    assert any(job["items"]["simulated"])
    for key, end in (("low", min), ("high", max)):
        assert job["items"][key] == [_find_end(row, key, end) for row in rows]
    assert job["items"]["chance"] == pytest.approx([row["adopted"]["probability"] for row in rows])
    classes = [one.replace("_", " ") for one in job["items"]["class"]]
    assert classes == ["" if row["anchor"]["counts_as_anchored"] else row["adopted"]["class"] for row in rows]
    live = client.get("/api/live").json()["items"]
    shown = dict(zip(live["row"], live["class"], strict=True))
    free = zip(job["items"]["row"], classes, strict=True)
    assert job["items"]["formula"] == [shown[row] if risk else "" for row, risk in free]
    sums = job["before_after"]
    assert sums["before"]["falls"] > sums["after"]["falls"]
    pieces = {
        sum([*sums[side]["counts"].values(), sums[side]["anchored"], sums[side]["apart"]])
        for side in ("before", "after")
    }
    assert pieces == {sum(job["items"]["quantity"])}


@pytest.mark.slow
def test_a_job_ends_with_its_files_is_found_again_and_rows_that_changed_since_are_stale(running):
    asked = {"verify": "none", "formats": ["html"]}
    assert running.client.post("/api/job", asked).json()["job"]["state"] == "running"
    assert running.client.post("/api/job", asked).status == 409
    job = wait_for_job(running.client)
    assert job["state"] == "done"
    assert running.client.get("/api/state").json()["job"]["id"] == job["id"]
    report = running.client.get("/api/job/report")
    policy = report.headers["content-security-policy"]
    assert policy.startswith("sandbox allow-scripts; default-src 'none'; script-src 'sha256-")
    assert "frame-ancestors 'self'" in policy
    assert report.headers["x-frame-options"] == "SAMEORIGIN"
    assert running.client.get("/api/job/file/report.html").headers["content-disposition"].startswith("attachment")
    assert running.client.get("/api/job/file/report.pdf").status == 404
    book = running.client.get("/api/book").json()
    columns = {one["field"]: one["at"] for one in book["sheets"][2]["columns"]}
    edits = [["Items", 2, columns["breadth"], 31], ["Items", 3, columns["notes"], "by the door"]]
    version = running.client.post("/api/edit", {"version": book["version"], "edits": edits}).json()["state"]["version"]
    now = running.client.get("/api/job").json()["job"]
    assert (now["id"], now["is_old"], now["stale"]) == (job["id"], True, [2])
    running.client.post("/api/undo", {"version": version})
    assert running.client.get("/api/job").json()["job"]["stale"] == []


def test_floors_and_the_building_make_all_rows_stale(example_inventory):
    from dataclasses import replace

    def change_floor(**changes):
        first, *others = example_inventory.floors
        return replace(example_inventory, floors=(replace(first, **changes), *others))

    rows = [one.row for one in example_inventory.items]
    building = example_inventory.building
    assert list_stale(example_inventory, example_inventory) == []
    assert list_stale(example_inventory, replace(example_inventory, items=example_inventory.items[1:])) == rows[:1]
    assert list_stale(example_inventory, change_floor(name="Attic")) == []
    assert list_stale(example_inventory, change_floor(pfa={"X": 1.0})) == rows
    assert list_stale(example_inventory, replace(example_inventory, building=replace(building, client="B"))) == []
    for change in ({"friction": 0.2}, {"structure": "walls"}, {"ground_pgv": 0.3}, {"period": 0.9}):
        changed = replace(example_inventory, building=replace(building, **change))
        assert list_stale(example_inventory, changed) == rows, change


def test_what_cannot_be_asked_for_is_refused(running):
    """Among it what runs code: fitted models and templates come from the command line alone."""
    every: tuple[dict[str, object], ...] = (
        {"verify": "some"}, {"runs": 0}, {"runs": "many"}, {"seed": -1}, {"scale": 0}, {"first": -1}, {"first": True},
        {"formats": []}, {"formats": ["npz"]}, {"formats": "../x"}, {"scenario": "x"},
    )  # fmt: skip
    for asked in every:
        reply = running.client.post("/api/job", asked)
        assert (reply.status, bool(reply.json()["message"])) == (422, True), asked
    left = wait_for_job(running.client)["id"] if running.client.get("/api/job").json()["job"] else ""
    assert _list_left(running) == [f"job-{left}"] * bool(left)
    more = {"method": "/tmp/own.toml", "template": "/tmp", "out": "/tmp/out"}
    assert running.client.post("/api/job", {"formats": ["json"], "verify": "none", **more}).status == 200
    assert wait_for_job(running.client)["settings"] == {"verify": "none"}


@pytest.mark.slow
def test_cancelling_ends_the_process_and_leaves_nothing(served, tmp_path):
    server = served(write(tmp_path / "w.xlsx"))
    server.client.post("/api/job", LONG)
    wait_until(lambda: server.client.get("/api/job").json()["job"]["stage"], bool)
    job = server.client.post("/api/job/cancel").json()["job"]
    assert (job["state"], job["files"]) == ("cancelled", [])
    wait_until(lambda: _list_left(server), lambda left: left == [])
    if Path("/proc/self/task").is_dir():
        assert find_worker(server, b"job_process") == 0
    server.client.post("/api/job", LONG)  # another one can begin, which ends with the server
    status, _, err = server.stop()
    assert (status, err) == (0, "Stopped. All changes are saved in w.xlsx.\n")
    assert list((tmp_path / "tmp").iterdir()) == []


@linux
@pytest.mark.slow
def test_a_process_that_is_killed_is_a_job_that_failed(served, tmp_path):
    server = served(write(tmp_path / "w.xlsx"))
    server.client.post("/api/job", LONG)
    os.kill(wait_until(lambda: find_worker(server, b"job_process"), bool), signal.SIGKILL)
    job = wait_for_job(server.client)
    assert job["state"] == "failed"
    assert "ended unexpectedly" in job["message"]
    assert _list_left(server) == []


@linux
@pytest.mark.slow
def test_a_job_ends_with_a_server_that_is_killed_and_the_next_one_sweeps_up(served, tmp_path):
    path = write(tmp_path / "w.xlsx")
    server = served(path)
    server.client.post("/api/job", LONG)
    worker = wait_until(lambda: find_worker(server, b"job_process"), bool)
    wait_until(lambda: server.client.get("/api/job").json()["job"]["stage"], bool)
    server.process.kill()
    server.process.wait()
    wait_until(lambda: is_gone(worker), bool)
    wait_until(lambda: _list_left(server), lambda left: left == [])
    assert [one.name[:12] for one in (tmp_path / "tmp").iterdir()] == ["assess-open-"]
    other = served(path)
    assert len(list((tmp_path / "tmp").iterdir())) == 1
    other.stop()
    assert list((tmp_path / "tmp").iterdir()) == []
