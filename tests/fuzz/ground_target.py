"""A target: grids of ShakeMap and computed scenarios of the ground."""

import math
import pickle
import random
import re
from collections.abc import Sequence
from pathlib import Path

from assess.errors import InputError
from assess.motion.ground_scenarios import read_scenarios
from assess.motion.shakemap import parse_shakemap
from assess.motion.site_ground import SiteGround
from tests.fuzz.havoc import NUMBERS, mangle
from tests.fuzz.plain_targets import FURTHER, ROOT, check_message, keep

MARK = b"\n===\n"
"""Between the values and the sites of scenarios."""
MAPS = ROOT / "samples" / "shakemaps" / "loma-prieta-1989-epicentre"
_DATA = re.compile(rb"(<grid_data>\s*)(.*?)(</grid_data>)", re.DOTALL)
COLUMNS, ROWS = 6, 5


class GroundMotions:
    """Two kinds of input: the XML of a grid, and the two tables of scenarios with `MARK` between them."""

    suffix, most_seconds, further = ".bin", 5.0, FURTHER
    tokens = (
        *NUMBERS, b"<", b">", b"/>", b"<grid_data>", b"</grid_data>", b'<grid_field index="3" name="PGA" units="" />',
        b'units="%g"', b'units="g"', b'name="PGA"', b'name="PGV"', b'name="STDPGA"', b'name="PSA03"', b"&#x1b;", b"{0}",
        b"<!DOCTYPE x [<!ENTITY a 'b'>]>", b"<!--", b"]]>", b"\xff\xfe", b"\0", b'"', b"NaN", b"nan", b"site_id",
        b"custom_site_id", b"event_id", b"gmv_PGA", b"gmv_SA(1.0)", b"gmv_PGV", b"lon", b"lat", b"#", b",", b"\r\n",
    )  # fmt: skip

    def seeds(self) -> Sequence[bytes]:
        """Return small parts of real grids, and scenarios of both names of sites."""
        grids = [shrink((MAPS / name).read_bytes()) for name in ("grid.xml", "uncertainty.xml")]
        return [*grids, *(write_scenarios(name) for name in ("site_id", "custom_site_id"))]

    def mutate(self, draw: random.Random, data: bytes, pool: Sequence[bytes]) -> bytes:
        """Change bytes."""
        return mangle(draw, data, pool, self.tokens)

    def check(self, data: bytes, folder: Path, *, deep: bool) -> str:
        """Read it as what it is, and a grid as the uncertainties of a sound one, too; take the shaking at places."""
        del deep
        try:
            if MARK in data:
                check_scenarios(data, folder)
            else:
                check_map(data)
        except InputError as error:
            check_message(error, "fuzz" if MARK not in data else "")
            return "refused"
        return "read"


def check_map(data: bytes) -> None:
    """Read a grid; InputError where it cannot be used."""
    sound = shrink((MAPS / "grid.xml").read_bytes())
    try:
        beside = parse_shakemap(sound, "grid.xml", uncertainty=data, uncertainty_name="fuzz.xml")
        check_site(beside.at(*_middle(beside.grid.latitude, beside.grid.longitude)))
    except InputError as error:
        check_message(error, "fuzz.xml")
    found = parse_shakemap(data, "fuzz.xml")
    keep(0 < len(found.title) < 1000, "a title that is empty or endless")
    for place in (
        _middle(found.grid.latitude, found.grid.longitude),
        (found.grid.latitude[0], found.grid.longitude[-1]),
    ):
        check_site(found.at(float(place[0]), float(place[1])))
    keep(pickle.loads(pickle.dumps(found)).sha256 == found.sha256, "a map that does not pickle")
    try:
        found.at(float(found.grid.latitude[-1]) + 0.01, float(found.grid.longitude[0]))
    except InputError:
        return
    keep(False, "a place outside the grid that is not refused")


def check_scenarios(data: bytes, folder: Path) -> None:
    """Read scenarios; InputError where they cannot be used."""
    box = folder / "fuzz"
    box.mkdir(exist_ok=True)
    values, _, sites = data.partition(MARK)
    (box / "gmf-data.csv").write_bytes(values)
    (box / "sitemesh.csv").write_bytes(sites)
    found = read_scenarios(box)
    site = found.at(37.0, -122.0)
    check_site(site)
    if site.scenarios:
        keep(len(site.scenarios) == found.event_count, "scenarios that are not those of the events")
        keep(abs(sum(site.scenarios)) < 1e-6 * len(site.scenarios), "scenarios whose mean is not 0")


def check_site(site: SiteGround) -> None:
    """Check that what a place is given can be used."""
    numbers = [site.pga, site.dispersion, site.pgv or 0.0, *(one for pair in site.psa for one in pair), *site.scenarios]
    keep(all(map(math.isfinite, numbers)), "a shaking that is not finite")
    keep(site.pga > 0 and site.dispersion >= 0 and (site.pgv is None or site.pgv > 0), "a shaking of 0 or below")
    keep(site.shared is None or 0 <= site.shared <= 1, "a share beyond 0 to 1")
    for text in (site.dispersion_source, *(one for pair in site.facts for one in pair), *site.cautions):
        keep(len(text) < 1000 and str(text).isprintable(), f"a text with control characters, or endless: {text[:80]!r}")


def _middle(latitudes: Sequence[float], longitudes: Sequence[float]) -> tuple[float, float]:
    return float(latitudes[0] + latitudes[-1]) / 2, float(longitudes[0] + longitudes[-1]) / 2


def shrink(data: bytes) -> bytes:
    """Return a grid of `ROWS` x `COLUMNS` points from the north-western corner of a large one."""
    columns, rows = (int(re.findall(rb'%s="(\d+)"' % name, data)[0]) for name in (b"nlon", b"nlat"))
    lines = _DATA.findall(data)[0][1].strip().splitlines()
    if len(lines) != columns * rows:
        raise ValueError("a grid whose rows are not those of its points")
    kept = b"\n".join(lines[row * columns + at] for row in range(ROWS) for at in range(COLUMNS))
    small = _DATA.sub(lambda found: found[1] + kept + b"\n" + found[3], data)
    return re.sub(rb'nlat="\d+"', b'nlat="%d"' % ROWS, re.sub(rb'nlon="\d+"', b'nlon="%d"' % COLUMNS, small))


def write_scenarios(name: str) -> bytes:
    """Return three scenarios at two sites."""
    names = {"site_id": ("0", "1"), "custom_site_id": ("u1", "u2")}[name]
    rows = [
        f"{site},{event},{0.1 + 0.05 * event:.5E},{20 + event:.5E},{0.2 + 0.1 * at:.5E}"
        for event in range(3) for at, site in enumerate(names)
    ]  # fmt: skip
    values = ["#,,,,\"generated_by='OpenQuake engine'\"", f"{name},event_id,gmv_PGA,gmv_PGV,gmv_SA(1.0)", *rows, ""]
    sites = [f"{name},lon,lat", f"{names[0]},-122.0,37.0", f"{names[1]},-122.1,37.1", ""]
    return "\n".join(values).encode() + MARK + "\n".join(sites).encode()
