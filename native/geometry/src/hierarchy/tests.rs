use glam::DVec3;

use super::*;
use crate::decimate::collapse_to_tetrahedron;
use crate::progress::Progress;
use crate::shapes;

/// A tetrahedron 0 1 2 3 whose face (1, 2, 3) is split by vertex 4.
fn split_tetrahedron() -> (TriangleMesh, [[VertexId; 3]; 4]) {
    let ids = |f: [u32; 3]| f.map(VertexId);
    let points = vec![DVec3::NEG_Z, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let split = [
        [0, 2, 1],
        [0, 1, 3],
        [2, 0, 3],
        [4, 1, 2],
        [4, 2, 3],
        [4, 3, 1],
    ];
    let base = [[0, 2, 1], [0, 1, 3], [2, 0, 3], [1, 2, 3]];
    (
        TriangleMesh::new(points, split.map(ids).to_vec()).unwrap(),
        base.map(ids),
    )
}

#[test]
fn an_undone_collapse_gives_the_mesh_back() {
    let (mesh, base) = split_tetrahedron();
    let mut builder = HierarchyBuilder::new();
    builder.push(VertexId(4), &[1, 2, 3].map(VertexId));
    builder.end_round();
    let hierarchy = builder.build(mesh, base).unwrap();
    assert_eq!(hierarchy.check(), Ok(()));
    assert_eq!((hierarchy.n_rounds(), hierarchy.round(0)), (1, 0..1));
    assert_eq!(hierarchy.faces_at(4).unwrap(), base);
    assert_eq!(hierarchy.coarse_to_fine(), [0, 2, 1, 3, 4].map(VertexId));
}

#[test]
fn a_ring_in_the_wrong_direction_is_refused() {
    let (mesh, base) = split_tetrahedron();
    let mut builder = HierarchyBuilder::new();
    builder.push(VertexId(4), &[1, 3, 2].map(VertexId));
    let error = builder.build_checked(mesh, base).unwrap_err();
    assert!(
        matches!(error, HierarchyError::RingMissing { index: 0, .. }),
        "{error}"
    );
}

/// The records of a hierarchy, to be spoilt.
fn records(of: &CollapseHierarchy) -> HierarchyBuilder {
    let mut records = HierarchyBuilder::new();
    for round in 0..of.n_rounds() {
        for index in of.round(round) {
            let Collapse { vertex, ring } = of.collapse(index);
            records.push(vertex, ring);
        }
        records.end_round();
    }
    records
}

#[test]
fn records_of_a_hierarchy_are_taken_and_spoilt_ones_refused() {
    let hierarchy = collapse_to_tetrahedron(shapes::blob(2, 4), &Progress::none()).unwrap();
    let (mesh, base) = (hierarchy.mesh.clone(), hierarchy.base);
    let built = |records: HierarchyBuilder| records.build_checked(mesh.clone(), base);
    let again = built(records(&hierarchy)).unwrap();
    assert_eq!(again.rings, hierarchy.rings);
    assert_eq!(again.rounds, hierarchy.rounds);

    let mut far = records(&hierarchy);
    far.rings[5] = VertexId(1 << 30);
    assert!(matches!(
        built(far),
        Err(HierarchyError::NoSuchCollapse { index: 0 | 1, .. })
    ));
    let mut one_round = records(&hierarchy);
    one_round.rounds = vec![0];
    assert!(matches!(
        built(one_round),
        Err(HierarchyError::Dependent { .. })
    ));
    let flat = records(&hierarchy).build_checked(mesh.clone(), [base[0]; 4]);
    assert!(matches!(
        flat,
        Err(HierarchyError::NoTetrahedron { n_corners: 3 })
    ));
    let mut short = records(&hierarchy);
    short.starts = vec![0; short.starts.len()];
    let refused = built(short).unwrap_err().to_string();
    assert!(refused.contains("a ring of 0"), "{refused}");
}
