"""Which floor, room, type or place of a workbook is which of a building model, although people may have renamed it.

What tells is where the pieces stand that both have. Names alone would mislead: whoever calls the floors 0 and 1 that
the model calls 1 and 2 has a floor 1 that is another.
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from assess.workbook.names import key

Levels = Mapping[str, float | None]
"""Elevations of floors [m] by their names as names are compared; None where it is not known."""

SAME_LEVEL = 0.05
"""Difference up to which two floors are at one elevation [m]."""
_NUMBER = re.compile(r"(?: \(\d+\))+$")


def match_floors(model: Levels, workbook: Levels, pairs: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Return the floor of the workbook that each floor of a model is; those of the model alone are left out.

    `model` and `workbook`: the floors, with their elevations [m].
    `pairs`: the floors, in the model and in the workbook, of every piece that both have.

    Notes
    -----
    A floor has kept its name where no floor of the workbook has more of its pieces than that of the same name. Else it
    is the one that has more than half of them, unless another has kept that name, or the elevations say that the
    pieces, not the names, have moved. Floors without pieces are found by their names and elevations.
    """
    counts: dict[str, Counter[str]] = {}
    for one, own in pairs:
        counts.setdefault(one, Counter())[own] += 1
    found = {one: one for one in workbook if one in counts and counts[one][one] == max(counts[one].values())}
    kept = set(found)
    for one in model:
        own = _find_majority(counts.get(one, Counter()))
        if one not in found and own in workbook and own not in kept and not _have_moved(one, own, model, workbook):
            found[one] = own
    for one in model:
        if one not in found and (alike := _find_alike(one, model, workbook, set(found.values()))) is not None:
            found[one] = alike
    return {one: own for one, own in found.items() if one in model}


def _find_majority(counter: Counter[str]) -> str:
    """Return what more than half agree on, "" where there is nothing such."""
    best, number = max(counter.items(), key=lambda one: one[1], default=("", 0))
    return best if 2 * number > counter.total() else ""


def _have_moved(one: str, own: str, model: Levels, workbook: Levels) -> bool:
    """Tell whether a floor of the same name is where the model has it, and the one that has its pieces is not."""
    level = model[one]
    return _is_level(level, workbook.get(one)) and not _is_level(level, workbook[own])


def _find_alike(one: str, model: Levels, workbook: Levels, taken: Collection[str]) -> str | None:
    """Return the floor that is most likely one of which no pieces tell, None for a new one."""
    level = model[one]
    near = [own for own in workbook if own not in taken and _is_level(level, workbook[own])]
    is_named = one in workbook
    if is_named and (one in near or workbook[one] is None or len(near) != 1):
        return one
    return near[0] if len(near) == 1 else None


def _is_level(one: float | None, other: float | None) -> bool:
    return one is not None and other is not None and abs(one - other) <= SAME_LEVEL


def match_rooms(trios: Iterable[tuple[str, str, str]], known: Collection[str]) -> dict[tuple[str, str], str]:
    """Return the names that people gave to rooms, by floor and room of the model as names are compared.

    `trios`: of every piece that both have: its floor as names are compared, its room in the model and in the workbook.
    `known`: all rooms of the model, as names are compared: a piece in another one of these was moved.

    Notes
    -----
    A room was renamed where more than half of its pieces are in one room that the model does not know, and none in a
    room of its own name.
    """
    counts: dict[tuple[str, str], Counter[str]] = {}
    spelt: dict[str, str] = {}
    for floor, room, own in trios:
        counts.setdefault((floor, key(room)), Counter())[key(own)] += 1
        spelt.setdefault(key(own), own)
    found = {}
    for (floor, room), counter in counts.items():
        own = _find_majority(counter)
        if own and own not in known and not counter[room]:
            found[floor, room] = spelt[own]
    return found


@dataclass(frozen=True, slots=True)
class Named:
    """A type or a place: its name, and what tells it from others of that name, such as its sizes or its position."""

    name: str
    content: tuple[Any, ...]

    @property
    def stem(self) -> str:
        """The name as names are compared, without the number by which an import tells it from others."""
        return _NUMBER.sub("", key(self.name))


def match_alike(
    model: Sequence[Named], own: Sequence[Named], is_same: Callable[[Any, Any], bool], *, by_content: bool = False
) -> dict[int, int]:
    """Return which of `own` each of `model` is, by their places in the sequences.

    The number in "Desk (2)" follows the order of the model, which may have changed: what has the same name but for the
    number, and the same content, is the same; then what has the same name; and `by_content` what has the same content,
    although people have renamed it.
    """
    stems: dict[str, list[int]] = {}
    for at, one in enumerate(own):
        stems.setdefault(one.stem, []).append(at)

    def is_namesake(one: Named, other: Named) -> bool:
        return key(one.name) == key(other.name)

    def is_alike(one: Named, other: Named) -> bool:
        return is_same(one.content, other.content)

    def is_equal(one: Named, other: Named) -> bool:
        return is_namesake(one, other) and is_alike(one, other)

    found: dict[int, int] = {}
    steps = [(is_equal, stems), (is_alike, stems), (is_namesake, stems), *[(is_alike, None)] * by_content]
    for fits, near in steps:
        taken = set(found.values())
        for at in (at for at in range(len(model)) if at not in found):
            among = range(len(own)) if near is None else near.get(model[at].stem, ())
            best = next((it for it in among if it not in taken and fits(model[at], own[it])), None)
            if best is not None:
                found[at] = best
                taken.add(best)
    return found
