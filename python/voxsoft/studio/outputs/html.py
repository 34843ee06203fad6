"""One self-contained page of a body: the viewer, the core as WebAssembly, and the scene."""

from __future__ import annotations

import base64
import html
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import msgspec
import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.comparison.error_bar import ErrorBars
from voxsoft.design import Design
from voxsoft.errors import FileError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath, load
from voxsoft.simulation import Result
from voxsoft.simulation.compatibility import refuse
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.equilibrium import equilibrium_of
from voxsoft.studio.bodies.fields import FIELDS
from voxsoft.studio.bodies.objects import moments_of
from voxsoft.studio.bodies.overlap_event import overlap_of
from voxsoft.studio.bodies.reopening import RunState, known_equilibrium
from voxsoft.studio.bodies.scene import scene_of
from voxsoft.studio.bodies.smooth import pack_smooth
from voxsoft.studio.outputs.page import page_file
from voxsoft.studio.protocol import events

#: The page without a scene, built with the studio's page.
TEMPLATE: Final = "viewer.html"

_PLACE: Final = '<script id="voxsoft-scene" type="application/octet-stream;base64">'
_NO_BARS: Final = ErrorBars.none("a page looks for none", "open its design in the studio")
_TITLE: Final = "<title>VoxSoft</title>"


class Notes(msgspec.Struct):
    """Data of a scene for the page."""

    version: str
    name: str
    text: str
    sentence: str
    fields: list[events.Field]
    body: events.Body
    #: Smooth surface of the shapes as the page reads it, base64; empty where none was traced.
    smooth: str = ""
    #: Overlap of the body with itself as it is shown first; None: nowhere, or unloaded.
    overlap: events.Overlap | None = None
    #: Poses of objects as they are shown first, and contacts then; None: nowhere, or unloaded.
    moment: events.Moment | None = None
    #: True if the state shown first is an equilibrium.
    at_rest: bool = False
    #: Its numbers, with error bars where these are known.
    equilibrium: events.Equilibrium | None = None


@dataclass(frozen=True)
class LivePage:
    """A page that is alive in any browser, also in the cell of a notebook.

    Attributes
    ----------
    text
        The page, with nothing left outside it.
    height
        Height in a notebook, in pixels.
    """

    text: str = field(repr=False)
    height: int = 560

    def _repr_html_(self) -> str:
        """Show the page in a notebook, kept apart from it."""
        return (
            f'<iframe srcdoc="{html.escape(self.text)}" sandbox="allow-scripts" '
            f'style="width: 100%; height: {self.height}px; border: 0"></iframe>'
        )

    def save(self, path: FilePath) -> None:
        """Write the page to a file.

        Raises
        ------
        FileError
            It cannot be written.
        """
        write_atomically(path, self.text)


def page_of_body(
    body: StudioBody,
    *,
    factors: Sequence[float] = (),
    positions: NDArray[np.float64] | None = None,
    moment: events.Moment | None = None,
    at_rest: bool = False,
    equilibrium: events.Equilibrium | None = None,
    text: str = "",
    sentence: str = "",
) -> LivePage:
    """Make the page of a body.

    Parameters
    ----------
    body
        The body; it must be one that can be solved.
    factors
        Factor on each load of the design; default: 1.
    positions
        Positions of the vertices that the page shows first [m], (n, 3); default: unloaded. Play
        shows the way from the unloaded shape.
    moment
        Poses of objects then, and contacts; default: the unloaded poses.
    at_rest
        True if those positions are an equilibrium.
    equilibrium
        Its numbers, which the page lists.
    text
        The design as text; default: as :meth:`voxsoft.design.Design.to_toml` writes it.
    sentence
        First sentence of the page.

    Raises
    ------
    FileError
        The viewer was not built.
    VoxSoftError
        The body cannot be solved, or is of the lattice material and has contact, which a page does
        not find.
    """
    if body.refusal is not None:
        raise body.refusal
    refuse(body.setup.design, "page")
    body = replace(body, setup=body.under(factors)) if factors else body
    design = body.setup.design
    notes = Notes(
        version=_core.__version__,
        name=design.name,
        text=text or design.to_toml(),
        sentence=sentence or "Press play, pull on the body, change the loads.",
        fields=list(FIELDS),
        body=body.event(),
        smooth=_smooth(body),
        overlap=None if positions is None else _overlap(body, design, positions),
        # The frame that the page shows first has number 0 there.
        moment=moment and msgspec.structs.replace(moment, frame=0, fields=False),
        at_rest=at_rest and positions is not None,
        # The page looks for no error bars.
        equilibrium=equilibrium
        and msgspec.structs.replace(
            equilibrium, topology=body.topology, frame=0, looking=False, askable=False
        ),
    )
    scene = scene_of(body).pack(msgspec.json.encode(notes).decode(), positions)
    return LivePage(_filled(scene, design.name))


def _smooth(body: StudioBody) -> str:
    packed = pack_smooth(body.setup.design, body.voxels, body.topology)
    return "" if packed is None else base64.b64encode(packed).decode()


def _overlap(
    body: StudioBody, design: Design, positions: NDArray[np.float64]
) -> events.Overlap | None:
    found = overlap_of(design, body.mesh, positions, body.topology)
    return found if found.places else None


def page_of(shown: Design | Result) -> LivePage:
    """Make the page of a design, or of its result.

    Raises
    ------
    VoxSoftError
        The design cannot be meshed or solved.
    """
    design = shown.design if isinstance(shown, Result) else shown
    body = StudioBody.of(design, rev=1, topology=1)
    if not isinstance(shown, Result):
        return page_of_body(body)
    sentence = f"{shown.message[:1].upper()}{shown.message[1:]}."
    moments = moments_of(shown, 0)
    moment = moments[-1] if moments else None
    return page_of_body(
        body,
        positions=shown.positions,
        moment=moment,
        at_rest=shown.status == "ok",
        equilibrium=equilibrium_of(shown, body.topology, 0, _NO_BARS),
        sentence=sentence,
    )


def export_page(source: FilePath, target: FilePath, assignments: Sequence[str] = ()) -> None:
    """Write the page of a design file, or of the state at rest in a run folder.

    Raises
    ------
    FileError
        The source cannot be read, or the target not be written.
    VoxSoftError
        The design cannot be meshed or solved.
    """
    origin = Path(source)
    if origin.is_dir() and assignments:
        raise FileError(str(origin), "is a run, whose design is settled", "export the design file")
    file = origin / "design.toml" if origin.is_dir() else origin
    if not file.is_file():
        raise FileError(str(origin), "is no run folder: it holds no design.toml")
    design = load(file, assignments=assignments)
    state = RunState(origin) if origin.is_dir() else None
    body = StudioBody.of(design, rev=1, topology=1) if state else None
    result = known_equilibrium(body, [state]) if body and state else None
    page_of(result or design).save(target)


def _filled(scene: bytes, name: str) -> str:
    content = page_file(TEMPLATE)
    if content is None:
        raise FileError("studio", "the viewer was not built", "run `make studio` in the sources")
    template = content.decode()
    if template.count(_PLACE) != 1:
        raise FileError(TEMPLATE, "has no place for a scene", "run `make studio` again")
    packed = base64.b64encode(scene).decode("ascii")
    titled = template.replace(_TITLE, f"<title>{html.escape(name)} · VoxSoft</title>", 1)
    return titled.replace(_PLACE, _PLACE + packed, 1)
