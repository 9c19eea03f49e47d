//! Progress and cancellation: every long loop reports here and stops here.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use thiserror::Error;

/// The user asked to stop; nothing was changed.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
#[error("cancelled")]
pub struct Cancelled;

/// A flag that another thread raises to stop a running job. Clones share the flag.
#[derive(Clone, Debug, Default)]
pub struct CancelToken(Arc<AtomicBool>);

impl CancelToken {
    /// A flag that is down.
    pub fn new() -> Self {
        Self::default()
    }

    /// Raises the flag; the job stops at its next check.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the flag is up.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Who listens: called with the name of the step and the share of the whole job done, in 0..=1.
pub type Listener<'a> = dyn Fn(&str, f64) + Sync + 'a;

/// A part of a job that reports its share of the whole and notices a cancellation.
///
/// A step splits its own part with [`Progress::part`]; the leaves call [`Progress::at`] in their
/// loops, at least every 50 ms of work so that a user who cancels waits for no more than that.
#[derive(Clone)]
pub struct Progress<'a> {
    token: CancelToken,
    listener: Option<&'a Listener<'a>>,
    name: &'a str,
    start: f64,
    span: f64,
}

impl<'a> Progress<'a> {
    /// Nobody listens and nobody cancels.
    pub fn none() -> Progress<'static> {
        Progress {
            token: CancelToken::new(),
            listener: None,
            name: "",
            start: 0.0,
            span: 1.0,
        }
    }

    /// A whole job, heard by `listener` and stopped by `token`.
    pub fn new(token: CancelToken, listener: &'a Listener<'a>) -> Self {
        Self {
            token,
            listener: Some(listener),
            name: "",
            start: 0.0,
            span: 1.0,
        }
    }

    /// A whole job that can be stopped but is not heard.
    pub fn silent(token: CancelToken) -> Progress<'static> {
        Progress {
            token,
            listener: None,
            name: "",
            start: 0.0,
            span: 1.0,
        }
    }

    /// The part of this job between the shares `from` and `to`, called `name`.
    /// An empty name keeps the name of this part.
    #[must_use]
    pub fn part(&self, name: &'a str, from: f64, to: f64) -> Self {
        Self {
            token: self.token.clone(),
            listener: self.listener,
            name: if name.is_empty() { self.name } else { name },
            start: self.start + from * self.span,
            span: (to - from) * self.span,
        }
    }

    /// Says that this share (0..=1) of the part is done.
    ///
    /// # Errors
    /// [`Cancelled`] when the token's flag is up.
    pub fn at(&self, share: f64) -> Result<(), Cancelled> {
        if let Some(listener) = self.listener {
            listener(self.name, self.start + share.clamp(0.0, 1.0) * self.span);
        }
        self.check()
    }

    /// Notices a cancellation without reporting.
    ///
    /// # Errors
    /// [`Cancelled`] when the token's flag is up.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.token.is_cancelled() {
            Err(Cancelled)
        } else {
            Ok(())
        }
    }

    /// The flag that stops this job.
    pub fn token(&self) -> &CancelToken {
        &self.token
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn parts_report_their_share_of_the_whole() {
        let heard = Mutex::new(Vec::new());
        let listener =
            |name: &str, share: f64| heard.lock().unwrap().push((name.to_owned(), share));
        let whole = Progress::new(CancelToken::new(), &listener);
        let second = whole.part("embed", 0.5, 1.0);
        second.part("", 0.0, 0.5).at(1.0).unwrap();
        assert_eq!(*heard.lock().unwrap(), [("embed".to_owned(), 0.75)]);
    }

    #[test]
    fn a_raised_flag_stops_every_part() {
        let token = CancelToken::new();
        let part = Progress::silent(token.clone()).part("decimate", 0.0, 0.1);
        assert_eq!(part.check(), Ok(()));
        token.cancel();
        assert_eq!(part.at(0.3), Err(Cancelled));
    }
}
