//! Everything that a report says: rows of the database, and what the study rests on.

use cabin::{ComfortWindow, Vehicle};
use chrono_tz::Tz;
use ingest::FileRecord;
use store::{
    AnnualInterval, AnnualRow, Cloud, ControlClass, ControlPoint, ControlTrace, ControlYear, DesignInterval, DesignRow,
    DisturbanceBin, DrivenEnds, EconomicRow, Ends, EnergyRow, ExclusionCount, LeftOutRow, LimitShare, LimitedRow,
    MissionTrace, MonthRow, MonthlyRow, Outside, Sensitivities, SetpointRow, SimulatedClass, SimulatedYear,
    SimulationFailure, SpreadRow, StatusCounts, TraceWindow, VariantSetting, VariantYear, VoteBin,
};
use study::assumptions::Assumption;

/// Everything that a report says, in the order of the study.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StudyReport {
    /// Name of the study.
    pub name: String,
    /// A line of the study's author, shown at the top.
    pub note: Option<String>,
    /// Version of the program.
    pub program_version: String,
    /// BLAKE3 of the study with all its defaults.
    pub study_hash: String,
    /// BLAKE3 of all inputs.
    pub input_hash: String,
    /// Time zone of the place.
    pub zone: Tz,
    /// Designs.
    pub designs: Vec<DesignRow>,
    /// Annual means by design and window.
    pub annual: Vec<AnnualRow>,
    /// Energy by design and window.
    pub energies: Vec<EnergyRow>,
    /// The bus.
    pub vehicle: Vehicle,
    /// Shadow fractions at the full hours of a year of 365 days from 1 January 00:00 UTC; empty where none are stored.
    pub shadow: Vec<f64>,
    /// How often disturbances lie where.
    pub disturbance_bins: Vec<DisturbanceBin>,
    /// How often passengers vote what at the optima.
    pub vote_bins: Vec<VoteBin>,
    /// Intervals of 90 % of the annual means.
    pub annual_intervals: Vec<AnnualInterval>,
    /// Of what each design saves against each other one.
    pub design_intervals: Vec<DesignInterval>,
    /// Intervals of the annual means of simulated missions.
    pub simulation_intervals: Vec<DrivenEnds>,
    /// Intervals of the annual means under controllers.
    pub control_intervals: Vec<DrivenEnds>,
    /// How sure each month is.
    pub month_spreads: Vec<SpreadRow>,
    /// The year without one route, year or month.
    pub left_out: Vec<LeftOutRow>,
    /// Monthly means by design, window and month.
    pub monthly: Vec<MonthlyRow>,
    /// Months that have samples.
    pub months: Vec<MonthRow>,
    /// In how many samples the limits of comfort bind.
    pub limit_shares: Vec<LimitShare>,
    /// Points by status.
    pub status: StatusCounts,
    /// Input files, with what was noticed in them.
    pub files: Vec<FileRecord>,
    /// Segments without a sample by reason.
    pub exclusions: Vec<ExclusionCount>,
    /// What the numbers rest on.
    pub assumptions: Vec<Assumption>,
    /// Annual means of the simulated missions, by design, window and controller; empty where nothing is simulated.
    pub simulated_years: Vec<SimulatedYear>,
    /// The simulated missions by month, temperature and length.
    pub simulated_classes: Vec<SimulatedClass>,
    /// Missions that are not simulated.
    pub simulation_failures: Vec<SimulationFailure>,
    /// The missions that are shown in time; none where nothing is simulated.
    pub traces: Vec<MissionTrace>,
    /// What they come to in each window that is simulated.
    pub trace_windows: Vec<TraceWindow>,
    /// Setpoints of every design and window; none where `control` was never complete.
    pub setpoints: Vec<SetpointRow>,
    /// Optima of the design whose controllers are shown, in the windows that figures show.
    pub clouds: Vec<Cloud>,
    /// Annual means of controlled missions, by design, window and controller; empty where nothing is driven.
    pub control_years: Vec<ControlYear>,
    /// The same by month and temperature.
    pub control_classes: Vec<ControlClass>,
    /// Annual power beside the passenger-hours outside each window.
    pub control_outside: Vec<Outside>,
    /// The mission that is shown in time under some controllers.
    pub control_traces: Vec<ControlTrace>,
    /// What it comes to under all of them, with its largest absolute 15-minute vote and that of the optima.
    pub control_trace_points: Vec<(ControlPoint, Option<f64>, f64)>,
    /// Missions that controllers cannot drive: mission, design, reason.
    pub control_failures: Vec<[String; 3]>,
    /// How often limits keep designs from their windows; empty where none does.
    pub limited: Vec<LimitedRow>,
    /// What comfort costs by the user's figures; empty where the study has none.
    pub economics: Vec<EconomicRow>,
    /// Buses that differ, in all windows; empty where the study has none.
    pub variants: Vec<VariantYear>,
    /// What they override.
    pub variant_settings: Vec<VariantSetting>,
    /// What the year depends on; empty where nobody has asked.
    pub sensitivities: Sensitivities,
}

impl StudyReport {
    /// Months without samples, 1 … 12.
    #[must_use]
    pub fn missing_months(&self) -> Vec<u8> {
        (1..=12).filter(|month| !self.months.iter().any(|m| m.month == *month)).collect()
    }

    /// Names of the designs in the order of the study.
    pub(crate) fn design_names(&self) -> Vec<&str> {
        self.designs.iter().map(|d| d.name.as_str()).collect()
    }

    /// The distinct windows in the order of the study.
    pub(crate) fn windows(&self) -> Vec<ComfortWindow> {
        let mut windows = Vec::new();
        for row in &self.annual {
            if !windows.contains(&row.window) {
                windows.push(row.window);
            }
        }
        windows
    }

    /// The window that stands for the study where only one is shown.
    pub(crate) fn shown_window(&self) -> Option<ComfortWindow> {
        ComfortWindow::shown(&self.windows())
    }

    pub(crate) fn annual_power_w(&self, design: &str, window: ComfortWindow) -> Option<f64> {
        self.annual_row(design, window)?.hvac_power_w
    }

    /// Whether any interval is known.
    pub(crate) fn has_intervals(&self) -> bool {
        self.annual_intervals.iter().any(|r| r.hvac_power_w.is_some())
    }

    /// The interval of an annual mean in W.
    pub(crate) fn annual_ends(&self, design: &str, window: ComfortWindow) -> Ends {
        self.interval(design, window)?.hvac_power_w
    }

    /// The intervals of a design and window.
    pub(crate) fn interval(&self, design: &str, window: ComfortWindow) -> Option<&AnnualInterval> {
        self.annual_intervals.iter().find(|r| r.design == design && r.window == window)
    }

    /// The cheapest design of those that meet a window in every hour, with its power in W; of all where none does.
    pub(crate) fn cheapest(&self, window: ComfortWindow) -> Option<(&str, f64)> {
        let of = self.designs.iter().filter_map(|d| Some((d.name.as_str(), self.annual_power_w(&d.name, window)?)));
        of.min_by(|a, b| self.misses(a.0, window).cmp(&self.misses(b.0, window)).then(a.1.total_cmp(&b.1)))
    }

    /// Whether a design's limits keep it from a window in some hour.
    pub(crate) fn misses(&self, design: &str, window: ComfortWindow) -> bool {
        self.limited.iter().any(|r| r.design == design && r.window == window && r.limited > 0)
    }

    /// The design that others are compared with: resistive heating and nothing else where the study has it, else the dearest.
    pub(crate) fn reference(&self, window: ComfortWindow) -> Option<(&str, f64)> {
        let of = |d: &'_ DesignRow| self.annual_power_w(&d.name, window);
        let plain = |d: &&DesignRow| d.is_plain_resistive() && of(d).is_some();
        let dearest = || {
            let solved = self.designs.iter().filter(|d| of(d).is_some());
            solved.max_by(|a, b| of(a).unwrap_or_default().total_cmp(&of(b).unwrap_or_default()))
        };
        let found = self.designs.iter().find(plain).or_else(dearest)?;
        Some((&found.name, of(found)?))
    }

    /// What a design saves of the power of another one, with its interval.
    pub(crate) fn saving(&self, design: &str, other: &str, window: ComfortWindow) -> Option<(f64, Ends)> {
        let same = |p: &&DesignInterval| p.window == window && p.designs[0] == design && p.designs[1] == other;
        let ends = self.design_intervals.iter().find(same).and_then(|p| p.ends);
        let other_w = self.annual_power_w(other, window).filter(|w| *w > 0.0)?;
        Some((1.0 - self.annual_power_w(design, window)? / other_w, ends))
    }

    /// Power of a design in one window over that in another, less 1, with its interval where the other one is ±1.
    pub(crate) fn change(&self, design: &str, window: ComfortWindow, from: ComfortWindow) -> Option<(f64, Ends)> {
        let from_w = self.annual_power_w(design, from).filter(|w| *w > 0.0)?;
        let is_1 = from.is_plus_minus(1.0);
        let ends = self.interval(design, window).filter(|_| is_1).and_then(|r| r.change_vs_pmv_1);
        Some((self.annual_power_w(design, window)? / from_w - 1.0, ends))
    }

    pub(crate) fn annual_row(&self, design: &str, window: ComfortWindow) -> Option<&AnnualRow> {
        self.annual.iter().find(|r| r.design == design && r.window == window)
    }
}
