"""Documents from files, run folders, trials, and files dropped on the page."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Final

from voxsoft.design import Design, families, robots
from voxsoft.design.document.resolution import Document as PlainDocument
from voxsoft.errors import DesignError, FileError, VoxSoftError
from voxsoft.files.toml_edits import with_value
from voxsoft.jobs import load
from voxsoft.shapes.cad_files import HINT, WHAT, is_cad_file
from voxsoft.studio.documents.document import DesignDocument
from voxsoft.studio.documents.uploads import MESHES, design_of_mesh
from voxsoft.studio.protocol.commands import MeshImport
from voxsoft.studio.running.studying import design_text_of, stored_trial
from voxsoft.study.trial import Trial
from voxsoft.units import format_quantity

#: The name of the design that holds nothing yet.
EMPTY: Final = "empty"
_NOTHING: Final = """\
schema = "voxsoft/1"
name = "robot"
voxel_size = "5 mm"
"""


def template_document(name: str, home: Path) -> DesignDocument:
    """A shipped family of designs, as a new document that would be saved in the folder `home`.

    With the name ``"empty"`` it is a design that holds nothing yet.

    Raises
    ------
    VoxSoftError
        There is no such family.
    """
    if name == EMPTY:
        return DesignDocument(_NOTHING, "robot.toml", folder=home)
    return DesignDocument(families.family_text(name), f"{name}.toml", folder=home)


def robot_document(name: str, home: Path) -> DesignDocument:
    """A finished robot, as a new document that would be saved in the folder `home`.

    Raises
    ------
    VoxSoftError
        There is no such robot.
    """
    return DesignDocument(robots.robot_text(name), f"{name}.toml", folder=home)


def started_document(name: str, home: Path) -> DesignDocument:
    """The robot to which three answers lead, with its values, as a new document.

    Raises
    ------
    VoxSoftError
        No robot is made of these answers.
    """
    start = robots.start(name)
    text = robots.robot_text(start.robot)
    for parameter, value in start.parameters.items():
        text = with_value(text, ["parameters", parameter, "value"], value)
    return DesignDocument(text, f"{start.robot}.toml", folder=home)


def document_at(path: Path, home: Path) -> DesignDocument:
    """A design file, or the design of a run folder as a new document.

    Only a file with the name of a design file is read, as only such a file is ever saved: the page
    shows the text of an opened file, and is no way to look at other files.

    Raises
    ------
    FileError
        It is no design file, cannot be read, or the folder holds no design.
    """
    try:
        is_folder = path.is_dir()
    except OSError as error:
        raise FileError(str(path)[:80], f"cannot be read: {error.strerror}") from None
    if not is_folder and is_cad_file(path.name):
        raise FileError(str(path)[:200], WHAT, HINT)
    if not is_folder and path.suffix.lower() != ".toml":
        hint = 'name a file that ends in ".toml", or a run folder; drop meshes on the page'
        raise FileError(str(path)[:200], "is no design file", hint)
    if not is_folder:
        return DesignDocument.of_file(path)
    file, name = path / "design.toml", f"{path.name}.toml"
    with suppress(VoxSoftError):  # a folder that tells no job
        source = load(path, check=False).spec.design
        return DesignDocument(source.with_files({}, home).text, name, folder=home)
    if not file.is_file() and (path / "study.json").is_file():
        return DesignDocument(design_text_of(path), name, folder=home)
    if not file.is_file():
        raise FileError(str(path), "is no run folder: it holds no design.toml")
    opened = DesignDocument.of_file(file)
    opened.path, opened.saved, opened.name = None, None, name
    return opened


def uploaded_document(file: Path, home: Path, mesh: MeshImport | None = None) -> DesignDocument:
    """A file that was dropped on the page, as a new document; a mesh is read as it says.

    Raises
    ------
    VoxSoftError
        Its content does not match its name, or holds no shape.
    """
    if file.suffix == ".toml":
        opened = DesignDocument.of_file(file)
        opened.path, opened.saved, opened.folder = None, None, home
        return opened
    if file.suffix in MESHES:
        text = design_of_mesh(file, mesh)
    else:
        raise FileError(file.name, "holds measurements", "drop it on the page: a pane takes it")
    return DesignDocument(text, f"{file.stem}.toml", folder=home)


def trial_document(folder: Path, number: str, home: Path) -> tuple[DesignDocument, bool]:
    """The design of a study with the parameters of one trial, and whether that came to rest.

    Raises
    ------
    VoxSoftError
        There is no such trial, or the design of the study cannot be read.
    """
    trial = stored_trial(folder, number)
    document = document_at(folder, home)
    design = document.design
    if design is None:
        raise FileError(f"{folder.name}/{number}", "belongs to a design that cannot be read")
    text = with_parameters_of(trial, document.text, document.source or {}, design)
    name = f"{folder.name}-{number}.toml"
    return DesignDocument(text, name, folder=document.folder), trial.status == "ok"


def with_parameters_of(trial: Trial, text: str, source: PlainDocument, design: Design) -> str:
    """The text of a design with the parameters of a trial in place of its own.

    Parameters
    ----------
    trial
        The trial.
    text, source, design
        The design file, its text, and the design in it.

    Raises
    ------
    DesignError
        The design has no parameter of that name.
    """
    missing = [name for name in trial.parameters if name not in design.parameters]
    if missing:
        what = f"varies {', '.join(missing)}, which the open design does not have as a parameter"
        raise DesignError(f"design {trial.number}", what, "open it as a document of its own")
    for parameter, value in trial.parameters.items():
        kind = design.parameters[parameter].kind
        shown = format_quantity(value, kind) if isinstance(value, float) else value
        table = source.get("parameters", {}).get(parameter)
        inner = ["value"] if isinstance(table, dict) else []
        text = with_value(text, ["parameters", parameter, *inner], shown)
    return text
