//! Spoiled closed meshes come back from `clean` closed, with the same parts and the same volume.

mod common;

use common as shapes;
use glam::DVec3;
use orbflow_geometry::clean::{Cleaned, Error, clean, take_apart};
use orbflow_geometry::measure;
use orbflow_geometry::mesh::{Id, PolygonMesh, TriangleMesh};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::random::Random;
use proptest::prelude::*;

/// Positions and faces that are being spoiled.
struct Loose {
    positions: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
    random: Random,
}

impl Loose {
    fn of(mesh: &TriangleMesh, seed: u64) -> Self {
        Self {
            positions: mesh.positions().to_vec(),
            faces: mesh
                .faces()
                .iter()
                .map(|f| f.map(|v| v.0).to_vec())
                .collect(),
            random: Random::new(seed),
        }
    }

    fn shuffle_vertices(&mut self) {
        let n = self.positions.len();
        let mut new_id: Vec<u32> = (0..n as u32).collect();
        shuffle(&mut new_id, &mut self.random);
        let mut positions = vec![DVec3::ZERO; n];
        for (old, &new) in new_id.iter().enumerate() {
            positions[new as usize] = self.positions[old];
        }
        self.positions = positions;
        for v in self.faces.iter_mut().flatten() {
            *v = new_id[*v as usize];
        }
    }

    fn shuffle_faces(&mut self) {
        shuffle(&mut self.faces, &mut self.random);
        for face in &mut self.faces {
            let n = face.len();
            face.rotate_left(self.random.below(n));
        }
    }

    /// Some faces get vertices of their own; with a share of 1 the mesh is a soup.
    fn detach(&mut self, share: f64) {
        for v in self.faces.iter_mut().flatten() {
            if self.random.unit() < share {
                self.positions.push(self.positions[*v as usize]);
                *v = self.positions.len() as u32 - 1;
            }
        }
    }

    fn flip(&mut self, share: f64) {
        for face in &mut self.faces {
            if self.random.unit() < share {
                face.reverse();
            }
        }
    }

    fn add_rubbish(&mut self, n: usize) {
        let n_faces = self.faces.len();
        for _ in 0..n {
            self.positions.push(DVec3::splat(self.random.unit()));
            let face = self.faces[self.random.below(n_faces)].clone();
            self.faces.push(vec![face[0], face[0], face[1]]);
            self.faces.push(vec![face[1], face[1], face[1]]);
            self.faces.push(face);
        }
    }

    /// Puts a corner in the middle of some edges, seen from one side only or from both.
    fn split_edges(&mut self, n: usize) {
        for _ in 0..n {
            let i = self.random.below(self.faces.len());
            let (a, b) = (self.faces[i][0], self.faces[i][1]);
            let middle = self.positions[a as usize].midpoint(self.positions[b as usize]);
            self.positions.push(middle);
            let m = self.positions.len() as u32 - 1;
            for face in &mut self.faces {
                let n = face.len();
                let at = (0..n).find(|&k| {
                    let side = (face[k], face[(k + 1) % n]);
                    side == (a, b) || side == (b, a)
                });
                if let Some(k) = at {
                    face.insert(k + 1, m);
                }
            }
        }
    }

    fn clean(&self) -> Cleaned {
        let mesh = PolygonMesh::from_faces(self.positions.clone(), &self.faces);
        let mesh = mesh.expect("the faces name vertices");
        let cleaned = clean(&mesh, &Progress::none()).expect("it can be mended");
        assert_eq!(cleaned.mesh.check(), Ok(()));
        assert_eq!(cleaned.source.len(), cleaned.mesh.n_faces());
        for source in cleaned.source.as_slice() {
            assert!(source.index() < mesh.n_faces());
        }
        cleaned
    }
}

fn shuffle<T>(values: &mut [T], random: &mut Random) {
    for i in (1..values.len()).rev() {
        values.swap(i, random.below(i + 1));
    }
}

fn same_solid(found: &TriangleMesh, wanted: &TriangleMesh) -> Result<(), TestCaseError> {
    prop_assert!(found.is_closed());
    prop_assert_eq!(found.euler_number(), wanted.euler_number());
    let [found, wanted] = [measure::volume(found), measure::volume(wanted)];
    prop_assert!(
        (found - wanted).abs() < 1e-9 * wanted.abs(),
        "{found} {wanted}"
    );
    Ok(())
}

fn closed_mesh() -> impl Strategy<Value = TriangleMesh> {
    (0..5usize, 2..6u32).prop_map(|(i, n)| shapes::closed(n).swap_remove(i).1)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_shuffled_soup_with_flipped_faces_becomes_the_same_solid(
        mesh in closed_mesh(), seed: u64, detached in 0.0..1.5f64, flipped in 0.0..0.35f64,
    ) {
        let mut loose = Loose::of(&mesh, seed);
        loose.shuffle_faces();
        loose.detach(detached);
        loose.flip(flipped);
        loose.shuffle_vertices();
        let cleaned = loose.clean();
        same_solid(&cleaned.mesh, &mesh)?;
        prop_assert_eq!(cleaned.mesh.n_vertices(), mesh.n_vertices());
        prop_assert_eq!(cleaned.report.n_welded, loose.positions.len() - mesh.n_vertices());
    }

    #[test]
    fn rubbish_is_dropped_and_counted(mesh in closed_mesh(), seed: u64, n in 0..9usize) {
        let mut loose = Loose::of(&mesh, seed);
        loose.add_rubbish(n);
        loose.shuffle_faces();
        let cleaned = loose.clean();
        same_solid(&cleaned.mesh, &mesh)?;
        let report = cleaned.report;
        prop_assert_eq!((report.n_degenerate, report.n_isolated), (2 * n, n));
        prop_assert_eq!(report.n_duplicates, n);
    }

    #[test]
    fn polygons_with_corners_on_straight_lines_leave_no_crack(
        mesh in closed_mesh(), seed: u64, n in 0..60usize,
    ) {
        let mut loose = Loose::of(&mesh, seed);
        loose.split_edges(n);
        loose.shuffle_faces();
        same_solid(&loose.clean().mesh, &mesh)?;
    }

    #[test]
    fn the_result_does_not_depend_on_size_and_names(
        mesh in closed_mesh(), seed: u64, exponent in -990..990i32,
    ) {
        let size = 2f64.powi(exponent);
        let mut loose = Loose::of(&mesh, seed);
        loose.split_edges(5);
        let plain = loose.clean().mesh;
        loose.positions.iter_mut().for_each(|p| *p *= size);
        let sized = loose.clean().mesh;
        prop_assert_eq!(plain.faces(), sized.faces());
        loose.shuffle_vertices();
        prop_assert_eq!(loose.clean().mesh.n_faces(), plain.n_faces());
    }

    #[test]
    fn a_clean_mesh_is_left_alone(mesh in closed_mesh()) {
        let cleaned = Loose::of(&mesh, 0).clean();
        prop_assert_eq!(&cleaned.mesh, &mesh);
        prop_assert!(cleaned.report.sentences().is_empty());
    }

    #[test]
    fn any_faces_end_in_a_manifold_mesh_or_an_error(
        faces in proptest::collection::vec(proptest::collection::vec(0..9u32, 3..7), 1..14),
        points in proptest::collection::vec((0..3i32, 0..3i32, 0..3i32), 9),
    ) {
        let point = |&(x, y, z): &(i32, i32, i32)| DVec3::new(x.into(), y.into(), z.into());
        let positions = points.iter().map(point).collect();
        let mesh = PolygonMesh::from_faces(positions, &faces).unwrap();
        if let Ok(cleaned) = clean(&mesh, &Progress::none()) {
            prop_assert!(cleaned.mesh.check().is_ok());
        }
        match take_apart(&mesh, Some(1e-5), &Progress::none()) {
            Ok(apart) => prop_assert!(apart.mesh.check().is_ok()),
            Err(error) => prop_assert!(matches!(error, Error::NoArea { .. }), "{error}"),
        }
    }
}
