//! Forces are minus the gradient of the energy; rigid motions cost nothing.

use proptest::prelude::*;
use voxsoft_solid::vector::{Vec3, add, cross, rotate};
use voxsoft_solid::{Body, LatticeMaterial, Mesh, elastic};
use voxsoft_voxel::{Grid, tet_mesh};

fn body(cells: [usize; 3], h: f64, materials: &[LatticeMaterial]) -> Body {
    let mut grid = Grid::empty(cells, [0.0; 3], h, u64::MAX).unwrap();
    let size = cells.map(|n| n as f64 * h);
    grid.fill_box([0.0; 3], size, 1);
    let mut middle = size;
    middle[0] /= 2.0;
    grid.fill_box([0.0; 3], middle, materials.len() as u8);
    let mesh = tet_mesh(&grid, u64::MAX).unwrap();
    let count = mesh.tets.len() as u32;
    let mesh = Mesh {
        vertices: mesh.vertices,
        tets: mesh.tets.iter().map(|tet| tet.map(|v| v as u32)).collect(),
        tet_part: mesh.tet_part.iter().map(|part| part - 1).collect(),
        tet_block: (0..count).map(|tet| tet / 5).collect(),
        ..Mesh::default()
    };
    Body::new(&mesh, materials).unwrap()
}

fn soft() -> LatticeMaterial {
    LatticeMaterial::from_moduli(20e3, 100e3, 1070.0).unwrap()
}

fn stiff() -> LatticeMaterial {
    LatticeMaterial::from_moduli(300e3, 900e3, 1200.0).unwrap()
}

fn forces(body: &Body, positions: &[Vec3]) -> Vec<Vec3> {
    let mut forces = vec![[0.0; 3]; positions.len()];
    elastic::add_forces(body, positions, &mut forces);
    forces
}

#[test]
fn an_inner_edge_has_the_compliance_of_the_design_page() {
    let (h, edge) = (2e-3, 20e3);
    let body = body([4, 4, 4], h, &[soft()]);
    let inner = |p: &Vec3| p.iter().all(|x| *x > 1e-9 && *x < 4.0 * h - 1e-9);
    let mut seen = 0;
    for e in body.edges() {
        let [a, b] = e.vertices.map(|v| body.rest()[v as usize]);
        if inner(&a) && inner(&b) {
            assert!((1.0 / e.stiffness * (edge * e.length) - 1.0).abs() < 1e-9);
            seen += 1;
        }
    }
    assert!(seen > 50);
}

#[test]
fn energy_of_a_uniform_strain_does_not_depend_on_the_voxel_size() {
    let stretch = |p: &Vec3| [1.05 * p[0], 0.98 * p[1], p[2] + 0.02 * p[0]];
    let energy = |n: usize| {
        let body = body([n, n, n], 0.02 / n as f64, &[soft()]);
        let positions: Vec<Vec3> = body.rest().iter().map(stretch).collect();
        elastic::energy(&body, &positions)
    };
    let reference = energy(2);
    for n in [4, 8] {
        assert!((energy(n) / reference - 1.0).abs() < 1e-9);
    }
}

#[test]
fn mass_is_density_times_volume_part_by_part() {
    let h = 3e-3;
    let body = body([4, 2, 2], h, &[soft(), stiff()]);
    let half = 8.0 * h * h * h;
    assert!((body.total_mass() / (half * (1070.0 + 1200.0)) - 1.0).abs() < 1e-12);
}

#[test]
fn chunks_of_one_color_share_no_vertex_and_cover_all_constraints() {
    let body = body([5, 4, 3], 1e-3, &[soft()]);
    assert_eq!(body.colors().len(), 8);
    let chunks: Vec<_> = body.chunks().collect();
    let mut start = 0;
    for &end in body.colors() {
        let mut seen = std::collections::HashSet::new();
        for (edges, tets) in &chunks[start..end as usize] {
            let mut own = std::collections::HashSet::new();
            own.extend(body.edges()[edges.clone()].iter().flat_map(|e| e.vertices));
            own.extend(body.tets()[tets.clone()].iter().flat_map(|t| t.vertices));
            assert!(seen.is_disjoint(&own));
            seen.extend(own);
        }
        start = end as usize;
    }
    assert_eq!(
        chunks.iter().map(|b| b.0.len()).sum::<usize>(),
        body.edges().len()
    );
    assert_eq!(
        chunks.iter().map(|b| b.1.len()).sum::<usize>(),
        body.tets().len()
    );
}

proptest! {
    #[test]
    fn forces_are_the_gradient_and_carry_no_net_force_or_moment(
        noise in prop::collection::vec(-0.4..0.4f64, 3 * 45), which in 0..135usize,
    ) {
        let h = 2e-3;
        let body = body([4, 2, 2], h, &[soft(), stiff()]);
        let mut positions: Vec<Vec3> = body.rest().to_vec();
        for (i, x) in positions.as_flattened_mut().iter_mut().enumerate() {
            *x += h * noise[i];
        }
        let forces = forces(&body, &positions);
        let size = forces.as_flattened().iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let mut total = [0.0; 3];
        let mut moment = [0.0; 3];
        for (f, x) in forces.iter().zip(&positions) {
            total = add(total, *f);
            moment = add(moment, cross(*x, *f));
        }
        // Rounding of a sum over 45 vertices.
        for axis in 0..3 {
            prop_assert!(total[axis].abs() < 1e-12 * size * 45.0);
            prop_assert!(moment[axis].abs() < 1e-12 * size * 45.0 * h * 4.0);
        }
        // Central differences: error of order step², and rounding of the energy over the step.
        let step = 1e-5 * h;
        let mut energy_at = |shift: f64| {
            positions.as_flattened_mut()[which] += shift;
            let energy = elastic::energy(&body, &positions);
            positions.as_flattened_mut()[which] -= shift;
            energy
        };
        let slope = (energy_at(step) - energy_at(-step)) / (2.0 * step);
        prop_assert!((slope + forces.as_flattened()[which]).abs() < 1e-6 * size);
    }

    #[test]
    fn rigid_motions_cost_no_energy(
        angle in -3.0..3.0f64, axis in prop::array::uniform3(-1.0..1.0f64), shift in prop::array::uniform3(-1.0..1.0f64),
    ) {
        let length = (axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]).sqrt();
        prop_assume!(length > 1e-3);
        let axis = axis.map(|a| a / length);
        let body = body([2, 2, 2], 5e-3, &[soft()]);
        let moved: Vec<Vec3> = body.rest().iter().map(|p| add(rotate(*p, axis, angle), shift)).collect();
        // A meter of shift leaves 1e-16 m of rounding on edges of 5 mm.
        prop_assert!(elastic::energy(&body, &moved) < 1e-20);
    }
}
