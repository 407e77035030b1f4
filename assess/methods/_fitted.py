"""A model that a study fitted as one more method: its TOML file, written and read, every fault named by its key."""

import hashlib
import json
import re
import tomllib
import unicodedata
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from assess.errors import InputError
from assess.i18n import Text, fill, join
from assess.methods._fitted_model import PREFIX, QUANTITIES, Fitted, Polynomial, Probit, build_method
from assess.methods._method import FittedOn, Method, Range

__all__ = ["Fitted", "Polynomial", "Probit", "parse_model", "read_model", "write_model"]

FORMAT = 1
"""Version of the file."""
MOST_BYTES = 65_536
MOST_TERMS, MOST_POWER = 16, 3
LARGEST = 1e30
"""Of a coefficient: no sum of terms overflows."""
LONGEST_TITLE, LONGEST_DATA = 60, 120

TOP = ("format", "key", "title", "kind", "fitted_on", "range", "errors")
ERRORS = {"leave_one_out_rmse": "error", "leave_one_out_standard_error": "spread", "constant_rmse": "constant"}
"""Keys of the errors, and their names in `FittedOn`."""
KINDS = {"polynomial": ("base", "terms"), "probit": ("b0", "b1", "b2")}
KEY = re.compile(rf"{PREFIX}[a-z0-9_]{{1,40}}(?<!_raw)(?<!_flags)", re.ASCII)
"""The endings are those of columns that stand beside a method's value."""


def write_model(model: Fitted) -> str:
    """Return the file of a model.

    Raises
    ------
    InputError
        If it holds what could not be read back, as a number that is not finite.
    """
    top = {"key": model.key, "title": model.title, "kind": model.kind, "fitted_on": model.fitted.data}
    lines = [
        "# A model of the chance of overturning, fitted by assess. `assess run` shows it next to the methods.",
        f"format = {FORMAT}",
        *(f"{name} = {json.dumps(text, ensure_ascii=False)}" for name, text in top.items()),
        "\n[range]",
        *(f"{name} = [{_number(one.low)}, {_number(one.high)}]" for name, one in model.ranges.items()),
        "\n[errors]",
        *(f"{name} = {_number(getattr(model.fitted, field))}" for name, field in ERRORS.items()),
        f"\n[{model.kind}]",
        *_write_formula(model.formula),
    ]
    text = "\n".join(lines) + "\n"
    parse_model(text, "the model")
    return text


def _write_formula(formula: Polynomial | Probit) -> Sequence[str]:
    if isinstance(formula, Probit):
        return [f"{name} = {_number(getattr(formula, name))}" for name in KINDS["probit"]]
    head = [f'base = "{formula.base}"', "terms = [  # power of the base, of x = B/H; power of PFA [cm/s2]; coefficient"]
    return [*head, *(f"  [{i}, {j}, {_number(c)}]," for i, j, c in formula.terms), "]"]


def _number(value: float) -> str:
    return repr(float(value))


def read_model(path: Path | str) -> Method:
    """Return the model of a TOML file as a method.

    Raises
    ------
    InputError
        If it cannot be used: the message names the file, the key and how to fix it.
    """
    path = Path(path)
    text = _read_text(path)
    digest = hashlib.sha256(text.encode()).hexdigest()
    return build_method(parse_model(text, str(path)), f"{path.name}, SHA-256 {digest}")


def _read_text(path: Path) -> str:
    """Return the text of a file; raises InputError where it is not a text file, too large or not readable."""
    try:
        if not path.exists():
            raise InputError(fill("{path}: there is no such file. Check the name.", path=path))
        if not path.is_file():
            raise InputError(
                fill("{path}: it is not a file: name the .toml file that `assess study fit` wrote.", path=path)
            )
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
    except (OSError, ValueError) as error:
        text = fill("{path}: the file cannot be read: {why}. Check its permissions.", path=path, why=str(error))
        raise InputError(text) from None
    if len(data) > MOST_BYTES:
        raise InputError(
            fill(
                "{path}: the file is larger than {most} kB, the limit for a fitted model. Name another file.",
                path=path,
                most=MOST_BYTES >> 10,
            )
        )
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        text = fill("{path}: the file is not a UTF-8 text. Name the .toml file that a study wrote.", path=path)
        raise InputError(text) from None


def parse_model(text: str, file: str) -> Fitted:
    """Return the model of a file's text; raises InputError that names `file`, the key and how to fix it."""
    try:
        found = tomllib.loads(text.removeprefix("\ufeff"))
    except (ValueError, RecursionError) as error:  # also: a number of thousands of digits
        detail = str(error).partition(";")[0]
        message = fill(
            "{file}: the file is not valid TOML: {why}. Correct the line, or have the study write the file again.",
            file=file,
            why=detail,
        )
        raise InputError(message) from None
    if found.get("format") != FORMAT or isinstance(found.get("format"), bool):
        given = _show(found["format"]) if "format" in found else fill("missing")
        raise InputError(
            fill(
                "{file}: format is {value}, expected {expected}. Have a study of this version write the file.",
                file=file,
                value=given,
                expected=FORMAT,
            )
        )
    kind = found.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        given = _show(kind) if "kind" in found else fill("missing")
        raise InputError(
            fill("{file}: kind is {value}, expected one of: {names}.", file=file, value=given, names=", ".join(KINDS))
        )
    return _build(file, found, kind)


def _build(file: str, found: dict[str, Any], kind: str) -> Fitted:
    top = _Table(file, "", found, (*TOP, kind))
    limits = _Table(file, "range.", found["range"], tuple(QUANTITIES))
    errors = _Table(file, "errors.", found["errors"], tuple(ERRORS))
    formula = _Table(file, f"{kind}.", found[kind], KINDS[kind])
    numbers = {field: errors.number(name, 0.0) for name, field in ERRORS.items()}
    return Fitted(
        key=_read_key(top),
        title=top.text("title", LONGEST_TITLE),
        formula=_read_polynomial(formula) if kind == "polynomial" else _read_probit(formula),
        fitted=FittedOn(data=top.text("fitted_on", LONGEST_DATA), **numbers),
        ranges={name: limits.ends(name, one.unit) for name, one in QUANTITIES.items()},
    )


class _Table:
    """A table of the file, whose faults are reported with their keys."""

    def __init__(self, file: str, name: str, values: object, keys: Sequence[str]) -> None:
        self.file, self.name = file, name
        if not isinstance(values, dict):
            raise self.wrong("", values, fill("a table: [{name}]", name=name.rstrip(".")))
        self.values: dict[str, Any] = values
        for key in keys:
            if key not in values:
                raise self.fault(key, fill("is missing. Add it, or have the study write the file again."))
        for key in values:
            if key not in keys:
                names = ", ".join(keys)
                raise self.fault(_show(key), fill("is unknown. Remove it; expected are: {names}.", names=names))

    def fault(self, key: str, what: Text) -> InputError:
        """Return the error that says of a key `what` is wrong with it."""
        place = f"{self.file}: {(self.name + key).rstrip('.')}"
        return InputError(join(" ", (place, what)))

    def wrong(self, key: str, value: object, expected: Text) -> InputError:
        """Return the error for a value that is not what is `expected`."""
        return self.fault(key, fill("is {value}, expected {expected}.", value=_show(value), expected=expected))

    def number(self, key: str, low: float = -LARGEST) -> float:
        return self.check_number(key, self.values[key], low)

    def check_number(self, key: str, value: object, low: float = -LARGEST) -> float:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not (is_number and low <= value <= LARGEST):  # type: ignore[operator]
            expected = fill("a number of at most {most:g}", most=LARGEST)
            if low >= 0:
                expected = fill("a number from {low:g} to {most:g}", low=low, most=LARGEST)
            raise self.wrong(key, value, expected)
        return float(value)  # type: ignore[arg-type]

    def ends(self, key: str, unit: str) -> Range:
        value = self.values[key]
        if not (isinstance(value, list) and len(value) == 2):
            raise self.wrong(key, value, fill("[lowest, highest]"))
        low, high = (self.check_number(key, end, 0.0) for end in value)
        if low > high:
            raise self.wrong(key, value, fill("the lowest first"))
        if high == 0:
            raise self.wrong(key, value, fill("the highest above 0, as in the data that it was fitted to"))
        return Range(low, high, unit)

    def text(self, key: str, longest: int) -> str:
        value = self.values[key]
        if not isinstance(value, str) or not 0 < len(value) <= longest:
            raise self.wrong(key, value, fill("a text of 1 to {most} characters", most=longest))
        odd = [sign for sign in value if unicodedata.category(sign)[0] in "CZ" and sign != " "]
        if odd:
            text = fill("holds the character {character}, which cannot be printed. Remove it.", character=ascii(odd[0]))
            raise self.fault(key, text)
        if not value[0].isalnum():
            text = fill("begins with {character!r}, expected a letter or a digit.", character=value[0])
            raise self.fault(key, text)
        return value


def _read_key(top: _Table) -> str:
    from assess.methods import all_methods

    key = top.values["key"]
    if not isinstance(key, str) or not KEY.fullmatch(key):
        rule = fill("{start} and then small letters, digits and _, not ending in _raw or _flags", start=PREFIX)
        raise top.wrong("key", key, rule)
    if any(method.key == key for method in all_methods()):
        text = fill("is {value}, the key of a published method. Choose another.", value=_show(key))
        raise top.fault("key", text)
    return key


def _read_probit(table: _Table) -> Probit:
    return Probit(table.number("b0"), table.number("b1", 0.0), table.number("b2", 0.0))


def _read_polynomial(table: _Table) -> Polynomial:
    base, terms = table.values["base"], table.values["terms"]
    if base not in ("x", "1/x"):
        raise table.wrong("base", base, fill('"x" for B/H or "1/x" for its inverse'))
    if not (isinstance(terms, list) and 0 < len(terms) <= MOST_TERMS):
        raise table.wrong("terms", terms, fill("1 to {most} of [i, j, coefficient]", most=MOST_TERMS))
    found = [_read_term(table, f"terms[{at}]", term) for at, term in enumerate(terms)]
    powers = [(i, j) for i, j, _ in found]
    for at, one in enumerate(powers):
        if one in powers[:at]:
            text = fill("has the powers {i}, {j} of another term. Remove one.", i=one[0], j=one[1])
            raise table.fault(f"terms[{at}]", text)
    return Polynomial(base, tuple(found))


def _read_term(table: _Table, key: str, term: object) -> tuple[int, int, float]:
    if not (isinstance(term, list) and len(term) == 3):
        raise table.wrong(key, term, fill("[i, j, coefficient]"))
    i, j, coefficient = term
    for power in (i, j):
        if type(power) is not int or not 0 <= power <= MOST_POWER:
            text = fill(
                "has the power {value}, expected a whole number from 0 to {most}.", value=_show(power), most=MOST_POWER
            )
            raise table.fault(key, text)
    return i, j, table.check_number(key, coefficient)


def _show(value: object) -> str:
    """Return a value of the file short enough for a message, without what a terminal would act on."""
    if isinstance(value, int) and abs(value) >= 10**40:
        return fill("a number of over 40 digits")
    text = ascii(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
