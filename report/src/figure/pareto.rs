//! Pareto fronts: annual power over the comfort that is asked for, and power of single missions over the comfort reached.

use kuva::backend::svg::SvgBackend;
use kuva::plot::legend::LegendPosition;
use kuva::plot::scatter::MarkerShape;
use kuva::plot::{LinePlot, LineStyle, ScatterPlot};
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;

use store::DesignRow;

use crate::StudyReport;

/// The IBM palette, which stays apart for colour-blind eyes; markers and dashes keep the lines apart in grey.
const COLOURS: [&str; 5] = ["#648fff", "#dc267f", "#ffb000", "#785ef0", "#fe6100"];
const MARKERS: [MarkerShape; 5] =
    [MarkerShape::Circle, MarkerShape::Square, MarkerShape::Triangle, MarkerShape::Diamond, MarkerShape::TriangleDown];
const DASHES: [&str; 4] = ["", "6 3", "2 2", "8 3 2 3"];

/// A line of the figure, with a marker at each point; a single point is a marker.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Front {
    /// Name in the legend.
    pub name: String,
    /// Dashes as in SVG; empty for a solid line.
    pub dash: &'static str,
    /// Comfort and power in kW, in the order of the line.
    pub points: Vec<(f64, f64)>,
}

/// What stands around a figure.
pub(crate) struct Axes {
    pub title: &'static str,
    pub x: &'static str,
    pub y: &'static str,
    /// Step of the end of the first axis.
    pub x_step: f64,
    /// For screen readers.
    pub told: &'static str,
}

/// Fronts and points in one picture.
pub(crate) fn fronts_svg(fronts: &[Front], axes: &Axes) -> String {
    let mut plots = Vec::new();
    for (i, front) in fronts.iter().enumerate().filter(|(_, front)| !front.points.is_empty()) {
        let colour = COLOURS[i % COLOURS.len()];
        // With more fronts than colours, the same colour comes with another marker.
        let marker = MARKERS[(i + i / COLOURS.len()) % MARKERS.len()];
        let style = if front.dash.is_empty() { LineStyle::Solid } else { LineStyle::Custom(front.dash.to_owned()) };
        if front.points.len() > 1 {
            let line = LinePlot::new().with_data(front.points.clone()).with_color(colour);
            plots.push(Plot::Line(line.with_stroke_width(1.8).with_line_style(style)));
        }
        let markers = ScatterPlot::new().with_data(front.points.clone()).with_color(colour).with_size(4.0);
        plots.push(Plot::Scatter(markers.with_marker(marker).with_legend(&front.name)));
    }
    let most = |of: fn(&(f64, f64)) -> f64| fronts.iter().flat_map(|f| &f.points).map(of).fold(0.0, f64::max);
    let x_max = (most(|p| p.0) / axes.x_step).ceil().max(1.0) * axes.x_step;
    let legend =
        if fronts.len() > COLOURS.len() { LegendPosition::OutsideRightTop } else { LegendPosition::InsideTopRight };
    draw(plots, axes, [x_max, most(|p| p.1).ceil().max(1.0)], legend)
}

/// Symmetric windows only; unequal ones have no place on the axis.
pub(crate) fn pareto_svg(study: &StudyReport) -> String {
    let front = |(i, design): (usize, &DesignRow)| {
        let of = study.annual.iter().filter(|r| r.design == design.name && r.window.is_symmetric());
        let mut points: Vec<(f64, f64)> =
            of.filter_map(|r| Some((r.window.pmv_limit(), r.hvac_power_w? / 1000.0))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Front { name: design.name.clone(), dash: DASHES[i % DASHES.len()], points }
    };
    let fronts: Vec<Front> = study.designs.iter().enumerate().map(front).collect();
    if fronts.iter().all(|f| f.points.is_empty()) {
        return EMPTY.to_owned();
    }
    let axes = Axes {
        title: "Annual mean HVAC power over the comfort that is asked for",
        x: "limit of |PMV|",
        y: "annual mean HVAC power in kW",
        x_step: 0.25,
        told: "Pareto fronts: annual mean HVAC power in kW over the limit of the predicted mean vote",
    };
    fronts_svg(&fronts, &axes)
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
    let front = |(mission, simulated): &(&str, bool)| {
        let of = |p: &&ParetoPoint| p.mission == *mission && p.simulated == *simulated;
        let way = if *simulated { "simulated" } else { "steady state" };
        Front {
            name: format!("{mission}, {way}"),
            dash: if *simulated { "" } else { DASHES[1] },
            points: points.iter().filter(of).map(|p| (p.max_abs_pmv, p.power_kw)).collect(),
        }
    };
    let axes = Axes {
        title: "Simulated missions beside their steady-state optima",
        x: "largest |PMV| (simulated: 15-minute mean)",
        y: "mean HVAC power in kW",
        x_step: 0.25,
        told: "Mean HVAC power in kW over the largest predicted mean vote of missions, simulated and in steady state",
    };
    fronts_svg(&names.iter().map(front).collect::<Vec<_>>(), &axes)
}

fn draw(plots: Vec<Plot>, axes: &Axes, [x_max, y_max]: [f64; 2], legend: LegendPosition) -> String {
    let layout = Layout::auto_from_plots(&plots)
        .with_width(720.0)
        .with_height(440.0)
        .with_title(axes.title)
        .with_x_label(axes.x)
        .with_y_label(axes.y)
        .with_x_axis_min(0.0)
        .with_x_axis_max(x_max)
        .with_y_axis_min(0.0)
        .with_y_axis_max(y_max)
        .with_x_tick_format(TickFormat::Fixed(if axes.x_step < 1.0 { 2 } else { 0 }))
        .with_title_size(15)
        .with_label_size(13)
        .with_tick_size(11)
        .with_body_size(12)
        .with_legend_position(legend)
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
