//! Groups of crossings: connected, and between the same two components.
use std::collections::HashMap;

use crate::union::Sets;

/// Sets of triangles, each together with the component that it penetrates.
///
/// A triangle that penetrates two components belongs to two groups, and two fingers that both penetrate a body between
/// them are two groups.
pub(crate) struct Groups {
    /// Component of each vertex: the smallest vertex connected to it by tetrahedra.
    component: Vec<u32>,
    numbers: HashMap<(u32, u32), usize>,
    sets: Sets,
}

impl Groups {
    pub(crate) fn new(vertices: usize, tets: &[[i32; 4]]) -> Self {
        let mut joined = Sets::new(vertices);
        for tet in tets {
            for vertex in &tet[1..] {
                joined.join(tet[0] as usize, *vertex as usize);
            }
        }
        Self {
            component: (0..vertices).map(|v| joined.find(v) as u32).collect(),
            numbers: HashMap::new(),
            sets: Sets::new(0),
        }
    }

    /// Component of a vertex.
    pub(crate) fn component(&self, vertex: i32) -> u32 {
        self.component[vertex as usize]
    }

    /// Group of a triangle in a component.
    pub(crate) fn of(&mut self, triangle: u32, component: u32) -> usize {
        let number = self.number(triangle, component);
        self.sets.find(number)
    }

    /// Merges the groups of two triangles, each in a component.
    pub(crate) fn join(&mut self, one: (u32, u32), other: (u32, u32)) {
        let (one, other) = (self.number(one.0, one.1), self.number(other.0, other.1));
        self.sets.join(one, other);
    }

    fn number(&mut self, triangle: u32, component: u32) -> usize {
        let key = (triangle, component);
        *self.numbers.entry(key).or_insert_with(|| self.sets.add())
    }
}
