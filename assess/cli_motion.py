"""The commands on recorded motions: what a record holds, and one block under one record."""

import json
from pathlib import Path
from typing import Annotated

import typer

from assess.console import exits
from assess.errors import InputError


def record(
    files: Annotated[list[str], typer.Argument(help="Records: FILE or FILE#channel.", show_default=False)],
    as_json: Annotated[
        bool,
        typer.Option("--json", help="Print one JSON document instead: an object for one file, a list for several."),
    ] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw the channels to this .png, .svg or .pdf.")] = None,
) -> None:
    """Tell what records hold: channels, time step, PFA, PFV, displacement and 5 % spectrum, as assess treats them."""
    from assess.report.commands.records import check_figure, describe, list_lines, read_channels, write_figure

    if plot is not None:
        with exits():
            check_figure(plot)
    found, failed = [], 0
    for name in files:
        try:
            found.append(read_channels(name))
        except InputError as error:
            typer.echo(f"error  {error}", err=True)
            failed += 1
    if not found:
        raise typer.Exit(2)
    documents = [describe(channels) for channels in found]
    if as_json:
        typer.echo(json.dumps(documents[0] if len(files) == 1 else documents, ensure_ascii=False, indent=1))
    else:
        typer.echo("\n\n".join("\n".join(list_lines(document)) for document in documents))
    if plot is not None:
        with exits():
            channels = [channel for ones in found for channel in ones]
            drawn = write_figure(channels, plot)
        left = f"; {len(channels) - drawn} more channels are not drawn" if drawn < len(channels) else ""
        typer.echo(f"wrote {plot}{left}", err=True)
    if failed:
        raise typer.Exit(1)


def rock(
    breadth: Annotated[float, typer.Option(help="Side parallel to the motion [cm].", show_default=False)],
    height: Annotated[float, typer.Option(help="[cm]", show_default=False)],
    record: Annotated[str, typer.Option(help="The motion: FILE or FILE#channel.", show_default=False)],
    pfa: Annotated[float | None, typer.Option(help="Scale it to this peak [g].", show_default="not scaled")] = None,
    restitution: Annotated[
        float | None, typer.Option(help="Angular velocity after an impact over before.", show_default="Housner's")
    ] = None,
    baseline: Annotated[str, typer.Option(help="Treatment of an uncorrected record: standard, none.")] = "standard",
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON document instead.")] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw motion and rotation to this .png, .svg or .pdf.")] = None,
) -> None:
    """Rock one block under one record: whether it overturns, by direct integration of Housner's equation."""
    from assess.report.commands.records import check_figure
    from assess.report.commands.rocking import describe, list_lines, read_case, write_figure

    with exits():
        if plot is not None:
            check_figure(plot)
        case = read_case(breadth, height, record, pfa, restitution, baseline)
        from assess.rocking.response import follow_block

        try:
            response = follow_block(
                case.breadth, case.height, case.motion.acceleration, case.motion.time_step, restitution=case.restitution
            )
        except ValueError as error:  # how stocky a block may be, only the integration knows
            raise InputError(f"--breadth and --height: {error}") from None
        if as_json:
            typer.echo(json.dumps(describe(case, response), indent=1))
        else:
            typer.echo("\n".join(list_lines(case, response)))
        if plot is not None:
            write_figure(case, response, plot)
            typer.echo(f"wrote {plot}", err=True)
