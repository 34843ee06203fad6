"""The document of the studio: a text in TOML that form, editor and view all show."""

from __future__ import annotations

import time
import uuid
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from voxsoft.design import Design
from voxsoft.design.document.formula import is_formula
from voxsoft.design.document.included import placed_document
from voxsoft.design.document.resolution import Document as PlainDocument
from voxsoft.errors import DesignError, FileError, VoxSoftError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import LARGEST_FILE, read_document, read_text
from voxsoft.files.toml_edits import with_value
from voxsoft.studio.documents.positions import diagnostics_of
from voxsoft.studio.documents.timeline import timeline_of
from voxsoft.studio.documents.uploads import safe_name
from voxsoft.studio.protocol import events
from voxsoft.units import KINDS, format_quantity, parse

#: Changes of the same place that follow each other within this time are undone together [s].
ONE_CHANGE: Final = 1.0
#: Number of changes that can be undone.
LONGEST_HISTORY: Final = 500
#: Largest text of the history [characters].
LARGEST_HISTORY: Final = 50_000_000
#: Number of documents before it to which undo can lead back.
MOST_DOCUMENTS: Final = 20


@dataclass
class DesignDocument:
    """One text, its meaning, and its history.

    Attributes
    ----------
    text
        The text as it stands, good or not.
    name
        Name of the document: the file's name.
    path
        The file, or None for a document that was never saved.
    folder
        Base of relative paths of meshes.
    rev
        Grows with each change.
    design
        Design of the last text that was good, or None if there was none.
    diagnostics
        Problems of the text as it stands.
    empty
        True if the text describes nothing yet: no design, and no fault either.
    saved
        The text that its file holds, or None where there is no file.
    restored
        True if the text comes from a draft: nobody knows its changes.
    id
        Names the document beside others that were opened; one file has one id at all times, and
        a document that a change made of another has the id of that.
    hash
        Hash of all that decides the numbers of the design; empty while the text is none.
    before, after
        Documents that were open before this one, with changes that were not saved, and after it.
    """

    text: str
    name: str
    path: Path | None = None
    folder: Path = field(default_factory=Path.cwd)
    rev: int = 1
    design: Design | None = None
    source: PlainDocument | None = None
    diagnostics: list[events.Diagnostic] = field(default_factory=list)
    empty: bool = False
    saved: str | None = None
    restored: bool = False
    id: str = field(default_factory=lambda: uuid.uuid4().hex)
    hash: str = ""
    before: DesignDocument | None = field(default=None, repr=False)
    after: DesignDocument | None = field(default=None, repr=False)
    _former: dict[str, float] | None = None
    _histories: list[events.HistoryLine] = field(default_factory=list)
    _undo: list[str] = field(default_factory=list)
    _redo: list[str] = field(default_factory=list)
    _last_place: object = None
    _last_time: float = 0.0

    def __post_init__(self) -> None:
        self._opened = self.text
        self._read()
        self._first_name = None if self.design is None else self.design.name

    @classmethod
    def of_file(cls, path: Path) -> DesignDocument:
        """Open a design file, also one whose text is no design yet.

        Raises
        ------
        FileError
            It cannot be read as text.
        """
        text = read_text(path)
        whole = path.absolute()
        own = uuid.uuid5(uuid.NAMESPACE_URL, whole.as_uri()).hex
        return cls(text, path.name, whole, whole.parent, saved=text, id=own)

    @property
    def valid(self) -> bool:
        """True if the text as it stands is a design."""
        return not self.empty and not any(each.severity == "error" for each in self.diagnostics)

    @property
    def dirty(self) -> bool:
        """True if the text differs from the one saved last."""
        return self.text != self.saved

    @property
    def edited(self) -> bool:
        """True if the text differs from the one opened or saved last."""
        if self.saved is None:
            return self.restored or self.text != self._opened
        return self.dirty

    @property
    def title(self) -> str:
        """Title: its file, or the name that was given to the design since."""
        name = None if self.design is None else self.design.name
        if self.path is not None or name is None or name == self._first_name:
            return self.name
        return safe_name(f"{name}.toml")

    @property
    def file(self) -> Path:
        """Its file; of a document that was never saved, where it would be saved."""
        return self.path or (self.folder / self.title).absolute()

    def replace(self, text: str, place: object = None, *, now: float | None = None) -> bool:
        """Take another text; returns whether it is another one.

        Parameters
        ----------
        text
            The text, good or not.
        place
            Place of the change; changes of one place that follow each other are undone together.
        now
            The time of the change [s].

        Raises
        ------
        FileError
            A text of more than 10 MB.
        """
        if len(text.encode("utf-8", "surrogatepass")) > LARGEST_FILE:
            raise FileError(self.name, "is larger than 10 MB, too large for a design")
        if text == self.text:
            return False
        now = time.monotonic() if now is None else now
        together = place is not None and place == self._last_place
        if not (together and now - self._last_time < ONE_CHANGE and self._undo):
            self._undo.append(self.text)
            while len(self._undo) > LONGEST_HISTORY or (
                len(self._undo) > 1 and sum(map(len, self._undo)) > LARGEST_HISTORY
            ):
                del self._undo[0]
        elif self._undo[-1] == text:
            # A slider that was dragged back: there is nothing to undo, and nothing to go on from.
            self._undo.pop()
            place = None
        self._last_place, self._last_time = place, now
        self._redo.clear()
        self._become(text)
        return True

    def edit(
        self,
        path: list[str | int],
        value: object,
        *,
        stroke: int = 0,
        now: float | None = None,
    ) -> bool:
        """Set one value by its path, keeping comments; returns whether the text changed.

        Parameters
        ----------
        path, value
            The place, and its value; None removes it.
        stroke
            Number of the stroke of the hand: edits of one place in one stroke are one change.
        now
            The time of the change [s].

        Raises
        ------
        DesignError
            The text is not TOML, or the path leads nowhere.
        """
        return self.replace(with_value(self.text, path, value), (stroke, *path), now=now)

    def undo(self) -> bool:
        """Take back the last change; returns whether there was one."""
        return self._swap(self._undo, self._redo)

    def redo(self) -> bool:
        """Make the change again that was taken back last; returns whether there was one."""
        return self._swap(self._redo, self._undo)

    def follow(self, other: DesignDocument) -> None:
        """Take the place of another document, to which undo leads if it holds unsaved changes."""
        self.rev = other.rev + 1
        unsaved = other.dirty and other.text != self.text
        self.before = other if unsaved else other.before
        if self.before is not None:
            self.before.after = self
        oldest: DesignDocument | None = self
        for _ in range(MOST_DOCUMENTS):
            oldest = None if oldest is None else oldest.before
        if oldest is not None:
            oldest.before = None

    def save(self, path: Path | None = None) -> Path:
        """Write the text to its file, or to another, which is its file from then on.

        Raises
        ------
        FileError
            No file is known, or it cannot be written.
        """
        target = self.target(path or self.path or Path())
        if path is None and self.path is None:
            raise FileError("save", "the document has no file yet", 'give a name like "arm.toml"')
        if target.suffix.lower() != ".toml":
            raise FileError(str(path), "is no name of a design file", 'end it with ".toml"')
        write_atomically(target, self.text)
        self.path, self.folder, self.name, self.saved = (
            target,
            target.parent,
            target.name,
            self.text,
        )
        if self.valid:
            self._former = self._values()
        return target

    def target(self, path: Path) -> Path:
        """Resolve a path that is written from the folder of the document."""
        return (self.folder / path).absolute()

    def event(self) -> events.Document:
        """Everything as the page wants it."""
        design = self.design
        return events.Document(
            rev=self.rev,
            id=self.id,
            hash=self.hash,
            text=self.text,
            name=self.title,
            path=None if self.path is None else str(self.path),
            folder=str(self.folder),
            dirty=self.edited,
            valid=self.valid,
            empty=self.empty,
            parameters=self._parameters(),
            design=None if design is None else design.model_dump(by_alias=True, exclude_none=True),
            source=self.source,
            diagnostics=self.diagnostics,
            can_undo=bool(self._undo) or self._is_step(self.before),
            can_redo=bool(self._redo) or self._is_step(self.after),
            before="" if self.before is None else self.before.title,
            after="" if self.after is None else self.after.title,
            histories=self._histories,
        )

    def _is_step(self, other: DesignDocument | None) -> bool:
        """Check if a change led from another document to this one, or back."""
        return other is not None and other.id == self.id

    def _swap(self, taken: list[str], given: list[str]) -> bool:
        if not taken:
            return False
        given.append(self.text)
        self._last_place = None
        self._become(taken.pop())
        return True

    def _become(self, text: str) -> None:
        self.text = text
        self.rev += 1
        self._read()

    def _read(self) -> None:
        """Read the text; where it is no design the last good one stays."""
        self.diagnostics, self.hash, self.empty = [], "", False
        try:
            document = read_document(self.text, self.name)
            self.source = document
            self.design = Design.from_document(placed_document(document, self.folder))
            self._histories = timeline_of(self.design, document)
            if self._former is None:
                self._former = self._values()
            self.hash = self.design.hash
        except VoxSoftError as error:
            self.empty = _lacks_all(self.source, error)
            if self.empty:
                # Nothing of an earlier text is left that could be shown for it.
                self.design, self._histories = None, []
            else:
                self.diagnostics = diagnostics_of(error, self.text)

    def _values(self) -> dict[str, float]:
        parameters = {} if self.design is None else self.design.parameters
        return {name: parameter.value for name, parameter in parameters.items()}

    def _parameters(self) -> list[events.Parameter]:
        if self.design is None:
            return []
        written: Any = (self.source or {}).get("parameters", {})
        former = self._former or {}
        return [
            _parameter(
                name,
                parameter,
                written.get(name) if isinstance(written, dict) else None,
                former.get(name),
            )
            for name, parameter in self.design.parameters.items()
        ]


def _lacks_all(source: PlainDocument | None, error: VoxSoftError) -> bool:
    """Check if a text is no design only because nothing is described in it yet."""
    if any((source or {}).get(section) for section in ("shapes", "parts", "bodies")):
        return False
    return [problem.where for problem in error.problems] == ["parts"]


def _parameter(
    name: str,
    parameter: Any,  # noqa: ANN401
    written: object,
    former: float | None,
) -> events.Parameter:
    text = written.get("value") if isinstance(written, dict) else written
    shown = text if isinstance(text, str) else format_quantity(parameter.value, parameter.kind)
    unit = _unit_of(shown, parameter.kind) or _unit_of(
        format_quantity(parameter.max or parameter.value, parameter.kind), parameter.kind
    )
    return events.Parameter(
        name=name,
        value=parameter.value,
        kind=parameter.kind,
        text=shown,
        min=parameter.min,
        max=parameter.max,
        step=parameter.step,
        display_unit=unit,
        factor=parse(f"1 {unit}", parameter.kind) if unit else 1.0,
        formula=is_formula(shown),
        former=former,
        description=parameter.description,
    )


def _unit_of(text: str, kind: str) -> str:
    """The unit that a quantity is written with; the preferred one of its kind where none is."""
    units = KINDS[kind].units
    if is_formula(text):
        return ""
    _, _, unit = text.strip().partition(" ")
    try:
        parse(f"1 {unit}", kind)
    except (VoxSoftError, DesignError):
        return units[0] if units else ""
    return unit.strip()
