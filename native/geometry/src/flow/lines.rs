//! The lines of the grid of a whole metric, traced without reading the grid.
//!
//! In doubled coordinates a cone lies at even numbers. A line at an odd level is the middle of a
//! strip of quads and never meets a vertex; one at an even level runs along edges and ends where
//! it meets a cone. In a triangle the lines of one axis join its side of the widest span to the
//! other two, so that following them is counting. Agrees with [`super::strips::strips`] on the
//! grid when every vertex is a cone: a line through a flat vertex is not seen as a loop.

use glam::I64Vec2;

use super::complex::Complex;
use super::strips::Strips;
use crate::mesh::{FaceId, HalfedgeId, Id};

const NONE: u32 = u32::MAX;

/// Where a line crosses a side of a triangle.
#[derive(Clone, Copy, PartialEq)]
struct Crossing {
    side: HalfedgeId,
    /// 0: the line has one x; 1: one y, in the frame of the side's face.
    axis: usize,
    /// How many doubled levels from the side's origin: 1 to twice the span, excluded.
    step: usize,
}

/// What one axis says of a side of a face, in doubled levels.
#[derive(Clone, Copy)]
struct Gate {
    /// Where the crossings of the side begin.
    first: usize,
    /// How many levels it spans.
    span: usize,
    /// The side of its face that all lines of the axis cross, its levels, and those of the side
    /// before it.
    widest: HalfedgeId,
    whole: usize,
    before: usize,
}

struct Tracer<'a> {
    complex: &'a Complex,
    /// The gates of each halfedge, by axis.
    gates: Vec<[Gate; 2]>,
    /// The line of each crossing.
    lines: Vec<u32>,
}

/// One line.
struct Line {
    is_middle: bool,
    is_loop: bool,
    length: f64,
}

/// Follows every strip and every edge line of a metric whose vectors are whole.
pub fn trace(complex: &Complex) -> Strips {
    let mut tracer = Tracer::new(complex);
    let mut lines = Vec::new();
    for side in complex.halfedge_ids() {
        for axis in [0, 1] {
            for step in 1..tracer.gate(side, axis).span.max(1) {
                let start = Crossing { side, axis, step };
                if tracer.lines[tracer.place(start)] == NONE {
                    lines.push(tracer.follow(start, lines.len() as u32));
                }
            }
        }
    }
    let mut last_face = vec![NONE; lines.len()];
    let n_spiral = complex
        .face_ids()
        .map(|f| tracer.meetings(f, &mut lines, &mut last_face))
        .sum::<usize>();
    let looped = lines.iter().filter(|line| line.is_loop && !line.is_middle);
    let area = complex.area();
    Strips {
        spiral: n_spiral as f64 / area,
        loops: looped.map(|line| line.length).sum::<f64>() / (2.0 * area),
        n_strips: lines.iter().filter(|line| line.is_middle).count(),
    }
}

impl<'a> Tracer<'a> {
    fn new(complex: &'a Complex) -> Self {
        let mut n = 0;
        let mut gates = Vec::with_capacity(complex.twins.len());
        for face in complex.face_ids() {
            let h = complex.halfedge(face);
            let names = [h, h.next(), h.prev()];
            let spans = names.map(|e| {
                let levels = |x: f64| 2 * x.abs().round() as usize;
                let vector = complex.start[e];
                [levels(vector.x), levels(vector.y)]
            });
            let widest = [0, 1].map(|axis| {
                let wider = |a: usize, b: usize| {
                    if spans[b][axis] > spans[a][axis] {
                        b
                    } else {
                        a
                    }
                };
                wider(wider(0, 1), 2)
            });
            for own in spans {
                gates.push([0, 1].map(|axis| {
                    let at = widest[axis];
                    n += own[axis];
                    Gate {
                        first: n - own[axis],
                        span: own[axis],
                        widest: names[at],
                        whole: spans[at][axis],
                        before: spans[(at + 2) % 3][axis],
                    }
                }));
            }
        }
        let lines = vec![NONE; n];
        Self {
            complex,
            gates,
            lines,
        }
    }

    fn gate(&self, side: HalfedgeId, axis: usize) -> &Gate {
        &self.gates[side.index()][axis]
    }

    fn place(&self, crossing: Crossing) -> usize {
        self.gate(crossing.side, crossing.axis).first + crossing.step
    }

    /// How far along the widest side of its face the line through a crossing meets it.
    fn along_widest(&self, from: Crossing) -> usize {
        let gate = self.gate(from.side, from.axis);
        if from.side == gate.widest.next() {
            gate.whole - from.step
        } else if from.side == gate.widest.prev() {
            gate.before - from.step
        } else {
            from.step
        }
    }

    /// Where the line through a crossing leaves the face; none at a vertex.
    fn through(&self, from: Crossing) -> Option<Crossing> {
        let gate = self.gate(from.side, from.axis);
        let along = self.along_widest(from);
        let (side, step) = if from.side != gate.widest {
            (gate.widest, along)
        } else if along < gate.before {
            (gate.widest.prev(), gate.before - along)
        } else if along > gate.before {
            (gate.widest.next(), gate.whole - along)
        } else {
            return None;
        };
        Some(Crossing { side, step, ..from })
    }

    /// The same crossing seen from the other face.
    fn across(&self, from: Crossing) -> Crossing {
        Crossing {
            side: self.complex.twins[from.side],
            axis: from.axis ^ usize::from(self.complex.turns[from.side] % 2),
            step: self.gate(from.side, from.axis).span - from.step,
        }
    }

    /// How long the line through a crossing is inside its face.
    fn chord(&self, at: Crossing) -> f64 {
        let gate = self.gate(at.side, at.axis);
        let [whole, before, along] =
            [gate.whole, gate.before, self.along_widest(at)].map(|x| x as f64);
        let longest = 2.0 * self.complex.double_area(at.side.face()) / whole;
        if along <= before {
            longest * along / before
        } else {
            longest * (whole - along) / (whole - before)
        }
    }

    fn follow(&mut self, start: Crossing, name: u32) -> Line {
        let mut line = Line {
            is_middle: start.step % 2 == 1,
            is_loop: false,
            length: 0.0,
        };
        let mut at = start;
        loop {
            let place = self.place(at);
            self.lines[place] = name;
            let Some(out) = self.through(at) else {
                return line;
            };
            if !line.is_middle {
                line.length += self.chord(at);
            }
            let place = self.place(out);
            self.lines[place] = name;
            at = self.across(out);
            if self.lines[self.place(at)] != NONE {
                line.is_loop = at == start;
                return line;
            }
        }
    }

    /// Where the lines of a face cross themselves: counts middles, and loops are none any more.
    ///
    /// `last_face` keeps for each line the last face of which a line of the first axis it is.
    fn meetings(&self, face: FaceId, lines: &mut [Line], last_face: &mut [u32]) -> usize {
        let h = self.complex.halfedge(face);
        let sides = [h, h.next(), h.prev()].map(|e| (2.0 * self.complex.start[e]).as_i64vec2());
        let corners = [I64Vec2::ZERO, sides[0], sides[0] + sides[1]];
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        let gates = [0, 1].map(|axis| self.gate(h, axis));
        let name = |level: i64, axis: usize| {
            let widest = gates[axis].widest;
            let origin = corners[widest.corner()][axis];
            let step = (level - origin).unsigned_abs() as usize;
            self.lines[self.gate(widest, axis).first + step]
        };
        for x in low.x + 1..high.x {
            last_face[name(x, 0) as usize] = face.0;
        }
        let mut n_middles = 0;
        for y in low.y + 1..high.y {
            let line = name(y, 1);
            if last_face[line as usize] != face.0 {
                continue;
            }
            for x in (low.x + 1..high.x).filter(|x| (x - y) % 2 == 0) {
                if name(x, 0) != line || !self.owns(h, [corners, sides], I64Vec2::new(x, y)) {
                    continue;
                }
                if y % 2 == 0 {
                    lines[line as usize].is_loop = false;
                } else {
                    n_middles += 1;
                }
            }
        }
        n_middles
    }

    /// Whether a point lies in a face; on an edge it belongs to the smaller halfedge's.
    fn owns(&self, h: HalfedgeId, [corners, sides]: [[I64Vec2; 3]; 2], point: I64Vec2) -> bool {
        let side_of = |i: usize| sides[i].perp_dot(point - corners[i]);
        let names = [h, h.next(), h.prev()];
        (0..3).all(|i| match side_of(i) {
            0 => names[i] < self.complex.twins[names[i]],
            side => side > 0,
        })
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // No spiral is exactly none.
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::flow::complex::tests::box_complex;
    use crate::flow::covariance::Dense;
    use crate::flow::drag::State;
    use crate::flow::grid::read_quads;
    use crate::flow::periods::choose;
    use crate::flow::rounding::Rounding;
    use crate::flow::strips::strips;
    use crate::random::Random;

    #[test]
    fn the_lines_of_a_box_are_its_sections() {
        // 10 × 8 × 6: as many strips as units of length; all lines but the box's edges are loops.
        let strips = trace(&box_complex(1));
        assert_eq!(strips.n_strips, 24);
        assert_eq!(strips.spiral, 0.0);
        let loops = 9.0 * 28.0 + 7.0 * 32.0 + 5.0 * 36.0;
        assert!((strips.loops - loops / 752.0).abs() < 1e-12);
    }

    #[test]
    fn flips_and_frames_do_not_change_the_lines() {
        let mut complex = box_complex(1);
        let before = trace(&complex);
        for h in complex.halfedge_ids() {
            complex.reframe(h.face(), h.0 as u8 % 4);
            if complex.is_flippable(h, 1e-6) {
                complex.flip(h);
                let after = trace(&complex);
                assert_eq!(
                    (after.n_strips, after.spiral),
                    (before.n_strips, before.spiral)
                );
                assert!((after.loops - before.loops).abs() < 1e-12);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn lines_agree_with_those_of_the_grid(seed: u64, scale in 0.6..1.6f64) {
            let mut complex = box_complex(1);
            let basis = choose(&mut complex).unwrap();
            let mut random = Random::new(seed);
            let wish = basis.wish.iter().map(|x| x * scale + 3.0 * (random.unit() - 0.5)).collect();
            let covariance = Dense::energy(&complex).inverse();
            let state = State::new(&complex, basis.start);
            let whole = Rounding::new(state, wish, covariance).round();
            prop_assume!(whole.is_some());
            let whole = whole.unwrap().complex;
            let (quads, n_vertices) = read_quads(&whole).unwrap();
            let [own, read] = [trace(&whole), strips(&quads, n_vertices).unwrap()];
            prop_assert_eq!(own.n_strips, read.n_strips);
            prop_assert!((own.spiral - read.spiral).abs() < 1e-12);
            prop_assert!((own.loops - read.loops).abs() < 1e-12);
        }
    }
}
