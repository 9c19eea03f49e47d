//! Parts surfaces that share edges into sheets: oriented surfaces with borders.
//!
//! Along each line of shared edges pages are paired, the whole line in one way; what is left over
//! ends there. In turn:
//!
//! 1. where each surface that meets there has two pages, they are each other's (bodies that touch),
//!    and those of a surface that has no border but these pages (a body with a fin);
//! 2. pages that go on into each other within 30 degrees, the smoothest first, over all lines;
//! 3. other pages, those first that have become one sheet elsewhere (a box with a wall from edge
//!    to edge stays closed), then by their turn again, as long as it is no fold.
//!
//! A turn is the mean along the line. No pair is made that would give a sheet one side only. Where
//! a surface has but one side without any shared edge, nothing can be done: it stays a tangle.

mod facing;
mod lines;
mod middles;
mod points;
mod strands;
#[cfg(test)]
mod tests;
mod turns;

use std::f64::consts::{FRAC_PI_3, FRAC_PI_6};

use super::edges::{Edges, Twins};
use super::mend::Soup;
use super::pairs::Pairing;
use super::triangulate::Triangulated;
use crate::groups::Groups;
use crate::mesh::{HalfedgeId, Id};
use facing::Facing;
pub(super) use lines::Line;
use lines::LineEdge;
pub(super) use middles::split_at_middles;
pub(super) use points::points;
pub use points::{Fan, SharedPoint};
pub use strands::{SharedLine, Strand};
pub(super) use strands::{Sorted, Turned, count, told};

/// Pages that turn by less go on into each other, whatever else is true of them: as much as the
/// crease between two smooth groups. Below, coarse round walls with a stem are cut open; at 45
/// degrees a wall from edge to edge of a box goes on into its side.
const SMOOTH: f64 = FRAC_PI_6;
/// Pages that turn by more do not go on into each other: it would be a fold. At 90 degrees the
/// edges of boxes come apart, at 150 leaves on one stem are glued in pairs.
const MOST: f64 = 2.0 * FRAC_PI_3;
/// How much pages that belong to one sheet may turn more than others.
const OF_ONE_SHEET: f64 = FRAC_PI_3;
/// More pages than these at one edge are no surfaces that meet there; all of them end.
const MOST_PAGES: usize = 64;

/// Triangles with their neighbours.
pub(super) struct Parted {
    /// At most one neighbour at each side.
    pub(super) twins: Twins,
    /// The lines along which sheets meet.
    pub(super) lines: Vec<Line>,
    /// Those along which solids touch that go nowhere into each other.
    pub(super) touching: Vec<Line>,
    /// Whether some edge still has more than two faces, paired or not.
    pub(super) is_crowded: bool,
}

/// Which pages of a line go on into each other at which price.
struct Candidate {
    turn: f64,
    line: usize,
    pages: [usize; 2],
}

/// Pairs what meets at shared edges.
pub(super) fn part(soup: &Soup, pairing: Pairing) -> Parted {
    let Pairing {
        mut twins,
        touching,
        mut shared,
    } = pairing;
    let is_crowded = !shared.is_empty() || !touching.is_empty();
    if !is_crowded {
        return Parted {
            twins,
            lines: Vec::new(),
            touching: Vec::new(),
            is_crowded,
        };
    }
    let triangulated = &soup.triangulated;
    let mut facing = Facing::new(triangulated.faces.len());
    for run in soup.edges.runs() {
        if let [g, h] = *run {
            facing.link(
                [g, h].map(HalfedgeId::face),
                is_against(triangulated, [g, h]),
            );
        }
    }
    let (touching, refused) = touching_or_not(triangulated, (&mut twins, touching), &mut facing);
    shared.extend(refused);
    let touching = lines::touching(triangulated, &twins, &touching);
    let mut pages = Pages {
        triangulated,
        lines: lines::chained(triangulated, &twins, &shared),
        twins,
        facing,
    };
    pages.pair_bodies(&soup.edges);
    pages.pair_by_turn();
    Parted {
        twins: pages.twins,
        lines: pages.lines,
        touching,
        is_crowded,
    }
}

/// Whether two faces run through their edge in the same direction.
fn is_against(triangulated: &Triangulated, [g, h]: [HalfedgeId; 2]) -> bool {
    triangulated.ends(g)[0] == triangulated.ends(h)[0]
}

/// The pairs of faces at an edge that go on into each other.
type Pairs = Vec<[HalfedgeId; 2]>;

/// Links the faces of solids that touch. The edges where that can be; and those where it cannot:
/// where a solid would have one side only, or where solids go over into each other at both ends, so
/// that neither end parts.
fn touching_or_not(
    triangulated: &Triangulated,
    (twins, touching): (&mut Twins, Vec<Pairs>),
    facing: &mut Facing,
) -> (Vec<Pairs>, Vec<Vec<HalfedgeId>>) {
    let mut links = |pair: &[HalfedgeId; 2]| {
        let faces = pair.map(HalfedgeId::face);
        let may = facing.may_link(faces, false);
        if may {
            facing.link(faces, false);
        }
        may
    };
    let is_linked = |pairs: &Pairs| pairs.iter().all(&mut links);
    let (left, mut refused): (Vec<_>, Vec<_>) = touching.into_iter().partition(is_linked);
    for &pair in refused.iter().flatten() {
        twins.part(pair);
    }
    let mut fans = fans(triangulated, twins);
    let mut linked = Vec::new();
    for pairs in left {
        let ends = |&[h, _]: &[HalfedgeId; 2]| {
            let [a, b] = [h, h.next()].map(|corner| fans.root(corner.index()));
            [a.min(b), a.max(b)]
        };
        let mut ends: Vec<[usize; 2]> = pairs.iter().map(ends).collect();
        ends.sort_unstable();
        if ends.windows(2).any(|w| w[0] == w[1]) {
            for &pair in &pairs {
                twins.part(pair);
            }
            refused.push(pairs);
        } else {
            linked.push(pairs);
        }
    }
    let run = |pairs: Pairs| {
        let mut run = pairs.concat();
        run.sort_unstable();
        run
    };
    (linked, refused.into_iter().map(run).collect())
}

/// The fan of each corner of the triangles.
fn fans(triangulated: &Triangulated, twins: &Twins) -> Groups {
    let n = 3 * triangulated.faces.len();
    let mut groups = Groups::new(n);
    for h in (0..n).map(HalfedgeId::from_index) {
        let Some(twin) = twins.of(h).filter(|&twin| twin > h) else {
            continue;
        };
        let mut corners = [twin.next(), twin];
        if is_against(triangulated, [h, twin]) {
            corners.reverse();
        }
        groups.link(h.index(), corners[0].index());
        groups.link(h.next().index(), corners[1].index());
    }
    groups
}

/// A surface at a line, before anything is paired there.
struct Surface {
    group: usize,
    pages: Vec<usize>,
}

/// The pages of all lines while they are paired.
struct Pages<'a> {
    triangulated: &'a Triangulated,
    lines: Vec<Line>,
    twins: Twins,
    facing: Facing,
}

impl Pages<'_> {
    /// The sheet of a page, as far as it is put together.
    fn group(&mut self, line: usize, page: usize) -> usize {
        let face = self.lines[line].edges[0].pages[page].face();
        self.facing.place(face).group
    }

    /// Pairs the pages of lines where each surface has two, and those of surfaces that close so.
    fn pair_bodies(&mut self, edges: &Edges) {
        let mut closes = vec![true; self.triangulated.faces.len()];
        for run in edges.runs().filter(|run| run.len() == 1) {
            closes[self.facing.place(run[0].face()).group] = false;
        }
        let surfaces: Vec<_> = (0..self.lines.len())
            .map(|line| self.surfaces(line))
            .collect();
        for surface in surfaces
            .iter()
            .flatten()
            .filter(|surface| surface.pages.len() != 2)
        {
            closes[surface.group] = false;
        }
        for (line, surfaces) in surfaces.iter().enumerate() {
            let are_bodies = surfaces.iter().all(|surface| surface.pages.len() == 2);
            let bodies = surfaces.iter().filter(|s| are_bodies || closes[s.group]);
            for body in bodies {
                self.pair(line, [body.pages[0], body.pages[1]]);
            }
        }
    }

    /// The surfaces that meet at a line.
    fn surfaces(&mut self, line: usize) -> Vec<Surface> {
        let mut surfaces: Vec<Surface> = Vec::new();
        for page in 0..self.lines[line].n_pages() {
            let group = self.group(line, page);
            match surfaces.iter_mut().find(|surface| surface.group == group) {
                Some(surface) => surface.pages.push(page),
                None => surfaces.push(Surface {
                    group,
                    pages: vec![page],
                }),
            }
        }
        surfaces
    }

    /// Pairs pages by their turn: the smooth ones, then the others.
    fn pair_by_turn(&mut self) {
        let mut candidates = self.candidates();
        sort(&mut candidates);
        for candidate in candidates.iter().filter(|c| c.turn <= SMOOTH) {
            self.pair(candidate.line, candidate.pages);
        }
        candidates.retain(|c| c.pages.iter().all(|&page| self.lines[c.line].is_free(page)));
        for c in &mut candidates {
            let [a, b] = c.pages.map(|page| self.group(c.line, page));
            c.turn -= if a == b { OF_ONE_SHEET } else { 0.0 };
        }
        sort(&mut candidates);
        for candidate in candidates.iter().filter(|c| c.turn <= MOST) {
            self.pair(candidate.line, candidate.pages);
        }
    }

    /// All pairs of free pages.
    fn candidates(&self) -> Vec<Candidate> {
        let mut candidates = Vec::new();
        for (line, of) in self.lines.iter().enumerate() {
            let is_free = |page: &usize| of.is_free(*page);
            let free: Vec<usize> = (0..of.n_pages()).filter(is_free).collect();
            if free.len() > MOST_PAGES {
                continue;
            }
            let turns = turns::turns(self.triangulated, of, &free);
            for (i, &a) in free.iter().enumerate() {
                let others = free.iter().enumerate().skip(i + 1);
                candidates.extend(others.map(|(j, &b)| Candidate {
                    turn: turns[i][j],
                    line,
                    pages: [a, b],
                }));
            }
        }
        candidates
    }

    /// Makes two pages go on into each other, if they are free and it gives no sheet of one side.
    fn pair(&mut self, line: usize, [a, b]: [usize; 2]) {
        let (line, triangulated) = (&mut self.lines[line], self.triangulated);
        if !line.is_free(a) || !line.is_free(b) {
            return;
        }
        let sides = |edge: &LineEdge| [edge.pages[a], edge.pages[b]];
        let relation =
            |sides: [HalfedgeId; 2]| (sides.map(HalfedgeId::face), is_against(triangulated, sides));
        let relations = line.edges.iter().map(sides).map(relation);
        let may_link = |(faces, against)| self.facing.may_link(faces, against);
        if !relations.clone().all(may_link) {
            return;
        }
        relations.for_each(|(faces, against)| self.facing.link(faces, against));
        for [g, h] in line.edges.iter().map(sides) {
            self.twins.link(g, h);
        }
        [line.partner[a], line.partner[b]] = [Some(b), Some(a)];
    }
}

/// The smoothest first; of equal ones that of the first line.
fn sort(candidates: &mut [Candidate]) {
    candidates.sort_by(|x, y| {
        let names = (x.line, x.pages).cmp(&(y.line, y.pages));
        x.turn.total_cmp(&y.turn).then(names)
    });
}
