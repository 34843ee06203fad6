//! Cells whose faces become the skin: those with their center in the shape.
//!
//! Voxels that a surface cuts may have their center outside; a cell that is empty, because its material belongs to its
//! neighbors, may have it inside, at the corner of a body. The crossing of the surface is found between two centers,
//! one inside and one outside, so the skin follows the centers, and the voxels carry it. A wall that has no center is
//! taken by its voxels.

use std::collections::{BTreeMap, BTreeSet};

use voxsoft_solid::vector::{Vec3, add, dot, norm, scale, sub};

use super::crossing::Field;
use crate::surface::Carried;

/// Smallest cosine between the way to a neighbor and the way inward for which the surface beside a center outside lies
/// before that neighbor: the way from an edge or a corner of a cube.
const INWARD: f64 = 0.5;
/// Empty neighbors, of six, of a cell in the corner of a body. Cells of a narrow chamber, left empty though full for
/// the most part, have fewer.
const BARE: usize = 3;

type Key = [i32; 3];

/// Cells with their corners, among the vertices of the voxels and, behind these, some more.
pub(super) struct Cells {
    pub corners: Vec<[u32; 8]>,
    pub vertices: Vec<Vec3>,
    /// Vertex of a voxel that stands for each of the vertices behind those of the voxels.
    stand_ins: Vec<u32>,
    /// Voxels near each of them.
    pub near: Vec<Vec<u32>>,
}

impl Cells {
    /// Cells for voxels with the given corners.
    ///
    /// # Errors
    ///
    /// Errors of the function.
    pub(super) fn of<E>(
        voxels: &[[u32; 8]],
        vertices: &[Vec3],
        field: &mut Field<'_, E>,
    ) -> Result<Self, E> {
        let grid = Grid::of(voxels, vertices, field.voxel);
        let mut inside = grid.inside(grid.around(), field)?;
        let astray: Vec<Key> = (grid.keys.iter())
            .filter(|key| !inside.contains(*key))
            .copied()
            .collect();
        let centers: Vec<Vec3> = astray.iter().map(|key| grid.center(*key)).collect();
        let alone: Vec<Key> = (astray.into_iter().zip(field.gradients(&centers)?))
            .filter(|(key, gradient)| !is_before(*key, *gradient, &inside))
            .map(|(key, _)| key)
            .collect();
        let bare = |key: &Key| {
            let beside = (0..6).map(|side| beside(*key, side));
            let is_bare = |key: &Key| !grid.numbers.contains_key(key) && !inside.contains(key);
            beside.filter(is_bare).count()
        };
        let added: Vec<Key> = (inside.iter())
            .filter(|key| !grid.numbers.contains_key(*key) && bare(key) >= BARE)
            .copied()
            .collect();
        inside.extend(alone);
        let kept = grid.keys.iter().zip(voxels);
        let corners = kept.filter(|(key, _)| inside.contains(*key));
        let mut cells = Self {
            corners: corners.map(|(_, corners)| *corners).collect(),
            vertices: vertices.to_vec(),
            stand_ins: Vec::new(),
            near: Vec::new(),
        };
        cells.add(&added, &grid, voxels);
        Ok(cells)
    }

    /// Adds cells beside voxels.
    fn add(&mut self, added: &[Key], grid: &Grid, voxels: &[[u32; 8]]) {
        let real = self.vertices.len();
        let mut known: BTreeMap<Key, u32> = BTreeMap::new();
        for key in added {
            let around: Vec<u32> = (neighbors(*key))
                .filter_map(|key| grid.numbers.get(&key).copied())
                .collect();
            for voxel in &around {
                for (corner, vertex) in voxels[*voxel as usize].into_iter().enumerate() {
                    known.insert(corner_of(grid.keys[*voxel as usize], corner), vertex);
                }
            }
            let corners: [Key; 8] = std::array::from_fn(|corner| corner_of(*key, corner));
            let own = corners.iter().filter_map(|corner| known.get(corner));
            let own: Vec<u32> = own.copied().filter(|v| (*v as usize) < real).collect();
            self.corners.push(corners.map(|corner| {
                *known.entry(corner).or_insert_with(|| {
                    let place = grid.corner(corner);
                    let away = |v: &u32| norm(sub(self.vertices[*v as usize], place));
                    let nearest = own.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
                    self.stand_ins.push(nearest.copied().unwrap_or(0));
                    self.near.push(around.clone());
                    self.vertices.push(place);
                    self.vertices.len() as u32 - 1
                })
            }));
        }
    }

    /// Share with the vertices of voxels alone.
    pub(super) fn share(&self, share: &Carried) -> Carried {
        let real = self.vertices.len() - self.stand_ins.len();
        if share.vertices.iter().all(|v| (*v as usize) < real) {
            return share.clone();
        }
        let mut weights: BTreeMap<u32, f64> = BTreeMap::new();
        for (vertex, weight) in share.vertices.iter().zip(&share.weights) {
            let behind = (*vertex as usize).checked_sub(real);
            let vertex = behind.map_or(*vertex, |number| self.stand_ins[number]);
            *weights.entry(vertex).or_default() += weight;
        }
        let (vertices, weights) = weights.into_iter().unzip();
        Carried { vertices, weights }
    }
}

/// Voxels by their integer places.
struct Grid {
    origin: Vec3,
    voxel: f64,
    keys: Vec<Key>,
    numbers: BTreeMap<Key, u32>,
}

impl Grid {
    fn of(voxels: &[[u32; 8]], vertices: &[Vec3], voxel: f64) -> Self {
        let low = |corners: &[u32; 8]| vertices[corners[0] as usize];
        let origin = voxels.first().map_or([0.0; 3], low);
        let key = |corners| sub(low(corners), origin).map(|x| (x / voxel).round() as i32);
        let keys: Vec<Key> = voxels.iter().map(key).collect();
        let numbers = keys.iter().copied().zip(0..).collect();
        Self {
            origin,
            voxel,
            keys,
            numbers,
        }
    }

    fn corner(&self, key: Key) -> Vec3 {
        add(self.origin, scale(self.voxel, key.map(f64::from)))
    }

    fn center(&self, key: Key) -> Vec3 {
        let half = self.voxel / 2.0;
        add(self.corner(key), [half; 3])
    }

    /// Voxels and the cells around them.
    fn around(&self) -> BTreeSet<Key> {
        let near = self.keys.iter().flat_map(|key| neighbors(*key));
        near.chain(self.keys.iter().copied()).collect()
    }

    /// Those cells whose centers are in the shape.
    fn inside<E>(
        &self,
        cells: BTreeSet<Key>,
        field: &mut Field<'_, E>,
    ) -> Result<BTreeSet<Key>, E> {
        let centers: Vec<Vec3> = cells.iter().map(|key| self.center(*key)).collect();
        let values = cells.into_iter().zip(field.at(&centers)?);
        let inside = values.filter(|(_, value)| *value < 0.0);
        Ok(inside.map(|(key, _)| key).collect())
    }
}

/// Tests whether a cell inward of one with its center outside has its own inside.
fn is_before(key: Key, gradient: Vec3, inside: &BTreeSet<Key>) -> bool {
    neighbors(key).any(|other| {
        let way: Vec3 = std::array::from_fn(|i| f64::from(other[i] - key[i]));
        let most = INWARD * norm(way) * norm(gradient);
        -dot(way, gradient) > most && inside.contains(&other)
    })
}

fn neighbors(key: Key) -> impl Iterator<Item = Key> {
    let all = (0..27).filter(|number| *number != 13);
    all.map(move |n| {
        let way = [n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1];
        std::array::from_fn(|i| key[i] + way[i])
    })
}

fn beside(mut key: Key, side: usize) -> Key {
    key[side / 2] += [1, -1][side % 2];
    key
}

/// Integer place of a corner of a cell.
fn corner_of(key: Key, corner: usize) -> Key {
    std::array::from_fn(|i| key[i] + (corner >> (2 - i) & 1) as i32)
}
