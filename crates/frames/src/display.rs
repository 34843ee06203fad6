use voxsoft_solid::fields::{Field, Fields};
use voxsoft_solid::{Body, ProblemError, State};

use crate::outline::Outline;
use crate::pack::FrameHead;

/// Displayed part of a body, and the elements for coloring it by a field.
#[derive(Debug, Clone)]
pub struct Display {
    outline: Outline,
    /// Elements around the displayed vertices.
    fields: Fields,
}

impl Display {
    /// Surface given by triangles of body vertices; see [`Outline::surface`].
    pub fn surface(
        body: &Body,
        triangles: &[[u32; 3]],
        tags: &[u8],
        voxel_size: f64,
    ) -> Result<Self, ProblemError> {
        let outline = Outline::surface(body.rest(), triangles, tags, voxel_size)?;
        Ok(Self::of(body, outline))
    }

    /// Surface with the voxels behind it; see [`Outline::solid`].
    pub fn solid(
        body: &Body,
        triangles: &[[u32; 3]],
        tags: &[u8],
        voxels: &[[u32; 8]],
        voxel_size: f64,
    ) -> Result<Self, ProblemError> {
        let outline = Outline::solid(body.rest(), triangles, tags, voxels, voxel_size)?;
        Ok(Self::of(body, outline))
    }

    /// Tetrahedra of body vertices; see [`Outline::tets`].
    pub fn tets(
        body: &Body,
        tets: &[[u32; 4]],
        tags: &[u8],
        voxel_size: f64,
    ) -> Result<Self, ProblemError> {
        let outline = Outline::tets(body.rest(), tets, tags, voxel_size)?;
        Ok(Self::of(body, outline))
    }

    fn of(body: &Body, outline: Outline) -> Self {
        let fields = Fields::new(body, outline.vertices().to_vec());
        Self { outline, fields }
    }

    /// Displayed vertices of the body, see [`Outline::vertices`].
    pub fn vertices(&self) -> &[u32] {
        self.outline.vertices()
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.outline.points()
    }

    /// Packs the topology message.
    pub fn topology(&self, body: &Body, number: u32) -> Vec<u8> {
        self.outline.topology(body.rest(), number)
    }

    /// Values of a field at [`Display::vertices`].
    pub fn values(&self, body: &Body, state: &State, field: Field) -> Vec<f64> {
        self.fields.evaluate(body, state, field)
    }

    /// Packs the message of a frame.
    ///
    /// # Panics
    ///
    /// If the state belongs to another body.
    pub fn frame(&self, body: &Body, state: &State, field: Field, head: FrameHead) -> Vec<u8> {
        let values = self.values(body, state, field);
        let State {
            positions, time, ..
        } = state;
        self.outline
            .frame(head, *time, positions, field as u16, &values)
    }
}
