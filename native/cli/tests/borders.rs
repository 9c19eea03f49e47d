//! What the program makes of meshes with borders.

mod support;

use std::collections::HashMap;
use std::f64::consts::PI;
use std::fmt::Write;
use std::fs;

use orbflow_geometry::elementary::{cos, sin};
use orbflow_geometry::measure::{Topology, topology};
use orbflow_geometry::mesh::io::{Format, read};
use orbflow_geometry::mesh::{PolygonMesh, VertexId};
use orbflow_geometry::progress::Progress;
use serde_json::{Value, json};
use support::{Folder, run};

/// Quads of a square, as OBJ; the sides of its columns may be one.
fn rows([n, m]: [usize; 2], is_round: bool, place: impl Fn(f64, f64) -> [f64; 3]) -> String {
    let n_columns = if is_round { m } else { m + 1 };
    let mut text = String::new();
    for (i, j) in (0..=n).flat_map(|i| (0..n_columns).map(move |j| (i, j))) {
        let [x, y, z] = place(i as f64 / n as f64, j as f64 / m as f64);
        let _ = writeln!(text, "v {x:.6} {y:.6} {z:.6}");
    }
    let name = |i: usize, j: usize| 1 + i * n_columns + j % n_columns;
    for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
        let quad = [
            name(i, j),
            name(i, j + 1),
            name(i + 1, j + 1),
            name(i + 1, j),
        ];
        let _ = writeln!(text, "f {} {} {} {}", quad[0], quad[1], quad[2], quad[3]);
    }
    text
}

fn plate() -> String {
    rows([8, 12], false, |s, t| [1.5 * t, s, 0.0])
}

fn tube() -> String {
    rows([10, 20], true, |s, t| {
        let angle = 2.0 * PI * t;
        [cos(angle), sin(angle), 3.0 * s]
    })
}

/// Half a ball, closed at the top by one face.
fn hemisphere() -> String {
    let ball = rows([8, 24], true, |s, t| {
        let [angle, height] = [2.0 * PI * t, 0.45 * PI * s];
        let r = cos(height);
        [r * cos(angle), r * sin(angle), sin(height)]
    });
    let top: Vec<String> = (1..=24).map(|j| (8 * 24 + j).to_string()).collect();
    format!("{ball}f {}\n", top.join(" "))
}

/// The edges of one face.
fn border(mesh: &PolygonMesh) -> Vec<[VertexId; 2]> {
    let mut n_faces: HashMap<[VertexId; 2], usize> = HashMap::new();
    for face in mesh.faces() {
        for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
            *n_faces.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let single = n_faces.into_iter().filter(|(_, n)| *n == 1);
    single.map(|(ends, _)| ends).collect()
}

/// How far the vertices of an output's borders are from the input's borders, in diagonals.
fn off_border(input: &PolygonMesh, output: &PolygonMesh) -> f64 {
    let lines = border(input).into_iter();
    let lines: Vec<_> = lines.map(|ends| ends.map(|v| input.position(v))).collect();
    let off = |v: VertexId| {
        let p = output.position(v);
        let to = lines.iter().map(|&[a, b]| {
            let along = (p - a).dot(b - a) / (b - a).length_squared();
            p.distance(a.lerp(b, along.clamp(0.0, 1.0)))
        });
        to.fold(f64::INFINITY, f64::min)
    };
    let [low, high] = input.bounds();
    let vertices = border(output).concat().into_iter();
    vertices.map(off).fold(0.0, f64::max) / low.distance(high)
}

fn mesh(text: &str) -> PolygonMesh {
    read(text.as_bytes(), Format::Obj)
        .expect("it is an obj file")
        .mesh
}

struct Done {
    input: PolygonMesh,
    output: PolygonMesh,
    report: Value,
    err: String,
}

impl Done {
    fn topologies(&self) -> [Topology; 2] {
        [&self.input, &self.output]
            .map(|mesh| topology(mesh, &Progress::none()).expect("nobody cancels"))
    }
}

fn remesh(text: &str, more: &[&str]) -> Done {
    let folder = Folder::new();
    let input = folder.write("open.obj", text);
    let [output, report] = ["out.obj", "report.json"].map(|name| folder.path(name));
    let usual = [
        "remesh", &input, &output, "--mirror", "off", "--report", &report,
    ];
    let done = run(&[&usual[..], more].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let report = fs::read_to_string(report).expect("a report was written");
    Done {
        input: mesh(text),
        output: mesh(&fs::read_to_string(output).expect("a result was written")),
        report: serde_json::from_str(&report).expect("a report is JSON"),
        err: done.err,
    }
}

#[test]
fn open_meshes_stay_open_with_their_borders_where_they_were() {
    for (text, n_borders, way) in [(hemisphere(), 1, "capped"), (tube(), 2, "capped")] {
        let asked = ["--faces", "120", "--strict", "--own-quads", "off"];
        let done = remesh(&text, &asked);
        let [before, after] = done.topologies();
        assert_eq!((before.n_borders, before.genus), (n_borders, Some(0)));
        assert_eq!((after.n_borders, after.genus), (n_borders, Some(0)));
        assert!(
            after.manifold && after.n_quads == after.n_faces,
            "{after:?}"
        );
        assert_eq!(after.n_components, 1);
        assert!(off_border(&done.input, &done.output) < 1e-3);
        let opened = &done.report["parts"][0]["opened"];
        let told = json!({"n_borders": n_borders, "n_filled": 0, "way": way, "n_sealed": 0});
        assert_eq!(*opened, told);
        assert!(!done.err.contains("filled"), "{}", done.err);
    }
}

#[test]
fn a_plate_stays_a_plate_with_its_corners() {
    // Its own quads are cut into finer ones, or, where these are not wanted, a sheet flows.
    let ways = [
        ("on", "own", json!(null)),
        ("off", "used", json!("doubled")),
    ];
    for (own_quads, status, way) in ways {
        let asked = ["--faces", "96", "--strict", "--own-quads", own_quads];
        let done = remesh(&plate(), &asked);
        let [_, after] = done.topologies();
        assert_eq!((after.n_borders, after.genus), (1, Some(0)));
        assert!(off_border(&done.input, &done.output) < 1e-3);
        for (x, y) in [(0.0, 0.0), (1.5, 0.0), (0.0, 1.0), (1.5, 1.0)] {
            let is_there = |p: [f64; 3]| (p[0] - x).abs() + (p[1] - y).abs() + p[2].abs() < 1e-5;
            let mut places = done.output.positions().iter().map(|&p| <[f64; 3]>::from(p));
            assert!(places.any(is_there), "({x}, {y})");
        }
        let part = &done.report["parts"][0];
        assert_eq!(
            (&part["flow"]["status"], &part["opened"]["way"]),
            (&json!(status), &way)
        );
    }
}

#[test]
fn handles_are_sealed_up_to_a_size() {
    let ring = |s: f64, t: f64| {
        let [tube, round] = [2.0 * PI * s, 2.0 * PI * t];
        let r = 1.0 + 0.3 * cos(tube);
        [r * cos(round), r * sin(round), 0.3 * sin(tube)]
    };
    // A torus as rows whose last is the first: positions that are equal are one.
    let torus = rows([12, 32], true, ring);
    // Round the tube it is 50 % of the diagonal.
    for (handles, n_sealed) in [("keep", 0), ("seal:45", 0), ("seal:60", 1)] {
        let done = remesh(&torus, &["--faces", "200", "--handles", handles]);
        let [_, after] = done.topologies();
        assert_eq!((after.n_borders, after.genus), (0, Some(1 - n_sealed)));
        let says = done.err.contains("open.obj: 1 handle sealed");
        assert_eq!(says, n_sealed > 0, "{}", done.err);
        assert_eq!(done.report["score"]["same_topology"], true);
    }
}

#[test]
fn borders_are_filled_all_of_them_or_those_up_to_a_size() {
    // Round the tube it is 152 % of the diagonal.
    for (borders, n_filled) in [("fill", 2), ("fill:160", 2), ("fill:150", 0)] {
        let done = remesh(
            &tube(),
            &["--faces", "100", "--borders", borders, "--strict"],
        );
        let [_, after] = done.topologies();
        assert_eq!((after.n_borders, after.genus), (2 - n_filled, Some(0)));
        let opened = &done.report["parts"][0]["opened"];
        assert_eq!(
            (&opened["n_borders"], &opened["n_filled"]),
            (&2.into(), &n_filled.into())
        );
        let says = done.err.contains("open.obj: 2 borders filled");
        assert_eq!(says, n_filled > 0, "{}", done.err);
        // Of what was made for what was asked for, the score is as good as of a closed mesh.
        let score = &done.report["score"];
        assert_eq!(score["same_topology"], true);
        assert!(score["hausdorff_pct"].as_f64().unwrap() < 3.0, "{score}");
    }
}
