//! Separating: faces that cross each other are moved apart, vertex by vertex, in space.
//!
//! Where limbs are closer than a face is long, faces of one pass through those of the next. A
//! corner of a face that crosses goes to the place around it, off the surface too, from which least
//! crosses, where that pays for the distance. Sphere points stay, so nothing folds there.

use glam::DVec3;

use super::sheet::{Face, Point, Sheet};
use super::skin::cut;
use super::untangle::{REACHES, corners, grown, places_around, smooth, worse_than};
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, VertexMap, bounds};
use crate::nearest::{Bvh, crossing_pairs, depths};
use crate::progress::{Cancelled, Progress};

/// Rounds over the corners of faces that cross, at most.
const N_ROUNDS: usize = 20;
/// Nothing is tried where more than one pair in so many faces crosses: it would take seconds.
const FACES_PER_PAIR: usize = 10;
/// Rings of faces around what still crosses that are pulled smooth with it, at most.
const MOST_RINGS: usize = 2;
/// Rounds without fewer pairs after which it stops.
const PATIENCE: usize = 3;
/// How far a vertex may go at all, in mean edges: farther, tips would be lost.
const MOST_WAY: f64 = 0.7;
/// What an edge that passes through a triangle costs, and each mean edge that it is deep.
const THROUGH: [f64; 2] = [0.1, 0.5];
/// What a vertex a mean edge away from where it was costs.
const COST: f64 = 0.1;
/// Quality that no move may spoil unless a face is worse already.
const GUARDED_QUALITY: f64 = 0.2;
/// And up to which lack of quality is weighed.
const ENOUGH: f64 = 0.3;

/// Moves corners of faces that cross until none does or no move helps; returns how many pairs of
/// triangles crossed and how many still do.
///
/// What still crosses then is pulled smooth with what is around it, which makes limbs thinner, and
/// stays so where that leaves less and inverts nothing. Where too much crosses nothing is tried.
pub(super) fn separate(sheet: &mut Sheet, progress: &Progress) -> Result<[usize; 2], Cancelled> {
    let mut solid = Solid::new(sheet, progress)?;
    let n_before = solid.n_pairs;
    if n_before > sheet.faces().len() / FACES_PER_PAIR {
        return Ok([n_before; 2]);
    }
    let edge = sheet.mean_edge();
    let (starts, n_inverted) = (sheet.positions(), worse_than(sheet, 0.0).len());
    for n_rings in 0..=MOST_RINGS {
        if solid.n_pairs == 0 {
            break;
        }
        let before = sheet.positions();
        let mut now = solid.clone();
        if n_rings > 0 {
            let knot = grown(sheet, corners(sheet, &solid.crossing), n_rings);
            smooth(sheet, &knot);
            for v in knot {
                let way = sheet.position(v) - starts[v];
                sheet.lift(v, starts[v] + way.clamp_length_max(MOST_WAY * edge));
            }
            now = Solid::new(sheet, progress)?;
        }
        let left = move_apart(sheet, (now, &starts), progress)?;
        if left.n_pairs < solid.n_pairs && worse_than(sheet, 0.0).len() <= n_inverted {
            solid = left;
        } else {
            sheet.lift_all(&before);
        }
    }
    Ok([n_before, solid.n_pairs])
}

/// How many pairs of triangles of some faces cross.
pub(super) fn n_crossing(mesh: &PolygonMesh, progress: &Progress) -> Result<usize, Cancelled> {
    let at = |v| mesh.position(v);
    let triangles = mesh.faces().flat_map(|face| cut(&Face::new(face), at));
    let triangles: Vec<_> = triangles.collect();
    let flat: Vec<_> = triangles.iter().map(|t| t.map(at)).collect();
    let tree = Bvh::build(&flat, progress)?;
    Ok(crossing_pairs(&tree, &triangles, at, progress)?.len())
}

/// Moves corners of faces that cross, round by round, and keeps the best round.
fn move_apart(
    sheet: &mut Sheet,
    (mut solid, starts): (Solid, &VertexMap<DVec3>),
    progress: &Progress,
) -> Result<Solid, Cancelled> {
    let edge = sheet.mean_edge();
    let mut best = (solid.clone(), sheet.positions());
    let mut n_vain = 0;
    for _ in 0..N_ROUNDS {
        if solid.n_pairs == 0 || n_vain == PATIENCE {
            break;
        }
        for v in corners(sheet, &solid.crossing) {
            progress.check()?;
            if !sheet.is_pinned(v) {
                solid.around(sheet, v, edge).step(sheet, starts[v]);
            }
        }
        solid = Solid::new(sheet, progress)?;
        n_vain += 1;
        if solid.n_pairs < best.0.n_pairs {
            best = (solid.clone(), sheet.positions());
            n_vain = 0;
        }
    }
    sheet.lift_all(&best.1);
    Ok(best.0)
}

/// The triangles in space, and what crosses there.
#[derive(Clone)]
struct Solid {
    tree: Bvh,
    /// The face that each triangle is of.
    faces: Vec<FaceId>,
    /// The faces that cross others, each once.
    crossing: Vec<FaceId>,
    n_pairs: usize,
}

impl Solid {
    fn new(sheet: &Sheet, progress: &Progress) -> Result<Self, Cancelled> {
        let at = |v| sheet.position(v);
        let (mut triangles, mut faces) = (Vec::new(), Vec::new());
        for (id, face) in sheet.faces().iter_ids() {
            for triangle in cut(face, at) {
                triangles.push(triangle);
                faces.push(id);
            }
        }
        let flat: Vec<_> = triangles.iter().map(|t| t.map(at)).collect();
        let tree = Bvh::build(&flat, progress)?;
        let pairs = crossing_pairs(&tree, &triangles, at, progress)?;
        let involved = pairs.iter().flatten().map(|&i| faces[i as usize]);
        let mut crossing: Vec<_> = involved.collect();
        crossing.sort_unstable();
        crossing.dedup();
        Ok(Self {
            tree,
            faces,
            crossing,
            n_pairs: pairs.len(),
        })
    }

    /// What a vertex may come to cross.
    fn around(&self, sheet: &Sheet, v: VertexId, edge: f64) -> Around {
        let mut near = Vec::new();
        let reach = DVec3::splat(REACHES[0] * edge);
        for &face in sheet.ring(v) {
            let corners = sheet.faces()[face].corners().iter();
            let [low, high] = bounds(&corners.map(|&v| sheet.position(v)).collect::<Vec<_>>());
            self.tree
                .visit_overlaps(low - reach, high + reach, |triangle| {
                    near.push(self.faces[triangle.index()]);
                });
        }
        near.sort_unstable();
        near.dedup();
        let ring = sheet.ring(v);
        let others = near.into_iter().filter(|face| !ring.contains(face));
        let at = |v| sheet.position(v);
        let others = others.flat_map(|face| cut(&sheet.faces()[face], at));
        let others = others.map(|triangle| (triangle, bounds(&triangle.map(at))));
        Around {
            v,
            edge,
            faces: ring.iter().map(|&face| sheet.faces()[face]).collect(),
            others: others.collect(),
        }
    }
}

/// A vertex, its faces, and the other triangles in reach with their boxes.
struct Around {
    v: VertexId,
    edge: f64,
    faces: Vec<Face>,
    others: Vec<([VertexId; 3], [DVec3; 2])>,
}

impl Around {
    /// Moves the vertex to the best place around it.
    fn step(&self, sheet: &mut Sheet, start: DVec3) {
        let now = *sheet.point(self.v);
        let guarded = sheet.worst_quality(self.v, &now).min(GUARDED_QUALITY);
        let crossed = self.crossed(sheet, now.position);
        if crossed == 0.0 {
            return;
        }
        let cost = |crossed: f64, there: &Point| {
            let way = there.position.distance_squared(start) / (self.edge * self.edge);
            crossed + sheet.badness(self.v, there, ENOUGH) + COST * way
        };
        let mut best = (cost(crossed, &now), now.position);
        for position in places_around(&now, self.edge) {
            let there = Point { position, ..now };
            let is_far = position.distance(start) > MOST_WAY * self.edge;
            if is_far || sheet.worst_quality(self.v, &there) < guarded {
                continue;
            }
            let cost = cost(self.crossed(sheet, position), &there);
            if cost < best.0 {
                best = (cost, position);
            }
        }
        sheet.lift(self.v, best.1);
    }

    /// How much the vertex's faces cross others, and each other, with the vertex elsewhere.
    fn crossed(&self, sheet: &Sheet, position: DVec3) -> f64 {
        let at = |w| {
            if w == self.v {
                position
            } else {
                sheet.position(w)
            }
        };
        let own = self.faces.iter().flat_map(|face| cut(face, at));
        let own: Vec<_> = own
            .map(|triangle| (triangle, bounds(&triangle.map(at))))
            .collect();
        let mut sum = 0.0;
        for (i, (triangle, [low, high])) in own.iter().enumerate() {
            for (other, [from, to]) in self.others.iter().chain(&own[i + 1..]) {
                if low.cmple(*to).all() && from.cmple(*high).all() {
                    let depths = depths([*triangle, *other], at);
                    sum += depths
                        .map(|depth| THROUGH[0] + THROUGH[1] * depth / self.edge)
                        .sum::<f64>();
                }
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::vertex_normals;
    use crate::mesh::TriangleMesh;
    use crate::shapes;
    use crate::sphere::quad_sphere;
    use crate::sphere_map::SphereMap;

    /// A ball flattened to a share of its height.
    fn flat(height: f64) -> SphereMap {
        let ball = shapes::sphere(12);
        let sphere = ball.positions().iter().copied().collect();
        let flat = ball.positions().iter();
        let flat = flat.map(|&p| DVec3::new(p.x, p.y, height * p.z));
        let mesh = TriangleMesh::new(flat.collect(), ball.faces().to_vec());
        SphereMap::prove(mesh.unwrap(), sphere).unwrap()
    }

    /// The sheet of quads on it, with every so many vertices pushed through to the other side.
    fn pushed(map: &SphereMap, every: usize) -> Sheet<'_> {
        let mut sheet = Sheet::new(map, vertex_normals(map.mesh()), &quad_sphere([12; 3]));
        for v in sheet.vertex_ids().step_by(every) {
            let p = sheet.position(v);
            sheet.lift(v, DVec3::new(p.x, p.y, -2.0 * p.z));
        }
        sheet
    }

    fn n_crossing(sheet: &Sheet) -> usize {
        Solid::new(sheet, &Progress::none()).unwrap().n_pairs
    }

    #[test]
    fn what_crosses_is_moved_apart_and_the_rest_stays() {
        let map = flat(0.05);
        let mut sheet = pushed(&map, 211);
        let before = sheet.positions();
        let [n_before, n_inverted] = [n_crossing(&sheet), worse_than(&sheet, 0.0).len()];
        assert!(n_before > 5, "{n_before}");
        let counts = separate(&mut sheet, &Progress::none()).unwrap();
        assert_eq!(counts, [n_before, 0]);
        assert_eq!(n_crossing(&sheet), 0);
        assert!(worse_than(&sheet, 0.0).len() <= n_inverted);
        let edge = sheet.mean_edge();
        let ways = sheet
            .vertex_ids()
            .map(|v| sheet.position(v).distance(before[v]));
        let ways: Vec<f64> = ways.collect();
        assert!(ways.iter().all(|way| *way < edge));
        assert!(ways.iter().filter(|way| **way == 0.0).count() > ways.len() / 2);
        assert_eq!(separate(&mut sheet, &Progress::none()).unwrap(), [0, 0]);
    }

    #[test]
    fn pinned_vertices_stay_and_hopeless_sheets_are_left_alone() {
        let map = flat(0.05);
        let mut sheet = pushed(&map, 211);
        for v in sheet.vertex_ids() {
            sheet.pin(v);
        }
        let before = sheet.positions();
        let [n_before, n_left] = separate(&mut sheet, &Progress::none()).unwrap();
        assert_eq!(n_before, n_left);
        assert_eq!(sheet.positions(), before);
        let mut sheet = pushed(&map, 3);
        let before = sheet.positions();
        let [n_before, n_left] = separate(&mut sheet, &Progress::none()).unwrap();
        assert!(n_before == n_left && n_before > sheet.faces().len() / FACES_PER_PAIR);
        assert_eq!(sheet.positions(), before);
    }
}
