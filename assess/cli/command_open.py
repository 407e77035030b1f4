"""``assess open``: the workbook as sheets and as a plan in the browser."""

import re
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields, replace
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.cli import interrupts
from assess.cli.console import open_address, say
from assess.cli.options import language_of
from assess.environment import say_install
from assess.errors import AssessError, InputError
from assess.i18n import find_language

if TYPE_CHECKING:
    from assess.web.limits import Limits
    from assess.web.server import Place, Server

ORDER = 2
EXAMPLES = (
    "assess open building.xlsx",
    "assess open",
    "assess open building.xlsx --port 8100 --no-browser --language it",
    "assess open --host 10.0.0.5 --port 8100 --allowed-host assess.example.org --user-header X-Remote-User",
    "assess open --host 10.0.0.5 --sessions /var/lib/assess --limit users=20",
)
PACKAGES = ("starlette", "uvicorn")
HOST = re.compile(r"(?:[A-Za-z0-9](?:[A-Za-z0-9.-]{0,252})|\[[0-9A-Fa-f:.]{2,45}\])(?::\d{1,5})?")
"""A name that browsers reach a proxy by, as they send it."""
HEADER = re.compile(r"[A-Za-z0-9-]{1,60}")
TAKEN = frozenset(
    ("cookie", "host", "origin", "x-assess", "content-length", "content-type", "accept", "user-agent", "connection")
)
"""Headers that browsers send by themselves."""


def command(
    path: Annotated[
        Path | None,
        typer.Argument(
            metavar="[WORKBOOK]",
            help="The workbook to open, .xlsx; without it the page begins with a new one.",
            show_default=False,
        ),
    ] = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port of the page; 0: any that is free.")] = 0,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only print the address of the page.")] = False,
    language: Annotated[str | None, language_of("the page", "the workbook's, else the browser's")] = None,
    host: Annotated[
        str, typer.Option(help="Address to listen at; other than this machine's only with the next two options.")
    ] = "127.0.0.1",
    allowed_host: Annotated[
        list[str] | None,
        typer.Option(
            help="For several users, behind a proxy: NAME or NAME:PORT by which browsers reach it; may be repeated.",
            show_default=False,
        ),
    ] = None,
    user_header: Annotated[
        str | None,
        typer.Option(help="Header in which that proxy, and nobody else, names the user.", show_default=False),
    ] = None,
    limit: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE", help="What sessions may take (docs/hosting.md); may be repeated.", show_default=False
        ),
    ] = None,
    sessions: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="Where the sessions of users stay for the next start; else they end with it.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Open a workbook in the browser: sheets, plan, what if, simulation and reports.

    Changes are saved in the workbook as you make them. Ctrl-C ends it. docs/hosting.md tells how to run it for others.
    """
    code = find_language(language) if language else ""
    if missing := [name for name in PACKAGES if find_spec(name) is None]:
        raise AssessError(f"the page needs {', '.join(missing)}, which is not installed. {say_install('web')}")
    from assess.delivery.folders import private_folder
    from assess.web.journal import set_aside
    from assess.web.limits import HOSTED, OWN, PREFIX
    from assess.web.server import Place, Server, bind

    limits = _change_limits(HOSTED if user_header else OWN, limit or ())
    place = Place(host, port, tuple(allowed_host or ()), user_header or "", code, limits, stays=sessions is not None)
    _check_place(place, path)
    set_aside(path)  # before it is tidied up
    with bind(place) as listening, _hold_folder(sessions) if sessions else private_folder(PREFIX) as folder:
        server = Server(listening, place, folder, Path.cwd())
        for remark in server.open(path) if not place.is_hosted else ():
            say(f"warning  {remark}", err=True)
        ending = server.run(interrupts.NUMBERS, lambda: _welcome(server, place, no_browser))
    for name in ending.lost:
        say(f"Changes of {name} were not downloaded and are gone.", err=True)
    for name, kept in ending.kept:
        say(f"Changes of {name} that were not saved in it are kept in {kept}.", err=True)
    if ending.saved:
        say(f"Stopped. All changes are saved in {ending.saved}.", err=True)
    else:
        say("Stopped.", err=True)


@contextmanager
def _hold_folder(folder: Path) -> Iterator[Path]:
    """Yield the folder of sessions, which one server at a time may use; InputError where another one does."""
    from assess.delivery.folders import FolderLock

    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"--sessions {folder} cannot be used: {error.strerror}.") from None
    lock = FolderLock(folder)
    if not lock.take():
        raise InputError(f"--sessions {folder} is in use by another server.")
    try:
        yield folder
    finally:
        lock.release()


def _change_limits(limits: "Limits", texts: Sequence[str]) -> "Limits":
    """Return limits with some changed; InputError for any that cannot be."""
    names = {one.name: one.type for one in fields(limits)}
    for text in texts:
        name, _, value = text.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = 0.0
        is_count = names.get(name) is int
        if name not in names or not number > 0 or (is_count and not number.is_integer()):
            what = "a whole number above 0" if is_count else "a number above 0"
            raise InputError(f"--limit {text!r}: expected NAME=VALUE, {what}, with a NAME of {', '.join(names)}.")
        limits = replace(limits, **{name: int(number) if is_count else number})  # type: ignore[arg-type]
    return limits


def _check_place(place: "Place", path: Path | None) -> None:
    """Raise InputError where others than the user could come in."""
    from assess.web.server import is_loopback

    for name in place.allowed:
        if not HOST.fullmatch(name):
            raise InputError(f"--allowed-host {name!r} is no NAME or NAME:PORT, such as assess.example.org.")
    if place.user_header and (not HEADER.fullmatch(place.user_header) or place.user_header.lower() in TAKEN):
        raise InputError(f"--user-header {place.user_header!r} is no header for the user, such as X-Remote-User.")
    if bool(place.allowed) != bool(place.user_header):
        raise InputError("--allowed-host and --user-header belong together: the proxy's names, and how it names users.")
    if not is_loopback(place.host) and not place.is_hosted:
        raise InputError(
            f"--host {place.host} can be reached from other machines: add --allowed-host and --user-header of a proxy "
            "that authenticates users (docs/hosting.md), or leave out --host."
        )
    if place.stays and not place.is_hosted:
        raise InputError("--sessions is for several users: add --allowed-host and --user-header, or leave it out.")
    if place.is_hosted and path is not None:
        raise InputError("each user of a hosted page opens a workbook of their own: leave out the workbook.")


def _welcome(server: "Server", place: "Place", no_browser: bool) -> None:
    """Print the address, open it in the browser, and do so again at each Enter."""

    def show() -> None:
        address = server.issue_address()
        say(address)
        sys.stdout.flush()
        if not (no_browser or place.is_hosted):
            threading.Thread(target=open_address, args=(address,), name="assess-browser", daemon=True).start()

    def repeat() -> None:
        for _ in sys.stdin:
            show()

    show()
    if place.is_hosted:
        say(f"Behind the proxy of {', '.join(place.allowed)}. Ctrl-C or SIGTERM ends it.", err=True)
    elif sys.stdin is not None and sys.stdin.isatty():
        say("Ctrl-C here ends it; Enter opens the page again.", err=True)
        threading.Thread(target=repeat, name="assess-enter", daemon=True).start()
