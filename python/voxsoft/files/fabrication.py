"""Molds as a folder: files for a printer, a sheet of instructions, and all numbers."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from voxsoft.errors import DesignError, details_as_data
from voxsoft.fabrication import Cast, Fabrication
from voxsoft.fabrication.patterns import Pattern
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath, save
from voxsoft.files.surfaces import write_surfaces
from voxsoft.plot.solids import Solid, plot_solids
from voxsoft.units import format_quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOWER, _UPPER, _CASTING, _PRINTED = "#9fb8c8", "#c9d4db", "#e8b88a", "#b9b4c9"
_WAYS: Final = {
    "cast": "Cast in one mold",
    "core": "Cast around a core that is drawn out through an opening",
    "halves": "Cast in halves and bonded",
    "lost-core": "Cast around a core that is lost",
    "printed": "Printed directly",
}
_STYLE: Final = """
body { font: 15px/1.55 system-ui, sans-serif; max-width: 54rem; margin: 2rem auto; padding: 0 1rem;
  color: #1a1a1a; background: #fff }
h1 { font-size: 1.7rem; margin-bottom: 0.2rem } h2 { font-size: 1.2rem; margin-top: 2rem }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; width: 100% }
th, td { padding: 0.3rem 0.6rem; text-align: right; border-bottom: 1px solid #ddd }
th { border-bottom: 2px solid #888 } th:first-child, td:first-child { text-align: left }
li { margin: 0.5rem 0 } figure { margin: 1rem 0; break-inside: avoid } img { max-width: 100% }
figcaption, .quiet { color: #555; font-size: 0.9rem } .bad { color: #a63c00 }
.row { display: flex; flex-wrap: wrap; gap: 1rem; align-items: flex-end }
@media print { body { margin: 0; max-width: none; font-size: 11pt } h2 { break-after: avoid } }
"""


def fabrication_summary(made: Fabrication, suffix: str = ".3mf") -> dict[str, Any]:
    """Return all numbers of molds as plain data: lengths in m, volumes in m³, masses in kg."""
    surfaces = made.surfaces()
    parts = [
        {"name": name, "file": f"{name}{suffix}", "volume": _volume(*surface)}
        for name, surface in surfaces.items()
    ]
    return {
        "way": made.way,
        "why": made.why,
        "parts": parts,
        "castings": [
            {
                "name": cast.casting.name,
                "material": cast.casting.component.material,
                "volume": cast.volume,
                "poured": cast.poured,
                "mass": cast.mass,
                "deviation": cast.deviation,
                "trapped_air": cast.mold.trapped,
                "shrinkage": cast.shrinkage,
                "thicker": cast.mold.thicker,
                "open": cast.mold.is_open,
                "before": list(cast.before),
            }
            for cast in made.casts
        ],
        "walls": [
            {"component": each.component, "thickness": each.thickness, "at": list(each.place)}
            for each in made.walls
        ],
        "deviation": made.deviation,
        "volume": {"described": made.described, "poured": made.poured},
        "trapped_air": made.trapped_air,
        "pour": {
            "a": sum(cast.a for cast in made.casts),
            "b": sum(cast.b for cast in made.casts),
            "waste": sum(cast.waste for cast in made.casts),
        },
        "inlets": [
            {"chamber": each.chamber, "at": list(each.at), "diameter": 2.0 * each.radius}
            for each in made.inlets
        ],
        "patterns": [
            {"file": f"{name}.svg", "axes": each.axes, "size": list(each.size), "area": each.area}
            for name, each in made.patterns.items()
        ],
        "notes": list(made.notes),
        "problems": details_as_data(made.problems),
    }


def write_fabrication(made: Fabrication, folder: FilePath, *, stl: bool = False) -> Path:
    """Write molds as a folder that someone with a printer can follow.

    Parameters
    ----------
    made
        Result of :func:`voxsoft.fabrication.make`.
    folder
        Folder; it is made, and files in it are replaced. It then holds a file for each part,
        an ``.svg`` in true size for each flat layer, ``sheet.html``, ``make.json`` and
        ``design.toml``.
    stl
        True for parts as ``.stl`` in mm instead of ``.3mf``.

    Raises
    ------
    DesignError
        A proof failed; all of them are listed, and nothing is written.
    FileError
        A file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> import voxsoft as vs
    >>> from voxsoft.fabrication import make
    >>> from voxsoft.units import mm
    >>> bar = vs.Part(shape=vs.Box(size=(20 * mm, 8 * mm, 6 * mm)), material="ecoflex-00-30")
    >>> made = make(vs.Design(name="bar", voxel_size=2 * mm, parts=[bar]))
    >>> sorted(each.name for each in write_fabrication(made, tempfile.mkdtemp()).iterdir())
    ['design.toml', 'make.json', 'part-1-lower.3mf', 'sheet.html']
    """
    if made.problems:
        raise DesignError.listing(made.problems)
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    suffix = ".stl" if stl else ".3mf"
    for name, surface in made.surfaces().items():
        write_surfaces(target / f"{name}{suffix}", {name: surface})
    for name, pattern in made.patterns.items():
        write_atomically(target / f"{name}.svg", pattern_as_svg(pattern))
    summary = fabrication_summary(made, suffix)
    write_atomically(target / "make.json", json.dumps(summary, indent=2) + "\n")
    save(made.design, target / "design.toml")
    write_atomically(target / "sheet.html", "\n".join(_sheet(made, suffix)) + "\n")
    return target


def pattern_as_svg(pattern: Pattern) -> str:
    """Return the outline of a layer as SVG in true size, its second axis up.

    Examples
    --------
    >>> square = np.array([[0, 0], [0.01, 0], [0.01, 0.01], [0, 0.01], [0, 0]])
    >>> print(pattern_as_svg(Pattern("felt", "xy", (square,), (0.01, 0.01), 1e-4)), end="")
    <svg xmlns="http://www.w3.org/2000/svg" width="10mm" height="10mm" viewBox="0 0 10 10">
    <title>felt</title>
    <path fill="none" stroke="black" stroke-width="0.1" d="M0 10L10 10L10 0L0 0Z"/>
    </svg>
    """
    wide, tall = (1e3 * each for each in pattern.size)
    lines = []
    for outline in (*pattern.outlines, *pattern.lines):
        points = [f"{1e3 * x:.6g} {tall - 1e3 * y + 0.0:.6g}" for x, y in outline]
        closed = bool((outline[0] == outline[-1]).all())
        lines.append(f"M{'L'.join(points[:-1])}Z" if closed else f"M{'L'.join(points)}")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide:.6g}mm" height="{tall:.6g}mm" '
        f'viewBox="0 0 {wide:.6g} {tall:.6g}">\n<title>{escape(pattern.name)}</title>\n'
        f'<path fill="none" stroke="black" stroke-width="0.1" d="{"".join(lines)}"/>\n</svg>\n'
    )


def _volume(vertices: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def _sheet(made: Fabrication, suffix: str) -> Iterator[str]:
    name = escape(made.design.name)
    yield "<!doctype html>"
    yield f'<html lang="en"><meta charset="utf-8"><title>{name}: molds</title>'
    yield f"<style>{_STYLE}</style>"
    yield f"<h1>{name}</h1>"
    why = f" {made.why[:1].upper()}{made.why[1:]}." if made.why else ""
    yield f"<p>{_WAYS[made.way]}.{escape(why)}</p>"
    yield from _print_table(made, suffix)
    yield from _mix_table(made)
    yield "<h2>Steps</h2><ol>"
    yield from (f"<li>{escape(step)}" for step in made.before)
    for cast in made.casts:
        yield from _cast_steps(cast)
    yield from _joining_steps(made)
    yield "</ol>"
    yield from _proof_table(made)
    yield "</html>"


def _print_table(made: Fabrication, suffix: str) -> Iterator[str]:
    yield "<h2>Print</h2><table><tr><th>File<th>Size in mm<th>Volume in cm³"
    for name, (vertices, triangles) in made.surfaces().items():
        size = 1e3 * (vertices.max(axis=0) - vertices.min(axis=0))
        shown = " x ".join(f"{each:.1f}" for each in size)
        volume = 1e6 * _volume(vertices, triangles)
        yield f"<tr><td>{escape(name)}{suffix}<td>{shown}<td>{volume:.1f}"
    yield "</table><p class=quiet>Platinum silicones do not cure on fresh resin prints: cure such "
    yield "prints fully and coat them. Release agent helps on filament prints.</p>"


def _mix_table(made: Fabrication) -> Iterator[str]:
    if not made.casts:
        return
    yield "<h2>Mix</h2><table><tr><th>Casting<th>Silicone<th>A in g<th>B in g<th>of it waste in g"
    yield "<th>Pot life<th>Cure"
    for cast in made.casts:
        title, times = cast.casting.component.material, "<td>see its bulletin<td>see its bulletin"
        second = "<td>by its bulletin"
        if cast.data is not None:
            title = cast.data.title
            pot, cure = cast.data.pot_life / 60.0, cast.data.cure / 3600.0
            times = f"<td>{pot:.3g} min<td>{cure:.3g} h"
            second = f"<td>{1e3 * cast.b:.1f}"
        yield (
            f"<tr><td>{escape(cast.casting.name)}<td>{escape(title)}<td>{1e3 * cast.a:.1f}{second}"
            f"<td>{1e3 * cast.waste:.1f}{times}"
        )
    yield "</table>"
    sources = sorted({cast.data.source for cast in made.casts if cast.data is not None})
    mass = sum(cast.mass for cast in made.casts)
    yield f"<p class=quiet>Expected mass of all castings: {1e3 * mass:.1f} g. "
    shrinking = max(cast.shrinkage for cast in made.casts)
    if shrinking > 0.0:
        yield f"Molds are larger by up to {100.0 * shrinking:.2g} %: silicone shrinks. "
    yield f"{escape('; '.join(sources))}</p>"


def _cast_steps(cast: Cast) -> Iterator[str]:
    name = escape(cast.casting.name)
    mold = cast.mold
    for step in cast.before:
        yield f"<li>{escape(step)}"
    if cast.casting.first:
        core = escape(mold.parts[-1].name)
        yield f"<li>Put {escape(cast.casting.first)}, with its thread, into the mold of {name}, "
        yield f"over the core of {core}."
    elif cast.casting.inserts > 0.0:
        yield "<li>Hold each core at its place in the mold by spacers of cured silicone, as thick "
        yield "as the wall there."
    if mold.is_open:
        yield f"<li>Pour {name} into {escape(mold.parts[0].name)} to the brim and level it with a "
        yield "straight edge; bubbles rise out."
    else:
        vents = sum(each.kind == "vent" for each in mold.openings)
        yield f"<li>Put {escape(mold.parts[1].name)} on {escape(mold.parts[0].name)}: the thin pin "
        yield "goes into the thin socket. Clamp the flanges. Hold it level and pour "
        full = "in the vent" if vents == 1 else f"in all {vents} vents" if vents else "in it"
        yield f"{name} through the funnel until silicone stands {full}."
    yield "<div class=row>"
    yield from _figure(_exploded(cast), f"Mold of {cast.casting.name}, open")
    yield "</div>"
    if mold.is_open:
        yield "<li>After the cure, push the casting out."
    else:
        yield "<li>After the cure, cut the vents and the sprue, draw the upper part straight up, "
        yield "and push the casting out of the lower part."


def _joining_steps(made: Fabrication) -> Iterator[str]:
    for plan in made.plans:
        if plan.cut is not None:
            low, high = (escape(each.name) for each in plan.castings)
            yield f"<li>Spread a thin film of the same silicone on the seam of {low} "
            yield f"({1e6 * plan.cut.seam:.0f} mm²), put {high} on it and let it cure under its "
            yield "own weight."
    components = {plan.component.name for plan in made.plans}
    if len(components) + sum(each.kind == "rigid" for each in made.printed) > 1:
        yield "<li>Bond the components with silicone adhesive, as they touch in the design."
    before = {*made.before, *(step for cast in made.casts for step in cast.before)}
    for note in made.notes:
        if note not in before:
            yield f"<li>{escape(note)}"
    if any(plan.way == "lost-core" for plan in made.plans):
        yield "<li>Melt or dissolve the cores and rinse through the inlets."
    plates = [each for each in made.printed if each.kind == "plate"]
    if plates:
        names = escape(", ".join(each.name for each in plates))
        yield f"<li>Bond {names} to the clamped faces with silicone adhesive."
    for inlet in made.inlets:
        at = ", ".join(f"{1e3 * each + 0.0:.3g}" for each in inlet.at)
        tube = format_quantity(made.printer.tube, "length")
        yield f"<li>Push a tube of {tube} into the inlet of {escape(inlet.chamber)} at ({at}) mm "
        yield "and seal it."


def _proof_table(made: Fabrication) -> Iterator[str]:
    if not made.casts:
        return
    yield "<h2>Proofs</h2><table><tr><th>Casting<th>Volume in mm³<th>of the mold in mm³"
    yield "<th>largest deviation in mm<th>trapped air in mm³"
    for cast in made.casts:
        yield (
            f"<tr><td>{escape(cast.casting.name)}<td>{1e9 * cast.volume:.1f}"
            f"<td>{1e9 * cast.poured:.1f}<td>{1e3 * cast.deviation:.3f}"
            f"<td>{1e9 * cast.mold.trapped:.1f}"
        )
    yield "</table><p class=quiet>Each part is one closed solid, leaves along its direction "
    yield "without meeting the casting, and is nowhere thinner than the wall of the printer.</p>"
    for wall in made.walls:
        at = ", ".join(f"{round(1e3 * each, 1) + 0.0:g}" for each in wall.place)
        yield f"<p class=quiet>The thinnest wall of {escape(wall.component)} is "
        yield f"{1e3 * wall.thickness:.3g} mm thick, at ({at}) mm.</p>"
    yield "<p class=quiet>Stretch while a casting leaves its mold is not computed: no part has "
    yield "an undercut deeper than 0.1 mm, so that the casting need not stretch.</p>"


def _exploded(cast: Cast) -> Figure:
    """Draw the parts of a mold along their direction, with the casting between."""
    mold = cast.mold
    low, high = mold.surface.bounds
    gap = 0.5 * float(high[2] - low[2]) + 0.01
    lift = np.array([0.0, 0.0, 1.0])
    lower = mold.parts[0].surface
    solids: list[Solid] = [(lower.vertices, lower.triangles, _LOWER)]
    height = float(lower.vertices[:, 2].max())
    rise = max(height - low[2], 0.0) + gap
    solids.append((mold.surface.vertices + rise * lift, mold.surface.triangles, _CASTING))
    if not mold.is_open:
        upper = mold.parts[1].surface
        above = float(high[2]) + rise + gap - float(upper.vertices[:, 2].min())
        solids.append((upper.vertices + above * lift, upper.triangles, _UPPER))
    return plot_solids(solids)


def _figure(figure: Figure, words: str) -> Iterator[str]:
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png", dpi=100)
    data = base64.b64encode(drawn.getvalue()).decode("ascii")
    yield f'<figure><img alt="{escape(words)}" src="data:image/png;base64,{data}">'
    yield f"<figcaption>{escape(words)}</figcaption></figure>"
