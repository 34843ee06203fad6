"""Tested range: the stretches of the specimens behind a material's constants."""

from __future__ import annotations

from typing import Annotated, ClassVar, Self

from pydantic import model_validator

from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.records import Record
from voxsoft.units import UnitOf


class StretchRange(Record):
    """The stretches (length over original length) between which a material was tested.

    Parameters
    ----------
    largest
        Largest stretch of specimens in tension, 1 or more.
    smallest
        Smallest stretch in compression, above 0 and at most 1, if they were pressed.

    Examples
    --------
    >>> StretchRange(largest=4.0).smallest is None
    True
    >>> StretchRange(largest=0.5)
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: largest: 0.5 is below 1. Try: a stretch is 1 plus the strain, \
1.5 for a specimen that was made half as long again
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    largest: Annotated[float, UnitOf("number", positive=True)]
    smallest: Annotated[float, UnitOf("number", positive=True)] | None = None

    @model_validator(mode="after")
    def _around_one(self) -> Self:
        if self.largest < 1.0:
            raise MaterialError(
                "largest",
                f"{self.largest:g} is below 1",
                "a stretch is 1 plus the strain, 1.5 for a specimen that was made half as long "
                "again",
            )
        if self.smallest is not None and self.smallest > 1.0:
            raise MaterialError(
                "smallest", f"{self.smallest:g} is above 1", "leave it out, or give 0.8 for 20 %"
            )
        return self
