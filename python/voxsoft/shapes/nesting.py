"""Nesting of the closed shells of a triangle surface: which of them enclose material.

A shell is a closed, connected surface. Outermost shells enclose material, whichever side
their faces were on. A shell within another encloses a void where it faces the other way than the
outermost one around it, and material where it faces likewise; or, by `nested = "void"`, material
and voids alternate by depth. A shell with the same content as the one around it is left
out. So the winding number of the remaining shells is one in material and zero in voids.
"""

from __future__ import annotations

from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft._components import components

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Nested = Literal["solid", "void"]

#: Most triangles of a shell that are looked up in another one.
_SAMPLES: Final = 128
#: Thresholds of the winding number on the two sides of a face, with the error of the fast sum.
_OUTSIDE, _INSIDE = 0.25, 0.75
#: Volume, as a part of the cube around the surface, below which a shell is flat and encloses
#: nothing.
_FLAT: Final = 1e-12


class Nest(NamedTuple):
    """Closed shells that can be read in two ways.

    Attributes
    ----------
    shells
        Number of closed shells of the surface.
    inverted
        Number of outermost shells that faced inward, where others do not; they were turned outward.
    alike
        Number of shells within another of the same sense.
    center
        Center of the largest of those.
    solid, hollow
        Volume of the material around them when such shells enclose no void, and when material
        and voids alternate by depth.
    """

    shells: int = 0
    inverted: int = 0
    alike: int = 0
    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    solid: float = 0.0
    hollow: float = 0.0


def taken_once(triangles: Indices) -> tuple[Indices, int]:
    """Keep repeated faces once, and remove walls between two bodies.

    Connected faces that all occur twice are a wall where others begin at their rim, as two bodies
    that meet there have one each. Without such a rim the body was written twice.

    Returns
    -------
    triangles : ndarray, shape (t, 3)
    doubled : int
        Number of faces of bodies that were written twice with opposite sense.

    Examples
    --------
    >>> tet = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    >>> found, doubled = taken_once(np.vstack([tet, tet[:, ::-1]]))
    >>> len(found), doubled
    (4, 4)
    """
    _, first, same, uses = np.unique(
        np.sort(triangles, axis=1),
        axis=0,
        return_index=True,
        return_inverse=True,
        return_counts=True,
    )
    if len(first) == len(triangles):
        return triangles, 0
    kept = triangles[first]
    edge, _ = _edges(kept)
    others = np.bincount(edge)[edge]
    patch = _joined(kept, others == 2)
    is_twice: NDArray[np.bool_] = np.bincount(patch, weights=uses % 2)[patch] == 0
    has_rim = np.bincount(patch, weights=(others > 2).reshape(-1, 3).sum(axis=1))[patch] > 0
    senses = np.bincount(same.reshape(-1), weights=_parity(triangles))
    doubled = int(np.count_nonzero(is_twice & ~has_rim & (senses == 0.0)))
    return np.ascontiguousarray(kept[~(is_twice & has_rim)]), doubled


def unnested(
    points: Floats, triangles: Indices, nested: Nested | None = None
) -> tuple[Indices, Nest]:
    """Turn closed shells outward around material and inward around voids.

    Parameters
    ----------
    points
        Vertices, (n, 3).
    triangles
        Vertices of each triangle, (t, 3); neighbors agree on which side is outside.
    nested
        ``"void"`` for material and voids that alternate by depth; else the sense of each shell
        decides.

    Returns
    -------
    triangles : ndarray, shape (k, 3)
        Triangles, without shells of the same content as the one around them.
    nest : Nest

    Examples
    --------
    >>> tet = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    >>> outer = 6.0 * np.vstack([np.zeros(3), np.eye(3)])
    >>> points = np.vstack([outer, 1.0 + outer / 6.0])
    >>> found, nest = unnested(points, np.vstack([tet, tet + 4]))
    >>> len(found), nest.alike, round(nest.solid, 3), round(nest.hollow, 3)
    (4, 1, 36.0, 35.833)
    """
    label = _shells(points, triangles)
    count = int(label.max(initial=-1)) + 1
    if not count:
        return triangles, Nest()
    volume = _volumes(points, triangles, label)
    parent = _parents(points, triangles, label, np.abs(volume))
    order = np.argsort(-np.abs(volume), kind="stable")
    root, depth = np.arange(count), np.zeros(count, dtype=np.int64)
    solid = np.ones(count, dtype=bool)
    for shell in order:
        around = parent[shell]
        if around >= 0:
            root[shell], depth[shell] = root[around], depth[around] + 1
            solid[shell] = volume[shell] * volume[root[shell]] > 0.0
    alternating = depth % 2 == 0
    alike = (parent >= 0) & (solid == solid[parent])
    nest = _nest(points, triangles, label, volume, root, alike & (parent >= 0))
    if alike.any():
        of = np.isin(root, root[alike])
        nest = nest._replace(
            solid=_material(volume, parent, solid, of),
            hollow=_material(volume, parent, alternating, of),
        )
    if nested == "void":
        solid = alternating
    needless = (parent >= 0) & (solid == solid[parent])
    turn = (volume > 0.0) != solid
    of_shell = np.maximum(label, 0)
    is_turned = (label >= 0) & turn[of_shell]
    found = np.where(is_turned[:, None], triangles[:, ::-1], triangles)
    return np.ascontiguousarray(found[(label < 0) | ~needless[of_shell]]), nest


def _nest(
    points: Floats,
    triangles: Indices,
    label: Indices,
    volume: Floats,
    root: Indices,
    alike: NDArray[np.bool_],
) -> Nest:
    count = len(volume)
    inward = volume[root == np.arange(count)] < 0.0
    inverted = 0 if inward.all() else int(inward.sum())
    if not alike.any():
        return Nest(count, inverted)
    largest = int(np.argmax(np.where(alike, np.abs(volume), -1.0)))
    corners = points[triangles[label == largest].reshape(-1)]
    x, y, z = ((corners.min(axis=0) + corners.max(axis=0)) / 2.0).tolist()
    return Nest(count, inverted, int(alike.sum()), (x, y, z))


def _material(
    volume: Floats, parent: Indices, solid: NDArray[np.bool_], of: NDArray[np.bool_]
) -> float:
    """Sum the volume of material of some nests: a shell counts if it changes the content."""
    around = (parent >= 0) & solid[parent]
    change = solid.astype(np.float64) - around
    return float((np.abs(volume) * change)[of].sum())


def _parity(triangles: Indices) -> Floats:
    """Return 1 where the corners of a triangle rise in its sense, -1 where they fall."""
    a, b, c = triangles.T
    return np.where(((a < b).astype(int) + (b < c) + (c < a)) == 2, 1.0, -1.0)


def _edges(triangles: Indices) -> tuple[Indices, NDArray[np.int64]]:
    """Return the number of each triangle's edges, and the sense in which it runs along them."""
    ends = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, edge = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    return edge.reshape(-1).astype(np.int64), np.where(ends[:, 0] < ends[:, 1], 1, -1)


def _joined(triangles: Indices, through: NDArray[np.bool_]) -> Indices:
    """Number triangles by their component, connected through some of their edges, (t,)."""
    edge, _ = _edges(triangles)
    face = np.repeat(np.arange(len(triangles)), 3)
    size = len(triangles) + int(edge.max(initial=-1)) + 1
    label = components(face[through], edge[through] + len(triangles), size)
    _, number = np.unique(label[: len(triangles)], return_inverse=True)
    return number.reshape(-1).astype(np.int64)


def _shells(points: Floats, triangles: Indices) -> Indices:
    """Number the closed shells: label of each triangle, -1 where it belongs to none, (t,).

    Components that end at edges of three or more faces are joined with their neighbors there.
    """
    edge, sense = _edges(triangles)
    face = np.repeat(np.arange(len(triangles)), 3)
    pairs = np.bincount(edge)[edge] == 2
    label = _joined(triangles, pairs)
    label = _joined(triangles, pairs | _is_open(label, face, edge, sense)[label[face]])
    volume = _volumes(points, triangles, label)
    extent = np.ptp(points[triangles.reshape(-1)], axis=0).max()
    unfit = _is_open(label, face, edge, sense) | (np.abs(volume) <= _FLAT * extent**3)
    return np.where(unfit, -1, np.cumsum(~unfit) - 1)[label]


def _is_open(
    label: Indices, face: Indices, edge: Indices, sense: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Return True for each component whose faces leave an edge unbalanced."""
    count = int(edge.max()) + 1
    _, index = np.unique(label[face] * count + edge, return_inverse=True)
    balance = np.bincount(index.reshape(-1), weights=sense)
    is_open = np.zeros(int(label.max()) + 1, dtype=bool)
    is_open[label[face[balance[index.reshape(-1)] != 0.0]]] = True
    return is_open


def _volumes(points: Floats, triangles: Indices, label: Indices) -> Floats:
    """Return the volume of each shell, negative where it faces inward."""
    a, b, c = (points[triangles[:, corner]] - points[triangles[0, 0]] for corner in range(3))
    own = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    of = label >= 0
    return np.bincount(label[of], weights=own[of]).astype(np.float64)


def _parents(points: Floats, triangles: Indices, label: Indices, volume: Floats) -> Indices:
    """Find the smallest shell around each shell, -1 for none, (s,)."""
    import igl

    count = len(volume)
    faces = np.argsort(label, kind="stable")
    faces = faces[label[faces] >= 0]
    start = np.searchsorted(label[faces], np.arange(count + 1))
    own = [faces[start[shell] : start[shell + 1]] for shell in range(count)]
    low = np.array([points[triangles[each]].min(axis=(0, 1)) for each in own])
    high = np.array([points[triangles[each]].max(axis=(0, 1)) for each in own])
    parent = np.full(count, -1, dtype=np.int64)
    for around in np.argsort(-volume, kind="stable"):
        boxed = (low >= low[around]).all(axis=1) & (high <= high[around]).all(axis=1)
        inner = np.flatnonzero(boxed & (volume < volume[around]))
        if not len(inner):
            continue
        some = [own[shell][:: -(-len(own[shell]) // _SAMPLES)] for shell in inner]
        first = np.cumsum([0, *(len(each) for each in some[:-1])])
        places = points[triangles[np.concatenate(some)]].mean(axis=1)
        tree = igl.FastWindingNumberBVH()
        tree.init(points, np.ascontiguousarray(triangles[own[around]]))
        wound = np.abs(np.atleast_1d(tree.winding_number(np.ascontiguousarray(places))))
        least, most = np.minimum.reduceat(wound, first), np.maximum.reduceat(wound, first)
        parent[inner[(least > _OUTSIDE) & (most > _INSIDE)]] = around
    return parent
