"""The methods with their equations, the worked example, and the motion of floors without a sensor."""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from assess.i18n import fill
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import (
    Block,
    Box,
    Bullets,
    Equation,
    Equations,
    Heading,
    Paragraph,
    Section,
    Words,
    list_columns,
    strong,
    table,
)
from assess.report.provenance import say_reference
from assess.report.say import ground
from assess.report.summary import describe
from assess.report.view import Part, View

if TYPE_CHECKING:
    from assess.methods import MethodInfo

WHOLE = 14
"""Lines of equations that are kept on one page."""
QUANTITIES: Mapping[str, str] = {"breadth_to_height": "B/H", "pfa": "PFA", "height": "H", "pfv": "PFV"}
"""Symbols of the inputs that a method has ranges of."""


def build(view: View) -> Section:
    """Return what is adopted, each method, the worked example, and the profiles of the codes."""
    blocks: list[Block] = [Paragraph(view.content.verified.adopted)]
    blocks += [Box(list(_describe(one)), "method", "article") for one in view.content.methods]
    blocks += [Box(list(_work(view)), "method", "article", "example")] if view.content.example else []
    return Section([*blocks, Box(_describe_profiles(view), "method", "article")])


def _set(lines: Sequence[str], *after: Words) -> Equations:
    return Equations([*(Equation(_(line)) for line in lines), *after], is_whole=len(lines) <= WHOLE)


def _describe(method: "MethodInfo") -> Iterator[Block]:
    yield Heading(_(method.title))
    yield Paragraph(_(method.predicts))
    yield _set(method.equations)
    if method.valid:
        ranges = [
            " ".join(
                (QUANTITIES.get(name, name), _("{low:g} to {high:g}", low=one.low, high=one.high), one.unit)
            ).rstrip()
            for name, one in method.valid.items()
        ]
        yield Paragraph([strong(words.name_ranges(method)), f" {', '.join(ranges)}."])
    for heading, texts in (
        (_("Assumptions"), method.assumptions),
        (_("Departures from the source"), method.departures),
    ):
        if texts:
            yield Paragraph(strong(heading), "lead-in")
            yield Bullets([_(text) for text in texts], "")
    yield Paragraph(_("Source: {reference}", reference=say_reference(method.reference)), "small")


def _work(view: View) -> Iterator[Block]:
    example = view.content.example
    if example is None:
        return
    yield Heading(_("Worked example: {item}", item=words.cut(example.item.item, 40)))
    yield Paragraph(_(
        "{what}, floor {floor}: {size} cm, {axis}, under its governing motion. All other numbers are computed in the "
        "same way.",
        what=describe(example, 60), floor=words.cut(example.item.floor, 20), size=words.size(example),
        axis=_("along {axis}", axis=example.governing.motion.axis),
    ))  # fmt: skip
    for one in view.content.worked:
        yield Paragraph(strong(one.title), "lead-in")
        yield Equations([*map(Equation, one.steps), strong(one.result)], is_whole=len(one.steps) <= WHOLE)


def _describe_profiles(view: View) -> list[Block]:
    text = _(
        "Ground PGA times a code's amplification with height is used on floors without any other motion, or on every "
        "floor where the scenario names a code."
    )
    heads = list_columns((_("Code"), "w9"), (_("Clause"), "w18"), (_("Equation"), ""), (_("Status"), "w36"))
    rows = [
        (one.key, ground.list_clauses(one), Equation(_(one.equation)), ground.profile_status(one))
        for one in view.run.provenance.profiles
    ]
    return [
        Heading(_("Floor motion without a sensor")),
        Paragraph(f"{text} {_(ground.ENVELOPES)}"),
        table(heads, rows),
    ]


PART = Part(key="methods", heading=fill("Methods"), places={"annex": 50, "all": 130}, build=build)
