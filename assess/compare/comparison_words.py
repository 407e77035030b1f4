"""How a comparison calls things, in the language in use: settings, inputs, standings, directions, chances."""

import re
from collections.abc import Mapping
from typing import Any

from assess.compare.changes import ABSENT, Direction, PieceChange, StateChange, Total
from assess.compare.past_run import ANCHORED, BY_FORMULA, INPUTS, UNCONFIRMED, PastChance, PastRun
from assess.i18n import Text, fill, ngettext, number
from assess.i18n import gettext as _
from assess.report import words
from assess.results import CANNOT_ROCK
from assess.risk import RiskClass

LONGEST = 60
"""Characters of a value from a run that a table shows."""
NAMED = 5
"""Items that a line names; the others are counted."""

SETTINGS: Mapping[str, Text] = {
    "scenario": fill("Source of the floor motion"),
    "verify": fill("Pieces simulated"),
    "runs": fill("Draws of each floor and axis"),
    "seed": fill("Random seed"),
    "scale": fill("Factor on the motion of every floor"),
    "ideal": fill("Exactly this motion and these pieces"),
    "scale_motions": fill("Own motions scaled to each floor's PFA"),
    "city": fill("Earthquakes drawn by the building's place"),
    "zeta_acceleration": fill("Kaneko and Hayashi: dispersion of PFA"),
    "zeta_velocity": fill("Kaneko and Hayashi: dispersion of PFV"),
    "slide_coefficient": fill("Ishiyama: sliding coefficient"),
    "ductility_reduction": fill("Reduction of forces for ductility"),
    "anchor": fill("Taken as anchored and holding"),
    "anchor_resonance": fill("Anchors: resonance factor"),
    "anchor_strength": fill("Anchors: strength factor"),
    "anchor_importance": fill("Anchors: importance factor"),
    "route_risk": fill("Limit on the chance that a route is blocked"),
}
"""Settings by name; of later versions' others the name is shown."""
ALWAYS = ("scale", "anchor")
"""Settings that are shown even where both runs have the same."""
_DIRECTIONS: Mapping[Direction, Text] = {
    Direction.WORSE: fill("worse"),
    Direction.RISES: fill("higher chance"),
    Direction.UNCLEAR: fill("not comparable"),
    Direction.ADDED: fill("only in AFTER"),
    Direction.REMOVED: fill("only in BEFORE"),
    Direction.BETTER: fill("better"),
    Direction.FALLS: fill("lower chance"),
    Direction.SAME: fill("unchanged"),
}
_STANDINGS: Mapping[str, Text] = {
    UNCONFIRMED: fill("unconfirmed"),
    BY_FORMULA: fill("by formula only"),
    ANCHORED: fill("anchored"),
    "doubtful": fill("doubtful"),
}
_BASES: Mapping[str, Text] = {
    "simulated": fill("simulated"),
    "formula": fill("by formula"),
    "unconfirmed": fill("unconfirmed"),
    CANNOT_ROCK: fill("cannot rock"),
}
_CLASSES = {risk.word: risk for risk in RiskClass}
_SYMBOLS = {UNCONFIRMED: words.UNCONFIRMED, BY_FORMULA: words.BY_FORMULA, ANCHORED: words.ANCHORED}
_STYLES = {UNCONFIRMED: "apart-unconfirmed", BY_FORMULA: "apart-formula", ANCHORED: "anchored"}


def name_setting(name: str) -> str:
    """Return what a setting is called."""
    return _(SETTINGS[name]) if name in SETTINGS else name


def name_direction(direction: Direction) -> str:
    """Return a direction in words."""
    return _(_DIRECTIONS[direction])


def say_direction(one: PieceChange | StateChange) -> str:
    """Return where a row goes, and that the difference lies within the sampling interval where it does."""
    text = name_direction(one.direction)
    if one.is_within and one.direction != Direction.SAME:
        return _("{change} (within the sampling interval)", change=text)
    return text


def name_basis(basis: str) -> str:
    """Return what a chance rests on."""
    return _(_BASES[basis])


def name_state(state: str) -> str:
    """Return the standing of a piece or the state of a route or room in words; a dash where the run lacks it."""
    if state == ABSENT:
        return words.DASH
    return _(_STANDINGS.get(state, state))


def label_standing(standing: str) -> str:
    """Return the standing of a piece with its symbol."""
    risk = _CLASSES.get(standing)
    if risk is not None:
        return words.risk_label(risk)
    return f"{_SYMBOLS[standing]} {name_state(standing)}" if standing in _SYMBOLS else name_state(standing)


def style_standing(standing: str) -> str:
    """Return the name of the style of a standing."""
    risk = _CLASSES.get(standing)
    return words.class_name(risk) if risk is not None else _STYLES.get(standing, "none")


def say_chance(chance: PastChance | None) -> str:
    """Return a chance with its interval, where there is one."""
    return words.DASH if chance is None else words.say_chance(chance.probability, chance.low, chance.high)


def say_inputs(change: PieceChange) -> list[str]:
    """Return what differs in the inputs of a piece: ``Height: 180 → 200 cm``."""
    texts = []
    for name, (before, after) in change.inputs.items():
        field = INPUTS[name]
        values = _("{before} → {after}", before=say_value(before), after=say_value(after))
        texts.append(_("{label}: {value}", label=_(field.label), value=f"{values} {field.unit}".rstrip()))
    return texts


def say_value(value: Any) -> str:
    """Return a value of a run: a dash for none, words for a flag, texts cut."""
    if value is None or value == "" or value == ():
        return words.DASH
    if isinstance(value, bool):
        return _("yes") if value else _("no")
    if isinstance(value, int | float):
        return number(value, ".6g")
    if isinstance(value, tuple):
        return words.name_first([words.cut(one, 30) for one in value], NAMED)
    return words.cut(_(str(value)), LONGEST)


def say_anchor(value: Any) -> str:
    """Return the setting of what is taken as anchored, ``A1,A2`` or ``first:3``, in words."""
    first = re.fullmatch(r"first:(\d{1,9})", str(value))
    if first:
        return ngettext("the first entry of what to fix", "the first {n:,} entries of what to fix", int(first[1]))
    return say_value(tuple(value.split(",")) if isinstance(value, str) and value else value)


def say_total(value: float, is_count: bool) -> str:
    """Return a sum: a count in whole numbers, an expected number with two decimals."""
    return number(int(value), ",d") if is_count else number(value, ",.2f")


def say_difference(total: Total, is_count: bool) -> str:
    """Return the change of a sum with its sign, and whether it lies within the sampling interval."""
    if not total.is_comparable:
        return _("not comparable")
    difference = total.after - total.before
    if abs(difference) < (0.5 if is_count else 0.005):
        return say_total(0, is_count)
    text = f"{'+' if difference > 0 else '−'}{say_total(abs(difference), is_count)}"
    return _("{change} (within the sampling interval)", change=text) if total.is_within else text


def list_conditions(run: PastRun) -> list[str]:
    """Return what sets a run apart from the workbook as it is: a factor, pieces taken as anchored, nothing varied."""
    texts, settings = [], run.settings
    if run.shaking:
        texts.append(_("assumed shaking, {intensity}", intensity=words.cut(_(run.shaking), 40)))
    if settings.get("scale", 1) != 1:
        texts.append(_("motion × {scale}", scale=say_value(settings.get("scale"))))
    if settings.get("anchor"):
        texts.append(_("taken as anchored: {items}", items=say_anchor(settings.get("anchor"))))
    if settings.get("ideal"):
        texts.append(_("if exactly this motion recurred"))
    return texts
