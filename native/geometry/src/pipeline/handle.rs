//! A loop round or through a handle, to show where it is.

use crate::close::handles::short_loop;
use crate::mesh::{Id, TriangleMesh, VertexId};
use crate::progress::Progress;

/// The edges of a short loop in each component that has handles.
pub fn loops(mesh: &TriangleMesh) -> Vec<Vec<[VertexId; 2]>> {
    let components = mesh.named_components(&Progress::none());
    let components = components.expect("nobody cancels").into_iter();
    let found = components.map(|(part, vertices)| {
        let line = short_loop(&part).unwrap_or_default();
        let line = line.into_iter().map(|v| vertices[v.index()]);
        let next = line.clone().cycle().skip(1);
        line.zip(next).map(|(a, b)| [a, b]).collect()
    });
    found.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn a_loop_of_a_torus_closes_and_a_ball_has_none() {
        let torus = shapes::torus(8, 6);
        let found = &loops(&torus)[0];
        assert!((3..=8).contains(&found.len()), "{found:?}");
        for v in found.iter().flatten() {
            assert_eq!(found.iter().flatten().filter(|w| *w == v).count(), 2);
        }
        let ball = shapes::sphere(4);
        assert!(loops(&ball)[0].is_empty());
    }

    #[test]
    fn a_border_is_no_handle() {
        let ball = shapes::sphere(4);
        let some = ball.faces().iter().skip(9).copied();
        let (open, _) = TriangleMesh::of_faces(ball.positions(), some).unwrap();
        assert!(!open.is_closed() && loops(&open)[0].is_empty());
    }
}
