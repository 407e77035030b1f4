"""Equations as HTML, and the hash of the script."""

import base64
import hashlib

import pytest

from assess.report.pages.html import hash_script, write_equation


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
    assert str(write_equation(text)) == html


def test_hash():
    digest = base64.b64encode(hashlib.sha256(b"x();").digest()).decode()
    assert hash_script("x();") == f"sha256-{digest}"
