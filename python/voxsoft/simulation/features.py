"""Features of a design: entries that not every use takes, each with the function that finds it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import Final

from voxsoft.design import Contact, Design, Dielectric, Object
from voxsoft.design.attachment import attachments_of
from voxsoft.design.discretization.cut_cells import cuts_cells
from voxsoft.errors import VoxSoftError
from voxsoft.materials import Hyperelastic, Lattice, Material, Rigid
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.setup.fluids import has_supplies

#: Function that finds the entries of a design that are a feature, by their places.
_Places = Callable[[Design], Iterator[str]]


def _entries(name: str) -> _Places:
    """Return the places of all entries under a key of a design."""

    def places(design: Design) -> Iterator[str]:
        found = getattr(design, name)
        if isinstance(found, tuple):
            yield from (f"{name}[{index}]" for index in range(len(found)))
        elif found:
            yield name

    return places


def _key(name: str) -> _Places:
    """Return the place of a key of a design, once for all its entries."""

    def places(design: Design) -> Iterator[str]:
        if getattr(design, name):
            yield name

    return places


def _contact(design: Design) -> Iterator[str]:
    if has_contact(design):
        bodies = "objects" if design.objects else "bodies"
        yield "contact" if design.contact is not None else bodies


def _objects(is_such: Callable[[Object], bool]) -> _Places:
    def places(design: Design) -> Iterator[str]:
        for index, each in enumerate(design.objects):
            if is_such(each):
                yield f"objects[{index}].motion"

    return places


def _bonds(design: Design) -> Iterator[str]:
    for index, pair in enumerate(() if design.contact is None else design.contact.pairs):
        if pair.kind == "bonded":
            yield f"contact.pairs[{index}]"


def _adhesions(design: Design) -> Iterator[str]:
    if design.contact is None:
        return
    if design.contact.adhesion is not None:
        yield "contact.adhesion"
    for index, pair in enumerate(design.contact.pairs):
        if pair.adhesion is not None:
            yield f"contact.pairs[{index}].adhesion"


def _supplies(design: Design) -> Iterator[str]:
    if has_supplies(design):
        yield "supplies" if design.supplies else "connections"


def _attachments(design: Design) -> Iterator[str]:
    yield from (where for where, _ in attachments_of(design))


def _materials(is_such: Callable[[Material], bool], entry: str = "") -> _Places:
    def places(design: Design) -> Iterator[str]:
        for index, part in enumerate(design.parts):
            if is_such(design.material_of(part)):
                yield f"parts[{index}].material{entry}"

    return places


def _fibers(design: Design) -> Iterator[str]:
    yield from (f"parts[{index}].fibers" for index, part in enumerate(design.parts) if part.fibers)


def _sealing_layers(design: Design) -> Iterator[str]:
    for index, layer in enumerate(design.layers):
        if layer.seal:
            yield f"layers[{index}].seal"


def _wound(design: Design) -> Iterator[str]:
    for index, part in enumerate(design.parts):
        if any(fiber.is_wound for fiber in part.fibers):
            yield f"parts[{index}].fibers"


def _growth_over_time(design: Design) -> Iterator[str]:
    for index, activation in enumerate(design.activations):
        if activation.history is not None and activation.growth is not None:
            yield f"activations[{index}].history"


def _profiles(design: Design) -> Iterator[str]:
    for index, activation in enumerate(design.activations):
        if activation.growth is not None and activation.growth.profile is not None:
            yield f"activations[{index}].profile"


def _dielectrics(design: Design) -> Iterator[str]:
    for index, activation in enumerate(design.activations):
        if isinstance(activation, Dielectric):
            yield f"activations[{index}]"


def _dielectrics_over_time(design: Design) -> Iterator[str]:
    for index, activation in enumerate(design.activations):
        if isinstance(activation, Dielectric) and activation.history is not None:
            yield f"activations[{index}].history"


def _is_cut(design: Design) -> bool:
    """Return True if the surface cuts voxels of a design, of any of its bodies."""
    if not design.has_cut_voxels:
        return False
    if design.bodies:
        return any(_is_cut(design.alone(body.name)) for body in design.bodies)
    try:
        return cuts_cells(design, design.voxel_size)
    except VoxSoftError:
        return True  # a body without voxels is reported where it is meshed


def _fraction(design: Design) -> Iterator[str]:
    if _is_cut(design):
        yield "fill"


def _file_mesh(design: Design) -> Iterator[str]:
    if design.mesh is not None:
        yield "mesh"


def _loads(*kinds: str) -> _Places:
    def places(design: Design) -> Iterator[str]:
        for index, load in enumerate(design.loads):
            if load.kind in kinds:
                yield f"loads[{index}]"

    return places


def _load_histories(design: Design) -> Iterator[str]:
    for index, load in enumerate(design.loads):
        if load.history is not None:
            yield f"loads[{index}].history"


def _both(first: _Places, second: _Places) -> _Places:
    """Return the places of a feature in designs that have another as well."""

    def places(design: Design) -> Iterator[str]:
        if next(second(design), None) is not None:
            yield from first(design)

    return places


def _softens(material: Material) -> bool:
    return isinstance(material, Hyperelastic) and material.mullins is not None


def _relaxes(material: Material) -> bool:
    return isinstance(material, Hyperelastic) and bool(material.prony)


def _friction(design: Design) -> Iterator[str]:
    contact = design.contact or Contact()
    values = [contact.friction, *(pair.friction or 0.0 for pair in contact.pairs)]
    if has_contact(design) and any(value > 0.0 for value in values):
        yield "contact"


_softening: Final = _materials(_softens, ".mullins")
_lattices: Final = _materials(lambda each: isinstance(each, Lattice))

#: Every feature, with the function that finds it in a design whose bodies are assembled.
FEATURES: Final[Mapping[str, _Places]] = MappingProxyType(
    {
        "gravity": _loads("gravity"),
        "pressure": _loads("pressure"),
        "force": _loads("force"),
        "traction": _loads("traction"),
        "magnetic field": _loads("magnetic_field"),
        "immersion": _loads("immersion"),
        "drag": _loads("drag"),
        "force field": _loads("force_field"),
        "load over time": _load_histories,
        "floor": _key("floor"),
        "contact": _contact,
        "objects": _entries("objects"),
        "free objects": _objects(lambda each: each.is_free),
        "objects that turn": _objects(
            lambda each: each.way is not None and each.way.rotation is not None
        ),
        "bonds": _bonds,
        "adhesion": _adhesions,
        "several bodies": _key("bodies"),
        "tendons": _entries("tendons"),
        "springs and the like": _attachments,
        "supplies": _supplies,
        "layers": _key("layers"),
        "layers that seal": _sealing_layers,
        "fibers": _fibers,
        "wound fibers": _wound,
        "activations": _key("activations"),
        "activations over time": _growth_over_time,
        "activations with a profile": _profiles,
        "dielectrics": _dielectrics,
        "dielectrics over time": _dielectrics_over_time,
        "softening": _softening,
        "viscosity": _materials(_relaxes),
        "local refinement": _key("refine"),
        "planes of symmetry": _key("symmetry"),
        "cut voxels": _fraction,
        "rigid parts": _materials(lambda each: isinstance(each, Rigid)),
        "spring lattice": _lattices,
        "mesh of a file": _file_mesh,
        "spring lattice and contact": _both(_contact, _lattices),
        "profiles and contact": _both(_profiles, _contact),
        "symmetry and contact": _both(_key("symmetry"), _contact),
        "symmetry and friction": _both(_key("symmetry"), _friction),
        "fibers of several bodies": _both(_fibers, _key("bodies")),
        "activations of several bodies": _both(_key("activations"), _key("bodies")),
    }
)

#: Features that are always there with another one.
IMPLIED: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {
        "objects": ("contact",),
        "free objects": ("contact",),
        "objects that turn": ("contact",),
        "bonds": ("contact",),
        "adhesion": ("contact",),
        "several bodies": ("contact",),
        "layers that seal": ("layers",),
        "wound fibers": ("fibers",),
        "activations over time": ("activations",),
        "activations with a profile": ("activations",),
        "dielectrics": ("activations",),
        "dielectrics over time": ("activations", "dielectrics"),
        "spring lattice and contact": ("contact", "spring lattice"),
        "profiles and contact": ("contact", "activations", "activations with a profile"),
        "symmetry and contact": ("contact", "planes of symmetry"),
        "symmetry and friction": ("contact", "planes of symmetry", "symmetry and contact"),
        "fibers of several bodies": ("contact", "several bodies", "fibers"),
        "activations of several bodies": ("contact", "several bodies", "activations"),
    }
)


def has_feature(design: Design, feature: str) -> bool:
    """Return True if a design has a feature of :data:`FEATURES`."""
    return next(FEATURES[feature](design.assembled), None) is not None
