"""Scope of labels in Abaqus input: a flat model, a part or an instance."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats.abaqus_cards import Card
from voxsoft.formats.contents import CORNERS, CellBlock
from voxsoft.formats.placing import Placing

#: Members of a set: labels, or names of sets.
Members = Sequence[int | str]


class Scope:
    """Nodes, elements and sets that share their labels."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.placing = Placing()
        self.is_used = False
        self.labels: dict[int, int] = {}
        self.points: list[NDArray[np.float64]] = []
        self.cell_of: dict[int, int] = {}
        self.cells: list[tuple[str, list[list[int]], str]] = []
        self.sets: dict[str, dict[str, list[int | str]]] = {"node": {}, "element": {}}
        self.shown: dict[tuple[str, str], str] = {}
        self.sections: list[str] = []
        self.missing: set[str] = set()
        self.first_point = self.first_cell = 0

    def add(self, part: Scope) -> None:
        """Copy all contents of a part."""
        self.labels, self.points = dict(part.labels), [each.copy() for each in part.points]
        self.cell_of, self.cells = dict(part.cell_of), list(part.cells)
        self.sets = {k: {n: list(m) for n, m in s.items()} for k, s in part.sets.items()}
        self.shown, self.sections = dict(part.shown), list(part.sections)

    def add_nodes(self, labels: list[int], points: NDArray[np.float64]) -> int:
        """Add nodes; move those that exist. Return the number of moved ones."""
        again = 0
        for label, point in zip(labels, points, strict=True):
            if label in self.labels:
                self.points[self.labels[label]] = point
                again += 1
            else:
                self.labels[label] = len(self.points)
                self.points.append(point)
        return again

    def add_elements(self, card: Card, kind: str) -> list[int]:
        """Add elements of a card, whose rows may run over several lines; return their labels."""
        count = _nodes_of(kind)
        labels, rows, row = [], [], list[int]()
        for fields in card.data:
            row += card.labels(fields)
            if len(row) > count:
                label, nodes = row[0], row[1:]
                if len(nodes) > count:
                    what = f"element {label} has {len(nodes)} nodes; {card.get('TYPE')} has {count}"
                    raise FileError(card.where, what)
                if label in self.cell_of:
                    what = f"element {label} stands twice"
                    raise FileError(card.where, what, "number elements once in each part")
                self.cell_of[label] = len(self.cell_of)
                labels.append(label)
                rows.append(nodes)
                row = []
        if row:
            what = f"element {row[0]} has {len(row) - 1} nodes; {card.get('TYPE')} has {count}"
            raise FileError(card.where, what, "check that the file is complete")
        self.cells.append((kind, rows, card.where))
        return labels

    def extend(self, kind: str, name: str, members: Members) -> None:
        """Add members to a set."""
        self.shown.setdefault((kind, name.upper()), name)
        self.sets[kind].setdefault(name.upper(), []).extend(members)

    def placed_points(self) -> NDArray[np.float64]:
        """Return the nodes at the position of the scope, (n, 3)."""
        return self.placing.placed(np.array(self.points).reshape(-1, 3))

    def blocks(self) -> Iterator[CellBlock]:
        """Yield the cells, with nodes as numbers of points of the contents.

        Raises
        ------
        FileError
            If an element names a node that is missing.
        """
        for kind, rows, where in self.cells:
            try:
                nodes = [[self.labels[label] for label in row] for row in rows]
            except KeyError as error:
                raise FileError(where, f"an element has node {error}, which is missing") from None
            shape = (len(rows), _nodes_of(kind))
            yield CellBlock(kind, np.array(nodes, np.int64).reshape(shape) + self.first_point)

    def members(
        self, kind: str, name: str, known: Mapping[str, Scope], inside: tuple[str, ...] = ()
    ) -> NDArray[np.int64]:
        """Return points or cells of a set, as numbers of the contents; sets in it included."""
        if name in inside:
            raise FileError(self.name or "sets", f"set {name} holds itself")
        found: list[NDArray[np.int64]] = []
        numbers: list[int] = []
        for each in self.sets[kind].get(name, ()):
            scope, key = self._resolved(each, known)
            number = scope.number(kind, key)
            if number is not None:
                numbers.append(number)
            elif isinstance(key, str) and key.startswith("\0"):
                cells = scope.members("element", key[1:], known)
                found.append(_nodes_in(known.values(), cells))
            elif isinstance(key, str) and key in scope.sets[kind]:
                found.append(scope.members(kind, key, known, (*inside, name)))
            else:
                shown = self.shown[kind, name]
                self.missing.add(f"Set {shown} names {kind} or set {each}, which is missing")
        return np.concatenate([np.array(numbers, np.int64), *found])

    def _resolved(self, member: int | str, known: Mapping[str, Scope]) -> tuple[Scope, int | str]:
        """Return the scope of a member, and its label or the name of a set there."""
        if isinstance(member, int):
            return self, member
        mark, text = ("\0", member[1:]) if member.startswith("\0") else ("", member)
        owner, dot, rest = text.upper().partition(".")
        scope, key = (known[owner], rest) if dot and owner in known else (self, text.upper())
        return scope, int(key) if key.isdigit() else mark + key

    def number(self, kind: str, label: int | str) -> int | None:
        """Return the number of a node or element in the contents; None if there is none."""
        if isinstance(label, str):
            return None
        local = (self.labels if kind == "node" else self.cell_of).get(label)
        first = self.first_point if kind == "node" else self.first_cell
        return None if local is None else local + first


def _nodes_in(scopes: Iterable[Scope], cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the points of cells of the contents."""
    found: list[NDArray[np.int64]] = [np.empty(0, np.int64)]
    for scope in scopes:
        first = scope.first_cell
        for block in scope.blocks():
            inside = cells[(cells >= first) & (cells < first + len(block.nodes))] - first
            found.append(block.nodes[inside].ravel())
            first += len(block.nodes)
    return np.concatenate(found)


def _nodes_of(kind: str) -> int:
    """Return the number of nodes of a cell of a kind."""
    return CORNERS.get(kind) or int(kind.lstrip("abcdefghijklmnopqrstuvwxyz"))
