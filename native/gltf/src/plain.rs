//! A plain mesh as a scene of one node.

use std::collections::BTreeMap;

use glam::DVec3;
use orbflow_geometry::mesh::io::MeshFile;
use serde_json::{Map, Value, json};

use crate::Container;
use crate::build::{Building, Layout, Name};
use crate::error::WriteError;
use crate::slots::Slots;
use crate::triangles::cut;
use crate::uses::Numbered;
use crate::write::assembled;

/// Writes a mesh with its materials, by name and otherwise as they are by default, and its texture
/// coordinates. Polygons are cut into triangles; normals are left out.
///
/// # Errors
/// When it is too large for its container, or a vertex too far away.
pub fn plain(file: &MeshFile, container: Container) -> Result<Vec<u8>, WriteError> {
    let mut primitives: BTreeMap<Option<i32>, Building> = BTreeMap::new();
    let mesh = &file.mesh;
    for (face, (&first, corners)) in mesh.starts().iter().zip(mesh.faces()).enumerate() {
        let material = file.materials.get(face).copied();
        let building = primitives
            .entry(material)
            .or_insert_with(|| Building::new(layout(file)));
        let places: Vec<DVec3> = corners.iter().map(|&v| mesh.position(v)).collect();
        let mut names = Vec::with_capacity(places.len());
        for (i, &place) in places.iter().enumerate() {
            if !place.as_vec3().is_finite() {
                return Err(WriteError::NotFinite { position: place });
            }
            names.push(building.vertex(|record| {
                record.floats(place.to_array());
                if let Some(coordinate) = file.coordinates.get(first as usize + i) {
                    let [u, v] = coordinate.unwrap_or_default();
                    record.floats([u, 1.0 - v]);
                }
            }));
        }
        building
            .indices
            .extend(cut(&places).into_iter().flatten().map(|i| names[i]));
    }
    let mut slots = Slots::new(Vec::new(), Vec::new(), Numbered::default());
    let (mut entries, mut materials) = (Vec::new(), Vec::new());
    for (material, building) in &primitives {
        let mut entry = slots.add_primitive(building);
        if let Some(material) = material {
            let name = usize::try_from(*material).ok();
            let name = name.and_then(|i| file.material_names.get(i)).cloned();
            let name = name.unwrap_or_else(|| format!("material_{material}"));
            entry.insert("material".into(), json!(materials.len()));
            materials.push(json!({"name": name}));
        }
        entries.push(Value::Object(entry));
    }
    assembled(scene(&entries, &materials), slots, container)
}

fn layout(file: &MeshFile) -> Layout {
    let mut layout = Layout::default();
    layout.floats(Name::Attribute("POSITION".into()), 3);
    if !file.coordinates.is_empty() {
        layout.floats(Name::Attribute("TEXCOORD_0".into()), 2);
    }
    layout
}

fn scene(primitives: &[Value], materials: &[Value]) -> Value {
    let mut scene = Map::new();
    scene.insert(
        "asset".into(),
        json!({"version": "2.0", "generator": "Orbflow"}),
    );
    scene.insert("scene".into(), json!(0));
    let node = if primitives.is_empty() {
        json!({})
    } else {
        json!({"mesh": 0})
    };
    scene.insert("scenes".into(), json!([{"nodes": [0]}]));
    scene.insert("nodes".into(), json!([node]));
    if !primitives.is_empty() {
        scene.insert("meshes".into(), json!([{"primitives": primitives}]));
    }
    if !materials.is_empty() {
        scene.insert("materials".into(), json!(materials));
    }
    scene.into()
}
