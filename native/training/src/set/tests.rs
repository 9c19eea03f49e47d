use std::fs;
use std::path::{Path, PathBuf};

use orbflow_geometry::progress::Progress;
use tempfile::TempDir;

use super::*;
use crate::sample::training_level;
use crate::shapes::shape;
use crate::thesis::chamfer;
use crate::thesis::target::{N_POINTS, Target};

fn some(seed: u64) -> Shape {
    let whole = shape(seed);
    let level = training_level(whole.clone(), 300).expect("made shapes are closed");
    Shape {
        whole,
        level,
        target: None,
    }
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
        targets: None,
    }
}

const NAMES: [&str; 3] = ["a", "b", "c"];

/// A whole set of two shapes, one source without.
fn set() -> (TempDir, PathBuf) {
    written(&head(), [some(1), some(2)])
}

fn written(head: &Head, [first, second]: [Shape; 2]) -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.set");
    let mut writer = Writer::begin_or_resume(&path, head, &NAMES).unwrap();
    writer.append(source("a"), &[first]).unwrap();
    writer.append(source("b"), &[]).unwrap();
    writer.append(source("c"), &[second]).unwrap();
    (folder, path)
}

/// Their rate loses its last bit on its way through text.
fn chamfer_settings() -> chamfer::Settings {
    chamfer::Settings {
        rate: 0.099_254_341_217_606_51,
        ..chamfer::Settings::default()
    }
}

fn head_with_targets() -> Head {
    Head {
        targets: Some(chamfer_settings()),
        ..head()
    }
}

fn some_with_target(seed: u64) -> Shape {
    let offsets = (0..3 * N_POINTS).map(|i| 0.001 * i as f32 - 0.5);
    let target = Target {
        settings: chamfer_settings(),
        offsets: offsets.collect(),
    };
    Shape {
        target: Some(target),
        ..some(seed)
    }
}

/// A whole set of a shape without a target and one with, which is the end of the file.
fn set_with_targets() -> (TempDir, PathBuf) {
    written(&head_with_targets(), [some(1), some_with_target(2)])
}

/// Opens a set and reads all that is in it.
fn read_whole(path: &Path) -> Result<Vec<Shape>, SetError> {
    let set = Set::open(path)?;
    let make = |_, shape: Shape| Ok::<_, SetError>(shape);
    set.read_all(&set.shapes(), make, &Progress::none())
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
fn the_sum_is_that_of_the_head_and_all_sources() {
    let (_folder, path) = set();
    let sum = |path: &Path| Set::open(path).unwrap().sum();
    let wanted = sum(&path);
    let later = Head { seed: 1, ..head() };
    for (head, second, is_same) in [(head(), 2, true), (later, 2, false), (head(), 3, false)] {
        let (_folder, path) = written(&head, [some(1), some(second)]);
        assert_eq!(sum(&path) == wanted, is_same);
    }
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() - 1]).unwrap();
    assert_ne!(sum(&path), wanted);
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
fn a_target_comes_back_with_the_settings_that_made_it() {
    let (_folder, path) = set_with_targets();
    let shapes = read_whole(&path).unwrap();
    let kept = shapes[1].target.as_ref().unwrap();
    let wanted = some_with_target(2).target.unwrap();
    assert_eq!(kept.offsets, wanted.offsets);
    assert_eq!(kept.settings.n_steps, wanted.settings.n_steps);
    assert_eq!(shapes[0].target, None);
}

#[test]
fn a_set_goes_on_with_the_same_settings_of_targets_alone() {
    let (_folder, path) = set_with_targets();
    let begin = |head: &Head| Writer::begin_or_resume(&path, head, &NAMES);
    drop(begin(&head_with_targets()).unwrap());
    let mut other = head_with_targets();
    other.targets.as_mut().unwrap().n_steps = 7;
    for (head, words) in [
        (other, r#""n_steps":7"#),
        (head(), r#"not with {"n_faces":300"#),
    ] {
        let error = begin(&head).unwrap_err().to_string();
        assert!(error.contains(r#""n_steps":400"#), "{error}");
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn a_head_of_another_version_is_refused() {
    let (_folder, path) = set_with_targets();
    let whole = fs::read(&path).unwrap();
    assert_eq!(whole[8], 2);
    for (version, words) in [
        (1, "a set of version 1 has no such head"),
        (3, "reads versions 1 to 2"),
    ] {
        let mut bad = whole.clone();
        bad[8] = version;
        fs::write(&path, bad).unwrap();
        let error = Set::open(&path).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
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
        let error = read_whole(&path).expect_err("every byte is under a sum");
        assert!(!error.to_string().is_empty(), "byte {at}");
    }
}

#[test]
fn damaged_targets_are_refused_with_the_place() {
    let (_folder, path) = set_with_targets();
    let whole = fs::read(&path).unwrap();
    let n = whole.len();
    for at in (n - 12 * N_POINTS..n).step_by(1_000).chain([n - 1]) {
        let mut bad = whole.clone();
        bad[at] ^= 0x01;
        fs::write(&path, bad).unwrap();
        let error = read_whole(&path).unwrap_err().to_string();
        assert!(error.contains("damaged at byte"), "{error}");
        assert!(error.contains("the sum of c part 0"), "{error}");
    }
}

#[test]
fn targets_that_lie_are_refused() {
    let bytes = some_with_target(1).to_bytes();
    let settings = chamfer_settings();
    let refused = |bytes: &[u8], targets| {
        let error = Shape::from_bytes(bytes, targets).unwrap_err();
        error.to_string()
    };
    assert!(refused(&bytes, None).contains("no settings of targets"));
    let targets = Some(&settings);
    let short = refused(&bytes[..bytes.len() - 4], targets);
    assert!(short.contains("5900 bytes are left over"), "{short}");
    let long = refused(&[&bytes[..], &[0; 4]].concat(), targets);
    assert!(long.contains("5908 bytes are left over"), "{long}");
    let mut bad = bytes;
    let at = bad.len() - 4;
    bad[at..].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let infinite = refused(&bad, targets);
    assert!(
        infinite.contains("offset 1475 of the target is inf"),
        "{infinite}"
    );
}

#[test]
fn parts_that_lie_are_refused() {
    let bytes = some(1).to_bytes();
    let refused = |bytes: &[u8]| Shape::from_bytes(bytes, None).unwrap_err().to_string();
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
