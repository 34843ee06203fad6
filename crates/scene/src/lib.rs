//! A problem with all it takes to play it, as bytes: what a page without a server opens.
//!
//! The magic `VXSC` and a version (u32, little-endian), then the scene in the format of the `postcard` crate,
//! laid out as in `forms.rs`. [`Scene::read`] lets every material, clamp and load be checked by its own rules,
//! and [`Scene::problem`] checks the mechanics.

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
pub const VERSION: u32 = 6;

/// Why bytes are no scene.
#[derive(Debug, Error, Clone, PartialEq)]
pub enum SceneError {
    /// They do not begin as a scene does.
    #[error("this is no scene of VoxSoft")]
    NotAScene,
    /// Another version wrote them.
    #[error("the scene has the version {0}, this reads {VERSION}: export it again")]
    Version(u32),
    /// They end too early, or something between is not what it should be.
    #[error("the scene is cut off or damaged")]
    CutOff,
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

/// A problem with what it takes to play it.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Text of the writer's, which no one reads here.
    pub notes: String,
    /// How it runs; end time, patience and records are not kept.
    pub settings: Dynamics,
    /// The mesh with its membranes.
    pub mesh: Mesh,
    /// The material of each part.
    pub materials: Vec<Material>,
    /// The clamps.
    pub clamps: Vec<Clamp>,
    /// The loads.
    pub loads: Vec<Load>,
    /// The floor.
    pub floor: Option<Floor>,
    /// Voxel size in m.
    pub voxel_size: f64,
    /// The surface that is shown.
    pub triangles: Vec<[u32; 3]>,
    /// A tag for each triangle.
    pub tags: Vec<u8>,
    /// What can be changed and what is plotted.
    pub cast: Cast,
    /// What touches.
    pub touching: Option<Touching>,
    /// Where the vertices are shown first in m; `None`: unloaded.
    pub positions: Option<Vec<Vec3>>,
}

impl Scene {
    /// The scene as bytes.
    pub fn write(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        postcard::to_extend(&forms::Scene::from(self), bytes)
            .expect("memory takes all bytes, and all lists have lengths")
    }

    /// Reads what [`Scene::write`] wrote. No list is allocated much beyond the bytes that are there.
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

    /// Builds the problem, without what touches.
    pub fn problem(&self) -> Result<Problem, ProblemError> {
        let body = Body::new(&self.mesh, &self.materials)?;
        Problem::new(body, self.clamps.clone(), self.loads.clone(), self.floor)
    }

    /// Gets the problem ready to be played: with the same bits everywhere, if explicit steps move it and
    /// `deterministic` is asked for.
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
