"""The range of a column in the unit of its header, and what a number outside of it may mean in other units."""

from assess.i18n import Text, fill
from assess.units import GRAVITY, QUANTITIES
from assess.workbook.schema import Column

_PERCENT_OF_G = "%g"
_METRIC, _IMPERIAL = ("cm", "m", "mm", "m/s", "cm/s", "kg", "kN", "N"), ("in", "ft", "in/s", "lb", "lbf")
_ACCELERATIONS = (_PERCENT_OF_G, "m/s2", "cm/s2", "g")
_MOST_READINGS = 2


def _scale(column: Column, unit: str) -> float:
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
            "{number:.10g} {other} = {converted:.4g} {unit}",
            number=number, other=other, converted=number * _scale(column, other) / _scale(column, unit), unit=unit,
        )
        for other in _list_units(column, number, unit)
    ]  # fmt: skip
    if len(readings) > 1:
        return fill("Did you mean {one}, or {other}?", one=readings[0], other=readings[1])
    if readings:
        return fill("Did you mean {name}?", name=readings[0])
    return fill("Check the number and the unit in the header.")


def _list_units(column: Column, number: float, unit: str) -> list[str]:
    systems: tuple[tuple[str, ...], ...] = (_IMPERIAL, _METRIC) if unit in _IMPERIAL else (_METRIC, _IMPERIAL)
    if column.quantity == "acceleration":
        systems = (_ACCELERATIONS,)
    known = {*QUANTITIES.get(column.quantity, {}), _PERCENT_OF_G}
    for system in systems:
        others = [other for other in system if other != unit and other in known]
        usual = [one for one in others if is_within(column, number, one) and not is_unusual(column, number, one)]
        if usual:
            return usual[:_MOST_READINGS]
    return []
