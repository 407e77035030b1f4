"""A building model as a file: what can be told of it before the library opens it, and the model that it opens.

The library takes a file that breaks off as if it were whole, with the elements up to there. So the end is looked for
first. STEP physical files: ISO 10303-21, of which a first line, a header and a last line are required.
"""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from assess.environment import say_install
from assess.errors import ModelError
from assess.i18n import Text, fill
from assess.resources import open_input

MOST_BYTES = 512 * 2**20
"""Size of a model that is read [bytes]."""
FIRST, LAST = b"ISO-10303-21;", b"END-ISO-10303-21;"
_LOOKED_AT = 65536
_SCHEMA = re.compile(rb"FILE_SCHEMA\s*\(\s*\(\s*'([^']{1,80})'", re.IGNORECASE)
SCHEMAS = ("IFC2X3", "IFC4", "IFC4X3")
"""Schemas that are read, with their corrections such as IFC4X3_ADD2."""
_NO_MODEL = fill("it does not begin as an IFC file (ISO-10303-21) does. Export the building as IFC (.ifc, STEP)")
_Found = TypeVar("_Found")


def is_model(start: bytes) -> bool:
    """Tell whether a file begins as a STEP physical file does."""
    return start.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(FIRST)


def check_model(path: Path, name: str) -> None:
    """Raise unless a file is a whole STEP file of a known schema, as far as can be told without reading all of it.

    Raises ModelError if it cannot be opened, is empty, too large, packed, XML, no model, cut off, or of another schema.
    """
    try:
        size = path.stat().st_size
        with open_input(path) as file:
            start = file.read(_LOOKED_AT)
            file.seek(max(0, size - _LOOKED_AT))
            end = file.read()
    except OSError as error:
        raise unreadable(name, error) from None
    if why := _find_fault(size, start, end):
        raise unreadable(name, why)


def unreadable(name: str, why: OSError | Text) -> ModelError:
    """Return the error of a file that cannot be read."""
    reason = why.strerror or str(why) if isinstance(why, OSError) else why
    return ModelError(fill("{name} cannot be read: {why}.", name=name, why=reason))


def _find_fault(size: int, start: bytes, end: bytes) -> Text | None:
    if size == 0:
        return fill("it is empty. Export the building again")
    if size > MOST_BYTES:
        return fill("it has {size:,.0f} MB, more than {most:,} MB. Export fewer storeys, or furniture, "
                    "spaces, doors and walls only", size=size / 2**20, most=MOST_BYTES >> 20)  # fmt: skip
    if start.startswith(b"PK\x03\x04"):
        return fill("it is packed as a zip file. Unpack it and import the .ifc file in it")
    if b"<ifcXML" in start or b"ifcXML" in start[:2048]:
        return fill("it is an ifcXML file. Export the building as IFC (.ifc, STEP)")
    if not is_model(start):
        return _NO_MODEL
    if LAST not in end:
        return fill("it is cut off: its last line, {last}, is missing. Copy or export it again", last=LAST.decode())
    found = _SCHEMA.search(start)
    schema = found[1].decode("ascii", "replace") if found else "-"
    return None if schema.upper().startswith(SCHEMAS) else _say_schema(schema)


def _say_schema(schema: str) -> Text:
    known = ", ".join(SCHEMAS)
    return fill("its schema is {schema}, expected one of: {known}. Export it as IFC4", schema=schema, known=known)


def check_installed() -> None:
    """Raise ModelError with the line that tells how to install the library, if it is not there."""
    from importlib.util import find_spec

    if find_spec("ifcopenshell") is None:
        raise ModelError(fill("Building models (IFC) need the library ifcopenshell. {how}", how=say_install("ifc")))


def read_with(path: Path, name: str, understand: Callable[[Any], _Found]) -> _Found:
    """Return what `understand` finds in the model of a file; call it in a process of its own.

    `understand` may raise errors of Python where an entity is of another kind than its schema asks for.
    Raises ModelError as `check_model`, or if the library or `understand` cannot make sense of the file.
    """
    import ifcopenshell

    check_model(path, name)
    try:
        model = ifcopenshell.open(str(path))
    except (ifcopenshell.Error, RuntimeError, ValueError, OSError) as error:
        if "unsupported schema" in str(error).lower():
            schema = str(error).strip().split()[-1]
            raise unreadable(name, _say_schema(schema)) from None
        raise _find_damage(name, error) from None
    if not isinstance(model, ifcopenshell.file):
        raise unreadable(name, _NO_MODEL)
    _set_clearances_aside(model)
    try:
        return understand(model)
    except (AssertionError, AttributeError, TypeError, ValueError, LookupError, RuntimeError) as error:
        raise _find_damage(name, error) from error


def _set_clearances_aside(model: Any) -> None:
    """Give representations called Clearance, the room that an element needs, a context of their own: they are no body.

    It is the identifier of a representation that names its use (IFC4, IfcShapeRepresentation); some programs put it
    into the context of bodies all the same.
    """
    contexts: dict[int, Any] = {}
    for one in model.by_type("IfcShapeRepresentation"):
        if (one.RepresentationIdentifier or "").strip().casefold() == "clearance":
            whole = getattr(one.ContextOfItems, "ParentContext", None) or one.ContextOfItems
            if whole.id() not in contexts:
                contexts[whole.id()] = model.create_entity(
                    "IfcGeometricRepresentationSubContext", ContextIdentifier="Clearance", ContextType="Model",
                    ParentContext=whole, TargetView="MODEL_VIEW",
                )  # fmt: skip
            one.ContextOfItems = contexts[whole.id()]


def _find_damage(name: str, error: Exception) -> ModelError:
    first = str(error).strip().split("\n")[0][:120].rstrip(".")
    return ModelError(fill("{name} is damaged: {why}. Export it again.", name=name, why=first or type(error).__name__))
