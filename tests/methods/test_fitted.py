"""Fitted models as methods: the file comes back as written, every fault is told, and no adopted risk goes by them."""

import contextlib
import dataclasses
import math
import os
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings as examples, strategies as st

from assess.errors import InputError
from assess.i18n import load_catalogue, speaking
from assess.methods import Cases, FittedOn, Method, Range, proposed_or
from assess.methods.fitted import QUANTITIES, Fitted, Polynomial, Probit, parse_model, read_model, write_model
from assess.settings import Settings
from assess.units import GRAVITY
from tests.methods import test_contract as contract

k = proposed_or.COEFFICIENTS
EQ9 = Polynomial("1/x", ((0, 0, k.a), (1, 0, k.b), (0, 1, k.c), (2, 0, k.d), (0, 2, k.e), (1, 1, k.f)))
ON = "3 buildings, 21 channels, 100 motions each, seed 1"
SURFACE = Fitted(
    key="fitted_surface", title="Surface (8)", formula=EQ9,
    fitted=FittedOn(data=ON, error=0.1234, spread=0.02, constant=0.4321),
    ranges={
        "breadth_to_height": Range(0.1, 0.5), "pfa_g": Range(0.1, 0.9, "g"), "height_cm": Range(90.0, 210.0, "cm"),
        "pfv_cm_s": Range(4.0, 150.0, "cm/s"), "pfv_over_pfa_s": Range(0.03, 0.25, "s"),
    },
)  # fmt: skip
PROBIT = dataclasses.replace(SURFACE, key="fitted_probit", title="Probit with size", formula=Probit(-1.2, 1.8, 0.9))
PUBLISHED = ("test_no_shaking",)
"""Test of the contract for published methods alone: a fitted surface gives some risk at rest."""
NO_FILE = "it is not a file: name the .toml file that `assess study fit` wrote."
BOTH = pytest.mark.parametrize("model", [SURFACE, PROBIT], ids=lambda model: model.kind)


def saved(folder, model=SURFACE, name="m.toml"):
    path = folder / name
    path.write_text(write_model(model), encoding="utf-8")
    return path


def spoilt(folder, old, new, model=SURFACE):
    text = write_model(model)
    assert text.count(old) == 1, old
    path = folder / "m.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


def of(model) -> Method:
    from assess.methods.fitted import build_method

    return build_method(model, "m.toml")


def evaluate(model, **cases):
    return of(model).evaluate(Cases.of(**cases), Settings())


numbers = st.floats(-1e30, 1e30)
ranges = st.tuples(st.floats(0, 1e6), st.floats(0, 1e6, exclude_min=True)).map(sorted)
powers = st.tuples(st.integers(0, 3), st.integers(0, 3))
polynomials = st.builds(
    lambda base, terms: Polynomial(base, tuple((i, j, c) for (i, j), c in terms.items())),
    st.sampled_from(["x", "1/x"]), st.dictionaries(powers, numbers, min_size=1, max_size=16),
)  # fmt: skip
probits = st.builds(Probit, numbers, st.floats(0, 1e30), st.floats(0, 1e30))
texts = st.text(st.characters(exclude_categories=["C", "Z"], include_characters=' "\\{}<>&#'), max_size=50)
models = st.builds(
    lambda key, title, on, formula, ends, error: Fitted(
        key="fitted_" + key, title="A" + title, formula=formula,
        fitted=FittedOn(data="1" + on, error=error, spread=error / 3, constant=error * 1.1),
        ranges={
            name: Range(end[0], end[1], one.unit) for end, (name, one) in zip(ends, QUANTITIES.items(), strict=True)
        },
    ),
    st.from_regex(r"[a-z0-9]{1,20}", fullmatch=True), texts, texts, st.one_of(polynomials, probits),
    st.tuples(ranges, ranges, ranges, ranges, ranges), st.floats(0, 1),
)  # fmt: skip


class TestFile:
    @examples(deadline=None, max_examples=200)
    @given(model=models)
    @pytest.mark.slow
    def test_what_is_written_comes_back(self, model):
        assert parse_model(write_model(model), "m.toml") == model

    @pytest.mark.parametrize("change", [lambda text: "\ufeff" + text, lambda text: text.replace("\n", "\r\n")])
    def test_files_of_windows_are_read(self, tmp_path, change):
        path = tmp_path / "m.toml"
        path.write_bytes(change(write_model(SURFACE)).encode())
        assert read_model(path).key == "fitted_surface"

    def test_what_could_not_be_read_back_is_not_written_and_numpy_numbers_are_written_as_numbers(self):
        fitted = dataclasses.replace(SURFACE.fitted, error=math.nan)
        with pytest.raises(InputError, match=r"the model: errors\.leave_one_out_rmse is nan, expected a number"):
            write_model(dataclasses.replace(SURFACE, fitted=fitted))
        with pytest.raises(InputError, match="the model: key is 'surface', expected fitted_ and then small letters"):
            write_model(dataclasses.replace(SURFACE, key="surface"))
        formula = Probit(*(np.float64(one) for one in (-1.2, 1.8, 0.9)))
        assert parse_model(write_model(dataclasses.replace(PROBIT, formula=formula)), "m") == PROBIT

    def test_every_fault_names_the_file_the_key_and_the_mend(self, tmp_path):
        for old, new, told in (
            ("format = 1", "format = 2", "format is 2, expected 1. Have a study of this version write the file."),
            ("format = 1", "", "format is missing, expected 1"),
            ('kind = "polynomial"', 'kind = "spline"', "kind is 'spline', expected one of: polynomial, probit."),
            ('kind = "polynomial"', "kind = 3", "kind is 3, expected one of"),
            ('kind = "polynomial"', 'kind = "probit"', "probit is missing. Add it"),
            ('key = "fitted_surface"', 'key = "proposed_or"', "key is 'proposed_or', expected fitted_ and then"),
            ('key = "fitted_surface"', 'key = "fitted_a_raw"', "not ending in _raw or _flags."),
            ('key = "fitted_surface"', 'key = "fitted_../x"', "key is 'fitted_../x', expected"),
            ('key = "fitted_surface"', "", "key is missing. Add it, or have the study write the file again."),
            ('title = "Surface (8)"', 'title = ""', "title is '', expected a text of 1 to 60 characters."),
            ('title = "Surface (8)"', f'title = "{"x" * 61}"', "expected a text of 1 to 60 characters."),
            ('title = "Surface (8)"', 'title = "=HYPERLINK()"', "title begins with '=', expected a letter or a digit."),
            ('title = "Surface (8)"', 'title = "a\\u001b[31mb"', "title holds the character '\\x1b', which cannot be"),
            ('title = "Surface (8)"', 'title = "a\\u202eb"', "title holds the character '\\u202e'"),
            ('title = "Surface (8)"', 'title = "a\\nb"', "title holds the character '\\n'"),
            ("pfa_g = [0.1, 0.9]", "pfa_g = [0.9, 0.1]", "range.pfa_g is [0.9, 0.1], expected the lowest first."),
            ("pfa_g = [0.1, 0.9]", "pfa_g = 0.9", "range.pfa_g is 0.9, expected [lowest, highest]."),
            ("pfa_g = [0.1, 0.9]", "pfa_g = [-1, 0.9]", "range.pfa_g is -1, expected a number from 0 to 1e+30."),
            ("pfa_g = [0.1, 0.9]", "pfa_g = [-0.2, -0.1]", "range.pfa_g is -0.2, expected a number from 0 to 1e+30."),
            ("pfa_g = [0.1, 0.9]", "pfa_g = [0.0, -0.1]", "range.pfa_g is -0.1, expected a number from 0 to 1e+30."),
            ("pfa_g = [0.1, 0.9]", "pfa_g = [0.0, 0.0]", "range.pfa_g is [0.0, 0.0], expected the highest above 0"),
            ("height_cm = [90.0, 210.0]", "height_cm = [-0.0, 0]", "height_cm is [-0.0, 0], expected the highest"),
            ("pfa_g = [0.1, 0.9]", "pfa = [0.1, 0.9]", "range.pfa_g is missing."),
            ("pfa_g = [0.1, 0.9]", "pfa_g = [0.1, 0.9]\ndate = 1", "range.'date' is unknown. Remove it; expected are:"),
            ("[range]", "[ranges]", "range is missing."),
            ("pfv_over_pfa_s = [0.03, 0.25]\n", "", "range.pfv_over_pfa_s is missing. Add it, or have the study write"),
            ("[0.03, 0.25]", "[0.25, 0.03]", "range.pfv_over_pfa_s is [0.25, 0.03], expected the lowest first."),
            ("constant_rmse = 0.4321\n", "", "errors.constant_rmse is missing. Add it, or have the study write"),
            ("constant_rmse = 0.4321", "constant_rmse = -1", "errors.constant_rmse is -1, expected a number from 0 to"),
            ("constant_rmse = 0.4321", "constant = 0.4321", "errors.constant_rmse is missing."),
            ("leave_one_out_rmse = 0.1234", "leave_one_out_rmse = nan", "errors.leave_one_out_rmse is nan, expected"),
            ("leave_one_out_rmse = 0.1234", "leave_one_out_rmse = true", "errors.leave_one_out_rmse is True, expected"),
            ('base = "1/x"', 'base = "ln x"', "polynomial.base is 'ln x', expected \"x\" for B/H"),
            (repr(k.b), "inf", "polynomial.terms[1] is inf, expected a number of at most 1e+30."),
            (repr(k.b), "1" + "0" * 400, "polynomial.terms[1] is a number of over 40 digits, expected a number"),
            (repr(k.b), '"0.3"', "polynomial.terms[1] is '0.3', expected a number"),
            (f"[1, 0, {k.b!r}]", f"[1, 0, 0, {k.b!r}]", "terms[1] is [1, 0, 0, 0.30856415], expected [i, j,"),
            (f"[1, 0, {k.b!r}]", f"[4, 0, {k.b!r}]", "terms[1] has the power 4, expected a whole number"),
            (f"[1, 0, {k.b!r}]", f"[1.0, 0, {k.b!r}]", "terms[1] has the power 1.0, expected a whole number"),
            (f"[1, 0, {k.b!r}]", f"[0, 1, {k.b!r}]", "polynomial.terms[2] has the powers 0, 1 of another term."),
            ("terms = [", "terms = 3\nrest = [", "polynomial.'rest' is unknown."),
            ("[errors]", "[errors", "the file is not valid TOML: "),
            ("[errors]", "a = " + "[" * 5000, "the file is not valid TOML: "),
            ("[errors]", "a = " + "9" * 5000, "the file is not valid TOML: "),
        ):  # fmt: skip
            with pytest.raises(InputError) as caught:
                read_model(spoilt(tmp_path, old, new))
            assert str(caught.value).startswith(f"{tmp_path / 'm.toml'}: ")
            assert told in str(caught.value), (old, new)
            assert "\x1b" not in str(caught.value)
        with pytest.raises(InputError, match=re.escape("probit.b1 is -0.1, expected a number from 0 to 1e+30.")):
            read_model(spoilt(tmp_path, "b1 = 1.8", "b1 = -0.1", PROBIT))
        assert read_model(spoilt(tmp_path, "pfa_g = [0.1, 0.9]", "pfa_g = [0, 0.9]")).valid["pfa"].low == 0

    def test_files_that_are_none(self, tmp_path):
        with pytest.raises(InputError, match="there is no such file"):
            read_model(tmp_path / "none.toml")
        with pytest.raises(InputError, match=re.escape(f"{tmp_path}: {NO_FILE}")):
            read_model(tmp_path)
        large, binary = tmp_path / "large.toml", tmp_path / "binary.toml"
        large.write_text(write_model(SURFACE) + "#" * 66_000)
        binary.write_bytes(b"\xff\xfe\x00")
        with pytest.raises(InputError, match=r"large\.toml: the file is larger than 64 kB"):
            read_model(large)
        with pytest.raises(InputError, match=r"binary\.toml: the file is not a UTF-8 text"):
            read_model(binary)

    @pytest.mark.skipif(os.name == "nt", reason="a device has no path there")
    def test_a_device_is_no_file(self):
        with pytest.raises(InputError, match=re.escape(f"{os.devnull}: {NO_FILE}")):
            read_model(Path(os.devnull))

    @examples(deadline=None, max_examples=300)
    @given(data=st.data())
    @pytest.mark.slow
    def test_damaged_files_are_told_and_nothing_else_is_raised(self, data):
        text = write_model(data.draw(st.sampled_from([SURFACE, PROBIT])))
        at = data.draw(st.integers(0, len(text) - 1))
        put = data.draw(st.text(max_size=3))
        damaged = text[:at] + put + text[at + data.draw(st.integers(0, 5)) :]
        with contextlib.suppress(InputError):
            model = parse_model(damaged, "m.toml")
            assert parse_model(write_model(model), "m.toml") == model


@BOTH
class TestMethod:
    """Fitted models keep to what every method keeps to."""

    def test_the_contract_of_methods(self, model):
        method, classes = of(model), (contract.TestBatch, contract.TestUnknown, contract.TestDescription)
        tests = {name: getattr(one(), name) for one in classes for name in dir(one) if name.startswith("test_")}
        for name in PUBLISHED:
            del tests[name]
        assert len(tests) >= 16
        for test in tests.values():
            test(method)

    def test_title_and_reference_say_what_it_is(self, model, tmp_path):
        method = read_model(saved(tmp_path, model))
        assert method.title == f"{model.title} (fitted on 3 buildings)"
        assert re.fullmatch(
            rf"{re.escape(model.title)}\. m\.toml, SHA-256 [0-9a-f]{{64}}\. Fitted to computed chances on {ON}; where "
            r"a building is left out of the fit, the error for it is 0\.123 \(root mean square, standard error 0\.020\)"
            r"; a constant, the mean chance of the other buildings, has 0\.432\. For a building .* than a constant, .*",
            str(method.reference),
        )

    def test_a_long_list_of_data_is_cut_in_the_title_only(self, model):
        method = of(dataclasses.replace(model, fitted=dataclasses.replace(model.fitted, data="a" * 100)))
        assert method.title == f"{model.title} (fitted on {'a' * 39}…)"
        assert "a" * 100 in method.reference.remark

    @pytest.mark.parametrize(
        ("error", "told"),
        [
            (0.1, "it is better than a constant, "),
            (0.37, "Beware: for a building that it was not fitted to, it is hardly better than a constant, "),
            (0.3996, "Beware: for a building that it was not fitted to, it is no better than a constant, "),
            (0.5, "Beware: for a building that it was not fitted to, it is no better than a constant, "),
        ],
    )
    def test_how_it_does_beside_a_constant_is_said(self, model, error, told):
        method = of(dataclasses.replace(model, fitted=FittedOn(data=ON, error=error, spread=0.05, constant=0.4)))
        assert told in method.assumptions[0]
        assert method.reference.remark.endswith(f"has 0.400. {method.assumptions[0]}")

    def test_the_ranges_of_its_data_are_shown_to_three_digits(self, model):
        ratio = Range(0.0312345, 0.25, "s")
        shown = of(dataclasses.replace(model, ranges={**model.ranges, "pfv_over_pfa_s": ratio})).valid
        assert shown["PFV/PFA"] == Range(0.0312, 0.25, "s")
        assert list(shown) == ["breadth_to_height", "pfa", "height", "pfv", "PFV/PFA"]

    def test_extrapolated_outside_any_range(self, model):
        inside = {"breadth": 0.45, "height": 1.5, "pfa": 0.4 * GRAVITY, "pfv": 0.5}
        assert not evaluate(model, **inside).flags["extrapolated"][0]
        for change in (
            {"breadth": 0.14}, {"breadth": 0.76}, {"pfa": 0.97}, {"pfa": 0.91 * GRAVITY}, {"pfv": 0.039}, {"pfv": 1.51},
            {"breadth": 0.3, "height": 0.89}, {"height": 2.11},
            {"pfv": 0.029 * 0.4 * GRAVITY}, {"pfv": 0.251 * 0.4 * GRAVITY},  # inside the PFV, outside PFV/PFA
        ):  # fmt: skip
            assert evaluate(model, **inside | change).flags["extrapolated"][0], change
        peaks = {"pfa": [0.1 * GRAVITY, 0.9 * GRAVITY], "pfv": [0.04, 1.5]}
        assert not evaluate(model, breadth=[0.09, 1.05], height=[0.9, 2.1], **peaks).flags["extrapolated"].any()
        pfv = np.array([0.03, 0.25]) * 0.4 * GRAVITY  # both ends of the ratio of the peaks belong to it
        assert not evaluate(model, breadth=0.45, height=1.5, pfa=0.4 * GRAVITY, pfv=pfv).flags["extrapolated"].any()


class TestValues:
    def test_equation_9_saved_is_the_raw_value_of_the_published_method(self):
        cases = contract.random_batch()
        found = of(SURFACE).evaluate(cases, Settings())
        raw = proposed_or.evaluate(cases, Settings()).detail["raw"]
        np.testing.assert_allclose(found.detail["raw"], raw, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(found.value, np.clip(raw, 0, 1), atol=1e-9)
        np.testing.assert_array_equal(found.flags["clipped"], found.value != found.detail["raw"])
        assert found.flags["clipped"].any()

    def test_table_3_of_the_paper(self):
        # AL1: B/H 0.32 at 0.41 g gives 0.66; AL2: 0.14 at 0.19 g gives 0.67
        found = evaluate(SURFACE, breadth=[0.32, 0.14], height=1.0, pfa=np.array([0.41, 0.19]) * GRAVITY)
        np.testing.assert_allclose(found.detail["raw"], [0.66, 0.67], atol=0.0051)

    def test_a_polynomial_in_x_worked_by_hand(self):
        # 0.5 - 2·0.25 + 0.001·200 + 0.01·0.25²·200 = 0.325
        terms = ((0, 0, 0.5), (1, 0, -2.0), (0, 1, 0.001), (2, 1, 0.01))
        model = dataclasses.replace(SURFACE, formula=Polynomial("x", terms))
        assert evaluate(model, breadth=0.5, height=2.0, pfa=2.0).value[0] == pytest.approx(0.325)

    def test_a_probit_worked_by_hand(self):
        # B 0.3, H 0.4 m: p = sqrt(3 g); PFA = 0.75 g, so A = 1; PFV so that V = e: R = Phi(-1.2 + 0.9)
        pfv = math.e * 0.75 * GRAVITY / math.sqrt(3 * GRAVITY)
        found = evaluate(PROBIT, breadth=0.3, height=0.4, pfa=0.75 * GRAVITY, pfv=pfv).value[0]
        assert found == pytest.approx(0.38208857781)

    def test_a_piece_of_unknown_velocity_is_not_shown_to_lie_inside_and_a_probit_needs_it(self):
        found = evaluate(SURFACE, breadth=0.45, height=1.5, pfa=0.4 * GRAVITY)
        assert not math.isnan(found.value[0])
        assert found.flags["extrapolated"][0]
        assert of(SURFACE).flags["extrapolated"].endswith("or PFV is unknown, so that it may be outside")
        assert of(PROBIT).flags["extrapolated"] == "outside the data that it was fitted to"
        found = evaluate(PROBIT, breadth=0.3, height=1.8, pfa=3.0)
        assert math.isnan(found.value[0])
        assert found.flags["pfv_unknown"][0]

    def test_no_number_overflows(self):
        wild = Polynomial("1/x", tuple((i, j, (-1) ** i * 1e30) for i in range(4) for j in range(4)))
        found = evaluate(dataclasses.replace(SURFACE, formula=wild), breadth=[0.0, 1e-300, 0.05], height=3.0, pfa=50.0)
        assert not np.isinf(found.detail["raw"]).any()
        assert not (found.value > 1).any()

    def test_equations_are_written_in_the_language_of_the_report(self):
        from assess.i18n import gettext

        assert of(SURFACE).equations[0] == "R = a + b/(B/H) + c·PFA + d/(B/H)² + e·PFA² + f·PFA/(B/H), PFA in cm/s²"
        assert of(SURFACE).equations[1] == "a = -0.97758451; b = 0.30856415; c = 0.0032112873"
        with speaking(load_catalogue("it")):
            assert gettext(of(SURFACE).equations[1]) == "a = -0,97758451; b = 0,30856415; c = 0,0032112873"
            assert gettext(of(SURFACE).title) == "Surface (8) (adattato a 3 buildings)"
