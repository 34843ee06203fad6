"""Names in CalculiX's input files: sets of parts, places and loads, materials, surfaces.

CalculiX and Abaqus ignore case, and take letters, digits, ``_`` and ``-``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.bricks import BrickModel
from voxsoft.formats.region_names import comments_of, labels_of
from voxsoft.simulation import Setup, named_regions

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

#: Sets of all nodes and elements, of the vertices of the voxels, and of the held nodes.
ALL_NODES: Final = "ALL-NODES"
ALL_ELEMENTS: Final = "ALL-ELEMENTS"
VERTICES: Final = "VERTICES"
HELD: Final = "HELD"

#: Weight of a node in the mean of a probe that is rounding.
_NO_WEIGHT: Final = 1e-9


@dataclass(frozen=True)
class DeckNames:
    """Names of the entries of a file; those of a comparison are numbers.

    Attributes
    ----------
    parts
        Element set of each part.
    materials
        Material of each part; parts of one material share its name.
    tools
        Nodes, elements and surface of each object.
    layers
        Elements and material of each layer.
    places
        Nodes of each clamp and probe, and of the regions of a file, by the name of their set.
    clamps
        Names among them that are clamps.
    probes
        Name among them of each probe of the design.
    weights
        Weights of the nodes of each probe, in their order, by the name of their set.
    comments
        Lines that map such names to those of the design, where they differ.
    """

    parts: tuple[str, ...]
    materials: tuple[str, ...]
    tools: tuple[str, ...] = ()
    layers: tuple[str, ...] = ()
    places: Mapping[str, Ints] = field(default_factory=lambda: MappingProxyType({}), repr=False)
    clamps: tuple[str, ...] = ()
    probes: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}), repr=False)
    weights: Mapping[str, Floats] = field(default_factory=lambda: MappingProxyType({}), repr=False)
    comments: tuple[str, ...] = ()

    @classmethod
    def numbered(cls, model: BrickModel) -> Self:
        """Number everything, as the file of a comparison does."""
        tools = () if model.contact is None else model.contact.tools
        return cls(
            tuple(f"PART{number}" for number in range(len(model.materials))),
            tuple(f"MATERIAL{number}" for number in range(len(model.materials))),
            tuple(f"TOOL{number}" for number in range(len(tools))),
            tuple(f"LAYER{layer.number}" for layer in model.layers),
        )

    @classmethod
    def of(cls, setup: Setup, model: BrickModel) -> Self:
        """Take the names of a design.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> setup = Setup.of(families.beam())
        >>> names = DeckNames.of(setup, BrickModel.of(setup))
        >>> names.parts, names.materials, sorted(names.places)[:2]
        (('body',), ('ecoflex-00-30',), ['clamp_0', 'probe_station-1'])
        """
        design = setup.design
        titles = [part.label or f"PART-{number}" for number, part in enumerate(design.parts, 1)]
        tools = [] if model.contact is None else [tool.name for tool in model.contact.tools]
        # Two parts may have one label: their place makes them two.
        own = [
            f"{title} {titles[:place].count(title) + 1}" if title in titles[:place] else title
            for place, title in enumerate(titles)
        ]
        layers = [f"layer_{layer.name or number}" for number, layer in enumerate(design.layers)]
        sets = labels_of([*own, *(f"object_{tool}" for tool in tools), *layers])
        rubber = [
            part.material if isinstance(part.material, str) else f"material of {title}"
            for part, title in zip(design.parts, own, strict=True)
        ]
        materials = labels_of(dict.fromkeys([*layers, *rubber]))
        regions = named_regions(design, setup.mesh)
        places = labels_of(regions)
        clamps = clamp_regions(setup, model)
        nodes = {
            places[name]: clamps[name] if name in clamps else model.vertex_nodes[vertices]
            for name, vertices in regions.items()
        }
        probes = {name: places[f"probe_{name}"] for name in setup.places}
        weights: dict[str, Floats] = {}
        for name, place in setup.places.items():
            # A point on the grid has one corner with a weight.
            kept = np.abs(place.weights) > _NO_WEIGHT
            nodes[probes[name]] = model.vertex_nodes[place.vertices[kept]]
            weights[probes[name]] = place.weights[kept]
        return cls(
            tuple(sets[title] for title in own),
            tuple(materials[name] for name in rubber),
            tuple(sets[f"object_{tool}"] for tool in tools),
            tuple(sets[layer] for layer in layers),
            nodes,
            tuple(places[name] for name in clamps if name in places),
            probes,
            weights,
            tuple(comments_of(places)),
        )


def clamp_regions(setup: Setup, model: BrickModel) -> dict[str, Ints]:
    """Return the nodes that each clamp holds, by the name of its region."""
    clamps = zip(setup.design.clamps, model.clamp_nodes, strict=True)
    return {f"clamp_{clamp.name or number}": nodes for number, (clamp, nodes) in enumerate(clamps)}
