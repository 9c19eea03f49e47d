//! Writing: the file's text with new primitives.

use std::collections::{BTreeMap, BTreeSet};

use orbflow_geometry::mesh::{Id, PolygonMesh};
use orbflow_geometry::pipeline::{Origin, Origins};
use serde_json::{Map, Value, json};

use crate::accessor::view_bytes;
use crate::build::Building;
use crate::carry::Carrying;
use crate::error::{Item, WriteError};
use crate::scene::{Cuts, Made, Scene};
use crate::slots::Slots;
use crate::uses::free;
use crate::{Container, beside, container};

/// A file that was made, and sentences about what it lacks.
#[derive(Clone, PartialEq, Debug)]
pub struct Written {
    /// The file.
    pub bytes: Vec<u8>,
    /// What it lacks.
    pub notes: Vec<String>,
}

impl Scene {
    /// The file with what was made of its meshes in their place.
    ///
    /// Quads and larger polygons are cut into triangles. A mesh of which nothing is left keeps one
    /// point, so that nodes, skins and animations that name it still fit.
    ///
    /// # Errors
    /// When it is too large for its container, or a vertex too far away.
    ///
    /// # Panics
    /// When the origins are not those of the mesh by these cuts.
    pub fn written(
        &self,
        made: Made<'_>,
        cuts: &Cuts,
        container: Container,
    ) -> Result<Written, WriteError> {
        let mut notes = Vec::new();
        let primitives = Carrying::new(self, made, cuts).primitives()?;
        let primitives = self.not_empty(primitives, cuts, &mut notes)?;
        let is_rebuilt = |mesh, primitive| primitives.contains_key(&(mesh, primitive));
        let free = free(&self.root, &self.text, is_rebuilt);
        let list = |name: &str| self.text[name].as_array().cloned().unwrap_or_default();
        let is_kept = |view: &usize| !free.views.contains(view);
        let kept: Vec<usize> = (0..self.root.views.len()).filter(is_kept).collect();
        let mut slots = Slots::new(list("accessors"), list("bufferViews"), free);
        for view in kept {
            let bytes = view_bytes(&self.root, &self.buffers, Item::File, view);
            let offset = slots.add_bytes(bytes.expect("views were checked"));
            let entry = &mut slots.views[view];
            entry["buffer"] = json!(0);
            entry["byteOffset"] = json!(offset);
        }
        let mut text = self.text.clone();
        put_primitives(&mut text, &primitives, &mut slots);
        self.put_images(&mut text, &mut slots);
        slots.finish();
        let bytes = assembled(text, slots, container)?;
        Ok(Written { bytes, notes })
    }

    /// The primitives by their places; none where one is to go because nothing of it is left.
    fn not_empty(
        &self,
        primitives: Vec<Building>,
        cuts: &Cuts,
        notes: &mut Vec<String>,
    ) -> Result<BTreeMap<(usize, usize), Option<Building>>, WriteError> {
        let mut n_left: BTreeMap<usize, usize> = BTreeMap::new();
        for group in &self.groups {
            let mesh = group.placed.mesh;
            n_left.insert(mesh, self.root.meshes[mesh].primitives.len());
        }
        let mut all = BTreeMap::new();
        for (number, (group, building)) in self.groups.iter().zip(primitives).enumerate() {
            let place = (group.placed.mesh, group.primitive);
            if !building.indices.is_empty() {
                all.insert(place, Some(building));
                continue;
            }
            let item = Item::Primitive(place.0, place.1);
            let left = n_left.get_mut(&place.0).expect("every mesh was counted");
            if *left > 1 {
                *left -= 1;
                notes.push(format!(
                    "no face of the result comes from {item}: it is gone"
                ));
                all.insert(place, None);
            } else {
                notes.push(format!(
                    "no face of the result comes from {item}: a point is left"
                ));
                all.insert(place, Some(self.point(number, cuts)?));
            }
        }
        Ok(all)
    }

    /// A triangle without area for a primitive, where its first corner was.
    fn point(&self, group: usize, cuts: &Cuts) -> Result<Building, WriteError> {
        let face = self.of_faces.iter().position(|&of| of as usize == group);
        let face = face.expect("every group has a face");
        let corner = 3 * face as u32;
        let origin = Origin {
            corners: [corner; 3],
            weights: [1.0, 0.0, 0.0],
        };
        let place = self.mesh.position(self.mesh.corners()[corner as usize]);
        let mesh = PolygonMesh::from_faces(vec![place], &[[0, 0, 0]]);
        let mesh = mesh.expect("a repeated corner is allowed");
        let origins = Origins {
            vertices: vec![origin],
            corners: vec![vec![origin; 3]; cuts.sets.len()],
            faces: vec![Id::from_index(face)],
        };
        let made = Made {
            mesh: &mesh,
            origins: &origins,
        };
        let primitives = Carrying::new(self, made, cuts).primitives()?;
        let found = primitives.into_iter().nth(group);
        Ok(found.expect("every group has a primitive"))
    }

    /// Images that were files beside it become bytes of the file.
    fn put_images(&self, text: &mut Value, slots: &mut Slots) {
        for (&i, bytes) in &self.images {
            let view = slots.add_view(bytes);
            let Some(image) = text["images"][i].as_object_mut() else {
                continue;
            };
            image.remove("uri");
            image.insert("bufferView".into(), json!(view));
            image
                .entry("mimeType")
                .or_insert(json!(kind_of_image(bytes)));
        }
    }
}

/// The media type of an image by its first bytes.
fn kind_of_image(bytes: &[u8]) -> &'static str {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => "image/png",
        [b'R', b'I', b'F', b'F', ..] => "image/webp",
        [0xAB, b'K', b'T', b'X', ..] => "image/ktx2",
        _ => "image/jpeg",
    }
}

fn put_primitives(
    text: &mut Value,
    primitives: &BTreeMap<(usize, usize), Option<Building>>,
    slots: &mut Slots,
) {
    let mut gone: BTreeSet<(usize, usize)> = BTreeSet::new();
    for (&(mesh, primitive), building) in primitives {
        let Some(building) = building else {
            gone.insert((mesh, primitive));
            continue;
        };
        let parts = slots.add_primitive(building);
        let entry = &mut text["meshes"][mesh]["primitives"][primitive];
        if let Some(entry) = entry.as_object_mut() {
            entry.remove("mode");
            entry.extend(parts);
        }
    }
    // From the last on, so that numbers stay true.
    for (mesh, primitive) in gone.into_iter().rev() {
        if let Some(list) = text["meshes"][mesh]["primitives"].as_array_mut() {
            list.remove(primitive);
        }
    }
}

/// Text and bytes as one file.
pub fn assembled(text: Value, slots: Slots, container: Container) -> Result<Vec<u8>, WriteError> {
    let Slots {
        accessors,
        views,
        bytes,
        ..
    } = slots;
    let mut text = text;
    let first = text.pointer_mut("/buffers/0").map(Value::take);
    let mut buffer = match first {
        Some(Value::Object(buffer)) => buffer,
        _ => Map::new(),
    };
    buffer.remove("uri");
    buffer.insert("byteLength".into(), json!(bytes.len()));
    if container == Container::Gltf {
        buffer.insert("uri".into(), json!(beside::data(&bytes)));
    }
    let lists = [
        ("accessors", accessors),
        ("bufferViews", views),
        ("buffers", vec![buffer.into()]),
    ];
    for (name, list) in lists {
        // The format has no empty lists.
        if !bytes.is_empty() {
            text[name] = Value::Array(list);
        }
    }
    let written = serde_json::to_vec(&text)?;
    match container {
        Container::Glb => container::joined(written, bytes),
        Container::Gltf => Ok(written),
    }
}
