//! Solids keep their edges and corners: edges of quads cover every crease, a vertex is at every
//! corner, at counts that allow no cube exactly, and across the plane of symmetry too.

use std::collections::HashSet;
use std::f64::consts::TAU;

use glam::DVec3;
use orbflow_geometry::elementary::direction;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::mesh::{PolygonMesh, VertexId};
use orbflow_geometry::pipeline::{Input, Mirror, Settings, remesh};
use orbflow_geometry::progress::Progress;

/// How far a vertex may be off a crease to lie on it, for shapes of a size of about 2.
const NEAR: f64 = 1e-3;

/// Flat faces.
struct Solid {
    positions: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
}

/// A prism along z over a polygon, which is convex.
fn prism(polygon: &[[f64; 2]], half: f64) -> Solid {
    let n = polygon.len() as u32;
    let at = |z: f64| polygon.iter().map(move |&[x, y]| DVec3::new(x, y, z));
    let mut faces = vec![(0..n).rev().collect(), (n..2 * n).collect()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]));
    Solid {
        positions: at(-half).chain(at(half)).collect(),
        faces,
    }
}

fn cube() -> Solid {
    prism(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]], 1.0)
}

/// An L, its ends cut into two quads each.
fn l_bar() -> Solid {
    let polygon = [
        [-1.5, -1.5],
        [1.5, -1.5],
        [1.5, -0.5],
        [-0.5, -0.5],
        [-0.5, 1.5],
        [-1.5, 1.5],
    ];
    let mut solid = prism(&polygon, 0.5);
    let ends = [[0, 3, 2, 1], [0, 5, 4, 3], [6, 7, 8, 9], [6, 9, 10, 11]];
    solid.faces.splice(0..2, ends.map(|f| f.to_vec()));
    solid
}

fn pyramid() -> Solid {
    let mut solid = cube();
    solid.positions.truncate(5);
    solid.positions[4] = DVec3::Z * 0.4;
    solid.faces.truncate(1);
    let sides = (0..4).map(|i| vec![i, (i + 1) % 4, 4]);
    solid.faces.extend(sides);
    solid
}

impl Solid {
    fn normal(&self, face: &[u32]) -> DVec3 {
        let [a, b, c] = [0, 1, 2].map(|i| self.positions[face[i] as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// The edges between faces that turn by more than 40°.
    fn creases(&self) -> Vec<[DVec3; 2]> {
        let mut creases = Vec::new();
        let sides = |f: &[u32]| -> Vec<[u32; 2]> {
            let n = f.len();
            (0..n).map(|i| [f[i], f[(i + 1) % n]]).collect()
        };
        for (i, face) in self.faces.iter().enumerate() {
            for [a, b] in sides(face) {
                let other = self.faces[i..].iter().find(|f| sides(f).contains(&[b, a]));
                let is_sharp = |f: &Vec<u32>| self.normal(face).dot(self.normal(f)) < 0.766;
                if other.is_some_and(is_sharp) {
                    creases.push([a, b].map(|v| self.positions[v as usize]));
                }
            }
        }
        creases
    }
}

/// What share of a crease edges of a mesh lie along.
fn covered(mesh: &PolygonMesh, [from, to]: [DVec3; 2]) -> f64 {
    let length = from.distance(to);
    let way = (to - from) / length;
    let along = |v: VertexId| {
        let p = mesh.position(v) - from;
        let at = p.dot(way);
        let is_on = p.distance(way * at) < NEAR && (-NEAR..length + NEAR).contains(&at);
        is_on.then_some(at)
    };
    let mut edges = HashSet::new();
    for face in mesh.faces() {
        for (i, &a) in face.iter().enumerate() {
            let b = face[(i + 1) % face.len()];
            edges.insert([a.min(b), a.max(b)]);
        }
    }
    let part = |[a, b]: [VertexId; 2]| along(a).zip(along(b)).map_or(0.0, |(a, b)| (a - b).abs());
    edges.into_iter().map(part).sum::<f64>() / length
}

fn check(solid: &Solid, counts: &[usize]) {
    let mesh =
        PolygonMesh::from_faces(solid.positions.clone(), &solid.faces).expect("a solid is a mesh");
    for &faces in counts {
        for mirror in [Mirror::Auto, Mirror::Off] {
            let settings = Settings {
                faces,
                mirror,
                ..Settings::default()
            };
            let (solver, quiet) = (Solver::default(), Progress::none());
            let made =
                remesh(Input::new(&mesh), &settings, &solver, &quiet).expect("a solid can be done");
            let what = format!("{faces} {mirror:?} {:?}", made.report.parts[0].flow);
            for crease in solid.creases() {
                let covered = covered(&made.mesh, crease);
                assert!((covered - 1.0).abs() < 0.005, "{crease:?} {covered} {what}");
                for corner in crease {
                    let mut vertices = made.mesh.positions().iter();
                    assert!(
                        vertices.any(|p| p.distance(corner) < NEAR),
                        "{corner} {what}"
                    );
                }
            }
            let n_faces = made.mesh.n_faces();
            assert!(n_faces.abs_diff(faces) <= faces / 8 + 4, "{n_faces} {what}");
        }
    }
}

#[test]
fn a_cube_stays_one_at_every_count() {
    check(&cube(), &[24, 54, 100]);
}

#[test]
fn creases_that_turn_inwards_are_kept_too() {
    check(&l_bar(), &[24, 54]);
}

#[test]
fn acute_edges_are_kept() {
    check(
        &prism(&[[-1.5, -0.7], [1.5, -0.7], [-1.5, 0.8]], 1.0),
        &[54],
    );
}

#[test]
fn three_and_six_sides_get_irregular_vertices_inside() {
    check(&pyramid(), &[54]);
    let half = 0.75_f64.sqrt();
    let hexagon = [
        [1.0, 0.0],
        [0.5, half],
        [-0.5, half],
        [-1.0, 0.0],
        [-0.5, -half],
        [0.5, -half],
    ];
    check(&prism(&hexagon, 0.4), &[54]);
}

#[test]
fn a_drum_of_few_quads_does_not_bulge_between_its_rims() {
    let polygon: Vec<[f64; 2]> = (0..32)
        .map(|i| direction(f64::from(i) * TAU / 32.0).to_array())
        .collect();
    let drum = prism(&polygon, 1.25);
    let mesh = PolygonMesh::from_faces(drum.positions, &drum.faces).expect("a drum is a mesh");
    for mirror in [Mirror::Auto, Mirror::Off] {
        let settings = Settings {
            faces: 54,
            mirror,
            ..Settings::default()
        };
        let (solver, quiet) = (Solver::default(), Progress::none());
        let made = remesh(Input::new(&mesh), &settings, &solver, &quiet).expect("a drum is done");
        for p in made.mesh.positions() {
            let radius = p.truncate().length();
            assert!(radius < 1.0 + NEAR, "{p} {mirror:?}");
        }
    }
}
