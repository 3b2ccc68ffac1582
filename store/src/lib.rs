//! The experiment database: the only room that knows SQL.
//!
//! One [`Store`] is one connection, used by one thread; calls block. Every method that writes does so in one
//! transaction, so that a kill leaves either all of it or nothing. The schema is in `migrations/`; what analysts see are
//! its views, described in `docs/database.md`.

mod connection;
mod inputs;
mod optima;
mod rows;
mod runs;
mod simulations;
mod study;
mod verification;
mod views;

pub use connection::{Store, StoreError};
pub use inputs::KnownFile;
pub use optima::{PointId, StoredOptimum};
pub use rows::{
    DesignRow, ExclusionRow, FileRow, FindingRow, SampleRow, SegmentRow, StoredExclusion, StoredFinding, WindowRow,
};
pub use runs::{Counts, RunEnd, RunRow};
pub use simulations::{LoadRow, SimulatedClass, SimulatedYear, SimulationId, SimulationRow};
pub use study::{StoredStudy, StudyChange};
pub use verification::{CheckRow, VerificationRow};
pub use views::{
    AnnualRow, ExclusionCount, LimitShare, MonthRow, MonthlyRow, OptimumRow, StatusCounts, StoredFile, StoredSample,
};
