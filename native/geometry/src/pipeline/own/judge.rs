//! Whether quads are a modeller's, and whether cut or fewer ones can stay.

use glam::DVec3;

use super::Own;
use crate::deform::n_inverted;
use crate::elementary::ln;
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::pair::{Layout, squareness};
use crate::pipeline::marks::Marks;
use crate::pipeline::settings::Settings;

/// Vertices where other than four quads meet: so many, and one in so many of the quads asked for.
const FEW_IRREGULAR: usize = 8;
const QUADS_PER_IRREGULAR: usize = 20;
/// No vertex has more quads.
const MOST_VALENCE: usize = 6;
/// The share of quads that one strip crosses twice: modellers leave none, machines many.
const MOST_SPIRAL: f64 = 0.02;
/// The share of triangles that are halves of quads, of a part that came in quads.
const MOSTLY: f64 = 0.5;
/// Quads that came in stay as they are, whatever they look like, up to so many for each.
const NEAR: usize = 2;
/// The sine of the worst corner of every quad, and the mean over the area.
const LEAST_SQUARE: f64 = 0.08;
const MEAN_SQUARE: f64 = 0.75;
/// How much longer or shorter edges are than wanted: the mean of the logarithm over the area, and where
/// sharp edges lie close together, which a flow could not follow.
const MOST_UNEVEN: f64 = 0.7;
const MOST_UNEVEN_OF_SHARP: f64 = 1.2;
/// And where edges of one length are asked for.
const MOST_UNEVEN_OF_EVEN: f64 = 0.15;

/// How many quads a part came in; none where a good share of it came in other polygons.
pub fn n_quads(part: &TriangleMesh, sides: &Marks) -> Option<usize> {
    if sides.is_empty() {
        return None;
    }
    are_quads(part, &sides.on(part)).then_some(part.n_faces() / 2)
}

/// Whether a part came in quads, a good share of it.
pub fn are_quads(part: &TriangleMesh, is_side: &HalfedgeMap<bool>) -> bool {
    let halves = part.face_ids().filter(|&f| is_half(part, is_side, f));
    halves.count() as f64 >= MOSTLY * part.n_faces() as f64
}

/// Whether quads meet at a pole that was no pole of quads when they came in, as that of a UV sphere.
pub fn has_new_poles(
    (part, quads): (&TriangleMesh, &PolygonMesh),
    is_side: &HalfedgeMap<bool>,
) -> bool {
    let n_quads = quads.faces_per_vertex();
    let is_pole = |v: VertexId| n_quads[v.index()] > MOST_VALENCE;
    let is_no_half = |face: &FaceId| !is_half(part, is_side, *face);
    let mut others = part.face_ids().filter(is_no_half);
    others.any(|face| part.face(face).into_iter().any(is_pole))
}

/// Takes diagonals of quads that came in from marked halfedges: where one is bent, it is no sharp edge.
pub fn without_diagonals(
    part: &TriangleMesh,
    is_side: &HalfedgeMap<bool>,
    marked: &mut HalfedgeMap<bool>,
) {
    let is_inside = |h: HalfedgeId| !is_side[h] && is_half(part, is_side, h.face());
    for h in part.halfedge_ids() {
        let is_diagonal = is_inside(h) && part.twin(h).is_some_and(is_inside);
        marked[h] &= !is_diagonal;
    }
}

/// Whether a triangle has two sides of polygons, as half of a quad has.
fn is_half(part: &TriangleMesh, is_side: &HalfedgeMap<bool>, face: FaceId) -> bool {
    let first = part.halfedge(face);
    let sides = [first, first.next(), first.prev()].into_iter();
    sides.filter(|&h| is_side[h]).count() == 2
}

impl Own {
    /// Whether so many of these quads, or finer ones in them, have few vertices of other than four.
    pub fn is_regular(&self, n_wanted: usize) -> bool {
        if self.is_near(n_wanted) {
            return self.is_modelled();
        }
        let valences = self.quads.faces_per_vertex();
        let each = || valences.iter().zip(&self.is_border);
        let most = |&is_border: &bool| {
            if is_border {
                MOST_VALENCE / 2
            } else {
                MOST_VALENCE
            }
        };
        // On a border a corner has one quad, a turn inwards three.
        let is_usual = |(&n, &is_border): (&usize, &bool)| if is_border { n <= 3 } else { n == 4 };
        let n_irregular = each().filter(|&pair| !is_usual(pair)).count();
        each().all(|(&n, is_border)| n <= most(is_border))
            && n_irregular <= FEW_IRREGULAR + n_wanted / QUADS_PER_IRREGULAR
    }

    /// Whether about as many quads as came in are asked for, or fewer.
    pub fn is_near(&self, n_wanted: usize) -> bool {
        self.came_in_quads && n_wanted <= NEAR * self.quads.n_faces()
    }

    /// Whether next to no strip crosses itself.
    fn is_modelled(&self) -> bool {
        let layout = Layout::of(&self.quads, None);
        layout.is_some_and(|layout| layout.spiral() <= MOST_SPIRAL)
    }

    /// Whether quads in these can stay: square corners, and edges of about one length.
    pub fn is_good(&self, fine: &PolygonMesh, (settings, n_wanted): (&Settings, usize)) -> bool {
        let is_even = settings.style.evenness() > 0.0;
        if self.is_near(n_wanted) && !is_even {
            return n_inverted(fine) == 0;
        }
        let most_uneven = if is_even {
            MOST_UNEVEN_OF_EVEN
        } else if self.kept.is_empty() {
            MOST_UNEVEN
        } else {
            MOST_UNEVEN_OF_SHARP
        };
        is_even_and_square(fine, most_uneven)
    }
}

fn is_even_and_square(quads: &PolygonMesh, most_uneven: f64) -> bool {
    let corners = |face: &[VertexId]| [0, 1, 2, 3].map(|i| quads.position(face[i]));
    let area = |p: &[DVec3; 4]| (p[2] - p[0]).cross(p[3] - p[1]).length() / 2.0;
    let each = || quads.faces().map(corners);
    let whole: f64 = each().map(|p| area(&p)).sum();
    let edge = (whole / quads.n_faces() as f64).sqrt();
    let [mut square, mut uneven] = [0.0, 0.0];
    for p in each() {
        let worst = squareness(p);
        if worst < LEAST_SQUARE {
            return false;
        }
        let longer = |i: usize| ln(p[i].distance(p[(i + 1) % 4]) / edge).abs();
        square += area(&p) * worst;
        uneven += area(&p) * (0..4).map(longer).sum::<f64>() / 4.0;
    }
    square >= MEAN_SQUARE * whole && uneven <= most_uneven * whole
}
