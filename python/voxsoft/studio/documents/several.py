"""Designs of several bodies: made of a design of one, and given further ones."""

from __future__ import annotations

import copy
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from voxsoft.design import Design, families
from voxsoft.design.contact import BODY
from voxsoft.design.document.formula import is_formula
from voxsoft.design.document.included import inner_design, is_outside
from voxsoft.errors import DesignError, FileError, VoxSoftError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import read_document, read_text
from voxsoft.files.toml_edits import with_value
from voxsoft.files.toml_text import write_toml
from voxsoft.shapes.sampling import corners_of
from voxsoft.studio.documents.copies import Change, free_name, names_of, point
from voxsoft.studio.documents.document import DesignDocument
from voxsoft.studio.protocol import events

#: Files of a folder that are looked at.
_MOST_FILES: Final = 500
#: Entries of a design that concern all bodies, and not one.
_OF_ALL: Final = ("floor", "objects", "contact", "objectives", "constraints", "solver")
#: Keys of entries that name a chamber or a probe.
_NAMES: Final = ("cavity", "probe")


def design_files(document: DesignDocument) -> events.DesignFiles:
    """List the design files beside a document, without its own."""
    found = []
    for path in sorted(document.folder.glob("*.toml"))[:_MOST_FILES]:
        if path == document.path:
            continue
        try:
            read = read_document(read_text(path), path.name)
        except VoxSoftError:
            continue
        if "voxel_size" in read and ("parts" in read or "bodies" in read):
            title = str(read.get("name", path.stem))
            parameters = dict(_parameters(read.get("parameters")))
            found.append(events.DesignFile(file=path.name, title=title, parameters=parameters))
    return events.DesignFiles(folder=str(document.folder), files=found)


def _parameters(tables: object) -> Iterator[tuple[str, str]]:
    """The parameters of a document that are no formulas of others, and their values as text."""
    for name, table in tables.items() if isinstance(tables, Mapping) else ():
        if not _is_derived(table):
            yield name, str(table.get("value", "") if isinstance(table, Mapping) else table)


def changed_text(text: str, changes: Collection[Change]) -> str:
    """Make changes of a text one after the other.

    Raises
    ------
    DesignError
        A change leads nowhere.
    """
    for path, value in changes:
        text = with_value(text, path, value)
    return text


def several_of(document: DesignDocument) -> tuple[DesignDocument, str]:
    """Make a new document whose one body is the design of a document; and the name of that body.

    Entries that concern all bodies move along: floor, gravity, objects, contact, goals, the solver.
    Parameters stay in step with those of the design.

    Raises
    ------
    DesignError
        The document is not saved in a file, which bodies could name.
    """
    source, design = document.source, document.design
    if source is None or design is None or not document.valid:
        raise DesignError("design", "is not valid", "fix the underlined errors")
    if document.path is None or document.dirty:
        what = "is not saved, and its bodies name its file"
        raise DesignError("design", what, "save it first (Ctrl+S), then try again")
    name = _body_name(document.path.stem, [BODY, *names_of(design)])
    parameters = source.get("parameters", {})
    own = {key: f"= {key}" for key, value in parameters.items() if not _is_derived(value)}
    body: dict[str, Any] = {"name": name, "design": document.path.name}
    outer: dict[str, Any] = {
        "schema": "voxsoft/1",
        "name": f"several of {design.name}",
        "voxel_size": source["voxel_size"],
    }
    if own:
        outer["parameters"] = copy.deepcopy(parameters)
        body["set"] = own
    objects = source.get("objects") or []
    shapes = _used_shapes(objects, source.get("shapes") or {})
    if shapes:
        outer["shapes"] = shapes
    outer["bodies"] = [body]
    everywhere = [load for load in source.get("loads") or [] if load.get("kind") == "gravity"]
    if everywhere:
        outer["loads"] = copy.deepcopy(everywhere)
    outer |= {key: _of_body(source[key], name) for key in _OF_ALL if key in source}
    file = free_file(document.folder, f"{document.path.stem}-several", ())
    made = DesignDocument(write_toml(outer), file.name, folder=document.folder)
    if not made.valid:
        first = made.diagnostics[0]
        raise DesignError(first.where, first.what, first.hint)
    return made, name


def _is_derived(parameter: object) -> bool:
    value = parameter.get("value") if isinstance(parameter, Mapping) else parameter
    return is_formula(value)


def _used_shapes(value: Any, shapes: Mapping[str, Any]) -> dict[str, Any]:  # noqa: ANN401
    """The shapes that something is made of, by name, as they are written."""
    found: dict[str, Any] = {}
    waiting = [value]
    while waiting:
        each = waiting.pop()
        if isinstance(each, str) and each in shapes and each not in found:
            found[each] = copy.deepcopy(shapes[each])
            waiting.append(shapes[each])
        elif isinstance(each, Mapping):
            waiting += each.values()
        elif isinstance(each, list):
            waiting += each
    return {name: found[name] for name in shapes if name in found}


def _of_body(value: Any, name: str, key: str = "") -> Any:  # noqa: ANN401
    """Entries of a design of one body as those of a design in which it has a name."""
    if isinstance(value, list):
        return [_of_body(each, name, key) for each in value]
    if isinstance(value, Mapping):
        return {inner: _of_body(each, name, inner) for inner, each in value.items()}
    if value == BODY and key in ("of", "object"):
        return name
    if key in _NAMES and value not in ("all", None):
        return f"{name}.{value}"
    return copy.deepcopy(value)


def added(document: DesignDocument, file: str, beyond: float) -> tuple[list[Change], str]:
    """Add a body whose design is a file beside a document of several bodies; and its name.

    Parameters
    ----------
    document
        A good document.
    file
        The path of the design's file, from the folder of the document.
    beyond
        Position along x at which the body begins [m].

    Raises
    ------
    DesignError
        The file cannot be read as a design, or is that of the document.
    """
    if is_outside(file, document.folder):
        what = f'"{file}" is outside of the folder of the design'
        raise DesignError("design", what, "copy the file beside the design first")
    path = (document.folder / file).absolute()
    if document.path is not None and path == document.path:
        raise DesignError("design", f"{file} would include itself", "choose another file")
    inner = inner_design(str(path))
    low = _lowest(inner)
    name = _body_name(path.stem, names_of(document.design))
    body: dict[str, Any] = {"name": name, "design": file}
    # Voxels begin at a multiple of their size.
    size = inner.voxel_size
    at = float(np.ceil((beyond - low) / size - 1e-9)) * size
    if at:
        body["position"] = point((at, 0.0, 0.0))
    there = len((document.source or {}).get("bodies") or [])
    return [(["bodies", there], body)], name


def file_of_template(name: str, folder: Path) -> Path:
    """Write a template as a file of a folder, unless it is there already; returns the file.

    Raises
    ------
    VoxSoftError
        There is no such template, or the file cannot be written.
    """
    return _written(families.family_text(name), name, folder)


def file_of_document(document: DesignDocument, folder: Path) -> Path:
    """Write a document that was uploaded as a file of a folder, unless it is there already."""
    return _written(document.text, Path(document.name).stem, folder)


def _written(text: str, stem: str, folder: Path) -> Path:
    file = free_file(folder, stem, (text,))
    if not file.exists():
        write_atomically(file, text)
    return file


def free_file(folder: Path, stem: str, texts: Collection[str]) -> Path:
    """A design file of a folder that is not there yet, or holds one of some texts already.

    Raises
    ------
    FileError
        There are too many of that name.
    """
    for number in range(1, 1_000):
        file = folder / (f"{stem}.toml" if number == 1 else f"{stem}-{number}.toml")
        if not file.exists():
            return file
        if texts and file.is_file() and read_text(file) in texts:
            return file
    raise FileError(str(folder), f"has too many files called {stem}")


def _body_name(stem: str, taken: Collection[str]) -> str:
    """A name for a body of a file: dots part the names of bodies from those of probes."""
    return free_name(stem.replace(".", "-") or "left", taken)


def _lowest(design: Design) -> float:
    """Position along x at which a design begins [m]."""
    whole = design.assembled
    corners: list[float] = []
    for name in whole.body_names:
        alone = whole.alone(name)
        pose = next((body.pose for body in whole.bodies if body.name == name), None)
        for low, high in _boxes(alone):
            ends = np.array([low, high])
            ways = [ends[[i, j, k], [0, 1, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
            placed = ways if pose is None else [pose[0] @ each + pose[1] for each in ways]
            corners += [float(each[0]) for each in placed]
    return min(corners)


def _boxes(design: Design) -> Iterator[tuple[list[float], list[float]]]:
    if design.mesh is not None:
        vertices = design.mesh.read().mesh.vertices
        yield vertices.min(axis=0).tolist(), vertices.max(axis=0).tolist()
        return
    for part in design.parts:
        shape = design.shapes[part.shape] if isinstance(part.shape, str) else part.shape
        yield corners_of(shape, None, design.shapes)
