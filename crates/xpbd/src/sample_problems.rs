//! Sample problems for comparing strips with single vertices.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Body, Clamp, Floor, History, LatticeMaterial, Load, Mesh, Motion, PointForces, Pressure,
    Problem,
};
use voxsoft_voxel::{Grid, tet_mesh};

const SIDE: f64 = 5e-3;

/// A box of 7 × 4 × 5 voxels with a cavity of 3 × 2 × 3, and the cavity's triangles.
fn hollow() -> (Body, Vec<[u32; 3]>) {
    let mut grid = Grid::empty([7, 4, 5], [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [7.0 * SIDE, 4.0 * SIDE, 5.0 * SIDE], 1);
    for cell in (0..18).map(|n| [2 + n / 6, 1 + n / 3 % 2, 1 + n % 3]) {
        grid.set(cell, 0);
    }
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let count = tets.tets.len();
    let cavity = tets.cavities[0].triangles.iter();
    let triangles = cavity.map(|t| t.map(|v| v as u32)).collect();
    let mesh = Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    };
    let material = LatticeMaterial::from_moduli(27e3, 100e3, 1070.0).unwrap();
    (Body::new(&mesh, &[material]).unwrap(), triangles)
}

fn vertices(body: &Body, inside: impl Fn(&Vec3) -> bool) -> Vec<u32> {
    let count = body.rest().len() as u32;
    (0..count)
        .filter(|&v| inside(&body.rest()[v as usize]))
        .collect()
}

/// A hollow box under three loads: inflated and sagging, pulled and twisted, and standing on the floor.
pub(crate) fn problems() -> Vec<Problem> {
    let (body, triangles) = hollow();
    let gravity = Load::gravity([0.0, 0.0, -9.81]);
    let wall = Clamp::fixed(vertices(&body, |p| p[0] < 1e-9));
    let pressure = Load::constant(Pressure {
        voids: vec![(body.tets()[3].vertices, 0.3)],
        triangles,
        pressure: 800.0,
        closed: false,
    });
    let end = vertices(&body, |p| p[0] > 6.9 * SIDE);
    let turned = Clamp {
        vertices: end.clone(),
        axes: [true, false, true],
        motion: Some(Motion {
            displacement: [2e-3, 0.0, 1e-3],
            axis: [0.0, 1.0, 0.0],
            angle: 0.1,
            center: [7.0 * SIDE, 0.0, 0.0],
            history: History::constant(),
            courses: None,
        }),
    };
    let pull = Load::constant(PointForces {
        forces: vec![[0.0, 2e-3, 0.0]; end.len()],
        vertices: end,
    });
    let floor = Some(Floor { z: 0.0 });
    let stand = Clamp {
        vertices: vertices(&body, |p| p[0] < 1e-9),
        axes: [true, true, false],
        motion: None,
    };
    let make = |clamps, loads, floor| Problem::new(body.clone(), clamps, loads, floor).unwrap();
    vec![
        make(vec![wall.clone()], vec![gravity.clone(), pressure], None),
        make(vec![wall, turned], vec![pull], None),
        make(vec![stand], vec![gravity], floor),
    ]
}
