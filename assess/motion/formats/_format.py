"""What a format of recorded motion is, what words of headers mean, directions, and the record that readers build."""

import math
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from assess.arrays import FloatArray
from assess.errors import RecordError
from assess.i18n import fill, join, nfill
from assess.motion.record import Record, Series, check_samples, check_time_step, peak
from assess.units import ACCELERATION, GRAVITY, read_unit

T = TypeVar("T")

MOST_CHANNELS = 500
"""Channels of one file, or of one archive's member."""
MOST_VALUES = 20_000_000
"""Samples of one file, all its channels and, in an archive, all its members together."""
MOST_NOTES = 4
"""Notes on single channels that are left out."""
HEADER_PEAK_WITHIN = 0.02
"""Headers print two to four digits of the peak; a larger difference [-] is noted."""

_MORE_UNITS = {"mm/s2": 0.001, "g/10": GRAVITY / 10, "mg": GRAVITY / 1000, "in/s2": 0.0254}
NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[ED][-+]?\d+)?"
"""A number of a header, without sign, with the exponent that Fortran prints, in letters of either case."""
END = r"(?=[\s,;]|$)"
"""Where such a number ends, if no unit follows it."""

_EXPONENT = re.compile(r"(?<=[\d.])D(?=[-+\d])", re.IGNORECASE)
_QUANTITIES = {"velocity": fill("velocities"), "displacement": fill("displacements")}

Direction = tuple[float | None, bool | None]
"""Azimuth [deg], None where it is unknown, and whether the channel is vertical, None where that is unknown."""
UNKNOWN: Direction = (None, None)


@dataclass(frozen=True, slots=True)
class Format:
    """One way in which files hold recorded motion; `title` is shown to people.

    * `recognises`: whether the first bytes of a file are of this format. The name of a file decides nothing.
    * `parse`: from the whole file to its channels, which need not name it; raises RecordError, and nothing else,
      whatever the bytes.
    """

    key: str
    title: str
    recognises: Callable[[bytes], bool]
    parse: Callable[[bytes], tuple[Record, ...]]

    def read(self, data: bytes, file: str) -> tuple[Record, ...]:
        """Return the channels of a file from its bytes and its name; raises RecordError as `parse`."""
        return tuple(replace(record, file=file, format=self.title) for record in self.parse(data))


def build_record(
    series: Series,
    *,
    corrected: bool,
    own: FloatArray | None = None,
    channel: str = "",
    direction: Direction = UNKNOWN,
    location: str = "",
    station: str = "",
    event: str = "",
    start: str = "",
    header_pfa: float | None = None,
    has_offset: bool = False,
    notes: Sequence[str] = (),
    recorder: str = "",
) -> Record:
    """Return the record of one channel; see `Record` for the parameters that are not named here.

    * `own` (n,): the file's own samples [m/s2], where they are not evenly spaced.
    * `has_offset`: whether the samples carry the instrument's offset: the peak is then that about their mean.
    * `notes`: further notes than those of the series.
    """
    own = series.values if own is None else own
    file_pfa = peak(own - own.mean() if has_offset else own)
    notes = [*series.notes, *notes]
    if header_pfa is not None and abs(header_pfa - file_pfa) > HEADER_PEAK_WITHIN * file_pfa:
        notes.append(
            fill(
                "the header prints a peak of {printed:.4g} cm/s2, the data have {found:.4g} cm/s2",
                printed=100 * header_pfa,
                found=100 * file_pfa,
            )
        )
    return Record(
        file="", format="", channel=channel or "1", location=location, azimuth_deg=direction[0], vertical=direction[1],
        station=station, event=event, start=start, corrected=corrected, time_step=series.time_step,
        acceleration=series.values, file_pfa=file_pfa, header_pfa=header_pfa, notes=tuple(notes), recorder=recorder,
    )  # fmt: skip


def read_real(text: str) -> float | None:
    """Return the number that `text` is, None where it is none; Fortran's D stands for E."""
    try:
        return float(_EXPONENT.sub("E", text))
    except ValueError:
        return None


def read_finite(text: str | None) -> float | None:
    """Return the finite number that `text` is, None where it is none."""
    number = read_real(text or "")
    return number if number is not None and math.isfinite(number) else None


def read_acceleration_unit(text: str) -> float | None:
    """Return the factor from the unit that `text` names to m/s2, None where it is no unit of acceleration."""
    spelt = read_unit(text.replace("**", "").replace("^", "")).replace("sec", "s").replace("/s/s", "/s2").strip(".")
    return ACCELERATION.get(spelt, _MORE_UNITS.get(spelt))


def require_unit(text: str) -> float:
    """Return the factor from the unit that `text` names to m/s2; RecordError where it is no unit of acceleration."""
    factor = read_acceleration_unit(text)
    if factor is None:
        raise RecordError.about("{unit!r} is not a known unit of acceleration. Get the file again", unit=text[:20])
    return factor


def name_quantity(text: str) -> str:
    """Return what a file holds instead of accelerations, as messages call it; as in its header if it is not known."""
    return _QUANTITIES.get(text.lower(), text.lower())


def read_peak(number: str, unit: float | None) -> float | None:
    """Return the peak that a header prints, in `unit` [m/s2], as m/s2 without sign; None where there is none."""
    found = read_finite(number)
    return None if found is None or unit is None else abs(found) * unit


def even_series(values: FloatArray, time_step: float, notes: Sequence[str] = ()) -> Series:
    """Return samples that the file says are evenly spaced, checked."""
    check_samples(values)
    check_time_step(time_step)
    return Series(float(f"{time_step:.12g}"), values, tuple(notes))


def check_channels(count: int) -> None:
    """Raise RecordError if a file has more channels than are read."""
    if count > MOST_CHANNELS:
        raise RecordError.about(
            "the file has more than {most} channels: give a file with those that are needed", most=MOST_CHANNELS
        )


def too_many_values() -> RecordError:
    """Return the error for a file with more samples than are read."""
    return RecordError.about(
        "the file has more than {most:,} samples: give the channels that are needed, cut to the shaking",
        most=MOST_VALUES,
    )


def keep_readable(parts: Iterable[tuple[str, T]], read: Callable[[T], Record]) -> tuple[Record, ...]:
    """Read every named part that can be read, and note on those why the others cannot; RecordError if none can."""
    records, reasons = [], []
    for name, part in parts:
        try:
            records.append(read(part))
        except RecordError as error:
            reasons.append((name, error.message))
    if not records and len(reasons) == 1:
        raise RecordError(reasons[0][1])
    if not records:
        listed = join("; ", (join(": ", reason) for reason in reasons[:MOST_NOTES]))
        raise RecordError.about(
            "none of its {count} channels can be read: {reasons}", count=len(reasons), reasons=listed
        )
    notes = [
        fill("{part} of the file is left out: {reason}", part=name, reason=reason)
        for name, reason in reasons[:MOST_NOTES]
    ]
    more = len(reasons) - MOST_NOTES
    if more > 0:
        notes.append(
            nfill("{n} more channel of the file is left out", "{n} more channels of the file are left out", more)
        )
    return tuple(replace(record, notes=(*record.notes, *notes)) for record in records)


# ---------------------------------------------------------------- directions


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_VERTICAL = _words(
    "up down dn dwn ver vert vrt vertical verticale vertikal verticaal düşey z az acz accz v u ud du 上下"
)
_POINTS = {
    **dict.fromkeys(_words("n ns sn north nord norte noord kuzey 南北"), 0.0),
    **dict.fromkeys(_words("e ew we east est este ost oost doğu 東西"), 90.0),
    **dict.fromkeys(_words("s south sud süd sur zuid güney"), 180.0),
    **dict.fromkeys(_words("w west ouest ovest oeste batı"), 270.0),
}
_LEVEL = _words(
    "x y ax ay acx acy accx accy h hor horiz horizontal horizontale orizzontale l long longitudinal longitudinale lon "
    "t tra tran trans transv transverse transversal trasversale r rad radial radiale fn fp"
)
_NEUTRAL = _words("a acc accel acceleration ch chan channel comp component dir direction")
_PAIR = re.compile(r"\b([nsewud])\s*[-/]\s*([nsewud])\b", re.IGNORECASE)
_TOKEN = re.compile(r"[^\W_]+")
_WORD = re.compile(r"([^\W\d_]+)\d{0,2}")
_SEED = re.compile(r"(?:\w*\d)?(?!ch)[bcdefghlmprsuv][ghlmn](?P<last>[ensz12])(?:\d\d)?", re.IGNORECASE | re.ASCII)
_DEGREES = re.compile(r"(\d{1,3}(?:\.\d*)?)\s*(?:deg\w*\.?|°)", re.IGNORECASE | re.ASCII)
_BARE = re.compile(r"(?:[A-Z][\w-]*?(?=\d{3}$))?(\d{1,3}(?:\.\d*)?)", re.IGNORECASE | re.ASCII)
_QUADRANT = re.compile(r"([NS])\s*(\d{1,2}(?:\.\d*)?)\s*(?:deg\w*\.?|°)?\s*([EW])", re.IGNORECASE | re.ASCII)


def read_direction(text: str, *, bare_degrees: bool = True) -> Direction:
    """Return the direction by a channel's name or header, such as "N21W", "090", "HNZ--", "UD2", "roof, east", "Düşey".

    It is not known where no word tells a direction, or where two of them contradict each other. `bare_degrees` tells
    whether a number alone, or at the end of a station's code, is an azimuth and not the number of the channel.
    """
    text = text.strip()
    quadrant, degrees = _QUADRANT.fullmatch(text), _DEGREES.search(text)
    if quadrant:
        off = float(quadrant[2]) * (1 if quadrant[3].upper() == "E" else -1)
        return (off if quadrant[1].upper() == "N" else 180 - off) % 360, False
    azimuths: set[float | None] = set()  # of the words, with None for a word that has none
    upright = level = False
    for token in _TOKEN.findall(_PAIR.sub(r"\1\2", text)):
        code, word = _SEED.fullmatch(token), _WORD.fullmatch(token)
        name = (code["last"] if code else word[1] if word else "").casefold()
        upright |= name in _VERTICAL
        level |= name in _POINTS or name in _LEVEL or (code is not None and name in {"1", "2"})
        if name not in _NEUTRAL and not token.isdecimal():
            azimuths.add(_POINTS.get(name))
    degrees = degrees or (_BARE.fullmatch(text) if bare_degrees else None)
    if degrees and float(degrees[1]) <= 360 and not upright:
        return float(degrees[1]), False
    if upright == level:
        return UNKNOWN
    return (azimuths.pop() if len(azimuths) == 1 else None), upright


def settle_directions(records: Sequence[Record]) -> tuple[Record, ...]:
    """Return the records, with the directions that follow from the other two of three components of one recording.

    Of three, the one beside two horizontal ones is vertical, and those beside a vertical one are horizontal.
    """
    recordings, settled = defaultdict(list), list(records)
    for at, record in enumerate(records):
        own = record.file if not (record.station or record.event) else ""
        recordings[record.format, record.station, record.event, record.start, record.location, own].append(at)
    for places in recordings.values():
        known = [records[at].vertical for at in places]
        if len(places) != 3 or (known.count(False), known.count(True)) not in {(2, 0), (0, 1), (1, 1)}:
            continue
        vertical = True not in known
        why = (
            fill("the file does not tell its direction: beside two horizontal components it is the vertical one")
            if vertical
            else fill("the file does not tell its direction: beside the vertical component it is a horizontal one")
        )
        for at in (at for at in places if records[at].vertical is None):
            settled[at] = replace(records[at], vertical=vertical, notes=(*records[at].notes, why))
    return tuple(settled)
