"""What stands at the bounds takes: ``python tests/benchmarks/bounds.py [WORD ...]`` prints the table of docs/limits.md.

Each row is a command in a process of its own: time of the processor, and memory at its peak. With words, only rows that
hold one of them.
"""

import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[2]))

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


def with_routes(path: Path, segments: int) -> Path:
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
    return write(path, Floors=floors(count), Items=pieces, Places=places, Routes=routes)


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


def plain(path: Path, count: int) -> Path:
    """Write a workbook without live formulas, as other programs write it."""
    rows = [["Item", "Floor", "Breadth [cm]", "Height [cm]", "Axis"]]
    rows += [[f"i{at}", str(1 + at % 2), 40, 180, "XY"[at % 2]] for at in range(count)]  # type: ignore[list-item]
    return write_shared(path, {"Floors": [["Floor", "PFA X [g]", "PFA Y [g]"], ["1", 0.3, 0.2], ["2", 0.4, 0.3]],
                               "Items": rows})  # fmt: skip


def _of_items(count: int) -> Callable[[Path], Path]:
    return lambda folder: write(folder / "w.xlsx", Floors=floors(2), Items=items(count))


def _of_plain_items(count: int) -> Callable[[Path], Path]:
    return lambda folder: plain(folder / "w.xlsx", count)


def _of_floors(count: int) -> Callable[[Path], Path]:
    return lambda folder: write(folder / "w.xlsx", Floors=floors(count), Items=items(count, count))


def _of_segments(count: int) -> Callable[[Path], Path]:
    return lambda folder: with_routes(folder / "w.xlsx", count)


def _of_records(count: int, samples: int, kind: str) -> Callable[[Path], Path]:
    return lambda folder: with_records(folder, count, samples, kind)


def _of_csv(channels: int) -> Callable[[Path], Path]:
    return lambda folder: with_csv(folder, channels)


def cases() -> Iterator[tuple[str, Callable[[Path], Path], list[str]]]:
    """Yield what stands in the workbook, what writes it, and what is run on it."""
    check, run, reports = ["check"], ["run", *FORMULA], ["run", *REPORTS]
    for count in (1_000, 10_000):
        yield f"{count:,} items: check", _of_items(count), check
        yield f"{count:,} items: run, json and csv", _of_items(count), run
        yield f"{count:,} items: run, PDF, HTML and Excel", _of_items(count), reports
    most = MAX_ROWS - 1
    yield f"{most:,} items, no live formulas: check", _of_plain_items(most), check
    yield f"{most:,} items, no live formulas: run, json and csv", _of_plain_items(most), run
    for count in (100, 1_000, 5_000):
        yield f"{count:,} floors: run, json and csv", _of_floors(count), run
    for count in (500, 5_000):
        yield f"{count:,} segments: run, json and csv", _of_segments(count), run
    yield "a record of 4,000,000 samples (SAC): check", _of_records(1, 4_000_000, "sac"), check
    yield "a record of 4,000,000 samples (SAC): run, json and csv", _of_records(1, 4_000_000, "sac"), run
    yield "5 records of 4,000,000 samples (SAC): run, json and csv", _of_records(5, 4_000_000, "sac"), run
    yield "50 records of 100,000 samples (AT2): run, json and csv", _of_records(50, 100_000, "at2"), run
    yield "64 MB of plain CSV, 1 channel: check", _of_csv(1), check
    yield "64 MB of plain CSV, 500 channels: check", _of_csv(500), check
    yield "a logo of 50 million pixels (PNG): check", with_picture, check
    yield "a logo of 50 million pixels (PNG): run, PDF, HTML and Excel", with_picture, reports


def main() -> None:
    """Print the table."""
    print("| what | processor [s] | memory at the peak [MB] |\n|---|---|---|")
    for name, build, command in cases():
        if sys.argv[1:] and not any(word in name for word in sys.argv[1:]):
            continue
        with tempfile.TemporaryDirectory() as box:
            folder = Path(box)
            book = build(folder)
            out = ["--out", str(folder / "out")] if command[0] == "run" else []
            _, seconds, peak = measure([sys.executable, "-m", "assess", command[0], str(book), *command[1:], *out])
        print(f"| {name} | {seconds:.1f} | {peak:.0f} |", flush=True)


if __name__ == "__main__":
    main()
