//! What the program says of results that are not as they were to be, and of files of other programs.

mod support;

use std::fs;

use orbflow_geometry::elementary::sin_cos;
use serde_json::Value;
use support::{Folder, ball, run};

/// A ball with a horn on one side.
fn horned() -> String {
    let ball = ball("");
    let drawn = |line: &str| match line.strip_prefix("v ") {
        Some(numbers) => {
            let p: Vec<f64> = numbers
                .split(' ')
                .map(|x| x.parse().expect("a number"))
                .collect();
            let x = p[0] + 4.0 * (p[0] - 0.7).max(0.0);
            format!("v {x} {} {}\n", p[1], p[2])
        }
        None => format!("{line}\n"),
    };
    ball.lines().map(drawn).collect()
}

#[test]
fn a_mirror_that_replaced_a_side_is_told_and_refused_by_strict() {
    let folder = Folder::new();
    let input = folder.write("horn.obj", &horned());
    let [output, report] = ["out.obj", "r.json"].map(|name| folder.path(name));
    let wanted = [
        "remesh", &input, &output, "--faces", "200", "--mirror", "x", "--report", &report,
    ];
    let strict = run(&[&wanted[..], &["--strict"]].concat());
    assert_eq!(strict.code, 3, "{}", strict.err);
    assert_eq!(folder.names(), ["horn.obj", "r.json"]);
    let done = run(&wanted);
    assert_eq!(done.code, 0, "{}", done.err);
    let told: Value = serde_json::from_str(&fs::read_to_string(report).unwrap()).unwrap();
    let told = told["warnings"].as_array().unwrap();
    let kinds: Vec<&str> = told.iter().map(|w| w["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["far", "mirror-replaced"]);
    for warning in told {
        let text = warning["text"].as_str().unwrap();
        let line = format!("horn.obj: warning: {text}\n");
        assert!(
            done.err.contains(&line) && strict.err.contains(text),
            "{}",
            done.err
        );
    }
}

#[test]
fn a_refused_mirror_is_told_and_no_reason_to_stop() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let wanted = [
        "remesh",
        &input,
        "-",
        "--faces",
        "200",
        "--kind",
        "triangles",
    ];
    let done = run(&[&wanted[..], &["--mirror", "x", "--strict"]].concat());
    let words = "ball.obj: warning: 1 part is not made symmetric (only quads that flow can be)\n";
    assert_eq!(
        (done.code, done.err.ends_with(words)),
        (0, true),
        "{}",
        done.err
    );
}

#[test]
fn files_of_other_programs_are_named_and_what_to_do_with_them() {
    let folder = Folder::new();
    let words =
        "open it in Blender, where the add-on does the same, or convert it to GLB, OBJ or PLY";
    for (file, text, name) in [
        ("fox.obj", "Kaydara FBX Binary  \0", "FBX"),
        ("fox.dae", "<?xml?><COLLADA>", "Collada"),
    ] {
        let input = folder.write(file, text);
        for verb in [&["remesh", &input, "-"][..], &["score", &input, &input]] {
            let refused = run(verb);
            assert_eq!(refused.code, 3, "{file}");
            let said = format!("{file}: a {name} file cannot be read; {words}");
            assert!(refused.err.contains(&said), "{file}: {}", refused.err);
        }
    }
    // Whoever names the format means it.
    let given = [
        "score",
        &folder.path("fox.obj"),
        "-",
        "--input-format",
        "obj",
    ];
    let told = run(&given).err;
    assert!(!told.contains("cannot be read"), "{told}");
}

#[test]
fn lost_rings_of_a_file_are_told_of_and_refused_by_strict() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let points = (0..12).map(|i| {
        let (sin, cos) = sin_cos(f64::from(i) * std::f64::consts::TAU / 12.0);
        format!("v {} {} 0.1", 3.0 * cos, 3.0 * sin)
    });
    let points: Vec<String> = points.collect();
    let ids: Vec<String> = (1..=12).map(|i| i.to_string()).collect();
    let ring = format!("{}\nl {} 1\n", points.join("\n"), ids.join(" "));
    let far = folder.write("far.obj", &ring);
    let [output, report] = ["out.obj", "r.json"].map(|name| folder.path(name));
    let wanted = [
        "remesh", &input, &output, "--faces", "300", "--report", &report, "--guides",
    ];
    let lost = run(&[&wanted[..], &[&far, "--guides-strength", "follow"]].concat());
    assert_eq!(lost.code, 0, "{}", lost.err);
    assert!(
        lost.err.contains("warning: guide 0 is lost: it is "),
        "{}",
        lost.err
    );
    let strict = run(&[&wanted[..], &[&far, "--strict"]].concat());
    assert_eq!(strict.code, 3, "{}", strict.err);
    let none = folder.write("none.obj", "v 0 0 0\n");
    let told: Value = serde_json::from_str(&fs::read_to_string(&report).unwrap()).unwrap();
    assert_eq!(told["guides"][0]["strength"], "exact");
    let refused = run(&[&wanted[..], &[&none]].concat());
    assert_eq!(refused.code, 3, "{}", refused.err);
    assert!(
        refused.err.contains("there is no line in it"),
        "{}",
        refused.err
    );
}
