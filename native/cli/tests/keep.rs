//! What the program does with faces that are to be kept.

mod support;

use std::fs;

use serde_json::Value;
use support::{BALL_FACES, Folder, ball, run};

/// The places of the corners of an OBJ's faces, bit for bit.
fn places(text: &str) -> Vec<Vec<[u64; 3]>> {
    let numbers = |line: &str| -> Vec<f64> {
        let words = line.split_whitespace().skip(1);
        words.map(|word| word.parse().expect("a number")).collect()
    };
    let points = text.lines().filter(|line| line.starts_with("v "));
    let points: Vec<Vec<f64>> = points.map(numbers).collect();
    let corner = |word: &str| {
        let number = word.split('/').next().unwrap_or(word);
        let place = &points[number.parse::<usize>().expect("a number") - 1];
        [0, 1, 2].map(|axis| place[axis].to_bits())
    };
    let faces = text.lines().filter_map(|line| line.strip_prefix("f "));
    faces
        .map(|face| face.split(' ').map(corner).collect())
        .collect()
}

#[test]
fn named_faces_are_in_the_result_as_they_were() {
    let folder = Folder::new();
    let given = ball("");
    let input = folder.write("ball.obj", &given);
    // One side of a blown up cube but its first row.
    let keep = folder.write("keep.txt", "12-140\n141 142\n143\n");
    let [output, report] = ["out.obj", "report.json"].map(|name| folder.path(name));
    let remesh = [
        "remesh", &input, &output, "--keep", &keep, "--report", &report,
    ];
    let done = run(&[&remesh[..], &["--faces", "400"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        done.err.contains("132 faces kept, joined along "),
        "{}",
        done.err
    );
    let report: Value = serde_json::from_str(&fs::read_to_string(&report).unwrap()).unwrap();
    assert_eq!(report["kept_faces"]["n_faces"], 132);
    assert_eq!(report["output"]["closed"], true);
    assert_eq!(report["output"]["genus"], 0);
    let made = places(&fs::read_to_string(&output).unwrap());
    let before = places(&given);
    assert_eq!(made[made.len() - 132..], before[12..144]);
}

#[test]
fn numbers_that_name_no_faces_are_refused() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let output = folder.path("out.obj");
    for (text, word) in [
        ("3\n5 x7", "x7"),
        ("9-2", "9-2"),
        ("864", "864"),
        ("1-9999", "1-9999"),
    ] {
        let keep = folder.write("keep.txt", text);
        let done = run(&["remesh", &input, &output, "--keep", &keep]);
        assert_ne!(done.code, 0);
        let wanted = format!("'{word}' names no faces; there are {BALL_FACES}, from 0 on");
        assert!(done.err.contains(&wanted), "{}", done.err);
    }
    assert!(!folder.names().contains(&"out.obj".to_owned()));
}
