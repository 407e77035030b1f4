"""Lines added to a STEP file: texts, numbers and identifiers as ifcopenshell reads them, all other bytes kept."""

import re
from typing import Any

import ifcopenshell
import ifcopenshell.guid
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assess.bim.export_properties import (
    LONGEST_LABEL,
    append_lines,
    make_global_id,
    make_uuid,
    write_label,
    write_real,
    write_text,
)
from assess.errors import ModelError
from assess.plain_text import plain_line

MODEL = b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=IFCLABEL('ENDSEC;');\nENDSEC;\nEND-ISO-10303-21;\n"


def read_back(value: str) -> Any:
    """Return a value as ifcopenshell reads it."""
    header = "HEADER;FILE_DESCRIPTION((''),'2;1');FILE_NAME('','',(''),(''),'','','');FILE_SCHEMA(('IFC4'));ENDSEC;"
    model = ifcopenshell.file.from_string(
        f"ISO-10303-21;{header}DATA;#1=IFCPROPERTYSINGLEVALUE('N',$,{value},$);ENDSEC;END-ISO-10303-21;"
    )
    return model.by_id(1).NominalValue.wrappedValue


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("d'angolo", "'d''angolo'"),
        ("a\\b", "'a\\\\b'"),
        ("perché – è", "'perch\\X2\\00E9\\X0\\ \\X2\\2013\\X0\\ \\X2\\00E8\\X0\\'"),
        ("é🏢é", "'\\X2\\00E9\\X0\\\\X4\\0001F3E2\\X0\\\\X2\\00E9\\X0\\'"),
        ("two\nlines", "'two lines'"),
        ("bell\x07", "'bell\\X2\\FFFD\\X0\\'"),
    ],
)
def test_texts_are_ascii_on_one_line(text, written):
    assert write_text(text) == written


@settings(max_examples=40)
@given(st.text(st.characters(codec="utf-8"), max_size=40))
@pytest.mark.slow
def test_every_text_comes_back(text):
    assert read_back(write_label(text)) == plain_line(text)


def test_a_label_is_no_longer_than_the_schema_allows():
    value = read_back(write_label("è" * 300))
    assert (len(value), value[-2:]) == (LONGEST_LABEL, "è…")


@settings(max_examples=40)
@given(st.floats(min_value=-1e12, max_value=1e12))
def test_every_number_comes_back(number):
    text = write_real(number)
    assert re.fullmatch(r"IFCREAL\(-?\d+\.\d*(E-?\d+)?\)", text)
    assert read_back(text) == number


def test_identifiers_are_those_of_their_numbers():
    for at in range(50):
        found = make_global_id("property set", str(at))
        assert ifcopenshell.guid.expand(found) == make_uuid("property set", str(at)).hex
        assert (len(found), found[0] in "0123") == (22, True)
    assert make_global_id("a", "b") == make_global_id("a", "b") != make_global_id("a", "c")
    assert make_global_id("a", "b") != make_global_id("b", "a")


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_lines_stand_before_the_last_endsec_with_the_ends_of_the_file(end):
    data = MODEL.replace(b"\n", end.encode())
    found = append_lines(data, ["#2=A();", "#3=B();"], "m.ifc")
    before, after = data[: data.rindex(b"ENDSEC;")], data[data.rindex(b"ENDSEC;") :]
    assert found == before + f"#2=A();{end}#3=B();{end}".encode() + after


def test_a_file_on_one_line_and_with_remarks_at_its_end_is_extended():
    data = b"ISO-10303-21;HEADER;ENDSEC;DATA;#1=A();ENDSEC ;/* a **remark** */ END-ISO-10303-21;"
    found = append_lines(data, ["#2=B();"], "m.ifc")
    assert found == data.replace(b"ENDSEC ;", b"\n#2=B();\nENDSEC ;")


@pytest.mark.parametrize("end", [b"", b"ENDSEC;\n", b"END-ISO-10303-21;\n", b"ENDSEC;\n#9=A();\nEND-ISO-10303-21;\n"])
def test_a_file_with_another_end_is_refused(end):
    with pytest.raises(ModelError, match=r"m.ifc does not end as an IFC file does"):
        append_lines(b"ISO-10303-21;\nDATA;\n#1=A();\n" + end, ["#2=B();"], "m.ifc")
