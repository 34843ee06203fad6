//! Inputs that are commanded act as the same courses given from the start, bit for bit.

use voxsoft_solid::fluid::{Chamber, Course, FluidInput, Medium, Network, Ramp, Source};
use voxsoft_solid::{
    Body, Clamp, Eigenstrain, EigenstrainFactor, Fluid, History, HyperelasticMaterial, Input, Load,
    Mesh, Model, Motion, Pressure, Problem, ProblemError, Share,
};
use voxsoft_voxel::{Grid, tet_mesh};

fn course() -> History {
    History::new(vec![0.0, 2.0], vec![0.5, 1.5]).unwrap()
}

fn cube() -> Mesh {
    let mut grid = Grid::empty([1, 1, 1], [0.0; 3], 1.0, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [1.0; 3], 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let count = tets.tets.len();
    Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    }
}

/// A cube that grows, with a clamp, a load and a gas, all with the history given.
fn problem(history: &History) -> Problem {
    let factor = EigenstrainFactor {
        history: history.clone(),
        power: 1.0,
        share: Share::Whole,
        number: 3,
    };
    let eigenstrain = Eigenstrain::new(vec![factor]).unwrap();
    let material = HyperelasticMaterial::new(Model::NeoHookean { c10: 0.5 }, 20.0, 1.0).unwrap();
    let grown = material.with_eigenstrain(eigenstrain, Eigenstrain::none());
    let body = Body::new(&cube(), &[grown]).unwrap();
    let mut clamp = Clamp::fixed(vec![0, 7]);
    clamp.motion = Some(Motion {
        displacement: [0.0, 0.0, 1.0],
        angle: 1.0,
        history: history.clone(),
        ..Motion::commanded()
    });
    let load = Load {
        history: history.clone(),
        ..Load::gravity([0.0, 0.0, -1.0])
    };
    let own = Course(history.times().to_vec(), history.factors().to_vec());
    let still = Course(vec![0.0], vec![1.0]);
    let chamber = |held| Chamber {
        medium: Medium::Gas { constant: 287.0 },
        mass: Ramp(0.0, 1.0),
        temperature: Ramp(293.0, 293.0),
        outside: Ramp(1.0, 1.0),
        history: if held { still.clone() } else { own.clone() },
        path: None,
        held: held.then_some(0),
    };
    let network = Network {
        atmosphere: 1e5,
        chambers: vec![chamber(false), chamber(true)],
        branches: vec![],
        sources: vec![Source {
            pressure: 1.0,
            history: own,
        }],
        pumps: vec![],
    };
    let wall = || {
        vec![Pressure {
            triangles: vec![[0, 1, 2]],
            voids: vec![],
            pressure: 1.0,
            closed: true,
        }]
    };
    let fluid = Fluid::new(network, vec![wall(), wall()]).unwrap();
    let made = Problem::new(body, vec![clamp], vec![load], None).unwrap();
    made.with_fluid(fluid).unwrap()
}

/// Bits of positions of clamped vertices, forces, energy and pressures at a time.
fn seen(problem: &mut Problem, time: f64) -> Vec<u64> {
    problem.begin(time);
    let mut positions = problem.body().rest().to_vec();
    problem.place_clamps(time, 1.0, &mut positions);
    problem.start_fluid(&positions, Some(time));
    let mut forces = vec![[0.0; 3]; positions.len()];
    problem.add_loads(&positions, time, &mut forces);
    let energy = voxsoft_solid::elastic::stored_energy(problem.body(), &positions);
    let pressures = problem.fluid().unwrap().last_pressures();
    let numbers = positions.iter().flatten().chain(forces.iter().flatten());
    let all = numbers.chain(std::iter::once(&energy)).chain(&pressures);
    all.map(|x| x.to_bits()).collect()
}

fn inputs() -> [Input; 6] {
    [
        Input::Load(0),
        Input::Clamp(0, 2),
        Input::Clamp(0, 3),
        Input::Growth(3),
        Input::Fluid(FluidInput::Mass(0)),
        Input::Fluid(FluidInput::Source(0)),
    ]
}

#[test]
fn commanded_courses_are_those_of_the_problem() {
    let mut given = problem(&course());
    let mut commanded = problem(&History::always(1.0));
    for input in inputs() {
        commanded.command(input, course()).unwrap();
    }
    for time in [0.0, 0.25, 1.0, 2.0, 3.0] {
        assert_eq!(seen(&mut given, time), seen(&mut commanded, time), "{time}");
    }
}

#[test]
fn each_input_changes_what_it_drives() {
    for input in inputs() {
        let mut problem = problem(&History::always(1.0));
        let before = seen(&mut problem, 1.0);
        problem.command(input, History::always(0.9)).unwrap();
        assert_ne!(before, seen(&mut problem, 1.0), "{input:?}");
    }
}

#[test]
fn inputs_that_are_not_there_are_refused() {
    let mut problem = problem(&course());
    for input in [
        Input::Load(1),
        Input::Clamp(1, 0),
        Input::Clamp(0, 4),
        Input::Growth(0),
        Input::Fluid(FluidInput::Mass(2)),
        Input::Fluid(FluidInput::Opening(0)),
        Input::Fluid(FluidInput::Pump(0)),
    ] {
        let refused = problem.command(input, course());
        assert!(
            matches!(refused, Err(ProblemError::Index { .. })),
            "{input:?}"
        );
    }
    let refused = problem.command(Input::Growth(3), History::always(0.0));
    assert!(matches!(refused, Err(ProblemError::NotPositive { .. })));
}
