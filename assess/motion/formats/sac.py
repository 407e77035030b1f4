"""SAC, binary: one channel to a file, read by ObsPy.

A SAC file has no field for the unit of its samples. It is taken from the first of these that says it:

1. KUSER0, KUSER1 or KUSER2, free text of 8 characters, where it is a unit of acceleration: g, m/s2, cm/s2, gal;
2. IDEP, the type of the samples, where it is IACC: the manual has accelerations in nm/s2.

Many writers set IACC whatever their unit (the Community Seismic Network has g). A peak that would be below 0.1 cm/s2
then is no motion that moves furniture, but a sign of that: it is refused and not believed.

Source: Lawrence Livermore National Laboratory and IRIS, SAC user's manual, data file format.
"""

import struct
from typing import Any

import numpy as np

from assess.errors import RecordError
from assess.language import fill
from assess.motion.formats._format import Format
from assess.motion.formats._obspy import read_traces, start_of
from assess.motion.formats._text import direction_of_code, even_series, read_acceleration_unit
from assess.motion.record import FloatArray, Record, peak

TITLE = "SAC"

HEADER = 632
"""Bytes: 70 real numbers, 40 whole numbers, 192 characters."""
VERSION, COUNT, KIND, MEANING, EVEN = (4 * place for place in (76, 79, 85, 86, 105))
"""Places of NVHDR, NPTS, IFTYPE, IDEP and LEVEN [bytes]."""
VERSIONS, TIME_SERIES = {6, 7}, 1
KINDS = {1, 2, 3, 4, 51}
"""Time series, two kinds of spectra, pairs, and a grid."""
OTHER_MEANINGS = {6: "displacement", 7: "velocity", 50: "volts"}
ACCELERATION = 8
NM_S2 = 1e-9
LEAST = 0.001
"""Peak [m/s2] below which nanometres per second squared are not believed."""

_MEND = (
    "Write the unit into the header's field KUSER0 (g, m/s2, cm/s2; in ObsPy: trace.stats.sac.kuser0 = 'g'), "
    "or save the record as plain CSV"
)


def recognises(head: bytes) -> bool:
    """Tell whether `head` is the header of a SAC file, of either order of bytes."""
    return len(head) >= HEADER and _byte_order(head) is not None


def read(data: bytes, file: str) -> tuple[Record, ...]:
    """Read the one channel of a SAC file.

    Raises
    ------
    RecordError
        If the unit is not known, the file is damaged, or ObsPy is not installed.
    """
    _check_header(data)
    traces, notes = read_traces(data, "SAC")
    trace = traces[0]
    header = trace.stats.get("sac", {})
    with np.errstate(all="ignore"):  # what becomes infinite is refused further on
        values = np.asarray(trace.data, dtype=np.float64)
        factor, note = _read_unit(header, values)
        own = values * factor
    series = even_series(own, float(f"{float(trace.stats.delta):.7g}"), (*notes, note))
    azimuth, vertical = _read_direction(header)
    code = str(header.get("kcmpnm", "")).strip()
    place = str(header.get("khole", "")).strip()
    record = Record(
        file=file,
        format=TITLE,
        channel=code or "1",
        location=place,
        azimuth_deg=azimuth,
        vertical=vertical,
        station=".".join(filter(None, (str(header.get(key, "")).strip() for key in ("knetwk", "kstnm")))),
        event=str(header.get("kevnm", "")).strip(),
        start=start_of(trace) if "nzyear" in header else "",
        corrected=False,
        time_step=series.time_step,
        acceleration=own,
        file_pfa=peak(own - own.mean()),
        header_pfa=None,
        notes=series.notes,
    )
    return (record,)


def _whole(data: bytes, order: str, place: int) -> int:
    return int(struct.unpack_from(f"{order}i", data, place)[0])


def _byte_order(data: bytes) -> str | None:
    """Return "<" or ">", None where the header is none of SAC's."""
    for order in "<>":
        if (
            _whole(data, order, VERSION) in VERSIONS
            and _whole(data, order, KIND) in KINDS
            and _whole(data, order, EVEN) in {0, 1}
        ):
            return order
    return None


def _check_header(data: bytes) -> None:
    order = _byte_order(data) if len(data) >= HEADER else None
    if order is None:
        raise RecordError("the header is none of a SAC file. Get the file again")
    if _whole(data, order, KIND) != TIME_SERIES or _whole(data, order, EVEN) != 1:
        raise RecordError("it holds no evenly sampled time series. Give the record itself")
    count, there = _whole(data, order, COUNT), (len(data) - HEADER) // 4
    if not 0 < count <= there:
        raise RecordError(f"the header announces {count} numbers of data, there are {there}. Get the file again")
    meaning = OTHER_MEANINGS.get(_whole(data, order, MEANING))
    if meaning:
        raise RecordError(f"it holds {meaning}, not accelerations. Give the acceleration of the same channel")


def _read_unit(header: Any, values: FloatArray) -> tuple[float, str]:
    """Return the factor to m/s2, and a note on where it is from."""
    for key in ("kuser0", "kuser1", "kuser2"):
        text = str(header.get(key, "")).strip()
        factor = read_acceleration_unit(text)
        if factor is not None:
            note = fill("the unit is that of the header's field {field}: {unit}", field=key.upper(), unit=text)
            return factor, note
    if header.get("idep") != ACCELERATION:
        raise RecordError(f"the file does not say its unit. {_MEND}")
    as_said = NM_S2 * peak(values - values.mean())
    if not as_said >= LEAST:
        raise RecordError(
            "the header says acceleration (IDEP), which means nm/s2, but that makes the peak "
            f"{100 * as_said:.2g} cm/s2: the unit is another. {_MEND}"
        )
    return NM_S2, fill("the unit is nm/s2, what the type of the samples (IDEP) means")


def _read_direction(header: Any) -> tuple[float | None, bool]:
    azimuth, tilt = header.get("cmpaz"), header.get("cmpinc")
    if tilt is not None and float(tilt) in {0.0, 180.0}:
        return None, True
    if tilt is not None and float(tilt) == 90.0 and azimuth is not None and 0 <= float(azimuth) <= 360:
        return float(azimuth), False
    return direction_of_code(str(header.get("kcmpnm", "")).strip())


FORMAT = Format(key="sac", title=TITLE, recognises=recognises, read=read)
