//! `_core.ProblemParts`: clamps, loads, contact and attachments of a problem before it is made. Long because one Python
//! class collects all inputs of a problem, each kind in a method.

use std::sync::Arc;

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use voxsoft_contact::surface::Surface;
use voxsoft_contact::surface_contact::Flip;
use voxsoft_contact::surface_contact::law::Adhesive;
use voxsoft_contact::surface_contact::rigid::Frame;
use voxsoft_solid::fluid::{Network, Walls};
use voxsoft_solid::matrix::Mat3;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Attachment, Carried, Clamp, CutSurface, Dielectric, Drag, DragLaw, Element, Filling, Floor,
    Fluid, ForceField, Gravity, History, Hydrostatic, Images, Load, LoadKind, Membrane,
    MembraneMaterial, Membranes, Mirrored, Motion, PointForces, Pressure, ProblemError,
};

use crate::arrays::rows;
use crate::errors::to_python;
use crate::formula::PyFormula;
use crate::plain::plain;
use crate::skin::PySkin;
use crate::surface_contact::{BodyPart, BondPart, ContactParts, Freedom, ObjectPart, Way, Whole};
use crate::tendon::TendonPart;

/// A load history: times in s and factors.
type HistoryArgument = Option<(Vec<f64>, Vec<f64>)>;

fn history(argument: HistoryArgument) -> Result<History, ProblemError> {
    match argument {
        Some((times, factors)) => History::new(times, factors),
        None => Ok(History::constant()),
    }
}

fn motion(
    displacement: Option<Vec3>,
    axis: Vec3,
    angle: f64,
    center: Vec3,
    history: HistoryArgument,
) -> Result<Option<Motion>, ProblemError> {
    let Some(displacement) = displacement else {
        return Ok(None);
    };
    let history = self::history(history)?;
    Ok(Some(Motion {
        displacement,
        axis,
        angle,
        center,
        history,
        courses: None,
    }))
}

/// Collects clamps and loads before the problem is made.
#[pyclass(name = "ProblemParts", module = "voxsoft._core")]
#[derive(Default)]
pub struct PyProblemParts {
    pub(crate) clamps: Vec<Clamp>,
    pub(crate) loads: Vec<Load>,
    pub(crate) floor: Option<Floor>,
    pub(crate) membranes: Vec<(Vec<[u32; 3]>, MembraneMaterial)>,
    pub(crate) block_fraction: Vec<f64>,
    pub(crate) block_filling: Vec<Filling>,
    pub(crate) block_axes: Vec<Mat3>,
    pub(crate) coarse: Vec<[u32; 8]>,
    pub(crate) attachments: Vec<Attachment>,
    pub(crate) touch: Option<ContactParts>,
    pub(crate) tendons: Vec<(TendonPart, History)>,
    pub(crate) dielectrics: Vec<Load>,
    pub(crate) fluid: Option<Fluid>,
}

#[pymethods]
impl PyProblemParts {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    #[pyo3(signature = (vertices, axes, displacement=None, axis=[0.0, 0.0, 1.0], angle=0.0, center=[0.0; 3], history=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn clamp(
        &mut self,
        vertices: PyReadonlyArray1<'_, u32>,
        axes: [bool; 3],
        displacement: Option<Vec3>,
        axis: Vec3,
        angle: f64,
        center: Vec3,
        history: HistoryArgument,
    ) -> PyResult<()> {
        let motion = motion(displacement, axis, angle, center, history).map_err(to_python)?;
        let vertices = vertices.as_array().to_vec();
        self.clamps.push(Clamp {
            vertices,
            axes,
            motion,
        });
        Ok(())
    }

    #[pyo3(signature = (acceleration, history=None))]
    fn gravity(&mut self, acceleration: Vec3, history: HistoryArgument) -> PyResult<()> {
        self.load(Gravity { acceleration }, history)
    }

    /// Adds a pressure on triangles and on the given parts of cut tetrahedra; with `closed` they enclose a volume, if
    /// need be together with planes of symmetry through the origin.
    #[pyo3(signature = (triangles, pressure, history=None, voids=None, closed=false))]
    fn pressure(
        &mut self,
        triangles: PyReadonlyArray2<'_, u32>,
        pressure: f64,
        history: HistoryArgument,
        voids: VoidsArgument<'_>,
        closed: bool,
    ) -> PyResult<()> {
        let triangles = rows("triangles", &triangles)?;
        let voids = self::voids(voids)?;
        self.load(
            Pressure {
                triangles,
                voids,
                pressure,
                closed,
            },
            history,
        )
    }

    #[pyo3(signature = (vertices, forces, history=None))]
    fn forces(
        &mut self,
        vertices: PyReadonlyArray1<'_, u32>,
        forces: PyReadonlyArray2<'_, f64>,
        history: HistoryArgument,
    ) -> PyResult<()> {
        let forces = rows("forces", &forces)?;
        let vertices = vertices.as_array().to_vec();
        self.load(PointForces { vertices, forces }, history)
    }

    /// Adds the hydrostatic pressure of a liquid within triangles and the given parts of cut tetrahedra: it grows by
    /// `slope` (Pa/m) from `origin` (m).
    #[pyo3(signature = (triangles, slope, origin, history=None, voids=None))]
    fn hydrostatic(
        &mut self,
        triangles: PyReadonlyArray2<'_, u32>,
        slope: Vec3,
        origin: Vec3,
        history: HistoryArgument,
        voids: VoidsArgument<'_>,
    ) -> PyResult<()> {
        let load = Hydrostatic {
            triangles: rows("triangles", &triangles)?,
            voids: self::voids(voids)?,
            slope,
            origin,
        };
        self.load(load, history)
    }

    /// Adds the drag of a fluid on triangles of vertices, or of the points of a skin on the vertices from `first` on: its
    /// density (kg/m³), the coefficients along the normal and the surface, the speed (m/s) of the linear part, and its
    /// flow (m/s). Areas count by their `share`.
    #[pyo3(signature = (triangles, law, flow, share, history=None, skin=None, first=0))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn drag(
        &mut self,
        triangles: PyReadonlyArray2<'_, u32>,
        law: [f64; 4],
        flow: Vec3,
        share: f64,
        history: HistoryArgument,
        skin: Option<PyRef<'_, PySkin>>,
        first: u32,
    ) -> PyResult<()> {
        let triangles: Vec<[u32; 3]> = rows("triangles", &triangles)?;
        let surface = match &skin {
            Some(skin) => Surface {
                points: skin.0.surface.points.clone(),
                triangles,
            },
            None => Surface::of_triangles(&triangles),
        };
        let moved = |point: Carried| Carried {
            vertices: point.vertices.iter().map(|v| v + first).collect(),
            ..point
        };
        let [density, normal, tangential, linear] = law;
        let law = DragLaw {
            density,
            normal,
            tangential,
            linear,
            flow,
        };
        let points = surface.points.into_iter().map(moved).collect();
        self.load(Drag::new(points, surface.triangles, share, law), history)
    }

    /// Adds an acceleration (m/s²) of vertices by a formula for each of its components.
    #[pyo3(signature = (vertices, formulas, history=None))]
    fn force_field(
        &mut self,
        vertices: PyReadonlyArray1<'_, u32>,
        formulas: [PyRef<'_, PyFormula>; 3],
        history: HistoryArgument,
    ) -> PyResult<()> {
        let formulas = formulas.map(|formula| formula.0.clone());
        let vertices = vertices.as_array().to_vec();
        self.load(ForceField::new(vertices, formulas), history)
    }

    /// Sets the gas or liquid in chambers: a network by the names of its fields, and for each of its chambers the walls,
    /// as triangles with their voids and weight.
    fn fluid(
        &mut self,
        network: &Bound<'_, PyAny>,
        walls: Vec<Vec<WallArgument<'_>>>,
    ) -> PyResult<()> {
        let network: Network = plain("network", network)?;
        let wall = |(triangles, voids, weight): WallArgument<'_>| {
            Ok(Pressure {
                triangles: rows("triangles", &triangles)?,
                voids: self::voids(voids)?,
                pressure: weight,
                closed: true,
            })
        };
        let chamber = |walls: Vec<WallArgument<'_>>| walls.into_iter().map(wall).collect();
        let walls: Vec<Walls> = walls.into_iter().map(chamber).collect::<PyResult<_>>()?;
        self.fluid = Some(Fluid::new(network, walls).map_err(to_python)?);
        Ok(())
    }

    fn floor(&mut self, z: f64) {
        self.floor = Some(Floor { z });
    }

    /// Adds an attached energy term: the name of its kind, and its elements by the names of their fields.
    fn attach(&mut self, kind: &str, elements: &Bound<'_, PyAny>) -> PyResult<()> {
        let tagged = PyDict::new(elements.py());
        tagged.set_item(kind, elements)?;
        self.attachments.push(plain(kind, &tagged)?);
        Ok(())
    }

    /// Adds a dielectric sheet between compliant electrodes: the corners of its voxels, the gradients of the
    /// deformation along two directions in the sheet and across it by each corner (1/m, a row for each corner of each
    /// voxel), their volumes (m³), and half of the permittivity times the square of the field as drawn (Pa). Sheets
    /// come after tendons.
    #[pyo3(signature = (corners, gradients, volumes, pressure, history=None))]
    fn dielectric(
        &mut self,
        corners: PyReadonlyArray2<'_, u32>,
        gradients: PyReadonlyArray2<'_, f64>,
        volumes: PyReadonlyArray1<'_, f64>,
        pressure: f64,
        history: HistoryArgument,
    ) -> PyResult<()> {
        let corners: Vec<[u32; 8]> = rows("corners", &corners)?;
        let gradients: Vec<Vec3> = rows("gradients", &gradients)?;
        let volumes = volumes.as_array();
        let (gradients, rest) = gradients.as_chunks::<8>();
        if gradients.len() != corners.len() || volumes.len() != corners.len() || !rest.is_empty() {
            let message = format!(
                "dielectric: {} voxels, gradients of {} and {} volumes",
                corners.len(),
                gradients.len(),
                volumes.len()
            );
            return Err(PyValueError::new_err(message));
        }
        let each = corners.into_iter().zip(gradients).zip(volumes);
        let elements = each.map(|((vertices, gradients), &volume)| Element {
            vertices,
            gradients: *gradients,
            volume,
        });
        let kind = Dielectric {
            elements: elements.collect(),
            pressure,
        };
        let history = self::history(history).map_err(to_python)?;
        let kind = kind.into();
        self.dielectrics.push(Load { kind, history });
        Ok(())
    }

    /// Adds a tendon, by the names of its fields; tendons come after all other loads except dielectric sheets.
    #[pyo3(signature = (tendon, history=None))]
    fn tendon(&mut self, tendon: &Bound<'_, PyAny>, history: HistoryArgument) -> PyResult<()> {
        let part = plain("tendon", tendon)?;
        let history = self::history(history).map_err(to_python)?;
        self.tendons.push((part, history));
        Ok(())
    }

    /// Sets the directions of the edges of each block, three unit vectors one after the other, (v, 9).
    fn axes(&mut self, axes: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let rows: Vec<[f64; 9]> = rows("axes", &axes)?;
        let matrix =
            |row: &[f64; 9]| std::array::from_fn(|i| std::array::from_fn(|j| row[3 * i + j]));
        self.block_axes = rows.iter().map(matrix).collect();
        Ok(())
    }

    /// Adds a body to contact with itself, others and objects: its boundary, its voxel size in m, and the number of
    /// parts into which contact points divide the edge of a voxel. A smooth surface `skin`, which numbers the vertices
    /// of the body from 0, replaces the voxel surface. Bodies come in the order of their vertices.
    #[pyo3(signature = (surface, voxel_size, refine, skin=None, first=0, count=None))]
    fn touch(
        &mut self,
        surface: PyReadonlyArray2<'_, u32>,
        voxel_size: f64,
        refine: u32,
        skin: Option<PyRef<'_, PySkin>>,
        first: u32,
        count: Option<u32>,
    ) -> PyResult<()> {
        self.touch.get_or_insert_default().bodies.push(BodyPart {
            surface: rows("surface", &surface)?,
            voxel: voxel_size,
            refine,
            skin: skin.map(|skin| Arc::clone(&skin.0)),
            vertices: first..count.map_or(u32::MAX, |count| first + count),
        });
        Ok(())
    }

    /// Adds a rigid object that is fixed, or moves as a clamp does.
    #[pyo3(signature = (points, triangles, displacement=None, axis=[0.0, 0.0, 1.0], angle=0.0, center=[0.0; 3], history=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn object(
        &mut self,
        points: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        displacement: Option<Vec3>,
        axis: Vec3,
        angle: f64,
        center: Vec3,
        history: HistoryArgument,
    ) -> PyResult<()> {
        let motion = motion(displacement, axis, angle, center, history).map_err(to_python)?;
        let points: Vec<Vec3> = rows("points", &points)?;
        let frame = Frame::around(&points);
        self.add_object(points, &triangles, frame, Way::Held(motion))
    }

    /// Adds a free rigid object: its mass in kg, center of mass in m, principal axes (unit vectors, row by row), and
    /// the roots of its second moments of mass along them over its mass, in m. Where planes of symmetry cut it, it is
    /// `held` along the axes across them, and a `share` of its mass counts.
    #[pyo3(signature = (points, triangles, mass, center, axes, radii, share=1.0, held=[false; 3]))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn free_object(
        &mut self,
        points: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        mass: f64,
        center: Vec3,
        axes: [Vec3; 3],
        radii: Vec3,
        share: f64,
        held: [bool; 3],
    ) -> PyResult<()> {
        let frame = Frame::of_mass(center, axes, radii).map_err(to_python)?;
        let way = Way::Free(Freedom { mass, share, held });
        self.add_object(rows("points", &points)?, &triangles, frame, way)
    }

    /// Adds the mirror image of the free object with the number `of`; its vectors are multiplied by `signs`.
    fn image_object(
        &mut self,
        points: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        of: usize,
        signs: Vec3,
    ) -> PyResult<()> {
        let points: Vec<Vec3> = rows("points", &points)?;
        let frame = Frame::around(&points);
        self.add_object(points, &triangles, frame, Way::Image(of, signs))
    }

    /// Lets contact act on a whole body of which the problem has a symmetric part: its vertices as images of those of
    /// the part, the corners of its voxels by its own vertices, and for each plane the axis across it and the images of
    /// all vertices.
    fn whole(
        &mut self,
        images: ImagesArgument<'_>,
        voxels: PyReadonlyArray2<'_, u32>,
        planes: Vec<(usize, PyReadonlyArray1<'_, u32>)>,
    ) -> PyResult<()> {
        let flip = |(axis, images): &(usize, PyReadonlyArray1<'_, u32>)| Flip {
            axis: *axis,
            images: images.as_array().to_vec(),
        };
        self.touch.get_or_insert_default().whole = Some(Whole {
            images: self::images(&images)?,
            voxels: rows("voxels", &voxels)?,
            flips: planes.iter().map(flip).collect(),
        });
        Ok(())
    }

    /// Sets the friction coefficients between all bodies and the objects after them; NaN where they do not touch.
    fn friction(&mut self, table: PyReadonlyArray2<'_, f64>) {
        let rows = table
            .as_array()
            .rows()
            .into_iter()
            .map(|row| row.to_vec())
            .collect();
        self.touch.get_or_insert_default().friction = rows;
    }

    /// Bonds two surfaces, the one with the smaller number first, where they are within `reach` (m) of each other, up
    /// to a traction of `strength` (Pa).
    fn bond(&mut self, a: u32, b: u32, reach: f64, strength: f64) {
        let bond = BondPart {
            of: [a, b],
            reach,
            strength,
        };
        self.touch.get_or_insert_default().bonds.push(bond);
    }

    /// Sets a traction between two surfaces of up to `strength` (Pa) within a `range` (m) that draws them together.
    fn adhesion(&mut self, a: u32, b: u32, strength: f64, range: f64) -> PyResult<()> {
        let law = Adhesive::new(strength, range).map_err(to_python)?;
        let parts = self.touch.get_or_insert_default();
        parts.laws.set([a, b], Arc::new(law));
        Ok(())
    }

    /// Adds a membrane on triangles.
    fn membrane(
        &mut self,
        triangles: PyReadonlyArray2<'_, u32>,
        young: f64,
        poisson: f64,
        thickness: f64,
        density: f64,
    ) -> PyResult<()> {
        let material = MembraneMaterial {
            young,
            poisson,
            thickness,
            density,
        };
        self.membranes
            .push((rows("triangles", &triangles)?, material));
        Ok(())
    }

    /// Adds a part of a membrane on triangles whose corners are mirror images; `points` are the rest positions of the
    /// images.
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn mirrored_membrane(
        &mut self,
        images: ImagesArgument<'_>,
        points: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        young: f64,
        poisson: f64,
        thickness: f64,
        density: f64,
        share: f64,
    ) -> PyResult<()> {
        let points: Vec<Vec3> = rows("points", &points)?;
        let material = MembraneMaterial {
            young,
            poisson,
            thickness,
            density,
        };
        let membrane = |triangle: [u32; 3]| {
            let corner = |v: u32| points.get(v as usize).copied().unwrap_or([f64::NAN; 3]);
            let whole = Membrane::new(triangle, triangle.map(corner), material);
            whole.map(|m| m.with_share(share)).map_err(to_python)
        };
        let triangles: Vec<[u32; 3]> = rows("triangles", &triangles)?;
        let membranes = triangles.into_iter().map(membrane);
        let membranes = Membranes(membranes.collect::<PyResult<_>>()?);
        let mirrored = Mirrored::new(self::images(&images)?, membranes);
        self.attachments
            .push(Attachment::MirroredMembranes(mirrored));
        Ok(())
    }

    /// Adds a pressure on triangles whose corners are mirror images: parts of a closed surface.
    #[pyo3(signature = (images, triangles, pressure, history=None))]
    fn mirrored_pressure(
        &mut self,
        images: ImagesArgument<'_>,
        triangles: PyReadonlyArray2<'_, u32>,
        pressure: f64,
        history: HistoryArgument,
    ) -> PyResult<()> {
        let load = Pressure {
            triangles: rows("triangles", &triangles)?,
            voids: Vec::new(),
            pressure,
            closed: true,
        };
        self.load(Mirrored::new(self::images(&images)?, load), history)
    }

    /// Sets the filled part of each block, and the moments of its material: center and spread along the axes, and the
    /// means of the products of two coordinates, in halves of an edge.
    #[pyo3(signature = (fractions, moments=None, surfaces=None))]
    fn fractions(
        &mut self,
        fractions: PyReadonlyArray1<'_, f64>,
        moments: Option<PyReadonlyArray2<'_, f64>>,
        surfaces: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<()> {
        self.block_fraction = fractions.as_array().to_vec();
        let rows: Vec<[f64; 9]> = moments.map_or(Ok(Vec::new()), |m| rows("moments", &m))?;
        let filling = |[x, y, z, a, b, c, yz, zx, xy]: [f64; 9]| Filling {
            shift: [x, y, z],
            spread: [a, b, c],
            products: [yz, zx, xy],
            surface: CutSurface::NONE,
        };
        self.block_filling = rows.into_iter().map(filling).collect();
        let rows: Vec<[f64; 9]> =
            surfaces.map_or(Ok(Vec::new()), |s| self::rows("surfaces", &s))?;
        for (filling, [x, y, z, a, b, c, d, e, f]) in self.block_filling.iter_mut().zip(rows) {
            filling.surface = CutSurface::of([x, y, z], [[a, b], [c, d], [e, f]]);
        }
        Ok(())
    }

    /// Sets groups of eight blocks that form one voxel of twice the side.
    fn coarse(&mut self, groups: PyReadonlyArray2<'_, u32>) -> PyResult<()> {
        self.coarse = rows("groups", &groups)?;
        Ok(())
    }
}

/// Triangles, voids, and the weight of both.
type WallArgument<'py> = (PyReadonlyArray2<'py, u32>, VoidsArgument<'py>, f64);

/// Tetrahedra and the part of each that is void.
type VoidsArgument<'py> = Option<(PyReadonlyArray2<'py, u32>, PyReadonlyArray1<'py, f64>)>;

/// Vertex of each image, and the factors on its vectors.
type ImagesArgument<'py> = (PyReadonlyArray1<'py, u32>, PyReadonlyArray2<'py, f64>);

fn images((of, signs): &ImagesArgument<'_>) -> PyResult<Images> {
    Ok(Images {
        of: of.as_array().to_vec(),
        signs: rows("signs", signs)?,
    })
}

fn voids(argument: VoidsArgument<'_>) -> PyResult<Vec<([u32; 4], f64)>> {
    let Some((tets, parts)) = argument else {
        return Ok(Vec::new());
    };
    let tets: Vec<[u32; 4]> = rows("voids", &tets)?;
    let parts = parts.as_array().to_vec();
    if tets.len() != parts.len() {
        let message = format!("voids: {} tets and {} parts", tets.len(), parts.len());
        return Err(PyValueError::new_err(message));
    }
    Ok(tets.into_iter().zip(parts).collect())
}

impl PyProblemParts {
    fn add_object(
        &mut self,
        points: Vec<Vec3>,
        triangles: &PyReadonlyArray2<'_, u32>,
        frame: Frame,
        way: Way,
    ) -> PyResult<()> {
        let object = ObjectPart {
            points,
            triangles: rows("triangles", triangles)?,
            frame,
            way,
        };
        self.touch.get_or_insert_default().objects.push(object);
        Ok(())
    }

    fn load(&mut self, kind: impl Into<LoadKind>, history: HistoryArgument) -> PyResult<()> {
        let history = self::history(history).map_err(to_python)?;
        let kind = kind.into();
        self.loads.push(Load { kind, history });
        Ok(())
    }
}
