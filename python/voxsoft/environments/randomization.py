"""Draws of materials and parameters, one for each episode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from voxsoft.design import Design, Part
from voxsoft.errors import DesignError
from voxsoft.materials import load_card
from voxsoft.materials.constants import constant_of
from voxsoft.materials.posterior import Posterior
from voxsoft.records import closest
from voxsoft.units import si_value


@dataclass(frozen=True)
class Randomization:
    """Domain randomization: materials from the posteriors of their cards, parameters from ranges.

    Parameters
    ----------
    parts
        Names of the parts whose materials are drawn; default: all whose card has a posterior, and
        with `spread` all. Parts of one material have one draw.
    spread
        Share by which a material without a posterior is uncertain (95 %), 0.3 for 30 %.
    parameters
        Range of each parameter of the design that is drawn, evenly: numbers in SI units or texts
        with units; None for the range that the design itself gives.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> beam = families.beam()
    >>> part = beam.parts[0].replace(material="ecoflex-00-30-lattice")
    >>> beam = beam.replace(parts=[part])
    >>> design, drawn = Randomization().draw(beam, np.random.default_rng(0))
    >>> list(drawn)
    ['ecoflex-00-30-lattice.edge']
    """

    parts: Sequence[str] | None = None
    spread: float | None = None
    parameters: Mapping[str, tuple[float | str, float | str] | None] = field(default_factory=dict)

    def draw(
        self, design: Design, generator: np.random.Generator
    ) -> tuple[Design, dict[str, float]]:
        """Draw a design, with the numbers that were drawn, in SI units by name.

        Raises
        ------
        DesignError
            An unknown part or parameter, a range that is none, or nothing to draw.
        MaterialError
            A card whose posterior cannot be read.
        """
        drawn: dict[str, float] = {}
        if self.parameters:
            values = {}
            for name, ends in self.parameters.items():
                low, high = self._range(design, name, ends)
                values[name] = drawn[name] = float(generator.uniform(low, high))
            design = design.with_parameters(**values)
        posteriors = self._posteriors(design)
        if posteriors:
            made = {}
            for label, (posterior, _) in posteriors.items():
                made[label] = posterior.draw(generator)
                for name in posterior.intervals:
                    drawn[f"{label}.{name}"] = constant_of(made[label], name)
            of_part = {at: label for label, (_, parts) in posteriors.items() for at in parts}
            parts = [
                part.replace(material=made[of_part[index]]) if index in of_part else part
                for index, part in enumerate(design.parts)
            ]
            design = design.replace(parts=parts)
        if not drawn:
            what = "finds no card with a posterior, and no parameter is named"
            raise DesignError("randomize", what, "give a spread, as 0.3 for 30 %")
        return design, drawn

    def _posteriors(self, design: Design) -> dict[str, tuple[Posterior, list[int]]]:
        """Return the posterior of each material by its label, with the indices of its parts."""
        names = [part.name for part in design.parts]
        for name in self.parts or ():
            if name not in names:
                what = f'"{name}" is no part'
                raise DesignError("randomize.parts", what, closest(name, [n for n in names if n]))
        found: dict[str, tuple[Posterior, list[int]]] = {}
        for index, part in enumerate(design.parts):
            if self.parts is not None and part.name not in self.parts:
                continue
            label = part.material if isinstance(part.material, str) else f"parts[{index}]"
            if label not in found:
                posterior = self._posterior(design, part)
                if posterior is None:
                    continue
                found[label] = posterior, []
            found[label][1].append(index)
        return found

    def _posterior(self, design: Design, part: Part) -> Posterior | None:
        material = design.material_of(part)
        if isinstance(part.material, str) and part.material not in design.materials:
            posterior = Posterior.of(load_card(part.material))
            if posterior is not None:
                return posterior
        if self.spread is None or material.model == "rigid":
            return None
        return Posterior.around(material, self.spread)

    def _range(
        self, design: Design, name: str, ends: tuple[float | str, float | str] | None
    ) -> tuple[float, float]:
        where = f"randomize.parameters.{name}"
        if name not in design.parameters:
            what = f'"{name}" is no parameter'
            raise DesignError(where, what, closest(name, list(design.parameters)))
        parameter = design.parameters[name]
        if ends is None:
            given = (parameter.min, parameter.max)
            if given[0] is None or given[1] is None:
                raise DesignError(where, "has no min and max in the design", "give a range")
            low, high = float(given[0]), float(given[1])
        else:
            low, high = (si_value(each, parameter.kind, where) for each in ends)
        if not low < high:
            raise DesignError(where, f"goes from {low:g} to {high:g}", "give the lower end first")
        return low, high
