//! Primitives while they are built: vertices as records of bytes, each once.

use std::collections::HashMap;

use crate::accessor::{Component, Numbers};

/// What a channel is called in a primitive.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Name {
    Attribute(String),
    Target(usize, &'static str),
}

/// One attribute in the records.
#[derive(Clone, PartialEq, Debug)]
pub struct Channel {
    pub name: Name,
    pub component: Component,
    pub normalized: bool,
    pub width: usize,
    /// Whether readers must be told the least and the largest values.
    pub is_bounded: bool,
    pub offset: usize,
}

impl Channel {
    /// How many bytes an element has, filled up to words.
    pub fn size(&self) -> usize {
        (self.component.size() * self.width).next_multiple_of(4)
    }
}

/// The channels of a record, one after the other.
#[derive(Clone, Default, Debug)]
pub struct Layout {
    pub channels: Vec<Channel>,
    stride: usize,
}

impl Layout {
    /// Adds one with three or so floating-point numbers.
    pub fn floats(&mut self, name: Name, width: usize) {
        let numbers = Numbers {
            component: Component::F32,
            normalized: false,
            width,
            values: Vec::new(),
        };
        self.like(name, &numbers);
    }

    /// Adds one with numbers of the same type as these.
    pub fn like(&mut self, name: Name, numbers: &Numbers) {
        let is_place = match &name {
            Name::Attribute(name) => name == "POSITION",
            Name::Target(_, name) => *name == "POSITION",
        };
        let channel = Channel {
            name,
            component: numbers.component,
            normalized: numbers.normalized,
            width: numbers.width,
            is_bounded: is_place,
            offset: self.stride,
        };
        self.stride += channel.size();
        self.channels.push(channel);
    }
}

/// A record while it is written.
#[derive(Debug)]
pub struct Record(Vec<u8>);

impl Record {
    pub fn floats(&mut self, values: impl IntoIterator<Item = f64>) {
        for value in values {
            // Both zeros are one value.
            self.0.extend((value as f32 + 0.0).to_le_bytes());
        }
    }

    /// Shares as numbers of a type; whole ones are rounded.
    pub fn numbers(&mut self, component: Component, values: &[f64]) {
        let most = f64::from(component.most());
        let whole = |value: f64| (value * most).round().clamp(0.0, most);
        match component {
            Component::U8 => self
                .0
                .extend(values.iter().map(|&value| whole(value) as u8)),
            Component::U16 => {
                let words = values.iter().map(|&value| whole(value) as u16);
                self.0.extend(words.flat_map(u16::to_le_bytes));
            }
            _ => return self.floats(values.iter().copied()),
        }
        self.fill();
    }

    pub fn bones(&mut self, is_wide: bool, bones: &[u16]) {
        if is_wide {
            self.0
                .extend(bones.iter().flat_map(|bone| bone.to_le_bytes()));
        } else {
            self.0.extend(bones.iter().map(|&bone| bone as u8));
        }
        self.fill();
    }

    fn fill(&mut self) {
        self.0.resize(self.0.len().next_multiple_of(4), 0);
    }
}

/// A primitive of vertices that are shared where all that lies on them agrees.
#[derive(Debug)]
pub struct Building {
    pub layout: Layout,
    pub n_vertices: usize,
    pub indices: Vec<u32>,
    records: Vec<u8>,
    known: HashMap<Vec<u8>, u32>,
}

impl Building {
    pub fn new(layout: Layout) -> Self {
        Self {
            layout,
            n_vertices: 0,
            indices: Vec::new(),
            records: Vec::new(),
            known: HashMap::new(),
        }
    }

    /// The vertex with this record.
    pub fn vertex(&mut self, write: impl FnOnce(&mut Record)) -> u32 {
        let mut record = Record(Vec::with_capacity(self.layout.stride));
        write(&mut record);
        debug_assert_eq!(record.0.len(), self.layout.stride);
        if let Some(&vertex) = self.known.get(&record.0) {
            return vertex;
        }
        let vertex = self.n_vertices as u32;
        self.n_vertices += 1;
        self.records.extend_from_slice(&record.0);
        self.known.insert(record.0, vertex);
        vertex
    }

    /// The bytes of a channel, vertex by vertex.
    pub fn bytes(&self, channel: &Channel) -> Vec<u8> {
        let range = channel.offset..channel.offset + channel.size();
        let records = self.records.chunks_exact(self.layout.stride);
        records
            .flat_map(|record| &record[range.clone()])
            .copied()
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_shared_where_all_agrees() {
        let mut layout = Layout::default();
        layout.floats(Name::Attribute("POSITION".into()), 3);
        let color = Numbers {
            component: Component::U8,
            normalized: true,
            width: 3,
            values: Vec::new(),
        };
        layout.like(Name::Attribute("COLOR_0".into()), &color);
        let mut building = Building::new(layout);
        let mut vertex = |x: f64, red: f64| {
            building.vertex(|record| {
                record.floats([x, 0.0, 0.0]);
                record.numbers(Component::U8, &[red, 0.5, 1.0]);
            })
        };
        let found = [
            vertex(0.0, 0.0),
            vertex(0.0, 1.0),
            vertex(-0.0, 0.0),
            vertex(1.0, 0.0),
        ];
        assert_eq!(found, [0, 1, 0, 2]);
        let channel = building.layout.channels[1].clone();
        let bytes = building.bytes(&channel);
        assert_eq!(bytes, [0, 128, 255, 0, 255, 128, 255, 0, 0, 128, 255, 0]);
    }
}
