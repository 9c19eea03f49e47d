//! Long computations that cannot look up themselves.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use crate::progress::{Cancelled, Progress};

/// Between two looks at the progress.
const PAUSE: Duration = Duration::from_millis(10);

/// Computes on another thread while this one watches for a cancellation. A cancelled computation
/// is left to end by itself, unheard: sorting and factorising have no place to stop in the middle.
pub fn watched<T: Send + 'static>(
    compute: impl FnOnce() -> T + Send + 'static,
    progress: &Progress,
) -> Result<T, Cancelled> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        // Nobody listens any more once it is cancelled.
        let _ = sender.send(compute());
    });
    loop {
        match receiver.recv_timeout(PAUSE) {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => progress.check()?,
            Err(RecvTimeoutError::Disconnected) => panic!("the computation panicked"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::progress::CancelToken;

    #[test]
    fn a_result_comes_back_and_a_cancelled_one_is_not_waited_for() {
        assert_eq!(watched(|| 3, &Progress::none()), Ok(3));
        let token = CancelToken::new();
        token.cancel();
        let start = Instant::now();
        let sleep = || thread::sleep(Duration::from_secs(20));
        assert_eq!(watched(sleep, &Progress::silent(token)), Err(Cancelled));
        assert!(start.elapsed() < Duration::from_secs(10));
    }
}
