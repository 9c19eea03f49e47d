//! Runs the core on a thread of its own, without the interpreter's lock.

use std::any::Any;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ScopedJoinHandle};
use std::time::Duration;

use glam::DVec3;
use orbflow_geometry::progress::{self, Progress};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors::{self, VerbError};

/// How long the calling thread sleeps between looking at progress, signals and the end. Below
/// 20 ms the calls cost time; above 100 ms a bar jerks and Ctrl-C feels dead.
const TICK: Duration = Duration::from_millis(50);

/// The pipeline's recursions are shallow, but a thread's default 2 MB is not much on a big mesh.
const STACK_BYTES: usize = 16 << 20;

/// A flag that another thread raises to stop a running job.
#[pyclass(frozen, module = "orbflow_native")]
#[derive(Default)]
pub struct CancelToken(progress::CancelToken);

#[pymethods]
impl CancelToken {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Raises the flag; the job stops within a fraction of a second and raises `Cancelled`.
    fn cancel(&self) {
        self.0.cancel();
    }

    /// Whether the flag is up.
    #[getter]
    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

/// Who hears a job and who may stop it, as they came from Python.
pub struct Job<'py> {
    listener: Option<Bound<'py, PyAny>>,
    token: progress::CancelToken,
    scale: DVec3,
}

impl<'py> Job<'py> {
    /// A job heard by `listener(name, share)` and stopped by `token`.
    pub fn new(listener: Option<Bound<'py, PyAny>>, token: Option<&CancelToken>) -> Self {
        Self {
            listener,
            token: token.map(|token| token.0.clone()).unwrap_or_default(),
            scale: DVec3::ONE,
        }
    }

    /// The same on a mesh whose positions were multiplied by `scale`.
    pub fn scaled(self, scale: DVec3) -> Self {
        Self { scale, ..self }
    }

    /// Does `work` on a thread of its own while this thread reports progress and hears Ctrl-C.
    ///
    /// # Errors
    /// What `work` returns; what the listener raises; `KeyboardInterrupt`; `RuntimeError` when the
    /// core panics, so that a defect of ours never takes the interpreter down.
    pub fn run<T: Send, E: VerbError>(
        &self,
        py: Python<'py>,
        work: impl FnOnce(&Progress) -> Result<T, E> + Send,
    ) -> PyResult<T> {
        let state = &State::default();
        let hear = &|name: &str, share: f64| state.lock().hear(name, share);
        let token = self.token.clone();
        thread::scope(|scope| {
            let body = move || {
                let _ended = Ended(state);
                work(&Progress::new(token, hear))
            };
            let handle = thread::Builder::new()
                .name("orbflow".to_owned())
                .stack_size(STACK_BYTES)
                .spawn_scoped(scope, body)?;
            let heard = self.attend(py, state);
            if heard.is_err() {
                self.token.cancel();
            }
            let done = py.detach(|| join(handle));
            heard?;
            match done {
                Ok(result) => result.map_err(|error| errors::exception(py, &error, self.scale)),
                Err(text) => Err(PyRuntimeError::new_err(text)),
            }
        })
    }

    fn attend(&self, py: Python<'py>, state: &State) -> PyResult<()> {
        let mut told = -1.0;
        loop {
            let Report { name, share, ended } = py.detach(|| state.wait());
            py.check_signals()?;
            if let Some(listener) = self.listener.as_ref().filter(|_| share > told) {
                told = share;
                listener.call1((name, share))?;
            }
            if ended {
                return Ok(());
            }
        }
    }
}

fn join<T>(handle: ScopedJoinHandle<'_, T>) -> Result<T, String> {
    let text = |cause: &(dyn Any + Send)| {
        let text = cause.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| cause.downcast_ref::<&str>().copied());
        format!(
            "internal error, please report it: {}",
            text.unwrap_or("unknown")
        )
    };
    handle.join().map_err(|cause| text(cause.as_ref()))
}

/// What the working thread tells the calling one.
#[derive(Default)]
struct State {
    report: Mutex<Report>,
    changed: Condvar,
}

#[derive(Clone, Default)]
struct Report {
    name: String,
    share: f64,
    ended: bool,
}

impl Report {
    fn hear(&mut self, name: &str, share: f64) {
        if self.name != name {
            name.clone_into(&mut self.name);
        }
        // Steps on several threads may report out of order; a bar never goes back.
        self.share = self.share.max(share);
    }
}

impl State {
    fn lock(&self) -> MutexGuard<'_, Report> {
        self.report.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits one tick, or less when the work ends, and gives the latest report.
    fn wait(&self) -> Report {
        let wait = self
            .changed
            .wait_timeout_while(self.lock(), TICK, |report| !report.ended);
        let (report, _) = wait.unwrap_or_else(PoisonError::into_inner);
        report.clone()
    }
}

/// Says that the work has ended, also when it panics.
struct Ended<'a>(&'a State);

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        self.0.lock().ended = true;
        self.0.changed.notify_all();
    }
}
