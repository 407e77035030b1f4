"""What pelicun makes of a damage database, run in an environment that has pelicun: prints a JSON document.

Usage: ``python pelicun_reader.py FRAGILITY.csv MEDIANS.json DIRECTION``

Component number n stands at location n. The floor below it takes 0.5, 1 and 1.6 times number n of the medians, in g or
in m/s, along direction 1. Along
direction 2 it takes nine times as much where DIRECTION is 1, which a component that is directional does not see, and
half as much where DIRECTION is 0, the larger one of both. The document holds the share of samples in damage state 1 by
component and factor.
"""

import json
import sys
from pathlib import Path
from typing import Any

import pandas as pd

SAMPLES = 10_000
FACTORS = (0.5, 1.0, 1.6)
SHORT = {"Peak Floor Acceleration": "PFA", "Peak Floor Velocity": "PFV"}


def main(file: str, medians: str, direction: str) -> None:
    """Print the share of samples that are damaged."""
    table = pd.read_csv(file, index_col="ID")
    table["median"] = json.loads(Path(medians).read_text(encoding="utf-8"))
    shares = {str(factor): find_shares(file, table, direction, factor) for factor in FACTORS}
    print(json.dumps({one: {factor: shares[factor][one] for factor in shares} for one in table.index}))


def find_shares(file: str, table: pd.DataFrame, direction: str, factor: float) -> dict[str, float]:
    """Return the share of samples in damage state 1 of each component, at `factor` times its median."""
    from pelicun.assessment import Assessment  # type: ignore[import-not-found]  # it is not where the tests run

    options: dict[str, Any] = {"PrintLog": False, "Seed": 1}
    if direction == "0":
        options["NonDirectionalMultipliers"] = {"ALL": 1.0}
    assessment = Assessment(options)
    assessment.stories = len(table)
    assessment.demand.load_sample(build_demands(table, factor, 9 if direction == "1" else 0.5))
    assessment.asset.load_cmp_model({"marginals": place(table, direction)})
    assessment.asset.generate_cmp_sample(SAMPLES)
    assessment.damage.load_model_parameters([file], set(table.index))
    assessment.damage.calculate()
    sample = assessment.damage.save_sample()
    sample = sample[0] if isinstance(sample, tuple) else sample
    damaged = sample.loc[:, [str(one[-1]) == "1" for one in sample.columns]].astype(float)
    return {
        one: float(damaged[[at for at in damaged.columns if at[0] == one]].sum(axis=1).mean()) for one in table.index
    }


def build_demands(table: pd.DataFrame, factor: float, other: float) -> pd.DataFrame:
    """Return the demands of all floors, alike in all samples; their first row holds the units."""
    columns = {}
    for floor, (_, row) in enumerate(table.iterrows()):
        value = factor * row["median"]
        for at, size in (("1", value), ("2", other * value)):
            columns[f"1-{SHORT[row['Demand-Type']]}-{floor}-{at}"] = [row["Demand-Unit"], *[size] * SAMPLES]
    return pd.DataFrame(columns, index=["Units", *range(SAMPLES)])


def place(table: pd.DataFrame, direction: str) -> pd.DataFrame:
    """Return one of each component, the n-th at location n."""
    rows = [
        {"Units": "ea", "Location": str(at), "Direction": direction, "Theta_0": 1.0, "Blocks": 1, "Family": None}
        for at in range(1, len(table) + 1)
    ]
    return pd.DataFrame(rows, index=list(table.index))


if __name__ == "__main__":
    main(*sys.argv[1:])
