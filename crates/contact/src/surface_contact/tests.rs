//! Contact of tetrahedra, alone and with mirror images, checked against the laws of terms.
use super::*;
use voxsoft_solid::conformance::{Law, check_term};
use voxsoft_solid::{AssumedStrain, Contact, Images, MirroredContact, Precision, Term};

/// Two tetrahedra, the tip of the second in a face of the first, by less than the pressure that the exact tangent
/// accepts: beyond it the stiffness leaves out a part of the turning of the pressure.
const PRESSED: [Vec3; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.1, 0.0],
    [0.0, 1.0, 0.05],
    [0.1, 0.1, -1.0],
    [0.31, 0.33, 0.01455],
    [0.6, 0.1, 1.0],
    [0.1, 0.2, 1.1],
    [0.4, 0.7, 0.9],
];
/// Faces of tetrahedra of negative volume.
const FACES: [[u32; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// Tetrahedron and, on the same surface, its image if there is one.
fn tetrahedron(first: u32, image: Option<u32>) -> Surface {
    let of_image = image.map(|first| (first, FACES.map(|[a, b, c]| [a, c, b])));
    let mut surface = Surface {
        points: Vec::new(),
        triangles: Vec::new(),
    };
    for (first, faces) in [(first, FACES)].into_iter().chain(of_image) {
        let base = surface.points.len() as u32;
        let points = (first..first + 4).map(Carried::vertex);
        surface.points.extend(points);
        let faces = faces.map(|face| face.map(|v| v + base));
        surface.triangles.extend(faces);
    }
    surface
}

fn description(surfaces: Vec<Surface>) -> Description {
    Description {
        bonds: Vec::new(),
        surfaces,
        friction: vec![vec![f64::NAN, 0.0], vec![0.0, f64::NAN]],
        voxel: 1.0,
        young: 2.0,
    }
}

fn pressed() -> (SurfaceContact, Vec<Vec3>) {
    let surfaces = vec![tetrahedron(0, None), tetrahedron(4, None)];
    let contact = SurfaceContact::new(description(surfaces), &PRESSED).unwrap();
    (contact, PRESSED.to_vec())
}

/// Second tetrahedron lifted off the first.
fn apart(positions: &[Vec3]) -> Vec<Vec3> {
    let mut apart = positions.to_vec();
    for x in &mut apart[4..] {
        x[2] += 0.1;
    }
    apart
}

#[test]
fn contact_keeps_the_laws_of_terms() {
    let (mut contact, positions) = pressed();
    let pairs = contact.pairs(&positions);
    assert_eq!(pairs.len(), 1);
    assert!(pairs[0].gap < 0.0 && pairs[0].gap > -0.0005, "{pairs:?}");
    let apart = apart(&positions);
    contact.follow(&positions);
    check_term(&contact, &apart, &positions).unwrap();
    contact.correct(&positions, 0.0, Precision::DEFAULT);
    check_term(&contact, &apart, &positions).unwrap();
}

#[test]
fn immovable_bodies_are_not_pushed_apart() {
    let (mut contact, positions) = pressed();
    contact.follow(&positions);
    assert!(
        !contact.correct(&positions, 0.0, Precision::DEFAULT),
        "it is too deep"
    );
    let (contact, _) = pressed();
    let mut contact = contact.with_still(vec![[true; 3]; 8], &PRESSED);
    contact.follow(&positions);
    assert!(contact.pairs(&positions).is_empty());
    assert!(contact.correct(&positions, 0.0, Precision::DEFAULT));
    // A contact that closes later acts as usual.
    let (contact, _) = pressed();
    let mut contact = contact.with_still(vec![[true; 3]; 8], &apart(&PRESSED));
    contact.follow(&positions);
    assert_eq!(contact.pairs(&positions).len(), 1);
    // The normal has a component along each axis, along which the tip may be moved.
    for axis in 0..3 {
        let (contact, _) = pressed();
        let mut still = vec![[true; 3]; 8];
        still[4][axis] = false;
        let mut contact = contact.with_still(still, &PRESSED);
        contact.follow(&positions);
        assert_eq!(contact.pairs(&positions).len(), 1);
    }
}

#[test]
fn mirrored_contact_equals_contact_of_half() {
    // Half of a body beside the plane x = 0, and the whole of both halves.
    let half = PRESSED.map(|[x, y, z]| [x + 0.5, y, z]).to_vec();
    let sides = [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]];
    let images = Images {
        of: (0..8).chain(0..8).collect(),
        signs: sides.iter().flat_map(|side| [*side; 8]).collect(),
    };
    let whole = images.seen(&half);
    let surfaces = vec![tetrahedron(0, Some(8)), tetrahedron(4, Some(12))];
    let contact = SurfaceContact::new(description(surfaces), &whole).unwrap();
    let contact = contact.with_planes([true, false, false], &whole);
    let mut mirrored = MirroredContact::new(images, contact);
    let surfaces = vec![tetrahedron(0, None), tetrahedron(4, None)];
    let mut alone = SurfaceContact::new(description(surfaces), &half).unwrap();
    let apart = apart(&half);
    alone.follow(&half);
    alone.correct(&half, 0.0, Precision::DEFAULT);
    // Mirrored contact counts as anchored by the other half, which here does not touch it: rigid motion without energy
    // is the one law that it breaks, after those of derivatives pass.
    let keeps_derivatives = |mirrored: &MirroredContact<SurfaceContact>| {
        let broken = check_term(mirrored, &apart, &half).unwrap_err();
        assert_eq!(broken.law, Law::RigidMotion);
        assert!(broken.how.contains("anchored"), "{broken:?}");
    };
    mirrored.follow(&half);
    keeps_derivatives(&mirrored);
    mirrored.correct(&half, 0.0, Precision::DEFAULT);
    keeps_derivatives(&mirrored);
    let forces = |contact: &dyn Contact| {
        let mut forces = vec![[0.0; 3]; half.len()];
        contact.add_forces(&half, &mut forces);
        forces
    };
    let largest = forces(&alone)
        .iter()
        .map(|f| f[2].abs())
        .fold(0.0, f64::max);
    assert!(largest > 0.0);
    for (one, other) in forces(&mirrored).iter().zip(forces(&alone)) {
        for axis in 0..3 {
            assert!((one[axis] - other[axis]).abs() < 1e-12 * largest, "{one:?}");
        }
    }
}

/// Tetrahedron with a point in its first face, moved outward by `height`.
fn dented(height: f64) -> SurfaceContact {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let third = 1.0 / 3.0 + height;
    let rest = [&corners[..], &[[third; 3]]].concat();
    let surface = Surface {
        points: (0..5).map(Carried::vertex).collect(),
        triangles: vec![
            [1, 2, 4],
            [2, 3, 4],
            [3, 1, 4],
            [0, 2, 1],
            [0, 3, 2],
            [0, 1, 3],
        ],
    };
    rubbing(surface, &rest)
}

/// Contact of a surface that has friction with itself.
fn rubbing(surface: Surface, rest: &[Vec3]) -> SurfaceContact {
    let alone = Description {
        friction: vec![vec![0.5]],
        ..description(vec![surface])
    };
    SurfaceContact::new(alone, rest).unwrap()
}

#[test]
fn surfaces_that_are_not_convex_may_rub_themselves() {
    assert!(!dented(0.0).rubs_itself && !dented(0.1).rubs_itself);
    assert!(dented(-0.1).rubs_itself);
    assert!(!rubbing(tetrahedron(4, None), &PRESSED).rubs_itself);
    assert!(
        rubbing(tetrahedron(0, Some(4)), &PRESSED).rubs_itself,
        "two components"
    );
    assert!(!pressed().0.rubs_itself, "no friction");
}

#[test]
fn a_predicted_pressure_keeps_a_point_in_contact_that_ends_a_little_out() {
    let (mut contact, positions) = pressed();
    contact.follow(&positions);
    let still = vec![[0.0; 3]; 8];
    let strain = contact.predict(&positions, &still).unwrap();
    let pull = |out: f64, strain: Option<&AssumedStrain>| {
        let mut moved = positions.clone();
        moved[4..].iter_mut().for_each(|x| x[2] += out);
        let mut forces = still.clone();
        match strain {
            Some(strain) => contact.add_predicted_forces(strain, &moved, &mut forces),
            None => contact.add_forces(&moved, &mut forces),
        }
        forces[4][2]
    };
    // In contact both push. A thousandth of a voxel out, nothing pushes, and the predicted pressure pulls back.
    assert!(pull(0.0, None) > 0.0 && pull(0.0, Some(&strain)) == pull(0.0, None));
    assert_eq!(pull(1e-3, None), 0.0);
    assert!(pull(1e-3, Some(&strain)) < 0.0);
    // It does neither far out nor without a pressure.
    assert_eq!(pull(2.0 * predicted::KEPT, Some(&strain)), 0.0);
    let nothing = AssumedStrain::Numbers(vec![0.0; strain.numbers().len()]);
    assert_eq!(pull(1e-3, Some(&nothing)), 0.0);
}
