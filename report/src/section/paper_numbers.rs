//! Numbers that the paper prints of its two missions, beside those of this study (figures `single-scenario`,
//! `dynamic-comparison`, `dynamic-comparison-pareto`, `causal-pareto-front`).

use cabin::{HeatFlows, OperatingMode, celsius};
use chrono::Timelike;
use store::MissionTrace;

use super::findings::Verdict;
use super::mission_hour::{shown_operation, starts};
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::numbers::window;

/// A number, side by side.
struct PaperNumber {
    figure: &'static str,
    number: String,
    paper: String,
    ours: String,
    verdict: Verdict,
}

/// What the paper prints of an hour: temperatures in °C, flows in kW without their sign.
struct PrintedHour {
    label: &'static str,
    figure: &'static str,
    temperatures_c: [f64; 6],
    flows_kw: [f64; 13],
}

const PRINTED: [PrintedHour; 2] = [
    PrintedHour {
        label: "cold",
        figure: "single-scenario-cold",
        temperatures_c: [16.1, 13.5, 12.3, 9.5, 1.4, -0.7],
        flows_kw: [4.2, 1.0, 2.3, 0.4, 0.4, 10.6, 11.0, 9.0, 2.0, 8.0, 0.0, 0.0, 0.0],
    },
    PrintedHour {
        label: "hot",
        figure: "single-scenario-hot",
        temperatures_c: [24.9, 30.8, 29.1, 30.3, 34.9, 34.7],
        flows_kw: [2.0, 1.0, 0.9, 0.9, 0.1, 8.7, 6.2, 0.7, 0.2, 13.5, 1.0, 2.4, 7.1],
    },
];
const TEMPERATURES: [&str; 6] =
    ["cabin air", "interior", "radiant heaters", "shell inside", "shell outside", "ambient"];
const FLOWS: [&str; 13] = [
    "passengers",
    "electronics",
    "doors",
    "interior to cabin air",
    "interior to shell, radiation",
    "cabin air to shell",
    "through the shell",
    "shell to ambient air",
    "shell to surroundings, radiation",
    "air unit",
    "sun on interior",
    "sun on shell inside",
    "sun on shell outside",
];
/// Boxes of the figure `dynamic-comparison-pareto`: limit of PMV, and between which mean powers in kW both missions lie.
const BOXES_KW: [(f64, [f64; 2]); 5] =
    [(0.0, [3.87, 9.08]), (0.5, [3.2, 6.38]), (1.0, [2.63, 4.35]), (1.5, [2.17, 2.81]), (2.0, [0.98, 2.37])];
/// Boxes of the figure `causal-pareto-front`: the summer mission, optimal and under control.
const CAUSAL_BOXES_KW: [(f64, [f64; 2]); 4] =
    [(0.25, [3.75, 4.03]), (0.625, [3.28, 3.52]), (1.0, [2.86, 3.09]), (1.5, [2.38, 2.63])];
/// Temperatures agree within this, flows within a tenth and at least within so many kW, times within so many minutes.
const WITHIN_K: f64 = 0.5;
const WITHIN_KW: f64 = 0.1;
const WITHIN_MIN: i64 = 10;

/// None without a mission that is named like one of the paper.
pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let all = numbers(study);
    if all.is_empty() {
        return None;
    }
    let cells = |n: &PaperNumber| {
        vec![n.figure.to_owned(), n.number.clone(), n.paper.clone(), n.ours.clone(), n.verdict.word().to_owned()]
    };
    let table = Table::new(
        "paper_numbers.csv",
        &["figure", "number", "paper", "this study", "verdict"],
        &[],
        all.iter().map(cells).collect(),
    );
    let data = DataTable::of(
        "paper_numbers.csv",
        &all,
        &[
            ("figure", &|n| n.figure.to_owned()),
            ("number", &|n| n.number.clone()),
            ("paper", &|n| n.paper.clone()),
            ("this_study", &|n| n.ours.clone()),
            ("verdict", &|n| n.verdict.word().to_owned()),
        ],
    );
    let words = "Of the missions that are named like the paper's two. Temperatures count as within at 0.5 K, flows at a tenth or 0.1 kW,\n\
                 times at 10 minutes, powers where all of them lie in the box that the paper draws around its own. Passengers and doors are\n\
                 inputs: with synthetic telemetry they are not those of the paper.";
    Some(
        Section { tables: vec![data], ..Section::new("Numbers that the paper prints") }
            .asking("Are the temperatures, flows and times found again that the paper prints of its two missions?")
            .with(Block::words(words))
            .with(Block::Table(table))
            .with(Block::Means(super::value(format!(
                "{} of {} numbers are found again.",
                all.iter().filter(|n| n.verdict == Verdict::Within).count(),
                all.len()
            ))))
            .with(Block::limits(
                "Weather and mission are named like the paper's; whether they are the same, a name cannot say.",
            )),
    )
}

fn numbers(study: &StudyReport) -> Vec<PaperNumber> {
    let mut all = Vec::new();
    let of_paper: Vec<&MissionTrace> = study.traces.iter().filter(|t| t.of_paper).collect();
    for printed in &PRINTED {
        if let Some(trace) = of_paper.iter().find(|t| t.label == printed.label) {
            all.extend(of_hour(study, trace, printed));
        }
    }
    if let Some(hot) = of_paper.iter().find(|t| t.label == "hot") {
        let starts = starts(hot, study.zone);
        let runs = |o: &cabin::Operation| o.mode != OperatingMode::Passive;
        let at = |place: Option<usize>| starts.get(place?).copied();
        let optima: Vec<&cabin::Operation> = hot.segments.iter().map(|(_, o)| o).collect();
        let rests = optima.windows(2).position(|pair| runs(pair[0]) && !runs(pair[1])).map(|before| before + 1);
        let times = [
            ("air curtains from", (10, 50), at(optima.iter().position(|o| o.devices.air_curtain))),
            ("air unit at rest again from", (6, 50), at(rests)),
        ];
        for (number, (hour, minute), start) in times {
            let Some(start) = start else { continue };
            let off = i64::from(start.hour()) * 60 + i64::from(start.minute()) - (hour * 60 + minute);
            all.push(PaperNumber {
                figure: "dynamic-comparison-hot",
                number: number.to_owned(),
                paper: format!("about {hour:02}:{minute:02}"),
                ours: start.format("%H:%M").to_string(),
                verdict: verdict(off.abs() <= WITHIN_MIN),
            });
        }
        all.extend(CAUSAL_BOXES_KW.iter().filter_map(|of| causal(study, *of)));
    }
    if of_paper.len() == PRINTED.len() {
        all.extend(BOXES_KW.iter().filter_map(|of| both_missions(study, *of)));
    }
    all
}

fn of_hour(study: &StudyReport, trace: &MissionTrace, printed: &PrintedHour) -> Vec<PaperNumber> {
    let Some((sample, o, flows)) = shown_operation(trace, study) else { return Vec::new() };
    let t = &o.temperatures;
    let temperatures_c = [
        t.cabin_k,
        t.interior_k,
        t.radiant_heater_k,
        t.shell_inside_k,
        t.shell_outside_k,
        sample.disturbances.ambient_temperature_k,
    ]
    .map(celsius);
    let number = |name: &str, paper: f64, ours: f64, unit: &str, within: f64| PaperNumber {
        figure: printed.figure,
        number: name.to_owned(),
        paper: format!("{paper:.1} {unit}").replace('-', "−"),
        ours: format!("{:.1} {unit}", ours + 0.0).replace('-', "−"),
        verdict: verdict((ours - paper).abs() <= within),
    };
    let temperatures = TEMPERATURES.iter().zip(printed.temperatures_c).zip(temperatures_c);
    let mut all: Vec<PaperNumber> =
        temperatures.map(|((name, paper), ours)| number(name, paper, ours, "°C", WITHIN_K)).collect();
    for ((name, paper), ours) in FLOWS.iter().zip(printed.flows_kw).zip(flows_kw(&flows)) {
        all.push(number(name, paper, ours, "kW", (0.1 * paper).max(WITHIN_KW)));
    }
    all
}

/// In the order of the names, without their sign, as the paper prints them.
fn flows_kw(f: &HeatFlows) -> [f64; 13] {
    [
        f.passengers_w,
        f.other_w,
        f.door_w,
        f.convection_interior_w,
        f.radiation_interior_shell_w,
        f.convection_shell_inside_w,
        f.conduction_shell_w,
        f.convection_shell_outside_w,
        f.radiation_shell_outside_w,
        f.air_unit_w,
        f.solar.interior_w,
        f.solar.shell_inside_w,
        f.solar.shell_outside_w,
    ]
    .map(|w| w.abs() / 1e3)
}

fn both_missions(study: &StudyReport, (limit, printed): (f64, [f64; 2])) -> Option<PaperNumber> {
    let rows = study.trace_windows.iter().filter(|w| w.window.is_plus_minus(limit));
    let powers_w = rows.flat_map(|w| [w.static_mean_hvac_power_w, w.mean_hvac_power_w]);
    boxed("dynamic-comparison-pareto", "both missions", limit, printed, powers_w)
}

fn causal(study: &StudyReport, (limit, printed): (f64, [f64; 2])) -> Option<PaperNumber> {
    let extracted = study.control_trace_points.iter().map(|(point, ..)| point).filter(|p| p.controller == "extracted");
    let rows = extracted.filter(|p| p.window.is_plus_minus(limit));
    let powers_w = rows.flat_map(|p| [p.static_mean_hvac_power_w, p.mean_hvac_power_w]);
    boxed("causal-pareto-front", "the summer mission", limit, printed, powers_w)
}

fn boxed(
    figure: &'static str,
    what: &str,
    limit: f64,
    [low, high]: [f64; 2],
    powers_w: impl Iterator<Item = f64>,
) -> Option<PaperNumber> {
    let powers_kw: Vec<f64> = powers_w.map(|w| w / 1e3).collect();
    let least = powers_kw.iter().copied().reduce(f64::min)?;
    let most = powers_kw.iter().copied().reduce(f64::max)?;
    let of = cabin::ComfortWindow::symmetric(limit).ok()?;
    Some(PaperNumber {
        figure,
        number: format!("mean power of {what} at PMV {}", window(of)),
        paper: format!("{low:.2} … {high:.2} kW"),
        ours: format!("{least:.2} … {most:.2} kW"),
        verdict: verdict(low <= least && most <= high),
    })
}

fn verdict(within: bool) -> Verdict {
    if within { Verdict::Within } else { Verdict::Outside }
}
