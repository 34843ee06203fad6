"""Designs: typed models of parts, clamps, loads and measured quantities."""

from voxsoft.design.activation import FiberStrain, Strain, Swelling, Thermal
from voxsoft.design.body import Body
from voxsoft.design.chamber import Chamber
from voxsoft.design.clamp import Clamp, Motion, Rotation
from voxsoft.design.contact import Contact, ContactPair
from voxsoft.design.dielectric import Dielectric
from voxsoft.design.document.assignment import set_values
from voxsoft.design.file_mesh import FileMesh
from voxsoft.design.fluid import Gas, Liquid
from voxsoft.design.history import History
from voxsoft.design.layer import Layer
from voxsoft.design.line import Pump, Valve
from voxsoft.design.load import (
    AnyLoad,
    Drag,
    Floor,
    Force,
    ForceField,
    Gravity,
    Immersion,
    MagneticField,
    Pressure,
    Traction,
)
from voxsoft.design.model import Design
from voxsoft.design.molds import Molds
from voxsoft.design.object import Object
from voxsoft.design.parameter import Parameter
from voxsoft.design.part import Part
from voxsoft.design.profile import Profile
from voxsoft.design.refinement import Refinement
from voxsoft.design.region import Probe, Region
from voxsoft.design.require import require_design
from voxsoft.design.shape_memory import ShapeMemory
from voxsoft.design.solver import Solver
from voxsoft.design.spring import Spring
from voxsoft.design.supply import (
    AnySupply,
    Connection,
    FlowSupply,
    MassSupply,
    PressureSupply,
    VolumeSupply,
)
from voxsoft.design.symmetry import Symmetry
from voxsoft.design.target import Constraint, Objective
from voxsoft.design.tendon import Guide, Tendon

__all__ = [
    "AnyLoad",
    "AnySupply",
    "Body",
    "Chamber",
    "Clamp",
    "Connection",
    "Constraint",
    "Contact",
    "ContactPair",
    "Design",
    "Dielectric",
    "Drag",
    "FiberStrain",
    "FileMesh",
    "Floor",
    "FlowSupply",
    "Force",
    "ForceField",
    "Gas",
    "Gravity",
    "Guide",
    "History",
    "Immersion",
    "Layer",
    "Liquid",
    "MagneticField",
    "MassSupply",
    "Molds",
    "Motion",
    "Object",
    "Objective",
    "Parameter",
    "Part",
    "Pressure",
    "PressureSupply",
    "Probe",
    "Profile",
    "Pump",
    "Refinement",
    "Region",
    "Rotation",
    "ShapeMemory",
    "Solver",
    "Spring",
    "Strain",
    "Swelling",
    "Symmetry",
    "Tendon",
    "Thermal",
    "Traction",
    "Valve",
    "VolumeSupply",
    "require_design",
    "set_values",
]
