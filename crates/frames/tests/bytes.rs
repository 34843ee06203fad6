//! Layout of packed messages.

use proptest::prelude::*;
use voxsoft_frames::{Display, Field, FrameHead, HEADER, Outline};
use voxsoft_solid::{Body, LatticeMaterial, Mesh, State};
use voxsoft_voxel::{Grid, tet_mesh};

const SIDE: f64 = 5e-3;

/// A body, its triangles with their tags, its tetrahedra.
type Hollow = (Body, Vec<[u32; 3]>, Vec<u8>, Vec<[u32; 4]>);

/// A hollow box of 3×3×3 voxels, its triangles and their tags: those of the cavity have the bit 7.
fn hollow() -> Hollow {
    let mut grid = Grid::empty([3; 3], [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [3.0 * SIDE; 3], 1);
    grid.set([1; 3], 0);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let count = tets.tets.len();
    let unsigned = |t: &[i32; 3]| t.map(|v| v as u32);
    let inner: Vec<[u32; 3]> = tets.cavities[0].triangles.iter().map(unsigned).collect();
    let all: Vec<[u32; 3]> = tets.triangles.iter().map(unsigned).collect();
    let tags = all
        .iter()
        .map(|t| if inner.contains(t) { 0x80 } else { 0 })
        .collect();
    let mesh = Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    };
    let material = LatticeMaterial::from_moduli(20e3, 90e3, 1000.0).unwrap();
    let four = mesh.tets.clone();
    (Body::new(&mesh, &[material]).unwrap(), all, tags, four)
}

/// Reads numbers one after the other.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (head, tail) = self.0.split_at(N);
        self.0 = tail;
        head.try_into().unwrap()
    }
    fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.take())
    }
    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }
    fn f32(&mut self) -> f32 {
        f32::from_le_bytes(self.take())
    }
    fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }
}

#[test]
fn topology_holds_points_triangles_edges_and_tags() {
    let (body, triangles, tags, _) = hollow();
    let display = Display::surface(&body, &triangles, &tags, SIDE).unwrap();
    let bytes = display.topology(&body, 17);
    let mut read = Reader(&bytes);
    assert_eq!(&read.take::<4>(), b"VXF1");
    assert_eq!((read.take::<2>(), read.u16()), ([1, 1], 0));
    assert_eq!((read.u32(), read.u32(), read.f64()), (17, 0, SIDE));
    // Every vertex of the box is on the outer or the inner surface: 64. Six faces of nine squares and the
    // inner cube's six, each of two triangles: 120. Edges: 6·2·12 − 12·3 outside, 12 inside.
    assert_eq!([read.u32(), read.u32(), read.u32()], [64, 120, 108 + 12]);
    let mut read = Reader(&bytes[HEADER..]);
    for &vertex in display.vertices() {
        let point = [read.f32(), read.f32(), read.f32()];
        assert_eq!(point, body.rest()[vertex as usize].map(|x| x as f32));
    }
    for triangle in &triangles {
        let got = [read.u32(), read.u32(), read.u32()].map(|p| display.vertices()[p as usize]);
        assert_eq!(&got, triangle);
    }
    for _ in 0..120 {
        let [a, b] =
            [read.u32(), read.u32()].map(|p| body.rest()[display.vertices()[p as usize] as usize]);
        let apart: f64 = (0..3).map(|i| (a[i] - b[i]).abs()).sum();
        assert!((apart - SIDE).abs() < 1e-12, "an edge of a voxel");
    }
    assert_eq!(read.0, &tags);
    assert_eq!(tags.iter().filter(|&&t| t == 0x80).count(), 12);
}

#[test]
fn solid_lists_surface_points_first() {
    let mut grid = Grid::empty([4; 3], [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [4.0 * SIDE; 3], 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let unsigned = |t: &[i32; 3]| t.map(|v| v as u32);
    let triangles: Vec<[u32; 3]> = tets.triangles.iter().map(unsigned).collect();
    let rest = &tets.vertices;
    let tags = vec![0; triangles.len()];
    let at = |place: [usize; 3]| {
        let point = place.map(|k| k as f64 * SIDE);
        let near = |x: &[f64; 3]| (0..3).all(|k| (x[k] - point[k]).abs() < 1e-9);
        rest.iter().position(near).unwrap() as u32
    };
    let voxels: Vec<[u32; 8]> = (0..64)
        .map(|n| [n / 16, n / 4 % 4, n % 4])
        .map(|[x, y, z]| std::array::from_fn(|c| at([x + (c >> 2), y + (c >> 1 & 1), z + (c & 1)])))
        .collect();
    let surface = Outline::surface(rest, &triangles, &tags, SIDE).unwrap();
    let solid = Outline::solid(rest, &triangles, &tags, &voxels, SIDE).unwrap();
    assert_eq!((surface.points(), solid.points()), (98, 125));
    assert_eq!(&solid.vertices()[..98], surface.vertices());
    assert_eq!(solid.triangles(), surface.triangles());
    let bytes = solid.topology(rest, 1);
    let mut read = Reader(&bytes[24..]);
    let counts = [read.u32(), read.u32(), read.u32(), read.u32()];
    assert_eq!(counts, [125, 192, surface.edges().len() as u32, 64]);
    let before = 12 * 125 + 12 * 192 + 8 * surface.edges().len();
    let mut read = Reader(&bytes[HEADER + before..]);
    for voxel in &voxels {
        for corner in voxel {
            assert_eq!(solid.vertices()[read.u32() as usize], *corner);
        }
    }
    assert_eq!(read.0, &tags);
}

#[test]
fn shrunk_tets_have_their_own_points() {
    let (body, _, _, tets) = hollow();
    let display = Display::tets(&body, &tets[..7], &[3; 7], SIDE).unwrap();
    assert_eq!(display.points(), 28);
    let bytes = display.topology(&body, 1);
    let mut read = Reader(&bytes);
    assert_eq!(
        (read.u32(), read.take::<2>()),
        (u32::from_le_bytes(*b"VXF1"), [1, 2])
    );
    let mut read = Reader(&bytes[24..]);
    // Their shapes show where they are: no edges are drawn.
    assert_eq!([read.u32(), read.u32(), read.u32()], [28, 28, 0]);
    assert_eq!(bytes.len(), HEADER + 28 * 12 + 28 * 12 + 28);
    let state = State::at_rest(&body);
    let frame = display.frame(&body, &state, Field::Stretch, FrameHead::default());
    assert_eq!(frame.len(), HEADER + 28 * 8);
}

#[test]
fn bad_indices_and_tags_are_reported() {
    let (body, triangles, tags, _) = hollow();
    assert!(Display::surface(&body, &[[0, 1, 64]], &[0], SIDE).is_err());
    assert!(Display::surface(&body, &triangles, &tags[1..], SIDE).is_err());
    assert!(Display::tets(&body, &[[0, 1, 2, 99]], &[0], SIDE).is_err());
    let empty = Display::surface(&body, &[], &[], SIDE).unwrap();
    let frame = empty.frame(
        &body,
        &State::at_rest(&body),
        Field::X,
        FrameHead::default(),
    );
    assert_eq!(frame.len(), HEADER);
}

proptest! {
    #[test]
    fn positions_and_values_round_trip_within_a_step(
        moves in prop::collection::vec(prop::array::uniform3(-0.01..0.01f64), 64),
        id in 0u16..9,
    ) {
        let (body, triangles, tags, _) = hollow();
        let display = Display::surface(&body, &triangles, &tags, SIDE).unwrap();
        let mut state = State::at_rest(&body);
        state.time = 0.25;
        for (position, change) in state.positions.iter_mut().zip(&moves) {
            for axis in 0..3 {
                position[axis] += change[axis];
            }
        }
        let field = Field::from_id(id).unwrap();
        let head = FrameHead { topology: 5, frame: 9, seq: 11, flags: 5 };
        let bytes = display.frame(&body, &state, field, head);
        let mut read = Reader(&bytes);
        prop_assert_eq!(&read.take::<4>(), b"VXF1");
        prop_assert_eq!((read.take::<2>(), read.u16()), ([2, 5], id));
        prop_assert_eq!((read.u32(), read.u32(), read.f64()), (5, 9, 0.25));
        prop_assert_eq!((read.u32(), read.u32()), (64, 11));
        let origin = [read.f32(), read.f32(), read.f32()];
        let scale = [read.f32(), read.f32(), read.f32()];
        let (low, high) = (read.f32(), read.f32());
        let all: Vec<u32> = display.vertices().to_vec();
        let values = voxsoft_solid::fields::Fields::new(&body, all).evaluate(&body, &state, field);
        for (place, &vertex) in display.vertices().iter().enumerate() {
            for axis in 0..3 {
                let got = f64::from(origin[axis]) + f64::from(scale[axis]) * f64::from(read.u16()) / 65535.0;
                let step = f64::from(scale[axis]) / 65535.0;
                // Half a step, and the rounding of the ends to f32.
                let error = (got - state.positions[vertex as usize][axis]).abs();
                prop_assert!(error < 0.51 * step + 1e-7 * step.max(1e-2));
            }
            let quantized = read.u16();
            if !values[place].is_finite() {
                // An inverted voxel has no stress.
                prop_assert_eq!(quantized, 0);
                continue;
            }
            let got = f64::from(low) + f64::from(high - low) * f64::from(quantized) / 65535.0;
            let error = (got - values[place]).abs();
            prop_assert!(error <= 0.51 * f64::from(high - low) / 65535.0 + 2e-7 * f64::from(high.abs().max(low.abs())));
        }
        prop_assert!(read.0.is_empty());
    }
}
