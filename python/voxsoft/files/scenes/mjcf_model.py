"""MJCF document while it is written: its sections, its controls, and the list of losses."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import ErrorDetail
from voxsoft.files.scenes.scene import Scene

Floats = NDArray[np.float64]
Ints = NDArray[np.integer[Any]]
Element = ElementTree.Element


def numbers(values: Iterable[float]) -> str:
    """Return numbers with all their digits, as an attribute has them.

    Examples
    --------
    >>> numbers(np.array([0.1, -2.0])), numbers([1, 2])
    ('0.1 -2.0', '1 2')
    """
    return " ".join(map(repr, np.asarray(values).tolist()))


def vertex_name(index: int) -> str:
    """Return the name of the body of a vertex."""
    return f"vertex/{index}"


def joint_name(index: int, axis: int) -> str:
    """Return the name of the joint of a vertex along an axis."""
    return f"vertex/{index}/{'xyz'[axis]}"


@dataclass
class Model:
    """MJCF document.

    Attributes
    ----------
    scene
        Scene that it is made of.
    root
        The element ``mujoco``.
    lost
        Entries of the design that it does not hold, or holds in another form.
    controls
        Final value of each actuator, in their order.
    """

    scene: Scene
    root: Element = field(default_factory=lambda: ElementTree.Element("mujoco"))
    lost: list[ErrorDetail] = field(default_factory=list)
    controls: list[float] = field(default_factory=list)

    def section(self, name: str) -> Element:
        """Return a child of the root, made at its first use."""
        found = self.root.find(name)
        return ElementTree.SubElement(self.root, name) if found is None else found

    def add(self, section: str, tag: str, **attributes: str) -> Element:
        """Add an element to a section."""
        return ElementTree.SubElement(self.section(section), tag, attributes)

    def lose(self, where: str, what: str, hint: str = "") -> None:
        """Note a loss."""
        self.lost.append(self.scene.loss(where, what, hint))

    def actuator(self, tag: str, final: float, **attributes: str) -> None:
        """Add an actuator with the value of its control under the loads of the design."""
        self.add("actuator", tag, **attributes)
        self.controls.append(final)

    @cached_property
    def held(self) -> NDArray[np.bool_]:
        """Axes along which vertices are clamped, (n, 3)."""
        setup = self.scene.setup
        held = np.zeros(setup.mesh.vertices.shape, dtype=bool)
        for clamp, vertices in zip(setup.design.clamps, setup.clamped, strict=True):
            axes = np.array(["xyz".index(axis) for axis in clamp.axes])
            held[np.ix_(vertices, axes)] = True
        return held

    @cached_property
    def moved(self) -> dict[int, int]:
        """Clamp that carries a vertex, by vertex: the last one, if it is on a prescribed way.

        Only clamps that hold all axes are: they are rigid bodies.
        """
        setup = self.scene.setup
        found: dict[int, int] = {}
        for index, (clamp, vertices) in enumerate(
            zip(setup.design.clamps, setup.clamped, strict=True)
        ):
            for vertex in vertices.tolist():
                found.pop(vertex, None)
                if clamp.motion is not None and clamp.axes == "xyz":
                    found[vertex] = index
        return found

    @cached_property
    def vertices(self) -> list[Element]:
        """Body that carries each vertex."""
        return []

    @cached_property
    def origins(self) -> Floats:
        """Place of the body that carries each vertex, (n, 3), m."""
        return self.scene.setup.mesh.vertices.copy()

    @cached_property
    def clamps(self) -> dict[int, Element]:
        """Body of each clamp that moves vertices."""
        return {}

    @cached_property
    def objects(self) -> list[Element]:
        """Body of each object."""
        return []

    def linear(self, name: str, coefficients: Floats) -> bool:
        """Add a fixed tendon whose length is a linear function of the displacements.

        Parameters
        ----------
        name
            Its name.
        coefficients
            Slopes by the displacement of each vertex, (n, 3).

        Returns
        -------
        bool
            False where no free vertex has a part in it: MuJoCo has no such tendon.
        """
        used = np.argwhere((coefficients != 0.0) & ~self.held).tolist()
        if not used:
            return False
        tendon = self.add("tendon", "fixed", name=name)
        for index, axis in used:
            slope = repr(float(coefficients[index, axis]))
            joint = joint_name(index, axis)
            ElementTree.SubElement(tendon, "joint", {"joint": joint, "coef": slope})
        return True
