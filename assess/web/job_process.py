"""The process of one simulation: the very calls of `assess run` on a copy of the workbook, reported line by line.

``python -m assess.web.job_process FOLDER``: FOLDER holds ``job.json`` and ``input/``; it gets ``out/`` with the reports
and ``summary.json``. Each line of the output is a JSON object. The process ends at once when its input is closed, as
that is when the server has ended, however it did; the folder is then removed.
"""

import json
import os
import shutil
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from assess.errors import AssessError, PdfUnavailableError, WorkbookError
from assess.i18n import fill, gettext, load_catalogue, speaking
from assess.processes import limit_process
from assess.progress import Progress, Report
from assess.results import Results
from assess.risk import RiskClass
from assess.settings import Settings, count_processors
from assess.web.request_errors import describe_problem

ORDER, LIMITS, INPUT, OUT, SUMMARY = "job.json", "limits.json", "input", "out", "summary.json"
PLAIN = frozenset(("json", "csv", "xlsx"))
"""Formats that need no series of figures."""
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
        shutil.rmtree(folder, ignore_errors=True)
        os._exit(1)

    threading.Thread(target=end_with_server, name="assess-server", daemon=True).start()
    if hasattr(os, "nice"):
        os.nice(LOWER_PRIORITY)
    order, limits = (json.loads((folder / name).read_text(encoding="utf-8")) for name in (ORDER, LIMITS))
    limit_process(*limits)
    with speaking(load_catalogue(order["language"])):
        try:
            send({"state": "done", **assess_workbook(folder, order, send)})
        except AssessError as error:
            problems = list(map(describe_problem, error.problems if isinstance(error, WorkbookError) else ()))
            send({"state": "failed", "message": gettext(error.message), "problems": problems})
        except MemoryError:
            text = fill(
                "The simulation needs more than {n:,.0f} MB of memory, which is the limit here.", n=limits[0] / 1e6
            )
            send({"state": "failed", "message": gettext(text), "problems": []})
        except OSError as error:
            send({"state": "failed", "message": error.strerror or type(error).__name__, "problems": []})
    os._exit(0)  # without waiting for anything that is still computed aside


def assess_workbook(folder: Path, order: dict[str, Any], send: Send) -> dict[str, Any]:
    """Assess the workbook, write reports and summary, and return messages; raises AssessError as `assess run`."""
    from assess.pipeline.run import run
    from assess.report import write_reports
    from assess.report.report_options import ReportOptions
    from assess.workbook.read import read_inventory

    latest, stage = 0.0, ("", "")

    def listen(report: Report) -> None:
        nonlocal latest, stage
        now, of = time.monotonic(), (report.stage, report.detail)
        if of != stage or now - latest >= SENT_EVERY:
            latest, stage = now, of
            send({name: getattr(report, name) for name in ("stage", "share", "detail", "seconds_left")})

    progress, formats = Progress(listen), order["formats"]
    settings = Settings(**order["settings"])
    inventory = read_inventory(folder / INPUT / order["workbook"], progress=progress)
    threads = max(1, count_processors() - 1)
    results = run(inventory, settings, jobs=threads, figures=not set(formats) <= PLAIN, progress=progress)
    message = ""
    try:
        write_reports(results, folder / OUT, formats, ReportOptions(), progress=progress)
    except PdfUnavailableError as error:  # all other formats are there
        message = gettext(error.message)
    (folder / SUMMARY).write_text(json.dumps(summarise(results)), encoding="utf-8")
    return {"message": message, "problems": [describe_problem(one) for one in results.problem_rows]}


def summarise(results: Results) -> dict[str, Any]:
    """Return the rows of the furniture with their classes, and what is to be expected before and after."""
    from assess.report.words import find_range

    rows = list(results)
    items = {
        "row": [one.item.row for one in rows],
        "quantity": [one.item.quantity for one in rows],
        "class": ["" if one.is_anchored else one.adopted.risk.name.lower() for one in rows],
        "formula": ["" if one.is_anchored else one.formula_class.name.lower() for one in rows],
        "chance": [one.adopted.probability for one in rows],
        "low": [found and found[0] for found in map(find_range, rows)],
        "high": [found and found[1] for found in map(find_range, rows)],
        "simulated": [one.adopted.is_simulated or not one.adopted.can_rock for one in rows],
    }
    schedule, anchor = results.schedule, results.settings.anchor
    names = ("falls", "falls_low", "falls_high", "anchored", "apart", "blocked_routes", "cut_off_rooms")
    sums: dict[str, Any] = {
        when: {
            "counts": {risk.name.lower(): state.count(risk) for risk in RiskClass},
            **{name: getattr(state, name) for name in names},
        }
        for when, state in (("before", schedule.before), ("after", schedule.after))
    }
    sums |= {"cost": schedule.cost, "entries": len(schedule.rows), "first": anchor if isinstance(anchor, int) else 0}
    return {"items": items, "before_after": sums}


if __name__ == "__main__":
    main()
