"""The inventory as an object: it pickles small, compares by content, and its waveforms are read when they are used."""

import pickle
from pathlib import Path

import numpy as np
import pytest

from assess.errors import RecordError
from assess.model import Inventory
from assess.workbook.read import read_inventory
from tests.workbook.books import read, write
from tests.workbook.test_records import floors_with, write_record

MARKET_STREET = Path(__file__).parents[1] / "inventories" / "market-street.xlsx"


@pytest.fixture(scope="module")
def market_street() -> Inventory:
    return read_inventory(MARKET_STREET)


def samples(inventory: Inventory) -> list[np.ndarray]:
    return [one.record.acceleration for floor in inventory.floors for ones in floor.records.values() for one in ones]


def test_an_inventory_pickles_small_and_comes_back_equal(market_street: Inventory) -> None:
    data = pickle.dumps(market_street)
    assert len(data) < 100_000
    again = pickle.loads(data)
    assert again == market_street
    assert all(map(np.array_equal, samples(again), samples(market_street)))
    assert again.read_bytes() == MARKET_STREET.read_bytes()


def recorded(folder: Path) -> Inventory:
    write_record(folder / "one.csv", "time [s],NS [g],EW [g]")
    return read(folder, floors=floors_with("one.csv#EW"))


def test_a_record_that_is_gone_or_changed_is_named(tmp_path: Path) -> None:
    data = pickle.dumps(recorded(tmp_path))
    (tmp_path / "one.csv").write_text("other")
    with pytest.raises(RecordError, match=r"one\.csv has changed since the workbook was read"):
        samples(pickle.loads(data))
    (tmp_path / "one.csv").unlink()
    with pytest.raises(RecordError, match=r"one\.csv cannot be read again: No such file"):
        samples(pickle.loads(data))


def test_records_are_handed_over_after_unpickling(tmp_path: Path) -> None:
    inventory = recorded(tmp_path)
    bytes_of = (tmp_path / "one.csv").read_bytes()
    again = pickle.loads(pickle.dumps(inventory))
    (tmp_path / "one.csv").unlink()
    whole = again.with_records({"one.csv": bytes_of})
    assert whole == inventory
    assert np.array_equal(samples(whole)[0], samples(inventory)[0])
    with pytest.raises(RecordError, match="has changed"):
        again.with_records({"one.csv": bytes_of + b"\n"})


def test_records_that_were_bytes_are_asked_for(tmp_path: Path) -> None:
    write_record(tmp_path / "one.csv")
    data = write(tmp_path, floors=floors_with("one.csv")).read_bytes()
    files = {"one.csv": (tmp_path / "one.csv").read_bytes()}
    again = pickle.loads(pickle.dumps(read_inventory(data, records=files)))
    with pytest.raises(RecordError, match=r"one\.csv: .* pass its bytes to `with_records`"):
        samples(again)
    assert samples(again.with_records(files))[0].size == 400


def test_a_frame_has_units_in_its_names(market_street: Inventory) -> None:
    frame = market_street.frame()
    assert {"breadth_cm", "width_cm", "height_cm", "x_m", "y_m", "angle_deg", "edge_distance_m"} <= {*frame.columns}
    assert not {"breadth", "height", "x"} & {*frame.columns}
    first = market_street.items[0]
    assert frame.loc[first.item, "height_cm"] == pytest.approx(100 * first.height)
