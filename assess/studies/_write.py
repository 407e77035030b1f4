"""The page of a study, and the page of them all."""

from collections.abc import Iterator, Mapping, Sequence

from assess.risk import LIMITS, RiskClass
from assess.studies._study import Finding, Options, Study, table_lines
from assess.version import __version__

PAGE = "validation.md"
PAPER = "Overturning Risk of Furniture in Earthquake Affected Areas"


def describe(study: Study, finding: Finding, folder: str) -> Iterator[str]:
    """Yield the section of a study; figures lie in `folder`, as links have it."""
    yield f"`assess study {study.name}`, {study.of} of the paper."
    yield ""
    yield from finding.page
    for name in finding.figures:
        yield ""
        yield f"![{study.title}]({folder}{name})"


def build_own_page(study: Study, finding: Finding) -> str:
    """Return the page of one study: what came out first."""
    lines = [f"# {study.title}", "", *(f"* {one}" for one in (*finding.summary, *finding.failures)), ""]
    if finding.overview:
        lines += [*finding.overview, ""]
    return "\n".join((*lines, *describe(study, finding, ""), ""))


def build_page(studies: Sequence[Study], findings: Mapping[str, Finding], options: Options, folder: str = "") -> str:
    """Return the page of all studies: what was checked and how near first, then where formulas fail, then each."""
    found = [findings[study.name] for study in studies]
    overview = [line for one in found for line in one.overview]
    failures = [f"* {sentence}" for one in found for sentence in one.failures]
    lines = [
        *_introduce(options),
        *("## What was checked, against what, and how near", ""),
        *table_lines(("study", "what, and how near"), [_row(study, findings[study.name]) for study in studies]),
        *("", "## How near the formulas come in instrumented buildings", ""),
        *(*overview, "", "## Where the published formulas fail", "", *failures, "", *LIMITATIONS),
    ]
    for study in studies:
        lines += ["", f"## {study.title}", "", *describe(study, findings[study.name], folder)]
    return "\n".join(lines) + "\n"


def _row(study: Study, finding: Finding) -> tuple[str, str]:
    return f"`{study.name}`, {study.of}", f"**{study.title}.** {' '.join(finding.summary)}"


def _introduce(options: Options) -> Iterator[str]:
    yield "# Validation"
    yield ""
    yield (
        f'The formulas of the paper "{PAPER}" and others, held against direct integration of rocking blocks, against '
        "published limits and against shaking-table tests. Every number is from a run of `assess study all --runs "
        f"{options.runs} --seed {options.seed}` (assess {__version__}), on data that comes along: you can run it "
        "again. The sections up to the one on what this does not show are ten minutes; those of the single studies, "
        "which follow, hold the details."
    )
    yield ""
    yield "Words used here:"
    yield ""
    yield from (f"* {one}" for one in WORDS)
    classes = ", ".join(f"{one.word} below {100 * limit:g} %" for one, limit in zip(RiskClass, LIMITS, strict=False))
    yield f"* **Classes** of the chance: {classes}, then {RiskClass.VERY_HIGH.word}."
    yield ""


WORDS = (
    "**Direct integration**: Housner's equation of a rigid, free-standing rectangular block in a plane, which rocks "
    "and does not slide, with his restitution 1 - 1.5 sin²α at each impact, moved by an acceleration history. It has "
    "overturned when its rotation reaches π/2. Its **chance** is the share of motions under which it overturns. It is "
    "what the formulas are held against, not the truth: real pieces slide, bend and lean on walls.",
    "**Motions**: histories generated for the 5 % response spectrum of a recorded floor motion, as `assess run` does; "
    "**PFA** and **PFV** are the peak acceleration and velocity of the record as scaled.",
    "**OR** is the proposed formula of the paper, equation (9): as printed, cut to 0 and 1; and as used here, held "
    "where it would fall as a motion grows or a piece gets thinner. **B** and **H** are breadth and height of a "
    "piece, g·B/H the acceleration at which a rigid block begins to rock.",
)
LIMITATIONS = (
    "## What this does not show",
    "",
    "* The records of the paper's own three buildings are not published; others stand in, of which the Berkeley one is "
    "of a weak, quick motion that is scaled far beyond what was recorded. Scaling keeps the shape of a spectrum; real "
    "stronger motions usually have more at long periods.",
    "* Blocks and values of PFA are an even grid, not the furniture and the hazard of an office: biases and shares "
    "change with them.",
    "* Integration and formulas share assumptions: rigid, no sliding, no wall, one direction, no vertical motion.",
    "* The shaking-table tests are nine blocks, without sizes and histories in print.",
)
