"""The simulation of a session, on a running server: its results, its end, and what is left of it."""

import json
import os
import signal
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from assess.compare.changes import compare
from assess.compare.comparison_document import View
from assess.compare.past_run import read_run
from assess.web.jobs import MOST_RUNS, Runs
from assess.web.limits import OWN
from assess.web.live import CLASSES
from tests.waiting import wait_until
from tests.web.model_reader import find_worker, is_gone, linux
from tests.web.opened import hold, write_one_floor
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
    assert (job["state"], job["message"], job["is_old"]) == ("done", "", False)
    there = {one["name"]: one["state"] for one in job["files"]}
    assert {name for name, state in there.items() if state == "there"} == {"items.csv", "report.xlsx", "results.json"}
    files = {name: client.get(f"/api/job/file/{name}").data for name in there if there[name]}
    assert {name for name in ("items.csv", "report.xlsx") if files[name] != (out / name).read_bytes()} == set()
    assert _read_numbers(files["results.json"]) == _read_numbers((out / "results.json").read_bytes())
    assert client.get("/api/job/file/report.pdf").status == 404
    found, results = job["found"], json.loads(files["results.json"])
    rows = [row for row in results["items"] if not row["anchor"]["counts_as_anchored"]]
    simulated = [row for row in rows if row["adopted"]["basis"] in ("simulated", "cannot rock")]
    pieces = Counter({row["adopted"]["class"].replace(" ", "_"): 0 for row in simulated})
    for row in simulated:
        pieces[row["adopted"]["class"].replace(" ", "_")] += row["quantity"]
    assert pieces == Counter({name: n for name, n in found["counts"].items() if n and name in CLASSES})
    falls = sum(row["adopted"]["probability"] * row["quantity"] for row in simulated)
    assert found["falls"][0] == pytest.approx(falls)
    assert found["counts"]["formula"] == sum(r["quantity"] for r in rows if r["adopted"]["basis"] == "formula")
    assert sum(found["counts"].values()) == sum(row["quantity"] for row in results["items"])


def _read_numbers(data):
    """Return results without the list of the files that were made with them, which a run makes one after another."""
    found = json.loads(data)
    del found["assess"]["files"]
    return found


@pytest.mark.slow
def test_files_are_made_of_a_run_when_they_are_asked_for_and_it_is_old_once_the_workbook_is_another(running):
    client = running.client
    assert client.post("/api/job", {"verify": "none", "formats": ["json"]}).json()["job"]["state"] == "running"
    assert client.post("/api/job", {"verify": "none"}).status == 409
    job = wait_for_job(client)
    assert job["state"] == "done"
    assert client.get("/api/state").json()["job"]["id"] == job["id"]
    assert client.get("/api/job/report").status == 404
    asked = {"id": job["id"], "formats": ["html", "csv"]}
    assert client.post("/api/job/files", asked).json()["job"]["state"] == "running"
    shares = list[float]()

    def look():
        now = client.get("/api/job").json()["job"]
        shares.append(now["share"])
        return now

    writing = wait_until(look, lambda now: now["label"] == "Writing report.html" or now["state"] != "running")
    assert writing["label"] == "Writing report.html"
    assert writing["seconds_left"] >= 1
    again = wait_until(look, lambda now: now["state"] != "running")
    assert shares == sorted(shares), "it never begins again"
    assert again["id"] == job["id"]
    assert {one["format"] for one in again["files"] if one["state"] == "there"} == {"html", "csv", "json"}
    report = client.get(f"/api/job/report?id={job['id']}")
    policy = report.headers["content-security-policy"]
    assert policy.startswith("sandbox allow-scripts allow-modals; default-src 'none'; script-src 'sha256-")
    assert "frame-ancestors 'none'" in policy
    assert client.get("/api/job/file/report.html").headers["content-disposition"].startswith("attachment")
    for asked in ({"formats": ["npz"]}, {"formats": []}, {"id": "0123", "formats": ["pdf"]}):
        assert client.post("/api/job/files", asked).status in (404, 422), asked
    book = client.get("/api/book").json()
    columns = {one["field"]: one["at"] for one in book["sheets"][2]["columns"]}
    edits = [["Items", 3, columns["notes"], "by the door"]]
    version = client.post("/api/edit", {"version": book["version"], "edits": edits}).json()["state"]["version"]
    assert client.get("/api/job").json()["job"]["is_old"]
    client.post("/api/undo", {"version": version})
    assert not client.get("/api/job").json()["job"]["is_old"]


@pytest.mark.slow
def test_runs_are_kept_compared_and_removed(running):
    """A comparison is that of the command, in its words."""
    client, book = running.client, running.client.get("/api/book").json()
    for one in client.get("/api/job").json()["runs"]:
        client.post("/api/job/remove", {"id": one["id"]})
    columns = {one["field"]: one["at"] for one in book["sheets"][2]["columns"]}
    ids = []
    for height in (None, 90):
        if height:
            edits = [["Items", 2, columns["height"], height]]
            change = client.post("/api/edit", {"version": book["version"], "edits": edits}).json()
            book["version"] = change["state"]["version"]
        client.post("/api/job", {"verify": "none", "formats": ["json"]})
        ids.append(wait_for_job(client)["id"])
    client.post("/api/undo", {"version": book["version"]})
    runs = client.get("/api/job").json()["runs"]
    assert [one["id"] for one in runs] == ids[::-1]
    assert len({one["outcome"] for one in runs}) == 2
    found = client.get(f"/api/job/compare?before={ids[0]}&after={ids[1]}").json()
    folders = [running.folder.parent / "compared" / one for one in ids]
    for folder, one in zip(folders, ids, strict=True):
        folder.mkdir(parents=True)
        (folder / "results.json").write_bytes(client.get(f"/api/job/file/results.json?id={one}").data)
    view = View(compare(*map(read_run, folders)))
    assert found["headline"] == view.headline
    assert found["pieces"][0][0] == "A1"
    assert found["pieces"][0][-1] == "Height: 200 → 90 cm"
    assert found["tone"] == "better"
    assert {row[0] for row in found["counts"]} >= {"expected falls"}
    page = client.get(f"/api/job/compare?before={ids[0]}&after={ids[1]}&as=page")
    assert b"<h1" in page.data
    assert page.headers["content-security-policy"].startswith("sandbox")
    assert client.get(f"/api/job/compare?before={ids[0]}&after=x").status == 404
    client.post("/api/job/remove", {"id": ids[0]})
    assert [one["id"] for one in client.get("/api/job").json()["runs"]] == ids[1:]
    assert len(_list_left(running)) == 1


def test_the_oldest_runs_go_first_and_those_of_an_earlier_process_are_found(tmp_path):
    for n in range(MOST_RUNS + 2):
        folder = tmp_path / "session" / f"job-{n:02}"
        folder.mkdir(parents=True)
        order = {"version": n, "time": f"2026-01-{n + 1:02}", "settings": {}}
        (folder / "job.json").write_text(json.dumps(order), encoding="utf-8")
        if n:  # the first has no results
            (folder / "results.pickle").write_bytes(b"")
            (folder / "summary.json").write_text('{"en": {"outcome": "one"}}', encoding="utf-8")
    runs = Runs(tmp_path / "session", OWN)
    assert runs.latest is not None
    assert runs.latest.id == f"{MOST_RUNS + 1:02}"
    book = hold(write(tmp_path / "w.xlsx"))
    runs.begin(book, {"verify": "none", "formats": ["json"]})
    book.simulator.close()
    kept = [one["version"] for one in runs.list_all()]
    assert kept == list(range(MOST_RUNS + 1, 2, -1)), "the new one has no results yet"
    runs.close()
    assert [one["version"] for one in Runs(tmp_path / "session", OWN).list_all()] == kept


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
    assert (job["state"], {one["state"] for one in job["files"]}) == ("cancelled", {""})
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
