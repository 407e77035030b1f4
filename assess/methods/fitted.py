"""A model that a study fitted, kept in a small TOML file, as one more method: shown next to the others, never adopted.

Every fault of the file is reported with its key.

Equations
---------
polynomial  R = sum of c·u^i·PFA^j, u = B/H or 1/(B/H), PFA in cm/s², as equation (9) of the paper
probit      R = Φ(b_0 + b_1 ln[PFA/(g B/H)] + b_2 ln[p PFV/(g B/H)]), b_1, b_2 ≥ 0, p of equation (4)

Reference
---------
The groups PFA/(g tan α) and p PFV/(g tan α) are those of Dimitrakopoulos and Paraskeva (2015), tan α = B/H.
"""

import hashlib
import json
import re
import string
import tomllib
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial, reduce
from pathlib import Path
from typing import Any, Literal

import numpy as np

from assess.arrays import FloatArray
from assess.errors import InputError
from assess.i18n import Text, fill, join
from assess.methods.cases import Cases
from assess.methods.expression import localise, normal_cdf, show_pfa, show_ratio
from assess.methods.method import (
    BLOCK,
    BY_RATIO,
    BY_SIZE,
    CLIPPED,
    PFV_FLAGS,
    Column,
    Example,
    FittedOn,
    Method,
    Outcome,
    Range,
    Reason,
    Reference,
)
from assess.rocking.block import frequency_parameter
from assess.settings import Settings
from assess.units import ACCELERATION, GRAVITY, LENGTH, VELOCITY

Base = Literal["x", "1/x"]
Powers = tuple[int, int]
"""Powers i of the base and j of PFA in a term."""

PREFIX = "fitted_"
"""How the key of every such method begins."""


def expand(base: Base, powers: Sequence[Powers], x: FloatArray, y: FloatArray) -> list[FloatArray]:
    """Return u^i y^j, (n,) each, of x = B/H [-] and y = PFA [cm/s2]; u is x or 1/x."""
    u = x if base == "x" else 1 / x
    return [_raise(u, i) * _raise(y, j) for i, j in powers]


def _raise(values: FloatArray, power: int) -> FloatArray:
    return reduce(np.multiply, [values] * power, np.ones_like(values))


def write_sum(base: Base, powers: Sequence[Powers], x: str, y: str) -> str:
    """Return the sum of terms with a, b, c... for their coefficients: ``a + b/x + c·y``."""
    return " + ".join(
        letter + (f"·{y}{_SIGNS[j]}" if j else "") + (f"{'·' if base == 'x' else '/'}{x}{_SIGNS[i]}" if i else "")
        for letter, (i, j) in zip(string.ascii_lowercase, powers, strict=False)
    )


_SIGNS = ("", "", "²", "³")


def find_groups(
    *, breadth: FloatArray, height: FloatArray, pfa: FloatArray, pfv: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return PFA/(g B/H) and p PFV/(g B/H) [-], (n,) each, of sizes [m] and peaks [m/s2], [m/s]."""
    start = GRAVITY * breadth / height
    return pfa / start, frequency_parameter(breadth, height) * pfv / start


@dataclass(frozen=True, slots=True)
class Polynomial:
    """Terms (i, j, coefficient) of B/H [-], or of its inverse, and PFA [cm/s2]."""

    base: Base
    terms: tuple[tuple[int, int, float], ...]

    @property
    def powers(self) -> list[Powers]:
        """The powers of each term."""
        return [(i, j) for i, j, _ in self.terms]

    @np.errstate(all="ignore")
    def evaluate(self, cases: Cases) -> FloatArray:
        """Return the sum of the terms for n cases [-], which knows no bounds."""
        x, y = cases.breadth_to_height, cases.pfa / ACCELERATION["cm/s2"]
        columns = expand(self.base, self.powers, x, y)
        total = sum((c * column for (_, _, c), column in zip(self.terms, columns, strict=True)), np.zeros_like(x))
        return np.where(np.isnan(x) | np.isnan(y), np.nan, total)


@dataclass(frozen=True, slots=True)
class Probit:
    """Coefficients of the probit [-]; `b1` and `b2` are 0 or above."""

    b0: float
    b1: float
    b2: float

    @np.errstate(all="ignore")
    def evaluate(self, cases: Cases) -> FloatArray:
        """Return the chance of n cases [-]; 0 where nothing moves, NaN where PFV is unknown."""
        A, V = find_groups(breadth=cases.breadth, height=cases.height, pfa=cases.pfa, pfv=cases.pfv)
        chance = normal_cdf(self.b0 + self.b1 * np.log(A) + self.b2 * np.log(V))
        return np.where(np.isnan(A) | np.isnan(V), np.nan, np.where((A > 0) & (V > 0), chance, 0.0))


@dataclass(frozen=True, slots=True)
class Quantity:
    """A quantity of the data of a fit: its name in `Method.valid`, its unit there, and its values for n cases, (n,)."""

    name: str
    unit: str
    measure: Callable[[Cases], FloatArray]


QUANTITIES: Mapping[str, Quantity] = {
    "breadth_to_height": Quantity("breadth_to_height", "", lambda cases: cases.breadth_to_height),
    "pfa_g": Quantity("pfa", "g", lambda cases: cases.pfa / ACCELERATION["g"]),
    "height_cm": Quantity("height", "cm", lambda cases: cases.height / LENGTH["cm"]),
    "pfv_cm_s": Quantity("pfv", "cm/s", lambda cases: cases.pfv / VELOCITY["cm/s"]),
    "pfv_over_pfa_s": Quantity("PFV/PFA", "s", lambda cases: cases.pfv / cases.pfa),
}
"""The quantities whose ranges a model states, by their key in its file."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted:
    """A fitted model.

    * `key`, `title`: the key begins with `PREFIX`.
    * `formula`: with its coefficients.
    * `fitted`: buildings, motions, runs and seed, in words, and the errors where a building is left out of the fit.
    * `ranges`: what it was fitted to, by the keys of `QUANTITIES`.
    """

    key: str
    title: str
    formula: Polynomial | Probit
    fitted: FittedOn
    ranges: Mapping[str, Range]

    @property
    def kind(self) -> str:
        """``polynomial`` or ``probit``, as in its file."""
        return "probit" if isinstance(self.formula, Probit) else "polynomial"

    def evaluate(self, cases: Cases, settings: Settings) -> Outcome:
        """Return the chance of n cases, with the unbounded value and the cautions."""
        found = self.formula.evaluate(cases)
        raw = np.where(np.isfinite(found), found, np.nan)
        value = np.clip(raw, 0.0, 1.0)
        known = ~np.isnan(value)
        with np.errstate(all="ignore"):
            # Where PFV is unknown a case does not lie inside the data.
            inside = reduce(
                np.logical_and, [one.holds(QUANTITIES[key].measure(cases)) for key, one in self.ranges.items()]
            )
        flags = {"extrapolated": known & ~inside, "clipped": known & (value != raw)}
        if isinstance(self.formula, Probit):
            flags["pfv_unknown"] = np.isnan(cases.pfv)
        return Outcome(value, {"raw": raw}, flags)


# ---------------------------------------------------------------- as a method


def build_method(model: Fitted, source: str) -> Method:
    """Return a model as a method; `source` says where it comes from."""
    is_probit = isinstance(model.formula, Probit)
    fitted, formula, verdict = model.fitted, model.formula, _judge(model.fitted)
    if isinstance(formula, Probit):
        equations: tuple[str, ...] = (
            "R = Φ(b_0 + b_1 ln[PFA/(g·B/H)] + b_2 ln[p·PFV/(g·B/H)])",
            "p = √(3g/(4r)), r = ½·√(B² + H²)",
            _write_numbers(("b_0", "b_1", "b_2"), (formula.b0, formula.b1, formula.b2)),
        )
    else:
        letters, numbers = string.ascii_lowercase, [c for _, _, c in formula.terms]
        equations = (
            fill("R = {total}, PFA in cm/s²", total=write_sum(formula.base, formula.powers, "(B/H)", "PFA")),
            *(_write_numbers(letters[at : at + 3], numbers[at : at + 3]) for at in range(0, len(numbers), 3)),
        )
    data = fitted.data.partition(", ")[0]  # the title heads columns
    errors = fill(
        "Fitted to computed chances on {data}; where a building is left out of the fit, the error for it is "
        "{error:.3f} (root mean square, standard error {spread:.3f}); a constant, the mean chance of the other "
        "buildings, has {constant:.3f}.",
        data=fitted.data, error=fitted.error, spread=fitted.spread, constant=fitted.constant,
    )  # fmt: skip
    return Method(
        key=model.key,
        title=fill(
            "{name} (fitted on {data})",
            name=model.title,
            data=data if len(data) <= 40 else f"{data[:39]}…",
        ),
        short_title=model.title, kind="probability", order=1000, predicts=BY_SIZE if is_probit else BY_RATIO,
        reference=Reference(title=model.title, source=source, remark=join(" ", (errors, verdict))),
        needs=frozenset({"breadth", "height", "pfa", *(("pfv",) if is_probit else ())}),
        valid={
            QUANTITIES[key].name: Range(float(f"{one.low:.3g}"), float(f"{one.high:.3g}"), one.unit)
            for key, one in model.ranges.items()
        },
        evaluate=model.evaluate,
        steps=partial(_work, equations),
        columns=(Column("raw", "Unbounded value"),),
        equations=equations,
        assumptions=(verdict, COMPARED, *(OF_PROBIT if is_probit else OF_POLYNOMIAL), BLOCK),
        flags={"clipped": CLIPPED} | (FLAGS_OF_PROBIT if is_probit else FLAGS_OF_POLYNOMIAL),
        reasons=(
            Reason(APPROXIMATES),
            *([Reason(NO_BETTER)] if fitted.is_no_better else []),
            Reason(BEYOND, flag="extrapolated"),
        ),
        fitted=fitted,
    )  # fmt: skip


def _work(equations: Sequence[str], example: Example) -> list[str]:
    velocity = [] if np.isnan(example.pfv) else [localise(f"PFV = {example.pfv:.6g} cm/s")]
    result = localise(f"R = {example.number('raw'):.4f}")
    return [show_ratio(example), show_pfa(example), *velocity, *equations, result]


COMPARED = fill("A model of the user's own, no published method: shown for comparison, it counts for no adopted risk.")
OF_PROBIT = (
    fill("The ranges given are those of the data that it was fitted to; outside them it is marked as extrapolated."),
    fill(
        "The chance never falls as PFA or PFV grows; of two pieces of one B/H, the larger is never the easier to "
        "overturn."
    ),
)
OF_POLYNOMIAL = (
    fill(
        "The ranges given are those of the data that it was fitted to; outside them it is marked as extrapolated, and "
        "where PFV is unknown as well: PFV/PFA may then lie outside."
    ),
    fill("A surface, not a law: it ignores size, and may fall where the motion grows or the piece gets thinner."),
)
FLAGS_OF_POLYNOMIAL = {
    "extrapolated": fill("outside the data that it was fitted to, or PFV is unknown, so that it may be outside")
}
FLAGS_OF_PROBIT = {"extrapolated": fill("outside the data that it was fitted to"), **PFV_FLAGS}


APPROXIMATES = (
    "The fitted model gives {value} at B/H {breadth_to_height} and PFA {pfa_g} g: it approximates what was computed on "
    "the buildings that it was fitted to."
)
NO_BETTER = (
    "For a building that it was not fitted to, it is no better than a constant, one chance for every piece and motion."
)
BEYOND = "The piece or its motion lies outside the data that the model was fitted to, or PFV is unknown."
REASONS = (APPROXIMATES, NO_BETTER, BEYOND)
"""Texts of reasons, for the catalogues."""


def _judge(fitted: FittedOn) -> Text:
    if fitted.is_no_better:
        return fill(
            "Beware: for a building that it was not fitted to, it is no better than a constant, that is, one chance "
            "for every piece and motion."
        )
    if fitted.constant - fitted.error < fitted.spread:
        return fill(
            "Beware: for a building that it was not fitted to, it is hardly better than a constant, that is, one "
            "chance for every piece and motion: the two errors differ by less than the standard error."
        )
    return fill(
        "For a building that it was not fitted to, it is better than a constant, that is, one chance for every piece "
        "and motion."
    )


def _write_numbers(names: Sequence[str], values: Sequence[float]) -> Text:
    """Return ``a = 1.5; b = 2``, which a report writes with its own decimal sign."""
    pairs = zip(names, values, strict=False)
    return join("; ", [fill("{name} = {value:.9g}", name=name, value=value) for name, value in pairs])


# ---------------------------------------------------------------- its file

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
"""The endings are those of columns next to a method's value."""


def write_model(model: Fitted) -> str:
    """Return the file of a model.

    Raises InputError if it holds what could not be read back, as a number that is not finite.
    """
    top = {"key": model.key, "title": model.title, "kind": model.kind, "fitted_on": model.fitted.data}
    if isinstance(model.formula, Probit):
        formula = [f"{name} = {float(getattr(model.formula, name))!r}" for name in KINDS["probit"]]
    else:
        formula = [
            f'base = "{model.formula.base}"',
            "terms = [  # power of the base, of x = B/H; power of PFA [cm/s2]; coefficient",
            *(f"  [{i}, {j}, {float(c)!r}]," for i, j, c in model.formula.terms),
            "]",
        ]
    lines = [
        "# A model of the chance of overturning, fitted by assess. `assess run` shows it next to the methods.",
        f"format = {FORMAT}",
        *(f"{name} = {json.dumps(text, ensure_ascii=False)}" for name, text in top.items()),
        "\n[range]",
        *(f"{name} = [{float(one.low)!r}, {float(one.high)!r}]" for name, one in model.ranges.items()),
        "\n[errors]",
        *(f"{name} = {float(getattr(model.fitted, field))!r}" for name, field in ERRORS.items()),
        f"\n[{model.kind}]",
        *formula,
    ]
    text = "\n".join(lines) + "\n"
    parse_model(text, "the model")
    return text


def read_model(path: Path | str) -> Method:
    """Return the model of a TOML file as a method.

    Raises InputError if it cannot be used: the message names the file, the key and how to fix it.
    """
    path = Path(path)
    try:
        if not path.exists():
            raise InputError.about("{path}: there is no such file. Check the name.", path=path)
        if not path.is_file():
            raise InputError.about(
                "{path}: it is not a file: name the .toml file that `assess study fit` wrote.", path=path
            )
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
    except (OSError, ValueError) as error:
        raise InputError.about(
            "{path}: the file cannot be read: {why}. Check its permissions.", path=path, why=str(error)
        ) from None
    if len(data) > MOST_BYTES:
        raise InputError.about(
            "{path}: the file is larger than {most} kB, the limit for a fitted model. Name another file.",
            path=path,
            most=MOST_BYTES >> 10,
        )
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        raise InputError.about(
            "{path}: the file is not a UTF-8 text. Name the .toml file that a study wrote.", path=path
        ) from None
    digest = hashlib.sha256(text.encode()).hexdigest()
    return build_method(parse_model(text, str(path)), f"{path.name}, SHA-256 {digest}")


def parse_model(text: str, file: str) -> Fitted:
    """Return the model of a file's text; raises InputError that names `file`, the key and how to fix it."""
    from assess.methods import all_methods

    try:
        found = tomllib.loads(text.removeprefix("\ufeff"))
    except (ValueError, RecursionError) as error:  # also: a number of thousands of digits
        detail = str(error).partition(";")[0]
        raise InputError.about(
            "{file}: the file is not valid TOML: {why}. Correct the line, or have the study write the file again.",
            file=file,
            why=detail,
        ) from None
    if found.get("format") != FORMAT or isinstance(found.get("format"), bool):
        given = _show(found["format"]) if "format" in found else fill("missing")
        raise InputError.about(
            "{file}: format is {value}, expected {expected}. Have a study of this version write the file.",
            file=file, value=given, expected=FORMAT,
        )  # fmt: skip
    kind = found.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        given = _show(kind) if "kind" in found else fill("missing")
        raise InputError.about(
            "{file}: kind is {value}, expected one of: {names}.", file=file, value=given, names=", ".join(KINDS)
        )
    top = _Table(file, "", found, (*TOP, kind))
    limits = _Table(file, "range.", found["range"], tuple(QUANTITIES))
    errors = _Table(file, "errors.", found["errors"], tuple(ERRORS))
    formula = _Table(file, f"{kind}.", found[kind], KINDS[kind])
    numbers = {field: errors.number(name, 0.0) for name, field in ERRORS.items()}
    key = top.values["key"]
    if not isinstance(key, str) or not KEY.fullmatch(key):
        rule = fill("{start} and then small letters, digits and _, not ending in _raw or _flags", start=PREFIX)
        raise top.wrong("key", key, rule)
    if any(method.key == key for method in all_methods()):
        raise top.fault("key", fill("is {value}, the key of a published method. Choose another.", value=_show(key)))
    return Fitted(
        key=key,
        title=top.text("title", LONGEST_TITLE),
        formula=_read_polynomial(formula)
        if kind == "polynomial"
        else Probit(formula.number("b0"), formula.number("b1", 0.0), formula.number("b2", 0.0)),
        fitted=FittedOn(data=top.text("fitted_on", LONGEST_DATA), **numbers),
        ranges={name: limits.ends(name, one.unit) for name, one in QUANTITIES.items()},
    )


class _Table:
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

    def number(self, key: str, low: float = -LARGEST, value: object = None) -> float:
        """Return the number of a key, or `value` within it."""
        value = self.values[key] if value is None else value
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
        low, high = (self.number(key, 0.0, end) for end in value)
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


def _read_polynomial(table: _Table) -> Polynomial:
    base, terms = table.values["base"], table.values["terms"]
    if base not in ("x", "1/x"):
        raise table.wrong("base", base, fill('"x" for B/H or "1/x" for its inverse'))
    if not (isinstance(terms, list) and 0 < len(terms) <= MOST_TERMS):
        raise table.wrong("terms", terms, fill("1 to {most} of [i, j, coefficient]", most=MOST_TERMS))
    found: list[tuple[int, int, float]] = []
    for at, term in enumerate(terms):
        key = f"terms[{at}]"
        if not (isinstance(term, list) and len(term) == 3):
            raise table.wrong(key, term, fill("[i, j, coefficient]"))
        i, j, coefficient = term
        for power in (i, j):
            if type(power) is not int or not 0 <= power <= MOST_POWER:
                text = fill(
                    "has the power {value}, expected a whole number from 0 to {most}.",
                    value=_show(power),
                    most=MOST_POWER,
                )
                raise table.fault(key, text)
        found.append((i, j, table.number(key, value=coefficient)))
    powers = [(i, j) for i, j, _ in found]
    for at, one in enumerate(powers):
        if one in powers[:at]:
            text = fill("has the powers {i}, {j} of another term. Remove one.", i=one[0], j=one[1])
            raise table.fault(f"terms[{at}]", text)
    return Polynomial(base, tuple(found))


def _show(value: object) -> str:
    """Return a value of the file short enough for a message, without what a terminal would act on."""
    if isinstance(value, int) and abs(value) >= 10**40:
        return fill("a number of over 40 digits")
    text = ascii(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
