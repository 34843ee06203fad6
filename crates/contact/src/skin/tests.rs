//! Skins of bodies with known surface.

use std::array;
use std::collections::BTreeMap;
use std::convert::Infallible;

use proptest::prelude::*;
use voxsoft_solid::vector::{Vec3, cross, dot, norm, sub};

use super::Skin;
use crate::gap::doubled;
use crate::surface::Surface;
use crate::tree::Tree;
use crate::triangles::{Meeting, meeting};

/// Voxels of 1 m whose centers are in a shape, within `-size` and `size` along each axis.
struct Filled {
    voxels: Vec<[u32; 8]>,
    vertices: Vec<Vec3>,
}

impl Filled {
    fn of(size: i32, shape: impl Fn(Vec3) -> f64) -> Self {
        let mut filled = Self {
            voxels: Vec::new(),
            vertices: Vec::new(),
        };
        let mut known = BTreeMap::new();
        let all = move || -size..size;
        let cells = all().flat_map(|x| all().flat_map(move |y| all().map(move |z| [x, y, z])));
        for cell in cells {
            if shape(cell.map(|i| f64::from(i) + 0.5)) >= -1e-9 {
                continue;
            }
            filled.voxels.push(std::array::from_fn(|c| {
                let corner: [i32; 3] = std::array::from_fn(|i| cell[i] + (c >> (2 - i) & 1) as i32);
                *known.entry(corner).or_insert_with(|| {
                    filled.vertices.push(corner.map(f64::from));
                    filled.vertices.len() as u32 - 1
                })
            }));
        }
        filled
    }

    fn skin(&self, shape: impl Fn(Vec3) -> f64) -> Skin {
        let values = |places: &[Vec3]| Ok(places.iter().map(|p| shape(*p)).collect());
        let skin: Result<Skin, Infallible> = Skin::of(&self.voxels, &self.vertices, values);
        let Ok(skin) = skin;
        for (point, at) in skin.surface.points.iter().zip(&skin.points) {
            let away = norm(sub(point.at(&self.vertices), *at));
            assert!(away < 1e-5, "carried {away} m beside its place");
            let sum: f64 = point.weights.iter().sum();
            assert!((sum - 1.0).abs() < 1e-12, "weights sum to {sum}");
        }
        skin
    }
}

fn skin_of(size: i32, shape: impl Fn(Vec3) -> f64) -> Skin {
    Filled::of(size, &shape).skin(&shape)
}

fn ball(radius: f64, center: Vec3) -> impl Fn(Vec3) -> f64 {
    move |p| norm(sub(p, center)) - radius
}

/// Box around `center`, with its half `sides` along `axes`; an exact distance except outside of its edges.
fn block(center: Vec3, half: Vec3, axes: [Vec3; 3]) -> impl Fn(Vec3) -> f64 {
    move |p| {
        let along = (0..3).map(|i| dot(axes[i], sub(p, center)).abs() - half[i]);
        along.fold(f64::NEG_INFINITY, f64::max)
    }
}

const ALONG: [Vec3; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn volume(skin: &Skin) -> f64 {
    let each = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|p| skin.points[p as usize]);
        dot(a, cross(b, c)) / 6.0
    };
    skin.surface.triangles.iter().map(each).sum()
}

/// Counts edges that do not occur once in each direction.
fn open_edges(skin: &Skin) -> usize {
    let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    for [a, b, c] in &skin.surface.triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let way = if from < to { 1 } else { -1 };
            *edges.entry([*from.min(to), *from.max(to)]).or_default() += way;
        }
    }
    edges.values().filter(|count| **count != 0).count()
}

/// Counts pairs of triangles that intersect.
fn crossings(skin: &Skin) -> usize {
    let all: Vec<[i32; 3]> = skin
        .surface
        .triangles
        .iter()
        .map(|t| t.map(|p| p as i32))
        .collect();
    let tree = Tree::new(&crate::shells::bounds_of(&skin.points, &all));
    let found = tree.pairs(&|i, j| {
        let met = meeting(&skin.points, all[i as usize], all[j as usize]);
        (met == Meeting::Cross).then_some(())
    });
    found.len()
}

/// Largest distance of a point from a surface, m.
fn farthest(skin: &Skin, shape: impl Fn(Vec3) -> f64) -> f64 {
    skin.points
        .iter()
        .map(|p| shape(*p).abs())
        .fold(0.0, f64::max)
}

fn has_point(skin: &Skin, place: Vec3) -> bool {
    skin.points
        .iter()
        .any(|point| norm(sub(*point, place)) < 1e-5)
}

fn sound(skin: &Skin) {
    assert_eq!(open_edges(skin), 0, "not closed");
    assert_eq!(crossings(skin), 0, "triangles pass through each other");
}

#[test]
fn points_of_a_ball_are_on_it() {
    for radius in [2.3, 4.0, 8.1] {
        let center = [0.13, -0.27, 0.41];
        let shape = ball(radius, center);
        let skin = skin_of(10, &shape);
        sound(&skin);
        // A chord of half a voxel is 1 / (8 · 4 · radius) inside; few points are left on one, of at most a voxel.
        let off: Vec<f64> = skin.points.iter().map(|p| shape(*p).abs()).collect();
        assert!(farthest(&skin, &shape) < 1.0 / (8.0 * radius));
        let exact = off.iter().filter(|off| **off < 1e-8).count();
        assert!(
            exact as f64 > 0.98 * off.len() as f64,
            "{exact} of {}",
            off.len()
        );
        // Flat triangles of half a voxel reduce the volume by a second-order error.
        let ideal = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        let lost = 1.0 - volume(&skin) / ideal;
        assert!(lost > 0.0 && lost < 0.13 / radius.powi(2), "{lost}");
        for triangle in &skin.surface.triangles {
            let corners = triangle.map(|p| skin.points[p as usize]);
            let middle = sub(corners[0], center);
            let (area, size) = (doubled(corners), norm(doubled(corners)));
            // The worst one is the least folded; on a smooth part normals are right to a few degrees.
            assert!(dot(area, middle) > 0.5 * size * norm(middle));
        }
    }
}

#[test]
fn boxes_are_exact() {
    // Boxes along the faces of voxels, off them, through centers of voxels, which are empty then, and almost through.
    for (center, half) in [
        ([0.0; 3], [2.0, 1.0, 3.0]),
        ([0.21, -0.13, 0.37], [2.1, 1.3, 2.8]),
        ([0.0; 3], [1.5 + 1e-10, 2.5 - 1e-16, 2.0]),
        ([0.0; 3], [1.5 + 1e-8, 2.5 + 1e-8, 2.0]),
    ] {
        let shape = block(center, half, ALONG);
        let skin = skin_of(6, &shape);
        sound(&skin);
        // If the surface passes almost through a center, triangles around it are kept apart.
        let through_centers = half[0] == 1.5 + 1e-8;
        let off = farthest(&skin, &shape);
        assert!(off < if through_centers { 1e-2 } else { 1e-8 }, "{off}");
        let ideal = 8.0 * half[0] * half[1] * half[2];
        let ratio = volume(&skin) / ideal;
        // A hundredth of a voxel on all sides of 3 by 5 by 4.
        let most = if through_centers { 0.02 } else { 1e-8 };
        assert!((ratio - 1.0).abs() < most, "{ratio}");
        for corner in 0..8 {
            let side = |i: usize| {
                if corner >> i & 1 == 1 {
                    half[i]
                } else {
                    -half[i]
                }
            };
            let place = [0, 1, 2].map(|i| center[i] + side(i));
            assert!(through_centers || has_point(&skin, place), "{place:?}");
        }
    }
}

#[test]
fn faces_of_voxels_stay_where_no_surface_passes() {
    let filled = Filled::of(3, ball(2.0, [0.0; 3]));
    let skin = filled.skin(|_| 1.0);
    let stairs = Surface::of_voxels(&filled.voxels, 2);
    assert!(skin.surface == stairs);
    assert!(filled.skin(|_| f64::NAN).surface == stairs);
    // A surface somewhere else does not attract them either.
    assert!(filled.skin(|p| p[0] + 7.0).surface == stairs);
}

#[test]
fn thin_walls_and_slits_keep_both_sides() {
    // A shell of three quarters of a voxel, and two blocks four tenths of a voxel apart.
    let shell = |p: Vec3| (norm(sub(p, [0.1, 0.2, 0.3])) - 4.0).abs() - 0.375;
    sound(&skin_of(8, shell));
    let (low, high) = (
        block([0.0, 0.0, -1.7], [2.0, 2.0, 2.0], ALONG),
        block([0.0, 0.0, 2.7], [2.0, 2.0, 2.0], ALONG),
    );
    let apart = move |p: Vec3| low(p).min(high(p));
    let skin = skin_of(6, &apart);
    sound(&skin);
    assert!(has_point(&skin, [2.0, 2.0, 0.3]) && has_point(&skin, [2.0, 2.0, 0.7]));
    assert!((volume(&skin) - 128.0).abs() < 1e-6);
}

#[test]
fn chambers_are_surfaces_too() {
    let (outer, inner) = (ball(6.0, [0.1; 3]), ball(3.0, [0.3; 3]));
    let hollow = |p: Vec3| outer(p).max(-inner(p));
    let skin = skin_of(8, hollow);
    sound(&skin);
    assert!(farthest(&skin, hollow) < 1.0 / 24.0);
    let ideal = 4.0 / 3.0 * std::f64::consts::PI * (216.0 - 27.0);
    assert!((volume(&skin) / ideal - 1.0).abs() < 0.01);
}

/// Cells of which at least 22 % of places are in the shape, as of voxels that a surface cuts.
fn cut(size: i32, shape: impl Fn(Vec3) -> f64) -> Filled {
    let parts = 8;
    Filled::of(size, |center| {
        let inside = (0..parts * parts * parts).filter(|number| {
            let steps = [
                number / (parts * parts),
                number / parts % parts,
                number % parts,
            ];
            let place = |i: usize| (f64::from(steps[i]) + 0.5) / f64::from(parts) - 0.5;
            shape(array::from_fn(|i| center[i] + place(i))) < 0.0
        });
        0.22 - inside.count() as f64 / f64::from(parts * parts * parts)
    })
}

#[test]
fn cut_voxels_end_at_the_surface() {
    for (center, half) in [
        // A third full at the top, and a quarter in two edges and in corners.
        ([0.0, 0.0, -0.35], [2.0, 2.0, 1.65]),
        ([0.0; 3], [2.5, 2.49, 2.0]),
        ([0.21, -0.13, 0.37], [2.1, 1.3, 2.8]),
        ([0.0, 0.0, 0.1], [1.66, 1.66, 1.6]),
    ] {
        let shape = block(center, half, ALONG);
        let skin = cut(5, &shape).skin(&shape);
        sound(&skin);
        let off = farthest(&skin, &shape);
        assert!(off < 1e-6, "{off} {half:?}");
        let ratio = volume(&skin) / (8.0 * half[0] * half[1] * half[2]);
        assert!((ratio - 1.0).abs() < 1e-6, "{ratio} {half:?}");
    }
    for radius in [2.3, 4.0, 5.3] {
        let shape = ball(radius, [0.13, -0.27, 0.41]);
        let skin = cut(7, &shape).skin(&shape);
        sound(&skin);
        let off = farthest(&skin, &shape);
        assert!(off < 1.0 / (8.0 * radius), "{off} of {radius}");
    }
}

#[test]
fn a_skin_moves_as_its_voxels_do() {
    let shape = ball(3.0, [0.1, 0.2, 0.3]);
    let mut filled = Filled::of(5, &shape);
    let skin = filled.skin(&shape);
    let stretched = |p: Vec3| [1.2 * p[0] + 0.1 * p[1], 0.9 * p[1], p[2] - 0.2 * p[0]];
    for vertex in &mut filled.vertices {
        *vertex = stretched(*vertex);
    }
    for (carried, point) in skin.surface.points.iter().zip(&skin.points) {
        let at = carried.at(&filled.vertices);
        // Points nearer than a millionth to a face of a voxel count as on it.
        assert!(norm(sub(at, stretched(*point))) < 1e-5);
    }
}

/// Rotates the axes by half a turn about `axis`.
fn turned(axis: Vec3) -> [Vec3; 3] {
    let square = dot(axis, axis);
    ALONG.map(|v| std::array::from_fn(|i| 2.0 * dot(axis, v) / square * axis[i] - v[i]))
}

proptest! {
    #[test]
    fn skins_are_closed_without_self_intersection(
        center in prop::array::uniform3(-0.5..0.5f64),
        half in prop::array::uniform3(0.7..3.0f64),
        axis in prop::array::uniform3(0.1..1.0f64),
        wall in 0.5..2.0f64,
        hollow in any::<bool>(),
    ) {
        let outer = block(center, half, turned(axis));
        let inner = ball(half[0].max(wall) - wall / 2.0, center);
        let shape = move |p: Vec3| if hollow { outer(p).max(-inner(p)) } else { outer(p) };
        let filled = Filled::of(6, &shape);
        prop_assume!(!filled.voxels.is_empty());
        let skin = filled.skin(&shape);
        prop_assert_eq!(open_edges(&skin), 0);
        prop_assert_eq!(crossings(&skin), 0);
        let stairs = Surface::of_voxels(&filled.voxels, 2);
        prop_assert_eq!(&skin.surface.triangles, &stairs.triangles);
        // Voxels that the surface cuts carry it too, except where a wall has no center.
        let of_cut = cut(6, &shape).skin(&shape);
        prop_assert_eq!(open_edges(&of_cut), 0);
        prop_assert_eq!(crossings(&of_cut), 0);
        for point in &of_cut.shares {
            prop_assert!(point.weights.iter().all(|weight| *weight > 0.0));
        }
    }
}
