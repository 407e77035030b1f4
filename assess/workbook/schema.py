"""Every sheet and column of the workbook, once.

Reading, checking, the empty workbook, the report's headings and the README's table are all derived from `SHEETS`, and
so are the names in other languages, by which a workbook may call its sheets, columns and choices, too: see `names`.
A header is the label with its unit in brackets, ``Height [cm]``; the bracket is the unit of the column.
"""

from dataclasses import dataclass
from typing import Any, Literal

from assess.details import DETAILS, FIX_BY
from assess.intensity import SHAKINGS
from assess.model import ANCHORED, AXES, COST_PER, IMPORTANCE, LEVELS, SIZES_FROM, STRUCTURES, TEXT_SECTIONS, UNITS
from assess.settings import ANCHOR_CODES, CLASS_BY, SCENARIOS
from assess.units import QUANTITIES

Kind = Literal["text", "number", "count", "choice", "flag", "language", "date", "file", "records", "outline"]

USES = ("Office", "Hospital", "School", "Laboratory", "Library", "Home", "Shop")
"""Uses of a building for which there is a list of furniture and an example room; any other may be typed."""
PLACES = ("room", "corridor", "door", "stair", "exit")
LANGUAGES = ("English", "Italiano")
"""Of reports: names that `assess.i18n.find_language` knows."""
YES, NO = "yes", "no"
CURRENCIES = {"€": "EUR", "$": "USD", "US$": "USD", "£": "GBP", "¥": "JPY", "Fr": "CHF", "SFr": "CHF", "NZ$": "NZD"}
"""ISO codes of currencies by their signs; the codes are offered, any other ISO code may be typed."""

DEFAULT_WIDTH = 0.9
"""Default required width of a route [m]: 900 mm, as Italy's D.M. 3 August 2015 asks for up to 300 occupants."""


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a table, or one line of a form.

    * `name`: Field of the model in `assess.model`.
    * `label`: Heading, without the unit; `aliases` are earlier ones, `language` is the code of theirs.
    * `help`: What to fill in: the input message in Excel and the README's table.
    * `quantity`, `unit`, `imperial`: Key of `assess.units.QUANTITIES`, and the unit that the empty workbook offers (SI,
      imperial).
    * `low`, `high`: Outside these an error, outside `usual_low` and `usual_high` a warning, in `unit`.
    * `choices`: What a choice may be; of a flag `YES` and `NO`, which are read as True and False.
    * `offered`: What the drop-down of a text offers; any other text is kept, too.
    * `source`: Sheet whose first column lists what the cell may name.
    * `default`: What a blank means, in words.
    * `width`: In the empty workbook [characters].
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
    offered: tuple[str, ...] = ()
    source: str = ""
    default: str = ""
    width: int = 12
    language: str = "en"
    aliases: tuple[str, ...] = ()

    def __hash__(self) -> int:
        """Return a hash of its name and label: that of all of it would be found anew in each look-up of a cache."""
        return hash((self.name, self.label))

    def header(self, units: Literal["si", "imperial"] = "si") -> str:
        """Label with the unit in brackets, as the empty workbook writes it."""
        unit = self.imperial if units == "imperial" and self.imperial else self.unit
        return f"{self.label} [{unit}]" if unit else self.label

    @property
    def labels(self) -> tuple[str, ...]:
        """Its label and its earlier ones."""
        return (self.label, *self.aliases)

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

    def __hash__(self) -> int:
        """Return a hash of its name: those of all columns would be found anew in each look-up of a cache."""
        return hash(self.name)

    def column(self, name: str) -> Column:
        """Return the column with this field name."""
        return next(column for column in self.columns if column.name == name)


_LENGTH: dict[str, Any] = {"quantity": "length", "unit": "m", "imperial": "ft"}
_METRES = _LENGTH | {"low": -1e5, "high": 1e5}
_TYPE_SIZE = _LENGTH | {"unit": "cm", "imperial": "in", "low": 5, "high": 600}
_SIZE = _TYPE_SIZE | {"usual_low": 20, "usual_high": 300, "default": "the Type's in the Catalogue"}
_ACCELERATION: dict[str, Any] = {
    "quantity": "acceleration", "unit": "g", "imperial": "g", "low": 0.0001, "high": 5, "usual_low": 0.01,
    "usual_high": 2,
}  # fmt: skip
_VELOCITY: dict[str, Any] = {
    "quantity": "velocity", "unit": "cm/s", "imperial": "in/s", "low": 0.01, "high": 1000, "usual_low": 1,
    "usual_high": 300, "default": "follows from PFA by the building's period",
}  # fmt: skip
_GROUND_VELOCITY = _VELOCITY | {"default": "drawn, 105 cm/s for each g of Ground PGA"}
_CENTRE: dict[str, Any] = {"quantity": "share", "unit": "%", "imperial": "%", "low": 5, "high": 95}
_WEIGHT: dict[str, Any] = {"quantity": "mass", "unit": "kg", "imperial": "lb", "low": 0.1, "high": 20000}
_DEGREES: dict[str, Any] = {"quantity": "angle", "unit": "deg", "imperial": "deg", "low": -360, "high": 360}

BUILDING = Sheet(
    "Building", "form", False,
    "The building and the earthquake: one line each, all may stay blank.",
    (
        Column("building", "Building", "text", "Name of the building.", width=40),
        Column("address", "Address", "text", "Street and town."),
        Column("latitude", "Latitude", "number", "Of the site, north positive: with Longitude, to find it in a "
               "ShakeMap file, or in a Hazard file of many sites.", **_DEGREES | {"low": -90, "high": 90}),
        Column("longitude", "Longitude", "number", "Of the site, east positive.", **_DEGREES | {"low": -180, "high": 180}),
        Column("use", "Use", "text", "What the building is used for: choose from the list, or type your own.",
               offered=USES),
        Column("client", "Client", "text", "For whom the report is made: for its cover."),
        Column("storeys", "Storeys", "count", "Storeys above ground.", low=1, high=300),
        Column("height", "Height", "number", "Height of the roof above the ground: gives T1, and how much more upper "
               "floors move.", **_LENGTH, low=2, high=1000, default="3 m a storey, at least the highest Elevation"),
        Column("period", "Period T1", "number", "First period of vibration: how much more upper floors without a record "
               "move than the ground.", quantity="time", unit="s", imperial="s", low=0.02, high=20, default="by Height"),
        Column("structure", "Structure", "choice", "What carries the building sideways: it tells how its floors move. "
               "May stay blank.", choices=STRUCTURES, default="unknown"),
        Column("azimuth_deg", "Azimuth of X", "number", "Compass direction of the building's X axis, clockwise from "
               "north. Y is at a right angle.", **_DEGREES, default="directions of records are not checked"),
        Column("prepared_by", "Prepared by", "text", "Who answers for the report."),
        Column("checked_by", "Checked by", "text", "Who has checked the report: for its cover."),
        Column("approved_by", "Approved by", "text", "Who has approved the report: for its cover."),
        Column("revision", "Revision", "text", "Number or letter of this issue of the report."),
        Column("report_date", "Report date", "date", "Date on the cover of the report.", default="today"),
        Column("organisation", "Organisation", "text", "For the cover of the report."),
        Column("logo", "Logo file", "file", "PNG or JPEG file beside the workbook, for the cover."),
        Column("scenario", "Scenario", "text", "The earthquake, in words: for the cover."),
        Column("scenario_kind", "Scenario kind", "choice", "as filled: each floor's record, else PFA, else between "
               "its neighbours, else from the ground. A code: every floor.", choices=SCENARIOS, default="as filled"),
        Column("ground_pga", "Ground PGA", "number", "Peak ground acceleration: gives the motion of floors without "
               "record or PFA, and the level to which annual chances refer.", **_ACCELERATION),
        Column("ground_pgv", "Ground PGV", "number", "Peak ground velocity of the same earthquake: chances on floors "
               "without a record depend on it most.", **_GROUND_VELOCITY),
        Column("sds", "SDS", "number", "Design spectral acceleration at short periods: 0.4 SDS stands in for a blank "
               "Ground PGA.", **_ACCELERATION),
        Column("shakemap", "ShakeMap file", "file", "grid.xml of a ShakeMap (USGS) beside the workbook, with its "
               "uncertainty.xml where there is one: gives the ground motion at Latitude and Longitude where Ground PGA and "
               "SDS are blank."),
        Column("shaking", "Shaking", "choice", "If you know none of these: the intensity of the shaking, MMI or JMA (Japan). "
               "Its published median PGA and PGV serve every floor without a motion of its own; the reports say so.",
               choices=tuple(SHAKINGS), default="no shaking is assumed"),
        Column("hazard", "Hazard file", "file", "Hazard curve of the site beside the workbook, for chances a year: a CSV "
               "file with pga_g,annual_rate, or OpenQuake's hazard_curve-mean-PGA.csv.",
               default="chances a year are not evaluated"),
        Column("friction", "Default friction", "number", "Coefficient of friction of pieces whose own is blank. "
               "Blank: no sliding, as the paper assumes.", low=0.01, high=2, default="no sliding"),
        Column("restitution", "Restitution", "number", "Angular velocity after an impact over that before it, for "
               "direct integration.", low=0.01, high=1, default="Housner's"),
        Column("motion_uncertainty", "Motion uncertainty", "number", "How much stronger or weaker an earthquake "
               "like this one could be: standard deviation of ln amplitude, common to all floors. 0: exactly this one.",
               low=0, high=1.5, default="0.4, assumed, with records; else what the source of the ground motion has"),
        Column("piece_uncertainty", "Piece uncertainty", "flag", "yes: base, height, centre of gravity and "
               "restitution of each piece differ a little from what is filled in, in each simulated motion. no: exactly "
               "as filled in.", choices=(YES, NO), default=YES),
        Column("class_by", "Class by", "choice", "Which formula gives the class of a piece that is not simulated: the one "
               "that agrees best with simulation, or the OR of the paper, which depends on B/H and PFA alone.",
               choices=CLASS_BY, default=CLASS_BY[0]),
        Column("language", "Report language", "language", "Language of the report.", choices=LANGUAGES,
               default="the workbook's"),
        Column("report_units", "Report units", "choice", "Units of the reports. SI: cm, m, kN, kg, cm/s. US: in, ft, lb, "
               "in/s. Files for other programs keep theirs.", choices=UNITS, default=UNITS[0]),
        Column("anchor_code", "Code of anchors", "choice", "Code of the force on anchors, from SDS or Ground PGA, else ShakeMap "
               "or Shaking. NTC 2018: F_a of 7.2.3, with S_a and q_a of EN 1998-1.", choices=ANCHOR_CODES,
               default="by Scenario kind, else ASCE 7-22"),
        Column("licence", "Licence", "text", "Professional licence or registration of who answers for the report."),
        Column("project_number", "Project number", "text", "Number of the project or contract."),
        Column("survey_date", "Survey date", "date", "When the furniture was surveyed."),
        Column("surveyed_by", "Surveyed by", "text", "Who surveyed it."),
        Column("extent", "Extent", "text", "What the survey covers: floors, wings, kinds of furniture."),
        Column("rooms_not_entered", "Rooms not entered", "text", "Rooms that were not seen, and why."),
        Column("investigation_level", "Level of investigation", "choice", "After the levels of ASTM E2026, in our words. "
               "0: from documents, without a visit. 1: a visit. 2: a visit, with drawings reviewed and simple calculations. "
               "3: detailed investigation and analysis.", choices=LEVELS),
        Column("documents", "Documents reviewed", "text", "Drawings, reports and lists that were reviewed."),
        Column("purpose", "Purpose and reliance", "text", "What the report is for, and who may rely on it."),
    ),
)  # fmt: skip

FLOORS = Sheet(
    "Floors", "table", True,
    "Every floor that has furniture, and how it shakes: a record, a peak acceleration (PFA), or its elevation alone.",
    (
        Column("floor", "Floor", "text", "Short name, used in Items.", required=True, width=9),
        Column("name", "Name", "text", "Longer name for the report.", width=18),
        Column("elevation", "Elevation", "number", "Height of the floor above the ground. Worth most where it has no "
               "record and no PFA; where no floor above the ground has one, floors called by their number are placed by "
               "Height and Storeys.", **_LENGTH, low=-200, high=1000),
        Column("pfa_x", "PFA X", "number", "Peak floor acceleration along X.", **_ACCELERATION),
        Column("pfa_y", "PFA Y", "number", "Peak floor acceleration along Y. One axis alone serves both.",
               **_ACCELERATION),
        Column("pfv_x", "PFV X", "number", "Peak floor velocity along X.", **_VELOCITY),
        Column("pfv_y", "PFV Y", "number", "Peak floor velocity along Y.", **_VELOCITY),
        Column("record_x", "Record X", "records", "Recorded motion along X: file, or file#channel, beside the "
               "workbook; parallel ones split by ;", width=24),
        Column("record_y", "Record Y", "records", "Recorded motion along Y, likewise.", width=24),
        Column("plan", "Plan", "file", "Floor plan beside the workbook, drawn under the pieces: PNG, JPEG, SVG or DXF. "
               "It is placed by the next columns.", width=16, aliases=("Plan image",)),
        Column("plan_left", "Plan left X", "number", "X of the lower left corner of the plan: of the picture, of an "
               "SVG's viewBox, of the box round all lines of a DXF.", **_METRES),
        Column("plan_bottom", "Plan bottom Y", "number", "Y of that corner.", **_METRES),
        Column("plan_width", "Plan width", "number", "Width of the whole plan in the building: its scale.", **_LENGTH,
               low=0.5, high=5000, default="a DXF file's own, where it names its units"),
        Column("plan_turn", "Plan turn", "number", "Angle by which the plan is turned about its lower left corner, "
               "anticlockwise.", **_DEGREES, default="0"),
    ),
)  # fmt: skip

ITEMS = Sheet(
    "Items", "table", True,
    "The furniture: one row a piece, or a row for several alike.",
    (
        Column("item", "Item", "text", "Its own number or name.", required=True, width=10),
        Column("floor", "Floor", "text", "A floor of the Floors sheet.", required=True, source="Floors", width=9),
        Column("room", "Room", "text", "Room or area.", width=14),
        Column("description", "Description", "text", "What it is.", width=26),
        Column("type", "Type", "text", "A type of the Catalogue: gives the sizes that are blank here.",
               source="Catalogue", width=24),
        Column("quantity", "Quantity", "count", "How many alike. A piece with a position on the plan needs a row of "
               "its own.", low=1, high=10000, default="1", width=9),
        Column("breadth", "Breadth", "number", "The shorter plan side, between the outer supports where they stand "
               "inside.", **_SIZE),
        Column("width", "Width", "number", "The longer plan side.", **_SIZE),
        Column("height", "Height", "number", "From the floor to the top.", **_SIZE),
        Column("axis", "Axis", "choice", "Building axis parallel to Breadth: the direction it topples.", choices=AXES,
               default="the worse of both", width=6),
        Column("anchored", "Anchored", "choice", "Fixed to wall or floor? unknown counts as free-standing; partly, too, unless Bracket capacity is typed "
               "and holds.",
               choices=ANCHORED, default="unknown", width=10),
        Column("friction", "Friction", "number", "Coefficient of friction with the floor: tells whether, and how far, "
               "the piece slides. It lowers no chance.", low=0.01, high=2, default="the building's, else no sliding", width=9),
        Column("x", "X", "number", "Centre of the piece on the plan.", **_METRES),
        Column("y", "Y", "number", "Centre of the piece on the plan.", **_METRES),
        Column("angle_deg", "Angle", "number", "Anticlockwise from X to Breadth; within 15 of X or Y it sets a blank "
               "Axis.", **_DEGREES),
        Column("route", "Route", "text", "Evacuation route it may block.", source="Routes",
               default="those that its position tells", width=10),
        Column("segment", "Segment", "text", "Part of that route.", default="every segment of that route on the floor"),
        Column("edge_distance", "Edge distance", "number", "From its nearest face to the edge of the route; negative "
               "if inside.", **_LENGTH, low=-100, high=100000.0, default="as the plan has it, else 0, at the edge"),
        Column("importance", "Importance", "choice", "What its fall would endanger. life safety comes first in the "
               "list of what to fix.", choices=IMPORTANCE),
        Column("centre_of_gravity", "Centre of gravity", "number", "Height of the centre of gravity above the floor, "
               "as a share of the piece's height, with what it holds. Above 50: top-heavy, falls sooner.", **_CENTRE,
               default="the Type's in the Catalogue, else 50", width=10),
        Column("against_wall", "Against wall", "flag", "yes: one of its long sides stands against a wall, so that it "
               "falls away from it. Which side that is follows from X, Y, Angle and the Outline of its room in Places.",
               choices=(YES, NO), default="not known: it may fall either way", width=10),
        Column("mobile", "Mobile", "flag", "yes: it stands on castors and rolls away before it overturns, so it is counted "
               "apart, but for slender pieces.", choices=(YES, NO), default="the Type's in the Catalogue, else not known",
               width=9),
        Column("weight", "Weight", "number", "With what it holds: gives the force on its bracket.",
               **_WEIGHT | {"usual_low": 1, "usual_high": 3000}, default="the Type's in the Catalogue, else estimated, assumed",
               width=9),
        Column("bracket_height", "Bracket height", "number", "Height above the floor at which its bracket holds it, at "
               "most its own.", **_LENGTH | {"unit": "cm", "imperial": "in", "low": 1, "high": 600},
               default="0.9 of its Height, assumed", width=9),
        Column("bracket_capacity", "Bracket capacity", "number", "Tension that its brackets hold together: the reports say whether they do.",
               quantity="force", unit="kN", imperial="lbf", low=0.01, high=200, default="not known", width=9),
        Column("photo", "Photo", "file", "Picture of the piece beside the workbook (PNG or JPEG), for the list of what "
               "to fix.", width=16),
        Column("source_id", "Source ID", "text", "Of the piece in the building model or handover file that it was imported "
               "from.", width=24),
        Column("sizes_from", "Sizes from", "choice", "Where Breadth, Width and Height come from. scan: a phone or "
               "tablet scanned the room, so they are less certain, and the simulation varies them more.",
               choices=SIZES_FROM, default="measured", width=10),
        Column("notes", "Notes", "text", "Anything else.", width=30),
    ),
)  # fmt: skip

GROUPS = (("Piece", "item"), ("Size", "breadth"), ("Fixing", "anchored"), ("Place", "x"), ("Details", "importance"))
"""Groups of the columns of Items, each with its first column; further columns up to the next group belong to it."""
WORKING_GROUP = "Working values"
"""The group of the columns that Excel computes, but for the class."""

PLACES_SHEET = Sheet(
    "Places", "table", False,
    "Rooms, doors, stairs and exits that routes lead between.",
    (
        Column("place", "Place", "text", "Its own name.", required=True, width=16),
        Column("floor", "Floor", "text", "A floor of the Floors sheet.", required=True, source="Floors"),
        Column("x", "X", "number", "Position on the plan: a segment is the straight line between those of its two "
               "places.", **_METRES),
        Column("y", "Y", "number", "Position on the plan.", **_METRES),
        Column("kind", "Kind", "choice", "What it is. A room needs a way to an exit, or to a stair.", choices=PLACES,
               default="a point that routes pass"),
        Column("outline", "Outline", "outline", "Corners of its walls on the plan, in order round it, as x y; x y; x y: "
               "by them it is known which way pieces against a wall fall.", quantity="length", unit="m", imperial="ft",
               default="its walls are not known", width=30),
    ),
)  # fmt: skip

ROUTES = Sheet(
    "Routes", "table", False,
    "Evacuation routes, one row a segment.",
    (
        Column("route", "Route", "text", "Name of the route; repeat it on each segment.", required=True, width=10),
        Column("segment", "Segment", "text", "Name of this part of it.", required=True, width=10),
        Column("floor", "Floor", "text", "A floor of the Floors sheet; leave it blank on stairs.", source="Floors",
               default="that of both places"),
        Column("start", "From", "text", "The place where it begins.", source="Places", width=16),
        Column("end", "To", "text", "The place where it ends.", source="Places", width=16),
        Column("room", "Room", "text", "The Room of Items that it runs through, several split by ; Placed pieces of "
               "other rooms do not count.", default="pieces of every room count, through walls as well", width=16),
        Column("clear_width", "Clear width", "number", "Width without furniture in it.", **_LENGTH, low=0.1, high=100,
               default="as Required width"),
        Column("required_width", "Required width", "number", "Width that must stay free.", **_LENGTH, low=0.1,
               high=100, default=f"{DEFAULT_WIDTH} m"),
        Column("occupants", "Occupants", "count", "People who leave by it.", low=0, high=100000,
               default="the width they need is not checked"),
        Column("notes", "Notes", "text", "Anything else.", width=30),
    ),
)  # fmt: skip

CATALOGUE = Sheet(
    "Catalogue", "table", False,
    "Types of furniture with their sizes and weights. Add your own; a duplicate type counts as an error.",
    (
        Column("type", "Type", "text", "Name of the type.", required=True, width=34),
        Column("breadth", "Breadth", "number", "The shorter plan side.", **_TYPE_SIZE),
        Column("width", "Width", "number", "The longer plan side.", **_TYPE_SIZE),
        Column("height", "Height", "number", "From the floor to the top.", **_TYPE_SIZE),
        Column("weight", "Weight", "number", "With what it holds.", **_WEIGHT, default="not known", width=9),
        Column("centre_of_gravity", "Centre of gravity", "number", "Height of the centre of gravity above the floor, "
               "as a share of the height.", **_CENTRE, default="50", width=10),
        Column("fix_by", "Fix by", "choice", "How pieces of this type can be fixed: for the list of what to fix.",
               choices=tuple(FIX_BY), default="wall bracket, or base angle where no wall is near", width=14),
        Column("mobile", "Mobile", "flag", "yes: pieces of this type stand on castors.", choices=(YES, NO),
               default="not known", width=9),
        Column("source", "Source", "text", "Where the values come from; assumed: no citable source prints them.",
               width=60),
    ),
)  # fmt: skip

COSTS = Sheet(
    "Costs", "table", False,
    "What it costs to fix a piece, for the schedule of the reports: no cost is assumed.",
    (
        Column("detail", "Detail", "text", "How a piece is fixed: choose from the list.", required=True,
               offered=tuple(str(one.title) for one in DETAILS.values()), width=34),
        Column("unit_cost", "Unit cost", "number", "Of fixing one piece, or of one fixing: see Per.", low=0, high=900_000,
               default="none: the schedule shows no cost", width=12),
        Column("currency", "Currency", "text", "ISO code or sign, such as EUR: the same in every row.",
               offered=tuple(dict.fromkeys(CURRENCIES.values())), default="the currency is not shown", width=10),
        Column("per", "Per", "choice", "What Unit cost is of: a piece, or each of its fixings.", choices=COST_PER,
               default=COST_PER[0], width=10),
        Column("source", "Source", "text", "Where the cost comes from: an offer, a price list.", width=60),
    ),
)  # fmt: skip

TEXTS = Sheet(
    "Text", "table", False,
    "Findings and judgement in your own words, for the report: one paragraph a row, shown in this order.",
    (
        Column("section", "Section", "choice", "Part of the report in which the paragraph stands.", choices=TEXT_SECTIONS,
               default=TEXT_SECTIONS[0], width=18),
        Column("text", "Text", "text", "The paragraph, as plain text.", required=True, width=110),
    ),
)  # fmt: skip

SHEETS = (BUILDING, FLOORS, ITEMS, PLACES_SHEET, ROUTES, CATALOGUE, COSTS, TEXTS)

PICTURE_FIELDS = frozenset({"photo", "plan", "plan_left", "plan_bottom", "plan_width", "plan_turn"})
"""Fields of tables that only reports and plans show: a row in which they are wrong is assessed without them."""

SHAKEN = ("ground_pga", "ground_pgv", "sds", "shakemap", "shaking")
"""Fields of Building that tell how the ground shakes; any one will do."""

HELP, LISTS, WALK_DOWN = "Help", "Lists", "Walk-down"
"""Sheets of the empty workbook that hold no data, the last a form to be printed; reading leaves them out."""

CLASS, CLASS_OR = "Class (formula)", "Class (OR)"
"""By the formula that the sheet Building chooses, and by the paper's."""

LIVE = ("B/H", "PFA used [g]", "FEMA P-58", "OR", "Kaneko-Hayashi", CLASS, CLASS_OR, "Can rock")
"""Columns of Items that Excel computes: the class next to the item, the others at the right; reading leaves them out."""

WORKINGS = (
    "Row in Floors", "Row in Catalogue", "Axis used", "PFV used [cm/s]", "Breadth used [cm]", "Height used [cm]",
)  # fmt: skip
"""Right of those, what they are computed from: each formula stays short, and its input can be seen."""
