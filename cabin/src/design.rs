//! What HVAC equipment a bus has.

use crate::{Cop, Devices, PowerLimit};

/// How the air is heated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heating {
    /// Electric resistance elements, COP 1.
    Ptc,
    /// Heat pump.
    HeatPump,
}

impl Heating {
    /// The word in study files and in the database.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ptc => "ptc",
            Self::HeatPump => "hp",
        }
    }

    /// The heating of a word.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Ptc, Self::HeatPump].into_iter().find(|h| h.name() == name)
    }
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
    /// The devices on board.
    pub devices: Devices,
    /// What the air unit can give in heating; `None` without a limit.
    pub heating_limit: Option<PowerLimit>,
    /// What it can take away in cooling.
    pub cooling_limit: Option<PowerLimit>,
    /// A resistive heater behind the air unit, which helps where that is not enough, in W; 0 where there is none.
    pub backup_heater_w: f64,
}

impl Design {
    /// Whether its air unit has a limit, or a back-up heater for where it has.
    #[must_use]
    pub fn is_limited(&self) -> bool {
        self.heating_limit.is_some() || self.cooling_limit.is_some() || self.backup_heater_w > 0.0
    }

    /// Whether another design has the same air unit: COP, limits and back-up heater.
    #[must_use]
    pub fn has_air_unit_of(&self, other: &Self) -> bool {
        self.heating_cop == other.heating_cop
            && self.cooling_cop == other.cooling_cop
            && self.heating_limit == other.heating_limit
            && self.cooling_limit == other.cooling_limit
            && self.backup_heater_w == other.backup_heater_w
    }
}
