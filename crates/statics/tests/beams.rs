//! Cantilevers under their own weight: rotations beyond a right angle, from one step.

mod common;

use common::{cantilever, rubber, settled};
use voxsoft_solid::{LatticeMaterial, Material};
use voxsoft_statics::{Settings, Status};

#[test]
fn a_slender_beam_takes_its_whole_weight_at_once() {
    for (cells, most) in [([20, 2, 2], 40), ([20, 4, 2], 40), ([10, 2, 4], 8)] {
        let problem = cantilever(cells, 5e-3, rubber());
        let answer = settled(&problem, &Settings::default());
        assert_eq!(answer.status, Status::AtRest);
        assert!(answer.stable);
        println!("{cells:?} {} {}", answer.iterations, answer.back_offs);
        assert!(
            answer.iterations <= most,
            "{} iterations",
            answer.iterations
        );
    }
}

#[test]
fn the_lattice_comes_to_the_same_interface() {
    let lattice = LatticeMaterial::from_moduli(25e3, 100e3, 1070.0).unwrap();
    let problem = cantilever([20, 2, 2], 5e-3, Material::from(lattice));
    let answer = settled(&problem, &Settings::default());
    println!("lattice {} {}", answer.iterations, answer.back_offs);
    assert_eq!(answer.status, Status::AtRest);
}
