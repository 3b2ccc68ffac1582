//! Pareto fronts: annual power over the comfort that is asked for, and power of single missions over the comfort reached.

use kuva::backend::svg::SvgBackend;
use kuva::plot::legend::LegendPosition;
use kuva::plot::scatter::MarkerShape;
use kuva::plot::{LinePlot, LineStyle, ScatterPlot};
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;

use crate::StudyReport;

/// The IBM palette, which stays apart for colour-blind eyes; markers and dashes keep the lines apart in grey.
const COLOURS: [&str; 5] = ["#648fff", "#dc267f", "#ffb000", "#785ef0", "#fe6100"];
const MARKERS: [MarkerShape; 5] =
    [MarkerShape::Circle, MarkerShape::Square, MarkerShape::Triangle, MarkerShape::Diamond, MarkerShape::TriangleDown];
const DASHES: [&str; 4] = ["", "6 3", "2 2", "8 3 2 3"];

/// Symmetric windows only; unequal ones have no place on the axis.
pub(crate) fn pareto_svg(study: &StudyReport) -> String {
    let mut plots = Vec::new();
    let mut largest_kw = 0.0_f64;
    let mut largest_limit = 0.0_f64;
    for (i, design) in study.designs.iter().enumerate() {
        let mut points: Vec<(f64, f64)> = study
            .annual
            .iter()
            .filter(|r| r.design == design.name && r.window.is_symmetric())
            .filter_map(|r| Some((r.window.pmv_limit(), r.hvac_power_w? / 1000.0)))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if points.is_empty() {
            continue;
        }
        for (limit, kilowatt) in &points {
            largest_kw = largest_kw.max(*kilowatt);
            largest_limit = largest_limit.max(*limit);
        }
        let colour = COLOURS[i % COLOURS.len()];
        let dash = DASHES[i % DASHES.len()];
        let style = if dash.is_empty() { LineStyle::Solid } else { LineStyle::Custom(dash.to_owned()) };
        let line =
            LinePlot::new().with_data(points.clone()).with_color(colour).with_stroke_width(1.8).with_line_style(style);
        let markers = ScatterPlot::new()
            .with_data(points)
            .with_color(colour)
            .with_size(4.0)
            .with_marker(MARKERS[i % MARKERS.len()])
            .with_legend(&design.name);
        plots.extend([Plot::Line(line), Plot::Scatter(markers)]);
    }
    if plots.is_empty() {
        return EMPTY.to_owned();
    }
    let axes = Axes {
        title: "Annual mean HVAC power over the comfort that is asked for",
        x: "limit of |PMV|",
        y: "annual mean HVAC power in kW",
        x_max: (largest_limit * 4.0).ceil().max(1.0) / 4.0,
        y_max: largest_kw.ceil().max(1.0),
        told: "Pareto fronts: annual mean HVAC power in kW over the limit of the predicted mean vote",
    };
    draw(plots, &axes)
}

/// One mission with one comfort window, simulated or in steady state.
#[derive(Debug, Clone, PartialEq)]
pub struct ParetoPoint {
    /// Name of the mission in the legend.
    pub mission: String,
    /// Whether it is simulated; else in steady state.
    pub simulated: bool,
    /// Largest absolute vote; of a simulation the largest 15-minute mean.
    pub max_abs_pmv: f64,
    /// Mean power in kW.
    pub power_kw: f64,
}

/// Mean power over the comfort that is reached, simulated and in steady state (paper, figure `dynamic-comparison-pareto`).
#[must_use]
pub fn simulated_pareto_svg(points: &[ParetoPoint]) -> String {
    let mut names: Vec<(&str, bool)> = Vec::new();
    for p in points {
        if !names.contains(&(&p.mission, p.simulated)) {
            names.push((&p.mission, p.simulated));
        }
    }
    let mut plots = Vec::new();
    for (i, (mission, simulated)) in names.iter().enumerate() {
        let of = |p: &&ParetoPoint| p.mission == *mission && p.simulated == *simulated;
        let line: Vec<(f64, f64)> = points.iter().filter(of).map(|p| (p.max_abs_pmv, p.power_kw)).collect();
        let style = if *simulated { LineStyle::Solid } else { LineStyle::Custom("6 3".to_owned()) };
        let colour = COLOURS[i % COLOURS.len()];
        let way = if *simulated { "simulated" } else { "steady state" };
        let curve =
            LinePlot::new().with_data(line.clone()).with_color(colour).with_stroke_width(1.8).with_line_style(style);
        let markers = ScatterPlot::new()
            .with_data(line)
            .with_color(colour)
            .with_size(4.0)
            .with_marker(MARKERS[i % MARKERS.len()])
            .with_legend(format!("{mission}, {way}"));
        plots.extend([Plot::Line(curve), Plot::Scatter(markers)]);
    }
    let most = |f: fn(&ParetoPoint) -> f64| points.iter().map(f).fold(0.0, f64::max);
    let axes = Axes {
        title: "Simulated missions beside their steady-state optima",
        x: "largest |PMV| (simulated: 15-minute mean)",
        y: "mean HVAC power in kW",
        x_max: (most(|p| p.max_abs_pmv) * 4.0).ceil().max(1.0) / 4.0,
        y_max: most(|p| p.power_kw).ceil().max(1.0),
        told: "Mean HVAC power in kW over the largest predicted mean vote of missions, simulated and in steady state",
    };
    draw(plots, &axes)
}

/// What stands around a plot.
struct Axes {
    title: &'static str,
    x: &'static str,
    y: &'static str,
    x_max: f64,
    y_max: f64,
    /// For screen readers.
    told: &'static str,
}

fn draw(plots: Vec<Plot>, axes: &Axes) -> String {
    let layout = Layout::auto_from_plots(&plots)
        .with_width(720.0)
        .with_height(440.0)
        .with_title(axes.title)
        .with_x_label(axes.x)
        .with_y_label(axes.y)
        .with_x_axis_min(0.0)
        .with_x_axis_max(axes.x_max)
        .with_y_axis_min(0.0)
        .with_y_axis_max(axes.y_max)
        .with_x_tick_format(TickFormat::Fixed(2))
        .with_title_size(15)
        .with_label_size(13)
        .with_tick_size(11)
        .with_body_size(12)
        .with_legend_position(LegendPosition::InsideTopRight)
        .with_font_family("Helvetica, Arial, sans-serif");
    let svg = SvgBackend::default().render_scene(&render_multiple(plots, layout));
    finish(&svg, axes.told)
}

/// Gives the figure a title for screen readers. The library numbers clip paths through the whole process; here they get
/// a name that is always the same.
fn finish(svg: &str, told: &str) -> String {
    let clip = svg.split_once("<clipPath id=\"").and_then(|(_, rest)| rest.split_once('"')).map(|(id, _)| id);
    let svg = clip.map_or_else(|| svg.to_owned(), |id| svg.replace(id, "plot-area"));
    match svg.split_once('>') {
        Some((head, rest)) => format!("{head}><title>{told}</title>{rest}\n"),
        None => svg,
    }
}

const EMPTY: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 480 40\" width=\"480\" height=\"40\">\
<title>No Pareto front</title><text x=\"8\" y=\"26\" font-family=\"Helvetica, Arial, sans-serif\">No symmetric comfort \
window is solved: there is no front to show.</text></svg>\n";
