"""What files of recorded motion hold, for `assess record`: as one document, as text, as figures."""

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from assess.errors import OutputError, RecordError
from assess.motion.formats import list_addresses, read_records, select
from assess.motion.record import Baseline, Motion, Record, treat, treatment
from assess.units import GRAVITY

PERIODS = (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)
"""Periods of the printed spectrum [s]."""
MOST_DRAWN = 12
"""Channels in one figure."""
KINDS = ("png", "svg", "pdf")


class Channel(NamedTuple):
    """One channel: what to write into a workbook to name it, as its file has it, and as treated."""

    name: str
    record: Record
    motion: Motion


def read_channels(name: str) -> list[Channel]:
    """Return the channels of ``FILE``, or the one of ``FILE#channel``, as they are and as treated.

    Raises
    ------
    RecordError
        If the file cannot be read, or has no such channel.
    """
    path, channel = _split(name)
    if channel is not None:
        return [read_channel(name)]
    records = read_records(path)
    texts = [""] if len(records) == 1 else [f"#{text}" for text in list_addresses(records)]
    return [Channel(f"{path.name}{text}", record, treat(record)) for text, record in zip(texts, records, strict=True)]


def read_channel(name: str, baseline: Baseline = "standard") -> Channel:
    """Return the channel of ``FILE#channel``, or the only one of ``FILE``.

    Raises
    ------
    RecordError
        If the file cannot be read, has no such channel, or has several and none is named; the message lists them.
    """
    path, channel = _split(name)
    record = select(read_records(path), channel)
    return Channel(path.name if channel is None else f"{path.name}#{channel}", record, treat(record, baseline))


def _split(name: str) -> tuple[Path, str | None]:
    """Return the file and the channel that a name means: a file may have a # in its own name."""
    if "#" not in name or _is_there(Path(name)):
        return Path(name), None
    file, _, channel = name.partition("#")
    return Path(file), channel


def _is_there(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # a name that is too long
        return False


def describe(channels: Sequence[Channel]) -> dict[str, Any]:
    """Return what the channels of one file are, as the document of `assess record --json`."""
    return {
        "file": channels[0].record.file.split("/")[0],
        "format": ", ".join(dict.fromkeys(one.record.format for one in channels)),
        "channels": [_describe(*one) for one in channels],
    }


def _describe(name: str, record: Record, motion: Motion) -> dict[str, Any]:
    from assess.motion.spectrum import response_spectrum

    spectrum = response_spectrum(motion.acceleration, motion.time_step, np.array(PERIODS))
    return {
        "channel": record.channel,
        "name": name,
        "member": record.file,
        "location": record.location,
        "azimuth_deg": record.azimuth_deg,
        "vertical": record.vertical,
        "station": record.station,
        "event": record.event,
        "start": record.start,
        "time_step_s": record.time_step,
        "samples": int(record.acceleration.size),
        "pfa_header_g": None if record.header_pfa is None else record.header_pfa / GRAVITY,
        "pfa_file_g": record.file_pfa / GRAVITY,
        "pfa_g": motion.pfa / GRAVITY,
        "pfv_cm_s": motion.pfv * 100,
        "pfd_cm": motion.pfd * 100,
        "corrected": record.corrected,
        "treatment": treatment(record),
        "notes": list(record.notes),
        "spectrum": {
            "damping": 0.05,
            "periods_s": list(PERIODS),
            "pseudo_acceleration_g": [float(value) / GRAVITY for value in spectrum.pseudo],
        },
    }


def list_lines(document: dict[str, Any]) -> Iterator[str]:
    """Yield the lines that tell a person what a file holds."""
    count = len(document["channels"])
    yield f"{document['file']}: {document['format']}, {count} channel{'' if count == 1 else 's'}"
    for one in document["channels"]:
        yield ""
        yield f"  {one['name']}{_where(one)}"
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


def _where(one: dict[str, Any]) -> str:
    azimuth = "vertical" if one["vertical"] else "" if one["azimuth_deg"] is None else f"{one['azimuth_deg']:g} deg"
    parts = [part for part in (f"channel {one['channel']}", one["location"], azimuth) if part]
    return f" ({', '.join(parts)})"


def check_figure(path: Path) -> None:
    """Raise RecordError unless a figure can be written to `path`, as far as can be told beforehand."""
    if path.suffix.lower().removeprefix(".") not in KINDS:
        raise RecordError(f"the figure {path.name} is of no known kind: end its name in .png, .svg or .pdf")
    try:
        can_be = path.parent.is_dir() and not path.is_dir()
    except OSError:  # a name that is too long
        can_be = False
    if not can_be:
        raise RecordError(f"the figure {path} cannot be written there: name a file in a folder that exists")


def write_figure(channels: Sequence[Channel], path: Path) -> int:
    """Draw acceleration, velocity and spectrum of the first channels; return how many were drawn.

    Raises
    ------
    RecordError
        If the name does not end in .png, .svg or .pdf, or its folder is missing.
    OutputError
        If the file cannot be written; what was there is left as it was.
    """
    from assess.report.figures.draw import draw

    check_figure(path)
    kind = path.suffix.lower().removeprefix(".")
    shown = channels[:MOST_DRAWN]
    save_figure(draw(10, 0.4 + 1.9 * len(shown), partial(_paint, shown), kind), path)
    return len(shown)


def save_figure(picture: bytes, path: Path) -> None:
    """Write a figure whole or not at all; OutputError if it cannot be written."""
    stage = path.with_name(f".{path.stem[:40]}.writing")
    try:
        stage.write_bytes(picture)
        stage.replace(path)
    except OSError as error:
        stage.unlink(missing_ok=True)
        raise OutputError(f"{path} could not be written: {error.strerror}. Name another file.") from None


def _paint(shown: Sequence[Channel], figure: Any) -> None:
    from assess.motion.spectrum import build_periods, response_spectrum

    rows = figure.subplots(len(shown), 3, squeeze=False, sharex="col", width_ratios=(2, 2, 1.3))
    periods = build_periods(0.03, 10.0, 150)
    for (name, record, motion), (first, second, third) in zip(shown, rows, strict=True):
        times = np.arange(motion.acceleration.size) * motion.time_step
        azimuth = "vertical" if record.vertical else "" if record.azimuth_deg is None else f"{record.azimuth_deg:g}°"
        title = ", ".join(part for part in (name, record.location, azimuth) if part)
        first.set_title(title.replace("$", r"\$")[:90], loc="left", fontsize=8)
        for axes, values, unit in (
            (first, motion.acceleration / GRAVITY, "g"),
            (second, motion.velocity * 100, "cm/s"),
        ):
            _paint_history(axes, times, values, unit)
        spectrum = response_spectrum(motion.acceleration, motion.time_step, periods)
        third.semilogx(periods, spectrum.pseudo / GRAVITY, color="#1b4f72", linewidth=1)
        third.set_ylabel("PSA, 5 % [g]")
        third.set_ylim(bottom=0)
        third.grid(visible=True, color="#e0e0e0", linewidth=0.5)
        third.set_xticks([0.05, 0.2, 1, 5], ["0.05", "0.2", "1", "5"])
        third.minorticks_off()
    for axes, label in zip(rows[-1], ("time [s]", "time [s]", "period [s]"), strict=True):
        axes.set_xlabel(label)


def _paint_history(axes: Any, times: Any, values: Any, unit: str) -> None:
    at = int(np.abs(values).argmax())
    axes.plot(times, values, color="#444444", linewidth=0.5)
    axes.plot(times[at], values[at], "o", color="#b03a2e", markersize=4, fillstyle="none")
    axes.annotate(f"{abs(values[at]):.3g} {unit} at {times[at]:.4g} s", (times[at], values[at]), fontsize=7,
                  xytext=(4, 0), textcoords="offset points", va="center", color="#b03a2e",
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 1, "alpha": 0.85})  # fmt: skip
    axes.set_ylabel(f"acceleration [{unit}]" if unit == "g" else f"velocity [{unit}]")
    axes.margins(x=0)
