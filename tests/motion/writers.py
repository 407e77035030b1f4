"""Writes a small valid file of every format: a known signal in, bytes out."""

import io
import struct
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from assess.arrays import FloatArray
from assess.units import GRAVITY


def wave(count: int = 400, step: float = 0.01, peak: float = 1.5) -> FloatArray:
    """Return a decaying sine [m/s2] whose largest value is about `peak`."""
    times = np.arange(count) * step
    return np.asarray(peak * np.sin(2 * np.pi * 1.5 * times) * np.exp(-times / 2), dtype=np.float64)


@dataclass(frozen=True)
class Signal:
    """What a writer writes; an azimuth of None is the vertical."""

    acceleration: FloatArray = field(default_factory=wave)
    azimuth: float | None = 90.0
    number: int = 1
    step: float = 0.01

    @property
    def direction(self) -> str:
        return "UP" if self.azimuth is None else f"{self.azimuth:3.0f} DEG"

    @property
    def peak(self) -> float:
        return float(self.acceleration[np.abs(self.acceleration).argmax()])


EAST, NORTH, UP = Signal(), Signal(wave(peak=0.8), 360.0, 2), Signal(wave(peak=0.4), None, 3)
THREE = (EAST, NORTH, UP)


def block(values: Sequence[float], per_line: int, form: str) -> list[str]:
    """Return lines of numbers, as Fortran writes them."""
    texts = [form.format(value) for value in values]
    return ["".join(texts[first : first + per_line]) for first in range(0, len(texts), per_line)]


def joined(lines: Sequence[str]) -> bytes:
    return ("\r\n".join(lines) + "\r\n").encode("latin-1")


# --- CSMIP ---


def _csmip_text(signal: Signal, peak_line: str) -> list[str]:
    return [
        "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 02/08/94, CDMG QN94A403",
        "MADE-UP EARTHQUAKE",
        "JANUARY 17, 1994 04:31 PST              (ORIGIN(CIT): 01/17/94, 12:30:55.4 GMT)",
        "14403-S3492-94021.02               TRIGGER TIME: 01/17/94, 12:31:04.1 UTC",
        "STATION NO. 14403   33.929N, 118.260W     SMA-1  S/N 3492 ( 3 CHNS OF 16 AT STA)",
        "TOWN HALL                                 CGS",
        f"CHAN {signal.number:2d}: {signal.direction}  (STA CHN: {signal.number + 10})     LOCATION: ROOF: EAST WALL",
        "MADE-UP EARTHQUAKE     JANUARY 17, 1994 04:31 PST",
        "HYPOCENTER: 34.215N, 118.538W, H=18KM.",
        "INSTR PERIOD =  .0397 SEC,  DAMPING =  .592,  SENSITIVITY = 1.77 CM/G.",
        f"NO. OF POINTS = {signal.acceleration.size:6d}  RECORD LENGTH = 4.000 SEC",
        peak_line,
        "RMS ACCEL OF COMPLETE RECORD =  .021 G.",
    ]


def _csmip_numbers(reals: int) -> list[str]:
    return block([0] * 100, 16, "{:5d}") + block([0.0] * reals, 8, "{:10.3f}")


def _csmip_end(signal: Signal) -> str:
    return f"/&  ----------  END OF DATA FOR CHANNEL {signal.number:2d}  ----------"


def csmip_v1(*signals: Signal) -> bytes:
    """Evenly spaced, in g."""
    lines = []
    for signal in signals:
        rate, count = 1 / signal.step, signal.acceleration.size
        peak_line = f"Units of uncor data are sec and g .        Max  = {signal.peak / GRAVITY:7.3f} g , at 1.000 sec."
        lines += _csmip_text(signal, peak_line) + _csmip_numbers(50)
        lines.append(f" {count:5d} Accelerogram points at {rate:.0f} pts/sec in units of g .      Format: (8f9.6)")
        lines += [*block(list(signal.acceleration / GRAVITY), 8, "{:9.6f}"), _csmip_end(signal)]
    return joined(lines)


def csmip_v1_pairs(*signals: Signal) -> bytes:
    """Pairs of time and g/10, as from film."""
    lines = []
    for signal in signals:
        peak_line = f"UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = {signal.peak / GRAVITY:7.3f} G, AT   1.000 SEC."
        times = np.arange(signal.acceleration.size) * signal.step
        pairs = np.column_stack([times, signal.acceleration / GRAVITY * 10]).ravel()
        lines += _csmip_text(signal, peak_line) + _csmip_numbers(50)
        lines += [*block(list(pairs), 10, "{:7.3f}"), _csmip_end(signal)]
    return joined(lines)


def csmip_v2(*signals: Signal, form: str = "") -> bytes:
    lines = []
    for signal in signals:
        count, values = signal.acceleration.size, 100 * signal.acceleration
        lines += [
            f"CORRECTED ACCELEROGRAM   14403-S3492-94021.02    CHAN {signal.number:2d}: {signal.direction}   FROM"
        ]
        lines += _csmip_text(signal, "                        UNCOR MAX  =  -.275 G, AT  10.947 SEC.")
        lines += ["ACCELEROGRAM BANDPASS FILTERED WITH RAMPS AT  .050- .100 AND 23.00-25.00 CYC/SEC"]
        lines += [f"{count:6d} POINTS OF INSTRUMENT- AND BASELINE-CORRECTED ACCEL, VELOC AND DISPL DATA"]
        lines += [f"AT EQUALLY-SPACED INTERVALS OF    {signal.step:.3f}  SEC."]
        lines += [f"PEAK ACCELERATION = {100 * signal.peak:9.3f}    CM/SEC/SEC  AT   10.940   SEC."]
        lines += ["PEAK   VELOCITY   =     1.000      CM/SEC    AT   11.100   SEC."] + [""] * 6
        lines += _csmip_numbers(100)
        lines += [
            f"{count:5d} POINTS OF ACCEL DATA EQUALLY SPACED AT {signal.step:5.3f} SEC.  (UNITS: CM/SEC/SEC){form}"
        ]
        lines += block(list(values), 8, "{:10.3f}")
        for name, unit in (("VELOC", "CM/SEC"), ("DISPL", "CM")):
            lines += [f"{count:5d} POINTS OF {name} DATA EQUALLY SPACED AT {signal.step:5.3f} SEC.  (UNITS: {unit})"]
            lines += block([7000.0] * count, 8, "{:10.3f}")
        lines.append(_csmip_end(signal))
    return joined(lines)


# --- COSMOS ---


def cosmos(
    *signals: Signal,
    stage: int = 2,
    kind: str = "Corrected acceleration",
    unit: str = "cm/sec2(04)",
    factor: float = 0.01,
    text_direction: bool = True,
) -> bytes:
    lines = []
    for signal in signals:
        integers, reals, name = [-999] * 100, [-999.0] * 100, unit.partition("(")[0]
        integers[0], integers[53] = stage, 400 if signal.azimuth is None else round(signal.azimuth)
        reals[33], reals[61] = 0.005, 1000 * signal.step
        direction = signal.direction.title() if text_direction else "?"
        lines += [
            f"{kind}    (Format v01.20 with 13 text lines) Src: made up",
            "Record of Made-up Earthquake of Fri Nov 30, 2018 17:29 UTC",
            "Hypocenter: 61.34640 -149.95520 H= 46km Mw=7.0",
            "Origin: 2018/11/30 17:29:29    UTC",
            "Statn No: 02-008040 Code:NP-8040   USGS  AK:Anchorage;Town Hall",
            "Coords: 61.2135 -149.8933  Site geology:",
            "Recorder: Granite         (32 Chns of  53 at Sta) Sensor: Episensor",
            "Rcrd start time: 2018/11/30 17:29:06.332 UTC (Q=5) RcrdId: (see comment)",
            f"Sta Chan   {signal.number}: {direction} (Rcrdr Chan  ?) Location:Roof NW corner",
            "Raw record length = 210.000 sec, Uncor max =   1033406, at  45.580 sec.",
            f"Processed:2019/06/28 02:27:47 UTC (NCSN) Max = {signal.peak / factor:.3f} {name}, at 1 sec",
            "Record filtered below 0.1 Hz (periods over 10 secs), and above 40 Hz",
            "Values used when parameter or data value is unknown/unspecified:   -999, -999.00",
            " 100 Integer-header values follow on  10 lines, Format= (10I8)",
            *block(integers, 10, "{:8d}"),
            " 100 Real-header values follow on  17 lines, Format= (6F13.6)",
            *block(reals, 6, "{:13.6f}"),
            '   1 Comment line(s) follow, each starting with a "|":',
            "| 3 units=cm/sec2(04),Format=(8F10.5) is only a comment",
            f"  {signal.acceleration.size:6d}  acceleration pts, approx    4 secs, units={unit},Format=(8F10.5)",
            *block(list(signal.acceleration / factor), 8, "{:10.5f}"),
            f"/&  ----------  End of data for channel  {signal.number}  ----------",
        ]
    return joined(lines)


# --- one channel to a file ---


def at2(signal: Signal = EAST, *, old: bool = False, kind: str = "ACCELERATION", unit: str = "G") -> bytes:
    count = signal.acceleration.size
    component = "UP" if signal.azimuth is None else f"{signal.azimuth:03.0f}"
    head = [
        "PEER NGA STRONG MOTION DATABASE RECORD",
        f"Made-up, 10/18/1989, Town Hall, roof, {component}",
        f"{kind} TIME SERIES IN UNITS OF {unit}",
        f"NPTS=   {count}, DT=   {signal.step:.4f} SEC,",
    ]
    if old:
        head = [
            "PEER STRONG MOTION DATABASE RECORD. PROCESSING BY PACIFIC ENGINEERING.",
            f"MADE-UP 5/19/40 0439, TOWN HALL, {component} (USGS STATION 117)",
            f"{kind} TIME HISTORY IN UNITS OF {unit}. FILTER POINTS: HP=0.2 Hz LP=15.0 Hz",
            f" {count}    {signal.step:.4f}    NPTS, DT",
        ]
    return joined(head + block(list(signal.acceleration / GRAVITY), 5, "{:15.7E}"))


SCALE = 3920 / 6182761 / 100
"""One count of the K-NET writer [m/s2]."""


def knet(signal: Signal = EAST, *, direction: str = "E-W", offset: int = -12085, **changes: str) -> bytes:
    """Whole counts about an offset; `changes` replace what stands behind a name, with _ for its blanks."""
    counts = np.rint(signal.acceleration / SCALE).astype(int)
    about = np.abs(counts - counts.mean()).max() * SCALE * 100
    header = {
        "Origin Time": "2018/01/24 19:51:00", "Lat.": "41.0", "Long.": "142.5", "Depth. (km)": "30", "Mag.": "6.2",
        "Station Code": "AOM001", "Station Lat.": "41.5267", "Station Long.": "140.9244", "Station Height(m)": "39",
        "Record Time": "2018/01/24 19:51:43", "Sampling Freq(Hz)": f"{1 / signal.step:.0f}Hz",
        "Duration Time(s)": f"{counts.size * signal.step:.0f}", "Dir.": direction,
        "Scale Factor": "3920(gal)/6182761", "Max. Acc. (gal)": f"{about:.3f}",
        "Last Correction": "2018/01/24 19:51:43", "Memo.": "",
    }  # fmt: skip
    header |= {name.replace("_", " "): value for name, value in changes.items()}
    lines = [f"{name:<18}{value}" for name, value in header.items()]
    return joined(lines + block(list(counts + offset), 8, "{:8d} "))


def esm(signal: Signal = EAST, **changes: str) -> bytes:
    """Write cm/s^2; `changes` replace the value behind a key."""
    header = {
        "EVENT_NAME": "MADE-UP", "EVENT_DATE_YYYYMMDD": "20190728", "STATION_CODE": "ARS1",
        "STATION_NAME": "Town Hall", "LOCATION": "00",
        "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS": "20190728_160919.870", "SAMPLING_INTERVAL_S": f"{signal.step:.6f}",
        "NDATA": f"{signal.acceleration.size}", "STREAM": "HNZ" if signal.azimuth is None else "HNE",
        "UNITS": "cm/s^2", "PGA_CM/S^2": f"{100 * signal.peak:.6f}", "BASELINE_CORRECTION": "BASELINE REMOVED",
        "FILTER_TYPE": "BUTTERWORTH", "DATA_TYPE": "ACCELERATION", "PROCESSING": "manual (Paolucci et al., 2011)",
        "USER1": "",
    }  # fmt: skip
    header |= {name.replace("__", "/"): value for name, value in changes.items()}
    lines = [f"{name}: {value}" for name, value in header.items()]
    return joined(lines + block(list(100 * signal.acceleration), 1, "{:.6f}"))


def geonet(*signals: Signal, corrected: bool = True) -> bytes:
    lines = []
    for signal in signals:
        count, values = signal.acceleration.size, 1000 * signal.acceleration
        names = {None: "Up", 90.0: "N90E", 360.0: "N00E", 242.0: "S62W"}
        numbers = np.zeros((10, 10))
        numbers[3, 0 if not corrected else 3], numbers[6, 4], numbers[6, 5] = count, 0.005, signal.step
        lines += [
            f"{'C' if corrected else 'Unc'}orrected accelerogram 20161113_110256_WTMC_20 GNS Science",
            "Site WTMC      42 37 10S  173 03 13E     Cusp file:  20161113_110259_WTMC",
            "Town Hall", "Instrument Cusp_10462", "Resolution: 18-bit   Instr Period: 0.0050 s   Damping: 0.700",
            "Accelerogram 20161113_110256_WTMC_20                 Processed 2016 December 09",
            "5 km south-west of Waiau", "2016 November 13         11:02:56 UT",
            "Epicentre  42 41 33S 173 01 19E  Bearing S18W  Dist    9km  Depth   15km Mw 7.82",
            f"Number of points  {count}    Duration 4.00 s",
            f"Raw readings in units of 1.00 mm/s/s  at intervals of {signal.step:.3f} s" if not corrected
            else f"Instrument corrected data at {signal.step:.3f} sec intervals",
            "Data is unfiltered", f"Component {names[signal.azimuth]}  Longitudinal Accelerometer Axis",
            f"Acceleration:  peak {1000 * signal.peak:8.1f} mm/s/s at  44.88 sec     rms    719.0 mm/s/s",
            "Velocity record unevaluated", "Displacement record unevaluated",
        ]  # fmt: skip
        lines += ["".join(f"{number:8.0f}" for number in row) for row in numbers[:4]]
        lines += ["".join(f"{number:8.4f}" for number in row) for row in numbers[4:]]
        lines += block(list(values), 10, "{:8.1f}")
        lines += block([9999.0] * (2 * count), 10, "{:8.1f}") if corrected else []
    return joined(lines)


# --- binary ---


def sac(
    signal: Signal = EAST, *, order: str = "<", unit: str = "", meaning: int = 5, factor: float = 1.0,
    kind: int = 1, even: int = 1, count: int | None = None,
) -> bytes:  # fmt: skip
    """Write `factor` times m/s2; `unit` goes into KUSER0, `meaning` into IDEP."""
    reals, integers = np.full(70, -12345.0), np.full(40, -12345)
    reals[0], reals[5], reals[6] = signal.step, 0.0, (signal.acceleration.size - 1) * signal.step
    reals[57], reals[58] = signal.azimuth or 0.0, 0.0 if signal.azimuth is None else 90.0
    integers[:6], integers[6] = (2019, 187, 3, 19, 52, 0), 6
    integers[9] = signal.acceleration.size if count is None else count
    integers[15], integers[16], integers[35:40] = kind, meaning, (even, 0, 1, 1, 0)
    texts = [b"-12345  "] * 24
    texts[:3], texts[20:22] = [b"TOWN    ", b"Made-up ", b"        "], [b"HNE     ", b"CJ      "]
    texts[17] = unit.encode().ljust(8)  # KUSER0
    header = reals.astype(f"{order}f4").tobytes() + integers.astype(f"{order}i4").tobytes() + b"".join(texts)
    return header + (factor * signal.acceleration).astype(f"{order}f4").tobytes()


def mseed(*signals: Signal, code: str = "HNE", whole: bool = False, gap_after: int = 0, station: str = "TOWN") -> bytes:
    """Write records of 512 bytes of 32-bit numbers; `whole` ones are counts; samples after `gap_after` are 1 s late."""
    records: list[bytes] = []
    form, encoding = (">i4", 3) if whole else (">f4", 4)
    for signal in signals:
        name = f"{code[:2]}{'Z' if signal.azimuth is None else 'N' if signal.azimuth == 360 else code[2]}"
        for first in range(0, signal.acceleration.size, 100):
            values = signal.acceleration[first : first + 100].astype(form)
            late = 1.0 if gap_after and first >= gap_after else 0.0
            ticks = round((first * signal.step + late) * 10_000)
            head = f"{len(records) + 1:06d}D {station:<5}  {name:<3}NP".encode()
            head += struct.pack(">HHBBBBH", 2018, 334, 17, 28, 10 + ticks // 10_000, 0, ticks % 10_000)
            head += struct.pack(">HhhBBBBiHH", values.size, round(1 / signal.step), 1, 0, 0, 0, 1, 0, 64, 48)
            head += struct.pack(">HHBBBB", 1000, 0, encoding, 1, 9, 0)
            records.append((head.ljust(64, b"\0") + values.tobytes()).ljust(512, b"\0"))
    return b"".join(records)


def zipped(members: Mapping[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w", method) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return target.getvalue()


@dataclass(frozen=True)
class Sample:
    """A written file, of the format `key`, and what it holds; digits of the format lose up to `within` [m/s2]."""

    key: str
    data: bytes
    signals: Sequence[Signal]
    corrected: bool
    within: float


SAMPLES: Mapping[str, Callable[[], Sample]] = {
    "v1": lambda: Sample("csmip_v1", csmip_v1(*THREE), THREE, False, 1e-5),
    "v1 pairs": lambda: Sample("csmip_v1", csmip_v1_pairs(*THREE), THREE, False, 1e-3),
    "v2": lambda: Sample("csmip_v2", csmip_v2(*THREE), THREE, True, 1e-5),
    "cosmos v1": lambda: Sample("cosmos", cosmos(*THREE, stage=1), THREE, False, 1e-7),
    "cosmos v2": lambda: Sample("cosmos", cosmos(*THREE), THREE, True, 1e-7),
    "cosmos g": lambda: Sample("cosmos", cosmos(EAST, unit="g(02)", factor=GRAVITY), [EAST], True, 1e-4),
    "at2": lambda: Sample("peer_at2", at2(), [EAST], True, 1e-6),
    "at2 old": lambda: Sample("peer_at2", at2(UP, old=True), [UP], True, 1e-6),
    "k-net": lambda: Sample("knet", knet(offset=0), [EAST], False, SCALE),
    "kik-net": lambda: Sample("knet", knet(UP, direction="6", offset=0), [UP], False, SCALE),
    "esm": lambda: Sample("esm", esm(), [EAST], True, 1e-8),
    "geonet v1a": lambda: Sample("geonet", geonet(*THREE, corrected=False), THREE, False, 1e-4),
    "geonet v2a": lambda: Sample("geonet", geonet(*THREE), THREE, True, 1e-4),
    "sac g": lambda: Sample("sac", sac(unit="g", factor=1 / GRAVITY), [EAST], False, 1e-6),
    "sac big-endian": lambda: Sample("sac", sac(UP, order=">", meaning=8, factor=1e9), [UP], False, 1e-6),
    "miniseed": lambda: Sample("miniseed", mseed(*THREE), THREE, False, 1e-6),
}
"""A file of every format and kind."""
