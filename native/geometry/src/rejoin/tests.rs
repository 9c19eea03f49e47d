//! Sheets of a few quads that meet.

use glam::DVec3;

use super::*;
use crate::elementary::direction;

/// Sheets one after the other.
#[derive(Default)]
struct Stack {
    positions: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
}

impl Stack {
    /// A sheet of its own; which faces it has.
    fn add(&mut self, positions: &[DVec3], faces: &[Vec<u32>]) -> Range<usize> {
        let [first, from] = [self.positions.len(), self.faces.len()];
        self.positions.extend_from_slice(positions);
        let named = |face: &Vec<u32>| face.iter().map(|v| v + first as u32).collect();
        self.faces.extend(faces.iter().map(named));
        from..self.faces.len()
    }

    /// `n` × `m` quads; `at` says where its points are.
    fn grid(&mut self, [n, m]: [u32; 2], at: impl Fn(f64, f64) -> DVec3) -> Range<usize> {
        let places = (0..=m).flat_map(|j| (0..=n).map(move |i| (i, j)));
        let positions: Vec<DVec3> = places.map(|(i, j)| at(i.into(), j.into())).collect();
        let name = |i: u32, j: u32| j * (n + 1) + i;
        let quad = |(i, j)| {
            vec![
                name(i, j),
                name(i + 1, j),
                name(i + 1, j + 1),
                name(i, j + 1),
            ]
        };
        let quads: Vec<_> = (0..m)
            .flat_map(|j| (0..n).map(move |i| (i, j)))
            .map(quad)
            .collect();
        self.add(&positions, &quads)
    }

    fn mesh(&self) -> PolygonMesh {
        PolygonMesh::from_faces(self.positions.clone(), &self.faces).unwrap()
    }
}

/// A wall through x = 0, and stems of so many rows that end there a little off.
fn wall(stems: &[u32]) -> (PolygonMesh, Line) {
    let mut sheets = Stack::default();
    let through = sheets.grid([6, 6], |i, j| DVec3::new(i - 3.0, 0.0, j));
    let mut strands = vec![Strand {
        faces: through,
        is_border: false,
    }];
    for (k, &m) in stems.iter().enumerate() {
        let side = 1.0 - 2.0 * k as f64;
        let up = 6.0 / f64::from(m);
        let at = |i: f64, j: f64| DVec3::new(0.06, side * (i + 0.03), j * up);
        strands.push(Strand {
            faces: sheets.grid([4, m], at),
            is_border: true,
        });
    }
    let line = Line {
        points: vec![DVec3::ZERO, DVec3::Z * 2.5, DVec3::Z * 6.0],
        is_closed: false,
        strands,
    };
    (sheets.mesh(), line)
}

/// How many edges have each number of faces.
fn edges_of(mesh: &PolygonMesh, n_faces: usize) -> usize {
    let mut edges: Vec<[VertexId; 2]> = Vec::new();
    for face in mesh.faces() {
        let next = face.iter().cycle().skip(1);
        edges.extend(face.iter().zip(next).map(|(&a, &b)| [a.min(b), a.max(b)]));
    }
    edges.sort_unstable();
    edges
        .chunk_by(|a, b| a == b)
        .filter(|run| run.len() == n_faces)
        .count()
}

/// The sheets that meet at lines.
fn sheets(lines: &[Line], may_change: bool) -> Vec<Sheet> {
    let strands = lines.iter().flat_map(|line| &line.strands);
    let mut sheets: Vec<Sheet> = strands
        .map(|strand| Sheet {
            faces: strand.faces.clone(),
            may_change,
        })
        .collect();
    sheets.sort_by_key(|sheet| sheet.faces.start);
    sheets.dedup();
    sheets
}

fn rejoined(mesh: &PolygonMesh, lines: &[Line]) -> Rejoined {
    let sheets = sheets(lines, false);
    let given = Given {
        mesh,
        sheets: &sheets,
        features: &[],
    };
    let result = rejoin(&given, lines, &Progress::none()).unwrap();
    assert_eq!(result, rejoin(&given, lines, &Progress::none()).unwrap());
    assert_eq!(result.mesh.starts(), mesh.starts());
    for face in mesh.face_ids() {
        let named = mesh.face(face).iter().map(|&v| result.name[v]);
        assert!(named.eq(result.mesh.face(face).iter().copied()));
    }
    result
}

#[test]
fn a_stem_gets_the_vertices_of_the_wall_that_it_ends_at() {
    let (mesh, line) = wall(&[6]);
    let result = rejoined(&mesh, &[line]);
    assert_eq!(result.is_joined, [true]);
    assert_eq!(result.mesh.n_vertices(), mesh.n_vertices() - 7);
    assert_eq!(edges_of(&result.mesh, 3), 6);
    let joined = result.mesh.position(result.name[VertexId(3)]);
    assert!(joined.length() < 1e-12, "{joined}");
}

#[test]
fn sheets_with_other_counts_stay_apart_and_are_counted() {
    let (mesh, line) = wall(&[5]);
    let result = rejoined(&mesh, std::slice::from_ref(&line));
    assert_eq!(result.is_joined, [false]);
    assert_eq!(result.mesh, mesh);
    // The others are joined.
    let (mesh, line) = wall(&[5, 6]);
    let result = rejoined(&mesh, &[line]);
    assert_eq!(result.is_joined, [false]);
    assert_eq!(edges_of(&result.mesh, 3), 6);
    let (mesh, line) = wall(&[6, 6]);
    let result = rejoined(&mesh, &[line]);
    assert!(result.is_joined[0]);
    assert_eq!(edges_of(&result.mesh, 4), 6);
}

#[test]
fn a_lid_inside_a_tube_is_joined_all_round() {
    for n in [8, 9] {
        let mut sheets = Stack::default();
        let round = |i: u32, n: u32| direction(f64::from(i) / f64::from(n) * std::f64::consts::TAU);
        let positions: Vec<DVec3> = (0..40)
            .map(|i| round(i % 8, 8).extend(f64::from(i / 8) * 0.7))
            .collect();
        let next = |i: u32| i / 8 * 8 + (i + 1) % 8;
        let quads: Vec<Vec<u32>> = (0..32)
            .map(|i| vec![i, next(i), next(i) + 8, i + 8])
            .collect();
        let tube = sheets.add(&positions, &quads);
        let rim: Vec<DVec3> = (0..n)
            .map(|i| (round(n - i, n) * 0.98).extend(1.4))
            .collect();
        let lid = sheets.add(&rim, &[(0..n).collect()]);
        let line = Line {
            points: (0..32).map(|i| round(i, 32).extend(1.4)).collect(),
            is_closed: true,
            strands: [(tube, false), (lid, true)]
                .map(|(faces, is_border)| Strand { faces, is_border })
                .into(),
        };
        let mesh = sheets.mesh();
        let result = rejoined(&mesh, &[line]);
        assert_eq!(result.is_joined, [n == 8]);
        assert_eq!(edges_of(&result.mesh, 3), if n == 8 { 8 } else { 0 });
    }
}

#[test]
fn lines_that_end_in_one_vertex_have_one_vertex_there() {
    // Three walls round a post, each a sheet of its own, and a floor between two of them.
    let (mesh, line) = wall(&[6]);
    let mut sheets = Stack {
        positions: mesh.positions().to_vec(),
        faces: mesh
            .faces()
            .map(|face| face.iter().map(|v| v.0).collect())
            .collect(),
    };
    let floor = sheets.grid([3, 4], |i, j| DVec3::new(i, j, -0.02));
    let to = |x: f64, y: f64, wall: usize| Line {
        points: vec![DVec3::ZERO, DVec3::new(x, y, 0.0)],
        is_closed: false,
        strands: vec![
            Strand {
                is_border: true,
                ..line.strands[wall].clone()
            },
            Strand {
                faces: floor.clone(),
                is_border: true,
            },
        ],
    };
    let lines = [line.clone(), to(3.0, 0.0, 0), to(0.0, 4.0, 1)];
    let result = rejoined(&sheets.mesh(), &lines);
    assert_eq!(result.is_joined, [true; 3]);
    let post = result.name[VertexId(3)];
    let at_post = result
        .mesh
        .faces()
        .filter(|face| face.contains(&post))
        .count();
    assert_eq!(at_post, 2 + 1 + 1);
}

/// Whether every face of a mesh is a quad that turns no corner against its own area.
fn is_sound(mesh: &PolygonMesh) -> bool {
    mesh.faces().all(|face| {
        let corners: Vec<DVec3> = face.iter().map(|&v| mesh.position(v)).collect();
        face.len() == 4 && n_turned(&corners, area(&corners)) == 0
    })
}

/// A wall and stems as above beside so many quads that a few more or fewer do not matter.
fn wall_in_a_field(stems: &[u32]) -> (PolygonMesh, Line, Vec<Sheet>) {
    let (mesh, line) = wall(stems);
    let mut stack = Stack {
        positions: mesh.positions().to_vec(),
        faces: mesh
            .faces()
            .map(|face| face.iter().map(|v| v.0).collect())
            .collect(),
    };
    let mut sheets = sheets(std::slice::from_ref(&line), true);
    sheets.push(Sheet {
        faces: stack.grid([20, 20], |i, j| DVec3::new(i, j, -9.0)),
        may_change: false,
    });
    (stack.mesh(), line, sheets)
}

#[test]
fn stems_with_other_counts_get_that_of_the_wall() {
    for stems in [&[5][..], &[7], &[4], &[9], &[5, 8], &[6, 7]] {
        let (mesh, line, sheets) = wall_in_a_field(stems);
        let lines = [line];
        let given = Given {
            mesh: &mesh,
            sheets: &sheets,
            features: &[],
        };
        let result = rejoin(&given, &lines, &Progress::none()).unwrap();
        assert_eq!(result.is_joined, [true], "{stems:?}");
        assert!(is_sound(&result.mesh));
        let n_faces = result.n_faces.iter().sum::<usize>();
        assert_eq!(n_faces, result.mesh.n_faces());
        let n = edges_of(&result.mesh, 2 + stems.len());
        assert!((4..=9).contains(&n), "{stems:?}: {n}");
        // A wall with stems can be shrunk to a point, and so can the field.
        let n_edges: usize = (1..5).map(|n| edges_of(&result.mesh, n)).sum();
        assert_eq!(result.mesh.n_vertices() + n_faces, n_edges + 2);
        for v in &result.name {
            assert!(v.index() < result.mesh.n_vertices());
        }
        for (v, of) in result.mesh.positions().iter().zip(result.from.iter()) {
            let [a, b] = of.map(|v| mesh.position(v));
            assert!(v.distance(a.midpoint(b)) < 2.0);
        }
    }
}

#[test]
fn features_are_cut_with_the_strips_that_cross_them() {
    let (mesh, line, sheets) = wall_in_a_field(&[5]);
    let lines = [line];
    // The far border of the stem, of five edges beside six of the wall.
    let far = |v: u32| VertexId(49 + 5 * v + 4);
    let features: Vec<Edge> = (0..5).map(|v| [far(v), far(v + 1)]).collect();
    let given = Given {
        mesh: &mesh,
        sheets: &sheets,
        features: &features,
    };
    let result = rejoin(&given, &lines, &Progress::none()).unwrap();
    assert_eq!(result.features.len(), result.n_faces[1] / 4);
    for [a, b] in &result.features {
        let has_both = |face: &[VertexId]| face.contains(a) && face.contains(b);
        assert!(result.mesh.faces().any(has_both));
    }
}
