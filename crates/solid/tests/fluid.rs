//! Gas and liquid behind walls: forces from a potential, their stiffness with its low-rank part, and conservation of
//! mass.

use voxsoft_solid::conformance::check_load;
use voxsoft_solid::fluid::{
    Branch, Chamber, Course, End, Fluid, Instant, Line, Medium, Network, Ramp, Source, Tube, Valve,
};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{ExternalForce, Hydrostatic, Pressure, Vertices};

const ATMOSPHERE: f64 = 1e5;
const AIR: Medium = Medium::Gas { constant: 287.0 };
const WATER: Medium = Medium::Liquid {
    density: 1000.0,
    bulk: 2e9,
};
const ROOM: f64 = 300.0;

fn always() -> Course {
    Course(vec![0.0], vec![1.0])
}

/// A wall around a volume of a sixth.
fn corners() -> Vec<Vec3> {
    vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.1, 0.0],
        [0.0, 1.0, 0.1],
        [0.1, 0.0, 1.0],
    ]
}

fn wall(weight: f64) -> Pressure {
    Pressure {
        // Normals point inward, out of the solid around.
        triangles: vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]],
        voids: Vec::new(),
        pressure: weight,
        closed: true,
    }
}

/// The end of the load path, after all histories.
const END: Instant = Instant {
    part: 1.0,
    time: f64::INFINITY,
};

fn volume() -> f64 {
    let on = Vertices {
        rest: &corners(),
        positions: &corners(),
        masses: &[],
    };
    wall(1.0).work(on)
}

fn chamber(medium: Medium, over: f64) -> Chamber {
    let (density, _) = medium.density(0.0, ROOM, ATMOSPHERE);
    let mass = density * volume();
    Chamber {
        medium,
        mass: Ramp(mass, over * mass),
        temperature: Ramp(ROOM, ROOM),
        outside: Ramp(0.0, 0.0),
        history: always(),
        path: None,
        held: None,
    }
}

fn network(chambers: Vec<Chamber>, branches: Vec<Branch>, sources: Vec<Source>) -> Network {
    Network {
        atmosphere: ATMOSPHERE,
        chambers,
        branches,
        sources,
        pumps: Vec::new(),
    }
}

fn line(medium: Medium, tube: bool) -> Line {
    let gas = Valve::Gas {
        conductance: 1e-7,
        critical_ratio: 0.3,
    };
    Line {
        valve: (!tube).then_some(gas),
        tube: tube.then_some(Tube {
            length: 1.0,
            diameter: 0.02,
            viscosity: 2e-5,
        }),
        medium,
        temperature: ROOM,
    }
}

fn moved(by: f64, seed: usize) -> Vec<Vec3> {
    let mut positions = corners();
    for (index, x) in positions.as_flattened_mut().iter_mut().enumerate() {
        *x += by * ((index + 3 * seed) as f64 * 1.7).sin();
    }
    positions
}

/// Adds the product of an element matrix with a field to another one.
fn add_product(vertices: &[u32], matrix: &[f64], field: &[Vec3], product: &mut [Vec3]) {
    let size = 3 * vertices.len();
    for (place, k) in matrix.iter().enumerate() {
        let (row, column) = (place / size, place % size);
        let part = k * field[vertices[column / 3] as usize][column % 3];
        product[vertices[row / 3] as usize][row % 3] += part;
    }
}

fn forces(fluid: &Fluid, positions: &[Vec3]) -> Vec<Vec3> {
    let mut forces = vec![[0.0; 3]; positions.len()];
    fluid.add_forces(positions, END, &mut forces);
    forces
}

fn product(a: &[Vec3], b: &[Vec3]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    pairs.map(|(a, b)| a * b).sum()
}

/// Compares differences of forces and of the potential, over `step`, with stiffness and forces.
fn check_derivatives(fluid: &Fluid, step: f64) {
    let x = moved(0.02, 1);
    let way = moved(1.0, 2);
    let at = |t: f64| -> Vec<Vec3> {
        let pairs = x.iter().zip(&way);
        pairs
            .map(|(x, w)| [0, 1, 2].map(|i| x[i] + t * w[i]))
            .collect()
    };
    let (ahead, behind) = (at(step), at(-step));
    let mut stiffness = vec![[0.0; 3]; x.len()];
    fluid.visit_stiffness(&x, END, &mut |vertices, matrix| {
        add_product(vertices, matrix, &way, &mut stiffness);
    });
    fluid.coupling(&x, END).add_product(&way, &mut stiffness);
    let (high, low) = (forces(fluid, &ahead), forces(fluid, &behind));
    let size = product(&stiffness, &stiffness).sqrt();
    for vertex in 0..x.len() {
        for axis in 0..3 {
            let slope = (high[vertex][axis] - low[vertex][axis]) / (2.0 * step);
            // Differences are accurate to the square of the step over the size of the volume.
            assert!((slope + stiffness[vertex][axis]).abs() < 1e-5 * size);
        }
    }
    if fluid.is_conservative() {
        let potential = |x: &[Vec3]| fluid.potential(x, END);
        let slope = (potential(&ahead) - potential(&behind)) / (2.0 * step);
        let power = product(&forces(fluid, &x), &way);
        assert!((slope + power).abs() < 1e-5 * power.abs());
    }
}

#[test]
fn sealed_contents_have_a_potential_and_the_stiffness_of_their_forces() {
    for (medium, over) in [(AIR, 1.3), (AIR, 0.6), (WATER, 1.00002)] {
        let sealed = network(vec![chamber(medium, over)], vec![], vec![]);
        let mut fluid = Fluid::new(sealed, vec![vec![wall(0.5), wall(0.5)]]).unwrap();
        fluid.start(&corners(), None);
        check_derivatives(&fluid, 1e-5);
    }
}

#[test]
fn flow_within_a_step_has_a_potential_and_the_stiffness_of_its_forces() {
    let source = Source {
        pressure: 5e4,
        history: always(),
    };
    for tube in [false, true] {
        let branch = Branch {
            ends: [End::Source(0), End::Chamber(0)],
            line: line(AIR, tube),
            opening: None,
        };
        let open = network(vec![chamber(AIR, 1.0)], vec![branch], vec![source.clone()]);
        let mut fluid = Fluid::new(open, vec![vec![wall(1.0)]]).unwrap();
        fluid.start(&corners(), Some(0.0));
        fluid.begin(0.1, 10.0, [1.0, 0.0]);
        check_derivatives(&fluid, 1e-5);
    }
}

#[test]
fn exchange_between_chambers_conserves_mass() {
    let branch = Branch {
        ends: [End::Chamber(0), End::Chamber(1)],
        line: line(AIR, false),
        opening: None,
    };
    let chambers = vec![chamber(AIR, 2.0), chamber(AIR, 1.0)];
    let both = network(chambers, vec![branch], vec![]);
    let mut fluid = Fluid::new(both, vec![vec![wall(1.0)], vec![wall(1.0)]]).unwrap();
    assert!(!fluid.is_conservative());
    fluid.start(&corners(), Some(0.0));
    let total = |fluid: &Fluid| -> f64 { fluid.read(&corners(), END).iter().map(|r| r.mass).sum() };
    let before = total(&fluid);
    let steps = 40;
    for step in 1..=steps {
        let weights = if step == 1 {
            [1.0, 0.0]
        } else {
            [4.0 / 3.0, -1.0 / 3.0]
        };
        let rate = if step == 1 { 20.0 } else { 30.0 };
        fluid.begin(0.05 * f64::from(step), rate, weights);
        check_derivatives(&fluid, 1e-5);
        fluid.take_step(&corners());
    }
    let [a, b] = fluid.read(&corners(), END)[..] else {
        panic!("two chambers")
    };
    // Forty roundings.
    assert!((total(&fluid) - before).abs() < 1e-14 * before);
    assert!(a.pressure > b.pressure && b.pressure > 0.2e5);
    assert!(a.flow < 0.0 && (a.flow + b.flow).abs() < 1e-12 * b.flow);
    assert!(!fluid.is_at_rest(1e-3));
}

#[test]
fn closed_valve_stops_flow_at_rest_and_over_time() {
    let branch = |opening: Vec<f64>| Branch {
        ends: [End::Source(0), End::Chamber(0)],
        line: line(AIR, true),
        opening: Some(Course(vec![0.0, 1.0], opening)),
    };
    let source = || Source {
        pressure: 5e4,
        history: always(),
    };
    let filled = |opening: Vec<f64>| {
        let one = network(
            vec![chamber(AIR, 1.0)],
            vec![branch(opening)],
            vec![source()],
        );
        Fluid::new(one, vec![vec![wall(1.0)]]).unwrap()
    };
    // At rest the final opening counts: sealed, or at the pressure of the source.
    for (opening, expected) in [(vec![1.0, 0.0], 0.0), (vec![0.0, 1.0], 5e4)] {
        let mut fluid = filled(opening);
        fluid.start(&corners(), None);
        let pressure = fluid.read(&corners(), END)[0].pressure;
        assert!((pressure - expected).abs() < 1e-6 * ATMOSPHERE);
    }
    let mut fluid = filled(vec![0.5, 0.0]);
    fluid.start(&corners(), Some(0.0));
    let mut masses = Vec::new();
    for step in 1..=4 {
        fluid.begin(0.5 * f64::from(step), 2.0, [1.0, 0.0]);
        check_derivatives(&fluid, 1e-5);
        fluid.take_step(&corners());
        masses.push(fluid.read(&corners(), END)[0].mass);
    }
    assert!(masses[0] > chamber(AIR, 1.0).mass.1);
    assert!(masses[1..].iter().all(|mass| *mass == masses[1]));
    assert!(fluid.is_at_rest(1e-9));
}

#[test]
fn the_weight_of_a_liquid_keeps_the_laws_of_loads() {
    let weight = Hydrostatic {
        triangles: wall(1.0).triangles,
        voids: vec![([0, 1, 2, 3], 0.4)],
        slope: [0.3, -0.2, -2.0],
        origin: [0.4, 0.1, 0.3],
    };
    let on = Vertices {
        rest: &corners(),
        positions: &moved(0.02, 1),
        masses: &[1.0; 4],
    };
    check_load(&weight, on).unwrap();
}

#[test]
fn carried_pressure_converges_to_that_of_the_volume() {
    let sealed = network(vec![chamber(WATER, 1.001)], vec![], vec![]);
    let mut fluid = Fluid::new(sealed, vec![vec![wall(1.0)]]).unwrap();
    fluid.start(&corners(), None);
    let pressure = fluid.read(&corners(), END)[0].pressure;
    let mut carried = vec![0.9 * pressure];
    for _ in 0..6 {
        fluid.carry(Some(carried));
        carried = fluid.carried_on(&corners(), END, &[[0.0; 3]; 4]);
    }
    fluid.carry(None);
    assert!((carried[0] - pressure).abs() < 1e-9 * pressure);
}
