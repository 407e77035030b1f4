"""Any folder of records: the chances of one piece by every formula, and what it does under each very record."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from assess.errors import InputError, RecordError
from assess.methods import Cases
from assess.report.commands.records import Channel, read_channels
from assess.report.words import cut
from assess.risk import RiskClass, classify
from assess.rocking.block import STOCKY
from assess.studies._formulas import evaluate_formulas
from assess.studies._study import Options, Row, Table, table_lines
from assess.studies._tower import SHORT_TITLES, method_cells, method_columns
from assess.units import GRAVITY, VELOCITY

SHOWN = 8
"""Channels, and things left out, on the page; the .csv has all."""
LONGEST = 110
"""Characters of a reason on the page."""
COLUMNS = ("record", "location", "azimuth_deg", "station", "event", "corrected", "notes", "pfa_g", "pfv_cm_s")
VERDICT = ("overturned", "rotation_over_critical_angle", "impacts")


@dataclass(frozen=True, slots=True, eq=False)
class Folder:
    """The horizontal channels of a folder, and everything else in it with the reason why it was left out."""

    path: Path
    channels: Sequence[Channel]
    left_out: Sequence[tuple[str, str]]


def read_folder(path: Path, out: Path) -> Folder:
    """Read every file of a folder as a record.

    Parameters
    ----------
    path : Path
        The folder.
    out : Path
        Folder of our own files, which may lie within and is none of the records.

    Raises
    ------
    InputError
        If there is no such folder, it may not be read, or it has no horizontal channel that can be.
    """
    if not path.is_dir():
        raise InputError(f"{path}: there is no such folder. Name a folder of floor records")
    channels: list[Channel] = []
    left_out: list[tuple[str, str]] = []
    for file in _list(path, out):
        found, reasons = _read(file)
        channels += found
        left_out += reasons
    if not channels:
        seen = _tell_first([f"{name}: {cut(reason, LONGEST)}" for name, reason in left_out]) or "it is empty"
        raise InputError(f"{path}: no horizontal channel can be read in it ({seen}). Put floor records into it")
    return Folder(path, channels, left_out)


def _list(path: Path, out: Path) -> list[Path]:
    """Return what is in a folder, in order, without the folder of our own files."""
    try:
        return sorted(one for one in path.iterdir() if not (one.is_dir() and one.resolve() == out.resolve()))
    except OSError as error:
        raise InputError(f"{path} could not be read: {error.strerror or error}. Name another folder") from None


def _read(file: Path) -> tuple[list[Channel], list[tuple[str, str]]]:
    """Return the horizontal channels of a file, and what is left out of it, with the reason; pipes are not opened."""
    name = _spell(file.name)
    if file.is_dir():
        return [], [(name, "a folder: folders within are not looked into")]
    if not file.is_file():
        return [], [(name, "no regular file")]
    try:
        found = read_channels(str(file))
    except RecordError as error:
        return [], [(name, _spell(str(error).removeprefix(f"{file.name}: ")))]
    reasons = [(_spell(one.name), "vertical: it topples no furniture") for one in found if one.record.vertical]
    return [one._replace(name=_spell(one.name)) for one in found if not one.record.vertical], reasons


def _spell(text: str) -> str:
    """Return a name in characters that can be written: what is none in UTF-8 by its number."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _tell_first(told: Sequence[str]) -> str:
    """Return the first `SHOWN` of what there is to tell, and how many more there are."""
    rest = len(told) - SHOWN
    return "; ".join(told[:SHOWN]) + (f"; and {rest} more" if rest > 0 else "")


@dataclass(frozen=True, slots=True, eq=False)
class Told:
    """What there is to tell of a folder: lines for the page, and the tables by name."""

    page: Sequence[str]
    tables: dict[str, Table]


def tell_folder(folder: Folder, options: Options) -> Told:
    """Evaluate the piece under every channel of a folder, and rock it under each."""
    cases = Cases.of(
        breadth=options.breadth,
        height=options.height,
        pfa=[one.motion.pfa for one in folder.channels],
        pfv=[one.motion.pfv for one in folder.channels],
    )
    values = evaluate_formulas(cases, options.settings)
    rows = []
    for at, one in enumerate(folder.channels):
        options.tell(f"record {at + 1} of {len(folder.channels)}: {one.name}")
        rows.append((*_describe_channel(one), *method_cells(values, at), *_rock(one, options)))
    columns = (*COLUMNS, *method_columns(), *VERDICT)
    tables = {"table1-records": Table(columns=columns, rows=rows)}
    if folder.left_out:
        tables["table1-records-left-out"] = Table(columns=("file", "reason"), rows=folder.left_out)
    return Told([*_describe(folder, columns, rows, options), *_describe_left_out(folder)], tables)


def _describe_channel(one: Channel) -> Row:
    record, motion = one.record, one.motion
    azimuth = "" if record.azimuth_deg is None else record.azimuth_deg
    peaks = motion.pfa / GRAVITY, motion.pfv / VELOCITY["cm/s"]
    told = record.station, record.event, record.corrected, "; ".join(str(note) for note in record.notes)
    return one.name, record.location, azimuth, *told, *peaks


def _rock(one: Channel, options: Options) -> Row:
    """Return the verdict of direct integration under the record itself; "" where the piece is too stocky to rock."""
    if options.breadth / options.height >= STOCKY:
        return "", "", ""
    from assess.rocking.ensemble import rock_blocks

    found = rock_blocks(options.breadth, options.height, one.motion.acceleration[None], one.motion.time_step)
    return bool(found.overturned[0, 0]), float(found.rotation[0, 0]), int(found.impacts[0, 0])


# ---------------------------------------------------------------- the page


def _describe(folder: Folder, columns: Sequence[str], rows: Sequence[Row], options: Options) -> Iterator[str]:
    cells = [dict(zip(columns, row, strict=True)) for row in rows]
    fell = sum(one["overturned"] is True for one in cells)
    rocked = sum(one["impacts"] != "" and float(str(one[VERDICT[1]])) > 0 for one in cells)
    high = [f"{_count_high(cells, key)} by {name}" for key, name in SHORT_TITLES.items()]
    yield ""
    yield (
        f"**The same piece under records of your own** (folder {quote(_name(folder.path))}, horizontal channels: "
        f"{len(rows)}; PFA and PFV are the records' own). By direct integration it rocks under {rocked} and overturns "
        f"under {fell}; it is in class high or above under {', '.join(high)}. A verdict under one record is no chance: "
        "a slightly different motion may reverse it."
    )
    if options.breadth / options.height >= STOCKY:
        yield f"B/H is {STOCKY:g} or more: the piece does not rock, and is not integrated."
    yield ""
    worst = sorted(
        cells, key=lambda one: (one["overturned"] is not True, -float(str(one["pfa_g"])), str(one["record"]))
    )
    heads = ("channel", "PFA [g]", "PFV [cm/s]", *SHORT_TITLES.values(), "integration: rotation over alpha")
    yield from table_lines(heads, [_short(one) for one in worst[:SHOWN]])
    if len(worst) > SHOWN:
        yield ""
        yield f"{len(worst) - SHOWN} more in `table1-records.csv`."


def _name(path: Path) -> str:
    """Return a folder's name as pages show it, of "." too."""
    full = path.resolve()
    return _spell(full.name or str(full))


def quote(name: str) -> str:
    """Return a name as Markdown shows it letter for letter, whatever backticks are in it."""
    line = re.sub(r"[\r\n]", " ", name)
    fence = "`" * (1 + max((len(one) for one in re.findall("`+", line)), default=0))
    edge = " " if line.startswith("`") or line.endswith("`") else ""
    return f"{fence}{edge}{line}{edge}{fence}"


def _short(one: dict[str, object]) -> Row:
    chances = [_number(one[key], ".2f") for key in SHORT_TITLES]
    turned = "overturns" if one["overturned"] is True else _number(one[VERDICT[1]], ".2f")
    name = quote(str(one["record"])).replace("|", "\\|")
    return name, _number(one["pfa_g"], ".3f"), _number(one["pfv_cm_s"], ".1f"), *chances, turned


def _number(value: object, form: str) -> str:
    return format(value, form) if isinstance(value, float) else "-"


def _count_high(cells: Sequence[dict[str, object]], key: str) -> int:
    chances = [value for one in cells if isinstance(value := one[key], float)]
    return sum((classify(value) or RiskClass.LOW) >= RiskClass.HIGH for value in chances)


def _describe_left_out(folder: Folder) -> Iterator[str]:
    if not folder.left_out:
        return
    told = _tell_first([f"{quote(name)} ({cut(reason, LONGEST)})" for name, reason in folder.left_out])
    yield ""
    yield f"Left out, with the whole reasons in `table1-records-left-out.csv`: {told}."
