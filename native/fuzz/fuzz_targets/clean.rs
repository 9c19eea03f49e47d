//! Any polygons over points of a small grid become a manifold mesh or an error; a second cleaning
//! finds nothing to mend, and what has no handles can be closed.
#![no_main]

use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use orbflow_geometry::clean::{Report, clean};
use orbflow_geometry::close::{self, Way, close};
use orbflow_geometry::mesh::{Id, PolygonMesh, TriangleMesh};
use orbflow_geometry::progress::Progress;

fuzz_target!(|bytes: &[u8]| {
    let Some(mesh) = mesh_of(bytes) else {
        return;
    };
    let Ok(cleaned) = clean(&mesh, &Progress::none()) else {
        return;
    };
    assert_eq!(cleaned.mesh.check(), Ok(()));
    assert_eq!(cleaned.source.len(), cleaned.mesh.n_faces());
    assert!(
        cleaned
            .source
            .as_slice()
            .iter()
            .all(|face| face.index() < mesh.n_faces())
    );
    close_all(&cleaned.mesh);
    let faces: Vec<_> = cleaned
        .mesh
        .faces()
        .iter()
        .map(|f| f.map(|v| v.0))
        .collect();
    let again = PolygonMesh::from_faces(cleaned.mesh.positions().to_vec(), &faces);
    let again = clean(&again.expect("a clean mesh is a mesh"), &Progress::none());
    // Parts that touch may be welded anew.
    if cleaned.mesh.is_closed() && all_different(cleaned.mesh.positions()) {
        let again = again.expect("a closed manifold mesh needs no mending");
        assert_eq!(again.mesh, cleaned.mesh);
        assert_eq!(again.report, Report::default());
    }
});

fn close_all(mesh: &TriangleMesh) {
    let quiet = Progress::none();
    for part in mesh.components(&quiet).expect("nobody cancels") {
        for way in [Way::Measured, Way::Cap, Way::Double] {
            let settings = close::Settings {
                way,
                ..close::Settings::default()
            };
            match close(&part, &settings, &quiet) {
                Ok(closed) => {
                    assert!(closed.mesh.is_closed());
                    assert_eq!(closed.mesh.euler_number(), 2);
                    assert_eq!(&closed.mesh.faces()[..part.n_faces()], part.faces());
                }
                Err(error) => assert!(matches!(error, close::Error::Handles { .. }), "{error}"),
            }
        }
    }
}

fn all_different(points: &[DVec3]) -> bool {
    let mut sorted: Vec<_> = points
        .iter()
        .map(|p| p.to_array().map(|x| (x + 0.0).to_bits()))
        .collect();
    sorted.sort_unstable();
    sorted.windows(2).all(|pair| pair[0] != pair[1])
}

/// A byte for the number of points, a byte for each (two bits a coordinate, two that scale), then
/// a byte for each corner; its high bit ends a face.
fn mesh_of(bytes: &[u8]) -> Option<PolygonMesh> {
    let (&n, bytes) = bytes.split_first()?;
    let n = usize::from(n % 32);
    let (points, corners) = bytes.split_at_checked(n)?;
    let point = |&byte: &u8| {
        let at = |shift: u8| f64::from(byte >> shift & 3);
        DVec3::new(at(0), at(2), at(4)) * [1.0, 1.0, -1.0, 1e-300][usize::from(byte >> 6)]
    };
    let mut faces = vec![Vec::new()];
    for byte in corners.iter().take(400) {
        if let Some(face) = faces.last_mut() {
            face.push(u32::from(byte & 31));
        }
        if byte & 128 != 0 {
            faces.push(Vec::new());
        }
    }
    faces.retain(|face| face.len() >= 3);
    PolygonMesh::from_faces(points.iter().map(point).collect(), &faces).ok()
}
