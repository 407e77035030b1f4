"""Equations as HTML, and the hash of the script."""

import base64
import hashlib
import re

import pytest

from assess.report.pages.html import hash_script, lower_indices, write_equation


@pytest.mark.parametrize(
    ("text", "html"),
    [
        ("F_f = PFA/(2π PFV)", "F<sub>f</sub> = PFA/(2π PFV)"),
        ("15.6/√H (1 + B/H)^-1.5", "15.6/√H (1 + B/H)<sup>-1.5</sup>"),
        ("15,6/√202·(1 + 0,1386)^(-1,5) = 0,9", "15,6/√202·(1 + 0,1386)<sup>-1,5</sup> = 0,9"),
        ("θ″ = -p²·(a_g/g)", "θ″ = -p²·(a<sub>g</sub>/g)"),
        ("λ_A < ζ_V & x", "λ<sub>A</sub> &lt; ζ<sub>V</sub> &amp; x"),
        ("a_1<b>", "a<sub>1</sub>&lt;b&gt;"),
    ],
)
def test_equations(text, html):
    assert str(lower_indices(text)) == html


def test_an_equation_is_a_picture_with_the_plain_text_as_its_alternative():
    html = str(write_equation('Rocking where |a_g|/g > B/H & "so" <on>'))
    head, picture, rest = re.fullmatch(r"(.*?)<img (.*?)>(.*)", html).groups()
    assert head == "Rocking where "
    assert 'alt="|a_g|/g &gt; B/H"' in picture
    assert picture.startswith('class="math" src="data:image/svg+xml,')
    assert rest == " &amp; &#34;so&#34; &lt;on&gt;"


def test_a_page_holds_each_letter_of_its_equations_once():
    letters: dict[str, str] = {}
    lines = [str(write_equation(text, letters)) for text in ("B/H = 0.5", "B/H = 0.25")]
    used = [re.findall(r'href="#([^"]+)"', line) for line in lines]
    assert [len(one) for one in used] == [6, 7]
    assert set(letters) == {name for one in used for name in one}
    assert len(letters) == 7  # B H = 0 . 5 2
    assert all('role="img"' in line for line in lines)
    assert 'aria-label="B/H = 0.25"' in lines[1]


def test_hash():
    digest = base64.b64encode(hashlib.sha256(b"x();").digest()).decode()
    assert hash_script("x();") == f"sha256-{digest}"
