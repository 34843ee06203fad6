"""Frames as the page reads them: positions and one field, sixteen bits each."""

from __future__ import annotations

import struct
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.studio.wire import MAGIC, MessageKind

Floats = NDArray[np.float64]

_STEPS: Final = 65_535


def pack_points(
    points: Floats,
    values: Floats,
    *,
    topology: int,
    frame: int,
    time: float,
    seq: int,
    field: int,
    flags: int,
) -> bytes:
    """Write a frame of given points; the core does the same for the surface of a body it moves.

    Parameters
    ----------
    points
        Positions [m], (n, 3); what is not finite is written as the lowest corner.
    values
        The field, (n,), SI.
    topology, frame, time, seq, field, flags
        What the header says.

    Examples
    --------
    >>> packed = pack_points(
    ...     np.eye(3), np.arange(3.0), topology=1, frame=0, time=0.0, seq=0, field=0, flags=1
    ... )
    >>> len(packed)
    88
    """
    origin, scale = _range(points, axis=0)
    low, span = _range(values[:, None], axis=0)
    packed = np.zeros((len(points), 4), dtype="<u2")
    packed[:, :3] = _quantized(points, origin, scale)
    packed[:, 3:] = _quantized(values[:, None], low, span)
    head = struct.pack(
        "<IBBHIIdII3f3f2f",
        MAGIC,
        MessageKind.FRAME,
        flags,
        field,
        topology,
        frame & 0xFFFF_FFFF,
        time,
        len(points),
        seq & 0xFFFF_FFFF,
        *origin,
        *scale,
        float(low[0]),
        float(low[0] + span[0]),
    )
    return head + packed.tobytes()


def value_at(packed: bytes, point: int) -> float:
    """Read the field of one point out of a frame.

    Examples
    --------
    >>> packed = pack_points(
    ...     np.eye(3), np.arange(3.0), topology=1, frame=0, time=0.0, seq=0, field=0, flags=1
    ... )
    >>> value_at(packed, 2)
    2.0
    """
    low, high = struct.unpack_from("<2f", packed, 56)
    (step,) = struct.unpack_from("<H", packed, 64 + 8 * point + 6)
    return float(low + (high - low) * step / _STEPS)


def _range(values: Floats, axis: int) -> tuple[Floats, Floats]:
    finite = np.where(np.isfinite(values), values, 0.0)
    if not len(values):
        return np.zeros(values.shape[1]), np.zeros(values.shape[1])
    low = finite.min(axis=axis).astype(np.float32).astype(np.float64)
    return low, finite.max(axis=axis) - low


def _quantized(values: Floats, low: Floats, span: Floats) -> NDArray[np.uint16]:
    share = np.divide(values - low, span, out=np.zeros_like(values), where=span > 0)
    share = np.where(np.isfinite(share), share, 0.0)
    steps: NDArray[np.uint16] = np.rint(np.clip(share, 0.0, 1.0) * _STEPS).astype(np.uint16)
    return steps
