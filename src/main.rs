//! `busclimate`: what thermal comfort in an electric city bus costs over a whole year.
//!
//! This package only wires the rooms together: `args` is what was typed, `study` what it means, `stages` the work in
//! its order. Results go to stdout, progress and log lines to stderr; the exit status is that of [`failure`].

mod args;
mod console;
mod failure;
mod stages;
mod study;

use anyhow::{Context, anyhow};
use clap::Parser;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use args::{Args, Command, DemoArgs, StudyArgs};
use console::{Console, say};
use failure::{Ending, Failure};
use stages::Stage;
use study::Study;
use study::template::{self, Template};

/// Missions come and go as blocks of megabytes: the system's allocator gives them back to the kernel each time, which
/// costs a third of the reading.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Where a run without a study file makes its demo.
const DEMO_FOLDER: &str = "busclimate-demo";
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
            write_demo(demo, console)?;
            Ok(Ending::Done)
        }
        Command::Init { dir } => {
            init(dir)?;
            Ok(Ending::Done)
        }
        Command::Check(study) => stages::check(&open(study)?),
        Command::Ingest(study) => stages::run(&open(study)?, &[Stage::Ingest], console, stop),
        Command::Shade(study) => stages::run(&open(study)?, &[Stage::Shade], console, stop),
        Command::Solve(args) => stages::run(&open(&args.study)?.solved_by(args.method), &[Stage::Solve], console, stop),
        Command::Report(study) => stages::run(&open(study)?, &[Stage::Report], console, stop),
        Command::Run(args) => {
            let study = if args.study.study.is_none() && !Path::new(STUDY_FILE).exists() {
                StudyArgs { study: Some(demo_study(console)?), db: args.study.db.clone() }
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

fn init(dir: &Path) -> Result<(), Failure> {
    let name = dir.file_name().map_or_else(|| "study".to_owned(), |n| n.to_string_lossy().into_owned());
    let text = template::render(&Template { name: &name, note: None, buses: &[] });
    let path = dir.join(STUDY_FILE);
    if path.exists() {
        return Err(Failure::Usage(anyhow!("{} is there already; it is left as it is", path.display())));
    }
    std::fs::create_dir_all(dir)
        .and_then(|()| std::fs::write(&path, text))
        .with_context(|| format!("cannot write {}; check permissions and free space", path.display()))
        .map_err(Failure::Usage)?;
    say(format_args!("{} is written; put the missions, the weather and shadow.csv where it says", path.display()))
}

/// The demo of a run without a study file, made once.
fn demo_study(console: &Console) -> Result<PathBuf, Failure> {
    let dir = PathBuf::from(DEMO_FOLDER);
    let study = dir.join(STUDY_FILE);
    if !study.exists() {
        console.info(&format!("no study file here: making the demo in ./{DEMO_FOLDER}"));
        write_demo(&DemoArgs { dir, missions: 48, seed: 1, like: None, buses: Vec::new() }, console)?;
    }
    Ok(study)
}

fn write_demo(args: &DemoArgs, console: &Console) -> Result<(), Failure> {
    let plans = match &args.like {
        None => demo::default_plan(args.missions, args.seed).map_err(|e| Failure::Usage(e.into()))?,
        Some(path) => {
            let file = std::fs::File::open(path)
                .with_context(|| format!("cannot read {}; give the metaData.csv of ZTBus", path.display()))
                .map_err(Failure::Inputs)?;
            let plans =
                demo::read_meta_data(file).with_context(|| path.display().to_string()).map_err(Failure::Inputs)?;
            let wanted = if args.buses.is_empty() { &[183][..] } else { &args.buses };
            plans.into_iter().filter(|p| wanted.contains(&p.bus)).collect()
        }
    };
    let mut buses: Vec<u32> = plans.iter().map(|p| p.bus).collect();
    buses.sort_unstable();
    buses.dedup();

    let bar = console.bar("demo missions", plans.len() as u64);
    let summary = demo::write(&args.dir, args.seed, &plans, &|done, _| bar.set_position(done))
        .map_err(|e| Failure::Inputs(e.into()))?;
    bar.finish_and_clear();
    let note = "Synthetic data, made by busclimate: it shows how the program works and says nothing about Zürich.";
    let study = template::render(&Template { name: "demo", note: Some(note), buses: &buses });
    // Written last: a study file that is there has all its data.
    let path = args.dir.join(STUDY_FILE);
    stages::write_beside(&path, study.as_bytes()).map_err(Failure::Inputs)?;
    say(format_args!(
        "{} missions, {} rows, {} MB of synthetic telemetry; study file {}",
        summary.missions,
        summary.rows,
        summary.bytes / 1_000_000,
        path.display()
    ))
}
