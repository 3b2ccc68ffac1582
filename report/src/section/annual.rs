//! Annual mean power by design and window.

use cabin::ComfortWindow;
use store::AnnualRow;

use super::{pareto, weights_note};
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Span, Table};
use crate::numbers::{optional, text, watts, window, within};

pub(super) fn section(study: &StudyReport) -> Section {
    let designs = study.design_names();
    let row = |w| {
        let cell = |d: &&str| {
            let power_w = study.annual_power_w(d, w);
            power_w.map_or_else(|| watts(None), |power_w| within(power_w, study.annual_ends(d, w), 0))
        };
        let cells = designs.iter().map(cell);
        [window(w)].into_iter().chain(cells).collect()
    };
    let rows = study.windows().into_iter().map(row).collect();
    let section = Section { tables: vec![data(study)], ..Section::new("Annual mean HVAC power") }
        .asking("How much power does each design need for how much comfort, in the mean over the hours in service?");
    pareto::with_fronts(section, study)
        .with(Block::words("In W:"))
        .with(Block::Table(Table::new("annual_average.csv", &["PMV"], &designs, rows)))
        .with(study.has_intervals().then(interval_note))
        .with(weights_note(study))
        .with(limited_note(study))
        .with(meaning(study))
        .with(Block::limits(
            "These are optima of single hours: no control reaches all of them, and what a cabin takes to warm up is not in them. Sections\n\
             below say how much that is. The means are over the hours in service, months weighted by their days; hours out of service have\n\
             no power here.",
        ))
}

/// Which design is the cheapest in which windows.
fn meaning(study: &StudyReport) -> Option<Block> {
    let mut runs: Vec<(&str, ComfortWindow, ComfortWindow)> = Vec::new();
    for w in study.windows() {
        let Some((name, _)) = study.cheapest(w) else { continue };
        match runs.last_mut() {
            Some((last, _, to)) if *last == name => *to = w,
            _ => runs.push((name, w, w)),
        }
    }
    let text = match runs.as_slice() {
        [] => return None,
        [(name, ..)] => format!("In every comfort window {name} needs the least."),
        several => {
            let each = several.iter().map(|(name, from, to)| match from == to {
                true => format!("{name} at PMV {}", window(*from)),
                false => format!("{name} from PMV {} to {}", window(*from), window(*to)),
            });
            format!("The cheapest design depends on the comfort window: {}.", each.collect::<Vec<_>>().join(", "))
        }
    };
    let words = " The farther the vote may be from neutral, the less power any design needs: what is lower on the same place of the\n\
                 figure is cheaper for the same comfort.";
    Some(Block::Means(vec![Span::Value(text), Span::Text(words)]))
}

/// Which designs do not give the comfort that their row says.
fn limited_note(study: &StudyReport) -> Option<Block> {
    let misses = |name: &&str| study.windows().into_iter().any(|w| study.misses(name, w));
    let names: Vec<&str> = study.design_names().into_iter().filter(misses).collect();
    let text = vec![
        Span::Text("Not in every hour within the window, because power is limited: "),
        Span::Value(names.join(", ")),
        Span::Text(
            ". What comes nearest counts; the section on limits says how near. No such design is called the cheapest.",
        ),
    ];
    (!names.is_empty()).then_some(Block::Note(text))
}

/// What stands in brackets.
pub(super) fn interval_note() -> Block {
    Block::Note(vec![Span::Text(
        "In brackets: 90 % interval, from the days of the recorded years; digits that it does not let stand are left out.",
    )])
}

fn data(study: &StudyReport) -> DataTable {
    let missing = study.missing_months().iter().map(u8::to_string).collect::<Vec<_>>().join(" ");
    let power = |r: &AnnualRow| study.annual_ends(&r.design, r.window);
    let reduction = |r: &AnnualRow| study.interval(&r.design, r.window)?.reduction_vs_ptc;
    DataTable::of(
        "annual_average.csv",
        &study.annual,
        &[
            ("design", &|r| text(&r.design)),
            ("pmv_limit", &|r| r.window.pmv_limit().to_string()),
            ("pmv_min", &|r| r.window.pmv_min().to_string()),
            ("pmv_max", &|r| r.window.pmv_max().to_string()),
            ("hvac_power_w", &|r| optional(r.hvac_power_w)),
            ("heating_power_w", &|r| optional(r.heating_power_w)),
            ("cooling_power_w", &|r| optional(r.cooling_power_w)),
            ("sample_count", &|r| r.sample_count.to_string()),
            ("unsolved_count", &|r| r.unsolved_count.to_string()),
            ("unsolved_weight", &|r| r.unsolved_weight.to_string()),
            ("reduction_vs_ptc", &|r| optional(r.reduction_vs_ptc)),
            ("hvac_power_low_w", &|r| optional(power(r).map(|[low, _]| low))),
            ("hvac_power_high_w", &|r| optional(power(r).map(|[_, high]| high))),
            ("reduction_vs_ptc_low", &|r| optional(reduction(r).map(|[low, _]| low))),
            ("reduction_vs_ptc_high", &|r| optional(reduction(r).map(|[_, high]| high))),
            ("missing_months", &|_| missing.clone()),
        ],
    )
}
