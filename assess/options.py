"""What the options of `assess run` mean, checked before the work."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from assess.settings import AUTO, MOST_RUNS, SCENARIOS, SEED, VERIFY, Settings, match_choice, read_runs

if TYPE_CHECKING:
    from assess.inventory.model import Inventory
    from assess.report.look import Look


def read_look(language: str | None, template: Path | None, accessible: bool) -> "Callable[[Inventory], Look]":
    """Return how the reports of an inventory are to look; what is wrong with the options is told before the work."""
    from assess.language import find_language
    from assess.report.look import Look

    look = Look(language=find_language(language or "en"), templates=template, accessible=accessible)
    if template is not None:
        from assess.report.pages.html import check_look

        check_look(look)
    return lambda inventory: look if language else replace(look, language=inventory.report_language)


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
    verify: str, runs: str | None, seed: int | None, scale_motions: bool, scenario: str | None
) -> Settings:
    """Return the settings of a run."""
    if verify not in VERIFY:
        raise typer.BadParameter(f"{verify!r} is not one of: {', '.join(VERIFY)}.", param_hint="--verify")
    count = read_runs(runs)
    if count is None:
        raise typer.BadParameter(f"{runs!r} is not a number from 1 to {MOST_RUNS:,}, nor {AUTO}.", param_hint="--runs")
    kind = None if scenario is None else match_choice(scenario, SCENARIOS)
    if scenario is not None and kind is None:
        raise typer.BadParameter(f"{scenario!r} is not one of: {', '.join(SCENARIOS)}.", param_hint="--scenario")
    return Settings(
        verify=verify,  # type: ignore[arg-type]
        runs=count,
        seed=SEED if seed is None else seed,
        scale_motions=scale_motions,
        scenario=kind,  # type: ignore[arg-type]
    )
