//! Round trips of scenes, and reading of damaged bytes without panics.

use proptest::prelude::*;
use voxsoft_contact::surface::Surface;
use voxsoft_contact::surface_contact::Description;
use voxsoft_contact::surface_contact::rigid::Frame;
use voxsoft_player::{Cast, Control, Placed, Probe};
use voxsoft_scene::{Scene, SceneError, Touching, VERSION};
use voxsoft_solid::matrix::IDENTITY;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Attachment, Clamp, CutSurface, Fiber, Filling, Floor, History, HyperelasticMaterial,
    LatticeMaterial, Load, Material, Membrane, MembraneMaterial, Mesh, Model, Motion, PointForces,
    Pressure, Rigid, Spring, Springs, Winding,
};
use voxsoft_voxel::{Grid, tet_mesh};
use voxsoft_xpbd::{Damping, Dynamics};

const SIDE: f64 = 5e-3;

/// Vertices with those of a free object, an octahedron, its first vertex, and its contact with the body.
fn with_ball(mut vertices: Vec<Vec3>, body: &[[u32; 3]]) -> (Vec<Vec3>, u32, Touching) {
    let first = vertices.len() as u32;
    let frame = Frame::of_mass([0.0, 0.0, 0.1], IDENTITY, [0.01; 3]).unwrap();
    vertices.extend(frame.vertices());
    let corner = |axis: usize, side: f64| {
        let mut corner = [0.0, 0.0, 0.1];
        corner[axis] += side;
        frame.carry(corner, first)
    };
    let points = (0..3).flat_map(|axis| [corner(axis, 0.02), corner(axis, -0.02)]);
    let faces = (0..8u32).map(|side| {
        let [a, b, c] = [side & 1, 2 + (side >> 1 & 1), 4 + (side >> 2 & 1)];
        if side.count_ones() % 2 == 0 {
            [a, b, c]
        } else {
            [a, c, b]
        }
    });
    let ball = Surface {
        points: points.collect(),
        triangles: faces.collect(),
    };
    let touching = Touching {
        description: Description {
            bonds: Vec::new(),
            surfaces: vec![Surface::of_triangles(body), ball],
            friction: vec![vec![0.1, 0.2], vec![0.2, 0.0]],
            voxel: SIDE,
            young: 6e4,
        },
        rigid: vec![Rigid([first, first + 1, first + 2, first + 3])],
        springs: Springs(frame.springs(first, 1e6).to_vec()),
        names: vec!["body".into(), "ball".into()],
        objects: vec![Placed {
            vertices: [first, first + 1, first + 2, first + 3],
            middle: [0.0, 0.0, 0.1],
        }],
    };
    (vertices, first, touching)
}

/// Scene of two voxels of two materials with clamps, loads, a membrane, an attached spring, contact, controls and
/// probes.
fn full() -> Scene {
    let mut grid = Grid::empty([2, 1, 1], [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [2.0 * SIDE, SIDE, SIDE], 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let fabric = MembraneMaterial {
        young: 1e6,
        poisson: 0.3,
        thickness: 1e-4,
        density: 900.0,
    };
    let triangles: Vec<[u32; 3]> = tets.triangles.iter().map(|t| t.map(|v| v as u32)).collect();
    let corners = triangles[0].map(|v| tets.vertices[v as usize]);
    let (vertices, first, touching) = with_ball(tets.vertices, &triangles);
    let mesh = Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: (0..10).map(|t| u8::from(t >= 5)).collect(),
        tet_block: (0..10).map(|t| t / 5).collect(),
        vertices,
        block_fraction: vec![1.0, 0.7],
        block_filling: vec![
            Filling::FULL,
            Filling {
                shift: [0.1, 0.0, 0.0],
                spread: [0.9; 3],
                products: [0.0, 0.02, -0.03],
                surface: CutSurface::of([0.3, -0.2, 0.1], [[0.0, 0.8], [0.1, 0.0], [0.0; 2]]),
            },
        ],
        membranes: vec![Membrane::new(triangles[0], corners, fabric).unwrap()],
        attachments: vec![Attachment::Springs(Springs(vec![Spring {
            vertices: vec![2, 7],
            weights: vec![1.0, -1.0],
            anchor: [0.0; 3],
            length: 0.02,
            stiffness: 4.0,
        }]))],
        point_masses: (first..first + 4).map(|vertex| (vertex, 0.01)).collect(),
        block_axes: vec![],
        coarse: vec![],
    };
    let fiber = Fiber {
        direction: [0.0, 0.6, 0.8],
        modulus: 3e4,
        compression: true,
        free: 0.95,
    };
    let winding = Winding {
        center: [0.1, 0.2, -0.3],
        axis: [0.0, 0.8, 0.6],
        angle: 0.9,
        modulus: 2e4,
        compression: false,
        free: 0.95,
    };
    let ogden = Model::Ogden {
        terms: [(2e4, 1.3), (1e3, 5.0), (0.0, 0.0)],
    };
    let rubber = HyperelasticMaterial::new(ogden, 4e5, 1000.0).unwrap();
    let rubber = rubber
        .with_fibers(vec![fiber])
        .unwrap()
        .with_windings(vec![winding])
        .unwrap()
        .with_prony(vec![(0.2, 0.5)])
        .unwrap();
    let lattice = LatticeMaterial::from_moduli(2e4, 9e4, 1000.0).unwrap();
    let ramp = History::new(vec![0.0, 1.0], vec![0.0, 2.0]).unwrap();
    let motion = Motion {
        displacement: [1e-3, 0.0, 0.0],
        axis: [0.0, 0.0, 1.0],
        angle: 0.1,
        center: [0.0; 3],
        history: ramp.clone(),
        courses: None,
    };
    let pressure = Pressure {
        triangles: triangles.clone(),
        voids: vec![([0, 1, 2, 3], 0.5)],
        pressure: 300.0,
        closed: false,
    };
    let pull = PointForces {
        vertices: vec![3],
        forces: vec![[0.0, 1e-3, 0.0]],
    };
    Scene {
        notes: "{\"name\": \"Würfel\"}".into(),
        settings: Dynamics {
            damping: Damping::Rate(3.0),
            substeps: Some(40),
            ..Dynamics::default()
        },
        materials: vec![lattice.into(), rubber.into()],
        clamps: vec![
            Clamp::fixed(vec![0, 1]),
            Clamp {
                vertices: vec![5],
                axes: [true, false, true],
                motion: Some(motion),
            },
        ],
        loads: vec![
            Load::gravity([0.0, 0.0, -9.81]),
            Load {
                kind: pressure.into(),
                history: ramp,
            },
            Load::constant(pull),
        ],
        floor: Some(Floor { z: -0.01 }),
        voxel_size: SIDE,
        tags: vec![0; triangles.len()],
        triangles,
        cast: Cast {
            topology: 4,
            controls: vec![Control {
                value: 300.0,
                loads: vec![1, 2],
            }],
            probes: vec![Probe {
                name: "tip".into(),
                vertices: vec![3, 4],
                weights: vec![0.25, 0.75],
            }],
        },
        touching: Some(touching),
        positions: Some(mesh.vertices.clone()),
        mesh,
    }
}

/// Reads a scene and makes its player; damaged bytes may only give errors.
fn open(bytes: &[u8]) -> Result<(), SceneError> {
    Scene::read(bytes)?.play(true)?;
    Ok(())
}

#[test]
fn scene_round_trips() {
    let models = [
        Model::NeoHookean { c10: 1e4 },
        Model::MooneyRivlin { c10: 1e4, c01: 2e3 },
        Model::Yeoh {
            c: [1e4, -50.0, 3.0],
        },
        Model::Gent {
            shear: 2e4,
            limit: 30.0,
        },
    ];
    let raw = LatticeMaterial::from_compliances(1e-3, 1e-9, 1000.0).unwrap();
    let mut materials: Vec<Material> = vec![raw.into()];
    materials.extend(models.map(|m| HyperelasticMaterial::new(m, 4e5, 1000.0).unwrap().into()));
    let plain = Scene {
        materials,
        floor: None,
        settings: Dynamics::default(),
        ..full()
    };
    for scene in [full(), plain] {
        assert_eq!(Scene::read(&scene.write()), Ok(scene));
    }
    assert_eq!(open(&full().write()), Ok(()));
}

/// Bytes that an earlier commit wrote: a change of their layout without a new `VERSION` is seen here, and with one
/// `studio/tests/engine/beam.py` has to be run.
#[test]
fn stored_scene_is_read() {
    let stored = include_bytes!("../../../studio/tests/engine/beam.scene");
    let scene = Scene::read(stored).unwrap();
    assert_eq!(scene.mesh.tet_block.len(), 5 * 6 * 2 * 2);
}

#[test]
fn truncated_or_extended_bytes_are_reported() {
    let bytes = full().write();
    for length in 0..bytes.len() {
        assert!(Scene::read(&bytes[..length]).is_err(), "{length} bytes");
    }
    let longer = [&bytes[..], &[0, 0]].concat();
    assert_eq!(Scene::read(&longer), Err(SceneError::TooLong(2)));
    let mut newer = bytes.clone();
    newer[4] = VERSION as u8 + 1;
    assert_eq!(Scene::read(&newer), Err(SceneError::Version(VERSION + 1)));
    // A list with a length beyond the available bytes is refused once they are used up.
    let endless = b"VXSC\0\0\0\0\xff\xff\xff\xff\x0fab";
    let mut endless = endless.to_vec();
    endless[4] = VERSION as u8;
    assert_eq!(Scene::read(&endless), Err(SceneError::CutOff));
    assert_eq!(Scene::read(b"PK\x03\x04"), Err(SceneError::NotAScene));
}

#[test]
fn invalid_values_are_reported() {
    let spoilt = |spoil: fn(&mut Scene)| {
        let mut scene = full();
        spoil(&mut scene);
        Scene::read(&scene.write())
    };
    let what = |place| Err(SceneError::Value(place));
    let found = spoilt(|scene| scene.cast.controls[0].loads.push(3));
    assert_eq!(found, what("a control"));
    let found = spoilt(|scene| scene.cast.probes[0].vertices[0] = 999);
    assert_eq!(found, what("a probe"));
    let found = spoilt(|scene| scene.cast.probes[0].weights.truncate(1));
    assert_eq!(found, what("a probe"));
    let found = spoilt(|scene| scene.settings.tolerance = f64::NAN);
    assert_eq!(found, what("settings of the run"));
    let found = spoilt(|scene| scene.floor = Some(Floor { z: f64::INFINITY }));
    assert_eq!(found, what("height of the floor"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = open(&bytes);
        // Behind a valid header, so that lengths and kinds are decoded.
        let version = voxsoft_scene::VERSION.to_le_bytes();
        let found = open(&[b"VXSC", &version[..], &bytes[..]].concat());
        assert!(!matches!(found, Err(SceneError::Version(_))));
    }

    #[test]
    fn damaged_scenes_never_panic(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = full().write();
        for (at, value) in damage {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        let _ = open(&bytes);
    }
}
