//! Accessors, buffer views and bytes of a file that is written: what is free is used again, so that
//! nothing that stays gets another number.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use crate::accessor::KINDS;
use crate::build::{Building, Channel, Name};
use crate::uses::Numbered;

/// Buffer views for vertices and for indices.
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// The lists of a file that are written anew.
pub struct Slots {
    pub accessors: Vec<Value>,
    pub views: Vec<Value>,
    pub bytes: Vec<u8>,
    free: Numbered,
}

impl Slots {
    pub fn new(accessors: Vec<Value>, views: Vec<Value>, free: Numbered) -> Self {
        Self {
            accessors,
            views,
            bytes: Vec::new(),
            free,
        }
    }

    /// The place of bytes that are added.
    pub fn add_bytes(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bytes.len().next_multiple_of(4);
        self.bytes.resize(offset, 0);
        self.bytes.extend_from_slice(bytes);
        offset
    }

    /// The view of bytes that are added.
    pub fn add_view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.add_bytes(bytes);
        let view = json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()});
        put(&mut self.views, &mut self.free.views, view)
    }

    /// Adds what a primitive has: its `attributes`, `targets` and `indices`.
    pub fn add_primitive(&mut self, primitive: &Building) -> Map<String, Value> {
        let mut attributes = Map::new();
        let mut targets: Vec<Map<String, Value>> = Vec::new();
        for channel in &primitive.layout.channels {
            let accessor = json!(self.add_channel(primitive, channel));
            match &channel.name {
                Name::Attribute(name) => {
                    attributes.insert(name.clone(), accessor);
                }
                Name::Target(i, name) => {
                    targets.resize(targets.len().max(i + 1), Map::new());
                    targets[*i].insert((*name).to_owned(), accessor);
                }
            }
        }
        let mut parts = Map::new();
        parts.insert("attributes".into(), attributes.into());
        let indices = self.add_indices(primitive);
        parts.insert("indices".into(), json!(indices));
        if !targets.is_empty() {
            parts.insert("targets".into(), json!(targets));
        }
        parts
    }

    fn add_channel(&mut self, primitive: &Building, channel: &Channel) -> usize {
        let bytes = primitive.bytes(channel);
        let view = self.add_view(&bytes);
        self.views[view]["target"] = json!(VERTICES);
        if channel.size() != channel.component.size() * channel.width {
            self.views[view]["byteStride"] = json!(channel.size());
        }
        let kind = KINDS.iter().find(|(_, width)| *width == channel.width);
        let mut accessor = json!({
            "bufferView": view,
            "componentType": channel.component.code(),
            "count": primitive.n_vertices,
            "type": kind.map(|(name, _)| *name),
        });
        if channel.normalized {
            accessor["normalized"] = json!(true);
        }
        if channel.is_bounded {
            let [low, high] = bounds(&bytes);
            accessor["min"] = json!(low);
            accessor["max"] = json!(high);
        }
        put(&mut self.accessors, &mut self.free.accessors, accessor)
    }

    fn add_indices(&mut self, primitive: &Building) -> usize {
        let is_small = primitive.n_vertices < usize::from(u16::MAX);
        let indices = primitive.indices.iter();
        let bytes: Vec<u8> = if is_small {
            indices.flat_map(|&i| (i as u16).to_le_bytes()).collect()
        } else {
            indices.flat_map(|i| i.to_le_bytes()).collect()
        };
        let view = self.add_view(&bytes);
        self.views[view]["target"] = json!(INDICES);
        let accessor = json!({
            "bufferView": view,
            "componentType": if is_small { 5123 } else { 5125 },
            "count": primitive.indices.len(),
            "type": "SCALAR",
        });
        put(&mut self.accessors, &mut self.free.accessors, accessor)
    }

    /// Leaves out what is free at the end, and makes the rest of what is free as small as can be.
    pub fn finish(&mut self) {
        cut(&mut self.accessors, &mut self.free.accessors);
        if !self.free.accessors.is_empty() {
            let view = self.add_view(&[0; 4]);
            for &i in &self.free.accessors {
                self.accessors[i] = json!({
                    "bufferView": view, "componentType": 5126, "count": 1, "type": "SCALAR",
                });
            }
        }
        cut(&mut self.views, &mut self.free.views);
        if !self.free.views.is_empty() {
            let offset = self.add_bytes(&[0; 4]);
            for &i in &self.free.views {
                self.views[i] = json!({"buffer": 0, "byteOffset": offset, "byteLength": 4});
            }
        }
    }
}

/// Puts a value in the first free place, or at the end.
fn put(list: &mut Vec<Value>, free: &mut BTreeSet<usize>, value: Value) -> usize {
    if let Some(i) = free.pop_first() {
        list[i] = value;
        return i;
    }
    list.push(value);
    list.len() - 1
}

fn cut(list: &mut Vec<Value>, free: &mut BTreeSet<usize>) {
    while let Some(last) = list.len().checked_sub(1).filter(|last| free.remove(last)) {
        list.truncate(last);
    }
}

/// The least and the largest of points of three numbers.
fn bounds(bytes: &[u8]) -> [[f32; 3]; 2] {
    let (mut low, mut high) = ([f32::MAX; 3], [f32::MIN; 3]);
    for point in bytes.chunks_exact(12) {
        for (i, number) in point.chunks_exact(4).enumerate() {
            let value = f32::from_le_bytes([number[0], number[1], number[2], number[3]]);
            low[i] = low[i].min(value);
            high[i] = high[i].max(value);
        }
    }
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_places_are_used_first_and_the_rest_is_cut_or_made_small() {
        let old = || vec![json!(0), json!(1), json!(2), json!(3), json!(4)];
        let free = Numbered {
            accessors: [4].into(),
            views: [0, 2, 4].into(),
        };
        let mut slots = Slots::new(old(), old(), free);
        assert_eq!(slots.add_view(&[7; 5]), 0);
        slots.finish();
        assert_eq!(slots.accessors.len(), 4);
        assert_eq!(slots.views.len(), 4);
        assert_eq!(slots.views[2]["byteOffset"], 8);
        assert_eq!(slots.views[3], 3);
        assert_eq!(slots.bytes.len(), 12);
    }
}
