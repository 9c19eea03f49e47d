//! Files that are broken are refused with the numbers that find the spot, and never end in a panic.

#![allow(clippy::unwrap_used)] // What helps tests is a test.

mod support;

use orbflow_geometry::random::Random;
use orbflow_gltf::Scene;
use serde_json::{Value, json};
use support::{File, glb, parts, scene};

fn message(file: &[u8]) -> String {
    match Scene::read(file, None) {
        Err(error) => error.to_string(),
        Ok(_) => "it is read".to_owned(),
    }
}

/// What is said of the scene with one value of its text changed.
fn changed(pointer: &str, value: Value) -> String {
    let (mut text, bytes) = parts(&scene());
    let (above, key) = pointer.rsplit_once('/').unwrap();
    let above = text.pointer_mut(above).expect("what is changed is there");
    match above {
        Value::Array(list) => list[key.parse::<usize>().unwrap()] = value,
        above => above[key] = value,
    }
    message(&glb(&text, &bytes))
}

/// The accessor of an attribute of the first primitive.
fn accessor(name: &str) -> usize {
    let (text, _) = parts(&scene());
    let primitive = &text["meshes"][0]["primitives"][0];
    let found = match name {
        "indices" => &primitive["indices"],
        "target" => &primitive["targets"][0]["POSITION"],
        name => &primitive["attributes"][name],
    };
    found.as_u64().unwrap() as usize
}

#[test]
fn what_names_something_that_is_not_there_is_named() {
    for (pointer, value, wanted) in [
        ("/scene", 9, "the file names scene 9, but there are 1"),
        ("/nodes/0/mesh", 9, "node 0 names mesh 9, but there are 2"),
        ("/nodes/0/skin", 9, "node 0 names skin 9, but there are 1"),
        (
            "/nodes/1/children/0",
            77,
            "node 1 names node 77, but there are 6",
        ),
        ("/nodes/1/children/0", 1, "node 1 is reached twice"),
        (
            "/skins/0/inverseBindMatrices",
            900,
            "skin 0 names accessor 900",
        ),
        (
            "/meshes/0/primitives/1/attributes/POSITION",
            900,
            "primitive 1 of mesh 0 names accessor 900",
        ),
        (
            "/bufferViews/0/buffer",
            3,
            "buffer view 0 names buffer 3, but there are 1",
        ),
        (
            "/bufferViews/1/byteLength",
            99_999_999,
            "buffer view 1 needs",
        ),
        (
            "/buffers/0/byteLength",
            99_999_999,
            "buffer 0 should have 99999999 bytes",
        ),
    ] {
        let text = changed(pointer, json!(value));
        assert!(text.contains(wanted), "{pointer}: {text}");
    }
}

/// Changes accessors of attributes, each by its name and a key, and looks for words.
fn check_changed(cases: &[(&str, &str, Value, &str)]) {
    for (name, key, value, wanted) in cases {
        let text = changed(
            &format!("/accessors/{}/{key}", accessor(name)),
            value.clone(),
        );
        assert!(text.contains(wanted), "{name}, {key}: {text}");
    }
}

#[test]
fn positions_that_do_not_fit_are_named() {
    check_changed(&[
        (
            "POSITION",
            "count",
            json!(5_000_000),
            "needs 60000000 bytes of buffer view",
        ),
        ("POSITION", "count", json!(u64::MAX), "bytes of buffer view"),
        (
            "POSITION",
            "byteOffset",
            json!(u64::MAX),
            "bytes of buffer view",
        ),
        (
            "POSITION",
            "type",
            json!("VEC2"),
            "has 2 of type 5126 where three numbers are expected",
        ),
        ("POSITION", "type", json!("VEC9"), "has VEC9 of type 5126"),
        ("POSITION", "componentType", json!(7), "has VEC3 of type 7"),
        (
            "POSITION",
            "bufferView",
            json!(null),
            "has none where bytes of a buffer are expected",
        ),
    ]);
}

#[test]
fn attributes_that_do_not_fit_are_named() {
    let count = format!(
        "accessor {} has 3 elements, but 151 vertices",
        accessor("TEXCOORD_0")
    );
    check_changed(&[
        ("TEXCOORD_0", "count", json!(3), &count),
        (
            "indices",
            "componentType",
            json!(5126),
            "whole numbers without sign",
        ),
        (
            "JOINTS_0",
            "componentType",
            json!(5126),
            "bytes of buffer view",
        ),
        (
            "target",
            "count",
            json!(1_000_000_000),
            "has 1000000000 elements, but 151 vertices",
        ),
        (
            "target",
            "sparse/count",
            json!(1_000_000),
            "bytes of buffer view",
        ),
        (
            "target",
            "sparse/indices/componentType",
            json!(5126),
            "sparse indices",
        ),
    ]);
}

#[test]
fn an_index_beyond_the_vertices_is_named() {
    let mut file = File::default();
    let points = file.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let indices = file.indices(&[0, 1, 3]);
    let with =
        |primitive: Value| json!({"nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}]});
    let text = with(json!({"attributes": {"POSITION": points}, "indices": indices}));
    assert_eq!(
        message(&file.glb(text)),
        "accessor 1 names vertex 3, but there are 3"
    );

    let mut file = File::default();
    let points = file.floats(&[
        [0.0, f32::NAN, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, f32::INFINITY, 0.0],
    ]);
    let text = with(json!({"attributes": {"POSITION": points}}));
    let scene = Scene::read(&file.glb(text), None).unwrap();
    assert_eq!(
        scene.notes(),
        ["2 numbers that are not finite are taken for 0"]
    );
    let text = with(json!({"attributes": {"POSITION": points}, "mode": 1}));
    assert_eq!(
        message(&file.glb(text)),
        "no node of the scene shows a mesh of triangles"
    );
}

#[test]
fn packed_data_is_refused_by_name() {
    let draco = json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}});
    let text = changed("/meshes/1/primitives/0/extensions", draco);
    assert!(
        text.starts_with("primitive 0 of mesh 1 is packed by KHR_draco_mesh_compression"),
        "{text}"
    );
    let meshopt = json!({"EXT_meshopt_compression": {"buffer": 0}});
    let text = changed("/bufferViews/2/extensions", meshopt);
    assert!(
        text.starts_with("buffer view 2 is packed by EXT_meshopt_compression"),
        "{text}"
    );
}

#[test]
fn other_versions_and_what_is_no_text_are_refused() {
    assert_eq!(
        changed("/asset/version", json!("1.0")),
        "version '1.0' of glTF is not read; 2.0 is"
    );
    assert!(message(b"{\"asset\": ").starts_with("its JSON is wrong: EOF"));
    assert!(message(b"{}").contains("missing field `asset`"));
    let deep = ["[".repeat(100_000), "]".repeat(100_000)].concat();
    assert!(message(deep.as_bytes()).contains("recursion limit"));
}

#[test]
fn every_cut_of_a_file_is_an_error_and_no_change_a_panic() {
    let file = scene();
    for n in (0..file.len()).step_by(97) {
        assert_ne!(message(&file[..n]), "it is read", "{n}");
    }
    let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    let mut random = Random::new(5);
    let mut n_read = 0;
    for _ in 0..2000 {
        let mut broken = file.clone();
        for _ in 0..3 {
            let i = 20 + (random.next_u64() as usize) % length;
            broken[i] = b"0123456789[]{}\":,-eE nul"[(random.next_u64() % 24) as usize];
        }
        if let Ok(scene) = Scene::read(&broken, None) {
            n_read += usize::from(!scene.cuts(None).sets.is_empty());
        }
    }
    assert!(n_read > 20, "{n_read} changes do no harm");
}
