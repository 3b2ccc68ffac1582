//! The experiment database: the only room that knows SQL.
//!
//! One [`Store`] is one connection, used by one thread; calls block. Every method that writes does so in one
//! transaction, so that a kill leaves either all of it or nothing. The schema is in `migrations/`; what analysts see are
//! its views, described in `docs/database.md`.

mod averages;
mod bus;
mod checks;
mod clouds;
mod connection;
mod control_views;
mod controls;
mod dictionary;
mod driven;
mod economics;
mod energy;
mod error;
mod files;
mod grid;
mod histograms;
mod history;
mod how_sure;
mod limited;
mod missions;
mod optima;
mod questions;
mod relations;
mod row;
mod runs;
mod samples;
mod sensitivities;
mod setpoints;
mod shadow;
mod simulations;
mod stages;
mod traces;
mod uncertainty;
mod variants;
mod verification;
mod views;

pub use self::setpoints::SetpointRow;
pub use averages::{Beside, MonthAverages};
pub use bus::BusRow;
pub use checks::Checked;
pub use clouds::{Cloud, CloudPoint};
pub use connection::{Store, lock_path};
pub use control_views::{ControlClass, ControlMinute, ControlPoint, ControlTrace, ControlYear, Outside};
pub use controls::{ControlId, ControlRow, ControlledMission};
pub use dictionary::{Column, ColumnKind, Relation, dictionary};
pub use driven::{Driven, DrivenEnds, DrivenMission, DrivenMissions, DrivenPoint};
pub use economics::{EconomicInput, EconomicRow};
pub use energy::{AirUnitSide, Bin, Class, ClassSum, ClassYear, Energy, MonthFlows, MonthSums};
pub use error::StoreError;
pub use files::KnownFile;
pub use grid::{DesignRow, GridChange, StoredGrid};
pub use histograms::{DisturbanceBin, VoteBin};
pub use history::{Basis, Change, ChangeKind, PastAverage};
pub use how_sure::{AnnualInterval, DesignInterval, LeftOutRow, SpreadRow};
pub use limited::LimitedRow;
pub use missions::StoredSegment;
pub use optima::{MissingOptima, NewOptimum, StatusCounts, StoredOptimum};
pub use questions::{Question, questions};
pub use relations::Values;
pub use runs::{Counts, RunEnd, RunRow, RunStage};
pub use sensitivities::{IndexRow, InputRow, ResultOf, Sensitivities, SensitivityResult, SwingRow};
pub use simulations::{SimulatedClass, SimulatedYear, SimulationFailure, SimulationId, SimulationRow};
pub use stages::{RecordedStage, SettingRow, StageRecord};
pub use traces::{MissionTrace, TraceRow, TraceWindow};
pub use uncertainty::{AnnualEnds, DaySum, Ends, LeftOut, MonthDays, MonthSpread, PairEnds, Uncertainty};
pub use variants::{NewVariant, VariantSetting, VariantYear};
pub use verification::{CheckRow, VerificationRow};
pub use views::{AnnualRow, EnergyRow, ExclusionCount, LimitShare, MonthRow, MonthlyRow, OptimumRow};
