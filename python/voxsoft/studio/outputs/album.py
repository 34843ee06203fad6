"""Pictures and equilibria of trials, files, versions and open documents."""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final, NamedTuple

from voxsoft.design import Design
from voxsoft.design.document.included import placed_document
from voxsoft.errors import FileError, VoxSoftError
from voxsoft.files.designs import read_document, read_text
from voxsoft.simulation import Result
from voxsoft.studio.bodies import reopening
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.reopening import Known, known_equilibrium
from voxsoft.studio.outputs.stills import design_in
from voxsoft.studio.outputs.thumbnails import FOLDER, MOST, NoPictureError, Thumbnail, Thumbnails
from voxsoft.studio.running.runs import RunList
from voxsoft.studio.running.studying import stored_study
from voxsoft.study import equilibria
from voxsoft.study.equilibria import Equilibria, Equilibrium

#: Name of the journal of a study, which grows with each trial.
_JOURNAL: Final = "study.journal"


class _Known(NamedTuple):
    """The trials of a study as they were when its journal had a size."""

    folder: Path
    size: int
    design: Design
    parameters: dict[str, dict[str, Any]]


class Album:
    """Finds pictures of designs, and the equilibria that are known of them.

    Parameters
    ----------
    own
        The studio's own folder.
    runs
        The list of runs.
    """

    def __init__(self, own: Path, runs: RunList) -> None:
        self._runs = runs
        self._solved = Equilibria(own / reopening.FOLDER)
        self._own = Thumbnails(own / FOLDER, MOST)
        self._study: _Known | None = None

    def of_trial(self, run: str, number: str, cancelled: threading.Event) -> Thumbnail:
        """Draw a trial of a study, at rest where the study or the studio has its equilibrium.

        Raises
        ------
        VoxSoftError
            There is no such trial, or it cannot be drawn.
        NoLongerWantedError
            `cancelled` was set before it was begun.
        """
        folder = self._runs.folder_of(run)
        if not number.isdecimal():
            raise FileError(f"{run}/{number}", "is no trial of that study")
        pictures = Thumbnails(folder / FOLDER)
        design = partial(self._design_of, folder, number)
        return pictures.of(
            number, design, [Equilibria(folder / equilibria.FOLDER), self._solved], cancelled
        )

    def of_text(self, text: str, name: str, folder: Path, cancelled: threading.Event) -> Thumbnail:
        """Draw the design of a text whose relative paths begin in a folder.

        Raises
        ------
        NoPictureError
            It is no design, or cannot be drawn.
        NoLongerWantedError
            `cancelled` was set before it was begun.
        """
        content = hashlib.sha256(f"{folder}\0{text}".encode("utf-8", "surrogatepass")).hexdigest()

        def design() -> Design:
            return Design.from_document(placed_document(read_document(text, name), folder))

        try:
            return self._own.of(content[:32], design, [self._solved], cancelled)
        except VoxSoftError as error:
            raise NoPictureError(error.where, error.what, error.hint) from None

    def of_file(self, path: Path, cancelled: threading.Event) -> Thumbnail:
        """Draw a design file.

        Raises
        ------
        FileError
            It cannot be read.
        NoPictureError
            It is no design, or cannot be drawn.
        NoLongerWantedError
            `cancelled` was set before it was begun.
        """
        return self.of_text(read_text(path), path.name, path.parent, cancelled)

    def equilibrium(self, body: StudioBody, stored: Sequence[Known]) -> Result | None:
        """The equilibrium of a body as it is stored, or was solved before; None where unknown."""
        return known_equilibrium(body, [*stored, self._solved])

    def solved(self, body: StudioBody, result: Result) -> None:
        """Keep an equilibrium that was solved for."""
        self._solved.keep(body.setup.design.hash, Equilibrium.of(result))

    def _design_of(self, folder: Path, number: str) -> Design:
        """The design of a trial, without reading a study anew for each of its trials."""
        size = _size_of(folder / _JOURNAL)
        known = self._study
        fresh = known is not None and known.folder == folder
        if known is None or not fresh or (known.size != size and number not in known.parameters):
            trials = stored_study(folder).trials
            parameters = {str(trial.number): dict(trial.parameters) for trial in trials}
            known = self._study = _Known(folder, size, design_in(folder), parameters)
        if number not in known.parameters:
            raise FileError(f"{folder.name}/{number}", "is no trial of that study")
        return known.design.with_parameters(**known.parameters[number])


def _size_of(file: Path) -> int:
    try:
        return file.stat().st_size
    except OSError:
        return 0
