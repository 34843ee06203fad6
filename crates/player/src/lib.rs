//! Player of a live problem: commands in, events and frames out.
//!
//! A [`Player`] moves a problem while a user changes its loads and grabs it. It executes each [`Command`], moves by
//! [`Player::advance`] as its caller passes time on, records the frames that it shows, and reports by [`Event`]s and by
//! frames ([`voxsoft_frames`]). The studio's server plays with it through the Python binding, and an exported page
//! through WebAssembly: both give the same events and frames.
//!
//! A player does no input or output and has no [`Clock`] of its own.
//!
//! ```
//! use voxsoft_frames::{Display, Field};
//! use voxsoft_player::{Cast, Clock, Command, Control, Event, Mode, Player};
//! use voxsoft_solid::{Body, Clamp, LatticeMaterial, Load, Mesh, Problem};
//! use voxsoft_xpbd::Dynamics;
//!
//! struct Still;
//! impl Clock for Still {
//!     fn now(&self) -> f64 {
//!         0.0
//!     }
//! }
//!
//! # let mesh = Mesh {
//! #     vertices: vec![[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]],
//! #     tets: vec![[0, 1, 2, 3]],
//! #     tet_part: vec![0],
//! #     tet_block: vec![0],
//! #     ..Mesh::default()
//! # };
//! # let rubber = LatticeMaterial::from_moduli(25e3, 100e3, 1070.0)?;
//! # let body = Body::new(&mesh, &[rubber])?;
//! # let surface = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
//! # let surface = Display::surface(&body, &surface, &[0; 4], 0.0)?;
//! # let load = Load::gravity([0.0, 0.0, -9.81]);
//! # let problem = Problem::new(body, vec![Clamp::fixed(vec![0, 1, 2])], vec![load], None)?;
//! let gravity = Control { value: 9.81, loads: vec![0] };
//! let cast = Cast { topology: 1, controls: vec![gravity], probes: vec![] };
//! let mut player = Player::new(problem, Dynamics::default(), surface, cast);
//! player.command(Command::Play)?;
//! while player.moving() {
//!     for event in player.advance(1.0 / 60.0, f64::INFINITY, &Still) {
//!         if let Event::Stat(stat) = event {
//!             println!("{:.3} s {}", stat.time, stat.sentence);
//!         }
//!     }
//!     let frame = player.pack_frame(Field::Displacement, 0, None);
//!     assert_eq!(frame.len(), voxsoft_frames::HEADER + 4 * 8);
//! }
//! assert_eq!(player.mode(), Mode::AtRest);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod clock;
mod command;
mod control;
mod event;
mod motion;
mod objects;
mod pace;
mod player;
mod plots;
mod recording;
mod sentences;
mod stepper;
mod touching;
mod view;

pub use clock::Clock;
pub use command::{Command, STIFFNESS};
pub use control::Control;
pub use event::{
    Event, GrabState, Mode, Moment, MomentOf, Picked, Plot, Pose, Refusal, Shown, Stat,
    SurfaceContact, Value,
};
pub use motion::{FRAME_TIME, Rest};
pub use pace::PACES;
pub use player::{Cast, Player};
pub use plots::{COLUMNS, Probe};
pub use stepper::{converging, stepper};
pub use touching::{Placed, Touching};
