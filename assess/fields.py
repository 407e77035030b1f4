"""Every shown field of a result, once: its column, place in results.json, label, unit, format and how it is read.

results.json and its schema, items.csv, the tables of a notebook, the Excel report and the lists of the other reports
derive from the lists below. A method's own columns follow from what it says of itself (`MethodInfo.columns`).
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from functools import cache
from html import escape
from itertools import islice
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

from assess.details import DETAILS
from assess.errors import Problem
from assess.i18n import fill
from assess.methods import MethodInfo
from assess.model import ANCHORED, AXES, COST_PER, IMPORTANCE, SIZES_FROM
from assess.results import BASES, BRANCHES, ItemResult, ItemRow, Results
from assess.risk import RiskClass
from assess.route_results import Chance, PieceRef, RoomRow, RouteRow, SegmentRow
from assess.schedule_results import PHASES, ScheduleRow, State, WorkRow
from assess.table import DATA, EVERYWHERE, FILES, Field, Kind, Table, Where


def _of_item(key: str, label: str, **more: Any) -> Field:
    source = f"item.{key}" if key in ItemRow.__slots__ else f"item.more.{key}"
    return Field(key=key, source=source, label=label, **more)


def _in_group(group: str, name: str, label: str = "", *, source: str = "", **more: Any) -> Field:
    """A field of a group of a record; `name` may lead into a group within it."""
    key, path = f"{group}_{name.replace('.', '_')}", (group, *name.split("."))
    return Field(key=key, source=source or f"{group}.{name}", path=path, label=label, **more)


def _simulation_field(name: str, kind: Kind, label: str, source: str = "", **more: Any) -> Field:
    return _in_group(
        "verification", name, label, source=f"simulation.{source or name}", kind=kind, **{"shows": DATA, **more}
    )


SIMULATION_FIELDS = (
    _simulation_field("runs", "count", fill("Motions"),
        help="Draws of an earthquake like this one and of the piece, a motion each, that it was simulated under."),
    _simulation_field("draws", "count", fill("Draws"),
        help="Draws of all pieces exactly alike on its floor: `runs` of each."),
    _simulation_field("overturned", "count", fill("Overturned"), help="Those of them in which the piece overturned."),
    _simulation_field("probability", "share", fill("Chance"), help="`overturned` / `draws`."),
    _simulation_field("low", "share", fill("Low"), help="Lower end of the 95 % sampling interval (Wilson)."),
    _simulation_field("high", "share", fill("High"), help="Upper end of it."),
    _simulation_field("ideal.runs", "count", fill("Motions"), help="Motions, the same as of the draws."),
    _simulation_field("if_slower", "share", fill("Chance if slower"), is_optional=True,
        help="Chance in the third of the draws with the least PFV/PFA, where ground motion and building are drawn."),
    _simulation_field("if_faster", "share", fill("Chance if faster"), is_optional=True,
        help="Chance in that with the most."),
    _simulation_field("ideal.overturned", "count", fill("Overturned"),
        help="Motions under which the piece overturned exactly as given, if exactly this motion recurred."),
    _simulation_field("ideal.probability", "share", fill("Chance if exactly this motion recurred"),
        short=fill("If exactly this motion recurred"), shows=DATA | {"methods"}, help="`overturned` / `runs`."),
    _simulation_field("ideal.low", "share", fill("Low"), help="Lower end of its sampling interval."),
    _simulation_field("ideal.high", "share", fill("High"), help="Upper end of it."),
    _simulation_field("record.overturned", "flag", fill("Overturns under the record"), "record_overturned",
        short=fill("Under the record"), shows=DATA | {"pieces"},
        help="Whether it overturns under the recorded motion itself."),
    _simulation_field("record.max_rotation_ratio", "number",
        fill("Largest rotation under the record, over the critical angle"), "record_max_rotation_ratio",
        help="Largest |theta| over the critical angle under the recorded motion."),
)  # fmt: skip
"""What simulation found under a motion: together null in results.json where it did not run."""


_KINDS: Mapping[str, Kind] = {"number": "number", "count": "count", "truth": "flag"}
"""Of the columns of a method; all others are texts."""


def method_fields(method: MethodInfo) -> Iterator[Field]:
    """Yield the fields of a case by one method: its value, what stands beside it, its flags."""
    key, path = method.key, ("methods", method.key)
    listed: frozenset[Where] = frozenset(("methods", "pieces") if method.is_live else ("methods",))
    yield Field(
        key=key, source=f"methods.{key}.value", path=(*path, "value"), label=method.title, kind="share",
        short=method.short_title, is_optional=True, format="0.0%" if method.kind == "probability" else "0", width=10,
        shows=DATA | listed,
    )  # fmt: skip
    for column in method.columns if method.role != "simulation" else ():  # that has fields of its own
        whole, _point, decimals = column.format.rstrip("f").partition(".")
        shown = f"{'#,##0' if whole else '0'}{'.' if int(decimals or 0) else ''}{'0' * int(decimals or 0)}"
        yield Field(
            key=f"{key}_{column.name}", source=f"methods.{key}.detail.{column.name}", path=(*path, column.name),
            label=column.label, unit=column.unit, format=shown if column.format else "",
            kind=_KINDS.get(column.kind, "text"),
            is_optional=True, shows=DATA,
        )  # fmt: skip
    yield Field(key=f"{key}_flags", source=f"methods.{key}.flags", path=(*path, "flags"), kind="list", shows=DATA)


def _adopted(name: str, label: str, kind: Kind, source: str = "", **more: Any) -> Field:
    return _in_group("adopted", name, label, source=f"adopted.{source or name}", kind=kind, **{"shows": DATA, **more})


ADOPTED_FIELDS = (
    _adopted("method", fill("Method"), "text",
        help='Key of the method whose value it is; "" where the piece cannot rock.'),
    _adopted("basis", fill("Basis"), "text", choices=BASES, help="`simulated`; `formula`: not simulated; "
        "`unconfirmed`: the formula's class, as the motions of a simulation that gave a lower one may be too weak; "
        "`cannot rock`: too stocky, or not even the strongest motion that may be drawn can start it; or `rolls`: on "
        "castors, which no method covers, and its chance is that of a piece without them. Counts, lists and sums never "
        "mix them; but what cannot rock is low, and counts with those of the run."),
    _adopted("probability", fill("Chance of overturning"), "share", format="0.0%", short=fill("Chance"),
        shows=DATA | {"pieces", "risky"}),
    _adopted("low", fill("Low"), "share", is_optional=True, format="0.0%",
        help="Lower end of the sampling interval; null where the formula's value is adopted."),
    _adopted("high", fill("High"), "share", is_optional=True, format="0.0%"),
    _adopted("class", fill("Class"), "class", "risk", shows=DATA | {"pieces", "risky"}),
    _adopted("class_upper", fill("Class, upper estimate"), "class", "upper"),
    _adopted("lowered_from", fill("Lowered from"), "class", is_optional=True,
        help="Class by formula where simulation lowered it."),
    _adopted("flags", fill("Flags"), "list", short=fill("Marks"), shows=DATA | {"pieces"}),
)  # fmt: skip

FORMULA_CLASSES = (
    Field(key="class_formula", source="formula_class", label=fill("Class (formula)"), kind="class",
        shows=DATA | {"pieces", "risky"},
        help="By the formula that *Class by* chooses, the highest under any of its motions; low where it cannot rock."),
    Field(key="class_or", source="paper_class", label=fill("Class (OR)"), kind="class",
        shows=DATA | {"pieces", "risky"},
        help="By the paper's formula under the governing motion; low where it cannot rock."),
)  # fmt: skip
"""The classes of a row of furniture by formula, beside the one that is adopted."""


def _annual(name: str, label: str, kind: Kind, **more: Any) -> Field:
    return _in_group("annual", name, label, source=f"item.annual.{name}", kind=kind, **{"shows": DATA, **more})


ANNUAL_FIELDS = (
    _annual("rate", fill("Falls a year"), "number", help="How often a year it falls, if it stands free."),
    _annual("low", fill("Low"), "number", is_optional=True,
            help="Lower end of the 95 % sampling interval of the rate; null where it fell in no draw."),
    _annual("high", fill("High"), "number", is_optional=True, help="Upper end of it."),
    _annual("chance_a_year", fill("Chance a year"), "share", format="0.00%"),
    _annual("chance_in_50_years", fill("Chance in 50 years"), "share", format="0.0%"),
    _annual("fit", fill("Integrated"), "text", choices=("lognormal", "table"),
            help="The lognormal fitted to the shares that fall, or their table where that is not near enough."),
    _annual("median_g", fill("Median ground PGA"), "number", unit="g", is_optional=True,
            help="Ground PGA at which it falls in half of the draws, by the lognormal."),
    _annual("dispersion", fill("Dispersion"), "number", is_optional=True),
    _annual("misfit", fill("Misfit"), "share", is_optional=True,
            help="Largest difference between the lognormal and a share."),
    _annual("at_least", fill("Lower bound"), "flag", help="Whether the motions may be too weak: a lower bound then."),
    _annual("ends_matter", fill("Ends of the curve matter"), "flag",
            help="Whether more than 5 % of the rate comes, or could come, from outside the hazard curve."),
)  # fmt: skip
"""How often a year it falls: together null where that was not evaluated."""


def _sliding(name: str, label: str, **more: Any) -> Field:
    return _in_group("sliding", name, label, source=f"governing.sliding.{name}", is_optional=True, **more)


SLIDING_FIELDS = (
    _sliding("branch", fill("Starts to (as run)"), choices=BRANCHES, width=12,
        help="What it does first at the floor's PFA (Shenton 1996); `sliding` is null where no friction is given."),
    _sliding("slip_median_cm", fill("Peak slip, median (as run)"), unit="cm", kind="number", format="0.0",
        help="Of a block that slides and does not rock (Newmark 1965), under the draws of the simulation; null where "
        "it cannot slide, or nothing was simulated."),
    _sliding("slip_84_cm", fill("Peak slip, 84 % (as run)"), unit="cm", kind="number", format="0.0",
        help="Not exceeded in 84 % of the draws."),
)  # fmt: skip
"""How a piece of known friction slides: together null in results.json where no friction is given."""


_IN_ALL_LISTS: frozenset[Where] = EVERYWHERE | {"risky", "methods"}

PIECE_FIELDS = (
    _of_item("item", fill("Item"), width=12, shows=_IN_ALL_LISTS),
    _of_item("floor", fill("Floor"), width=8, shows=_IN_ALL_LISTS),
    _of_item("room", fill("Room"), width=16, shows=EVERYWHERE | {"risky"}),
    _of_item("description", fill("Description"), width=32, shows=EVERYWHERE | {"risky"}),
    _of_item("type", fill("Type"), width=22),
    _of_item(
        "quantity", fill("Quantity"), short=fill("No."), kind="count", format="#,##0", shows=EVERYWHERE | {"risky"},
    ),
    _of_item("breadth_cm", fill("Breadth"), short=fill("B × W × H"), kind="number", unit="cm",
        shows=EVERYWHERE | {"risky"}),
    _of_item("width_cm", fill("Width"), kind="number", unit="cm", is_optional=True),
    _of_item("height_cm", fill("Height"), kind="number", unit="cm"),
    _of_item("breadth_to_height", fill("B/H"), kind="number", format="0.000", width=8, shows=EVERYWHERE | {"methods"}),
    _of_item("centre_of_gravity", fill("Centre of gravity"), kind="share", format="0%", width=8, shows=DATA,
        help="Height of the centre of gravity, as a share of the piece's height."),
    Field(key="axis", source="governing.motion.axis", label=fill("Axis"), choices=AXES, width=6, shows=EVERYWHERE,
        help="The axis that governs."),
    _of_item("axis_given", fill("Axis given"), is_optional=True, choices=AXES, width=7,
        help="null: unknown, the worse of both governs."),
    _of_item("angle_deg", fill("Angle"), kind="number", unit="deg", width=8, is_optional=True),
    _of_item("x_m", fill("X"), kind="number", unit="m", width=8, is_optional=True),
    _of_item("y_m", fill("Y"), kind="number", unit="m", width=8, is_optional=True),
    _of_item("friction", fill("Friction"), kind="number", is_optional=True,
        help="The one used: the piece's own, else the building's."),
    *SLIDING_FIELDS,
    _of_item("against_wall", fill("Against wall"), kind="flag", is_optional=True, width=8,
        help="Whether a long side stands against a wall; null: not known."),
    _of_item("mobile", fill("Mobile"), kind="flag", is_optional=True, width=8,
        help="Whether it stands on castors, its type's where its own is blank; null: not known."),
    _of_item("falls_toward_deg", fill("Falls toward"), kind="number", unit="deg", is_optional=True, shows=DATA,
        help="Direction in which a piece against a wall falls, anticlockwise from X; null: it may fall either way."),
    Field(key="one_sided_chance", source="governing.one_sided", label=fill("Chance with a wall at its back"),
        kind="share", format="0.0%", is_optional=True, width=10,
        help="Simulated beside the adopted chance, which it does not change: turning away from the wall alone."),
    Field(key="importance", source="item.importance", is_blank_unknown=True, label=fill("Importance"), is_optional=True,
        choices=IMPORTANCE, width=13),
    Field(key="pfa_g", source="governing.motion.pfa_g", label=fill("PFA used"), short=fill("PFA"), unit="g",
        kind="number", format="0.000", shows=EVERYWHERE | {"methods"}, help="Of the motion that governs."),
    Field(key="pfv_cm_s", source="governing.motion.pfv_cm_s", label=fill("PFV used"), short=fill("PFV"), unit="cm/s",
        kind="number", format="0.0", is_optional=True, shows=FILES | {"methods"}),
    Field(key="pfa_source", source="governing.motion.label", shows=DATA, help="The record, `given`, the code of a "
        "profile (with an assumed intensity: `Shaking MMI VII, ASCE 7-22`), or the floors that it is interpolated "
        "between."),
)  # fmt: skip


def _of_anchor(key: str, label: str = "", **more: Any) -> Field:
    given = {"unit": "kN", "kind": "number", "is_optional": True, **more}
    return Field(key=key, source=f"item.anchor.{key}", path=("anchor", key), label=label, **given)


ANCHOR_FIELDS = (
    _of_item("weight_kg", fill("Weight"), unit="kg", kind="number", is_optional=True),
    _of_anchor("weight_kn", fill("Weight with contents")),
    _of_anchor("weight_source", fill("Source of the weight (estimate: assumed)"), unit="", kind="text",
        is_optional=False, choices=("given", "type", "estimate")),
    _of_anchor("bracket_height_cm", fill("Bracket height"), unit="cm"),
    _of_anchor("bracket_capacity_kn", fill("Bracket capacity"), help="Tension that its bracket holds."),
    _of_anchor("tension_kn", fill("Tension at the bracket")),
    _of_anchor("tension_low_kn", fill("Tension at 16 % of PFA")),
    _of_anchor("tension_high_kn", fill("Tension at 84 % of PFA")),
    _of_anchor("tension_without_weight_kn", fill("Tension without the help of the weight")),
    _of_anchor("shear_kn", fill("Shear at the base")),
    _of_anchor("tension_code_kn", fill("Tension by the code"),
        help="By `anchor_code` of the run, where a ground motion is known for it."),
    _of_anchor("shear_code_kn", fill("Shear by the code")),
    _of_anchor("needed_friction", fill("Friction needed at the base"), unit="", shows=DATA,
        help="Coefficient below which the base of the held piece slides at PFA."),
    *(
        _of_anchor(key, unit="", kind="flag", is_optional=False, shows=DATA, help=text)
        for key, text in (
            ("is_height_assumed", "Whether the workbook leaves the height of its bracket blank: 0.9 of its own."),
            ("is_per_metre", "Whether weight and forces are those of one metre of it, as its width is not known."),
        )
    ),
    *(
        _of_anchor(
            key, label, unit="", kind="flag", shows=DATA,
            help="Null where the capacity is not known, and where it carries the force of one metre of a piece whose "
            "width is not known.",
        )
        for key, label in (
            ("holds", fill("Bracket holds at PFA")), ("holds_high", fill("Bracket holds at 84 % of PFA")),
            ("holds_code", fill("Bracket holds by the code")),
        )
    ),
    Field(key="counts_as_anchored", source="item.is_held", path=("anchor", "counts_as_anchored"),
        label=fill("Counts as anchored"), kind="flag", shows=DATA,
        help="It says so and its bracket is not known to fail, or it is partly anchored by one that holds at 84 %."),
)  # fmt: skip
"""The weight of a piece, and what its bracket has to carry; all of it is screening, not design."""


def item_fields(methods: Sequence[MethodInfo]) -> tuple[Field, ...]:
    """Return the fields of a row of furniture by the methods of the run, in the order of items.csv."""
    of_case = (*(field for method in methods for field in method_fields(method)), *SIMULATION_FIELDS)
    of_axis = (
        Field(key="axis", source="motion.axis"),
        Field(key="source", source="motion.label"),
        Field(key="pfa_g", source="motion.pfa_g", kind="number"),
        Field(key="pfv_cm_s", source="motion.pfv_cm_s", kind="number"),
        *(
            Field(key=one.key, source=f"methods.{one.key}.value", path=("methods", one.key), kind="share")
            for one in methods
        ),
        *SIMULATION_FIELDS,
    )
    return (
        *PIECE_FIELDS,
        *(replace(one, source=f"governing.{one.source}") for one in of_case),
        *ADOPTED_FIELDS,
        *FORMULA_CLASSES,
        *ANNUAL_FIELDS,
        Field(key="axes", source="cases", kind="records", records=of_axis, shows=DATA,
            line="{axis}: {source} {pfa_g} g", help="Every motion that the item was evaluated under."),
        _of_item("anchored", fill("Anchored"), choices=ANCHORED, width=10),
        *(
            _of_item(key, label, width=24, is_optional=True, is_blank_unknown=True)
            for key, label in (("route", fill("Route")), ("segment", fill("Segment")))
        ),
        *ANCHOR_FIELDS,
        _of_item("edge_distance_m", fill("Edge distance"), unit="m", kind="number", is_optional=True, shows=DATA),
        _of_item("notes", fill("Notes"), width=40),
        _of_item("assumed", fill("Assumed"), kind="list", width=28,
            help="Fields that were blank in the workbook and were filled in."),
        Field(key="source_sheet", source="sheet", path=("source", "sheet"), shows=DATA),
        Field(key="source_row", source="item.row", path=("source", "row"), kind="count", shows=DATA),
        _of_item("source_id", fill("Source ID"), is_optional=True, shows=DATA,
            help="Its identifier in the building model or handover file that it was imported from."),
        _of_item("sizes_from", fill("Sizes from"), choices=SIZES_FROM, shows=DATA,
            help="Where its sizes come from; base and height of a scan are drawn with a larger standard deviation."),
    )  # fmt: skip


def _of_motion(key: str, kind: Kind = "text", **more: Any) -> Field:
    return Field(key=key, kind=kind, is_optional=True, is_blank_unknown=True, **more)


def _of_record(key: str, label: str = "") -> Field:
    return Field(key=key, source=f"recorded.{key}", label=label, is_optional=True)


def _fit(name: str, label: str, format: str, unit: str = "", **more: Any) -> Field:  # noqa: A002
    return _in_group("ensemble", f"fit.{name}", label, kind="number", unit=unit, format=format, **more)


def _none_is_empty(value: list[Any] | None) -> list[Any]:
    return value or []


MOTION_FIELDS = (
    Field(key="axis", label=fill("Axis"), choices=AXES),
    Field(key="source", choices=("record", "given", "interpolated", "profile", "beam")),
    Field(key="pfa_g", kind="number", label=fill("PFA"), unit="g", format="0.000", help="After treatment."),
    Field(key="pfv_cm_s", kind="number", label=fill("PFV"), unit="cm/s", format="0.0", is_optional=True),
    Field(key="flags", kind="list"),
    Field(key="between", kind="list", help="The floors below and above that it is interpolated between."),
    Field(key="profile", source="profile.key", is_optional=True, help="The code whose design profile gave the PFA."),
    Field(key="profile_verified", source="profile.verified", kind="flag", is_optional=True,
        help="Whether the profile agrees with public implementations of the code."),
    _of_motion("clause"),
    _of_motion("height_ratio", "number", label=fill("z/h"), format="0.000", help="Its height over the roof's."),
    _of_motion("amplification", "number", label=fill("Amplification"), format="0.000", help="PFA over ground PGA."),
    Field(key="dispersion", kind="number", label=fill("Motion uncertainty"), format="0.00",
        help="Standard deviation of ln amplitude that is drawn, from one earthquake to the next."),
    Field(key="pfv_follows", kind="flag", help="Whether PFV is not known by itself and follows PFA."),
    _of_motion("record", help="The record as the workbook names it."),
    _of_motion("pfa_file_g", "number", label=fill("PFA in the file"), unit="g", format="0.000",
        help="Peak of the file's own values, before treatment."),
    _of_record("format"),
    _of_record("station", fill("Station")),
    _of_record("location"),
    _of_record("channel"),
    _of_record("event", fill("Event")),
    _of_motion("azimuth_deg", "number", label=fill("Azimuth"), unit="deg"),
    _of_motion("corrected", "flag"),
    _of_motion("time_step_s", "number"),
    _of_motion("samples", "count"),
    Field(key="notes", kind="list"),
    _in_group("ensemble", "motions", kind="count", label=fill("Motions"), format="#,##0"),
    _in_group("ensemble", "assumed_motion", kind="flag",
        help="Whether no record is known, so that ground motion and building are drawn."),
    _in_group("ensemble", "unknown_building", kind="flag",
        help="Whether neither T1, Height, Storeys nor an Elevation is known, so that no class is confirmed."),
    _in_group("ensemble", "weak_motions", kind="flag",
        help="Whether the motions are weaker than the floor's, so that they may not lower a class."),
    _in_group("ensemble", "bands", kind="factors", is_optional=True, flat=_none_is_empty,
        help="Factors above and below PFA/(2 pi PFV) by which drawn motions were brought to the floor's peaks."),
    _in_group("ensemble", "signs", kind="signs", is_optional=True, flat=_none_is_empty, help="Whether the motions "
        "move as the phases that all floors share (1) or against them (-1), by octave from 0.1 to 25.6 Hz: as the "
        "records of two floors or more of one earthquake on one clock do; null where no such records are known."),
    _fit("matched_to_s", fill("Matched from 0.05 s to"), "0.00", "s", source="ensemble.fit.matched_to"),
    _fit("mean_deviation", fill("Mean deviation"), "0.0%"),
    _fit("worst_deviation", fill("Worst deviation"), "+0.0%;-0.0%"),
    _fit("worst_period_s", fill("at period"), "0.000", "s", source="ensemble.fit.worst_period"),
    _fit("pfa_ratio", fill("PFA over the target's"), "0.000"),
    _fit("pfa_scatter", fill("Scatter of PFA"), "0.0%"),
    _fit("pfv_ratio", fill("PFV over the target's"), "0.000", is_optional=True),
    _fit("pfv_scatter", fill("Scatter of PFV"), "0.0%"),
    _fit("spectrum_scatter", fill("Scatter of the spectrum"), "0.0%"),
)  # fmt: skip
"""The fields of a floor's motion, as they stand in results.json under ``floors[].demands[]``."""


FLOOR_FIELDS = (
    Field(key="floor", source="floor.floor"),
    Field(key="name", source="floor.name"),
    Field(key="elevation_m", source="floor.elevation_m", kind="number", is_optional=True),
    *(replace(one, source=f"motion.{one.source}") for one in MOTION_FIELDS),
)
"""The fields of a row of the table of floors: the floor, and one of its motions."""


SHAKING_FIELDS = (
    Field(key="choice", help="The class of intensity, as the workbook offers it."),
    Field(key="name", help="The class in short."),
    Field(key="intensity", kind="number", help="What it is taken for: MMI, or JMA instrumental intensity."),
    *(
        Field(key=key, kind="number", help="Published medians of the ground's peaks, before the settings' factor.")
        for key in ("pga_g", "pgv_cm_s")
    ),
    Field(key="scatter", kind="number", help="Standard deviation of ln PGV given the intensity [-]."),
    Field(key="is_derived", kind="flag", help="Whether PGA follows from PGV, by the ratio that is drawn."),
    Field(key="is_open", kind="flag", help="Whether the class has no upper limit."),
    *(Field(key=key, kind="list", help="The relations in short and in full.") for key in ("sources", "references")),
)
"""An intensity that stands in for a known motion of the ground (`assess.intensity.Shaking`)."""


def _of_ground(key: str, kind: Kind = "text", text: str = "", source: str = "", **more: Any) -> Field:
    return Field(key=key, source=source or f"provenance.site_ground.{key}", kind=kind, help=text, **more)


_MEDIANS = "Medians at the building, before the settings' factor; `pgv_cm_s` is null where it is not known."
GROUND_FIELDS = (
    _of_ground("kind", text="Which of the two.", choices=("shakemap", "scenarios")),
    _of_ground("file", text="Name and hash of its file."),
    _of_ground("sha256", text="Name and hash of its file."),
    _of_ground("pga_g", "number", _MEDIANS),
    _of_ground("pgv_cm_s", "number", _MEDIANS, is_optional=True),
    _of_ground("psa", "records", "Spectral accelerations, as far as they are known; for information.",
        source="provenance.site_ground.psa_g",
        records=(Field(key="period_s", source="0", kind="number", help="Period."),
                 Field(key="psa_g", source="1", kind="number", help="Median, 5 % damping."))),
    _of_ground("dispersion", "number",
        "Standard deviation of ln PGV at the building [-], or of ln PGA where PGV is not known."),
    _of_ground("dispersion_source", text="Where that comes from."),
    _of_ground("own_dispersion", "number",
        "Motion uncertainty without it [-]; both together are the root of the sum of squares.",
        source="building.own_dispersion"),
    _of_ground("shared", "number", "Share of its variance that is common to all places in one earthquake [-]; null "
        "where that is not known.", is_optional=True),
    _of_ground("distance_km", "number", "From the building to the site of the scenarios.", is_optional=True),
    _of_ground("scenarios", "count", "Number of scenarios; 0 for a map.", source="provenance.site_ground.count"),
    _of_ground("facts", "records", "The earthquake, version and status of the map, and the like.",
        records=tuple(Field(key=key, source=at, help="What is told, and what it is.")
                      for at, key in (("0", "label"), ("1", "value")))),
    _of_ground("cautions", "list", "What makes it less certain than its dispersion tells."),
)  # fmt: skip
"""The ground motion at the building by a ShakeMap or scenarios, of the results."""


# ---------------------------------------------------------------- the schedule


def _work(key: str, kind: Kind = "text", label: str = "", **more: Any) -> Field:
    given = {"format": {"number": "0.00", "count": "#,##0"}.get(kind, ""), **more}
    return Field(key=key, kind=kind, label=label, **given)


def _force(name: str, label: str, short: str, **more: Any) -> Field:
    return _work(name, "number", label, short=short, unit="kN", width=9, **more)


WORK_FIELDS = (
    _work("floor", label=fill("Floor"), width=8),
    _work("room", label=fill("Room"), width=16),
    _work("items", "list", fill("Items"), width=24, help="The most urgent first."),
    _work("pieces", "count", fill("Pieces"), width=7, help="How many pieces they are, quantities counted."),
    _work("detail", label=fill("Detail"), width=20, choices=tuple(DETAILS),
        help="A generic way to fix them: screening, not design."),
    _work("like", choices=tuple(DETAILS),
        help="The detail whose forces and fixings they are: of an anchor to check or complete that of its type."),
    _force("tension_kn", fill("Tension at PFA"), fill("T at PFA"), help="What the fixings of each piece carry "
        "together: at the bracket, or, where it is fixed at its base, at the far edge of the base, on the lever of "
        "its breadth."),
    _force("tension_high_kn", fill("Tension at 84 % of PFA"), fill("T at 84 %")),
    _force("tension_code_kn", fill("Tension by the code"), fill("T by code"), is_optional=True,
        help="By `anchor_code`; null where no ground motion is known for a code."),
    _force("shear_kn", fill("Shear at the base"), fill("Shear"), help="Of each piece at PFA."),
    _work("fixings", "count", fill("Fixings each"), width=8,
        help="Of one piece, by the larger of the tensions at 84 % and by the code over the printed capacity of one."),
    _work("fixings_are_least", "flag", source="is_least",
        help="Whether they are the least, not a result: no capacity is printed."),
    _work("all_fixings", "count", fill("Fixings in all"), width=8, help="Of all its pieces."),
    _force("pull_kn", fill("Pull on one fixing"), fill("Pull each"), is_optional=True,
        help="The larger of the tensions at 84 % and by the code over the fixings; null where none is counted."),
    _work("weights_assumed", "count", help="Pieces whose weight is an estimate."),
    _work("heights_assumed", "count", help="Pieces whose bracket height is assumed."),
    _work("is_per_metre", "flag", help="Whether forces are those of one metre of a piece, as its width is not known."),
    _work("unit_cost", "number", fill("Unit cost"), width=10, is_optional=True,
        help="Of what `cost_per` says, of the sheet Costs, in the schedule's currency."),
    _work("cost_per", label=fill("Unit cost per"), width=8, choices=("", *COST_PER)),
    _work("cost", "number", fill("Cost"), width=10, is_optional=True),
    _work("cost_source", label=fill("Source of the cost"), width=24),
    _work("hours", "number", fill("Hours"), width=8, help="Of work on all its pieces, of all people: assumed."),
)  # fmt: skip
"""Alike pieces of one room that are fixed in the same way."""

ENTRY_FIELDS = (
    _work("place", "count", fill("No."), width=5, help="Its place in the order of urgency, from 1."),
    _work("phase", label=fill("Phase"), width=6, choices=PHASES,
        help="A: now; B: with the next works; C: not worth it on its own, listed only."),
    _work("floor", help="Of its most urgent piece."),
    _work("room"),
    _work("pieces", "count"),
    _work("only_together", "flag", source="is_together", help="Whether fixing some of them opens no route."),
    _work("falls_avoided", "number", fill("Falls avoided"), format="0.000", help="Expected number, if anchors hold."),
    _work("falls_left", "number", fill("Falls left"), format="0.000",
        help="Expected number once it and those before it are fixed."),
    _work("falls_at_most", "number", fill("Falls avoided at most"), format="0.000", help="Of pieces that stand apart; "
        "of anchored ones what their anchors are trusted to avoid; else 0."),
    _work("cost", "number", is_optional=True, help="null where the sheet Costs leaves any part of it open."),
    _work("hours", "number", fill("Hours"), help="Of work: assumed."),
    _work("works", "records", records=WORK_FIELDS, help="What is to be done."),
)  # fmt: skip
"""One entry of the schedule."""

PHASE_FIELDS = (
    _work("phase", choices=PHASES), *(_work(key, "count") for key in ("entries", "pieces", "places", "uncosted")),
    *(_work(key, "number") for key in ("falls_avoided", "falls_left", "hours")),
    _work("cost", "number", is_optional=True, help="Of what is known; null where nothing is."),
)  # fmt: skip
"""One phase of the schedule; what is to be expected after it stands beside."""

STATE_FIELDS = (
    _work("falls", "number", fill("Expected falls"), help="Of free-standing pieces of the run's basis."),
    _work("falls_low", "number", is_optional=True, help="Falls that 5 % of the draws do not exceed."),
    _work("falls_high", "number", is_optional=True, help="Falls that 95 % of the draws do not exceed."),
    *(
        Field(
            key=f"pieces_{risk.word.replace(' ', '_')}", path=("pieces", risk.word.replace(" ", "_")), kind="count",
            source=f"classes.{int(risk)}",
        )
        for risk in RiskClass
    ),
    _work("pieces_apart", "count", fill("Unconfirmed, by formula only, or rolling"), path=("pieces", "apart"),
        source="apart", help="Unconfirmed, by formula only where others were simulated, or on castors."),
    _work("pieces_anchored", "count", fill("Anchored"), path=("pieces", "anchored"), source="anchored"),
    _work("routes", "counts", help="How many there are by their state."),
    _work("blocked_routes_expected", "number", fill("Blocked routes, expected"), source="blocked_routes"),
    _work("cut_off_rooms_expected", "number", fill("Rooms that lose every exit, expected"), source="cut_off_rooms"),
    _work("rooms_at_risk", "list", fill("Rooms that may lose every exit"),
        help="Their chance of losing every exit is at least the chosen risk, or not known."),
    _work("unknown_routes", "count", fill("Left out of these averages: routes not known"),
        help="Routes that blocked_routes_expected leaves out."),
    _work("unknown_rooms", "count", fill("Left out of these averages: rooms not known"),
        help="Rooms that cut_off_rooms_expected leaves out."),
)  # fmt: skip
"""What is to be expected of the building."""


def schedule_fields(row: type) -> Mapping[str, Field]:
    """Return the fields of one of the rows of `assess.schedule_results` by their keys."""
    tables = {WorkRow: WORK_FIELDS, ScheduleRow: ENTRY_FIELDS, State: STATE_FIELDS}
    return {one.key: one for one in tables[row]}


# ---------------------------------------------------------------- evacuation routes


_LABELS: Mapping[str, tuple[str, str]] = {
    "route": (fill("Route"), ""),
    "segment": (fill("Segment"), ""),
    "floor": (fill("Floor"), ""),
    "floors": (fill("Floors"), fill("Floor")),
    "from_place": (fill("From"), fill("From – to")),
    "to_place": (fill("To"), ""),
    "room": (fill("Room"), ""),
    "occupants": (fill("Occupants"), ""),
    "notes": (fill("Notes"), ""),
    "flags": (fill("Remarks"), fill("Marks")),
    "segment_indices": (fill("Segments"), ""),
    "unevaluated_segments": (fill("Segments not evaluated"), ""),
    "unevaluated_indices": (fill("Segments not evaluated, taken as open"), ""),
    # widths
    "clear_width_used_m": (fill("Clear width"), fill("Clear")),
    "required_width_used_m": (fill("Required width"), fill("Required")),
    "standing_width_m": (fill("Width now"), ""),
    "least_width_m": (fill("Width if all fall"), fill("All fallen")),
    "needed_width_m": (fill("Width that they need"), fill("Occupants need; marks")),
    "insufficient_for_occupants": (fill("Insufficient for occupants"), ""),
    "insufficient_after_falls_probability": (fill("Chance too narrow for occupants"), ""),
    "other_rooms": (fill("Not counted, in another room"), ""),
    # state and chances of a segment or route
    "state": (fill("State"), ""),
    "blocked_probability": (fill("Chance blocked"), fill("Blocked")),
    "blocked_low": (fill("Interval low"), ""),
    "blocked_high": (fill("Interval high"), ""),
    "blocked_independent": (fill("Blocked, all independent"), fill("Bounds")),
    "blocked_correlated": (fill("Blocked, fully correlated"), ""),
    "blocked_pieces": (fill("Pieces"), ""),
    "blocked_unverified": (fill("By the formula alone"), ""),
    "blocked_unconfirmed": (fill("Unconfirmed pieces"), ""),
    "blocked_if_unconfirmed_fall_probability": (fill("Blocked if unconfirmed pieces fall"), ""),
    "missing": (fill("To fill in"), ""),
    "missing_after": (fill("To fill in once these are done"), ""),
    "decisive_segment": (fill("Decisive segment"), ""),
    "from_places": (fill("From"), ""),
    "to_places": (fill("To"), ""),
    "fixes": (fill("Pieces to anchor or move"), ""),
    "blocked_is_joint": (fill("Basis"), fill("Bounds; rests on")),
    "blocked_or_reduced_probability": (fill("Chance narrowed or blocked"), fill("Narrowed or blocked")),
    "blocked_if_anchors_fail_probability": (fill("Blocked if anchors fail"), ""),
    "under_record": (fill("Under the record"), ""),
    "most_likely_piece": (fill("Most likely piece"), fill("Likeliest piece")),
    # rooms
    "exits": (fill("Exits that can be reached"), fill("Exits")),
    "loses_every_exit_probability": (fill("Chance of losing every exit"), fill("Loses all exits")),
    "loses_every_exit_low": (fill("Interval low"), ""),
    "loses_every_exit_high": (fill("Interval high"), ""),
    "loses_every_exit_independent": (fill("All independent"), ""),
    "loses_every_exit_correlated": (fill("Fully correlated"), ""),
    "loses_every_exit_is_joint": (fill("Basis"), ""),
    "loses_if_unconfirmed_fall_probability": (fill("If unconfirmed pieces fall"), ""),
    "loses_if_anchors_fail_probability": (fill("If anchors fail"), ""),
    "ways": (fill("Ways out"), fill("Ways out and the chance that each is blocked")),
    # floors
    "segments": (fill("Segments"), ""),
    "blocked_segments_expected": (fill("Blocked segments expected"), fill("Expected blocked")),
    "unknown_segments": (fill("Segments not known"), fill("Not known")),
    "routes": (fill("Routes"), ""),
    "blocked_routes_expected": (fill("Blocked routes expected"), fill("Expected blocked")),
    "unknown_routes": (fill("Routes not known"), fill("Not known")),
    "rooms": (fill("Rooms"), ""),
    "cut_off_rooms_expected": (fill("Rooms expected to lose every exit"), fill("Expected cut off")),
    "unknown_rooms": (fill("Rooms not known"), fill("Not known")),
    "any_room_cut_off_probability": (fill("Chance that any room does"), fill("Any room loses all exits")),
    "any_room_cut_off_low": (fill("Interval low"), ""),
    "any_room_cut_off_high": (fill("Interval high"), ""),
    "uncounted_pieces": (fill("Pieces not counted"), fill("Left out")),
    # a piece beside a segment
    "item": (fill("Item"), fill("Piece")),
    "by_plan": (fill("Known by"), ""),
    "distance_m": (fill("From the edge of the route"), fill("Distance")),
    "reach_m": (fill("Reaches into it"), fill("Reach")),
    "left_m": (fill("Width left beside it alone"), fill("Leaves")),
    "blocks_alone": (fill("Blocks alone"), ""),
    "falls_while_blocked": (fill("Falls and blocked"), ""),
}  # fmt: skip
"""Label, and a shorter one for the tables of pages, by the column of a notebook's table."""

_KINDS_OF_TYPES: Mapping[Any, Kind] = {float: "number", int: "count", bool: "flag"}
_FORMATS: Mapping[str, str] = {"share": "0.0%", "number": "0.00", "count": "#,##0"}
_SHARES = frozenset(("falls_while_blocked", "gain", "left"))


@cache
def route_fields(row: type) -> Mapping[str, Field]:
    """Return the fields of one of the rows of `assess.route_results` by their keys."""
    return {one.key: one for one in row_fields(row)}


def row_fields(row: Any, path: tuple[str, ...] = ()) -> Iterator[Field]:
    """Yield the fields of the rows of a dataclass: chances as columns, pieces and ways by their names."""
    hints = get_type_hints(row)
    for one in fields(row):
        hint, names = hints[one.name], (*path, one.name)
        hint = next((part for part in get_args(hint) if NoneType in get_args(hint)), hint)
        if hint is PieceRef:
            yield _field(names, (*names, "item"))
        elif is_dataclass(hint):
            yield from row_fields(hint, names)
        elif get_origin(hint) is tuple:
            yield _field(names, names, "list")
        else:
            is_share = hint is float and (row is Chance or one.name in _SHARES)
            yield _field(names, names, "share" if is_share else _KINDS_OF_TYPES.get(hint, "text"))


def _field(names: Sequence[str], source: Sequence[str], kind: Kind = "text") -> Field:
    key = "_".join(names)
    label, short = _LABELS.get(key, ("", ""))
    return Field(
        key=key, source=".".join(source), label=label, short=short, kind=kind,
        unit="m" if key.endswith("_m") else "", format=_FORMATS.get(kind, ""),
        flat=_name_each if kind == "list" else None,
    )  # fmt: skip


def _name_each(values: Sequence[Any]) -> list[Any]:
    return [getattr(one, "item", getattr(one, "end", getattr(one, "what", one))) for one in values]


# ---------------------------------------------------------------- tables


def build_table(results: Results, name: str) -> Table:
    """Return a table: items, cases, floors, segments, routes, rooms, schedule (its entries) or problems."""
    routes, methods = results.route_tables, results.methods
    if name == "items":
        return Table(item_fields(methods), results.parts)
    if name == "cases":
        of_case = (
            Field(key="item", source="item.item"),
            Field(key="floor", source="motion.floor"),
            Field(key="axis", source="motion.axis", choices=AXES),
            Field(key="source", source="motion.label"),
            Field(key="pfa_g", source="motion.pfa_g", kind="number"),
            Field(key="pfv_cm_s", source="motion.pfv_cm_s", kind="number", is_optional=True),
            Field(key="governs", kind="flag"),
            *(field for method in methods for field in method_fields(method)),
            *SIMULATION_FIELDS, *ADOPTED_FIELDS,
        )  # fmt: skip
        return Table(of_case, lambda: (part.cases for part in results.parts()))
    floors = {one.floor: one for one in results.floor_rows}
    tables: Mapping[str, tuple[Iterable[Field], Sequence[Any]]] = {
        "floors": (FLOOR_FIELDS, [{"floor": floors[one.floor], "motion": one} for one in results.motions]),
        "segments": (row_fields(SegmentRow), routes.segments), "routes": (row_fields(RouteRow), routes.routes),
        "rooms": (row_fields(RoomRow), routes.rooms), "schedule": (ENTRY_FIELDS, results.schedule.rows),
        "problems": (row_fields(Problem), results.problem_rows),
    }  # fmt: skip
    return Table.of(*tables[name])


# ---------------------------------------------------------------- for a notebook


def results_html(results: Results, most: int = 10) -> str:
    """Return a short table: pieces by class, and the first rows."""
    words = [risk.word for risk in reversed(RiskClass)]
    counts = dict.fromkeys((*words, "unconfirmed", "by formula only", "rolls"), 0)
    for one in results:
        if not one.is_anchored:
            counts[one.apart.replace("formula", "by formula only") or one.adopted.risk.word] += one.item.quantity
    classes = ", ".join(f"{word} {count:,}" for word, count in counts.items() if count or word in words)
    head = f"<p>{escape(repr(results))}<br>Free-standing pieces by class: {classes}</p>"
    shown = ("item", "floor", "description", "breadth_cm", "height_cm", "pfa_g", "adopted_probability", "adopted_class")
    rows = Table.of([one for one in item_fields(results.methods) if one.key in shown], list(islice(results, most)))
    return head + _html(list(rows.rows()))


def item_html(one: ItemResult) -> str:
    """Return one row of furniture as a table of two columns."""
    chosen = (*PIECE_FIELDS, *ADOPTED_FIELDS)
    rows = [
        {"field": field.key, "value": value}
        for field in chosen
        if (value := field.flatten(field.read(one))) not in (None, "")
    ]
    return _html(rows)


def _html(rows: Sequence[Mapping[str, Any]]) -> str:
    if not rows:
        return ""
    head = "".join(f"<th>{escape(name)}</th>" for name in rows[0])
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(_short(value))}</td>" for value in row.values()) + "</tr>" for row in rows
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _short(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(map(str, value))
    return f"{value:.4g}" if isinstance(value, float) else "" if value is None else str(value)
