"""What the options of `assess run` and `assess routes` mean, checked before the work."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from assess.errors import InputError
from assess.settings import AUTO, MOST_RUNS, ROUTE_RISK, SCENARIOS, SEED, VERIFY, Settings, match_choice, read_runs

if TYPE_CHECKING:
    from assess.inventory.model import Inventory
    from assess.methods import Method
    from assess.report.look import Look

MOST_METHODS = 4
"""Fitted models that a report shows beside the published methods: a column each."""
MOST_PFA, STEP, MOST_VALUES = Decimal(5), "0.05", 50
"""Largest PFA [g] of a fragility, the usual step [g], and how many values it may have."""
NUMBER = r"(\d{1,4}(?:\.\d{0,12})?|\.\d{1,12})"
PFA = re.compile(rf"{NUMBER}:{NUMBER}(?::{NUMBER})?", re.ASCII)


def check_run(out: Path, verify: str, runs: str | None, seed: int | None, motions: Path | None, scale: bool) -> None:
    """Raise BadParameter where the folder of the reports is a file, or options of one's own motions contradict."""
    if out.exists() and not out.is_dir():
        raise typer.BadParameter(f"{out} is a file; name a folder.", param_hint="--out")
    if motions is not None and (verify == "none" or runs is not None or seed is not None):
        message = "your own motions are all taken, in a verification: leave out --verify none, --runs and --seed."
        raise typer.BadParameter(message, param_hint="--motions")
    if scale and motions is None:
        raise typer.BadParameter(
            "there are no motions to scale: name their folder by --motions.", param_hint="--scale-motions"
        )


def read_look(language: str | None, template: Path | None, accessible: bool) -> "Callable[[Inventory], Look]":
    """Return how the reports of an inventory are to look; what is wrong with the options is told before the work."""
    from assess.language import find_language
    from assess.report.look import Look

    look = Look(language=find_language(language or "en"), templates=template, accessible=accessible)
    if template is not None:
        from assess.report.pages.html import check_look

        check_look(look)
    return lambda inventory: look if language else replace(look, language=inventory.report_language)


def read_methods(files: "Sequence[Path] | None") -> "list[Method]":
    """Return the fitted models of files as methods, as many as a report has room for.

    Raises
    ------
    InputError
        If one cannot be used, or there are too many.
    """
    files = files or ()
    if len(files) > MOST_METHODS:
        raise InputError(f"--method names {len(files)} files; a report has room for {MOST_METHODS}. Leave some out.")
    if not files:
        return []
    from assess.methods._fitted import read_model

    return [read_model(file) for file in files]


def read_formats(formats: str, verify: str) -> list[str]:
    """Return the formats that are asked for."""
    from assess.report import FILES

    wanted = [name.strip().lower() for name in formats.split(",") if name.strip()]
    if not wanted or any(name not in FILES for name in wanted):
        raise typer.BadParameter(f"{formats!r} is not a list of: {', '.join(FILES)}.", param_hint="--formats")
    if "npz" in wanted and verify == "none":
        raise typer.BadParameter("npz holds what verification finds: leave out --verify none.", param_hint="--formats")
    return wanted


def read_settings(
    verify: str,
    runs: str | None,
    seed: int | None,
    scenario: str | None,
    *,
    scale_motions: bool = False,
    route_risk: float = ROUTE_RISK,
) -> Settings:
    """Return the settings of a run."""
    if verify not in VERIFY:
        raise typer.BadParameter(f"{verify!r} is not one of: {', '.join(VERIFY)}.", param_hint="--verify")
    count = read_runs(runs)
    if count is None:
        raise typer.BadParameter(f"{runs!r} is not a number from 1 to {MOST_RUNS:,}, nor {AUTO}.", param_hint="--runs")
    if not 0 < route_risk < 1:
        message = f"{route_risk:g} is no chance above 0 and below 1: write 3 % as 0.03."
        raise typer.BadParameter(message, param_hint="--route-risk")
    kind = None if scenario is None else match_choice(scenario, SCENARIOS)
    if scenario is not None and kind is None:
        raise typer.BadParameter(f"{scenario!r} is not one of: {', '.join(SCENARIOS)}.", param_hint="--scenario")
    return Settings(
        verify=verify,  # type: ignore[arg-type]
        runs=count,
        seed=SEED if seed is None else seed,
        scale_motions=scale_motions,
        scenario=kind,  # type: ignore[arg-type]
        route_risk=route_risk,
    )


def read_fixed_settings(runs: str | None, seed: int | None, scenario: str | None) -> Settings:
    """Return the settings of a fragility, which has as many motions at every value."""
    settings = read_settings("none", runs, seed, scenario)
    if settings.runs == AUTO:
        message = f"{AUTO} is for assess run: every value takes the same motions. Give their number."
        raise typer.BadParameter(message, param_hint="--runs")
    return settings


def read_pfa(text: str) -> list[float]:
    """Return the values of PFA [g] that ``LOW:HIGH`` or ``LOW:HIGH:STEP`` means: both ends, and every step between."""
    found = PFA.fullmatch(text.strip())
    if found is None:
        raise _bad_pfa(f"{text[:40]!r} is not LOW:HIGH or LOW:HIGH:STEP in g, as 0.1:1.0 or 0.1:1.0:0.05.")
    low, high, step = (Decimal(part) for part in (found[1], found[2], found[3] or STEP))
    if not 0 < low <= high <= MOST_PFA:
        raise _bad_pfa(f"it goes from {low} to {high} g, expected above 0, LOW first, and at most {MOST_PFA} g.")
    if step == 0:
        raise _bad_pfa("the step is 0 g, expected above 0.")
    steps = int((high - low) / step)
    values = [low + step * at for at in range(min(steps, MOST_VALUES) + 1)]
    values += [high] if values[-1] < high else []
    if len(values) > MOST_VALUES:
        raise _bad_pfa(f"{text.strip()} are over {MOST_VALUES} values. Take a larger step.")
    return [float(one) for one in values]


def _bad_pfa(message: str) -> typer.BadParameter:
    return typer.BadParameter(message, param_hint="--pfa")
