"""Which buildings a folder or an index has; names are data, and lead nowhere."""

import os
import sys

import pytest

from assess.errors import InputError
from assess.portfolio.sources import find_sources

posix = pytest.mark.skipif(os.name == "nt", reason="names and links that Windows does not have")


def _put(folder, *names):
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(b"x")


def _paths(found):
    return [one.path for one in found]


def test_a_folder_is_searched_with_those_in_it_and_without_what_is_no_building(tmp_path):
    _put(tmp_path, "b.xlsx", "a/deep/c.XLSM", "a/notes.txt", ".hidden/d.xlsx", ".e.xlsx", "~$b.xlsx")
    _put(tmp_path, "run/report.xlsx", "run/results.json", "mine/report.xlsx", "city/ranking.xlsx")
    _put(tmp_path, "city/portfolio.json", "change/compare.xlsx", "change/compare.json", "out/b.xlsx")
    found = find_sources(tmp_path, tmp_path / "out")
    assert _paths(found) == ["a/deep/c.XLSM", "b.xlsx", "mine/report.xlsx"]
    assert [one.kind for one in found] == ["workbook"] * 3
    assert not any(one.refused for one in found)
    assert found[0].file == tmp_path / "a" / "deep" / "c.XLSM"


@pytest.mark.parametrize("ending", [".xls", ".ods", ".XLS"])
def test_a_workbook_of_another_format_is_a_building_that_is_refused_with_what_to_do(tmp_path, ending):
    _put(tmp_path, f"sub/old{ending}", "~$old.xls", ".hidden.ods")
    (found,) = find_sources(tmp_path)
    assert found.path == f"sub/old{ending}"
    assert found.refused == f"workbooks ending in {ending.lower()} are not read."
    assert found.fix == "Save it as .xlsx (Excel Workbook) and remove this file."
    index = tmp_path / "index.csv"
    index.write_text(f"path\nsub/old{ending}\n", encoding="utf-8")
    (listed,) = find_sources(index)
    assert listed.refused == found.refused
    assert listed.fix == "Save it as .xlsx (Excel Workbook) and name that file."


@posix
def test_names_that_attack_are_kept_as_they_are(tmp_path):
    names = ["=1+1.xlsx", "<script>alert(1).xlsx", "a\nb.xlsx", "x" * 240 + ".xlsx", "A.xlsx", "a.xlsx", "%2e%2e.xlsx"]
    _put(tmp_path, *names)
    found = find_sources(tmp_path)
    assert sorted(_paths(found)) == sorted(names)
    assert not any(one.refused for one in found)


@posix
@pytest.mark.skipif(sys.platform == "darwin", reason="names are UTF-8 there")
def test_a_name_that_is_not_utf_8_becomes_a_text_that_can_be_written(tmp_path):
    os.close(os.open(os.fsencode(tmp_path) + b"/caf\xe9.xlsx", os.O_CREAT))
    (found,) = find_sources(tmp_path)
    assert found.path == "caf\\xe9.xlsx"
    assert found.path.encode("utf-8")
    assert found.file.exists()


@posix
def test_links_that_lead_out_are_refused_and_those_inside_are_buildings(tmp_path):
    root, outside = tmp_path / "in", tmp_path / "out"
    _put(root, "a.xlsx")
    _put(outside, "secret.xlsx")
    (root / "inside.xlsx").symlink_to(root / "a.xlsx")
    (root / "leads-out.xlsx").symlink_to(outside / "secret.xlsx")
    (root / "folder").symlink_to(outside)
    (root / "gone.xlsx").symlink_to(root / "nothing.xlsx")
    (root / "round.xlsx").symlink_to(root / "round.xlsx")
    found = {one.path: (str(one.refused), str(one.fix)) for one in find_sources(root)}
    assert found["a.xlsx"] == found["inside.xlsx"] == ("", "")
    assert found["leads-out.xlsx"] == ("it is a link that leads out of the folder.", "Copy the workbook here.")
    assert found["folder"] == ("it is a link to a folder, which is not searched.", "Copy the folder here.")
    nowhere = "it is a link that leads to no file, or in a circle.", "Copy the workbook here in place of the link."
    assert found["gone.xlsx"] == found["round.xlsx"] == nowhere


def test_a_folder_without_workbooks_a_workbook_and_nothing_are_errors(tmp_path):
    with pytest.raises(InputError, match="there is no workbook"):
        find_sources(tmp_path)
    _put(tmp_path, "one.xlsx")
    with pytest.raises(InputError, match="is a workbook: name the folder that holds it"):
        find_sources(tmp_path / "one.xlsx")
    with pytest.raises(InputError, match=r"neither a folder nor an index \(.csv\)"):
        find_sources(tmp_path / "none")


def test_an_index_names_buildings_below_its_folder_alone(tmp_path):
    _put(tmp_path / "in", "a.xlsx", "sub/b.xlsx")
    _put(tmp_path, "secret.xlsx")
    index = tmp_path / "in" / "index.csv"
    lines = [
        "path,building,use,floor_area_m2", "sub\\b.xlsx,,,", "./a.xlsx,Named,,", "../secret.xlsx,,,", "gone.xlsx,,,",
        f"{tmp_path}/secret.xlsx,,,", "C:\\x.xlsx,,,", "a.pdf,,,", ",No survey,office,1000",
    ]  # fmt: skip
    index.write_text("\n".join(lines), encoding="utf-8")
    found = {one.path: one for one in find_sources(index)}
    assert found["a.xlsx"].index.building == "Named"
    assert found["sub/b.xlsx"].file == tmp_path / "in" / "sub" / "b.xlsx"
    outside = "the path leads out of the folder of the index"
    refused = {path: str(one.refused) for path, one in found.items() if one.refused}
    assert all(found[path].fix for path in refused)
    assert refused.keys() == {"../secret.xlsx", "gone.xlsx", f"{tmp_path.as_posix()}/secret.xlsx", "C:/x.xlsx", "a.pdf"}
    assert outside in refused["../secret.xlsx"]
    assert outside in refused["C:/x.xlsx"]
    assert refused["gone.xlsx"] == "there is no such file."
    assert "has to end in .xlsx or .xlsm" in refused["a.pdf"]
    assert (found["No survey"].kind, found["No survey"].file) == ("assumed", None)
