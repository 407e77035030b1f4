"""Which reader takes a file is told by its content; what none takes is refused in words, and stays bounded."""

import subprocess
import sys
from pathlib import Path

import pytest

from assess.bim.read_source import read_source
from assess.errors import AssessError, InputError, ModelError
from tests.bim.cobie_files import write_cobie
from tests.bim.ifc_files import one_room
from tests.motion.writers import zipped

MODELS = Path(__file__).parents[2] / "samples" / "models"
LARGE = (MODELS / "LargeBuilding.ifc").read_bytes()
NO_ENTITIES = b"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n#1=(;\nENDSEC;\nEND-ISO-10303-21;\n"
SHELF = (0, 0, 0, 0.4, 0.8, 1.9)


@pytest.mark.slow
def test_a_model_is_known_whatever_its_name(tmp_path):
    name = "renamed.xlsx"
    model, _, room = one_room()
    model.piece("Shelf", SHELF, within=room, at=(2, 1, 0))
    path = model.write(tmp_path / "a.ifc").rename(tmp_path / name)
    assert [row["description"] for row in read_source(path, name).items] == ["Shelf"]


def test_a_cobie_file_is_known_whatever_its_name_and_what_nothing_reads_is_refused(tmp_path):
    path = write_cobie(tmp_path / "handover.xlsx").rename(tmp_path / "handover.ifc")
    assert len(read_source(path, "handover.ifc").items) == 2
    with pytest.raises(ModelError, match="holds no positions, so that no routes can be drafted"):
        read_source(path, "handover.ifc", routes="draft")
    (tmp_path / "a.rvt").write_bytes(b"\xd0\xcf\x11\xe0" + bytes(100))
    with pytest.raises(ModelError, match=r"a\.rvt is of a kind that is not imported: name an IFC model"):
        read_source(tmp_path / "a.rvt", "a.rvt")
    with pytest.raises(InputError, match=r"a\.ifc does not exist. Check the name and the folder"):
        read_source(tmp_path / "a.ifc", "a.ifc")
    with pytest.raises(InputError, match=r"a\.ifc is a folder\. Name the file in it"):
        read_source(tmp_path, "a.ifc")
    path = tmp_path / "a.ifc"
    with path.open("wb") as file:
        file.write(LARGE[:4096])
        file.truncate(2 * 2**30)
    with pytest.raises(ModelError, match=r"it has 2,048 MB, more than 512 MB\. Export fewer storeys"):
        read_source(path, "a.ifc")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "a.ifc cannot be read: it is empty. Export the building again."),
        (b"%PDF-1.7\n" + bytes(1000), "it does not begin as an IFC file (ISO-10303-21) does."),
        (LARGE[: len(LARGE) // 2], "its last line, END-ISO-10303-21;, is missing. Copy or export it again."),
        (LARGE[:-20], "its last line, END-ISO-10303-21;, is missing."),
        (b"<?xml version='1.0'?>\n<ifcXML xmlns='x'/>", "it is an ifcXML file. Export the building as IFC"),
        (zipped({"a.ifc": LARGE}), "it is packed as a zip file. Unpack it and import the .ifc file in it."),
        (b"PK\x03\x04" + bytes(200), "a.ifc is damaged: it cannot be unpacked."),
        (LARGE.replace(b"'IFC2X3'", b"'IFC1X9'", 1), "its schema is IFC1X9, expected one of: IFC2X3, IFC4, IFC4X3."),
        (LARGE.replace(b"LENGTHUNIT", b"AREAUNIT"), "a.ifc has no unit of length"),
        (b"ISO-10303-21;\nHEADER;\nENDSEC;\nEND-ISO-10303-21;\n", "its schema is -, expected one of"),
        (NO_ENTITIES, "a.ifc is damaged: "),
    ],
)  # fmt: skip
def test_what_is_no_model_is_refused_in_words(tmp_path, data, message):
    path = tmp_path / "a.ifc"
    path.write_bytes(data)
    with pytest.raises(AssessError) as caught:
        read_source(path, "a.ifc")
    assert message in caught.value.message


@pytest.mark.slow
def test_a_million_entities_more_change_nothing_and_more_pieces_than_are_read_are_refused(tmp_path):
    at = LARGE.rindex(b"ENDSEC;")
    path = tmp_path / "a.ifc"
    with path.open("wb") as file:
        file.write(LARGE[:at])
        file.writelines(b"#%d=IFCCARTESIANPOINT((%d.,0.,0.));\n" % (10**6 + n, n) for n in range(10**6))
        file.write(LARGE[at:])
    assert len(read_source(path, "a.ifc").items) == 14
    at = LARGE.rindex(b"ENDSEC;")
    path = tmp_path / "a.ifc"
    one = b"#%d=IFCFURNISHINGELEMENT('0%021d',$,'x',$,$,$,$,$);\n"
    path.write_bytes(LARGE[:at] + b"".join(one % (10**6 + n, n) for n in range(20_000)) + LARGE[at:])
    with pytest.raises(ModelError, match=r"holds 20,014 pieces of furniture, more than 20,000\. Export"):
        read_source(path, "a.ifc")


@pytest.mark.slow
def test_without_the_library_one_line_tells_how_to_install_it(tmp_path):
    """The library is hidden from a process of its own, as on a machine without the extra."""
    code = "import sys; sys.modules['ifcopenshell'] = None; from assess.__main__ import main; main()"
    command = [sys.executable, "-c", code, "import", MODELS / "duplex.ifc", "-o", tmp_path / "b.xlsx"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.strip().splitlines() == [
        "error  Building models (IFC) need the library ifcopenshell. Install it from the folder of the source code of "
        "assess: python -m pip install '.[ifc]', or with pipx: pipx install --force '.[ifc]'"
    ]
    assert not (tmp_path / "b.xlsx").exists()
