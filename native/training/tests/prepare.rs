//! Sets: what goes into them, and that neither threads nor cuts change a byte.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, mpsc};
use std::thread;
use std::time::Duration;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use orbflow_geometry::mesh::io::{Format, MeshFile, write};
use orbflow_geometry::mesh::{PolygonMesh, TriangleMesh};
use orbflow_geometry::progress::{CancelToken, Progress};
use orbflow_training::prepare::{PrepareError, Settings, prepare};
use orbflow_training::set::{Set, Source, Split};
use orbflow_training::shapes::shape;
use orbflow_training::thesis::chamfer;
use orbflow_training::thesis::target::{Reading, sphere};
use rawzip::path::EntryPath;
use rawzip::{CompressionMethod, ZipArchiveWriter};
use tempfile::TempDir;

const OPEN: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n";

fn obj(mesh: &TriangleMesh) -> Vec<u8> {
    let file = MeshFile::from(PolygonMesh::from(mesh));
    let mut bytes = Vec::new();
    write(&file, Format::Obj, &mut bytes).expect("memory can be written");
    bytes
}

/// A folder with meshes good and bad, a table, and a zip file with a licence of its own.
fn models() -> (TempDir, PathBuf) {
    let folder = TempDir::new().expect("a temporary folder can be made");
    let models = folder.path().join("models");
    fs::create_dir_all(models.join("animals")).expect("the folder can be written");
    let put = |name: &str, bytes: &[u8]| {
        fs::write(models.join(name), bytes).expect("the folder can be written");
    };
    put("animals/cat.obj", &obj(&shape(5)));
    put("open.obj", OPEN);
    put("broken.ply", b"ply\nnonsense");
    put("broken.zip", b"PK nonsense");
    put("notes.txt", b"not a mesh");
    put("long.obj", &[&b"v 0 0 "[..], &vec![b'x'; 1 << 21]].concat());
    put("manifest.csv", b"file,licence\nanimals/cat.obj,CC-BY-4.0\n");
    let files = [
        ("License.txt", b"These models are CC0.".to_vec()),
        ("fish/fish_01.obj", obj(&shape(6))),
        ("../escape.obj", OPEN.to_vec()),
    ];
    put("pack.zip", &zip(&files).expect("memory can be written"));
    (folder, models)
}

fn zip(files: &[(&str, Vec<u8>)]) -> Result<Vec<u8>, rawzip::Error> {
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    for (name, text) in files {
        // As it stands, so that a name may be hostile.
        let entry = archive.new_file(EntryPath::verbatim(name.as_bytes()));
        let deflated = entry.compression_method(CompressionMethod::DEFLATE);
        let (mut entry, config) = deflated.start()?;
        let mut out = config.wrap(DeflateEncoder::new(&mut entry, Compression::default()));
        out.write_all(text)?;
        let (encoder, descriptor) = out.finish()?;
        encoder.finish()?;
        entry.finish(descriptor)?;
    }
    archive.finish()?;
    Ok(bytes)
}

fn settings() -> Settings {
    Settings {
        n_faces: 300,
        n_procedural: 7,
        ..Settings::default()
    }
}

fn prepared(models: &Path, output: &Path) -> Set {
    let given = [models.to_owned()];
    let set = prepare(&given, &settings(), output, &Progress::none());
    set.expect("there is something to prepare")
}

#[test]
fn folders_and_zip_files_become_a_set_that_says_what_is_in_it() {
    let (folder, models) = models();
    let set = prepared(&models, &folder.path().join("a.set"));
    let manifest = set.manifest();
    assert!(manifest.is_complete);
    let source = |name: &str| -> &Source {
        let found = manifest.sources.iter().find(|source| source.name == name);
        found.unwrap_or_else(|| panic!("no {name} in {manifest:?}"))
    };
    for (name, category, licence, left_out) in [
        ("models/animals/cat.obj", "animals", "CC-BY-4.0", ""),
        ("models/pack.zip/fish/fish_01.obj", "fish", "CC0-1.0", ""),
        (
            "models/open.obj",
            "models",
            "unknown",
            "1 part with a border",
        ),
        ("models/long.obj", "models", "unknown", "line 1: 'xxx"),
        ("models/broken.ply", "models", "unknown", "line 2"),
        (
            "models/broken.zip",
            "zip",
            "unknown",
            "Missing end of central directory",
        ),
        (
            "models/pack.zip/../escape.obj",
            "",
            "CC0-1.0",
            "1 part with a border",
        ),
        ("shape 0", "made", "made, needs none", ""),
    ] {
        let source = source(name);
        assert_eq!(
            (&*source.category, &*source.licence),
            (category, licence),
            "{name}"
        );
        assert_eq!(
            source.parts.len(),
            usize::from(left_out.is_empty()),
            "{name}"
        );
        let reasons = source.left_out.join("; ");
        assert!(reasons.contains(left_out), "{name}: {reasons}");
    }
    assert_eq!(manifest.sources.len(), 7 + 7);
    let test = set.shapes_of(Split::Test);
    assert!(
        test.iter()
            .any(|which| which.source.name == format!("shape {}", 1u64 << 40))
    );
    let cat = set
        .shapes()
        .into_iter()
        .find(|w| w.source.name.ends_with("cat.obj"));
    let read = set.read(cat.unwrap()).unwrap();
    assert_eq!(read.whole.n_faces(), shape(5).n_faces().min(16_000));
    assert_eq!(read.level.mesh().n_faces(), 300);
}

#[test]
fn neither_threads_nor_cuts_change_a_byte() {
    let (folder, models) = models();
    let path = |name: &str| folder.path().join(name);
    for (threads, name) in [(1, "one.set"), (2, "two.set")] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| drop(prepared(&models, &path(name))));
    }
    let one = fs::read(path("one.set")).unwrap();
    assert!(one == fs::read(path("two.set")).unwrap());

    fs::write(path("cut.set"), &one[..one.len() / 2]).unwrap();
    drop(prepared(&models, &path("cut.set")));
    assert!(one == fs::read(path("cut.set")).unwrap());
}

/// Seven made shapes with targets of two steps.
fn with_targets() -> Settings {
    let targets = chamfer::Settings {
        n_steps: 2,
        n_samples: 50,
        ..chamfer::Settings::default()
    };
    Settings {
        n_faces: 1_000,
        targets: Some(targets),
        ..settings()
    }
}

fn targeted(settings: &Settings, output: &Path) -> Set {
    let set = prepare(&[], settings, output, &Progress::none());
    set.expect("there is something to prepare")
}

#[test]
fn neither_threads_nor_cuts_change_a_byte_of_targets() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    for (threads, name) in [(1, "one.set"), (2, "two.set")] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let make = || drop(targeted(&with_targets(), &path(name)));
        pool.unwrap().install(make);
    }
    let one = fs::read(path("one.set")).unwrap();
    assert!(one == fs::read(path("two.set")).unwrap());

    fs::write(path("cut.set"), &one[..one.len() / 2]).unwrap();
    drop(targeted(&with_targets(), &path("cut.set")));
    assert!(one == fs::read(path("cut.set")).unwrap());
}

#[test]
fn targets_are_those_of_the_level_and_change_nothing_else() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    let settings = with_targets();
    let none = Settings {
        targets: None,
        ..settings.clone()
    };
    let set = targeted(&settings, &path("a.set"));
    let plain = targeted(&none, &path("b.set"));
    let targets = settings.targets.as_ref().unwrap();
    assert_eq!(set.shapes().len(), 7);
    for (which, plain_which) in set.shapes().into_iter().zip(plain.shapes()) {
        let (mut shape, plain) = (set.read(which).unwrap(), plain.read(plain_which).unwrap());
        let target = shape.target.take().unwrap();
        assert_eq!(shape.to_bytes(), plain.to_bytes());
        assert_eq!(&target.settings, targets);
        let surface = Reading::new(&shape.level).unwrap().surface;
        let made = chamfer::offsets(&sphere(), &surface, targets, &Progress::none());
        assert_eq!(target.offsets, made.unwrap());
        assert!(target.offsets.iter().any(|x| *x != 0.0));
    }
}

#[test]
fn a_target_that_is_not_finite_is_left_out_and_named() {
    let folder = TempDir::new().unwrap();
    let mut settings = with_targets();
    settings.targets.as_mut().unwrap().edge = 1e300;
    let set = targeted(&settings, &folder.path().join("a.set"));
    for which in set.shapes() {
        assert_eq!(set.read(which).unwrap().target, None);
        let reasons = which.source.left_out.join("; ");
        assert!(
            reasons.contains("the target of part 0: the target is not finite"),
            "{reasons}"
        );
    }
}

#[test]
fn targets_are_refused_where_none_could_be_made() {
    let folder = TempDir::new().unwrap();
    let output = folder.path().join("a.set");
    let coarse = Settings {
        n_faces: 978,
        ..with_targets()
    };
    let mut wrong = with_targets();
    wrong.targets.as_mut().unwrap().normal = f64::NAN;
    for (settings, words) in [(coarse, "--faces 980"), (wrong, "chamfer.normal = NaN")] {
        let error = prepare(&[], &settings, &output, &Progress::none()).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
    assert!(!output.exists());
}

#[test]
fn more_made_shapes_than_can_be_are_refused() {
    let folder = TempDir::new().unwrap();
    let output = folder.path().join("a.set");
    for n_procedural in [1_000_001, 2_000_000_000_000_000_000, usize::MAX] {
        let many = Settings {
            n_procedural,
            ..settings()
        };
        let error = prepare(&[], &many, &output, &Progress::none()).unwrap_err();
        assert!(error.to_string().contains("at most 1000000"), "{error}");
    }
    assert!(!output.exists());
}

#[test]
fn a_run_that_makes_targets_can_be_cancelled() {
    let folder = TempDir::new().unwrap();
    let output = folder.path().join("a.set");
    let mut endless = with_targets();
    endless.targets.as_mut().unwrap().n_steps = usize::MAX;
    let (begun, begins) = mpsc::channel();
    let (token, begun) = (CancelToken::new(), Mutex::new(begun));
    let listener = |_: &str, _: f64| {
        let sent = begun.lock().map(|begun| begun.send(()));
        assert!(sent.is_ok());
    };
    let cancelled = thread::scope(|scope| {
        let to_cancel = token.clone();
        scope.spawn(move || {
            begins.recv().expect("preparing begins");
            // By then the first shapes are at their targets.
            thread::sleep(Duration::from_millis(300));
            to_cancel.cancel();
        });
        let progress = Progress::new(token.clone(), &listener);
        prepare(&[], &endless, &output, &progress)
    });
    let error = cancelled.unwrap_err().to_string();
    assert!(error.contains("0 of 7 sources are in the set"), "{error}");
}

#[test]
fn a_cancelled_run_says_how_far_it_came() {
    let (folder, models) = models();
    let token = CancelToken::new();
    token.cancel();
    let output = folder.path().join("a.set");
    let cancelled = prepare(&[models], &settings(), &output, &Progress::silent(token));
    assert!(matches!(
        cancelled,
        Err(PrepareError::Cancelled {
            n_done: 0,
            n_sources: 14
        })
    ));
    assert!(!Set::open(&output).unwrap().manifest().is_complete);
}

#[test]
fn nothing_to_prepare_is_an_error() {
    let folder = TempDir::new().unwrap();
    let output = folder.path().join("a.set");
    let none = Settings {
        n_procedural: 0,
        ..settings()
    };
    let given = [folder.path().to_owned()];
    let error = prepare(&given, &none, &output, &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("nothing to prepare"), "{error}");
    let missing = [folder.path().join("missing")];
    let error = prepare(&missing, &none, &output, &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("missing"), "{error}");
    assert!(!output.exists());
}
