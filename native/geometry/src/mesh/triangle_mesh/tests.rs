use super::*;

fn ids<const N: usize>(faces: [[u32; 3]; N]) -> Vec<[VertexId; 3]> {
    faces.into_iter().map(|f| f.map(VertexId)).collect()
}

fn points(n: usize) -> Vec<DVec3> {
    (0..n)
        .map(|i| DVec3::new(i as f64, (i * i) as f64, (i % 2) as f64))
        .collect()
}

fn tetrahedron() -> TriangleMesh {
    let faces = ids([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    TriangleMesh::new(points(4), faces).unwrap()
}

#[test]
fn a_tetrahedron_is_closed_and_every_ring_has_three_neighbours() {
    let mesh = tetrahedron();
    assert!(mesh.is_closed() && mesh.border_loops().is_empty());
    assert_eq!((mesh.euler_number(), mesh.face_components().1), (2, 1));
    for v in mesh.vertex_ids() {
        let ring: Vec<_> = mesh.neighbours(v).collect();
        assert_eq!(ring.len(), 3);
        for h in mesh.outgoing(v) {
            assert_eq!(mesh.origin(h), v);
            assert_eq!(mesh.twin(mesh.twin(h).unwrap()), Some(h));
        }
    }
}

#[test]
fn consecutive_neighbours_are_the_faces_at_the_vertex_counter_clockwise() {
    let mesh = tetrahedron();
    let ring: Vec<_> = mesh.neighbours(VertexId(0)).collect();
    for i in 0..3 {
        let wanted = [VertexId(0), ring[i], ring[(i + 1) % 3]];
        let found = mesh
            .faces()
            .iter()
            .any(|f| (0..3).any(|k| [f[k], f[(k + 1) % 3], f[(k + 2) % 3]] == wanted));
        assert!(found, "{wanted:?}");
    }
}

#[test]
fn a_border_ring_starts_and_ends_on_the_border() {
    let mesh = TriangleMesh::new(points(4), ids([[0, 1, 2], [0, 2, 3]])).unwrap();
    let ring: Vec<_> = mesh.neighbours(VertexId(0)).collect();
    assert_eq!(ring, [1, 2, 3].map(VertexId));
    assert_eq!(mesh.valence(VertexId(0)), 3);
    assert_eq!(mesh.border_loops().len(), 1);
    assert_eq!(mesh.border_loops()[0].len(), 4);
    assert_eq!(mesh.euler_number(), 1);
}

#[test]
fn broken_meshes_are_refused_with_numbers() {
    let message = |n, faces| TriangleMesh::new(points(n), faces).unwrap_err().to_string();
    assert_eq!(
        message(5, ids([[0, 1, 2], [1, 0, 3], [0, 1, 4]])),
        "3 faces meet at the edge between vertices 0 and 1; at most 2 can"
    );
    assert_eq!(
        message(4, ids([[0, 1, 2], [0, 1, 3]])),
        "two faces run through the edge between vertices 0 and 1 in the same direction"
    );
    assert_eq!(
        message(5, ids([[0, 1, 2], [0, 3, 4]])),
        "the faces at vertex 0 form more than one fan"
    );
    assert_eq!(message(4, ids([[0, 1, 2]])), "vertex 3 has no face");
    assert_eq!(message(3, ids([[0, 1, 1]])), "face 0 has vertex 1 twice");
    assert_eq!(
        message(3, ids([[0, 1, 5]])),
        "face 0 names vertex 5, but there are 3 vertices"
    );
}
