"""Risk classes as property sets of a building model: STEP lines added to the file, of which every byte stays."""

from collections import Counter
from collections.abc import Iterator, Sequence

from assess.bim.export_model import PROPERTY_SET, ModelElement, ModelPart
from assess.bim.export_results import ExportEntry, ExportPiece, ExportRun, ExportSegment, ExportWork
from assess.bim.export_step import (
    append_lines,
    make_global_id,
    write_integer,
    write_label,
    write_long_text,
    write_real,
    write_text,
)
from assess.bim.export_words import (
    BASES,
    describe,
    say_program,
    say_report,
    say_scenario,
    say_standing,
)
from assess.compare.past_run import PastRun
from assess.details import DETAILS
from assess.i18n import gettext as _
from assess.report import words


def add_properties(
    data: bytes, name: str, part: ModelPart, found: ExportRun, pieces: Sequence[tuple[ExportPiece, ModelElement]]
) -> bytes:
    """Return a building model with a property set on each of its pieces.

    `pieces`: the pieces with their elements: of several with one Source ID, the worst.
    Raises ModelError if the file does not end as an IFC file does.
    """
    lines: list[str] = []
    planned, routes = find_works(found.entries), find_routes(found.segments)
    counts = Counter(one.source_id for one in found.pieces)
    for piece, element in pieces:
        item = piece.past.item
        properties = list_properties(found.run, piece, routes.get(item, ()), planned.get(item))
        alike = counts[piece.source_id]
        if alike > 1:
            several = _("{n:,} pieces with this Source ID, the worst", n=alike)
            own = _("2 pieces with this Source ID, the worse") if alike == 2 else several
            properties.append(("Of", write_label(own)))
        lines += _write_set(properties, element, part.last_number + len(lines) + 1)
    return append_lines(data, lines, name)


def _write_set(properties: Sequence[tuple[str, str]], element: ModelElement, first: int) -> Iterator[str]:
    """Yield the properties of an element, their set, and its relation to the element, numbered from `first`."""
    owner = f"#{element.owner}" if element.owner else "$"
    for number, (key, value) in enumerate(properties, first):
        yield f"#{number}=IFCPROPERTYSINGLEVALUE({write_text(key)},$,{value},$);"
    last = first + len(properties)
    own = ",".join(f"#{number}" for number in range(first, last))
    set_key, relation_key = (make_global_id(kind, element.key) for kind in ("property set", "relation"))
    what = write_text(say_meaning())
    yield f"#{last}=IFCPROPERTYSET('{set_key}',{owner},{write_text(PROPERTY_SET)},{what},({own}));"
    yield f"#{last + 1}=IFCRELDEFINESBYPROPERTIES('{relation_key}',{owner},$,$,(#{element.number}),#{last});"


def say_meaning() -> str:
    """Return what the set is, for its Description."""
    return _("Chance that the piece overturns in the earthquake named in Scenario, not per year. Forces are for "
             "screening, not design.")  # fmt: skip


Planned = tuple[ExportEntry, ExportWork]
"""A part of the schedule, in its entry."""


def find_works(entries: Sequence[ExportEntry]) -> dict[str, Planned]:
    """Return the part of the schedule that each piece in it belongs to, by its name."""
    return {item: (entry, work) for entry in entries for work in entry.works for item in work.items}


def find_routes(segments: Sequence[ExportSegment]) -> dict[str, list[str]]:
    """Return the routes that each piece may block, by its name."""
    found: dict[str, dict[str, None]] = {}
    for one in segments:
        for item in one.items:
            found.setdefault(item, {})[one.route] = None
    return {item: list(routes) for item, routes in found.items()}


def list_properties(
    run: PastRun, one: ExportPiece, routes: Sequence[str], planned: Planned | None
) -> list[tuple[str, str]]:
    """Return the properties of a piece: names, the same in every language, and values as STEP text.

    RiskClass is the class in the words of the report, so that what is outside its classes is no class here either.

    `routes`: those that it may block.
    `planned`: its part of the schedule; None where it has none.
    """
    return [
        *_list_risk(run, one),
        *_list_inputs(one),
        *_list_importance(one, routes),
        *(_list_fixing(*planned) if planned else ()),
        ("Scenario", write_long_text(say_scenario(run))),
        ("AssessedBy", write_label(say_program(run))),
        ("Report", write_long_text(say_report(run))),
    ]


def _list_risk(run: PastRun, one: ExportPiece) -> Iterator[tuple[str, str]]:
    chance = one.past.chance
    yield "RiskClass", write_label(say_standing(run, one))
    if one.upper != one.past.risk:
        yield "ClassUpper", write_label(words.risk_word(one.upper))
    yield "Probability", write_real(chance.probability)
    if chance.low is not None and chance.high is not None:
        yield "ProbabilityLow", write_real(chance.low)
        yield "ProbabilityHigh", write_real(chance.high)
    yield "Basis", write_label(_(BASES[one.past.basis]))


def _list_inputs(one: ExportPiece) -> Iterator[tuple[str, str]]:
    inputs = one.past.inputs
    yield "Item", write_label(one.past.item)
    yield "Description", write_label(describe(one))
    if inputs.get("anchored"):
        yield "Anchored", write_label(_(str(inputs["anchored"])))
    for key, field in (("Breadth_cm", "breadth_cm"), ("Height_cm", "height_cm"), ("PFA_g", "pfa_g")):
        value = inputs.get(field)
        if isinstance(value, int | float):
            yield key, write_real(value)
    if one.pfa_source:
        yield "PFASource", write_label(one.pfa_source)


def _list_importance(one: ExportPiece, routes: Sequence[str]) -> Iterator[tuple[str, str]]:
    if routes:
        yield "MayBlockRoutes", write_long_text(", ".join(routes))
    if one.importance:
        yield "Importance", write_label(_(one.importance))


def _list_fixing(entry: ExportEntry, work: ExportWork) -> Iterator[tuple[str, str]]:
    yield "FixOrder", write_integer(entry.place)
    yield "FixingDetail", write_label(_(DETAILS[work.detail].title))
    yield "FixingTension_kN", write_real(work.tension_kn)
    yield "FixingTension84_kN", write_real(work.tension_high_kn)
    if work.tension_code_kn is not None:
        yield "FixingTensionCode_kN", write_real(work.tension_code_kn)
    yield "BaseShear_kN", write_real(work.shear_kn)
