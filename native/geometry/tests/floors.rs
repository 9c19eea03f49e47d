//! Holds the picture of the floors in `docs/architecture.md` against the code: a module may use
//! floors below its own, never its own floor's siblings or a floor above.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// From the ground up: what everything may ask whether to go on lies under the numbered floors.
const FLOORS: [&[&str]; 5] = [
    &["elementary", "progress"],
    &["groups", "mesh", "random", "sparse"],
    &[
        "chords",
        "guidance",
        "hierarchy",
        "measure",
        "mirror",
        "nearest",
        "sphere_map",
    ],
    &[
        "clean", "close", "decimate", "deform", "embed", "flow", "graft", "pair", "rejoin",
        "score", "solid", "sphere", "transfer",
    ],
    &["pipeline"],
];

fn floor(module: &str) -> Option<usize> {
    FLOORS.iter().position(|modules| modules.contains(&module))
}

fn source_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder)
        .expect("the folder of sources")
        .map(|entry| entry.expect("an entry of it").path());
    let mut files: Vec<PathBuf> = entries
        .flat_map(|path| {
            if path.is_dir() {
                source_files(&path)
            } else {
                vec![path]
            }
        })
        .filter(|path| path.extension().is_some_and(|e| e == "rs") && !path.ends_with("tests.rs"))
        .collect();
    files.sort();
    files
}

/// The modules that follow `crate::` in a file, in lists too.
fn used_modules(text: &str) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    for after in text.split("crate::").skip(1) {
        let names = match after.strip_prefix('{') {
            Some(list) => list.split_once("};").map_or(list, |(inside, _)| inside),
            None => after
                .split(|c: char| !c.is_alphanumeric() && c != '_')
                .next()
                .unwrap_or(""),
        };
        let words = names.split(|c: char| !c.is_alphanumeric() && c != '_');
        used.extend(
            words
                .filter(|word| floor(word).is_some())
                .map(str::to_owned),
        );
    }
    used
}

#[test]
fn modules_use_only_the_floors_below_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut faults = Vec::new();
    let mut seen = BTreeSet::new();
    for path in source_files(&root) {
        let inside = path.strip_prefix(&root).unwrap();
        let module = inside
            .iter()
            .next()
            .unwrap()
            .to_str()
            .unwrap()
            .trim_end_matches(".rs");
        if module == "lib" {
            continue;
        }
        let Some(own) = floor(module) else {
            faults.push(format!("{module} has no floor"));
            continue;
        };
        seen.insert(module.to_owned());
        let text = fs::read_to_string(&path).expect("a source file");
        // Tests may use whatever makes their examples.
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or("");
        for used in used_modules(code) {
            if used != module && floor(&used).unwrap() >= own {
                faults.push(format!("{} uses {used}", inside.display()));
            }
        }
    }
    assert!(seen.len() > 3, "the sources were not found: {seen:?}");
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn a_list_of_imports_is_read_whole() {
    let used = used_modules("use crate::{mesh::Id, embed::{Solver, x}};\ncrate::deform::y");
    assert_eq!(
        used.into_iter().collect::<Vec<_>>(),
        ["deform", "embed", "mesh"]
    );
}
