"""Abaqus and CalculiX input: nodes, elements and sets, of one flat model or of an assembly.

Sets are unions over their cards. Sets of a part exist in each of its instances, and are called
``instance.SET`` where another instance has the name too.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from itertools import chain, takewhile
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.errors import FileError
from voxsoft.formats.abaqus_cards import Card, cards_of
from voxsoft.formats.abaqus_elements import kind_of
from voxsoft.formats.abaqus_scope import Scope
from voxsoft.formats.contents import CellBlock, Contents
from voxsoft.formats.placing import Placing, local_system
from voxsoft.formats.region_names import names_in, objects_in, unit_in

#: First and last line of our own files, by which a file cut between two lines is recognized.
BEGIN: Final = "** VoxSoft mesh"
END: Final = "** end of VoxSoft mesh"
#: First and last line of our own files of whole computations.
BEGIN_COMPUTATION: Final = "** VoxSoft computation"
END_COMPUTATION: Final = "** end of VoxSoft computation"
_ENDS: Final = {BEGIN: END, BEGIN_COMPUTATION: END_COMPUTATION}
#: Sets of our own files that are no regions and no parts.
_OWN: Final = frozenset({"ALL-NODES", "ALL-ELEMENTS"})

#: Cards that make nodes, elements or positions by rules that are not read here.
_MAKERS: Final = {
    *("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "IMPORT", "MESHREFINEMENT", "PARAMETER"),
    *("SYMMETRICMODELGENERATION", "MODELCHANGE", "IMPERFECTION"),
}
#: Cards that only enclose others.
_FRAMES: Final = {
    *("HEADING", "PREPRINT", "ENDPART", "ASSEMBLY", "ENDASSEMBLY", "ENDINSTANCE", "SURFACE"),
}


def read(path: Path) -> Contents:
    """Read a file.

    Raises
    ------
    FileError
        For cards that cannot be followed, and missing labels, with file and line.
    """
    head = list(_head(path))
    end = _ENDS.get(head[0]) if head else None
    is_ours = end is not None
    if end is not None and not path.read_bytes().rstrip().endswith(end.encode()):
        raise FileError(str(path), "is cut short: its last line is missing", "write it again")
    model = _Model(path)
    if end == END_COMPUTATION:
        model.is_computation, model.objects = True, {name.upper() for name in objects_in(head)}
    for card in cards_of(path):
        model.take(card)
    names = names_in(head)
    contents = model.contents(names, _OWN if is_ours else frozenset())
    # Older files of ours do not name their unit, which is m.
    return replace(contents, unit=unit_in(head) or (1.0 if is_ours else None))


def _head(path: Path) -> Iterator[str]:
    """Return the comments at the beginning of a file."""
    with path.open(encoding="utf-8", errors="replace") as file:
        yield from takewhile(lambda line: line.startswith("**"), map(str.rstrip, file))


class _Model:
    """Model made of cards, one after the other."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.is_computation = False
        self.objects: set[str] = set()
        self.root = Scope("")
        self.scope = self.root
        self.parts: dict[str, Scope] = {}
        self.instances: dict[str, Scope] = {}
        self.local = Placing()
        self.passed: Counter[str] = Counter()
        self.surfaces: list[str] = []
        self.notes: list[str] = []

    def take(self, card: Card) -> None:
        """Add a card to the model."""
        if self.objects & {card.get(kind).upper() for kind in ("NSET", "ELSET")}:
            return  # a rigid object beside the body of one of our own files
        match card.name:
            case "PART":
                self.scope = self._new(self.parts, card)
            case "INSTANCE":
                self.scope = self._instance(card)
            case "ENDPART" | "ENDINSTANCE" | "ASSEMBLY" | "ENDASSEMBLY":
                self.scope, self.local = self.root, Placing()
            case "SYSTEM":
                self.local = local_system(card)
            case "NODE":
                self._nodes(card)
            case "ELEMENT":
                self._elements(card)
            case "NSET" | "ELSET":
                self._set(card)
            case "SOLIDSECTION" if card.get("ELSET"):
                self.scope.sections.append(card.get("ELSET"))
            case name if name in _MAKERS:
                what = f"*{name} makes or moves nodes or elements by a rule that is not read"
                hint = "write the deck with all nodes and elements listed"
                raise FileError(card.where, what, hint)
            case "SURFACE" if not self.is_computation:
                self.surfaces.append(card.get("NAME"))
            case name if name not in _FRAMES:
                self.passed[name] += 1

    def _new(self, known: dict[str, Scope], card: Card) -> Scope:
        name = card.get("NAME") or f"{card.name}-{len(known) + 1}"
        if name.upper() in known:
            raise FileError(card.where, f"*{card.name} {name} stands twice")
        known[name.upper()] = Scope(name)
        self.local = Placing()
        return known[name.upper()]

    def _instance(self, card: Card) -> Scope:
        wanted = card.get("PART").upper()
        if card.get("INSTANCE") or card.get("LIBRARY"):
            what = "*INSTANCE takes its place from another analysis, which is not read"
            raise FileError(card.where, what, "write the deck with the parts in it")
        if wanted and wanted not in self.parts:
            raise FileError(
                card.where, f"*INSTANCE names part {card.get('PART')}, which is missing"
            )
        scope = self._new(self.instances, card)
        scope.placing = Placing.of_instance(card)
        # Data of an instance are in the frame of the instance; cards of its own may follow.
        if wanted:
            scope.add(self.parts[wanted])
            self.parts[wanted].is_used = True
        return scope

    def _nodes(self, card: Card) -> None:
        system = card.get("SYSTEM").upper()[:1] or "R"
        if system not in "RC":
            raise FileError(card.where, f"*NODE, SYSTEM={system} is not read", "use R or C")
        rows = [card.numbers(row) for row in card.data]
        if any(len(row) < 2 for row in rows):
            raise FileError(card.where, "*NODE has a line without coordinates")
        if not rows:
            return
        labels = [int(row[0]) for row in rows]
        points = np.array([(*row[1:4], 0.0, 0.0)[:3] for row in rows])
        if system == "C":
            radius, angle, z = points[:, 0], np.radians(points[:, 1]), points[:, 2]
            points = np.column_stack((radius * np.cos(angle), radius * np.sin(angle), z))
        again = self.scope.add_nodes(labels, self.local.placed(points))
        if again:
            self.notes.append(f"{again} nodes stand twice ({card.where}); the last place counts")
        if name := card.get("NSET"):
            self.scope.extend("node", name, labels)

    def _elements(self, card: Card) -> None:
        element = card.get("TYPE")
        kind = kind_of(element)
        if kind is None:
            self.notes.append(
                f"{counted(len(card.data), 'line')} of elements of type {element or '(none)'} "
                "not taken: they fill no space"
            )
            return
        labels = self.scope.add_elements(card, kind)
        if name := card.get("ELSET"):
            self.scope.extend("element", name, labels)

    def _set(self, card: Card) -> None:
        kind = "node" if card.name == "NSET" else "element"
        name = card.get(card.name) or card.get("NAME")
        if not name:
            raise FileError(card.where, f"*{card.name} has no name")
        owner = ""
        if instance := card.get("INSTANCE"):
            if instance.upper() not in self.instances:
                what = f"*{card.name} {name} names instance {instance}, which is missing"
                raise FileError(card.where, what)
            owner = instance.upper() + "."
        members: list[int | str] = []
        if kind == "node" and card.get("ELSET"):
            self.scope.extend("node", name, [f"\0{owner}{card.get('ELSET')}"])
        for row in card.data:
            if "GENERATE" in card.parameters:
                first, last, step = (*card.labels(row), 1)[:3]
                members += range(first, last + 1, max(step, 1))
            else:
                members += [int(each) if each.isdigit() else each for each in row if each]
        self.scope.extend(kind, name, [f"{owner}{each}" for each in members] if owner else members)

    def contents(self, names: dict[str, str], own: Collection[str]) -> Contents:
        """Return the whole model, with each instance at its position."""
        placed = list(self.instances.values())
        if placed:
            left = [part.name for part in self.parts.values() if not part.is_used]
            self.notes += [f"Part {name} has no instance and is left out" for name in left]
        else:
            placed = list(self.parts.values())
            if placed:
                self.notes.append("No *INSTANCE places the parts: each is taken where it stands")
        scopes = [self.root, *placed]
        points = np.concatenate([scope.placed_points() for scope in scopes])
        if not len(points):
            raise FileError(str(self.path), "holds no *NODE card with nodes")
        first_point = first_cell = 0
        blocks: list[CellBlock] = []
        for scope in scopes:
            scope.first_point, scope.first_cell = first_point, first_cell
            blocks += scope.blocks()
            first_point += len(scope.labels)
            first_cell += len(scope.cell_of)
        sets = {kind: self._sets(kind, scopes) for kind in ("node", "element")}
        sections = tuple(self._section_names(scopes, sets["element"]))
        if self.is_computation:  # its other sets are faces under pressure
            sets["element"] = {name: sets["element"][name] for name in sections}
        if self.passed:
            listed = ", ".join(f"*{name}" for name in self.passed)
            self.notes.append(f"Cards that are no geometry are passed over: {listed}")
        surfaces = [name for name in self.surfaces if not re.match(r"CAVITY-\d+$", name, re.I)]
        self.notes += [f"Surface {name} is not taken: sets of nodes are" for name in surfaces]
        self.notes += chain.from_iterable(sorted(scope.missing) for scope in scopes)
        return Contents(
            points,
            tuple(blocks),
            {name: found for name, found in sets["element"].items() if name.upper() not in own},
            {names.get(n, n): found for n, found in sets["node"].items() if n.upper() not in own},
            notes=tuple(dict.fromkeys(self.notes)),
            format="Abaqus input",
            sections=sections,
            instances=tuple(scope.name for scope in self.instances.values()),
        )

    def _sets(self, kind: str, scopes: list[Scope]) -> dict[str, NDArray[np.int64]]:
        """Return all sets of a kind by the names that they have in the contents."""
        known = {scope.name.upper(): scope for scope in scopes}
        uses = Counter(name for scope in scopes for name in scope.sets[kind])
        found = {}
        for scope in scopes:
            for name in scope.sets[kind]:
                members = np.unique(scope.members(kind, name, known))
                found[self._called(kind, scope, name, uses)] = members
        return found

    @staticmethod
    def _called(kind: str, scope: Scope, name: str, uses: Counter[str]) -> str:
        shown = scope.shown[kind, name]
        return f"{scope.name}.{shown}" if scope.name and uses[name] > 1 else shown

    def _section_names(self, scopes: list[Scope], found: Iterable[str]) -> Iterator[str]:
        known = {name.upper(): name for name in found}
        for scope in scopes:
            for name in dict.fromkeys(map(str.upper, scope.sections)):
                for called in (f"{scope.name.upper()}.{name}", name):
                    if called in known:
                        yield known[called]
                        break
