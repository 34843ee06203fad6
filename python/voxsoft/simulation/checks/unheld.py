"""Rigid-body motions that clamps leave free, so that statics has no unique equilibrium."""

from __future__ import annotations

from collections.abc import Iterator

from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.setup.freedom import free_motion
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.choice import STATICS, kind_of


def unheld(setup: Setup) -> Iterator[Diagnostic]:
    """Find the rigid-body motions that clamps leave free, where statics needs them held.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> soft = families.beam().with_values("parts.0.material=ecoflex-00-30")
    >>> [str(found) for found in unheld(Setup.of(soft.with_values("clamps.0.axes=xz")))]
    ['clamps: leave the body free to move along y. Try: hold it along these axes, or give the \
design an end_time to watch it move']
    """
    design = setup.design
    if kind_of(design, design.solver) in STATICS and (free := free_motion(setup)):
        what = f"leave the body free to {free}"
        hint = "hold it along these axes, or give the design an end_time to watch it move"
        yield Diagnostic("error", "clamps", what, hint)
