"""The command on studies: the paper done again, on data that comes along."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from assess.console import exits, stops
from assess.errors import InputError

if TYPE_CHECKING:
    from assess.studies import Finding, Options, Study

ALL = "all"
NAMES = "table1, solver, table2, contours, table3, fit"
"""Names of the studies: importing them for ``--help`` would take seconds. A test holds them against the studies."""
SMALLEST, LARGEST = 5.0, 600.0
"""Sizes of a piece [cm]."""
FEWEST = 20
"""Motions at least: the share of fewer tells nothing."""


def study(
    name: Annotated[str, typer.Argument(help=f"{NAMES}; or {ALL}, one after the other.", show_default=False)],
    out: Annotated[
        str, typer.Option(metavar="DIR", help="Folder of the files; parts in it keeps what takes long.")
    ] = "studies",
    runs: Annotated[
        int,
        typer.Option(
            min=FEWEST,
            max=1000,
            help=f"Motions generated for each channel; table2, contours, fit. Fewer than {FEWEST} tell nothing.",
        ),
    ] = 100,
    seed: Annotated[int, typer.Option(min=0, help="Of the generated motions.")] = 1,
    records: Annotated[
        str | None, typer.Option(metavar="DIR", help="Folder of your own records, for table1.", show_default=False)
    ] = None,
    breadth: Annotated[
        float | None, typer.Option(help="Of the piece that table1 and table2 show [cm].", show_default="45")
    ] = None,
    height: Annotated[float | None, typer.Option(help="The same [cm].", show_default="160")] = None,
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Threads; they change no number.", show_default="one a processor")
    ] = None,
) -> None:
    """Do a part of the paper again, or its comparison with direct integration: a page, tables and figures.

    table1, table3 and solver take seconds to a minute. table2, contours and fit share one long integration. What it has
    done is kept in the folder parts of --out: if a run is ended, the same command goes on from there.
    """
    with exits(lambda: _tell_kept(Path(out))), stops():
        from assess.studies import Options, all_studies
        from assess.studies._run import check_folder, run_all

        _check_named(out=out, records=records)
        every, folder = all_studies(), Path(out)
        chosen = [one for one in every if name.lower() in (one.name, ALL)]
        if not chosen:
            raise InputError(f"'{name}' is no study; expected one of {', '.join(one.name for one in every)}, {ALL}")
        options = Options(out=folder, runs=runs, seed=seed, jobs=jobs or os.cpu_count() or 1, tell=_tell)
        own = {"records": None if records is None else Path(records), "breadth": breadth, "height": height}
        options = _add_own(own, options, chosen, every)
        check_folder(folder)
        findings = run_all(chosen, options)
        if name.lower() == ALL:
            _write_page(chosen, findings, options)
        _tell_findings(chosen, findings, folder)


def _check_named(**folders: str | None) -> None:
    """Refuse a folder without a name, which would mean the one in which one stands."""
    for option, name in folders.items():
        if name is not None and not name.strip():
            raise InputError(f"--{option} is empty: name a folder, or leave --{option} away")


def _add_own(
    given: Mapping[str, Path | float | None], options: "Options", chosen: Sequence["Study"], every: Sequence["Study"]
) -> "Options":
    """Return the options with those that are the user's own; InputError if no chosen study looks at one of them."""
    from assess.units import LENGTH

    own: dict[str, Any] = {}
    for option, value in given.items():
        if value is None:
            continue
        if not any(option in one.takes for one in chosen):
            takers = ", ".join(one.name for one in every if option in one.takes)
            raise InputError(f"--{option} is nothing to {chosen[0].name}, only to {takers} and {ALL}: leave it out")
        own[option] = value * LENGTH["cm"] if isinstance(value, float) else value
    found = replace(options, **own)
    _check_piece(found.breadth / LENGTH["cm"], found.height / LENGTH["cm"])
    if found.records is not None and found.records.resolve() == found.out.resolve():
        raise InputError("--records and --out are one folder: name another for the files with --out")
    return found


def _check_piece(breadth: float, height: float) -> None:
    if not (SMALLEST <= breadth <= height <= LARGEST):
        raise InputError(
            f"--breadth and --height: expected sizes of {SMALLEST:g} to {LARGEST:g} cm, the breadth at most the "
            f"height; these are {breadth:g} and {height:g} cm"
        )


def _write_page(chosen: Sequence["Study"], findings: "Mapping[str, Finding]", options: "Options") -> None:
    from assess.studies._run import write_files
    from assess.studies._write import PAGE, build_page

    write_files(options.out, {PAGE: build_page(chosen, findings, options).encode("utf-8")})


def _tell_findings(chosen: Sequence["Study"], findings: "Mapping[str, Finding]", out: Path) -> None:
    """Print what came out, and tell where the files are."""
    from assess.studies._write import PAGE

    for one in chosen:
        for sentence in findings[one.name].summary:
            typer.echo(sentence)
    kept = _find_parts(out)
    page = out / (f"{chosen[0].name}.md" if len(chosen) == 1 else PAGE)
    typer.echo(f"wrote {page}" + (f"; {kept} keeps what took long, for the next run" if kept else ""), err=True)


def _tell_kept(out: Path) -> str:
    """Return what is left of a run that is ended."""
    kept = _find_parts(out)
    if kept is None:
        return "nothing is half written"
    return f"what is done is kept in {kept}, and the same command goes on from there"


def _find_parts(out: Path) -> Path | None:
    from assess.studies._parts import PARTS

    return out / PARTS if (out / PARTS).is_dir() else None


def _tell(what: str) -> None:
    typer.echo(what, err=True)
