//! Materials as Python hands them over.
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Fiber, HyperelasticMaterial, LatticeMaterial, Material, Model};

use crate::errors::to_python;

/// The model's name, its constants, the bulk modulus (Pa) and the density (kg/m³); families of fibers
/// as (direction, modulus in Pa, whether they carry compression) and Prony branches may follow.
#[derive(FromPyObject)]
pub enum MaterialArgument {
    /// Without fibers.
    Plain(String, Vec<f64>, f64, f64),
    /// With fibers.
    Reinforced(String, Vec<f64>, f64, f64, Fibers),
    /// With fibers and Prony branches (share of the instantaneous modulus, time in s).
    Viscous(String, Vec<f64>, f64, f64, Fibers, Vec<(f64, f64)>),
}

type Fibers = Vec<(Vec3, f64, bool)>;

/// Young's modulus (Pa) and Poisson's ratio of a lattice material at a voxel size (m).
#[pyfunction]
pub fn lattice_constants(argument: MaterialArgument, voxel_size: f64) -> PyResult<(f64, f64)> {
    match material(argument)? {
        Material::Lattice(material) => {
            Ok((material.young(voxel_size), material.poisson(voxel_size)))
        }
        Material::Hyperelastic(material) => Ok((material.young(), material.poisson())),
    }
}

pub(crate) fn material(argument: MaterialArgument) -> PyResult<Material> {
    let (model, constants, bulk, density, fibers, prony) = match argument {
        MaterialArgument::Plain(model, constants, bulk, density) => {
            (model, constants, bulk, density, Vec::new(), Vec::new())
        }
        MaterialArgument::Reinforced(model, constants, bulk, density, fibers) => {
            (model, constants, bulk, density, fibers, Vec::new())
        }
        MaterialArgument::Viscous(model, constants, bulk, density, fibers, prony) => {
            (model, constants, bulk, density, fibers, prony)
        }
    };
    let model = match (model.as_str(), constants.as_slice()) {
        ("lattice", &[edge]) => {
            let material = LatticeMaterial::from_moduli(edge, bulk, density);
            return Ok(material.map_err(to_python)?.into());
        }
        ("lattice-compliance", &[edge, volume]) => {
            let material = LatticeMaterial::from_compliances(edge, volume, density);
            return Ok(material.map_err(to_python)?.into());
        }
        ("neo-hookean", &[c10]) => Model::NeoHookean { c10 },
        ("mooney-rivlin", &[c10, c01]) => Model::MooneyRivlin { c10, c01 },
        ("yeoh", &[c10, c20, c30]) => Model::Yeoh { c: [c10, c20, c30] },
        ("ogden", pairs) if matches!(pairs.len(), 2 | 4 | 6) => {
            let mut terms = [(0.0, 0.0); 3];
            for (term, pair) in terms.iter_mut().zip(pairs.chunks(2)) {
                *term = (pair[0], pair[1]);
            }
            Model::Ogden { terms }
        }
        ("gent", &[shear, limit]) => Model::Gent { shear, limit },
        (other, constants) => {
            let count = constants.len();
            let message = format!("no material model \"{other}\" with {count} constants");
            return Err(PyValueError::new_err(message));
        }
    };
    let fibers = fibers
        .into_iter()
        .map(|(direction, modulus, compression)| Fiber {
            direction,
            modulus,
            compression,
        });
    let material = HyperelasticMaterial::new(model, bulk, density)
        .and_then(|material| material.with_fibers(fibers.collect()))
        .and_then(|material| material.with_prony(prony))
        .map_err(to_python)?;
    Ok(material.into())
}
