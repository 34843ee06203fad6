"""Observations as bytes: all that a motion goes on from, to the same bits in another process."""

from __future__ import annotations

import json
from io import BytesIO
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from voxsoft._core import __version__
from voxsoft.errors import SimulationError
from voxsoft.simulation.runs.drives import Value
from voxsoft.simulation.runs.sensors import SensorState

if TYPE_CHECKING:
    from voxsoft.simulation.runs.observation import Observation, Subject

_VERSION: Final = "voxsoft"
#: Numbers of an observation itself, by their attributes.
_NUMBERS: Final = ("steps", "status", "message", "elastic_energy", "kinetic_energy")


def observation_bytes(seen: Observation) -> bytes:
    """Return an observation as the content of an ``.npz`` file.

    It holds ``text``, JSON with all numbers and words, the hash of the design and the version of
    VoxSoft; ``positions``, ``velocities`` (n, 3), objects included, and ``before`` (n, 3), those a
    step ago, where there is one, m and m/s; and ``memory``, bytes of the core.

    Parameters
    ----------
    seen
        The observation.

    Raises
    ------
    DesignError
        The design is made of a Python function and has no hash.
    """
    subject, moment, driven = seen._subject, seen._moment, seen._driven
    text = {
        _VERSION: __version__,
        "design": subject.setup.design.hash,
        "time_step": subject.step,
        **{name: getattr(seen, name) for name in _NUMBERS},
        "moment": {"time": moment.time, "residual": moment.residual},
        "driven": {
            "values": driven.values,
            "memories": driven.memories,
            "following": sorted(driven.following),
            "moving": sorted(driven.moving),
            "late": driven.late,
            "work": dict(driven.work),
            "power": driven.power,
            "seed": driven.seed,
        },
        "sensors": {name: sample.tolist() for name, sample in seen.sensors.items()},
        "sensing": {
            "generator": dict(driven.sensors.generator),
            "drifts": [each.tolist() for each in driven.sensors.drifts],
            "late": [[each.tolist() for each in queue] for queue in driven.sensors.late],
        },
    }
    arrays: dict[str, Any] = {
        # Numbers as Python writes them are read back to the last bit, infinity too.
        "text": np.array(json.dumps(text)),
        "positions": moment.positions,
        "velocities": moment.velocities,
        "memory": np.frombuffer(moment.memory.bytes(), dtype=np.uint8),
    }
    if seen._before is not None:
        arrays["before"] = seen._before
    content = BytesIO()
    np.savez(content, **arrays)
    return content.getvalue()


def observation_from(content: bytes, subject: Subject) -> Observation:
    """Restore an observation that :func:`observation_bytes` gave.

    Parameters
    ----------
    content
        The bytes.
    subject
        Body of a simulator of the same design.

    Raises
    ------
    SimulationError
        They are damaged, or of another design, time step or version of VoxSoft.
    """
    from voxsoft.simulation.runs.observation import Driven, Moment, Observation

    try:
        with np.load(BytesIO(content), allow_pickle=False) as arrays:
            found: dict[str, NDArray[Any]] = dict(arrays)
        text = json.loads(str(found["text"]))
        if text[_VERSION] != __version__:
            raise _unreadable(f"are of VoxSoft {text[_VERSION]}, and this is {__version__}")
        if text["design"] != subject.setup.design.hash:
            raise _unreadable("are of another design")
        if text["time_step"] != subject.step:
            raise _unreadable(f"are of steps of {text['time_step']:g} s, not {subject.step:g} s")
        driven, sensing = text["driven"], text["sensing"]
        return Observation.of(
            subject,
            Moment(
                positions=found["positions"],
                velocities=found["velocities"],
                memory=subject.problem.read_memory(found["memory"].tobytes()),
                **text["moment"],
            ),
            Driven(
                **driven
                | {
                    "values": tuple(_value(each) for each in driven["values"]),
                    "memories": tuple(driven["memories"]),
                    "following": frozenset(driven["following"]),
                    "moving": frozenset(driven["moving"]),
                    "work": MappingProxyType(driven["work"]),
                },
                sensors=SensorState(
                    generator=sensing["generator"],
                    drifts=tuple(np.array(each) for each in sensing["drifts"]),
                    late=tuple(
                        tuple(np.array(each) for each in queue) for queue in sensing["late"]
                    ),
                ),
            ),
            before=found.get("before"),
            sensors=MappingProxyType({k: np.array(each) for k, each in text["sensors"].items()}),
            **{name: text[name] for name in _NUMBERS},
        )
    except (BadZipFile, OSError, EOFError, ValueError, KeyError, TypeError) as error:
        raise _unreadable(f"are damaged: {error}") from None


def _value(stored: Any) -> Value:  # noqa: ANN401 - from JSON
    if isinstance(stored, list):
        x, y, z = stored
        return x, y, z
    return float(stored)


def _unreadable(what: str) -> SimulationError:
    hint = "restore bytes of the same design, settings and version of VoxSoft"
    return SimulationError("state", f"its bytes {what}", hint)
