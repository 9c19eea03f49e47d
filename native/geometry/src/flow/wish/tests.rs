use super::*;
use crate::flow::field::{Settings, orient};
use crate::flow::singularities::tidy;
use crate::measure::total_area;
use crate::shapes;

fn tidy_wish(mesh: &TriangleMesh, n_quads: f64) -> (OrientationField, HalfedgeMap<DVec2>) {
    let sizes = FaceMap::filled(mesh.n_faces(), (total_area(mesh) / n_quads).sqrt());
    let mut field = orient(mesh, &Settings::default(), &Progress::none()).unwrap();
    tidy(mesh, &mut field, &sizes);
    let vectors = wish(mesh, &field, &sizes, &Progress::none()).unwrap();
    (field, vectors)
}

#[test]
fn faces_close_and_twins_are_quarter_turns_of_each_other() {
    for (name, mesh) in shapes::closed(12) {
        let (field, vectors) = tidy_wish(&mesh, 300.0);
        for h in mesh.halfedge_ids() {
            let sum = vectors[h] + vectors[h.next()] + vectors[h.prev()];
            assert!(sum.length() < 1e-12, "{name} {sum}");
            let twin = mesh.twin(h).unwrap();
            let across = -vectors[h].turned(field.turns[h]);
            assert!(vectors[twin].distance(across) < 1e-12, "{name}");
        }
    }
}

#[test]
fn the_wish_follows_the_field_at_the_wanted_size() {
    for (name, mesh) in shapes::closed(12) {
        let h = (total_area(&mesh) / 300.0).sqrt();
        let (field, vectors) = tidy_wish(&mesh, 300.0);
        let charts = Charts::new(&mesh);
        let arms = arms(&mesh, &field);
        let [mut misfit, mut size] = [0.0; 2];
        for halfedge in mesh.halfedge_ids() {
            let arm = arms[halfedge.face()];
            let wanted = DVec2::new(arm.x, -arm.y).rotate(charts.edge(halfedge) / h);
            misfit += vectors[halfedge].distance_squared(wanted);
            size += wanted.length_squared();
        }
        assert!(misfit < 0.2 * size, "{name} {}", misfit / size);
    }
}
