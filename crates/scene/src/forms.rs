//! Serialized layout of a scene. Its contents are rebuilt by the constructors of `solid`, so that no damaged scene
//! becomes an invalid material or load.

use serde::{Deserialize, Serialize};
use voxsoft_player::{Cast, Control, Probe};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{self as solid, HyperelasticMaterial, LatticeConstants, LatticeMaterial};
use voxsoft_solid::{Attachment, LoadKind, Model, ProblemError};
use voxsoft_xpbd::{Damping, Dynamics};

use crate::{SceneError, touching};

#[derive(Serialize, Deserialize)]
pub(crate) struct Scene {
    notes: String,
    settings: Settings,
    mesh: Mesh,
    materials: Vec<Material>,
    clamps: Vec<Clamp>,
    loads: Vec<Load>,
    floor: Option<f64>,
    voxel_size: f64,
    triangles: Vec<[u32; 3]>,
    tags: Vec<u8>,
    topology: u32,
    controls: Vec<Control>,
    probes: Vec<Probe>,
    touching: Option<touching::Form>,
    positions: Option<Vec<Vec3>>,
}

#[derive(Serialize, Deserialize)]
struct Settings {
    time_step: f64,
    substeps: Option<u32>,
    iterations: u32,
    /// Rate in 1/s; `None` is critical damping.
    damping: Option<f64>,
    retardation: f64,
    tolerance: f64,
}

#[derive(Serialize, Deserialize)]
struct Mesh {
    vertices: Vec<Vec3>,
    tets: Vec<[u32; 4]>,
    tet_part: Vec<u8>,
    tet_block: Vec<u32>,
    block_fraction: Vec<f64>,
    /// Shift, spread and products of each block.
    block_filling: Vec<[Vec3; 3]>,
    /// Frame and areas of the surface in each block.
    block_surface: Vec<([Vec3; 3], [[f64; 2]; 3])>,
    /// Vertices, then Young's modulus, Poisson's ratio, thickness and density of each membrane.
    membranes: Vec<([u32; 3], [f64; 4])>,
    attachments: Vec<Attachment>,
    point_masses: Vec<(u32, f64)>,
}

#[derive(Serialize, Deserialize)]
enum Material {
    Lattice {
        edge: f64,
        bulk: f64,
        density: f64,
    },
    LatticeCompliance {
        edge: f64,
        volume: f64,
        density: f64,
    },
    Hyperelastic {
        model: Hyperelastic,
        bulk: f64,
        density: f64,
        /// Direction, modulus, resistance to compression, and free stretch of each family.
        fibers: Vec<(Vec3, f64, bool, f64)>,
        windings: Vec<Winding>,
        /// Share and time of each branch.
        prony: Vec<(f64, f64)>,
        /// Stretch at which it is free of stress, relative to the body at rest.
        swelling: f64,
    },
}

/// Fibers wound about an axis.
#[derive(Serialize, Deserialize)]
struct Winding {
    center: Vec3,
    axis: Vec3,
    angle: f64,
    modulus: f64,
    compression: bool,
    free: f64,
}

#[derive(Serialize, Deserialize)]
enum Hyperelastic {
    NeoHookean(f64),
    MooneyRivlin(f64, f64),
    Yeoh([f64; 3]),
    Ogden([(f64, f64); 3]),
    Gent(f64, f64),
}

/// Times and factors.
#[derive(Serialize, Deserialize)]
struct History(Vec<f64>, Vec<f64>);

#[derive(Serialize, Deserialize)]
struct Clamp {
    vertices: Vec<u32>,
    axes: [bool; 3],
    motion: Option<Motion>,
}

#[derive(Serialize, Deserialize)]
struct Motion {
    displacement: Vec3,
    axis: Vec3,
    angle: f64,
    center: Vec3,
    history: History,
}

#[derive(Serialize, Deserialize)]
struct Load {
    kind: LoadKind,
    history: History,
}

impl From<&crate::Scene> for Scene {
    fn from(scene: &crate::Scene) -> Self {
        Self {
            notes: scene.notes.clone(),
            settings: (&scene.settings).into(),
            mesh: (&scene.mesh).into(),
            materials: scene.materials.iter().map(Into::into).collect(),
            clamps: scene.clamps.iter().map(Into::into).collect(),
            loads: scene.loads.iter().map(Into::into).collect(),
            floor: scene.floor.map(|floor| floor.z),
            voxel_size: scene.voxel_size,
            triangles: scene.triangles.clone(),
            tags: scene.tags.clone(),
            topology: scene.cast.topology,
            controls: scene.cast.controls.clone(),
            probes: scene.cast.probes.clone(),
            touching: scene.touching.as_ref().map(Into::into),
            positions: scene.positions.clone(),
        }
    }
}

impl TryFrom<Scene> for crate::Scene {
    type Error = SceneError;

    fn try_from(form: Scene) -> Result<Self, SceneError> {
        let vertices = form.mesh.vertices.len();
        let known = |vertex: &u32| (*vertex as usize) < vertices;
        let probes_known = form.probes.iter().all(|probe| {
            probe.vertices.iter().all(known) && probe.vertices.len() == probe.weights.len()
        });
        let loads = form.loads.len();
        let touching = match form.touching {
            None => None,
            Some(touching) => {
                let found = touching.of_vertices(vertices);
                Some(found.ok_or(SceneError::Value("what touches"))?)
            }
        };
        let mut controlled = form.controls.iter().flat_map(|control| &control.loads);
        for (good, what) in [
            (form.floor.is_none_or(f64::is_finite), "height of the floor"),
            (probes_known, "a probe"),
            (controlled.all(|load| (*load as usize) < loads), "a control"),
        ] {
            good.then_some(()).ok_or(SceneError::Value(what))?;
        }
        Ok(Self {
            notes: form.notes,
            settings: form.settings.try_into()?,
            mesh: form.mesh.try_into()?,
            materials: all(form.materials)?,
            clamps: all(form.clamps)?,
            loads: all(form.loads)?,
            floor: form.floor.map(|z| solid::Floor { z }),
            voxel_size: form.voxel_size,
            triangles: form.triangles,
            tags: form.tags,
            cast: Cast {
                topology: form.topology,
                controls: form.controls,
                probes: form.probes,
            },
            touching,
            positions: form.positions,
        })
    }
}

fn all<T, U: TryFrom<T, Error = ProblemError>>(forms: Vec<T>) -> Result<Vec<U>, ProblemError> {
    forms.into_iter().map(U::try_from).collect()
}

impl From<&Dynamics> for Settings {
    fn from(settings: &Dynamics) -> Self {
        Self {
            time_step: settings.time_step,
            substeps: settings.substeps,
            iterations: settings.iterations,
            damping: match settings.damping {
                Damping::Rate(rate) => Some(rate),
                Damping::Critical => None,
            },
            retardation: settings.retardation,
            tolerance: settings.tolerance,
        }
    }
}

impl TryFrom<Settings> for Dynamics {
    type Error = SceneError;

    fn try_from(form: Settings) -> Result<Self, SceneError> {
        let rate = form.damping.unwrap_or_default();
        let numbers = [rate, form.retardation, form.tolerance, form.time_step];
        let finite = numbers.iter().all(|x| x.is_finite());
        if !(finite && form.time_step > 0.0 && form.substeps != Some(0)) {
            return Err(SceneError::Value("settings of the run"));
        }
        Ok(Self {
            time_step: form.time_step,
            substeps: form.substeps,
            iterations: form.iterations,
            damping: form.damping.map_or(Damping::Critical, Damping::Rate),
            retardation: form.retardation,
            tolerance: form.tolerance,
            ..Self::default()
        })
    }
}

impl From<&solid::Mesh> for Mesh {
    fn from(mesh: &solid::Mesh) -> Self {
        let filling = |f: &solid::Filling| [f.shift, f.spread, f.products];
        let surface = |f: &solid::Filling| (f.surface.frame, f.surface.areas);
        let membrane = |one: &solid::Membrane| {
            let m = one.material();
            (one.vertices(), [m.young, m.poisson, m.thickness, m.density])
        };
        Self {
            vertices: mesh.vertices.clone(),
            tets: mesh.tets.clone(),
            tet_part: mesh.tet_part.clone(),
            tet_block: mesh.tet_block.clone(),
            block_fraction: mesh.block_fraction.clone(),
            block_filling: mesh.block_filling.iter().map(filling).collect(),
            block_surface: mesh.block_filling.iter().map(surface).collect(),
            membranes: mesh.membranes.iter().map(membrane).collect(),
            attachments: mesh.attachments.clone(),
            point_masses: mesh.point_masses.clone(),
        }
    }
}

impl TryFrom<Mesh> for solid::Mesh {
    type Error = SceneError;

    fn try_from(form: Mesh) -> Result<Self, SceneError> {
        let rest = &form.vertices;
        let membrane = |(vertices, [young, poisson, thickness, density]): ([u32; 3], [f64; 4])| {
            let material = solid::MembraneMaterial {
                young,
                poisson,
                thickness,
                density,
            };
            let mut corners = [[0.0; 3]; 3];
            for (corner, vertex) in corners.iter_mut().zip(vertices) {
                let found = rest.get(vertex as usize).copied();
                *corner = found.ok_or(SceneError::Value("vertex of a membrane"))?;
            }
            Ok(solid::Membrane::new(vertices, corners, material)?)
        };
        let membranes: Result<_, SceneError> = form.membranes.into_iter().map(membrane).collect();
        let surfaces = form.block_surface.into_iter();
        let filling =
            |([shift, spread, products], (frame, areas)): ([Vec3; 3], _)| solid::Filling {
                surface: solid::CutSurface { frame, areas },
                shift,
                spread,
                products,
            };
        Ok(Self {
            membranes: membranes?,
            attachments: form.attachments,
            point_masses: form.point_masses,
            block_axes: Vec::new(),
            coarse: Vec::new(),
            vertices: form.vertices,
            tets: form.tets,
            tet_part: form.tet_part,
            tet_block: form.tet_block,
            block_fraction: form.block_fraction,
            block_filling: form
                .block_filling
                .into_iter()
                .zip(surfaces)
                .map(filling)
                .collect(),
        })
    }
}

impl From<&solid::Material> for Material {
    fn from(material: &solid::Material) -> Self {
        match material {
            solid::Material::Lattice(lattice) => {
                let density = lattice.density();
                match lattice.constants() {
                    LatticeConstants::Moduli { edge, bulk } => Self::Lattice {
                        edge,
                        bulk,
                        density,
                    },
                    LatticeConstants::Compliances { edge, volume } => Self::LatticeCompliance {
                        edge,
                        volume,
                        density,
                    },
                }
            }
            solid::Material::Hyperelastic(rubber) => Self::Hyperelastic {
                model: match *rubber.model() {
                    Model::NeoHookean { c10 } => Hyperelastic::NeoHookean(c10),
                    Model::MooneyRivlin { c10, c01 } => Hyperelastic::MooneyRivlin(c10, c01),
                    Model::Yeoh { c } => Hyperelastic::Yeoh(c),
                    Model::Ogden { terms } => Hyperelastic::Ogden(terms),
                    Model::Gent { shear, limit } => Hyperelastic::Gent(shear, limit),
                },
                bulk: rubber.bulk(),
                density: rubber.density(),
                fibers: rubber
                    .fibers()
                    .iter()
                    .map(|f| (f.direction, f.modulus, f.compression, f.free))
                    .collect(),
                windings: rubber.windings().iter().map(Into::into).collect(),
                prony: rubber.prony().to_vec(),
                swelling: rubber.swelling(),
            },
        }
    }
}

impl From<&solid::Winding> for Winding {
    fn from(winding: &solid::Winding) -> Self {
        Self {
            center: winding.center,
            axis: winding.axis,
            angle: winding.angle,
            modulus: winding.modulus,
            compression: winding.compression,
            free: winding.free,
        }
    }
}

impl From<Winding> for solid::Winding {
    fn from(form: Winding) -> Self {
        Self {
            center: form.center,
            axis: form.axis,
            angle: form.angle,
            modulus: form.modulus,
            compression: form.compression,
            free: form.free,
        }
    }
}

impl TryFrom<Material> for solid::Material {
    type Error = ProblemError;

    fn try_from(form: Material) -> Result<Self, ProblemError> {
        Ok(match form {
            Material::Lattice {
                edge,
                bulk,
                density,
            } => LatticeMaterial::from_moduli(edge, bulk, density)?.into(),
            Material::LatticeCompliance {
                edge,
                volume,
                density,
            } => LatticeMaterial::from_compliances(edge, volume, density)?.into(),
            Material::Hyperelastic {
                model,
                bulk,
                density,
                fibers,
                windings,
                prony,
                swelling,
            } => {
                let model = match model {
                    Hyperelastic::NeoHookean(c10) => Model::NeoHookean { c10 },
                    Hyperelastic::MooneyRivlin(c10, c01) => Model::MooneyRivlin { c10, c01 },
                    Hyperelastic::Yeoh(c) => Model::Yeoh { c },
                    Hyperelastic::Ogden(terms) => Model::Ogden { terms },
                    Hyperelastic::Gent(shear, limit) => Model::Gent { shear, limit },
                };
                let fiber = |(direction, modulus, compression, free)| solid::Fiber {
                    direction,
                    modulus,
                    compression,
                    free,
                };
                let fibers = fibers.into_iter().map(fiber).collect();
                let plain = HyperelasticMaterial::new(model, bulk, density)?;
                let wound = plain
                    .with_fibers(fibers)?
                    .with_windings(windings.into_iter().map(Into::into).collect())?;
                wound.with_prony(prony)?.with_swelling(swelling)?.into()
            }
        })
    }
}

impl From<&solid::History> for History {
    fn from(history: &solid::History) -> Self {
        Self(history.times().to_vec(), history.factors().to_vec())
    }
}

impl TryFrom<History> for solid::History {
    type Error = ProblemError;

    fn try_from(History(times, factors): History) -> Result<Self, ProblemError> {
        Self::new(times, factors)
    }
}

impl From<&solid::Clamp> for Clamp {
    fn from(clamp: &solid::Clamp) -> Self {
        Self {
            vertices: clamp.vertices.clone(),
            axes: clamp.axes,
            motion: clamp.motion.as_ref().map(|motion| Motion {
                displacement: motion.displacement,
                axis: motion.axis,
                angle: motion.angle,
                center: motion.center,
                history: (&motion.history).into(),
            }),
        }
    }
}

impl TryFrom<Clamp> for solid::Clamp {
    type Error = ProblemError;

    fn try_from(form: Clamp) -> Result<Self, ProblemError> {
        let motion = |motion: Motion| -> Result<_, ProblemError> {
            Ok(solid::Motion {
                displacement: motion.displacement,
                axis: motion.axis,
                angle: motion.angle,
                center: motion.center,
                history: motion.history.try_into()?,
                courses: None,
            })
        };
        Ok(Self {
            vertices: form.vertices,
            axes: form.axes,
            motion: form.motion.map(motion).transpose()?,
        })
    }
}

impl From<&solid::Load> for Load {
    fn from(load: &solid::Load) -> Self {
        Self {
            kind: load.kind.clone(),
            history: (&load.history).into(),
        }
    }
}

impl TryFrom<Load> for solid::Load {
    type Error = ProblemError;

    fn try_from(form: Load) -> Result<Self, ProblemError> {
        Ok(Self {
            kind: form.kind,
            history: form.history.try_into()?,
        })
    }
}
