//! How far the annual averages of the steady-state method are from those of the simulated missions, and why.

use minijinja::context;
use minijinja::value::Value;
use store::{SimulatedClass, SimulatedYear};

use crate::headline::shown_window;
use crate::numbers::{percent, signed, watts, window};
use crate::tables::{optional, table, text};
use crate::{ReportError, StudyReport};

/// The annual mean of one design and window: in steady state, simulated as in the paper, and the causes of the difference.
/// The causes add up to it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Comparison<'s> {
    pub paper: &'s SimulatedYear,
    /// What the start at depot temperature costs in W.
    pub start_up_w: f64,
    /// What the power limits cost (negative: what they leave unheated).
    pub power_limit_w: f64,
    /// What holding the operating mode within each segment costs.
    pub hourly_modes_w: f64,
    /// What is left: loads, doors and weather averaged over the segment.
    pub averaging_w: f64,
}

/// All designs and windows that are simulated in all four ways.
pub(crate) fn comparisons(study: &StudyReport) -> Vec<Comparison<'_>> {
    let years = &study.simulated_years;
    let of = |y: &SimulatedYear, controller: &str| {
        let same = |o: &&SimulatedYear| {
            o.controller == controller && o.design == y.design && o.pmv_min == y.pmv_min && o.pmv_max == y.pmv_max
        };
        years.iter().find(same).map(|o| o.mean_hvac_power_w)
    };
    let compare = |paper| {
        let y: &SimulatedYear = paper;
        let (warm, unlimited, free) = (of(y, "warm-start")?, of(y, "unlimited")?, of(y, "free-mode")?);
        Some(Comparison {
            paper,
            start_up_w: y.mean_hvac_power_w - warm,
            power_limit_w: warm - unlimited,
            hourly_modes_w: unlimited - free,
            averaging_w: free - y.static_mean_hvac_power_w,
        })
    };
    years.iter().filter(|y| y.controller == "paper").filter_map(compare).collect()
}

/// The rows of the report's table.
pub(crate) fn annual_rows(study: &StudyReport) -> Vec<Value> {
    comparisons(study)
        .iter()
        .map(|c| {
            let y = c.paper;
            let difference_w = y.mean_hvac_power_w - y.static_mean_hvac_power_w;
            context! {
                design => &y.design, window => window((y.pmv_min, y.pmv_max)), fixed => watts(Some(y.static_mean_hvac_power_w)),
                simulated => watts(Some(y.mean_hvac_power_w)),
                difference => signed_percent(difference_w, y.static_mean_hvac_power_w),
                start_up => signed(c.start_up_w, 0), limit => signed(c.power_limit_w, 0), modes => signed(c.hourly_modes_w, 0),
                averaging => signed(c.averaging_w, 0), saturated => percent(Some(y.saturated_fraction)),
            }
        })
        .collect()
}

/// The classes of one design in the window that stands for the study.
pub(crate) fn class_rows(study: &StudyReport) -> (Option<String>, Vec<Value>) {
    let shown = shown_window(study);
    let in_window = |c: &&SimulatedClass| Some((c.pmv_min, c.pmv_max)) == shown;
    let Some(design) = study.simulated_classes.iter().rev().find(in_window).map(|c| c.design.clone()) else {
        return (None, Vec::new());
    };
    let rows = study
        .simulated_classes
        .iter()
        .filter(in_window)
        .filter(|c| c.design == design)
        .map(|c| {
            let warm_w = c.warm_start_power_w - c.static_mean_hvac_power_w;
            context! {
                sorted_by => &c.sorted_by, class => &c.class, missions => c.mission_count,
                fixed => watts(Some(c.static_mean_hvac_power_w)), simulated => watts(Some(c.mean_hvac_power_w)),
                difference => signed_percent(c.mean_hvac_power_w - c.static_mean_hvac_power_w, c.static_mean_hvac_power_w),
                warm => signed_percent(warm_w, c.static_mean_hvac_power_w),
                pmv => c.mean_max_abs_pmv.map_or_else(|| "–".to_owned(), |v| format!("{v:.2}")),
                saturated => percent(Some(c.saturated_fraction)),
            }
        })
        .collect();
    (Some(design), rows)
}

fn signed_percent(part: f64, whole: f64) -> String {
    if whole > 0.0 { format!("{} %", signed(100.0 * part / whole, 1)) } else { "–".to_owned() }
}

pub(crate) fn annual_csv(study: &StudyReport) -> Result<Vec<u8>, ReportError> {
    let header = [
        "design",
        "pmv_min",
        "pmv_max",
        "controller",
        "mean_hvac_power_w",
        "static_mean_hvac_power_w",
        "saturated_fraction",
        "mission_count",
    ];
    table(&header, study.simulated_years.iter(), |y| {
        vec![
            text(&y.design),
            y.pmv_min.to_string(),
            y.pmv_max.to_string(),
            y.controller.clone(),
            y.mean_hvac_power_w.to_string(),
            y.static_mean_hvac_power_w.to_string(),
            y.saturated_fraction.to_string(),
            y.mission_count.to_string(),
        ]
    })
}

pub(crate) fn classes_csv(study: &StudyReport) -> Result<Vec<u8>, ReportError> {
    let header = [
        "design",
        "pmv_min",
        "pmv_max",
        "sorted_by",
        "class",
        "mission_count",
        "mean_hvac_power_w",
        "static_mean_hvac_power_w",
        "warm_start_power_w",
        "mean_max_abs_pmv_15min",
        "saturated_fraction",
    ];
    table(&header, study.simulated_classes.iter(), |c| {
        vec![
            text(&c.design),
            c.pmv_min.to_string(),
            c.pmv_max.to_string(),
            c.sorted_by.clone(),
            c.class.clone(),
            c.mission_count.to_string(),
            c.mean_hvac_power_w.to_string(),
            c.static_mean_hvac_power_w.to_string(),
            c.warm_start_power_w.to_string(),
            optional(c.mean_max_abs_pmv),
            c.saturated_fraction.to_string(),
        ]
    })
}
