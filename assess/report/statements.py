"""What a report states about itself: assumptions, the meaning of the marks, limits, and how it was made."""

from collections import Counter
from collections.abc import Sequence

from assess.i18n import gettext as _, ngettext, number
from assess.pipeline.anchors import BRACKET
from assess.report import words
from assess.report.say import ground
from assess.report.say.route import say_risk
from assess.results import MOTION_FLAGS, PIECE_FLAG_TEXTS, Results
from assess.route_results import FLAGS as ROUTE_FLAGS
from assess.units import GRAVITY
from assess.workbook.catalogue import is_assumed
from assess.workbook.schema import ITEMS

MOST_FILES = 40
"""Input files whose hashes a report lists."""
OBSERVED = ("standing_inside",)
"""Flags of routes that state an observation rather than an assumption."""
Lines = list[tuple[str, str]]


def list_flags(results: Results) -> dict[str, str]:
    """Return the meaning of every mark; where methods mean different things by one, each with its method."""
    meanings: dict[str, dict[str, str]] = {}
    for method in results.methods:
        for flag, meaning in method.flags.items():
            meanings.setdefault(flag, {}).setdefault(_(meaning), _(method.title))
    texts = {
        flag: next(iter(by_meaning))
        if len(by_meaning) == 1
        else "; ".join(f"{title}: {text}" for text, title in by_meaning.items())
        for flag, by_meaning in meanings.items()
    }
    return texts | {flag: _(text) for flag, text in (*PIECE_FLAG_TEXTS.items(), *MOTION_FLAGS.items())}


# ---------------------------------------------------------------- assumptions


def list_assumptions(results: Results) -> Lines:
    """Return what was assumed, and for how many rows or where."""
    items, lines = results.item_rows, ground.list_assumed(results)
    catalogue = _("taken from the Catalogue by Type")
    assumed = {
        "breadth": catalogue, "width": catalogue, "height": catalogue, "weight": catalogue,
        "centre_of_gravity": catalogue,
        "quantity": _("1 piece"),
        "axis": _("set from Angle, which lies within 15° of X or Y"),
        "anchored": _("unknown, which counts as free-standing"),
        "friction": _("the building's default friction"),
    }  # fmt: skip
    counted = Counter(name for item in items for name in item.assumed)
    for name, text in assumed.items():
        if n := counted[name]:
            where = ngettext("{column} blank in {n:,} row", "{column} blank in {n:,} rows", n,
                             column=_(ITEMS.column(name).label))  # fmt: skip
            lines.append((where, text))
    types = {one.type for one in results.catalogue if is_assumed(one.source)}
    sizes = {"breadth", "width", "height", "centre_of_gravity"}
    if n := sum(item.type in types and not sizes.isdisjoint(item.assumed) for item in items):
        lines.append((ngettext("Sizes by Type in {n:,} row", "Sizes by Type in {n:,} rows", n),
                      _("assumed: usual sizes, no citable source")))  # fmt: skip
    if n := sum(one.anchor.weight_source == "estimate" for one in items):
        text = _("estimated for forces on brackets, by a density of what the Type holds; densities are assumed unless "
                 "a source stands beside them")  # fmt: skip
        lines.append((ngettext("Weight unknown in {n:,} row", "Weight unknown in {n:,} rows", n), text))
    if n := sum(one.anchor.is_height_assumed for one in items):
        lines.append((ngettext("Bracket height unknown in {n:,} row", "Bracket height unknown in {n:,} rows", n),
                      _("assumed: {share:g} % of the height of the piece", share=100 * BRACKET)))  # fmt: skip
    if n := sum(item.axis_given is None for item in items):
        lines.append((ngettext("Axis unknown in {n:,} row", "Axis unknown in {n:,} rows", n),
                      _("the worse of X and Y governs")))  # fmt: skip
    if n := sum(item.friction is None for item in items):
        lines.append((ngettext("Friction unknown in {n:,} row", "Friction unknown in {n:,} rows", n),
                      _("no sliding, as the paper assumes")))  # fmt: skip
    constants = {
        one.title: ", ".join(f"{each.symbol} = {number(getattr(results.settings, each.setting), 'g')}"
                             for each in one.parameters)
        for one in results.methods if one.parameters
    }  # fmt: skip
    return [
        *lines,
        *(_list_for_routes(results) if results.has_routes else ()),
        *((_(title), text) for title, text in constants.items()),
        (_("Gravity"), f"{number(GRAVITY)} m/s²"),
        (_("A class limit belongs to"), _("the higher class (the paper leaves this open)")),
    ]  # fmt: skip


def _list_for_routes(results: Results) -> Lines:
    routes = results.route_tables
    of_segments = Counter(flag for one in routes.segments for flag in one.flags)
    of_pieces = Counter(
        flag for __, flag in {(near.item_index, flag) for one in routes.segments for near in one.pieces
                              for flag in near.flags}
    )  # fmt: skip
    lines = [(_("Routes: the chosen risk"), say_risk(routes.risk))]
    for flag, text in ROUTE_FLAGS.items():
        if flag not in OBSERVED and (n := of_segments[flag]):
            lines.append((ngettext("Routes: {n:,} segment", "Routes: {n:,} segments", n), _(text)))
        if flag not in OBSERVED and (n := of_pieces[flag]):
            lines.append((ngettext("Routes: {n:,} row of pieces", "Routes: {n:,} rows of pieces", n), _(text)))
    blocked = [*(one.blocked for one in routes.segments), *(one.blocked for one in routes.routes)]
    chances = [chance for chance in blocked if chance is not None]
    if not any(chance.pieces for chance in chances):
        return lines
    draws = ngettext("{n:,} draw with seed {seed}", "{n:,} draws with seed {seed}", routes.draws,
                     seed=results.settings.seed)  # fmt: skip
    lines += [(_("Routes: where there are too many combinations of falling pieces to go through"), draws)]
    if any(chance.unverified for chance in chances):
        lines.append((_("Routes: pieces that enter by the formula's chance alone"),
                      _("fall independently of all others; the largest of the joint, the independent and the fully "
                        "correlated chance counts")))  # fmt: skip
    if any(not chance.unverified and not chance.is_joint for chance in chances):
        largest = _("the largest of the joint, the independent and the fully correlated chance counts")
        lines.append((_("Routes: pieces that were decided after different numbers of draws"), largest))
    return lines


# ---------------------------------------------------------------- limits


def list_limits(results: Results) -> Sequence[str]:
    """Return the limits of the methods, in plain words."""
    of_simulation = (
        _("A simulated chance is that of the rigid block under motions that match the floor's record, or that are "
          "drawn where it has none. Its sampling interval covers the number of draws only."),
        _("How much stronger or weaker an earthquake like this one could be, and how much pieces differ from their "
          "nominal sizes, centre of gravity and restitution, is assumed, not measured on furniture."),
        *(() if results.provenance.suite else (ground.say_signs(results),)),
        _("Rocking depends on details of a motion that a response spectrum does not contain, such as long pulses. "
          "The behaviour under the recorded motion itself is therefore shown next to the chance."),
    )  # fmt: skip
    of_routes = (
        _("Evacuation routes are screened by a rule of this program, as no published rule exists. Only pieces that "
          "overturn count: not what slides or rolls, spilt contents, jammed doors, fallen ceilings or people."),
        _("An open route is not shown to be safe: its chance is below the chosen risk in an earthquake like this one, "
          "as far as the workbook lists the furniture. The direction of a recorded motion is not used: a piece may "
          "fall either way, unless it stands against a wall and the outline of its room tells on which side that is."),
    )  # fmt: skip
    return [
        _("The chance is that of overturning in an earthquake like this one. It is not a chance per year, and does not "
          "state how likely the scenario is."),
        _("Every piece is a rigid block on a rigid floor, moving in one vertical plane. Its centre of gravity is at "
          "mid-height unless Centre of gravity says otherwise, which simulation takes into account and the formulas "
          "do not. A top-heavy piece falls sooner, a bottom-heavy one later."),
        _("Chances and classes leave sliding out. How a piece of known friction starts to move, and how far it would "
          "slide if it did not rock, is shown beside them: a piece that slides may still hit people or block a way."),
        _("A wall at the back of a piece lowers neither its chance nor its class, as the wall's own motion and "
          "pounding feed in energy that is left out. The chance with the wall is shown beside."),
        _("Vertical motion is left out."),
        _("Not covered: castors, stacked or leaning pieces, pieces linked to each other, open drawers, spilt "
          "contents, fastenings that fail."),
        *(f"{_(results.formula.title)}: {_(text)}" for text in results.formula.assumptions),
        _("A piece marked as anchored is not classified: it depends on its anchors; its free-standing risk is shown."),
        *(of_simulation if results.has_simulated else ()),
        *(of_routes if results.has_routes else ()),
    ]  # fmt: skip


# ---------------------------------------------------------------- how it was made


def list_making(results: Results) -> Lines:
    """Return what a run is made again from: version, settings, seed, and the hash of every input."""
    settings, provenance = results.settings, results.provenance
    made_with = ", ".join(f"{name} {value}" for name, value in provenance.platform.items())
    lines = [
        ("assess", f"{provenance.version} ({made_with})"),
        (_("SHA-256 of the program's code"), provenance.code),
        (_("Scenario kind"), _(provenance.scenario)),
        (_("Verification"), settings.verify),
        *([(_("Exactly this motion, and every piece exactly as given"), _("yes"))] if settings.ideal else []),
        *([(_("Factor on every floor's motion"), number(settings.scale, "g"))] if settings.scale != 1 else []),
    ]
    if results.has_simulated and provenance.suite is None:
        lines += [(_("Motions of each floor and axis"), f"{settings.runs}"), (_("Seed"), f"{settings.seed}")]
    if results.has_routes:
        lines.append((_("Routes: the chosen risk"), say_risk(settings.route_risk)))
    lines.append((_("Workbook"), f"{words.cut(provenance.workbook, 80)}, SHA-256 {provenance.sha256}"))
    files = list(provenance.files.items())
    lines += [(_("File"), f"{words.cut(name, 80)}, SHA-256 {digest}") for name, digest in files[:MOST_FILES]]
    if len(files) > MOST_FILES:
        more = len(files) - MOST_FILES
        lines.append((_("File"), ngettext("{n:,} more is in results.json.", "{n:,} more are in results.json.", more)))
    return lines
