"""Deliver files again and again, each time killed one step later, until it comes through: a script, run by tests.

``python killer.py WAY FOLDER STRIDE`` takes every STRIDE-th moment and prints one JSON document: for each what the
folder held right after the kill, and what it held after the next run. A moment is a line of `assess.delivery`, or what
the interpreter reports (an audit event) before it opens, renames, links, removes or makes a file or a folder, wherever
it is called. Forking is safe here: this process has no threads.
"""

import contextlib
import json
import os
import shutil
import signal
import sys
from pathlib import Path

from assess.delivery import folders
from assess.delivery.deliver import deliver, is_unfinished, save, stage_for
from assess.delivery.folders import NEW, sweep

DATA = "list.json"
OLD = {"report.html": "old", "items.csv": "old", "gone.pdf": "old", DATA: "old"}
FRESH = {"report.html": "new", "items.csv": "new", "added.xlsx": "new", DATA: "new"}
NEXT = dict.fromkeys(FRESH, "next")
EVENTS = ("open", "os.", "shutil.")
OWN = str(Path(folders.__file__).parent)


class Killer:
    """Kills this process at a step."""

    def __init__(self, step: int) -> None:
        self.left, self.is_on = step, True

    def count(self) -> None:
        self.left -= 1
        if self.left < 0 and self.is_on:
            self.is_on = False  # the kill is an event, too
            os.kill(os.getpid(), signal.SIGKILL)

    def trace(self, frame, event, _argument):
        if not frame.f_code.co_filename.startswith(OWN):
            return None
        if event == "line":
            self.count()
        return self.trace

    def audit(self, event, _arguments):
        if event.startswith(EVENTS):
            self.count()


def fill(folder, files):
    for name, text in files.items():
        (folder / name).write_text(text)


def find_old(folder):
    return [name for name in {**OLD, **FRESH} if (folder / name).is_file()]


def work(way, folder, files=None):
    """Deliver the new files."""
    files = files or FRESH
    if way == "save":
        save({folder / name: text.encode() for name, text in files.items()})
        return
    with stage_for(folder) as stage:
        fill(stage / NEW, files)
        deliver(stage, folder, find_old, DATA)


def fail(way, folder):
    """Deliver the new files, with a move that fails: the old ones return."""
    whole = Path.replace

    def replace(self, target):
        if self.name == "report.html" and self.parent.name == NEW:
            raise PermissionError(13, "open in another program", str(self), None, str(target))
        return whole(self, target)

    setattr(Path, "replace", replace)  # noqa: B010 - as type checkers allow it
    with contextlib.suppress(PermissionError):
        work(way, folder)


def look(folder):
    return {path.name: path.read_text() for path in folder.iterdir() if path.is_file() and path.name[0] != "."}


def prepare(folder):
    """Make the folder as it was before, with a file of the user's."""
    shutil.rmtree(folder.parent, ignore_errors=True)
    folder.mkdir(parents=True)
    fill(folder, OLD | {"mine.txt": "mine"})


def run_killed(step, act, *words):
    """Act in a process that is killed at a step; return whether it was."""
    child = os.fork()
    if child == 0:
        killer = Killer(step)
        sys.addaudithook(killer.audit)
        sys.settrace(killer.trace)
        try:
            act(*words)
            killer.is_on = False
        finally:
            os._exit(killer.is_on)
    status = os.waitpid(child, 0)[1]
    assert os.WIFSIGNALED(status) or status == 0
    return status != 0


def look_whole(folder):
    """Return what readers see: nothing of a folder that is unfinished."""
    return None if is_unfinished(folder, DATA) or not (folder / DATA).exists() else look(folder)


def main():
    way, folder, found, step = sys.argv[1], Path(sys.argv[2]) / "parent" / "out", [], 0
    act = fail if way == "undo" else work
    killed = True
    while killed:
        prepare(folder)
        if way == "twice":  # a second run is killed where a first one was
            run_killed(step // 2, work, "list", folder)
        killed = run_killed(step, act, way, folder, *([NEXT] if way == "twice" else []))
        before = look_whole(folder)
        work("save" if way == "save" else "list", folder, NEXT)
        for place in (folder, folder.parent):
            sweep(place)
        left = [path.name for place in (folder, folder.parent) for path in place.iterdir() if path.name[0] == "."]
        found.append({"before": before, "after": look(folder), "left": left})
        step += int(sys.argv[3])
    print(json.dumps(found))


if __name__ == "__main__":
    main()
