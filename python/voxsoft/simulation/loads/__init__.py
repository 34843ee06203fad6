"""Actions of each kind of load on a body: the one place that distinguishes kinds of loads."""

from voxsoft.simulation.loads.actions import Action, LoadReceiver
from voxsoft.simulation.loads.kind import LoadedBody, LoadKind, LoadReading
from voxsoft.simulation.loads.kinds import KINDS
from voxsoft.simulation.loads.resolve import ResolvedLoad, read, readings, resolve
from voxsoft.simulation.loads.undefined import undefined_in_words, undefined_past

__all__ = [
    "KINDS",
    "Action",
    "LoadKind",
    "LoadReading",
    "LoadReceiver",
    "LoadedBody",
    "ResolvedLoad",
    "read",
    "readings",
    "resolve",
    "undefined_in_words",
    "undefined_past",
]
