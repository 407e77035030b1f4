"""The process of one run: the very calls of `assess run` on a copy of the workbook, then its files, one after another.

``python -m assess.web.job_process FOLDER``: FOLDER holds ``job.json`` and ``input/``; it gets ``summary.json`` and
``results.pickle`` as soon as the results are there, and each file in a folder of its own in ``out/``, named by its
format. Where the results are there already, only files are made. ``job.json`` is looked at after each file: more may be
asked for meanwhile. Each line of the output is a JSON object. The process ends at once when its input is closed, as
that is when the server has ended, however it did; a run without results is then removed.
"""

import json
import os
import pickle
import shutil
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from assess.errors import AssessError, PdfUnavailableError, WorkbookError
from assess.i18n import LANGUAGES, fill, gettext, load_catalogue, speaking
from assess.processes import limit_process
from assess.progress import Progress, Report
from assess.results import Results
from assess.settings import Settings, count_processors
from assess.web.overview import describe_results
from assess.web.request_errors import describe_problem

ORDER, INPUT, OUT, SUMMARY, RESULTS = "job.json", "input", "out", "summary.json", "results.pickle"
SENT_EVERY = 0.1
"""Shortest time between two reports of one stage [s]."""
LOWER_PRIORITY = 5
"""How far this process stands back for the server, which answers while it works."""
Send = Callable[[dict[str, Any]], None]


def main() -> None:
    """Do the job of the folder that is named."""
    folder = Path(sys.argv[1])
    stream = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # whatever else is printed goes to the standard error
    lock = threading.Lock()

    def send(message: dict[str, Any]) -> None:
        with lock:
            stream.write(json.dumps(message) + "\n")
            stream.flush()

    def end_with_server() -> None:
        sys.stdin.buffer.read()
        if not (folder / RESULTS).is_file():
            shutil.rmtree(folder, ignore_errors=True)
        os._exit(1)

    threading.Thread(target=end_with_server, name="assess-server", daemon=True).start()
    if hasattr(os, "nice"):
        os.nice(LOWER_PRIORITY)
    order = _read_order(folder)
    limit_process(*order["limits"])
    with speaking(load_catalogue(order["language"])):
        try:
            results = load_or_compute(folder, send)
            while todo := [one for one in _read_order(folder)["formats"] if not (folder / OUT / one).exists()]:
                send({"writing": todo[0]})
                send({"written": todo[0], "message": write_file(results, folder, todo[0])})
            send({"state": "done"})
        except AssessError as error:
            problems = list(map(describe_problem, error.problems if isinstance(error, WorkbookError) else ()))
            send({"state": "failed", "message": gettext(error.message), "problems": problems})
        except MemoryError:
            most = order["limits"][0] / 1e6
            text = fill("The run needs more than {most:,.0f} MB of memory, which is the limit here.", most=most)
            send({"state": "failed", "message": gettext(text), "problems": []})
        except OSError as error:
            send({"state": "failed", "message": error.strerror or type(error).__name__, "problems": []})
    os._exit(0)  # without waiting for anything that is still computed aside


def _read_order(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / ORDER).read_text(encoding="utf-8"))
    return found


def load_or_compute(folder: Path, send: Send) -> Results:
    """Return the results of a run, assessed where they are not there yet; raises AssessError as `assess run`."""
    from assess.pipeline.run import run
    from assess.workbook.read import read_inventory

    if (folder / RESULTS).is_file():
        kept: Results = pickle.loads((folder / RESULTS).read_bytes())  # noqa: S301 - our own, in a folder of our own
        return kept
    latest, stage = 0.0, ("", "")

    def listen(report: Report) -> None:
        nonlocal latest, stage
        now, of = time.monotonic(), (report.stage, report.detail)
        if of != stage or now - latest >= SENT_EVERY:
            latest, stage = now, of
            send({name: getattr(report, name) for name in ("stage", "share", "detail")})

    progress, order = Progress(listen), _read_order(folder)
    inventory = read_inventory(folder / INPUT / order["workbook"], progress=progress)
    settings, threads = Settings(**order["settings"]), max(1, count_processors() - 1)
    results = run(inventory, settings, jobs=threads, series_folder=folder, progress=progress)
    write_file(results, folder, "json")
    (folder / SUMMARY).write_text(json.dumps(summarise(results)), encoding="utf-8")
    part = folder / f"{RESULTS}.part"
    part.write_bytes(pickle.dumps(results))
    part.replace(folder / RESULTS)  # last, as it tells that all is there
    send({"found": True})
    return results


def write_file(results: Results, folder: Path, name: str) -> str:
    """Write the file of a format in a folder of its own; return why there is none where a library is missing."""
    from assess.report import write_reports
    from assess.report.report_options import ReportOptions

    message = ""
    (folder / OUT).mkdir(exist_ok=True)
    part = folder / OUT / f".{name}"
    shutil.rmtree(part, ignore_errors=True)
    try:
        write_reports(results, part, [name], ReportOptions())
    except PdfUnavailableError as error:
        message = gettext(error.message)
    part.mkdir(exist_ok=True)
    part.replace(folder / OUT / name)
    return message


def summarise(results: Results) -> Mapping[str, Any]:
    """Return what is to be expected, in every language."""
    found = {}
    for code in LANGUAGES:
        with speaking(load_catalogue(code)):
            found[code] = describe_results(results)
    return found


if __name__ == "__main__":
    main()
