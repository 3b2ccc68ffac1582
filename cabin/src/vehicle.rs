//! The constants of a bus.

use serde::{Deserialize, Serialize};

/// Every constant of the model, by name; [`Vehicle::default`] is the bus of the paper (section "Model Constants").
///
/// Values marked *substitute* are not printed in the paper.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Vehicle {
    /// Cabin length in m.
    pub cabin_length_m: f64,
    /// Cabin width in m.
    pub cabin_width_m: f64,
    /// Cabin height in m.
    pub cabin_height_m: f64,
    /// Total shell area A_s in m².
    pub shell_area_m2: f64,
    /// Area of seats and rails A_int in m².
    pub interior_area_m2: f64,
    /// Area of all radiant heaters A_rh in m².
    pub radiant_heater_area_m2: f64,
    /// Roof area in m².
    pub roof_area_m2: f64,
    /// Area of all walls in m².
    pub wall_area_m2: f64,
    /// Convection at the inside of the shell and at the interior h_in in W/(m² K).
    pub convection_inside_w_m2_k: f64,
    /// Convection at the outside of the shell h_out in W/(m² K).
    pub convection_outside_w_m2_k: f64,
    /// Convection at the radiant heaters h_rh in W/(m² K).
    pub convection_radiant_heater_w_m2_k: f64,
    /// Conduction through the shell k in W/(m² K).
    pub conduction_shell_w_m2_k: f64,
    /// View factor from radiant heaters to interior.
    pub view_factor_heater_interior: f64,
    /// View factor from radiant heaters to shell.
    pub view_factor_heater_shell: f64,
    /// View factor from interior to shell.
    pub view_factor_interior_shell: f64,
    /// View factor from each passenger surface to the interior.
    pub view_factor_passenger_interior: f64,
    /// Height of the doors in m.
    pub door_height_m: f64,
    /// Combined width of all doors in m.
    pub door_width_m: f64,
    /// Discharge coefficient of the door model C_d.
    pub door_discharge_coefficient: f64,
    /// Density of air in kg/m³.
    pub air_density_kg_m3: f64,
    /// Specific heat capacity of air in J/(kg K).
    pub air_heat_capacity_j_kg_k: f64,
    /// Gravitational acceleration in m/s².
    pub gravity_m_s2: f64,
    /// Stefan-Boltzmann constant in W/(m² K⁴), as rounded in the paper.
    pub stefan_boltzmann_w_m2_k4: f64,
    /// Power of the air curtains with all doors open in W.
    pub air_curtain_power_w: f64,
    /// Share of the door loss that the air curtains save.
    pub air_curtain_loss_reduction: f64,
    /// Heat of one passenger in W.
    pub passenger_heat_w: f64,
    /// Heat of electric components, lights and screens Q_other in W (*substitute*: the 1.0 kW of the paper's figures).
    pub other_heat_w: f64,
    /// Temperature of the radiant heaters when on, in K.
    pub radiant_heater_target_k: f64,
    /// Solar absorptivity of the shell.
    pub shell_absorptivity: f64,
    /// Solar transmissivity of the windows.
    pub window_transmissivity: f64,
    /// Share of the transmitted sun that the interior absorbs.
    pub interior_solar_fraction: f64,
    /// Share of the roof covered by components.
    pub roof_coverage_fraction: f64,
    /// Share of the walls that is window.
    pub window_fraction: f64,
    /// Air velocity in the cabin in m/s.
    pub air_velocity_m_s: f64,
    /// Relative humidity in the cabin, 0 … 1.
    pub relative_humidity: f64,
    /// Metabolic rate of a passenger in met (1 met = 58.15 W/m², ISO 7730).
    pub metabolic_rate_met: f64,
    /// Least clothing insulation in clo (*substitute*: the floor of the paper's clothing figure).
    pub clothing_floor_clo: f64,
    /// Width and depth of a passenger in m.
    pub passenger_width_m: f64,
    /// Height of a passenger in m.
    pub passenger_height_m: f64,
    /// How many passengers are placed for the mean comfort, at least 50 (*substitute*: the paper's number is not known).
    pub passenger_placements: u32,
    /// Seed of the placement (*substitute*).
    pub passenger_seed: u64,
    /// Rows of ceiling panels along the bus (*substitute*; rows × columns = 16 in the paper).
    pub panel_rows: u32,
    /// Columns of ceiling panels across the bus (*substitute*).
    pub panel_columns: u32,
    /// Extent of a panel along the bus in m (*substitute*).
    pub panel_length_m: f64,
    /// Extent of a panel across the bus in m (*substitute*).
    pub panel_width_m: f64,
}

impl Default for Vehicle {
    fn default() -> Self {
        Self {
            cabin_length_m: 18.7,
            cabin_width_m: 2.6,
            cabin_height_m: 2.4,
            shell_area_m2: 199.5,
            interior_area_m2: 20.0,
            radiant_heater_area_m2: 4.0,
            roof_area_m2: 48.6,
            wall_area_m2: 102.2,
            convection_inside_w_m2_k: 8.01,
            convection_outside_w_m2_k: 20.67,
            convection_radiant_heater_w_m2_k: 2.1,
            conduction_shell_w_m2_k: 6.86,
            view_factor_heater_interior: 0.30,
            view_factor_heater_shell: 0.70,
            view_factor_interior_shell: 0.94,
            view_factor_passenger_interior: 0.30,
            door_height_m: 1.95,
            door_width_m: 4.42,
            door_discharge_coefficient: 0.6,
            air_density_kg_m3: 1.25,
            air_heat_capacity_j_kg_k: 1005.0,
            gravity_m_s2: 9.81,
            stefan_boltzmann_w_m2_k4: 5.67e-8,
            air_curtain_power_w: 1020.0,
            air_curtain_loss_reduction: 0.60,
            passenger_heat_w: 125.3,
            other_heat_w: 1000.0,
            radiant_heater_target_k: 343.15,
            shell_absorptivity: 0.30,
            window_transmissivity: 0.46,
            interior_solar_fraction: 0.30,
            roof_coverage_fraction: 0.66,
            window_fraction: 0.354,
            air_velocity_m_s: 0.1,
            relative_humidity: 0.40,
            metabolic_rate_met: 1.2,
            clothing_floor_clo: 0.3,
            passenger_width_m: 0.25,
            passenger_height_m: 1.7,
            passenger_placements: 200,
            passenger_seed: 1,
            panel_rows: 8,
            panel_columns: 2,
            panel_length_m: 0.5,
            panel_width_m: 0.5,
        }
    }
}

/// A constant lies outside the range in which the model has a meaning.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} = {value}: {rule}")]
pub struct VehicleError {
    /// Name of the constant.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// What it has to satisfy.
    pub rule: &'static str,
}

impl Vehicle {
    /// What goes out through all doors open, without curtain, in W per K^1.5 of the temperature difference, at an ambient
    /// temperature in K (paper, eq. `qdoor`).
    #[must_use]
    pub fn door_loss_w_k15(&self, ambient_k: f64) -> f64 {
        let air_w_k = self.air_density_kg_m3 * self.air_heat_capacity_j_kg_k;
        let exchange = self.door_discharge_coefficient
            * (self.gravity_m_s2 * self.door_height_m * self.door_height_m * self.door_height_m).sqrt()
            * self.door_width_m
            / 3.0;
        air_w_k * exchange / ambient_k.sqrt()
    }

    /// Checks every constant against the range in which the model has a meaning.
    ///
    /// # Errors
    /// The first constant that is out of its range.
    pub fn check(&self) -> Result<(), VehicleError> {
        let positive = [
            ("cabin_length_m", self.cabin_length_m),
            ("cabin_width_m", self.cabin_width_m),
            ("cabin_height_m", self.cabin_height_m),
            ("shell_area_m2", self.shell_area_m2),
            ("interior_area_m2", self.interior_area_m2),
            ("radiant_heater_area_m2", self.radiant_heater_area_m2),
            ("convection_inside_w_m2_k", self.convection_inside_w_m2_k),
            ("convection_outside_w_m2_k", self.convection_outside_w_m2_k),
            ("convection_radiant_heater_w_m2_k", self.convection_radiant_heater_w_m2_k),
            ("conduction_shell_w_m2_k", self.conduction_shell_w_m2_k),
            ("stefan_boltzmann_w_m2_k4", self.stefan_boltzmann_w_m2_k4),
            ("air_velocity_m_s", self.air_velocity_m_s),
            ("passenger_width_m", self.passenger_width_m),
            ("passenger_height_m", self.passenger_height_m),
            ("panel_length_m", self.panel_length_m),
            ("panel_width_m", self.panel_width_m),
        ];
        let not_negative = [
            ("roof_area_m2", self.roof_area_m2),
            ("wall_area_m2", self.wall_area_m2),
            ("door_height_m", self.door_height_m),
            ("door_width_m", self.door_width_m),
            ("door_discharge_coefficient", self.door_discharge_coefficient),
            ("air_density_kg_m3", self.air_density_kg_m3),
            ("air_heat_capacity_j_kg_k", self.air_heat_capacity_j_kg_k),
            ("gravity_m_s2", self.gravity_m_s2),
            ("air_curtain_power_w", self.air_curtain_power_w),
            ("passenger_heat_w", self.passenger_heat_w),
            ("other_heat_w", self.other_heat_w),
        ];
        let fractions = [
            ("view_factor_heater_interior", self.view_factor_heater_interior),
            ("view_factor_heater_shell", self.view_factor_heater_shell),
            ("view_factor_interior_shell", self.view_factor_interior_shell),
            ("view_factor_passenger_interior", self.view_factor_passenger_interior),
            ("air_curtain_loss_reduction", self.air_curtain_loss_reduction),
            ("shell_absorptivity", self.shell_absorptivity),
            ("window_transmissivity", self.window_transmissivity),
            ("interior_solar_fraction", self.interior_solar_fraction),
            ("roof_coverage_fraction", self.roof_coverage_fraction),
            ("window_fraction", self.window_fraction),
            ("relative_humidity", self.relative_humidity),
        ];
        let error = |name, value, rule| Err(VehicleError { name, value, rule });
        for (name, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return error(name, value, "must be a number above 0");
            }
        }
        for (name, value) in not_negative {
            if !(value.is_finite() && value >= 0.0) {
                return error(name, value, "must be a number, 0 or above");
            }
        }
        for (name, value) in fractions {
            if !(0.0..=1.0).contains(&value) {
                return error(name, value, "must lie between 0 and 1");
            }
        }
        if !(323.15..=423.15).contains(&self.radiant_heater_target_k) {
            let rule = "must lie between 323.15 and 423.15 K (70 °C are 343.15 K)";
            return error("radiant_heater_target_k", self.radiant_heater_target_k, rule);
        }
        if !(0.8..=4.0).contains(&self.metabolic_rate_met) {
            return error("metabolic_rate_met", self.metabolic_rate_met, "ISO 7730 covers 0.8 to 4 met");
        }
        if !(0.0..=2.0).contains(&self.clothing_floor_clo) {
            return error("clothing_floor_clo", self.clothing_floor_clo, "ISO 7730 covers 0 to 2 clo");
        }
        if self.passenger_placements < 50 {
            let value = f64::from(self.passenger_placements);
            return error("passenger_placements", value, "at least 50 passengers make a mean");
        }
        if self.panel_rows == 0 || self.panel_columns == 0 {
            return error("panel_rows", f64::from(self.panel_rows), "panel_rows and panel_columns must be 1 or more");
        }
        let fits = f64::from(self.panel_rows) * self.panel_length_m <= self.cabin_length_m
            && f64::from(self.panel_columns) * self.panel_width_m <= self.cabin_width_m;
        if !fits {
            return error("panel_length_m", self.panel_length_m, "the panels must fit on the ceiling");
        }
        if self.passenger_height_m >= self.cabin_height_m || self.passenger_width_m >= self.cabin_width_m {
            return error("passenger_height_m", self.passenger_height_m, "a passenger must fit into the cabin");
        }
        Ok(())
    }
}
