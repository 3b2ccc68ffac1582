//! Figures as SVG: pure functions of what they show.

mod clouds;
mod heat_flow;
mod panels;
mod pareto;

pub(crate) use clouds::{CloudFigure, CloudPanel, PointCloud, clouds_svg};
pub use heat_flow::{HeatFlowFigure, heat_flow_svg};
pub use panels::{Curve, Panel, PanelFigure, panels_svg};
pub(crate) use pareto::{Axes, Front, fronts_svg, pareto_svg};
pub use pareto::{ParetoPoint, simulated_pareto_svg};
