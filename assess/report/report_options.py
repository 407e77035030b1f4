"""How reports are written: their language, a firm's own templates, and whether the PDF is for screen readers."""

import difflib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from assess import resources
from assess.errors import InputError
from assess.i18n import LANGUAGES, fill, join, load_catalogue, speaking


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportOptions:
    """How reports are written.

    * `language`: code of the language of the reports, one of `assess.i18n.LANGUAGES`; "" takes the workbook's.
      results.json and items.csv, which programs read, are the same in every language.
    * `templates`: a folder whose files replace those of the same name among the templates: trusted code.
    * `accessible`: whether the PDF is PDF/UA-1, for screen readers, instead of PDF/A-3u, for archives.

    Raises InputError if the language is unknown, or the folder of templates does not exist or holds nothing that
    replaces a template.
    """

    language: str = ""
    templates: Path | None = None
    accessible: bool = False

    def __post_init__(self) -> None:
        if self.language and self.language not in LANGUAGES:
            known = ", ".join(LANGUAGES)
            raise InputError.about("language is {name!r}, expected one of {known}", name=self.language, known=known)
        folder = self.templates
        if folder is None:
            return
        if not folder.is_dir():
            raise InputError.about("templates: there is no folder {folder}", folder=folder)
        standard = {path.relative_to(resources.templates()).as_posix() for path in resources.templates().rglob("*.*")}
        own = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
        unknown = sorted(name for name in own - standard if not Path(name).name.startswith("."))
        former = [name for name in unknown if name.startswith("sections/") or name == "report.html.j2"]
        if former:
            raise InputError.about(
                "templates: {folder}: {name} is no longer a template. Choose and order the sections in page.html.j2, "
                "reword them in texts/en.po, and put your cover in cover.html.j2.", folder=folder, name=former[0],
            )  # fmt: skip
        if unknown:
            near = difflib.get_close_matches(unknown[0], standard, 1, 0.5)
            fault = fill("templates: {folder}: {name} replaces no standard template.", folder=folder, name=unknown[0])
            raise InputError(join(" ", (fault, *(fill("Did you mean {name}?", name=name) for name in near))))
        if not own & standard:
            names = ", ".join(sorted({name.split("/")[0] for name in standard}))
            raise InputError.about(
                "templates: {folder} holds no template: expected some of {names}, as in the standard templates",
                folder=folder, names=names,
            )  # fmt: skip

    @property
    def spoken_language(self) -> str:
        """The code of the language of the reports."""
        return self.language or LANGUAGES[0]

    @property
    def folders(self) -> tuple[Path, ...]:
        """Where a template is looked for, in this order."""
        return (*((self.templates,) if self.templates else ()), resources.templates())

    def read(self, name: str) -> str:
        """Return the text of a template or style file, the firm's own first."""
        found = next(folder / name for folder in self.folders if (folder / name).is_file())
        return found.read_text(encoding="utf-8")

    @contextmanager
    def spoken(self) -> Iterator[None]:
        """Have every text be in the language of the report."""
        with speaking(load_catalogue(self.spoken_language, self.templates)):
            yield
