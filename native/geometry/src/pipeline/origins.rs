//! What of the input every element of the result comes from.

use super::Input;
use super::frame::Prepared;
use super::marks::Marks;
use crate::mesh::{FaceId, PolygonMesh};
use crate::nearest::{Bvh, Closest};
use crate::progress::{Cancelled, Progress};
use crate::transfer;

/// Places between two looks at the progress: some milliseconds of work.
const CHUNK: usize = 8192;

/// Three corners of one face of the input, and their shares.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Origin {
    /// The corners, as the input's array of corners counts them.
    pub corners: [u32; 3],
    /// Not negative; they sum to 1.
    pub weights: [f64; 3],
}

impl Origin {
    /// A corner of the input itself.
    pub(super) fn of(corner: u32) -> Self {
        Self {
            corners: [corner; 3],
            weights: [1.0, 0.0, 0.0],
        }
    }
}

/// What data of the input goes where: values mixed by the weights of an origin.
#[derive(Clone, PartialEq, Debug)]
pub struct Origins {
    /// Of every vertex of the result.
    pub vertices: Vec<Origin>,
    /// For each set of cuts those of every corner of every face; those of one face lie on one side
    /// of the cuts.
    pub corners: Vec<Vec<Origin>>,
    /// The face of the input under every face.
    pub faces: Vec<FaceId>,
}

/// Finds the origins of all elements of a result.
pub fn origins(
    input: &Input<'_>,
    (prepared, tree): (&Prepared, &Bvh),
    result: &PolygonMesh,
    progress: &Progress<'_>,
) -> Result<Option<Origins>, Cancelled> {
    let Some(cuts) = input.cuts else {
        return Ok(None);
    };
    let mut sets = Vec::with_capacity(cuts.len());
    for set in cuts {
        progress.check()?;
        sets.push(Marks::new((input.mesh, set), &prepared.frame).on(&prepared.mesh));
    }
    let old = (&prepared.mesh, tree);
    let places = transfer::places(old, &sets, result, progress)?;
    let origin = |place: &Closest| Origin {
        corners: [0, 1, 2].map(|i| prepared.input_corner(input.mesh, place.face, i)),
        weights: place.weights,
    };
    let origins = |places: &Vec<Closest>| {
        let mut origins = Vec::with_capacity(places.len());
        for chunk in places.chunks(CHUNK) {
            progress.check()?;
            origins.extend(chunk.iter().map(origin));
        }
        Ok(origins)
    };
    Ok(Some(Origins {
        vertices: origins(&places.vertices)?,
        corners: places
            .corners
            .iter()
            .map(origins)
            .collect::<Result<_, _>>()?,
        faces: places
            .faces
            .iter()
            .map(|&f| prepared.input_face(f))
            .collect(),
    }))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::mesh::Id;
    use crate::shapes;

    #[test]
    fn every_element_of_a_cleaned_mesh_comes_from_itself() {
        // Quads, of which no two share a vertex.
        let mesh = shapes::cuboid(3);
        let quads = (0..mesh.n_faces()).step_by(2).flat_map(|i| {
            let [a, b] = [i, i + 1].map(|f| mesh.triangle(FaceId::from_index(f)));
            let apart = |p: &DVec3| b.iter().all(|q| q != p);
            let tip = a.iter().position(apart).expect("two triangles differ");
            let other = b.iter().find(|q| a.iter().all(|p| p != *q));
            let other = *other.expect("two triangles differ");
            [a[tip], a[(tip + 1) % 3], other, a[(tip + 2) % 3]]
        });
        let positions: Vec<DVec3> = quads.collect();
        let faces: Vec<[u32; 4]> = (0..positions.len() as u32 / 4)
            .map(|f| [4 * f, 4 * f + 1, 4 * f + 2, 4 * f + 3])
            .collect();
        let soup = PolygonMesh::from_faces(positions, &faces).unwrap();
        let prepared = Prepared::new(&soup, &Progress::none()).unwrap();
        let input = Input {
            cuts: Some(&[Vec::new()]),
            ..Input::new(&soup)
        };
        let inside = soup.with_positions(prepared.frame.enter(soup.positions()));
        let tree = Bvh::of_mesh(&prepared.mesh);
        let found = origins(&input, (&prepared, &tree), &inside, &Progress::none());
        let found = found.unwrap().expect("cuts are given");
        assert_eq!(found.faces, soup.face_ids().collect::<Vec<_>>());
        for (i, origin) in found.corners[0].iter().enumerate() {
            let shares = origin.corners.iter().zip(origin.weights);
            let place = shares.map(|(&c, share)| soup.position(soup.corners()[c as usize]) * share);
            let wanted = soup.position(soup.corners()[i]);
            assert!(place.sum::<DVec3>().distance(wanted) < 1e-9, "corner {i}");
            assert!(
                origin.corners.iter().all(|c| c / 4 == i as u32 / 4),
                "corner {i}"
            );
        }
    }
}
