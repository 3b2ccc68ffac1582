//! stderr: log lines and progress bars; stdout: results.

use anyhow::{Context, anyhow};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::fmt;
use std::io::{IsTerminal, Write, stderr, stdout};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use tracing_subscriber::filter::LevelFilter;

use crate::args::Log;
use crate::failure::Failure;

static STOP: AtomicBool = AtomicBool::new(false);
static STYLE: OnceLock<ProgressStyle> = OnceLock::new();

/// Asks whether a signal has come.
pub type Stop = fn() -> bool;

/// Turns Ctrl-C and SIGTERM into a flag that the stages ask for between their steps.
pub fn stop_on_signal() -> Result<Stop, Failure> {
    ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed))
        .map_err(|e| Failure::Usage(anyhow!("cannot listen to signals: {e}")))?;
    Ok(|| STOP.load(Ordering::Relaxed))
}

/// What goes to stderr.
pub struct Console {
    bars: bool,
}

impl Console {
    pub fn new(log: Log, quiet: bool) -> Self {
        let level = if quiet { LevelFilter::WARN } else { LevelFilter::INFO };
        let lines = tracing_subscriber::fmt().with_writer(stderr).with_max_level(level).with_target(false);
        match log {
            Log::Text => lines.without_time().with_ansi(stderr().is_terminal()).init(),
            Log::Json => lines.json().flatten_event(true).init(),
        }
        Self { bars: !quiet && log == Log::Text && stderr().is_terminal() }
    }

    pub fn info(&self, message: &str) {
        tracing::info!("{message}");
    }

    pub fn warn(&self, message: &str) {
        tracing::warn!("{message}");
    }

    pub fn failed(&self, failure: &Failure) {
        tracing::error!("{failure}");
    }

    /// A bar on a terminal, nothing elsewhere.
    pub fn bar(&self, label: &'static str, length: u64) -> ProgressBar {
        let target = if self.bars { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let style = STYLE.get_or_init(|| {
            let template = "{msg:>16} [{bar:40}] {human_pos}/{human_len} {eta} left";
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
        });
        ProgressBar::with_draw_target(Some(length), target).with_style(style.clone()).with_message(label)
    }
}

/// A line of result on stdout.
pub fn say(line: fmt::Arguments) -> Result<(), Failure> {
    writeln!(stdout(), "{line}").context("cannot write to stdout").map_err(Failure::Inputs)
}
