//! Scenes and texture coordinates through the program.

#![allow(clippy::unwrap_used)] // What helps tests is a test.

mod support;

use std::fs;
use std::path::Path;

use gltf::Gltf;
use support::{BALL_FACES, Folder, ball, run, run_with_input};

/// A ball with texture coordinates from above, two materials and a library.
fn painted() -> String {
    let text = ball("");
    let lines = |start: &'static str| text.lines().filter(move |line| line.starts_with(start));
    let coordinates = lines("v ").map(|line| {
        let numbers: Vec<f64> = line
            .split(' ')
            .filter_map(|word| word.parse().ok())
            .collect();
        format!("vt {} {}", 0.5 + 0.3 * numbers[0], 0.5 + 0.3 * numbers[1])
    });
    let faces = lines("f ").enumerate().map(|(i, line)| {
        let corners = line.split(' ').skip(1).map(|v| format!("{v}/{v}"));
        let corners: Vec<String> = corners.collect();
        let paint = match i {
            0 => "usemtl red paint\n",
            _ if i == BALL_FACES / 2 => "usemtl blue\n",
            _ => "",
        };
        format!("{paint}f {}", corners.join(" "))
    });
    let library = "mtllib my paints.mtl".to_owned();
    let vertices = lines("v ").map(str::to_owned);
    let all: Vec<String> = [library]
        .into_iter()
        .chain(vertices)
        .chain(coordinates)
        .chain(faces)
        .collect();
    all.join("\n") + "\n"
}

/// How far the texture coordinates of an OBJ file are from those of [`painted`] at most.
fn farthest(text: &str) -> f64 {
    let numbers = |start: &str| -> Vec<Vec<f64>> {
        let lines = text.lines().filter_map(|line| line.strip_prefix(start));
        lines
            .map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect())
            .collect()
    };
    let (points, coordinates) = (numbers("v "), numbers("vt "));
    let mut farthest = 0.0f64;
    let corners = text.lines().filter_map(|line| line.strip_prefix("f "));
    for corner in corners.flat_map(|line| line.split(' ')) {
        let (v, vt) = corner
            .split_once('/')
            .expect("every corner has texture coordinates");
        let index = |word: &str| word.parse::<usize>().unwrap() - 1;
        let (p, c) = (&points[index(v)], &coordinates[index(vt)]);
        for i in 0..2 {
            farthest = farthest.max((c[i] - 0.5 - 0.3 * p[i]).abs());
        }
    }
    farthest
}

#[test]
fn obj_keeps_texture_coordinates_materials_and_libraries() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &painted());
    let output = folder.path("low.obj");
    let ended = run(&["remesh", &input, &output, "--faces", "400"]);
    assert_eq!(ended.code, 0, "{}", ended.err);
    let text = fs::read_to_string(output).unwrap();
    assert!(text.starts_with("mtllib my paints.mtl\n"));
    assert!(text.contains("\nusemtl red paint\n") && text.contains("\nusemtl blue\n"));
    // Faces across the border of the materials take the coordinates of the border.
    let off = farthest(&text);
    assert!(off < 0.15, "{off}");
}

#[test]
fn a_scene_goes_in_and_out_through_files_and_streams() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &painted());
    let glb = folder.path("ball.glb");
    let faces = BALL_FACES.to_string();
    let made = run(&["decimate", &input, &glb, "--faces", &faces]);
    assert_eq!(made.code, 0, "{}", made.err);
    let names = |path: &str| -> Vec<String> {
        let Gltf { document, .. } = Gltf::open(Path::new(path)).unwrap();
        let names = document
            .materials()
            .filter_map(|material| material.name().map(str::to_owned));
        names.collect()
    };
    assert_eq!(names(&glb), ["red paint", "blue"]);
    let low = folder.path("low.glb");
    let ended = run(&["remesh", &glb, &low, "--faces", "400"]);
    assert_eq!(ended.code, 0, "{}", ended.err);
    assert!(
        ended.err.contains("polygons are cut into triangles"),
        "{}",
        ended.err
    );
    assert_eq!(names(&low), ["red paint", "blue"]);
    let bytes = fs::read(&glb).unwrap();
    let piped = [
        "remesh",
        "-",
        "-",
        "--faces",
        "400",
        "--output-format",
        "glb",
    ];
    let streamed = run_with_input(&piped, &bytes);
    assert_eq!(streamed.code, 0, "{}", streamed.err);
    assert!(streamed.out == fs::read(&low).unwrap());
    let text = run_with_input(&["decimate", "-", "-", "--faces", "300"], &bytes);
    assert_eq!(text.code, 0, "{}", text.err);
    let text = String::from_utf8(text.out).unwrap();
    assert!(text.contains("usemtl blue\n"));
    let off = farthest(&text);
    assert!(off < 0.15, "{off}");
}

#[test]
fn every_verb_reads_a_scene() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &painted());
    let [glb, report, sphere] =
        ["ball.gltf", "map.json", "sphere.glb"].map(|name| folder.path(name));
    let made = run(&["decimate", &input, &glb, "--faces", "300"]);
    assert_eq!(made.code, 0, "{}", made.err);
    let embedded = run(&["embed", &glb, "--report", &report, "--sphere", &sphere]);
    assert_eq!(embedded.code, 0, "{}", embedded.err);
    Gltf::open(Path::new(&sphere)).unwrap();
    let scored = run(&["score", &input, &glb]);
    assert_eq!(scored.code, 0, "{}", scored.err);
    assert!(!scored.out.is_empty());
}

#[test]
fn a_broken_scene_is_refused_with_its_numbers() {
    let folder = Folder::new();
    let broken = folder.path("broken.glb");
    fs::write(&broken, b"glTF\x02\0\0\0\x10\x27\0\0").unwrap();
    let ended = run(&["remesh", &broken, &folder.path("low.glb")]);
    assert_eq!(ended.code, 3);
    let wanted = format!("orbflow: {broken}: the file should have 10000 bytes, but 12 are there\n");
    assert_eq!(ended.err, wanted);
    assert_eq!(folder.names(), ["broken.glb"]);
    let wrong = run(&["remesh", &broken, &folder.path("low.fbx")]);
    assert_eq!(wrong.code, 2);
    assert!(wrong.err.contains(".glb"), "{}", wrong.err);
}
