//! Splits a mesh into parts that one sphere can cover, and shares the faces among them.
//!
//! Today a part is a closed component of genus 0; a mesh with a border or with handles is refused
//! with its numbers. Filling borders and cutting handles (METHOD 3) belong here: they turn such a
//! mesh into closed parts of genus 0 with tagged faces, which `join` takes out again.

use super::Error;
use crate::measure;
use crate::mesh::TriangleMesh;
use crate::progress::Progress;

/// The components of a mesh, closed and of genus 0, in the order of their first faces.
pub fn split(whole: &TriangleMesh, progress: &Progress<'_>) -> Result<Vec<TriangleMesh>, Error> {
    refuse_borders(whole)?;
    progress.check()?;
    let (_, n) = whole.face_components();
    progress.check()?;
    if n == 1 {
        // Whole, it keeps the numbers of its vertices.
        return Ok(vec![checked(whole.clone(), [1, 1])?]);
    }
    let parts = whole.components(progress)?;
    let numbered = parts.into_iter().enumerate();
    numbered
        .map(|(index, part)| checked(part, [index + 1, n]))
        .collect()
}

/// A part, if it has no handles.
fn checked(mesh: TriangleMesh, [part, n_parts]: [usize; 2]) -> Result<TriangleMesh, Error> {
    match (2 - mesh.euler_number()) / 2 {
        0 => Ok(mesh),
        genus => Err(Error::Genus {
            genus,
            part,
            n_parts,
        }),
    }
}

fn refuse_borders(whole: &TriangleMesh) -> Result<(), Error> {
    let loops = whole.border_loops();
    if loops.is_empty() {
        return Ok(());
    }
    Err(Error::Open {
        n_loops: loops.len(),
        n_edges: loops.iter().map(Vec::len).sum(),
    })
}

/// Shares `n_faces` among parts by their weights; each gets at least `least`.
///
/// The largest remainders are rounded up, so the shares sum to `n_faces` unless the least shares
/// alone exceed it.
pub fn share(weights: &[f64], n_faces: usize, least: usize) -> Vec<usize> {
    let mut shares = vec![least; weights.len()];
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|&a, &b| weights[a].total_cmp(&weights[b]));
    // From small to large: who would get less than the least leaves more to share for the others.
    let mut left = n_faces;
    let mut total: f64 = weights.iter().sum();
    for (rank, &i) in order.iter().enumerate() {
        let wanted = if total > 0.0 {
            left as f64 * weights[i] / total
        } else {
            0.0
        };
        let last = rank + 1 == order.len();
        let share = if last { left } else { wanted.round() as usize };
        shares[i] = share.max(least);
        left = left.saturating_sub(shares[i]);
        total -= weights[i];
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::VertexId;
    use crate::shapes;

    fn joined(meshes: &[TriangleMesh]) -> TriangleMesh {
        let mut positions = Vec::new();
        let mut faces = Vec::new();
        for mesh in meshes {
            let start = positions.len() as u32;
            positions.extend_from_slice(mesh.positions());
            faces.extend(
                mesh.faces()
                    .iter()
                    .map(|f| f.map(|v| VertexId(v.0 + start))),
            );
        }
        TriangleMesh::new(positions, faces).unwrap()
    }

    #[test]
    fn one_closed_part_is_split_into_itself() {
        let mesh = shapes::blob(3, 4);
        let parts = split(&mesh, &Progress::none()).unwrap();
        assert_eq!(parts.len(), 1);
        assert_eq!(parts[0], mesh);
    }

    #[test]
    fn components_keep_their_faces_in_order() {
        let whole = joined(&[shapes::cuboid(2), shapes::sphere(3)]);
        let parts = split(&whole, &Progress::none()).unwrap();
        assert_eq!(
            parts.iter().map(TriangleMesh::n_faces).collect::<Vec<_>>(),
            [48, 108]
        );
        let triangles = parts
            .iter()
            .flat_map(|p| p.face_ids().map(|face| p.triangle(face)));
        for (face, triangle) in whole.face_ids().zip(triangles) {
            assert_eq!(triangle, whole.triangle(face));
        }
    }

    #[test]
    fn an_open_mesh_is_refused_with_its_borders_counted() {
        let mut faces = shapes::sphere(3).faces().to_vec();
        faces.pop();
        let mesh = TriangleMesh::new(shapes::sphere(3).positions().to_vec(), faces).unwrap();
        let message = split(&mesh, &Progress::none()).unwrap_err().to_string();
        assert!(
            message.starts_with("1 border loop, 3 border edges: "),
            "{message}"
        );
    }

    #[test]
    fn shares_follow_the_weights_sum_up_and_keep_the_least() {
        assert_eq!(share(&[1.0, 3.0], 100, 4), [25, 75]);
        assert_eq!(share(&[1.0, 1e-9, 1.0], 100, 4).iter().sum::<usize>(), 100);
        assert_eq!(share(&[1.0, 1e-9], 100, 4), [96, 4]);
        assert_eq!(share(&[1.0; 3], 5, 4), [4, 4, 4]);
        assert_eq!(share(&[0.0; 2], 10, 4).iter().sum::<usize>(), 10);
    }
}
