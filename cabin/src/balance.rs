//! The five heat balances in steady state (paper, eq. odes with all derivatives zero).
//!
//! Given the cabin temperature and whether the radiant heaters are on, the balances fix every other temperature, and the
//! cabin's own balance then says what heat the air unit has to bring. Linearised, the outside of the shell and the heaters
//! are eliminated by hand, so that a two-by-two system is left; its matrix is an M-matrix for every positive
//! temperature, which makes the solution unique and all temperatures rise with the cabin's.

use crate::{
    Disturbances, HeatFlows, HeatTransfer, PassengerViews, PmvModel, Real, Slopes, SolarGains, Temperatures, Vehicle,
    clothing_insulation_clo,
};

/// The state of the radiant heaters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heaters {
    /// No power; the panels take the temperature that their surroundings give them.
    Off,
    /// At their target temperature (paper, eq. rh-target).
    On,
}

impl Heaters {
    /// 1 where they are held at their target, 0 where they are off.
    pub(crate) fn held(self) -> f64 {
        match self {
            Self::Off => 0.0,
            Self::On => 1.0,
        }
    }
}

/// The cabin under given disturbances, with all coefficients ready.
#[derive(Debug, Clone, Copy)]
pub struct Cabin<'a> {
    pub(crate) ambient_k: f64,
    pub(crate) solar: SolarGains,
    pub(crate) gains_w: [f64; 2],
    /// Convection in W/K: shell inside, interior, heaters, shell outside.
    pub(crate) g_shell: f64,
    pub(crate) g_interior: f64,
    pub(crate) g_heater: f64,
    pub(crate) g_outside: f64,
    /// Conduction through the shell in W/K.
    pub(crate) g_conduction: f64,
    /// Radiation in W/K⁴: heaters to interior, heaters to shell, interior to shell, shell to surroundings.
    pub(crate) r_heater_interior: f64,
    pub(crate) r_heater_shell: f64,
    pub(crate) r_interior_shell: f64,
    pub(crate) r_outside: f64,
    /// What the outside of the shell gets from sun and surroundings in W, less what it gives at 0 K.
    pub(crate) outside_w: f64,
    passenger_heat_w: f64,
    /// Door loss in W/K^1.5 without curtain, with all doors open and as they are.
    door_all_open: f64,
    door: f64,
    curtain_keeps: f64,
    curtain_power_all_open_w: f64,
    curtain_power_w: f64,
    pub(crate) heater_target_k: f64,
    pub(crate) view_interior: f64,
    pub(crate) views: &'a PassengerViews,
    pub(crate) pmv: PmvModel,
}

impl<'a> Cabin<'a> {
    /// The cabin of a vehicle under the given disturbances, seen by the given passengers.
    #[must_use]
    pub fn new(vehicle: &Vehicle, views: &'a PassengerViews, disturbances: &Disturbances) -> Self {
        Self::with_solar_gains(vehicle, views, disturbances, SolarGains::new(vehicle, disturbances))
    }

    /// As [`Cabin::new`], with the solar gains given instead of computed from the irradiance.
    #[must_use]
    pub fn with_solar_gains(
        vehicle: &Vehicle,
        views: &'a PassengerViews,
        disturbances: &Disturbances,
        solar: SolarGains,
    ) -> Self {
        let v = vehicle;
        let transfer = HeatTransfer::of(v);
        let ambient_k = disturbances.ambient_temperature_k;
        let door_all_open = v.door_loss_w_k15(ambient_k);
        let clothing = clothing_insulation_clo(ambient_k, v.clothing_floor_clo);
        let pmv = PmvModel::new(clothing, v.metabolic_rate_met, v.relative_humidity, v.air_velocity_m_s);
        Self {
            ambient_k,
            solar,
            gains_w: [disturbances.passengers * v.passenger_heat_w, v.other_heat_w],
            g_shell: transfer.convection_shell_inside_w_k,
            g_interior: transfer.convection_interior_w_k,
            g_heater: transfer.convection_radiant_heater_w_k,
            g_outside: transfer.convection_shell_outside_w_k,
            g_conduction: transfer.conduction_shell_w_k,
            r_heater_interior: transfer.radiation_heater_interior_w_k4,
            r_heater_shell: transfer.radiation_heater_shell_w_k4,
            r_interior_shell: transfer.radiation_interior_shell_w_k4,
            r_outside: transfer.radiation_shell_outside_w_k4,
            outside_w: solar.shell_outside_w
                + transfer.convection_shell_outside_w_k * ambient_k
                + transfer.radiation_shell_outside_w_k4 * pow4(ambient_k),
            passenger_heat_w: v.passenger_heat_w,
            door_all_open,
            door: door_all_open * disturbances.door_open_fraction,
            curtain_keeps: 1.0 - v.air_curtain_loss_reduction,
            curtain_power_all_open_w: v.air_curtain_power_w,
            curtain_power_w: v.air_curtain_power_w * disturbances.door_open_fraction,
            heater_target_k: v.radiant_heater_target_k,
            view_interior: v.view_factor_passenger_interior,
            views,
            pmv,
        }
    }

    /// The same cabin with other passengers on board and another fraction of the doors open.
    #[must_use]
    #[inline]
    pub fn with_load(mut self, passengers: f64, door_open_fraction: f64) -> Self {
        self.gains_w[0] = passengers * self.passenger_heat_w;
        self.door = self.door_all_open * door_open_fraction;
        self.curtain_power_w = self.curtain_power_all_open_w * door_open_fraction;
        self
    }

    /// Ambient temperature in K.
    #[must_use]
    pub fn ambient_k(&self) -> f64 {
        self.ambient_k
    }

    /// Power of the air curtains in W: that of the blowers at the doors that are open.
    #[must_use]
    pub fn air_curtain_power_w(&self) -> f64 {
        self.curtain_power_w
    }

    /// Heat that the air unit has to bring in steady state in W (negative: take away), and its slope in W/K over the
    /// cabin temperature, which is positive.
    #[must_use]
    pub fn air_unit_heat_w(&self, t: &Temperatures, slopes: &Slopes, curtain: bool) -> (f64, f64) {
        self.air_unit_heat_abreast_w(t, slopes, self.door_loss_share(curtain))
    }

    /// As [`Cabin::air_unit_heat_w`], for one bus or several; `door_loss_share` is [`Cabin::door_loss_share`] of each.
    #[must_use]
    #[inline(always)]
    pub fn air_unit_heat_abreast_w<R: Real>(
        &self,
        t: &Temperatures<R>,
        slopes: &Slopes<R>,
        door_loss_share: R,
    ) -> (R, R) {
        let door_w_k = self.door_conductance_w_k(t.cabin_k, door_loss_share);
        let mut heat_w = door_w_k.mul_add(t.cabin_k - self.ambient_k, -(self.gains_w[0] + self.gains_w[1]));
        let mut slope = door_w_k * 1.5;
        for (surface_k, follows, conductance) in [
            (t.radiant_heater_k, slopes.radiant_heater, self.g_heater),
            (t.interior_k, slopes.interior, self.g_interior),
            (t.shell_inside_k, slopes.shell_inside, self.g_shell),
        ] {
            heat_w = (t.cabin_k - surface_k).mul_add(conductance, heat_w);
            slope = (R::splat(1.0) - follows).mul_add(conductance, slope);
        }
        (heat_w, slope)
    }

    /// Electric power in W that holds the radiant heaters at their temperature; 0 to rounding while they are off.
    #[must_use]
    #[inline(always)]
    pub fn radiant_heater_power_w<R: Real>(&self, t: &Temperatures<R>) -> R {
        let heater4 = pow4(t.radiant_heater_k);
        let shell_w = (heater4 - pow4(t.shell_inside_k)) * self.r_heater_shell;
        let radiation_w = (heater4 - pow4(t.interior_k)).mul_add(self.r_heater_interior, shell_w);
        (t.radiant_heater_k - t.cabin_k).mul_add(self.g_heater, radiation_w)
    }

    /// Every heat flow at the given temperatures, with the given air unit heat and heater power in W.
    #[must_use]
    #[inline]
    pub fn flows(&self, t: &Temperatures, curtain: bool, air_unit_w: f64, radiant_heater_power_w: f64) -> HeatFlows {
        let [heater4, interior4, shell4] = [t.radiant_heater_k, t.interior_k, t.shell_inside_k].map(pow4);
        HeatFlows {
            convection_shell_inside_w: (t.cabin_k - t.shell_inside_k) * self.g_shell,
            convection_interior_w: (t.interior_k - t.cabin_k) * self.g_interior,
            convection_shell_outside_w: (t.shell_outside_k - self.ambient_k) * self.g_outside,
            convection_radiant_heater_w: (t.radiant_heater_k - t.cabin_k) * self.g_heater,
            conduction_shell_w: (t.shell_inside_k - t.shell_outside_k) * self.g_conduction,
            radiation_shell_outside_w: (pow4(t.shell_outside_k) - pow4(self.ambient_k)) * self.r_outside,
            radiation_heater_shell_w: (heater4 - shell4) * self.r_heater_shell,
            radiation_heater_interior_w: (heater4 - interior4) * self.r_heater_interior,
            radiation_interior_shell_w: (interior4 - shell4) * self.r_interior_shell,
            door_w: self.door_conductance_w_k(t.cabin_k, self.door_loss_share(curtain)) * (t.cabin_k - self.ambient_k),
            passengers_w: self.gains_w[0],
            other_w: self.gains_w[1],
            air_unit_w,
            radiant_heater_power_w,
            solar: self.solar,
        }
    }

    /// The share of the door loss that is left with or without air curtains.
    #[must_use]
    #[inline]
    pub fn door_loss_share(&self, curtain: bool) -> f64 {
        if curtain { self.curtain_keeps } else { 1.0 }
    }

    /// Door loss for each kelvin between cabin and ambient air, in W/K (eq. qdoor, exact square root). The loss's slope over the
    /// cabin temperature is half as much again.
    #[inline(always)]
    pub(crate) fn door_conductance_w_k<R: Real>(&self, cabin_k: R, door_loss_share: R) -> R {
        door_loss_share * self.door * (cabin_k - self.ambient_k).abs().sqrt()
    }

    /// The surfaces where their balances hold to first order about the given temperatures, with the cabin as warm as it is; and
    /// how they follow it. `cubes` are the third powers of heaters, interior, inside and outside of the shell.
    ///
    /// A flow r (a⁴ − b⁴) is to first order 4 r (a³ a' − b³ b') less three times itself, which gives the new temperatures
    /// themselves, not their changes: convection is linear in them and need not be known. `held` is 1 where the heaters are held
    /// at their temperature, 0 where they are off.
    #[inline(always)]
    pub(crate) fn balanced<R: Real>(
        &self,
        t: &Temperatures<R>,
        [heater3, interior3, inside3, outside3]: [R; 4],
        held: R,
    ) -> (Temperatures<R>, Slopes<R>) {
        let (r_hi, r_hs, r_is) = (4.0 * self.r_heater_interior, 4.0 * self.r_heater_shell, 4.0 * self.r_interior_shell);
        // Slopes of the radiation in W/K over its source and its target, and three times the flow.
        let (hi_source, hi_target) = (heater3 * r_hi, interior3 * r_hi);
        let (hs_source, hs_target) = (heater3 * r_hs, inside3 * r_hs);
        let (is_source, is_target) = (interior3 * r_is, inside3 * r_is);
        let outward = outside3 * (4.0 * self.r_outside);
        let hi_w = hi_source.mul_add(t.radiant_heater_k, -hi_target * t.interior_k) * 0.75;
        let hs_w = hs_source.mul_add(t.radiant_heater_k, -hs_target * t.shell_inside_k) * 0.75;
        let is_w = is_source.mul_add(t.interior_k, -is_target * t.shell_inside_k) * 0.75;

        // The heaters follow interior and inside of the shell, or are held at their target.
        let (half, one) = (R::splat(0.5), R::splat(1.0));
        let free_inverse = one / (hi_source + hs_source + self.g_heater);
        let free_k = t.cabin_k.mul_add(self.g_heater, hi_w + hs_w) * free_inverse;
        let heater_inverse = held.above(half, R::splat(0.0), free_inverse);
        let heater_k = held.above(half, t.radiant_heater_k, free_k);
        let (per_interior, per_inside) = (hi_target * heater_inverse, hs_target * heater_inverse);
        let per_cabin = heater_inverse * self.g_heater;
        // The outside of the shell follows its inside.
        let outside_inverse = one / (outward + (self.g_conduction + self.g_outside));
        let outside_k = (outward * 0.75).mul_add(t.shell_outside_k, self.outside_w) * outside_inverse;
        let outside_per_inside = outside_inverse * self.g_conduction;

        // What is left for interior and inside of the shell: a two-by-two system.
        let interior_own = hi_source.mul_add(-per_interior, hi_target + is_source + self.g_interior);
        let interior_other = hi_source.mul_add(per_inside, is_target);
        let inside_own = hs_target + is_target + (self.g_shell + self.g_conduction);
        let inside_own = outside_per_inside.mul_add(-self.g_conduction, hs_source.mul_add(-per_inside, inside_own));
        let inside_other = hs_source.mul_add(per_interior, is_source);
        let inverse = one / interior_own.mul_add(inside_own, -interior_other * inside_other);
        let solve = |interior: R, inside: R| {
            let interior_times = inside_own.mul_add(interior, interior_other * inside);
            (interior_times * inverse, interior_own.mul_add(inside, inside_other * interior) * inverse)
        };
        let interior_w = t.cabin_k.mul_add(self.g_interior, is_w - hi_w + self.solar.interior_w);
        let inside_w = t.cabin_k.mul_add(self.g_shell, R::splat(self.solar.shell_inside_w) - hs_w - is_w);
        let (interior_k, shell_inside_k) = solve(
            hi_source.mul_add(heater_k, interior_w),
            outside_k.mul_add(self.g_conduction, hs_source.mul_add(heater_k, inside_w)),
        );
        let (interior, shell_inside) =
            solve(hi_source.mul_add(per_cabin, self.g_interior), hs_source.mul_add(per_cabin, self.g_shell));
        let temperatures = Temperatures {
            cabin_k: t.cabin_k,
            interior_k,
            shell_inside_k,
            shell_outside_k: outside_per_inside.mul_add(shell_inside_k, outside_k),
            radiant_heater_k: per_inside.mul_add(shell_inside_k, per_interior.mul_add(interior_k, heater_k)),
        };
        let slopes = Slopes {
            interior,
            shell_inside,
            shell_outside: outside_per_inside * shell_inside,
            radiant_heater: per_inside.mul_add(shell_inside, per_interior.mul_add(interior, per_cabin)),
        };
        (temperatures, slopes)
    }
}

/// Fourth power of a temperature.
#[inline(always)]
pub(crate) fn pow4<R: Real>(k: R) -> R {
    let square = k * k;
    square * square
}
