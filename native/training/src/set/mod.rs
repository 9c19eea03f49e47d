//! A set of shapes made ready to train on, in one file.
//!
//! ```text
//!  0  8 bytes  "ORBFLOWS"
//!  8  u32      version of this layout, 2 with targets and 1 without; all numbers are little-endian
//! 12  u32      length h of the head
//! 16  u64      FNV-1a of the head: against accidents, not against forgers
//! 24  h bytes  head, JSON: see [`Head`]
//!  +  blocks   one for each source, in the order of their list
//!
//!  0  4 bytes  "SRCE"                                        a block
//!  4  u32      length e of the entry
//!  8  u64      length p of the parts
//! 16  u64      FNV-1a of the entry
//! 24  u64      FNV-1a of the 24 bytes before
//! 32  e bytes  entry of the manifest, JSON: see [`Source`]
//!  +  p bytes  the parts, one after the other; each may end with its target
//! ```
//!
//! A run that was cut leaves whole blocks and at most one that is not; [`Set::open`] passes over that
//! one, and `prepare` goes on from there. Parts are read by their place in the file when they are
//! asked for: mapping it into memory would take unsafe code, which this workspace forbids. What a
//! file says is checked before memory is asked for.

mod encode;
mod manifest;
mod read;
mod write;

pub use encode::{PartError, Shape};
pub use manifest::{Counts, Head, Manifest, Source, Split};
pub use read::{Set, SetError, Which};
pub use write::{Writer, WriterError};

const MAGIC: &[u8; 8] = b"ORBFLOWS";
/// Versions that are read. Sets without targets stay what every program can read.
const PLAIN: u32 = 1;
const WITH_TARGETS: u32 = 2;
const BLOCK: &[u8; 4] = b"SRCE";
/// The length of what stands before the head, and before the entry of a block.
const FRONT: usize = 24;
const BLOCK_FRONT: usize = 32;
/// The longest text that is believed: an entry has three parts and a few sentences.
const MAX_TEXT: usize = 1 << 20;

/// The version of the layout of a set.
fn version(head: &Head) -> u32 {
    match head.targets {
        None => PLAIN,
        Some(_) => WITH_TARGETS,
    }
}

/// The little-endian number in up to eight bytes.
fn number(digits: &[u8]) -> u64 {
    let digits = digits.iter().rev();
    digits.fold(0, |sum, &byte| sum << 8 | u64::from(byte))
}

#[cfg(test)]
mod tests;
