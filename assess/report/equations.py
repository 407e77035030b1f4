"""Equations as they are printed: from the plain text of a method or of a worked example to TeX.

The plain texts stand once, in the file of each method, in a small notation: ``·`` and ``/``, ``^`` and ``²``, ``_`` for
an index, ``√(...)``, functions by their names. A part of a line that is written in it is an equation; the words around
it stay words. A quotient becomes a fraction, unless it stands within brackets, and brackets that a fraction makes
needless are left out.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

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
_RELATIONS = {"≤": r"\leq", "≥": r"\geq"}
_SIGNS = {"−": "-", "±": r"\pm"}
_LOWER, _UPPER = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789"), str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")
_NAME = re.compile(
    r"(?P<base>B/H|PFV(?=50)|[A-Z]{2,}|.)(?P<index>50|_[A-Za-z0-9α-ω]+|[₀-₉]+)?(?P<star>[*]?)(?P<primes>[′″]*)"
)


class NotationError(ValueError):
    """A text is not written in the notation of equations."""


@dataclass(frozen=True, slots=True)
class Token:
    """A part of a line: what it is, its text, and where it starts."""

    kind: str
    text: str
    start: int


@dataclass(frozen=True, slots=True)
class Part:
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
        try:
            found = _split_relations(line[start:stop])
        except NotationError:
            continue
        parts += [Part(line[end:start])] if start > end else []
        parts += found
        end = stop
    return [*parts, Part(line[end:])] if end < len(line) else parts


def _split_relations(equation: str) -> list[Part]:
    depth, starts = 0, list[int]()
    for token in _tokenise(equation):
        depth += (token.kind == "open") - (token.kind == "close")
        starts += [token.start] if token.kind == "relation" and depth == 0 else []
    ends = [0, *starts[1:], len(equation)]
    texts = [equation[start:end] for start, end in pairwise(ends)]
    return [
        part
        for text in texts
        for part in (Part(text.rstrip(), write_tex(text)), Part(text[len(text.rstrip()) :]))
        if part.text
    ]


def write_tex(equation: str) -> str:
    """Return an equation in TeX.

    Raises
    ------
    NotationError
        If it is not written in the notation of this module.
    """
    tokens = [one for one in _tokenise(equation) if one.kind != "space"]
    return _Parser(tokens).read_all()


def _tokenise(line: str) -> list[Token]:
    return [Token(str(found.lastgroup), found[0], found.start()) for found in _TOKEN.finditer(line)]


# ---------------------------------------------------------------- where the equations of a line are


def _find_stretches(line: str) -> Iterator[tuple[int, int]]:
    """Yield start and end of each stretch that may be an equation: it has a relation or a product, and no words."""
    depth, stretch = 0, list[Token]()
    tokens = _tokenise(line)
    for at, token in enumerate(tokens):
        depth += (token.kind == "open") - (token.kind == "close")
        if _ends_stretch(tokens, at, depth):
            yield from _bounds(stretch)
            stretch, depth = [], 0
        else:
            stretch.append(token)
    yield from _bounds(stretch)


def _ends_stretch(tokens: list[Token], at: int, depth: int) -> bool:
    token = tokens[at]
    if token.kind in ("word", "other", "comma"):
        return token.kind != "comma" or depth <= 0
    begins_number = token.kind == "space" and len(token.text) > 2  # that of the equation, as in ``R = k/N   (5)``
    return depth <= 0 and (_is_conjunction(tokens, at) or begins_number)


def _is_conjunction(tokens: list[Token], at: int) -> bool:
    """Tell whether a lone letter between spaces is a word, as the Italian "e" is: a name or a word follows it."""
    around = tokens[at - 1 : at] + tokens[at + 1 : at + 3]
    is_alone = len(around) == 3 and all(one.kind == "space" for one in around[:2])
    text = tokens[at].text
    return is_alone and len(text) == 1 and "a" <= text <= "z" and around[2].kind in ("name", "word")


def _bounds(stretch: list[Token]) -> Iterator[tuple[int, int]]:
    """Yield start and end of a stretch without what belongs to the words around it; not of one that words interrupt."""
    if [one.kind for one in stretch[-2:]] == ["name", "open"]:
        return
    while stretch and stretch[0].kind in ("space", "close"):
        stretch = stretch[1:]
    if stretch and stretch[0].kind == "relation":
        return
    while stretch and stretch[-1].kind in ("space", "open"):
        stretch = stretch[:-1]
    if any(one.kind == "relation" or (one.kind == "operator" and one.text in "·/^") for one in stretch):
        yield stretch[0].start, stretch[-1].start + len(stretch[-1].text)


# ---------------------------------------------------------------- from tokens to TeX

_CLOSING = {"(": ")", "[": "]"}
_STARTS = ("number", "name", "half", "root", "open", "function")


class _Parser:
    """Reads an equation from left to right: relations of sums of products of powers."""

    def __init__(self, tokens: list[Token]) -> None:
        self.tokens, self.at, self.in_brackets = tokens, 0, 0

    def read_all(self) -> str:
        found = self.relations()
        if self.at < len(self.tokens):
            raise NotationError(self.tokens[self.at].text)
        return found

    def peek(self) -> Token:
        return self.tokens[self.at] if self.at < len(self.tokens) else Token("end", "", -1)

    def take(self, *kinds: str) -> str:
        token = self.peek()
        if token.kind not in kinds:
            raise NotationError(token.text or "the end")
        self.at += 1
        return token.text

    def relations(self) -> str:
        parts = [] if self.peek().kind == "relation" else [self.sum()]
        while self.peek().kind == "relation":
            sign = self.take("relation")
            parts += [_RELATIONS.get(sign, sign), self.sum()]
        return " ".join(parts)

    def sum(self) -> str:
        parts = [self.sign()] if self._is_sign() else []
        parts.append(self.product())
        while self._is_sign():
            parts += [self.sign(), self.product()]
        return " ".join(parts)

    def _is_sign(self) -> bool:
        return self.peek().kind == "operator" and self.peek().text in "+-−±"

    def sign(self) -> str:
        sign = self.take("operator")
        return _SIGNS.get(sign, sign)

    def product(self) -> str:
        """Read factors; what stands before a stroke is the numerator, a second stroke adds to the denominator."""
        start, over, under = self.at, self.factors(), list[str]()
        if self._is_stroke() and r"\dfrac" in over:  # a fraction within a fraction is written with a stroke
            self.at = start
            over = self._inside(self.factors)
        while self._is_stroke():
            self.take("operator")
            under.append(self._inside(self.run))
        rest = ""
        if under and (mark := self.times()):
            rest = mark + self.product()
        return self._quotient(over, under) + rest + self.unit()

    def factors(self) -> str:
        found = self.factor()
        while mark := self.times():
            found += mark + self.factor()
        return found

    def times(self) -> str:
        """Return the TeX between two factors, and nothing where none follows."""
        if self.peek().kind == "operator" and self.peek().text == "·":
            self.take("operator")
            return r"\cdot "
        if self.peek().kind in _STARTS:
            return " " if self._touches() else r"\, "
        return ""

    def _is_stroke(self) -> bool:
        return self.peek().kind == "operator" and self.peek().text == "/"

    def _inside(self, read: Callable[[], str]) -> str:
        """Return what `read` reads where fractions are written with strokes."""
        self.in_brackets += 1
        found = read()
        self.in_brackets -= 1
        return found

    def run(self) -> str:
        """Read what a stroke divides by: factors that stand together without a space or a sign, as in ``3g/4r``."""
        found = self.factor()
        while self.peek().kind in _STARTS and self._touches():
            found += " " + self.factor()
        return found

    def _touches(self) -> bool:
        before = self.tokens[self.at - 1]
        return before.start + len(before.text) == self.peek().start

    def _quotient(self, over: str, under: list[str]) -> str:
        if not under:
            return over
        if self.in_brackets:
            return "/".join([over, *under])
        below = _bare(under[0]) if len(under) == 1 else r" \cdot ".join(under)
        return rf"\dfrac{{{_bare(over)}}}{{{below}}}"

    def unit(self) -> str:
        if self.peek().kind != "unit":
            return ""
        return r"\;\mathrm{" + self.take("unit").replace("²", "^2") + "}"

    def factor(self) -> str:
        found = self.atom()
        if self.peek().kind == "upper":
            found += "^{" + self.take("upper").translate(_UPPER) + "}"
        elif self.peek().kind == "operator" and self.peek().text == "^":
            self.at += 1
            sign = self.sign() if self._is_sign() else ""
            found += "^{" + sign + _bare(self.atom()) + "}"
        return found

    def atom(self) -> str:
        kind = self.peek().kind
        if kind == "number":
            return self.take("number").replace(",", "{,}")
        if kind == "half":
            return r"\frac{1}{2}" if self.take("half") else ""
        if kind == "name":
            return self.name()
        if kind == "function":
            return self.function()
        if kind == "root":
            return self.root()
        if kind == "bar":
            return self.magnitude()
        return self.bracket()

    def name(self) -> str:
        found = write_name(self.take("name"))
        if found == r"\Phi" or (found == "N" and self.peek().text == "(" and self._touches()):
            return found + (self.bracket(deeper=0) if self.peek().kind == "open" else "")
        return found

    def function(self) -> str:
        name = self.take("function")
        word = rf"\{name}" if name not in ("asin", "acos", "atan", "sgn") else rf"\mathrm{{{name}}}"
        if self.peek().kind == "upper":
            word += "^{" + self.take("upper").translate(_UPPER) + "}"
        if self.peek().kind == "open":
            return word + self.bracket(deeper=0)
        return word + r"\, " + self.factor()

    def root(self) -> str:
        self.take("root")
        if self.peek().kind != "open":
            return rf"\sqrt{{{self.factor()}}}"
        return rf"\sqrt{{{_bare(self.bracket(deeper=0))}}}"

    def magnitude(self) -> str:
        self.take("bar")
        found = self.sum()
        self.take("bar")
        return f"|{found}|"

    def bracket(self, deeper: int = 1) -> str:
        """Read what stands in brackets; those of a function or a root are not `deeper`: they may hold a fraction."""
        opened = self.take("open")
        self.in_brackets += deeper
        parts = [self.sum()]
        while self.peek().kind == "comma":
            self.take("comma")
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
        inner = tex.removeprefix(left).removesuffix(right)
        if tex.startswith(left) and tex.endswith(right) and _is_balanced(inner):
            return inner
    return tex


def _is_balanced(tex: str) -> bool:
    """Tell whether no bracket closes in a TeX that was not opened there."""
    depth = 0
    for found in re.finditer(r"\\(left|right)(?=[(\[)\]])", tex):
        depth += 1 if found[1] == "left" else -1
        if depth < 0:
            return False
    return True


def write_name(name: str) -> str:
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
