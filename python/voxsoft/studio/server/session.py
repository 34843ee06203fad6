"""State shared by all tabs: the document, the body, the jobs and the runs.

Long because every command that is not about time is carried out here, one short method each.
"""

from __future__ import annotations

import shutil
import threading
import uuid
from collections.abc import Sequence
from contextlib import suppress
from functools import singledispatchmethod
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

from voxsoft._folders import folder_name
from voxsoft.design import Design
from voxsoft.design.contact import BODY
from voxsoft.design.document.resolution import Document as PlainDocument
from voxsoft.design.features import feature_changes
from voxsoft.errors import DesignError, FileError, MeasurementError, StudyError, VoxSoftError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.cards import card_name, load_card_file, save_card
from voxsoft.files.designs import read_text
from voxsoft.files.figures import save_thumbnail
from voxsoft.files.run_folder import make_folder
from voxsoft.files.toml_edits import with_swapped
from voxsoft.jobs import CalibrateSpec, DesignSource, MeasuredTable, load
from voxsoft.simulation.checks.check import CheckReport
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.ghosts import GhostTracer
from voxsoft.studio.bodies.mesher import Mesher
from voxsoft.studio.bodies.reopening import Known, RunState, stored_in
from voxsoft.studio.documents.copies import Change, copied, moved, removed
from voxsoft.studio.documents.document import DesignDocument
from voxsoft.studio.documents.drafts import Draft, Drafts
from voxsoft.studio.documents.fineness import fineness_of
from voxsoft.studio.documents.line_difference import line_differences
from voxsoft.studio.documents.materials import materials_of
from voxsoft.studio.documents.opening import (
    document_at,
    robot_document,
    started_document,
    template_document,
    trial_document,
    uploaded_document,
    with_parameters_of,
)
from voxsoft.studio.documents.positions import diagnostics_of
from voxsoft.studio.documents.recent import RecentFiles
from voxsoft.studio.documents.renaming import renamed
from voxsoft.studio.documents.several import (
    added,
    changed_text,
    design_files,
    file_of_document,
    file_of_template,
    several_of,
)
from voxsoft.studio.documents.tables import (
    guessed_columns,
    is_test,
    mapped_text,
    measured,
    measured_test,
    table_uses,
)
from voxsoft.studio.documents.uploads import facts_of_mesh, safe_name, unpack_folder
from voxsoft.studio.documents.versions import Versions, versions_event
from voxsoft.studio.motion.engine import Engine
from voxsoft.studio.outputs.album import Album
from voxsoft.studio.outputs.exports import Shown, export_run, export_shown
from voxsoft.studio.outputs.kept import keep
from voxsoft.studio.outputs.stills import Stills
from voxsoft.studio.outputs.thumbnails import Thumbnail
from voxsoft.studio.protocol import commands, events
from voxsoft.studio.protocol.event_bus import Tabs
from voxsoft.studio.protocol.tab import Tab
from voxsoft.studio.running.asked import spec_of
from voxsoft.studio.running.compared import compared
from voxsoft.studio.running.jobs import Jobs
from voxsoft.studio.running.recipes import recipe_of
from voxsoft.studio.running.runs import RunList, card_of, kind_of
from voxsoft.studio.running.stored_job import stored_job
from voxsoft.studio.running.studying import stored_trial
from voxsoft.studio.server.catalog import hello
from voxsoft.studio.server.starting import start_event

#: Folder of the studio's own files below the runs.
OWN_FOLDER: Final = ".studio"

_KIND_NAMES: Final[dict[type, str]] = {
    commands.RunSpec: "run",
    commands.StudySpec: "study",
    commands.CalibrateSpec: "calibration",
}


class _Loaded(NamedTuple):
    """A revision that is to be shown at rest, and where its equilibrium may be stored."""

    rev: int
    stored: Sequence[Known]


class Session:
    """The studio behind its tabs.

    Parameters
    ----------
    runs
        Folder of the runs; made when something is written.
    source
        File to open: a design file or a run folder; default: the last draft, or a template.

    Raises
    ------
    FileError
        The source cannot be read.
    """

    def __init__(self, runs: Path, source: Path | None = None) -> None:
        self.runs = runs.absolute()
        self.own = self.runs / OWN_FOLDER
        self.tabs = Tabs()
        self.jobs = Jobs(self.tabs, self._runs_changed)
        self.list = RunList(self.runs, self.own, self.jobs.running_in)
        self.stills = Stills(self.list)
        self.album = Album(self.own, self.list)
        self.engine = Engine(self.tabs, self.album.solved)
        self._tables: dict[str, tuple[str, list[commands.ColumnMap] | None]] = {}
        self._mesher = Mesher(
            self.engine.wait_for_body,
            self._meshed,
            self._examined,
            self._not_meshed,
            self._not_examined,
        )
        self._ghosts = GhostTracer(self.tabs.send_to)
        self._lock = threading.RLock()
        self._author: Tab | None = None
        self._loaded: _Loaded | None = None
        self._downloads: dict[str, Path] = {}
        self._drafts = Drafts(self.own)
        self._recent = RecentFiles(self.own)
        self._versions = Versions(self.own)
        self._fresh = source is None and self._drafts.read() is None
        self._notes: list[str] = []
        self.document = self._first_document(source)
        #: Revision at which the document came; bodies of earlier ones are of other documents.
        self._shown_since = self.document.rev
        if self.document.path is not None:
            self._recent.note(self.document.path)

    def start(self) -> None:
        """Start the threads, and mesh the document."""
        self.engine.start()
        self._mesher.start()
        self._ghosts.start()
        self._mesh()

    def end(self) -> None:
        """Stop the threads and the jobs; the draft is written."""
        self._keep_draft(now=True)
        self.jobs.end()
        self._mesher.end()
        self._ghosts.end()
        self.engine.end()
        shutil.rmtree(self.own / "exports", ignore_errors=True)

    def send_snapshot(self, tab: Tab) -> None:
        """Tell a new tab all that it needs."""
        with self._lock:
            self.tabs.send_to(tab, hello(self.runs))
            self.tabs.send_to(tab, start_event(self._recent.files(), fresh=self._fresh))
            self.tabs.send_to(tab, self.document.event())
            for note in self._notes:
                self.tabs.send_to(tab, events.Log(level="info", text=note))
            self._notes.clear()
        self.engine.send_snapshot(tab)
        self.jobs.send_snapshot(tab)
        self.tabs.send_to(tab, self.list.event())

    def left(self, tab: Tab) -> None:
        """Forget a tab that was closed."""
        if self._author is tab:
            self._author = None

    def repaint(self, tab: Tab) -> None:
        """Give a tab that took a frame the next one, if it differs."""
        self.engine.repaint(tab)

    def handle(self, tab: Tab, command: commands.Command) -> None:
        """Execute a command; a failure is reported to its tab."""
        try:
            with self._lock:
                self._execute(command, tab)
        except VoxSoftError as error:
            for problem in error.problems:
                self.tabs.send_to(
                    tab,
                    events.Error(
                        seq=command.seq, where=problem.where, what=problem.what, hint=problem.hint
                    ),
                )
        except BaseException as error:  # a panic of the core too: one command must not end all
            what = f"{type(error).__name__}: {error}"
            self.tabs.send_to(tab, events.Error(seq=command.seq, where="studio", what=what))

    @singledispatchmethod
    def _execute(self, command: commands.Command, tab: Tab) -> None:
        """Execute a command; the engine executes those about time and pictures."""
        self.engine.execute(command, tab)

    @_execute.register
    def _on_hello(self, command: commands.Hello, tab: Tab) -> None:
        raise StudyError("hello", "was said already")

    # The document

    @_execute.register
    def _on_text(self, command: commands.Text, tab: Tab) -> None:
        if command.rev != self.document.rev and self._author not in (None, tab):
            self.tabs.send_to(tab, self.document.event())
            raise FileError(
                "text",
                "was changed in another tab meanwhile; the text typed here was not taken",
                "look at the text as it is now, and change it again",
            )
        self._author = tab
        self._changed(self.document.replace(command.text, "text"))

    @_execute.register
    def _on_edit(self, command: commands.Edit, tab: Tab) -> None:
        self._author = tab
        self._changed(self.document.edit(command.path, command.value, stroke=command.stroke))

    @_execute.register
    def _on_edits(self, command: commands.Edits, tab: Tab) -> None:
        self._author = tab
        self._change(self.document, [(each.path, each.value) for each in command.changes])

    @_execute.register
    def _on_swap(self, command: commands.Swap, tab: Tab) -> None:
        self._author = tab
        text = with_swapped(self.document.text, command.path, command.first, command.second)
        self._changed(self.document.replace(text))

    @_execute.register
    def _on_copy(self, command: commands.Copy, tab: Tab) -> None:
        self._author = tab
        document, name = self._of_several(command.name)
        source, design = self._good(document)
        found = copied(source, design, name, command.way)
        self._change(document, found.changes)
        if found.left:
            text = f"{', '.join(found.left)}: of {name} alone, as a copy needs others"
            self.tabs.publish(events.Log(level="warning", text=text))

    @_execute.register
    def _on_move(self, command: commands.Move, tab: Tab) -> None:
        self._author = tab
        source, design = self._good(self.document)
        changes = moved(source, design, command.name, command.by)
        self._change(self.document, changes, ("move", command.name))

    @_execute.register
    def _on_remove(self, command: commands.Remove, tab: Tab) -> None:
        self._author = tab
        source, design = self._good(self.document)
        self._change(self.document, removed(source, design, command.name))

    @_execute.register
    def _on_rename(self, command: commands.Rename, tab: Tab) -> None:
        self._author = tab
        text = renamed(self.document.text, command.section, command.name, command.to)
        self._changed(self.document.replace(text))

    @_execute.register
    def _on_add_body(self, command: commands.AddBody, tab: Tab) -> None:
        self._author = tab
        document, _ = self._of_several(BODY)
        self._good(document)
        file = Path(command.name)
        if command.what == "template":
            file = file_of_template(command.name, document.folder)
        elif command.what == "upload":
            upload = uploaded_document(self._upload(command.name), document.folder, command.mesh)
            file = file_of_document(upload, document.folder)
        if command.what != "file":
            self.tabs.publish(events.Saved(what="design", path=str(file)))
            file = Path(file.name)
        changes, _ = added(document, file.as_posix(), command.beyond)
        self._change(document, changes)

    @_execute.register
    def _on_add_feature(self, command: commands.AddFeature, tab: Tab) -> None:
        self._author = tab
        if self.document.source is None:
            raise DesignError("design", "is not TOML", "fix the underlined errors")
        _, changes = feature_changes(self.document.source, command.name, command.at)
        self._change(self.document, changes)

    @_execute.register
    def _on_sync(self, command: commands.Sync, tab: Tab) -> None:
        self.tabs.send_to(tab, events.Synced(seq=command.seq))

    @_execute.register
    def _on_designs(self, command: commands.Designs, tab: Tab) -> None:
        self.tabs.send_to(tab, design_files(self.document))

    @_execute.register
    def _on_materials(self, command: commands.Materials, tab: Tab) -> None:
        self.tabs.send_to(tab, materials_of(self.document))

    @_execute.register
    def _on_ghosts(self, command: commands.Ghosts, tab: Tab) -> None:
        self._ghosts.ask(tab, self.document.design, self.document.rev, command.names)

    def _of_several(self, name: str) -> tuple[DesignDocument, str]:
        """A document in which bodies have names, and the new name there of a body or object."""
        _, design = self._good(self.document)
        if name != BODY or design.bodies:
            return self.document, name
        return several_of(self.document)

    def _good(self, document: DesignDocument) -> tuple[PlainDocument, Design]:
        if document.empty:
            raise DesignError("design", "describes nothing yet", "add a shape first")
        if document.source is None or document.design is None or not document.valid:
            raise DesignError("design", "is not valid", "fix the underlined errors")
        return document.source, document.design

    def _change(
        self, document: DesignDocument, changes: list[Change], place: object = None
    ) -> None:
        """Change a document as one step that is undone together; a new one is shown."""
        text = changed_text(document.text, changes)
        if document is self.document:
            self._changed(document.replace(text, place))
            return
        document = DesignDocument(text, document.name, folder=document.folder, id=self.document.id)
        document.follow(self.document)
        # Undo leads back also to a document that is saved: this was a change of it.
        document.before, self.document.after = self.document, document
        self._show(document)

    @_execute.register
    def _on_undo(self, command: commands.Undo, tab: Tab) -> None:
        self._author = tab
        if self.document.undo():
            self._announce()
        else:
            self._go_beyond("undo", self.document.before, tab, turn=command.beyond)

    @_execute.register
    def _on_redo(self, command: commands.Redo, tab: Tab) -> None:
        self._author = tab
        if self.document.redo():
            self._announce()
        else:
            self._go_beyond("redo", self.document.after, tab, turn=command.beyond)

    def _go_beyond(
        self, way: Literal["undo", "redo"], next: DesignDocument | None, tab: Tab, *, turn: bool
    ) -> None:
        """Go to the next document at the end of the changes of one, or say only which it is."""
        if next is not None and (turn or next.id == self.document.id):
            self._turn_to(next)
            return
        name = "" if next is None else next.title
        self.tabs.send_to(tab, events.Edge(way=way, name=self.document.title, beyond=name))

    @_execute.register
    def _on_save(self, command: commands.Save, tab: Tab) -> None:
        path = None if command.path is None else Path(command.path)
        if path is not None and not command.overwrite:
            there = self.document.target(path)
            if there.exists() and there != self.document.path:
                self.tabs.send_to(tab, events.FileExists(path=str(there)))
                return
        written = self._saved(path)
        self._recent.forget(self.document.id)
        self._keep_draft(now=True)
        self._begun()
        self.tabs.publish(self.document.event())
        self.tabs.publish(events.Saved(what="document", path=str(written)))

    def _saved(self, path: Path | None) -> Path:
        """Save the document; earlier and new content of the file are versions."""
        before = ""
        with suppress(VoxSoftError):
            before = read_text(self.document.target(path or self.document.path or Path()))
        written = self.document.save(path)
        self._versions.keep(written, before, "in the file before")
        self._versions.keep(written, self.document.text, "saved")
        return written

    @_execute.register
    def _on_versions(self, command: commands.Versions, tab: Tab) -> None:
        file = self.document.file
        self.tabs.send_to(tab, versions_event(file, self._versions.of(file)))

    @_execute.register
    def _on_version_show(self, command: commands.VersionShow, tab: Tab) -> None:
        version = self._versions.one(self.document.file, command.id)
        lines = line_differences(version.text, self.document.text)
        self.tabs.send_to(tab, events.VersionDifference(id=version.id, lines=lines))

    @_execute.register
    def _on_version_restore(self, command: commands.VersionRestore, tab: Tab) -> None:
        self._author = tab
        version = self._versions.one(self.document.file, command.id)
        self._versions.keep(self.document.file, self.document.text, "before another was restored")
        self._changed(self.document.replace(version.text))

    @_execute.register
    def _on_take(self, command: commands.Take, tab: Tab) -> None:
        self._author = tab
        run, _, number = command.trial.rpartition("/")
        folder = self.list.folder_of(run)
        trial = stored_trial(folder, number)
        source, design = self._good(self.document)
        text = with_parameters_of(trial, self.document.text, source, design)
        changed = self.document.replace(text)
        taken = self.document.design
        if trial.status == "ok" and taken is not None and taken.hash == trial.hash:
            self._loaded = _Loaded(self.document.rev, stored_in(folder))
            if not changed:
                self._mesh()  # it is that design, and is shown as it came to rest
        self._changed(changed)
        self.tabs.send_to(tab, events.Taken(trial=command.trial, changed=changed))

    @_execute.register
    def _on_open(self, command: commands.Open, tab: Tab) -> None:
        self._author = tab
        match command.what:
            case "template":
                self._open(template_document(command.name, self._home))
            case "robot":
                self._open(robot_document(command.name, self._home))
            case "start":
                self._open(started_document(command.name, self._home))
            case "file":
                self._open(document_at(Path(command.name), self._home))
            case "upload":
                self._open_upload(command.name, command.mesh)
            case "unsaved":
                self._open(self._recent.unsaved(command.name).document(self._home))
            case "run":
                self._open_run(self.list.folder_of(command.name))
            case "trial":
                run, _, number = command.name.rpartition("/")
                folder = self.list.folder_of(run)
                document, at_rest = trial_document(folder, number, self._home)
                self._name_as(document, run)
                self._open(document, stored_in(folder) if at_rest else None)

    @property
    def _home(self) -> Path:
        """Folder in which documents without a file would be saved."""
        return self.runs.parent

    def _open(self, document: DesignDocument, stored: Sequence[Known] | None = None) -> None:
        """Show another document; undo leads back to the one before.

        With `stored`, where its equilibrium may be, it is shown at rest.
        """
        if self.document.edited:
            reason = f"before {document.name} was opened"
            self._versions.keep(self.document.file, self.document.text, reason)
        document.follow(self.document)
        self._loaded = None if stored is None else _Loaded(document.rev, stored)
        self._show(document)

    def _turn_to(self, document: DesignDocument) -> None:
        """Show a document again that was open before."""
        document.rev = self.document.rev + 1
        self._show(document)

    def _show(self, document: DesignDocument) -> None:
        self._list_unsaved(document)
        self.document, self._shown_since = document, document.rev
        self.engine.forget()
        self._announce()

    def _list_unsaved(self, next: DesignDocument) -> None:
        """Let Recent lead back to a document that has no file, as another takes its place."""
        left = self.document
        if left.path is not None or left.empty or not left.edited or left.id == next.id:
            return
        self._recent.note_unsaved(Draft(left.text, left.title, "", left.id))
        self.tabs.publish(start_event(self._recent.files(), fresh=False))

    def _begun(self) -> None:
        """Note that there is work now, and the file that it is of where that is another one."""
        path = self.document.path
        another = path is not None and not self._recent.is_first(path)
        if path is not None and another:
            self._recent.note(path)
        if self._fresh or another:
            self._fresh = False
            self.tabs.publish(start_event(self._recent.files(), fresh=False))

    def _upload(self, name: str) -> Path:
        file = self.own / "uploads" / safe_name(name)
        if not file.is_file():
            raise FileError(name, "was not uploaded", "drop the file on the page again")
        return file

    def _open_upload(self, name: str, mesh: commands.MeshImport | None) -> None:
        file = self._upload(name)
        if file.suffix == ".zip":
            folder = unpack_folder(file, self._free_folder(file.stem))
            self._open(document_at(folder, self._home))
        else:
            self._open(uploaded_document(file, self._home, mesh))

    def _open_run(self, folder: Path) -> None:
        kind = kind_of(folder)
        try:
            stored = [RunState(folder)] if kind == "run" else None
            document = document_at(folder, self._home)
            self._name_as(document, folder.name)
            self._open(document, stored)
        except FileError as error:
            if kind != "calibrate":
                raise
            # One that `voxsoft calibrate` wrote: there is still its result to be shown.
            self.tabs.publish(events.Log(level="info", text=str(error)))

    def _name_as(self, document: DesignDocument, run: str) -> None:
        """Give the design of a job the id of the document that the job was started from."""
        job = self.jobs.known(run)
        if job is not None and job.subject is not None and job.subject.document:
            document.id = job.subject.document

    # Jobs

    @_execute.register
    def _on_keep(self, command: commands.Keep, tab: Tab) -> None:
        shown = self._shown()
        folder = self._free_folder(command.name or f"{shown.body.setup.design.name}-run")
        try:
            sentence = keep(shown, self.document.folder, folder)
        except VoxSoftError:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        self.tabs.publish(events.Saved(what="run", path=str(folder)))
        self.tabs.publish(events.Log(level="info", text=f"kept {sentence}"))
        self._runs_changed()
        # The picture takes longer than the run: the next command must not wait for it.
        threading.Thread(target=self._draw, args=(shown, folder), daemon=True).start()

    def _draw(self, shown: Shown, folder: Path) -> None:
        with suppress(VoxSoftError, OSError):
            save_thumbnail(shown.measured(), folder)
            self._runs_changed()

    @_execute.register
    def _on_fineness(self, command: commands.Fineness, tab: Tab) -> None:
        self.tabs.send_to(tab, fineness_of(self._shown(), self.document))

    @_execute.register
    def _on_job_start(self, command: commands.JobStart, tab: Tab) -> None:
        asked, document = command.spec, self.document
        if not document.valid or document.design is None:
            raise StudyError("job", "the design is not valid", "fix the underlined errors")
        tables = []
        if isinstance(asked, commands.CalibrateSpec):
            tables = [table for each in asked.data for table in self._measured_tables(each)]
        source = DesignSource(text=document.text, folder=str(document.folder))
        name = asked.name or f"{document.design.name}-{_KIND_NAMES[type(asked)]}"
        spec = spec_of(asked, source, tables)
        folder = self._free_folder(name)
        if isinstance(spec, CalibrateSpec):
            spec = spec.replace(card=card_name(folder.name))
        self.jobs.start(spec, folder, document.id)
        self._runs_changed()

    @_execute.register
    def _on_job_pause(self, command: commands.JobPause, tab: Tab) -> None:
        self.jobs.pause(command.id)

    @_execute.register
    def _on_job_stop(self, command: commands.JobStop, tab: Tab) -> None:
        self.jobs.stop(command.id)

    @_execute.register
    def _on_job_resume(self, command: commands.JobResume, tab: Tab) -> None:
        if self.jobs.known(command.id) is not None and self.jobs.resume(command.id):
            return
        folder = self.list.folder_of(command.id)
        self.jobs.start(load(folder).spec, folder)
        self._runs_changed()

    @_execute.register
    def _on_job_show(self, command: commands.JobShow, tab: Tab) -> None:
        if self.jobs.known(command.id) is None:  # all tabs know those of this studio
            for event in stored_job(self.list.folder_of(command.id)):
                self.tabs.send_to(tab, event)

    @_execute.register
    def _on_recipe(self, command: commands.Recipe, tab: Tab) -> None:
        self.tabs.send_to(tab, recipe_of(self.list.folder_of(command.id)))

    @_execute.register
    def _on_measurement(self, command: commands.Measurement, tab: Tab) -> None:
        if is_test(command.name):
            event, _ = measured_test(command.name, command.text, self.document.folder)
        else:
            event, _ = measured(command.name, command.text, command.columns, command.select)
        self._tables[command.name] = (command.text, command.columns)
        self.tabs.send_to(tab, event)

    def _measured_tables(self, data: commands.MeasuredData) -> tuple[MeasuredTable, ...]:
        """A table that was sent before, mapped, or those of a test."""
        if data.name not in self._tables:
            raise FileError(data.name, "was not sent", "drop the file on the page again")
        text, columns = self._tables[data.name]
        if is_test(data.name):
            event, loads = measured_test(data.name, text, self.document.folder)
            if not loads:
                raise self._unusable(event)
            return MeasuredTable.of_measurements(loads, data.name)
        event, found = measured(data.name, text, data.columns or columns, data.select)
        if found is None:
            raise self._unusable(event)
        mapped = mapped_text(text, data.columns or columns or guessed_columns(text))
        return (MeasuredTable(name=data.name, text=mapped, select=data.select),)

    def _unusable(self, event: events.Measured) -> MeasurementError:
        """The first problem of a table that cannot be used."""
        first = event.problems[0]
        return MeasurementError(first.where, first.what, first.hint)

    @_execute.register
    def _on_card_save(self, command: commands.CardSave, tab: Tab) -> None:
        folder = self.list.folder_of(command.job)
        card = card_of(folder)
        if card is None:
            raise FileError(command.job, "holds no material card", "wait until it is done")
        found = load_card_file(card).replace(name=command.name)
        target = self.document.folder / f"{safe_name(command.name + '.toml')}"
        save_card(found, target)
        self.tabs.publish(events.Saved(what="card", path=str(target)))

    # Runs

    @_execute.register
    def _on_runs(self, command: commands.Runs, tab: Tab) -> None:
        self.tabs.send_to(tab, self.list.event())

    @_execute.register
    def _on_run_rename(self, command: commands.RunRename, tab: Tab) -> None:
        self.list.rename(command.id, command.name)
        self._runs_changed()

    @_execute.register
    def _on_run_delete(self, command: commands.RunDelete, tab: Tab) -> None:
        self.list.delete(command.id)
        self._runs_changed()

    @_execute.register
    def _on_run_restore(self, command: commands.RunRestore, tab: Tab) -> None:
        self.list.restore(command.id)
        self._runs_changed()

    @_execute.register
    def _on_compare(self, command: commands.Compare, tab: Tab) -> None:
        self.tabs.send_to(tab, compared(self.list, command.a, command.b))

    def _runs_changed(self) -> None:
        self.tabs.publish(self.list.event())

    def _free_folder(self, name: str) -> Path:
        """A folder among the runs that is not there yet."""
        stem = folder_name(name, "run")
        for number in range(1, 10_000):
            folder = self.runs / (stem if number == 1 else f"{stem}-{number}")
            if not folder.exists():
                return make_folder(folder)
        raise FileError(str(self.runs), f'has too many folders called "{stem}"')

    def _changed(self, changed: bool) -> None:
        if changed:
            self._announce()

    def _announce(self) -> None:
        """Tell everyone of the document as it is now, and mesh it if it is good."""
        self._begun()
        self.tabs.publish(self.document.event())
        self._mesh()
        self._keep_draft()

    def _keep_draft(self, *, now: bool = False) -> None:
        """Keep unsaved changes, within a second; the earlier draft goes once they are saved."""
        document: DesignDocument | None = self.document
        while document is not None and not document.dirty:
            document = document.before
        draft = None
        if document is not None:
            draft = Draft(document.text, document.name, str(document.path or ""), document.id)
        try:
            self._drafts.keep(draft, now=now)
        except VoxSoftError as error:
            self.tabs.publish(events.Log(level="warning", text=f"the draft is not kept: {error}"))

    def _mesh(self) -> None:
        """Mesh the document if it is good; of one that never was there is nothing to be shown."""
        document = self.document
        if document.design is None:
            self.engine.leave()
        elif document.valid or document.rev == self._shown_since:
            self._mesher.ask(document.design, document.rev)

    # The mesher's answers, on its thread

    def _meshed(self, body: StudioBody) -> None:
        with self._lock:
            if body.rev < self._shown_since or self.document.design is None:
                return
        # A run that came to rest is shown as it ended, not as it began.
        asked = self._loaded
        loaded = asked is not None and asked.rev == body.rev
        known = None
        if asked is not None and loaded:
            known = self.album.equilibrium(body, asked.stored)
        self.engine.show(body, loaded=loaded, known=known)

    def _examined(self, body: StudioBody, report: CheckReport, smooth: bytes | None) -> None:
        self.engine.publish_report(body, report, smooth)

    def _not_examined(self, error: VoxSoftError) -> None:
        text = f"The body could not be checked, so faults of it are not shown. {error}"
        self.tabs.publish(events.Log(level="error", text=text))

    def _not_meshed(self, rev: int, error: VoxSoftError) -> None:
        with self._lock:
            if rev < self._shown_since:
                return
            self.engine.stay(str(error))
            if rev == self.document.rev:
                self.document.diagnostics = diagnostics_of(error, self.document.text)
                self.tabs.publish(self.document.event())

    # Files

    def store_upload(self, name: str, content: bytes) -> Path:
        """Keep a file that was dropped on the page, under a safe name; returns where it is.

        Raises
        ------
        FileError
            It cannot be written.
        """
        stored = make_folder(self.own / "uploads") / safe_name(name)
        write_atomically(stored, content)
        return stored

    def download(self, key: str) -> Path | None:
        """The file that an export left for a download."""
        found = self._downloads.get(key)
        return found if found is not None and found.is_file() else None

    def offer(self, file: Path, format: str) -> events.Exported:
        """Make a file ready to be fetched."""
        key = uuid.uuid4().hex
        self._downloads[key] = file
        return events.Exported(format=format, url=f"/download/{key}", name=file.name)

    def export(self, format: str, options: dict[str, Any]) -> events.Exported:
        """Write the shown state, or a run of `options`, in a format, ready to be fetched.

        Raises
        ------
        VoxSoftError
            It cannot be written in that format.
        """
        folder = make_folder(self.own / "exports" / uuid.uuid4().hex[:12])
        run = options.get("run")
        if isinstance(run, str):
            written = export_run(self.list.folder_of(run), format, options, folder)
        else:
            written = export_shown(self._shown(), format, options, folder)
        for lost in written.lost:
            text = f"{written.file.name}: {lost}"
            self.tabs.publish(events.Log(level="warning", text=text))
        return self.offer(written.file, format)

    def molds(self, asked: dict[str, Any]) -> events.Molds:
        """Make the molds of the document, as the page asks for them.

        Raises
        ------
        VoxSoftError
            The document is no design yet, a wrong limit, or a body that cannot be sampled.
        """
        from voxsoft.studio.outputs.molds import make_molds, reported

        with self._lock:
            _, design = self._good(self.document)
            name, rev = Path(self.document.name).stem, self.document.rev
        folder = make_folder(self.own / "exports" / uuid.uuid4().hex[:12])
        made = make_molds(design, asked, folder / f"{name}-molds")
        if made.archive is None:
            return reported(made, rev, "", "")
        offered = self.offer(made.archive, "molds")
        return reported(made, rev, offered.url, offered.name)

    def mesh(self, asked: dict[str, Any]) -> events.MeshFacts:
        """Measure a mesh that was uploaded, so that the page can ask for its unit.

        Raises
        ------
        VoxSoftError
            It is not there, cannot be read, or encloses nothing.
        """
        return facts_of_mesh(self._upload(str(asked.get("name", ""))))

    def table(self, asked: dict[str, Any]) -> events.TableUses:
        """Say which uses a table that was dropped can have.

        Raises
        ------
        VoxSoftError
            It is no table.
        """
        return table_uses(str(asked.get("name", ""))[:300], str(asked.get("text", "")))

    def coupons(self, asked: dict[str, Any]) -> events.CouponFit:
        """Fit models to tests of a material.

        Raises
        ------
        VoxSoftError
            A table that cannot be used, or no model that can be fitted.
        """
        from voxsoft.studio.documents.coupons import fitted_coupons

        return fitted_coupons(asked)

    def _shown(self) -> Shown:
        """The state on the screen now."""
        with self._lock:
            name, text = Path(self.document.name).stem, self.document.text
        return self.engine.shown(name, text)

    def picture(self, of: str, cancelled: threading.Event) -> Thumbnail:
        """Draw a picture: "trial/ID/INDEX", "file/PATH", "unsaved/ID" or "version/ID".

        Versions are those of the document. Only files that the start screen lists are drawn.

        Raises
        ------
        VoxSoftError
            There is no such thing, or it cannot be drawn.
        NoLongerWantedError
            `cancelled` was set before it was begun.
        """
        kind, _, name = of.partition("/")
        if kind == "trial":
            run, _, number = name.rpartition("/")
            return self.album.of_trial(run, number, cancelled)
        if kind == "version":
            with self._lock:
                file = self.document.file
            one = self._versions.one(file, name)
            return self.album.of_text(one.text, one.name, Path(one.folder), cancelled)
        if kind == "file" and any(each.path == name for each in self._recent.files()):
            return self.album.of_file(Path(name), cancelled)
        if kind == "unsaved":
            draft = self._recent.unsaved(name)
            return self.album.of_text(draft.text, draft.name, self._home, cancelled)
        raise FileError(of[:200], "is not known", "reload the page")

    def thumbnail(self, run: str) -> Path | None:
        """The picture of a run, if there is one."""
        return self.list.picture(run)

    def _first_document(self, source: Path | None) -> DesignDocument:
        """First document: the source, with its unsaved changes; the draft; a template."""
        draft = self._drafts.read()
        if draft is None:
            if source is not None:
                return document_at(source, self._home)
            document = template_document("cylinder", self._home)
            document.saved = document.text
            return document
        file = draft.file
        if source is None and file is None:
            return draft.document(self._home)
        document = document_at(source or file or Path(), self._home)
        if file is not None and file == document.path:
            if document.replace(draft.text):
                self._notes.append("Changes that were not saved are back; undo goes to the file.")
        else:
            unsaved = draft.document(self._home)
            if file is not None:
                unsaved = DesignDocument.of_file(file)
                unsaved.replace(draft.text)
            document.follow(unsaved)
            self._notes.append(f"Changes of {draft.name} were not saved; undo offers the way back.")
        return document
