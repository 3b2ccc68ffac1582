//! Averages of the last complete stage: renewed in the transaction that completes it, so that readers never see one of a
//! half-computed study. Sums go by missions and months, not by the ids of rows, which tell in what order things came.

mod controls;
mod months;
mod optima;
mod simulations;

use sqlx::Row;
use sqlx::sqlite::SqliteConnection;

use crate::checks::{commit, seal_averages};
use crate::row::begin;
use crate::stages::{RecordedStage, StageRecord, record_stage};
use crate::{
    ControlTrace, Driven, DrivenEnds, EconomicInput, Energy, NewVariant, SetpointRow, Store, StoreError, StoredGrid,
    control_views, driven, economics, energy, setpoints, uncertainty, variants,
};

pub use months::MonthAverages;

impl Store {
    /// Completes the optima: renews the averages of the months that have changed and the variants, and records the stage.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn complete_optima(
        &mut self,
        record: &StageRecord,
        grid: &StoredGrid,
        energy: &Energy,
        beside: &Beside,
    ) -> Result<(), StoreError> {
        let renew = [
            "DELETE FROM annual_average",
            optima::ANNUAL,
            optima::HISTORY,
            optima::ANNUAL_INTERVAL,
            optima::DESIGN_INTERVAL,
            "DELETE FROM limit_share",
            optima::LIMIT_SHARE,
            "DELETE FROM annual_energy",
            optima::ANNUAL_ENERGY,
            "DELETE FROM limited_annual",
            optima::LIMITED,
            "DELETE FROM economics",
            optima::ECONOMICS,
            "DELETE FROM unmet_demand",
            optima::UNMET_DEMAND,
            "DELETE FROM stale_month",
        ];
        self.complete(RecordedStage::Solve, record, &renew, New::Optima(grid, energy, beside))
    }

    /// Completes the simulations: renews what they come to in the year and by class, and records the stage.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn complete_simulations(&mut self, record: &StageRecord, ends: &[DrivenEnds]) -> Result<(), StoreError> {
        let renew = [
            "DELETE FROM simulation_month WHERE month IN (SELECT month FROM stale_simulation_month)",
            simulations::MONTH,
            "DELETE FROM simulation_annual",
            simulations::ANNUAL,
            "DELETE FROM simulation_class_month WHERE month IN (SELECT month FROM stale_simulation_month)",
            simulations::CLASS_MONTH,
            "DELETE FROM simulation_class",
            simulations::CLASS,
            "DELETE FROM stale_simulation_month",
        ];
        self.complete(RecordedStage::Simulate, record, &renew, New::Driven(ends))
    }

    /// Completes the missions under controllers: renews the setpoints that they follow, what they come to in the year and by
    /// class, and the mission that is shown in time, and records the stage.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn complete_controls(
        &mut self,
        record: &StageRecord,
        rows: &[SetpointRow],
        traces: &[ControlTrace],
        ends: &[DrivenEnds],
    ) -> Result<(), StoreError> {
        let renew = [
            "DELETE FROM control_annual",
            controls::ANNUAL,
            "DELETE FROM control_class",
            controls::CLASS,
            "DELETE FROM control_outside",
            controls::OUTSIDE,
        ];
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            let run_id = last_run(&mut tx).await?;
            setpoints::put(&mut tx, run_id, rows).await?;
            control_views::put_traces(&mut tx, run_id, traces).await?;
            driven::put(&mut tx, run_id, Driven::Controlled, ends).await?;
            for sql in renew {
                execute(&mut tx, sql).await?;
            }
            describe(&mut tx).await?;
            seal_averages(&mut tx).await?;
            record_stage(&mut tx, RecordedStage::Control, record).await?;
            commit(tx).await
        })
    }

    fn complete(
        &mut self,
        stage: RecordedStage,
        record: &StageRecord,
        renew: &[&'static str],
        new: New<'_>,
    ) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            let run_id = last_run(&mut tx).await?;
            match new {
                New::Optima(grid, energy, beside) => {
                    months::put(&mut tx, run_id, grid, &energy.averages).await?;
                    energy::put(&mut tx, run_id, grid, energy).await?;
                    uncertainty::put(&mut tx, run_id, grid, &energy.uncertainty).await?;
                    variants::put(&mut tx, run_id, grid, &beside.variants).await?;
                    economics::put(&mut tx, run_id, &beside.costs).await?;
                }
                New::Driven(ends) => driven::put(&mut tx, run_id, Driven::Simulated, ends).await?,
            }
            for &sql in renew {
                execute(&mut tx, sql).await?;
            }
            describe(&mut tx).await?;
            seal_averages(&mut tx).await?;
            record_stage(&mut tx, stage, record).await?;
            commit(tx).await
        })
    }
}

/// What stands beside the optima of a study.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Beside {
    /// Buses that differ.
    pub variants: Vec<NewVariant>,
    /// What designs cost.
    pub costs: Vec<EconomicInput>,
}

/// What is written besides averages.
enum New<'n> {
    Optima(&'n StoredGrid, &'n Energy, &'n Beside),
    Driven(&'n [DrivenEnds]),
}

/// Tells the planner how large tables are: without it a question about a year's optima and samples takes twenty times as long.
async fn describe(c: &mut SqliteConnection) -> Result<(), StoreError> {
    execute(c, "PRAGMA analysis_limit = 1000").await?;
    execute(c, "ANALYZE").await
}

pub(crate) async fn last_run(c: &mut SqliteConnection) -> Result<i64, StoreError> {
    Ok(sqlx::query("SELECT coalesce(max(run_id), 0) FROM run").fetch_one(c).await?.try_get(0)?)
}

async fn execute(c: &mut SqliteConnection, sql: &'static str) -> Result<(), StoreError> {
    sqlx::query(sql).execute(c).await?;
    Ok(())
}
