//! `busclimate`: what thermal comfort in an electric city bus costs over a whole year.
//!
//! This package is the command line and nothing else: `args` is what was typed, `pipeline` does the work, `print` says what came
//! of it. Results go to stdout, progress and log lines to stderr; the exit status is that of [`failure`].

mod args;
mod compare;
mod console;
mod failure;
mod offer;
mod prepare;
mod print;

use anyhow::anyhow;
use clap::Parser;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use args::{Args, Command, Log, StudyArgs};
use console::{Console, say};
use failure::{Ending, Failure};
use pipeline::{Export, Format, Loading, Options, Part, Patience, Point, Stage, Wanted};
use study::Study;

/// Missions come and go as blocks of megabytes: the system's allocator gives them back to the kernel each time, which
/// costs a third of the reading.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// The study file of a folder.
const STUDY_FILE: &str = "study.toml";

fn main() -> ExitCode {
    let args = Args::parse();
    let console = Console::new(&args);
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
            .num_threads(threads.into())
            .build_global()
            .map_err(|e| Failure::Usage(anyhow!("--threads {threads}: {e}")))?;
    }
    if args.command.can_stop() {
        console::stop_on_signal()?;
    }
    let wait = Duration::from_secs(args.wait);
    let metrics = args.metrics.clone();
    let options =
        &Options { rehash: args.rehash, forget_missing: args.forget_missing, wait, metrics, ..Options::default() };
    match &args.command {
        Command::Demo(demo) => {
            prepare::demo(demo, console)?;
            Ok(Ending::Done)
        }
        Command::Init { dir } => {
            prepare::init(dir)?;
            Ok(Ending::Done)
        }
        Command::Fetch(typed) => {
            let wanted = match typed.only {
                None => Wanted::All,
                Some(args::Inputs::Missions) => Wanted::Missions,
                Some(args::Inputs::Weather) => Wanted::Weather,
            };
            let patience = Patience { timeout: Duration::from_secs(typed.timeout), ..Patience::default() };
            print::fetched(&pipeline::fetch(&open(&typed.study)?, wanted, patience, typed.offline, console)?)
        }
        Command::Canyon(canyon) => {
            let study = open(&canyon.study)?;
            let (azimuths_deg, heights) = (&canyon.street_azimuths_deg, &canyon.heights_to_width);
            let (path, kinds) = pipeline::write_canyon(&study, azimuths_deg, heights, canyon.streets.into())?;
            say(format_args!("{} is written: the shade of {kinds} kinds of street canyons", path.display()))?;
            Ok(Ending::Done)
        }
        Command::Check(study) => {
            let study = open(study)?;
            print::check(&study, &pipeline::check(&study, console)?)
        }
        Command::Ingest(study) => run(&open(study)?, &[Stage::Ingest], options, console),
        Command::Shade(study) => run(&open(study)?, &[Stage::Shade], options, console),
        Command::Solve { solve, shard, to } => {
            let study = open(&solve.study)?.solved_by(solve.method.into());
            match shard.zip(to.as_ref()) {
                None => run(&study, &[Stage::Solve], options, console),
                Some((shard, folder)) => {
                    let work = pipeline::solve_shard(&study, shard, folder, console)?;
                    say(format_args!(
                        "{} samples in {} files of {}, {} of them written now",
                        work.samples,
                        work.files,
                        folder.display(),
                        work.written
                    ))?;
                    Ok(Ending::Done)
                }
            }
        }
        Command::Merge { study, dir, db } => {
            let study = open(&StudyArgs { study: Some(study.clone()), db: db.clone() })?;
            let options = Options { shards: Some(dir.clone()), ..options.clone() };
            run(&study, &[Stage::Solve], &options, console)
        }
        Command::Simulate(study) => run(&open(study)?, &[Stage::Simulate], options, console),
        Command::Control(control) => {
            let study = open(&control.study)?;
            let ending = run(&study, &[Stage::Control], options, console)?;
            let (found, folder) = (pipeline::setpoints(&study)?, study.base.join(&control.to));
            pipeline::write_setpoints(&study, &found, &folder)?;
            print::setpoints(&folder, &found)?;
            Ok(ending)
        }
        Command::Sensitivity(study) => {
            let study = open(study)?;
            let ending = run(&study, &[Stage::Sensitivity, Stage::Report], options, console)?;
            print::sensitivities(&pipeline::sensitivities(&study)?)?;
            Ok(ending)
        }
        Command::Climates { study, files, to, db } => {
            let study = open(&StudyArgs { study: Some(study.clone()), db: db.clone() })?;
            let climates = pipeline::climates(&study, files)?;
            if let Some(folder) = to {
                pipeline::write_climates(&climates, folder)?;
            }
            print::climates(&climates, to.as_deref())
        }
        Command::Report { study, check: None } => run(&open(study)?, &[Stage::Report], options, console),
        Command::Report { study, check: Some(folder) } => {
            print::report_check(folder, &pipeline::check_report(&open(study)?, folder)?)
        }
        Command::Run { solve: typed, dry_run: true } => {
            let study = open(&typed.study)?.solved_by(typed.method.into());
            print::plan(&pipeline::plan(&study, args.rehash)?)?;
            Ok(Ending::Done)
        }
        Command::Run { solve: typed, dry_run: false } => {
            let no_study = typed.study.study.is_none() && !Path::new(STUDY_FILE).exists();
            let study = if no_study {
                if args.quiet || args.log == Log::Json {
                    // Nobody is there to be shown a demo: a job in the wrong folder must not end well.
                    return Err(Failure::Usage(anyhow!("there is no {STUDY_FILE} here; name a study file")));
                }
                StudyArgs { study: Some(prepare::demo_study(console)?), db: typed.study.db.clone() }
            } else {
                typed.study.clone()
            };
            let ending = run(&open(&study)?.solved_by(typed.method.into()), &Stage::ALL, options, console)?;
            if no_study {
                say(format_args!("there is no {STUDY_FILE} here: these are made-up data of a demo"))?;
            }
            Ok(ending)
        }
        Command::Verify { study, part } => {
            let study = open(study)?;
            let name = study.name.clone();
            let part = Part { fraction: part.fraction, seed: part.seed };
            print::verification(&name, &pipeline::verify(study, part, wait, console)?)
        }
        Command::Backup { study, file, db } => {
            let study = StudyArgs { study: Some(study.clone()), db: db.clone() };
            pipeline::backup(&open(&study)?, file)?;
            say(format_args!("{} is written", file.display()))?;
            Ok(Ending::Done)
        }
        Command::Compare(typed) => compare::compare(typed),
        Command::Export(typed) => {
            let study = open(&typed.study)?;
            let wanted = match typed.format {
                args::ExportFormat::Parquet => Export::Tables(Format::Parquet),
                args::ExportFormat::Csv => Export::Tables(Format::Csv),
                args::ExportFormat::Lut => Export::LookUpTables(Loading { capacity: typed.capacity }),
            };
            pipeline::export(&study, wanted, &typed.to, console)?;
            say(format_args!("{} is written; {} says what is in it", typed.to.display(), "datapackage.json"))?;
            Ok(Ending::Done)
        }
        Command::Dictionary { study, format } => offer::dictionary(study, *format),
        Command::Schema => offer::schema(),
        Command::Completions { shell } => offer::completions(*shell),
        Command::Man { dir } => offer::man(dir),
        Command::Status { study, why, json } => {
            let study = open(study)?;
            let status = pipeline::status(&study)?;
            let plan = if *why { Some(pipeline::plan(&study, args.rehash)?) } else { None };
            print::status(&status, plan.as_deref(), *json)
        }
        Command::Show { study, point, json } => {
            let wanted = Point { sample: point.sample, design: point.design.clone(), pmv_limit: point.pmv_limit };
            print::shown(&wanted, &pipeline::show(&open(study)?, &wanted)?, point.figure.as_deref(), *json)
        }
    }
}

/// Runs stages and says what came of it.
fn run(study: &Study, stages: &[Stage], options: &Options, console: &Console) -> Result<Ending, Failure> {
    let begin = Instant::now();
    tracing::debug!(
        "study {:?}, hash {}, database {}, {} threads, busclimate {}",
        study.name,
        study.hash,
        study.database.display(),
        rayon::current_num_threads(),
        pipeline::PROGRAM_VERSION
    );
    let done = pipeline::run(study, stages, options, console)?;
    console.run_ended(&done, begin.elapsed().as_secs_f64());
    print::run(study, stages, &done, begin.elapsed())
}

fn open(args: &StudyArgs) -> Result<Study, Failure> {
    let path = args.study.as_deref().unwrap_or_else(|| Path::new(STUDY_FILE));
    // A folder stands for the study file in it.
    let path = if path.is_dir() { path.join(STUDY_FILE) } else { path.to_owned() };
    Ok(Study::open(&path, args.db.as_deref())?)
}
