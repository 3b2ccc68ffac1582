//! The command line as it was typed.

use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use pipeline::Shard;
use std::path::PathBuf;

/// More threads than any machine has cores only cost memory.
const MOST_THREADS: i64 = 1024;

/// What thermal comfort in an electric city bus costs over a whole year.
///
/// Exit status: 0 done; 1 finished, but points stayed unsolved, inputs were refused or expected data is missing; 2 usage or
/// study file wrong; 3 inputs or database unusable; 4 interrupted, run again to resume; 5 another run is at work on the
/// database; 6 the database is not complete: points are pending, or the last run was interrupted or failed.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 100)]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,

    /// How log lines on stderr look.
    #[arg(long, global = true, value_enum, default_value_t = Log::Text)]
    pub log: Log,

    /// Only warnings and errors on stderr.
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    pub quiet: bool,

    /// Also details on stderr.
    #[arg(long, short, global = true)]
    pub verbose: bool,

    /// Read every input again, also those that look as they did.
    #[arg(long, global = true)]
    pub rehash: bool,

    /// Let go what came from missions that are no longer where the study says; without it, it is kept, and said.
    #[arg(long, global = true)]
    pub forget_missing: bool,

    /// How long to wait for another run on the same database.
    #[arg(long, global = true, value_name = "SECONDS", default_value_t = 0)]
    pub wait: u64,

    /// Write what a run came to as metrics to this file (OpenMetrics; name it *.prom for the node exporter).
    #[arg(long, global = true, value_name = "FILE")]
    pub metrics: Option<PathBuf>,

    /// Threads that compute; as many as cores without it. Results do not depend on it.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    pub threads: Option<u16>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Log {
    Text,
    /// One JSON object a line.
    Json,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a synthetic data set in the real formats, and a study file for it.
    Demo(DemoArgs),
    /// Write a commented study file with every default of the paper.
    Init {
        /// Folder of the new study.
        dir: PathBuf,
    },
    /// Download the missions and the weather that the section `fetch` of a study names; what was cut goes on from there.
    Fetch(FetchArgs),
    /// Write the shadow file that a study names, computed for street canyons at its location.
    Canyon(CanyonArgs),
    /// Validate study and inputs without running; estimate points, time and size.
    Check(StudyArgs),
    /// Read missions and weather files.
    Ingest(StudyArgs),
    /// Join segments with weather, sun and shade to hourly samples.
    Shade(StudyArgs),
    /// Find the optimal operation of every sample, design and comfort window that has none yet.
    Solve {
        #[command(flatten)]
        solve: SolveArgs,
        /// Solve a share of the samples only, the I-th of N from 1, into files of the folder that --to names; the database is only
        /// read. `merge` takes them up.
        #[arg(long, value_name = "I/N", value_parser = shard, requires = "to")]
        shard: Option<Shard>,
        /// Folder of the files, which all shares may write to at once.
        #[arg(long, value_name = "DIR", requires = "shard")]
        to: Option<PathBuf>,
    },
    /// Take up what shares have solved (`solve --shard`), and solve what none of them has.
    Merge {
        /// Study file, or the folder of one.
        study: PathBuf,
        /// Folder of the shares' files.
        dir: PathBuf,
        /// Where the experiment database lies, instead of where the study file says.
        #[arg(long, value_name = "FILE")]
        db: Option<PathBuf>,
    },
    /// Simulate every mission second by second, beside what the steady-state optima foresee.
    Simulate(StudyArgs),
    /// Extract setpoints for a controller on board from the optima, drive every mission by them and by published ones, and write
    /// the setpoints as files.
    Control(ControlArgs),
    /// What the year depends on: each input of the section `sensitivity` at its low and its high value, and Sobol' indices of all
    /// together; stored, and shown in the report.
    Sensitivity(StudyArgs),
    /// The same bus and timetable under the weather of other files, such as typical years of other cities (EPW, PVGIS) or the
    /// reference year of the same place, beside its own. Exit status 1 where some hours have no weather there.
    Climates {
        /// Study file, or the folder of one.
        study: PathBuf,
        /// Weather files, each of a place of its own.
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Write climates.csv, all comfort windows, and climates.svg into this folder.
        #[arg(long, value_name = "DIR")]
        to: Option<PathBuf>,
        /// Where the experiment database lies, instead of where the study file says.
        #[arg(long, value_name = "FILE")]
        db: Option<PathBuf>,
    },
    /// Write the report: a page, and beside it every figure and table as files of their own.
    Report {
        #[command(flatten)]
        study: StudyArgs,
        /// Write nothing; say whether the report in this folder still follows from the database. Exit status 1 where it does not.
        #[arg(long, value_name = "DIR")]
        check: Option<PathBuf>,
    },
    /// All stages, only what is missing; without a study file it makes a demo and runs that.
    Run {
        #[command(flatten)]
        solve: SolveArgs,
        /// Only say what would be done, why, and in about what time; nothing is written.
        #[arg(long)]
        dry_run: bool,
    },
    /// Solve a part of the stored points by another method, and check every stored sum.
    Verify {
        #[command(flatten)]
        study: StudyArgs,
        #[command(flatten)]
        part: PartArgs,
    },
    /// Copy the database as it is at one moment into a new file, while anything runs.
    Backup {
        /// Study file, or the folder of one.
        study: PathBuf,
        /// The copy.
        file: PathBuf,
        /// Where the experiment database lies, instead of where the study file says.
        #[arg(long, value_name = "FILE")]
        db: Option<PathBuf>,
    },
    /// Which settings, inputs and samples differ between two databases or two runs, and what that does to the annual averages.
    /// Exit status 1 where anything differs.
    Compare(CompareArgs),
    /// Write the database's tables, or look-up tables for fleet planners, as files into a folder.
    Export(ExportArgs),
    /// What tables, views and columns of the database are, and questions with the queries that answer them.
    Dictionary {
        #[command(flatten)]
        study: StudyArgs,
        /// How it is said.
        #[arg(long, value_enum, default_value_t = DictionaryFormat::Markdown)]
        format: DictionaryFormat,
    },
    /// The JSON schema of the study file, for editors.
    Schema,
    /// Completions of this command line for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Write manual pages into a folder.
    Man {
        /// The folder, such as ~/.local/share/man/man1.
        dir: PathBuf,
    },
    /// What the database holds, what is pending, what failed.
    Status {
        #[command(flatten)]
        study: StudyArgs,
        /// Also what each stage of a run would do, and what has changed.
        #[arg(long)]
        why: bool,
        /// As one JSON object.
        #[arg(long)]
        json: bool,
    },
    /// One optimum: temperatures, heat flows, the binary choices, and the rows it came from.
    Show {
        #[command(flatten)]
        study: StudyArgs,
        #[command(flatten)]
        point: PointArgs,
        /// As one JSON object.
        #[arg(long)]
        json: bool,
    },
}

/// `I/N`.
fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').and_then(|(index, of)| Shard::new(index.parse().ok()?, of.parse().ok()?));
    parts.ok_or_else(|| "give I/N with I from 1 to N, such as 2/4".to_owned())
}

impl Command {
    /// Whether it looks at signals between its steps; the others are ended by them at once, and leave no file half written.
    pub fn can_stop(&self) -> bool {
        matches!(
            self,
            Self::Fetch(_)
                | Self::Ingest(_)
                | Self::Shade(_)
                | Self::Solve { .. }
                | Self::Merge { .. }
                | Self::Simulate(_)
                | Self::Control(_)
                | Self::Sensitivity(_)
                | Self::Report { check: None, .. }
                | Self::Run { .. }
                | Self::Verify { .. }
        )
    }
}

#[derive(Debug, Clone, ClapArgs)]
pub struct StudyArgs {
    /// Study file, or the folder of one [default: study.toml].
    pub study: Option<PathBuf>,

    /// Where the experiment database lies, instead of where the study file says.
    #[arg(long, value_name = "FILE")]
    pub db: Option<PathBuf>,
}

#[derive(Debug, Clone, ClapArgs)]
pub struct SolveArgs {
    #[command(flatten)]
    pub study: StudyArgs,

    /// How optima are found; points that were found otherwise are computed again.
    #[arg(long, value_enum, default_value_t = Method::Fast)]
    pub method: Method,
}

/// How optima are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// Global by construction, exact door law and vote.
    Fast,
    /// The paper's nonlinear programs with its smooth door law, and the exact vote.
    Nlp,
    /// The paper's nonlinear programs with its smooth door law and its network for the vote.
    NlpSurrogate,
}

impl From<Method> for solve::Method {
    fn from(typed: Method) -> Self {
        match typed {
            Method::Fast => Self::Fast,
            Method::Nlp => Self::Nlp,
            Method::NlpSurrogate => Self::NlpSurrogate,
        }
    }
}

#[derive(Debug, ClapArgs)]
pub struct FetchArgs {
    #[command(flatten)]
    pub study: StudyArgs,

    /// Only the missions or only the weather.
    #[arg(long, value_enum)]
    pub only: Option<Inputs>,

    /// Ask no server; only say what is there and what is missing.
    #[arg(long)]
    pub offline: bool,

    /// How long to wait for a connection, an answer, or the next bytes.
    #[arg(long, value_name = "SECONDS", default_value_t = 30, value_parser = clap::value_parser!(u64).range(1..))]
    pub timeout: u64,
}

/// A kind of inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Inputs {
    /// Telemetry.
    Missions,
    /// Weather.
    Weather,
}

#[derive(Debug, ClapArgs)]
pub struct CompareArgs {
    /// A database, or a study file or its folder, whose database is meant.
    pub one: PathBuf,

    /// Another one.
    #[arg(required_unless_present = "runs", conflicts_with = "runs")]
    pub other: Option<PathBuf>,

    /// Two runs of the one database instead, the earlier one first; the table `run` has their numbers.
    #[arg(long, num_args = 2, value_names = ["FIRST", "SECOND"])]
    pub runs: Vec<i64>,

    /// How it is said.
    #[arg(long, value_enum, default_value_t = CompareFormat::Text)]
    pub format: CompareFormat,
}

/// How differences are said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CompareFormat {
    /// Lines for people.
    Text,
    /// Comma-separated values: a row for each difference and each annual average.
    Csv,
}

#[derive(Debug, ClapArgs)]
pub struct ExportArgs {
    #[command(flatten)]
    pub study: StudyArgs,

    /// What is written: all documented tables as Parquet or CSV, or look-up tables of HVAC consumption.
    #[arg(long, value_enum)]
    pub format: ExportFormat,

    /// Folder: a new one, an empty one, or one that holds an export, which is replaced.
    #[arg(long, value_name = "DIR")]
    pub to: PathBuf,

    /// With lut: people on board at a level of loading of 1.
    #[arg(long, value_name = "PEOPLE", default_value_t = 160.0)]
    pub capacity: f64,
}

/// What is exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ExportFormat {
    /// Apache Parquet, a folder a design.
    Parquet,
    /// Comma-separated values, a folder a design.
    Csv,
    /// HVAC share of the consumption, in the columns of SimBA and eFLIPS.
    Lut,
}

/// How the dictionary is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DictionaryFormat {
    /// Tables of columns with type, unit and meaning.
    Markdown,
    /// Questions and their queries.
    Questions,
    /// Everything as one JSON object.
    Json,
    /// Metadata for Datasette: datasette study.db --metadata FILE.
    Datasette,
}

#[derive(Debug, ClapArgs)]
pub struct PartArgs {
    /// Share of the stored points that is solved again, 0 … 1.
    #[arg(long, value_name = "F", default_value_t = 0.02)]
    pub fraction: f64,

    /// Seed of their choice.
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
}

#[derive(Debug, ClapArgs)]
pub struct DemoArgs {
    /// Folder of the data set.
    pub dir: PathBuf,

    /// Missions of 3 to 6 hours, spread over the year.
    #[arg(long, value_name = "N", default_value_t = 48, conflicts_with = "like")]
    pub missions: usize,

    /// Seed of everything that is made up.
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,

    /// Missions with start, end and load of a published metaData.csv.
    #[arg(long, value_name = "METADATA.csv")]
    pub like: Option<PathBuf>,

    /// A file of real weather instead of the synthetic one: MeteoSwiss' open data (ogd-smn_…), a SIA 4028 year, or hourly
    /// CSV with the columns interval_start_utc, T_degC and StrGlo_Wm2.
    #[arg(long, value_name = "FILE")]
    pub weather: Option<PathBuf>,

    /// With --like: bus to take; may be given several times [default: 183].
    #[arg(long = "bus", value_name = "NUMBER", requires = "like")]
    pub buses: Vec<u32>,
}

#[derive(Debug, ClapArgs)]
pub struct ControlArgs {
    #[command(flatten)]
    pub study: StudyArgs,

    /// Folder for a TOML and a CSV of each design and comfort window, beside the study file.
    #[arg(long, value_name = "DIR", default_value = "setpoints")]
    pub to: PathBuf,
}

#[derive(Debug, ClapArgs)]
pub struct CanyonArgs {
    #[command(flatten)]
    pub study: StudyArgs,

    /// Direction of a street from north in degrees; may be given several times [default: eight, evenly spread].
    #[arg(long = "street-azimuth-deg", value_name = "A", allow_negative_numbers = true)]
    pub street_azimuths_deg: Vec<f64>,

    /// Height of the walls over the width of a street; may be given several times, each with equal share [default:
    /// those of `--streets`].
    #[arg(long = "height-to-width", value_name = "H")]
    pub heights_to_width: Vec<f64>,

    /// Streets that have a name.
    #[arg(long, value_enum, default_value_t, conflicts_with = "heights_to_width")]
    pub streets: Streets,
}

#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub enum Streets {
    /// 0.22 times as high as wide: the shade of the hour in summer whose solar heat the paper prints.
    #[default]
    Calibrated,
    /// A mixture of 0, 0.5, 1 and 1.5 times as high as wide.
    Town,
}

impl From<Streets> for pipeline::Streets {
    fn from(streets: Streets) -> Self {
        match streets {
            Streets::Calibrated => Self::Calibrated,
            Streets::Town => Self::Town,
        }
    }
}

#[derive(Debug, ClapArgs)]
pub struct PointArgs {
    /// Sample, as in the view `sample`.
    #[arg(long, value_name = "ID")]
    pub sample: i64,

    /// Design, as in the study file.
    #[arg(long, value_name = "D")]
    pub design: String,

    /// Limit of the comfort window [-L, +L], or the larger limit of an unequal one.
    #[arg(long, value_name = "L")]
    pub pmv_limit: f64,

    /// Write the heat flows as a diagram (SVG) to a file.
    #[arg(long, value_name = "FILE")]
    pub figure: Option<PathBuf>,
}
