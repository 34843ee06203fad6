"""The design that a job is of, by which the page tells it from those of other designs."""

from __future__ import annotations

from voxsoft.errors import VoxSoftError
from voxsoft.jobs import Spec
from voxsoft.studio.protocol import events


def subject_of(spec: Spec, job: str, document: str = "") -> events.Subject | None:
    """Name the design of a job; None where it cannot be read.

    Parameters
    ----------
    spec
        The job.
    job
        Its name.
    document
        Id of the document that it was started from; empty for a job of an earlier studio.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.jobs import DesignSource, RunSpec
    >>> beam = families.beam()
    >>> found = subject_of(RunSpec(design=DesignSource.of_design(beam)), "beam-run")
    >>> found.design, found.hash == beam.hash
    ('beam', True)
    """
    try:
        design = spec.design.read()
        return events.Subject(job=job, document=document, design=design.name, hash=design.hash)
    except VoxSoftError:
        return None
