//! `_core.Material`, `_core.Fiber` and `_core.Winding`: materials of parts, as frozen values.
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Eigenstrain, EigenstrainFactor, Fiber, History, HyperelasticMaterial, LatticeMaterial,
    Material, Model, Mullins, ProblemError, Share, Softening, Winding,
};

use crate::arrays::rows;
use crate::errors::{exception, to_python};

/// A growth factor: times (s), stretches, their exponent, and the share of each block if it is a field.
type Factor<'py> = (
    usize,
    Vec<f64>,
    Vec<f64>,
    f64,
    Option<PyReadonlyArray2<'py, f64>>,
);

/// A family of fibers: a unit vector, a modulus in Pa, resistance to compression (or tension only), and the stretch at
/// which they are free of stress.
#[pyclass(frozen, from_py_object, name = "Fiber", module = "voxsoft._core")]
#[derive(Clone)]
pub struct PyFiber(Fiber);

#[pymethods]
impl PyFiber {
    #[new]
    #[pyo3(signature = (direction, *, modulus, compression, free))]
    fn new(direction: Vec3, modulus: f64, compression: bool, free: f64) -> Self {
        Self(Fiber {
            direction,
            modulus,
            compression,
            free,
        })
    }
}

/// A family of fibers wound about an axis: a point on it in m, a unit vector along it, and the angle to it in rad.
#[pyclass(frozen, from_py_object, name = "Winding", module = "voxsoft._core")]
#[derive(Clone)]
pub struct PyWinding(Winding);

#[pymethods]
impl PyWinding {
    #[new]
    #[pyo3(signature = (center, axis, angle, *, modulus, compression, free))]
    fn new(
        center: Vec3,
        axis: Vec3,
        angle: f64,
        modulus: f64,
        compression: bool,
        free: f64,
    ) -> Self {
        Self(Winding {
            center,
            axis,
            angle,
            modulus,
            compression,
            free,
        })
    }
}

/// The material of a part, in SI units.
#[pyclass(
    frozen,
    eq,
    from_py_object,
    name = "Material",
    module = "voxsoft._core"
)]
#[derive(Clone, PartialEq)]
pub struct PyMaterial(pub(crate) Material);

#[pymethods]
impl PyMaterial {
    /// Lattice material (the paper's springs), from moduli.
    #[staticmethod]
    #[pyo3(signature = (*, edge, bulk, density))]
    fn lattice(edge: f64, bulk: f64, density: f64) -> PyResult<Self> {
        made(LatticeMaterial::from_moduli(edge, bulk, density))
    }

    /// Lattice material (the paper's springs), from raw compliances.
    #[staticmethod]
    #[pyo3(signature = (*, edge, volume, density))]
    fn lattice_compliance(edge: f64, volume: f64, density: f64) -> PyResult<Self> {
        made(LatticeMaterial::from_compliances(edge, volume, density))
    }

    #[staticmethod]
    #[pyo3(signature = (*, c10, bulk, density))]
    fn neo_hookean(c10: f64, bulk: f64, density: f64) -> PyResult<Self> {
        hyperelastic(Model::NeoHookean { c10 }, bulk, density)
    }

    #[staticmethod]
    #[pyo3(signature = (*, c10, c01, bulk, density))]
    fn mooney_rivlin(c10: f64, c01: f64, bulk: f64, density: f64) -> PyResult<Self> {
        hyperelastic(Model::MooneyRivlin { c10, c01 }, bulk, density)
    }

    #[staticmethod]
    #[pyo3(signature = (*, c, bulk, density))]
    fn yeoh(c: [f64; 3], bulk: f64, density: f64) -> PyResult<Self> {
        hyperelastic(Model::Yeoh { c }, bulk, density)
    }

    /// Ogden material of up to three terms, each a shear modulus and an exponent.
    #[staticmethod]
    #[pyo3(signature = (*, terms, bulk, density))]
    fn ogden(terms: Vec<(f64, f64)>, bulk: f64, density: f64) -> PyResult<Self> {
        let mut three = [(0.0, 0.0); 3];
        let Some(filled) = three.get_mut(..terms.len()) else {
            return Err(to_python(ProblemError::Length {
                what: "terms of an Ogden material",
                got: terms.len(),
                expected: 3,
            }));
        };
        filled.copy_from_slice(&terms);
        hyperelastic(Model::Ogden { terms: three }, bulk, density)
    }

    #[staticmethod]
    #[pyo3(signature = (*, shear, limit, bulk, density))]
    fn gent(shear: f64, limit: f64, bulk: f64, density: f64) -> PyResult<Self> {
        hyperelastic(Model::Gent { shear, limit }, bulk, density)
    }

    /// Copy of the material with these families of fibers in place of any others.
    fn with_fibers(&self, py: Python<'_>, fibers: Vec<PyFiber>) -> PyResult<Self> {
        let fibers = fibers.into_iter().map(|fiber| fiber.0).collect();
        made(self.rubber(py, "fibers")?.with_fibers(fibers))
    }

    /// Copy of the material with these families of wound fibers in place of any others.
    fn with_windings(&self, py: Python<'_>, windings: Vec<PyWinding>) -> PyResult<Self> {
        let windings = windings.into_iter().map(|winding| winding.0).collect();
        made(self.rubber(py, "fibers")?.with_windings(windings))
    }

    /// Copy of the material with a Prony series: share of the instantaneous modulus and relaxation time in s of each
    /// branch.
    fn with_prony(&self, py: Python<'_>, branches: Vec<(f64, f64)>) -> PyResult<Self> {
        made(self.rubber(py, "prony")?.with_prony(branches))
    }

    /// Copy of the material with the Mullins effect: Ogden and Roxburgh's constants `r`, `m` (J/m³) and `beta`, and the
    /// energy (J/m³) that all of it has already had.
    #[pyo3(signature = (r, m, beta, first=0.0))]
    fn with_mullins(
        &self,
        py: Python<'_>,
        r: f64,
        m: f64,
        beta: f64,
        first: f64,
    ) -> PyResult<Self> {
        let mullins = Mullins::new(r, m, beta, first).map_err(to_python)?;
        Ok(Self(
            self.rubber(py, "mullins")?
                .with_softening(Softening::Mullins(mullins))
                .into(),
        ))
    }

    /// Copy of the material with isotropic swelling: free of stress at this stretch along every axis.
    fn with_swelling(&self, py: Python<'_>, stretch: f64) -> PyResult<Self> {
        made(self.rubber(py, "activations")?.with_swelling(stretch))
    }

    /// Copy of the material with growth over time of itself and of its fibers. Each factor has times in s, stretches,
    /// an exponent and, if it is a field, the share of each block with half its differences across it.
    fn with_growth(
        &self,
        py: Python<'_>,
        of_material: Vec<Factor<'_>>,
        of_fibers: Vec<Factor<'_>>,
    ) -> PyResult<Self> {
        let factor = |(number, times, stretches, power, field): Factor<'_>| {
            let share = match field {
                None => Share::Whole,
                Some(field) => Share::Field(rows("field", &field)?.into()),
            };
            let history = History::new(times, stretches).map_err(to_python)?;
            Ok(EigenstrainFactor {
                history,
                power,
                share,
                number,
            })
        };
        let growth = |factors: Vec<Factor<'_>>| {
            let each = factors.into_iter().map(factor);
            Eigenstrain::new(each.collect::<PyResult<_>>()?).map_err(to_python)
        };
        let (of_material, of_fibers) = (growth(of_material)?, growth(of_fibers)?);
        let rubber = self.rubber(py, "activations")?;
        made(Ok(rubber.with_eigenstrain(of_material, of_fibers)))
    }

    /// Young's modulus in Pa at small strain, for voxels with edges of `voxel_size` m.
    fn young(&self, voxel_size: f64) -> f64 {
        match &self.0 {
            Material::Lattice(material) => material.young(voxel_size),
            Material::Hyperelastic(material) => material.young(),
        }
    }

    /// Poisson's ratio at small strain, for voxels with edges of `voxel_size` m.
    fn poisson(&self, voxel_size: f64) -> f64 {
        match &self.0 {
            Material::Lattice(material) => material.poisson(voxel_size),
            Material::Hyperelastic(material) => material.poisson(),
        }
    }

    fn __repr__(&self) -> String {
        match &self.0 {
            Material::Lattice(material) => format!("{material:?}"),
            Material::Hyperelastic(material) => format!("{material:?}"),
        }
    }
}

impl PyMaterial {
    /// Returns the hyperelastic material; a lattice has no fibers, Prony branches, Mullins effect, swelling or growth.
    fn rubber(&self, py: Python<'_>, what: &str) -> PyResult<HyperelasticMaterial> {
        self.0.hyperelastic().cloned().ok_or_else(|| {
            let came = "are for hyperelastic materials, and this one is a lattice";
            let hint = "use the neo-Hookean one of the same Young's modulus";
            exception(py, "MaterialError", what, came, hint)
        })
    }
}

fn hyperelastic(model: Model, bulk: f64, density: f64) -> PyResult<PyMaterial> {
    made(HyperelasticMaterial::new(model, bulk, density))
}

fn made(material: Result<impl Into<Material>, ProblemError>) -> PyResult<PyMaterial> {
    material
        .map(|material| PyMaterial(material.into()))
        .map_err(to_python)
}
