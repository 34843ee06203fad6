//! WebAssembly core of a page: opens and plays a scene through plain exports.
//!
//! There is no generated glue: numbers are passed as arguments, bytes through the core's memory, and commands and
//! events are JSON, as in the studio's server. `studio/src/engine/core.ts` is the typed side. Each instance of the
//! module plays one scene. Explicit steps take one constraint at a time with plain arithmetic, so that positions have
//! the same bits as those of the native core's deterministic mode. Implicit steps, which bodies with hyperelastic
//! voxels take, factorize with any instructions that the processor has, and agree to rounding.
//!
//! | export | action |
//! |---|---|
//! | `vx_input(length) → at` | room for the bytes of the next call |
//! | `vx_answer() → at` | address of the bytes of the last answer, valid until the next call |
//! | `vx_open() → length` | opens the scene in the input; the answer is the error, or empty |
//! | `vx_notes() → length` | the writer's notes, UTF-8 |
//! | `vx_command() → length` | executes the command in the input; events, a list in JSON |
//! | `vx_advance(seconds, budget) → length` | advances time; events |
//! | `vx_stat() → length`, `vx_topology() → length` | present numbers, as an event; topology message of the display |
//! | `vx_frame(field, seq) → length` | message of the displayed frame; empty if there is no such field |
//! | `vx_positions() → length` | f64×3 of every vertex, m |
//!
//! A refused command is answered by one event of the kind `error`, without a `seq`. Times are in s; the page provides
//! its clock as the import `page.now() → s`. Answers are empty until a scene is open.

use std::cell::RefCell;

use serde::Serialize;
use voxsoft_frames::Field;
use voxsoft_player::{Clock, Event, Player, Refusal};
use voxsoft_scene::Scene;

/// Open player, and the buffers of input and answer.
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

/// Clock provided by the page.
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

    /// Outside a page there is no clock.
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

/// Stores the answer of `work`; returns its length.
fn answer(work: impl FnOnce(&mut Desk) -> Vec<u8>) -> usize {
    DESK.with_borrow_mut(|desk| {
        desk.answer = work(desk);
        desk.answer.len()
    })
}

/// Stores the answer of the player, empty before a scene is open; returns its length.
fn answer_of(work: impl FnOnce(&mut Player, &[u8]) -> Vec<u8>) -> usize {
    answer(|desk| match &mut desk.player {
        Some(player) => work(player, &desk.input),
        None => Vec::new(),
    })
}

/// Allocates `length` bytes of input for the next call.
#[unsafe(no_mangle)]
pub extern "C" fn vx_input(length: usize) -> *mut u8 {
    DESK.with_borrow_mut(|desk| {
        desk.input.clear();
        desk.input.resize(length, 0);
        desk.input.as_mut_ptr()
    })
}

/// Address of the bytes of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn vx_answer() -> *const u8 {
    DESK.with_borrow(|desk| desk.answer.as_ptr())
}

/// Opens the scene in the input; the answer is the error, or empty.
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

/// Answers with the writer's notes.
#[unsafe(no_mangle)]
pub extern "C" fn vx_notes() -> usize {
    answer(|desk| desk.notes.clone().into_bytes())
}

/// Executes the command in the input, and answers with the events.
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

/// Advances by `seconds` within a wall-clock `budget` (s), and answers with the events.
#[unsafe(no_mangle)]
pub extern "C" fn vx_advance(seconds: f64, budget: f64) -> usize {
    answer_of(|player, _| reply(Ok(player.advance(seconds, budget, &PageClock))))
}

/// Answers with the present numbers of the player.
#[unsafe(no_mangle)]
pub extern "C" fn vx_stat() -> usize {
    answer_of(|player, _| json(&Event::Stat(player.stat())))
}

/// Answers with the topology message of the display.
#[unsafe(no_mangle)]
pub extern "C" fn vx_topology() -> usize {
    answer_of(|player, _| player.topology())
}

/// Answers with the message of the displayed frame.
#[unsafe(no_mangle)]
pub extern "C" fn vx_frame(field: u16, seq: u32) -> usize {
    answer_of(|player, _| match Field::from_id(field) {
        Some(field) => player.pack_frame(field, seq, None),
        None => Vec::new(),
    })
}

/// Answers with the positions of all vertices in m.
#[unsafe(no_mangle)]
pub extern "C" fn vx_positions() -> usize {
    answer_of(|player, _| {
        let state = player.state();
        let numbers = state.positions.as_flattened().iter();
        numbers.flat_map(|x| x.to_le_bytes()).collect()
    })
}
