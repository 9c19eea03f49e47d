//! Lines of boxes and spheres.

use glam::DVec3;

use super::*;
use crate::flow::field::{Settings, orient};
use crate::flow::{self, Flow, Guides, flow};
use crate::measure::{sharp_edges, total_area};
use crate::mesh::FaceMap;
use crate::progress::Progress;
use crate::shapes;
use crate::sphere_map::SphereMap;

const SHARP: f64 = 0.7;

fn field_of(mesh: &TriangleMesh) -> OrientationField {
    orient(mesh, &Settings::default(), &Progress::none()).unwrap()
}

/// Edges whose corners are told by how they turn.
fn all(edges: &HalfedgeMap<bool>) -> Sharp<'_> {
    Sharp { edges, firm: None }
}

#[test]
fn a_box_has_twelve_lines_between_its_corners() {
    let mesh = shapes::cuboid(10);
    let sharp = sharp_edges(&mesh, SHARP);
    let corners = corners(&mesh, all(&sharp));
    assert_eq!(corners.iter().filter(|&&is| is).count(), 8);
    let h = (total_area(&mesh) / 400.0).sqrt();
    let mut field = field_of(&mesh);
    let sizes = FaceMap::filled(mesh.n_faces(), h);
    attract(&mesh, &mut field, all(&sharp), &sizes);
    for v in mesh.vertex_ids() {
        assert_eq!(field.indices[v], i32::from(corners[v]));
    }
    let whole = lines(&mesh, &field, all(&sharp), h);
    assert_eq!(whole.len(), 12);
    assert!(whole.iter().all(|line| line.halfedges.len() == 10));
    // For quads a quarter as long, the longer edges come in pieces.
    let cut = lines(&mesh, &field, all(&sharp), h / 4.0);
    assert!(cut.len() > 12);
    let n_edges: usize = cut.iter().map(|line| line.halfedges.len()).sum();
    assert_eq!(n_edges, 120);
    for line in &cut {
        assert_eq!(mesh.origin(line.halfedges[0]), line.ends[0]);
        assert!(line.halfedges.len() < 10);
    }
}

#[test]
fn closed_lines_come_once_and_round_shapes_have_none() {
    let mesh = shapes::sphere(8);
    let field = field_of(&mesh);
    assert!(lines(&mesh, &field, all(&sharp_edges(&mesh, SHARP)), 0.2).is_empty());
    let on_equator = |v| mesh.position(v).z.abs() < 1e-9;
    let equator = |h| on_equator(mesh.origin(h)) && on_equator(mesh.target(h));
    let sharp = mesh.halfedge_ids().map(equator).collect();
    let lines = chains(&mesh, &field, all(&sharp));
    let singular = |v: &VertexId| on_equator(*v) && field.indices[*v] != 0;
    let n_singular = mesh.vertex_ids().filter(singular).count();
    assert_eq!(lines.len(), n_singular.max(1));
    assert_eq!(lines.iter().map(Vec::len).sum::<usize>(), 32);
    for line in &lines {
        for pair in line.windows(2) {
            assert_eq!(mesh.target(pair[0]), mesh.origin(pair[1]));
        }
    }
}

/// About 400 quads of a shape that is seen from the origin.
fn quads_of(mesh: TriangleMesh) -> Flow {
    let sphere = mesh.positions().iter().map(|p| p.normalize_or(DVec3::Z));
    let sphere = sphere.collect();
    let map = SphereMap::prove(mesh, sphere).unwrap();
    let marked = HalfedgeMap::filled(3 * map.mesh().n_faces(), false);
    let guides = Guides {
        lines: &marked,
        marked: &marked,
        firm: None,
        turned: None,
        drawn: None,
        mirror: None,
    };
    flow(&map, guides, &flow::Settings::new(400), &Progress::none()).unwrap()
}

#[test]
fn a_long_capsule_gets_rings_and_straight_lines_only() {
    let Flow { report, seams, .. } = quads_of(shapes::capsule(6.0, 16));
    assert_eq!((report.n_cones, seams.len()), (8, 0));
    assert!(report.score.spiral < 1e-12, "{:?}", report.score);
    assert!(report.score.loops > 0.8, "{:?}", report.score);
}

#[test]
fn a_box_gets_quads_whose_seams_are_its_edges() {
    let found = quads_of(shapes::cuboid(16));
    assert_eq!(found.report.n_cones, 8);
    assert_eq!(found.report.n_creases, [12, 12]);
    assert_eq!(found.seams.len(), 12);
    // Every corner is the end of three edges, and no strip of quads crosses itself.
    for seam in &found.seams {
        for end in [seam.vertices[0], seam.vertices[seam.vertices.len() - 1]] {
            let valence = found.mesh.faces().filter(|f| f.contains(&end)).count();
            assert_eq!(valence, 3);
        }
    }
    assert!(found.report.score.spiral < 1e-12);
}
