//! Moving a place along the surface.

use glam::DVec3;

use super::{SphereMap, SurfacePoint, weighted};
use crate::mesh::{FaceId, HalfedgeId, VertexId};

/// Moves a place on the surface towards a nearby position in space, by going downhill: from the
/// closest point of a face across the edge or corner that it lies on, as long as that comes nearer.
///
/// The result is a place that no neighbouring face improves on, reached without leaving the
/// surface: it never jumps from one sheet to another that only lies near in space. It is never
/// farther from `target` than `from` is. Cost: the number of faces crossed.
pub fn walk_along(map: &SphereMap, from: SurfacePoint, target: DVec3) -> SurfacePoint {
    let mut best = closest_on_face(map, from.face, target);
    loop {
        let nearer = match best.touched {
            Touched::Inside => return best.place,
            Touched::Edge(i) => {
                let edge = HalfedgeId(best.place.face.0 * 3 + i);
                let face = across(map, edge);
                Some(closest_on_face(map, face, target)).filter(|c| c.is_nearer_than(&best))
            }
            Touched::Corner(i) => {
                let corner = map.mesh().face(best.place.face)[i as usize];
                around(map, corner, target).filter(|c| c.is_nearer_than(&best))
            }
        };
        match nearer {
            Some(nearer) => best = nearer,
            None => return best.place,
        }
    }
}

/// The part of a face that a closest point lies on; edge i leaves corner i.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Touched {
    Inside,
    Edge(u32),
    Corner(u32),
}

struct Closest {
    place: SurfacePoint,
    touched: Touched,
    distance_squared: f64,
}

impl Closest {
    /// Nearer by more than rounding: otherwise two faces could each find the other's side nearer.
    fn is_nearer_than(&self, other: &Self) -> bool {
        self.distance_squared < other.distance_squared * (1.0 - 1e-12)
    }
}

fn across(map: &SphereMap, edge: HalfedgeId) -> FaceId {
    let twin = map.mesh().twin(edge);
    twin.expect("a sphere map has no border").face()
}

/// The closest place on the faces at a vertex.
fn around(map: &SphereMap, vertex: VertexId, target: DVec3) -> Option<Closest> {
    let faces = map.mesh().outgoing(vertex).map(HalfedgeId::face);
    let closest = faces.map(|face| closest_on_face(map, face, target));
    closest.min_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared))
}

/// The closest point of a triangle and the part that it lies on (Ericson 2005, 5.1.5).
fn closest_on_face(map: &SphereMap, face: FaceId, target: DVec3) -> Closest {
    let [a, b, c] = map.mesh().triangle(face);
    let (weights, touched) = closest_weights([b - a, c - a], target - a, target - b, target - c);
    let distance_squared = weighted([a, b, c], weights).distance_squared(target);
    Closest {
        place: SurfacePoint { face, weights },
        touched,
        distance_squared,
    }
}

fn closest_weights([ab, ac]: [DVec3; 2], ap: DVec3, bp: DVec3, cp: DVec3) -> ([f64; 3], Touched) {
    let [d1, d2] = [ab.dot(ap), ac.dot(ap)];
    if d1 <= 0.0 && d2 <= 0.0 {
        return ([1.0, 0.0, 0.0], Touched::Corner(0));
    }
    let [d3, d4] = [ab.dot(bp), ac.dot(bp)];
    if d3 >= 0.0 && d4 <= d3 {
        return ([0.0, 1.0, 0.0], Touched::Corner(1));
    }
    let [d5, d6] = [ab.dot(cp), ac.dot(cp)];
    if d6 >= 0.0 && d5 <= d6 {
        return ([0.0, 0.0, 1.0], Touched::Corner(2));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return ([1.0 - t, t, 0.0], Touched::Edge(0));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return ([1.0 - t, 0.0, t], Touched::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return ([0.0, 1.0 - t, t], Touched::Edge(1));
    }
    let total = va + vb + vc;
    ([va / total, vb / total, vc / total], Touched::Inside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::{cos, sin};
    use crate::mesh::{TriangleMesh, VertexMap};
    use crate::shapes;

    fn ellipsoid() -> SphereMap {
        let round = shapes::sphere(9);
        let sphere = VertexMap::from_vec(round.positions().to_vec());
        let stretched = sphere.iter().map(|&s| s * DVec3::new(1.0, 2.0, 0.3));
        let mesh = TriangleMesh::new(stretched.collect(), round.faces().to_vec()).unwrap();
        SphereMap::prove(mesh, sphere).unwrap()
    }

    fn direction(i: u32) -> DVec3 {
        let t = f64::from(i);
        DVec3::new(sin(t * 0.7), cos(t * 1.3), sin(t * 2.1)).normalize_or(DVec3::X)
    }

    #[test]
    fn a_place_on_a_convex_surface_is_reached() {
        let map = ellipsoid();
        for i in 0..300 {
            let wanted = map.surface_position(map.locate(direction(i)));
            let start = map.locate(direction(i) + 0.4 * direction(i + 7));
            let reached = map.surface_position(walk_along(&map, start, wanted));
            assert!(reached.distance(wanted) < 1e-9, "{i}: {reached} {wanted}");
        }
    }

    #[test]
    fn a_walk_never_goes_away_and_stops_where_it_stands_best() {
        let map = ellipsoid();
        for i in 0..300 {
            let target = 3.0 * direction(i) * direction(i + 1);
            let start = map.locate(direction(i + 2));
            let end = walk_along(&map, start, target);
            let distance = |at| map.surface_position(at).distance(target);
            assert!(distance(end) <= distance(start));
            let again = walk_along(&map, end, target);
            assert!(distance(again) >= distance(end) * (1.0 - 1e-12));
            assert!((end.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_walk_stays_on_its_sheet() {
        let map = ellipsoid();
        // From the top of the flat body, a target just below the bottom stays on top.
        let top = map.locate(DVec3::Z);
        let end = walk_along(&map, top, DVec3::new(0.0, 0.0, -0.35));
        assert!(map.surface_position(end).z > 0.0);
    }
}
