//! Compares scores with the figures of an independent tool, recorded in `score/figures.json` by
//! `score/make.py`.

use std::fs;
use std::path::{Path, PathBuf};

use orbflow_geometry::mesh::PolygonMesh;
use orbflow_geometry::mesh::io::{self, Format};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::score::{Settings, score};
use serde_json::{Map, Value};

/// Figures from samples, which differ between the tools, and by how much they may: a share of
/// the figure and, for those that are shares themselves, an absolute part.
const SAMPLED: [(&str, f64, f64); 7] = [
    ("chamfer_pct", 0.01, ROUNDING),
    ("chamfer_at_target_pct", 0.01, ROUNDING),
    ("p95_pct", 0.02, ROUNDING),
    ("hausdorff_pct", 0.1, ROUNDING),
    ("normal_consistency", 0.0, 0.005),
    ("f1_at_0.5_pct", 0.0, 1.0),
    ("f1_at_1_pct", 0.0, 1.0),
];
/// Figures of quads, which the tool makes of any polygons: none where there are no quads.
const OF_QUADS: [&str; 7] = [
    "alignment_deg",
    "chain_edge_median",
    "chain_mean",
    "chain_median",
    "high_valence",
    "irregular_pct",
    "loop_edges_pct",
];
/// Figures that the tool does not have.
const OWN: [&str; 1] = ["border_irregular_pct"];
/// How far exact figures may be apart, as a share: the order of sums differs.
const ROUNDING: f64 = 1e-9;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/score")
}

fn read(name: &str) -> PolygonMesh {
    let bytes = fs::read(folder().join(name)).expect("a mesh of the folder");
    io::read(&bytes, Format::Obj).expect("a valid file").mesh
}

fn recorded() -> Map<String, Value> {
    let text = fs::read_to_string(folder().join("figures.json")).expect("the recorded figures");
    serde_json::from_str(&text).expect("an object of objects")
}

fn scored(name: &str, target: usize) -> Map<String, Value> {
    let [input, output] = ["input", "output"].map(|role| read(&format!("{name}_{role}.obj")));
    let settings = Settings {
        target: Some(target),
        ..Settings::default()
    };
    let found = score(&input, &output, &settings, &Progress::none()).expect("a score");
    let Ok(Value::Object(found)) = serde_json::to_value(found) else {
        panic!("a score is an object");
    };
    found
}

fn agrees(figure: &str, found: &Value, wanted: &Value) -> bool {
    let (Some(a), Some(b)) = (found.as_f64(), wanted.as_f64()) else {
        return found == wanted;
    };
    let sampled = SAMPLED.iter().find(|(name, ..)| *name == figure);
    let (share, absolute) = sampled.map_or((ROUNDING, ROUNDING), |&(_, share, abs)| (share, abs));
    (a - b).abs() <= share * b.abs() + absolute
}

#[test]
fn every_figure_agrees_with_the_recorded_one() {
    let mut faults = Vec::new();
    let all = recorded();
    for (name, wanted) in &all {
        let wanted = wanted.as_object().expect("an object");
        let found = scored(name, wanted["target"].as_u64().expect("a count") as usize);
        let is_theirs = |figure: &String| !OWN.contains(&figure.as_str());
        for (figure, found) in found.iter().filter(|(figure, _)| is_theirs(figure)) {
            let is_meant = wanted["quads_pct"] != 0.0 || !OF_QUADS.contains(&figure.as_str());
            let wanted = wanted.get(figure).filter(|_| is_meant);
            let wanted = wanted.unwrap_or(&Value::Null);
            if !agrees(figure, found, wanted) {
                faults.push(format!("{name} {figure}: {found} instead of {wanted}"));
            }
        }
        let missing = wanted
            .keys()
            .filter(|key| *key != "target" && !found.contains_key(*key));
        faults.extend(missing.map(|key| format!("{name} {key}: missing")));
    }
    assert!(all.len() >= 7, "the recorded figures are gone");
    assert!(faults.is_empty(), "{faults:#?}");
}
