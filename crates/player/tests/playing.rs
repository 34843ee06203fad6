//! Tests of a player on a beam that sags under its weight, played as in a page.

use std::cell::Cell;
use std::sync::Mutex;

use voxsoft_frames::{Display, Field};
use voxsoft_player::{Cast, Clock, Command, Control, Event, FRAME_TIME, Mode, Player, Probe, Stat};
use voxsoft_solid::{Body, Clamp, LatticeMaterial, Load, Mesh, Problem};
use voxsoft_voxel::{Grid, tet_mesh};
use voxsoft_xpbd::{Damping, Dynamics};

const SIDE: f64 = 5e-3;

/// Clock that advances by a tick at each reading.
#[derive(Default)]
struct Ticking {
    now: Mutex<Cell<f64>>,
    tick: f64,
}

impl Clock for Ticking {
    fn now(&self) -> f64 {
        let now = self.now.lock().unwrap();
        now.set(now.get() + self.tick);
        now.get()
    }
}

/// Four voxels in a row, held at x = 0.
fn beam(damping: Damping) -> Player {
    let mut grid = Grid::empty([4, 1, 1], [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [4.0 * SIDE, SIDE, SIDE], 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let count = tets.tets.len();
    let triangles: Vec<[u32; 3]> = tets.triangles.iter().map(|t| t.map(|v| v as u32)).collect();
    let held = |v: &u32| tets.vertices[*v as usize][0] == 0.0;
    let clamp = Clamp::fixed((0..tets.vertices.len() as u32).filter(held).collect());
    let mesh = Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    };
    let material = LatticeMaterial::from_moduli(6e4, 4e5, 1070.0).unwrap();
    let body = Body::new(&mesh, &[material]).unwrap();
    let surface = Display::surface(&body, &triangles, &vec![0; triangles.len()], SIDE).unwrap();
    let gravity = Load::gravity([0.0, 0.0, -9.81]);
    let problem = Problem::new(body, vec![clamp], vec![gravity], None).unwrap();
    let settings = Dynamics {
        damping,
        ..Dynamics::default()
    };
    let cast = Cast {
        topology: 7,
        controls: vec![Control {
            value: 9.81,
            loads: vec![0],
        }],
        probes: vec![Probe::at("tip".into(), mesh.vertices.len() as u32 - 1)],
    };
    Player::new(problem, settings, surface, cast)
}

/// Advances until time stops; returns all events.
fn settle(player: &mut Player, clock: &Ticking) -> Vec<Event> {
    let mut reported = Vec::new();
    for _ in 0..5000 {
        if !player.moving() {
            return reported;
        }
        reported.extend(player.advance(FRAME_TIME, f64::INFINITY, clock));
    }
    panic!("it never rests: {:?}", player.stat());
}

fn last<'a>(reported: &'a [Event]) -> &'a Stat {
    let stat = |event: &'a Event| match event {
        Event::Stat(stat) => Some(stat),
        _ => None,
    };
    reported.iter().rev().find_map(stat).unwrap()
}

#[test]
fn beam_sags_to_rest_in_slow_motion_and_reports_all_rows() {
    let (mut player, clock) = (beam(Damping::Critical), Ticking::default());
    let reported = player.command(Command::Play).unwrap();
    let stat = last(&reported);
    assert_eq!((stat.state, stat.substeps), (Mode::Playing, 0));
    assert!(stat.pace < 1.0 && stat.sentence.contains("as it comes to rest within"));
    let reported = settle(&mut player, &clock);
    let stat = last(&reported);
    assert_eq!(stat.state, Mode::AtRest);
    assert!(stat.sentence.starts_with("At rest after "));
    let rows = reported.iter().filter_map(|event| match event {
        Event::Plot(plot) => Some(plot.rows.len()),
        _ => None,
    });
    assert_eq!(rows.sum::<usize>(), stat.frames_stored);
    let sag = player.whole_plot().rows.last().unwrap()[4].unwrap();
    assert!(sag > 1e-6, "the tip has moved by {sag} m");
}

#[test]
fn load_wakes_body_at_rest_only_if_playing() {
    let (mut player, clock) = (beam(Damping::Critical), Ticking::default());
    let change = |factor| Command::Load {
        index: 0,
        value: None,
        factor: Some(factor),
    };
    player.command(change(0.5)).unwrap();
    assert_eq!(player.mode(), Mode::Paused);
    player.command(Command::Play).unwrap();
    settle(&mut player, &clock);
    let reported = player.command(change(2.0)).unwrap();
    assert_eq!(last(&reported).state, Mode::Playing);
    assert_eq!(
        (last(&reported).pace, &*last(&reported).loads),
        (1.0, &[19.62][..])
    );
    settle(&mut player, &clock);
    player.command(Command::Pause).unwrap();
    player.command(change(1.0)).unwrap();
    assert_eq!(player.mode(), Mode::Paused);
    let reported = player.command(Command::Reset).unwrap();
    let stat = last(&reported);
    assert_eq!((stat.time, stat.frame, stat.frames_stored), (0.0, 0, 0));
    assert_eq!(stat.loads, [9.81]);
}

#[test]
fn grab_pulls_with_its_spring_force_and_releases() {
    let (mut player, clock) = (beam(Damping::Critical), Ticking::default());
    player.command(Command::Play).unwrap();
    let grab = |target| Command::Grab {
        id: 3,
        vertex: 1,
        object: None,
        target,
        stiffness: 40.0,
    };
    assert!(player.command(grab([0.0, f64::NAN, 0.0])).is_err());
    player.command(grab([0.0, 0.0, 0.02])).unwrap();
    settle(&mut player, &clock);
    let [pull] = &*player.grabs() else {
        panic!("one spring");
    };
    let force = pull.force.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!((force - 40.0 * pull.stretch).abs() < 1e-12);
    assert_eq!((pull.id, pull.vertex), (3, 1));
    player.command(Command::Release { id: 3 }).unwrap();
    assert!(player.grabs().is_empty() && player.moving());
}

#[test]
fn seek_shows_recorded_frame_and_keeps_present() {
    let (mut player, clock) = (beam(Damping::Critical), Ticking::default());
    let seek = |frame, time| Command::Seek { frame, time };
    assert!(player.command(seek(1, None)).is_err());
    player.command(Command::Play).unwrap();
    settle(&mut player, &clock);
    let present = player.state().into_owned();
    let reported = player.command(seek(2, None)).unwrap();
    let stat = last(&reported);
    assert_eq!((stat.state, stat.frame), (Mode::Past, 2));
    let time = stat.time;
    assert!(player.state().positions != present.positions);
    let of = |bytes: Vec<u8>| u32::from_le_bytes(bytes[12..16].try_into().unwrap());
    assert_eq!(of(player.pack_frame(Field::Z, 0, None)), 2);
    let reported = player.command(seek(0, Some(time + 1e-9))).unwrap();
    assert_eq!(last(&reported).frame, 2);
    player.command(Command::Live).unwrap();
    assert_eq!(player.state().into_owned(), present);
}

#[test]
fn single_step_takes_a_step_and_slow_motion_waits() {
    let (mut player, clock) = (beam(Damping::Critical), Ticking::default());
    let pace = |factor| Command::Pace { factor };
    assert!(player.command(pace(Some(0.0))).is_err());
    player.command(pace(Some(1e-4))).unwrap();
    player.command(Command::Step { n: 2 }).unwrap();
    settle(&mut player, &clock);
    assert_eq!((player.stat().substeps, player.stat().frame), (2, 2));
    player.command(Command::Play).unwrap();
    player.advance(FRAME_TIME, f64::INFINITY, &clock);
    assert_eq!(player.stat().frame, 2, "no step is due yet");
}

#[test]
fn clock_budget_cuts_a_frame_short() {
    let clock = Ticking {
        tick: 0.001,
        ..Ticking::default()
    };
    let mut player = beam(Damping::Rate(1.0));
    player.command(Command::Pace { factor: Some(1.0) }).unwrap();
    player.command(Command::Play).unwrap();
    player.advance(10.0, 0.0095, &clock);
    let stat = player.stat();
    assert_eq!((stat.substeps, stat.frame), (10, 1));
    assert!((stat.step_ms - 1.1).abs() < 1e-9);
}

#[test]
fn command_and_event_names_match_protocol() {
    let read = |text| serde_json::from_str::<Command>(text);
    let n = read(r#"{"t": "step", "seq": 4}"#).unwrap();
    assert_eq!(n, Command::Step { n: 1 });
    assert!(read(r#"{"t": "dance"}"#).is_err());
    let player = beam(Damping::Critical);
    let reported = serde_json::to_value(Event::Stat(player.stat())).unwrap();
    assert_eq!(
        (&reported["t"], &reported["state"]),
        (&"stat".into(), &"paused".into())
    );
    assert!(reported["residual"].is_null());
}
