"""What a run says of the buildings that it skipped."""

from assess.portfolio.run_portfolio import run_portfolio
from assess.settings import Settings
from tests.portfolio.staged import StagedGround, write_city
from tests.workbook.books import write_book


def _run(tmp_path):
    ground = StagedGround(tmp_path)
    return run_portfolio(
        tmp_path / "city", tmp_path / "out", Settings(verify="none"), ground=ground, jobs=1, formats=("parquet",)
    )


def test_why_a_building_was_skipped_begins_a_sentence_and_does_not_name_its_file_again(tmp_path):
    city = write_city(tmp_path / "city", [40.0])
    (city / "sub").mkdir()
    (city / "sub" / "text.xlsx").write_bytes(b"text")
    (city / "empty.xlsx").write_bytes(b"")
    (city / "old.xls").write_bytes(b"")
    write_book(city / "other.xlsx", {"Sheet": [["hi"]]})
    found = dict(_run(tmp_path).skipped)
    missing = "the sheet is missing. Add it, or start from a workbook made with `assess new`."
    assert found.pop("other.xlsx") in (f"Items: {missing}", f"Floors: {missing}")
    assert found == {
        "sub/text.xlsx": "It is not an Excel workbook (.xlsx). Save it from Excel as .xlsx.",
        "empty.xlsx": "It is empty (0 bytes). Download or copy it again.",
        "old.xls": "Workbooks ending in .xls are not read. Save it as .xlsx (Excel Workbook) and remove this file.",
    }
