"""Options that several commands have, their values as arguments of the library, and the writing of files."""

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from assess.cli.console import say
from assess.errors import InputError, OutputError
from assess.i18n import LANGUAGES, count
from assess.settings import AUTO, CLASS_BY, MOST_SCALE, RUNS, SCENARIOS, SEED, VERIFY, Settings, change_settings

if TYPE_CHECKING:
    from assess.motion.site_ground import GroundField

FIGURES = (".png", ".svg", ".pdf")  # kinds of figures that can be written


def one_of(values: Sequence[str]) -> Callable[[str], list[str]]:
    """Return what completes one of some words, in capitals or not; spaces become hyphens, for the shell."""
    plain = [value.replace(" ", "-").lower() for value in values]
    return lambda incomplete: [
        f"{incomplete}{value[len(incomplete) :]}" for value in plain if value.startswith(incomplete.lower())
    ]


def list_of(values: Sequence[str]) -> Callable[[str], list[str]]:
    """Return what completes the last of some words that commas separate, without those that are there already."""

    def complete(incomplete: str) -> list[str]:
        before, comma, _last = incomplete.rpartition(",")
        return [f"{before}{comma}{value}" for value in values if value not in before.split(",")]

    return complete


Workbook = Annotated[Path, typer.Argument(help="The inventory, an .xlsx workbook.", show_default=False)]
Runs = Annotated[
    str | None,
    typer.Option(
        help=f"Motions of each floor and axis; {AUTO}: until every class is statistically resolved.",
        show_default=str(RUNS),
        autocompletion=one_of((AUTO,)),
    ),
]
Draws = Annotated[str | None, typer.Option(help="Draws: motions of each floor and axis.", show_default=str(RUNS))]
Seed = Annotated[int | None, typer.Option(help="Random seed of the generated motions.", show_default=str(SEED))]


def read_size(text: str | float) -> float:
    """Return a length in cm, typed as in the workbook: 40, 40 cm, 12in, 1' 6"; typer.BadParameter if it is none."""
    from assess.workbook.habits import CellError
    from assess.workbook.schema import ITEMS
    from assess.workbook.values import understand

    try:
        return float(text)
    except ValueError:
        pass
    try:
        found = understand(ITEMS.column("breadth"), str(text), "cm")[0]
    except CellError as error:
        raise typer.BadParameter(f"{error.message} {error.fix}".strip()) from None
    if not isinstance(found, int | float):
        raise typer.BadParameter(f"{text!r} is not a number; expected one such as 40 or 12in")
    return float(found)


def read_factor(text: str | float) -> float:
    """Return a factor [-], which may be typed as a percentage; typer.BadParameter if it is none."""
    typed = str(text).strip()
    try:
        number = float(typed.removesuffix("%"))
    except ValueError:
        raise typer.BadParameter(
            f"{typed.removesuffix('%')!r} is not a number; expected one such as 1.5 or 150%"
        ) from None
    return number / 100 if typed.endswith("%") else number


SIZE: dict[str, Any] = {"parser": read_size, "metavar": "<float>"}  # of an option that takes a length [cm]
Scale = Annotated[
    float,
    typer.Option(
        parser=read_factor,
        metavar="<float>",
        help=f"Factor on every floor's motion, records and peaks alike: above 0, at most {MOST_SCALE:g}.",
        show_default=True,
    ),
]
Scenario = Annotated[
    str | None,
    typer.Option(
        help=f"Source of the floor motion: {', '.join(SCENARIOS)}.",
        show_default="the workbook's",
        autocompletion=one_of(SCENARIOS),
    ),
]
ClassBy = Annotated[
    str | None,
    typer.Option(
        help=f"Formula that gives the class of what is not simulated: {', '.join(CLASS_BY)}.",
        show_default="the workbook's",
        autocompletion=one_of(CLASS_BY),
    ),
]
Verify = Annotated[
    str,
    typer.Option(
        help="Pieces to simulate by integration: all, high (high risk, doubtful, on routes), none.",
        autocompletion=one_of(VERIFY),
    ),
]
Ideal = Annotated[
    bool,
    typer.Option(
        "--ideal",
        help="Adopt the chance if exactly this motion recurred, every piece exactly as given: without uncertainty.",
    ),
]
Jobs = Annotated[
    int | None, typer.Option(min=1, help="Threads; they do not change a result.", show_default="one per CPU")
]
ShakeMapFile = Annotated[
    Path | None,
    typer.Option(
        "--shakemap",
        help="grid.xml of a ShakeMap (USGS), with its uncertainty.xml beside it: the ground motion at Latitude and "
        "Longitude of Building, in place of the one of the workbook.",
        show_default=False,
    ),
]
GroundMotions = Annotated[
    Path | None,
    typer.Option(
        "--ground-motions",
        help="Folder with gmf-data.csv and sitemesh.csv (or sites.csv) of OpenQuake: computed scenarios of the ground "
        "motion, in place of the one of the workbook.",
        show_default=False,
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON document instead of text.")]


def language_of(what: str, default: str = LANGUAGES[0]) -> Any:
    """Return the option for the language of what is written; `default` says which one it is without it."""
    own: dict[str, Any] = {} if default == LANGUAGES[0] else {"show_default": default}
    return typer.Option(help=f"Language of {what}: {', '.join(LANGUAGES)}.", autocompletion=one_of(LANGUAGES), **own)


def plot_of(what: str) -> Any:
    """Return the option for a figure."""
    return typer.Option(help=f"Draw {what} to this {', '.join(FIGURES[:-1])} or {FIGURES[-1]}.")


def force(what: str) -> Any:
    """Return the option that has a file replaced."""
    return typer.Option("--force", help=f"Replace {what}.")


def read_settings(**given: Any) -> Settings:
    """Return the settings with the options that were given; None is one that was not."""
    return change_settings(None, {name: value for name, value in given.items() if value is not None})


def read_run_settings(**given: Any) -> Settings:
    """Return the settings of `assess run` and `assess portfolio`, whose --ideal is about what is simulated."""
    if given["ideal"] and given["verify"] == "none":
        raise InputError("--ideal is about the simulation: leave out --ideal or --verify none")
    return read_settings(**given)


def read_draw_settings(of_each: str, **given: Any) -> Settings:
    """Return the settings of commands whose draws serve at every level of shaking (`of_each`)."""
    settings = read_settings(verify="none", **given)
    if settings.runs == AUTO:
        raise InputError(f"--runs: {AUTO} is for assess run, as every {of_each} uses the same motions. Give a number.")
    return settings


def fit_runs(settings: Settings, scenarios: int) -> Settings:
    """Return the settings with as many draws as count every computed scenario of the ground alike, if there are any."""
    from assess.pipeline.city_draws import choose_runs

    return change_settings(settings, {"runs": choose_runs(scenarios)}) if scenarios else settings


def read_ground(shakemap: Path | None, scenarios: Path | None) -> "GroundField | None":
    """Return the ground motion that --shakemap or --ground-motions names, which exclude each other."""
    if shakemap is not None and scenarios is not None:
        raise InputError("--shakemap and --ground-motions both give the ground motion: leave one out")
    if shakemap is not None:
        from assess.motion.shakemap import read_shakemap

        return read_shakemap(shakemap)
    if scenarios is not None:
        from assess.motion.ground_scenarios import read_scenarios

        return read_scenarios(scenarios)
    return None


def spell_options(settings: Mapping[str, Any], names: Iterable[str]) -> Iterator[str]:
    """Yield the parts of a command line that give `assess run` those of some settings that are not by default."""
    default = Settings().as_record()
    for name in names:
        value = settings.get(name)
        if value not in (None, default[name]):
            yield from (f"--{name.replace('_', '-')}", *(() if value is True else (str(value),)))


def check_out(folder: Path, formats: Sequence[str] = ()) -> None:
    """Raise unless reports can be written to a folder, as far as is known before the work (`report.check_folder`)."""
    if folder.exists() and not folder.is_dir():
        raise InputError(f"--out: {folder} is a file; name a folder")
    from assess.report import check_folder

    check_folder(folder, formats)


def check_file(path: Path | None, what: str, endings: tuple[str, ...] = FIGURES) -> None:
    """Raise InputError unless a file of one of these kinds can be written, as far as is known before the work."""
    if path is None:
        return
    if path.suffix.lower() not in endings:
        expected = " or ".join(filter(None, (", ".join(endings[:-1]), endings[-1])))
        raise InputError(f"the {what} {path.name} has an unsupported file type: end its name in {expected}")
    try:
        can_be = path.parent.is_dir() and not path.is_dir()
    except OSError:  # a name that is too long
        can_be = False
    if not can_be:
        raise InputError(f"the {what} {path} cannot be written there: name a file in a folder that exists")


def quote(path: Path) -> str:
    """Return a path as it is typed in a command."""
    return f'"{path}"' if " " in str(path) else str(path)


def is_same(path: Path, other: Path) -> bool:
    """Tell whether two names are those of one file."""
    return path.resolve() == other.resolve() or (path.exists() and other.exists() and path.samefile(other))


def check_new(path: Path, *, replaces: bool) -> None:
    """Raise OutputError if a file exists, and it was not asked for that it be replaced."""
    if path.exists() and not replaces:
        raise OutputError(f"{path} already exists: add --force to replace it, or choose another name.")


def save_files(files: Mapping[Path, bytes]) -> None:
    """Write files, whole or none of them; the folder of each is made if missing. See `assess.delivery`.

    Raises OutputError if one cannot be written; what was there before is left.
    """
    from assess.delivery.deliver import save

    try:
        save(files)
    except OSError as error:
        names = {path.name: path for path in files}
        named = (Path(name).name for name in (error.filename2, error.filename) if isinstance(name, str))
        path = next((names[each] for each in named if each in names), next(iter(files)))
        why = error.strerror or error
        raise OutputError(f"{path} could not be written: {why}. Name another file.") from None


Draw = Callable[[str], tuple[bytes, int]]
"""From the kind of a figure, png, svg or pdf, to the figure, and how many of what it shows it has no room for."""


def write_files(files: Mapping[Path, bytes], plot: Path | None, draw: Draw, what: str) -> None:
    """Write files and a figure of `what`, whole or none of them, and name each on stderr."""
    everything, left = dict(files), 0
    if plot is not None:
        everything[plot], left = draw(plot.suffix.lower().removeprefix("."))
    if everything:
        save_files(everything)
    for file in everything:
        say(f"wrote {file}" + (f"; {count(left, f'more {what}')} not drawn" if file == plot and left else ""), err=True)


def check_size(option: str, value: float, name: str = "") -> None:
    """Raise InputError unless a value lies within the limits of a column of Items (`name`, by default the option)."""
    from assess.workbook.schema import ITEMS

    column = ITEMS.column(name or option)
    low, high = column.low or 0.0, column.high or float("inf")
    unit = f" {column.unit}" if column.unit else ""
    if not low <= value <= high:
        raise InputError(f"--{option} is {value:g}{unit}, expected {low:g} to {high:g}{unit}")


MOST_LEVELS = 50
_NUMBER = r"(\d{1,4}(?:\.\d{0,12})?|\.\d{1,12})"
_SPAN = re.compile(rf"{_NUMBER}:{_NUMBER}(?::{_NUMBER})?", re.ASCII)


def read_formats(text: str, known: Collection[str]) -> list[str]:
    """Return the formats that --formats names, in small letters; raises InputError for one that is not known."""
    wanted = [name.strip().lower() for name in text.split(",") if name.strip()]
    unknown = [name for name in wanted if name not in known]
    if unknown or not wanted:
        named = f"{unknown[0]!r} is an unknown format" if unknown else "no format is named"
        raise InputError(f"--formats: {named}; expected some of: {', '.join(known)}.")
    return wanted


@dataclass(frozen=True, slots=True)
class Span:
    """How levels are typed: their option, their unit, the default step, the largest level, and examples."""

    option: str
    unit: str
    step: str
    most: int
    examples: str

    def read(self, text: str) -> Sequence[float]:
        """Return the levels that ``LOW:HIGH`` or ``LOW:HIGH:STEP`` means: both ends, and every step between."""
        found = _SPAN.fullmatch(text.strip())
        if found is None:
            raise InputError(
                f"{self.option}: {text[:40]!r} is not LOW:HIGH or LOW:HIGH:STEP in {self.unit}, as {self.examples}."
            )
        low, high, step = (Decimal(part) for part in (found[1], found[2], found[3] or self.step))
        if not 0 < low <= high <= self.most:
            raise InputError(
                f"{self.option} is {low} to {high} {self.unit}, expected above 0, LOW first, and at most {self.most} "
                f"{self.unit}."
            )
        if step == 0:
            raise InputError(f"{self.option}: the step is 0 {self.unit}, expected above 0.")
        steps = int((high - low) / step)
        values = [low + step * at for at in range(min(steps, MOST_LEVELS) + 1)]
        values += [high] if values[-1] < high else []
        if len(values) > MOST_LEVELS:
            raise InputError(f"{self.option}: {text.strip()} gives over {MOST_LEVELS} values. Take a larger step.")
        return [float(one) for one in values]
