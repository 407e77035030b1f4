"""Pictures that the workbook names: the logo, plans of floors, photos of pieces.

Only files inside one folder are touched, by the rules of `assess.workbook.records`.
"""

from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from assess.errors import Problem
from assess.i18n import Text, fill, join, nfill
from assess.model import FloorPlan
from assess.pictures import PictureError, check_picture, count_pixels, prepare_photo
from assess.plans import MOST_FILE, Drawing, count_side, is_picture, read_plan
from assess.progress import Progress
from assess.resources import open_input, read_input
from assess.workbook.habits import CellError, shorten
from assess.workbook.kept_files import Allowance, KeptFiles, find_key
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.records import find_file

PLACED = ("plan_left", "plan_bottom", "plan_width")
"""What a plan is placed by."""
FAR_LARGER = 8.0
"""A plan wider and higher than the pieces on it by this factor is likely in another unit."""
LEAST_SPREAD = 2.0
"""Spread of pieces [m] below which nothing follows from it."""
MOST_NAMED = 3
"""Pieces that a warning names."""
Made = TypeVar("Made")


class PictureReader:
    """Reads the pictures that a workbook names, each once, and checks them as the functions of `check` do.

    `folder` is where they are, None where the workbook was read without one. What is found: the `logo`, the `plans`
    that are drawn by the row of their floor, and `photos` as small JPEGs by the text of their cell.
    """

    def __init__(self, folder: Path | None, progress: Progress, kept: KeptFiles | None = None) -> None:
        self.folder, self.progress, self.kept = folder, progress, kept or KeptFiles()
        self.logo: Path | None = None
        self.plans: dict[int, FloorPlan] = {}
        self.photos: dict[str, bytes] = {}
        self._plans: dict[str | tuple[str, float | None], tuple[Path, Drawing] | CellError] = {}
        self._useless: dict[str, CellError] = {}
        self._allowance = Allowance()

    def check_logo(self, tables: Tables) -> Iterator[Problem]:
        """Find the logo, or report what is wrong with it."""

        def prepare(data: bytes) -> None:
            self._allowance.take(pixels=count_pixels(data))
            check_picture(data)

        table = tables["Building"]
        for row in table.with_all("logo"):
            try:
                self.logo, _data = self._read(row.get("logo"), prepare, "logo")
            except CellError as error:
                yield table.problem("logo", row, _left_out(error.message), error.fix, "warning")

    def check_photos(self, tables: Tables) -> Iterator[Problem]:
        """Read the photos of the pieces, or report what is wrong with them."""

        def prepare(data: bytes) -> bytes:
            self._allowance.take(photos=1)
            photo = prepare_photo(data)
            self._allowance.take(photo_bytes=len(photo))
            return photo

        table = tables["Items"]
        for row in table.with_all("photo"):
            text = row.get("photo")
            if text not in self.photos and text not in self._useless:
                self.progress.check()
                try:
                    _path, self.photos[text] = self._read(text, prepare, "photo")
                except CellError as error:
                    self._useless[text] = error
            if useless := self._useless.get(text):
                yield table.habit("photo", row, _left_out(useless.message), useless.fix, "warning")

    def check_plans(self, tables: Tables) -> Iterator[Problem]:
        """Read the plans of the floors, or report what is wrong with them, their numbers or where they lie."""
        table = tables["Floors"]
        for row in table.with_all("floor"):
            if table.lacks(row, "plan"):
                given = next((name for name in (*PLACED, "plan_turn") if row.get(name) is not None), None)
                if given:
                    values = {"label": table.label(given), "other": table.label("plan")}
                    message = fill("{label} is filled in without {other}.", **values)
                    yield table.problem(given, row, message, fill("Name the file of the plan, or clear it."), "warning")
                continue
            if row.get("plan") is None:
                continue
            self.progress.check()
            found = self._draw(row.get("plan"), row.get("plan_width"))
            if isinstance(found, CellError):
                yield table.problem("plan", row, found.message, found.fix)
                continue
            path, drawing = found
            if drawing.left_out:
                what = join(", ", drawing.left_out)
                message = fill("of the plan the lines alone are drawn; left out: {what}.", what=what)
                yield table.problem("plan", row, message, severity="note")
            if any(table.spoilt(name, row) for name in (*PLACED, "plan_turn")):
                continue
            left, bottom, width = row.get("plan_left"), row.get("plan_bottom"), row.get("plan_width") or drawing.width
            if left is not None and bottom is not None and width is not None:
                plan = self.plans[row.number] = FloorPlan(
                    path=path, content=drawing.content, is_lines=drawing.is_lines, left=left, bottom=bottom,
                    width=width, height=width * drawing.aspect, turn_deg=row.get("plan_turn") or 0.0,
                )  # fmt: skip
                yield from _check_place(table, row, plan, tables["Items"], tables["Places"])
                continue
            needed = PLACED if drawing.width is None else PLACED[:-1]
            blank = [fill(table.label(name)) for name in needed if row.get(name) is None]
            message = nfill("the plan is not drawn: {labels} is blank.", "the plan is not drawn: {labels} are blank.",
                            len(blank), labels=join(", ", blank))  # fmt: skip
            fix = fill("Fill in X and Y of its lower left corner, and its width in the building.")
            yield table.problem("plan", row, message, fix, "warning")

    def find_drawing(self, text: str, width: float | None) -> Drawing | None:
        """Return what is drawn of a plan, wherever it lies; None where its file cannot be used."""
        found = self._draw(text, width)
        return None if isinstance(found, CellError) else found[1]

    def _draw(self, text: str, width: float | None) -> tuple[Path, Drawing] | CellError:
        found = self._plans.get(text) or self._plans.get((text, width))
        if found is None:

            def prepare(data: bytes) -> Drawing:
                if is_picture(data):
                    self._allowance.take(pixels=count_pixels(data))
                else:
                    self._allowance.take(drawings=1, drawing_bytes=len(data))
                return read_plan(data, width)

            try:
                found = self._read(text, prepare, "plan", count_side(width))
            except CellError as error:
                found = error
            is_scaled = not isinstance(found, CellError) and not found[1].is_lines
            self._plans[(text, width) if is_scaled else text] = found
        return found

    def _read(self, text: str, prepare: Callable[[bytes], Made], purpose: str, side: int = 0) -> tuple[Path, Made]:
        """Return where a picture is, and what `prepare` makes of its bytes (`side`: of pixels only); or CellError."""
        name = shorten(text)
        if self.folder is None:
            message = fill("the picture {name} cannot be used: the workbook was read without a folder.", name=name)
            raise CellError(message, fill("Pass the folder in `records`."))
        path = find_file(text, self.folder)
        if side:  # which counts for pictures only
            with suppress(OSError), open_input(path) as file:
                side = side if is_picture(file.read(16)) else 0

        def make() -> Made | PictureError:
            try:
                data = read_input(path, MOST_FILE)
            except OSError as error:
                message = fill("the file {name} cannot be opened: {why}.", name=name, why=error.strerror)
                raise CellError(message, fill("Check its access rights.")) from None
            try:
                return prepare(data)
            except PictureError as error:
                return error

        found: Made | PictureError = self.kept.take(find_key(path, purpose, side), self._allowance, make)
        if isinstance(found, PictureError):
            message = fill("the picture {name} cannot be used: {why}.", name=name, why=found.message)
            raise CellError(message)
        return path, found


def _left_out(message: Text) -> Text:
    """Return a message with what follows: a picture is no reason to do without a report."""
    return fill("{message} It is left out.", message=message)


def _check_place(table: Table, row: Row, plan: FloorPlan, items: Table, places: Table) -> Iterator[Problem]:
    own = [one for one in items.with_all("floor", "x", "y") if one.get("floor") == row.get("floor")]
    if not own:
        return
    outside = [one for one in own if not plan.holds((one.get("x"), one.get("y")))]
    if outside:
        names = [shorten(one.get("item") or "?") for one in outside[:MOST_NAMED]]
        message = nfill("{n:,} piece of {all:,} lies outside the plan: {names}.",
                        "{n:,} pieces of {all:,} lie outside the plan: {names}.", len(outside), all=len(own),
                        names=", ".join(names) + (", ..." if len(outside) > MOST_NAMED else ""))  # fmt: skip
        fix = fill("Check Plan left X, Plan bottom Y, Plan width and Plan turn, and the positions of these pieces.")
        yield table.problem("plan", row, message, fix, "warning")
        return
    placed = [*own, *(one for one in places.with_all("floor", "x", "y") if one.get("floor") == row.get("floor"))]
    spread = max(max(one.get(side) for one in placed) - min(one.get(side) for one in placed) for side in ("x", "y"))
    if spread >= LEAST_SPREAD and min(plan.width, plan.height) > FAR_LARGER * spread:
        message = fill("the plan is {width:.4g} x {height:.4g} m, while the pieces on it lie within {spread:.3g} m.",
                       width=plan.width, height=plan.height, spread=spread)  # fmt: skip
        fix = fill("Check Plan width: it is that of the whole plan in the building, in the unit of its heading.")
        yield table.problem("plan_width", row, message, fix, "warning")
