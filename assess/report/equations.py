"""Equations as they are printed: from the plain text of a method or of a worked example to TeX.

The plain texts stand once, in the file of each method, in a small notation: ``·`` and ``/``, ``^`` and ``²``, ``_`` for
an index, ``√(...)``, functions by their names. A part of a line that is written in it is an equation; the words around
it stay words. A quotient becomes a fraction, unless it stands within brackets, and brackets that a fraction makes
needless are left out.
"""

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

FUNCTIONS = ("asin", "acos", "atan", "sin", "cos", "tan", "exp", "ln", "max", "min", "sgn")
_UNITS = r"cm/s²|m/s²|cm/s|rad/s|rad|Hz|cm|m|g|s"
_TOKEN = re.compile(
    rf"""(?P<space>\s+)
    |(?P<unit>(?<=\d\s)(?:{_UNITS})(?=$|[\s,;.)]))
    |(?P<number>\d+(?:[.,]\d+)*(?<![.,]))
    |(?P<function>(?:{"|".join(FUNCTIONS)})(?![A-Za-z_]))
    |(?P<name>B/H[*]|(?:(?:[A-Z]{{2,}}|[A-Za-z])(?![A-Za-z])|[αβγδεζηθλμπρσωΦ])(?:(?<=PFV)50)?
        (?:_[A-Za-z0-9α-ω]+|[₀-₉]+)?[*]?[′″]*)
    |(?P<upper>[⁰¹²³⁴-⁹]+)
    |(?P<half>½)
    |(?P<relation>[=<>≤≥])
    |(?P<operator>[-+−±·/^])
    |(?P<root>√)
    |(?P<open>[(\[])
    |(?P<close>[)\]])
    |(?P<bar>[|])
    |(?P<comma>[,;:](?=\s|$))
    |(?P<word>[^\W\d_]+(?:[-'’/][^\W\d_]+)*[²³]?)
    |(?P<other>.)""",
    re.VERBOSE,
)
_GREEK = {
    "α": r"\alpha", "β": r"\beta", "γ": r"\gamma", "δ": r"\delta", "ε": r"\varepsilon", "ζ": r"\zeta", "η": r"\eta",
    "θ": r"\theta", "λ": r"\lambda", "μ": r"\mu", "π": r"\pi", "ρ": r"\rho", "σ": r"\sigma", "ω": r"\omega",
    "Φ": r"\Phi",
}  # fmt: skip
_SIGNS = {"−": "-", "±": r"\pm", "≤": r"\leq", "≥": r"\geq"}
_LOWER, _UPPER = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789"), str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")
_NAME = re.compile(
    r"(?P<base>B/H|PFV(?=50)|[A-Z]{2,}|.)(?P<index>50|_[A-Za-z0-9α-ω]+|[₀-₉]+)?(?P<star>[*]?)(?P<primes>[′″]*)"
)


Token = re.Match[str]
"""A part of a line; the name of its group tells what it is."""


class NotationError(ValueError):
    """A text is not written in the notation of equations."""


class Part(NamedTuple):
    """A stretch of a line as it stands in the plain text; `tex` is empty where it is words."""

    text: str
    tex: str = ""


def split_line(line: str) -> list[Part]:
    """Return a line as its equations and the words between them: put together, their texts are the line.

    An equation of several relations is a part up to the second, and one from each further relation: a line may break
    before it.
    """
    parts: list[Part] = []
    end = 0
    for start, stop in _find_stretches(line):
        equation, depth, breaks = line[start:stop], 0, list[int]()
        for token in _TOKEN.finditer(equation):
            depth += (token.lastgroup == "open") - (token.lastgroup == "close")
            breaks += [token.start()] if token.lastgroup == "relation" and depth == 0 else []
        texts = [equation[one:other] for one, other in pairwise([0, *breaks[1:], len(equation)])]
        try:
            found = [(text.rstrip(), write_tex(text), text[len(text.rstrip()) :]) for text in texts]
        except NotationError:
            continue
        parts += [Part(line[end:start])] if start > end else []
        for text, tex, blank in found:
            parts += [Part(text, tex), *([Part(blank)] if blank else [])]
        end = stop
    return [*parts, Part(line[end:])] if end < len(line) else parts


def write_tex(equation: str) -> str:
    """Return an equation in TeX; NotationError if it is not written in the notation of this module."""
    parser = _Parser([one for one in _TOKEN.finditer(equation) if one.lastgroup != "space"])
    parts = list[str]()
    while not parts or parser.kind == "relation":
        parts += [parser.take("relation")] if parser.kind == "relation" else []
        parts.append(parser.sum())
    if parser.kind:
        raise NotationError(parser.text)
    return " ".join(parts)


# ---------------------------------------------------------------- where the equations of a line are


def _find_stretches(line: str) -> Iterator[tuple[int, int]]:
    """Yield start and end of each stretch that may be an equation: it has a relation or a product, and no words."""
    tokens, depth, stretches = list(_TOKEN.finditer(line)), 0, [list[Token]()]
    for at, token in enumerate(tokens):
        depth += (token.lastgroup == "open") - (token.lastgroup == "close")
        if _ends_stretch(tokens, at, depth):
            stretches.append([])
            depth = 0
        else:
            stretches[-1].append(token)
    for stretch in stretches:  # without what belongs to the words around it, and none that words interrupt
        if [one.lastgroup for one in stretch[-2:]] == ["name", "open"]:
            continue
        while stretch and stretch[0].lastgroup in ("space", "close"):
            stretch.pop(0)
        if stretch and stretch[0].lastgroup == "relation":
            continue
        while stretch and stretch[-1].lastgroup in ("space", "open"):
            stretch.pop()
        if any(one.lastgroup == "relation" or (one.lastgroup == "operator" and one[0] in "·/^") for one in stretch):
            yield stretch[0].start(), stretch[-1].end()


def _ends_stretch(tokens: list[Token], at: int, depth: int) -> bool:
    """Tell whether a token ends a stretch: words do, and a lone letter between spaces, as the Italian "e" is."""
    kind, text = tokens[at].lastgroup, tokens[at][0]
    if kind in ("word", "other", "comma"):
        return kind != "comma" or depth <= 0
    if depth > 0:
        return False
    if kind == "space" and len(text) > 2:  # before the number of the equation, as in ``R = k/N   (5)``
        return True
    around = [one.lastgroup for one in tokens[at - 1 : at] + tokens[at + 1 : at + 3]]
    is_alone = len(around) == 3 and around[:2] == ["space", "space"]
    return is_alone and len(text) == 1 and "a" <= text <= "z" and around[2] in ("name", "word")


# ---------------------------------------------------------------- from tokens to TeX

_CLOSING = {"(": ")", "[": "]"}
_STARTS = ("number", "name", "half", "root", "open", "function")


class _Parser:
    """Reads an equation from left to right: relations of sums of products of powers."""

    def __init__(self, tokens: list[Token]) -> None:
        self.tokens, self.at, self.in_brackets = tokens, 0, 0

    @property
    def kind(self) -> str:
        return str(self.tokens[self.at].lastgroup) if self.at < len(self.tokens) else ""

    @property
    def text(self) -> str:
        return self.tokens[self.at][0] if self.at < len(self.tokens) else ""

    def is_operator(self, signs: str) -> bool:
        return self.kind == "operator" and self.text in signs

    def touches(self) -> bool:
        return self.at < len(self.tokens) and self.tokens[self.at - 1].end() == self.tokens[self.at].start()

    def take(self, kind: str) -> str:
        text = self.text
        if self.kind != kind:
            raise NotationError(text or "the end")
        self.at += 1
        return _SIGNS.get(text, text)

    def sum(self) -> str:
        parts = list[str]()
        while not parts or self.is_operator("+-−±"):
            parts += [self.take("operator")] if self.is_operator("+-−±") else []
            parts.append(self.product())
        return " ".join(parts)

    def product(self) -> str:
        """Read factors; what stands before a stroke is the numerator, a second stroke adds to the denominator."""
        start, found, under = self.at, self.factors(), list[str]()
        if self.is_operator("/") and r"\dfrac" in found:  # a fraction within a fraction is written with a stroke
            self.at = start
            found = self.factors(is_inside=True)
        while self.is_operator("/"):
            self.at += 1
            under.append(self.factors(is_inside=True, is_run=True))
        if under and self.in_brackets:
            found = "/".join([found, *under])
        elif under:
            below = _bare(under[0]) if len(under) == 1 else r" \cdot ".join(under)
            found = rf"\dfrac{{{_bare(found)}}}{{{below}}}"
        if under and (mark := self.times()):
            found += mark + self.product()
        if self.kind == "unit":
            found += r"\;\mathrm{" + self.take("unit").replace("²", "^2") + "}"
        return found

    def factors(self, *, is_inside: bool = False, is_run: bool = False) -> str:
        """Read factors, with fractions as strokes if `is_inside`; of a run those that touch, as in ``3g/4r``."""
        self.in_brackets += is_inside
        found = self.factor()
        while mark := self.times(is_run=is_run):
            found += mark + self.factor()
        self.in_brackets -= is_inside
        return found

    def times(self, *, is_run: bool = False) -> str:
        """Return the TeX between two factors, and nothing where none follows."""
        if self.is_operator("·") and not is_run:
            self.at += 1
            return r"\cdot "
        if self.kind not in _STARTS:
            return ""
        return " " if self.touches() else "" if is_run else r"\, "

    def factor(self) -> str:
        found = self.atom() + self.power()
        if self.is_operator("^"):
            self.at += 1
            sign = self.take("operator") if self.is_operator("+-−±") else ""
            found += "^{" + sign + _bare(self.atom()) + "}"
        return found

    def power(self) -> str:
        return "^{" + self.take("upper").translate(_UPPER) + "}" if self.kind == "upper" else ""

    def atom(self) -> str:
        match self.kind:
            case "number":
                return self.take("number").replace(",", "{,}")
            case "half":
                self.at += 1
                return r"\frac{1}{2}"
            case "name":
                found = _write_name(self.take("name"))
                is_called = found == r"\Phi" or (found == "N" and self.touches())
                return found + (self.bracket(deeper=0) if is_called and self.text == "(" else "")
            case "function":
                name = self.take("function")
                word = rf"\mathrm{{{name}}}" if name in ("asin", "acos", "atan", "sgn") else rf"\{name}"
                word += self.power()
                return word + (self.bracket(deeper=0) if self.text in _CLOSING else r"\, " + self.factor())
            case "root":
                self.at += 1
                inside = _bare(self.bracket(deeper=0)) if self.text in _CLOSING else self.factor()
                return rf"\sqrt{{{inside}}}"
            case "bar":
                self.at += 1
                found = self.sum()
                self.take("bar")
                return f"|{found}|"
        return self.bracket()

    def bracket(self, deeper: int = 1) -> str:
        """Read what stands in brackets; those of a function or a root are not `deeper`: they may hold a fraction."""
        opened = self.take("open")
        self.in_brackets += deeper
        parts = [self.sum()]
        while self.kind == "comma":
            self.at += 1
            parts.append(self.sum())
        self.in_brackets -= deeper
        if self.take("close") != _CLOSING[opened]:
            raise NotationError(opened)
        listed = r",\, ".join(parts)
        return rf"\left{opened}{listed}\right{_CLOSING[opened]}"


def _bare(tex: str) -> str:
    """Return TeX without the brackets around all of it."""
    for opened, closed in _CLOSING.items():
        left, right = rf"\left{opened}", rf"\right{closed}"
        inner, depth = tex.removeprefix(left).removesuffix(right), 0
        if tex.startswith(left) and tex.endswith(right):
            depths = [depth := depth + (1 if one == "left" else -1) for one in _BRACKET.findall(inner)]
            return inner if min(depths, default=0) >= 0 else tex  # none closes that was not opened there
    return tex


_BRACKET = re.compile(r"\\(left|right)(?=[(\[)\]])")


def _write_name(name: str) -> str:
    """Return the TeX of a quantity: capitals together upright, a letter slanted, its index, star and primes."""
    found = _NAME.fullmatch(name)
    if found is None:
        raise NotationError(name)
    base = found["base"]
    base = f"({base})" if base == "B/H" else rf"\mathrm{{{base}}}" if len(base) > 1 else _GREEK.get(base, base)
    index = (found["index"] or "").removeprefix("_").translate(_LOWER)
    shown = _GREEK.get(index, index) if len(index) == 1 or index.isdigit() else rf"\mathrm{{{index}}}"
    lower = f"_{{{shown}}}" if index else ""
    primes = found["primes"].replace("″", "′′")  # as letters: mathtext's own primes are tiny in STIX
    return base + lower + (r"^{\ast}" if found["star"] else "") + (rf"\mathrm{{{primes}}}" if primes else "")
