"""``assess rock``: one block under one record, as text, as one JSON document, as a figure."""

import json
from pathlib import Path
from typing import Annotated

import typer

from assess.cli.console import say, show_progress
from assess.cli.options import SIZE, AsJson, check_file, one_of, plot_of, write_files

ORDER = 5
EXAMPLES = (
    "assess rock --breadth 40 --height 180 --record floor12.smc",
    "assess rock --breadth 40 --height 180 --record floor12.csv#east --pfa 0.5 --plot rocking.png",
    "assess rock --breadth 40 --height 180 --record floor12.smc --cg 60",
    "assess rock --breadth 40 --height 180 --record floor12.csv#east --vertical floor12.csv#up --wall --friction 0.3",
    "assess rock --breadth 40 --height 180 --record floor12.smc --restitution 0.9 --baseline none --json",
)


def command(
    breadth: Annotated[float, typer.Option(help="Side parallel to the motion [cm].", show_default=False, **SIZE)],
    height: Annotated[float, typer.Option(help="Height [cm].", show_default=False, **SIZE)],
    record: Annotated[str, typer.Option(help="The motion: FILE or FILE#channel.", show_default=False)],
    pfa: Annotated[
        float | None, typer.Option(help="Scale the motion to this peak [g].", show_default="not scaled")
    ] = None,
    cg: Annotated[
        float | None, typer.Option(help="Height of the centre of gravity [% of the height].", show_default="50")
    ] = None,
    restitution: Annotated[
        float | None,
        typer.Option(help="Ratio of angular velocity after an impact to that before it.", show_default="Housner 1963"),
    ] = None,
    baseline: Annotated[
        str,
        typer.Option(
            help="Treatment of an uncorrected record: standard, none.", autocompletion=one_of(("standard", "none"))
        ),
    ] = "standard",
    wall: Annotated[bool, typer.Option("--wall", help="Show what it does with a wall on either side.")] = False,
    vertical: Annotated[
        str | None,
        typer.Option(
            help="Vertical motion, scaled like the horizontal one: FILE or FILE#channel.", show_default="none"
        ),
    ] = None,
    friction: Annotated[
        float | None, typer.Option(help="Show how it starts to move, and how far it slides.", show_default="no sliding")
    ] = None,
    as_json: AsJson = False,
    plot: Annotated[Path | None, plot_of("motion and rotation")] = None,
) -> None:
    """Integrate the rocking of one block under one record, by Housner's equation."""
    check_file(plot, "figure")
    with show_progress():
        from assess.cli.rock_output import describe, draw_figure, evaluate, list_lines, read_case

        case = read_case(breadth, height, record, pfa, restitution, baseline, cg)
        found = evaluate(case, wall=wall, vertical=vertical, friction=friction)
    say(json.dumps(describe(case, found), indent=1) if as_json else "\n".join(list_lines(case, found)))
    write_files({}, plot, lambda kind: (draw_figure(case, found.response, kind), 0), "")
