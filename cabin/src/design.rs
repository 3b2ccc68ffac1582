//! What HVAC equipment a bus has.

use crate::Cop;

/// How the air is heated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heating {
    /// Electric resistance elements, COP 1.
    Ptc,
    /// Heat pump.
    HeatPump,
}

/// One HVAC design. Every design has air conditioning.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// Name, unique in a study.
    pub name: String,
    /// How the air is heated.
    pub heating: Heating,
    /// COP in heating over the lift `T_cab − T_amb`.
    pub heating_cop: Cop,
    /// COP in cooling over the lift `T_amb − T_cab`.
    pub cooling_cop: Cop,
    /// Whether radiant heaters are on board.
    pub radiant_heaters: bool,
    /// Whether air curtains are on board.
    pub air_curtain: bool,
}
