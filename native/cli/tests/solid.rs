//! What the program makes of shells that intersect or lie in each other.

mod support;

use std::fmt::Write;
use std::fs;

use serde_json::Value;
use support::{Folder, run};

/// Boxes by two corners, as OBJ.
fn boxes(all: &[[[f64; 3]; 2]]) -> String {
    let mut text = String::new();
    for (i, [low, high]) in all.iter().enumerate() {
        for corner in 0..8 {
            let at = |axis: usize| [low, high][corner >> axis & 1][axis];
            let _ = writeln!(text, "v {} {} {}", at(0), at(1), at(2));
        }
        for [a, b, c, d] in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            let name = |corner: usize| 8 * i + corner + 1;
            let _ = writeln!(text, "f {} {} {} {}", name(a), name(b), name(c), name(d));
        }
    }
    text
}

fn remesh(text: &str, more: &[&str]) -> (Value, String) {
    let folder = Folder::new();
    let input = folder.write("boxes.obj", text);
    let [output, report] = ["out.obj", "report.json"].map(|name| folder.path(name));
    let usual = ["remesh", &input, &output, "--report", &report];
    let done = run(&[&usual[..], more].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let report = fs::read_to_string(report).expect("a report was written");
    let report = serde_json::from_str(&report).expect("a report is JSON");
    (report, done.err)
}

#[test]
fn boxes_that_intersect_become_one_closed_mesh_and_it_is_said() {
    let text = boxes(&[
        [[0.0, 0.0, 0.0], [2.0, 1.0, 1.0]],
        [[0.5, 0.3, 0.4], [1.3, 0.7, 2.0]],
        [[0.1, 0.1, 0.1], [0.3, 0.3, 0.3]],
    ]);
    let usual = ["--faces", "300", "--solid", "--solid-detail", "1"];
    let (report, err) = remesh(&text, &usual);
    assert!(err.contains("3 shells made 1 closed surface"), "{err}");
    let output = &report["output"];
    assert_eq!(
        (&output["closed"], &output["n_components"]),
        (&true.into(), &1.into())
    );
    let solid = &report["solid"];
    assert_eq!(
        (&solid["n_shells"], &solid["n_closed"]),
        (&3.into(), &3.into())
    );
    assert!((solid["cell_pct"].as_f64().unwrap() - 1.0).abs() < 1e-12);
    assert!(solid["n_faces"].as_u64().unwrap() > 1000);
}

#[test]
fn boxes_inside_others_go_where_that_is_asked_for() {
    let text = boxes(&[
        [[0.0, 0.0, 0.0], [2.0, 1.0, 1.0]],
        [[0.1, 0.1, 0.1], [0.7, 0.7, 0.7]],
    ]);
    let (report, err) = remesh(&text, &["--faces", "100", "--inner", "drop", "--strict"]);
    assert!(
        err.contains("1 part with 6 faces inside others: dropped"),
        "{err}"
    );
    assert_eq!(report["output"]["n_components"], 1);
    assert_eq!(report["kept"][0]["reasons"][0]["kind"], "inside");
    assert!(report["solid"].is_null());
    let (report, _) = remesh(&text, &["--faces", "100"]);
    assert_eq!(report["output"]["n_components"], 2);
}
