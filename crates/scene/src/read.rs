use thiserror::Error;
use voxsoft_solid::{
    Clamp, Fiber, Filling, Floor, Gravity, History, HyperelasticMaterial, LatticeMaterial, Load,
    LoadKind, Material, Membrane, MembraneMaterial, Mesh, Model, Motion, PointForces, Pressure,
    ProblemError,
};
use voxsoft_xpbd::{Damping, Dynamics};

use crate::write::kind;
use crate::{MAGIC, Scene, VERSION};

/// Why bytes are no scene.
#[derive(Debug, Error, Clone, PartialEq)]
#[non_exhaustive]
pub enum SceneError {
    /// They do not begin as a scene does.
    #[error("this is no scene of VoxSoft")]
    NotAScene,
    /// Another version wrote them.
    #[error("the scene has the version {0}, this reads {VERSION}: export it again")]
    Version(u32),
    /// They end too early, or a length is wrong.
    #[error("the scene is cut off or damaged at byte {0}")]
    CutOff(usize),
    /// There is more after the end.
    #[error("the scene has {0} bytes too many")]
    TooLong(usize),
    /// A value has no meaning.
    #[error("the scene is damaged: {0}")]
    Value(&'static str),
    /// What is described cannot be.
    #[error(transparent)]
    Problem(#[from] ProblemError),
}

impl Scene {
    /// Reads what [`Scene::write`] wrote. Nothing is allocated beyond the size of the bytes.
    pub fn read(bytes: &[u8]) -> Result<Self, SceneError> {
        let mut from = Reader { bytes, at: 0 };
        if from.array::<4>().ok() != Some(MAGIC) {
            return Err(SceneError::NotAScene);
        }
        let version = from.u32()?;
        if version != VERSION {
            return Err(SceneError::Version(version));
        }
        let notes = from.list(1, Reader::u8)?;
        let notes = String::from_utf8(notes).map_err(|_| SceneError::Value("notes"))?;
        let settings = from.settings()?;
        let mut mesh = Mesh {
            vertices: from.list(24, Reader::f64s)?,
            tets: from.list(16, Reader::u32s)?,
            tet_part: from.list(1, Reader::u8)?,
            tet_block: from.list(4, Reader::u32)?,
            block_fraction: from.list(8, Reader::f64)?,
            block_filling: from.list(48, |from| {
                let (shift, spread) = (from.f64s()?, from.f64s()?);
                Ok(Filling { shift, spread })
            })?,
            membranes: Vec::new(),
        };
        mesh.membranes = from.list(44, |from| from.membrane(&mesh.vertices))?;
        let scene = Self {
            notes,
            settings,
            mesh,
            materials: from.list(29, Reader::material)?,
            clamps: from.list(8, Reader::clamp)?,
            loads: from.list(9, Reader::load)?,
            floor: from.floor()?,
            voxel_size: from.f64()?,
            triangles: from.list(12, Reader::u32s)?,
            tags: from.list(1, Reader::u8)?,
        };
        match bytes.len() - from.at {
            0 => Ok(scene),
            more => Err(SceneError::TooLong(more)),
        }
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

type Read<T> = Result<T, SceneError>;

impl Reader<'_> {
    fn array<const N: usize>(&mut self) -> Read<[u8; N]> {
        let rest = &self.bytes[self.at..];
        let found = rest.first_chunk().ok_or(SceneError::CutOff(self.at))?;
        self.at += N;
        Ok(*found)
    }

    fn u8(&mut self) -> Read<u8> {
        Ok(self.array::<1>()?[0])
    }

    fn bool(&mut self) -> Read<bool> {
        match self.u8()? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(SceneError::Value("a yes or no")),
        }
    }

    fn u32(&mut self) -> Read<u32> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    fn u32s<const N: usize>(&mut self) -> Read<[u32; N]> {
        let mut row = [0; N];
        for value in &mut row {
            *value = self.u32()?;
        }
        Ok(row)
    }

    fn f64(&mut self) -> Read<f64> {
        Ok(f64::from_le_bytes(self.array()?))
    }

    fn f64s<const N: usize>(&mut self) -> Read<[f64; N]> {
        let mut row = [0.0; N];
        for value in &mut row {
            *value = self.f64()?;
        }
        Ok(row)
    }

    /// A list whose entries take `least` bytes or more.
    fn list<T>(&mut self, least: usize, each: impl Fn(&mut Self) -> Read<T>) -> Read<Vec<T>> {
        let at = self.at;
        let count = self.u32()? as usize;
        if count > (self.bytes.len() - self.at) / least {
            return Err(SceneError::CutOff(at));
        }
        (0..count).map(|_| each(self)).collect()
    }

    fn settings(&mut self) -> Read<Dynamics> {
        let time_step = self.f64()?;
        let substeps = Some(self.u32()?).filter(|&substeps| substeps > 0);
        let iterations = self.u32()?;
        let [rate, retardation, tolerance] = self.f64s()?;
        if !(time_step > 0.0 && time_step.is_finite()) {
            return Err(SceneError::Value("time step"));
        }
        if ![rate, retardation, tolerance].iter().all(|x| x.is_finite()) {
            return Err(SceneError::Value("settings of the run"));
        }
        let damping = if rate < 0.0 {
            Damping::Critical
        } else {
            Damping::Rate(rate)
        };
        Ok(Dynamics {
            time_step,
            substeps,
            iterations,
            damping,
            retardation,
            tolerance,
            ..Dynamics::default()
        })
    }

    fn membrane(&mut self, rest: &[[f64; 3]]) -> Read<Membrane> {
        let vertices = self.u32s::<3>()?;
        let [young, poisson, thickness, density] = self.f64s()?;
        let material = MembraneMaterial {
            young,
            poisson,
            thickness,
            density,
        };
        let mut corners = [[0.0; 3]; 3];
        for (corner, vertex) in corners.iter_mut().zip(vertices) {
            let found = rest.get(vertex as usize);
            *corner = *found.ok_or(SceneError::Value("vertex of a membrane"))?;
        }
        Ok(Membrane::new(vertices, corners, material)?)
    }

    fn material(&mut self) -> Read<Material> {
        let kind = self.u8()?;
        let [bulk, density] = self.f64s()?;
        let constants = self.list(8, Self::f64)?;
        let fibers = self.list(33, |from| {
            Ok(Fiber {
                direction: from.f64s()?,
                modulus: from.f64()?,
                compression: from.bool()?,
            })
        })?;
        let prony = self.list(16, |from| {
            let [share, time] = from.f64s()?;
            Ok((share, time))
        })?;
        if constants.iter().any(|constant| !constant.is_finite()) {
            return Err(SceneError::Value("constants of a material"));
        }
        let model = match (kind, constants.as_slice()) {
            (kind::LATTICE, &[edge]) => {
                return Ok(LatticeMaterial::from_moduli(edge, bulk, density)?.into());
            }
            (kind::LATTICE_COMPLIANCE, &[edge]) => {
                return Ok(LatticeMaterial::from_compliances(edge, bulk, density)?.into());
            }
            (kind::NEO_HOOKEAN, &[c10]) => Model::NeoHookean { c10 },
            (kind::MOONEY_RIVLIN, &[c10, c01]) => Model::MooneyRivlin { c10, c01 },
            (kind::YEOH, &[c10, c20, c30]) => Model::Yeoh { c: [c10, c20, c30] },
            (kind::OGDEN, &[m1, a1, m2, a2, m3, a3]) => Model::Ogden {
                terms: [(m1, a1), (m2, a2), (m3, a3)],
            },
            (kind::GENT, &[shear, limit]) => Model::Gent { shear, limit },
            _ => return Err(SceneError::Value("kind of a material")),
        };
        let material = HyperelasticMaterial::new(model, bulk, density)?;
        Ok(material.with_fibers(fibers)?.with_prony(prony)?.into())
    }

    fn history(&mut self) -> Read<History> {
        let (times, factors) = (self.list(8, Self::f64)?, self.list(8, Self::f64)?);
        Ok(History::new(times, factors)?)
    }

    fn clamp(&mut self) -> Read<Clamp> {
        let vertices = self.list(4, Self::u32)?;
        let axes = [self.bool()?, self.bool()?, self.bool()?];
        let motion = if self.bool()? {
            Some(Motion {
                displacement: self.f64s()?,
                axis: self.f64s()?,
                angle: self.f64()?,
                center: self.f64s()?,
                history: self.history()?,
            })
        } else {
            None
        };
        Ok(Clamp {
            vertices,
            axes,
            motion,
        })
    }

    fn load(&mut self) -> Read<Load> {
        let kind = match self.u8()? {
            kind::GRAVITY => LoadKind::from(Gravity {
                acceleration: self.f64s()?,
            }),
            kind::PRESSURE => Pressure {
                pressure: self.f64()?,
                triangles: self.list(12, Self::u32s)?,
                voids: self.list(24, |from| Ok((from.u32s()?, from.f64()?)))?,
            }
            .into(),
            kind::FORCES => PointForces {
                vertices: self.list(4, Self::u32)?,
                forces: self.list(24, Self::f64s)?,
            }
            .into(),
            _ => return Err(SceneError::Value("kind of a load")),
        };
        let history = self.history()?;
        Ok(Load { kind, history })
    }

    fn floor(&mut self) -> Read<Option<Floor>> {
        let there = self.bool()?;
        let z = self.f64()?;
        if !z.is_finite() {
            return Err(SceneError::Value("height of the floor"));
        }
        Ok(there.then_some(Floor { z }))
    }
}
