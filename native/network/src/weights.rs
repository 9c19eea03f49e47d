//! The file of a trained network.
//!
//! ```text
//!  0  8 bytes  "ORBFLOWN"
//!  8  u32      version of this layout, 2; all numbers are little-endian
//! 12  u32      length h of the header
//! 16  u64      length p of the parameters
//! 24  u64      FNV-1a of header and parameters: against accidents, not against forgers
//! 32  h bytes  header, JSON: see [`Header`]
//!  +  p bytes  parameters in half precision, in the order of [`Network::new`]
//! ```
//!
//! Nothing in a file is executed, and what it says is checked before memory is asked for.

use half::f16;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::features::N_FEATURES;
use crate::net::{Network, Sizes};

/// The weights that every build carries; `native/training/runs/README.md` says where they come from.
const SHIPPED: &[u8] = include_bytes!("../weights.orbflow");
const MAGIC: &[u8; 8] = b"ORBFLOWN";
const VERSION: u32 = 2;
/// The length of what stands before the header.
const FRONT: usize = 32;
/// Where the sum stands in it.
const SUM_AT: usize = 24;
/// The most that a header may ask for.
const MAX_WIDTH: usize = 512;
const MAX_LEVELS: usize = 8;
const MAX_BLOCKS: usize = 16;
const MAX_RELAXATIONS: usize = 64;
const MAX_VERTICES: usize = 1 << 24;

/// What the file says of its network.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Header {
    /// Widths, levels, blocks and relaxations.
    pub sizes: Sizes,
    /// How many numbers a vertex brings.
    pub n_features: usize,
    /// How it was trained, on what, and under which licences.
    pub provenance: String,
}

/// What a file holds.
#[derive(Clone, PartialEq, Debug)]
pub struct Weights {
    /// The header.
    pub header: Header,
    /// The parameters, in the order of [`Network::new`].
    pub parameters: Vec<f32>,
}

/// Why bytes are no network.
#[derive(Clone, PartialEq, Eq, Debug, Error)]
pub enum ReadWeightsError {
    /// It begins with something else.
    #[error("these are no weights of orbflow: they do not begin with ORBFLOWN")]
    NotWeights,
    /// Made by another version.
    #[error("the weights have version {found}; this program reads version {VERSION}")]
    Version {
        /// What the file says.
        found: u32,
    },
    /// The lengths do not fit.
    #[error("the weights have {found} bytes, but {wanted} by their own account")]
    Length {
        /// How many there are.
        found: u64,
        /// How many there should be.
        wanted: u64,
    },
    /// The bytes changed since they were written.
    #[error("the weights are damaged: their sum is {found:016x}, but was {wanted:016x}")]
    Damaged {
        /// What it is.
        found: u64,
        /// What the file says.
        wanted: u64,
    },
    /// The header is no such JSON.
    #[error("the header of the weights cannot be read: {reason}")]
    Header {
        /// Why.
        reason: String,
    },
    /// The header asks for what this program does not do.
    #[error("the weights are for {what} = {found}; this program can do {can}")]
    Sizes {
        /// Which size.
        what: &'static str,
        /// How much.
        found: usize,
        /// How much there may be.
        can: String,
    },
    /// The parameters are not those of the network in the header.
    #[error("there are {found} parameters, but a network of these sizes has {wanted}")]
    Parameters {
        /// How many there are.
        found: usize,
        /// How many there should be.
        wanted: usize,
    },
    /// A parameter is no number.
    #[error("parameter {index} is not finite")]
    NotFinite {
        /// Which.
        index: usize,
    },
}

impl Header {
    /// Checks that this program can do a network of these sizes.
    ///
    /// # Errors
    /// [`ReadWeightsError`], the first size that it cannot do.
    pub fn check(&self) -> Result<(), ReadWeightsError> {
        check_sizes(self)
    }
}

impl Weights {
    /// The weights that every build carries.
    pub fn shipped() -> Self {
        Self::from_bytes(SHIPPED).expect("the tests read the same bytes")
    }

    /// The sum that a file of these weights has, which tells one from another.
    pub fn sum(&self) -> u64 {
        let [header, parameters] = self.encoded();
        fnv(header.iter().chain(&parameters))
    }

    /// The sum of the weights that every build carries.
    pub fn shipped_sum() -> u64 {
        u64::from_le_bytes(SHIPPED[SUM_AT..FRONT].try_into().expect("eight bytes"))
    }

    /// Header and parameters as files have them.
    fn encoded(&self) -> [Vec<u8>; 2] {
        let header = serde_json::to_vec(&self.header).expect("a header is plain numbers and text");
        let halves = self.parameters.iter().map(|&x| f16::from_f32(x));
        [header, halves.flat_map(f16::to_le_bytes).collect()]
    }

    /// The bytes of a weights file, parameters in half precision.
    pub fn to_bytes(&self) -> Vec<u8> {
        let [header, parameters] = self.encoded();
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((header.len() as u32).to_le_bytes());
        bytes.extend((parameters.len() as u64).to_le_bytes());
        bytes.extend(fnv(header.iter().chain(&parameters)).to_le_bytes());
        bytes.extend(header);
        bytes.extend(parameters);
        bytes
    }

    /// Reads a weights file.
    ///
    /// # Errors
    /// [`ReadWeightsError`]: the bytes are something else, damaged, or of another network.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ReadWeightsError> {
        let (header, parameters) = parts(bytes)?;
        let header: Header = serde_json::from_slice(header).map_err(|error| {
            let reason = error.to_string();
            ReadWeightsError::Header { reason }
        })?;
        check_sizes(&header)?;
        let [found, wanted] = [
            parameters.len() / 2,
            header.sizes.n_parameters().unwrap_or(usize::MAX),
        ];
        if found != wanted || parameters.len() % 2 != 0 {
            return Err(ReadWeightsError::Parameters { found, wanted });
        }
        let halves = parameters.chunks_exact(2);
        let parameters: Vec<f32> = halves
            .map(|half| f16::from_le_bytes([half[0], half[1]]).to_f32())
            .collect();
        match parameters.iter().position(|x| !x.is_finite()) {
            Some(index) => Err(ReadWeightsError::NotFinite { index }),
            None => Ok(Self { header, parameters }),
        }
    }

    /// The network.
    ///
    /// # Errors
    /// [`ReadWeightsError::Parameters`] when the parameters are not as many as the header says.
    pub fn network(&self) -> Result<Network, ReadWeightsError> {
        let sizes = &self.header.sizes;
        Network::new(sizes, &self.parameters).ok_or(ReadWeightsError::Parameters {
            found: self.parameters.len(),
            wanted: sizes.n_parameters().unwrap_or(usize::MAX),
        })
    }
}

/// Header and parameters, after every check that needs no network.
fn parts(bytes: &[u8]) -> Result<(&[u8], &[u8]), ReadWeightsError> {
    let found = bytes.len() as u64;
    if bytes.get(..8) != Some(MAGIC) {
        return Err(ReadWeightsError::NotWeights);
    }
    let too_short = ReadWeightsError::Length {
        found,
        wanted: FRONT as u64,
    };
    let front = bytes.get(..FRONT).ok_or(too_short)?;
    let number = |at: usize, n: usize| {
        let digits = front[at..at + n].iter().rev();
        digits.fold(0u64, |sum, &byte| sum << 8 | u64::from(byte))
    };
    let version = number(8, 4) as u32;
    if version != VERSION {
        return Err(ReadWeightsError::Version { found: version });
    }
    let [n_header, n_parameters] = [number(12, 4), number(16, 8)];
    let wanted = (FRONT as u64)
        .saturating_add(n_header)
        .saturating_add(n_parameters);
    if found != wanted {
        return Err(ReadWeightsError::Length { found, wanted });
    }
    let (header, parameters) = bytes[FRONT..].split_at(n_header as usize);
    let found = fnv(header.iter().chain(parameters));
    let wanted = number(SUM_AT, 8);
    if found != wanted {
        return Err(ReadWeightsError::Damaged { found, wanted });
    }
    Ok((header, parameters))
}

fn check_sizes(header: &Header) -> Result<(), ReadWeightsError> {
    let Sizes {
        width,
        levels,
        blocks,
        relaxations,
    } = &header.sizes;
    let most = |list: &[usize]| list.iter().copied().max().unwrap_or(0);
    let least = levels.iter().copied().min().unwrap_or(0);
    let checks = [
        ("features", header.n_features, N_FEATURES..=N_FEATURES),
        ("width", *width, 1..=MAX_WIDTH),
        ("levels", levels.len(), 1..=MAX_LEVELS),
        (
            "levels with blocks",
            blocks.len(),
            levels.len()..=levels.len(),
        ),
        ("blocks of a level", most(blocks), 0..=MAX_BLOCKS),
        ("relaxations", *relaxations, 0..=MAX_RELAXATIONS),
        ("vertices of the coarsest level", least, 4..=MAX_VERTICES),
        (
            "vertices of the finest level",
            most(levels),
            4..=MAX_VERTICES,
        ),
    ];
    for (what, found, range) in checks {
        if !range.contains(&found) {
            let can = format!("{} to {}", range.start(), range.end());
            return Err(ReadWeightsError::Sizes { what, found, can });
        }
    }
    if levels.is_sorted_by(|finer, coarser| finer > coarser) {
        return Ok(());
    }
    let reason = format!("the levels {levels:?} do not fall");
    Err(ReadWeightsError::Header { reason })
}

/// FNV-1a, 64 bits.
pub fn fnv<'a>(bytes: impl IntoIterator<Item = &'a u8>) -> u64 {
    let bytes = bytes.into_iter();
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
