//! How a network is trained.

use orbflow_network::features::N_FEATURES;
use orbflow_network::net::Sizes;
use orbflow_network::weights::{Header, ReadWeightsError};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// How a network is trained. What a file of settings leaves out has its default.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// The network: `[sizes]` with width, levels and blocks.
    pub sizes: Sizes,
    /// How many steps the whole run has; the rate follows from it.
    pub n_steps: usize,
    /// How many shapes a step sees.
    pub batch: usize,
    /// The highest learning rate.
    pub rate: f64,
    /// Where random choices start.
    pub seed: u64,
    /// Steps between checkpoints, at which the held-out shapes are measured too.
    pub interval: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            sizes: Sizes::default(),
            n_steps: 20_000,
            batch: 6,
            rate: 2e-3,
            seed: 0,
            interval: 500,
        }
    }
}

/// Why settings cannot be used.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum SettingsError {
    /// The text is no such file.
    #[error("{0}")]
    Toml(#[from] toml::de::Error),
    /// A number is out of its range.
    #[error("{name} = {found}; it must be {wanted}")]
    Range {
        /// Which.
        name: &'static str,
        /// What it is.
        found: String,
        /// What it may be.
        wanted: &'static str,
    },
    /// No weights file could hold the network.
    #[error("sizes: {0}")]
    Sizes(#[from] ReadWeightsError),
}

impl Settings {
    /// Reads settings as TOML.
    ///
    /// # Errors
    /// [`SettingsError`], with the line of the text.
    pub fn from_toml(text: &str) -> Result<Self, SettingsError> {
        let settings: Self = toml::from_str(text)?;
        settings.check()?;
        Ok(settings)
    }

    fn check(&self) -> Result<(), SettingsError> {
        let Self {
            n_steps,
            batch,
            rate,
            interval,
            ..
        } = self;
        for (name, found) in [
            ("n_steps", n_steps),
            ("batch", batch),
            ("interval", interval),
        ] {
            check_count(name, *found)?;
        }
        // More than 1 is what burn refuses; it would also diverge.
        if !(*rate > 0.0 && *rate <= 1.0) {
            return Err(SettingsError::Range {
                name: "rate",
                found: rate.to_string(),
                wanted: "above 0 and at most 1",
            });
        }
        let header = Header {
            sizes: self.sizes.clone(),
            n_features: N_FEATURES,
            provenance: String::new(),
        };
        Ok(header.check()?)
    }
}

/// Checks that there is one at least.
pub(crate) fn check_count(name: &'static str, found: usize) -> Result<(), SettingsError> {
    if found > 0 {
        return Ok(());
    }
    Err(SettingsError::Range {
        name,
        found: found.to_string(),
        wanted: "1 or more",
    })
}
