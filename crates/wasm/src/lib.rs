//! The core in a page: a scene opened, run and shown through plain exports.
//!
//! No generated glue: numbers go in as arguments, bytes through linear memory. `studio/src/engine/core.ts` is
//! the typed side. Explicit steps take one constraint at a time with plain arithmetic, so that positions have
//! the same bits as those of the native core's deterministic way. Implicit steps, which bodies with hyperelastic
//! voxels take, factorize with whatever the processor has, and agree to rounding.
//!
//! | export | what it does |
//! |---|---|
//! | `vx_alloc(length) → at`, `vx_free(at, length)` | memory for what is handed over |
//! | `vx_open(at, length) → run` | opens a scene; 0 where it cannot, then `vx_error` tells |
//! | `vx_close(run)` | frees all of it |
//! | `vx_error() → length` | a message in words, its bytes at `vx_answer_at` |
//! | `vx_answer_at() → at` | where the bytes of the last answer begin, until the next call |
//! | `vx_notes(run) → length` | the writer's notes, UTF-8 |
//! | `vx_vertices(run)`, `vx_loads(run)` | how many there are |
//! | `vx_shown(run) → length` | the body vertices of the surface's points, u32 each |
//! | `vx_implicit(run) → yes`, `vx_prefer_step(run, seconds)` | whether steps solve for their end, and how long they should be |
//! | `vx_advance(run, substeps) → length` | takes substeps; the answer is [`STATS`] numbers f64: status (0 moving, 1 at rest, 2 diverged), time, substep, substeps, back-offs, residual, elastic, kinetic, vertex of the breakdown or −1 |
//! | `vx_set_load(run, load, factor) → ok` | a load times its final value; NaN gives its history back |
//! | `vx_grab(run, number, vertex, x, y, z, stiffness) → ok`, `vx_release(run, number) → ok` | hands |
//! | `vx_pull(run, number) → length` | f64×4 of a grab: force in N and stretch in m; 0 bytes if there is none |
//! | `vx_reset(run)` | back to the rest pose |
//! | `vx_positions(run) → length` | f64×3 of every vertex, m |
//! | `vx_seek(run, at, time) → ok` | goes on from positions at `at` |
//! | `vx_topology(run, number) → length` | the topology message of the surface |
//! | `vx_frame(run, topology, frame, field, seq, flags) → length` | a frame message |
//!
//! Lengths are in bytes. A `run` is what `vx_open` gave and `vx_close` has not yet taken.

use std::cell::RefCell;

use voxsoft_frames::{Display, Field, FrameHead};
use voxsoft_scene::{Scene, stepper};
use voxsoft_solid::vector::{norm, sub};
use voxsoft_solid::{LiveStatus, Method, Stepper};

/// The numbers that `vx_advance` answers with.
pub const STATS: usize = 9;

/// An open scene.
pub struct Run {
    live: Box<dyn Stepper>,
    surface: Display,
    notes: String,
}

thread_local! {
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

fn answer(bytes: Vec<u8>) -> usize {
    let length = bytes.len();
    ANSWER.set(bytes);
    length
}

fn answer_numbers(numbers: &[f64]) -> usize {
    answer(numbers.iter().flat_map(|x| x.to_le_bytes()).collect())
}

/// Keeps the message of an error; whether there was none.
fn told<T>(result: Result<T, impl ToString>) -> Option<T> {
    result
        .map_err(|error| answer(error.to_string().into_bytes()))
        .ok()
}

impl Run {
    /// Opens a scene.
    pub fn open(bytes: &[u8]) -> Result<Self, String> {
        let scene = Scene::read(bytes).map_err(|error| error.to_string())?;
        let problem = scene.problem().map_err(|error| error.to_string())?;
        let (triangles, tags) = (&scene.triangles, &scene.tags);
        let surface = Display::surface(problem.body(), triangles, tags, scene.voxel_size);
        let mut settings = scene.settings;
        settings.deterministic = true;
        Ok(Self {
            surface: surface.map_err(|error| error.to_string())?,
            live: stepper(problem, settings),
            notes: scene.notes,
        })
    }
}

/// # Safety
///
/// Every function that takes a run wants one that `vx_open` gave and `vx_close` has not taken.
unsafe fn run<'a>(run: *mut Run) -> &'a mut Run {
    unsafe { &mut *run }
}

/// Memory of `length` bytes, aligned for numbers.
#[unsafe(no_mangle)]
pub extern "C" fn vx_alloc(length: usize) -> *mut u8 {
    let words = vec![0u64; length.div_ceil(8)].into_boxed_slice();
    Box::into_raw(words).cast()
}

/// Gives back what `vx_alloc` gave for the same length.
///
/// # Safety
///
/// `at` came from `vx_alloc(length)` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_free(at: *mut u8, length: usize) {
    let words = std::ptr::slice_from_raw_parts_mut(at.cast::<u64>(), length.div_ceil(8));
    drop(unsafe { Box::from_raw(words) });
}

/// Where the bytes of the last answer begin.
#[unsafe(no_mangle)]
pub extern "C" fn vx_answer_at() -> *const u8 {
    ANSWER.with_borrow(|bytes| bytes.as_ptr())
}

/// Opens the scene in the bytes at `at`; null where it cannot, and the answer is a message.
///
/// # Safety
///
/// `length` bytes can be read at `at`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_open(at: *const u8, length: usize) -> *mut Run {
    let bytes = unsafe { std::slice::from_raw_parts(at, length) };
    let opened = told(Run::open(bytes)).map(Box::new);
    opened.map_or(std::ptr::null_mut(), Box::into_raw)
}

/// Frees a run.
///
/// # Safety
///
/// A run that is open, which is closed then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_close(run: *mut Run) {
    drop(unsafe { Box::from_raw(run) });
}

/// The length of the last answer: after a failure, its message.
#[unsafe(no_mangle)]
pub extern "C" fn vx_error() -> usize {
    ANSWER.with_borrow(Vec::len)
}

/// The writer's notes.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_notes(at: *mut Run) -> usize {
    answer(unsafe { run(at) }.notes.clone().into_bytes())
}

/// The number of vertices.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_vertices(at: *mut Run) -> usize {
    unsafe { run(at) }.live.state().positions.len()
}

/// The number of loads.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_loads(at: *mut Run) -> usize {
    unsafe { run(at) }.live.problem().loads().len()
}

/// The vertices that are shown.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_shown(at: *mut Run) -> usize {
    let vertices = unsafe { run(at) }.surface.vertices();
    answer(vertices.iter().flat_map(|v| v.to_le_bytes()).collect())
}

/// Takes substeps and answers with the numbers of a look.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_advance(at: *mut Run, substeps: u32) -> usize {
    let look = unsafe { run(at) }.live.advance(substeps);
    let numbers: [f64; STATS] = [
        match look.status {
            LiveStatus::Moving => 0.0,
            LiveStatus::AtRest => 1.0,
            LiveStatus::Diverged => 2.0,
        },
        look.time,
        look.substep,
        look.substeps as f64,
        f64::from(look.back_offs),
        look.residual,
        look.elastic,
        look.kinetic,
        look.breakdown.map_or(-1.0, |b| b.vertex as f64),
    ];
    answer_numbers(&numbers)
}

/// Whether a step solves for its end, and may be as long as asked.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_implicit(at: *mut Run) -> bool {
    unsafe { run(at) }.live.method() == Method::Implicit
}

/// Asks for steps of another length in s.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_prefer_step(at: *mut Run, seconds: f64) {
    unsafe { run(at) }.live.prefer_step(seconds);
}

/// Makes a load `factor` times its final value; NaN gives its history back.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_set_load(at: *mut Run, load: usize, factor: f64) -> bool {
    let factor = Some(factor).filter(|factor| !factor.is_nan());
    told(unsafe { run(at) }.live.set_load(load, factor)).is_some()
}

/// Pulls a vertex.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_grab(
    at: *mut Run,
    number: u32,
    vertex: u32,
    x: f64,
    y: f64,
    z: f64,
    stiffness: f64,
) -> bool {
    let grabbed = unsafe { run(at) }
        .live
        .grab(number, vertex, [x, y, z], stiffness);
    told(grabbed).is_some()
}

/// Lets go.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_release(at: *mut Run, number: u32) -> bool {
    unsafe { run(at) }.live.release(number)
}

/// The force and the stretch of a grab.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_pull(at: *mut Run, number: u32) -> usize {
    let live = &unsafe { run(at) }.live;
    let mut grabs = live.grabs().iter();
    let Some((_, grab)) = grabs.find(|(other, _)| *other == number) else {
        return answer(Vec::new());
    };
    let position = live.state().positions[grab.vertex as usize];
    let [x, y, z] = grab.force(position);
    answer_numbers(&[x, y, z, norm(sub(grab.anchor, position))])
}

/// Back to the rest pose.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_reset(at: *mut Run) {
    unsafe { run(at) }.live.reset();
}

/// All positions.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_positions(at: *mut Run) -> usize {
    answer_numbers(unsafe { run(at) }.live.state().positions.as_flattened())
}

/// Goes on from other positions.
///
/// # Safety
///
/// An open run, and at `from` three f64 for each vertex.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_seek(at: *mut Run, from: *const f64, time: f64) -> bool {
    let live = &mut unsafe { run(at) }.live;
    let count = live.state().positions.len();
    let numbers = unsafe { std::slice::from_raw_parts(from, 3 * count) };
    let positions = numbers.as_chunks::<3>().0.to_vec();
    told(live.seek(positions, time)).is_some()
}

/// The topology message of the surface.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_topology(at: *mut Run, number: u32) -> usize {
    let run = unsafe { run(at) };
    answer(run.surface.topology(run.live.problem().body(), number))
}

/// A frame message; 0 bytes for a field that does not exist.
///
/// # Safety
///
/// An open run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vx_frame(
    at: *mut Run,
    topology: u32,
    frame: u32,
    field: u16,
    seq: u32,
    flags: u8,
) -> usize {
    let run = unsafe { run(at) };
    let Some(field) = Field::from_id(field) else {
        return answer(Vec::new());
    };
    let head = FrameHead {
        topology,
        frame,
        seq,
        flags,
    };
    let body = run.live.problem().body();
    answer(run.surface.frame(body, run.live.state(), field, head))
}
