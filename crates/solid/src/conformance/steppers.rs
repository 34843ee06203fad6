use super::law::{Law, Outcome, Subject};
use super::numbers::{bits, distance, on_threads};
use crate::balance::balance_of_forces;
use crate::vector::{add, norm, sub};
use crate::{Ask, LiveStatus, Method, Stepper, elastic};

/// Factor on the tolerance for a residual from another order of summation.
const OTHER_SUM: f64 = 2.0;
/// Number of steps after which a body counts as never at rest.
const MOST_STEPS: u32 = 1_000_000;
/// Number of steps after which bits are compared.
const STEPS: u32 = 150;

/// Checks the laws of a stepper on a problem whose clamps stand still and whose loads hold it away from its rest pose.
/// `make` gives a fresh one; at rest, the residual is below `tolerance`.
pub fn check_stepper(make: &(dyn Fn() -> Box<dyn Stepper> + Sync), tolerance: f64) -> Outcome {
    let stepper = make();
    let check = Check {
        subject: Subject(match stepper.method() {
            Method::Explicit => "explicit steps",
            Method::Implicit => "implicit steps",
        }),
        make,
        tolerance,
    };
    check.repetition()?;
    check.threads()?;
    check.rest_and_back()?;
    check.grabs()?;
    check.seek()?;
    check.cancellation()
}

struct Check<'a> {
    subject: Subject,
    make: &'a (dyn Fn() -> Box<dyn Stepper> + Sync),
    tolerance: f64,
}

impl Check<'_> {
    fn state_bits(stepper: &dyn Stepper) -> (Vec<u64>, Vec<u64>, u64) {
        let state = stepper.state();
        (
            bits(&state.positions),
            bits(&state.velocities),
            state.time.to_bits(),
        )
    }

    fn repetition(&self) -> Outcome {
        let law = Law::Repetition;
        let mut stepper = (self.make)();
        stepper.advance(STEPS);
        let first = Self::state_bits(&*stepper);
        stepper.reset();
        let origin = stepper.state().time == 0.0;
        self.subject.holds(law, "a reset leaves the time", origin)?;
        stepper.advance(STEPS);
        let again = Self::state_bits(&*stepper) == first;
        self.subject.holds(law, "other bits after a reset", again)?;
        stepper.reset();
        stepper.advance(STEPS / 50);
        let (state, memory) = (stepper.state().clone(), stepper.memory());
        let bytes = memory.bytes();
        let read = |bytes| stepper.problem().read_memory(bytes);
        let (stored, half) = (read(&bytes), read(&bytes[..bytes.len() / 2]));
        let same = stored.as_ref() == Some(&memory) && half.is_none();
        self.subject
            .holds(law, "another memory from its bytes, or one from half", same)?;
        let stored = stored.unwrap_or_else(|| memory.clone());
        let mut both = [stepper, (self.make)()];
        let mut seen = Vec::new();
        for (index, memory) in [(0, &memory), (1, &memory), (1, &stored)] {
            let stepper = &mut *both[index];
            if let Err(error) = stepper.resume(state.clone(), memory) {
                return self.subject.broken(law, error.to_string());
            }
            stepper.advance(STEPS / 10);
            seen.push(Self::state_bits(stepper));
        }
        let same = seen.iter().all(|bits| *bits == seen[0]);
        self.subject
            .holds(law, "other bits from one state and memory", same)
    }

    fn threads(&self) -> Outcome {
        let found = on_threads(|| {
            let mut stepper = (self.make)();
            stepper.advance(STEPS);
            Self::state_bits(&*stepper)
        });
        let same = found.windows(2).all(|pair| pair[0] == pair[1]);
        self.subject
            .holds(Law::Threads, "other bits on other threads", same)
    }

    /// Settles under all loads, then without any, which must restore the rest pose.
    fn rest_and_back(&self) -> Outcome {
        let mut stepper = (self.make)();
        self.settle(&mut *stepper)?;
        let loaded = stepper.state().positions.clone();
        let rest = stepper.problem().body().rest().to_vec();
        for load in 0..stepper.problem().loads().len() {
            if let Err(error) = stepper.set_load(load, Some(0.0)) {
                return self.subject.broken(Law::Changes, error.to_string());
            }
        }
        self.settle(&mut *stepper)?;
        // The rest pose is reached to the tolerance, and slender bodies turn a residual into some ten times as much
        // displacement.
        let left = distance(&stepper.state().positions, &rest);
        let allowed = 100.0 * self.tolerance * distance(&loaded, &rest);
        let what = "the way to the rest pose without loads";
        self.subject.at_most(Law::Changes, what, left, allowed)?;
        let count = stepper.problem().loads().len();
        let refused = stepper.set_load(count, Some(1.0)).is_err();
        self.subject
            .holds(Law::Changes, "a load that does not exist is set", refused)
    }

    fn settle(&self, stepper: &mut dyn Stepper) -> Outcome {
        let law = Law::Equilibrium;
        let look = stepper.advance(MOST_STEPS);
        let what = format!("it is {:?} after {} steps", look.status, look.substeps);
        self.subject
            .holds(law, &what, look.status == LiveStatus::AtRest)?;
        let (problem, positions) = (stepper.problem(), &stepper.state().positions);
        let mut external = vec![[0.0; 3]; positions.len()];
        problem.add_loads(positions, look.time, &mut external);
        for (_, grab) in stepper.grabs() {
            let vertex = grab.vertex as usize;
            external[vertex] = add(external[vertex], grab.force(positions[vertex]));
        }
        // Without any force only the kinetic energy shows rest.
        if external.iter().flatten().all(|force| *force == 0.0) {
            return Ok(());
        }
        let mut net = external.clone();
        elastic::add_forces(problem.body(), positions, &mut net);
        let found = balance_of_forces(problem, positions, &external, net).relative_residual();
        let allowed = OTHER_SUM * self.tolerance;
        self.subject.at_most(law, "the residual", found, allowed)
    }

    fn grabs(&self) -> Outcome {
        let (law, subject) = (Law::Changes, self.subject);
        let mut stepper = (self.make)();
        self.settle(&mut *stepper)?;
        let held = stepper.problem().held();
        let Some(vertex) = held.iter().rposition(|axes| *axes == [false; 3]) else {
            return Ok(());
        };
        let from = stepper.state().positions[vertex];
        let size = stepper.problem().body().size();
        let stiffness = stepper.problem().body().unit_strain_force() / size;
        let target = add(from, [0.0, 0.0, 0.05 * size]);
        let vertex = vertex as u32;
        let refused = stepper.grab(3, vertex, target, 0.0).is_err();
        subject.holds(law, "a spring without stiffness is taken", refused)?;
        if let Err(error) = stepper.grab(3, vertex, target, stiffness) {
            return subject.broken(law, error.to_string());
        }
        self.settle(&mut *stepper)?;
        let to = stepper.state().positions[vertex as usize];
        let nearer = norm(sub(target, to)) < norm(sub(target, from));
        subject.holds(law, "a grabbed vertex stays where it was", nearer)?;
        subject.holds(law, "a grab is not let go", stepper.release(3))?;
        subject.holds(law, "a grab is let go twice", !stepper.release(3))?;
        self.settle(&mut *stepper)?;
        let back = norm(sub(stepper.state().positions[vertex as usize], from));
        let allowed = 0.1 * norm(sub(to, from));
        subject.at_most(law, "the way back after a grab", back, allowed)
    }

    fn seek(&self) -> Outcome {
        let (law, subject) = (Law::Changes, self.subject);
        let mut stepper = (self.make)();
        stepper.advance(STEPS);
        let rest = stepper.problem().body().rest().to_vec();
        if let Err(error) = stepper.seek(rest.clone(), 0.25) {
            return subject.broken(law, error.to_string());
        }
        let state = stepper.state();
        let there = bits(&state.positions) == bits(&rest) && state.time == 0.25;
        subject.holds(law, "a seek leads elsewhere", there)?;
        let still = state.velocities.iter().flatten().all(|v| *v == 0.0);
        subject.holds(law, "a seek keeps velocities", still)?;
        let refused = stepper.seek(rest[1..].to_vec(), 0.0).is_err();
        subject.holds(law, "positions of too few vertices are taken", refused)
    }

    fn cancellation(&self) -> Outcome {
        let (law, subject) = (Law::Cancellation, self.subject);
        let mut stepper = (self.make)();
        let look = stepper.advance_while(STEPS, &mut |ask| ask == Ask::Within);
        subject.holds(law, "steps go on after a no", look.substeps <= 1)?;
        let mut stepper = (self.make)();
        let look = stepper.advance_while(STEPS, &mut |_| false);
        let one_step = look.time <= stepper.step() * (1.0 + 1e-12);
        subject.holds(law, "time goes on after a no", one_step)
    }
}
