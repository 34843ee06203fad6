//! The core in a page: a scene opened and played through plain exports.
//!
//! No generated glue: numbers go in as arguments, bytes through the core's memory, and commands and events are
//! JSON, as the studio's server has them. `studio/src/engine/core.ts` is the typed side. Each instance of the
//! module plays one scene. Explicit steps take one constraint at a time with plain arithmetic, so that positions
//! have the same bits as those of the native core's deterministic way. Implicit steps, which bodies with
//! hyperelastic voxels take, factorize with whatever the processor has, and agree to rounding.
//!
//! | export | what it does |
//! |---|---|
//! | `vx_input(length) → at` | room for the bytes of the next call |
//! | `vx_answer() → at` | where the bytes of the last answer begin, until the next call |
//! | `vx_open() → length` | opens the scene in the input; the answer is why it cannot, or empty |
//! | `vx_notes() → length` | the writer's notes, UTF-8 |
//! | `vx_command() → length` | does the command in the input; events, a list in JSON |
//! | `vx_advance(seconds, budget) → length` | lets time go on; events |
//! | `vx_stat() → length`, `vx_topology() → length` | all numbers of the moment, as an event; what is drawn |
//! | `vx_frame(field, seq) → length` | the frame that is looked at; nothing if there is no such field |
//! | `vx_positions() → length` | f64×3 of every vertex, m |
//!
//! A command that is refused is answered by one event of the kind `error`, without a `seq`. Times are in s; the
//! page lends its clock as the import `page.now() → s`. Until a scene is open, answers are empty.

use std::cell::RefCell;

use serde::Serialize;
use voxsoft_frames::Field;
use voxsoft_player::{Clock, Event, Player, Refusal};
use voxsoft_scene::Scene;

/// What is open, and bytes on their way in and out.
#[derive(Default)]
struct Desk {
    input: Vec<u8>,
    answer: Vec<u8>,
    notes: String,
    player: Option<Player>,
}

thread_local! {
    static DESK: RefCell<Desk> = RefCell::default();
}

/// The clock that the page lends.
struct PageClock;

#[cfg(target_arch = "wasm32")]
mod page {
    #[link(wasm_import_module = "page")]
    unsafe extern "C" {
        pub safe fn now() -> f64;
    }
}

impl Clock for PageClock {
    #[cfg(target_arch = "wasm32")]
    fn now(&self) -> f64 {
        page::now()
    }

    /// Outside a page there is none.
    #[cfg(not(target_arch = "wasm32"))]
    fn now(&self) -> f64 {
        0.0
    }
}

#[derive(Serialize)]
struct Refused {
    t: &'static str,
    #[serde(flatten)]
    refusal: Refusal,
}

fn json(value: &impl Serialize) -> Vec<u8> {
    serde_json::to_vec(value).expect("events have names and numbers alone")
}

fn reply(events: Result<Vec<Event>, Refusal>) -> Vec<u8> {
    let t = "error";
    match events {
        Ok(events) => json(&events),
        Err(refusal) => json(&[Refused { t, refusal }]),
    }
}

/// Answers with the bytes that come of the input; gives their length.
fn answer(work: impl FnOnce(&mut Desk) -> Vec<u8>) -> usize {
    DESK.with_borrow_mut(|desk| {
        desk.answer = work(desk);
        desk.answer.len()
    })
}

/// The same of the player, once there is one.
fn answer_of(work: impl FnOnce(&mut Player, &[u8]) -> Vec<u8>) -> usize {
    answer(|desk| match &mut desk.player {
        Some(player) => work(player, &desk.input),
        None => Vec::new(),
    })
}

/// Room for `length` bytes, which the next call reads.
#[unsafe(no_mangle)]
pub extern "C" fn vx_input(length: usize) -> *mut u8 {
    DESK.with_borrow_mut(|desk| {
        desk.input.clear();
        desk.input.resize(length, 0);
        desk.input.as_mut_ptr()
    })
}

/// Where the bytes of the last answer begin.
#[unsafe(no_mangle)]
pub extern "C" fn vx_answer() -> *const u8 {
    DESK.with_borrow(|desk| desk.answer.as_ptr())
}

/// Opens the scene in the input; the answer is why it cannot, or empty.
#[unsafe(no_mangle)]
pub extern "C" fn vx_open() -> usize {
    answer(|desk| {
        let scene = match Scene::read(&desk.input) {
            Ok(scene) => scene,
            Err(error) => return error.to_string().into_bytes(),
        };
        match scene.play(true) {
            Ok(player) => (desk.player, desk.notes) = (Some(player), scene.notes),
            Err(error) => return error.to_string().into_bytes(),
        }
        Vec::new()
    })
}

/// The writer's notes.
#[unsafe(no_mangle)]
pub extern "C" fn vx_notes() -> usize {
    answer(|desk| desk.notes.clone().into_bytes())
}

/// Does the command in the input, and answers with the events.
#[unsafe(no_mangle)]
pub extern "C" fn vx_command() -> usize {
    answer_of(|player, input| {
        let refused = |error: serde_json::Error| Refusal {
            place: "command",
            what: error.to_string(),
            hint: "",
        };
        let command = serde_json::from_slice(input).map_err(refused);
        reply(command.and_then(|command| player.command(command)))
    })
}

/// Lets time go on by some seconds, within a budget of the clock, and answers with the events.
#[unsafe(no_mangle)]
pub extern "C" fn vx_advance(seconds: f64, budget: f64) -> usize {
    answer_of(|player, _| reply(Ok(player.advance(seconds, budget, &PageClock))))
}

/// All numbers of the moment.
#[unsafe(no_mangle)]
pub extern "C" fn vx_stat() -> usize {
    answer_of(|player, _| json(&Event::Stat(player.stat())))
}

/// What is drawn.
#[unsafe(no_mangle)]
pub extern "C" fn vx_topology() -> usize {
    answer_of(|player, _| player.topology())
}

/// The frame that is looked at.
#[unsafe(no_mangle)]
pub extern "C" fn vx_frame(field: u16, seq: u32) -> usize {
    answer_of(|player, _| match Field::from_id(field) {
        Some(field) => player.pack_frame(field, seq, None),
        None => Vec::new(),
    })
}

/// Where the vertices are.
#[unsafe(no_mangle)]
pub extern "C" fn vx_positions() -> usize {
    answer_of(|player, _| {
        let state = player.state();
        let numbers = state.positions.as_flattened().iter();
        numbers.flat_map(|x| x.to_le_bytes()).collect()
    })
}
