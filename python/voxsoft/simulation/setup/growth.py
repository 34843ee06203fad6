"""Growth of parts and their fibers without load, by all activations together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import prod

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.activation import AnyActivation
from voxsoft.design.growth import Growth
from voxsoft.errors import DesignError
from voxsoft.materials import Hyperelastic
from voxsoft.records import closest
from voxsoft.simulation.compatibility import REASONS

#: Growth factor for the core: number of the activation, times in s, stretches, their power, and the
#: share of each voxel.
_Factor = tuple[int, tuple[float, ...], tuple[float, ...], float, NDArray[np.float64] | None]


@dataclass(frozen=True)
class PartGrowth:
    """Growth of a part and its fibers, by the number of the activation; several multiply."""

    of_part: dict[int, Growth] = field(default_factory=dict)
    of_fibers: dict[int, Growth] = field(default_factory=dict)

    @property
    def part_stretch(self) -> float:
        """Final stretch of the part by growth alone."""
        return prod(each.last for each in self.of_part.values())

    @property
    def fiber_stretch(self) -> float:
        """Final stretch of its fibers by growth alone."""
        return prod(each.last for each in self.of_fibers.values())

    @property
    def is_uniform(self) -> bool:
        """True if all places of the part grow alike."""
        both = (*self.of_part.values(), *self.of_fibers.values())
        return all(each.profile is None for each in both)

    def give_to(
        self,
        core: _core.Material,
        shares: Callable[[Growth, str], NDArray[np.float64] | None],
        *,
        over_time: bool,
    ) -> _core.Material:
        """Return the material of a part that grows over time, or differently from voxel to voxel.

        Parameters
        ----------
        core
            The part's material.
        shares
            Function that gives the share of a growth in each voxel of the mesh, (n, 4), for the
            place of an activation in the design; see
            :func:`voxsoft.simulation.setup.profiles.shares_of`.
        over_time
            True to follow the history, False for the final growth.
        """

        def factors(growths: dict[int, Growth]) -> list[_Factor]:
            found = []
            for number, growth in growths.items():
                share = shares(growth, f"activations[{number}]")
                now = growth if over_time else growth.at_the_end
                found.append((number, now.times, now.bases, now.power, share))
            return found

        return core.with_growth(factors(self.of_part), factors(self.of_fibers))


def growths_of(design: Design) -> dict[int, PartGrowth]:
    """Return the growth of the parts of a design, by the index of the part.

    Parameters
    ----------
    design
        The design with the activations.

    Raises
    ------
    DesignError
        There is no such part, it is a lattice or rigid, or has no fibers that could be longer.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> growths_of(families.beam())
    {}
    """
    found: dict[int, PartGrowth] = {}
    for number, activation in enumerate(design.activations):
        for index in parts_of(design, activation, f"activations[{number}].part"):
            growth = activation.growth
            if growth is None:
                continue
            known = found.setdefault(index, PartGrowth())
            (known.of_fibers if activation.of_fibers else known.of_part)[number] = growth
    return found


def grows_over_time(design: Design) -> bool:
    """Return True if an activation that makes a part grow has a history."""
    timed = [each for each in design.activations if each.history is not None]
    return any(activation.growth is not None for activation in timed)


def has_profiles(design: Design) -> bool:
    """Return True if a part of a design grows differently from place to place."""
    growths = [activation.growth for activation in design.activations]
    return any(growth is not None and growth.profile is not None for growth in growths)


def at_time(design: Design, time: float) -> Design:
    """Return the design with activations frozen at a time in s."""

    def then(activation: AnyActivation) -> AnyActivation:
        history = activation.history
        over = history is None or time >= history.times[-1]
        return activation if over else activation.at(time)

    if all(activation.history is None for activation in design.activations):
        return design
    return design.replace(activations=tuple(then(each) for each in design.activations))


def parts_of(design: Design, activation: AnyActivation, where: str) -> list[int]:
    """Return the indices of the parts that an activation names.

    Parameters
    ----------
    design
        The design with the parts.
    activation
        The activation that names them.
    where
        Place in the design, for errors.

    Raises
    ------
    DesignError
        Errors as for :func:`growths_of`.
    """
    named = [i for i, part in enumerate(design.parts) if activation.part == part.label]
    if not named:
        labels = [part.label for part in design.parts]
        what = f'there is no part "{activation.part}"'
        raise DesignError(where, what, closest(activation.part, labels))
    for index in named:
        material = design.material_of(design.parts[index])
        if not isinstance(material, Hyperelastic):
            what, hint = REASONS["spring lattice", "path of activations"]
            raise DesignError(where, f'{what}, and "{activation.part}" is "{material.model}"', hint)
        if activation.of_fibers and not design.parts[index].fibers:
            what = f'is for the fibers of a part, and "{activation.part}" has none'
            raise DesignError(where, what, 'give the part fibers, or take kind = "strain"')
    return named
