//! How far the annual averages of the steady-state method are from those of the simulated missions, and why.

use store::SimulatedYear;

use super::over_windows::{OverWindows, over_windows};
use super::{value, weights_note};
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Span, Table};
use crate::figure::{Axis, Chart};
use crate::numbers::{of_point, optional, percent, signed, signed_percent_within, text, watts, window, within};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let mut tables = Vec::new();
    if !study.simulation_failures.is_empty() {
        tables.push(failures(study));
    }
    if study.simulated_years.is_empty() && tables.is_empty() {
        return None;
    }
    tables.push(data(study));
    let section = Section { tables, ..Section::new("Steady state against simulation") }
        .asking("How far are the optima of single hours from what a bus takes second by second?");
    let rows: Vec<Vec<String>> = comparisons(study).iter().map(|c| row(c, study)).collect();
    let columns = [
        "steady state W",
        "simulated W",
        "difference",
        "start-up W",
        "power limit W",
        "hourly modes W",
        "averaging W",
        "time at the limit",
    ];
    let cause = |name: &str, text| vec![Span::Strong(name.to_owned()), Span::Text(text)];
    Some(
        section
            .with(Block::words(
                "Every mission once more, second by second: the optimum of each segment prescribes operating mode, curtain, heaters and cabin temperature, a PI\n\
                 controller follows it. The annual means count months by their days. The difference is split by simulating again without one habit after\n\
                 the other; the four parts add up to it:",
            ))
            .with(Block::List(vec![
                cause("start-up", ": the bus leaves the depot at depot temperature instead of in steady state;"),
                cause(
                    "power limit",
                    ": heat pump, air conditioning and heaters have limits (negative where the cabin stays off its setpoint for it);",
                ),
                cause(
                    "hourly modes",
                    ": heating, resting or cooling is held for a whole segment instead of following the comfort band;",
                ),
                cause("averaging", ": what doors, passengers and weather do within a segment."),
            ]))
            .with(chart(study).map(|chart| Block::chart("simulation", "Simulation less steady state", chart)))
            .with(Block::Table(Table::new("simulation_annual.csv", &["design", "PMV"], &columns, rows)))
            .with(weights_note(study))
            .with(meaning(study))
            .with(Block::limits(
                "The simulated control is told the optimum of each hour, which a bus on the road does not know; causal controllers have a\n\
                 section of their own.",
            )),
    )
}

/// How far simulation and steady state are apart, in percent of the latter.
fn difference_percent(y: &SimulatedYear) -> f64 {
    100.0 * (y.mean_hvac_power_w / y.static_mean_hvac_power_w - 1.0)
}

fn meaning(study: &StudyReport) -> Option<Block> {
    let all: Vec<f64> = comparisons(study).iter().map(|c| difference_percent(c.paper)).collect();
    let all = || all.iter().copied().filter(|d| d.is_finite());
    let (least, most) = (all().reduce(f64::min)?, all().reduce(f64::max)?);
    Some(Block::Means(value(format!(
        "Over all designs and windows that are simulated, the year takes {} to {} % of power against steady state: so far the annual \
         means of this report stand for a bus in motion.",
        signed(least, 1),
        signed(most, 1)
    ))))
}

/// The difference over the comfort window.
fn chart(study: &StudyReport) -> Option<Chart> {
    let years = comparisons(study);
    let chart = OverWindows {
        title: "Simulation less steady state".to_owned(),
        told: "Difference of the annual mean HVAC power in percent of steady state; bands: 90 % intervals.".to_owned(),
        quantity: Axis::new("difference in %"),
        height: 110.0,
    };
    over_windows(study, chart, |design, w| {
        let y = years.iter().map(|c| c.paper).find(|y| y.design == design && y.window == w)?;
        let ends = of_point(&study.simulation_intervals, &y.design, y.window, &y.controller);
        let ends = ends.and_then(|e| e.relative_difference).map(|ends| ends.map(|end| 100.0 * end));
        Some((difference_percent(y), ends)).filter(|(d, _)| d.is_finite())
    })
}

/// The annual mean of one design and window: in steady state, simulated as in the paper, and the causes of the difference.
/// The causes add up to it.
#[derive(Debug, Clone, PartialEq)]
struct Comparison<'s> {
    paper: &'s SimulatedYear,
    /// What the start at depot temperature costs in W.
    start_up_w: f64,
    /// What the power limits cost (negative: what they leave unheated).
    power_limit_w: f64,
    /// What holding the operating mode within each segment costs.
    hourly_modes_w: f64,
    /// What is left: loads, doors and weather averaged over the segment.
    averaging_w: f64,
}

/// All designs and windows that are simulated in all four ways.
fn comparisons(study: &StudyReport) -> Vec<Comparison<'_>> {
    let years = &study.simulated_years;
    let of = |y: &SimulatedYear, controller: &str| {
        let same = |o: &&SimulatedYear| o.controller == controller && o.design == y.design && o.window == y.window;
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

fn row(c: &Comparison<'_>, study: &StudyReport) -> Vec<String> {
    let y = c.paper;
    let difference_w = y.mean_hvac_power_w - y.static_mean_hvac_power_w;
    let ends = of_point(&study.simulation_intervals, &y.design, y.window, &y.controller);
    vec![
        y.design.clone(),
        window(y.window),
        watts(Some(y.static_mean_hvac_power_w)),
        within(y.mean_hvac_power_w, ends.and_then(|e| e.power_w), 0),
        signed_percent_within(difference_w, y.static_mean_hvac_power_w, ends.and_then(|e| e.relative_difference)),
        signed(c.start_up_w, 0),
        signed(c.power_limit_w, 0),
        signed(c.hourly_modes_w, 0),
        signed(c.averaging_w, 0),
        percent(Some(y.saturated_fraction)),
    ]
}

fn data(study: &StudyReport) -> DataTable {
    let ends = |y: &SimulatedYear| of_point(&study.simulation_intervals, &y.design, y.window, &y.controller);
    DataTable::of(
        "simulation_annual.csv",
        &study.simulated_years,
        &[
            ("design", &|y| text(&y.design)),
            ("pmv_min", &|y| y.window.pmv_min().to_string()),
            ("pmv_max", &|y| y.window.pmv_max().to_string()),
            ("controller", &|y| y.controller.clone()),
            ("mean_hvac_power_w", &|y| y.mean_hvac_power_w.to_string()),
            ("static_mean_hvac_power_w", &|y| y.static_mean_hvac_power_w.to_string()),
            ("saturated_fraction", &|y| y.saturated_fraction.to_string()),
            ("mission_count", &|y| y.mission_count.to_string()),
            ("mean_hvac_power_low_w", &|y| optional(ends(y).and_then(|e| e.power_w).map(|[low, _]| low))),
            ("mean_hvac_power_high_w", &|y| optional(ends(y).and_then(|e| e.power_w).map(|[_, high]| high))),
        ],
    )
}

fn failures(study: &StudyReport) -> DataTable {
    DataTable::of(
        "simulation_failures.csv",
        &study.simulation_failures,
        &[
            ("mission", &|f| text(&f.mission)),
            ("design", &|f| text(&f.design)),
            ("pmv_min", &|f| f.window.pmv_min().to_string()),
            ("pmv_max", &|f| f.window.pmv_max().to_string()),
            ("reason", &|f| text(&f.reason)),
        ],
    )
}
