"""What the sheets of the empty workbook say beside the columns, and the sheet Help before the list of them."""

TITLE = "Furniture in earthquakes: how to fill this in"

HEADS = ("Sheet", "Column", "What to fill in")

FIRST_LINES = (
    "1. Building: what you know of the building and the earthquake. Every line may stay blank.",
    "2. Floors: one row a floor with furniture. Give its peak floor acceleration (PFA), or name the file of a recorded "
    "motion that lies beside this workbook. Where you know neither, give the floor's Elevation: its motion is then "
    "interpolated between the floors above and below, which may be lower than the truth, or worked out from Ground "
    "PGA in Building.",
    "3. Items: one row a piece, or a row for several alike. Choose a Type, and its sizes come from the Catalogue; or "
    "type the sizes. The columns at the right show the risk class at once.",
    "4. Places and Routes are for evacuation routes and may stay empty.",
    "5. Check it with: assess check FILE.xlsx. Make the report with: assess run FILE.xlsx.",
    "The unit in the bracket of a header is the unit of the column: write Height [mm] or Height [in], and numbers "
    "below are read as such. Lengths: mm, cm, m, in, ft; accelerations: g, m/s2, cm/s2, gal; velocities: cm/s, m/s, "
    "in/s.",
    "Columns may stand in any order, and you may add your own: they are kept and come back in the Excel report. "
    "Columns marked * are required.",
    "The classes: ○ low below 3 %, ◇ medium below 30 %, ▲ high below 70 %, ■ very high from 70 % chance of overturning "
    "in this scenario, not per year. A * behind a class: outside the range in which the formula was checked by tests.",
)

LISTS_NOTE = "Lists, units and helper columns for the drop-downs and live columns. Please leave this sheet as it is."

CLASS_NOTE = (
    "Computed by Excel from this row. {mark} behind a class: outside the range in which the formula was checked "
    "by tests."
)

FOOTER = "&C&A, page &P of &N"
"""In the spreadsheet program's own signs: centred, the sheet's name, its page and the number of pages."""
