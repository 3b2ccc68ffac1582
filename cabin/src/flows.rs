//! Temperatures and heat flows of the five thermal reservoirs.

use crate::SolarGains;

/// Temperatures of the five thermal reservoirs in K; of one bus, or of several abreast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Temperatures<R = f64> {
    /// Cabin air.
    pub cabin_k: R,
    /// Seats and rails.
    pub interior_k: R,
    /// Inside of the shell.
    pub shell_inside_k: R,
    /// Outside of the shell.
    pub shell_outside_k: R,
    /// Radiant heaters.
    pub radiant_heater_k: R,
}

/// How the settled temperatures change with the cabin temperature, in K/K, each between 0 and 1; of one bus, or of several
/// abreast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slopes<R = f64> {
    /// Of the interior.
    pub interior: R,
    /// Of the inside of the shell.
    pub shell_inside: R,
    /// Of the outside of the shell.
    pub shell_outside: R,
    /// Of the radiant heaters.
    pub radiant_heater: R,
}

/// Every heat flow of the model in W, positive in the direction of the paper's equations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatFlows {
    /// Cabin air to the inside of the shell, Q_conv,s,i.
    pub convection_shell_inside_w: f64,
    /// Interior to cabin air, Q_conv,int.
    pub convection_interior_w: f64,
    /// Outside of the shell to ambient air, Q_conv,s,o.
    pub convection_shell_outside_w: f64,
    /// Radiant heaters to cabin air, Q_conv,rh.
    pub convection_radiant_heater_w: f64,
    /// Through the shell, outwards, Q_cond.
    pub conduction_shell_w: f64,
    /// Outside of the shell to its surroundings, Q_rad,s,o.
    pub radiation_shell_outside_w: f64,
    /// Radiant heaters to shell, Q_rad,rh,s.
    pub radiation_heater_shell_w: f64,
    /// Radiant heaters to interior, Q_rad,rh,int.
    pub radiation_heater_interior_w: f64,
    /// Interior to shell, Q_rad,int,s.
    pub radiation_interior_shell_w: f64,
    /// Through open doors, outwards, Q_door (eq. qdoor).
    pub door_w: f64,
    /// From passengers, Q_pass (eq. metabolic-heat).
    pub passengers_w: f64,
    /// From lights, screens and electric components, Q_other.
    pub other_w: f64,
    /// From the air unit, Q_hc; negative when cooling.
    pub air_unit_w: f64,
    /// Electric power of the radiant heaters, P_rh.
    pub radiant_heater_power_w: f64,
    /// From the sun.
    pub solar: SolarGains,
}

impl HeatFlows {
    /// Net heat into each reservoir in W: heaters, interior, cabin, inside and outside of the shell; zero in steady
    /// state (eq. odes).
    #[must_use]
    pub fn net_w(&self) -> [f64; 5] {
        [
            self.radiant_heater_power_w
                - self.convection_radiant_heater_w
                - self.radiation_heater_interior_w
                - self.radiation_heater_shell_w,
            self.radiation_heater_interior_w + self.solar.interior_w
                - self.convection_interior_w
                - self.radiation_interior_shell_w,
            self.air_unit_w
                + (self.passengers_w + self.other_w)
                + self.convection_radiant_heater_w
                + self.convection_interior_w
                - self.convection_shell_inside_w
                - self.door_w,
            self.convection_shell_inside_w
                + self.solar.shell_inside_w
                + self.radiation_heater_shell_w
                + self.radiation_interior_shell_w
                - self.conduction_shell_w,
            self.conduction_shell_w + self.solar.shell_outside_w
                - self.convection_shell_outside_w
                - self.radiation_shell_outside_w,
        ]
    }

    /// No heat anywhere.
    pub const ZERO: Self = Self {
        convection_shell_inside_w: 0.0,
        convection_interior_w: 0.0,
        convection_shell_outside_w: 0.0,
        convection_radiant_heater_w: 0.0,
        conduction_shell_w: 0.0,
        radiation_shell_outside_w: 0.0,
        radiation_heater_shell_w: 0.0,
        radiation_heater_interior_w: 0.0,
        radiation_interior_shell_w: 0.0,
        door_w: 0.0,
        passengers_w: 0.0,
        other_w: 0.0,
        air_unit_w: 0.0,
        radiant_heater_power_w: 0.0,
        solar: SolarGains { interior_w: 0.0, shell_inside_w: 0.0, shell_outside_w: 0.0 },
    };

    /// Flow by flow: `self` and so many times `other`.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        let sum = |a: f64, b: f64| a + factor * b;
        Self {
            convection_shell_inside_w: sum(self.convection_shell_inside_w, other.convection_shell_inside_w),
            convection_interior_w: sum(self.convection_interior_w, other.convection_interior_w),
            convection_shell_outside_w: sum(self.convection_shell_outside_w, other.convection_shell_outside_w),
            convection_radiant_heater_w: sum(self.convection_radiant_heater_w, other.convection_radiant_heater_w),
            conduction_shell_w: sum(self.conduction_shell_w, other.conduction_shell_w),
            radiation_shell_outside_w: sum(self.radiation_shell_outside_w, other.radiation_shell_outside_w),
            radiation_heater_shell_w: sum(self.radiation_heater_shell_w, other.radiation_heater_shell_w),
            radiation_heater_interior_w: sum(self.radiation_heater_interior_w, other.radiation_heater_interior_w),
            radiation_interior_shell_w: sum(self.radiation_interior_shell_w, other.radiation_interior_shell_w),
            door_w: sum(self.door_w, other.door_w),
            passengers_w: sum(self.passengers_w, other.passengers_w),
            other_w: sum(self.other_w, other.other_w),
            air_unit_w: sum(self.air_unit_w, other.air_unit_w),
            radiant_heater_power_w: sum(self.radiant_heater_power_w, other.radiant_heater_power_w),
            solar: SolarGains {
                interior_w: sum(self.solar.interior_w, other.solar.interior_w),
                shell_inside_w: sum(self.solar.shell_inside_w, other.solar.shell_inside_w),
                shell_outside_w: sum(self.solar.shell_outside_w, other.solar.shell_outside_w),
            },
        }
    }

    /// Every flow with the name of its column in the database and its name in words, in the order of the fields.
    #[must_use]
    pub fn named_w(&self) -> [(&'static str, &'static str, f64); 17] {
        [
            ("cabin_to_shell_w", "cabin air to shell", self.convection_shell_inside_w),
            ("interior_to_cabin_w", "interior to cabin air", self.convection_interior_w),
            ("shell_to_ambient_w", "shell to ambient air", self.convection_shell_outside_w),
            ("heater_to_cabin_w", "radiant heaters to cabin air", self.convection_radiant_heater_w),
            ("through_shell_w", "through the shell", self.conduction_shell_w),
            ("shell_radiation_w", "shell to surroundings (radiation)", self.radiation_shell_outside_w),
            ("heater_to_shell_w", "radiant heaters to shell", self.radiation_heater_shell_w),
            ("heater_to_interior_w", "radiant heaters to interior", self.radiation_heater_interior_w),
            ("interior_to_shell_w", "interior to shell (radiation)", self.radiation_interior_shell_w),
            ("door_w", "through open doors", self.door_w),
            ("passengers_w", "passengers", self.passengers_w),
            ("other_w", "electric components", self.other_w),
            ("air_unit_heat_w", "air unit", self.air_unit_w),
            ("radiant_heater_power_w", "radiant heater power", self.radiant_heater_power_w),
            ("solar_interior_w", "sun on interior", self.solar.interior_w),
            ("solar_shell_inside_w", "sun on shell inside", self.solar.shell_inside_w),
            ("solar_shell_outside_w", "sun on shell outside", self.solar.shell_outside_w),
        ]
    }
}
