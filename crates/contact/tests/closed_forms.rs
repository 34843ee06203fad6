//! Bodies with known overlap.
use proptest::prelude::*;
use voxsoft_contact::{Body, Penetration, Point, penetration};
use voxsoft_voxel::{Grid, TetMesh, tet_mesh};

/// Block of voxels of 1 m, its lower corner at the origin.
fn block(shape: [usize; 3]) -> TetMesh {
    let mut grid = Grid::empty(shape, [0.0; 3], 1.0, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], shape.map(|n| n as f64), 1);
    tet_mesh(&grid, u64::MAX).unwrap()
}

/// Several meshes as one body.
#[derive(Default)]
struct Bodies {
    rest: Vec<Point>,
    points: Vec<Point>,
    tets: Vec<[i32; 4]>,
    triangles: Vec<[i32; 3]>,
}

impl Bodies {
    fn with(mut self, mesh: &TetMesh, place: impl Fn(Point) -> Point) -> Self {
        let first = self.points.len() as i32;
        self.rest.extend(&mesh.vertices);
        self.points.extend(mesh.vertices.iter().map(|&p| place(p)));
        let tets = mesh.tets.iter().map(|tet| tet.map(|v| v + first));
        self.tets.extend(tets);
        let triangles = mesh.triangles.iter().map(|t| t.map(|v| v + first));
        self.triangles.extend(triangles);
        self
    }

    fn find(&self) -> Penetration {
        penetration(&Body {
            rest: &self.rest,
            positions: &self.points,
            tets: &self.tets,
            triangles: &self.triangles,
            membranes: &[],
        })
    }
}

fn still(p: Point) -> Point {
    p
}

fn moved(by: Point) -> impl Fn(Point) -> Point {
    move |p| std::array::from_fn(|i| p[i] + by[i])
}

/// Rotates about an axis by Rodrigues' formula.
fn turned(axis: Point, angle: f64) -> impl Fn(Point) -> Point {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let n = axis.map(|x| x / length);
    move |p| {
        let along: f64 = (0..3).map(|i| n[i] * p[i]).sum();
        std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let across = n[j] * p[k] - n[k] * p[j];
            p[i] * angle.cos() + across * angle.sin() + n[i] * along * (1.0 - angle.cos())
        })
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn depth_of_a_block_pushed_into_another(
        depth in 0.001..1.4_f64,
        beside in prop::array::uniform2(1.5..2.5_f64),
        axis in prop::array::uniform3(-1.0..1.0_f64),
        angle in 0.0..6.0_f64,
    ) {
        prop_assume!(axis.iter().any(|x| x.abs() > 0.1));
        let turn = turned(axis, angle);
        let push = moved([beside[0], beside[1], 3.0 - depth]);
        let found = Bodies::default()
            .with(&block([6, 6, 3]), &turn)
            .with(&block([2, 2, 3]), |p| turn(push(p)))
            .find();
        prop_assert_eq!(found.overlaps.len(), 1);
        // Positions are about 10 m, so rounding is 2e-15.
        prop_assert!((found.overlaps[0].depth - depth).abs() < 1e-13, "{:?}", found.overlaps);
    }

    #[test]
    fn overlap_of_blocks_on_a_common_grid(by in prop::array::uniform3(-3..4_i32)) {
        // Blocks of 2 x 2 x 2 and 3 x 2 x 2 voxels: their faces, edges and vertices fall onto each other.
        let found = Bodies::default()
            .with(&block([2, 2, 2]), still)
            .with(&block([3, 2, 2]), moved(by.map(f64::from)))
            .find();
        let common = by[0] > -3 && by[0] < 2 && by[1].abs() < 2 && by[2].abs() < 2;
        prop_assert_eq!(!found.overlaps.is_empty(), common);
    }
}

#[test]
fn touching_blocks_overlap_from_the_last_bit_on() {
    let at = |z: f64| {
        Bodies::default()
            .with(&block([4, 4, 2]), still)
            .with(&block([2, 2, 2]), moved([0.7, 0.9, z]))
            .find()
    };
    assert!(at(2.0).overlaps.is_empty());
    assert!(at(2.0_f64.next_up()).overlaps.is_empty());
    let least = at(2.0_f64.next_down());
    assert_eq!(least.overlaps.len(), 1);
    let bit = 2.0 - 2.0_f64.next_down();
    assert!(least.overlaps[0].depth <= 2.0 * bit && least.overlaps[0].depth > 0.0);
}

#[test]
fn block_wholly_in_another_is_found() {
    let found = Bodies::default()
        .with(&block([5, 5, 5]), still)
        .with(&block([1, 1, 1]), moved([1.25, 2.25, 2.25]))
        .find();
    assert!(found.pairs.is_empty());
    assert_eq!(found.overlaps.len(), 1);
    assert_eq!(found.overlaps[0].depth, 2.25);
}

#[test]
fn block_in_one_and_across_another_has_two_overlaps() {
    let found = Bodies::default()
        .with(&block([5, 5, 5]), still)
        .with(&block([1, 1, 1]), moved([2.0, 2.0, 2.25]))
        .with(&block([1, 1, 2]), moved([2.25, 2.5, 3.0]))
        .find();
    // Blocks 2 and 3 in block 1, and block 3 in block 2.
    assert_eq!(found.overlaps.len(), 3);
    let depths: Vec<f64> = found.overlaps.iter().map(|overlap| overlap.depth).collect();
    assert_eq!(depths[0], 2.0);
    assert!((depths[2] - 0.25).abs() < 1e-15, "{depths:?}");
}

#[test]
fn a_block_in_a_cavity_is_free() {
    let mut grid = Grid::empty([5, 5, 5], [0.0; 3], 1.0, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [5.0; 3], 1);
    for cell in 0..27 {
        grid.set([1 + cell / 9, 1 + cell / 3 % 3, 1 + cell % 3], 0);
    }
    let hollow = tet_mesh(&grid, u64::MAX).unwrap();
    let within = |by| {
        Bodies::default()
            .with(&hollow, still)
            .with(&block([1, 1, 1]), moved(by))
            .find()
    };
    assert!(within([2.0; 3]).overlaps.is_empty());
    assert!(within([1.0; 3]).overlaps.is_empty());
    let off = within([2.0, 2.0, 0.75]);
    assert!((off.overlaps[0].depth - 0.25).abs() < 1e-15);
}

#[test]
fn crossed_bars_overlap_without_a_vertex_inside() {
    // Edge to edge: square bars turned by 45 degrees about their lengths, one along x, one along y.
    let half = 0.5_f64.sqrt();
    let bar = |p: Point| {
        [
            6.0 * p[0] - 3.0,
            (p[1] - 0.5) * half - (p[2] - 0.5) * half,
            (p[1] - 0.5) * half + (p[2] - 0.5) * half,
        ]
    };
    let depth = 0.2;
    let across = |p: Point| {
        let [x, y, z] = bar(p);
        [-y, x, z + 2.0 * half - depth]
    };
    let found = Bodies::default()
        .with(&block([1, 1, 1]), bar)
        .with(&block([1, 1, 1]), across)
        .find();
    assert!(found.covered.is_empty());
    assert_eq!(found.overlaps.len(), 1);
    // The edge of one runs within the other, 0.2 below its edge: the faces there slope by 45 degrees.
    assert!(
        (found.overlaps[0].depth - depth * half).abs() < 1e-12,
        "{:?}",
        found.overlaps
    );
}

/// Strip in the plane y = const, rolled up along x by an angle per meter: it meets itself after a turn.
fn rolled(turns: f64) -> Bodies {
    let strip = block([40, 2, 1]);
    let radius = 40.0 / (turns * std::f64::consts::TAU);
    Bodies::default().with(&strip, |[x, y, z]| {
        let angle = x / radius;
        [(radius + z) * angle.sin(), y, (radius + z) * angle.cos()]
    })
}

#[test]
fn rolled_strip_overlaps_itself_past_one_turn() {
    assert!(rolled(0.99).find().overlaps.is_empty());
    let found = rolled(1.1).find();
    assert_eq!(found.overlaps.len(), 1);
    // The ends lie in the same ring of chords: no point of it is deeper than half its thickness.
    assert!(found.overlaps[0].depth > 0.4 && found.overlaps[0].depth < 0.51);
    let [here, there] = found.overlaps[0].rest;
    assert!((here[0] - there[0]).abs() > 35.0, "{here:?} {there:?}");
    assert_ne!(found.overlaps[0].tets[0], found.overlaps[0].tets[1]);
}

#[test]
fn strip_through_itself_overlaps_once() {
    // Path as in Klein's bottle: a strip that turns back and passes through its own middle, at a right angle.
    let path = |s: f64| -> ([f64; 2], f64) {
        use std::f64::consts::{FRAC_PI_2, PI};
        let (straight, radius) = (20.0, 6.0);
        let arc = 1.5 * PI * radius;
        if s < straight {
            ([s, 0.0], 0.0)
        } else if s < straight + arc {
            let angle = (s - straight) / radius;
            (
                [
                    straight + radius * angle.sin(),
                    radius * (1.0 - angle.cos()),
                ],
                angle,
            )
        } else {
            let down = s - straight - arc;
            ([straight - radius, radius - down], 3.0 * FRAC_PI_2)
        }
    };
    let strip = block([60, 3, 2]);
    let body = Bodies::default().with(&strip, |[x, y, z]| {
        let ([a, b], angle) = path(x);
        let across = z - 1.0;
        [a - across * angle.sin(), y, b + across * angle.cos()]
    });
    let found = body.find();
    assert_eq!(found.overlaps.len(), 1);
    let overlap = found.overlaps[0];
    assert!(
        (overlap.now[0] - 14.0).abs() < 1.5 && overlap.now[2].abs() < 1.5,
        "{overlap:?}"
    );
    // Two strips 2 m thick that cross at a right angle: nowhere deeper than half the thickness.
    assert!(
        overlap.depth > 0.7 && overlap.depth < 1.0 + 1e-9,
        "{overlap:?}"
    );
}

#[test]
fn vertex_pushed_through_its_own_cell_is_no_overlap() {
    let mesh = block([3, 3, 3]);
    let mut body = Bodies::default().with(&mesh, still);
    let corner = mesh.vertices.iter().position(|p| *p == [3.0; 3]).unwrap();
    body.points[corner] = [2.4; 3];
    assert!(body.find().overlaps.is_empty());
}

#[test]
fn result_is_independent_of_threads() {
    let body = Bodies::default()
        .with(&block([20, 20, 20]), still)
        .with(&block([20, 20, 20]), |p| {
            turned([1.0, 2.0, 3.0], 0.3)(moved([10.0, 11.0, 12.0])(p))
        });
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| body.find())
    };
    let one = on(1);
    assert!(one.pairs.len() > 100);
    assert_eq!(one, on(2));
    assert_eq!(one, on(5));
}
