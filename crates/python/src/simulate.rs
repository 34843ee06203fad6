//! `_core.Problem` and its XPBD solvers. Long because one Python class collects all inputs of a problem, each kind in a
//! method.
use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_contact::surface_contact::Flip;
use voxsoft_contact::surface_contact::law::Adhesive;
use voxsoft_contact::surface_contact::rigid::Frame;
use voxsoft_solid::balance::{balance_under, total_load_under};
use voxsoft_solid::fluid::{Network, Walls};
use voxsoft_solid::matrix::Mat3;
use voxsoft_solid::vector::{Vec3, sub};
use voxsoft_solid::{
    Attachment, Body, Brick, Clamp, Dielectric, Element, Filling, Floor, Fluid, Gravity, History,
    Hydrostatic, Images, Load, LoadKind, Material, Membrane, MembraneMaterial, Membranes, Mesh,
    Mirrored, Motion, PointForces, Pressure, Problem, ProblemError, State, elastic,
};
use voxsoft_xpbd::{Answer, Damping, Dynamics, Relaxation, Status, Trial, relax, simulate};

use crate::answer::PyAnswer;
use crate::arrays::{from_rows, rows};
use crate::errors::to_python;
use crate::gate;
use crate::handle::{Handle, PyMemory};
use crate::materials::PyMaterial;
use crate::skin::PySkin;
use crate::tendon::{PyTendon, TendonPart, tendons};
use crate::touch::{
    BodyPart, BondPart, Freedom, ObjectPart, TouchParts, Touching, Way, Whole, touch_of,
};
use crate::watch::{Watch, collect_sensors};

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
    }))
}

/// A mechanical problem: a body with clamps, loads and a floor.
#[pyclass(frozen, name = "Problem", module = "voxsoft._core")]
pub struct PyProblem {
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) materials: Arc<Vec<Material>>,
    pub(crate) problem: Arc<Handle>,
    pub(crate) touching: Option<Arc<Touching>>,
}

/// Collects clamps and loads before the problem is made.
#[pyclass(name = "ProblemParts", module = "voxsoft._core")]
#[derive(Default)]
pub struct PyProblemParts {
    clamps: Vec<Clamp>,
    loads: Vec<Load>,
    floor: Option<Floor>,
    membranes: Vec<(Vec<[u32; 3]>, MembraneMaterial)>,
    block_fraction: Vec<f64>,
    block_filling: Vec<Filling>,
    block_axes: Vec<Mat3>,
    coarse: Vec<[u32; 8]>,
    attachments: Vec<Attachment>,
    touch: Option<TouchParts>,
    tendons: Vec<(TendonPart, History)>,
    dielectrics: Vec<Load>,
    fluid: Option<Fluid>,
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

    /// Sets the gas or liquid in chambers: a network as JSON, and for each of its chambers the walls, as triangles with
    /// their voids and weight.
    fn fluid(&mut self, network: &str, walls: Vec<Vec<WallArgument<'_>>>) -> PyResult<()> {
        let network: Network = serde_json::from_str(network)
            .map_err(|error| PyValueError::new_err(format!("network: {error}")))?;
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

    /// Adds an attached energy term: the name of its kind, and its elements as JSON.
    fn attach(&mut self, kind: &str, elements: &str) -> PyResult<()> {
        let tagged = format!("{{{kind:?}:{elements}}}");
        let attachment = serde_json::from_str(&tagged)
            .map_err(|error| PyValueError::new_err(format!("{kind}: {error}")))?;
        self.attachments.push(attachment);
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

    /// Adds a tendon, as JSON; tendons come after all other loads except dielectric sheets.
    #[pyo3(signature = (tendon, history=None))]
    fn tendon(&mut self, tendon: &str, history: HistoryArgument) -> PyResult<()> {
        let part = serde_json::from_str(tendon)
            .map_err(|error| PyValueError::new_err(format!("tendon: {error}")))?;
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
    #[pyo3(signature = (fractions, moments=None))]
    fn fractions(
        &mut self,
        fractions: PyReadonlyArray1<'_, f64>,
        moments: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<()> {
        self.block_fraction = fractions.as_array().to_vec();
        let rows: Vec<[f64; 9]> = moments.map_or(Ok(Vec::new()), |m| rows("moments", &m))?;
        let filling = |[x, y, z, a, b, c, yz, zx, xy]: [f64; 9]| Filling {
            shift: [x, y, z],
            spread: [a, b, c],
            products: [yz, zx, xy],
        };
        self.block_filling = rows.into_iter().map(filling).collect();
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

#[pymethods]
impl PyProblem {
    #[new]
    fn new(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        tets: PyReadonlyArray2<'_, u32>,
        tet_part: PyReadonlyArray1<'_, u8>,
        tet_block: PyReadonlyArray1<'_, u32>,
        materials: Vec<PyMaterial>,
        parts: PyRef<'_, PyProblemParts>,
    ) -> PyResult<Self> {
        let mut mesh = Mesh {
            vertices: rows("vertices", &vertices)?,
            tets: rows("tets", &tets)?,
            tet_part: tet_part.as_array().to_vec(),
            tet_block: tet_block.as_array().to_vec(),
            block_fraction: parts.block_fraction.clone(),
            block_filling: parts.block_filling.clone(),
            block_axes: parts.block_axes.clone(),
            coarse: parts.coarse.clone(),
            membranes: Vec::new(),
            attachments: parts.attachments.clone(),
            point_masses: Vec::new(),
        };
        let count = mesh.vertices.len();
        for (triangles, material) in &parts.membranes {
            for triangle in triangles {
                if let Some(&index) = triangle.iter().find(|&&v| v as usize >= count) {
                    let what = "vertex of a membrane";
                    let index = index as usize;
                    return Err(to_python(ProblemError::Index { what, index, count }));
                }
                let corners = triangle.map(|v| mesh.vertices[v as usize]);
                let membrane = Membrane::new(*triangle, corners, *material).map_err(to_python)?;
                mesh.membranes.push(membrane);
            }
        }
        Self::assemble(py, mesh, materials, &parts)
    }

    /// Copy of the problem with the same body and loads and other materials.
    fn with_materials(&self, py: Python<'_>, materials: Vec<PyMaterial>) -> PyResult<Self> {
        let now = self.now();
        let parts = PyProblemParts {
            clamps: now.clamps().to_vec(),
            loads: now.loads().to_vec(),
            floor: now.floor(),
            membranes: Vec::new(),
            block_fraction: Vec::new(),
            block_filling: Vec::new(),
            block_axes: Vec::new(),
            coarse: Vec::new(),
            attachments: Vec::new(),
            touch: None,
            tendons: Vec::new(),
            dielectrics: Vec::new(),
            fluid: now.fluid().cloned(),
        };
        let mut mesh = Mesh::clone(&self.mesh);
        let mut parts = parts;
        if let Some(touching) = &self.touching {
            mesh.vertices.truncate(touching.first);
            let own = parts.clamps.len() - touching.parts.held();
            mesh.point_masses.clear();
            parts.clamps.truncate(own);
            parts.touch = Some(touching.parts.clone());
        }
        Self::assemble(py, mesh, materials, &parts)
    }

    #[getter]
    fn mass(&self) -> f64 {
        self.now().body().masses()[..self.own()].iter().sum()
    }

    #[getter]
    fn masses<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.now().body().masses()[..self.own()])
    }

    /// Edges of the lattice as (vertices, rest length, stiffness) arrays.
    #[expect(clippy::type_complexity, reason = "three arrays")]
    fn edges<'py>(
        &self,
        py: Python<'py>,
    ) -> (
        Bound<'py, PyArray2<u32>>,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<f64>>,
    ) {
        let now = self.now();
        let edges = now.body().edges();
        let vertices: Vec<[u32; 2]> = edges.iter().map(|edge| edge.vertices).collect();
        let collect = |value: fn(&voxsoft_solid::Edge) -> f64| edges.iter().map(value).collect();
        (
            from_rows(py, &vertices),
            PyArray1::from_vec(py, collect(|edge| edge.length)),
            PyArray1::from_vec(py, collect(|edge| edge.stiffness)),
        )
    }

    /// Pressure (Pa, positive in tension) in each hyperelastic voxel, on the vertex at its lowest corner; NaN on other
    /// vertices.
    fn pressures<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let positions = self.positions(&positions)?;
        let now = self.now();
        let body = now.body();
        let pressures = body.brick_term().pressures(&positions);
        let mut found = vec![f64::NAN; self.own()];
        for (index, brick) in body.small_bricks().iter().enumerate() {
            found[brick.vertices[0] as usize] = pressures[body.element_of(index)];
        }
        Ok(PyArray1::from_vec(py, found))
    }

    /// Largest isochoric energy (J/m³) so far of each hyperelastic voxel, if any has the Mullins effect.
    fn peaks<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let peaks = self.now().body().brick_term().peaks()?;
        Some(PyArray1::from_vec(py, peaks))
    }

    /// Sets the largest isochoric energies (J/m³) so far of hyperelastic voxels.
    fn set_peaks(&self, peaks: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        let (got, expected) = (peaks.len()?, self.now().body().bricks().len());
        if got != expected {
            let what = "peaks of voxels";
            return Err(to_python(ProblemError::Length {
                what,
                got,
                expected,
            }));
        }
        let peaks = peaks.as_array().to_vec();
        self.problem.change(|problem| problem.set_peaks(&peaks));
        Ok(())
    }

    /// Elastic energy in J and forces in N at the given positions.
    fn elastic<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<(f64, Bound<'py, PyArray2<f64>>)> {
        let positions = self.positions(&positions)?;
        let mut forces = vec![[0.0; 3]; positions.len()];
        let now = self.now();
        elastic::add_forces(now.body(), &positions, &mut forces);
        if let Some(contact) = now.contact() {
            let mut others = vec![[0.0; 3]; positions.len()];
            contact.add_forces(&positions, &mut others);
            for (force, other) in forces.iter_mut().zip(others) {
                *force = sub(*force, other);
            }
        }
        let energy = self.elastic_energy(&positions);
        Ok((energy, from_rows(py, &forces[..self.own()])))
    }

    /// Elastic plus external force (N) on every vertex under the final values of all loads. Tendons marked in `taut`
    /// stay taut.
    #[pyo3(signature = (positions, taut=vec![]))]
    fn net_forces<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
        taut: Vec<bool>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions = self.positions(&positions)?;
        let mut forces = vec![[0.0; 3]; positions.len()];
        let now = self.now();
        let problem = now.with_taut_tendons(&taut);
        problem.add_loads(&positions, f64::INFINITY, &mut forces);
        elastic::add_forces(now.body(), &positions, &mut forces);
        Ok(from_rows(py, &forces[..self.own()]))
    }

    /// Tendons at the given positions under the final values of all loads, as if loaded in one step.
    fn tendons(
        &self,
        py: Python<'_>,
        positions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Vec<Py<PyTendon>>> {
        let positions = self.positions(&positions)?;
        let mut problem = Problem::clone(&self.now());
        problem.start_loads();
        let factor_of = |load: &Load| load.history.at(f64::INFINITY);
        tendons(py, &problem, &positions, &factor_of)
    }

    /// Measures a moving state of all vertices, objects included, under the loads at its time: nothing is solved.
    fn measure(
        &self,
        py: Python<'_>,
        positions: PyReadonlyArray2<'_, f64>,
        velocities: PyReadonlyArray2<'_, f64>,
        time: f64,
        memory: &PyMemory,
        residual: f64,
    ) -> PyResult<PyAnswer> {
        let positions = self.positions(&positions)?;
        let velocities = rows("velocities", &velocities)?;
        if velocities.len() != positions.len() {
            let message = format!(
                "velocities: {} rows, expected {}",
                velocities.len(),
                positions.len()
            );
            return Err(PyValueError::new_err(message));
        }
        let there = self.with(|problem| problem.remember(&memory.0));
        let answer = Answer {
            state: State {
                positions,
                velocities,
                time,
            },
            status: Status::NotAtRest,
            residual,
            steps: 0,
            back_offs: 0,
            substep: 0.0,
            breakdown: None,
        };
        let watch = Watch::new(None, Vec::new(), false);
        there.answer(py, answer, watch, &|load| load.history.at(time))
    }

    /// Relaxes to equilibrium. `trial` is a number of steps and the residual above which the run then ends.
    #[pyo3(signature = (*, tolerance, max_steps, trial=None, start=None, progress=None))]
    fn relax(
        &self,
        py: Python<'_>,
        tolerance: f64,
        max_steps: u64,
        trial: Option<(u64, f64)>,
        start: Option<PyReadonlyArray2<'_, f64>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyAnswer> {
        let settings = Relaxation {
            tolerance,
            max_steps,
            trial: trial.map(|(steps, residual)| Trial { steps, residual }),
        };
        let problem = self.now();
        let mut state = State::at_rest(problem.body());
        if let Some(start) = start {
            state.positions = self.positions(&start)?;
        }
        let mut watch = Watch::new(progress, Vec::new(), false);
        let answer = gate::run(py, |cancel| {
            relax(&problem, state, &settings, &mut |now| {
                watch.see(now, cancel)
            })
        })?;
        let there = self.with(|_| ());
        there.answer(py, answer, watch, &|load| load.history.at(f64::INFINITY))
    }

    #[pyo3(signature = (*, time_step, substeps, iterations, damping, retardation, end_time, max_time, tolerance,
        record_interval=None, sensors=vec![], frames=false, progress=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn simulate(
        &self,
        py: Python<'_>,
        time_step: f64,
        substeps: Option<u32>,
        iterations: u32,
        damping: Option<f64>,
        retardation: f64,
        end_time: Option<f64>,
        max_time: f64,
        tolerance: f64,
        record_interval: Option<f64>,
        sensors: Vec<(PyReadonlyArray1<'_, u32>, PyReadonlyArray1<'_, f64>)>,
        frames: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyAnswer> {
        let damping = damping.map_or(Damping::Critical, Damping::Rate);
        let settings = Dynamics {
            time_step,
            substeps,
            iterations,
            damping,
            retardation,
            end_time,
            max_time,
            tolerance,
            deterministic: false,
            record_interval,
        };
        let problem = self.now();
        let state = State::at_rest(problem.body());
        let mut watch = Watch::new(progress, collect_sensors(&sensors), frames);
        let answer = gate::run(py, |cancel| {
            simulate(&problem, state, &settings, &mut |now| {
                watch.see(now, cancel)
            })
        })?;
        let time = answer.state.time;
        let there = self.with(|problem| problem.begin(time));
        there.answer(py, answer, watch, &|load| load.history.at(time))
    }
}

impl PyProblem {
    fn assemble(
        py: Python<'_>,
        mesh: Mesh,
        materials: Vec<PyMaterial>,
        parts: &PyProblemParts,
    ) -> PyResult<Self> {
        let materials: Vec<Material> = materials.into_iter().map(|given| given.0).collect();
        let (mut clamps, mut loads, floor) =
            (parts.clamps.clone(), parts.loads.clone(), parts.floor);
        let first = mesh.vertices.len();
        for (tendon, history) in parts.tendons.iter().cloned() {
            let load = tendon.load(history, parts.touch.as_ref(), first);
            let missing = || PyValueError::new_err("tendon: there is no such object");
            loads.push(load.ok_or_else(missing)?);
        }
        loads.extend(parts.dielectrics.iter().cloned());
        let touch = parts.touch.clone();
        let fluid = parts.fluid.as_ref().map(Fluid::anew);
        gate::run_owned(py, move |_| {
            let mut mesh = mesh;
            if let Some(parts) = &touch {
                parts.add_frames(&mut mesh, &mut clamps);
            }
            let body = Body::new(&mesh, &materials)?;
            let mut problem = Problem::new(body, clamps, loads, floor)?;
            if let Some(fluid) = fluid.transpose()? {
                problem = problem.with_fluid(fluid)?;
            }
            let mut touching = None;
            if let Some(parts) = touch {
                if let Some(springs) = parts.frame_springs(problem.body(), first) {
                    problem = problem.with_term(Arc::new(springs))?;
                }
                let (made, contact) = parts.into_touching(&problem, first)?;
                problem = problem.with_contact(contact)?;
                touching = Some(Arc::new(made));
            }
            Ok(Self {
                mesh: Arc::new(mesh),
                materials: Arc::new(materials),
                problem: Arc::new(Handle::new(problem)),
                touching,
            })
        })?
        .map_err(to_python)
    }

    /// Present problem with its history variables.
    pub(crate) fn now(&self) -> Arc<Problem> {
        self.problem.now()
    }

    /// Copy of the problem, changed by `act` (its history variables, say).
    pub(crate) fn with(&self, act: impl FnOnce(&mut Problem)) -> Self {
        let mut problem = Problem::clone(&self.now());
        act(&mut problem);
        Self {
            mesh: Arc::clone(&self.mesh),
            materials: Arc::clone(&self.materials),
            problem: Arc::new(Handle::new(problem)),
            touching: self.touching.clone(),
        }
    }

    /// Elastic energy of the material, J, without the energy of contact.
    fn elastic_energy(&self, positions: &[Vec3]) -> f64 {
        let now = self.now();
        let of_contact = now
            .contact()
            .map_or(0.0, |contact| contact.energy(positions));
        elastic::energy(now.body(), positions) - of_contact
    }

    /// Number of vertices of the body, without those of objects.
    pub(crate) fn own(&self) -> usize {
        let all = self.now().body().rest().len();
        self.touching
            .as_ref()
            .map_or(all, |touching| touching.first)
    }

    /// Pressures in the order of hyperelastic voxels, read at the vertices at their lowest corners.
    pub(crate) fn brick_pressures(&self, array: &PyReadonlyArray1<'_, f64>) -> PyResult<Vec<f64>> {
        let array = array.as_array();
        let now = self.now();
        let bricks = now.body().bricks();
        let pressure = |brick: &Brick| array.get(brick.vertices[0] as usize).copied();
        let found: Option<Vec<f64>> = bricks.iter().map(pressure).collect();
        match found {
            Some(found) if found.iter().all(|p| p.is_finite()) => Ok(found),
            _ => Err(PyValueError::new_err(
                "pressures: a voxel has none at its lowest corner",
            )),
        }
    }

    pub(crate) fn positions(&self, array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Vec3>> {
        let mut positions = rows("positions", array)?;
        let expected = self.now().body().rest().len();
        if let Some(touching) = &self.touching
            && positions.len() == touching.first
        {
            positions = touching.completed(&self.now(), positions);
        }
        if positions.len() != expected {
            let message = format!("positions: {} rows, expected {expected}", positions.len());
            return Err(PyValueError::new_err(message));
        }
        Ok(positions)
    }

    /// Converts an answer for Python; `self` has the history variables of its end, and reactions are those under loads
    /// with these factors.
    pub(crate) fn answer(
        self,
        py: Python<'_>,
        answer: Answer,
        watch: Watch,
        factor_of: &dyn Fn(&Load) -> f64,
    ) -> PyResult<PyAnswer> {
        if let Some(raised) = watch.raised {
            return Err(raised);
        }
        let positions = &answer.state.positions;
        let own = self.own();
        let problem = self.now();
        let (contacts, objects) = match &self.touching {
            Some(touching) => (
                touching.contacts(py, &problem, positions)?,
                touching.poses(py, &touching.seen(positions)[touching.own()..])?,
            ),
            None => (Vec::new(), Vec::new()),
        };
        let touching = self.touching.as_ref();
        let contact_field = touching
            .zip(touch_of(&problem))
            .map(|(touching, touch)| touching.field(py, touch, positions))
            .transpose()?;
        let balance = balance_under(&problem, positions, factor_of);
        let (load, load_moment) = total_load_under(&problem, positions, factor_of);
        let sensors = watch.sensors.len();
        let now = problem.fluid().map_or(Vec::new(), |fluid| {
            fluid.read(positions, fluid.instant(factor_of))
        });
        let now: Vec<[f64; 6]> = now.iter().map(|reading| reading.numbers()).collect();
        let read = if watch.chambers.is_empty() {
            0
        } else {
            watch.recorded
        };
        let frames = if watch.keep_frames { watch.recorded } else { 0 };
        Ok(PyAnswer {
            status: answer.status.into(),
            positions: from_rows(py, &positions[..own]).unbind(),
            velocities: from_rows(py, &answer.state.velocities[..own]).unbind(),
            time: answer.state.time,
            residual: answer.residual,
            steps: answer.steps,
            back_offs: answer.back_offs,
            substep: answer.substep,
            breakdown: answer.breakdown.map(|b| (b.vertex, b.rest, b.when)),
            reactions: from_rows(py, &balance.reactions[..own]).unbind(),
            reaction: balance.total_reaction(),
            reaction_moment: balance.total_moment(positions),
            load,
            load_moment,
            elastic_energy: self.elastic_energy(positions),
            record_times: PyArray1::from_vec(py, watch.times).unbind(),
            records: PyArray1::from_vec(py, watch.records)
                .reshape([watch.recorded, sensors, 3])?
                .unbind(),
            frames: PyArray1::from_vec(py, cut(watch.frames, positions.len(), own))
                .reshape([frames, own, 3])?
                .unbind(),
            path: None,
            chambers: from_rows(py, &now).unbind(),
            chamber_records: PyArray1::from_vec(py, watch.chambers)
                .reshape([read, now.len(), 6])?
                .unbind(),
            contacts,
            objects,
            history: None,
            tendons: tendons(py, &problem, positions, factor_of)?,
            problem: Py::new(py, self)?,
            contact_field,
        })
    }
}

/// Keeps the first `own` of every `all` points.
fn cut(frames: Vec<f64>, all: usize, own: usize) -> Vec<f64> {
    if own == all {
        return frames;
    }
    let each = frames
        .chunks_exact(3 * all)
        .flat_map(|frame| &frame[..3 * own]);
    each.copied().collect()
}
