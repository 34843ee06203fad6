//! Crossing of the surface of a shape with a face of a voxel.
//!
//! A voxel is filled if its center is in the shape, so that the surface lies between that center and the one beyond an
//! outer face. Voxels that a surface cuts may be filled with their center outside; the space between their centers and
//! the surface then counts as inside.

use voxsoft_solid::vector::{Vec3, axpy, norm, scale, sub};

/// Search intervals on a line, in voxels outward from a face: between centers, then behind the first.
const STRETCHES: [[f64; 2]; 2] = [[-0.5, 0.5], [-1.0, -0.5]];
/// Largest offset of a crossing inward of a face, in voxels. Crossings of all faces of a voxel that is full to just
/// beyond its center would coincide, and triangles between them would have no area.
const DEEPEST: f64 = -0.49;
/// Depth, in voxels, within which a place counts as on the surface: voxels whose centers lie on a side of a shape are
/// left empty, whatever rounding says.
const TIE: f64 = 1e-9;
/// Bisection steps of a bracket. The rest, a hundred-thousandth of a voxel, is interpolated, which is exact for flat
/// faces.
const HALVINGS: usize = 16;
/// Step of central differences, in voxels: their rounding and their truncation error are both below a millionth.
const DIFFERENCE: f64 = 1e-4;

/// Point on the surface, and its outward unit normal there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crossing {
    pub point: Vec3,
    pub normal: Vec3,
}

/// Level-set function of a shape, negative inside, at many places.
pub(super) type Function<'a, E> = dyn FnMut(&[Vec3]) -> Result<Vec<f64>, E> + 'a;

/// Level-set function together with the voxel size.
pub(super) struct Field<'a, E> {
    pub values: &'a mut Function<'a, E>,
    /// Voxel size in m.
    pub voxel: f64,
}

impl<E> Field<'_, E> {
    /// Values at some places; points on the surface count as outside.
    pub(super) fn at(&mut self, places: &[Vec3]) -> Result<Vec<f64>, E> {
        let mut values = (self.values)(places)?;
        for value in &mut values {
            *value += TIE * self.voxel;
        }
        Ok(values)
    }

    /// Gradients of the function.
    pub(super) fn gradients(&mut self, places: &[Vec3]) -> Result<Vec<Vec3>, E> {
        let step = DIFFERENCE * self.voxel;
        let around = |place: &Vec3| {
            let place = *place;
            (0..6).map(move |side| {
                let mut moved = place;
                moved[side / 2] += if side % 2 == 0 { step } else { -step };
                moved
            })
        };
        let around: Vec<Vec3> = places.iter().flat_map(around).collect();
        let values = self.at(&around)?;
        let of = |v: &[f64]| std::array::from_fn(|i| (v[2 * i] - v[2 * i + 1]) / (2.0 * step));
        Ok(values.chunks_exact(6).map(of).collect())
    }

    /// Crossings on lines through the centers of faces along their normals; `None` for lines without one.
    pub(super) fn crossings(&mut self, faces: &[Crossing]) -> Result<Vec<Option<Crossing>>, E> {
        let voxel = self.voxel;
        let along = |line: usize, t: f64| {
            let Crossing { mut point, normal } = faces[line];
            axpy(&mut point, t * voxel, normal);
            point
        };
        let mut brackets = self.brackets(faces.len(), along)?;
        for _ in 0..HALVINGS {
            let middles: Vec<Vec3> = brackets.iter().map(|b| along(b.line, b.middle())).collect();
            for (bracket, value) in brackets.iter_mut().zip(self.at(&middles)?) {
                bracket.halve(value);
            }
        }
        let points: Vec<Vec3> = brackets
            .iter()
            .map(|b| along(b.line, b.interpolated()))
            .collect();
        let gradients = self.gradients(&points)?;
        let mut found = vec![None; faces.len()];
        for (bracket, gradient) in brackets.iter().zip(gradients) {
            let size = norm(gradient);
            if size > 0.0 && size.is_finite() {
                let point = along(bracket.line, bracket.interpolated().max(DEEPEST));
                let normal = scale(1.0 / size, gradient);
                found[bracket.line] = Some(Crossing { point, normal });
            }
        }
        Ok(found)
    }

    /// Bracket on each line in which the function turns positive outward.
    fn brackets(
        &mut self,
        count: usize,
        along: impl Fn(usize, f64) -> Vec3,
    ) -> Result<Vec<Bracket>, E> {
        let mut found = Vec::new();
        let mut lines: Vec<usize> = (0..count).collect();
        for ends in STRETCHES {
            let places: Vec<Vec3> = lines
                .iter()
                .flat_map(|line| ends.map(|t| along(*line, t)))
                .collect();
            let values = self.at(&places)?;
            let mut others = Vec::new();
            for (line, values) in lines.into_iter().zip(values.chunks_exact(2)) {
                match Bracket::of(line, ends, [values[0], values[1]]) {
                    Some(bracket) => found.push(bracket),
                    None => others.push(line),
                }
            }
            lines = others;
        }
        Ok(found)
    }

    /// Moves places along the gradient toward the surface, each by `most` at the most and along its `free` axes alone.
    pub(super) fn approach(
        &mut self,
        places: &mut [Vec3],
        free: &[[bool; 3]],
        most: f64,
    ) -> Result<(), E> {
        let values = self.at(places)?;
        let gradients = self.gradients(places)?;
        for (((place, free), value), gradient) in
            places.iter_mut().zip(free).zip(values).zip(gradients)
        {
            let slope: Vec3 = std::array::from_fn(|i| if free[i] { gradient[i] } else { 0.0 });
            let square: f64 = slope.iter().map(|x| x * x).sum();
            let step = value / square.sqrt();
            if step.is_finite() && step != 0.0 {
                let step = step.clamp(-most, most);
                *place = sub(*place, scale(step / square.sqrt(), slope));
            }
        }
        Ok(())
    }
}

/// Interval of a line on which the function turns positive outward.
#[derive(Debug, Clone, Copy)]
struct Bracket {
    line: usize,
    ends: [f64; 2],
    values: [f64; 2],
}

impl Bracket {
    fn of(line: usize, ends: [f64; 2], values: [f64; 2]) -> Option<Self> {
        let crosses = values[0] < 0.0 && values[1] >= 0.0;
        crosses.then_some(Self { line, ends, values })
    }

    fn middle(&self) -> f64 {
        (self.ends[0] + self.ends[1]) / 2.0
    }

    fn halve(&mut self, value: f64) {
        let side = usize::from(value >= 0.0);
        self.ends[side] = self.middle();
        self.values[side] = value;
    }

    fn interpolated(&self) -> f64 {
        let part = -self.values[0] / (self.values[1] - self.values[0]);
        self.ends[0] + part * (self.ends[1] - self.ends[0])
    }
}
