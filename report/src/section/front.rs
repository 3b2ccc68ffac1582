//! The first page, for who decides: the question, the answer, what comfort costs, and what all of it rests on, in words that need
//! neither the paper nor the rest of the report.

use cabin::ComfortWindow;

use super::{missing_names, pareto};
use crate::StudyReport;
use crate::document::{Block, Prose, Section, Span, Table};
use crate::numbers::{Sure, sure};
use crate::words::{capital, comfort, equipment};

/// Designs that need more than the cheapest by less than this share need the same.
const ALIKE: f64 = 5e-4;

pub(super) fn section(study: &StudyReport) -> Section {
    let section = Section { level: 1, ..Section::new(&study.name) }
        .asking(
            "What does it cost over a year to keep the passengers of an electric city bus comfortable, and which equipment for heating and\n\
             cooling does it with the least electricity?",
        )
        .with(study.note.clone().map(|note| Block::Quote(vec![Span::Value(note)])));
    let Some((shown, cheapest)) = study.shown_window().and_then(|w| Some((w, study.cheapest(w)?))) else {
        let none = "There is no answer yet: not one hour of this study has an operation that keeps its passengers comfortable.";
        return section.with(Block::words(none)).with(Block::List(assumed(study, None)));
    };
    let section = section
        .with(Block::Paragraph(answer(study, shown, cheapest)))
        .with(by_kilometre_and_year(study, shown, cheapest))
        .with(Block::Paragraph(vec![
            Span::Text(
                "Comfort is judged by the predicted mean vote (PMV) of the international standard ISO 7730: the vote of a large group of people\n\
                 on the air and the surfaces around them, from −3 (cold) through 0 (neither cold nor warm) to +3 (hot). In the numbers above the\n\
                 mean vote of the passengers stays ",
            ),
            Span::Value(comfort(shown)),
            Span::Text("."),
        ]))
        .with(comfort_costs(study, shown, cheapest.0))
        .with(pareto::in_words(study).map(|chart| {
            Block::chart("comfort_cost", "What comfort costs with each kind of equipment", chart)
        }))
        .with(compared(study, shown));
    let assumed_title = Block::Paragraph(vec![Span::Strong("What this rests on:".to_owned())]);
    section.with(assumed_title).with(Block::List(assumed(study, Some(shown))))
}

/// A number and its unit, with its interval in words: kWh for an hour is the mean power in kW.
fn kwh(study: &StudyReport, design: &str, window: ComfortWindow, power_w: f64, hours: f64) -> Sure {
    let ends = study.annual_ends(design, window);
    let decimals = if hours == 1.0 { 2 } else { 0 };
    sure(power_w / 1e3 * hours, ends.map(|ends| ends.map(|end| end / 1e3 * hours)), decimals)
}

/// Its range, where it has one, within a sentence.
fn range(sure: &Sure) -> String {
    sure.ends.as_ref().map_or_else(String::new, |[low, high]| format!(" ({low} to {high})"))
}

fn answer(study: &StudyReport, shown: ComfortWindow, (cheapest, power_w): (&str, f64)) -> Prose {
    let alike: Vec<&str> = study
        .design_names()
        .into_iter()
        .filter(|d| study.misses(d, shown) == study.misses(cheapest, shown))
        .filter(|d| study.annual_power_w(d, shown).is_some_and(|w| w <= power_w * (1.0 + ALIKE)))
        .collect();
    let words: Vec<String> = alike.iter().map(|d| equipment(&study.designs, d)).collect();
    let first = match words.as_slice() {
        _ if study.designs.len() == 1 => format!("{} is the only equipment of this study.", capital(&words[0])),
        [one] => format!("{} needs the least electricity.", capital(one)),
        _ => format!("{} need the least electricity, all the same.", capital(&words.join(" and "))),
    };
    let energy = kwh(study, cheapest, shown, power_w, 1.0);
    let mut text = format!(
        " To keep the passengers comfortable it draws {} kilowatt-hours (kWh) for every hour in service{}.",
        energy.value,
        energy.ends.as_ref().map_or_else(String::new, |[low, high]| format!(", between {low} and {high}"))
    );
    let reference = study.reference(shown).filter(|(name, _)| !alike.contains(name));
    if let Some((other, other_w)) = reference
        && let Some((saving, ends)) = study.saving(cheapest, other, shown)
    {
        let saved = sure(100.0 * saving, ends.map(|ends| ends.map(|end| 100.0 * end)), 1);
        let of_other = kwh(study, other, shown, other_w, 1.0);
        text += &format!(
            " That is {} % less{} than {}, which draws {} kWh{}.",
            saved.value,
            range(&saved),
            equipment(&study.designs, other),
            of_other.value,
            range(&of_other)
        );
    }
    vec![Span::Strong(first), Span::Value(text)]
}

fn by_kilometre_and_year(study: &StudyReport, shown: ComfortWindow, (cheapest, power_w): (&str, f64)) -> Option<Block> {
    let energy = study.energies.iter().find(|e| e.design == cheapest && e.window == shown)?;
    let mut text = String::new();
    if let Some(kwh_per_km) = energy.kwh_per_km {
        text += &format!("That makes {kwh_per_km:.3} kWh for every kilometre. ");
    }
    if let Some(hours) = energy.operating_hours_per_bus_year {
        let year = kwh(study, cheapest, shown, power_w, hours);
        text += &format!(
            "In this study a bus is in service for {hours:.0} hours a year, which come to {} kWh{}; hours in the depot are not part of any \
             number here. ",
            year.value,
            range(&year)
        );
    }
    if study.has_intervals() {
        text += "The ranges hold nine of ten results when the days of the study are drawn anew.";
    }
    (!text.is_empty()).then(|| Block::Paragraph(vec![Span::Value(text.trim_end().to_owned())]))
}

/// Half as far from neutral as what is shown, and twice as far.
fn comfort_costs(study: &StudyReport, shown: ComfortWindow, cheapest: &str) -> Option<Block> {
    let of = |limit: f64| {
        let window = study.windows().into_iter().find(|w| w.is_plus_minus(limit))?;
        let other_w = study.annual_power_w(cheapest, window).filter(|w| *w > 0.0)?;
        let energy = kwh(study, cheapest, window, other_w, 1.0);
        let (change, ends) = study.change(cheapest, window, shown)?;
        // Less is told as such, with the smaller end first.
        let (more, sign) = if change < 0.0 { ("less", -100.0) } else { ("more", 100.0) };
        let mut ends = ends.map(|ends| ends.map(|end| sign * end));
        ends.iter_mut().for_each(|ends| ends.sort_by(f64::total_cmp));
        let change = sure(sign * change, ends, 0);
        let words = format!(
            "{} kWh for every hour in service{}, {} %{} {more}",
            energy.value,
            range(&energy),
            change.value,
            range(&change)
        );
        Some((comfort(window), words))
    };
    let (closer, wider) = (of(shown.pmv_limit() / 2.0), of(shown.pmv_limit() * 2.0));
    let text = match (closer, wider) {
        _ if !shown.is_symmetric() || shown.pmv_limit() == 0.0 => return None,
        (None, None) => return None,
        (Some((window, costs)), None) => format!(" With the vote {window}, the same equipment draws {costs}."),
        (None, Some((window, costs))) => format!(" With the vote {window}, the same equipment draws {costs}."),
        (Some((closer, costs)), Some((wider, saves))) => format!(
            " With the vote {closer}, the same equipment draws {costs}. With the vote {wider} it draws {saves}."
        ),
    };
    Some(Block::Paragraph(vec![Span::Strong("Comfort costs electricity.".to_owned()), Span::Value(text)]))
}

/// What stands beside equipment whose limits keep it from the comfort that is asked for.
const TOO_WEAK: &str = ", too weak in some hours";

/// All equipment in words.
fn compared(study: &StudyReport, shown: ComfortWindow) -> Option<Block> {
    let reference = study.reference(shown)?.0;
    let row = |d: &store::DesignRow| {
        let power_w = study.annual_power_w(&d.name, shown)?;
        let energy = kwh(study, &d.name, shown, power_w, 1.0);
        let to = |s: Sure| s.ends.map_or_else(String::new, |[low, high]| format!("{low} to {high}"));
        let saved = study.saving(&d.name, reference, shown).filter(|_| d.name != reference);
        let saved = saved.map(|(s, ends)| sure(100.0 * s, ends.map(|ends| ends.map(|end| 100.0 * end)), 1));
        let less = saved.as_ref().map_or_else(|| "–".to_owned(), |s| s.value.clone());
        let value = energy.value.clone();
        let too_weak = if study.misses(&d.name, shown) { TOO_WEAK } else { "" };
        Some(vec![
            capital(&equipment(&study.designs, &d.name)) + too_weak,
            value,
            to(energy),
            less,
            saved.map_or_else(String::new, to),
        ])
    };
    let rows: Vec<_> = study.designs.iter().filter_map(row).collect();
    let than = format!("% less than {}", equipment(&study.designs, reference));
    let numbers = ["kWh for an hour in service", "range", &than, "range"];
    (rows.len() > 1).then(|| Block::Table(Table::new("annual_average.csv", &["equipment"], &numbers, rows)))
}

/// What the numbers stand for, and what they leave out.
fn assumed(study: &StudyReport, shown: Option<ComfortWindow>) -> Vec<Prose> {
    let mut list = Vec::new();
    let samples: u64 = study.months.iter().map(|m| m.sample_count).sum();
    list.push(vec![
        Span::Value(format!("{samples} hours in service")),
        Span::Text(
            ", each with its weather, shade, passengers and open doors. The months of the year count by their days, however many hours each has.",
        ),
    ]);
    list.push(vec![Span::Text(
        "In every hour the equipment works as cheaply as it possibly can, as if the hour were known beforehand: what is best, not what a\n\
         control on board does.",
    )]);
    if shown.is_some_and(|shown| study.designs.iter().any(|d| study.misses(&d.name, shown))) {
        list.push(vec![Span::Text(
            "Equipment that is too weak in some hours leaves its passengers less comfortable in them than all others: it counts with what it\n             comes to, and is not called the cheapest. The section on limits of comfort says how many hours, and how far.",
        )]);
    }
    list.extend(controlled(study));
    list.extend(other_years(study));
    let missing = missing_names(study);
    if !missing.is_empty() {
        list.push(vec![
            Span::Strong("Months are missing".to_owned()),
            Span::Text(" ("),
            Span::Value(missing),
            Span::Text("): the annual figures stand for the other months only."),
        ]);
    }
    let refused = study.files.iter().filter(|f| !f.accepted).count();
    if refused > 0 {
        let files = if refused == 1 { "file" } else { "files" };
        list.push(vec![Span::Strong(format!("{refused} input {files} refused")), Span::Text(": see Data quality.")]);
    }
    if study.status.infeasible > 0 {
        list.push(vec![
            Span::Strong(format!("{} points have no operation", study.status.infeasible)),
            Span::Text(" that meets their comfort window; they are left out of the averages."),
        ]);
    }
    if study.status.not_converged > 0 {
        list.push(vec![
            Span::Strong(format!("{} points did not converge", study.status.not_converged)),
            Span::Text("; they are left out of the averages."),
        ]);
    }
    if !study.simulation_failures.is_empty() {
        list.push(vec![
            Span::Strong(format!("{} missions are not simulated", study.simulation_failures.len())),
            Span::Text(" with some design and window; simulation_failures.csv says why."),
        ]);
    }
    let substitutes = study.assumptions.iter().filter(|a| a.substitute).count();
    if substitutes > 0 {
        list.push(vec![
            Span::Text("Some properties of the equipment are "),
            Span::Strong("substitutes for unpublished data".to_owned()),
            Span::Value(format!(
                ", {substitutes} of {} assumptions; they are listed under “Assumptions”.",
                study.assumptions.len()
            )),
        ]);
    }
    list
}

/// What a controller that sees the present alone takes more than the optimum.
fn controlled(study: &StudyReport) -> Option<Prose> {
    let years: Vec<_> = study.control_years.iter().filter(|y| y.point.controller == "extracted").collect();
    let of_shown = study.shown_window()?;
    let point = &years.iter().rev().find(|y| y.point.window == of_shown)?.point;
    let more = 100.0 * (point.mean_hvac_power_w / point.static_mean_hvac_power_w - 1.0);
    let words = equipment(&study.designs, &point.design);
    more.is_finite().then(|| {
        vec![Span::Value(format!(
            "An automatic control that knows only the present draws {:.0} % {} with {words}, by simulation of every trip.",
            more.abs(),
            if more < 0.0 { "less" } else { "more" }
        ))]
    })
}

/// How much a single one of the recorded years matters.
fn other_years(study: &StudyReport) -> Option<Prose> {
    let shown = study.shown_window()?;
    let (cheapest, _) = study.cheapest(shown)?;
    let of = study.left_out.iter().filter(|l| l.design == cheapest && l.window == shown && l.kind == "year");
    let changes: Vec<f64> = of.map(|l| 100.0 * l.change).collect();
    let most = changes.iter().map(|c| c.abs()).fold(0.0, f64::max);
    (changes.len() > 1).then(|| {
        vec![Span::Value(format!(
            "{} recorded years. Without one of them the electricity of the cheapest equipment changes by up to {most:.1} %.",
            changes.len()
        ))]
    })
}
