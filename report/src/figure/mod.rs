//! Figures as SVG: pure functions of what they show, all drawn by one engine for one column of print.
//!
//! `chart` draws whatever has axes, `heat_flow` the flows of one operation; `palette` says which colour means what.

mod axis;
mod canvas;
mod chart;
mod heat_flow;
mod marks;
pub(crate) mod palette;
mod values;

pub(crate) use axis::{Axis, Ticks};
pub(crate) use canvas::{Form, coordinate};
pub(crate) use chart::{Chart, Panel, chart_drawn};
pub use heat_flow::{HeatFlowFigure, heat_flow_svg};
pub(crate) use heat_flow::{drawn as heat_flow_drawn, values as heat_flow_values};
pub(crate) use marks::{Mark, Side};
pub(crate) use values::{ValueRow, ValueTable, all_values, value_tables};
