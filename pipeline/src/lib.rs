//! From files to a report: missions and weather → samples → optima → simulations → report.
//!
//! [`run`] drives the [`Stage`]s over one database and keeps the record of the run. A stage declares what it needs through
//! [`Inputs`], which reads each input once, and through [`freshness`](crate::Stale): what is stale is an error with its
//! remedy, never computed with in silence. Whoever calls the pipeline, a program or a service, watches it by [`Progress`].

mod backup;
mod basis;
mod before;
mod budget;
mod canyon;
mod check;
mod climates;
mod compare;
mod control;
mod energy;
mod error;
mod export;
mod fetch;
mod files;
mod folder;
mod freshness;
mod in_order;
mod in_turns;
mod ingest;
mod inputs;
mod lock;
mod metrics;
mod missing;
mod mission_inputs;
mod mission_samples;
mod missions;
mod news;
mod open;
mod optima;
mod plan;
mod progress;
mod readers;
mod record;
mod report;
mod report_check;
mod run;
mod samples;
mod sensitivity;
mod shards;
mod show;
mod simulations;
mod status;
mod traces;
mod uncertainty;
mod variants;
mod verify;

pub use self::export::{Export, Words, export, words};
pub use self::fetch::{FetchedFile, Wanted, fetch};
pub use self::sensitivity::sensitivities;
pub use ::export::{Format, Loading};
pub use ::fetch::{FetchError, Fetched, Patience};
pub use ::report::Climates;
pub use backup::backup;
pub use canyon::write_canyon;
pub use check::{Check, check};
pub use climates::{climates, write_climates};
pub use compare::{AverageChange, Comparison, SampleChanges, compare, compare_runs};
pub use control::{setpoints, write_setpoints};
pub use error::PipelineError;
pub use files::write_whole;
pub use freshness::Stale;
pub use in_order::in_order;
pub use inputs::Inputs;
pub use mission_inputs::{MissionInputs, mission_inputs};
pub use mission_samples::{MissionReader, MissionSamples};
pub use plan::{StagePlan, plan};
pub use progress::{Progress, Quiet, StageEnd, Work};
pub use report_check::{Difference, ReportCheck, check_report};
pub use run::{Done, Options, Stage, run};
pub use shading::Streets;
pub use shards::{Shard, ShardWork, solve_shard};
pub use show::{Point, Shown, show};
pub use status::{LastRun, LastStage, Status, Summary, status};
pub use store::{Sensitivities, SetpointRow, SwingRow};
pub use verify::{Approximation, Part, Verification, verify};

/// Version of the program, as runs and reports state it.
pub const PROGRAM_VERSION: &str = env!("CARGO_PKG_VERSION");
