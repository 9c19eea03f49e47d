//! The program as a user meets it: files in, files out, exit codes, words on standard error.

mod support;

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use support::{BALL_FACES, Folder, ball, run, run_with_input};

#[test]
fn remesh_writes_mesh_sphere_and_report() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let [output, sphere, report] = ["out.obj", "sphere.ply", "report.json"].map(|n| folder.path(n));
    let files = [
        "remesh", &input, &output, "--sphere", &sphere, "--report", &report,
    ];
    let done = run(&[&files[..], &["--faces", "600", "--threads", "1"]].concat());
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    let report: Value = serde_json::from_str(&fs::read_to_string(report).unwrap()).unwrap();
    let told = &report["output"];
    assert_eq!(told["closed"], true);
    assert_eq!(told["genus"], 0);
    assert_eq!(told["n_quads"], told["n_faces"]);
    assert!((told["n_faces"].as_f64().unwrap() / 600.0 - 1.0).abs() < 0.02);
    assert_eq!(report["input"]["n_faces"], BALL_FACES);
    assert_eq!(report["embedding"]["degree"], 1);
    assert_eq!(report["embedding"]["n_folds"], 0);
    assert_eq!(report["embedding"]["predictor"], "solver");
    for key in ["n_vertices", "energy", "n_relaxations", "proposal"] {
        assert!(!report["embedding"][key].is_null(), "{key}");
    }
    assert!(report["score"]["chamfer_pct"].as_f64().is_some());
    let steps = report["steps"].as_array().unwrap();
    assert!(!steps.is_empty() && steps.iter().all(|step| step["time_ms"].is_number()));
    assert_eq!(report["version"], env!("CARGO_PKG_VERSION"));
    let text = fs::read_to_string(output).unwrap();
    assert_eq!(told["n_faces"], count_faces(&text));
    assert!(
        fs::read(sphere)
            .unwrap()
            .starts_with(b"ply\nformat binary_little_endian")
    );
    assert_eq!(
        folder.names(),
        ["ball.obj", "out.obj", "report.json", "sphere.ply"]
    );
}

#[test]
fn the_same_bytes_come_out_twice_and_with_any_number_of_threads() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let arguments = [
        "remesh",
        &input,
        "-",
        "--faces",
        "200",
        "--kind",
        "triangles",
        "--threads",
    ];
    let results = ["1", "2", "2"].map(|threads| {
        let done = run(&[&arguments[..], &[threads]].concat());
        assert_eq!(done.code, 0, "{}", done.err);
        done.out
    });
    assert!(results[0] == results[1] && results[1] == results[2]);
}

#[test]
fn the_same_bytes_come_out_on_a_processor_that_can_do_less() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    // To the C library; it picks its functions by what the processor can do.
    let results = [
        "",
        "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX2_Usable,-FMA_Usable",
    ]
    .map(|less| {
        let done = Command::new(env!("CARGO_BIN_EXE_orbflow"))
            .args(["remesh", &input, "-", "--faces", "300"])
            .env("GLIBC_TUNABLES", less)
            .output()
            .unwrap();
        assert!(done.status.success());
        done.stdout
    });
    assert!(results[0] == results[1]);
}

#[test]
fn standard_streams_carry_every_format() {
    let arguments = [
        "decimate",
        "-",
        "-",
        "--faces",
        "100",
        "--output-format",
        "off",
    ];
    let off = run_with_input(&arguments, ball("").as_bytes());
    assert_eq!((off.code, off.err.as_str()), (0, ""));
    assert!(off.out.starts_with(b"OFF\n"));
    let arguments = [
        "decimate",
        "-",
        "-",
        "--faces",
        "50",
        "--output-format",
        "ply",
    ];
    let ply = run_with_input(&arguments, &off.out);
    assert!(ply.out.starts_with(b"ply\n"), "{}", ply.err);
    let obj = run_with_input(&["decimate", "-", "-", "--faces", "50"], &ply.out);
    assert_eq!(obj.code, 0, "{}", obj.err);
    assert_eq!(count_faces(std::str::from_utf8(&obj.out).unwrap()), 50);
}

#[test]
fn embed_writes_a_report_and_the_sphere() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let sphere = folder.path("sphere.obj");
    let done = run(&["embed", &input, "--report", "-", "--sphere", &sphere]);
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    let report: Value = serde_json::from_slice(&done.out).unwrap();
    assert_eq!(report["embedding"]["degree"], 1);
    let text = fs::read_to_string(sphere).unwrap();
    for line in text.lines().filter_map(|line| line.strip_prefix("v ")) {
        let squares = line.split(' ').map(|x| x.parse::<f64>().unwrap().powi(2));
        assert!((squares.sum::<f64>() - 1.0).abs() < 1e-9, "{line}");
    }
}

#[test]
fn embed_chooses_nothing_at_random() {
    let refused = run(&["embed", "-", "--report", "-", "--seed", "1"]);
    assert_eq!(refused.code, 2);
    assert!(refused.err.contains("'--seed'"), "{}", refused.err);
}

#[test]
fn score_prints_figures_or_writes_them() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let report = folder.path("r.json");
    let printed = run(&["score", &input, &input]);
    assert_eq!((printed.code, printed.err.as_str()), (0, ""));
    let text = String::from_utf8(printed.out).unwrap();
    assert!(
        text.lines().any(|line| line.starts_with("chamfer_pct ")),
        "{text}"
    );
    assert_eq!(run(&["score", &input, &input, "--report", &report]).code, 0);
    let report: Value = serde_json::from_str(&fs::read_to_string(report).unwrap()).unwrap();
    assert_eq!(report["same_topology"], true);
}

#[test]
fn materials_are_carried_over_by_name() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball("usemtl red paint\n"));
    for verb in ["decimate", "remesh"] {
        let output = folder.path("out.obj");
        let done = run(&[verb, &input, &output, "--faces", "100"]);
        assert_eq!(done.code, 0, "{}", done.err);
        let text = fs::read_to_string(&output).unwrap();
        assert!(text.contains("usemtl red paint\nf "), "{verb}");
    }
}

#[test]
fn wrong_usage_ends_with_2_and_writes_nothing() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let [obj, stl, bare] = ["out.obj", "out.stl", "out"].map(|name| folder.path(name));
    let remesh = ["remesh", &input, &obj];
    let remesh = |more: &[&'static str]| -> Vec<String> {
        remesh
            .iter()
            .chain(more)
            .map(|word| (*word).to_owned())
            .collect()
    };
    let owned = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
    let cases: Vec<(Vec<String>, &str)> = vec![
        (owned(&[]), "Usage"),
        (owned(&["remesh", &input]), "OUT"),
        (remesh(&["--faces", "3"]), "4..=4000000"),
        (remesh(&["--faces", "4000001"]), "4..=4000000"),
        (remesh(&["--faces", "many"]), "many"),
        (remesh(&["--kind", "hexagons"]), "triangles, quads"),
        (remesh(&["--predictor", "magic"]), "solver"),
        (
            remesh(&["--primitive", "icosphere", "--kind", "quads"]),
            "icosphere",
        ),
        (
            owned(&["remesh", &input, &stl]),
            "must end in .obj, .ply, .off, .glb or .gltf",
        ),
        (
            owned(&["remesh", &input, &bare]),
            "must end in .obj, .ply, .off, .glb or .gltf",
        ),
        (
            owned(&["remesh", &input, "-", "--report", "-"]),
            "written twice",
        ),
        (
            owned(&["remesh", &input, &obj, "--sphere", &obj]),
            "written twice",
        ),
        (owned(&["score", "-", "-"]), "read twice"),
        (owned(&["decimate", &input, &obj]), "--faces"),
        (owned(&["embed", &input]), "--report"),
    ];
    for (arguments, words) in cases {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let refused = run(&arguments);
        assert_eq!(refused.code, 2, "{arguments:?}");
        assert!(
            refused.err.contains(words),
            "{arguments:?}: {}",
            refused.err
        );
    }
    assert_eq!(folder.names(), ["ball.obj"]);
}

#[test]
fn help_and_version_are_answers() {
    let help = run(&["remesh", "--help"]);
    assert_eq!(help.code, 0);
    let text = String::from_utf8(help.out).unwrap();
    assert!(
        text.contains("Exit codes") && text.contains("standard input"),
        "{text}"
    );
    assert_eq!(run(&["--version"]).code, 0);
}

#[test]
fn files_that_cannot_be_opened_or_written_end_with_3() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let missing = folder.path("missing.obj");
    let refused = run(&["remesh", &missing, "-"]);
    assert_eq!(refused.code, 3);
    assert!(refused.err.contains("cannot read") && refused.err.contains("missing.obj"));
    let nowhere = folder.path("no/such/folder/out.obj");
    let refused = run(&["decimate", &input, &nowhere, "--faces", "100"]);
    assert_eq!(refused.code, 3);
    assert!(refused.err.contains("cannot write"), "{}", refused.err);
}

#[test]
fn a_failure_leaves_the_old_output_as_it_was() {
    let folder = Folder::new();
    let flat = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let input = folder.write("flat.obj", flat);
    let output = folder.write("out.obj", "precious");
    let refused = run(&["remesh", &input, &output]);
    assert_eq!(refused.code, 3);
    assert!(
        refused.err.contains("3 different points"),
        "{}",
        refused.err
    );
    assert_eq!(fs::read_to_string(output).unwrap(), "precious");
    assert_eq!(folder.names(), ["flat.obj", "out.obj"]);
}

#[cfg(unix)]
#[test]
fn an_output_keeps_its_mode_and_a_link_stays_a_link() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let real = folder.write("real.obj", "old");
    let link = folder.path("link.obj");
    symlink(&real, &link).unwrap();
    fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
    assert_eq!(run(&["decimate", &input, &link, "--faces", "100"]).code, 0);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(
        fs::metadata(&real).unwrap().permissions().mode() & 0o777,
        0o640
    );
    assert!(fs::read_to_string(&real).unwrap().starts_with("v "));
    let device = [
        "decimate",
        &input,
        "/dev/null",
        "--faces",
        "9",
        "--output-format",
        "obj",
    ];
    assert_eq!(run(&device).code, 0);
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn every_broken_file_ends_with_a_result_or_with_words() {
    let folder = Folder::new();
    let done = [
        "duplicate_face",
        "duplicate_vertices",
        "edge_shared_by_three",
        "far_from_origin",
        "flat",
        "flipped_face",
        "huge_scale",
        "inside_out",
        "isolated_vertex",
        "missing_face",
        "negative_indices",
        "self_intersecting",
        "tiny_scale",
        "two_boxes_sharing_a_vertex",
        "zero_area_faces",
    ];
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("../geometry/tests/bad");
    for entry in fs::read_dir(files).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        if path.extension().is_none_or(|ending| ending != "obj") {
            continue;
        }
        let output = folder.path(&format!("{name}.ply"));
        let result = run(&["remesh", path.to_str().unwrap(), &output, "--faces", "60"]);
        let wanted = if done.contains(&name) { 0 } else { 3 };
        assert_eq!(result.code, wanted, "{name}: {}", result.err);
        assert_eq!(Path::new(&output).exists(), wanted == 0, "{name}");
        assert!(!result.err.contains("panicked"), "{name}: {}", result.err);
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_with_130_and_writes_nothing() {
    support::interrupt_while_working();
    support::interrupt_while_reading();
}

fn count_faces(obj: &str) -> usize {
    obj.lines().filter(|line| line.starts_with("f ")).count()
}

#[test]
fn densities_are_read_from_text_and_named_when_wrong() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let [output, list] = ["out.obj", "list.txt"].map(|name| folder.path(name));
    let vertices = ball("");
    let vertices = vertices.lines().filter_map(|line| line.strip_prefix("v "));
    let right = |line: &str| u8::from(!line.starts_with('-')).to_string();
    let right: Vec<String> = vertices.map(right).collect();
    let with = |text: &str, faces: &str| {
        fs::write(&list, text).unwrap();
        run(&[
            "remesh",
            &input,
            &output,
            "--density",
            &list,
            "--faces",
            faces,
        ])
    };
    let done = with("0 1\nhalf", "300");
    assert_eq!(done.code, 3);
    assert!(
        done.err
            .contains("list.txt, line 2: 'half' is not a number"),
        "{}",
        done.err
    );
    let done = with("0 1", "300");
    assert!(done.err.contains("2 densities for"), "{}", done.err);
    assert_eq!(folder.names(), ["ball.obj", "list.txt"]);
    let done = with(&right.join("\n"), "300");
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    let text = fs::read_to_string(&output).unwrap();
    let lines = text.lines().filter_map(|line| line.strip_prefix("v "));
    let [n_left, n_right] = lines.fold([0, 0], |mut n, line| {
        n[usize::from(!line.starts_with('-'))] += 1;
        n
    });
    assert!(2 * n_right > 3 * n_left, "{n_left} {n_right}");
}
