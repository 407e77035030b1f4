"""Studies run one by one, and their files, each written whole."""

import csv
import io
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from assess.errors import OutputError
from assess.studies._parts import write_through
from assess.studies._study import Finding, Options, Study, Table
from assess.studies._write import build_own_page


def run_all(studies: Sequence[Study], options: Options) -> dict[str, Finding]:
    """Run studies one by one; each is told."""
    found = {}
    for study in studies:
        own = replace(options, tell=lambda what, name=study.name: options.tell(f"{name}: {what}"))  # type: ignore[misc]
        options.tell(f"{study.name}: {study.title}")
        found[study.name] = run_study(study, own)
    return found


def run_study(study: Study, options: Options) -> Finding:
    """Run a study and write its tables, figures and files into the folder `options.out`; its page comes last."""
    finding = study.run(options)
    texts = {f"{name}.csv": _to_csv(table) for name, table in finding.tables.items()} | dict(finding.files)
    data = {name: text.encode("utf-8") for name, text in texts.items()} | dict(finding.figures)
    page = build_own_page(study, finding)
    write_files(options.out, data | {f"{study.name}.md": page.encode("utf-8")})
    return finding


def _to_csv(table: Table) -> str:
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(table.columns)
    writer.writerows(table.rows)
    return file.getvalue()


def check_folder(folder: Path) -> None:
    """Find out, before the long work, that a folder can be written to; it need not be there yet, and nothing is left.

    Raises
    ------
    OutputError
        If it cannot.
    """
    try:
        there = next(one for one in (folder, *folder.absolute().parents) if one.exists())
        with tempfile.TemporaryDirectory(prefix=".assess-writing-", dir=there):
            pass
    except OSError as error:
        raise OutputError(_explain(folder, error)) from None


def write_files(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write files into a folder, which is made; a name may lie in a folder within.

    All are written beside their places before the first is moved there: each appears whole, and if one cannot be
    written, none does.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".assess-writing-", dir=folder) as stage:
            for name, data in files.items():
                write_through(Path(stage) / name, lambda stream, data=data: stream.write(data))  # type: ignore[misc]
            taken = next((name for name in files if (folder / name).is_dir()), None)
            if taken is not None:
                raise OutputError(f"{folder / taken} could not be written: it is a folder. Move it away.")
            for name in files:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (Path(stage) / name).replace(folder / name)
    except OSError as error:
        raise OutputError(_explain(folder, error)) from None


def _explain(folder: Path, error: OSError) -> str:
    return f"{folder} could not be written: {error.strerror or error}. Name another folder with --out."
