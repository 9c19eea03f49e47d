//! Prediction alone: a mesh of the network's proposal, or words; and weights that nothing reads.

mod support;

use std::fs;

use orbflow_network::net::Sizes;
use orbflow_network::weights::Weights;
use serde_json::Value;
use support::{Folder, ball, run};

#[test]
fn predict_makes_a_mesh_of_the_proposal_and_tells_what_it_cost() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let [output, report] = ["out.obj", "r.json"].map(|name| folder.path(name));
    let files = ["predict", &input, &output, "--report", &report];
    let done = run(&[&files[..], &["--faces", "200"]].concat());
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    let report: Value = serde_json::from_str(&fs::read_to_string(report).unwrap()).unwrap();
    let embedding = &report["embedding"];
    assert_eq!(embedding["predictor"], "network");
    assert_eq!(embedding["repair"]["fell_back_to_solver"], false);
    for told in ["energy", "n_folds", "n_vertices"] {
        assert!(embedding["proposal"][told].is_number(), "{told}");
    }
    assert!(embedding["repair"]["n_moved"].is_number() && embedding["n_relaxations"].is_number());
    assert_eq!(embedding["weights"]["shipped"], true);
    for told in ["propose_ms", "repair_ms", "relax_ms"] {
        assert!(embedding["times"][told].is_number(), "{told}");
    }
    assert!(fs::exists(output).unwrap());
}

#[test]
fn a_file_of_the_programs_own_weights_changes_no_byte() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let weights = folder.path("own.orbflow");
    fs::write(&weights, Weights::shipped().to_bytes()).unwrap();
    for verb in [&["predict"][..], &["remesh", "--predictor", "network"]] {
        let own = [verb, &[&input, "-", "--faces", "200"]].concat();
        let [own, given] = [own.clone(), [&own[..], &["--weights", &weights]].concat()];
        let [own, given] = [own, given].map(|arguments| run(&arguments));
        assert_eq!((own.code, given.code), (0, 0), "{}", own.err);
        assert!(own.out == given.out && !own.out.is_empty());
    }
}

/// Weights that send every vertex to one place.
#[test]
fn predict_says_that_a_proposal_was_no_use_and_writes_the_report_alone() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let mut weights = Weights::shipped();
    // Before the gates, which come last, stands the bias of the head.
    let without_gates = Sizes {
        relaxations: 0,
        ..weights.header.sizes.clone()
    };
    let end = without_gates.n_parameters().unwrap();
    weights.parameters[end - 3..end].copy_from_slice(&[6e4, 0.0, 0.0]);
    let [path, output, report] = ["bad.orbflow", "out.obj", "r.json"].map(|n| folder.path(n));
    fs::write(&path, weights.to_bytes()).unwrap();
    let files = ["predict", &input, &output, "--weights", &path];
    let refused = run(&[&files[..], &["--report", &report, "--faces", "200"]].concat());
    assert_eq!(refused.code, 3, "{}", refused.err);
    let words = "ball.obj: the proposal for part 1 of 1 is beyond repair";
    assert!(refused.err.contains(words), "{}", refused.err);
    assert_eq!(folder.names(), ["bad.orbflow", "ball.obj", "r.json"]);
    let report: Value = serde_json::from_str(&fs::read_to_string(report).unwrap()).unwrap();
    let told = &report["embedding"]["weights"];
    let sum = format!("{:016x}", weights.sum());
    assert_eq!(
        (&told["sum"], &told["shipped"]),
        (&sum.into(), &false.into())
    );
    // Remesh does it all the same, by the solver.
    let files = ["remesh", &input, &output, "--predictor", "network"];
    let done = run(&[&files[..], &["--weights", &path, "--faces", "200"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
}

#[test]
fn weights_are_refused_for_the_solver() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    for verb in [["remesh", &input, "-"], ["embed", &input, "--report=-"]] {
        let refused = run(&[&verb[..], &["--predictor=solver", "--weights=w"]].concat());
        assert_eq!(refused.code, 2, "{verb:?}");
        let words = "--weights is not for --predictor solver";
        assert!(refused.err.contains(words), "{}", refused.err);
    }
}
