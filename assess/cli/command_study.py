"""``assess study``: a part of the paper done again, on open data that comes along."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from assess.cli.console import InterruptedWorkError, say, show_progress
from assess.cli.options import SIZE, Jobs, check_size, one_of
from assess.errors import CancelledError, InputError
from assess.settings import count_processors
from assess.units import LENGTH

if TYPE_CHECKING:
    pass

ORDER = 7
EXAMPLES = (
    "assess study table3",
    "assess study table1 --records my-records --breadth 40 --height 180",
    "assess study table2 --runs 200 --seed 2",
    "assess study all --out studies --jobs 4",
)

ALL = "all"
_FOLDER = Path(__file__).parents[1] / "studies"
_FILES = {(one.parent.name if one.stem == "__init__" else one.stem): one for one in _FOLDER.rglob("*.py")}
_STUDIES = sorted(name for name, file in _FILES.items() if "\nSTUDY = " in file.read_text(encoding="utf-8"))
NAMES = ", ".join(_STUDIES)
"""Names of the studies, which are those of their modules: importing them for ``--help`` would take seconds."""
FEWEST, MOST = 20, 1000  # fewest and most motions: a share of fewer is too uncertain


def command(
    name: Annotated[
        str,
        typer.Argument(
            help=f"{NAMES}; or {ALL}, one after the other.",
            show_default=False,
            autocompletion=one_of((*_STUDIES, ALL)),
        ),
    ],
    out: Annotated[
        str, typer.Option(metavar="DIR", help="Folder of the files; its folder parts keeps long integrations.")
    ] = "studies",
    runs: Annotated[
        int,
        typer.Option(
            min=FEWEST, max=MOST, help="Motions generated for each channel; table2, contours, fit, calibration."
        ),
    ] = 100,
    seed: Annotated[int, typer.Option(min=0, help="Random seed of the generated motions.")] = 1,
    records: Annotated[
        str | None, typer.Option(metavar="DIR", help="Folder of your own records, for table1.", show_default=False)
    ] = None,
    breadth: Annotated[
        float | None, typer.Option(help="Breadth of the piece in table1 and table2 [cm].", show_default="45", **SIZE)
    ] = None,
    height: Annotated[
        float | None, typer.Option(help="Height of the piece in table1 and table2 [cm].", show_default="160", **SIZE)
    ] = None,
    jobs: Jobs = None,
) -> None:
    """Do a part of the paper again: a page, tables and figures.

    The studies repeat results of the paper on open data, or compare its formulas with direct integration.

    table1, table3 and solver take seconds to a minute. table2, contours and fit share one long integration, and
    calibration has its own; finished parts are kept in the folder parts of --out: after an interruption, the same
    command continues from there.
    """
    for option, folder in (("out", out), ("records", records)):
        if folder is not None and not folder.strip():
            raise InputError(f"--{option} is empty: name a folder, or leave out --{option}")
    target = Path(out)
    given = {"records": None if records is None else Path(records), "breadth": breadth, "height": height}
    own: dict[str, Any] = {option: value for option, value in given.items() if value is not None}
    try:
        with show_progress() as progress:
            from assess.studies import PAGE, PARTS, Options, all_studies, build_page, check_folder, run_all, write_files

            every = all_studies()
            chosen = [one for one in every if name.lower() in (one.name, ALL)]
            if not chosen:
                raise InputError(f"{name!r} is an unknown study; expected one of: {NAMES}, {ALL}")
            for option, value in own.items():
                if not any(option in one.takes for one in chosen):
                    takers = ", ".join(one.name for one in every if option in one.takes)
                    raise InputError(
                        f"--{option} does not apply to {chosen[0].name}, only to {takers} and {ALL}: leave it out"
                    )
                if isinstance(value, float):
                    check_size(option, value)
                    own[option] = value * LENGTH["cm"]
            options = Options(out=target, runs=runs, seed=seed, jobs=jobs or count_processors(), **own)
            if options.breadth > options.height:
                broad, high = (size / LENGTH["cm"] for size in (options.breadth, options.height))
                raise InputError(f"--breadth is {broad:g} cm, expected at most the height, {high:g} cm")
            if options.records is not None and options.records.resolve() == target.resolve():
                raise InputError("--records and --out are the same folder: name another one for the files with --out")
            check_folder(target)
            findings = run_all(chosen, options, progress)
            if name.lower() == ALL:
                write_files(target, {PAGE: build_page(chosen, findings, options).encode("utf-8")})
            for sentence in (text for one in chosen for text in findings[one.name].summary):
                say(sentence)
            page = target / (f"{chosen[0].name}.md" if len(chosen) == 1 else PAGE)
            kept = f"; {target / PARTS} keeps the long integrations for the next run"
            say(f"wrote {page}{kept if (target / PARTS).is_dir() else ''}", err=True)
    except (KeyboardInterrupt, CancelledError):
        from assess.studies import PARTS

        kept = f"finished parts are kept in {target / PARTS}; the same command continues from there"
        raise InterruptedWorkError(kept if (target / PARTS).is_dir() else "nothing was written") from None
