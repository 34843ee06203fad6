//! Serialized scene: a problem with its display and controls as bytes, which a page opens without a server.
//!
//! Layout: the magic `VXSC` and a version (u32, little-endian), then the scene in the format of the `postcard` crate,
//! as in `forms.rs`. [`Scene::read`] rebuilds every material, clamp and load with its own checks, and
//! [`Scene::problem`] checks the mechanics.

mod forms;
mod touching;

use thiserror::Error;
use voxsoft_frames::Display;
use voxsoft_player::{Cast, Player};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Clamp, Floor, Load, Material, Mesh, Problem, ProblemError};
use voxsoft_xpbd::Dynamics;

pub use touching::Touching;

const MAGIC: [u8; 4] = *b"VXSC";

/// The version that is written and read.
pub const VERSION: u32 = 7;

/// Error of reading a scene.
#[derive(Debug, Error, Clone, PartialEq)]
pub enum SceneError {
    /// The magic is missing.
    #[error("this is no scene of VoxSoft")]
    NotAScene,
    /// The scene has another version.
    #[error("the scene has the version {0}, this reads {VERSION}: export it again")]
    Version(u32),
    /// The bytes end too early, or cannot be decoded.
    #[error("the scene is cut off or damaged")]
    CutOff,
    /// Bytes follow the end of the scene.
    #[error("the scene has {0} bytes too many")]
    TooLong(usize),
    /// A value is invalid.
    #[error("the scene is damaged: {0}")]
    Value(&'static str),
    /// The described problem is invalid.
    #[error(transparent)]
    Problem(#[from] ProblemError),
}

/// A problem with its display, controls and settings for play.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Notes of the writer, not interpreted here.
    pub notes: String,
    /// Settings of its dynamics; end time, maximum time, record interval and determinism are not stored.
    pub settings: Dynamics,
    /// Mesh with its membranes.
    pub mesh: Mesh,
    /// The material of each part.
    pub materials: Vec<Material>,
    /// Clamps of the problem.
    pub clamps: Vec<Clamp>,
    /// Loads of the problem.
    pub loads: Vec<Load>,
    /// Floor of the problem.
    pub floor: Option<Floor>,
    /// Voxel size in m.
    pub voxel_size: f64,
    /// Triangles of the displayed surface.
    pub triangles: Vec<[u32; 3]>,
    /// A tag for each triangle.
    pub tags: Vec<u8>,
    /// Controls and probes.
    pub cast: Cast,
    /// Contact: surfaces and rigid objects.
    pub touching: Option<Touching>,
    /// First displayed positions in m; `None` is the unloaded shape.
    pub positions: Option<Vec<Vec3>>,
}

impl Scene {
    /// Serializes the scene.
    pub fn write(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        postcard::to_extend(&forms::Scene::from(self), bytes)
            .expect("memory takes all bytes, and all lists have lengths")
    }

    /// Reads the bytes of [`Scene::write`]. No list is allocated much beyond the available bytes.
    pub fn read(bytes: &[u8]) -> Result<Self, SceneError> {
        let (magic, bytes) = bytes.split_first_chunk().ok_or(SceneError::NotAScene)?;
        if *magic != MAGIC {
            return Err(SceneError::NotAScene);
        }
        let (version, bytes) = bytes.split_first_chunk().ok_or(SceneError::CutOff)?;
        let version = u32::from_le_bytes(*version);
        if version != VERSION {
            return Err(SceneError::Version(version));
        }
        let (form, more): (forms::Scene, _) =
            postcard::take_from_bytes(bytes).map_err(|_| SceneError::CutOff)?;
        match more.len() {
            0 => form.try_into(),
            more => Err(SceneError::TooLong(more)),
        }
    }

    /// Builds the problem, without contact.
    pub fn problem(&self) -> Result<Problem, ProblemError> {
        let body = Body::new(&self.mesh, &self.materials)?;
        Problem::new(body, self.clamps.clone(), self.loads.clone(), self.floor)
    }

    /// Makes a player of the problem. With `deterministic`, explicit steps give the same bits on every processor.
    pub fn play(&self, deterministic: bool) -> Result<Player, ProblemError> {
        let mut problem = self.problem()?;
        let mut touching = None;
        if let Some(contact) = &self.touching {
            let played;
            (problem, played) = contact.add_to(problem)?;
            touching = Some(played);
        }
        let (triangles, tags) = (&self.triangles, &self.tags);
        let surface = Display::surface(problem.body(), triangles, tags, self.voxel_size)?;
        let settings = Dynamics {
            deterministic,
            ..self.settings.clone()
        };
        let mut player = Player::new(problem, settings, surface, self.cast.clone());
        if let Some(touching) = touching {
            player = player.with_touching(touching);
        }
        if let Some(positions) = &self.positions {
            player.show_first(positions.clone())?;
        }
        Ok(player)
    }
}
