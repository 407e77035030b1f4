"""Building models that are sent: read, cancelled, refused, opened as new workbooks."""

import socket
from pathlib import Path
from urllib.parse import urlsplit

import pytest

import assess
from assess.bim.import_workbook import ImportedBuilding
from assess.web import importing
from assess.web.file_names import clean_name
from assess.web.importing import READING, Import, find_free, name_workbook
from assess.web.limits import HOSTED, MOST_MODEL
from assess.web.request_errors import RequestError
from assess.web.slots import Slots
from assess.workbook.read import read_tables
from tests.bim import scan_files
from tests.bim.cobie_files import write_cobie
from tests.waiting import wait_until
from tests.web.model_reader import hold_reader, is_gone, linux, write_house
from tests.web.serving import list_named
from tests.web.test_sessions import OPTIONS, _come
from tests.workbooks import write

MODELS = Path(__file__).parents[2] / "samples" / "models"
DUPLEX, LARGE = MODELS / "duplex.ifc", MODELS / "LargeBuilding.ifc"
PLAN = "house-Level-1.svg"
PLANS = ["duplex-Level-1.svg", "duplex-Level-2.svg", "duplex-Roof.svg"]


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    return write_house(tmp_path_factory.mktemp("house") / "house.ifc").read_bytes()


def _read(client, name, data, query=""):
    """Send a model, and return what came out once it has been read."""
    reply = client.request("POST", f"/api/import?name={name}{query}", data)
    assert reply.status == 200, reply.data
    answer = wait_until(lambda: client.get("/api/import").json(), lambda found: found["import"]["state"] != "running")
    return answer["import"]


def _begin_sending(client, length, data):
    """Send the head of a model and its first bytes, and return the line, which stays open."""
    parts = urlsplit(client.base)
    headers = "".join(f"{name}: {value}\r\n" for name, value in client.headers.items())
    line = socket.create_connection((parts.hostname, parts.port))
    head = f"POST /api/import?name=a.ifc HTTP/1.1\r\nHost: {parts.netloc}\r\n{headers}{length}\r\n\r\n"
    line.sendall(head.encode() + data)
    return line


def _list_left(tmp_path):
    """Return what is kept of models: as they are sent, as they are read."""
    return [name for kind in ("body-", "import-") for name in list_named(tmp_path / "tmp", kind)]


@pytest.mark.slow
def test_a_model_becomes_a_workbook_with_its_plans_beside_it(served, tmp_path):
    server = served()
    found = _read(server.client, "duplex.ifc", DUPLEX.read_bytes())
    taken = found["found"]
    assert (found["state"], found["name"], found["workbook"]) == ("done", "duplex.ifc", "duplex.xlsx")
    assert (taken["pieces"], taken["of"], taken["floors"], taken["routes"]) == (47, 61, 2, 0)
    (group,) = [one for one in taken["skipped"] if one["is_furniture"]]
    assert (group["count"], sum(number for _, number in group["types"])) == (14, 14)
    assert taken["remarks"]
    assert [name for kind in ("body-", "model") for name in list_named(tmp_path / "tmp", kind)] == []
    assert list(server.folder.iterdir()) == []  # nothing is written before it is opened

    book = server.client.post("/api/import/open", {"shaking": "MMI VIII, severe"}).json()
    assert _list_left(tmp_path) == []
    assert (book["name"], book["mode"], book["missing"]) == ("duplex.xlsx", "disk", [])
    assert sorted(one.name for one in server.folder.iterdir()) == [*PLANS, "duplex-import.txt", "duplex.xlsx"]
    live = server.client.get("/api/live").json()
    assert (live["error"], len(live["items"]["class"]), "" in live["items"]["class"]) == ("", 47, False)
    assert len(assess.read_inventory(server.folder / "duplex.xlsx").items) == 47
    answer = server.client.get("/api/import").json()
    assert answer["import"] is None
    assert answer["opened"]["book"] == book["state"]["server"]
    assert answer["opened"]["found"] == taken  # the list can be looked at again
    assert server.client.post("/api/import/open").status == 404


@pytest.mark.slow
def test_a_second_workbook_of_a_model_replaces_no_file_and_a_third_ends_the_list(served_here, house, tmp_path):
    server = served_here(write(tmp_path / "office.xlsx"))
    before = (tmp_path / "office.xlsx").read_bytes()
    (server.folder / PLAN).write_bytes(b"mine")
    for name, open_meanwhile in (("house.xlsx", "office.xlsx"), ("house-2.xlsx", "house.xlsx")):
        assert _read(server.client, "house.ifc", house)["state"] == "done"
        assert server.client.get("/api/book").json()["name"] == open_meanwhile
        book = server.client.post("/api/import/open").json()
        assert (book["name"], book["missing"]) == (name, [])
    assert (server.folder / PLAN).read_bytes() == b"mine"
    tables, _ = read_tables((server.folder / "house.xlsx").read_bytes(), "house.xlsx")
    assert [row.get("plan") for row in tables["Floors"].rows] == ["house-Level-1-2.svg"]
    assert (tmp_path / "office.xlsx").read_bytes() == before
    server.client.post("/api/start", {"kind": "blank", "name": "other"})
    assert server.client.get("/api/import").json()["opened"] is None


@pytest.mark.slow
def test_a_cobie_file_and_a_scan_are_recognised_by_their_content(served, tmp_path):
    server = served()
    path = write_cobie(tmp_path / "handover.xlsx")
    begun = server.client.send("/api/upload", "handover.xlsx", path.read_bytes()).json()
    found = wait_until(lambda: server.client.get("/api/import").json()["import"], lambda one: one["state"] != "running")
    assert (found["id"], found["state"], found["workbook"]) == (
        begun["import"]["id"], "done", "handover-inventory.xlsx",
    )  # fmt: skip
    assert (found["found"]["pieces"], found["found"]["skipped"][0]["types"]) == (2, [["Door B", 1]])
    assert server.client.post("/api/import/open").json()["name"] == "handover-inventory.xlsx"
    office = write(tmp_path / "mine.xlsx")
    assert server.client.send("/api/upload", "mine.xlsx", office.read_bytes()).json()["name"] == "mine.xlsx"
    scan = scan_files.write(scan_files.office())  # by its content
    assert _read(server.client, "office.ifc", scan)["found"]["routes"] == 0
    assert server.client.request("POST", "/api/import?name=a.ifc&routes=all", b"x").status == 422
    assert server.client.request("POST", "/api/import?routes=none", b"x").status == 422
    found = _read(server.client, "office.ifc", scan, "&routes=draft")
    assert (found["state"], found["found"]["floors"], found["found"]["routes"] > 0) == ("done", 1, True)
    assert server.client.post("/api/import/open").json()["name"] == "office.xlsx"


@pytest.mark.slow
def test_what_cannot_be_read_is_said_and_not_kept_and_a_second_try_works(served, tmp_path):
    server = served()
    cut = DUPLEX.read_bytes()[: DUPLEX.stat().st_size // 2]
    for name, data, why in (
        ("cut.ifc", cut, "END-ISO-10303-21"), ("empty.ifc", b"", "empty.ifc"), ("note.txt", b"Dear all", "note.txt"),
        ("broken.xlsx", b"PK\x03\x04" + b"\0" * 40, "broken.xlsx"),
    ):  # fmt: skip
        found = _read(server.client, f"..%2F{name}", data)
        said = " ".join([found["message"], *(one["message"] for one in found["problems"])])
        assert (found["state"], found["found"], found["name"]) == ("failed", None, name)
        assert why in said, name
        assert str(tmp_path) not in said
        assert _list_left(tmp_path) == []
        assert server.client.post("/api/import/open").status == 404
    assert _read(server.client, "duplex.ifc", DUPLEX.read_bytes())["found"]["pieces"] == 47
    assert list(server.folder.iterdir()) == []


@linux
@pytest.mark.slow
def test_a_reading_ends_where_it_is_cancelled_replaced_or_the_server_ends(served, house, tmp_path):
    server = served()
    client = server.client
    assert client.request("POST", "/api/import?name=duplex.ifc", DUPLEX.read_bytes()).status == 200
    reader = hold_reader(server)
    assert client.get("/api/start").status == 200
    assert client.get("/api/import").json()["import"]["state"] == "running"
    assert client.post("/api/import/open").status == 404
    assert client.post("/api/import/cancel").json()["import"]["state"] == "cancelled"
    wait_until(lambda: is_gone(reader), bool)
    wait_until(lambda: _list_left(tmp_path), lambda left: left == [])
    wait_until(lambda: list_named(tmp_path / "tmp", "assess-model-"), lambda left: left == [])
    assert client.post("/api/import/open").status == 404
    client.request("POST", "/api/import?name=large.ifc", LARGE.read_bytes())
    reader = hold_reader(server)
    found = _read(client, "house.ifc", house)
    assert (found["state"], found["name"], is_gone(reader)) == ("done", "house.ifc", True)
    assert client.post("/api/import/cancel").json()["import"] is None  # what was read is dropped
    client.request("POST", "/api/import?name=duplex.ifc", DUPLEX.read_bytes())
    reader = hold_reader(server)
    assert server.stop()[::2] == (0, "Stopped.\n")
    assert is_gone(reader)
    assert list((tmp_path / "tmp").iterdir()) == []


@pytest.mark.slow
def test_one_model_is_sent_at_a_time_and_a_client_that_goes_away_leaves_nothing(served, tmp_path):
    client = served().client
    with _begin_sending(client, "Content-Length: 4000000", b"x" * 2_000_000):
        wait_until(lambda: _list_left(tmp_path), len)
    wait_until(lambda: _list_left(tmp_path), lambda left: left == [])
    assert client.get("/api/import").json()["import"] is None
    with _begin_sending(client, "Transfer-Encoding: chunked", b"1e8480\r\n" + b"x" * 2_000_000 + b"\r\n"):
        wait_until(lambda: _list_left(tmp_path), len)
        reply = client.request("POST", "/api/import?name=b.ifc", b"x")
        assert (reply.status, reply.json()["message"]) == (
            429, "Another building model is being sent. Wait until it has been received, then try again.",
        )  # fmt: skip
        assert len(_list_left(tmp_path)) == 1
        assert client.get("/api/start").status == 200
    wait_until(lambda: _list_left(tmp_path), lambda left: left == [])
    wait_until(lambda: client.request("POST", "/api/import?name=b.ifc", b"x").status, lambda status: status == 200)


@pytest.mark.slow
def test_on_a_server_for_several_a_model_is_its_users_alone_and_counted_as_it_is_saved(served, house, tmp_path):
    server = served(None, *OPTIONS)
    ann, _ = _come(server, "ann")
    (folder,) = (tmp_path / "tmp").rglob("session-*")
    assert _read(ann, "house.ifc", house)["state"] == "done"
    ben, _ = _come(server, "ben")
    assert ben.get("/api/import").json()["import"] is None
    book = ann.post("/api/import/open").json()
    assert (book["name"], book["mode"], book["missing"]) == ("house.xlsx", "held", [])
    assert ann.get("/api/picture?floor=Level%201").status == 200
    assert list(server.folder.iterdir()) == []
    with (folder / "results").open("wb") as file:
        file.truncate(HOSTED.bytes - 2**21)
    part = b"x" * 2**18
    for headers in ({"Content-Length": str(9 * 2**18)}, {}):
        reply = ann.request("POST", "/api/import?name=a.ifc", (part for _ in range(9)), headers)
        assert (reply.status, reply.json()["message"]) == (429, "The files of this session have more than 300 MB.")
        assert _list_left(tmp_path) == []
    assert ann.request("POST", "/api/import?name=a.ifc", (part for _ in range(5))).status == 200


@pytest.mark.slow
def test_what_is_too_large_is_refused_however_it_is_sent(served_here, tmp_path):
    client = served_here().client
    part = b"x" * 2**20
    for headers in ({"Content-Length": str(MOST_MODEL + 2**20)}, {}):
        body = (part for _ in range(MOST_MODEL // 2**20 + 1))
        assert client.request("POST", "/api/import?name=a.ifc", body, headers).status == 413
        assert _list_left(tmp_path) == []
    assert client.get("/api/import").json() == {"import": None, "opened": None, "most": MOST_MODEL}


def _begin(tmp_path, slots, data=b"x"):
    folder = tmp_path / "import-1"
    folder.mkdir()
    (folder / importing.SOURCE).write_bytes(data)
    return Import(folder, "duplex.ifc", "none", slots)


def test_plans_workbooks_and_models_get_names_that_nothing_else_has(tmp_path):
    """Storeys "EG" and "EG 2": the second name of the first plan is that of the second plan."""
    (tmp_path / "a.svg").write_bytes(b"mine")
    (tmp_path / "a-2.svg").write_bytes(b"a")  # of an earlier import of the same model
    (tmp_path / "b.svg").write_bytes(b"b")
    (tmp_path / "m-EG.svg").write_bytes(b"mine")
    plans = {"a.svg": b"a", "b.svg": b"b", "m-EG.svg": b"eg", "m-EG-2.svg": b"eg2"}
    floors = [*({"floor": name, "plan": name} for name in plans), {"floor": "none"}]
    found = ImportedBuilding(source="m.ifc", floors=floors, files=plans)
    renamed = importing._rename_files(found, tmp_path)
    names = [row.get("plan") for row in renamed.floors]
    assert names == ["a-2.svg", "b.svg", "m-EG-3.svg", "m-EG-2.svg", None]
    assert renamed.files == dict(zip(names[:4], plans.values(), strict=True))
    (tmp_path / "m-EG-2.svg").write_bytes(b"mine, too")
    renamed = importing._rename_files(found, tmp_path)
    assert [renamed.files[row["plan"]] for row in renamed.floors[:4]] == [*plans.values()]
    assert name_workbook("duplex.ifc") == "duplex.xlsx"
    assert name_workbook("hand.over.XLSX") == "hand.over-inventory.xlsx"
    assert name_workbook("con.ifc") == "workbook.xlsx"
    assert find_free("a.xlsx", tmp_path) == "a.xlsx"
    (tmp_path / "a.xlsx").touch()
    assert find_free("a.xlsx", tmp_path) == "a-2.xlsx"
    assert clean_name("C:\\x\\../../b\u202e<1>.ifc") == "b1.ifc"
    assert (len(clean_name("a" * 300 + ".ifc")), clean_name("a" * 300 + ".ifc")[-5:]) == (120, "a.ifc")
    assert clean_name("..") == ""


def test_without_a_place_nothing_is_kept_and_a_reading_for_which_nobody_asks_ends(tmp_path, monkeypatch):
    (folder := tmp_path / "server").mkdir()
    slots = Slots(folder, "models", 1, READING)
    taken = slots.take()
    with pytest.raises(RequestError, match="Other building models are being read"):
        _begin(tmp_path, slots)
    assert list(tmp_path.iterdir()) == [folder]
    taken.release()
    monkeypatch.setattr(importing, "LEFT_AFTER", -1.0)
    found = _begin(tmp_path, slots, DUPLEX.read_bytes())
    wait_until(lambda: found.state, lambda state: state != "running")
    assert (found.state, list(tmp_path.iterdir())) == ("cancelled", [folder])
