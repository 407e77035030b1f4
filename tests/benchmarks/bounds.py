"""What stands at the bounds takes: ``python tests/benchmarks/run.py bounds`` prints the table of docs/limits.md.

Each row is a command in a process of its own: time of the processor, and memory at its peak.
"""

import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from PIL import Image

from assess.pictures import MOST_PIXELS
from assess.workbook.open import MAX_ROWS
from assess.workbook.template import Content, write_workbook
from tests.benchmarks.measuring import measure
from tests.motion.writers import Signal, at2, sac, wave
from tests.workbook.books import write_shared

FORMULA = ["--verify", "none", "--formats", "json,csv"]
REPORTS = ["--verify", "none", "--formats", "pdf,html,xlsx"]
ITEM = {"breadth": 40, "width": 80, "height": 180, "anchored": "no"}


def write(path: Path, **rows: list[dict[str, Any]]) -> Path:
    """Write a workbook of these sheets."""
    write_workbook(path, Content(rows=rows))
    return path


def items(count: int, floors: int = 2) -> list[dict[str, Any]]:
    """Return pieces, spread over the floors."""
    return [{"item": f"i{at}", "floor": str(1 + at % floors), "axis": "XY"[at % 2], **ITEM} for at in range(count)]


def floors(count: int) -> list[dict[str, Any]]:
    """Return floors with typed motions."""
    return [{"floor": str(at), "pfa_x": 0.3, "pfa_y": 0.2, "elevation": 0.05 * (at - 1)} for at in range(1, count + 1)]


def with_routes(folder: Path, segments: int) -> Path:
    """Write a building of 50 segments to a floor, each with a piece beside it, a route a floor."""
    count = -(-segments // 50)
    places, routes, pieces = [], [], []
    for at in range(segments):
        floor, number = str(1 + at // 50), at % 50
        if number == 0:
            places.append({"place": f"{floor}.0", "floor": floor, "x": 0, "y": 0, "kind": "room"})
        kind = "exit" if number == 49 else "corridor"
        places.append({"place": f"{floor}.{number + 1}", "floor": floor, "x": 2 * number + 2, "y": 0, "kind": kind})
        ends = {"start": f"{floor}.{number}", "end": f"{floor}.{number + 1}"}
        widths = {"clear_width": 1.5, "required_width": 0.9}
        routes.append({"route": f"Way {floor}", "segment": f"{floor}.{number}", "floor": floor, **ends, **widths})
        pieces.append({"item": f"i{at}", "floor": floor, "x": 2 * number + 1, "y": 1, "angle_deg": 90, **ITEM})
    return write(folder / "w.xlsx", Floors=floors(count), Items=pieces, Places=places, Routes=routes)


def with_records(folder: Path, count: int, samples: int, kind: str) -> Path:
    """Write a workbook of one recorded motion a floor, and the records."""
    rows = []
    for at in range(count):
        signal = Signal(wave(samples, 0.001) * (1 + at / 50))
        (folder / f"r{at}.{kind}").write_bytes(sac(signal, unit="m/s2") if kind == "sac" else at2(signal))
        rows.append({"floor": str(at + 1), "record_x": f"r{at}.{kind}", "record_y": f"r{at}.{kind}"})
    return write(folder / "records.xlsx", Floors=rows, Items=items(20, count))


def with_csv(folder: Path, channels: int) -> Path:
    """Write a workbook with a record of 64 MB of plain CSV."""
    head = "time [s]," + ",".join(f"c{number} [cm/s2]" for number in range(channels)) + "\n"
    cells = [",".join([text] * channels) for text in ("-0.12345", "0.12345")]
    lines = (63_900_000 - len(head)) // (len(cells[0]) + 10)
    rows = (f"{row * 0.005:.3f},{cells[row % 2]}" for row in range(lines))
    (folder / "r.csv").write_text(head + "\n".join(rows), encoding="utf-8")
    name = "r.csv" if channels == 1 else "r.csv#c0"
    return write(folder / "csv.xlsx", Floors=[{"floor": "1", "record_x": name, "record_y": name}], Items=items(20, 1))


def with_picture(folder: Path) -> Path:
    """Write a workbook with the largest logo."""
    side = int(MOST_PIXELS**0.5)
    Image.new("RGBA", (side, side), (20, 90, 160, 255)).save(folder / "logo.png")
    return write(folder / "logo.xlsx", Building=[{"logo": "logo.png"}], Floors=floors(2), Items=items(20))


def plain(path: Path, count: int, floor_count: int = 2) -> Path:
    """Write a workbook without live formulas, as other programs write it."""
    levels: list[list[Any]] = [["Floor", "PFA X [g]", "PFA Y [g]"]]
    levels += [[str(at + 1), 0.3 + 0.005 * at, 0.2] for at in range(floor_count)]
    rows: list[list[Any]] = [["Item", "Floor", "Breadth [cm]", "Height [cm]", "Axis"]]
    rows += [[f"i{at}", str(1 + at % floor_count), 40, 180, "XY"[at % 2]] for at in range(count)]
    return write_shared(path, {"Floors": levels, "Items": rows})


def cases() -> Iterator[tuple[str, Callable[[Path], Path], list[str]]]:
    """Yield what stands in the workbook, what writes it, and what is run on it."""
    check, run, reports = ["check"], ["run", *FORMULA], ["run", *REPORTS]

    def of_items(count: int) -> Callable[[Path], Path]:
        return lambda folder: write(folder / "w.xlsx", Floors=floors(2), Items=items(count))

    def of_floors(count: int) -> Callable[[Path], Path]:
        return lambda folder: write(folder / "w.xlsx", Floors=floors(count), Items=items(count, count))

    for count in (1_000, 10_000):
        yield f"{count:,} items: check", of_items(count), check
        yield f"{count:,} items: run, json and csv", of_items(count), run
        yield f"{count:,} items: run, PDF, HTML and Excel", of_items(count), reports
    most = MAX_ROWS - 1
    yield f"{most:,} items, no live formulas: check", lambda folder: plain(folder / "w.xlsx", most), check
    yield f"{most:,} items, no live formulas: run, json and csv", lambda folder: plain(folder / "w.xlsx", most), run
    for count in (100, 1_000, 5_000):
        yield f"{count:,} floors: run, json and csv", of_floors(count), run
    for count in (500, 5_000):
        yield f"{count:,} segments: run, json and csv", partial(with_routes, segments=count), run
    one, five = (partial(with_records, count=count, samples=4_000_000, kind="sac") for count in (1, 5))
    yield "a record of 4,000,000 samples (SAC): check", one, check
    yield "a record of 4,000,000 samples (SAC): run, json and csv", one, run
    yield "5 records of 4,000,000 samples (SAC): run, json and csv", five, run
    fifty = partial(with_records, count=50, samples=100_000, kind="at2")
    yield "50 records of 100,000 samples (AT2): run, json and csv", fifty, run
    yield "64 MB of plain CSV, 1 channel: check", partial(with_csv, channels=1), check
    yield "64 MB of plain CSV, 500 channels: check", partial(with_csv, channels=500), check
    yield "a logo of 50 million pixels (PNG): check", with_picture, check
    yield "a logo of 50 million pixels (PNG): run, PDF, HTML and Excel", with_picture, reports


def rows(_folder: Path) -> Iterator[str]:
    """Yield the table in Markdown."""
    yield "| what | processor [s] | memory at the peak [MB] |\n|---|---|---|"
    for name, build, command in cases():
        with tempfile.TemporaryDirectory() as box:
            folder = Path(box)
            book = build(folder)
            out = ["--out", str(folder / "out")] if command[0] == "run" else []
            _, seconds, peak = measure([sys.executable, "-m", "assess", command[0], str(book), *command[1:], *out])
        yield f"| {name} | {seconds:.1f} | {peak:.0f} |"
