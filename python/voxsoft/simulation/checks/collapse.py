"""Voxels that are collapsed or inverted."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from voxsoft.design import Design
from voxsoft.fields import Fields
from voxsoft.materials import Hyperelastic
from voxsoft.simulation.diagnostic import Diagnostic, Severity

#: Volume ratio below which a voxel counts as collapsed.
#:
#: The energy of a change of volume is ``K/2 (J - 1)²`` in every material here. Pressed along two
#: axes, ``J = λ²``, it resists with ``2 K λ (1 - λ²)`` per original area, pressed along all three,
#: ``J = λ³``, with ``3 K λ² (1 - λ³)``: no more than at ``J = 1/3`` and ``J = 2/5``. Beyond, the
#: farther it is pressed the less it resists, until it is flat or inside out, which no rubber does:
#: it changes its volume by thousandths. (The law of hyperelastic materials itself ends at
#: ``J = 0.1``, where the core goes on with a polynomial.)
COLLAPSED: Final = 1.0 / 3.0


def collapsed_voxels(design: Design, fields: Fields) -> Iterator[Diagnostic]:
    """Find voxels that are inverted, and those that are collapsed.

    Parameters
    ----------
    design
        The design.
    fields
        Its stress and strain.

    Yields
    ------
    Diagnostic
        One for both kinds, an error where voxels are inverted, at the worst of them.
    """
    ratio = fields.volume_ratio
    inverted, collapsed = int((ratio <= 0.0).sum()), int((ratio < COLLAPSED).sum())
    if collapsed == 0:
        return
    worst = int(np.argmin(ratio))
    x, y, z = fields.centers[worst]
    material = design.material_of(design.parts[fields.parts[worst]])
    total = f"of {len(ratio):,} voxels"
    flat = f"are pressed below {COLLAPSED:.0%} of their volume"
    if inverted:
        what = f"{inverted:,} {total} are inside out, so that no stress is given there"
        if collapsed > inverted:
            what += f", and {collapsed - inverted:,} more {flat}"
    else:
        what = (
            f"{collapsed:,} {total} {flat}, which no rubber does, the worst to {ratio[worst]:.0%}"
        )
    hint = "lower the load, make what gives way there thicker, or use smaller voxels"
    if not isinstance(material, Hyperelastic):
        hint += (
            "; springs do not keep a voxel from turning inside out: a hyperelastic material "
            "resists more"
        )
    severity: Severity = "error" if inverted else "warning"
    yield Diagnostic(severity, "voxels", what, hint, at=(float(x), float(y), float(z)))
