"""The paper's own Table 2, as printed: neither its records nor the sizes of its pieces are published."""

from collections.abc import Iterator

import numpy as np

from assess.methods._method import FloatArray
from assess.risk import classify_all
from assess.studies._agreement import correlate_ranks
from assess.studies._facts import read_facts
from assess.studies._formulas import percent
from assess.studies._study import table_lines

PROPOSED, KANEKO, DIRECT = "proposed_or", "kaneko_hayashi", "housner_direct"


def read_print() -> dict[str, FloatArray]:
    """Return the columns of chances [-], (27,) each."""
    rows = read_facts("table2_methods")
    return {name: np.array([float(row[name]) for row in rows]) for name in (KANEKO, DIRECT, PROPOSED)}


def say_contrary() -> str:
    """Return in one sentence how the paper's own table differs from what is found here."""
    said = read_print()
    bias = {name: f"{100 * np.mean(said[name] - said[DIRECT]):+.1f}" for name in (PROPOSED, KANEKO)}
    return (
        "In the paper's own Table 2, as printed, it is the reverse: the bias of OR, fitted to such integrations, is "
        f"{bias[PROPOSED]} points, that of Kaneko-Hayashi {bias[KANEKO]}; its PFV, sizes and records are not printed, "
        "so that nobody can tell why."
    )


def describe_print() -> Iterator[str]:
    """Yield its rows, channel by channel, and how its formulas agree with its integration."""
    rows, said = read_facts("table2_methods"), read_print()
    above, level = (int(found.sum()) for found in (said[DIRECT] > said[PROPOSED], said[DIRECT] == said[PROPOSED]))
    yield (
        f"The paper's own Table 2, as printed: {len(rows)} channels of three other buildings. Direct integration "
        f"exceeds OR in {above} rows and equals it in {level}. {_tell('OR', said[PROPOSED], said[DIRECT])} "
        f"{_tell('Kaneko-Hayashi', said[KANEKO], said[DIRECT])} OR was fitted to such integrations by its authors, so "
        "its agreement there is no test of it."
    )
    yield ""
    yield from table_lines(
        ("building", "storey", "channel", "Kaneko-Hayashi", "direct integration", "proposed OR"),
        [
            (row["building"], row["storey"], row["channel"], *(percent(float(row[name])) for name in said))
            for row in rows
        ],
    )


def _tell(name: str, formula: FloatArray, direct: FloatArray) -> str:
    steps = classify_all(formula) - classify_all(direct)
    return (
        f"{name}: bias {100 * np.mean(formula - direct):+.1f} points, rank correlation "
        f"{correlate_ranks(formula, direct):.2f}, class too low in {percent(float(np.mean(steps < 0)))} of the rows, "
        f"too high in {percent(float(np.mean(steps > 0)))}."
    )
