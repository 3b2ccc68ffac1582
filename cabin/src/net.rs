//! The net heats of the reservoirs, of several buses abreast, and how they change with the temperature of the cabin air: a column
//! of their derivative.

use crate::balance::pow4;
use crate::{Cabin, Real, Temperatures};

impl Cabin<'_> {
    /// Net heat into each reservoir in W, as [`crate::HeatFlows::net_w`] has it (paper, eq. odes), but each flow added where it
    /// arrives and taken where it comes from at once. Heat of the air unit and power of the radiant heaters in W;
    /// `door_loss_share` is [`Cabin::door_loss_share`] of each bus.
    #[must_use]
    #[inline(always)]
    pub fn net_w<R: Real>(
        &self,
        t: &Temperatures<R>,
        door_loss_share: R,
        air_unit_w: R,
        radiant_heater_power_w: R,
    ) -> [R; 5] {
        let mut heater_w = radiant_heater_power_w;
        let mut interior_w = R::splat(self.solar.interior_w);
        let mut cabin_w = R::splat(self.gains_w[0] + self.gains_w[1]);
        let mut inside_w = R::splat(self.solar.shell_inside_w);
        // The outside of the shell with its surroundings.
        let mut outside_w = t.shell_outside_k.mul_add(-self.g_outside, self.outside_w);
        outside_w = pow4(t.shell_outside_k).mul_add(-self.r_outside, outside_w);

        let flow = |difference: R, conductance: f64, from_w: &mut R, to_w: &mut R| {
            *from_w = difference.mul_add(-conductance, *from_w);
            *to_w = difference.mul_add(conductance, *to_w);
        };
        flow(t.radiant_heater_k - t.cabin_k, self.g_heater, &mut heater_w, &mut cabin_w);
        flow(t.interior_k - t.cabin_k, self.g_interior, &mut interior_w, &mut cabin_w);
        flow(t.cabin_k - t.shell_inside_k, self.g_shell, &mut cabin_w, &mut inside_w);
        flow(t.shell_inside_k - t.shell_outside_k, self.g_conduction, &mut inside_w, &mut outside_w);
        let [heater4, interior4, inside4] = [t.radiant_heater_k, t.interior_k, t.shell_inside_k].map(pow4);
        flow(heater4 - interior4, self.r_heater_interior, &mut heater_w, &mut interior_w);
        flow(heater4 - inside4, self.r_heater_shell, &mut heater_w, &mut inside_w);
        flow(interior4 - inside4, self.r_interior_shell, &mut interior_w, &mut inside_w);
        let door_w_k = self.door_conductance_w_k(t.cabin_k, door_loss_share);
        cabin_w = (t.cabin_k - self.ambient_k).mul_add(-door_w_k, cabin_w);
        // Last, since it is known last.
        [heater_w, interior_w, cabin_w + air_unit_w, inside_w, outside_w]
    }

    /// How much more heat leaves through the doors for each kelvin of the cabin, in W/K; `door_loss_share` is
    /// [`Cabin::door_loss_share`] of each bus.
    #[must_use]
    #[inline(always)]
    pub fn door_slope_w_k<R: Real>(&self, cabin_k: R, door_loss_share: R) -> R {
        self.door_conductance_w_k(cabin_k, door_loss_share) * 1.5
    }

    /// How the net heats of heaters, interior, cabin and inside of the shell change for each kelvin of the cabin air, in W/K, at a
    /// slope of the doors. That of the outside of the shell does not.
    #[must_use]
    #[inline(always)]
    pub fn net_per_air_w_k<R: Real>(&self, door_slope_w_k: R) -> [R; 4] {
        let [heater, interior, inside] = [self.g_heater, self.g_interior, self.g_shell];
        [R::splat(heater), R::splat(interior), -(door_slope_w_k + (heater + interior + inside)), R::splat(inside)]
    }
}

#[cfg(test)]
mod tests {
    use crate::{Cabin, Disturbances, PassengerViews, Temperatures, Vehicle, kelvin};

    #[test]
    fn prop_net_heats_are_those_of_the_flows_and_changes_their_differences() {
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
        let [heater, interior, air, inside] =
            cabin.net_per_air_w_k(cabin.door_slope_w_k(at(0.0).cabin_k, cabin.door_loss_share(true)));
        let slopes_w_k = [heater, interior, air, inside, 0.0];
        let net_w = |cabin_k: f64| cabin.net_w(&at(cabin_k), cabin.door_loss_share(true), 1000.0, 500.0);
        let (above, below) = (net_w(by), net_w(-by));
        let flows = cabin.flows(&at(by), true, 1000.0, 500.0);
        for (net_w, of_flows_w) in above.into_iter().zip(flows.net_w()) {
            assert!((net_w - of_flows_w).abs() < 1e-9, "{net_w} {of_flows_w}");
        }
        for i in 0..5 {
            let difference = 0.5 * (above[i] - below[i]);
            assert!((slopes_w_k[i] * by - difference).abs() < 1e-8, "{i}: {} {difference}", slopes_w_k[i] * by);
        }
    }
}
