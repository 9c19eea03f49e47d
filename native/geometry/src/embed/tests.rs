use super::partial::Partial;
use super::*;
use crate::elementary::{acos, ln};
use crate::hierarchy::{Collapse, HierarchyBuilder};
use crate::mesh::{TriangleMesh, VertexId};
use crate::shapes;

/// A hierarchy made without regard to shape: short edges first, in rounds.
pub fn hierarchy(mesh: TriangleMesh) -> CollapseHierarchy {
    let mut partial = Partial::whole(
        &mesh,
        VertexMap::filled(mesh.n_vertices(), DVec3::Z),
        &Progress::none(),
    )
    .unwrap();
    let mut builder = HierarchyBuilder::new();
    while partial.n_there() > 4 {
        let mut blocked = VertexMap::filled(mesh.n_vertices(), false);
        let there: Vec<VertexId> = partial.there().map(|(v, _)| v).collect();
        for v in there {
            let length = |&u: &VertexId| mesh.position(u).distance(mesh.position(v));
            let ring = partial.ring(v);
            let legal = ring.iter().copied().filter(|&u| partial.is_legal(v, u));
            let nearest = legal.min_by(|a, b| length(a).total_cmp(&length(b)));
            let Some(u) = nearest.filter(|_| !blocked[v] && ring.len() < 9) else {
                continue;
            };
            let ring = partial.ring_from(v, u);
            builder.push(v, &ring);
            for &r in &ring {
                blocked[r] = true;
            }
            partial.collapse(Collapse {
                vertex: v,
                ring: &ring,
            });
        }
        builder.end_round();
    }
    let left: Vec<VertexId> = partial.there().map(|(v, _)| v).collect();
    let face = |v: VertexId, i: usize| [v, partial.ring(v)[i], partial.ring(v)[(i + 1) % 3]];
    let apex = left[0];
    let [a, b, c] = [0, 1, 2].map(|i| partial.ring(apex)[i]);
    let base = [face(apex, 0), face(apex, 1), face(apex, 2), [c, b, a]];
    builder.build(mesh, base).unwrap()
}

fn embedded(mesh: TriangleMesh) -> Embedded {
    let settings = Settings::default();
    embed(
        &hierarchy(mesh),
        &Solver::default(),
        &settings,
        &Progress::none(),
    )
    .unwrap()
}

#[test]
fn closed_shapes_are_embedded_without_a_fold() {
    for (name, mesh) in shapes::closed(8) {
        let report = embedded(mesh).report;
        assert!(!report.repair.fell_back_to_solver, "{name}");
        assert_eq!((report.n_folds, report.degree), (0, 1), "{name}");
    }
}

#[test]
fn a_sphere_embeds_as_itself_up_to_rotation() {
    let mesh = shapes::sphere(10);
    let Embedded { map, report } = embedded(mesh.clone());
    assert!(report.energy < ln(5.0_f64) + 0.01, "{}", report.energy);
    for face in mesh.face_ids() {
        let [v, w, _] = mesh.face(face);
        let cosine = map.sphere()[v].dot(map.sphere()[w]);
        let wanted = mesh.position(v).dot(mesh.position(w));
        assert!(
            (acos(cosine) - acos(wanted)).abs() < 0.02,
            "{cosine} {wanted}"
        );
    }
}

#[test]
fn an_even_map_keeps_areas_better() {
    let hierarchy = hierarchy(shapes::limbs(2, 8));
    let spread = |map: &SphereMap| {
        let mesh = map.mesh();
        let ratios = mesh.face_ids().map(|f| {
            let [a, b, c] = mesh.triangle(f);
            let [p, q, r] = map.sphere_triangle(f);
            let area = (b - a).cross(c - a).length();
            (area, crate::sphere_map::triple_product(p, q, r) / area)
        });
        let ratios: Vec<(f64, f64)> = ratios.collect();
        let total: f64 = ratios.iter().map(|(area, _)| area).sum();
        let mean = ratios.iter().map(|(area, r)| area * r).sum::<f64>() / total;
        let squares = ratios.iter().map(|(area, r)| area * (r - mean).powi(2));
        (squares.sum::<f64>() / total).sqrt() / mean
    };
    let even = even(&hierarchy, &Progress::none()).unwrap();
    let settings = Settings::default();
    let usual = embed(&hierarchy, &Solver::default(), &settings, &Progress::none()).unwrap();
    let [even, usual] = [spread(&even), spread(&usual.map)];
    assert!(even < 0.5 * usual, "{even} {usual}");
}
