"""``assess record``: what files of recorded motion hold, as text, as one JSON document, as a figure."""

import json
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from assess.cli.console import print_error, say, show_progress
from assess.cli.options import AsJson, check_file, plot_of, write_files
from assess.errors import InputError
from assess.i18n import count
from assess.units import GRAVITY

if TYPE_CHECKING:
    from assess.arrays import FloatArray
    from assess.motion.formats import Channel
    from assess.motion.record import Motion

ORDER = 6
EXAMPLES = (
    "assess record floor12.smc",
    "assess record set.zip#CHAN01.V2/1 roof.at2 --plot motions.png",
    "assess record floor12.smc --json",
)

PERIODS = (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)
"""Periods of the printed spectrum [s]."""
MOST_DRAWN = 12  # channels in one figure


def command(
    files: Annotated[list[str], typer.Argument(help="Records: FILE or FILE#channel.", show_default=False)],
    as_json: AsJson = False,
    plot: Annotated[Path | None, plot_of("the channels")] = None,
) -> None:
    """Show what files of recorded motion hold.

    Channels, time step, PFA, PFV, displacement and 5 % spectrum, as assess treats them. With --json, one file gives one
    object, several files give a list.
    """
    check_file(plot, "figure")
    found = []
    with show_progress():
        from assess.motion.formats import read_channels

        for name in files:
            try:
                if channels := read_channels(name):
                    found.append(channels)
            except InputError as error:
                print_error(str(error))
        documents = [describe(channels) for channels in found]
    if not found:
        raise typer.Exit(2)
    if as_json:
        say(json.dumps(documents[0] if len(files) == 1 else documents, ensure_ascii=False, indent=1))
    else:
        say("\n\n".join("\n".join(list_lines(document)) for document in documents))
    write_files({}, plot, partial(draw_channels, [channel for every in found for channel in every]), "channel")
    if len(found) < len(files):
        raise typer.Exit(1)


def describe(channels: Sequence["Channel"]) -> dict[str, Any]:
    """Return the document of `assess record --json` for the channels of one file."""
    from assess.motion.record import treatment

    return {
        "file": channels[0].record.file.split("/")[0],
        "format": ", ".join(dict.fromkeys(one.record.format for one in channels)),
        "channels": [
            {
                "channel": record.channel, "name": name, "member": record.file, "location": record.location,
                "azimuth_deg": record.azimuth_deg, "vertical": record.vertical, "station": record.station,
                "event": record.event, "start": record.start, "time_step_s": record.time_step,
                "samples": int(record.acceleration.size),
                "pfa_header_g": None if record.header_pfa is None else record.header_pfa / GRAVITY,
                "pfa_file_g": record.file_pfa / GRAVITY, "pfa_g": motion.pfa / GRAVITY, "pfv_cm_s": motion.pfv * 100,
                "pfd_cm": motion.pfd * 100, "corrected": record.corrected, "treatment": treatment(record),
                "notes": list(record.notes),
                "spectrum": {
                    "damping": 0.05, "periods_s": list(PERIODS),
                    "pseudo_acceleration_g": [
                        float(value) / GRAVITY for value in _pseudo_acceleration(motion, PERIODS)
                    ],
                },
            }
            for name, record, motion in channels
        ],
    }  # fmt: skip


def _pseudo_acceleration(motion: "Motion", periods: "Sequence[float] | FloatArray") -> "FloatArray":
    """Return the 5 % pseudo-acceleration spectrum [m/s2] at periods [s]."""
    import numpy as np

    from assess.motion.spectrum import response_spectrum

    return response_spectrum(motion.acceleration, motion.time_step, np.asarray(periods)).pseudo


def list_lines(document: dict[str, Any]) -> Iterator[str]:
    """Yield the lines of text for one file."""
    yield f"{document['file']}: {document['format']}, {count(len(document['channels']), 'channel')}"
    for one in document["channels"]:
        yield ""
        direction = _say_direction(one["vertical"], one["azimuth_deg"], " deg")
        where = ", ".join(filter(None, (f"channel {one['channel']}", one["location"], direction)))
        yield f"  {one['name']} ({where})"
        known = [part for part in (one["station"], one["event"], one["start"]) if part]
        if known:
            yield f"    {'; '.join(known)}"
        seconds = (one["samples"] - 1) * one["time_step_s"]
        yield f"    {one['samples']:,} samples, one every {one['time_step_s']:g} s: {seconds:.2f} s"
        yield f"    {one['treatment']}"
        header = "" if one["pfa_header_g"] is None else f" (header {one['pfa_header_g']:.4f} g)"
        yield f"    peak in the file {one['pfa_file_g']:.4f} g{header}"
        yield f"    PFA {one['pfa_g']:.4f} g, PFV {one['pfv_cm_s']:.2f} cm/s, displacement {one['pfd_cm']:.2f} cm"
        spectrum = one["spectrum"]
        yield "    5 % spectrum  T [s]  " + "".join(f"{period:>7g}" for period in spectrum["periods_s"])
        yield "                  PSA [g]" + "".join(f"{value:>7.3f}" for value in spectrum["pseudo_acceleration_g"])
        yield from (f"    note: {note}" for note in one["notes"])


def _say_direction(vertical: bool | None, azimuth_deg: float | None, sign: str) -> str:
    if azimuth_deg is not None:
        return f"{azimuth_deg:g}{sign}"
    return "direction not known" if vertical is None else "vertical" if vertical else "horizontal"


def draw_channels(channels: Sequence["Channel"], kind: str) -> tuple[bytes, int]:
    """Return acceleration, velocity and spectrum of each channel, and how many channels are not drawn."""
    from assess.report.figures.draw import draw

    shown = channels[:MOST_DRAWN]
    return draw(10, 0.4 + 1.9 * len(shown), partial(_paint, shown), kind), len(channels) - len(shown)


def _paint(shown: Sequence["Channel"], figure: Any) -> None:
    import numpy as np

    from assess.motion.spectrum import build_periods

    rows = figure.subplots(len(shown), 3, squeeze=False, sharex="col", width_ratios=(2, 2, 1.3))
    periods = build_periods(0.03, 10.0, 150)
    for (name, record, motion), (first, second, third) in zip(shown, rows, strict=True):
        times = np.arange(motion.acceleration.size) * motion.time_step
        direction = _say_direction(record.vertical, record.azimuth_deg, "°")
        title = ", ".join(part for part in (name, record.location, direction) if part)
        first.set_title(title.replace("$", r"\$")[:90], loc="left", fontsize=8)
        for axes, values, unit, what in (
            (first, motion.acceleration / GRAVITY, "g", "acceleration"),
            (second, motion.velocity * 100, "cm/s", "velocity"),
        ):
            at = int(abs(values).argmax())
            axes.plot(times, values, color="#444444", linewidth=0.5)
            axes.plot(times[at], values[at], "o", color="#b03a2e", markersize=4, fillstyle="none")
            axes.annotate(f"{abs(values[at]):.3g} {unit} at {times[at]:.4g} s", (times[at], values[at]), fontsize=7,
                          xytext=(4, 0), textcoords="offset points", va="center", color="#b03a2e",
                          bbox={"facecolor": "white", "edgecolor": "none", "pad": 1, "alpha": 0.85})  # fmt: skip
            axes.set_ylabel(f"{what} [{unit}]")
            axes.margins(x=0)
        third.semilogx(periods, _pseudo_acceleration(motion, periods) / GRAVITY, color="#1b4f72", linewidth=1)
        third.set_ylabel("PSA, 5 % [g]")
        third.set_ylim(bottom=0)
        third.grid(visible=True, color="#e0e0e0", linewidth=0.5)
        third.set_xticks([0.05, 0.2, 1, 5], ["0.05", "0.2", "1", "5"])
        third.minorticks_off()
    for axes, label in zip(rows[-1], ("time [s]", "time [s]", "period [s]"), strict=True):
        axes.set_xlabel(label)
