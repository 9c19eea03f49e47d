//! What must hold of surfaces that are closed: what the property tests and the fuzzer try.

use orbflow_geometry::clean::take_apart;
use orbflow_geometry::close::{self, handles};
use orbflow_geometry::measure::topology_of_triangles;
use orbflow_geometry::mesh::{FaceId, TriangleMesh, VertexId};
use orbflow_geometry::progress::Progress;

/// Closes every surface of a damaged mesh in all ways. The first two bytes say how many tubes are led
/// between faces of it first.
pub fn check(bytes: &[u8]) {
    let Some((&[n, step], rest)) = bytes.split_first_chunk() else {
        return;
    };
    let Some(mesh) = super::edits::damaged(rest) else {
        return;
    };
    let quiet = Progress::none();
    let Ok(apart) = take_apart(&mesh, None, &quiet) else {
        return;
    };
    let parts = apart.mesh.components(&quiet).expect("nobody cancels");
    for part in parts {
        if let Some(bridged) = bridged(&part, usize::from(n % 8), usize::from(step)) {
            closes(&bridged);
        }
        closes(&part);
    }
}

fn closes(part: &TriangleMesh) {
    let quiet = Progress::none();
    let shape = topology_of_triangles(part);
    let genus = shape.genus.expect("a surface has a genus");
    let cut = handles::cut(part, &quiet).expect("one surface can be cut");
    let whole = topology_of_triangles(&cut.mesh);
    assert_eq!((whole.genus, whole.n_components), (Some(0), 1));
    assert_eq!(whole.n_borders, shape.n_borders + 2 * genus as usize);
    let closed = close::close(&cut.mesh, &close::Settings::default(), &quiet);
    let closed = topology_of_triangles(&closed.expect("it has no handles").mesh);
    assert!(closed.closed && closed.genus == Some(0));
    let filled = close::fill(part, |_| true, &quiet).expect("any border can be filled");
    let filled = topology_of_triangles(&filled.mesh);
    assert_eq!((filled.closed, filled.genus), (true, Some(genus)));
    for size in [0.3, 3.0] {
        let sealed = handles::seal(part, handles::Limits::same(size), &quiet)
            .expect("one surface can be sealed");
        let left = topology_of_triangles(&sealed.mesh);
        assert_eq!(left.n_borders, shape.n_borders);
        assert_eq!(left.n_components, 1);
        assert_eq!(left.genus, Some(genus - sealed.n_sealed as i64));
    }
}

/// A surface with tubes between faces that do not touch; none where that is no surface.
fn bridged(part: &TriangleMesh, n: usize, step: usize) -> Option<TriangleMesh> {
    let mut is_near = vec![false; part.n_vertices()];
    let mut chosen: Vec<FaceId> = Vec::new();
    let faces: Vec<FaceId> = part.face_ids().collect();
    for i in 0..faces.len() {
        let face = faces[(i * (step + 1) + step) % faces.len()];
        let corners = part.face(face);
        let is_free = |v: &VertexId| !is_near[v.0 as usize] && !part.is_border(*v);
        if chosen.len() < 2 * n && !chosen.contains(&face) && corners.iter().all(is_free) {
            for v in corners {
                is_near[v.0 as usize] = true;
                part.neighbours(v)
                    .for_each(|w| is_near[w.0 as usize] = true);
            }
            chosen.push(face);
        }
    }
    if chosen.len() < 2 {
        return None;
    }
    chosen.truncate(chosen.len() / 2 * 2);
    let left = faces.iter().filter(|face| !chosen.contains(face));
    let mut all: Vec<[VertexId; 3]> = left.map(|&face| part.face(face)).collect();
    for pair in chosen.chunks(2) {
        let [[a, b, c], [p, q, r]] = [pair[0], pair[1]].map(|face| part.face(face));
        for [a, b, c, d] in [[a, b, r, p], [b, c, q, r], [c, a, p, q]] {
            all.extend([[a, b, c], [a, c, d]]);
        }
    }
    TriangleMesh::new(part.positions().to_vec(), all).ok()
}
