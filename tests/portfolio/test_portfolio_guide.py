"""The guide to the portfolio: its queries run on tables of the fixed schema, and give what they promise."""

import re
from pathlib import Path

import pytest

from assess.portfolio.sources import COLUMNS
from assess.portfolio.table_schemas import TABLES
from tests.portfolio.city_samples import make_view

duckdb = pytest.importorskip("duckdb")
GUIDE = (Path(__file__).parents[2] / "docs" / "portfolio.md").read_text(encoding="utf-8")
QUERIES = re.findall(r"^```sql\n(.*?)^```", GUIDE, re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def view():
    return make_view(60, draws=40)


@pytest.fixture
def asked(view, tmp_path, monkeypatch):
    """Return the rows of each query of the guide, on tables beside which they run."""
    folder = tmp_path / "bay-portfolio"
    folder.mkdir()
    connection = duckdb.connect()
    for name in TABLES:
        table = getattr(view, name)
        connection.register("given", table)
        target = (folder / f"{name}.parquet").as_posix()
        connection.execute(f"COPY (SELECT * FROM given) TO '{target}' (FORMAT parquet)")
    monkeypatch.chdir(tmp_path)
    return [connection.execute(query).fetch_df() for query in QUERIES]


def test_every_query_runs_and_answers_what_it_says(asked, view):
    falls, fixes, blocked, hospitals, skipped = asked
    own = view.buildings[view.buildings["status"] == "assessed"]
    assert falls["falls"].sum() == pytest.approx(own["expected_falls"].sum())
    assert set(falls["inventory"]) == {"surveyed", "assumed"}
    assert (fixes["detail"] == "L-bracket to studs").all()
    assert len(fixes) > 3
    assert len(blocked) == (view.routes["state"] == "blocked").sum()
    chosen = own[(own["use"] == "Hospital") & (own["inventory"] == "surveyed")]
    assert hospitals["expected"][0] == pytest.approx(chosen["expected_falls"].sum())
    assert hospitals["p05"][0] <= hospitals["expected"][0] <= hospitals["p95"][0]
    assert skipped["buildings"].tolist() == [5]


def test_the_guide_names_every_column_of_the_index_and_every_table():
    for name in COLUMNS:
        assert f"`{name}`" in GUIDE, name
    for name in TABLES:
        assert f"`{name}*.parquet`" in GUIDE, name
