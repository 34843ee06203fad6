"""Registry of file formats: suffixes, reader, writer, and contents that a file of each can hold.

A format is one entry here. The readers of meshes and surfaces, :func:`voxsoft.files.write_mesh`,
``voxsoft export`` and its help, the studio's lists and ``docs/reference/formats.md`` follow it.
Readers and writers are named by module and function and are imported at their first use, so that
help and lists cost no import.

Long because it holds an entry for each format.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Final, Literal

#: Subject of a file: volume cells, triangles, an array of voxels, a robot with its objects and
#: drives for another program, the states of a path or a motion, a design, a table, or the columns
#: of an instrument.
Kind = Literal["cells", "surface", "voxels", "scene", "series", "design", "table", "measured"]
#: Heading of the files of each kind.
HEADINGS: Final[dict[Kind, str]] = {
    "cells": "Mesh",
    "surface": "Surface",
    "voxels": "Voxels",
    "scene": "Scene",
    "series": "Series",
    "design": "Design",
    "table": "Table",
    "measured": "Measured data",
}
#: Contents beside the geometry that a written file keeps.
Holding = Literal["parts", "regions", "cavities", "values"]


@dataclass(frozen=True)
class Format:
    """A file format.

    Attributes
    ----------
    suffixes
        Suffixes of its files, in lower case; the first one is the usual one.
    kind
        Subject of a file.
    title
        Name of the format and of the programs that it is for.
    reader
        Function from a path to :class:`~voxsoft.formats.contents.Contents`, as
        ``"module:function"``; None if the format is not read. Of ``measured`` it takes the path
        and :class:`~voxsoft.instruments.options.Options`.
    taken
        Contents that the reader takes, for the documentation.
    writer
        Function that writes a file, as ``"module:function"``; None if the format is not written.
        Of ``cells`` it takes the path and a :class:`~voxsoft.files.mesh_file.MeshFile`; of
        ``surface`` the path and vertices and triangles of each surface by its name, in the unit of
        the file; of others the path and a :class:`~voxsoft.files.exports.Source`. Of ``scene`` and
        ``series`` it returns :class:`~voxsoft.errors.ErrorDetail` of all that the file does not
        hold.
    holds
        Contents beside the geometry that a written file keeps.
    purpose
        Use of a written file, as a sentence.
    computation
        Function that writes the whole computation of a design, as ``"module:function"``; None where
        a file holds a shape alone.
    units
        Units of length of such a file.
    unit
        Reason why an export takes no unit, after the suffix; None where it takes one.
    length
        Unit of the lengths of a written file that takes none.
    states
        Units that a file to read states, or those that are asked for.
    parts
        Parts of a body, or columns, that come of it.
    trap
        Usual fault with such files, and limits of the reader.
    command
        Command that reads one.
    """

    suffixes: tuple[str, ...]
    kind: Kind
    title: str
    reader: str | None = None
    taken: str = ""
    writer: str | None = None
    holds: frozenset[Holding] = frozenset()
    purpose: str = ""
    computation: str | None = None
    units: tuple[str, ...] = ()
    unit: str | None = "is always in m"
    length: str = "m"
    states: str = ""
    parts: str = ""
    trap: str = ""
    command: str = ""

    @property
    def suffix(self) -> str:
        """Usual suffix."""
        return self.suffixes[0]

    @property
    def fixed_unit(self) -> str | None:
        """Unit of the lengths of a written file; None where it is given."""
        return None if self.unit is None else self.length

    @property
    def has_shape(self) -> bool:
        """True for files with vertices, which can be those of the loaded body."""
        return self.kind in ("cells", "surface")


#: All formats with a reader or writer here; :mod:`meshio` reads further ones.
FORMATS: Final = (
    Format(
        (".vtu",),
        "cells",
        "VTK unstructured grid, for ParaView and PyVista",
        reader="voxsoft.formats.vtk_xml:read",
        taken="cells of all components but ghosts and hidden ones, in any coding and compression, "
        "and an array such as `material` as parts; polyhedra are refused",
        writer="voxsoft.files.vtu:write",
        holds=frozenset({"parts", "regions", "cavities", "values"}),
        purpose="To look at displacement, stretch and stress in ParaView or PyVista.",
        states="none: give `--unit`",
        parts="numbers of an array such as `material`",
        trap="points that no cell uses are dropped; polyhedra are refused",
        command="voxsoft check body.vtu --unit m --voxel-size '2 mm'",
    ),
    Format(
        (".vti", ".vtp", ".vts", ".vtr"),
        "cells",
        "VTK image, polygons and grids",
        reader="voxsoft.formats.vtk_xml:read",
        taken="cells as in `.vtu`; in an image a brick for each cell, or around each point, whose "
        "label is not 0: whole numbers, at most 255, which are parts. Gray values are refused",
        states="none: give `--unit`",
        parts="labels 1 to 255 of an image",
        trap="gray values are no labels: segment the scan first",
        command="voxsoft check scan.vti --unit mm --voxel-size '2 mm'",
    ),
    Format(
        (".vtk",),
        "cells",
        "Legacy VTK of versions 1 to 5.1",
        reader="voxsoft.formats.vtk_legacy:read",
        taken="data sets of all kinds, as in the files above",
        states="none: give `--unit`",
        parts="as in `.vtu`",
        trap="SOFA's meshes may hold tetrahedra that overlap, and are refused then",
        command="voxsoft check body.vtk --unit m --voxel-size '2 mm'",
    ),
    Format(
        (".nrrd", ".nhdr"),
        "cells",
        "NRRD images; `pip install 'voxsoft[images]'`",
        reader="voxsoft.formats.images:read_nrrd",
        taken="a brick for each voxel whose label is not 0, as in images of VTK, at its place; "
        "left and posterior coordinates change their sign",
        states="in the file",
        parts="labels 1 to 255",
        trap="left and posterior axes are turned to right and anterior",
        command="voxsoft check scan.nrrd --voxel-size '2 mm'",
    ),
    Format(
        (".nii", ".nii.gz"),
        "cells",
        "NIfTI images; `pip install 'voxsoft[images]'`",
        reader="voxsoft.formats.images:read_nifti",
        taken="as of NRRD, in the unit of the file; labels as they are stored, not as they are "
        "scaled",
        states="in the file",
        parts="labels 1 to 255, as stored",
        trap="labels that a scale makes 0.988 are read unscaled",
        command="voxsoft check scan.nii.gz --voxel-size '2 mm'",
    ),
    Format(
        (".tif", ".tiff"),
        "cells",
        "Stacks of TIFF; `pip install 'voxsoft[images]'`",
        reader="voxsoft.formats.images:read_tiff",
        taken="as of NRRD, with the spacing and unit that ImageJ writes; colors are refused",
        states="in the file, by ImageJ",
        parts="labels 1 to 255",
        trap="three slices may have been saved as colors, and are refused",
        command="voxsoft check scan.tif --voxel-size '2 mm'",
    ),
    Format(
        (".msh",),
        "cells",
        "Gmsh 2.2 and 4.1",
        reader="voxsoft.formats.gmsh:read",
        taken="cells with physical groups, as text or binary: volumes are parts; points, curves "
        "and surfaces are regions, by name or number",
        writer="voxsoft.files.gmsh:write",
        holds=frozenset({"parts", "regions", "cavities"}),
        purpose="To go on in Gmsh or a code that reads its meshes.",
        states="none: give `--unit`",
        parts="physical groups of volumes",
        trap="without physical groups of volumes all is one part",
        command="voxsoft check body.msh --unit mm --voxel-size '2 mm'",
    ),
    Format(
        (".inp",),
        "cells",
        "Abaqus and CalculiX",
        reader="voxsoft.formats.abaqus:read",
        taken="nodes, elements and sets of flat decks and of assemblies, each instance at its "
        "place; element sets with a section are parts, or all where none has one",
        writer="voxsoft.files.abaqus:write",
        holds=frozenset({"parts", "regions", "cavities"}),
        purpose="To solve the same body in Abaqus or CalculiX and check this result.",
        computation="voxsoft.files.computations:write",
        units=("m", "mm", "um"),
        unit="is in m; of the computation of a design `--unit` may be m, mm or um",
        states="none: give `--unit`",
        parts="element sets with a section",
        trap="sets without a section are no parts, unless none has one",
        command="voxsoft check body.inp --unit mm --voxel-size '2 mm'",
    ),
    Format(
        (".mesh",),
        "cells",
        "Medit; `.vol`, `.bdf`, `.su2` and others of meshio alike",
        reader="voxsoft.formats.by_meshio:read",
        taken="cells, and an array such as `material` as parts",
        states="none: give `--unit`",
        parts="an array such as `material`",
        trap="read by meshio; polyhedra and curved cells are not known",
        command="voxsoft check body.mesh --unit mm --voxel-size '2 mm'",
    ),
    Format(
        (".stl",),
        "surface",
        "STL, for printers and CAD",
        reader="voxsoft.formats.stl:read",
        taken="triangles as text or binary; the solids of a text by name",
        writer="voxsoft.files.surface_formats.stl:write",
        holds=frozenset({"parts"}),
        purpose="To print the body or cut its mold; other programs read it as triangles.",
        unit=None,
        states="none: give `--unit`",
        parts="solids of a text by name",
        trap="a heap of loose triangles encloses nothing; holes are reported",
        command="voxsoft check part.stl --unit mm --voxel-size '2 mm'",
    ),
    Format(
        (".obj",),
        "surface",
        "Wavefront OBJ, for modelers",
        reader="voxsoft.formats.obj:read",
        taken="faces of any number of corners; objects, groups and materials by name",
        writer="voxsoft.files.surface_formats.obj:write",
        holds=frozenset({"parts"}),
        purpose="To open the surface in Blender and other modelers.",
        unit=None,
        states="none: give `--unit`",
        parts="objects, groups and materials",
        trap="curved surfaces as formulas are refused: export triangles",
        command="voxsoft check part.obj --unit mm --voxel-size '2 mm'",
    ),
    Format(
        (".3mf",),
        "surface",
        "3MF, for slicers and printers of several materials",
        reader="voxsoft.formats.threemf:read",
        taken="the objects that the build places, with components and transforms, in their unit; "
        "objects and materials by name. Supports and objects that nothing places are left out; "
        "lattices of beams, slices and encryption are refused",
        writer="voxsoft.files.surface_formats.threemf:write",
        holds=frozenset({"parts"}),
        purpose="To print the parts in their materials: one object, its parts by name, in mm.",
        unit="is in mm, and says so",
        length="mm",
        states="in the file",
        parts="objects and materials",
        trap="objects that nothing places and supports are left out",
        command="voxsoft check part.3mf --voxel-size '2 mm'",
    ),
    Format(
        (".ply",),
        "surface",
        "PLY, for scanners",
        reader="voxsoft.formats.ply:read",
        taken="vertices and faces of any number of corners, as text or binary",
        states="none: give `--unit`",
        parts="one",
        trap="scans are often open: holes are reported with their place",
        command="voxsoft check scan.ply --unit mm --voxel-size '2 mm'",
    ),
    Format(
        (".off",),
        "surface",
        "OFF",
        reader="voxsoft.formats.by_trimesh:read_after_meshio",
        taken="vertices and faces",
        states="none: give `--unit`",
        parts="one",
        trap="as of STL",
        command="voxsoft check part.off --unit mm --voxel-size '2 mm'",
    ),
    Format(
        (".glb",),
        "surface",
        "glTF binary",
        reader="voxsoft.formats.by_trimesh:read",
        taken="triangles of all meshes, each at its place and by its name; in m by definition, and "
        "turned from y up to z up",
        writer="voxsoft.files.surface_formats.glb:write",
        holds=frozenset({"parts"}),
        purpose="To show the body on web pages and in viewers, its parts by name.",
        states="m, by definition",
        parts="meshes by name",
        trap="turned from y up to z up; one with numbers in mm is 1,000 times too large",
        command="voxsoft check part.glb --voxel-size '2 mm'",
    ),
    Format(
        (".npy",),
        "voxels",
        "NumPy array of the voxels' parts",
        reader="voxsoft.formats.voxel_arrays:read_npy",
        taken="a cube for each voxel along the axes x, y, z whose label is not 0: whole numbers to "
        "255, which are parts, or booleans; the size of a voxel is asked for",
        writer="voxsoft.files.exports:write_voxels",
        holds=frozenset({"parts"}),
        purpose="To work on the voxels in Python: an array of part numbers.",
        unit="holds the parts of voxels, and no lengths",
        states="none: give the size of a voxel",
        parts="labels 1 to 255",
        trap="axes are x, y, z: images often come as z, y, x; floats are refused",
        command="voxsoft check scan.npy --unit '2 mm'",
    ),
    Format(
        (".vxa", ".vxc", ".vxd"),
        "voxels",
        "VoxCAD, Voxelyze and voxcraft-sim",
        reader="voxsoft.formats.voxel_arrays:read_voxcad",
        taken="a cube for each voxel whose digit is not 0, in layers as readable text; "
        "`Lattice_Dim` is its size, which is asked for in `.vxd` without it. Materials, "
        "environment and controllers are not read",
        states="`Lattice_Dim`, or the size of a voxel",
        parts="digits of the palette",
        trap="packed layers are refused; materials are not read",
        command="voxsoft check robot.vxa",
    ),
    Format(
        (".mat",),
        "voxels",
        "Array of MATLAB up to version 7",
        reader="voxsoft.formats.mat:read_voxels",
        taken="as of `.npy`, from the one array with three axes; whole numbers stored as doubles "
        "too. Its axes are x, y, z: images of MATLAB have y first",
        states="none: give the size of a voxel",
        parts="labels 1 to 255",
        trap="images of MATLAB have y first; version 7.3 is refused",
        command="voxsoft check scan.mat --unit '2 mm'",
    ),
    Format(
        (".xml",),
        "scene",
        "MJCF, for MuJoCo 4",
        writer="voxsoft.files.scenes.mjcf:write",
        holds=frozenset({"parts"}),
        purpose="To simulate the robot in MuJoCo: flexes, contact, tendons, loads as actuators.",
    ),
    Format(
        (".usda", ".usdc", ".usdz", ".usd"),
        "scene",
        "USD as text, binary or archive, for Omniverse, Blender and Houdini",
        writer="voxsoft.files.scenes.usd:write",
        holds=frozenset({"parts", "regions"}),
        purpose="To show the robot and its motion in Blender, Houdini or Omniverse.",
    ),
    Format(
        (".pvd",),
        "series",
        "States of a path or a motion as VTU files, for ParaView and PyVista",
        writer="voxsoft.files.series:write",
        holds=frozenset({"parts", "regions", "cavities", "values"}),
        purpose="To play a path in ParaView: the body at each value, with its objects.",
        unit="is always in m, its times in SI units",
    ),
    Format(
        (".csv",),
        "table",
        "Table: probes of a run folder; in the studio, curves over time",
        writer="voxsoft.files.exports:write_table",
        purpose="To plot probes, residual and energies in a spreadsheet or Python.",
        unit="has its units in its header",
    ),
    Format(
        (".toml",),
        "design",
        "Design, with values in place of formulas",
        writer="voxsoft.files.exports:write_design",
        purpose="To keep, cite or send the design: this page of text rebuilds everything.",
        unit="says the unit of each number",
    ),
    Format(
        (".csv", ".txt", ".tsv", ".dat", ".log", ".tra"),
        "measured",
        "Tables and logs as text: testing machines, loggers, ImageJ, DeepLabCut, Kinovea",
        reader="voxsoft.instruments.read:read_table",
        taken="columns of numbers below any preamble; commas, semicolons or tabs between them, "
        "decimal commas, separators of thousands; units in the header or below it; cells without "
        "a number are gaps",
        states="in the header or below it; asked for otherwise",
        parts="columns by name",
        trap="`1,500` may be 1.5 or 1500: refused where nothing decides; 50 MB at most",
        command="voxsoft material fit coupon.csv --area '18 mm^2' --length '33 mm'",
    ),
    Format(
        (".kva",),
        "measured",
        "Tracks of Kinovea",
        reader="voxsoft.instruments.tracked:read_kva",
        taken="points of each track with their names, in the coordinates of Kinovea's calibration",
        states="none: `unit=`, and `rate=` where times are frames",
        parts="`track x`, `track y`",
        trap="times in hundredths of a second are coarse: `rate=` replaces them; y may point down",
        command="voxsoft calibrate beam.toml test.toml --method gradient",
    ),
    Format(
        (".tdms",),
        "measured",
        "TDMS of LabVIEW and DAQmx; `pip install 'voxsoft[measured]'`",
        reader="voxsoft.instruments.tdms:read",
        taken="scaled channels with their units, each at its own rate and start",
        states="of the channels",
        parts="channels, as `group/channel`",
        trap="raw counts are no newtons: scales are applied; two rates are no one table",
        command="voxsoft material fit coupon.tdms --area '18 mm^2' --length '33 mm'",
    ),
    Format(
        (".c3d",),
        "measured",
        "C3D of motion capture; `pip install 'voxsoft[measured]'`",
        reader="voxsoft.instruments.c3d:read",
        taken="markers in their unit, hidden ones as gaps, and analog channels at their own rate; "
        "a file with more frames than the 65,535 that it can count is refused",
        states="of markers and of each channel",
        parts="`marker x`, `marker y`, `marker z`",
        trap="hidden markers are gaps, though files may hold 0, 0, 0; a camera has its own clock",
        command="voxsoft calibrate beam.toml test.toml --method gradient",
    ),
    Format(
        (".mat",),
        "measured",
        "MAT of MATLAB up to version 7",
        reader="voxsoft.instruments.mat:read",
        taken="vectors and columns of matrices, in structs too; whole numbers as floats; units "
        "behind the names, or given",
        states="none: `force_N`, or `units=`",
        parts="vectors, columns of matrices, fields of structs",
        trap="tables of MATLAB are hidden in MAT: save their columns; version 7.3 is refused",
        command="voxsoft material fit coupon.mat --area '18 mm^2' --length '33 mm'",
    ),
)

#: Formats that can be written, by each suffix.
WRITTEN: Final = {
    suffix: form for form in FORMATS if form.writer is not None for suffix in form.suffixes
}
#: Formats of meshes and surfaces that can be read, by suffix.
READ: Final = {
    suffix: form
    for form in FORMATS
    if form.reader is not None and form.kind != "measured"
    for suffix in form.suffixes
}
#: Formats of measured data, by suffix.
MEASURED: Final = {
    suffix: form for form in FORMATS if form.kind == "measured" for suffix in form.suffixes
}


def function(name: str) -> Callable[..., Any]:
    """Return the function ``"module:function"``.

    Examples
    --------
    >>> function("voxsoft.formats.stl:read").__name__
    'read'
    """
    module, _, attribute = name.partition(":")
    found: Callable[..., Any] = getattr(import_module(module), attribute)
    return found


def counts_voxels(name: str) -> bool:
    """Return True for a file whose coordinates count voxels, so that their size is its unit.

    Examples
    --------
    >>> counts_voxels("scan.npy"), counts_voxels("scan.nrrd")
    (True, False)
    """
    lower = name.lower()
    return any(form.kind == "voxels" and lower.endswith(end) for end, form in READ.items())


def suffixes_that_hold(*contents: Holding) -> str:
    """Return the suffixes of written meshes and surfaces that keep all of some contents.

    Examples
    --------
    >>> suffixes_that_hold("regions"), suffixes_that_hold("values")
    ('.vtu, .msh or .inp', '.vtu')
    """
    written = ((s, form) for s, form in WRITTEN.items() if form.has_shape)
    *first, last = [s for s, form in written if form.holds.issuperset(contents)]
    return f"{', '.join(first)} or {last}" if first else last
