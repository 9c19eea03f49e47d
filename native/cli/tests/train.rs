//! Sets, training and evaluation as a user meets them: a set, a run, its weights, their figures.
#![cfg(feature = "train")]

mod support;

use std::fs;

use serde_json::Value;
use support::{Folder, ball, run};

/// A set of seven made shapes, one of them held back.
fn prepared(folder: &Folder) -> String {
    let set = folder.path("shapes.set");
    let done = run(&["prepare", "--procedural", "7", "-o", &set]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        done.err.contains("6 shapes to train on, 1 held back"),
        "{}",
        done.err
    );
    set
}

/// Trains for two steps; the path of the weights.
fn trained(folder: &Folder, set: &str) -> String {
    let output = folder.path("run");
    let config = folder.write("c.toml", "n_steps = 2\n");
    let done = run(&["train", set, "--config", &config, "-o", &output]);
    assert_eq!(done.code, 0, "{}", done.err);
    format!("{output}/weights.orbflow")
}

fn json(path: &str) -> Value {
    let text = fs::read_to_string(path).expect("it was written");
    serde_json::from_str(&text).expect("it is JSON")
}

#[test]
fn a_run_leaves_weights_that_embed_and_evaluate_take() {
    let folder = Folder::new();
    let set = prepared(&folder);
    let weights = trained(&folder, &set);
    for name in [
        "log.jsonl",
        "curve.svg",
        "shapes.json",
        "checkpoint/state.json",
    ] {
        assert!(fs::exists(folder.path(&format!("run/{name}"))).unwrap());
    }

    let input = folder.write("ball.obj", &ball(""));
    let report = folder.path("embed.json");
    let network = ["--predictor", "network", "--weights", &weights];
    let done = run(&[&["embed", &input, "--report", &report][..], &network].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(json(&report)["embedding"]["predictor"], "network");

    let [balls, manifest] = ["balls", "manifest.json"].map(|name| folder.path(name));
    fs::create_dir(&balls).unwrap();
    fs::write(format!("{balls}/ball.obj"), ball("")).unwrap();
    fs::write(format!("{balls}/empty.obj"), "").unwrap();
    let other = folder.path("balls.set");
    let done = run(&["prepare", &balls, "-o", &other, "--manifest", &manifest]);
    assert_eq!(done.code, 0, "{}", done.err);
    let manifest = json(&manifest);
    assert_eq!(manifest["n_left_out"], 1);
    assert_eq!(manifest["sources"][0]["name"], "balls/ball.obj");

    let report = folder.path("evaluation.json");
    let evaluate = ["evaluate", &set, "--weights", &weights, "--report", &report];
    let done = run(&[&evaluate[..], &["--other", &other, "--finish"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let figures = json(&report);
    for (side, n_shapes) in [("train", 6), ("test", 1), ("other", 1)] {
        let overall = &figures["sides"][side]["overall"];
        let proposals = &overall["proposals"];
        assert_eq!(overall["n_shapes"], n_shapes, "{side}");
        assert_eq!(proposals["solver"]["energy_ratio"], 1.0, "{side}");
        assert_eq!(proposals["solver"]["folds_pct"], 0.0, "{side}");
        assert!(proposals["network"]["energy_ratio"].as_f64().unwrap() > 0.9);
        assert_eq!(overall["whole"].is_null(), side == "train");
    }
    assert_eq!(figures["sides"]["other"]["shapes"][0]["category"], "balls");
    let done = run(&[&evaluate[..], &["--split", "test"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let sides = json(&report)["sides"].clone();
    assert_eq!(
        sides.as_object().unwrap().keys().collect::<Vec<_>>(),
        ["test"]
    );
}

#[test]
fn a_run_is_of_one_set_and_says_which() {
    let folder = Folder::new();
    let set = prepared(&folder);
    let weights = trained(&folder, &set);
    let (other, output) = (folder.path("other.set"), folder.path("run"));
    let done = run(&["prepare", "--procedural", "2", "-o", &other]);
    assert_eq!(done.code, 0, "{}", done.err);
    let config = folder.path("c.toml");
    let train = |set: &str| run(&["train", set, "--config", &config, "-o", &output]);
    let shapes = format!("{output}/shapes.json");
    let [first, text] = [&weights, &shapes].map(|path| fs::read(path).unwrap());

    let refused = train(&other);
    assert_eq!(refused.code, 3);
    assert!(refused.err.contains("another set"), "{}", refused.err);
    assert!(first == fs::read(&weights).unwrap() && text == fs::read(&shapes).unwrap());

    fs::write(&shapes, &text[..text.len() / 2]).unwrap();
    let done = train(&set);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(first == fs::read(&weights).unwrap() && text == fs::read(&shapes).unwrap());

    // Nothing of a run without a checkpoint is gone on with.
    fs::remove_dir_all(format!("{output}/checkpoint")).unwrap();
    let done = train(&other);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(json(&shapes)["n_training"], 2);
    let lines = fs::read_to_string(format!("{output}/log.jsonl")).unwrap();
    assert_eq!(lines.lines().count(), 1, "{lines}");
}

#[test]
fn the_programs_own_weights_are_measured_and_what_they_were_given_is_there_to_see() {
    let folder = Folder::new();
    let set = prepared(&folder);
    let [report, meshes] = ["evaluation.json", "meshes"].map(|name| folder.path(name));
    let evaluate = ["evaluate", &set, "--report", &report, "--split", "test"];
    let done = run(&[&evaluate[..], &["--meshes", &meshes]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let network = &json(&report)["sides"]["test"]["overall"]["proposals"]["network"];
    assert!(network["energy_ratio"].as_f64().unwrap() < 1.3, "{network}");
    let names = fs::read_dir(&meshes).unwrap();
    let mut names: Vec<String> = names
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort_unstable();
    let kinds = [
        "level",
        "level_sphere",
        "rebuilt",
        "rebuilt_sphere",
        "whole",
    ];
    assert_eq!(names.len(), kinds.len());
    for ((name, kind), n_vertices) in names.iter().zip(kinds).zip([500, 500, 1962, 1962, 8002]) {
        assert!(name.ends_with(&format!("part_0.{kind}.obj")), "{name}");
        let text = fs::read_to_string(format!("{meshes}/{name}")).unwrap();
        let n = text.lines().filter(|line| line.starts_with("v ")).count();
        assert_eq!(n, n_vertices, "{name}");
    }
}

#[cfg(unix)]
#[test]
fn a_cancelled_evaluation_says_that_meshes_were_written() {
    let folder = Folder::new();
    let set = prepared(&folder);
    let [report, meshes] = ["evaluation.json", "meshes"].map(|name| folder.path(name));
    let evaluate = ["evaluate", &set, "--report", &report, "--meshes", &meshes];
    let has_mesh = |entry: fs::DirEntry| entry.path().extension().is_some_and(|e| e == "obj");
    let ended = support::interrupt_once(&evaluate, || {
        fs::read_dir(&meshes).is_ok_and(|names| names.flatten().any(has_mesh))
    });
    let words = format!("meshes made by then are in {meshes}");
    assert_eq!(ended.code, 130);
    assert!(ended.err.contains(&words), "{}", ended.err);
    assert!(!fs::exists(report).unwrap());
}

#[test]
fn baselines_are_those_that_have_to_be_asked_for() {
    let folder = Folder::new();
    let (set, report) = (folder.path("no.set"), folder.path("evaluation.json"));
    let evaluate = ["evaluate", &set, "--report", &report];
    for (more, words) in [
        (&["--baseline", "solver"][..], "[possible values: thesis]"),
        (&["--thesis", "t.toml"], "--baseline <NAME>"),
    ] {
        let refused = run(&[&evaluate[..], more].concat());
        assert_eq!(refused.code, 2, "{}", refused.err);
        assert!(refused.err.contains(words), "{}", refused.err);
    }
}

#[test]
fn the_sets_targets_are_taken_where_they_were_made_with_the_same_settings() {
    let folder = Folder::new();
    let thesis = |name: &str, rate: f64| {
        let network = "width = 4\nn_steps = 1\n[chamfer]\nn_steps = 1\nn_samples = 50\n";
        folder.write(name, &format!("{network}rate = {rate}\n"))
    };
    let (same, other) = (thesis("same.toml", 0.25), thesis("other.toml", 0.5));
    let [set, report] = ["a.set", "evaluation.json"].map(|name| folder.path(name));
    let prepare = ["prepare", "--procedural", "7", "-o", &set];
    let targets = ["--targets", "chamfer", "--thesis"];
    let done = run(&[&prepare[..], &targets, &[&same]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    for (settings, words) in [
        (&same, "a.set: the thesis's targets are those of the set"),
        (
            &other,
            "are made now, the set's were made with other settings",
        ),
    ] {
        let evaluate = ["evaluate", &set, "--report", &report, "--split", "test"];
        let baseline = ["--baseline", "thesis", "--thesis", settings];
        let done = run(&[&evaluate[..], &baseline].concat());
        assert_eq!(done.code, 0, "{}", done.err);
        assert!(done.err.contains(words), "{}", done.err);
        let proposals = &json(&report)["sides"]["test"]["overall"]["proposals"];
        assert!(proposals["thesis_target"]["energy"].is_f64(), "{proposals}");
    }
    let refused = run(&[&prepare[..], &targets, &[&other]].concat());
    assert_eq!(refused.code, 3);
    let words = r#""rate":0.25,"n_samples":50"#;
    assert!(refused.err.contains(words), "{}", refused.err);
    let alone = run(&[&prepare[..], &["--thesis", &same]].concat());
    assert_eq!(alone.code, 2);
    assert!(alone.err.contains("--targets <NAME>"), "{}", alone.err);
}

#[test]
fn a_log_is_drawn_anew() {
    let folder = Folder::new();
    let missing = run(&["curve", &folder.path("no run")]);
    assert_eq!(missing.code, 3);
    assert!(missing.err.contains("log.jsonl"), "{}", missing.err);
    let line = r#"{"step":5,"loss":2.5,"rate":0.1,"held_out":{"n_shapes":1,"energy":2.0,"folds_pct":0.5}}"#;
    folder.write("log.jsonl", line);
    let done = run(&["curve", &folder.path(".")]);
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    let svg = fs::read_to_string(folder.path("curve.svg")).unwrap();
    assert!(svg.contains("distortion, held back"));
}

#[test]
fn what_is_no_weights_file_or_no_set_is_named() {
    let folder = Folder::new();
    let wrong = folder.write("ball.obj", &ball(""));
    let report = folder.path("evaluation.json");
    let done = run(&["evaluate", &wrong, "--weights", &wrong, "--report", &report]);
    assert_eq!(done.code, 3);
    assert!(
        done.err.contains("ball.obj: these are no weights"),
        "{}",
        done.err
    );
    let done = run(&["train", &wrong, "-o", &folder.path("run")]);
    assert_eq!(done.code, 3);
    assert!(
        done.err.contains("ball.obj is no set of orbflow"),
        "{}",
        done.err
    );
    assert_eq!(folder.names(), ["ball.obj"]);
}

#[test]
fn settings_and_devices_that_cannot_be_are_named() {
    let folder = Folder::new();
    let (set, output) = (folder.path("no.set"), folder.path("run"));
    for (text, words) in [
        ("steps = 5", "unknown field `steps`"),
        ("n_steps = 0", "n_steps = 0; it must be 1 or more"),
        ("rate = 2.0", "rate = 2; it must be above 0"),
        ("rate = nan", "rate = NaN"),
        (
            "[sizes]\nwidth = 0\nlevels = [9]\nblocks = [1]",
            "width = 0",
        ),
        (
            "[sizes]\nwidth = 8\nlevels = [9, 30]\nblocks = [1, 1]",
            "do not fall",
        ),
    ] {
        let config = folder.write("c.toml", text);
        let done = run(&["train", &set, "--config", &config, "-o", &output]);
        assert_eq!(done.code, 3, "{text}");
        assert!(done.err.contains(words), "{text}: {}", done.err);
    }
    let done = run(&["train", &set, "-o", &output, "--device", "cuda"]);
    assert_eq!(done.code, 3);
    assert!(done.err.contains("without the engine cuda"), "{}", done.err);
    assert_eq!(run(&["prepare", "-o", &set]).code, 2);
    let many = "2000000000000000000";
    let done = run(&["prepare", "--procedural", many, "-o", &set]);
    assert_eq!(done.code, 2);
    assert!(done.err.contains("0..=1000000"), "{}", done.err);
    assert_eq!(folder.names(), ["c.toml"]);
}

#[cfg(feature = "wgpu")]
#[test]
fn a_gpu_is_named_and_what_it_trained_can_be_had_without_it() {
    let folder = Folder::new();
    let set = prepared(&folder);
    let config = folder.write("c.toml", "n_steps = 2\n");
    let output = folder.path("run");
    let weights = |device: &str| {
        let train = ["train", &set, "--config", &config, "-o", &output];
        let done = run(&[&train[..], &["--device", device]].concat());
        assert_eq!(done.code, 0, "{device}: {}", done.err);
        assert_eq!(done.err.contains("training on "), device == "wgpu");
        fs::read(format!("{output}/weights.orbflow")).unwrap()
    };
    // The second call finds all steps done and reads the checkpoint alone.
    assert_eq!(weights("wgpu"), weights("cpu"));
}

#[test]
fn a_set_too_coarse_for_the_levels_is_refused_with_what_would_do() {
    let folder = Folder::new();
    let set = folder.path("coarse.set");
    let done = run(&["prepare", "--procedural", "1", "--faces", "400", "-o", &set]);
    assert_eq!(done.code, 0, "{}", done.err);
    let done = run(&["train", &set, "-o", &folder.path("run")]);
    assert_eq!(done.code, 3);
    assert!(
        done.err.contains("prepare it with --faces 3000"),
        "{}",
        done.err
    );
}
