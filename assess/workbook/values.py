"""What a cell means: its content as a value of its column in SI, or what is wrong with it in words.

`cell_reader` gives what reads the cells of a column. A cell that is typed otherwise than its column asks for is first
taken as the cell that was meant: `understand` takes what can be read in one way only, and says so in a note; what can
be read in two ways is an error that offers both. Cells that are typed as asked for, numbers above all, skip that.
"""

import datetime
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache, partial
from itertools import combinations, product

from assess.errors import InputError
from assess.i18n import LANGUAGES, Text, fill, find_language, nfill
from assess.model import Outline
from assess.units import GRAVITY, QUANTITIES, ROUNDING, read_unit
from assess.workbook.habits import SHOWN, CellError, Remark, clean, note, shorten
from assess.workbook.names import DASHES, ENGLISH, find_choice, find_near, plain, translate_choices
from assess.workbook.open import UNSAVED, Percent
from assess.workbook.schema import CURRENCIES, NO, YES, Column

CellReader = Callable[[object], tuple[object, tuple[Remark, ...]]]
"""Returns a cell's value in SI, and what is remarkable about it; raises CellError."""
ERRORS = frozenset({"#DIV/0!", "#N/A", "#NAME?", "#NULL!", "#NUM!", "#REF!", "#VALUE!", "#GETTING_DATA", "#SPILL!"})
_TIMES = (datetime.datetime, datetime.date, datetime.time)
_WRITE_OUTLINE = fill(
    "Write the corners in order round the room, x and y with a space between and a point as decimal sign: "
    "0 0; 6.5 0; 6.5 4; 0 4."
)


def is_blank(value: object) -> bool:
    """Tell whether a cell holds nothing to read."""
    return value is None or (isinstance(value, str) and not value.strip())


def read_text(value: object) -> str:
    """Return a cell's content as text: whole numbers without a decimal point, dates as ISO dates."""
    if isinstance(value, bool):
        return str(value).upper()
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    if isinstance(value, _TIMES):
        return value.isoformat()
    return clean(str(value))[0].strip()


@lru_cache(maxsize=512)
def cell_reader(column: Column, unit: str) -> CellReader:
    """Return what reads the cells of a column whose header has a unit; a blank one, or one of unseen marks, is None.

    What was read is kept: the same values stand in row after row, book after book.
    """
    read_new = partial(_read_cell, column, unit)
    read_known = lru_cache(maxsize=1024, typed=True)(read_new)

    def read(value: object) -> tuple[object, tuple[Remark, ...]]:
        is_rare = (isinstance(value, str) and len(value) > SHOWN) or value == 0  # 0 and -0 are equal, not the same
        return (read_new if is_rare else read_known)(value)

    return read


def _read_cell(column: Column, unit: str, value: object) -> tuple[object, tuple[Remark, ...]]:
    meant, remarks = value, list[Remark]()
    if not (type(value) is float or type(value) is int):
        if is_blank(value):
            return None, ()
        if value is UNSAVED:
            raise CellError(fill("the formula has no saved value."), fill("Open the workbook in Excel and save it."))
        if column.kind not in ("number", "count") and isinstance(value, str) and value.strip() in ERRORS:
            raise CellError(fill("{label} holds the error {error}.", label=column.label, error=value.strip()),
                            fill("Correct the formula in the cell."))  # fmt: skip
        if not is_free(column):
            meant, remark = understand(column, value, unit)
            remarks += [remark] if remark else []
    found = READERS[column.kind](column, meant, unit)
    if column.kind == "number" and isinstance(meant, int | float) and is_unusual(column, float(meant), unit):
        usual = span(column.usual_low, column.usual_high, column, unit)
        message = fill("{column} is {number:g} {unit}, usual is {usual}.", column=fill(column.label), number=meant,
                       unit=unit, usual=usual)  # fmt: skip
        remarks.append(Remark(message, fill("Check the number and the unit.")))
    elif isinstance(value, str) and column.kind in ("text", "file", "records") and (removed := clean(value)[1]):
        message = nfill("{n} control or direction character in {column} was taken out.",
                        "{n:,} control or direction characters in {column} were taken out.", removed,
                        column=fill(column.label))  # fmt: skip
        remarks.append(Remark(message))
    return found, tuple(remarks)


def _read_plain(column: Column, value: object, unit: str) -> str | None:
    return read_text(value) or None


def _read_number(column: Column, value: object, unit: str) -> float:
    number = _read_typed(column.label, value, unit)
    if not is_within(column, number, unit):
        expected = span(column.low, column.high, column, unit)
        typed = fill("{number:g}{unit}", number=number, unit=f" {unit}" if unit else "")
        message = fill("{label} is {typed}, expected {expected}.", label=column.label, typed=typed, expected=expected)
        raise CellError(message, find_slip(column, number, unit))
    if isinstance(value, Money):
        return value
    return number * QUANTITIES[column.quantity][unit] if column.quantity else number


def _read_typed(label: str, value: object, unit: str) -> float:
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    named = {"label": label, "text": shorten(value), "unit": f" [{unit}]" if unit else ""}
    if isinstance(value, (*_TIMES, datetime.timedelta)):
        message = fill("{label} holds a date or time ({value}), expected a number{unit}.", value=value, **named)
        fix = fill("Set the cell's format to General and type the number again.")
    elif not isinstance(value, str):
        shown = str(value).upper() if isinstance(value, bool) else shorten(value)
        message = fill("{label} is {value}, expected a number{unit}.", value=shown, **named)
        fix = fill("Type the number.")
    elif value.strip() in ERRORS:
        message = fill("{label} holds the error {error}.", label=label, error=value.strip())
        fix = fill("Correct the formula in the cell, or type the number.")
    else:
        message = fill("{label} is the text {text}, expected a number{unit}.", **named)
        fix = fill("Type the number alone.")
    raise CellError(message, fix)


def _read_count(column: Column, value: object, unit: str) -> int:
    number = _read_typed(column.label, value, "")
    low, high = int(column.low or 0), int(column.high or 0)
    if number != int(number) or not low <= number <= high:
        raise CellError(
            fill("{label} is {number:g}, expected a whole number from {low} to {high}.",
                 label=column.label, number=number, low=str(low), high=str(high)),
            fill("Delete the row if the piece is not there.") if number == 0 else fill("Type a whole number."),
        )  # fmt: skip
    return int(number)


def _read_choice(column: Column, value: object, unit: str) -> str:
    text = read_text(value)
    if (choice := find_choice(text, column.choices)) is not None:
        return choice
    own, near = translate_choices(column.choices, column.language), find_near_choice(column, text)
    mark = "; " if any("," in one for one in own) else ", "
    raise CellError(
        fill("{label} is {text}, expected one of: {choices}.",
             label=column.label, text=shorten(text), choices=mark.join(own)),
        fill("Did you mean {name}?", name=near) if near else fill("Choose from the list."),
    )  # fmt: skip


def find_near_choice(column: Column, text: str) -> str | None:
    """Return the choice that a text is likely a slip of, in English or the column's language; None if none is near."""
    words = {plain(word): word for word in (*column.choices, *translate_choices(column.choices, column.language))}
    return words.get(find_near(plain(text), words) or "")


def _read_language(column: Column, value: object, unit: str) -> str:
    try:
        code = find_language(read_text(value))
    except InputError:
        return _read_choice(column, value, unit)
    return next(choice for choice in column.choices if find_language(choice) == code)


def _read_outline(column: Column, value: object, unit: str) -> Outline:
    try:
        return parse_outline(read_text(value), QUANTITIES[column.quantity][unit])
    except CellError as error:
        fault = fill("{label}: {fault}", label=column.label, fault=error.message)
        raise CellError(fault, _WRITE_OUTLINE) from None


READERS: Mapping[str, Callable[[Column, object, str], object]] = {
    "text": _read_plain,
    "file": _read_plain,
    "records": _read_plain,
    "number": _read_number,
    "count": _read_count,
    "choice": _read_choice,
    "flag": lambda column, value, unit: value if isinstance(value, bool) else _read_choice(column, value, unit) == YES,
    "language": _read_language,
    "date": lambda column, value, unit: read_text(value.date() if isinstance(value, datetime.datetime) else value),
    "outline": _read_outline,
}


# ---------------------------------------------------------------- outlines of places

LEAST_CORNERS, MOST_CORNERS = 3, 200
"""Corners of an outline."""
FARTHEST = 1e5
"""Largest coordinate [m], as of positions."""
SAME = 1e-3
"""Distance up to which two corners are the same [m]."""
_COORDINATE = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+")
_MAYBE_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2},\d{3}")
Corner = tuple[float, float]


def parse_outline(text: str, factor: float) -> Outline:
    """Return the corners of an outline, ``x y; x y; x y`` [m by `factor`]; its last corner may repeat the first.

    The comma of ``6,5 0`` is a decimal one. Raises CellError if a corner is not two numbers or can be read in two ways
    (``1,500 0``), two that follow each other are the same, there are fewer than three or more than 200, or its sides
    cross or touch each other.
    """
    corners: list[Corner] = []
    parts = (part.strip() for part in text.replace("\n", ";").split(";"))
    for number, typed in enumerate(filter(None, parts), 1):
        part = typed.split()
        shown, count = " ".join(part)[:40], len(part)
        if count == 2 and all(_COORDINATE.fullmatch(one) or _DECIMAL_COMMA.fullmatch(one) for one in part):
            if any(_MAYBE_THOUSANDS.fullmatch(one) for one in part):
                raise CellError(
                    fill("corner {n} is '{text}', which can be read in two ways: write decimals with a point.",
                         n=number, text=shown)
                )  # fmt: skip
            part = [one.replace(",", ".") for one in part]
        if count != 2 or not all(_COORDINATE.fullmatch(one) for one in part):
            raise CellError(fill("corner {n} is '{text}', expected two numbers, x and y.", n=number, text=shown))
        x, y = (float(one) * factor for one in part)
        if max(abs(x), abs(y)) > FARTHEST:
            raise CellError(fill("corner {n} lies more than {most:,} km away.", n=number, most=int(FARTHEST / 1000)))
        corners.append((x, y))
    if len(corners) > 1 and math.dist(corners[0], corners[-1]) <= SAME:
        corners.pop()
    if not LEAST_CORNERS <= len(corners) <= MOST_CORNERS:
        raise CellError(nfill(
            "it has {n:,} corner, expected {least} to {most}.",
            "it has {n:,} corners, expected {least} to {most}.",
            len(corners), least=LEAST_CORNERS, most=MOST_CORNERS,
        ))  # fmt: skip
    for at, corner in enumerate(corners):
        if math.dist(corner, corners[at - 1]) <= SAME:
            raise CellError(fill("corner {n} is the same as the one before it.", n=at + 1))
    sides = list(zip(corners, [*corners[1:], corners[0]], strict=True))
    for one, other in combinations(range(len(sides)), 2):
        if _cross(sides, one, other):
            names = {"one": one + 1, "other": other + 1}
            raise CellError(fill("its sides {one} and {other} cross or touch each other.", **names))
    return tuple(corners)


def _cross(sides: list[tuple[Corner, Corner]], one: int, other: int) -> bool:
    """Return whether two sides meet other than at the corner that they share, or fold back there."""
    if other - one == 1 or (one == 0 and other == len(sides) - 1):
        (a, b), (_, c) = (sides[at] for at in ((one, other) if other - one == 1 else (other, one)))
        along = (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1])
        return along > 0 and _turn(b, a, c) == 0
    (a, b), (c, d) = sides[one], sides[other]
    ends = ((a, b, c), (a, b, d), (c, d, a), (c, d, b))
    turns = [_turn(*end) for end in ends]
    if turns[0] * turns[1] < 0 and turns[2] * turns[3] < 0:
        return True
    return any(
        turn == 0 and all(min(x, y) - SAME <= at <= max(x, y) + SAME for x, y, at in zip(*end, strict=True))
        for turn, end in zip(turns, ends, strict=True)
    )


def _turn(a: Corner, b: Corner, c: Corner) -> float:
    """Return twice the area of a triangle, 0 where its corners lie on one line."""
    cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return 0.0 if abs(cross) <= ROUNDING * math.dist(a, b) * math.dist(a, c) else cross


# ---------------------------------------------------------------- what a person means

LONGEST = 60
"""Characters of a text that may be a number or a date."""
INCHES_OF_A_FOOT = 12
_WIDE = {at: at - 0xFEE0 for at in range(0xFF01, 0xFF5F)}
_PLAIN_SIGNS: dict[int, int | str] = {**_WIDE, **DASHES, **dict.fromkeys(map(ord, "\u2019\u02bc"), "'")}
_NUMBER = re.compile(
    r"(?P<sign>[-+]?) ?(?P<digits>\d[\d.,' ]*|[.,]\d+)(?P<power>[eE][-+]?\d{1,3})?(?P<unit>.*)", re.ASCII
)
_PARTS = re.compile(
    r"(?P<sign>[-+]?) ?(?:(?P<metres>\d+) ?m ?(?P<cents>\d\d|\d(?= ?cm))(?: ?cm)?|"
    r"(?P<feet>\d+) ?(?:'|ft\.?|foot|feet)(?: ?-? ?(?P<inches>\d+(?:[.,]\d+)?) ?(?:\"|''|in\.?|inch|inches))?"
    r"|(?P<more_feet>\d+[.,]\d{1,2}) ?'|(?P<more_inches>\d+(?:[.,]\d{1,2})?) ?(?:\"|''))",
    re.ASCII | re.IGNORECASE,
)
"""Metres and centimetres, as 1m80; feet and inches, and either alone with its sign."""
_PRIMES = {ord("\u2032"): "'", **dict.fromkeys(map(ord, "\u2033\u201d\u201c"), '"')}
_PLAIN = re.compile(r"\d+(?:[.,]\d*)?|[.,]\d+", re.ASCII)
_GROUPED = re.compile(
    r"([1-9]\d{0,2}(?P<mark>[ ',.])\d{3}(?:(?P=mark)\d{3})*)(?:(?P<point>[.,])(?P<rest>\d*))?", re.ASCII
)
_ARABIC = re.compile(r"MMI ?(\d{1,2})(|,.*)", re.ASCII | re.IGNORECASE)
_ROMAN = ("", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X", "XI", "XII")


def straighten(text: str) -> str:
    """Return a text with plain spaces, dashes, apostrophes and digits in place of those that look alike."""
    return " ".join(text.translate(_PLAIN_SIGNS).split())


def is_free(column: Column) -> bool:
    """Tell whether a column takes any text as it is: one that other cells compare with does not."""
    return column.kind == "text" and (column.name == "text" or not (column.required or column.source))


def understand(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    """Return what belongs into a cell, and the note on that where it is not what the cell holds, `value`.

    That is a number in the unit of the header, a choice, a date or a name. Raises CellError if the cell can be read in
    two ways, or holds a day that does not exist.
    """
    take = _TAKERS.get(column.kind)
    return take(column, value, unit) if take else (value, None)


def _name_column(column: Column, unit: str = "") -> Text:
    label = fill(column.label)
    return fill("{label} [{unit}]", label=label, unit=unit) if unit else label


# ---------------------------------------------------------------- the range of a column

_PERCENT_OF_G = "%g"
_METRIC, _IMPERIAL = ("cm", "m", "mm", "m/s", "cm/s", "kg", "kN", "N"), ("in", "ft", "in/s", "lb", "lbf")
_ACCELERATIONS = (_PERCENT_OF_G, "m/s2", "cm/s2", "g")


def _scale(column: Column, unit: str) -> float:
    """Return the factor from a unit to that of the column's range."""
    if unit == _PERCENT_OF_G:
        return 0.01 * GRAVITY / column.factor
    return QUANTITIES[column.quantity][unit] / column.factor if column.quantity else 1.0


def is_within(column: Column, number: float, unit: str) -> bool:
    """Tell whether a number may stand in a column."""
    value = number * _scale(column, unit)
    slack = 1e-9 * abs(value)
    return (column.low is None or value >= column.low - slack) and (column.high is None or value <= column.high + slack)


def is_unusual(column: Column, number: float, unit: str) -> bool:
    """Tell whether a number lies outside what is usual in a column."""
    value = number * _scale(column, unit)
    return (column.usual_low is not None and value < column.usual_low) or (
        column.usual_high is not None and value > column.usual_high
    )


def span(low: float | None, high: float | None, column: Column, unit: str) -> Text:
    """Return a range in words, in the header's unit."""
    scale, suffix = _scale(column, unit), f" {unit}" if unit else ""
    least, most = (float(f"{(limit or 0) / scale:.4g}") for limit in (low, high))
    if low is not None and high is not None:
        return fill("{low:g} to {high:g}{unit}", low=least, high=most, unit=suffix)
    if low is not None:
        return fill("at least {low:g}{unit}", low=least, unit=suffix)
    return fill("at most {high:g}{unit}", high=most, unit=suffix)


def find_slip(column: Column, number: float, unit: str) -> Text | str:
    """Return what a number outside the range may mean: the units in which it would be usual, with what it is then."""
    if number == 0:
        return fill("Clear the cell if it is not known.")
    if number < 0:
        return fill("Remove the minus sign.") if (column.low or 0) >= 0 else ""
    if unit == "%" and number < 1 and is_within(column, 100 * number, unit):
        return fill("Write {percent:g} for {percent:g} %.", percent=100 * number)
    if (
        not unit
        and column.kind == "number"
        and number > 3 * (column.high or number)
        and is_within(column, number / 100, unit)
    ):
        return fill("Did you mean {number:g}?", number=number / 100)
    readings = [
        fill(
            "{number:.10g} {other} = {converted:.4g} {unit}", number=number, other=other, converted=converted, unit=unit
        )
        for other, converted in list_readings(column, number, unit)
    ]
    if len(readings) > 1:
        return fill("Did you mean {one}, or {other}?", one=readings[0], other=readings[1])
    if readings:
        return fill("Did you mean {name}?", name=readings[0])
    return fill("Check the number and the unit in the header.")


def list_readings(column: Column, number: float, unit: str) -> list[tuple[str, float]]:
    """Return the units in which a number outside the range would be usual, and what it is then in the header's unit."""
    systems: tuple[tuple[str, ...], ...] = (_IMPERIAL, _METRIC) if unit in _IMPERIAL else (_METRIC, _IMPERIAL)
    if column.quantity == "acceleration":
        systems = (_ACCELERATIONS,)
    known = {*QUANTITIES.get(column.quantity, {}), _PERCENT_OF_G} - {unit}
    for system in systems:
        readings = [
            (other, number * _scale(column, other) / _scale(column, unit))
            for other in system
            if other in known and is_within(column, number, other) and not is_unusual(column, number, other)
        ]
        if readings:
            return readings
    return []


# ---------------------------------------------------------------- numbers


class Money(float):
    """An amount that names its currency, by its ISO code, in the same cell."""

    currency: str


_MONEY = re.compile(r"(\D*?) ?(-?[\d.,](?:[\d.,' ]*\d)?)(?:[.,]-?)? ?(\D*)", re.ASCII)


def find_currency(text: str) -> str:
    """Return the ISO code of a currency by its code or sign, "" for what is neither."""
    from babel.numbers import is_currency

    sign, code = text.strip().rstrip("."), text.strip().upper()
    return CURRENCIES.get(sign) or (code if is_currency(code) else "")


def _take_money(column: Column, value: str) -> tuple[object, Remark | None] | None:
    """Return an amount with its currency, such as € 85,00; None for a text that has another form."""
    match = _MONEY.fullmatch(straighten(value).removeprefix("'").strip())
    named = [one for one in (match[1], match[3]) if one] if match else []
    if match is None or not named:
        return None
    usual = {*CURRENCIES, *CURRENCIES.values()}  # of the others, which may be words, the code as it is written
    codes = [find_currency(one) if one.isupper() or {one.strip(), one.strip().upper()} & usual else "" for one in named]
    if len(codes) > 1 and all(codes):
        fault = fill("{label} is {text}: it names a currency twice.", label=column.label, text=shorten(value))
        raise CellError(fault, fill("Write the currency once."))
    amount, _ = _take_number(column, match[2], "")
    if len(codes) > 1 or not codes[0] or not isinstance(amount, int | float):
        return None
    money = Money(amount)
    money.currency = codes[0]
    shown = fill("{number:.12g} {currency}", number=amount, currency=codes[0])
    return money, replace(note("unit", _name_column(column), shorten(value), shown, amount), value=None)


def _take_number(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    if isinstance(value, Percent) and column.quantity == "share" and is_within(column, 100 * value, unit):
        shown = fill("{number:g}{unit}", number=100 * value, unit=f" {unit}")
        found = note("percent", _name_column(column, unit), f"{value:.3%}", shown, 100 * value)
        return 100 * value, replace(found, value=None)
    if not isinstance(value, str) or len(value) > LONGEST:
        return value, None
    if column.name == "unit_cost" and (money := _take_money(column, value)) is not None:
        return money
    if (length := _read_parts(column, value, unit)) is not None:
        typed = fill("{number:g}{unit}", number=length, unit=f" {unit}")
        return length, note("unit", _name_column(column, unit), shorten(value), typed, length)
    match = _NUMBER.fullmatch(straighten(value).removeprefix("'").lstrip())  # the sign by which programs enter a text
    factor = _find_factor(match["unit"].strip(), column, unit) if match else None
    if match is None or factor is None:
        return value, None
    digits, suffix = match["digits"].rstrip(), f" {unit}" if unit else ""
    sign_and_power = float(f"1{match['power'] or 'e0'}") * (-1 if match["sign"] == "-" else 1)
    readings = [one * sign_and_power for one in read_digits(digits)]
    if factor != 1:  # without the noise of binary fractions
        readings = [float(f"{one * factor:.12g}") for one in readings]
    if len(readings) == 2:
        one, other = (fill("{number:.10g}{unit}", number=number, unit=suffix) for number in readings)
        message = fill("{label} is the text {text}, which can be read as {one} or as {other}.", label=column.label,
                       text=shorten(value), one=one, other=other)  # fmt: skip
        raise CellError(message, fill("Type the number without a separator between thousands."))
    if not readings or not math.isfinite(readings[0]):
        return value, None
    if named := match["unit"].strip():
        habit = "percent" if named.startswith("%") and column.quantity != "share" else "unit"
    elif _GROUPED.fullmatch(digits):
        habit = "thousands"
    elif "," in digits:
        habit = "comma"
    else:
        habit = "text" if value.translate(_PLAIN_SIGNS) == value else "signs"
    typed = fill("{number:g}{unit}", number=readings[0], unit=suffix)
    return readings[0], note(habit, _name_column(column, unit), shorten(value), typed, readings[0])


def is_converted(column: Column, value: object, unit: str) -> bool:
    """Tell whether a text names another unit than the header, so that the number that it means was computed."""
    if not isinstance(value, str) or len(value) > LONGEST or column.kind not in ("number", "count"):
        return False
    match = _NUMBER.fullmatch(straighten(value).removeprefix("'").lstrip())
    factor = _find_factor(match["unit"].strip(), column, unit) if match else None
    return factor not in (None, 1.0) or _read_parts(column, value, unit) is not None


def _read_parts(column: Column, value: str, unit: str) -> float | None:
    if column.quantity != "length":
        return None
    match = _PARTS.fullmatch(straighten(value.translate(_PRIMES)))
    if match is None:
        return None
    feet, inches = (
        float((match[name] or match[f"more_{name}"] or "0").replace(",", ".")) for name in ("feet", "inches")
    )
    if match["inches"] and inches >= INCHES_OF_A_FOOT:  # 1'800" may be one number
        return None
    known = QUANTITIES["length"]
    metric = int(match["metres"] or 0) + int(match["cents"] or 0) / 100
    metres = (metric + feet * known["ft"] + inches * known["in"]) * (-1 if match["sign"] == "-" else 1)
    return float(f"{metres / known[unit]:.12g}")


def read_digits(digits: str) -> list[float]:
    """Return the ways to read digits with separators: two for one before exactly three digits, except after 0."""
    found = [float(digits.replace(",", "."))] if _PLAIN.fullmatch(digits) else []
    match = _GROUPED.fullmatch(digits)
    if match and match["point"] != match["mark"]:
        found.append(float(f"{re.sub(r'[ .,]', '', match[1].replace(chr(39), ''))}.{match['rest'] or 0}"))
    return found


def _find_factor(typed: str, column: Column, unit: str) -> float | None:
    if not typed:
        return 1.0
    spelt, known = read_unit(typed.rstrip(".")), QUANTITIES.get(column.quantity, {})
    if column.quantity == "acceleration" and spelt in ("%", "%g"):
        return 0.01 * GRAVITY / known[unit]
    if not column.quantity:
        return 0.01 if spelt == "%" and column.kind == "number" else None
    if spelt not in known:
        return None
    return 1.0 if spelt == unit else known[spelt] / known[unit]


# ---------------------------------------------------------------- choices


def _take_choice(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    if isinstance(value, bool):
        if column.kind == "flag" or not {YES, NO} <= {*column.choices}:
            return value, None
        choice = YES if value else NO
        word = translate_choices((choice,), column.language)[0]
    elif not isinstance(value, str):
        return value, None
    else:
        found, word = find_meant(value, column.choices, column.language)
        if found is None or not word:
            return value, None
        choice = found
    return choice, note("choice", _name_column(column), shorten(value), word, word)


@lru_cache(maxsize=4096)  # the same choices stand in row after row
def find_meant(text: str, choices: tuple[str, ...], language: str) -> tuple[str | None, str]:
    """Return the choice that a text means, in English, and the word that belongs into the cell.

    The word is in the language of the column, and "" where the cell holds that choice as it is written in any
    language. Understood are letter case, spaces and accents left out, the first letters of one choice alone (of these
    the words for yes and no come first), and an intensity in Arabic numerals: ``MMI 7``.
    """
    typed, short, full = text.casefold(), plain(text), text
    if any(typed == choice.casefold() for choice in choices):
        return find_choice(text, choices), ""
    match = _ARABIC.fullmatch(straighten(text))
    if match and int(match[1]) < len(_ROMAN):
        full = f"MMI {_ROMAN[int(match[1])]}{match[2]}"
    choice = find_choice(full, choices)
    if choice is None and short:
        for among, code in product(((YES, NO), choices), dict.fromkeys((language, ENGLISH, *LANGUAGES))):
            words = zip(choices, translate_choices(choices, code), strict=True)
            found = [one for one, word in words if one in among and plain(word).startswith(short)]
            if found:
                choice = found[0] if len(found) == 1 else None
                break
    written = (word.casefold() for code in LANGUAGES for word in translate_choices(choices, code))
    if choice is None or typed in written:
        return choice, ""
    return choice, translate_choices(choices, language)[choices.index(choice)]


# ---------------------------------------------------------------- dates and names


def _take_date(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    if not isinstance(value, str):
        return value, None
    text = straighten(value[:LONGEST])
    date, month = _read_date(column.label, text, shorten(value)), _MONTH.fullmatch(text)
    if date is None and (month is None or (month[1] and not _find_month(month[1]))):
        message = fill("{label} is {text}, which is not read as a date; it is shown as typed.",
                       label=_name_column(column), text=shorten(value))  # fmt: skip
        return value, Remark(message, AS_ISO)
    if date is None or date == value:
        return value, None
    return date, note("date", _name_column(column), shorten(value), date, date)


def _take_name(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    """Take stray spaces out of a name that other cells compare with."""
    if not isinstance(value, str):
        return value, None
    name = " ".join(value.split())
    if name == value:
        return value, None
    return name, note("spaces", _name_column(column), shorten(value), shorten(name), name)


_Taker = Callable[[Column, object, str], tuple[object, Remark | None]]
_TAKERS: Mapping[str, _Taker] = {
    "number": _take_number,
    "count": _take_number,
    "choice": _take_choice,
    "flag": _take_choice,
    "date": _take_date,
    "text": _take_name,
}


_MONTHS = (
    ("january", "gennaio"), ("february", "febbraio"), ("march", "marzo"), ("april", "aprile"), ("may", "maggio"),
    ("june", "giugno"), ("july", "luglio"), ("august", "agosto"), ("september", "settembre"), ("october", "ottobre"),
    ("november", "novembre"), ("december", "dicembre"),
)  # fmt: skip
_ISO = re.compile(r"(\d{4})([-/.])(\d{1,2})\2(\d{1,2})(?:[T ]00:00(?::00)?)?", re.ASCII)
_NUMBERS = re.compile(r"(\d{1,2}) ?([-/.]) ?(\d{1,2}) ?\2 ?(\d{4})", re.ASCII)
_SHORT_YEAR = re.compile(r"\d{1,2} ?([-/.]) ?\d{1,2} ?\1 ?\d{2}", re.ASCII)
_DAY_FIRST = re.compile(r"(\d{1,2})(?:st|nd|rd|th|[.º°])?[ -]*([^\W\d_]{3,12})[., -]*(\d{4})", re.ASCII)
_MONTH_FIRST = re.compile(r"([^\W\d_]{3,12})[. -]*(\d{1,2})(?:st|nd|rd|th)?[, -]+(\d{4})", re.ASCII)
_MONTH = re.compile(r"(?:([^\W\d_]{3,12})\.?,? |\d{1,2}/|)\d{4}|\d{4}-\d{1,2}", re.ASCII)
"""A month and its year, such as March 2026, or a year: a date without its day."""
AS_ISO = fill("Write it as year-month-day: 2026-12-31.")


def _read_date(label: str, text: str, shown: str) -> str | None:
    """Return a date as an ISO date, None for a text that is not written as one.

    Understood are 2026-12-31, 31/12/2026, 12.31.2026, 31 Dec 2026, December 31, 2026 and 31 dicembre 2026. CellError if
    there is no such day, or the order of day and month cannot be known.
    """
    if _SHORT_YEAR.fullmatch(text):
        message = fill("{label} is {text}: the year has two digits.", label=label, text=shown)
        raise CellError(message, AS_ISO)
    found: list[tuple[int, int, int]] = []
    if match := _ISO.fullmatch(text):
        found = [(int(match[1]), int(match[3]), int(match[4]))]
    elif match := _NUMBERS.fullmatch(text):
        first, second, year = int(match[1]), int(match[3]), int(match[4])
        found = [(year, second, first)] + ([(year, first, second)] if first != second else [])
    elif (match := _DAY_FIRST.fullmatch(text)) and (month := _find_month(match[2])):
        found = [(int(match[3]), month, int(match[1]))]
    elif (match := _MONTH_FIRST.fullmatch(text)) and (month := _find_month(match[1])):
        found = [(int(match[3]), month, int(match[2]))]
    else:
        return None
    days = [day for reading in found if isinstance(day := _build(*reading), datetime.date)]
    if not days:
        why = _build(*min(found, key=lambda reading: not 1 <= reading[1] <= 12))
        raise CellError(
            fill("{label} is {text}, which is not a date: {why}.", label=label, text=shown, why=why), AS_ISO
        )
    if len(days) > 1:
        one, other = (day.isoformat() for day in days)
        message = fill("{label} is {text}, which can be read as {one} or as {other}.", label=label, text=shown, one=one,
                       other=other)  # fmt: skip
        raise CellError(message, fill("Write {one} or {other}.", one=one, other=other))
    return days[0].isoformat()


def _find_month(word: str) -> int:
    typed = word.casefold()
    return next((at for at, names in enumerate(_MONTHS, 1) if any(one.startswith(typed) for one in names)), 0)


def _build(year: int, month: int, day: int) -> datetime.date | Text:
    try:
        return datetime.date(year, month, day)
    except ValueError:
        pass
    if not 1 <= month <= 12:
        return fill("there is no month {month}", month=str(month))
    try:
        last = datetime.date(year + month // 12, month % 12 + 1, 1) - datetime.timedelta(days=1)
    except ValueError:  # before the year 1, or after the year 9999
        return fill("there is no year {year}", year=str(year))
    return fill("month {month} of {year} has {last} days", month=str(month), year=str(year), last=str(last.day))
