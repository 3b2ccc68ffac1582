//! `busclimate`: what thermal comfort in an electric city bus costs over a whole year.
//!
//! This package only wires the rooms together: `args` is what was typed, `study` what it means, `stages` the work in
//! its order. Results go to stdout, progress and log lines to stderr; the exit status is that of [`failure`].

mod args;
mod console;
mod failure;
mod prepare;
mod stages;
mod study;

use anyhow::anyhow;
use clap::Parser;
use std::path::Path;
use std::process::ExitCode;

use args::{Args, Command, StudyArgs};
use console::Console;
use failure::{Ending, Failure};
use stages::Stage;
use study::Study;

/// Missions come and go as blocks of megabytes: the system's allocator gives them back to the kernel each time, which
/// costs a third of the reading.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// The study file of a folder.
const STUDY_FILE: &str = "study.toml";

fn main() -> ExitCode {
    let args = Args::parse();
    let console = Console::new(args.log, args.quiet);
    match dispatch(&args, &console) {
        Ok(ending) => ending.code(),
        Err(failure) => {
            console.failed(&failure);
            failure.code()
        }
    }
}

fn dispatch(args: &Args, console: &Console) -> Result<Ending, Failure> {
    if let Some(threads) = args.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build_global()
            .map_err(|e| Failure::Usage(anyhow!("--threads {threads}: {e}")))?;
    }
    let stop = console::stop_on_signal()?;
    match &args.command {
        Command::Demo(demo) => {
            prepare::demo(demo, console)?;
            Ok(Ending::Done)
        }
        Command::Init { dir } => {
            prepare::init(dir)?;
            Ok(Ending::Done)
        }
        Command::Canyon(args) => {
            prepare::canyon(&open(&args.study)?, args)?;
            Ok(Ending::Done)
        }
        Command::Check(study) => stages::check(&open(study)?),
        Command::Ingest(study) => stages::run(&open(study)?, &[Stage::Ingest], console, stop),
        Command::Shade(study) => stages::run(&open(study)?, &[Stage::Shade], console, stop),
        Command::Solve(args) => stages::run(&open(&args.study)?.solved_by(args.method), &[Stage::Solve], console, stop),
        Command::Simulate(study) => stages::run(&open(study)?, &[Stage::Simulate], console, stop),
        Command::Report(study) => stages::run(&open(study)?, &[Stage::Report], console, stop),
        Command::Run(args) => {
            let study = if args.study.study.is_none() && !Path::new(STUDY_FILE).exists() {
                StudyArgs { study: Some(prepare::demo_study(console)?), db: args.study.db.clone() }
            } else {
                args.study.clone()
            };
            stages::run(&open(&study)?.solved_by(args.method), &Stage::ALL, console, stop)
        }
        Command::Verify { study, part } => stages::verify(open(study)?, part, console, stop),
        Command::Status { study, json } => stages::status(&open(study)?, *json),
        Command::Show { study, point } => stages::show(&open(study)?, point),
    }
}

fn open(args: &StudyArgs) -> Result<Study, Failure> {
    let path = args.study.as_deref().unwrap_or_else(|| Path::new(STUDY_FILE));
    // A folder stands for the study file in it.
    let path = if path.is_dir() { path.join(STUDY_FILE) } else { path.to_owned() };
    Ok(Study::open(&path, args.db.as_deref())?)
}
