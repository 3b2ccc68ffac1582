//! What an air unit can give, and what a back-up heater adds to it.

use crate::{Design, OperatingMode};

/// What a limit is a limit of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LimitOf {
    /// Electric power that goes into the unit.
    Electric,
    /// Heat that it brings or takes away.
    Thermal,
}

/// A limit of the air unit over the ambient temperature, linear between its rows and constant beyond them.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerLimit {
    of: LimitOf,
    /// Ambient temperature in K and limit in W.
    rows: Vec<(f64, f64)>,
}

/// A table that is no limit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PowerLimitError {
    /// No rows.
    #[error("the table is empty; give at least one pair [ambient temperature in °C, limit in W]")]
    Empty,
    /// A limit below 0 or no number, or a temperature that is none.
    #[error("row {row} is [{ambient_c}, {limit_w}]; the temperature must be a number and the limit one from 0 on")]
    Value {
        /// Row, from 1.
        row: usize,
        /// Ambient temperature in °C.
        ambient_c: f64,
        /// Limit in W.
        limit_w: f64,
    },
    /// The temperatures do not rise.
    #[error("row {row}: {ambient_c} °C is not above the row before; sort by temperature")]
    Order {
        /// Row, from 1.
        row: usize,
        /// Ambient temperature in °C.
        ambient_c: f64,
    },
}

impl PowerLimit {
    /// The same limit at every ambient temperature, in W from 0 on.
    ///
    /// # Errors
    /// [`PowerLimitError::Value`].
    pub fn constant(of: LimitOf, limit_w: f64) -> Result<Self, PowerLimitError> {
        Self::table(of, &[(0.0, limit_w)])
    }

    /// A table of `(ambient temperature in °C, limit in W)`, sorted by temperature.
    ///
    /// # Errors
    /// [`PowerLimitError`].
    pub fn table(of: LimitOf, rows: &[(f64, f64)]) -> Result<Self, PowerLimitError> {
        if rows.is_empty() {
            return Err(PowerLimitError::Empty);
        }
        for (i, &(ambient_c, limit_w)) in rows.iter().enumerate() {
            let row = i + 1;
            if !(ambient_c.is_finite() && limit_w.is_finite() && limit_w >= 0.0) {
                return Err(PowerLimitError::Value { row, ambient_c, limit_w });
            }
            if i > 0 && ambient_c <= rows[i - 1].0 {
                return Err(PowerLimitError::Order { row, ambient_c });
            }
        }
        Ok(Self { of, rows: rows.iter().map(|(ambient_c, limit_w)| (crate::kelvin(*ambient_c), *limit_w)).collect() })
    }

    /// The largest electric power in W that it lets in at any temperature; `None` of a limit of heat.
    #[must_use]
    pub fn most_electric_w(&self) -> Option<f64> {
        let most_w = self.rows.iter().map(|(_, limit_w)| *limit_w).fold(0.0, f64::max);
        (self.of == LimitOf::Electric).then_some(most_w)
    }

    /// The limit in W at an ambient temperature in K.
    #[must_use]
    pub fn at_w(&self, ambient_k: f64) -> f64 {
        let after = self.rows.partition_point(|(k, _)| *k <= ambient_k);
        match (after.checked_sub(1).map(|i| self.rows[i]), self.rows.get(after)) {
            (Some((x0, y0)), Some(&(x1, y1))) => y0 + (y1 - y0) * (ambient_k - x0) / (x1 - x0),
            (Some((_, y)), None) => y,
            (None, _) => self.rows[0].1,
        }
    }

    /// The heat in W that it allows at an ambient temperature in K and a COP.
    fn heat_w(&self, ambient_k: f64, cop: f64) -> f64 {
        match self.of {
            LimitOf::Thermal => self.at_w(ambient_k),
            LimitOf::Electric => self.at_w(ambient_k) * cop,
        }
    }
}

/// What brings the heat that is asked for, the cheaper source first, and what is left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Supply {
    /// Electric power of the unit in W, its back-up heater included.
    pub power_w: f64,
    /// Of that, what the back-up heater takes.
    pub backup_w: f64,
    /// Heat in W that nothing can bring or take away, 0 or more.
    pub unmet_w: f64,
}

impl Design {
    /// The COP of the unit in a mode, and what limits it; `None` where it is off.
    #[inline]
    fn unit(&self, mode: OperatingMode, lift_k: f64) -> Option<(f64, Option<&PowerLimit>)> {
        match mode {
            OperatingMode::Heating => Some((self.heating_cop.at(lift_k), self.heating_limit.as_ref())),
            OperatingMode::Cooling => Some((self.cooling_cop.at(lift_k), self.cooling_limit.as_ref())),
            OperatingMode::Passive => None,
        }
    }

    /// Heat in W that the back-up heater can bring.
    fn most_backup_w(&self, mode: OperatingMode) -> f64 {
        if mode == OperatingMode::Heating { self.backup_heater_w } else { 0.0 }
    }

    /// All that unit and back-up heater can give at most, in W of heat, at an ambient temperature in K and the mode's lift in
    /// K; infinite without a limit. The heat of cooling is what is taken away.
    #[must_use]
    pub fn capacity_w(&self, mode: OperatingMode, ambient_k: f64, lift_k: f64) -> f64 {
        let Some((cop, Some(limit))) = self.unit(mode, lift_k) else { return f64::INFINITY };
        limit.heat_w(ambient_k, cop) + self.most_backup_w(mode)
    }

    /// What brings `heat_w` (its absolute value in cooling) at an ambient temperature in K and the mode's lift in K: the
    /// unit at its COP and the back-up heater at 1, the cheaper one first.
    #[must_use]
    #[inline]
    pub fn supply(&self, mode: OperatingMode, heat_w: f64, ambient_k: f64, lift_k: f64) -> Supply {
        let Some((cop, limit)) = self.unit(mode, lift_k) else {
            return Supply { power_w: 0.0, backup_w: 0.0, unmet_w: 0.0 };
        };
        let most_w = limit.map_or(f64::INFINITY, |limit| limit.heat_w(ambient_k, cop));
        if heat_w <= most_w && cop >= 1.0 {
            return Supply { power_w: heat_w / cop, backup_w: 0.0, unmet_w: 0.0 };
        }
        let most_backup_w = self.most_backup_w(mode);
        let (unit_w, backup_w) = if cop >= 1.0 {
            let unit_w = heat_w.min(most_w);
            (unit_w, (heat_w - unit_w).min(most_backup_w))
        } else {
            let backup_w = heat_w.min(most_backup_w);
            ((heat_w - backup_w).min(most_w), backup_w)
        };
        // What is left of a difference of large numbers is rounding.
        let unmet_w = heat_w - unit_w - backup_w;
        let unmet_w = if unmet_w > 1e-6 * heat_w { unmet_w } else { 0.0 };
        Supply { power_w: unit_w / cop + backup_w, backup_w, unmet_w }
    }
}
