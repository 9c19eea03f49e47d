//! Lines along edges, as sums of vectors that no flip changes.
//!
//! What counts of a line is the sum of the vectors along it, all turned into the frame of its
//! beginning: Σ c w over halfedges, each c a Gaussian integer (at first a power of i). An edge that
//! is flipped away is the sum of two sides of a triangle at it. Three equal multiples may be taken
//! from the sides of any triangle, whose vectors cancel: so sums stay short, whatever order edges
//! flip in, where a path of edges that only ever goes round could double with every flip.

use glam::{DVec2, IVec2};

use super::{Complex, Turn};
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, Id};

/// What a halfedge contributes to a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Term {
    line: usize,
    factor: IVec2,
}

/// A line and another that is its image in every metric that is symmetric in a plane.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Tie {
    /// Which two lines.
    pub lines: [usize; 2],
    /// The sum along the first, turned by so many quarters and conjugated, is that along the other.
    pub turns: u8,
}

/// A line that is put along the nearest axis at any cost and has to be a straight way between its ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FirmLine {
    /// Which line.
    pub line: usize,
    /// The vertices at its ends.
    pub ends: [u32; 2],
    /// Whether it parts what counts from what does not.
    pub is_border: bool,
}

/// What of a surface counts when quads are counted.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Counted {
    /// How many quads are wanted there, where not all count.
    pub n_wanted: Option<usize>,
    /// Whether each vertex lies on it; none on its border.
    pub is_real: Vec<Option<bool>>,
}

/// Lines as sums over halfedges; none unless a complex was told to follow some.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Chains {
    n_lines: usize,
    /// Which of the lines are each other's images.
    pub ties: Vec<Tie>,
    /// The lines that have to be met, in order.
    pub firm: Vec<FirmLine>,
    /// What of the surface counts.
    pub counted: Counted,
    /// Closed loops of lines that shall be equally long, two and two.
    pub twins: Vec<[Vec<usize>; 2]>,
    /// The terms of each halfedge in the order of the lines; an edge's may be on either side.
    terms: Vec<Vec<Term>>,
}

impl Chains {
    /// How many lines there are.
    pub fn n_lines(&self) -> usize {
        self.n_lines
    }

    /// Whether a line has to be met.
    pub fn is_firm(&self, line: usize) -> bool {
        self.firm
            .binary_search_by_key(&line, |firm| firm.line)
            .is_ok()
    }

    /// How many terms there are in all, each as often as its factor says.
    #[cfg(test)]
    pub fn size(&self) -> i32 {
        let size = |term: &Term| term.factor.abs().element_sum();
        self.terms.iter().flatten().map(size).sum()
    }

    fn take(&mut self, h: HalfedgeId) -> Vec<Term> {
        std::mem::take(&mut self.terms[h.index()])
    }

    /// Adds to the terms of a halfedge, each factor changed.
    fn add(&mut self, h: HalfedgeId, terms: &[Term], change: impl Fn(IVec2) -> IVec2) {
        let own = &mut self.terms[h.index()];
        for &Term { line, factor } in terms {
            let factor = change(factor);
            match own.binary_search_by_key(&line, |term| term.line) {
                Ok(at) => own[at].factor += factor,
                Err(at) => own.insert(at, Term { line, factor }),
            }
        }
        own.retain(|term| term.factor != IVec2::ZERO);
    }

    fn factor(&self, h: HalfedgeId, line: usize) -> IVec2 {
        let own = self.terms[h.index()].iter().find(|term| term.line == line);
        own.map_or(IVec2::ZERO, |term| term.factor)
    }

    /// Notes that the vectors of a face are turned.
    pub(super) fn turn_face(&mut self, face: FaceId, turns: u8) {
        if self.n_lines == 0 {
            return;
        }
        let first = HalfedgeId(3 * face.0);
        for h in [first, first.next(), first.prev()] {
            for term in &mut self.terms[h.index()] {
                term.factor = term.factor.turned(4 - turns % 4);
            }
        }
    }

    /// Gives terms to other halfedges, all at once.
    pub(super) fn move_all<const N: usize>(&mut self, moves: &[(HalfedgeId, HalfedgeId); N]) {
        if self.n_lines > 0 {
            let taken = moves.map(|(from, _)| self.take(from));
            for (&(_, to), terms) in moves.iter().zip(taken) {
                self.terms[to.index()] = terms;
            }
        }
    }

    /// Keeps the terms of some faces, in the given order.
    pub(super) fn keep_faces(&mut self, faces: &[usize]) {
        if self.n_lines > 0 {
            let sides = |&f: &usize| [0, 1, 2].map(|i| HalfedgeId::from_index(3 * f + i));
            let kept = faces.iter().flat_map(sides);
            self.terms = kept
                .map(|h| std::mem::take(&mut self.terms[h.index()]))
                .collect();
        }
    }
}

impl Complex {
    /// Follows lines from now on, each from vertex to vertex over halfedges that join; they pass
    /// the vertices between on the left.
    pub fn follow_lines(&mut self, lines: &[Vec<HalfedgeId>]) {
        let mut chains = Chains {
            n_lines: lines.len(),
            ties: Vec::new(),
            twins: Vec::new(),
            firm: Vec::new(),
            counted: Counted::default(),
            terms: vec![Vec::new(); self.twins.len()],
        };
        for (i, line) in lines.iter().enumerate() {
            let mut turned = 0;
            for (at, &h) in line.iter().enumerate() {
                let factor = IVec2::X.turned(4 - turned);
                chains.add(h, &[Term { line: i, factor }], |factor| factor);
                let mut e = h.next();
                while line.get(at + 1).is_some_and(|&ahead| e != ahead) {
                    turned = (turned + self.turns[e]) % 4;
                    e = self.twins[e].next();
                }
            }
        }
        self.chains = chains;
    }

    /// The sum of vectors along a line, in the frame of its beginning.
    pub fn sum_along(&self, line: usize, vectors: &HalfedgeMap<DVec2>) -> DVec2 {
        let term = |h| self.chains.factor(h, line).as_dvec2().rotate(vectors[h]);
        self.halfedge_ids().map(term).sum()
    }

    /// The sum of coefficients along a line, in the frame of its beginning.
    pub fn coefficients_along(&self, line: usize) -> Vec<IVec2> {
        let mut sum = vec![IVec2::ZERO; self.coefficients.n_columns()];
        for h in self.halfedge_ids() {
            let factor = self.chains.factor(h, line);
            if factor != IVec2::ZERO {
                for (column, value) in self.coefficients.row(h) {
                    sum[column] += factor.rotate(value);
                }
            }
        }
        sum
    }

    /// Brings what the twin of a halfedge contributes over to it: w' = −iʳ w.
    fn gather(&mut self, h: HalfedgeId) {
        let terms = self.chains.take(self.twins[h]);
        let turns = self.turns[h];
        self.chains.add(h, &terms, |factor| -factor.turned(turns));
    }

    /// Leads lines round an edge that is about to be flipped.
    pub(super) fn detour(&mut self, h: HalfedgeId) {
        if self.chains.n_lines == 0 {
            return;
        }
        self.gather(h);
        let terms = self.chains.take(h);
        for side in [h.next(), h.prev()] {
            self.chains.add(side, &terms, |factor| -factor);
        }
    }

    /// Leads lines past a flat vertex of three faces of one frame, along the sides of these.
    pub(super) fn bypass(&mut self, spokes: [HalfedgeId; 3]) {
        if self.chains.n_lines == 0 {
            return;
        }
        for spoke in spokes {
            self.gather(spoke);
        }
        // What goes in comes out: the factors of the spokes cancel, and only differences count.
        let [_, second, third] = spokes.map(|spoke| self.chains.take(spoke));
        let [first_side, second_side] = [spokes[0].next(), spokes[1].next()];
        self.chains.add(first_side, &second, |factor| factor);
        for side in [first_side, second_side] {
            self.chains.add(side, &third, |factor| factor);
        }
    }

    /// Takes from the sides of a face the multiple that leaves the least of them.
    pub(super) fn tighten(&mut self, first: HalfedgeId) {
        let sides = [first, first.next(), first.prev()];
        let is_bare = |h: HalfedgeId| self.chains.terms[h.index()].is_empty();
        let is_free = |h: HalfedgeId| is_bare(h) && is_bare(self.twins[h]);
        if self.chains.n_lines == 0 || sides.into_iter().all(is_free) {
            return;
        }
        for h in sides {
            self.gather(h);
        }
        let lines = |h: HalfedgeId| self.chains.terms[h.index()].iter().map(|term| term.line);
        let lines: Vec<usize> = sides.into_iter().flat_map(lines).collect();
        for line in lines {
            let [a, b, c] = sides.map(|h| self.chains.factor(h, line));
            let factor = a.min(b).max(a.max(b).min(c));
            for h in sides.into_iter().filter(|_| factor != IVec2::ZERO) {
                self.chains
                    .add(h, &[Term { line, factor }], |factor| -factor);
            }
        }
    }
}
