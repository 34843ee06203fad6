"""Dielectric sheets for the core, and their electric breakdown."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.dielectric import Dielectric
from voxsoft.errors import DesignError
from voxsoft.mesh import Mesh
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.setup.contact import times_and_factors
from voxsoft.simulation.setup.growth import parts_of
from voxsoft.units import format_quantity

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ResolvedDielectric:
    """A dielectric sheet on a mesh.

    Attributes
    ----------
    activation
        The activation in the design.
    corners
        Vertices of its voxels, (k, 8).
    gradients
        Gradients that give the mean deformation of each voxel along two directions in the sheet and
        across it from its corners, 1/m, (k, 8, 3).
    volumes
        Volume of the material of each voxel, m³, (k,).
    """

    activation: Dielectric
    corners: NDArray[np.uint32]
    gradients: Floats
    volumes: Floats

    def give_to(self, parts: _core.ProblemParts) -> None:
        """Add the sheet to the core's problem."""
        parts.dielectric(
            self.corners,
            self.gradients.reshape(-1, 3),
            self.volumes,
            self.activation.pressure,
            times_and_factors(self.activation.history),
        )

    def true_field(self, positions: Floats) -> float:
        """Compute the largest true field in it at positions [m], (n, 3), with its final value, V/m.

        The sheet has become thinner by ``J/|F t₁ × F t₂|``.
        """
        deformation = np.einsum("kca,kcb->kab", positions[self.corners], self.gradients)
        area = np.linalg.norm(np.cross(deformation[..., 0], deformation[..., 1]), axis=-1)
        thinning = area / np.linalg.det(deformation)
        return float(abs(self.activation.factor * self.activation.value) * thinning.max())


def dielectrics_of(design: Design, mesh: Mesh) -> tuple[ResolvedDielectric, ...]:
    """Return the dielectric sheets of a design on its mesh.

    Parameters
    ----------
    design
        The design with the activations.
    mesh
        A mesh of voxels.

    Raises
    ------
    DesignError
        There is no such part, it is no rubber or has no voxels.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import Dielectric, families
    >>> beam = families.beam()
    >>> part = beam.parts[0].replace(name="film")
    >>> film = Dielectric(part="film", value="10 MV/m", permittivity=2.8, normal=(0, 0, 1))
    >>> beam = beam.replace(parts=[part], activations=[film])
    >>> mesh = vs.mesh_of(beam)
    >>> [sheet] = dielectrics_of(beam, mesh)
    >>> round(sheet.true_field(mesh.vertices) / 1e6, 9)
    10.0
    """
    return tuple(
        _sheet(design, mesh, number, activation)
        for number, activation in enumerate(design.activations)
        if isinstance(activation, Dielectric)
    )


def _sheet(design: Design, mesh: Mesh, number: int, activation: Dielectric) -> ResolvedDielectric:
    where = f"activations[{number}]"
    corners, gradients, volumes = [], [], []
    axes = activation.axes
    for index in parts_of(design, activation, f"{where}.part"):
        for body in mesh.each_body:
            # Parts of a body alone are numbered within it; those of the joined mesh, in the design.
            tets = slice(body.first_tet, body.first_tet + len(body.mesh.tets))
            numbers = np.flatnonzero(mesh.tet_part[tets][::5] == index + 1)
            if not len(numbers):
                continue
            own = body.mesh
            assert own.voxel_size is not None  # activations act on parts made of voxels
            filled = np.ones(len(numbers)) if own.fractions is None else own.fractions[numbers]
            volume = filled * own.voxel_size**3
            vertices, slopes = own.voxel_gradients(numbers)
            corners.append(vertices + body.first_vertex)
            gradients.append(slopes @ axes.T / volume[:, None, None])
            volumes.append(volume)
    if not corners:
        what = f'"{activation.part}" has no voxels'
        raise DesignError(f"{where}.part", what, "make it thicker, or the voxels smaller")
    return ResolvedDielectric(
        activation,
        np.concatenate(corners).astype(np.uint32),
        np.concatenate(gradients),
        np.concatenate(volumes),
    )


def broken_down(design: Design, mesh: Mesh, positions: Floats) -> Iterator[Diagnostic]:
    """Warn of dielectric sheets whose true field exceeds their breakdown strength."""
    if not any(isinstance(activation, Dielectric) for activation in design.activations):
        return
    numbers = [i for i, each in enumerate(design.activations) if isinstance(each, Dielectric)]
    for number, sheet in zip(numbers, dielectrics_of(design, mesh), strict=True):
        strength, field = sheet.activation.breakdown, sheet.true_field(positions)
        # NaN counts too: a sheet that is pressed flat has broken down.
        if strength is not None and not field <= strength:
            found = format_quantity(float(f"{field:.4g}"), "electric field")
            allowed = format_quantity(strength, "electric field")
            yield Diagnostic(
                "warning",
                f"activations[{number}].value",
                f"makes {found} in the sheet as it has become, and it breaks down at {allowed}",
                "lower the field, or hold the sheet so that it thins less",
            )
