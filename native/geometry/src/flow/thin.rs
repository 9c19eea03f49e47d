//! Fewer quads: strips of them are taken out, one after the other.
//!
//! A strip's quads become edges when its rungs, the edges that it crosses, shrink to a point each
//! (poly-chord collapse: Daniels, Silva, Shepherd & Cohen 2008). What is left is pure and closed, so
//! that a grid which is valid only at twice the count still leads to one of the count.

use glam::DVec3;

use super::error::Error;
use super::quads::{Flow, Report, tolerance};
use super::strips::{doubled_edges, follow_strips};
use crate::chords::{Leaving, normals, valences};
use crate::groups::Groups;
use crate::measure::Seam;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId};

/// More quads than this never meet at a vertex.
const MOST_VALENCE: usize = 7;
/// What a rung costs on flat ground, where 1 less the cosine is what its turn costs: without it flat
/// ground would lose its strips in any order.
const FLAT: f64 = 0.1;

impl Flow {
    /// Fewer quads: strips are taken out until there are as many as wanted within 2 %. They are no
    /// longer their own image in a plane; their sphere points may be folded.
    ///
    /// # Errors
    /// [`Error::Count`] where no strip can be taken out any more.
    pub fn thinned(self, n_wanted: usize) -> Result<Self, Error> {
        let quads = quads_of(&self.mesh);
        let n_quads = quads.len();
        let counts = [n_wanted, tolerance(n_wanted)];
        let thinned = thin(&quads, self.mesh.positions(), counts);
        let thinned = thinned.ok_or(Error::Count { n_quads, n_wanted })?;
        let report = Report {
            n_quads: thinned.quads.len(),
            n_cones: n_irregular(thinned.n_vertices, &thinned.quads),
            n_thinned: n_quads - thinned.quads.len(),
            ..self.report
        };
        let positions = thinned.middles(self.mesh.positions());
        Ok(Self {
            mesh: PolygonMesh::from_faces(positions, &thinned.quads)?,
            sphere: thinned.middles(&self.sphere),
            seams: thinned.seams(self.seams),
            images: None,
            report,
            ..self
        })
    }
}

/// The corners of the faces of a mesh of quads.
pub(super) fn quads_of(mesh: &PolygonMesh) -> Vec<[u32; 4]> {
    let corners = |face: FaceId| {
        let face = mesh.face(face);
        [0, 1, 2, 3].map(|i| face[i].0)
    };
    mesh.face_ids().map(corners).collect()
}

/// How many vertices have not four quads.
pub(super) fn n_irregular(n_vertices: usize, quads: &[[u32; 4]]) -> usize {
    let valences = valences(quads, n_vertices).into_iter();
    valences.filter(|&n| n != 4).count()
}

/// Fewer quads.
#[derive(Clone, PartialEq, Debug)]
struct Thinned {
    /// The corners of each quad, counter-clockwise.
    quads: Vec<[u32; 4]>,
    /// The vertex that each vertex of before became, in the middle of all that became it.
    vertex_of: Vec<u32>,
    /// How many vertices there are.
    n_vertices: usize,
}

/// Takes strips out of a closed mesh of quads until there are as many quads as wanted, within
/// `tolerance`: of those that leave a simple mesh with three to seven quads at a vertex the one whose
/// rungs are shortest and turn least.
///
/// `positions` are those of the vertices. None where no such strip is left or all have too many quads.
/// O(n) for each strip that is tried; often the first one tried goes.
fn thin(
    quads: &[[u32; 4]],
    positions: &[DVec3],
    [n_wanted, tolerance]: [usize; 2],
) -> Option<Thinned> {
    let mut places = positions.to_vec();
    let mut thinned = Thinned {
        quads: quads.to_vec(),
        vertex_of: (0..positions.len() as u32).collect(),
        n_vertices: positions.len(),
    };
    while thinned.quads.len() > n_wanted + tolerance {
        let most = thinned.quads.len() + tolerance - n_wanted;
        let strips = Strip::all(&thinned.quads, &places)?;
        let fitting = strips.iter().filter(|strip| strip.n_quads <= most);
        let mut fewer = fitting.filter_map(|strip| strip.collapsed(&thinned));
        let step = fewer.next()?;
        places = step.middles(&places);
        for v in &mut thinned.vertex_of {
            *v = step.vertex_of[*v as usize];
        }
        thinned.quads = step.quads;
        thinned.n_vertices = step.n_vertices;
    }
    Some(thinned)
}

impl Thinned {
    /// The middle of what became each vertex.
    fn middles(&self, values: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![(DVec3::ZERO, 0.0); self.n_vertices];
        for (&v, &value) in self.vertex_of.iter().zip(values) {
            let (sum, n) = &mut sums[v as usize];
            *sum += value;
            *n += 1.0;
        }
        sums.iter().map(|(sum, n)| *sum / *n).collect()
    }

    /// Seams over the new vertices, without those of which too little is left.
    fn seams(&self, seams: Vec<Seam>) -> Vec<Seam> {
        let mut is_taken = vec![false; self.n_vertices];
        let kept = seams.into_iter().filter_map(|seam| {
            let seam = self.seam(seam)?;
            let inner = &seam.vertices[1..seam.vertices.len() - 1];
            if inner.iter().any(|v| is_taken[v.index()]) {
                return None;
            }
            for v in inner {
                is_taken[v.index()] = true;
            }
            Some(seam)
        });
        kept.collect()
    }

    /// A seam over the new vertices; none where it ran along a rung or touches itself.
    fn seam(&self, seam: Seam) -> Option<Seam> {
        let mut vertices: Vec<VertexId> = Vec::new();
        let mut at: Vec<f64> = Vec::new();
        for (v, place) in seam.vertices.iter().zip(seam.at) {
            let new = VertexId(self.vertex_of[v.index()]);
            if vertices.last() == Some(&new) {
                // The first and the last place stay, where a line ends; others are alike.
                if at.len() > 1 {
                    *at.last_mut()? = place;
                }
            } else {
                vertices.push(new);
                at.push(place);
            }
        }
        let is_closed = seam.line.is_closed();
        if is_closed {
            *at.last_mut()? = at[0] + seam.line.length();
        }
        let mut sorted = vertices[usize::from(is_closed)..].to_vec();
        sorted.sort_unstable();
        let is_simple = sorted.windows(2).all(|pair| pair[0] != pair[1]);
        let least = if is_closed { 4 } else { 2 };
        (is_simple && vertices.len() >= least).then_some(Seam {
            vertices,
            at,
            line: seam.line,
        })
    }
}

/// The quads that one cut through opposite edges crosses.
struct Strip {
    rungs: Vec<[u32; 2]>,
    n_quads: usize,
    /// What it costs to take it out, per quad.
    cost: f64,
}

impl Strip {
    /// All strips of closed quads, the cheapest first; none where edges do not match.
    fn all(quads: &[[u32; 4]], places: &[DVec3]) -> Option<Vec<Self>> {
        let twins = Leaving::new(quads, places.len()).twins(quads)?;
        let (strip_of, n_strips) = follow_strips(&twins);
        let normals = normals(quads, places);
        let empty = || Self {
            rungs: Vec::new(),
            n_quads: 0,
            cost: 0.0,
        };
        let mut strips: Vec<Self> = std::iter::repeat_with(empty).take(n_strips).collect();
        for (q, quad) in quads.iter().enumerate() {
            let [first, second] = [0, 1].map(|i| strip_of[4 * q + i]);
            strips[first].n_quads += 1;
            strips[second].n_quads += usize::from(first != second);
            for i in 0..4 {
                let h = 4 * q + i;
                let ends = [quad[i], quad[(i + 1) % 4]];
                if h < twins[h] {
                    let [a, b] = ends.map(|v| v as usize);
                    let turn = 1.0 - normals[a].dot(normals[b]);
                    let strip = &mut strips[strip_of[h]];
                    strip.rungs.push(ends);
                    strip.cost += places[a].distance_squared(places[b]) * (turn + FLAT);
                }
            }
        }
        for strip in &mut strips {
            strip.cost /= strip.n_quads as f64;
        }
        strips.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        Some(strips)
    }

    /// Quads without this strip's, if they are a simple sphere.
    fn collapsed(&self, before: &Thinned) -> Option<Thinned> {
        let mut groups = Groups::new(before.n_vertices);
        for rung in &self.rungs {
            let [a, b] = rung.map(|v| v as usize);
            groups.link(a, b);
        }
        let (vertex_of, n_vertices) = groups.numbered();
        let moved = before
            .quads
            .iter()
            .map(|q| q.map(|v| vertex_of[v as usize]));
        let is_left = |q: &[u32; 4]| (0..4).all(|i| q[i] != q[(i + 1) % 4]);
        let quads: Vec<[u32; 4]> = moved.filter(is_left).collect();
        let is_gone = before.quads.len() - quads.len() == self.n_quads;
        // A sphere of quads has two vertices more than quads, and fewer where it is pinched.
        let is_whole = n_vertices == quads.len() + 2;
        let mut valences = valences(&quads, n_vertices).into_iter();
        let is_sound = valences.all(|n| (3..=MOST_VALENCE).contains(&n));
        (is_gone && is_whole && is_sound && doubled_edges(&quads, n_vertices) == 0).then_some(
            Thinned {
                quads,
                vertex_of,
                n_vertices,
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Polyline;
    use crate::sphere::quad_sphere;

    #[test]
    fn a_box_loses_whole_rings_of_squares() {
        let sphere = quad_sphere([6, 5, 4]);
        let quads = quads_of(&sphere);
        // The shortest strips of a box of 6 × 5 × 4 squares go round its longest axis.
        let thinned = thin(&quads, sphere.positions(), [130, 0]).unwrap();
        assert_eq!(thinned.quads.len(), 130);
        assert_eq!(thinned.n_vertices, 132);
        let positions = thinned.middles(sphere.positions());
        let mesh = PolygonMesh::from_faces(positions, &thinned.quads).unwrap();
        assert!(mesh.positions().iter().all(|p| p.length() > 0.8));
    }

    #[test]
    fn counts_are_reached_within_the_tolerance_and_spheres_stay_simple() {
        let sphere = quad_sphere([9, 8, 7]);
        let quads = quads_of(&sphere);
        for n_wanted in [40, 100, 200, 300] {
            let thinned = thin(&quads, sphere.positions(), [n_wanted, 12]).unwrap();
            let n = thinned.quads.len();
            assert!(n.abs_diff(n_wanted) <= 12, "{n} of {n_wanted}");
            assert_eq!(thinned.n_vertices, n + 2);
            assert_eq!(doubled_edges(&thinned.quads, thinned.n_vertices), 0);
        }
    }

    #[test]
    fn what_cannot_be_thinned_is_refused_and_what_needs_not_stays() {
        let cube = quad_sphere([1, 1, 1]);
        assert_eq!(thin(&quads_of(&cube), cube.positions(), [4, 0]), None);
        let thinned = thin(&quads_of(&cube), cube.positions(), [4, 2]).unwrap();
        assert_eq!(thinned.quads, quads_of(&cube));
        // Every strip of a box of squares has more than one quad.
        let sphere = quad_sphere([3, 3, 3]);
        assert_eq!(thin(&quads_of(&sphere), sphere.positions(), [53, 0]), None);
    }

    #[test]
    fn seams_go_over_to_the_vertices_that_are_left() {
        let thinned = Thinned {
            quads: Vec::new(),
            vertex_of: vec![0, 1, 1, 2, 0],
            n_vertices: 3,
        };
        let seam = |vertices: &[u32], is_closed: bool| {
            let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ZERO];
            Seam {
                vertices: vertices.iter().map(|&v| VertexId(v)).collect(),
                at: (0..vertices.len()).map(|i| i as f64).collect(),
                line: Polyline::new(points.to_vec(), is_closed),
            }
        };
        let seams = thinned.seams(vec![
            seam(&[0, 1, 2, 3], false),
            seam(&[1, 2], false),
            seam(&[0, 1, 2, 3, 4], true),
        ]);
        assert_eq!(seams.len(), 1);
        assert_eq!(seams[0].vertices, [0, 1, 2].map(VertexId));
        assert_eq!(seams[0].at, [0.0, 2.0, 3.0]);
        let ends = thinned.seams(vec![seam(&[1, 2, 3], false)]).swap_remove(0);
        assert_eq!(ends.at, [0.0, 2.0]);
        let closed = thinned
            .seams(vec![seam(&[4, 0, 1, 3, 4], true)])
            .swap_remove(0);
        assert_eq!(closed.vertices, [0, 1, 2, 0].map(VertexId));
        let whole = closed.at[3] - closed.at[0];
        assert!((whole - closed.line.length()).abs() < 1e-12);
    }
}
