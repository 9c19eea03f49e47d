//! Seals handles for good: those round which a short loop goes, thousands of them at once.
//!
//! From roots all over the surface what is near is looked at: where it is no disc, its shortest loops
//! are found by a tree and a co-tree, and drawn tight. Of loops that touch no other all are cut at
//! once but those of a spanning tree of the pieces that this would leave: what is left hangs together,
//! and no two loops of one handle are cut, nor one that parts the surface. Again, until no loop is
//! found; then both sides of every cut get a lid.

use std::collections::HashSet;

use glam::DVec3;

use super::near::Region;
use super::slit::slit_all;
use super::split::Pieces;
use super::tighten::{Stop, tighten};
use super::{Search, round, without_chords};
use crate::close;
use crate::groups::Groups;
use crate::measure::topology_of_triangles;
use crate::mesh::{HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId};
use crate::progress::Progress;

/// Roots are no farther from each other than this share of the longest loop.
const SPACING: f64 = 0.25;
/// Wide tunnels are looked for from so many fewer, as what is near a root is more.
const SPACING_WIDE: f64 = 0.5;
/// Loops of edges are so much longer than tight ones at most: drawing them tight takes most of the time.
const CROOKED: f64 = 1.4;
/// And so much longer, or may count as longer, as seen from a root that is not on them.
const REACH: f64 = 1.75;
const REACH_WIDE: f64 = 2.0;
/// At most so many rounds; most handles are cut in the first two.
const MOST_ROUNDS: usize = 50;

/// A mesh some of whose handles are sealed.
#[derive(Clone, PartialEq, Debug)]
pub struct Sealed {
    /// The mesh: given vertices and faces come first and in their order, then what they were split
    /// into, then the faces of lids.
    pub mesh: TriangleMesh,
    /// The halfedge of the old mesh that each halfedge, but for lids, is or was a piece of; none
    /// across a face.
    pub sides: HalfedgeMap<Option<HalfedgeId>>,
    /// How many handles were sealed.
    pub n_sealed: usize,
}

/// Which handles are sealed: those round which a tight loop is no longer than a limit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Limits {
    /// For loops of every kind.
    pub any: f64,
    /// For loops in tunnels, which a lid closes; one round a bar would part it.
    pub tunnels: f64,
}

impl Limits {
    /// The same for loops of every kind.
    pub fn same(size: f64) -> Self {
        Self {
            any: size,
            tunnels: size,
        }
    }

    fn longest(self) -> f64 {
        self.any.max(self.tunnels)
    }

    /// Whether tunnels may be wider than bars.
    fn is_wide(self) -> bool {
        self.tunnels > self.any
    }

    /// First what is short alone: most often nothing is left then.
    fn stages(self) -> impl Iterator<Item = Self> {
        let short = self.is_wide().then_some(Self::same(self.any));
        short.into_iter().chain([self])
    }

    fn takes(self, mesh: &TriangleMesh, (stops, length): (&[Stop], f64)) -> bool {
        length <= self.any || (length <= self.tunnels && is_in_tunnel(mesh, stops))
    }
}

/// A loop of edges that may be cut.
struct Candidate {
    vertices: Vec<VertexId>,
    /// Its length once it is drawn tight.
    length: f64,
}

/// Seals every handle of one component round which a tight loop goes that is within the limits.
///
/// Loops touch neither borders nor each other. About n log n in time, whatever the number of
/// handles.
///
/// # Errors
/// What [`close::fill`] says.
pub fn seal(
    mesh: &TriangleMesh,
    limits: Limits,
    progress: &Progress,
) -> Result<Sealed, close::Error> {
    let genus = topology_of_triangles(mesh).genus.unwrap_or(0).max(0);
    let mut seal = Seal {
        pieces: Pieces::whole(mesh),
        is_side: vec![false; mesh.n_vertices()],
        n_left: genus as usize,
        is_thorough: !limits.is_wide(),
    };
    for limits in limits.stages().filter(|limits| limits.longest() > 0.0) {
        seal = seal.run(limits, &progress.part("", 0.0, 0.9))?;
    }
    let (is_side, mesh) = (seal.is_side, &seal.pieces.mesh);
    let filled = close::fill(
        mesh,
        |border| is_side[mesh.origin(border[0]).index()],
        progress,
    )?;
    Ok(Sealed {
        mesh: filled.mesh,
        sides: seal.pieces.sides,
        n_sealed: filled.n_filled / 2,
    })
}

/// A mesh on the way.
struct Seal {
    pieces: Pieces,
    /// Which vertices lie on cuts.
    is_side: Vec<bool>,
    n_left: usize,
    /// Whether all is looked at again once nothing is found where loops were.
    is_thorough: bool,
}

impl Seal {
    /// Cuts until no loop is found.
    fn run(mut self, limits: Limits, progress: &Progress) -> Result<Self, close::Error> {
        // Where loops were found before; none looks everywhere.
        let mut near: Option<Vec<VertexId>> = None;
        for n_round in 0..MOST_ROUNDS {
            progress.at(n_round as f64 / MOST_ROUNDS as f64)?;
            if self.n_left == 0 {
                break;
            }
            self.pieces = without_chords(self.pieces, progress)?;
            let mesh = &self.pieces.mesh;
            let is_everywhere = near.is_none();
            let (found, roots) = candidates(mesh, (limits, near.as_deref()), progress)?;
            let chosen = apart(mesh, &found, progress)?;
            if chosen.is_empty() {
                if is_everywhere || !self.is_thorough {
                    break;
                }
                near = None;
                continue;
            }
            self = self.cut(&chosen, progress)?;
            near = Some(roots);
        }
        Ok(self)
    }

    /// Cuts along loops.
    fn cut(mut self, chosen: &[Vec<VertexId>], progress: &Progress) -> Result<Self, close::Error> {
        self.n_left = self.n_left.saturating_sub(chosen.len());
        let (pieces, copies) = slit_all(self.pieces, chosen, progress)?;
        self.is_side.resize(pieces.mesh.n_vertices(), false);
        for &v in chosen.iter().chain(&copies).flatten() {
            self.is_side[v.index()] = true;
        }
        Ok(Self { pieces, ..self })
    }
}

/// Whether a closed line goes round inside a tunnel: the surface along it faces its middle more
/// than it turns its back on it.
fn is_in_tunnel(mesh: &TriangleMesh, stops: &[Stop]) -> bool {
    let middle = stops.iter().map(|stop| stop.position(mesh)).sum::<DVec3>();
    let middle = middle / stops.len().max(1) as f64;
    let facing = |&stop: &Stop| {
        let place = stop.position(mesh);
        let v = match stop {
            Stop::Vertex(v) => v,
            Stop::Edge(place) => mesh.origin(place.edge),
        };
        let corners = mesh.outgoing(v).map(|h| mesh.triangle(h.face()));
        let normal = corners.map(|[a, b, c]| (b - a).cross(c - a)).sum::<DVec3>();
        normal
            .normalize_or_zero()
            .dot((middle - place).normalize_or_zero())
    };
    stops.iter().map(facing).sum::<f64>() > 0.0
}

/// Short loops that touch no other, and the roots from which they were seen.
fn candidates(
    mesh: &TriangleMesh,
    (limits, roots): (Limits, Option<&[VertexId]>),
    progress: &Progress,
) -> Result<(Vec<Candidate>, Vec<VertexId>), close::Error> {
    let size = limits.longest();
    let [spacing, reach] = if limits.is_wide() {
        [SPACING_WIDE, REACH_WIDE]
    } else {
        [SPACING, REACH]
    };
    let mut search = Search::new(mesh, true);
    let mut region = Region::new(mesh.n_faces());
    let everywhere = match roots {
        Some(_) => Vec::new(),
        None => search.net(spacing * size, progress)?,
    };
    let roots = roots.unwrap_or(&everywhere);
    let mut found: Vec<Candidate> = Vec::new();
    let mut seen = Vec::new();
    for &root in roots {
        if !search.is_free(root) {
            continue;
        }
        let loops = search.near((root, reach * size), &mut region, progress)?;
        if loops.is_empty() {
            continue;
        }
        seen.push(root);
        let measured = loops.into_iter().map(|vertices| {
            let places: Vec<_> = vertices.iter().map(|&v| mesh.position(v)).collect();
            let length = round(&places);
            Candidate { vertices, length }
        });
        found.extend(measured.filter(|found| found.length <= CROOKED * size));
    }
    found.sort_by(|a, b| a.length.total_cmp(&b.length));
    let mut taken = HashSet::new();
    let mut tight = Vec::new();
    for candidate in found {
        progress.check()?;
        let vertices = candidate.vertices;
        if vertices.iter().any(|v| taken.contains(v)) {
            continue;
        }
        let stops = tighten(mesh, &vertices, |_| false);
        let places: Vec<_> = stops.iter().map(|stop| stop.position(mesh)).collect();
        let length = round(&places);
        if limits.takes(mesh, (&stops, length)) {
            taken.extend(vertices.iter().copied());
            tight.push(Candidate { vertices, length });
        }
    }
    tight.sort_by(|a, b| a.length.total_cmp(&b.length));
    Ok((tight, seen))
}

/// Those of some loops that can all be cut and leave one piece; longer ones stay first.
fn apart(
    mesh: &TriangleMesh,
    found: &[Candidate],
    progress: &Progress,
) -> Result<Vec<Vec<VertexId>>, close::Error> {
    if found.is_empty() {
        return Ok(Vec::new());
    }
    let lines: Vec<Vec<VertexId>> = found.iter().map(|found| found.vertices.clone()).collect();
    let (cut, copies) = slit_all(Pieces::whole(mesh), &lines, progress)?;
    let (piece, n_pieces) = cut.mesh.face_components();
    let side = |v: VertexId| {
        let mut around = cut.mesh.outgoing(v);
        around
            .next()
            .map_or(0, |h| piece[h.face().index()] as usize)
    };
    let mut groups = Groups::new(n_pieces);
    let mut chosen = Vec::new();
    for (line, copies) in lines.into_iter().zip(&copies).rev() {
        if !groups.link(side(line[0]), side(copies[0])) {
            chosen.push(line);
        }
    }
    chosen.reverse();
    Ok(chosen)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::close::handles::tests::bridged;
    use crate::shapes;

    fn sealed(mesh: &TriangleMesh, size: f64) -> (Sealed, i64) {
        sealed_within(mesh, Limits::same(size))
    }

    fn sealed_within(mesh: &TriangleMesh, limits: Limits) -> (Sealed, i64) {
        let sealed = seal(mesh, limits, &Progress::none()).unwrap();
        let shape = topology_of_triangles(&sealed.mesh);
        let came = topology_of_triangles(mesh);
        assert_eq!((shape.n_components, shape.n_borders), (1, came.n_borders));
        for (h, side) in sealed.sides.ids().zip(&sealed.sides) {
            assert!(
                side.is_none_or(|side| side.index() < 3 * mesh.n_faces()),
                "{h}"
            );
        }
        let genus = shape.genus.unwrap();
        assert_eq!(genus, came.genus.unwrap() - sealed.n_sealed as i64);
        (sealed, genus)
    }

    #[test]
    fn all_handles_that_are_small_are_sealed_at_once() {
        for seed in 1..4 {
            let mesh = bridged((12, seed), 12, 3);
            assert_eq!(sealed(&mesh, 10.0).1, 0, "{seed}");
            assert_eq!(sealed(&mesh, 0.0).0.mesh, mesh);
        }
    }

    #[test]
    fn a_torus_is_sealed_from_the_length_round_its_tube_on() {
        let torus = shapes::torus(48, 24);
        let tube = std::f64::consts::TAU * 0.4;
        assert_eq!(sealed(&torus, 0.9 * tube).1, 1);
        assert_eq!(sealed(&torus, 1.1 * tube).1, 0);
    }

    #[test]
    fn a_tunnel_is_sealed_where_a_bar_as_long_round_stays() {
        let torus = shapes::torus(48, 24);
        let [tube, tunnel] = [0.4, 0.6].map(|r| std::f64::consts::TAU * r);
        let within = |tunnels| {
            let limits = Limits { any: 0.0, tunnels };
            sealed_within(&torus, limits)
        };
        assert_eq!(within(1.2 * tube).1, 1);
        let (sealed, genus) = within(1.1 * tunnel);
        assert_eq!((genus, sealed.n_sealed), (0, 1));
        // The cut goes round the axis; one through the bar would lie about a place at 1 from it.
        let new: Vec<_> = sealed.mesh.positions()[torus.n_vertices()..].to_vec();
        let middle = new.iter().sum::<DVec3>() / new.len() as f64;
        assert!(
            new.len() > 20 && middle.truncate().length() < 0.3,
            "{middle}"
        );
    }

    #[test]
    fn a_narrow_limb_is_not_cut_through() {
        let limbs = shapes::limbs(1, 10);
        let (sealed, genus) = sealed(&limbs, 10.0);
        assert_eq!((genus, sealed.mesh), (0, limbs));
    }
}
