//! Progress on the terminal.

use std::sync::{Mutex, Once};

use indicatif::{ProgressBar, ProgressStyle};
use orbflow_geometry::progress::{CancelToken, Progress};

/// The bar moves in thousandths.
const STEPS: u64 = 1000;

/// Runs a job with a bar on standard error; without one when that is no terminal.
pub fn with_bar<T>(token: &CancelToken, job: impl FnOnce(&Progress) -> T) -> T {
    let bar = ProgressBar::new(STEPS);
    let style =
        ProgressStyle::with_template("{msg:10} {wide_bar} {percent:>3} % {elapsed:>4}, {eta} left");
    bar.set_style(style.expect("the template is well formed"));
    let shown = Mutex::new(String::new());
    let resumed = Once::new();
    let listener = |name: &str, share: f64| {
        bar.set_position((share * STEPS as f64) as u64);
        // What an earlier run did says nothing of how fast this one is.
        resumed.call_once(|| bar.reset_eta());
        // A new message costs an allocation, and the loops call often.
        if let Ok(mut shown) = shown.try_lock()
            && *shown != name
        {
            name.clone_into(&mut shown);
            bar.set_message(name.to_owned());
        }
    };
    let result = job(&Progress::new(token.clone(), &listener));
    bar.finish_and_clear();
    result
}
