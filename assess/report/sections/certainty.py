"""Page two: how sure it is. The earthquake in words, what each method says, what moves the result, and the survey."""

from collections.abc import Iterator

from assess.i18n import fill, gettext as _, ngettext, number
from assess.report import blocks, words
from assess.report.cover import build_contents
from assess.report.say.ground import list_sources, say_ground
from assess.report.say.simulation import list_effects, say_assumed, say_condition
from assess.report.view import Part, View
from assess.results import ItemResult, count_pieces
from assess.risk import RiskClass, classify

SURVEY = (
    "survey_date", "surveyed_by", "extent", "rooms_not_entered", "investigation_level", "documents", "purpose",
)  # fmt: skip
"""Fields of the sheet Building on the survey and on who may rely on the report."""
MOST_NAMED = 10
"""Pieces that overturn under the record that are named."""


def build(view: View) -> blocks.Section:
    """Return what a reader has to know before trusting page one."""
    content = view.content
    shaking = say_ground(view.run)
    sources = "; ".join(list_sources(view.run.motions))
    found: list[blocks.Block] = [
        blocks.Heading(_("The earthquake")),
        *([blocks.Paragraph(shaking)] if shaking else []),
        *([blocks.Paragraph(_("Motion of the floors: {sources}.", sources=sources))] if sources else []),
        *([blocks.Paragraph(text)] if (text := say_recorded(view)) else []),
        *(blocks.Paragraph(text, "caution") for text in dict.fromkeys(one.short for one in content.cautions)),
        *_compare_methods(view),
        *_show_effects(view),
        *list_survey(view),
        *view.list_texts("What to believe"),
        *([build_contents(view)] if view.for_print else []),
    ]
    return blocks.Section(found, "believe")


def say_recorded(view: View) -> str:
    """Return what the recorded motion itself does, by name; "" without a record."""
    if not any(one.has_record for one in view.run.motions) or not view.content.verified.done:
        return ""
    fell = [one for one in view.content.verified.done if one.fell_in_record and not one.is_anchored]
    if not fell:
        return _("Under the recorded motion itself no piece overturns.")
    names = words.name_pieces([one.item.item for one in fell], MOST_NAMED)
    return ngettext("Under the recorded motion itself {n:,} piece overturns: {names}.",
                    "Under the recorded motion itself {n:,} pieces overturn: {names}.", count_pieces(fell),
                    names=names)  # fmt: skip


# ---------------------------------------------------------------- what each method says


def _compare_methods(view: View) -> Iterator[blocks.Block]:
    """Yield how many loose pieces each method calls high, and why the adopted one differs."""
    run, rows = view.run, [one for one in view.results if not one.is_anchored and one.apart != "rolls"]
    if not rows:
        return
    yield blocks.Heading(_("What each method says"))
    free = count_pieces(rows)
    lines: list[tuple[str, int, str]] = []
    for method in run.methods:
        if method.kind != "probability" or method.fitted is not None or method.key == run.simulation.key:
            continue
        values = ((one, one.worst(method.key)) for one in rows)
        high = count_pieces(one for one, value in values if _is_high(one, value))
        note = _("shown while the workbook is filled in") if method.key == run.formula.key else ""
        lines.append((_(method.title), high, note))
    lines.sort(key=lambda line: -line[1])
    highest, done = max((high for _name, high, _note in lines), default=0), [one for one in rows if one.is_simulated]
    if done:
        adopted = count_pieces(one for one in done if one.adopted.risk >= RiskClass.HIGH)
        lines.append((_("Simulated: an earthquake like this one"), adopted, _("adopted in this report")))
        if any(one.governing.simulation and one.governing.simulation.ideal for one in done):
            exact = count_pieces(one for one in done if one.ideal_class >= RiskClass.HIGH)
            lines.append((_("Simulated: exactly this motion, pieces as given"), exact, ""))
    heads = blocks.list_columns(
        (_("Method"), ""), (_("Pieces high or very high"), "w20", "num"), (_("Note"), "w36")
    )  # fmt: skip
    rows_ = [(blocks.head(name), _("{n:,} of {all:,}", n=high, all=free), note) for name, high, note in lines]
    yield blocks.table(heads, rows_, "methods-count few")
    yield blocks.Paragraph(" ".join(say_difference(view, is_lower=bool(done) and adopted < highest)))


def _is_high(one: ItemResult, value: float | None) -> bool:
    return one.adopted.can_rock and value is not None and (classify(value) or RiskClass.LOW) >= RiskClass.HIGH


def say_difference(view: View, *, is_lower: bool) -> list[str]:
    """Return why the methods differ, in plain sentences; `is_lower`: the simulation finds fewer pieces high."""
    run = view.run
    if not view.content.verified.done:
        return [_("No rocking was simulated in this run: the classes are those of the formula.")]
    draws = number(int(run.settings.runs), ",d") if run.settings.runs != "auto" else _("up to 5,000")
    if not is_lower:
        return [_("The formulas know the peak of the floor's motion and the shape of a piece; the simulation follows "
                  "every piece through {draws} motions of its floor, with its size.", draws=draws)]  # fmt: skip
    return [
        _("The formulas know the peak of the floor's motion and the shape of a piece; they were fitted to strong "
          "shaking and overstate weak shaking."),
        _("The simulation follows every piece through {draws} motions of its floor, with its size, and counts how "
          "often it overturns.", draws=draws),
        _("A piece that the peak of the motion cannot start to rock does not fall, whatever a formula says: that is "
          "why the numbers differ."),
    ]  # fmt: skip


# ---------------------------------------------------------------- what moves the result


def _show_effects(view: View) -> Iterator[blocks.Block]:
    """Yield what the expected falls would be under other assumptions, as bars."""
    effects = list_effects(view.run, view.results)
    if not effects:
        return
    now = view.content.total.expected
    yield blocks.Heading(_("What moves the result"))
    most = max(now, *(high for _label, _low, high in effects)) or 1.0
    heads = blocks.list_columns(
        (_("If it is otherwise than assumed"), ""), (_("Expected falls"), "w14", "num"), ("", "w36")
    )  # fmt: skip
    rows = [
        (blocks.head(label), _("{low} to {high}", low=words.round_falls(low), high=words.round_falls(high)),
         blocks.Image(_draw_range(low, now, high, most)))
        for label, low, high in effects
    ]  # fmt: skip
    yield blocks.table(heads, rows, "effects few")
    yield blocks.Paragraph(blocks.join_words([
        _("The line marks the result of this report: {falls}.", falls=words.round_falls(now)),
        _("Each percentage of this report is the chance of overturning in such an earthquake, not per year, "
          "{condition}.", condition=say_condition(view.run)),
        say_assumed(view.run),
    ]), "small")  # fmt: skip


def _draw_range(low: float, now: float, high: float, most: float) -> str:
    """Return a bar from the least to the largest number of falls, with a line at that of the report."""
    x, y, z = (1 + 198 * min(value / most, 1.0) for value in (low, now, high))
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" class="bar" aria-hidden="true" viewBox="0 0 200 12" width="200" '
        f'height="12"><path d="M1 6H199" stroke="#d5dade"/><rect x="{x:.1f}" y="2" width="{max(z - x, 1):.1f}" '
        f'height="8" fill="#db7133"/><path d="M{y:.1f} 0V12" stroke="#1c1c1c" stroke-width="1.6"/></svg>'
    )


# ---------------------------------------------------------------- the survey


def list_survey(view: View) -> list[blocks.Block]:
    """Return who surveyed what and when, the level of investigation, and who may rely on it."""
    facts = [(_(label), text) for label, text in view.list_facts(SURVEY)]
    known = [(blocks.head(label), text) for label, text in facts if text]
    missing = [label for label, text in facts if not text]
    found: list[blocks.Block] = [blocks.Heading(_("Survey and reliance"))]
    if known:
        found.append(blocks.table([blocks.Column(), blocks.Column()], known, "facts"))
    if missing:
        left = _("Not stated: {names}.", names=", ".join(missing))
        found.append(blocks.Paragraph(left, "small"))
    return found


PARTS = (
    Part(key="certainty", heading=fill("How sure this is"), places={"client": 15, "all": 15}, build=build),
)  # fmt: skip
