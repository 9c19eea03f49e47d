//! Sheets of a few quads that meet.

use std::collections::BTreeMap;

use glam::DVec3;

use super::*;
use crate::elementary::direction;
use crate::mesh::Id;

/// Sheets one after the other.
#[derive(Default)]
struct Stack {
    positions: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
    sheets: Vec<Sheet>,
}

impl Stack {
    /// A sheet of its own; which one it is.
    fn add(&mut self, positions: &[DVec3], faces: &[Vec<u32>]) -> usize {
        let [first, from] = [self.positions.len(), self.faces.len()];
        self.positions.extend_from_slice(positions);
        let named = |face: &Vec<u32>| face.iter().map(|v| v + first as u32).collect();
        self.faces.extend(faces.iter().map(named));
        self.sheets.push(Sheet {
            faces: from..self.faces.len(),
            is_kept: false,
        });
        self.sheets.len() - 1
    }

    /// `n` × `m` quads; `at` says where its points are.
    fn grid(&mut self, [n, m]: [u32; 2], at: impl Fn(f64, f64) -> DVec3) -> usize {
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

/// Sheets at a line with corners of their own.
fn strands(of: &[(usize, bool)]) -> Vec<Strand> {
    let strand = |&(sheet, is_border): &(usize, bool)| Strand {
        sheet,
        is_border,
        ends: [0, 1],
    };
    of.iter().map(strand).collect()
}

/// A wall through x = 0, and stems of so many rows that end there a little off.
fn wall(stems: &[u32]) -> (Stack, Line) {
    let mut sheets = Stack::default();
    let through = sheets.grid([6, 6], |i, j| DVec3::new(i - 3.0, 0.0, j));
    let mut at_line = vec![(through, false)];
    for (k, &m) in stems.iter().enumerate() {
        let side = 1.0 - 2.0 * k as f64;
        let up = 6.0 / f64::from(m);
        let at = |i: f64, j: f64| DVec3::new(0.06, side * (i + 0.03), j * up);
        at_line.push((sheets.grid([4, m], at), true));
    }
    let line = Line {
        points: vec![DVec3::ZERO, DVec3::Z * 2.5, DVec3::Z * 6.0],
        is_closed: false,
        strands: strands(&at_line),
        stays: false,
    };
    (sheets, line)
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

fn rejoined(stack: &Stack, lines: &[Line]) -> Rejoined {
    rejoined_with((stack, &[]), (lines, &[]))
}

fn rejoined_with((stack, features): (&Stack, &[Edge]), meeting: (&[Line], &[Touch])) -> Rejoined {
    let mesh = stack.mesh();
    let given = Given {
        mesh: &mesh,
        sheets: &stack.sheets,
        features,
    };
    let result = rejoin(&given, meeting, &Progress::none()).unwrap();
    assert_eq!(result, rejoin(&given, meeting, &Progress::none()).unwrap());
    assert_eq!(result.n_faces.iter().sum::<usize>(), result.mesh.n_faces());
    assert!(
        result
            .name
            .iter()
            .all(|v| v.index() < result.mesh.n_vertices())
    );
    result
}

/// Which lines were joined.
fn are_joined(result: &Rejoined) -> Vec<bool> {
    result.joined.iter().map(Option::is_some).collect()
}

#[test]
fn a_stem_gets_the_vertices_of_the_wall_that_it_ends_at() {
    let (stack, line) = wall(&[6]);
    let result = rejoined(&stack, &[line]);
    assert_eq!(are_joined(&result), [true]);
    assert_eq!(result.is_changed, [false; 2]);
    assert_eq!(result.mesh.n_vertices(), stack.positions.len() - 7);
    assert_eq!(edges_of(&result.mesh, 3), 6);
    let joined = result.mesh.position(result.name[VertexId(3)]);
    assert!(joined.length() < 1e-12, "{joined}");
}

#[test]
fn a_lid_inside_a_tube_is_joined_all_round() {
    for n in [8, 6, 12] {
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
        // Turned the other way, from elsewhere on.
        let mut places: Vec<DVec3> = (0..n)
            .map(|i| (round(n + 2 - i, n) * 0.98).extend(1.4))
            .collect();
        let inner = (0..n).map(|i| (round(n + 2 - i, n) * 0.5).extend(1.4));
        places.extend(inner);
        places.push(DVec3::Z * 1.4);
        let ring = (0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]);
        let fans = (0..n / 2).map(|i| vec![n + 2 * i, n + 2 * i + 1, n + (2 * i + 2) % n, 2 * n]);
        let lid = sheets.add(&places, &ring.chain(fans).collect::<Vec<_>>());
        let line = Line {
            points: (0..32).map(|i| round(i, 32).extend(1.4)).collect(),
            is_closed: true,
            strands: strands(&[(tube, false), (lid, true)]),
            stays: false,
        };
        let result = rejoined(&sheets, &[line]);
        assert_eq!(are_joined(&result), [true]);
        assert_eq!(edges_of(&result.mesh, 3), 8.max(n as usize));
        assert_eq!(edges_of(&result.mesh, 1), 16);
        assert!(is_sound(&result.mesh), "{n}");
    }
}

#[test]
fn lines_that_end_in_one_vertex_have_one_vertex_there() {
    // Three walls round a post, each a sheet of its own, and a floor between two of them.
    let (mut sheets, mut line) = wall(&[6]);
    let floor = sheets.grid([3, 4], |i, j| DVec3::new(i, j, -0.02));
    let to = |x: f64, y: f64, wall: usize| Line {
        points: vec![DVec3::ZERO, DVec3::new(x, y, 0.0)],
        is_closed: false,
        strands: [(wall, [0, 2]), (floor, [0, wall + 1])]
            .map(|(sheet, ends)| Strand {
                sheet,
                is_border: true,
                ends,
            })
            .into(),
        stays: false,
    };
    line.strands[0].ends = [0, 1];
    let lines = [line, to(3.0, 0.0, 0), to(0.0, 4.0, 1)];
    let result = rejoined(&sheets, &lines);
    assert_eq!(are_joined(&result), [true; 3]);
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

#[test]
fn stems_with_other_counts_get_that_of_the_wall() {
    for stems in [&[5][..], &[7], &[4], &[9], &[5, 8], &[6, 7], &[2], &[16]] {
        // Beside so many quads that a few more or fewer do not matter, and alone.
        for n in [1, 20] {
            let (mut stack, line) = wall(stems);
            stack.grid([n, n], |i, j| DVec3::new(i, j, -9.0));
            let result = rejoined(&stack, &[line]);
            assert_eq!(are_joined(&result), [true], "{stems:?}");
            assert!(is_sound(&result.mesh), "{stems:?}");
            let n_shared = edges_of(&result.mesh, 2 + stems.len());
            let most = stems.iter().copied().max().unwrap_or(0).max(6);
            assert!(
                (4..=most as usize + 1).contains(&n_shared),
                "{stems:?}: {n_shared}"
            );
            // A wall with stems can be shrunk to a point, and so can the field.
            let n_edges: usize = (1..5).map(|n| edges_of(&result.mesh, n)).sum();
            assert_eq!(
                result.mesh.n_vertices() + result.mesh.n_faces(),
                n_edges + 2
            );
            for (v, of) in result.mesh.positions().iter().zip(result.from.iter()) {
                let [a, b] = of.map(|v| stack.positions[v.index()]);
                assert!(v.distance(a.midpoint(b)) < 3.0);
            }
        }
    }
}

#[test]
fn features_are_cut_with_the_strips_that_cross_them() {
    let (mut stack, line) = wall(&[5]);
    stack.grid([20, 20], |i, j| DVec3::new(i, j, -9.0));
    // The far border of the stem, of five edges beside six of the wall.
    let far = |v: u32| VertexId(49 + 5 * v + 4);
    let features: Vec<Edge> = (0..5).map(|v| [far(v), far(v + 1)]).collect();
    let result = rejoined_with((&stack, &features), (&[line], &[]));
    assert_eq!(result.features.len(), result.n_faces[1] / 4);
    for [a, b] in &result.features {
        let has_both = |face: &[VertexId]| face.contains(a) && face.contains(b);
        assert!(result.mesh.faces().any(has_both));
    }
}

/// How many edges of a mesh with some number of faces lie on a line, by length.
fn length_on(mesh: &PolygonMesh, line: &Line, n_faces: usize) -> f64 {
    let mut edges: BTreeMap<Edge, usize> = BTreeMap::new();
    for face in mesh.faces() {
        let next = face.iter().cycle().skip(1);
        for (&a, &b) in face.iter().zip(next) {
            *edges.entry(sorted([a, b])).or_default() += 1;
        }
    }
    let lies = |v: VertexId| line.distance(mesh.position(v)) < 1e-9;
    let on_line = edges
        .iter()
        .filter(|([a, b], n)| **n == n_faces && lies(*a) && lies(*b));
    let length = |([a, b], _): (&Edge, &usize)| mesh.position(*a).distance(mesh.position(*b));
    on_line.map(length).sum()
}

#[test]
fn a_fin_that_runs_aslant_gets_edges_of_the_floor_it_stands_on() {
    // From inside to inside, from border to border, and from corner to corner of quads.
    let ways = [
        [DVec3::new(2.2, 2.1, 0.0), DVec3::new(7.7, 4.9, 0.0)],
        [DVec3::new(0.0, 3.0, 0.0), DVec3::new(10.0, 6.0, 0.0)],
        [DVec3::new(2.0, 2.0, 0.0), DVec3::new(7.0, 7.0, 0.0)],
        [DVec3::new(3.0, 5.0, 0.0), DVec3::new(7.0, 5.0, 0.0)],
    ];
    for [from, to] in ways {
        for n in [4, 9] {
            let mut stack = Stack::default();
            let floor = stack.grid([10, 10], |i, j| DVec3::new(i, j, 0.0));
            let along = (to - from) / f64::from(n);
            let fin = stack.grid([n, 2], |i, j| from + along * i + DVec3::Z * j);
            let line = Line {
                points: vec![from, to],
                is_closed: false,
                strands: strands(&[(floor, false), (fin, true)]),
                stays: false,
            };
            let result = rejoined(&stack, std::slice::from_ref(&line));
            assert_eq!(are_joined(&result), [true], "{from} {n}");
            let on_line = length_on(&result.mesh, &line, 3);
            assert!(
                (on_line - from.distance(to)).abs() < 1e-9,
                "{from} {n}: {on_line}"
            );
            assert!(is_sound(&result.mesh), "{from} {n}");
            // The floor's border and the fin's stay what they are.
            assert_eq!(edges_of(&result.mesh, 4), 0);
            let n_edges: usize = (1..4).map(|n| edges_of(&result.mesh, n)).sum();
            assert_eq!(
                result.mesh.n_vertices() + result.mesh.n_faces(),
                n_edges + 1
            );
        }
    }
}

#[test]
fn sheets_that_touch_in_a_point_have_one_vertex_there() {
    let mut stack = Stack::default();
    let floor = stack.grid([4, 4], |i, j| DVec3::new(i, j, 0.0));
    let other = stack.grid([3, 3], |i, j| DVec3::new(2.3 + i, 2.2 + j, i + j));
    let touch = Touch {
        place: DVec3::new(2.3, 2.2, 0.0),
        corners: [floor, other].map(|sheet| Corner { sheet, name: 0 }).into(),
    };
    let result = rejoined_with((&stack, &[]), (&[], std::slice::from_ref(&touch)));
    assert_eq!(result.mesh.n_vertices(), stack.positions.len() - 1);
    assert_eq!(result.name[VertexId(12)], result.name[VertexId(25)]);
    assert_eq!(result.mesh.position(result.name[VertexId(12)]), touch.place);
}

#[test]
fn sheets_have_vertices_where_something_stays() {
    for m in [2, 6, 7, 9] {
        let (stack, mut line) = wall(&[6]);
        line.stays = true;
        // Not even, and more or fewer than there are edges.
        let at = |k: u32| 6.0 * (f64::from(k) / f64::from(m)).powi(2);
        line.points = (0..=m).map(|k| DVec3::Z * at(k)).collect();
        for strands in [&line.strands[..], &line.strands[..1]] {
            let line = Line {
                strands: strands.to_vec(),
                ..line.clone()
            };
            let result = rejoined(&stack, std::slice::from_ref(&line));
            let along = result.joined[0].as_ref().unwrap();
            let posts = line.posts(along.len());
            assert!(posts.is_sorted_by(|a, b| a < b) && posts.len() == line.points.len());
            for (&i, &point) in posts.iter().zip(&line.points) {
                assert_eq!(result.mesh.position(along[i]), point);
            }
            let on_line = length_on(&result.mesh, &line, 1 + strands.len());
            assert!((on_line - 6.0).abs() < 1e-9, "{m}: {on_line}");
        }
    }
}

#[test]
fn what_would_make_many_faces_more_is_left_and_not_joined() {
    let (stack, mut line) = wall(&[6]);
    line.stays = true;
    line.points = (0..=200).map(|k| DVec3::Z * 0.03 * f64::from(k)).collect();
    let result = rejoined(&stack, std::slice::from_ref(&line));
    assert_eq!(result.joined, [None]);
    let n_faces = result.mesh.n_faces();
    assert_eq!(n_faces, stack.faces.len());
}
