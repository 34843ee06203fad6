use voxsoft_solid::{
    Clamp, Filling, History, HyperelasticMaterial, LatticeConstants, LoadKind, Material, Model,
};
use voxsoft_xpbd::Damping;

use crate::{MAGIC, Scene, VERSION};

/// Numbers of the kinds of materials and loads.
pub(crate) mod kind {
    pub const LATTICE: u8 = 0;
    pub const LATTICE_COMPLIANCE: u8 = 1;
    pub const NEO_HOOKEAN: u8 = 2;
    pub const MOONEY_RIVLIN: u8 = 3;
    pub const YEOH: u8 = 4;
    pub const OGDEN: u8 = 5;
    pub const GENT: u8 = 6;

    pub const GRAVITY: u8 = 0;
    pub const PRESSURE: u8 = 1;
    pub const FORCES: u8 = 2;
}

impl Scene {
    /// The scene as bytes.
    pub fn write(&self) -> Vec<u8> {
        let mut out = Writer(Vec::new());
        out.0.extend_from_slice(&MAGIC);
        out.u32(VERSION);
        out.list(self.notes.as_bytes(), |out, byte| out.u8(*byte));
        let settings = &self.settings;
        out.f64(settings.time_step);
        out.u32(settings.substeps.unwrap_or(0));
        out.u32(settings.iterations);
        out.f64(match settings.damping {
            Damping::Rate(rate) => rate,
            Damping::Critical => -1.0,
        });
        out.f64s(&[settings.retardation, settings.tolerance]);
        let mesh = &self.mesh;
        out.list(&mesh.vertices, |out, row| out.f64s(row));
        out.list(&mesh.tets, |out, row| out.u32s(row));
        out.list(&mesh.tet_part, |out, part| out.u8(*part));
        out.list(&mesh.tet_block, |out, block| out.u32(*block));
        out.list(&mesh.block_fraction, |out, part| out.f64(*part));
        out.list(&mesh.block_filling, |out, Filling { shift, spread }| {
            out.f64s(shift);
            out.f64s(spread);
        });
        out.list(&mesh.membranes, |out, membrane| {
            out.u32s(&membrane.vertices());
            let m = membrane.material();
            out.f64s(&[m.young, m.poisson, m.thickness, m.density]);
        });
        out.list(&self.materials, Writer::material);
        out.list(&self.clamps, Writer::clamp);
        out.list(&self.loads, |out, load| {
            match &load.kind {
                LoadKind::Gravity(gravity) => {
                    out.u8(kind::GRAVITY);
                    out.f64s(&gravity.acceleration);
                }
                LoadKind::Pressure(load) => {
                    out.u8(kind::PRESSURE);
                    out.f64(load.pressure);
                    out.list(&load.triangles, |out, row| out.u32s(row));
                    out.list(&load.voids, |out, (corners, part)| {
                        out.u32s(corners);
                        out.f64(*part);
                    });
                }
                LoadKind::Forces(load) => {
                    out.u8(kind::FORCES);
                    out.list(&load.vertices, |out, vertex| out.u32(*vertex));
                    out.list(&load.forces, |out, row| out.f64s(row));
                }
            }
            out.history(&load.history);
        });
        out.u8(u8::from(self.floor.is_some()));
        out.f64(self.floor.map_or(0.0, |floor| floor.z));
        out.f64(self.voxel_size);
        out.list(&self.triangles, |out, row| out.u32s(row));
        out.list(&self.tags, |out, tag| out.u8(*tag));
        out.0
    }
}

struct Writer(Vec<u8>);

impl Writer {
    fn u8(&mut self, value: u8) {
        self.0.push(value);
    }

    fn u32(&mut self, value: u32) {
        self.0.extend_from_slice(&value.to_le_bytes());
    }

    fn u32s(&mut self, values: &[u32]) {
        values.iter().for_each(|value| self.u32(*value));
    }

    fn f64(&mut self, value: f64) {
        self.0.extend_from_slice(&value.to_le_bytes());
    }

    fn f64s(&mut self, values: &[f64]) {
        values.iter().for_each(|value| self.f64(*value));
    }

    fn list<T>(&mut self, entries: &[T], each: impl Fn(&mut Self, &T)) {
        self.u32(entries.len() as u32);
        entries.iter().for_each(|entry| each(self, entry));
    }

    fn history(&mut self, history: &History) {
        self.list(history.times(), |out, time| out.f64(*time));
        self.list(history.factors(), |out, factor| out.f64(*factor));
    }

    fn clamp(&mut self, clamp: &Clamp) {
        self.list(&clamp.vertices, |out, vertex| out.u32(*vertex));
        clamp.axes.iter().for_each(|axis| self.u8(u8::from(*axis)));
        self.u8(u8::from(clamp.motion.is_some()));
        if let Some(motion) = &clamp.motion {
            self.f64s(&motion.displacement);
            self.f64s(&motion.axis);
            self.f64(motion.angle);
            self.f64s(&motion.center);
            self.history(&motion.history);
        }
    }

    fn material(&mut self, material: &Material) {
        match material {
            Material::Lattice(material) => {
                let (kind, edge, volume) = match material.constants() {
                    LatticeConstants::Moduli { edge, bulk } => (kind::LATTICE, edge, bulk),
                    LatticeConstants::Compliances { edge, volume } => {
                        (kind::LATTICE_COMPLIANCE, edge, volume)
                    }
                };
                self.u8(kind);
                self.f64s(&[volume, material.density()]);
                self.list(&[edge], |out, edge| out.f64(*edge));
                // Neither fibers nor branches.
                self.u32s(&[0, 0]);
            }
            Material::Hyperelastic(material) => self.hyperelastic(material),
        }
    }

    fn hyperelastic(&mut self, material: &HyperelasticMaterial) {
        let (kind, constants) = match *material.model() {
            Model::NeoHookean { c10 } => (kind::NEO_HOOKEAN, vec![c10]),
            Model::MooneyRivlin { c10, c01 } => (kind::MOONEY_RIVLIN, vec![c10, c01]),
            Model::Yeoh { c } => (kind::YEOH, c.to_vec()),
            Model::Ogden { terms } => {
                let flat = terms.iter().flat_map(|(mu, alpha)| [*mu, *alpha]);
                (kind::OGDEN, flat.collect())
            }
            Model::Gent { shear, limit } => (kind::GENT, vec![shear, limit]),
        };
        self.u8(kind);
        self.f64s(&[material.bulk(), material.density()]);
        self.list(&constants, |out, constant| out.f64(*constant));
        self.list(material.fibers(), |out, fiber| {
            out.f64s(&fiber.direction);
            out.f64(fiber.modulus);
            out.u8(u8::from(fiber.compression));
        });
        self.list(material.prony(), |out, (share, time)| {
            out.f64s(&[*share, *time])
        });
    }
}
