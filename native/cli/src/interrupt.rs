//! Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use orbflow_geometry::progress::CancelToken;

/// The exit code after Ctrl-C: 128 and the number of the signal.
pub const CANCELLED: u8 = 130;

/// What Ctrl-C does: ends the program at once while it reads, which may block for ever on a pipe;
/// stops the job once one is running.
pub struct Interrupt {
    token: CancelToken,
    is_working: Arc<AtomicBool>,
}

impl Interrupt {
    /// Starts to watch.
    pub fn watch() -> Result<Self, ctrlc::Error> {
        let interrupt = Self {
            token: CancelToken::new(),
            is_working: Arc::default(),
        };
        let (token, is_working) = (interrupt.token.clone(), interrupt.is_working.clone());
        ctrlc::set_handler(move || {
            if !is_working.load(Ordering::SeqCst) {
                std::process::exit(i32::from(CANCELLED));
            }
            token.cancel();
        })?;
        Ok(interrupt)
    }

    /// From here on the job is stopped and cleans up, instead of the program; everything that is
    /// read must have been.
    pub fn start_work(&self) -> &CancelToken {
        self.is_working.store(true, Ordering::SeqCst);
        &self.token
    }
}
