"""The results of a run brought back to the building model that its workbook was imported from."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from assess.bim.export_camera import Pair
from assess.bim.export_model import PROPERTY_SET, ModelPart, read_elements
from assess.bim.export_properties import add_properties
from assess.bim.export_results import ExportPiece, ExportRun, list_items
from assess.bim.export_topics import Topics, list_entries, write_topics
from assess.bim.ifc_file import check_installed, check_model, unreadable
from assess.bim.model_process import run_apart
from assess.errors import ModelError
from assess.i18n import fill
from assess.progress import Progress
from assess.resources import open_input


@dataclass(frozen=True, slots=True)
class Export:
    """The model with a property set on each of `written` pieces, and what to fix as topics; None if not asked for.

    For some pieces, here by their names, nothing is written: those without a Source ID, those `missing` in the model,
    and those that are something else there, by its class (`refused`). Of those that share a Source ID (`repeated`) the
    worse is written.
    """

    model: bytes | None
    topics: Topics | None
    written: int
    without_id: tuple[str, ...]
    missing: tuple[str, ...]
    refused: Mapping[str, tuple[str, ...]]
    repeated: tuple[str, ...]

    @property
    def is_complete(self) -> bool:
        """Whether every piece was found, and has an element of its own."""
        return not (self.without_id or self.missing or self.refused or self.repeated)


def build_export(
    found: ExportRun, model: Path, progress: Progress, *, with_properties: bool, with_topics: bool
) -> Export:
    """Bring results back to a building model: as property sets in a copy of it, as topics, or both.

    Raises ModelError if the model cannot be read, ifcopenshell is not installed, no piece is in the model, or a piece
    has such a property set already.
    """
    check_installed()
    check_model(model, model.name)
    sharing: dict[str, list[ExportPiece]] = {}
    for one in found.pieces:
        if one.source_id:
            sharing.setdefault(one.source_id, []).append(one)
    placed = None
    if with_topics:
        keys = {one.item: one.source_id for one in found.pieces if one.source_id}
        placed = [keys[item] for entry in list_entries(found, keys) for item in list_items(entry) if item in keys]
    part = run_apart(model.name, progress, read_elements, model.resolve(), model.name, list(sharing), placed)
    elements = {one.key: one for one in part.elements}
    pairs = [(one, elements[one.source_id]) for one in found.pieces if one.source_id in elements]
    worst = [
        (max(own, key=lambda one: (one.upper, one.chance.probability)), elements[key])
        for key, own in sharing.items()
        if key in elements
    ]
    _check_pairs(found, model, part, worst, with_properties=with_properties)
    changed = None
    if with_properties:
        try:
            with open_input(model) as file:
                changed = add_properties(file.read(), model.name, part, found, worst)
        except OSError as error:
            raise unreadable(model.name, error) from None

    def list_names(keys: Iterable[str]) -> tuple[str, ...]:
        return tuple(one.item for key in keys for one in sharing[key])

    refused: dict[str, list[str]] = {}
    for key, name in part.refused.items():
        refused.setdefault(name, []).append(key)
    return Export(
        model=changed,
        topics=write_topics(model.name, part, found, pairs) if with_topics else None,
        written=len(worst),
        without_id=tuple(one.item for one in found.pieces if not one.source_id),
        missing=list_names(key for key in sharing if key not in elements and key not in part.refused),
        refused={name: list_names(own) for name, own in refused.items()},
        repeated=list_names(key for key, own in sharing.items() if key in elements and len(own) > 1),
    )


def _check_pairs(
    found: ExportRun, model: Path, part: ModelPart, pairs: Sequence[Pair], *, with_properties: bool
) -> None:
    if not pairs and part.refused:
        key, name = next(iter(part.refused.items()))
        raise ModelError(
            fill("None of the Source IDs in {results} is that of furniture in {model}: {id} is an {name}. Fill in "
                 "Source ID in Items with the GlobalIds of furniture.",
                 results=found.run.path, model=model.name, id=key, name=name)
        )  # fmt: skip
    if not pairs:
        raise ModelError(
            fill("None of the Source IDs in {results} is that of an element of {model}. Name the model that the "
                 "workbook was imported from.", results=found.run.path, model=model.name)
        )  # fmt: skip
    done = [element.name or element.key for _, element in pairs if element.has_set]
    if done and with_properties:
        raise ModelError(
            fill("{model} holds {set} already, on {n:,} of the pieces (the first is {name}): it was exported before. "
                 "Name the model without it, as it was before that export.",
                 model=model.name, set=PROPERTY_SET, n=len(done), name=done[0])
        )  # fmt: skip
