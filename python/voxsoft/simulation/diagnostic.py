"""Diagnostic: an error or a warning about a design or a result."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

Severity = Literal["error", "warning"]


@dataclass(frozen=True)
class Diagnostic:
    """An error or a warning about a design or a result, with its subject and a remedy.

    Attributes
    ----------
    severity
        An error stops a simulation or spoils its numbers; a warning leaves them in doubt.
    where
        The subject: ``"parts[0]"``, ``"chambers"``.
    what, hint
        The finding, and a remedy.
    at
        A point of the unloaded body in m that shows it best; None where it has no place.

    Examples
    --------
    >>> str(Diagnostic("warning", "voxels", "a wall is 1 voxel thick", "halve the voxels"))
    'voxels: a wall is 1 voxel thick. Try: halve the voxels'
    """

    severity: Severity
    where: str
    what: str
    hint: str
    at: tuple[float, float, float] | None = None

    def __str__(self) -> str:
        message = f"{self.where}: {self.what}"
        return f"{message}. Try: {self.hint}" if self.hint else message

    def summary(self) -> dict[str, Any]:
        """Return plain data (an entry of ``"problems"`` or ``"warnings"`` in ``--json``)."""
        plain = {"severity": self.severity, "where": self.where, "what": self.what}
        place = {} if self.at is None else {"at": list(self.at)}
        return {**plain, "try": self.hint, **place}


def near(at: tuple[float, float, float]) -> str:
    """Format a position in the coordinates of the design.

    Examples
    --------
    >>> near((0.01, 0.0, 0.0225))
    'near (10, 0, 22.5) mm'
    """
    return f"near ({', '.join(f'{1e3 * value:.4g}' for value in at)}) mm"
