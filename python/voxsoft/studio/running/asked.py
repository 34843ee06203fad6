"""Conversion of a tab's request for a job to the spec of that job."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from voxsoft.jobs import CalibrateSpec, DesignSource, MeasuredTable, RunSpec, Spec, StudySpec
from voxsoft.studio.protocol import commands

Asked = commands.RunSpec | commands.StudySpec | commands.CalibrateSpec


def spec_of(asked: Asked, design: DesignSource, tables: Sequence[MeasuredTable]) -> Spec:
    """Make the spec of a job.

    Parameters
    ----------
    asked
        Command of the tab.
    design
        The design as it stands in the editor.
    tables
        The measured tables of a calibration, mapped.

    Raises
    ------
    StudyError
        A range or a target that cannot be.
    """
    fields = msgspec.to_builtins(asked)
    given = {key: value for key, value in fields.items() if value is not None}
    for key in ("kind", "name", "data"):
        given.pop(key, None)
    match asked:
        case commands.RunSpec():
            return RunSpec(design=design, **given)
        case commands.StudySpec():
            if asked.sampler == "grid":
                given.pop("budget")
            return StudySpec(design=design, **given)
        case commands.CalibrateSpec():
            return CalibrateSpec(design=design, data=tables, **given)
