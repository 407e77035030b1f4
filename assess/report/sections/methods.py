"""What the report rests on: methods with their equations, assumptions, limits, sources, input, and how it was made."""

from collections.abc import Iterator

from assess.i18n import fill, gettext as _, number
from assess.report import blocks, measures, statements, words
from assess.report.figures.draw import build_figure
from assess.report.figures.motion_figures import draw_motion, get_acceleration
from assess.report.page_columns import say_flag
from assess.report.provenance import say_reference
from assess.report.say import ground
from assess.report.say.piece import describe
from assess.report.say.route import say_risk
from assess.report.say.simulation import WILSON, list_references, say_assumed
from assess.report.view import Part, View, say_left
from assess.results import ItemResult, MotionRow
from assess.risk import classify
from assess.workbook.schema import BUILDING, NO, YES

WHOLE = 14
"""Lines of equations that are kept on one page."""

MOST_NOTES, MOST_PROBLEMS, FEW = 150, 120, 6
"""Notes and problems that are shown; rows up to which a table is kept on one page."""

ON_COVER = frozenset((
    "address", "client", "use", "organisation", "storeys", "height", "scenario_kind", "ground_pga", "sds", "hazard",
))  # fmt: skip
"""What the workbook says of the building that a cover has room for."""
ELSEWHERE = frozenset((
    "building", "scenario", "prepared_by", "checked_by", "approved_by", "report_date", "language", "revision",
    "azimuth_deg",
))  # fmt: skip
"""What stands elsewhere in the report."""


def build_methods(view: View) -> blocks.Section:
    """Return what is adopted, each method, the worked example, and the profiles of the codes."""
    listed: list[blocks.Block] = [blocks.Paragraph(view.content.verified.adopted)]
    symbols = {"breadth_to_height": "B/H", "pfa": "PFA", "height": "H", "pfv": "PFV"}
    for method in view.run.methods:
        equations = [blocks.Equation(_(line)) for line in method.equations]
        found: list[blocks.Block] = [
            blocks.Heading(_(method.title)), blocks.Paragraph(_(method.predicts)),
            blocks.Equations(equations, is_whole=len(equations) <= WHOLE),
        ]  # fmt: skip
        if method.valid:
            ranges = (
                " ".join((symbols.get(name, name), _("{low:g} to {high:g}", low=one.low, high=one.high), one.unit))
                for name, one in method.valid.items()
            )
            shown = ", ".join(text.rstrip() for text in ranges)
            found.append(blocks.Paragraph([blocks.strong(words.name_ranges(method)), f" {shown}."]))
        for heading, texts in (
            (_("Assumptions"), method.assumptions),
            (_("Departures from the source"), method.departures),
        ):
            if texts:
                found += [blocks.Paragraph(blocks.strong(heading), "lead-in"),
                          blocks.Bullets([_(text) for text in texts], "")]  # fmt: skip
        source = _("Source: {reference}", reference=say_reference(method.reference))
        listed.append(blocks.Box([*found, blocks.Paragraph(source, "small")], "method", "article"))
    if view.run.worked_item is not None:
        listed.append(
            blocks.Box(_list_worked(view, view.results[view.run.worked_item]), "method", "article", "example")
        )
    text = _("Ground PGA times a code's amplification with height is used on floors without any other motion, or on "
             "every floor where the scenario names a code.")  # fmt: skip
    heads = blocks.list_columns(
        (_("Code"), "w9"), (_("Clause"), "w18"), (_("Equation"), ""), (_("Status"), "w36")
    )  # fmt: skip
    rows = [
        (one.key, ground.list_clauses(one), blocks.Equation(_(one.equation)), ground.profile_status(one))
        for one in view.run.provenance.profiles
    ]
    profiles: list[blocks.Block] = [
        blocks.Heading(_("Floor motion without a sensor")),
        blocks.Paragraph(f"{text} {_(ground.ENVELOPES)}"),
        blocks.table(heads, rows),
    ]
    return blocks.Section([*listed, blocks.Box(profiles, "method", "article")])


def _list_worked(view: View, example: ItemResult) -> list[blocks.Block]:
    found: list[blocks.Block] = [
        blocks.Heading(_("Worked example: {item}", item=words.cut(example.item.item, 40))),
        blocks.Paragraph(_("{what}, floor {floor}: {size}, {axis}, under its governing motion. All other numbers "
                           "are computed in the same way.", what=describe(example, 60),
                           floor=words.cut(example.item.floor, 20), size=f"{words.size(example)} {measures.unit('cm')}",
                           axis=_("along {axis}", axis=example.governing.motion.axis))),
    ]  # fmt: skip
    for one in view.run.worked:
        method = next(each for each in view.run.methods if each.key == one.key)
        risk = classify(one.value)
        if method.kind == "criterion" or risk is None:
            result = _(method.words[0] if one.value else method.words[1])
        else:
            result = _("{symbol} = {value:.4f}, that is {percent}: {risk}", symbol=method.symbol, value=one.value,
                       percent=words.percent(one.value), risk=words.risk_word(risk))  # fmt: skip
        steps = [blocks.Equation(_(step)) for step in one.steps]
        found += [blocks.Paragraph(blocks.strong(_(method.title)), "lead-in"),
                  blocks.Equations([*steps, blocks.strong(result)], is_whole=len(steps) <= WHOLE)]  # fmt: skip
    return found


def build_approach(view: View) -> blocks.Section:
    """Return, for a client, paragraphs on motions, chances and classes, what was assumed uncertain, and routes."""
    content, run, verified = view.content, view.run, view.content.verified
    sources = "; ".join(ground.list_sources(run.motions))
    found: list[blocks.Block] = [blocks.Heading(_("Motion of the floors"))]
    if sources:
        found.append(blocks.Paragraph(_("Where the motion comes from: {sources}.", sources=sources)))
    if not view.shows("motions"):
        found += [blocks.Paragraph(one.text, "caution") for one in content.cautions]
    classes = "; ".join(f"{words.risk_label(risk)} {limits}" for risk, limits in words.list_limits())
    limits = _("Classes by the chance of overturning: {classes}.", classes=classes)
    parts: list[tuple[str, tuple[str, ...]]] = [(_("Chance and class"), (verified.adopted, verified.sentence, limits))]
    if verified.done:
        interval = _("A range is the 95 % sampling interval of Wilson (1927). It covers the number of draws only, not "
                     "what is unknown about the earthquake or the furniture. On assumed motion it is the chance in the "
                     "slower and in the faster third of the drawn motions: what is not known of the ground and of the "
                     "building.")  # fmt: skip
        parts.append((_("What was assumed uncertain"), (say_assumed(run), interval)))
    if run.has_routes:
        evaluated = _("A route is evaluated by the chance that fallen pieces leave less than the required clear width "
                      "on one of its segments; pieces that fall in the same draw count together. The limit on that "
                      "chance is {risk}. No published rule exists; the rule used here is described in the annex.",
                      risk=say_risk(run.route_tables.risk))  # fmt: skip
        parts.append((_("Evacuation routes"), (evaluated,)))
    for heading, texts in parts:
        found += [blocks.Heading(heading), *(blocks.Paragraph(text) for text in texts if text)]
    keys = {run.formula.key, *({run.simulation.key} if verified.done else ())}
    named = [say_reference(one.reference) for one in run.methods if one.key in keys]
    named += [WILSON] if verified.done else []
    if named:
        found += [blocks.Heading(_("Sources")), blocks.Bullets(list(dict.fromkeys(named)), "references")]
    return blocks.Section(found)


def build_assumptions(view: View) -> blocks.Section:
    """Return the assumptions."""
    heads = blocks.list_columns((_("Where"), "w36"), (_("Assumed"), ""))
    return blocks.Section([blocks.table(heads, view.content.assumptions)])


def build_references(view: View) -> blocks.Section:
    """Return the publications of methods and profiles, and the sources of sizes of the types that are used."""
    types = {item.type for item in view.run.item_rows}
    sizes = [
        _("Sizes of {type}: {source}", type=words.clip(one.type, 60), source=words.clip(one.source, 200))
        for one in view.run.catalogue
        if one.source and one.type in types
    ]
    profiles = [one.reference for one in ground.used_profiles(view.run)]
    return blocks.Section([blocks.Bullets([*list_references(view.run), *profiles, *sizes], "references")])


def build_quality(view: View) -> blocks.Section:
    """Return the log, in the annex the building as filled in, and versions and hashes."""
    problems, making = view.content.problems, statements.list_making(view.run)
    found: list[blocks.Block] = [blocks.Paragraph(_("Missing or unusual input and how it was handled."))]
    if problems:
        heads = blocks.list_columns((_("Kind"), "w9"), (_("Place"), "w14"), (_("What"), ""))
        rows = [
            (_(one.severity), words.cut(one.place, 60), f"{_(one.message)} {_(one.fix)}")
            for one in problems[:MOST_PROBLEMS]
        ]
        found.append(blocks.table(heads, rows, "few" if len(problems) <= FEW else ""))
        found += say_left(len(problems) - MOST_PROBLEMS)
    else:
        found.append(blocks.Paragraph(_("None.")))
    if view.edition == "annex":
        found += [blocks.Heading(_("The building as filled in")), list_facts(view)]
    heads = blocks.list_columns((_("What"), "w24"), (_("Value"), ""))
    made = [(what, blocks.Cell(value, "hash")) for what, value in making]
    table = blocks.table(heads, made, "few" if len(making) <= FEW else "")
    return blocks.Section([*found, blocks.Heading(_("How this report was made")), table])


def build_appendix(view: View) -> blocks.Section:
    """Return marks, notes and records."""
    notes = [one.item for one in view.results if one.item.notes]
    found: list[blocks.Block] = [
        blocks.Heading(_("What the marks mean")),
        blocks.Terms([(say_flag(flag), meaning) for flag, meaning in statements.list_flags(view.run).items()]),
    ]
    if notes:
        rows = [(words.cut(one.item, 40), words.clip(one.notes, 300)) for one in notes[:MOST_NOTES]]
        heads = blocks.list_columns((_("Item"), "w12"), (_("Note"), ""))
        table = blocks.table(heads, rows, "few" if len(notes) <= FEW else "")
        found += [blocks.Heading(_("Notes of the workbook")), table, *say_left(len(notes) - MOST_NOTES)]
    recorded = view.once("recorded", lambda: list(_list_recorded(view)))
    return blocks.Section([*found, *([blocks.Heading(_("Recorded motions")), *recorded] if recorded else [])])


def _list_recorded(view: View) -> Iterator[blocks.Box]:
    found = [(page.title, one) for page in view.content.floors for one in page.motions if is_drawn(one)]
    strongest = sorted((one for _title, one in found), key=lambda one: -one.pfa_g)[:16]  # the others are described
    for title, one in found:
        name = words.cut(one.record, 60)
        lines = [
            _("{floor}, along {axis}: {name} ({event}). {treatment}", floor=title, axis=one.axis, name=name,
              event=words.cut(one.event, 60), treatment=ground.describe_treatment(one)),
            _("PFA in the file: {pfa} g.", pfa=words.in_g(one.pfa_file_g)) if one.pfa_file_g else "",
        ]  # fmt: skip
        values = get_acceleration(view.run, one) if one in strongest else None
        figures = []
        if values is not None:
            drawn = draw_motion(values, one.time_step_s or 0.0, view.progress)
            alternative = _("Acceleration against time of {name}, peak {pfa} g", name=name, pfa=words.in_g(one.pfa_g))
            caption = _("Recorded acceleration along {axis}, treated: {name}.", axis=one.axis, name=name)
            figures = [build_figure(drawn, alternative, caption)]
        yield blocks.Box([blocks.Paragraph(blocks.join_words(lines), "small"), *figures], "keep")


def is_drawn(one: MotionRow) -> bool:
    """Tell whether a motion is a record of its own floor and axis."""
    return one.has_record and not one.is_borrowed


def list_facts(view: View) -> blocks.Table:
    """Return what the workbook says of the building, and the state of the report."""
    content, is_client = view.content, view.edition == "client"
    left_out = set(ELSEWHERE)
    if view.run.provenance.scenario == "as filled" and view.run.building.scenario_kind in ("", "as filled"):
        left_out.add("scenario_kind")
    run, lines = view.run, list[tuple[str, str]]()
    for column in BUILDING.columns:
        value = getattr(run.building, column.name)
        if column.name in left_out or column.kind == "file" or (is_client and column.name not in ON_COVER):
            continue
        if column.name == "scenario_kind":
            used, chosen = run.provenance.scenario, value or "as filled"
            value = used if used == chosen else _("{used} (the workbook: {chosen})", used=_(used), chosen=_(chosen))
        if value not in (None, ""):
            shown = str(value)
            if isinstance(value, float):
                shown = number(measures.convert(value / column.factor, column.unit), ".4g")
            shown = (YES if value else NO) if column.kind == "flag" else shown
            shown += f" {measures.unit(column.unit)}" if column.quantity else ""
            shown = ground.say_peak(run, column.name, shown) if column.name in ground.PEAKS else shown
            shown = words.clip(_(shown) if column.kind in ("choice", "flag") else shown)
            lines.append((_(column.label), words.cut(shown, 150) if is_client else shown))
    pieces = _("{pieces} in {rows} on {floors}", pieces=words.plural(content.total.total, "piece"),
               rows=words.plural(len(view.results), "row"),
               floors=words.plural(len(content.floors), "floor"))  # fmt: skip
    status, why = content.verified.status
    facts: list[tuple[str, blocks.Words]] = [
        *lines, (_("Date"), content.date), (_("Pieces"), pieces),
        (_("Status"), [blocks.strong(status), f": {why}"]),
    ]  # fmt: skip
    rows = [(blocks.head(label), text) for label, text in facts]
    return blocks.table([blocks.Column(), blocks.Column()], rows, "facts")


def list_signing(view: View) -> list[blocks.Block]:
    """Return who answers for the report; on paper with room to sign."""
    building = view.run.building
    heads = [(_("Role"), "w18"), (_("Name"), "")]
    heads += [(_("Signature"), "w36"), (_("Date"), "w18")] if view.for_print else []
    names = (
        (_("Prepared by"), building.prepared_by), (_("Checked by"), building.checked_by),
        (_("Approved by"), building.approved_by),
    )  # fmt: skip
    room = ("", "") if view.for_print else ()
    rows = [(blocks.head(role), words.cut(name, 60), *room) for role, name in names]
    return [blocks.table(blocks.list_columns(*heads), rows, "signing")]


def say_made(view: View) -> blocks.Paragraph:
    """Return by which version of the program the report was made, from which workbook."""
    origin = view.run.provenance
    made = _("Made with assess {version} from {workbook}; versions and hashes are in the data-quality log.",
             version=origin.version, workbook=words.cut(origin.workbook, 80))  # fmt: skip
    return blocks.Paragraph(made, "small")


PARTS = (
    Part(key="methods", heading=fill("Methods"), places={"annex": 50, "all": 130}, build=build_methods),
    Part(key="approach", heading=fill("How the chances were computed"), places={"client": 60, "all": 80},
         build=build_approach),
    Part(key="assumptions", heading=fill("Assumptions and defaults"), places={"annex": 60, "all": 150},
         build=build_assumptions),
    Part(key="limits", heading=fill("Limits of the methods"), places={"client": 70, "all": 140},
         build=lambda view: blocks.Section([
             *view.list_texts("Limits"), blocks.Bullets(statements.list_limits(view.run), ""),
             say_made(view),
         ])),
    Part(key="references", heading=fill("References"), places={"annex": 80, "all": 170}, build=build_references),
    Part(key="quality", heading=fill("Data-quality log"), places={"annex": 70, "all": 160}, build=build_quality),
    Part(key="appendix", heading=fill("Appendix"), places={"annex": 90, "all": 180}, build=build_appendix),
    Part(key="about", heading=fill("About this report"), places={"all": 200},  # in print it stands on the cover
         build=lambda view: blocks.Section([list_facts(view), *list_signing(view)])),
)  # fmt: skip
