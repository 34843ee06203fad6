"""Solver results besides vertex positions, as arrays and text for storage."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Final, Self, get_type_hints

import msgspec
import numpy as np
from numpy.typing import NDArray

from voxsoft._core import __version__
from voxsoft.design import Design
from voxsoft.errors import SimulationError
from voxsoft.simulation.features import has_feature
from voxsoft.simulation.results.fields import remember
from voxsoft.simulation.results.result import Result
from voxsoft.simulation.setup.contact import Pose, has_contact
from voxsoft.simulation.setup.fluids import has_supplies
from voxsoft.simulation.setup.growth import at_time
from voxsoft.simulation.setup.setup import Setup

#: Fields of a result that follow from the design, or are stored beside it.
_FOUND_AGAIN: Final = frozenset({"design", "mesh", "places", "positions"})
_VERSION: Final = "voxsoft"
#: Key of the number of an array in the text.
_ARRAY: Final = "array"


def is_given_by_positions(design: Design) -> bool:
    """Return True if vertex positions alone determine an equilibrium of a design.

    They do not with objects, which have poses, contact, which depends on its slip, supplies, which
    depend on the amounts given, and softening, which depends on the largest stretch.
    """
    softens = has_feature(design, "softening")
    return not (has_contact(design) or has_supplies(design) or softens)


@dataclass(frozen=True, eq=False)
class SolvedState:
    """A result without its design, its mesh and its positions.

    Frames of a motion are left out: they would take a hundred times as much.

    Attributes
    ----------
    text
        JSON of all numbers and words; an array is ``{"array": its number}`` there.
    arrays
        The arrays.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.simulation import simulate
    >>> setup = Setup.of(families.beam())
    >>> result = simulate(setup)
    >>> found = SolvedState.of(result).result(setup, result.positions)
    >>> found.metrics == result.metrics
    True
    """

    text: str = field(repr=False)
    arrays: tuple[NDArray[Any], ...] = field(repr=False)

    @classmethod
    def of(cls, result: Result) -> Self:
        """Collect the results of a solver."""
        arrays: list[NDArray[Any]] = []

        def numbered(value: object) -> object:
            if isinstance(value, np.ndarray):
                arrays.append(value)
                return {_ARRAY: len(arrays) - 1}
            if isinstance(value, np.generic):
                return value.item()
            raise NotImplementedError(type(value).__name__)

        without_frames = replace(
            result.recording, frames=np.zeros((0, *result.positions.shape), dtype=np.float64)
        )
        found = {
            name: msgspec.to_builtins(
                without_frames if name == "recording" else getattr(result, name),
                enc_hook=numbered,
            )
            for name in _TYPES
        }
        # Numbers as Python writes them are read back to the last bit, infinity too.
        return cls(json.dumps({_VERSION: __version__, **found}), tuple(arrays))

    def result(self, setup: Setup, positions: NDArray[np.float64]) -> Result:
        """Restore the result that this was taken of.

        Softening voxels get their largest energies again, as after the solution.

        Parameters
        ----------
        setup
            A setup of the design and the mesh that were solved.
        positions
            Vertex positions in m, (n, 3).

        Raises
        ------
        SimulationError
            The state is of another version of VoxSoft, of another mesh, or damaged.
        """
        if self._plain.get(_VERSION) != __version__:
            raise _unreadable("is of another version of VoxSoft")
        found = {name: self._read(name, kind) for name, kind in _TYPES.items()}
        design, shape = setup.design, setup.mesh.vertices.shape
        if found["reactions"].shape != shape or found["velocities"].shape != shape:
            raise _unreadable("is of another mesh")
        if found["solver"].get("way") == "dynamics":
            design = at_time(design, found["time"])
        result = Result(
            design=design, mesh=setup.mesh, places=setup.places, positions=positions, **found
        )
        try:
            remember(setup.problem, result.peaks)
        except ValueError as error:
            raise _unreadable(f"is of another mesh: {error}") from None
        return result

    @property
    def objects(self) -> Mapping[str, Pose]:
        """Poses of the rigid objects, by name; SimulationError where these are damaged."""
        poses: Mapping[str, Pose] = self._read("objects", _TYPES["objects"])
        return poses

    @cached_property
    def _plain(self) -> dict[str, Any]:
        try:
            plain = json.loads(self.text)
        except (ValueError, RecursionError) as error:
            raise _unreadable(f"is damaged: {error}") from None
        if not isinstance(plain, dict):
            raise _unreadable("is damaged: expected an object")
        return plain

    def _read(self, name: str, kind: Any) -> Any:  # noqa: ANN401 - of the type `kind`
        def array(_: type, value: object) -> NDArray[Any]:
            if not isinstance(value, dict) or not isinstance(value.get(_ARRAY), int):
                raise ValueError("expected an array")
            return self.arrays[value[_ARRAY]]

        try:
            return msgspec.convert(self._plain[name], kind, dec_hook=array)
        except (KeyError, IndexError, msgspec.ValidationError) as error:
            raise _unreadable(f"is damaged: {name}: {error}") from None


def _unreadable(what: str) -> SimulationError:
    return SimulationError("stored state", what, "solve the design again")


#: Type of each field that is stored.
_TYPES: Final[Mapping[str, Any]] = {
    name: kind
    for name, kind in get_type_hints(Result).items()
    if name in Result.__dataclass_fields__ and name not in _FOUND_AGAIN
}
