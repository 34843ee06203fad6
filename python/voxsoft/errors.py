"""The exception tree: every error VoxSoft raises on purpose is a :class:`VoxSoftError`.

A message says where (part, shape, parameter), what came, what is allowed and what to try.
Errors that correspond to a standard exception inherit it too, so ``except ValueError`` works.
"""

from __future__ import annotations


class VoxSoftError(Exception):
    """Base of all errors raised by VoxSoft.

    Parameters
    ----------
    where
        The place: ``"parts[0].material"``, ``"beam.toml, line 7"``.
    what
        What came and what is allowed.
    hint
        What to try, in plain words; may be empty.

    Examples
    --------
    >>> str(VoxSoftError("wall", "-2 mm is negative", "give a positive length"))
    'wall: -2 mm is negative. Try: give a positive length'
    """

    def __init__(self, where: str, what: str = "", hint: str = "") -> None:
        self.where, self.what, self.hint = where, what, hint
        super().__init__(where, what, hint)

    def __str__(self) -> str:
        message = f"{self.where}: {self.what}" if self.what else self.where
        return f"{message}. Try: {self.hint}" if self.hint else message


class UnitError(VoxSoftError, ValueError):
    """A missing unit, an unknown unit, or a unit of the wrong kind."""


class FormulaError(VoxSoftError, ValueError):
    """A formula that cannot be read, names something unknown, or runs in a circle."""


class DesignError(VoxSoftError, ValueError):
    """A design that is not valid: unknown key, impossible size, missing clamp, ..."""


class ShapeError(VoxSoftError, ValueError):
    """A shape that cannot be built or sampled."""


class VoxelError(VoxSoftError, ValueError):
    """A voxel grid that cannot be made or changed as asked."""


class MeshError(VoxSoftError, ValueError):
    """A mesh that cannot be built, read or used."""


class MaterialError(VoxSoftError, ValueError):
    """An unknown material card or impossible constants."""


class MeasurementError(VoxSoftError, ValueError):
    """Measured data that cannot be used: wrong unit, NaN, too few stations."""


class SimulationError(VoxSoftError, RuntimeError):
    """A simulation that could not be set up or run."""


class StudyError(VoxSoftError, RuntimeError):
    """A study that could not be set up, stored or resumed."""


class FileError(VoxSoftError, OSError):
    """A file that is missing, unreadable, truncated or cannot be written."""

    def __str__(self) -> str:
        return VoxSoftError.__str__(self)


class MissingPackageError(VoxSoftError, ImportError):
    """An optional package that is not installed; the message holds the pip command."""
