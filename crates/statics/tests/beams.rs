//! Cantilevers under their own weight: rotations beyond a right angle, from one step.

mod common;

use common::{block, cantilever, rubber, settled, vertices_where};
use voxsoft_solid::{Body, Clamp, HyperelasticMaterial, LatticeMaterial, Load, Material, Problem};
use voxsoft_statics::{Settings, Status};

#[test]
fn slender_beam_under_its_whole_weight_at_once() {
    for (cells, most) in [([20, 2, 2], 40), ([20, 4, 2], 40), ([10, 2, 4], 8)] {
        let problem = cantilever(cells, 5e-3, rubber());
        let answer = settled(&problem, &Settings::default());
        assert_eq!(answer.status, Status::AtRest);
        assert!(answer.stable);
        assert!(
            answer.iterations <= most,
            "{} iterations",
            answer.iterations
        );
    }
}

#[test]
fn lattice_cantilever_comes_to_rest() {
    let lattice = LatticeMaterial::from_moduli(25e3, 100e3, 1070.0).unwrap();
    let problem = cantilever([20, 2, 2], 5e-3, Material::from(lattice));
    let answer = settled(&problem, &Settings::default());
    assert_eq!(answer.status, Status::AtRest);
}

#[test]
fn light_load_on_a_nearly_incompressible_beam() {
    // K is 5,000 shear moduli, and the strain of 5e-5 leaves a residual of rounding above the tolerance.
    let material = HyperelasticMaterial::neo_hookean(60e3, 0.4999, 1.0).unwrap();
    let mesh = block([20, 2, 2], 5e-3);
    let body = Body::new(&mesh, &[material]).unwrap();
    let wall = Clamp::fixed(vertices_where(&mesh, |x| x[0] < 1e-9));
    let weight = Load::gravity([0.0, 0.0, -1.0]);
    let problem = Problem::new(body, vec![wall], vec![weight], None).unwrap();
    let answer = settled(&problem, &Settings::default());
    assert_eq!(answer.status, Status::AtRest);
    // Largest residual that counts as rounding.
    assert!(answer.residual < 1e-4, "{}", answer.residual);
}
