"""Random shapes from a grammar of every kind and operator, for tests and studies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np

from voxsoft.shapes.base import Shape, Triple
from voxsoft.shapes.catalog import KINDS
from voxsoft.shapes.primitives import Box

Rng = np.random.Generator
Fields = dict[str, Any]
T = TypeVar("T")

_EXPRESSIONS = (
    "x^2 + y^2 + z^2 - {r}^2",
    "sqrt(x^2 + y^2) - {r}/2 + {r}/8*sin(z*30)",
    "max(abs(x) + abs(y), abs(z)) - {r}",
    "hypot(x - {r}/2, y) - {r}/2 - abs(z)/4",
)


def random_shape(rng: Rng | int, depth: int = 3, size: float = 0.05) -> Shape:
    """Return a random shape of finite extent; the same seed gives the same shape.

    Parameters
    ----------
    rng : numpy.random.Generator or int
        Random generator, or its seed.
    depth : int, default 3
        Most operators from the shape down to a primitive.
    size : float, default 0.05
        Half edge of a cube around the origin that contains the shape [m].

    Returns
    -------
    Shape
        A valid shape; it may enclose nothing.

    Examples
    --------
    >>> random_shape(1) == random_shape(1)
    True
    """
    source = np.random.default_rng(rng)
    limit = Box(size=(2 * size,) * 3, center=(0, 0, 0))
    return limit & _grow(source, depth, size)


def _grow(rng: Rng, depth: int, size: float) -> Shape:
    if depth == 0 or rng.random() < 0.2:
        kind = _pick(rng, list(_PRIMITIVES))
        return _make(kind, _PRIMITIVES[kind](rng, size))
    kind = _pick(rng, list(_OPERATORS))
    fields = _OPERATORS[kind](rng, size)
    if kind == "grade":
        lattice = _make(_pick(rng, _PERIODIC), _sheet(rng, size))
        return _make(kind, {"of": lattice, **fields})
    operand = _grow(rng, depth - 1, size)
    if kind in _OF_TWO:
        return _make(kind, {"of": (operand, _grow(rng, depth - 1, size)), **fields})
    return _make(kind, {"of": operand, **fields})


def _make(kind: str, fields: Fields) -> Shape:
    return KINDS[kind](**fields)


def _pick(rng: Rng, choices: Sequence[T]) -> T:
    return choices[int(rng.integers(len(choices)))]


def _length(rng: Rng, size: float, low: float = 0.1, high: float = 1.0) -> float:
    return float(size * rng.uniform(low, high))


def _lengths(rng: Rng, size: float) -> Triple:
    return _length(rng, size), _length(rng, size), _length(rng, size)


def _point(rng: Rng, size: float) -> Triple:
    x, y, z = rng.uniform(-0.5 * size, 0.5 * size, 3).tolist()
    return x, y, z


def _axis(rng: Rng) -> str | Triple:
    if rng.random() < 0.5:
        return _pick(rng, "xyz")
    x, y, z = rng.normal(size=3).tolist()
    return x, y, z


def _angle(rng: Rng) -> float:
    return float(rng.uniform(-np.pi, np.pi))


def _ring(rng: Rng, size: float) -> list[tuple[float, float]]:
    angles = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(3, 8))))
    radii = rng.uniform(0.2 * size, size, len(angles))
    return [
        (float(r * np.cos(a)), float(r * np.sin(a))) for r, a in zip(radii, angles, strict=True)
    ]


def _upright(rng: Rng, size: float) -> Fields:
    return {"base": _point(rng, size), "axis": _axis(rng), "height": _length(rng, size)}


def _sheet(rng: Rng, size: float) -> Fields:
    return {"period": _length(rng, size, 0.3, 1.0), "thickness": _length(rng, size, 0.03, 0.2)}


def _sheet_or_solid(rng: Rng, size: float) -> Fields:
    if rng.random() < 0.5:
        return _sheet(rng, size)
    level = float(rng.uniform(-0.9, 0.9))
    return {"period": _length(rng, size, 0.3, 1.0), "form": "solid", "level": level}


_PERIODIC = ("gyroid", "schwarz-p", "schwarz-d", "neovius", "iwp", "cubic", "bcc", "fcc", "octet")
_OF_TWO = ("union", "intersection", "difference", "blend")

_PRIMITIVES: dict[str, Callable[[Rng, float], Fields]] = {
    "box": lambda r, s: {"size": _lengths(r, s), "center": _point(r, s)},
    "rounded-box": lambda r, s: {
        "size": _lengths(r, s),
        "corner": _point(r, s),
        "radius": _length(r, s, 0.01, 0.05),
    },
    "sphere": lambda r, s: {"radius": _length(r, s), "center": _point(r, s)},
    "ellipsoid": lambda r, s: {"radii": _lengths(r, s), "center": _point(r, s)},
    "cylinder": lambda r, s: {"radius": _length(r, s), **_upright(r, s)},
    "tube": lambda r, s: {
        "radius": _length(r, s, 0.5),
        "wall": _length(r, s, 0.05, 0.4),
        **_upright(r, s),
    },
    "cone": lambda r, s: {
        "radius": _length(r, s),
        "top_radius": _length(r, s, 0.0, 0.5),
        **_upright(r, s),
    },
    "capsule": lambda r, s: {
        "start": _point(r, s),
        "end": _point(r, s),
        "radius": _length(r, s, 0.05, 0.3),
    },
    "torus": lambda r, s: {
        "radius": _length(r, s, 0.4),
        "tube_radius": _length(r, s, 0.05, 0.3),
        "center": _point(r, s),
        "axis": _axis(r),
    },
    "half-space": lambda r, s: {"point": _point(r, s), "normal": _axis(r)},
    "prism": lambda r, s: {"points": _ring(r, s), **_upright(r, s)},
    "revolve": lambda r, s: {
        "points": [(0, 0), (_length(r, s), 0), (_length(r, s), _length(r, s))],
        "base": _point(r, s),
        "axis": _axis(r),
    },
    "expression": lambda r, s: {"text": _pick(r, _EXPRESSIONS).format(r=_length(r, s))},
    **dict.fromkeys(_PERIODIC[:5], _sheet_or_solid),
    **dict.fromkeys(_PERIODIC[5:], _sheet),
}

_OPERATORS: dict[str, Callable[[Rng, float], Fields]] = {
    **{
        kind: lambda r, s: {"smooth": 0.0 if r.random() < 0.5 else _length(r, s, 0.02, 0.3)}
        for kind in _OF_TWO[:3]
    },
    "blend": lambda r, s: {"weight": float(r.random()) if r.random() < 0.5 else "0.5 + 10*x"},
    "grade": lambda r, s: {
        "thickness": f"{_length(r, s, 0.03, 0.1)} + 0.05*abs(z)",
        "period": f"{_length(r, s, 0.3, 1.0)} + 0.1*x" if r.random() < 0.5 else None,
    },
    "offset": lambda r, s: {"distance": _length(r, s, -0.1, 0.1)},
    "shell": lambda r, s: {"thickness": _length(r, s, 0.05, 0.3)},
    "translate": lambda r, s: {"by": _point(r, s)},
    "rotate": lambda r, s: {"angle": _angle(r), "axis": _axis(r), "center": _point(r, s)},
    "scale": lambda r, s: {"factor": tuple(r.uniform(0.5, 1.5, 3).tolist())},
    "mirror": lambda r, s: {
        "normal": _axis(r),
        "point": _point(r, s),
        "keep": bool(r.random() < 0.5),
    },
    "array": lambda r, s: {
        "count": tuple(r.integers(1, 4, 3).tolist()),
        "spacing": _lengths(r, s),
    },
    "polar-array": lambda r, s: {"count": int(r.integers(1, 7)), "axis": _axis(r)},
    "twist": lambda r, s: {"angle": _angle(r), "height": 2 * s, "axis": _axis(r)},
    "bend": lambda r, s: {
        "radius": _length(r, s, 0.5, 3.0),
        **dict(zip(("axis", "toward"), r.permutation(["x", "y", "z"]).tolist(), strict=False)),
    },
    "taper": lambda r, s: {
        "factor": float(r.uniform(0.3, 1.5)),
        "height": _length(r, s),
        "axis": _axis(r),
    },
}
