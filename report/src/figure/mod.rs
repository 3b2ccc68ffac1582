//! Figures as SVG: pure functions of what they show, all drawn by one engine for one column of print.
//!
//! `chart` draws whatever has two axes, `bars` what many things do to a quantity, `heat_flow` the flows of one operation;
//! `palette` says which colour means what.

mod axis;
mod bars;
mod canvas;
mod chart;
mod heat_flow;
mod marks;
pub(crate) mod palette;
mod values;

pub(crate) use axis::{Axis, Ticks};
pub(crate) use bars::{Bar, Bars};
pub(crate) use bars::{all_values as bar_values, drawn as bars_drawn, value_table as bar_table};
pub(crate) use canvas::{Form, coordinate};
pub(crate) use chart::{Chart, Panel, chart_drawn};
pub use heat_flow::{HeatFlowFigure, heat_flow_svg};
pub(crate) use heat_flow::{drawn as heat_flow_drawn, values as heat_flow_values};
pub(crate) use marks::{Mark, Side};
pub(crate) use values::{ValueRow, ValueTable, all_values, value_tables};
