"""Every shown field of a result, once: its column, place in results.json, label, unit, format and how it is read.

results.json and its schema, items.csv, the tables of a notebook, the Excel report and the lists of the other reports
derive from the lists below. A method's own columns follow from what it says of itself (`MethodInfo.columns`).
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Any, Literal

from assess.i18n import fill
from assess.i18n import gettext as _
from assess.methods import MethodInfo
from assess.model import ANCHORED, AXES, IMPORTANCE, SIZES_FROM
from assess.results import BASES, BRANCHES, CaseRow, ItemRow, MotionRow, Results, Simulation
from assess.risk import RiskClass

Kind = Literal["text", "number", "count", "share", "flag", "class", "list", "signs", "factors", "records"]
"""What a field holds: a share lies in [0, 1]; a class is one of `RiskClass`; signs are a list of 1 and -1; records are
rows within the row."""
Where = Literal["json", "csv", "excel", "pieces", "risky", "methods"]
"""The last three are lists of the pages (HTML, PDF and its lines): all pieces, those at high risk, every method."""
DATA: frozenset[Where] = frozenset(("json", "csv"))
"""Of fields that the sheet Items of the Excel report leaves out, or shows in live columns of its own."""
FILES: frozenset[Where] = DATA | {"excel"}
EVERYWHERE: frozenset[Where] = FILES | {"pieces"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """One field of a row.

    Parameters
    ----------
    key : str
        Its column in items.csv and in the tables of a notebook, with the unit.
    read : callable
        From the row to its value: None for what is unknown.
    path : tuple of str
        Its place in a record of results.json; by default ``(key,)``.
    label, short, unit, format : str
        Heading in reports without the unit, a shorter one for the lists of pages, the unit, and how Excel shows it.
    width : int
        Width of its column in Excel, in characters.
    kind, is_optional, choices
        What it may hold, and whether it may be None; a field of a group, whether it may be where the group is there.
    shows : set of str
        Where it is shown.
    help : str
        What it means, for the schema and the documentation.
    flat : callable, optional
        From its value to the one of items.csv, where that differs.
    """

    key: str
    read: Callable[[Any], Any]
    path: tuple[str, ...] = ()
    label: str = ""
    short: str = ""
    unit: str = ""
    format: str = ""
    width: int = 9
    kind: Kind = "text"
    is_optional: bool = False
    choices: tuple[str, ...] = ()
    shows: frozenset[Where] = FILES
    help: str = ""
    flat: Callable[[Any], Any] | None = None

    @property
    def place(self) -> tuple[str, ...]:
        """Its place in a record of results.json."""
        return self.path or (self.key,)

    def heading(self) -> str:
        """Return its label with the unit in brackets, in the language in use."""
        return _head(self.label, self.unit)

    def short_heading(self) -> str:
        """Return its heading in the lists of pages, in the language in use."""
        return _head(self.short or self.label, self.unit)

    def flatten(self, row: Any) -> Any:
        """Return its value in items.csv."""
        value = self.read(row)
        return value if self.flat is None else self.flat(value)


def _head(label: str, unit: str) -> str:
    return f"{_(label)} [{unit}]" if unit else _(label)


def _of_item(key: str, label: str, **more: Any) -> Field:
    """A field of the row as it was assessed, or a column of the workbook that nothing is computed with."""
    is_computed_with = key in ItemRow.__slots__
    read = attrgetter(f"item.{key}") if is_computed_with else lambda one: one.item.field(key)  # many: the faster way
    return Field(key=key, read=read, label=label, **more)


def _word(risk: RiskClass | None) -> str | None:
    return None if risk is None else risk.word


def _simulated(name: str, *, is_ideal: bool = False) -> Callable[[Any], Any]:
    value = attrgetter(name)

    def read(row: Any) -> Any:
        found: Simulation | None = row.simulation if isinstance(row, CaseRow) else row.governing.simulation
        return None if found is None or (is_ideal and found.ideal is None) else value(found)

    return read


def _simulation_field(name: str, kind: Kind, label: str, path: tuple[str, ...] = (), **more: Any) -> Field:
    key = "_".join(("verification", *(path or (name,))))
    return Field(
        key=key, read=_simulated(name, is_ideal=path[:1] == ("ideal",)), path=("verification", *(path or (name,))),
        label=label, kind=kind,
        **{"shows": DATA, **more},
    )  # fmt: skip


SIMULATION_FIELDS = (
    _simulation_field(
        "runs", "count", fill("Motions"),
        help="Draws of an earthquake like this one and of the piece, a motion each, that it was simulated under.",
    ),
    _simulation_field(
        "draws", "count", fill("Draws"), help="Draws of all pieces exactly alike on its floor: `runs` of each."
    ),
    _simulation_field("overturned", "count", fill("Overturned"), help="Those of them in which the piece overturned."),
    _simulation_field("probability", "share", fill("Chance"), help="`overturned` / `draws`."),
    _simulation_field("low", "share", fill("Low"), help="Lower end of the 95 % sampling interval (Wilson)."),
    _simulation_field("high", "share", fill("High"), help="Upper end of it."),
    _simulation_field("runs", "count", fill("Motions"), ("ideal", "runs"), help="Motions, the same as of the draws."),
    _simulation_field(
        "if_slower", "share", fill("Chance if slower"), is_optional=True,
        help="Chance in the third of the draws with the least PFV/PFA, where ground motion and building are drawn.",
    ),
    _simulation_field(
        "if_faster", "share", fill("Chance if faster"), is_optional=True, help="Chance in that with the most.",
    ),
    _simulation_field(
        "ideal.overturned", "count", fill("Overturned"), ("ideal", "overturned"),
        help="Motions under which the piece overturned exactly as given, if exactly this motion recurred.",
    ),
    _simulation_field(
        "ideal.probability", "share", fill("Chance if exactly this motion recurred"), ("ideal", "probability"),
        short=fill("If exactly this motion recurred"), shows=DATA | {"methods"}, help="`overturned` / `runs`.",
    ),
    _simulation_field("ideal.low", "share", fill("Low"), ("ideal", "low"), help="Lower end of its sampling interval."),
    _simulation_field("ideal.high", "share", fill("High"), ("ideal", "high"), help="Upper end of it."),
    _simulation_field(
        "record_overturned", "flag", fill("Overturns under the record"), ("record", "overturned"),
        short=fill("Under the record"), shows=DATA | {"pieces"},
        help="Whether it overturns under the recorded motion itself.",
    ),
    _simulation_field(
        "record_max_rotation_ratio", "number", fill("Largest rotation under the record, over the critical angle"),
        ("record", "max_rotation_ratio"), help="Largest |theta| over the critical angle under the recorded motion.",
    ),
)  # fmt: skip
"""What simulation found under the governing motion: together null in results.json where it did not run."""


_KINDS: Mapping[str, Kind] = {"number": "number", "count": "count", "truth": "flag"}
"""Of the columns of a method; all others are texts."""


def _in_excel(spec: str) -> str:
    """Return the format of a number with a fixed number of decimals, ``,.1f``, as Excel writes it."""
    whole, _point, decimals = spec.rstrip("f").partition(".")
    zeros = "0" * int(decimals or 0)
    return (f"{'#,##0' if whole else '0'}{'.' if zeros else ''}{zeros}") if spec else ""


def method_fields(method: MethodInfo) -> Iterator[Field]:
    """Yield the fields of one method: its value, what stands beside it, its flags."""

    def result(row: Any) -> Any:
        case: CaseRow = row if isinstance(row, CaseRow) else row.governing
        return case.methods[method.key]

    def detail(name: str, row: Any) -> Any:
        return result(row).detail[name]

    path = ("methods", method.key)
    listed: frozenset[Where] = frozenset(("methods", "pieces") if method.is_live else ("methods",))
    yield Field(
        key=method.key, read=lambda row: result(row).value, path=(*path, "value"), label=method.title, kind="share",
        short=method.short_title, is_optional=True, format="0.0%" if method.kind == "probability" else "0", width=10,
        shows=DATA | listed,
    )  # fmt: skip
    for column in method.columns if method.role != "simulation" else ():  # that has fields of its own
        yield Field(
            key=f"{method.key}_{column.name}", read=partial(detail, column.name), path=(*path, column.name),
            label=column.label, unit=column.unit, format=_in_excel(column.format), kind=_KINDS.get(column.kind, "text"),
            is_optional=True, shows=DATA,
        )  # fmt: skip
    yield Field(
        key=f"{method.key}_flags", read=lambda row: list(result(row).flags), path=(*path, "flags"), kind="list",
        shows=DATA,
    )  # fmt: skip


def _adopted(name: str, read: Callable[[Any], Any], label: str, kind: Kind, **more: Any) -> Field:
    return Field(
        key=f"adopted_{name}", read=lambda row: read(row.adopted), path=("adopted", name), label=label, kind=kind,
        **{"shows": DATA, **more},
    )  # fmt: skip


ADOPTED_FIELDS = (
    _adopted(
        "method", lambda one: one.method, fill("Method"), "text",
        help='Key of the method whose value it is; "" where the piece cannot rock.',
    ),
    _adopted(
        "basis", lambda one: one.basis, fill("Basis"), "text", choices=BASES,
        help="`simulated`; `formula`: not simulated; `unconfirmed`: the formula's class, as the motions of a "
        "simulation that gave a lower one may be too weak; or `cannot rock`: too stocky, or not even the strongest "
        "motion that may be drawn can start it. Counts, lists and sums never mix the first three; the last is low, and "
        "counts with those of the run.",
    ),
    _adopted(
        "probability", lambda one: one.probability, fill("Chance of overturning"), "share", format="0.0%",
        short=fill("Chance"), shows=DATA | {"pieces", "risky"},
    ),
    _adopted(
        "low", lambda one: one.low, fill("Low"), "share", is_optional=True, format="0.0%",
        help="Lower end of the sampling interval; null where the formula's value is adopted.",
    ),
    _adopted("high", lambda one: one.high, fill("High"), "share", is_optional=True, format="0.0%"),
    _adopted("class", lambda one: one.risk.word, fill("Class"), "class", shows=DATA | {"pieces", "risky"}),
    _adopted("class_upper", lambda one: one.upper.word, fill("Class, upper estimate"), "class"),
    _adopted(
        "lowered_from", lambda one: _word(one.lowered_from), fill("Lowered from"), "class", is_optional=True,
        help="Class by formula where simulation lowered it.",
    ),
    _adopted(
        "flags", lambda one: list(one.flags), fill("Flags"), "list", short=fill("Marks"), shows=DATA | {"pieces"},
    ),
)  # fmt: skip

FORMULA_CLASSES = (
    Field(
        key="class_formula",
        read=lambda one: one.formula_class.word,
        path=("class_formula",),
        label=fill("Class (formula)"),
        kind="class",
        shows=DATA | {"pieces", "risky"},
        help="By the formula that *Class by* chooses, the highest under any of its motions; low where it cannot rock.",
    ),
    Field(
        key="class_or",
        read=lambda one: one.paper_class.word,
        path=("class_or",),
        label=fill("Class (OR)"),
        kind="class",
        shows=DATA | {"pieces", "risky"},
        help="By the paper's formula under the governing motion; low where it cannot rock.",
    ),
)
"""The classes of a row of furniture by formula, beside the one that is adopted."""


def _annual(name: str, label: str, kind: Kind, **more: Any) -> Field:
    read = attrgetter(name)
    return Field(
        key=f"annual_{name}", read=lambda one: None if one.item.annual is None else read(one.item.annual),
        path=("annual", name), label=label, kind=kind, **{"shows": DATA, **more},
    )  # fmt: skip


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
    def read(row: Any) -> Any:
        found = row.governing.sliding
        return None if found is None else getattr(found, name)

    return Field(
        key=f"sliding_{name}", read=read, path=("sliding", name), label=label, is_optional=True,
        **more,
    )  # fmt: skip


SLIDING_FIELDS = (
    _sliding(
        "branch", fill("Starts to (as run)"), choices=BRANCHES, width=12,
        help="What it does first at the floor's PFA (Shenton 1996); `sliding` is null where no friction is given.",
    ),
    _sliding(
        "slip_median_cm", fill("Peak slip, median (as run)"), unit="cm", kind="number", format="0.0",
        help="Of a block that slides and does not rock (Newmark 1965), under the draws of the simulation; null where "
        "it cannot slide, or nothing was simulated.",
    ),
    _sliding(
        "slip_84_cm", fill("Peak slip, 84 % (as run)"), unit="cm", kind="number", format="0.0",
        help="Not exceeded in 84 % of the draws.",
    ),
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
    _of_item(
        "breadth_cm", fill("Breadth"), short=fill("B × W × H"), kind="number", unit="cm", shows=EVERYWHERE | {"risky"},
    ),
    _of_item("width_cm", fill("Width"), kind="number", unit="cm", is_optional=True),
    _of_item("height_cm", fill("Height"), kind="number", unit="cm"),
    _of_item(
        "breadth_to_height", fill("B/H"), kind="number", format="0.000", width=8, shows=EVERYWHERE | {"methods"},
    ),
    _of_item(
        "centre_of_gravity", fill("Centre of gravity"), kind="share", format="0%", width=8, shows=DATA,
        help="Height of the centre of gravity, as a share of the piece's height.",
    ),
    Field(
        key="axis", read=attrgetter("governing.motion.axis"), label=fill("Axis"), choices=AXES, width=6,
        shows=EVERYWHERE, help="The axis that governs.",
    ),
    _of_item(
        "axis_given", fill("Axis given"), is_optional=True, choices=AXES, width=7,
        help="null: unknown, the worse of both governs.",
    ),
    _of_item("angle_deg", fill("Angle"), kind="number", unit="deg", width=8, is_optional=True),
    _of_item("x_m", fill("X"), kind="number", unit="m", width=8, is_optional=True),
    _of_item("y_m", fill("Y"), kind="number", unit="m", width=8, is_optional=True),
    _of_item(
        "friction", fill("Friction"), kind="number", is_optional=True,
        help="The one used: the piece's own, else the building's.",
    ),
    *SLIDING_FIELDS,
    _of_item(
        "against_wall", fill("Against wall"), kind="flag", is_optional=True, width=8,
        help="Whether a long side stands against a wall; null: not known.",
    ),
    _of_item(
        "falls_toward_deg", fill("Falls toward"), kind="number", unit="deg", is_optional=True, shows=DATA,
        help="Direction in which a piece against a wall falls, anticlockwise from X; null: it may fall either way.",
    ),
    Field(
        key="one_sided_chance", read=attrgetter("governing.one_sided"), label=fill("Chance with a wall at its back"),
        kind="share", format="0.0%", is_optional=True, width=10,
        help="Simulated beside the adopted chance, which it does not change: turning away from the wall alone.",
    ),
    Field(
        key="importance", read=lambda one: one.item.importance or None, label=fill("Importance"), is_optional=True,
        choices=IMPORTANCE, width=13,
    ),
    Field(
        key="pfa_g", read=attrgetter("governing.motion.pfa_g"), label=fill("PFA used"), short=fill("PFA"), unit="g",
        kind="number", format="0.000", shows=EVERYWHERE | {"methods"}, help="Of the motion that governs.",
    ),
    Field(
        key="pfv_cm_s", read=attrgetter("governing.motion.pfv_cm_s"), label=fill("PFV used"), short=fill("PFV"),
        unit="cm/s", kind="number", format="0.0", is_optional=True, shows=FILES | {"methods"},
    ),
    Field(
        key="pfa_source", read=attrgetter("governing.motion.label"), shows=DATA,
        help="The record, `given`, the code of a profile (with an assumed intensity: `Shaking MMI VII, ASCE 7-22`), "
        "or the floors that it is interpolated between.",
    ),
)  # fmt: skip


def _of_anchor(key: str, label: str, **more: Any) -> Field:
    return Field(
        key=key, read=attrgetter(f"item.anchor.{key}"), path=("anchor", key), label=label, is_optional=True,
        **{"unit": "kN", "kind": "number", **more},
    )  # fmt: skip


ANCHOR_FIELDS = (
    _of_item("weight_kg", fill("Weight"), unit="kg", kind="number", is_optional=True),
    _of_anchor("weight_kn", fill("Weight with contents")),
    Field(
        key="weight_source", read=attrgetter("item.anchor.weight_source"), path=("anchor", "weight_source"),
        label=fill("Source of the weight (estimate: assumed)"), choices=("given", "type", "estimate"),
    ),
    _of_anchor("bracket_height_cm", fill("Bracket height"), unit="cm"),
    _of_anchor("bracket_capacity_kn", fill("Bracket capacity"), help="Tension that its bracket holds."),
    _of_anchor("tension_kn", fill("Tension at the bracket")),
    _of_anchor("tension_low_kn", fill("Tension at 16 % of PFA")),
    _of_anchor("tension_high_kn", fill("Tension at 84 % of PFA")),
    _of_anchor("tension_without_weight_kn", fill("Tension without the help of the weight")),
    _of_anchor("shear_kn", fill("Shear at the base")),
    _of_anchor(
        "tension_code_kn", fill("Tension by the code"), help="For F_p of ASCE 7-22, where SDS or Ground PGA is known."
    ),
    _of_anchor("shear_code_kn", fill("Shear by the code")),
    _of_anchor(
        "needed_friction", fill("Friction needed at the base"), unit="", shows=DATA,
        help="Coefficient below which the base of the held piece slides at PFA.",
    ),
    *(
        Field(key=key, read=attrgetter(f"item.anchor.{key}"), path=("anchor", key), kind="flag", shows=DATA, help=text)
        for key, text in (
            ("is_height_assumed", "Whether the workbook leaves the height of its bracket blank: 0.9 of its own."),
            ("is_per_metre", "Whether weight and forces are those of one metre of it, as its width is not known."),
        )
    ),
    *(
        Field(
            key=key, read=attrgetter(f"item.anchor.{key}"), path=("anchor", key), label=label, kind="flag",
            is_optional=True, shows=DATA,
            help="Null where the capacity is not known, and where it carries the force of one metre of a piece whose "
            "width is not known.",
        )
        for key, label in (
            ("holds", fill("Bracket holds at PFA")), ("holds_high", fill("Bracket holds at 84 % of PFA")),
            ("holds_code", fill("Bracket holds by the code")),
        )
    ),
    Field(
        key="counts_as_anchored", read=attrgetter("item.is_held"), path=("anchor", "counts_as_anchored"),
        label=fill("Counts as anchored"), kind="flag", shows=DATA,
        help="It says so and its bracket is not known to fail, or it is partly anchored by one that holds at 84 %.",
    ),
)  # fmt: skip
"""The weight of a piece, and what its bracket has to carry; all of it is screening, not design."""


def _axis_record(case: CaseRow, methods: Sequence[MethodInfo]) -> dict[str, Any]:
    return {
        "axis": case.motion.axis,
        "source": case.motion.label,
        "pfa_g": case.motion.pfa_g,
        "pfv_cm_s": case.motion.pfv_cm_s,
        "methods": {one.key: case.methods[one.key].value for one in methods},
        "verification": _SIMULATION.nest(case)["verification"] if case.simulation else None,
    }


def _say_axes(axes: Iterable[Mapping[str, Any]]) -> list[str]:
    return [f"{axis['axis']}: {axis['source']} {axis['pfa_g']} g" for axis in axes]


def item_fields(results: Results) -> tuple[Field, ...]:
    """Return the fields of a row of furniture, in the order of items.csv."""
    return arrange_item_fields(results.methods, results.provenance.sheets.get("Items", "Items"))


def arrange_item_fields(methods: Sequence[MethodInfo], sheet: str) -> tuple[Field, ...]:
    """Return the fields of a row of furniture by the methods of the run, and the workbook's name of the sheet Items."""
    axes = Field(
        key="axes", read=lambda one: [_axis_record(case, methods) for case in one.cases], kind="records",
        shows=DATA, flat=_say_axes, help="Every motion that the item was evaluated under.",
    )  # fmt: skip
    return (
        *PIECE_FIELDS,
        *(field for method in methods for field in method_fields(method)),
        *SIMULATION_FIELDS,
        *ADOPTED_FIELDS,
        *FORMULA_CLASSES,
        *ANNUAL_FIELDS,
        axes,
        _of_item("anchored", fill("Anchored"), choices=ANCHORED, width=10),
        Field(key="route", read=lambda one: one.item.route or None, label=fill("Route"), width=24, is_optional=True),
        Field(
            key="segment", read=lambda one: one.item.segment or None, label=fill("Segment"), width=24, is_optional=True
        ),
        *ANCHOR_FIELDS,
        _of_item("edge_distance_m", fill("Edge distance"), unit="m", kind="number", is_optional=True, shows=DATA),
        _of_item("notes", fill("Notes"), width=40),
        Field(
            key="assumed", read=lambda one: list(one.item.assumed), label=fill("Assumed"), kind="list", width=28,
            help="Fields that were blank in the workbook and were filled in.",
        ),
        *_origin_fields(sheet),
    )  # fmt: skip


def _origin_fields(sheet: str) -> tuple[Field, ...]:
    """Return where a row of furniture and its sizes come from; `sheet` is the workbook's name of the sheet Items."""
    return (
        Field(key="source_sheet", read=lambda one: sheet, path=("source", "sheet"), shows=DATA),
        Field(
            key="source_row", read=attrgetter("item.row"), path=("source", "row"), kind="count", shows=DATA,
        ),
        _of_item(
            "source_id", fill("Source ID"), is_optional=True, shows=DATA,
            help="Its identifier in the building model or handover file that it was imported from.",
        ),
        _of_item(
            "sizes_from", fill("Sizes from"), choices=SIZES_FROM, shows=DATA,
            help="Where its sizes come from; base and height of a scan are drawn with a larger standard deviation.",
        ),
    )  # fmt: skip


def case_fields(results: Results) -> tuple[Field, ...]:
    """Return the fields of a piece under one motion."""
    item = results.cases_table.item.tolist()
    names = [results.item_rows[index].item for index in item]
    governing = {one.governing for one in results.item_rows}
    return (
        Field(key="item", read=lambda case: names[case.index]),
        Field(key="floor", read=lambda case: case.motion.floor),
        Field(key="axis", read=lambda case: case.motion.axis, choices=AXES),
        Field(key="source", read=lambda case: case.motion.label),
        Field(key="pfa_g", read=lambda case: case.motion.pfa_g, kind="number"),
        Field(key="pfv_cm_s", read=lambda case: case.motion.pfv_cm_s, kind="number", is_optional=True),
        Field(key="governs", read=lambda case: case.index in governing, kind="flag"),
        *(field for method in results.methods for field in method_fields(method)),
        *SIMULATION_FIELDS,
        *ADOPTED_FIELDS,
    )


def _of_motion(key: str, kind: Kind = "text", **more: Any) -> Field:
    """A field of a floor's motion that belongs to one kind of source: None for the others."""

    def read(row: MotionRow) -> Any:
        value = getattr(row, key)
        return None if value == "" else value

    return Field(key=key, read=read, kind=kind, is_optional=True, **more)


def _of_record(key: str, label: str = "") -> Field:
    """What the file of a record says: None where there is no record."""

    def read(row: MotionRow) -> Any:
        return getattr(row, key) if row.has_record else None

    return Field(key=key, read=read, label=label, is_optional=True)


def _fit(name: str, label: str, format: str, unit: str = "", **more: Any) -> Field:  # noqa: A002
    """How the generated motions meet their target: None where none were generated."""

    def read(row: MotionRow) -> Any:
        fit = row.ensemble.fit if row.ensemble else None
        return None if fit is None else getattr(fit, name)

    return Field(
        key=f"ensemble_fit_{name}", read=read, path=("ensemble", "fit", name), kind="number", label=label, unit=unit,
        format=format, **more,
    )  # fmt: skip


def _ensemble(name: str, kind: Kind, **more: Any) -> Field:
    return Field(
        key=f"ensemble_{name}", read=lambda row: None if row.ensemble is None else getattr(row.ensemble, name),
        path=("ensemble", name), kind=kind, **more,
    )  # fmt: skip


def _signs(row: MotionRow) -> list[int] | None:
    return None if row.ensemble is None or row.ensemble.signs is None else list(row.ensemble.signs)


def _bands(row: MotionRow) -> list[float] | None:
    return None if row.ensemble is None or row.ensemble.bands is None else list(row.ensemble.bands)


def _profile(name: str) -> Callable[[MotionRow], Any]:
    return lambda row: None if row.profile is None else getattr(row.profile, name)


MOTION_FIELDS = (
    Field(key="axis", read=lambda row: row.axis, label=fill("Axis"), choices=AXES),
    Field(key="source", read=lambda row: row.source, choices=("record", "given", "interpolated", "profile", "beam")),
    Field(
        key="pfa_g", read=lambda row: row.pfa_g, kind="number", label=fill("PFA"), unit="g", format="0.000",
        help="After treatment.",
    ),
    Field(
        key="pfv_cm_s", read=lambda row: row.pfv_cm_s, kind="number", label=fill("PFV"), unit="cm/s", format="0.0",
        is_optional=True,
    ),
    Field(key="flags", read=lambda row: list(row.flags), kind="list"),
    Field(
        key="between", read=lambda row: list(row.between), kind="list",
        help="The floors below and above that it is interpolated between.",
    ),
    Field(
        key="profile", read=_profile("key"), is_optional=True, help="The code whose design profile gave the PFA.",
    ),
    Field(
        key="profile_verified", read=_profile("verified"), kind="flag", is_optional=True,
        help="Whether the profile agrees with public implementations of the code.",
    ),
    _of_motion("clause"),
    _of_motion("height_ratio", "number", label=fill("z/h"), format="0.000", help="Its height over the roof's."),
    _of_motion("amplification", "number", label=fill("Amplification"), format="0.000", help="PFA over ground PGA."),
    Field(
        key="dispersion", read=lambda row: row.dispersion, kind="number", label=fill("Motion uncertainty"),
        format="0.00", help="Standard deviation of ln amplitude that is drawn, from one earthquake to the next.",
    ),
    Field(
        key="pfv_follows", read=lambda row: row.pfv_follows, kind="flag",
        help="Whether PFV is not known by itself and follows PFA.",
    ),
    _of_motion("record", help="The record as the workbook names it."),
    _of_motion(
        "pfa_file_g", "number", label=fill("PFA in the file"), unit="g", format="0.000",
        help="Peak of the file's own values, before treatment.",
    ),
    _of_record("format"),
    _of_record("station", fill("Station")),
    _of_record("location"),
    _of_record("channel"),
    _of_record("event", fill("Event")),
    _of_motion("azimuth_deg", "number", label=fill("Azimuth"), unit="deg"),
    _of_motion("corrected", "flag"),
    _of_motion("time_step_s", "number"),
    _of_motion("samples", "count"),
    Field(key="notes", read=lambda row: list(row.notes), kind="list"),
    _ensemble("motions", "count", label=fill("Motions"), format="#,##0"),
    _ensemble(
        "assumed_motion", "flag", help="Whether no record is known, so that ground motion and building are drawn.",
    ),
    _ensemble(
        "unknown_building", "flag",
        help="Whether neither T1, Height, Storeys nor an Elevation is known, so that no class is confirmed.",
    ),
    _ensemble(
        "weak_motions", "flag",
        help="Whether the motions are weaker than the floor's, so that they may not lower a class.",
    ),
    Field(
        key="ensemble_bands", read=_bands, path=("ensemble", "bands"), kind="factors", is_optional=True,
        flat=lambda value: value or [],
        help="Factors above and below PFA/(2 pi PFV) by which drawn motions were brought to the floor's peaks.",
    ),
    Field(
        key="ensemble_signs", read=_signs, path=("ensemble", "signs"), kind="signs", is_optional=True,
        flat=lambda value: value or [],
        help="Whether the motions move as the phases that all floors share (1) or against them (-1), by octave from "
        "0.1 to 25.6 Hz: as the records of two floors or more of one earthquake on one clock do; null where no such "
        "records are known.",
    ),
    _fit("matched_to_s", fill("Matched from 0.05 s to"), "0.00", "s"),
    _fit("mean_deviation", fill("Mean deviation"), "0.0%"),
    _fit("worst_deviation", fill("Worst deviation"), "+0.0%;-0.0%"),
    _fit("worst_period_s", fill("at period"), "0.000", "s"),
    _fit("pfa_ratio", fill("PFA over the target's"), "0.000"),
    _fit("pfa_scatter", fill("Scatter of PFA"), "0.0%"),
    _fit("pfv_ratio", fill("PFV over the target's"), "0.000", is_optional=True),
    _fit("pfv_scatter", fill("Scatter of PFV"), "0.0%"),
    _fit("spectrum_scatter", fill("Scatter of the spectrum"), "0.0%"),
)  # fmt: skip
"""The fields of a floor's motion, as they stand in results.json under ``floors[].demands[]``."""


def floor_fields(results: Results) -> tuple[Field, ...]:
    """Return the fields of a row of the table of floors: the floor, and one of its motions."""
    by_name = {one.floor: one for one in results.floor_rows}
    return (
        Field(key="floor", read=lambda row: row.floor),
        Field(key="name", read=lambda row: by_name[row.floor].name),
        Field(key="elevation_m", read=lambda row: by_name[row.floor].elevation_m, kind="number", is_optional=True),
        *MOTION_FIELDS,
    )


# ---------------------------------------------------------------- records and tables


_GROUPS = ("verification", "ensemble", "sliding", "annual", "anchor")
"""Groups of fields that are None together where nothing in them is known, such as where no simulation ran."""


class Shape:
    """How rows become records of results.json and rows of a table: its fields, arranged once for many rows."""

    def __init__(self, chosen: Iterable[Field]) -> None:
        self.fields = tuple(chosen)
        self._flat = [(one.key, one.read, one.flat) for one in self.fields]
        self._tree: dict[str, Any] = {}
        for one in self.fields:
            inner = self._tree
            for name in one.place[:-1]:
                inner = inner.setdefault(name, {})
            inner[one.place[-1]] = one.read

    def nest(self, row: Any) -> dict[str, Any]:
        """Return a row as a record of results.json."""
        return _nest(row, self._tree)

    def flatten(self, row: Any) -> dict[str, Any]:
        """Return a row of items.csv or of a table."""
        return {key: read(row) if flat is None else flat(read(row)) for key, read, flat in self._flat}


def _nest(row: Any, tree: Mapping[str, Any]) -> dict[str, Any]:
    record = {}
    for name, read in tree.items():
        if type(read) is dict:
            inner = _nest(row, read)
            record[name] = _none_if_blank(inner) if name in _GROUPS else inner
        else:
            record[name] = read(row)
    return record


def _none_if_blank(group: dict[str, Any]) -> dict[str, Any] | None:
    """Return a group, or None where nothing in it is known, nor in the groups within it."""
    inner = {name: _none_if_blank(one) if isinstance(one, dict) else one for name, one in group.items()}
    return inner if any(value is not None for value in inner.values()) else None


_SIMULATION = Shape(SIMULATION_FIELDS)


def unnest(record: Mapping[str, Any], chosen: Iterable[Field]) -> dict[str, Any]:
    """Return a row of a table from a record of results.json: what `flatten` gives for the row that it was made from."""
    row = {}
    for field in chosen:
        value: Any = record
        for name in field.place:
            value = value.get(name) if isinstance(value, Mapping) else None
        row[field.key] = value if field.flat is None else field.flat(value)
    return row
