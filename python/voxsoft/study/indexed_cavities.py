"""Check that cavities that a study selects by index are the same ones in all of its trials."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.simulation import Diagnostic
from voxsoft.simulation.setup.chambers import center_of, indices_used

if TYPE_CHECKING:
    from voxsoft.study.trial import Trial

#: Most trials that a warning lists by number.
_NAMED: Final = 8


@dataclass(frozen=True)
class IndexedCavities:
    """Centers of the cavities of a design that selects some by their index.

    Attributes
    ----------
    indices
        Index at each place of the design that has one, ``"loads[0].cavity"``.
    centers
        Center of every cavity, from 0 to 1 along each axis of the body's bounding box, so that
        bodies of other sizes can be compared; empty where no index is used.
    """

    indices: Mapping[str, int] = field(default_factory=dict)
    centers: tuple[tuple[float, ...], ...] = ()

    @classmethod
    def of(cls, design: Design, mesh: Mesh) -> Self:
        """Collect the indices of a design and the centers of its mesh's cavities."""
        indices = dict(indices_used(design))
        if not indices or not mesh.cavities:
            return cls()
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        centers = [(center_of(cavity, mesh) - low) / (high - low) for cavity in mesh.cavities]
        return cls(indices, tuple(tuple(map(float, center.round(6))) for center in centers))

    @classmethod
    def read(cls, record: Mapping[str, Any] | None) -> Self:
        """Read the output of :meth:`record`; older trials have None."""
        if record is None:
            return cls()
        return cls(record["indices"], tuple(tuple(center) for center in record["centers"]))

    def record(self) -> dict[str, Any]:
        """Write the indices and centers as plain data."""
        return {"indices": dict(self.indices), "centers": [list(each) for each in self.centers]}


def switched_cavities(trials: Iterable[Trial]) -> Iterator[Diagnostic]:
    """Warn of indices that mean one cavity in some trials and another one in others.

    A cavity has switched where its center is nearer to that of another cavity of the trial that
    has the most of them than to that of its own index there.

    Parameters
    ----------
    trials
        Trials of one study.
    """
    known = [trial for trial in trials if trial.cavities.centers]
    if not known:
        return
    first = max(known, key=lambda trial: len(trial.cavities.centers))
    places = np.array(first.cavities.centers)
    for where, index in first.cavities.indices.items():
        others = [trial.number for trial in known if _means_another(trial, where, index, places)]
        if not others:
            continue
        named = ", ".join(map(str, others[:_NAMED])) + (", ..." if len(others) > _NAMED else "")
        yield Diagnostic(
            "warning",
            where,
            f"is {index}, which means another cavity in {len(others)} of {len(known)} trials "
            f"({named}) than in trial {first.number}: cavities are counted by their volume, so "
            "that these trials cannot be compared",
            "name the cavity by its place under [chambers], and write its name here",
        )


def _means_another(trial: Trial, where: str, index: int, places: NDArray[np.float64]) -> bool:
    centers = trial.cavities.centers
    if trial.cavities.indices.get(where) != index or index >= min(len(centers), len(places)):
        return False
    gaps = np.linalg.norm(places - np.array(centers[index]), axis=1)
    # Among concentric cavities, which are equally near, the own one counts.
    return bool(gaps.min() < gaps[index] - 1e-6)
