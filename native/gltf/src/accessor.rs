//! Accessors: numbers in the bytes of buffers.

use std::cell::Cell;

use crate::error::{Item, ReadError};
use crate::schema::{Accessor, Root, Sparse};

/// The most numbers that are read of all meshes together: 2 GiB of them.
const MOST: usize = 1 << 29;

/// The types of numbers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u32) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// The number that stands for it.
    pub fn code(self) -> u32 {
        match self {
            Self::I8 => 5120,
            Self::U8 => 5121,
            Self::I16 => 5122,
            Self::U16 => 5123,
            Self::U32 => 5125,
            Self::F32 => 5126,
        }
    }

    /// How many bytes a number has.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// What stands for 1 where whole numbers stand for shares.
    pub fn most(self) -> f32 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::U32 | Self::F32 => 1.0,
        }
    }

    fn is_index(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    fn number(self, bytes: &[u8]) -> f32 {
        match *bytes {
            [a] if self == Self::I8 => f32::from(a as i8),
            [a] => f32::from(a),
            [a, b] if self == Self::I16 => f32::from(i16::from_le_bytes([a, b])),
            [a, b] => f32::from(u16::from_le_bytes([a, b])),
            [a, b, c, d] if self == Self::F32 => f32::from_le_bytes([a, b, c, d]),
            [a, b, c, d] => u32::from_le_bytes([a, b, c, d]) as f32,
            _ => 0.0,
        }
    }
}

/// What an accessor holds.
#[derive(Clone, PartialEq, Debug)]
pub struct Numbers {
    pub component: Component,
    pub normalized: bool,
    /// How many numbers an element has.
    pub width: usize,
    pub values: Vec<f32>,
}

/// The names of types and how many numbers they have.
pub const KINDS: [(&str, usize); 5] = [
    ("SCALAR", 1),
    ("VEC2", 2),
    ("VEC3", 3),
    ("VEC4", 4),
    ("MAT4", 16),
];

/// The accessors of a file.
pub struct Accessors<'a> {
    pub root: &'a Root,
    pub buffers: &'a [Vec<u8>],
    left: Cell<usize>,
    /// How many numbers were not finite, by accessor.
    pub not_finite: Cell<usize>,
}

/// Elements in bytes.
struct Run<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Run<'a> {
    fn elements(&self) -> impl Iterator<Item = &'a [u8]> {
        let (bytes, stride, size) = (self.bytes, self.stride, self.size);
        (0..self.count).map(move |i| &bytes[i * stride..i * stride + size])
    }
}

impl<'a> Accessors<'a> {
    pub fn new(root: &'a Root, buffers: &'a [Vec<u8>]) -> Self {
        Self {
            root,
            buffers,
            left: Cell::new(MOST),
            not_finite: Cell::new(0),
        }
    }

    /// The numbers of an accessor as shares where they are that; numbers that are not finite are 0.
    ///
    /// `n` is how many elements there have to be, if that is known.
    pub fn numbers(&self, index: usize, by: Item, n: Option<usize>) -> Result<Numbers, ReadError> {
        let accessor = self.accessor(index, by)?;
        let item = Item::Of("accessor", index);
        let (component, width) = shape(accessor, item)?;
        check_count(accessor, item, n)?;
        let count = accessor.count;
        let least = if accessor.normalized {
            -1.0
        } else {
            f32::NEG_INFINITY
        };
        let scale = if accessor.normalized {
            component.most()
        } else {
            1.0
        };
        let number = |bytes: &[u8]| self.finite(component.number(bytes) / scale).max(least);
        let numbers = |element: &'a [u8]| element.chunks_exact(component.size()).map(number);
        let mut values: Vec<f32> = if let Some(view) = accessor.buffer_view {
            let at = (view, accessor.byte_offset);
            let run = self.run(item, at, count, (width, component.size()))?;
            self.spend(count.saturating_mul(width))?;
            run.elements().flat_map(numbers).collect()
        } else {
            self.spend(count.saturating_mul(width))?;
            vec![0.0; count * width]
        };
        if let Some(sparse) = &accessor.sparse {
            for (i, element) in self.sparse(sparse, (item, count), width * component.size())? {
                for (value, number) in values[i * width..].iter_mut().zip(numbers(element)) {
                    *value = number;
                }
            }
        }
        Ok(Numbers {
            component,
            normalized: accessor.normalized,
            width,
            values,
        })
    }

    /// Whole numbers that name vertices, of which there are `n`.
    pub fn indices(&self, index: usize, by: Item, n: usize) -> Result<Vec<u32>, ReadError> {
        let accessor = self.accessor(index, by)?;
        let item = Item::Of("accessor", index);
        let (component, width) = shape(accessor, item)?;
        if !component.is_index() || width != 1 || accessor.sparse.is_some() {
            let found = format!("{} of type {}", accessor.kind, accessor.component_type);
            let expected = "whole numbers without sign, one an element,";
            return Err(ReadError::Unexpected {
                item,
                expected,
                found,
            });
        }
        let view = accessor.buffer_view.ok_or(no_bytes(item))?;
        let at = (view, accessor.byte_offset);
        let run = self.run(item, at, accessor.count, (1, component.size()))?;
        self.spend(accessor.count)?;
        let indices: Vec<u32> = run.elements().map(whole).collect();
        match indices.iter().find(|&&i| i as usize >= n) {
            None => Ok(indices),
            Some(&i) => Err(ReadError::NoSuch {
                by: item,
                what: "vertex",
                index: i as usize,
                n,
            }),
        }
    }

    fn accessor(&self, index: usize, by: Item) -> Result<&'a Accessor, ReadError> {
        let all = &self.root.accessors;
        all.get(index).ok_or(ReadError::NoSuch {
            by,
            what: "accessor",
            index,
            n: all.len(),
        })
    }

    /// The bytes of sparse elements and their places.
    fn sparse(
        &self,
        sparse: &Sparse,
        (item, n): (Item, usize),
        size: usize,
    ) -> Result<Vec<(usize, &'a [u8])>, ReadError> {
        let Sparse {
            count,
            indices,
            values,
        } = sparse;
        let component = Component::of(indices.component_type).filter(|c| c.is_index());
        let component = component.ok_or_else(|| ReadError::Unexpected {
            item,
            expected: "whole numbers as sparse indices",
            found: format!("type {}", indices.component_type),
        })?;
        let at = (indices.buffer_view, indices.byte_offset);
        let which = self.run(item, at, *count, (1, component.size()))?;
        let at = (values.buffer_view, values.byte_offset);
        let what = self.run(item, at, *count, (1, size))?;
        let places = which.elements().map(|bytes| whole(bytes) as usize);
        let mut found = Vec::with_capacity(*count);
        for (index, element) in places.zip(what.elements()) {
            if index >= n {
                return Err(ReadError::NoSuch {
                    by: item,
                    what: "element",
                    index,
                    n,
                });
            }
            found.push((index, element));
        }
        Ok(found)
    }

    /// Elements from an offset of a view on, checked to lie in it and in its buffer.
    fn run(
        &self,
        item: Item,
        (view, offset): (usize, usize),
        count: usize,
        (width, size): (usize, usize),
    ) -> Result<Run<'a>, ReadError> {
        let bytes = view_bytes(self.root, self.buffers, item, view)?;
        let size = width * size;
        let stride = self.root.views[view].byte_stride.unwrap_or(size);
        if stride < size {
            return Err(ReadError::Unexpected {
                item,
                expected: "elements that do not overlap",
                found: format!("{size} bytes every {stride} bytes"),
            });
        }
        let last = (count as u64)
            .saturating_sub(1)
            .saturating_mul(stride as u64);
        let length = if count == 0 { 0 } else { size as u64 };
        let needed = last.saturating_add(length).saturating_add(offset as u64);
        if needed > bytes.len() as u64 {
            return Err(ReadError::OutOfRange {
                item,
                needed,
                of: Item::Of("buffer view", view),
                has: bytes.len(),
            });
        }
        Ok(Run {
            bytes: &bytes[offset..],
            stride,
            size,
            count,
        })
    }

    fn spend(&self, n: usize) -> Result<(), ReadError> {
        let left = self.left.get().checked_sub(n);
        let left = left.ok_or(ReadError::TooLarge { most: MOST })?;
        self.left.set(left);
        Ok(())
    }

    fn finite(&self, number: f32) -> f32 {
        if number.is_finite() {
            return number;
        }
        self.not_finite.set(self.not_finite.get() + 1);
        0.0
    }
}

/// The bytes of a view.
pub fn view_bytes<'a>(
    root: &Root,
    buffers: &'a [Vec<u8>],
    by: Item,
    view: usize,
) -> Result<&'a [u8], ReadError> {
    let n = root.views.len();
    let found = root.views.get(view).ok_or(ReadError::NoSuch {
        by,
        what: "buffer view",
        index: view,
        n,
    })?;
    let item = Item::Of("buffer view", view);
    let buffer = buffers.get(found.buffer).ok_or(ReadError::NoSuch {
        by: item,
        what: "buffer",
        index: found.buffer,
        n: buffers.len(),
    })?;
    let end = found.byte_offset.saturating_add(found.byte_length);
    buffer
        .get(found.byte_offset..end)
        .ok_or(ReadError::OutOfRange {
            item,
            needed: end as u64,
            of: Item::Of("buffer", found.buffer),
            has: buffer.len(),
        })
}

/// Whether there are as many elements as there have to be. Without bytes a count is believed only where
/// that of the positions has been.
fn check_count(accessor: &Accessor, item: Item, n: Option<usize>) -> Result<(), ReadError> {
    let found = accessor.count;
    match n {
        Some(expected) if expected != found => Err(ReadError::Count {
            item,
            expected,
            found,
        }),
        None if accessor.buffer_view.is_none() => Err(no_bytes(item)),
        _ => Ok(()),
    }
}

fn no_bytes(item: Item) -> ReadError {
    ReadError::Unexpected {
        item,
        expected: "bytes of a buffer",
        found: "none".to_owned(),
    }
}

fn shape(accessor: &Accessor, item: Item) -> Result<(Component, usize), ReadError> {
    let component = Component::of(accessor.component_type);
    let kind = KINDS.iter().find(|(name, _)| *name == accessor.kind);
    match (component, kind) {
        (Some(component), Some(&(_, width))) => Ok((component, width)),
        _ => Err(ReadError::Unexpected {
            item,
            expected: "a type of the specification",
            found: format!("{} of type {}", accessor.kind, accessor.component_type),
        }),
    }
}

fn whole(bytes: &[u8]) -> u32 {
    let mut word = [0; 4];
    word[..bytes.len()].copy_from_slice(bytes);
    u32::from_le_bytes(word)
}
