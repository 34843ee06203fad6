"""MJCF, the scenes of MuJoCo: a flex of each part, loads and tendons as actuators, contact.

Each vertex is a body with a slide joint along each free axis and the mass that VoxSoft gives it; a
clamped one has no joint there. Units are those of SI. Where MJCF has no word for an entry of a
design, or one of another meaning, it is in the list of losses, which the file has as a comment.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final
from xml.etree import ElementTree

from voxsoft.errors import ErrorDetail
from voxsoft.files.atomic import write_atomically
from voxsoft.files.scenes.mjcf_bodies import add_flexes, add_layers, add_vertices
from voxsoft.files.scenes.mjcf_clamps import add_clamps
from voxsoft.files.scenes.mjcf_drives import add_loads, add_probes, add_springs, add_tendons
from voxsoft.files.scenes.mjcf_model import Model, numbers
from voxsoft.files.scenes.mjcf_objects import add_objects
from voxsoft.files.scenes.scene import COMMON, Scene, SceneSource

#: Time step where the design gives none [s].
TIME_STEP: Final = 0.005

_ACTIVATION: Final = "is not held: MuJoCo's flexes do not grow"
#: Features that MJCF holds, or whose losses the writer of their section tells.
HELD: Final = COMMON | {
    "pressure",
    "force",
    "traction",
    "magnetic field",
    "immersion",
    "load over time",
    "objects that turn",
    "bonds",
    "tendons",
    "springs and the like",
    "layers",
    "cut voxels",
}
#: Reason for each feature of a design that MJCF does not hold.
SENTENCES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "drag": "is not held: MuJoCo's flexes feel no fluid",
        "force field": "is not held: MuJoCo has no forces by formulas",
        "adhesion": "is not held: MuJoCo's contact does not stick",
        "supplies": "is not held: MuJoCo has no gas or liquid in a chamber",
        "fibers": "is not held: the material of a flex is the same in all directions",
        "activations": _ACTIVATION,
        "softening": "is not held: the material of a flex does not soften",
        "viscosity": "is not held: the damping of a flex is that of Rayleigh",
        "local refinement": "is written with small voxels everywhere that the mesh has them",
    }
)


def write(path: Path, source: SceneSource) -> list[ErrorDetail]:
    """Write a scene as MJCF.

    Parameters
    ----------
    path
        The file.
    source
        Source of the scene; its states are not written.

    Returns
    -------
    list of ErrorDetail
        Entries of the design that the file does not hold, or holds in another form.

    Raises
    ------
    OutputError
        The file cannot be written.
    """
    model = document_of(source.scene())
    ElementTree.indent(model.root)
    write_atomically(path, ElementTree.tostring(model.root, encoding="unicode") + "\n")
    return model.lost


def document_of(scene: Scene) -> Model:
    """Build the document of a scene.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> model = document_of(Scene.of(families.beam()))
    >>> [child.tag for child in model.root][1:4]
    ['compiler', 'option', 'worldbody']
    """
    model = Model(scene, lost=scene.lost(SENTENCES))
    model.root.set("model", scene.design.name)
    ElementTree.SubElement(model.root, "compiler", {"angle": "radian", "autolimits": "true"})
    step = scene.design.solver.time_step or TIME_STEP
    attributes = {"integrator": "discrete", "timestep": repr(step)}
    option = ElementTree.SubElement(model.root, "option", attributes)
    add_clamps(model)
    add_vertices(model)
    add_objects(model)
    add_flexes(model)
    add_layers(model)
    add_loads(model)
    add_tendons(model)
    add_springs(model)
    add_probes(model)
    option.set("gravity", numbers(scene.gravity))
    if model.controls:
        model.add("keyframe", "key", name="loads", ctrl=numbers(model.controls))
    model.root.insert(0, ElementTree.Comment(_comment(model)))
    return model


def _comment(model: Model) -> str:
    lines = [
        "Written by VoxSoft, in m, kg, s, N and Pa.",
        'The key "loads" sets the actuators to the loads of the design; without it they are zero.',
        *([] if not model.lost else ["Not held, or held in another form:"]),
        *(f"- {each}" for each in model.lost),
    ]
    # A comment must not hold two hyphens in a row.
    text = "\n  ".join(lines).replace("--", "- -")
    return f"\n  {text}\n"
