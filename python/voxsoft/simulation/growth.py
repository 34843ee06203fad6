"""By how much parts and their fibers are longer by themselves, by all activations together."""

from __future__ import annotations

from math import prod
from typing import NamedTuple

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.activation import AnyActivation
from voxsoft.design.growth import Growth
from voxsoft.errors import DesignError
from voxsoft.materials import Hyperelastic
from voxsoft.records import closest


class PartGrowth(NamedTuple):
    """How a part and its fibers grow; several activations of one multiply."""

    of_part: tuple[Growth, ...] = ()
    of_fibers: tuple[Growth, ...] = ()

    @property
    def part_stretch(self) -> float:
        """How many times as long the part is in the end."""
        return prod(each.last for each in self.of_part)

    @property
    def fiber_stretch(self) -> float:
        """How many times as long its fibers are in the end."""
        return prod(each.last for each in self.of_fibers)

    def over_time(self, core: _core.Material) -> _core.Material:
        """The material of a part that grows as time goes on."""
        return core.with_growth(self.of_part, self.of_fibers)


def growths_of(design: Design) -> dict[int, PartGrowth]:
    """Return how the parts of a design grow, by the index of the part.

    Parameters
    ----------
    design
        Whose activations it is about.

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
            known = found.get(index, PartGrowth())
            if activation.of_fibers:
                known = known._replace(of_fibers=(*known.of_fibers, growth))
            else:
                known = known._replace(of_part=(*known.of_part, growth))
            found[index] = known
    return found


def grows_over_time(design: Design) -> bool:
    """Whether a part of a design is longer by itself, and that has a history."""
    timed = [each for each in design.activations if each.history is not None]
    return any(activation.growth is not None for activation in timed)


def refuse_growth_over_time(design: Design, who: str) -> None:
    """Raise where an activation has a history and someone keeps parts as they are.

    Raises
    ------
    DesignError
        Naming who.
    """
    for index, activation in enumerate(design.activations):
        if activation.history is not None and activation.growth is not None:
            raise DesignError(
                f"activations[{index}].history",
                f"is not followed by {who}",
                "leave it out, or run the design over time",
            )


def at_time(design: Design, time: float) -> Design:
    """Return the design whose activations stay as they are at a time in s."""

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
        Whose parts they are.
    activation
        What names them.
    where
        The place that an error names.

    Raises
    ------
    DesignError
        As :func:`growths_of`.
    """
    named = [i for i, part in enumerate(design.parts) if activation.part == part.label]
    if not named:
        labels = [part.label for part in design.parts]
        what = f'there is no part "{activation.part}"'
        raise DesignError(where, what, closest(activation.part, labels))
    for index in named:
        material = design.material_of(design.parts[index])
        if not isinstance(material, Hyperelastic):
            raise DesignError(
                where,
                f'acts on hyperelastic parts, and "{activation.part}" is "{material.model}"',
                "use the neo-Hookean material of the same Young's modulus",
            )
        if activation.of_fibers and not design.parts[index].fibers:
            what = f'is for the fibers of a part, and "{activation.part}" has none'
            raise DesignError(where, what, 'give the part fibers, or take kind = "strain"')
    return named
