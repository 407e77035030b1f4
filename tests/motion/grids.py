"""Grids of a ShakeMap for tests: small ones made here, and the published ones in samples/."""

from collections.abc import Mapping, Sequence
from pathlib import Path

SHAKEMAPS = Path(__file__).parents[2] / "samples" / "shakemaps"
BAY = SHAKEMAPS / "loma-prieta-1989-bay" / "grid.xml"
EPICENTRE = SHAKEMAPS / "loma-prieta-1989-epicentre" / "grid.xml"
MARKET_STREET = 37.7893, -122.4008

LATITUDES, LONGITUDES = (38.0, 37.5, 37.0), (-122.0, -121.5)
HEAD = (
    '<?xml version="1.0"?><shakemap_grid xmlns="http://earthquake.usgs.gov/eqcenter/shakemap" event_id="{event}" '
    'shakemap_version="3" code_version="4.1" process_timestamp="2020-01-01T00:00:00Z" map_status="{status}" '
    'shakemap_event_type="ACTUAL"><event event_id="{event}" magnitude="6.0" event_timestamp="2020-01-01T00:00:00Z" '
    'event_description="Made up"/>'
)


def build_grid(
    fields: Mapping[str, tuple[str, Sequence[float | str]]],
    latitudes: Sequence[float] = LATITUDES,
    longitudes: Sequence[float] = LONGITUDES,
    *,
    size: tuple[int, int] | None = None,
    status: str = "RELEASED",
    event: str = "ev1",
) -> bytes:
    """Return a grid.xml: of each field its unit and its values, row by row in the order of the places.

    `size` is what the file claims of columns and rows, by default what it holds.
    """
    columns, rows = size or (len(longitudes), len(latitudes))
    names = [("LON", "dd"), ("LAT", "dd"), *((name, unit) for name, (unit, _) in fields.items())]
    listed = (f'<grid_field index="{at}" name="{name}" units="{unit}"/>' for at, (name, unit) in enumerate(names, 1))
    places = [(lon, lat) for lat in latitudes for lon in longitudes]
    lines = zip(places, *(values for _, values in fields.values()), strict=True)
    data = "\n".join(" ".join(map(str, (*place, *values))) for place, *values in lines)
    grid = f'<grid_specification nlon="{columns}" nlat="{rows}"/>{"".join(listed)}<grid_data>\n{data}\n</grid_data>'
    return f"{HEAD.format(status=status, event=event)}{grid}</shakemap_grid>".encode()
