"""What the files for other programs have in common: names that they accept, what was left out, what curves rest on."""

import re
import unicodedata
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from assess.errors import InputError
from assess.i18n import Text
from assess.pipeline.adopt import Assessment
from assess.pipeline.piece_fragility import UNITS, PieceFragilities, PieceFragility
from assess.text import plain_line
from assess.units import LENGTH
from assess.version import __version__

LONGEST_NAME = 60
"""Letters of a name that an identifier keeps; equal ones are then numbered."""
LABELS: Mapping[str, str] = {"pfa": "g", "pfv": "cm/s"}
"""Units of the intensity measures in remarks."""
SCREENING = (
    "For screening: one rigid block in plane motion on the record-compatible or drawn motions of its floor, without "
    "sliding, vertical motion, walls or anchors; not the fragility of a tested product."
)


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A curve that the files do not hold, and why."""

    name: str
    why: Text


@dataclass(frozen=True, slots=True)
class Exchange:
    """Files for another program: the bytes of each by its name, and the curves that they do not hold."""

    files: Mapping[str, bytes]
    left_out: tuple[LeftOut, ...]


def choose_curves(
    program: str, curves: Iterable[PieceFragility], judge: Callable[[PieceFragility], Text | None]
) -> tuple[list[PieceFragility], tuple[LeftOut, ...]]:
    """Return the curves that `judge` has nothing against, and those left out with its reason; InputError if all are."""
    judged = [(one, judge(one)) for one in curves]
    left = tuple(LeftOut(one.name, why) for one, why in judged if why is not None)
    if len(left) == len(judged):
        raise InputError.about(
            "formats: none of the {count} curves can be written for {program}. The first is {name}: {why}",
            count=len(left), program=program, name=plain_line(left[0].name), why=left[0].why,
        )  # fmt: skip
    return [one for one, why in judged if why is None], left


def name_safely(names: Iterable[str], joint: str) -> list[str]:
    """Return identifiers of ASCII letters, digits and `joint`, no two alike even where case does not count.

    A name that has no such letter becomes "curve"; the second of equal ones ends in 2, and so on.
    """
    taken: set[str] = set()
    numbers: Counter[str] = Counter()
    found = []
    for name in names:
        plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
        stem = re.sub("[^A-Za-z0-9]+", joint, plain)[:LONGEST_NAME].strip(joint) or "curve"
        chosen = stem
        while chosen.lower() in taken:
            numbers[stem.lower()] += 1
            chosen = f"{stem}{joint}{numbers[stem.lower()] + 1}"
        taken.add(chosen.lower())
        found.append(chosen)
    return found


def round_number(value: float) -> float:
    """Return a number with six significant digits, which are alike on every processor."""
    return float(f"{value:.6g}")


def describe_origin(assessment: Assessment, found: PieceFragilities) -> str:
    """Return what all curves of a file rest on: program, workbook, scenario, draws, seed, and what they hold for."""
    inventory = assessment.inventory
    pieces = "that of the pieces is" if found.has_drawn_pieces else "neither is that of the pieces"
    return (
        f"Overturning of free-standing furniture by direct integration of its rocking, assess {__version__}. "
        f"Workbook {inventory.file_name}, SHA-256 {inventory.sha256}; scenario {assessment.scenario}; "
        f"{found.runs} motions, seed {found.seed}. Lognormals are fitted by maximum binomial likelihood (Baker 2015, "
        f"doi:10.1193/021113EQS025M). The uncertainty of the motion is not in them, {pieces}. A curve holds for "
        f"motions of the PFV/PFA stated with it. {SCREENING}"
    )


def describe_curve(one: PieceFragility, im: str) -> Iterator[str]:
    """Yield what a curve is of and how it was found, a sentence each."""
    curve, unit, label = one.curve, UNITS[im], LABELS[im]
    yield f"{one.pieces} {'piece' if one.pieces == 1 else 'pieces'}: {say_sizes(one)}."
    yield f"Floors: {', '.join(map(plain_line, one.floors))}."
    if curve.kind == "fitted":
        yield (
            f"{im.upper()}: median {curve.median / unit:.4g} {label}, beta {curve.dispersion:.3g}, largest misfit "
            f"{curve.misfit:.3f}, of {curve.levels.size} levels from {curve.levels[0] / unit:.3g} to "
            f"{curve.levels[-1] / unit:.3g} {label}."
        )
    yield f"PFV/PFA of the motions: {_span(one.pfv_per_pfa, '.3g')} s."
    if any(motion.is_assumed for motion in one.motions):
        yield "Assumed motions: ground motion and building are drawn."
    if one.may_be_too_low:
        yield "Its motions may be too weak: pieces may overturn at lower levels than it says."
    if any(item.anchored == "yes" for item in one.items):
        yield "Anchored pieces are taken as free-standing."


def say_sizes(one: PieceFragility) -> str:
    """Return the base and the height of the pieces of a curve in words."""
    breadths, heights = ([getattr(item, name) / LENGTH["cm"] for item in one.items] for name in ("breadth", "height"))
    return f"base {_span(breadths, '.4g')} cm, height {_span(heights, '.4g')} cm, free-standing"


def _span(values: Sequence[float], form: str) -> str:
    low, high = format(min(values), form), format(max(values), form)
    return low if low == high else f"{low} to {high}"
