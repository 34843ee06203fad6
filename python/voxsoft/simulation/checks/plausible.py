"""Implausible numbers: meters for millimeters, pascals for kilopascals."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np

from voxsoft.design import Design
from voxsoft.materials import Rigid
from voxsoft.mesh import Mesh
from voxsoft.shapes import TriangleMesh
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.loads import readings
from voxsoft.units import format_quantity

# Bounds lie where no soft robot is known to be, ten times or more from usual numbers, and within a
# factor of a thousand, the slip of a unit.
#: m: inflatable arms of a few meters are the longest; a finger in meters for millimeters has 80.
_LONGEST: Final = 5.0
#: m: a cell has a tenth, a robot of an insect's size ten times as much.
_SHORTEST: Final = 0.5e-3
#: kg: a body of 5 m that is full of silicone from end to end has a ton from 0.45 m across.
_HEAVIEST: Final = 1000.0
#: m: there are at least some voxels in 5 m; a voxel of 0.5 mm in meters has 0.5.
_COARSEST: Final = 0.2
#: Pa: 5 mm of water. Membranes answer to it, walls of silicone do not.
_LOWEST_PRESSURE: Final = 50.0
#: Pa: the softest silicones have 10 kPa, gels for robots a few.
_SOFTEST: Final = 1000.0
#: kg/m³: foams begin at 20, and osmium has 22,600; 1.07 is silicone in g/cm³.
_LIGHTEST, _DENSEST = 10.0, 25_000.0
#: m/s²: a hundred times the weight on earth; 9810 is that in mm/s².
_STRONGEST: Final = 1000.0
#: T: sintered neodymium-iron-boron keeps up to 1.5; 100 is 100 mT without its unit.
_STRONGEST_MAGNET: Final = 2.0
#: T: the strongest magnet of a hospital has 10.
_STRONGEST_FIELD: Final = 20.0

_METERS: Final = 'lengths in Python are in m: write 2*mm or "2 mm"'


def implausible_numbers(body: object, mesh: Mesh, mass: float) -> Iterator[Diagnostic]:
    """Find numbers of a body that are likely in another unit than was meant.

    Parameters
    ----------
    body
        A design, or voxels, of which only the size can be judged.
    mesh
        Its mesh.
    mass
        Its mass in kg.

    Examples
    --------
    >>> from voxsoft.design import families, Pressure
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> soft = families.cylinder().replace(loads=[Pressure(value=3)])
    >>> print(*implausible_numbers(soft, mesh_of(soft), mass=0.1))
    loads[0].value: 3 Pa is less than 5 mm of water. Try: pressures in Python are in Pa: write \
3*kPa or "3 kPa"
    """
    yield from _of_size(body, mesh, mass)
    if isinstance(body, Design):
        yield from _of_loads(body)
        yield from _of_materials(body)
        yield from _of_magnets(body)


def _of_size(body: object, mesh: Mesh, mass: float) -> Iterator[Diagnostic]:
    hint = _hint_on_size(body)
    longest = float(np.ptp(mesh.vertices, axis=0).max())
    if mesh.voxel_size is not None and mesh.voxel_size > _COARSEST:
        size = format_quantity(mesh.voxel_size, "length")
        yield _warning("voxel_size", f"is {size}: each voxel is as large as a robot", _METERS)
    if not _SHORTEST <= longest <= _LONGEST:
        size = format_quantity(float(f"{longest:.4g}"), "length")
        yield _warning("parts", f"the body is {size} long", hint)
    if mass > _HEAVIEST:
        yield _warning("parts", f"the body has a mass of {mass:,.0f} kg", hint)


def _hint_on_size(body: object) -> str:
    """Suggest a remedy for a body of an implausible size."""
    if isinstance(body, Design):
        made_of = [each for shape in body.shapes.values() for each in shape.every()]
        files = [(each.path, each.unit) for each in made_of if isinstance(each, TriangleMesh)]
        files += [] if body.mesh is None else [(body.mesh.path, body.mesh.unit or "its own unit")]
        if files:
            read = dict.fromkeys(f"{Path(path).name} is read in {unit}" for path, unit in files)
            return f"check the unit: {', '.join(read)}"
    return _METERS


def _of_loads(design: Design) -> Iterator[Diagnostic]:
    # A file states the unit; a number typed in Python may have been meant in kPa.
    for index, load in enumerate(readings(design) if design.is_typed("loads") else ()):
        where = f"loads[{index}].value"
        if load.quantity == "pressure":
            largest = float(np.abs(load.components).max())
            if 0.0 < largest < _LOWEST_PRESSURE:
                what = f"{format_quantity(largest, 'pressure')} is less than 5 mm of water"
                hint = f'pressures in Python are in Pa: write {largest:g}*kPa or "{largest:g} kPa"'
                yield _warning(where, what, hint)
        elif load.quantity == "acceleration" and abs(load.size) > _STRONGEST:
            what = f"{format_quantity(load.size, 'acceleration')} is {load.size / 9.81:,.0f} g"
            yield _warning(where, what, "accelerations are in m/s^2: 9.81 on earth")


def _of_materials(design: Design) -> Iterator[Diagnostic]:
    for index, part in enumerate(design.parts):
        material, where = design.material_of(part), f"parts[{index}].material"
        young = material.young(design.voxel_size)
        if not isinstance(material, Rigid) and 0.0 < young < _SOFTEST:
            stiff = format_quantity(float(f"{young:.4g}"), "modulus")
            what = f"has a Young's modulus of {stiff}, softer than any silicone or gel"
            yield _warning(where, what, 'moduli are in Pa: write 60*kPa or "60 kPa"')
        if not _LIGHTEST <= material.density <= _DENSEST:
            what = f"has a density of {format_quantity(material.density, 'density')}"
            yield _warning(where, what, 'densities are in kg/m^3: silicone has "1070 kg/m^3"')


def _of_magnets(design: Design) -> Iterator[Diagnostic]:
    fields = {i: r for i, r in enumerate(readings(design)) if r.quantity == "magnetic field"}
    for index, part in enumerate(design.parts):
        strength = float(np.linalg.norm(part.remanence or 0.0))
        where = f"parts[{index}].remanence"
        if strength and not fields:
            hint = 'add a load of the kind "magnetic_field"'
            yield _warning(where, "there is no magnetic field that acts on it", hint)
        if strength > _STRONGEST_MAGNET:
            hint = "it is the flux density that stays without a field: 0.1 T of filled silicone"
            yield _warning(where, f"{strength:g} T is more than any magnet keeps", hint)
    for index, field in fields.items():
        if field.size > _STRONGEST_FIELD:
            what = f"{field.size:g} T is stronger than any coil of a laboratory"
            yield _warning(f"loads[{index}].value", what, "give the flux density in T")


def _warning(where: str, what: str, hint: str) -> Diagnostic:
    return Diagnostic("warning", where, what, hint)
