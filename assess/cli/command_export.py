"""``assess export``: risk classes back into the building model, and what to fix as topics for it."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from assess.cli.console import say, say_written, show_progress
from assess.cli.options import check_file, check_new, force, is_same, save_files
from assess.errors import InputError
from assess.i18n import LANGUAGES, count, load_catalogue, speaking

if TYPE_CHECKING:
    from assess.bim.export_files import Export

ORDER = 4
EXAMPLES = (
    "assess export report/results.json --ifc building.ifc -o building-risk.ifc",
    "assess export report/results.json --ifc building.ifc --bcf to-fix.bcfzip",
    "assess export report --ifc building.ifc --out building-risk.ifc --bcf to-fix.bcfzip --force",
)
TOPICS = (".bcfzip", ".bcf")
MOST_NAMED = 50  # pieces that a line names; the rest are counted


def command(
    results: Annotated[
        Path,
        typer.Argument(
            metavar="RESULTS", help="A results.json of assess run, or its folder.", show_default=False
        ),
    ],
    ifc: Annotated[
        Path, typer.Option("--ifc", help="The model that the workbook was imported from (.ifc).", show_default=False)
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="The model to write: a copy with a property set on each piece.",
                     show_default=False),
    ] = None,
    bcf: Annotated[
        Path | None,
        typer.Option("--bcf", help="The topics to write: what to fix, in order (BCF 2.1: .bcfzip or .bcf).",
                     show_default=False),
    ] = None,
    replaces: Annotated[bool, force("existing files")] = False,
) -> None:  # fmt: skip
    """Bring the results back to the building model: risk classes as properties, what to fix as topics.

    Pieces are found by Source ID. Each gets a property set Assess_OverturningRisk; nothing else in the model changes. A
    topic is an entry of the schedule: it selects its pieces, and the door on a route that they may block, if one is
    found. Texts are in the language of the workbook. The exit status is 1 where a piece is not furniture in the model,
    or shares its Source ID.
    """
    wanted = {option: path for option, path in {"--out": out, "--bcf": bcf}.items() if path is not None}
    if not wanted:
        raise InputError("nothing is to be written: add --out MODEL.ifc, --bcf TOPICS.bcfzip or both.")
    if len(set(map(Path.resolve, wanted.values()))) < len(wanted):
        raise InputError("--out and --bcf name the same file: name two.")
    for option, path in wanted.items():
        endings = TOPICS if option == "--bcf" else (".ifc",)
        check_file(path, "topics" if option == "--bcf" else "model", endings)
        if any(is_same(path, source) for source in (ifc, results)):
            raise InputError(f"{option}: {path} is read for this: name another file, so that it stays as it is.")
        check_new(path, replaces=replaces)
    from assess.bim.export_files import build_export
    from assess.bim.export_results import read_export

    with show_progress() as progress, progress.stage("reading", ifc.name):
        found = progress.wait_for(lambda: read_export(results))
        with speaking(load_catalogue(found.language if found.language in LANGUAGES else LANGUAGES[0])):
            export = build_export(found, ifc, progress, with_properties=out is not None, with_topics=bcf is not None)
    files = {out: export.model, bcf: export.topics.data if export.topics else None}
    save_files({path: data for path, data in files.items() if path is not None and data is not None})
    for line in describe_export(export, ifc.name):
        say(line)
    say_written(filter(None, (out, bcf)))
    if not export.is_complete:
        raise typer.Exit(1)


def describe_export(export: "Export", model: str) -> Iterator[str]:
    """Yield what was written, and which pieces could not be."""
    from assess.report.words import name_first

    if export.model is not None:
        yield f"{model}: a property set Assess_OverturningRisk on {count(export.written, 'piece')}."
    if (topics := export.topics) is not None:
        doors = f", {topics.doors:,} of them with a door" if topics.doors else ""
        yield f"{count(topics.count, 'topic')}: what to fix, in the order of the schedule{doors}."
        if topics.beyond:
            yield f"Less urgent entries of the schedule that are no topics: {topics.beyond:,}."
        if topics.unplaced:
            yield (
                f"Entries of the schedule that are no topics, as none of their pieces is in {model}: "
                f"{topics.unplaced:,}."
            )
        if topics.count and not topics.is_placed:
            yield "No doors were sought: the positions of the workbook are not those of the model."
    groups = {
        "without a Source ID": export.without_id,
        f"with a Source ID that is not in {model}": export.missing,
        **{f"whose Source ID is an {name} in the model, not furniture": own for name, own in export.refused.items()},
    }
    for why, names in groups.items():
        if names:
            yield f"Not written, {count(len(names), 'piece')} {why}: {name_first(names, MOST_NAMED)}."
    if export.repeated:
        set_of = "" if export.model is None else "; the property set is that of the worse"
        first = name_first(export.repeated, MOST_NAMED)
        yield f"{count(len(export.repeated), 'piece')} that share a Source ID{set_of}: {first}."
