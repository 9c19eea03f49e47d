//! What the program does and says with meshes of several parts.

mod support;

use std::fs;

use serde_json::Value;
use support::{Folder, ball, run};

/// A ball, and so many stray triangles of a size beside it.
fn with_scraps(n: usize, size: f64) -> String {
    let triangle = |i: usize| {
        let (x, s) = (3.0 + i as f64, size);
        format!("v {x} 0 0\nv {} 0 0\nv {x} {s} 0\n", x + s)
    };
    let text: String = (0..n).map(triangle).collect();
    let (first, faces) = ball("").split_once("f ").map_or_else(
        || panic!("a ball has faces"),
        |(vertices, faces)| (vertices.to_owned(), format!("f {faces}")),
    );
    let moved = faces.lines().map(|line| {
        let corners = line.split(' ').skip(1);
        let corner = |word: &str| (word.parse::<usize>().expect("a number") + 3 * n).to_string();
        let corners: Vec<String> = corners.map(corner).collect();
        format!("f {}\n", corners.join(" "))
    });
    let scraps = (0..n).map(|i| format!("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3));
    text + &first + &scraps.collect::<String>() + &moved.collect::<String>()
}

#[test]
fn parts_that_stay_are_named_with_reason_and_place() {
    let folder = Folder::new();
    let input = folder.write("scrap.obj", &with_scraps(1, 0.5));
    let [output, report] = ["out.obj", "report.json"].map(|name| folder.path(name));
    let remesh = ["remesh", &input, &output, "--faces", "100"];
    let done = run(&[&remesh[..], &["--report", &report]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let lines: Vec<&str> = done.err.lines().collect();
    assert!(
        lines[0].contains("scrap.obj: part 1 (1 face): the faces use 3 different points; ")
            && lines[0].ends_with(", at (3, 0, 0)"),
        "{lines:?}"
    );
    assert!(
        lines
            .iter()
            .any(|line| line.ends_with("1 part with 1 face cannot be done: left as before"))
    );
    let text = fs::read_to_string(&report).unwrap();
    let report: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(report["kept"][0]["reasons"][0]["kind"], "flat");
    assert_eq!(report["kept"][0]["outcome"], "kept");
    assert_eq!(report["settings"]["weld"], 1e-5);
    let text = fs::read_to_string(&output).unwrap();
    assert!(text.contains("v 3.5 0 0\n"), "{text}");
    let strict = run(&[&remesh[..], &["--strict"]].concat());
    assert_eq!(strict.code, 3);
    assert!(strict.err.starts_with("orbflow: "), "{}", strict.err);
    assert!(strict.err.lines().all(|line| line.contains("scrap.obj: ")));
    assert!(strict.err.contains("the faces use 3 different points"));
}

#[test]
fn many_reasons_are_cut_and_small_parts_are_one_line() {
    let folder = Folder::new();
    let input = folder.write("scraps.obj", &with_scraps(30, 0.01));
    let output = folder.path("out.obj");
    let remesh = ["remesh", &input, &output, "--faces", "100"];
    let done = run(&remesh);
    assert_eq!((done.code, done.err.lines().count()), (0, 22));
    assert!(done.err.contains("and 10 reasons more"), "{}", done.err);
    assert!(done.err.contains("30 parts with 30 faces cannot be done"));
    let small = ["--small-size", "1", "--small-parts", "drop", "--strict"];
    let done = run(&[&remesh[..], &small].concat());
    assert_eq!(
        (done.code, done.err.lines().count()),
        (0, 1),
        "{}",
        done.err
    );
    assert!(
        done.err
            .contains("30 parts with 30 faces too small: dropped")
    );
    let text = fs::read_to_string(&output).unwrap();
    assert!(text.lines().filter(|line| line.starts_with("f ")).count() <= 102);
}

#[test]
fn seams_are_welded_and_told() {
    let folder = Folder::new();
    // A box of six quads, each a little off the others.
    let corner = |i: usize, face: usize| {
        let at = |bit: usize| (i >> bit & 1) as f64 + 1e-7 * face as f64;
        format!("v {} {} {}\n", at(0), at(1), at(2))
    };
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let mut text = String::new();
    for (face, quad) in quads.iter().enumerate() {
        text.extend(quad.iter().map(|&i| corner(i, face)));
    }
    let face = |face: usize| {
        let [a, b, c, d] = [1, 2, 3, 4].map(|i| 4 * face + i);
        format!("f {a} {b} {c} {d}\n")
    };
    text.extend((0..6).map(face));
    let input = folder.write("seams.obj", &text);
    let output = folder.path("out.obj");
    let remesh = ["remesh", &input, &output, "--faces", "54"];
    let done = run(&remesh);
    assert_eq!(done.code, 0, "{}", done.err);
    let told = "seams.obj: 16 border points welded across gaps of up to ";
    assert!(done.err.contains(told), "{}", done.err);
    // The six sides have borders, which this primitive has not.
    let sphere = ["--primitive", "quad-sphere", "--weld"];
    for weld in ["off", "1e-9"] {
        let refused = run(&[&remesh[..], &sphere, &[weld]].concat());
        assert_eq!(refused.code, 3);
        assert!(refused.err.contains("welded"), "{}", refused.err);
        assert_eq!(refused.err.lines().count(), 7);
    }
}

#[test]
fn wrong_sizes_are_wrong_usage() {
    for (name, value, words) in [
        ("--weld", "0.5", "0 to 0.01"),
        ("--weld", "on", "invalid"),
        ("--small-size", "101", "0 to 100"),
        ("--small-parts", "eat", "keep, drop"),
        ("--borders", "eat", "keep, fill, or fill:SIZE"),
        ("--borders", "fill:1001", "0 to 1000"),
        ("--borders", "fill:all", "invalid"),
    ] {
        let refused = run(&["remesh", "-", "-", name, value]);
        assert_eq!(refused.code, 2, "{name}");
        assert!(refused.err.contains(words), "{}", refused.err);
    }
}
