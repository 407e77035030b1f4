"""Workers of dask: the same bytes as one process, and each fault of a cluster told or made up for."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path

import pytest

from assess.errors import InputError, OutputError
from assess.portfolio import cluster, local_pool
from assess.portfolio.building_task import FOLDER, Task
from assess.portfolio.cluster import (
    Site,
    WorkerUnfitError,
    answer_probe,
    check_cluster,
    check_workers,
    list_versions,
    run_checked,
    run_on_cluster,
)
from assess.portfolio.run_portfolio import run_portfolio
from assess.portfolio.sources import find_sources
from assess.settings import Settings
from tests.portfolio.staged import HOLDS, KILLS, KILLS_ONCE, StagedGround, read_results, write_city
from tests.refusals import check_refusals
from tests.waiting import PATIENCE, wait_until

pytest.importorskip("distributed")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")]
ROOT = Path(__file__).parents[2]
FORMULAS = Settings(verify="none")
QUIET = {"DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "false", "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "3s",
         "PYTHONPATH": str(ROOT)}  # fmt: skip

ALONE = ("--nthreads", "1", "--no-nanny")
"""A worker that nobody starts again when it dies."""


@contextlib.contextmanager
def _started(*words):
    """Start a command of dask, end it and all that it started."""
    with subprocess.Popen(
        [sys.executable, "-m", *words], env=os.environ | QUIET, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        start_new_session=True,
    ) as process:  # fmt: skip
        try:
            yield process
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


@contextlib.contextmanager
def _scheduler():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    words = ("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard")
    with _started(*words) as process:
        address = f"tcp://127.0.0.1:{port}"
        wait_until(lambda: _answers(port))
        yield process, address


def _answers(port):
    with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
        return True
    return False


def _workers(address, count, *options):
    words = ("distributed.cli.dask_worker", address, "--nworkers", str(count), "--no-dashboard", "--host", "127.0.0.1")
    return _started(*words, *(options or ("--nthreads", "1")))


@pytest.fixture(scope="module")
def address():
    """Return the address of a scheduler with three workers."""
    with _scheduler() as (_, found), _workers(found, 3):
        yield found


def _run(tmp_path, out, scheduler=None, settings=FORMULAS):
    return run_portfolio(
        tmp_path / "city", tmp_path / out, settings, ground=StagedGround(tmp_path), jobs=1, scheduler=scheduler,
        formats=("parquet",),
    )  # fmt: skip


@pytest.mark.parametrize("settings", [FORMULAS, pytest.param(Settings(verify="all", runs=10), marks=pytest.mark.long)])
def test_three_workers_give_the_bytes_of_one_process(tmp_path, address, monkeypatch, settings):
    write_city(tmp_path / "city", [40.0, 41.0] * 3)
    (tmp_path / "city" / "bad.xlsx").write_bytes(b"no workbook")
    found = _run(tmp_path, "cluster", address, settings)
    assert [path for path, _ in found.skipped] == ["bad.xlsx"]
    _run(tmp_path, "process", settings=settings)
    assert read_results(tmp_path / "cluster") == read_results(tmp_path / "process")
    assert not list((tmp_path / "cluster" / FOLDER).glob(".probe-*"))


@pytest.mark.long
def test_a_worker_that_dies_changes_no_byte_and_a_building_that_kills_workers_is_skipped(
    tmp_path, address, monkeypatch
):
    write_city(tmp_path / "city", [40.0, KILLS_ONCE, 41.0, KILLS])
    found = _run(tmp_path, "cluster", address)
    assert (tmp_path / "killed").exists()
    assert [path for path, _ in found.skipped] == ["b03.xlsx"]
    monkeypatch.setattr(local_pool, "MOST_DEATHS", 1)
    _run(tmp_path, "process")
    assert read_results(tmp_path / "cluster") == read_results(tmp_path / "process")


def test_a_client_that_is_killed_is_followed_by_one_that_goes_on(tmp_path, address, monkeypatch):
    write_city(tmp_path / "city", [40.0] * 8 + [HOLDS])
    (tmp_path / "hold").touch()
    code = (
        "from pathlib import Path\nfrom tests.portfolio import test_cluster as t\n"
        f"t._run(Path({str(tmp_path)!r}), 'out', {address!r})"
    )
    parts = tmp_path / "out" / FOLDER
    with subprocess.Popen([sys.executable, "-c", code], cwd=ROOT, env=os.environ | QUIET) as client:
        wait_until(lambda: len(list(parts.glob("*/*.part"))) == 8 and list(tmp_path.glob("held-*")))
        client.send_signal(signal.SIGKILL)
    (tmp_path / "hold").unlink()
    assert _run(tmp_path, "out", address).kept >= 8
    _run(tmp_path, "process")
    assert read_results(tmp_path / "out") == read_results(tmp_path / "process")


def test_a_scheduler_that_dies_is_told_and_what_is_done_is_kept(tmp_path, monkeypatch):
    write_city(tmp_path / "city", [40.0] * 8 + [HOLDS])
    (tmp_path / "hold").touch()
    with _scheduler() as (process, own), _workers(own, 1, *ALONE):
        tasks = [
            Task(source=one, settings=replace(FORMULAS, city=True), ground=StagedGround(tmp_path), out=tmp_path / "out")
            for one in find_sources(tmp_path / "city")
        ]
        (tmp_path / "out" / FOLDER).mkdir(parents=True)
        summaries = run_on_cluster(tasks, own)
        done = [next(summaries)]
        process.kill()
        with pytest.raises(OutputError, match=r"the scheduler .* is gone\. What is done is kept"):
            done += summaries
    assert len(list((tmp_path / "out" / FOLDER).glob("*/*.part"))) >= len(done) >= 1


def test_no_workers_and_workers_with_several_threads_are_told(tmp_path, monkeypatch):
    write_city(tmp_path / "city", [40.0])
    monkeypatch.setattr(cluster, "JOINING", 1.0)
    with _scheduler() as (_, own):
        with pytest.raises(InputError, match=r"has no workers\. Start some with one thread"):
            _run(tmp_path, "out", own)
        monkeypatch.undo()
        with (
            _workers(own, 1, "--nthreads", "3", "--no-nanny"),
            pytest.raises(InputError, match=r"it has 3 threads\. Start it with"),
        ):
            _run(tmp_path, "out", own)
    assert not list((tmp_path / "out").glob("*.parquet"))


@contextlib.contextmanager
def _serving(data):
    """Serve bytes to whoever connects, or nothing at all and keep the connection."""
    with socket.create_server(("127.0.0.1", 0)) as server, contextlib.ExitStack() as held:

        def serve():
            with contextlib.suppress(OSError):  # the end
                while True:
                    connection = held.enter_context(server.accept()[0])
                    if data:
                        connection.sendall(data)

        threading.Thread(target=serve, daemon=True).start()
        yield f"tcp://127.0.0.1:{server.getsockname()[1]}"
        server.shutdown(socket.SHUT_RDWR)


HTTP = b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n"


def _fail(tmp_path, scheduler):
    """Return what the command prints where no scheduler is; besides progress one line."""
    write_city(tmp_path / "city", [40.0])
    words = (tmp_path / "city", "--verify", "none", "--formats", "html", "--out", tmp_path / "out")
    command = [sys.executable, "-m", "assess", "portfolio", *map(str, words), "--scheduler", scheduler]
    done = subprocess.run(command, check=False, cwd=ROOT, capture_output=True, text=True, timeout=PATIENCE)
    assert (done.returncode, done.stdout) == (2, "")
    progress = ("Working, ", "Assessing 0 of 1 buildings")
    lines = [line for line in done.stderr.splitlines() if not line.startswith(progress)]
    assert len(lines) == 1, done.stderr
    assert not (tmp_path / "out" / "city.html").exists()
    return lines[0]


def test_what_is_not_a_scheduler_is_told_in_one_line(tmp_path):
    """A server of the web, and a worker."""
    said = "what is there does not answer as a dask scheduler"
    with _serving(HTTP) as address:
        line = _fail(tmp_path, address)
    assert line.startswith(f"error  --scheduler {address}: {said}")
    assert line.endswith("a scheduler prints its address when it starts.")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    with _scheduler() as (_, found), _workers(found, 1, *ALONE, "--worker-port", str(port)):
        wait_until(lambda: _answers(port))
        assert said in _fail(tmp_path, f"tcp://127.0.0.1:{port}")


def test_a_server_that_says_nothing_or_nothing_readable_and_nobody_are_told(tmp_path):
    write_city(tmp_path / "city", [40.0])
    for data in (bytes(2000), b""):
        with _serving(data) as address, pytest.raises(InputError, match="what is there does not answer as a dask"):
            _run(tmp_path, "out", address)
    with pytest.raises(InputError, match=r"127\.0\.0\.1:1 cannot be reached: .*\. Is it running\?"):
        _run(tmp_path, "out", "127.0.0.1:1")
    assert not list((tmp_path / "out").glob("*.parquet"))


def test_an_address_of_another_form_is_refused_at_once():
    message = r"^scheduler is .*, expected tcp://HOST:PORT, such as tcp://10\.0\.0\.5:8786"
    addresses = ("banana", "http://127.0.0.1:1", "tcp://host", "tcp://host:0", "host:70000", "", ":1")
    check_refusals(InputError, check_cluster, [(address, message) for address in addresses])
    for address in ("tcp://10.0.0.5:8786", "a-host.local:1", "wss://[::1]:65535", "tls://h_1:2"):
        check_cluster(address)


# ---------------------------------------------------------------- what workers have to have


class _Client:
    """Answers as workers would that run in this process: what they see is what `answer_probe` finds."""

    def __init__(self, **answers):
        self._answers = answers

    def run(self, function, site, on_error):
        assert (function, on_error) == (answer_probe, "return")
        return {name: answer(site) if callable(answer) else answer for name, answer in self._answers.items()}


@pytest.fixture
def site(tmp_path):
    """Return what workers have to have, with its probe written."""
    (tmp_path / "probe").write_text("token", encoding="ascii")
    (tmp_path / "a.xlsx").touch()
    return Site(versions=list_versions(), probe=tmp_path / "probe", token="token", seen=(tmp_path / "a.xlsx",))


def _refuse(site, answer):
    check_workers(_Client(good=answer_probe), site)
    with pytest.raises(InputError) as caught:
        check_workers(_Client(good=answer_probe, bad=answer), site)
    assert "good" not in str(caught.value)
    return str(caught.value)


def test_a_worker_that_cannot_do_the_work_is_refused_with_the_reason(site, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    elsewhere = replace(site, probe=other / "probe")
    versions = {"versions": list_versions() | {"assess": "0.0.1 (ab)", "numpy": "0.0.1"}}
    for answer, said in (
        (lambda _: answer_probe(site) | versions, "worker bad: other versions: assess 0.0.1 (ab) there, "),
        (lambda _: answer_probe(site) | {"threads": 3}, "it has 3 threads. Start it with one thread."),
        (ModuleNotFoundError("No module named 'assess'"), "assess is not installed there"),
        (RuntimeError("broken"), "it does not answer (RuntimeError: broken)"),
        (lambda _: answer_probe(elsewhere), "it does not share the folder"),
        (lambda _: answer_probe(replace(site, seen=(tmp_path / "gone.xlsx",))), "gone.xlsx. Put it in a folder that"),
    ):
        assert said in _refuse(site, answer)
    elsewhere.probe.write_text("token of another run", encoding="ascii")
    assert "it sees another folder of this name" in _refuse(site, lambda _: answer_probe(elsewhere))
    elsewhere.probe.write_text("token", encoding="ascii")  # a copy, on which it writes where nobody reads
    assert "it does not share the folder" in _refuse(site, lambda _: answer_probe(elsewhere))


@pytest.mark.long
def test_a_worker_that_joins_later_is_asked_as_well(site, tmp_path):
    (source,) = find_sources(write_city(tmp_path / "city", [40.0]))
    task = Task(source=source, settings=replace(FORMULAS, city=True), ground=StagedGround(tmp_path), out=tmp_path)
    assert run_checked(site, task).status == "assessed"
    assert [path.name for path in tmp_path.glob("probe*")] == ["probe"]
    other = replace(site, versions={"assess": "0.0.1"})
    with pytest.raises(WorkerUnfitError, match=r"other versions: assess .* there, 0\.0\.1 here"):
        run_checked(other, task)
