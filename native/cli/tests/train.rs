//! Training and evaluation as a user meets them: a run, its weights, their figures.
#![cfg(feature = "train")]

mod support;

use std::fs;

use serde_json::Value;
use support::{Folder, ball, run};

/// Trains for two steps on three made shapes; the path of the weights.
fn trained(folder: &Folder) -> String {
    let output = folder.path("run");
    let shapes = ["--shapes", "2", "--held-out", "1"];
    let arguments = [&["train", "-o", &output, "--steps", "2"][..], &shapes].concat();
    let done = run(&arguments);
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
    let weights = trained(&folder);
    for name in ["log.jsonl", "shapes.json", "checkpoint/state.json"] {
        assert!(fs::exists(folder.path(&format!("run/{name}"))).unwrap());
    }

    let input = folder.write("ball.obj", &ball(""));
    let report = folder.path("embed.json");
    let network = ["--predictor", "network", "--weights", &weights];
    let done = run(&[&["embed", &input, "--report", &report][..], &network].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(json(&report)["embedding"]["predictor"], "network");

    let report = folder.path("evaluation.json");
    let (balls, shapes) = (folder.path("balls"), ["--shapes", "2", "--held-out", "1"]);
    fs::create_dir(&balls).unwrap();
    fs::write(format!("{balls}/ball.obj"), ball("")).unwrap();
    fs::write(format!("{balls}/empty.obj"), "").unwrap();
    let evaluate = ["evaluate", "--weights", &weights, "--report", &report];
    let others = ["--other", &balls, "--finish"];
    let done = run(&[&evaluate[..], &shapes, &others].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let figures = json(&report);
    for (side, n_shapes) in [("training", 2), ("held_out", 1), ("other", 1)] {
        let overall = &figures["sides"][side]["overall"];
        assert_eq!(overall["n_shapes"], n_shapes, "{side}");
        assert_eq!(overall["solver"]["energy_ratio"], 1.0, "{side}");
        assert_eq!(overall["solver"]["folds_pct"], 0.0, "{side}");
        assert!(overall["network"]["energy_ratio"].as_f64().unwrap() > 0.9);
        assert_eq!(overall["whole"].is_null(), side == "training");
    }
    assert_eq!(figures["sides"]["other"]["shapes"][0]["category"], "balls");
    assert_eq!(figures["left_out"].as_array().unwrap().len(), 1);
}

#[test]
fn what_is_no_weights_file_is_named() {
    let folder = Folder::new();
    let wrong = folder.write("ball.obj", &ball(""));
    let report = folder.path("evaluation.json");
    let done = run(&["evaluate", "--weights", &wrong, "--report", &report]);
    assert_eq!(done.code, 3);
    assert!(done.err.contains("ball.obj"), "{}", done.err);
    assert_eq!(folder.names(), ["ball.obj"]);
}
