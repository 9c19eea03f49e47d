use std::fs;
use std::path::PathBuf;

use orbflow_geometry::progress::Progress;
use tempfile::TempDir;

use super::*;
use crate::sample::training_level;
use crate::shapes::shape;

fn some(seed: u64) -> Shape {
    let whole = shape(seed);
    let level = training_level(whole.clone(), 300).expect("made shapes are closed");
    Shape { whole, level }
}

fn source(name: &str) -> Source {
    Source {
        name: name.to_owned(),
        category: "made".to_owned(),
        licence: "CC0-1.0".to_owned(),
        split: Split::Train,
        parts: Vec::new(),
        left_out: Vec::new(),
    }
}

fn head() -> Head {
    Head {
        n_faces: 300,
        n_procedural: 2,
        seed: 0,
        licence: None,
        n_sources: 3,
    }
}

const NAMES: [&str; 3] = ["a", "b", "c"];

/// A whole set of two shapes, one source without.
fn set() -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.set");
    let mut writer = Writer::begin_or_resume(&path, &head(), &NAMES).unwrap();
    writer.append(source("a"), &[some(1)]).unwrap();
    writer.append(source("b"), &[]).unwrap();
    writer.append(source("c"), &[some(2)]).unwrap();
    (folder, path)
}

#[test]
fn what_is_written_is_read() {
    let (_folder, path) = set();
    let set = Set::open(&path).unwrap();
    let shapes = set.shapes();
    assert_eq!(shapes.len(), 2);
    assert_eq!(shapes[1].name(), "c part 0");
    for (which, seed) in shapes.into_iter().zip([1, 2]) {
        let (read, wanted) = (set.read(which).unwrap(), some(seed));
        assert_eq!(read.whole, wanted.whole);
        assert_eq!(read.to_bytes(), wanted.to_bytes());
    }
    let manifest = set.manifest();
    assert!(manifest.is_complete);
    assert_eq!((manifest.n_train, manifest.n_left_out), (2, 1));
    assert_eq!(manifest.licences["CC0-1.0"], 2);
}

#[test]
fn a_set_cut_anywhere_goes_on_to_the_same_bytes() {
    let (folder, whole) = set();
    let whole = fs::read(whole).unwrap();
    let path = folder.path().join("cut.set");
    for share in [0, 1, 5, 30, 47, 70, 90, 99] {
        fs::write(&path, &whole[..whole.len() * share / 100]).unwrap();
        let mut writer = Writer::begin_or_resume(&path, &head(), &NAMES).unwrap();
        for (i, seed) in [Some(1), None, Some(2)].into_iter().enumerate() {
            if i >= writer.n_done() {
                let shapes: Vec<Shape> = seed.map(some).into_iter().collect();
                writer.append(source(NAMES[i]), &shapes).unwrap();
            }
        }
        drop(writer);
        assert!(fs::read(&path).unwrap() == whole, "{share} %");
    }
}

#[test]
fn a_cut_set_is_read_as_far_as_it_goes() {
    let (_folder, path) = set();
    let whole = fs::read(&path).unwrap();
    fs::write(&path, &whole[..whole.len() - 1]).unwrap();
    let set = Set::open(&path).unwrap();
    assert!(!set.manifest().is_complete);
    assert_eq!((set.shapes().len(), set.sources().len()), (1, 2));
}

#[test]
fn other_sources_do_not_resume_and_strange_files_stay() {
    let (folder, path) = set();
    let error = Writer::begin_or_resume(&path, &head(), &["a", "x", "c"]).unwrap_err();
    assert!(error.to_string().contains("b as source 1"), "{error}");
    let strange = folder.path().join("precious.obj");
    fs::write(&strange, "v 0 0 0").unwrap();
    let error = Writer::begin_or_resume(&strange, &head(), &NAMES).unwrap_err();
    assert!(error.to_string().contains("no set of orbflow"), "{error}");
    assert_eq!(fs::read_to_string(&strange).unwrap(), "v 0 0 0");
}

#[test]
fn two_runs_do_not_write_one_set() {
    let (_folder, path) = set();
    let first = Writer::begin_or_resume(&path, &head(), &NAMES).unwrap();
    let second = Writer::begin_or_resume(&path, &head(), &NAMES);
    assert!(matches!(second, Err(WriterError::Locked { .. })));
    drop(first);
}

#[test]
fn damaged_sets_are_refused_with_words() {
    let (folder, path) = set();
    let whole = fs::read(path).unwrap();
    let path = folder.path().join("bad.set");
    let n = whole.len();
    for at in (0..700).step_by(5).chain((700..n).step_by(n / 60)) {
        let mut bad = whole.clone();
        bad[at] ^= 0x55;
        fs::write(&path, bad).unwrap();
        let read = Set::open(&path).and_then(|set| {
            let make = |_, shape: Shape| Ok::<_, SetError>(shape.whole.n_faces());
            set.read_all(&set.shapes(), make, &Progress::none())
        });
        let error = read.expect_err("every byte is under a sum");
        assert!(!error.to_string().is_empty(), "byte {at}");
    }
}

#[test]
fn parts_that_lie_are_refused() {
    let bytes = some(1).to_bytes();
    let refused = |bytes: &[u8]| Shape::from_bytes(bytes).unwrap_err().to_string();
    assert!(refused(&bytes[..bytes.len() - 4]).contains("more bytes are needed"));
    assert!(refused(&[&bytes[..], &[0; 3]].concat()).contains("3 bytes are left over"));
    assert!(refused(&[0xff; 24]).contains("more bytes are needed"));
    assert!(refused(&[0; 24]).contains("euler number is 0"));
    // Every number of the collapses, far out of range.
    for at in (bytes.len() - 4_000..bytes.len()).step_by(4) {
        let mut bad = bytes.clone();
        bad[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        refused(&bad);
    }
    // The first coordinate is not a number.
    let mut bad = bytes;
    bad[24..32].copy_from_slice(&f64::NAN.to_le_bytes());
    assert!(refused(&bad).contains("not finite"));
}
