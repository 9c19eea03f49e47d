//! A scene goes through the core and back: what stays, what is carried, and how well.

#![allow(clippy::unwrap_used)] // What helps tests is a test.

mod support;

use std::collections::BTreeSet;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use gltf::buffer::Source;
use gltf::mesh::util::{ReadColors, ReadJoints, ReadWeights};
use gltf::{Gltf, Primitive, Semantic};
use orbflow_gltf::{Container, Scene};
use support::{FACES, RISE, SPECK, coordinate, done, parts, remeshed, scene, share, side_of};

/// How far an edge of the result reaches, more or less.
const EDGE: f64 = 0.4;

/// What the crate `gltf` reads of a primitive.
struct Read {
    places: Vec<DVec3>,
    coordinates: Vec<[f64; 2]>,
    colors: Vec<[f64; 4]>,
    joints: Vec<[u16; 4]>,
    weights: Vec<[f64; 4]>,
    moves: Vec<DVec3>,
    normals: Vec<DVec3>,
    faces: Vec<[usize; 3]>,
}

/// The primitives of the ball, read and checked by the crate `gltf`.
fn ball() -> Vec<Read> {
    let Gltf { document, blob } = Gltf::from_slice(&done().file).unwrap();
    let bytes = blob.unwrap();
    let mesh = document.meshes().next().unwrap();
    mesh.primitives()
        .map(|primitive| read(&primitive, &bytes))
        .collect()
}

fn read(primitive: &Primitive<'_>, bytes: &[u8]) -> Read {
    let reader = primitive.reader(|_| Some(bytes));
    let point = |p: [f32; 3]| DVec3::from_array(p.map(f64::from));
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    let colors = reader.read_colors(0).unwrap();
    assert!(matches!(colors, ReadColors::RgbaU8(_)), "colors stay bytes");
    let joints = reader.read_joints(0).unwrap();
    assert!(matches!(joints, ReadJoints::U8(_)), "joints stay bytes");
    let Some(ReadWeights::F32(weights)) = reader.read_weights(0) else {
        panic!("weights are shares");
    };
    let (moves, _, _) = reader.read_morph_targets().next().unwrap();
    let found = Read {
        places: reader.read_positions().unwrap().map(point).collect(),
        coordinates: {
            let all = reader.read_tex_coords(0).unwrap().into_f32();
            all.map(|c| c.map(f64::from)).collect()
        },
        colors: colors.into_rgba_f32().map(|c| c.map(f64::from)).collect(),
        joints: joints.into_u16().collect(),
        weights: weights.map(|w| w.map(f64::from)).collect(),
        moves: moves.unwrap().map(point).collect(),
        normals: reader.read_normals().unwrap().map(point).collect(),
        faces: indices
            .chunks_exact(3)
            .map(|f| [f[0], f[1], f[2]].map(|i| i as usize))
            .collect(),
    };
    let n = found.places.len();
    assert!(n > 0 && found.faces.iter().flatten().all(|&i| i < n));
    let lengths = [
        found.coordinates.len(),
        found.colors.len(),
        found.joints.len(),
    ];
    assert_eq!(lengths, [n; 3]);
    assert_eq!(
        [found.weights.len(), found.moves.len(), found.normals.len()],
        [n; 3]
    );
    found
}

#[test]
fn all_but_meshes_stays_as_it_is() {
    let [(mut old, old_bytes), (mut new, bytes)] = [&scene(), &done().file].map(|f| parts(f));
    let piece = |text: &serde_json::Value, bytes: &[u8], view: usize| {
        let number = |name: &str| text["bufferViews"][view][name].as_u64().unwrap() as usize;
        bytes[number("byteOffset")..number("byteOffset") + number("byteLength")].to_vec()
    };
    assert_eq!(piece(&new, &bytes, 0), b"\x89PNG not really");
    let bound = old["skins"][0]["inverseBindMatrices"].as_u64().unwrap() as usize;
    assert_eq!(old["accessors"][bound], new["accessors"][bound]);
    let view = old["accessors"][bound]["bufferView"].as_u64().unwrap() as usize;
    assert_eq!(piece(&old, &old_bytes, view), piece(&new, &bytes, view));
    for text in [&mut old, &mut new] {
        for name in ["accessors", "bufferViews", "buffers"] {
            text.as_object_mut().unwrap().remove(name);
        }
        for primitive in [
            "/meshes/0/primitives/0",
            "/meshes/0/primitives/1",
            "/meshes/1/primitives/0",
        ] {
            let primitive = text
                .pointer_mut(primitive)
                .unwrap()
                .as_object_mut()
                .unwrap();
            primitive.remove("attributes");
            primitive.remove("indices");
            primitive.remove("targets");
        }
    }
    assert_eq!(old, new);
}

#[test]
fn what_is_not_taken_over_is_named() {
    let notes = done().notes.join("\n");
    for words in [
        "left out: TANGENT, _TEMPERATURE",
        "mesh 1 is shown by 2 nodes and remeshed once",
    ] {
        assert!(notes.contains(words), "{notes}");
    }
    let (text, _) = parts(&done().file);
    let attributes = text["meshes"][0]["primitives"][0]["attributes"]
        .as_object()
        .unwrap();
    let names: Vec<_> = attributes.keys().map(String::as_str).collect();
    let wanted = [
        "COLOR_0",
        "JOINTS_0",
        "NORMAL",
        "POSITION",
        "TEXCOORD_0",
        "WEIGHTS_0",
    ];
    assert_eq!(names, wanted);
}

#[test]
fn no_bytes_are_left_that_nothing_names() {
    let (text, bytes) = parts(&done().file);
    let views = text["bufferViews"].as_array().unwrap().iter();
    let piece = |view: &serde_json::Value| {
        ["byteOffset", "byteLength"].map(|name| view[name].as_u64().unwrap() as usize)
    };
    // What was free and cannot go is a few bytes that all share.
    let pieces: BTreeSet<_> = views.map(piece).collect();
    let named: usize = pieces.iter().map(|[_, n]| n.next_multiple_of(4)).sum();
    assert_eq!(bytes.len(), named);
    assert!(
        text["accessors"]
            .as_array()
            .unwrap()
            .iter()
            .all(|accessor| { accessor["count"].as_u64().unwrap() > 0 })
    );
}

#[test]
fn texture_coordinates_are_those_of_the_place_on_its_own_side() {
    let (mut n_far, mut n_all) = (0, 0);
    for primitive in ball() {
        for face in &primitive.faces {
            let [a, b, c] = face.map(|i| primitive.places[i]);
            if a.x > 2.0 {
                continue; // the speck
            }
            let (side, _) = side_of(a + b + c);
            n_all += 1;
            for (&i, p) in face.iter().zip([a, b, c]) {
                let [u, v] = primitive.coordinates[i];
                // A face across a seam belongs to one side alone, whose cell it stays in.
                let cell = (6.0 * u).floor() as usize;
                assert!(
                    (0.09..0.91).contains(&(6.0 * u - cell as f64)) && (0.09..0.91).contains(&v)
                );
                let (of_corner, at) = side_of(p);
                let wanted = coordinate(of_corner, at);
                let is_near = (wanted[0] - u).abs() < 0.02 && (wanted[1] - v).abs() < 0.06;
                n_far += usize::from(cell == side && of_corner == side && !is_near);
            }
        }
    }
    assert!(
        n_all > 200 && n_far * 50 < n_all,
        "{n_far} of {n_all} faces have far corners"
    );
}

#[test]
fn every_face_has_the_material_beneath_it() {
    let (mut n_wrong, mut n_all) = (0, 0);
    for (material, primitive) in ball().iter().enumerate() {
        for face in &primitive.faces {
            let [a, b, c] = face.map(|i| primitive.places[i]);
            n_all += 1;
            n_wrong += usize::from(a.x < 2.0 && side_of(a + b + c).0 / 3 != material);
        }
    }
    assert!(n_wrong * 10 < n_all, "{n_wrong} of {n_all}");
}

#[test]
fn shares_of_bones_sum_to_one_and_colours_follow_the_place() {
    for primitive in ball() {
        for (i, p) in primitive
            .places
            .iter()
            .enumerate()
            .filter(|(_, p)| p.x < 2.0)
        {
            let weights = primitive.weights[i];
            assert!(
                (weights.iter().sum::<f64>() - 1.0).abs() < 1e-7,
                "{weights:?}"
            );
            assert!(
                weights.is_sorted_by(|a, b| a >= b),
                "the largest come first"
            );
            let of_bones = weights.iter().zip(primitive.joints[i]);
            let second: f64 = of_bones
                .filter(|(_, bone)| *bone == 1)
                .map(|(w, _)| w)
                .sum();
            assert!((second - share(p.z)).abs() < 0.03, "{second} at {p}");
            let [red, green, blue, alpha] = primitive.colors[i];
            assert!((red - share(p.z)).abs() < 0.2 * EDGE, "{red} at {p}");
            let off = [green, blue - 1.0, alpha - 1.0].map(f64::abs);
            assert!(off.iter().all(|&off| off < 1e-9), "{off:?} at {p}");
        }
    }
}

#[test]
fn the_morph_target_moves_what_it_moved() {
    let mut most = 0.0f64;
    for primitive in ball() {
        for (p, step) in primitive.places.iter().zip(&primitive.moves) {
            most = most.max(step.z);
            assert!(step.x == 0.0 && step.y == 0.0 && (-1e-6..=RISE + 1e-6).contains(&step.z));
            if p.z < 0.5 {
                assert!(step.z.abs() < 1e-9, "at {p}");
            }
        }
    }
    assert!(most > 0.95 * RISE, "{most}");
}

#[test]
fn vertices_at_one_place_move_together() {
    // Where primitives and islands meet, a gap would open otherwise.
    let mut all = Vec::new();
    for primitive in ball() {
        for (i, p) in primitive.places.iter().enumerate() {
            let key = p.to_array().map(f64::to_bits);
            let weights = primitive.weights[i].map(f64::to_bits);
            let step = primitive.moves[i].to_array().map(f64::to_bits);
            all.push((key, (weights, primitive.joints[i], step)));
        }
    }
    all.sort_unstable();
    let n_shared = all.windows(2).filter(|two| two[0].0 == two[1].0).count();
    assert!(n_shared > 20, "{n_shared} vertices are split at seams");
    for two in all.windows(2).filter(|two| two[0].0 == two[1].0) {
        assert_eq!(two[0].1, two[1].1);
    }
}

#[test]
fn normals_are_smooth_where_those_of_the_file_were() {
    for primitive in ball() {
        for (p, normal) in primitive.places.iter().zip(&primitive.normals) {
            assert!((normal.length() - 1.0).abs() < 1e-6);
            let out = p.normalize_or_zero().dot(*normal);
            assert!(p.x > 2.0 || out > 0.97, "{normal} at {p}");
        }
        for face in primitive
            .faces
            .iter()
            .map(|f| f.map(|i| primitive.places[i]))
        {
            let [a, b, c] = face;
            let out = (b - a).cross(c - a).dot(a + b + c);
            assert!(a.x > 2.0 || out > 0.0, "a face looks inwards at {a}");
        }
    }
}

#[test]
fn a_part_that_stays_keeps_its_bits() {
    let places: Vec<_> = ball()
        .into_iter()
        .flat_map(|primitive| primitive.places)
        .collect();
    for corner in SPECK {
        let corner = DVec3::from_array(corner.map(f64::from));
        assert!(places.contains(&corner), "{corner}");
    }
}

#[test]
fn a_mirrored_node_does_not_turn_its_mesh_inside_out() {
    let Gltf { document, blob } = Gltf::from_slice(&done().file).unwrap();
    let bytes = blob.unwrap();
    let stone = document.meshes().nth(1).unwrap();
    assert_eq!(stone.primitives().len(), 1);
    let primitive = stone.primitives().next().unwrap();
    assert_eq!(
        primitive
            .attributes()
            .map(|(name, _)| name)
            .collect::<Vec<_>>(),
        [Semantic::Positions]
    );
    let reader = primitive.reader(|_| Some(&bytes[..]));
    let places: Vec<DVec3> = reader
        .read_positions()
        .unwrap()
        .map(|p| DVec3::from_array(p.map(f64::from)))
        .collect();
    let indices: Vec<_> = reader.read_indices().unwrap().into_u32().collect();
    assert!(
        places.iter().all(|p| (0.9..1.1).contains(&p.length())),
        "in its own space it is a ball"
    );
    for face in indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|i| places[face[i] as usize]);
        assert!((b - a).cross(c - a).dot(a + b + c) > 0.0);
    }
}

#[test]
fn the_same_file_gives_the_same_bytes_in_either_container() {
    let text = remeshed(&scene(), FACES, Container::Gltf).file;
    let Gltf { document, .. } = Gltf::from_slice(&text).unwrap();
    let Source::Uri(uri) = document.buffers().next().unwrap().source() else {
        panic!("the bytes are in the text");
    };
    let data = uri
        .strip_prefix("data:application/octet-stream;base64,")
        .unwrap();
    let (same, mut bytes) = parts(&done().file);
    let data = STANDARD.decode(data).unwrap();
    bytes.truncate(data.len());
    assert!(data == bytes);
    let text: serde_json::Value = serde_json::from_slice(&text).unwrap();
    assert_eq!(text["accessors"], same["accessors"]);
    let [by_text, by_bytes] =
        [&text.to_string().into_bytes(), &done().file].map(|file| Scene::read(file, None).unwrap());
    assert_eq!(by_text.mesh(), by_bytes.mesh());
}
