"""Pictures of bodies: their surface, shaded, with a field in color."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft.design import Design
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.errors import MeshError
from voxsoft.mesh import Mesh
from voxsoft.plot import shading
from voxsoft.plot.boundary import Axis, Boundary, beyond, boundary_of
from voxsoft.plot.camera import Camera
from voxsoft.plot.color_range import CLIP, ColorRange, color_range
from voxsoft.plot.colors import mapped, rgb
from voxsoft.plot.frames import at_frame
from voxsoft.plot.objects import Surroundings
from voxsoft.plot.quantities import Scale, scale_for
from voxsoft.plot.raster import Raster, rasterize
from voxsoft.plot.style import COLOR_MAP, SERIES, empty_figure
from voxsoft.plot.tendons import draw_tendons
from voxsoft.records import closest
from voxsoft.simulation import Result
from voxsoft.simulation.setup.places import on_the_surface

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

# Fields of a result by name: label of the color bar, and kind of quantity.
_FIELDS: Final[Mapping[str, tuple[str, str]]] = {
    "displacement": ("displacement", "length"),
    "von_mises": ("von Mises stress", "pressure"),
    "max_stretch": ("largest stretch", "number"),
    "energy_density": ("energy density", "pressure"),
    "contact_pressure": ("contact pressure", "pressure"),
}

#: Pixels of the longer side of the picture; it is computed twice as fine and averaged.
PIXELS = 900
_FINER = 2
# Shortest edge of triangles, in pixels, that is drawn.
_SHORTEST_LINE = 7.0
_PLAIN_COLOR = "#9fb8c8"
# Darkest shade of an undeformed body.
_PALEST = 0.68


def plot_body(
    body: Result | Design | Mesh,
    field: str | ArrayLike | None = None,
    *,
    label: str = "",
    section: Axis | tuple[Axis, float] | None = None,
    view: tuple[float, float] = (-60.0, 25.0),
    ghost: bool = True,
    lines: bool | None = None,
    objects: bool | Surroundings | None = None,
    frame: int | None = None,
    title: str | None = None,
) -> Figure:
    """Draw a body, shaded and deformed, with its tendons and a scale bar.

    Parameters
    ----------
    body
        Result, which is drawn deformed; design, unloaded; or mesh. Of the first two cut voxels are
        drawn as the shape that cuts them, which a mesh does not know: its voxels are drawn whole.
    field
        Quantity shown in color: ``"displacement"`` (its magnitude; the default for a result),
        ``"von_mises"``, ``"max_stretch"`` or ``"energy_density"`` of a result, with contact also
        ``"contact_pressure"``, ``"part"``, ``"plain"`` (the default without a result), or one
        number for each vertex, (n,). Where a few values lie far beyond all others, colors end where
        99 % of the area do, and the picture marks the farthest.
    label
        Label of the color bar for such numbers.
    section
        Axis normal to a cut that removes the half nearer to the reader: alone for a cut
        through the middle, or with its position in m. Voxels stay whole. Walls of cavities are
        drawn in colors of their own.
    view
        Azimuth and elevation of the eye in degrees.
    ghost
        True to show the undeformed body behind a deformed one.
    lines
        True to draw the edges of triangles; default: where they are long enough to be seen.
    objects
        True to draw the rigid objects and the floor of a result or design, gray; default: unless
        the color shows their contact pressure. Those of a mesh are given,
        ``Surroundings.of(design, {})`` of ``voxsoft.plot.objects``: a mesh does not know them.
    frame
        Index of the recorded frame of a result to draw, in place of its end: a run with
        ``frames=True`` has one for each of ``result.recording.times``. Tendons are drawn at the end
        alone.
    title
        Title of the picture; default: the name of the design.

    Returns
    -------
    matplotlib.figure.Figure
        The picture. A surface of 100,000 triangles takes a few seconds.

    Raises
    ------
    MeshError
        An unknown field, a number of values that is not that of the vertices, a section that
        leaves nothing, or a frame that was not recorded.

    Examples
    --------
    >>> from voxsoft.voxels import Voxels
    >>> mesh = Voxels.from_array([[[1, 1], [0, 1]]], voxel_size=0.005).mesh()
    >>> figure = plot_body(mesh, mesh.vertices[:, 2] * 1e3, label="height (mm)")
    >>> figure.axes[1].get_ylabel()
    'height (mm)'
    """
    if frame is not None:
        if not isinstance(body, Result):
            raise MeshError("frame", "is for a result alone", "leave it out")
        body = at_frame(body, frame)
    mesh, positions = _drawn(body)
    has_ghost = ghost and isinstance(body, Result) and section is None
    shown = [positions, mesh.vertices] if has_ghost else [positions]
    if objects is None:
        objects = not _is(field, "contact_pressure")
    around = _around(body, shown=objects) if isinstance(objects, bool) else objects
    shown.append(around.near(positions))
    tendons = body.tendons if isinstance(body, Result) else {}
    shown += [tendon.points for tendon in tendons.values()]
    camera = Camera.around(np.concatenate(shown), view, PIXELS * _FINER)
    plane = _plane(mesh, section, camera)
    surface = boundary_of(mesh, _kept(mesh, plane))
    colors = _colors(body, mesh, surface, field, label)
    seen = rasterize(camera.project(positions), surface.triangles, camera.width, camera.height)
    picture = _paint(seen, positions, surface, colors, camera, lines)
    before = None
    if has_ghost:
        points = camera.project(mesh.vertices)
        before = rasterize(points, surface.triangles, camera.width, camera.height)
        picture = _with_ghost(picture, seen, before, mesh, surface, camera)
    picture = around.drawn_over(picture, seen, camera, positions, plane, before)
    design = _design_of(body)
    name = "" if design is None else design.name
    figure = _figure(picture, camera, colors, name if title is None else title)
    draw_tendons(figure.axes[0], tendons, camera, _FINER)
    return figure


def body_image(
    body: Result | Design | Mesh,
    *,
    pixels: int = 320,
    view: tuple[float, float] = (-60.0, 25.0),
    field: str | None = None,
    room: ArrayLike | None = None,
) -> NDArray[np.uint8]:
    """Draw a small picture of a body without words, as for a list.

    Parameters
    ----------
    body
        Result, which is drawn deformed and colored by its displacement; design, or mesh.
    pixels
        Size of the longer side in pixels.
    view
        Azimuth and elevation of the eye in degrees.
    field
        Quantity shown in color, as in :func:`plot_body`.
    room
        Lowest and highest corner of the room that the picture shows, (2, 3), m, so that pictures of
        a motion fit each other; default: as much as the body needs.

    Returns
    -------
    ndarray of uint8, shape (h, w, 3)
        Red, green, blue.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> max(body_image(families.sphere(), pixels=64).shape) <= 80
    True
    """
    mesh, positions = _drawn(body)
    around = _around(body)
    shown = around.near(positions) if room is None else _corners(room)
    camera = Camera.around(shown, view, pixels * _FINER)
    surface = boundary_of(mesh, np.ones(len(mesh.tets), dtype=bool))
    colors = _colors(body, mesh, surface, field, "")
    seen = rasterize(camera.project(positions), surface.triangles, camera.width, camera.height)
    picture = _paint(seen, positions, surface, colors, camera, None)
    # The floor of a room stays where the body goes.
    picture = around.drawn_over(picture, seen, camera, positions if room is None else shown)
    return np.rint(255.0 * np.clip(_averaged(picture), 0.0, 1.0)).astype(np.uint8)


def _corners(room: ArrayLike) -> Floats:
    """Return the corners of a box from its lowest and highest one, (8, 3)."""
    low, high = np.asarray(room, dtype=np.float64)
    corners: Floats = np.array(list(product(*zip(low, high, strict=True))))
    return corners


def _design_of(body: Result | Design | Mesh) -> Design | None:
    """Return the design of a body; None for a mesh, which does not know it."""
    if isinstance(body, Result):
        return body.design
    return body if isinstance(body, Design) else None


def _drawn(body: Result | Design | Mesh) -> tuple[Mesh, Floats]:
    """Return the mesh, and positions now, with cut voxels up to the surface that cuts them."""
    if isinstance(body, Mesh):
        return body, body.vertices
    if isinstance(body, Result):
        design, mesh, moved = body.design, body.mesh, body.displacements
    else:
        design, mesh = body, mesh_of(body)
        moved = np.zeros_like(mesh.vertices)
    if mesh.fractions is None:
        return mesh, mesh.vertices + moved
    vertices = on_the_surface(design, mesh)
    # Only for the picture: its voxels are no longer cubes.
    return replace(mesh, vertices=vertices), vertices + moved


@dataclass(frozen=True)
class _Colors:
    """Color of each corner of each triangle as a number, or of each triangle as it is."""

    flat: Floats  # (t, 3) red, green, blue
    values: Floats | None = None  # (t, 3) at the corners
    range: ColorRange | None = None
    label: str = ""
    colored: NDArray[np.bool_] | None = None  # (t,) where the values count
    clipped: str = ""  # extremes outside the color range


def _around(body: Result | Design | Mesh, *, shown: bool = True) -> Surroundings:
    """Return the rigid objects and floor around a body that are shown."""
    design = _design_of(body)
    if not shown or design is None:
        return Surroundings()
    return Surroundings.of(design, body.objects if isinstance(body, Result) else {})


def _is(field: str | ArrayLike | None, name: str) -> bool:
    return isinstance(field, str) and field == name


def _plane(
    mesh: Mesh, section: Axis | tuple[Axis, float] | None, camera: Camera
) -> tuple[Axis, float, int] | None:
    """Find the plane of a section: the axis, the position on it, and the side that stays."""
    if section is None:
        return None
    if isinstance(section, tuple):
        axis, position = section
    else:
        axis = section
        along = mesh.vertices[:, "xyz".index(axis)]
        position = 0.5 * float(along.min() + along.max())
    return axis, position, -1 if camera.toward["xyz".index(axis)] > 0 else 1


def _kept(mesh: Mesh, plane: tuple[Axis, float, int] | None) -> NDArray[np.bool_]:
    if plane is None:
        return np.ones(len(mesh.tets), dtype=bool)
    kept = beyond(mesh, *plane)
    axis, position, _ = plane
    if not kept.any():
        raise MeshError(
            "section", f"at {axis} = {position * 1e3:g} mm leaves nothing of the body", "move it"
        )
    return kept


def _colors(
    body: Result | Design | Mesh,
    mesh: Mesh,
    surface: Boundary,
    field: str | ArrayLike | None,
    label: str,
) -> _Colors:
    if field is None:
        field = "displacement" if isinstance(body, Result) else "plain"
    flat = np.tile(rgb(_PLAIN_COLOR), (len(surface.triangles), 1))
    lined = surface.cavity >= 0
    if _is(field, "part"):
        palette = np.array([rgb(color) for color in (_PLAIN_COLOR, *SERIES[1:])])
        return _Colors(palette[(surface.part - 1) % len(palette)])
    walls = np.array([rgb(color) for color in SERIES[1:]])
    flat[lined] = walls[surface.cavity[lined] % len(walls)]
    if _is(field, "plain"):
        return _Colors(flat)
    values, label = _values(body, mesh, field, label)
    of_corners = values[surface.triangles]
    # With a field on the outside, cavity walls keep their own color to be recognized.
    outside = surface.triangles if lined.all() else surface.triangles[~lined]
    # Most of a body has no contact, so that 99 % of its area say little.
    whole = _is(field, "displacement") or _is(field, "contact_pressure")
    shown = color_range(values, outside, mesh.vertices, clip=not whole)
    return _Colors(flat, of_corners, shown, label, ~lined, _clipped(shown, values, mesh))


def _clipped(shown: ColorRange, values: Floats, mesh: Mesh) -> str:
    ends = ((shown.clips_high, "max", shown.most), (shown.clips_low, "min", shown.least))
    return "".join(
        f"\nclipped at {CLIP:g} %; {word} {values[vertex]:.4g} at "
        f"({', '.join(f'{x * 1e3:.1f}' for x in mesh.vertices[vertex])}) mm"
        for clips, word, vertex in ends
        if clips
    )


def _values(
    body: Result | Design | Mesh, mesh: Mesh, field: str | ArrayLike, label: str
) -> tuple[Floats, str]:
    if isinstance(field, str):
        of_result = _FIELDS if isinstance(body, Result) else {}
        if field not in of_result or not isinstance(body, Result):
            known = ["part", "plain", *of_result]
            raise MeshError("field", f'"{field}" is not known', closest(field, known))
        words, kind = of_result[field]
        if field == "displacement":
            numbers: Floats = np.linalg.norm(body.displacements, axis=1)
        elif field == "contact_pressure":
            if body.contact_field is None:
                what = "is that of a design with contact, and nothing touches in this one"
                raise MeshError("field", what, "add [[objects]] or [contact]")
            numbers = body.contact_field.pressure
        else:
            numbers = getattr(body.fields.at_vertices, field)
        scale = scale_for(numbers, kind)
        if field == "energy_density":
            scale = scale._replace(unit=scale.unit.replace("Pa", "J/m³"))
        return numbers * scale.factor, scale.label(words)
    values = np.asarray(field, dtype=np.float64)
    if values.shape != (len(mesh.vertices),):
        raise MeshError(
            "field",
            f"has shape {values.shape}; expected one number for each of "
            f"{len(mesh.vertices)} vertices",
        )
    if not np.isfinite(values).any():
        raise MeshError("field", "holds no finite number")
    return values, label


def _paint(
    seen: Raster,
    positions: Floats,
    surface: Boundary,
    colors: _Colors,
    camera: Camera,
    lines: bool | None,
) -> Floats:
    """Compute color and light for every pixel, (h, w, 3), white where there is no body."""
    shown = colors.flat[seen.triangle]
    if colors.values is not None and colors.range is not None and colors.colored is not None:
        values = seen.interpolate(colors.values)
        of_values = mapped(values, colors.range.low, colors.range.high)
        shown = np.where(colors.colored[seen.triangle][:, None], of_values, shown)
    normals = shading.normals_of(positions[surface.triangles])
    brightness = shading.lit(normals, camera)[seen.triangle]
    brightness *= shading.depth_contrast(seen) * shading.outlines(seen)
    flat = camera.project(positions)[:, :2][surface.triangles]
    if lines if lines is not None else _long_enough(flat):
        brightness *= shading.mesh_lines(seen, flat)
    return seen.spread(shown * brightness[:, None], 1.0)


def _long_enough(flat: Floats) -> bool:
    sides = np.linalg.norm(np.diff(flat, axis=1), axis=2)
    return bool(np.median(sides) > _SHORTEST_LINE * _FINER)


def _with_ghost(
    picture: Floats, seen: Raster, before: Raster, mesh: Mesh, surface: Boundary, camera: Camera
) -> Floats:
    """Draw the undeformed body pale behind the deformed one."""
    normals = shading.normals_of(mesh.vertices[surface.triangles])
    light = shading.lit(normals, camera)[before.triangle] * shading.outlines(before)
    pale = before.spread(_PALEST + (1.0 - _PALEST) * light, 1.0)
    return np.where(seen.covered[..., None], picture, pale[..., None])


def _averaged(picture: Floats) -> Floats:
    """Average the finer pixels of a picture."""
    height, width = picture.shape[0] // _FINER, picture.shape[1] // _FINER
    cropped = picture[: height * _FINER, : width * _FINER]
    averaged: Floats = cropped.reshape(height, _FINER, width, _FINER, 3).mean(axis=(1, 3))
    return averaged


def _figure(picture: Floats, camera: Camera, colors: _Colors, title: str) -> Figure:
    averaged = _averaged(picture)
    height, width = averaged.shape[:2]
    bar = 1.1 if colors.range is not None else 0.0
    figure = empty_figure(max(width / 150, 3.0) + bar, max(height / 150, 1.6) + 0.9)
    axes = figure.add_subplot(label="body")
    axes.imshow(np.clip(averaged, 0.0, 1.0), interpolation="antialiased")
    axes.set_axis_off()
    if title:
        axes.set_title(title, fontsize=11, loc="left")
    if colors.range is not None:
        _color_bar(figure, axes, colors, colors.range)
    _scale_bar(axes, camera, width, height)
    _directions(axes, camera, width, height)
    return figure


def _color_bar(figure: Figure, axes: Axes, colors: _Colors, shown: ColorRange) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    mappable = ScalarMappable(norm=Normalize(shown.low, shown.high), cmap=COLOR_MAP)
    bar: Any = figure.colorbar(
        mappable, ax=axes, shrink=0.75, aspect=24, pad=0.03, extend=shown.extend
    )
    bar.set_label(colors.label + colors.clipped, fontsize=10)
    bar.outline.set_visible(False)
    bar.ax.set_label("colorbar")


def _scale_bar(axes: Axes, camera: Camera, width: int, height: int) -> None:
    """Draw a bar of 1, 2 or 5 times a power of ten, about a fifth of the picture long."""
    meter = 1.0 / (camera.pixel * _FINER)
    aim = 0.2 * width / meter
    power = 10.0 ** np.floor(np.log10(aim))
    length = power * max(step for step in (1, 2, 5) if step * power <= aim * (1 + 1e-9))
    scale: Scale = scale_for(length, "length")
    y = height + 0.05 * height + 14
    axes.plot([0, length * meter], [y, y], color="black", linewidth=2, clip_on=False)
    text = f"{round(length * scale.factor, 6):g} {scale.unit}"
    axes.text(length * meter / 2, y + 8, text, ha="center", va="top", fontsize=9)
    axes.set_xlim(0, width)
    axes.set_ylim(y + 34, 0)


def _directions(axes: Axes, camera: Camera, width: int, height: int) -> None:
    """Draw the axes of space as they are seen, in the corner across from the scale bar."""
    size = 34.0
    center = np.array([width - 1.4 * size, height + 0.05 * height + 6])
    for name, across, along in zip("xyz", camera.right, camera.up, strict=True):
        tip = center + size * np.array([across, -along])
        arrow = {
            "arrowstyle": "-|>",
            "color": "black",
            "linewidth": 1.0,
            "shrinkA": 0,
            "shrinkB": 0,
        }
        axes.annotate("", tuple(tip), tuple(center), arrowprops=arrow, annotation_clip=False)
        if np.hypot(across, along) > 0.15:
            beside = center + 1.28 * size * np.array([across, -along])
            axes.text(beside[0], beside[1], name, ha="center", va="center", fontsize=9)
