//! Data shared by all candidates: the order of elimination, and the entries of each constraint in the tangent.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Load, Problem};

/// Index of a vertex that is held along all axes, and of a block of the tangent that does not exist.
pub(super) const NONE: u32 = u32::MAX;

/// Edge constraint and its blocks of the tangent.
pub(super) struct EdgePiece {
    pub ends: [u32; 2],
    /// Rest length, m.
    pub length: f64,
    /// Stiffness in N/m, before the candidate's factor.
    pub stiffness: f64,
    /// Blocks of each end with itself.
    pub diagonal: [u32; 2],
    /// Block of the two ends; symmetric, so that their order does not matter.
    pub cross: u32,
}

/// Two corners of a tetrahedron and their block of the tangent.
#[derive(Clone, Copy)]
pub(super) struct Pair {
    pub block: u32,
    /// Corner of the row, eliminated after the other.
    pub row: u8,
    pub column: u8,
    /// Other two corners, in the order in which the second derivative of the volume with respect to row and column is
    /// `[x_to − x_from]×/6`.
    pub from: u8,
    pub to: u8,
}

/// Volume constraint and its blocks of the tangent.
pub(super) struct TetPiece {
    pub vertices: [u32; 4],
    /// Rest volume, m³.
    pub volume: f64,
    /// Stiffness in Pa/m³, before the candidate's factor.
    pub stiffness: f64,
    pub diagonal: [u32; 4],
    pub pairs: [Pair; 6],
}

/// Row of 3×3 blocks of the lower half of the tangent: all columns from the first nonzero one to the diagonal.
#[derive(Clone, Copy)]
pub(super) struct Row {
    pub vertex: u32,
    /// Row of the first block.
    pub first: u32,
    /// Index of that block in the list of all blocks.
    pub start: u32,
}

/// Data of a problem that do not depend on the candidate.
pub(super) struct Layout {
    pub rest: Vec<Vec3>,
    pub edges: Vec<EdgePiece>,
    pub tets: Vec<TetPiece>,
    /// Vertices that are free along some axis, in the order of elimination.
    pub rows: Vec<Row>,
    pub blocks: usize,
    /// Held axes of such vertices: row and axis.
    pub pinned: Vec<(u32, u8)>,
    /// Entries of the tangent that belong to held axes.
    pub cleared: Vec<u32>,
    /// Diagonal entries among them.
    pub ones: Vec<u32>,
    /// Weight of each vertex and the other forces on it in N, with the final factors of their histories.
    pub weight: Vec<Vec3>,
    pub forces: Vec<Vec3>,
    /// Size of the body, m.
    pub size: f64,
    /// Force of a unit strain in N, before the candidate's factor on edges.
    pub unit_strain_force: f64,
}

/// Other two corners for each pair of corners, so that the second derivative of the volume with respect to the first
/// and the second is `[x_to − x_from]×/6`.
const PAIRS: [[u8; 4]; 6] = [
    [0, 1, 3, 2],
    [0, 2, 1, 3],
    [0, 3, 2, 1],
    [1, 2, 3, 0],
    [1, 3, 0, 2],
    [2, 3, 1, 0],
];

impl Layout {
    /// Lays out a lattice body under dead loads, without a floor, with fixed clamps; `None` for any other.
    pub fn of(problem: &Problem) -> Option<Self> {
        let body = problem.body();
        let beyond = body.attached().count() + body.membranes().len();
        let plain = body.hex8s().is_empty() && beyond == 0;
        let still = problem.clamps().iter().all(|clamp| clamp.motion.is_none());
        let dead = problem.loads().iter().all(|load| !load.kind.follows());
        if !plain || !still || !dead || problem.floor().is_some() || body.edges().is_empty() {
            return None;
        }
        let (rows, places) = skyline(problem);
        let last = rows.last()?;
        let blocks = (last.start + rows.len() as u32 - last.first) as usize;
        let block = |a: u32, b: u32| {
            let (a, b) = (places[a as usize], places[b as usize]);
            if a == NONE || b == NONE {
                return NONE;
            }
            let row = &rows[a.max(b) as usize];
            row.start + a.min(b) - row.first
        };
        let edges = body.edges().iter().map(|edge| {
            let [a, b] = edge.vertices;
            EdgePiece {
                ends: edge.vertices,
                length: edge.length,
                stiffness: edge.stiffness,
                diagonal: [block(a, a), block(b, b)],
                cross: block(a, b),
            }
        });
        let tets = body.tets().iter().map(|tet| {
            let place = |corner: u8| places[tet.vertices[corner as usize] as usize];
            TetPiece {
                vertices: tet.vertices,
                volume: tet.volume,
                stiffness: tet.stiffness,
                diagonal: tet.vertices.map(|v| block(v, v)),
                pairs: PAIRS.map(|[p, q, from, to]| {
                    let block = block(tet.vertices[p as usize], tet.vertices[q as usize]);
                    let (row, column) = if place(p) > place(q) { (p, q) } else { (q, p) };
                    // The block of `q` and `p` is the transpose, and changes the sign.
                    let (from, to) = if row == p { (from, to) } else { (to, from) };
                    Pair {
                        block,
                        row,
                        column,
                        from,
                        to,
                    }
                }),
            }
        });
        let (edges, tets) = (edges.collect(), tets.collect());
        let loads = |weight: bool| {
            let factor = |load: &Load| {
                if load.kind.is_weight() == weight {
                    load.history.at(f64::INFINITY)
                } else {
                    0.0
                }
            };
            let mut forces = vec![[0.0; 3]; body.rest().len()];
            problem.add_scaled_loads(body.rest(), &factor, &mut forces);
            forces
        };
        let (pinned, cleared, ones) = pinned(problem, &rows);
        Some(Self {
            rest: body.rest().to_vec(),
            edges,
            tets,
            blocks,
            pinned,
            cleared,
            ones,
            weight: loads(true),
            forces: loads(false),
            size: body.size(),
            unit_strain_force: body.unit_strain_force(),
            rows,
        })
    }

    /// Number of products of 3×3 blocks in a factorization.
    pub fn products(&self) -> u64 {
        let row = |(index, row): (usize, &Row)| {
            let width = |j: u32| j - self.rows[j as usize].first.max(row.first);
            (row.first..=index as u32)
                .map(width)
                .map(u64::from)
                .sum::<u64>()
        };
        self.rows.iter().enumerate().map(row).sum()
    }
}

/// Rows of the tangent, and the row of each vertex or [`NONE`].
///
/// Vertices are eliminated along the longest axis of the body: the envelope of the factor is then about as wide as two
/// layers of vertices across it.
fn skyline(problem: &Problem) -> (Vec<Row>, Vec<u32>) {
    let body = problem.body();
    let rest = body.rest();
    let mut axes = [0, 1, 2];
    let span = |axis: usize| {
        let values = || rest.iter().map(|x| x[axis]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    axes.sort_by(|&a, &b| span(b).total_cmp(&span(a)));
    let mut order: Vec<u32> = (0..rest.len() as u32)
        .filter(|&v| problem.held()[v as usize] != [true; 3])
        .collect();
    // Coordinates of one layer agree only up to rounding.
    let slack = 1e-6
        * body
            .edges()
            .iter()
            .map(|e| e.length)
            .fold(f64::INFINITY, f64::min);
    let key = |v: u32| axes.map(|axis| (rest[v as usize][axis] / slack).round() as i64);
    order.sort_by_cached_key(|&v| (key(v), v));
    let mut places = vec![NONE; rest.len()];
    for (place, &vertex) in order.iter().enumerate() {
        places[vertex as usize] = place as u32;
    }
    let mut firsts: Vec<u32> = (0..order.len() as u32).collect();
    let mut join = |vertices: &[u32]| {
        let placed = || {
            vertices
                .iter()
                .map(|&v| places[v as usize])
                .filter(|&p| p != NONE)
        };
        let Some(first) = placed().min() else { return };
        for place in placed() {
            let own = &mut firsts[place as usize];
            *own = first.min(*own);
        }
    };
    body.edges().iter().for_each(|edge| join(&edge.vertices));
    body.tets().iter().for_each(|tet| join(&tet.vertices));
    let mut start = 0;
    let rows = order
        .iter()
        .zip(firsts)
        .enumerate()
        .map(|(place, (&vertex, first))| {
            let row = Row {
                vertex,
                first,
                start,
            };
            start += place as u32 + 1 - first;
            row
        });
    (rows.collect(), places)
}

/// Held axes of vertices that are free along others, their entries of the tangent, and those on the diagonal.
fn pinned(problem: &Problem, rows: &[Row]) -> (Vec<(u32, u8)>, Vec<u32>, Vec<u32>) {
    let (mut pinned, mut cleared, mut ones) = (Vec::new(), Vec::new(), Vec::new());
    for (place, row) in rows.iter().enumerate() {
        let place = place as u32;
        for axis in 0..3u32 {
            if !problem.held()[row.vertex as usize][axis as usize] {
                continue;
            }
            pinned.push((place, axis as u8));
            for block in row.start..=row.start + place - row.first {
                cleared.extend((0..3).map(|column| 9 * block + 3 * axis + column));
            }
            for other in rows[place as usize..].iter().filter(|r| r.first <= place) {
                let block = other.start + place - other.first;
                cleared.extend((0..3).map(|r| 9 * block + 3 * r + axis));
            }
            ones.push(9 * (row.start + place - row.first) + 4 * axis);
        }
    }
    (pinned, cleared, ones)
}
