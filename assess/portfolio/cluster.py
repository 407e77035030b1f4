"""Tasks on the workers of a dask scheduler, on one machine or many that share the folders.

Before any work every worker is asked for its versions, its threads, and whether it sees the folder of the results and
the workbooks. Each task asks again, as workers may come later. A worker that dies is the business of dask: its task is
given to another one, and skipped where it keeps killing them. Whoever can reach a scheduler can run code on its
workers: it belongs in a trusted network.
"""

import asyncio
import hashlib
import os
import platform
import re
import time
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import CancelledError as FutureCancelled, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.environment import say_install
from assess.errors import CancelledError, InputError, OutputError
from assess.i18n import fill, join
from assess.portfolio.building_task import FOLDER, Summary, Task, give_up, run_task
from assess.progress import SILENT, Progress
from assess.text import plain_line
from assess.version import __version__, find_code

if TYPE_CHECKING:
    from distributed import Client, Future

WINDOW = 8  # tasks that are handed to the scheduler at once, a worker
CONNECTING, JOINING = 10.0, 30.0  # times [s] that the scheduler, and its first worker, are waited for
_ASKED_EVERY = 0.5
_PROBE = ".probe-"
_ADDRESS = re.compile(
    r"(?:(?:tcp|tls|ucx|wss?)://)?(?:\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9][A-Za-z0-9._-]*):(\d{1,5})", re.ASCII
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Site:
    """What every worker has to agree with: versions, a probe in the folder of the results, files to find."""

    versions: Mapping[str, str]
    probe: Path
    token: str
    seen: tuple[Path, ...]


def list_versions() -> dict[str, str]:
    """Return the versions that results depend on."""
    import numba
    import numpy
    import scipy

    return {
        "assess": f"{__version__} ({find_code()[:12]})",
        "Python": ".".join(platform.python_version_tuple()[:2]),
        "numpy": numpy.__version__, "scipy": scipy.__version__, "numba": numba.__version__,
    }  # fmt: skip


def check_cluster(scheduler: str) -> None:
    """Raise InputError unless the address has the form of that of a scheduler, and dask is installed."""
    match = _ADDRESS.fullmatch(scheduler)
    if match is None or not 0 < int(match[1]) < 65536:
        raise InputError.about(
            "scheduler is {address!r}, expected tcp://HOST:PORT, such as tcp://10.0.0.5:8786 (tls, ucx, ws or wss "
            "may take the place of tcp)",
            address=plain_line(scheduler)[:100],
        )
    try:
        import distributed  # noqa: F401
    except ImportError:
        raise InputError.about(
            "scheduler: dask is needed, which is not installed. {how}", how=say_install("cluster")
        ) from None


def run_on_cluster(tasks: Sequence[Task], scheduler: str, progress: Progress = SILENT) -> Iterator[Summary]:
    """Yield the summaries of tasks as workers get them done, in no order; the paths are the same on every machine.

    Raises InputError if dask is not installed, no scheduler with workers is at the address, or a worker is not fit for
    the work; OutputError if the scheduler is lost; CancelledError if the work was cancelled: parts that are written
    stay.
    """
    check_cluster(scheduler)
    token, folder = os.urandom(8).hex(), tasks[0].out / FOLDER
    workbook = next((one.source.file for one in tasks if one.source.file is not None and not one.source.refused), None)
    files = (workbook, getattr(tasks[0].ground, "path", None))
    seen = tuple(one for one in files if one is not None)
    with _connect(scheduler, progress) as client:
        probe = folder / f"{_PROBE}{token}"  # every worker has to read it, and to answer next to it
        probe.write_text(token, encoding="ascii")
        try:
            latest = time.monotonic() + JOINING
            while not client.nthreads():
                progress.check()
                if time.monotonic() > latest:
                    raise InputError.about(
                        "scheduler {address} has no workers. Start some with one thread each, by the command: dask "
                        "worker", address=scheduler,
                    )  # fmt: skip
                time.sleep(_ASKED_EVERY)
            site = Site(versions=list_versions(), probe=probe, token=token, seen=seen)
            check_workers(client, site)
            yield from _hand_over(client, site, tasks, scheduler, progress)
        finally:
            for path in folder.glob(f"{_PROBE}{token}*"):
                with suppress(OSError):
                    path.unlink()


@contextmanager
def _connect(scheduler: str, progress: Progress) -> Iterator["Client"]:
    from distributed import Client

    # a Client that fails says so for itself, at length and late: who is there is asked first
    try:
        with ThreadPoolExecutor(1) as thread:  # the caller may have a loop of its own
            answer = thread.submit(asyncio.run, _ask(scheduler, progress)).result()
        if not isinstance(answer, dict) or answer.get("type") != "Scheduler":
            raise ValueError  # a worker, or another program
        client = Client(scheduler, timeout=CONNECTING, set_as_default=False)
    except CancelledError:
        raise
    except Exception as error:  # whatever dask makes of what it was sent
        # a TypeError: there is no certificate; an ImportError: no package for the protocol
        if isinstance(error, TimeoutError) or not isinstance(error, OSError | TypeError | ImportError):
            raise InputError.about(
                "scheduler {address}: what is there does not answer as a dask scheduler of this version. Check host "
                "and port: a scheduler prints its address when it starts.", address=scheduler,
            ) from None  # fmt: skip
        inner: BaseException | None = error
        while inner is not None and not (isinstance(inner, OSError) and inner.strerror):
            inner = getattr(inner, "real_error", None) or inner.__cause__  # what the system refused, which dask wraps
        why = plain_line(str(getattr(inner, "strerror", None) or error)).strip() or type(error).__name__
        raise InputError.about(
            "scheduler {address} cannot be reached: {why}. Is it running?", address=scheduler, why=why
        ) from None
    try:
        yield client
    finally:
        with suppress(Exception):  # a scheduler that is gone
            client.close(timeout=2)


async def _ask(scheduler: str, progress: Progress) -> Any:
    """Return what is answered at the address to the question who is there; raises what comes instead."""

    async def ask() -> Any:
        from distributed.comm import connect
        from distributed.security import Security

        comm = await connect(scheduler, timeout=CONNECTING / 2, **Security().get_connection_args("client"))
        try:
            await comm.write({"op": "identity", "reply": True})
            return await comm.read()
        finally:
            comm.abort()

    asking = asyncio.ensure_future(ask())
    try:
        async with asyncio.timeout(CONNECTING):
            while not asking.done():
                progress.check()
                await asyncio.wait((asking,), timeout=_ASKED_EVERY / 5)
        return asking.result()
    finally:
        asking.cancel()


def check_workers(client: "Client", site: Site) -> None:
    """Raise InputError unless every worker can do the work."""
    answers = client.run(answer_probe, site, on_error="return")
    faults = [
        fill("worker {address}: {fault}", address=plain_line(str(address)), fault=fault)
        for address, answer in sorted(answers.items())
        if (fault := _judge(answer, site))
    ]
    if faults:
        raise InputError(join("\n", faults[:10]))


def answer_probe(site: Site, dask_worker: Any = None) -> dict[str, Any]:
    """Return, on a worker, what it has: versions, threads, and whether it sees the folders; answer the probe."""
    found: dict[str, Any] = {"versions": list_versions(), "fault": "", "name": ""}
    if dask_worker is not None:
        found["threads"] = dask_worker.state.nthreads
    try:
        if site.probe.read_text(encoding="ascii") == site.token:
            answer = site.probe.with_name(f"{site.probe.name}-{os.urandom(6).hex()}")
            answer.write_text(site.token, encoding="ascii")
            found["name"] = answer.name
    except OSError as error:
        found["fault"] = error.strerror or str(error)
    found["unseen"] = next((str(path) for path in site.seen if not path.exists()), "")
    return found


def _judge(answer: Any, site: Site) -> str:
    """Return why a worker cannot do the work; "" if it can."""
    if isinstance(answer, ImportError):
        return fill("assess is not installed there, or in another version ({why}).", why=str(answer)[:100])
    if not isinstance(answer, dict):
        return fill("it does not answer ({why}).", why=f"{type(answer).__name__}: {str(answer)[:200]}")
    others = [
        fill("{name} {theirs} there, {ours} here", name=name, theirs=answer["versions"].get(name, "?"), ours=ours)
        for name, ours in site.versions.items()
        if answer["versions"].get(name) != ours
    ]
    if others:
        return fill("other versions: {list}. Install the same everywhere.", list=join("; ", others))
    if answer.get("threads", 1) != 1:
        return fill("it has {n} threads. Start it with one thread.", n=answer["threads"])
    if not (site.probe.parent / answer["name"]).is_file():
        why = answer["fault"] or fill("it sees another folder of this name")
        return fill(
            "it does not share the folder {folder} ({why}). Name a folder that all machines see under one path.",
            folder=site.probe.parent,
            why=why,
        )
    if answer["unseen"]:
        return fill("it does not see {file}. Put it in a folder that all machines share.", file=answer["unseen"])
    return ""


class WorkerUnfitError(Exception):
    """A worker that came later cannot do the work."""


def run_checked(site: Site, task: Task) -> Summary:
    """Do a task on a worker, if it can; raises WorkerUnfitError if it has other versions, or lacks the folders."""
    answer = answer_probe(site)
    if fault := _judge(answer, site):
        raise WorkerUnfitError(f"{platform.node()}: {fault}")
    with suppress(OSError):
        (site.probe.parent / answer["name"]).unlink()
    return run_task(task)


def _hand_over(
    client: "Client", site: Site, tasks: Sequence[Task], scheduler: str, progress: Progress
) -> Iterator[Summary]:
    """Keep a window of tasks with the scheduler, and yield what comes back; OutputError if the scheduler is gone."""
    from distributed import KilledWorker

    lost = OutputError.about(
        "the scheduler {address} is gone. What is done is kept: start it and run the same command again.",
        address=scheduler,
    )
    left, running = deque(tasks), dict["Future", Task]()
    try:
        while left or running:
            try:
                most = WINDOW * max(1, len(client.nthreads()))
            except (OSError, TimeoutError):
                raise lost from None
            while left and len(running) < most:
                task = left.popleft()
                name = hashlib.sha256(f"{task.out}\n{task.source.path}".encode()).hexdigest()
                key = f"assess-{name[:20]}-{os.getpid()}"  # no other run on the scheduler has it
                running[client.submit(run_checked, site, task, key=key, pure=False, retries=2)] = task
            # an answer is lost with the worker that held it: the scheduler has the task done again
            while not (done := [future for future in running if future.status not in ("pending", "lost")]):
                progress.check()
                if client.status != "running":
                    raise lost
                time.sleep(_ASKED_EVERY / 10)
            for future in done:
                if future.status == "cancelled":
                    raise lost
                task = running.pop(future)
                error = future.exception() if future.status == "error" else None
                if isinstance(error, KilledWorker):
                    yield give_up(task)
                    continue
                if isinstance(error, WorkerUnfitError):
                    raise InputError.about("a worker that joined later cannot do the work: {why}", why=error) from None
                if error is not None:
                    why = f"{type(error).__name__}: {str(error)[:300]}"
                    raise OutputError.about("a worker failed: {why}", why=why) from error
                try:
                    summary: Summary = future.result()
                except (OSError, TimeoutError, asyncio.CancelledError, FutureCancelled):
                    # the scheduler died when the answer was there
                    raise lost from None
                yield summary
    finally:
        with suppress(Exception):  # a scheduler that is gone
            client.cancel(list(running), force=True)
