//! What lies on kept faces comes with them.

use glam::DVec3;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::mesh::{Id, PolygonMesh, VertexId};
use orbflow_geometry::pipeline::{self, Input, Origins, Remeshed};
use orbflow_geometry::progress::Progress;

use super::mixed::{Mixed, cube, sphere};
use super::stays;

/// How many corners and vertices the two faces beside the box have.
const N_CORNERS: usize = 7;
const N_VERTICES: usize = 5;

/// A quad and a triangle, then a box.
fn mesh() -> PolygonMesh {
    let mut mixed = Mixed::default();
    let quads: [&[u32]; 2] = [&[0, 1, 2, 3], &[3, 2, 4]];
    let points = [
        [2., 0., 0.],
        [2., 1., 0.],
        [2., 1., 1.],
        [2., 0., 1.],
        [2., 0.5, 2.],
    ];
    mixed.add_faces(&points, &quads);
    mixed.add(&cube(3), DVec3::ZERO, 1.0);
    mixed.mesh()
}

#[test]
fn what_lies_on_kept_faces_comes_with_them() {
    let mesh = mesh();
    let materials: Vec<i32> = (0..mesh.n_faces() as i32).map(|i| i - 7).collect();
    // An edge between corners that are not neighbours is none, and lies on no face.
    let carried = [[5, 6], [2, 3], [0, 2], [4, 2]].map(|ends: [u32; 2]| ends.map(VertexId));
    let input = Input {
        materials: Some(&materials),
        carried: &carried,
        cuts: Some(&[Vec::new()]),
        ..Input::new(&mesh)
    };
    let result = pipeline::remesh(input, &sphere(60), &Solver::default(), &Progress::none());
    let result = result.unwrap();
    stays(&result, &mesh, [0, 1]);
    let n = result.mesh.n_faces();
    let all = result.materials.as_deref();
    assert!(all.is_some_and(|all| all.len() == n && all.ends_with(&[-7, -6])));
    let origins = result.origins.as_ref().unwrap();
    come_from_themselves(&result, origins, &mesh);
    let first = (result.mesh.n_vertices() - N_VERTICES) as u32;
    let named = result.carried.iter().filter(|edge| edge.ends[0].0 >= first);
    let named = named.map(|edge| (edge.from, edge.ends.map(|v| v.0 - first)));
    let mut named: Vec<_> = named.collect();
    named.sort_unstable();
    assert_eq!(named, [(1, [2, 3]), (3, [2, 4])]);
    let told = result.report.carried.unwrap();
    assert_eq!(told.n_edges, result.carried.len());
}

/// Whether the last corners and vertices have those of the input as their only origins.
fn come_from_themselves(result: &Remeshed, origins: &Origins, mesh: &PolygonMesh) {
    let of_faces: Vec<u32> = origins.faces.iter().map(|f| f.0).collect();
    assert!(of_faces.ends_with(&[0, 1]));
    let n_corners = result.mesh.corners().len();
    let [corners] = &origins.corners[..] else {
        panic!("{} sets of cuts", origins.corners.len());
    };
    assert_eq!(corners.len(), n_corners);
    assert_eq!(origins.vertices.len(), result.mesh.n_vertices());
    let own = [1.0, 0.0, 0.0].map(f64::to_bits);
    for i in 0..N_CORNERS {
        let at = n_corners - N_CORNERS + i;
        let v = result.mesh.corners()[at];
        assert_eq!(corners[at].corners[0] as usize, i);
        for origin in [corners[at], origins.vertices[v.index()]] {
            assert_eq!(origin.weights.map(f64::to_bits), own);
            let corner = mesh.corners()[origin.corners[0] as usize];
            assert_eq!(mesh.position(corner), result.mesh.position(v));
        }
    }
}
