//! Snaps of a load path. Without contact a step may cross a limit and end on the far side; that is checked afterward.
//!
//! With contact, where a wall buckles or a pressed body slides off an edge, there is no equilibrium near the last one,
//! however short the step.
//!
//! The body then moves on to another equilibrium under the same load. It is found by the method for loose components
//! ([`crate::path::pseudo_transient`]): every vertex has a damper, so that the motion descends in energy, and the
//! dampers get weaker until they carry less than the tolerance of the forces. The result contains no damping.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Status, Term};

use std::sync::Arc;

use crate::linear::options::LinearOptions;
use crate::linear::options::LinearSolver;
use crate::linear::system::System;
use crate::path::arc_length;
use crate::path::contact_loop::Search;
use crate::path::equilibrium::Equilibrium;
use crate::path::load_parameter::LoadParameter;
use crate::path::load_path::Path;
use crate::path::parametrization::Parametrization;
use crate::path::pseudo_transient::PseudoTransient;
use crate::path::settings::Settings;

/// Fraction of the work of the loads that a step may release before it is checked for a limit: a linear response
/// releases half of it, a stiffening one less, a snap all of it.
const SET_FREE: f64 = 0.6;

impl Path<'_, '_> {
    /// Limit that the step from the last equilibrium to another one has crossed, if there is one: the loads drop there,
    /// and the body snaps. A step that releases no more energy than ordinary ones is not checked, nor is a path whose
    /// look ahead would change the memory of the loads.
    pub fn crossed_limit(
        &mut self,
        trial: &[Vec3],
        point: LoadParameter,
        along: Parametrization,
        settings: &Settings,
    ) -> Option<f64> {
        let problem = &self.equilibrium.problem;
        let plain = problem.contact().is_none() && problem.fluid().is_none();
        let known = plain && problem.floor().is_none() && !problem.depends_on_way();
        if !known || !along.has_factor() || self.equilibrium.system.is_iterative() {
            return None;
        }
        let loads = |at: &[Vec3]| problem.load_potential(at, &point.factor_of());
        let share = 1.0 - self.point.pressure / point.pressure;
        let work = share * (loads(&self.positions) - loads(trial));
        let before = self.equilibrium.potential(&self.positions, point).0;
        let free = before - self.equilibrium.potential(trial, point).0;
        if free <= SET_FREE * work {
            return None;
        }
        arc_length::look_for_limit(self, settings).filter(|limit| *limit < point.pressure)
    }

    /// Moves on to an equilibrium that the `search` finds, to which no short step leads; returns true if one was found.
    /// If not, nothing has changed.
    pub fn snap(&mut self, search: &mut impl Search, settings: &Settings) -> bool {
        let problem = &self.equilibrium.problem;
        let length = problem.contact().map(|contact| contact.length());
        let dampers = PseudoTransient::of_everything(problem, length);
        let term = Arc::clone(&dampers.dampers) as Arc<dyn Term>;
        let Ok(damped) = problem.clone().with_term(term) else {
            return false;
        };
        let options = LinearOptions {
            solver: LinearSolver::Direct,
            ..self.equilibrium.options
        };
        let Ok(equilibrium) = Equilibrium::new(damped, options) else {
            return false;
        };
        let mut path = Path {
            equilibrium: Equilibrium {
                precision: self.equilibrium.precision,
                has_loose: self.equilibrium.has_loose,
                ..equilibrium
            },
            positions: self.positions.clone(),
            point: search.point(),
            points: Vec::new(),
            snaps: Vec::new(),
            observer: self.observer,
            looking: true,
        };
        let ending = path.release(&dampers, search, settings);
        let Path {
            equilibrium,
            positions,
            point,
            points,
            ..
        } = path;
        let memory = equilibrium.problem.memory();
        let before = self.equilibrium.problem.memory();
        self.equilibrium.iterations += equilibrium.iterations;
        self.equilibrium.back_offs += equilibrium.back_offs;
        if ending.status() != Status::AtRest {
            return false;
        }
        // The old tangent has no pattern for the new contact.
        self.equilibrium.problem.remember(&memory);
        let problem = &self.equilibrium.problem;
        let Ok(system) = System::new(problem, &self.equilibrium.held, self.equilibrium.options)
        else {
            self.equilibrium.problem.remember(&before);
            return false;
        };
        self.equilibrium.system = system;
        self.positions = positions;
        self.point = point;
        self.points.extend(points.last().copied());
        self.snaps.push(point.pressure);
        true
    }
}
