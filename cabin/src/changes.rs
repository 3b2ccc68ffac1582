//! How the heat flows change with the temperature of the cabin air: a column of the derivative of [`Cabin::flows_abreast`].

use crate::{Cabin, Real};

impl Cabin<'_> {
    /// How much more heat leaves through the doors for each kelvin of the cabin, in W/K; `door_loss_share` is
    /// [`Cabin::door_loss_share`] of each bus.
    #[must_use]
    #[inline(always)]
    pub fn door_slope_w_k<R: Real>(&self, cabin_k: R, door_loss_share: R) -> R {
        self.door_conductance_w_k(cabin_k, door_loss_share) * 1.5
    }

    /// What a change of the cabin air in K changes in the net heats of [`crate::HeatFlows::net_w`] in W, at a slope of the doors.
    #[must_use]
    #[inline(always)]
    pub fn changes_with_air_w<R: Real>(&self, change_k: R, door_slope_w_k: R) -> [R; 5] {
        let [heater, interior, inside] = [self.g_heater, self.g_interior, self.g_shell].map(|g| change_k * g);
        let cabin = -(heater + interior + inside + door_slope_w_k * change_k);
        [heater, interior, cabin, inside, R::splat(0.0)]
    }
}

#[cfg(test)]
mod tests {
    use crate::{Cabin, Disturbances, PassengerViews, Temperatures, Vehicle, kelvin};

    #[test]
    fn prop_changes_are_the_differences_of_the_flows() {
        let vehicle = Vehicle::default();
        let views = PassengerViews::new(&vehicle);
        let d = Disturbances {
            ambient_temperature_k: kelvin(-3.0),
            dni_w_m2: 120.0,
            dhi_w_m2: 60.0,
            solar_altitude_rad: 0.4,
            shadow_fraction: 0.3,
            passengers: 20.0,
            door_open_fraction: 0.4,
        };
        let cabin = Cabin::new(&vehicle, &views, &d);
        let at = |change_k: f64| Temperatures {
            cabin_k: kelvin(19.0) + change_k,
            interior_k: kelvin(17.0),
            shell_inside_k: kelvin(11.0),
            shell_outside_k: kelvin(1.0),
            radiant_heater_k: kelvin(50.0),
        };
        let by = 1e-3;
        let slope = cabin.door_slope_w_k(at(0.0).cabin_k, cabin.door_loss_share(true));
        let changes = cabin.changes_with_air_w(by, slope);
        let flows = |cabin_k: f64| cabin.flows(&at(cabin_k), true, 1000.0, 500.0).net_w();
        let (above, below) = (flows(by), flows(-by));
        for i in 0..5 {
            let difference = 0.5 * (above[i] - below[i]);
            assert!((changes[i] - difference).abs() < 1e-8, "{i}: {} {difference}", changes[i]);
        }
    }
}
