"""Equations: what of a line is one, its TeX, and that every equation of a method is typeset."""

import re
import unicodedata

import pytest

from assess.compiled import examine_folder
from assess.i18n import gettext, load_catalogue, speaking
from assess.methods import all_methods
from assess.motion.scenario import PROFILES
from assess.report.blocks import Equation, lower_indices
from assess.report.equations import NotationError, split_line, write_tex
from assess.report.figures import math_figures
from assess.report.figures.math_figures import draw_math
from assess.report.html_blocks import HtmlWriter

NAMED = {
    "alpha": "α", "beta": "β", "gamma": "γ", "varepsilon": "ε", "zeta": "ζ", "eta": "η", "theta": "θ", "lambda": "λ",
    "mu": "μ", "pi": "π", "Phi": "Φ", "pm": "±", "leq": "≤", "geq": "≥", "sqrt": "√", "ast": "*",
}  # fmt: skip
LAYOUT = re.compile(r"\\(dfrac|frac|mathrm|left|right|cdot)(?![a-zA-Z])|\\[,;]")
DRAWS_EQUATIONS = True
LINES = [text for method in all_methods() for text in method.equations] + [one.equation for one in PROFILES.values()]


def test_tex_indices_equations_of_a_line_and_their_pictures():
    for plain, tex in (
        ("B/H", r"\dfrac{B}{H}"), ("b/(B/H)", r"\dfrac{b}{B/H}"), ("d/(B/H)²", r"\dfrac{d}{\left(B/H\right)^{2}}"),
        ("f·PFA/(B/H)", r"\dfrac{f\cdot \mathrm{PFA}}{B/H}"), ("a/2/3", r"\dfrac{a}{2 \cdot 3}"),
        ("a/b·c", r"\dfrac{a}{b}\cdot c"), ("(1/2 + x)/(a + b)", r"\dfrac{1/2 + x}{a + b}"),
        ("(a + b)·(c + d)/e", r"\dfrac{\left(a + b\right)\cdot \left(c + d\right)}{e}"),
        ("ln(a/b)/c", r"\dfrac{\ln\left(a/b\right)}{c}"), ("Φ((x - y)/z)", r"\Phi\left(\dfrac{x - y}{z}\right)"),
        ("√(3g/4r)", r"\sqrt{\dfrac{3 g}{4 r}}"),
        ("15.6/√H (1 + B/H)^-1.5", r"\dfrac{15.6}{\sqrt{H}}\, \left(1 + B/H\right)^{-1.5}"),
        ("(1 + x)^(-1,5)", r"\left(1 + x\right)^{- 1{,}5}"), ("sin²α", r"\sin^{2}\, \alpha"),
        ("θ″ = -p²", r"\theta\mathrm{′′} = - p^{2}"), ("|a_g|/g ≤ H_f", r"\dfrac{|a_{g}|}{g} \leq H_{f}"),
        ("PFV50 = V_imp", r"\mathrm{PFV}_{50} = V_{\mathrm{imp}}"), ("B/H* = -2d", r"(B/H)^{\ast} = - 2 d"),
        ("a₁ (z/h)¹⁰", r"a_{1}\, \left(z/h\right)^{10}"), ("p = 2.5 rad/s", r"p = 2.5\;\mathrm{rad/s}"),
        ("g = 9.8 m/s²", r"g = 9.8\;\mathrm{m/s^2}"), ("ε_k = N(0; 1)", r"\varepsilon_{k} = N\left(0,\, 1\right)"),
    ):  # fmt: skip
        assert write_tex(plain) == tex, (plain, tex)
    for plain in ("", "a +", "(a + b", "a + b)", "(a]", "a ^", "√", "|a", "as given", "a § b", "a/"):
        with pytest.raises(NotationError):
            write_tex(plain)
    for text, html in (
        ("F_f = PFA/(2π PFV)", "F<sub>f</sub> = PFA/(2π PFV)"),
        ("15.6/√H (1 + B/H)^-1.5", "15.6/√H (1 + B/H)<sup>-1.5</sup>"),
        ("15,6/√202·(1 + 0,1386)^(-1,5) = 0,9", "15,6/√202·(1 + 0,1386)<sup>-1,5</sup> = 0,9"),
        ("θ″ = -p²·(a_g/g)", "θ″ = -p²·(a<sub>g</sub>/g)"),
        ("λ_A < ζ_V & x", "λ<sub>A</sub> &lt; ζ<sub>V</sub> &amp; x"),
        ("a_1<b>", "a<sub>1</sub>&lt;b&gt;"),
    ):
        assert HtmlWriter(for_print=True).words(lower_indices(text)) == html, (text, html)
    for line, equations in (
        ("Rocking starts where |a_g|/g > B/H", ["|a_g|/g > B/H"]),
        ("R = k/N   (5), PFA in cm/s²", ["R = k/N"]),
        ("Possibile dove PFA > g·(B/H) e PFV > 10·B/√H (cm, cm/s)", ["PFA > g·(B/H)", "PFV > 10·B/√H"]),
        ("a = 0,5, b = N(0; 1); c = 2", ["a = 0,5", "b = N(0; 1)", "c = 2"]),
        ("B/H = 28/202 = 0.13861", ["B/H = 28/202", "= 0.13861"]),
        ("PFA is not above PFA*: it is used as it is.", []),
        ("It overturned in 144 of 200 draws of a motion.", []),
        ("The piece (see a) has 2 sides; k of them", []),
    ):
        parts = split_line(line)
        assert [one.text for one in parts if one.tex] == equations, (line, equations)
        assert "".join(one.text for one in parts) == line, (line, equations)
    html = HtmlWriter(for_print=True).words(Equation('Rocking where |a_g|/g > B/H & "so" <on>'))
    head, picture, rest = re.fullmatch(r"(.*?)<img (.*?)>(.*)", html).groups()
    assert head == "Rocking where "
    assert 'alt="|a_g|/g &gt; B/H"' in picture
    assert picture.startswith('class="math" src="data:image/svg+xml,')
    assert rest == " &amp; &#34;so&#34; &lt;on&gt;"


@pytest.mark.parametrize("code", ["en", "it"])
@pytest.mark.slow
def test_every_equation_of_a_method_is_typeset_in_every_language(code):
    """Each has the symbols and numbers of the plain text, which is its alternative, and mathtext draws it."""
    with speaking(load_catalogue(code)):
        lines = [gettext(line) for line in LINES]
    for line, english in zip(lines, LINES, strict=True):
        parts = [one for one in split_line(line) if one.tex]
        assert parts, line
        assert len(parts) == sum(1 for one in split_line(english) if one.tex), line
        for one in parts:
            assert _symbols(_read(one.tex)) == _symbols(one.text)
            drawn = draw_math(one.tex)
            assert drawn.letters
            assert drawn.box[2] > 10


def _read(tex):
    """Return TeX with its letters as they are, without what only lays it out."""
    for name, letter in NAMED.items():
        tex = re.sub(rf"\\{name}(?![a-zA-Z])", letter, tex)
    return LAYOUT.sub("", tex).replace("{,}", ",").replace("\\", "")


def _symbols(text):
    """Return the letters, digits and relations of an equation, sorted; brackets and strokes may have gone."""
    plain = unicodedata.normalize(
        "NFKC", text.replace("½", "12").replace("−", "-").replace("″", "''").replace("′", "'")
    )
    return sorted(one for one in plain if one.isalnum() or one in "=<>≤≥±√'*+-")


def test_what_is_drawn_is_kept_and_drawn_anew_where_that_is_damaged(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr("sys.platform", "linux")
    drawn = draw_math.__wrapped__(r"\dfrac{a}{b}")
    (kept,) = (tmp_path / "assess" / "equations").iterdir()
    with monkeypatch.context() as patch:
        patch.setattr(math_figures, "_draw", None)
        assert draw_math.__wrapped__(r"\dfrac{a}{b}") == drawn
    for damage in ("", "[]", "{}", '{"box": 1}', kept.read_text()[:-9]):
        kept.write_text(damage)
        assert draw_math.__wrapped__(r"\dfrac{a}{b}") == drawn
        assert kept.read_text().endswith("}")
    monkeypatch.setattr(math_figures, "MOST_KEPT", 1)
    draw_math.__wrapped__("c")
    (tmp_path / "assess" / "equations").chmod(0o777)
    examine_folder.cache_clear()
    kept.write_text("{}")
    assert draw_math.__wrapped__(r"\dfrac{a}{b}") == drawn, "nothing is read where others can write"
    assert [path.read_text() for path in (tmp_path / "assess" / "equations").iterdir()] == ["{}"]
    examine_folder.cache_clear()
