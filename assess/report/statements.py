"""What a report states of itself: what was assumed, what the marks mean, and where the methods end."""

from collections import Counter
from collections.abc import Mapping, Sequence

from assess.cases import FLAGS as ITEM_FLAGS
from assess.demand import FLAGS as DEMAND_FLAGS
from assess.inventory.columns import ITEMS
from assess.language import gettext as _
from assess.language import ngettext, number
from assess.report import words
from assess.report.findings import motions
from assess.report.findings.routes import say_risk
from assess.results import Assessment
from assess.routes.couplings import EXACT
from assess.routes.flags import FLAGS as ROUTE_FLAGS
from assess.routes.model import Routes
from assess.units import GRAVITY
from assess.version import __version__

MOST_FILES = 40
"""Input files whose hashes a report lists."""


def list_flags(assessment: Assessment) -> dict[str, str]:
    """Return what every mark means; where methods mean different things by one, each with its method."""
    meanings: dict[str, dict[str, str]] = {}
    for method in assessment.methods:
        for flag, meaning in method.flags.items():
            meanings.setdefault(flag, {}).setdefault(_(meaning), _(method.title))
    told = {
        flag: next(iter(by_meaning))
        if len(by_meaning) == 1
        else "; ".join(f"{title}: {text}" for text, title in by_meaning.items())
        for flag, by_meaning in meanings.items()
    }
    return told | {flag: _(text) for flag, text in (*ITEM_FLAGS.items(), *DEMAND_FLAGS.items())}


def list_assumptions(assessment: Assessment) -> list[tuple[str, str]]:
    """Return what was assumed, and for how many rows or where."""
    items = assessment.inventory.items
    counted = Counter(name for item in items for name in item.assumed)
    lines = motions.list_assumptions(assessment)
    for name, text in _assumed().items():
        if counted[name]:
            where = ngettext("{column} blank in {n:,} row", "{column} blank in {n:,} rows", counted[name],
                             column=_(ITEMS.column(name).label))  # fmt: skip
            lines.append((where, text))
    axes, frictions = (sum(value is None for value in values) for values in
                       ((item.axis for item in items), (item.friction for item in items)))  # fmt: skip
    if axes:
        lines.append((ngettext("Axis unknown in {n:,} row", "Axis unknown in {n:,} rows", axes),
                      _("the worse of X and Y governs")))  # fmt: skip
    if frictions:
        lines.append((ngettext("Friction unknown in {n:,} row", "Friction unknown in {n:,} rows", frictions),
                      _("no sliding, as the paper assumes")))  # fmt: skip
    of_routes = _list_for_routes(assessment.routes, assessment) if assessment.routes else []
    return lines + of_routes + _list_constants(assessment)


FOUND = ("standing_inside",)
"""Flags of routes that tell what was found, not what was assumed."""


def _list_for_routes(routes: Routes, assessment: Assessment) -> list[tuple[str, str]]:
    """Return what was assumed of the evacuation routes."""
    segments = Counter(flag for one in routes.segments for flag in one.flags)
    pieces = Counter(flag for flags in _flags_beside(routes) for flag in flags)
    lines = [(_("Routes: the chosen risk"), say_risk(routes.risk))]
    for flag, text in ROUTE_FLAGS.items():
        if flag in FOUND:
            continue
        if segments[flag]:
            where = ngettext("Routes: {n:,} segment", "Routes: {n:,} segments", segments[flag])
            lines.append((where, _(text)))
        if pieces[flag]:
            where = ngettext("Routes: {n:,} row of pieces", "Routes: {n:,} rows of pieces", pieces[flag])
            lines.append((where, _(text)))
    return lines + _list_couplings(routes, assessment)


def _flags_beside(routes: Routes) -> list[set[str]]:
    """Return the flags of every row of pieces beside a segment, each once."""
    found: dict[int, set[str]] = {}
    for one in routes.segments:
        for near in one.beside:
            found.setdefault(near.item, set()).update(near.flags)
    return list(found.values())


def _list_couplings(routes: Routes, assessment: Assessment) -> list[tuple[str, str]]:
    """Return what was assumed of pieces that fall together; nothing where none reaches a route."""
    outlooks = [*(one.outlook for one in routes.segments), *(one.outlook for one in routes.routes)]
    chances = [outlook.blocked for outlook in outlooks]
    if not any(chance.pieces for chance in chances):
        return []
    lines = [(_("Routes: where more than {exact:,} outcomes are too many to go through", exact=EXACT),
              _("{draws:,} draws with seed {seed}", draws=routes.draws, seed=assessment.settings.seed))]  # fmt: skip
    if any(chance.unverified for chance in chances):
        lines.append((_("Routes: pieces that enter by the formula's chance alone"),
                      _("fall independently of all others; the largest of the joint, the "
                        "independent and the fully correlated chance counts")))  # fmt: skip
    if any(chance.pieces > chance.unverified and not chance.is_joint for chance in chances):
        lines.append((_("Routes: pieces on floors whose motions come from different sources"),
                      _("fall independently of each other; the largest of the joint, the independent and the fully "
                        "correlated chance counts")))  # fmt: skip
    return lines


def _list_constants(assessment: Assessment) -> list[tuple[str, str]]:
    """Return the constants of the methods, and what holds for every number."""
    settings = assessment.settings
    return [
        (_("Kaneko-Hayashi, standard deviations (not printed in the source)"),
         f"ζ_A = {number(settings.zeta_acceleration, 'g')}, ζ_V = {number(settings.zeta_velocity, 'g')}"),
        (_("Kaneko-Hayashi, slide coefficient α"), number(settings.slide_coefficient, "g")),
        (_("Gravity"), f"{number(GRAVITY)} m/s²"),
        (_("A class limit belongs to"), _("the higher class (the paper leaves this open)")),
        (_("Units"), _("Lengths are in cm and m, accelerations in g, velocities in cm/s, whatever the workbook's units "
                       "are.")),
    ]  # fmt: skip


def _assumed() -> Mapping[str, str]:
    catalogue = _("taken from the Catalogue by Type")
    return {
        "breadth": catalogue,
        "width": catalogue,
        "height": catalogue,
        "quantity": _("1 piece"),
        "axis": _("set from Angle, which lies within 15° of X or Y"),
        "anchored": _("unknown, which counts as free-standing"),
        "friction": _("the building's default friction"),
    }


def list_limits(*, has_verified: bool, has_routes: bool = True) -> Sequence[str]:
    """Return where the methods end, in plain words."""
    verified, routes = _of_verification() if has_verified else (), _of_routes() if has_routes else ()
    return _of_the_block() + _of_the_formulas() + verified + routes


def _of_routes() -> tuple[str, ...]:
    return (
        _(
            "Evacuation routes are screened, by a rule of ours, as none is published in closed form. Only what "
            "overturns counts: not what slides or rolls, spilt contents, jammed doors, fallen ceilings or people."
        ),
        _(
            "A route that is below the chosen risk in this scenario is not shown to be safe, and a segment that is not "
            "evaluated is not known to be. The direction of a recorded motion is not used: a piece may fall either way."
        ),
    )


def _of_the_block() -> tuple[str, ...]:
    return (
        _(
            "The chance is that of overturning in this scenario. It is not a chance per year, and says nothing of"
            " how likely the scenario is."
        ),
        _(
            "Every piece is a rigid block on a rigid floor, moving in one vertical plane, with its centroid at "
            "mid-height. A top-heavy piece falls sooner, a bottom-heavy one later."
        ),
        _(
            "No piece slides. On a smooth floor (friction below B/H) a piece slides before it rocks, and may "
            "still hit people or block a way."
        ),
        _("Vertical motion is left out."),
        _(
            "Not covered: castors, stacked or leaning pieces, pieces linked to each other, open drawers, spilt "
            "contents, fastenings that fail."
        ),
    )


def _of_the_formulas() -> tuple[str, ...]:
    return (
        _(
            "The proposed OR formula was fitted in three steel buildings and is checked by shaking-table tests "
            "for B/H 0.14 to 0.39 and PFA 0.10 to 0.90 g only; results outside are marked."
        ),
        _(
            "The proposed OR formula knows no size: a large piece and a small one of the same proportions get the"
            " same value, although the larger is harder to overturn."
        ),
        _(
            "The proposed OR formula calls pieces high below the acceleration at which they can start to rock; "
            "the comparison shows the static criterion beside it."
        ),
        _("A piece marked as anchored is only as safe as its anchor; its free-standing risk is shown, never zero."),
    )


def _of_verification() -> tuple[str, ...]:
    return (
        _(
            "A verified chance is that of the rigid block under motions that meet the floor's spectrum and peak. "
            "Its interval covers the number of motions only."
        ),
        _(
            "Rocking depends on details of a motion that a response spectrum does not hold, such as long pulses. "
            "What a piece does under the recorded motion itself therefore stands beside its chance."
        ),
    )


def list_making(assessment: Assessment, platform: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return what a run is made again from: version, settings, seed, and the hash of every input."""
    settings, inventory = assessment.settings, assessment.inventory
    made_with = ", ".join(f"{name} {value}" for name, value in platform.items())
    lines = [
        ("assess", f"{__version__} ({made_with})"),
        (_("Scenario kind"), _(assessment.scenario)),
        (_("Verification"), f"--verify {settings.verify}"),
    ]
    if assessment.joints and assessment.suite is None:
        lines += [(_("Motions of each floor and axis"), f"{settings.runs}"), (_("Seed"), f"{settings.seed}")]
    if assessment.routes:
        lines.append((_("Routes: the chosen risk"), say_risk(settings.route_risk)))
    lines.append((_("Workbook"), f"{words.cut(inventory.source.name, 80)}, SHA-256 {inventory.sha256}"))
    files = list(inventory.files.items())
    lines += [(_("File"), f"{words.cut(name, 80)}, SHA-256 {digest}") for name, digest in files[:MOST_FILES]]
    if len(files) > MOST_FILES:
        more = len(files) - MOST_FILES
        lines.append((_("File"), ngettext("{n:,} more is in results.json.", "{n:,} more are in results.json.", more)))
    return lines
