"""Molds for casting a soft robot: parts to print, silicone to mix, and proofs of both.

>>> import voxsoft as vs
>>> from voxsoft.fabrication import make
>>> from voxsoft.units import mm
>>> bar = vs.Part(shape=vs.Box(size=(20 * mm, 8 * mm, 6 * mm)), material="ecoflex-00-30")
>>> make(vs.Design(name="bar", voxel_size=2 * mm, parts=[bar])).way
'cast'
"""

from __future__ import annotations

from voxsoft.design.molds import ASKED_WAYS, WAYS, AskedWay, Way
from voxsoft.design.printer import Printer
from voxsoft.fabrication.making import Cast, Fabrication, Printed, make
from voxsoft.fabrication.selection import one_body

__all__ = [
    "ASKED_WAYS",
    "WAYS",
    "AskedWay",
    "Cast",
    "Fabrication",
    "Printed",
    "Printer",
    "Way",
    "make",
    "one_body",
]
