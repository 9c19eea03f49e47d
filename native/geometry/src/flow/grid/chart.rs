//! The faces of a whole metric in doubled coordinates, and walks across them.

use glam::{DVec2, I64Vec2};

use crate::flow::complex::{Complex, Turn};
use crate::mesh::{HalfedgeId, Id};

/// More faces than this are not crossed on the way to a corner next by.
const MOST_CROSSED: usize = 5_000;

pub(super) struct Chart<'a> {
    pub complex: &'a Complex,
    /// The corners of each face; the first lies at 0.
    pub corners: Vec<[I64Vec2; 3]>,
}

fn halfedge(face: usize, corner: usize) -> HalfedgeId {
    HalfedgeId((3 * face + corner) as u32)
}

fn greatest_divisor(step: I64Vec2) -> i64 {
    let [mut a, mut b] = [step.x.abs(), step.y.abs()];
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl<'a> Chart<'a> {
    pub fn new(complex: &'a Complex) -> Self {
        let doubled = |v: DVec2| (2.0 * v.round()).as_i64vec2();
        let of_face = |sides: &[DVec2; 3]| {
            let b = doubled(sides[0]);
            [I64Vec2::ZERO, b, b + doubled(sides[1])]
        };
        let sides = complex.start.as_slice().as_chunks::<3>().0;
        Self {
            complex,
            corners: sides.iter().map(of_face).collect(),
        }
    }

    /// The least and greatest coordinates of a face.
    pub fn bounds(&self, face: usize) -> [I64Vec2; 2] {
        let [a, b, c] = self.corners[face];
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// Twice the signed area of a side and a point.
    fn side(&self, face: usize, i: usize, point: I64Vec2) -> i64 {
        let corners = &self.corners[face];
        let a = corners[i];
        (corners[(i + 1) % 3] - a).perp_dot(point - a)
    }

    /// The middles of quads that a face owns: inside it, or on a side whose halfedge is the
    /// smaller one.
    pub fn middles(&self, face: usize) -> Vec<I64Vec2> {
        let [low, high] = self.bounds(face);
        let mut middles = Vec::new();
        for y in (low.y + 1..high.y).step_by(2) {
            for x in (low.x + 1..high.x).step_by(2) {
                let middle = I64Vec2::new(x, y);
                let owns = |i: usize| match self.side(face, i, middle) {
                    0 => self.is_smaller(halfedge(face, i)),
                    area => area > 0,
                };
                if (0..3).all(owns) {
                    middles.push(middle);
                }
            }
        }
        middles
    }

    fn is_smaller(&self, h: HalfedgeId) -> bool {
        h < self.complex.twins[h]
    }

    /// The face and place of the middle `to`'s owner, from a face that holds it; how to get a
    /// point there.
    pub fn owner(&self, face: usize, middle: I64Vec2) -> Option<HalfedgeId> {
        let foreign =
            |i: &usize| self.side(face, *i, middle) == 0 && !self.is_smaller(halfedge(face, *i));
        (0..3).find(foreign).map(|i| halfedge(face, i))
    }

    /// The place of a point of `h`'s face in its twin's.
    pub fn carry(&self, h: HalfedgeId, point: I64Vec2) -> I64Vec2 {
        let [from, to] = self.hinges(h);
        (point - from).turned(self.complex.turns[h]) + to
    }

    /// The same for a point that is not whole.
    pub fn carry_real(&self, h: HalfedgeId, point: DVec2) -> DVec2 {
        let [from, to] = self.hinges(h).map(I64Vec2::as_dvec2);
        (point - from).turned(self.complex.turns[h]) + to
    }

    /// The origin of a halfedge in its face and in its twin's.
    fn hinges(&self, h: HalfedgeId) -> [I64Vec2; 2] {
        let twin = self.complex.twins[h];
        let there = self.corners[twin.face().index()][twin.next().corner()];
        [self.corners[h.face().index()][h.corner()], there]
    }

    /// Walks straight from a middle to a corner of its quad: the face that holds the corner, and
    /// its place there.
    pub fn walk(&self, face: usize, from: I64Vec2, to: I64Vec2) -> Option<(usize, I64Vec2)> {
        let (mut face, mut from, mut to) = (face, from, to);
        for _ in 0..MOST_CROSSED {
            let beyond = |i: &usize| self.side(face, *i, to) < 0;
            if !(0..3).any(|i| beyond(&i)) {
                return Some((face, to));
            }
            let corners = &self.corners[face];
            let crosses = |i: &usize| {
                let side_of = |p: I64Vec2| (to - from).perp_dot(p - from);
                side_of(corners[*i]) <= 0 && side_of(corners[(i + 1) % 3]) >= 0
            };
            let exit = halfedge(face, (0..3).filter(beyond).find(crosses)?);
            from = self.carry(exit, from);
            to = self.carry(exit, to);
            face = self.complex.twins[exit].face().index();
        }
        None
    }

    /// For an even place on a side of a face: the smaller halfedge of the edge, the step along
    /// it, and how many there are.
    pub fn step_along(&self, face: usize, place: I64Vec2) -> Option<(usize, usize, usize)> {
        let i = (0..3).find(|&i| self.side(face, i, place) == 0)?;
        let corners = &self.corners[face];
        let whole = corners[(i + 1) % 3] - corners[i];
        let n_steps = greatest_divisor(whole) / 2;
        let step = greatest_divisor(place - corners[i]) / (greatest_divisor(whole) / n_steps);
        let h = halfedge(face, i);
        let twin = self.complex.twins[h];
        let (edge, step) = if h < twin {
            (h, step)
        } else {
            (twin, n_steps - step)
        };
        Some((edge.index(), step as usize, n_steps as usize))
    }
}
