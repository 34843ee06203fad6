use voxsoft_solid::vector::Vec3;

/// Length of the header before the payload, in bytes.
pub const HEADER: usize = 64;

/// The first four bytes of a message.
pub const MAGIC: u32 = u32::from_le_bytes(*b"VXF1");

/// Kind of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MessageKind {
    /// Topology: points, triangles, edges and voxels.
    Topology = 1,
    /// Frame: positions and one field.
    Frame = 2,
    /// Smooth surface of shapes.
    Smooth = 3,
}

/// Kind of a topology.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TopologyFlag {
    /// A surface.
    Surface = 1,
    /// Tetrahedra, each drawn smaller than it is.
    ShrunkTets = 2,
}

/// Bits of [`FrameHead::flags`].
pub mod frame_flag {
    /// Time stands still.
    pub const PAUSED: u8 = 1;
    /// The simulation diverged.
    pub const DIVERGED: u8 = 2;
    /// The body is at rest until something is changed.
    pub const AT_REST: u8 = 4;
}

/// Header fields of a frame, set by the sender.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FrameHead {
    /// Number of the topology that the frame belongs to.
    pub topology: u32,
    /// Number of the frame.
    pub frame: u32,
    /// Number of the last input that was applied.
    pub seq: u32,
    /// Bits of [`frame_flag`].
    pub flags: u8,
}

struct Bytes(Vec<u8>);

impl Bytes {
    fn new(payload: usize) -> Self {
        Self(Vec::with_capacity(HEADER + payload))
    }

    fn put<const N: usize>(&mut self, bytes: [u8; N]) {
        self.0.extend_from_slice(&bytes);
    }

    fn start(&mut self, kind: MessageKind, flags: u8, field: u16, topology: u32, frame: u32) {
        self.put(MAGIC.to_le_bytes());
        self.put([kind as u8, flags]);
        self.put(field.to_le_bytes());
        self.put(topology.to_le_bytes());
        self.put(frame.to_le_bytes());
    }

    fn pad(&mut self, length: usize) {
        self.0.resize(length, 0);
    }

    /// Writes points, lists of corners, and a byte for each triangle.
    fn mesh(&mut self, points: &[Vec3], corners: &[&[u32]], tags: &[u8]) {
        self.pad(HEADER);
        for value in points.as_flattened() {
            self.put((*value as f32).to_le_bytes());
        }
        for corner in corners.iter().copied().flatten() {
            self.put(corner.to_le_bytes());
        }
        self.0.extend_from_slice(tags);
        self.pad(self.0.len().next_multiple_of(4));
    }
}

/// Connectivity of the points of a topology.
pub(crate) struct Shape<'a> {
    pub triangles: &'a [[u32; 3]],
    pub edges: &'a [[u32; 2]],
    pub voxels: &'a [[u32; 8]],
    /// Tag of each triangle.
    pub tags: &'a [u8],
}

pub(crate) fn pack_topology(
    flag: TopologyFlag,
    number: u32,
    voxel_size: f64,
    points: &[Vec3],
    shape: Shape<'_>,
) -> Vec<u8> {
    let Shape {
        triangles,
        edges,
        voxels,
        tags,
    } = shape;
    let corners = 12 * triangles.len() + 8 * edges.len() + 32 * voxels.len();
    let mut bytes = Bytes::new(12 * points.len() + corners + tags.len() + 4);
    bytes.start(MessageKind::Topology, flag as u8, 0, number, 0);
    bytes.put(voxel_size.to_le_bytes());
    for count in [points.len(), triangles.len(), edges.len(), voxels.len()] {
        bytes.put((count as u32).to_le_bytes());
    }
    let corners = [
        triangles.as_flattened(),
        edges.as_flattened(),
        voxels.as_flattened(),
    ];
    bytes.mesh(points, &corners, tags);
    bytes.0
}

/// Packs the smooth surface of shapes at rest: its points (m), its triangles, and the part of each.
pub fn pack_smooth(
    topology: u32,
    points: &[Vec3],
    triangles: &[[u32; 3]],
    parts: &[u8],
) -> Vec<u8> {
    let mut bytes = Bytes::new(12 * points.len() + 13 * triangles.len() + 4);
    bytes.start(MessageKind::Smooth, 0, 0, topology, 0);
    bytes.put(0f64.to_le_bytes());
    for count in [points.len(), triangles.len()] {
        bytes.put((count as u32).to_le_bytes());
    }
    bytes.mesh(points, &[triangles.as_flattened()], parts);
    bytes.0
}

pub(crate) fn pack_frame(
    head: FrameHead,
    field: u16,
    time: f64,
    points: &[Vec3],
    values: &[f64],
) -> Vec<u8> {
    let mut bytes = Bytes::new(8 * points.len());
    bytes.start(
        MessageKind::Frame,
        head.flags,
        field,
        head.topology,
        head.frame,
    );
    bytes.put(time.to_le_bytes());
    bytes.put((points.len() as u32).to_le_bytes());
    bytes.put(head.seq.to_le_bytes());
    let axes: [Range; 3] = std::array::from_fn(|axis| Range::of(points.iter().map(|p| p[axis])));
    let range = Range::of(values.iter().copied());
    for axis in &axes {
        bytes.put(axis.low.to_le_bytes());
    }
    for axis in &axes {
        bytes.put(axis.width().to_le_bytes());
    }
    bytes.put(range.low.to_le_bytes());
    bytes.put(range.high.to_le_bytes());
    for (point, value) in points.iter().zip(values) {
        for axis in 0..3 {
            bytes.put(axes[axis].quantize(point[axis]).to_le_bytes());
        }
        bytes.put(range.quantize(*value).to_le_bytes());
    }
    bytes.0
}

/// Range of some numbers, in single precision as for the client.
struct Range {
    low: f32,
    high: f32,
}

impl Range {
    /// Range of all finite numbers; 0 to 0 if there are none.
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let finite = values.filter(|v| v.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        });
        if low > high {
            return Self {
                low: 0.0,
                high: 0.0,
            };
        }
        Self {
            low: low as f32,
            high: high as f32,
        }
    }

    fn width(&self) -> f32 {
        self.high - self.low
    }

    /// Quantizes a value to 16 bits; NaN becomes 0.
    fn quantize(&self, value: f64) -> u16 {
        let width = f64::from(self.width());
        if width > 0.0 {
            // Casts to integers stop at the ends of their range.
            ((value - f64::from(self.low)) / width * f64::from(u16::MAX)).round() as u16
        } else {
            0
        }
    }
}
