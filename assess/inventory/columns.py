"""Every sheet and column of the workbook, once.

Reading, checking, the empty workbook, the report's headings and the README's table are all derived from `SHEETS`, and
so are the names in other languages, by which a workbook may call its sheets, columns and choices, too: see `wording`.
A header is the label with its unit in brackets, ``Height [cm]``; the bracket is the unit of the column.
"""

from dataclasses import dataclass
from typing import Literal

from assess.settings import SCENARIOS
from assess.units import QUANTITIES

Kind = Literal["text", "number", "count", "choice", "language", "date", "file", "records"]

AXES = ("X", "Y")
ANCHORED = ("no", "yes", "partly", "unknown")
IMPORTANCE = ("life safety", "function", "property")
PLACES = ("room", "corridor", "door", "stair", "exit")
LANGUAGES = ("English", "Italiano")
"""Of reports: names that `assess.language.find_language` knows."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """One column of a table, or one line of a form.

    Parameters
    ----------
    name : str
        Field of the model in `assess.inventory.model`.
    label : str
        Heading, without the unit.
    kind : str
        What a cell may hold.
    help : str
        What to fill in: the input message in Excel and the README's table.
    quantity, unit, imperial : str
        Key of `assess.units.QUANTITIES`, and the unit that the empty workbook offers (SI, imperial).
    required : bool
        Whether the table cannot be read without it.
    low, high : float, optional
        Outside these an error, in `unit`.
    usual_low, usual_high : float, optional
        Outside these a warning, in `unit`.
    choices : tuple of str
        What a choice may be.
    source : str
        Sheet whose first column lists what the cell may name.
    default : str
        What a blank means, in words.
    width : int
        Width in the empty workbook [characters].
    language : str
        Code of the language that `label` is in.
    """

    name: str
    label: str
    kind: Kind
    help: str
    quantity: str = ""
    unit: str = ""
    imperial: str = ""
    required: bool = False
    low: float | None = None
    high: float | None = None
    usual_low: float | None = None
    usual_high: float | None = None
    choices: tuple[str, ...] = ()
    source: str = ""
    default: str = ""
    width: int = 12
    language: str = "en"

    def header(self, units: Literal["si", "imperial"] = "si") -> str:
        """Label with the unit in brackets, as the empty workbook writes it."""
        unit = self.imperial if units == "imperial" and self.imperial else self.unit
        return f"{self.label} [{unit}]" if unit else self.label

    @property
    def factor(self) -> float:
        """Factor from `unit` to SI."""
        return QUANTITIES[self.quantity][self.unit] if self.quantity else 1.0


@dataclass(frozen=True, slots=True)
class Sheet:
    """One sheet: a table with a header row, or a form with labels in column A and values in column B."""

    name: str
    layout: Literal["table", "form"]
    required: bool
    help: str
    columns: tuple[Column, ...]

    def column(self, name: str) -> Column:
        """Return the column with this field name."""
        return next(column for column in self.columns if column.name == name)


def _size(name: str, label: str, text: str) -> Column:
    return Column(
        name=name, label=label, kind="number", help=text, quantity="length", unit="cm", imperial="in",
        low=5, high=600, usual_low=20, usual_high=300, default="the Type's in the Catalogue",
    )  # fmt: skip


def _type_size(name: str, label: str, text: str) -> Column:
    return Column(
        name=name, label=label, kind="number", help=text, quantity="length", unit="cm", imperial="in", low=5, high=600,
    )  # fmt: skip


def _metres(name: str, label: str, text: str, low: float = -1e5, high: float = 1e5, default: str = "") -> Column:
    return Column(
        name=name, label=label, kind="number", help=text, quantity="length", unit="m", imperial="ft",
        low=low, high=high, default=default,
    )  # fmt: skip


def _acceleration(name: str, label: str, text: str) -> Column:
    return Column(
        name=name, label=label, kind="number", help=text, quantity="acceleration", unit="g", imperial="g",
        low=0, high=5, usual_low=0.01, usual_high=2,
    )  # fmt: skip


def _velocity(name: str, label: str, text: str) -> Column:
    return Column(
        name=name, label=label, kind="number", help=text, quantity="velocity", unit="cm/s", imperial="in/s",
        low=0.01, high=1000, usual_low=1, usual_high=300, default="estimated from T1, else bounded",
    )  # fmt: skip


BUILDING = Sheet(
    "Building",
    "form",
    False,
    "The building and the earthquake: one line each, all may stay blank.",
    (
        Column(name="building", label="Building", kind="text", help="Name of the building.", width=40),
        Column(name="address", label="Address", kind="text", help="Street and town."),
        Column(name="use", label="Use", kind="text", help="Office, hospital, school ..."),
        Column(name="client", label="Client", kind="text", help="For whom the report is made: for its cover."),
        Column(name="storeys", label="Storeys", kind="count", help="Storeys above ground.", low=1, high=300),
        Column(
            name="height", label="Height", kind="number", quantity="length", unit="m", imperial="ft", low=2, high=1000,
            help="Height of the roof above the ground, for floors whose motion follows from Ground PGA.",
            default="the highest Elevation in Floors",
        ),
        Column(
            name="period", label="Period T1", kind="number", quantity="time", unit="s", imperial="s",
            help="First period of vibration: gives the PFV where a floor has none; ASCE 7-22 uses it, too.", low=0.02, high=20,
        ),
        Column(
            name="azimuth_deg", label="Azimuth of X", kind="number", quantity="angle", unit="deg", imperial="deg",
            help="Compass direction of the building's X axis, clockwise from north. Y is at a right angle.",
            low=-360, high=360, default="directions of records are not checked",
        ),
        Column(name="prepared_by", label="Prepared by", kind="text", help="Who answers for the report."),
        Column(name="checked_by", label="Checked by", kind="text", help="Who has checked the report: for its cover."),
        Column(name="approved_by", label="Approved by", kind="text", help="Who has approved the report: for its cover."),
        Column(name="revision", label="Revision", kind="text", help="Number or letter of this issue of the report."),
        Column(name="report_date", label="Report date", kind="date", help="Date on the cover of the report.", default="today"),
        Column(name="organisation", label="Organisation", kind="text", help="For the cover of the report."),
        Column(name="logo", label="Logo file", kind="file", help="PNG or JPEG file beside the workbook, for the cover."),
        Column(name="scenario", label="Scenario", kind="text", help="The earthquake, in words: for the cover."),
        Column(
            name="scenario_kind", label="Scenario kind", kind="choice", choices=SCENARIOS, default="as filled",
            help="as filled: each floor's record, else PFA, else between its neighbours, else ASCE 7-22. A code: every floor.",
        ),
        _acceleration(
            "ground_pga", "Ground PGA",
            "Peak ground acceleration (0.4 SDS in ASCE 7, α S in EN 1998-1 and NTC): gives the motion of floors without "
            "record or PFA.",
        ),
        _acceleration("sds", "SDS", "Design spectral acceleration at short periods: 0.4 SDS stands in for a blank Ground PGA."),
        Column(
            name="friction", label="Default friction", kind="number", low=0.01, high=2, default="no sliding",
            help="Coefficient of friction of pieces whose own is blank. Blank: no sliding, as the paper assumes.",
        ),
        Column(
            name="restitution", label="Restitution", kind="number", low=0.01, high=1, default="Housner's",
            help="Angular velocity after an impact over that before it, for direct integration.",
        ),
        Column(
            name="language", label="Report language", kind="language", choices=LANGUAGES, default="the workbook's",
            help="Language of the report.",
        ),
    ),
)  # fmt: skip

FLOORS = Sheet(
    "Floors",
    "table",
    True,
    "Every floor that has furniture, and how it shakes: a record, a peak acceleration (PFA), or its elevation alone.",
    (
        Column(name="floor", label="Floor", kind="text", required=True, help="Short name, used in Items.", width=9),
        Column(name="name", label="Name", kind="text", help="Longer name for the report.", width=18),
        _metres("elevation", "Elevation", "Height of the floor above the ground. Needed where it has no record and no PFA.", -200, 1000),
        _acceleration("pfa_x", "PFA X", "Peak floor acceleration along X."),
        _acceleration("pfa_y", "PFA Y", "Peak floor acceleration along Y. One axis alone serves both."),
        _velocity("pfv_x", "PFV X", "Peak floor velocity along X."),
        _velocity("pfv_y", "PFV Y", "Peak floor velocity along Y."),
        Column(
            name="record_x", label="Record X", kind="records", width=24,
            help="Recorded motion along X: file, or file#channel, beside the workbook; parallel ones split by ;",
        ),
        Column(name="record_y", label="Record Y", kind="records", width=24, help="Recorded motion along Y, likewise."),
        Column(name="plan", label="Plan image", kind="file", width=16, help="Picture of the floor plan; kept."),
    ),
)  # fmt: skip

ITEMS = Sheet(
    "Items",
    "table",
    True,
    "The furniture: one row a piece, or a row for several alike.",
    (
        Column(name="item", label="Item", kind="text", required=True, help="Its own number or name.", width=10),
        Column(
            name="floor", label="Floor", kind="text", required=True, source="Floors", width=9,
            help="A floor of the Floors sheet.",
        ),
        Column(name="room", label="Room", kind="text", help="Room or area.", width=14),
        Column(name="description", label="Description", kind="text", help="What it is.", width=26),
        Column(
            name="type", label="Type", kind="text", source="Catalogue", width=24,
            help="A type of the Catalogue: gives the sizes that are blank here.",
        ),
        Column(
            name="quantity", label="Quantity", kind="count", low=1, high=10000, default="1", width=9,
            help="How many alike. A piece with a position on the plan needs a row of its own.",
        ),
        _size("breadth", "Breadth", "The shorter plan side, between the outer supports where they stand inside."),
        _size("width", "Width", "The longer plan side."),
        _size("height", "Height", "From the floor to the top."),
        Column(
            name="axis", label="Axis", kind="choice", choices=AXES, default="the worse of both", width=6,
            help="Building axis parallel to Breadth: the direction it topples.",
        ),
        Column(
            name="anchored", label="Anchored", kind="choice", choices=ANCHORED, default="unknown", width=10,
            help="Fixed to wall or floor? partly and unknown count as free-standing.",
        ),
        Column(
            name="friction", label="Friction", kind="number", low=0.01, high=2, default="the building's, else no sliding",
            help="Coefficient of friction with the floor. Below B/H a piece slides before it rocks.", width=9,
        ),
        _metres("x", "X", "Centre of the piece on the plan."),
        _metres("y", "Y", "Centre of the piece on the plan."),
        Column(
            name="angle_deg", label="Angle", kind="number", quantity="angle", unit="deg", imperial="deg",
            low=-360, high=360, help="Anticlockwise from X to Breadth; within 15 of X or Y it sets a blank Axis.",
        ),
        Column(
            name="route", label="Route", kind="text", source="Routes", default="those that its position tells", width=10,
            help="Evacuation route it may block.",
        ),
        Column(
            name="segment", label="Segment", kind="text", default="every segment of that route on the floor",
            help="Part of that route.",
        ),
        _metres(
            "edge_distance", "Edge distance", "From its nearest face to the edge of the route; negative if inside.", -100,
            default="as the plan has it, else 0, at the edge",
        ),
        Column(
            name="importance", label="Importance", kind="choice", choices=IMPORTANCE, width=12,
            help="What its fall would endanger. life safety comes first in the list of what to fix.",
        ),
        Column(name="notes", label="Notes", kind="text", help="Anything else.", width=30),
    ),
)  # fmt: skip

PLACES_SHEET = Sheet(
    "Places",
    "table",
    False,
    "Rooms, doors, stairs and exits that routes lead between.",
    (
        Column(name="place", label="Place", kind="text", required=True, help="Its own name.", width=16),
        Column(name="floor", label="Floor", kind="text", required=True, source="Floors", help="A floor of the Floors sheet."),
        _metres("x", "X", "Position on the plan: a segment is the straight line between those of its two places."),
        _metres("y", "Y", "Position on the plan."),
        Column(
            name="kind", label="Kind", kind="choice", choices=PLACES, default="a point that routes pass",
            help="What it is. A room needs a way to an exit, or to a stair.",
        ),
    ),
)  # fmt: skip

ROUTES = Sheet(
    "Routes",
    "table",
    False,
    "Evacuation routes, one row a segment.",
    (
        Column(name="route", label="Route", kind="text", required=True, help="Name of the route; repeat it on each segment.", width=10),
        Column(name="segment", label="Segment", kind="text", required=True, help="Name of this part of it.", width=10),
        Column(
            name="floor", label="Floor", kind="text", source="Floors", default="that of both places",
            help="A floor of the Floors sheet; leave it blank on stairs.",
        ),
        Column(name="start", label="From", kind="text", source="Places", help="The place where it begins.", width=16),
        Column(name="end", label="To", kind="text", source="Places", help="The place where it ends.", width=16),
        Column(
            name="room", label="Room", kind="text", default="pieces of every room count, through walls as well", width=16,
            help="The Room of Items that it runs through, several split by ; Placed pieces of other rooms do not count.",
        ),
        _metres("clear_width", "Clear width", "Width without furniture in it.", 0.1, 100, "as Required width"),
        _metres("required_width", "Required width", "Width that must stay free.", 0.1, 100, "0.9 m"),
        Column(
            name="occupants", label="Occupants", kind="count", low=0, high=100000, default="the width they need is not told",
            help="People who leave by it.",
        ),
        Column(name="notes", label="Notes", kind="text", help="Anything else.", width=30),
    ),
)  # fmt: skip

CATALOGUE = Sheet(
    "Catalogue",
    "table",
    False,
    "Types of furniture with their sizes. Add your own; a type that is here twice counts as an error.",
    (
        Column(name="type", label="Type", kind="text", required=True, help="Name of the type.", width=34),
        _type_size("breadth", "Breadth", "The shorter plan side."),
        _type_size("width", "Width", "The longer plan side."),
        _type_size("height", "Height", "From the floor to the top."),
        Column(name="source", label="Source", kind="text", help="Where the sizes come from.", width=60),
    ),
)

SHEETS = (BUILDING, FLOORS, ITEMS, PLACES_SHEET, ROUTES, CATALOGUE)

HELP, LISTS = "Help", "Lists"
"""Sheets of the empty workbook that hold no data; reading leaves them out."""

LIVE = ("B/H", "PFA used [g]", "OR", "Kaneko-Hayashi", "Class (formula)")
"""Columns at the right of Items that Excel computes; reading leaves them out."""

WORKINGS = ("Axis used", "PFV used [cm/s]", "Height used [cm]")
"""Right of those, what they are computed from: each formula stays short, and its input can be seen."""
