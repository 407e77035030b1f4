"""Which way a channel points, for all formats: its azimuth, and whether it is vertical, horizontal or not known."""

import re
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

from assess.i18n import fill
from assess.motion.record import Record

Direction = tuple[float | None, bool | None]
"""Azimuth [deg], None where it is unknown, and whether the channel is vertical, None where nothing tells."""
UNKNOWN: Direction = (None, None)

COMPONENTS = 3
"""Of one recording at one place."""


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
    """Return the direction that the name of a channel or the header's word for it tells.

    * `text`: such as "N21W", "090", "HNZ--", "UD2", "roof, east" or "Düşey".
    * `bare_degrees`: whether a number alone, or at the end of a station's code, is an azimuth and not the number of the
      channel.

    Returned: not known where no word of it tells a direction, or where two of them contradict each other.
    """
    text = text.strip()
    quadrant, degrees = _QUADRANT.fullmatch(text), _DEGREES.search(text)
    if quadrant:
        off = float(quadrant[2]) * (1 if quadrant[3].upper() == "E" else -1)
        return (off if quadrant[1].upper() == "N" else 180 - off) % 360, False
    azimuths, upright, level = _read_words(text)
    degrees = degrees or (_BARE.fullmatch(text) if bare_degrees else None)
    if degrees and float(degrees[1]) <= 360 and not upright:
        return float(degrees[1]), False
    if upright == level:
        return UNKNOWN
    return (azimuths.pop() if len(azimuths) == 1 else None), upright


def _read_words(text: str) -> tuple[set[float | None], bool, bool]:
    """Return the azimuths of the words, with None for a word that has none, and whether one is vertical, one level."""
    azimuths: set[float | None] = set()
    upright = level = False
    for token in _TOKEN.findall(_PAIR.sub(r"\1\2", text)):
        code, word = _SEED.fullmatch(token), _WORD.fullmatch(token)
        name = (code["last"] if code else word[1] if word else "").casefold()
        upright |= name in _VERTICAL
        level |= name in _POINTS or name in _LEVEL or (code is not None and name in {"1", "2"})
        if name not in _NEUTRAL and not token.isdecimal():
            azimuths.add(_POINTS.get(name))
    return azimuths, upright, level


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
        if len(places) != COMPONENTS or (known.count(False), known.count(True)) not in {(2, 0), (0, 1), (1, 1)}:
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
