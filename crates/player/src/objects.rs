//! Grabs of free rigid objects: four springs, one to each vertex, hold both position and orientation.

use voxsoft_solid::Rigid;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};

use crate::event::{GrabState, Refusal};
use crate::player::{Held, Player};

/// First number of the stepper's grabs that hold objects, four for each.
const FIRST: u32 = 1 << 30;

fn number(id: u32, corner: usize) -> u32 {
    FIRST
        .wrapping_add(id.wrapping_mul(4))
        .wrapping_add(corner as u32)
}

impl Player {
    pub(crate) fn on_hold_object(
        &mut self,
        id: u32,
        object: usize,
        target: Vec3,
        stiffness: f64,
    ) -> Result<(), Refusal> {
        let vertices = self.free_vertices(object)?;
        if target.iter().any(|x| !x.is_finite()) {
            return Err(Refusal::new("grab", "the target is not a point", ""));
        }
        self.on_live();
        let positions = &self.stepper.state().positions;
        let middle = self.middle_of(object, positions);
        let from = match self.held.get(&id).and_then(|held| held.object) {
            Some((before, from)) if before == object => from,
            _ => vertices.map(|vertex| sub(positions[vertex as usize], middle)),
        };
        for (corner, vertex) in vertices.into_iter().enumerate() {
            let place = add(target, from[corner]);
            let grabbed = self
                .stepper
                .grab(number(id, corner), vertex, place, stiffness / 4.0);
            grabbed.map_err(|error| Refusal::new("grab", error, ""))?;
        }
        let held = Held {
            vertex: 0,
            object: Some((object, from)),
            target,
            stiffness,
        };
        self.held.insert(id, held);
        self.wake();
        Ok(())
    }

    pub(crate) fn let_go_of_object(&mut self, id: u32) {
        for corner in 0..4 {
            self.stepper.release(number(id, corner));
        }
    }

    /// Vertices of an object, which must move freely.
    fn free_vertices(&self, object: usize) -> Result<[u32; 4], Refusal> {
        let placed = self.touching.as_ref().and_then(|t| t.objects.get(object));
        let refusal = || Refusal::new("grab", format!("there is no object {object}"), "");
        let vertices = placed.ok_or_else(refusal)?.vertices;
        if self.stepper.problem().rigid().contains(&Rigid(vertices)) {
            return Ok(vertices);
        }
        let what = "the object does not move freely";
        Err(Refusal::new(
            "grab",
            what,
            r#"give it motion = "free" and a mass"#,
        ))
    }

    fn middle_of(&self, object: usize, positions: &[Vec3]) -> Vec3 {
        let rest = self.stepper.problem().body().rest();
        let placed = self.touching.as_ref().and_then(|t| t.objects.get(object));
        placed.map_or([0.0; 3], |placed| placed.pose(rest, positions).0)
    }

    /// State of the grab of an object.
    pub(crate) fn hold_of(&self, id: u32, held: &Held) -> Option<GrabState> {
        let (object, _) = held.object?;
        let positions = &self.stepper.state().positions;
        let grabs = self.stepper.grabs().iter();
        let own = grabs.filter(|(other, _)| (0..4).any(|corner| number(id, corner) == *other));
        let force = own.fold([0.0; 3], |sum, (_, grab)| {
            add(sum, grab.force(positions[grab.vertex as usize]))
        });
        Some(GrabState {
            id,
            vertex: held.vertex,
            object: Some(object),
            target: held.target,
            stiffness: held.stiffness,
            force,
            stretch: norm(scale(1.0 / held.stiffness, force)),
        })
    }
}
