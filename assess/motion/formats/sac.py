"""SAC, binary: one channel to a file.

A SAC file has no field for the unit of its samples. It is taken from the first of these that names it:

1. KUSER0, KUSER1 or KUSER2, free text of 8 characters, where it is a unit of acceleration: g, m/s2, cm/s2, gal;
2. IDEP, the type of the samples, where it is IACC: the manual has accelerations in nm/s2.

Many writers set IACC whatever their unit (the Community Seismic Network has g). A peak that would be below 0.1 cm/s2
then is no motion that moves furniture, but a sign of that: it is refused and not believed.

Source: Lawrence Livermore National Laboratory and IRIS, SAC user's manual, data file format.
"""

import struct
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np

from assess.arrays import FloatArray
from assess.errors import RecordError
from assess.i18n import fill
from assess.motion.formats._format import Format, build_record, even_series, read_acceleration_unit, read_direction
from assess.motion.record import Record, check_count, peak

HEADER, FOOTER = 632, 176
"""Bytes: 70 real numbers, 40 whole numbers, 192 characters; and what follows the data in version 7."""
REALS = {"delta": 0, "begin": 5, "azimuth": 57, "tilt": 58}
"""Places of DELTA, B, CMPAZ and CMPINC among the real numbers."""
INTEGERS = {"year": 70, "day": 71, "hour": 72, "minute": 73, "second": 74, "millisecond": 75,
            "version": 76, "count": 79, "kind": 85, "meaning": 86, "even": 105}  # fmt: skip
"""Places of NZYEAR to NZMSEC, NVHDR, NPTS, IFTYPE, IDEP and LEVEN, of four bytes each."""
TEXTS = {"station": (0, 8), "event": (8, 16), "place": (24, 8), "kuser0": (136, 8), "kuser1": (144, 8),
         "kuser2": (152, 8), "channel": (160, 8), "network": (168, 8)}  # fmt: skip
"""Places and lengths of KSTNM, KEVNM, KHOLE, KUSER0 to KUSER2, KCMPNM and KNETWK among the characters."""
TEXTS_FROM = 440
UNKNOWN = -12345

VERSIONS = {6, 7}
KINDS = {1, 2, 3, 4, 51}
"""Time series, two kinds of spectra, pairs, and a grid."""
OTHER_MEANINGS = {6: fill("displacements"), 7: fill("velocities"), 50: fill("volts")}
ACCELERATION = 8
NM_S2 = 1e-9
LEAST = 0.001
"""Peak [m/s2] below which nanometres per second squared are not believed."""

_FIX = fill(
    "Write the unit into the header's field KUSER0 (g, m/s2, cm/s2; in ObsPy: trace.stats.sac.kuser0 = 'g'), "
    "or save the record as plain CSV"
)


@dataclass(frozen=True, slots=True)
class _Header:
    """The fields that are read, and the order of bytes; None or "" where a field is unknown."""

    order: str
    reals: dict[str, float | None]
    integers: dict[str, int]
    texts: dict[str, str]


def parse(data: bytes) -> tuple[Record, ...]:
    """Read the one channel; RecordError if its unit is not known, or the file is damaged."""
    header = _read_header(data)
    if header is None:
        raise RecordError.about("the header is not that of a SAC file. Get the file again")
    numbers = header.integers
    if numbers["kind"] != 1 or numbers["even"] != 1:
        raise RecordError.about("the file holds no evenly sampled time series. Give the record itself")
    count, there = numbers["count"], (len(data) - HEADER - FOOTER * (numbers["version"] == max(VERSIONS))) / 4
    if count <= 0 or count != there:
        raise RecordError.about(
            "the number of data values is {there:.10g}, but {announced} in the header. Get the file again",
            announced=count,
            there=there,
        )
    check_count(count)
    if meaning := OTHER_MEANINGS.get(numbers["meaning"]):
        raise RecordError.about(
            "the file holds {kind}, not accelerations. Give the acceleration file of the same channel", kind=meaning
        )
    with np.errstate(all="ignore"):  # what becomes infinite is refused further on
        samples = np.frombuffer(data, f"{header.order}f4", count, HEADER).astype(np.float64)
        factor, note = _read_unit(header, samples)
        series = even_series(samples * factor, float(f"{header.reals['delta'] or 0.0:.7g}"), (note,))
    azimuth, tilt = header.reals["azimuth"], header.reals["tilt"]
    direction = read_direction(header.texts["channel"], bare_degrees=False)
    if tilt in {0.0, 180.0}:
        direction = None, True
    elif tilt == 90.0 and azimuth is not None and 0 <= azimuth <= 360:
        direction = azimuth, False
    start, begin = "", header.reals["begin"] or 0.0  # B is counted from the reference time
    with suppress(ValueError, OverflowError):  # a date that cannot be
        reference = datetime(numbers["year"], 1, 1) + timedelta(
            days=numbers["day"] - 1, hours=numbers["hour"], minutes=numbers["minute"],
            seconds=numbers["second"] + begin, milliseconds=numbers["millisecond"],
        )  # fmt: skip
        start = f"{reference.isoformat(sep=' ', timespec='milliseconds')} UTC"
    record = build_record(
        series, corrected=False, channel=header.texts["channel"], direction=direction, location=header.texts["place"],
        station=".".join(filter(None, (header.texts["network"], header.texts["station"]))), event=header.texts["event"],
        start=start, has_offset=True,
    )  # fmt: skip
    return (record,)


def _read_header(data: bytes) -> _Header | None:
    for order in "<>" if len(data) >= HEADER else "":
        numbers = {name: int(struct.unpack_from(f"{order}i", data, 4 * place)[0]) for name, place in INTEGERS.items()}
        if numbers["version"] in VERSIONS and numbers["kind"] in KINDS and numbers["even"] in {0, 1}:
            reals = {name: float(struct.unpack_from(f"{order}f", data, 4 * place)[0]) for name, place in REALS.items()}
            known = {name: None if value == UNKNOWN else value for name, value in reals.items()}
            texts = {
                name: data[TEXTS_FROM + start : TEXTS_FROM + start + length]
                .decode("latin-1")
                .partition("\0")[0]
                .strip()
                for name, (start, length) in TEXTS.items()
            }
            # KEVNM may hold it twice, once for each of its halves.
            texts = {name: "" if {*text.split()} == {str(UNKNOWN)} else text for name, text in texts.items()}
            return _Header(order, known, numbers, texts)
    return None


def _read_unit(header: _Header, values: FloatArray) -> tuple[float, str]:
    """Return the factor to m/s2, and a note on where it is from."""
    for key in ("kuser0", "kuser1", "kuser2"):
        text = header.texts[key]
        if (factor := read_acceleration_unit(text)) is not None:
            return factor, fill("the unit is that of the header's field {field}: {unit}", field=key.upper(), unit=text)
    if header.integers["meaning"] != ACCELERATION:
        raise RecordError.about("the file does not give its unit. {fix}", fix=_FIX)
    in_nm = NM_S2 * peak(values - values.mean())
    if not in_nm >= LEAST:
        raise RecordError.about(
            "the header gives the type acceleration (IDEP), whose unit is nm/s2, but the peak would then be "
            "{peak:.2g} cm/s2: the unit must be a different one. {fix}",
            peak=100 * in_nm,
            fix=_FIX,
        )
    return NM_S2, fill("the unit is nm/s2, what the type of the samples (IDEP) means")


FORMAT = Format("sac", "SAC", recognises=lambda head: _read_header(head) is not None, parse=parse)
