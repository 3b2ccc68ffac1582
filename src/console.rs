//! stderr: log lines and progress bars; stdout: results.

use anyhow::{Context, anyhow};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pipeline::{Done, Progress, StageEnd, Work};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;
use std::fmt;
use std::io::{ErrorKind, IsTerminal, Write, stderr, stdout};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use tracing_subscriber::filter::LevelFilter;

use crate::args::{Args, Log};
use crate::failure::Failure;

static STOP: OnceLock<Arc<AtomicBool>> = OnceLock::new();
static STYLE: OnceLock<ProgressStyle> = OnceLock::new();

/// Turns signals that ask to end into a flag that the stages ask for between their steps. One that the caller has the program
/// ignore stays ignored, such as SIGHUP under nohup.
pub fn stop_on_signal() -> Result<(), Failure> {
    let stop = STOP.get_or_init(Arc::default);
    for signal in [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal)) {
        flag::register(signal, Arc::clone(stop))
            .map_err(|e| Failure::Usage(anyhow!("cannot listen to signals: {e}")))?;
    }
    Ok(())
}

/// Whether a signal was ignored when the program started, where the system tells.
fn is_ignored(signal: i32) -> bool {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return false };
    let mask = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.is_some_and(|mask| mask & (1 << (signal - 1)) != 0)
}

/// stderr for log lines: a sink that is full or closed loses lines, and ends no run.
struct LogSink;

impl Write for LogSink {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        Ok(stderr().write(bytes).unwrap_or(bytes.len()))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        let _ = stderr().flush();
        Ok(())
    }
}

/// What goes to stderr.
pub struct Console {
    log: Log,
    bars: bool,
    bar: Mutex<ProgressBar>,
}

impl Console {
    pub fn new(&Args { log, quiet, verbose, .. }: &Args) -> Self {
        let level = match (quiet, verbose) {
            (true, _) => LevelFilter::WARN,
            (_, true) => LevelFilter::DEBUG,
            _ => LevelFilter::INFO,
        };
        let lines = tracing_subscriber::fmt().with_writer(|| LogSink).with_max_level(level).with_target(false);
        match log {
            Log::Text => lines.without_time().with_ansi(stderr().is_terminal()).init(),
            Log::Json => lines.json().flatten_event(true).init(),
        }
        let bars = !quiet && log == Log::Text && stderr().is_terminal();
        Self { log, bars, bar: Mutex::new(ProgressBar::hidden()) }
    }

    pub fn failed(&self, failure: &Failure) {
        tracing::error!("{failure}");
    }

    /// A run that came to its end, for machines; people read it on stdout.
    pub fn run_ended(&self, done: &Done, duration_s: f64) {
        if self.log == Log::Json {
            let (counts, pending) = (done.summary.counts, done.summary.pending());
            let (points, solved, failed) = (counts.points, counts.solved, counts.failed);
            let refused = done.summary.refused.len();
            tracing::info!(run_id = done.run_id, points, solved, failed, pending, refused, duration_s, "run ended");
        }
    }

    fn with_bar(&self, work: impl FnOnce(&mut ProgressBar)) {
        // A bar that another thread left in the middle of a step is still a bar.
        work(&mut self.bar.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

impl Progress for Console {
    /// A bar on a terminal, nothing elsewhere.
    fn begin(&self, label: &'static str, steps: u64) {
        let target = if self.bars { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let style = STYLE.get_or_init(|| {
            let template = "{msg:>16} [{bar:40}] {human_pos}/{human_len} {eta} left";
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
        });
        let new = ProgressBar::with_draw_target(Some(steps), target).with_style(style.clone()).with_message(label);
        self.with_bar(|bar| {
            bar.finish_and_clear();
            *bar = new;
        });
    }

    fn advance(&self, steps: u64) {
        self.with_bar(|bar| bar.inc(steps));
    }

    fn end(&self) {
        self.with_bar(|bar| bar.finish_and_clear());
    }

    fn info(&self, message: &str) {
        tracing::info!("{message}");
    }

    fn stage_ended(&self, end: &StageEnd) {
        let Work { computed, withdrawn, total, message } = &end.work;
        match self.log {
            Log::Text => {
                tracing::info!("{message}");
                tracing::debug!("{} took {:.2} s", end.stage.name(), end.duration_s);
            }
            Log::Json => {
                let (run_id, stage, duration_s) = (end.run_id, end.stage.name(), end.duration_s);
                tracing::info!(run_id, stage, computed, withdrawn, total, duration_s, "{message}");
            }
        }
    }

    fn warn(&self, message: &str) {
        tracing::warn!("{message}");
    }

    fn stop(&self) -> bool {
        STOP.get().is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

/// A line of result on stdout. Where the reader has heard enough and is gone, the rest is nobody's.
pub fn say(line: fmt::Arguments) -> Result<(), Failure> {
    match writeln!(stdout(), "{line}") {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.context("cannot write to stdout").map_err(Failure::Inputs),
    }
}
