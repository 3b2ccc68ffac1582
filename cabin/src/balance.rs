//! The five heat balances in steady state (paper, eq. odes with all derivatives zero).
//!
//! Given the cabin temperature and whether the radiant heaters are on, the balances fix every other temperature, and the
//! cabin's own balance then says what heat the air unit has to bring. Every Newton step eliminates the outside of the
//! shell and the heaters by hand, so that a two-by-two system is left; its matrix is an M-matrix for every positive
//! temperature, which makes the solution unique and all temperatures rise with the cabin's.

use crate::{
    Disturbances, PassengerViews, PmvModel, SolarGains, StandardRange, Vehicle, ZERO_CELSIUS_K, clothing_insulation_clo,
};

/// The state of the radiant heaters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heaters {
    /// No power; the panels take the temperature that their surroundings give them.
    Off,
    /// At their target temperature (paper, eq. rh-target).
    On,
}

/// Temperatures of the five thermal reservoirs in K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Temperatures {
    /// Cabin air.
    pub cabin_k: f64,
    /// Seats and rails.
    pub interior_k: f64,
    /// Inside of the shell.
    pub shell_inside_k: f64,
    /// Outside of the shell.
    pub shell_outside_k: f64,
    /// Radiant heaters.
    pub radiant_heater_k: f64,
}

/// How the settled temperatures change with the cabin temperature, in K/K, each between 0 and 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slopes {
    /// Of the interior.
    pub interior: f64,
    /// Of the inside of the shell.
    pub shell_inside: f64,
    /// Of the outside of the shell.
    pub shell_outside: f64,
    /// Of the radiant heaters.
    pub radiant_heater: f64,
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
            self.solar.interior_w + self.radiation_heater_interior_w
                - self.convection_interior_w
                - self.radiation_interior_shell_w,
            self.passengers_w
                + self.other_w
                + self.air_unit_w
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

    /// Every flow with its name, in the order of the fields.
    #[must_use]
    pub fn named_w(&self) -> [(&'static str, f64); 17] {
        [
            ("cabin air to shell", self.convection_shell_inside_w),
            ("interior to cabin air", self.convection_interior_w),
            ("shell to ambient air", self.convection_shell_outside_w),
            ("radiant heaters to cabin air", self.convection_radiant_heater_w),
            ("through the shell", self.conduction_shell_w),
            ("shell to surroundings (radiation)", self.radiation_shell_outside_w),
            ("radiant heaters to shell", self.radiation_heater_shell_w),
            ("radiant heaters to interior", self.radiation_heater_interior_w),
            ("interior to shell (radiation)", self.radiation_interior_shell_w),
            ("through open doors", self.door_w),
            ("passengers", self.passengers_w),
            ("electric components", self.other_w),
            ("air unit", self.air_unit_w),
            ("radiant heater power", self.radiant_heater_power_w),
            ("sun on interior", self.solar.interior_w),
            ("sun on shell inside", self.solar.shell_inside_w),
            ("sun on shell outside", self.solar.shell_outside_w),
        ]
    }
}

/// The cabin under given disturbances, with all coefficients ready.
#[derive(Debug, Clone, Copy)]
pub struct Cabin<'a> {
    ambient_k: f64,
    solar: SolarGains,
    gains_w: [f64; 2],
    /// Convection in W/K: shell inside, interior, heaters, shell outside.
    g_shell: f64,
    g_interior: f64,
    g_heater: f64,
    g_outside: f64,
    /// Conduction through the shell in W/K.
    g_conduction: f64,
    /// Radiation in W/K⁴: heaters to interior, heaters to shell, interior to shell, shell to surroundings.
    r_heater_interior: f64,
    r_heater_shell: f64,
    r_interior_shell: f64,
    r_outside: f64,
    /// Door loss in W/K^1.5 without curtain.
    door: f64,
    curtain_keeps: f64,
    curtain_power_w: f64,
    heater_target_k: f64,
    view_interior: f64,
    views: &'a PassengerViews,
    pmv: PmvModel,
    /// Surface excess in K from which convection is natural.
    kink_k: f64,
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
        let sigma = v.stefan_boltzmann_w_m2_k4;
        let ambient_k = disturbances.ambient_temperature_k;
        let air_w_k = v.air_density_kg_m3 * v.air_heat_capacity_j_kg_k;
        let exchange = v.door_discharge_coefficient
            * (v.gravity_m_s2 * v.door_height_m * v.door_height_m * v.door_height_m).sqrt()
            * v.door_width_m
            / 3.0;
        let clothing = clothing_insulation_clo(ambient_k, v.clothing_floor_clo);
        let pmv = PmvModel::new(clothing, v.metabolic_rate_met, v.relative_humidity, v.air_velocity_m_s);
        Self {
            ambient_k,
            solar,
            gains_w: [disturbances.passengers * v.passenger_heat_w, v.other_heat_w],
            g_shell: v.convection_inside_w_m2_k * v.shell_area_m2,
            g_interior: v.convection_inside_w_m2_k * v.interior_area_m2,
            g_heater: v.convection_radiant_heater_w_m2_k * v.radiant_heater_area_m2,
            g_outside: v.convection_outside_w_m2_k * v.shell_area_m2,
            g_conduction: v.conduction_shell_w_m2_k * v.shell_area_m2,
            r_heater_interior: sigma * v.radiant_heater_area_m2 * v.view_factor_heater_interior,
            r_heater_shell: sigma * v.radiant_heater_area_m2 * v.view_factor_heater_shell,
            r_interior_shell: sigma * v.interior_area_m2 * v.view_factor_interior_shell,
            r_outside: sigma * v.shell_area_m2,
            door: air_w_k * exchange / ambient_k.sqrt() * disturbances.door_open_fraction,
            curtain_keeps: 1.0 - v.air_curtain_loss_reduction,
            curtain_power_w: v.air_curtain_power_w * disturbances.door_open_fraction,
            heater_target_k: v.radiant_heater_target_k,
            view_interior: v.view_factor_passenger_interior,
            views,
            pmv,
            kink_k: pmv.natural_convection_from_k(),
        }
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

    /// A start for [`Cabin::settle`] that needs no knowledge: everything as warm as the cabin.
    #[must_use]
    pub fn rough_guess(&self, cabin_k: f64, heaters: Heaters) -> Temperatures {
        let radiant_heater_k = if heaters == Heaters::On { self.heater_target_k } else { cabin_k };
        Temperatures {
            cabin_k,
            interior_k: cabin_k,
            shell_inside_k: cabin_k,
            shell_outside_k: self.ambient_k,
            radiant_heater_k,
        }
    }

    /// All temperatures in steady state at a cabin temperature, with their slopes over it. `guess` gives the start; its
    /// cabin temperature does not count, and its heater temperature only while the heaters are off.
    ///
    /// `None` where Newton's method does not settle within 30 steps, which no physical input has been seen to cause.
    #[must_use]
    pub fn settle(&self, cabin_k: f64, heaters: Heaters, guess: &Temperatures) -> Option<(Temperatures, Slopes)> {
        let mut t = Temperatures { cabin_k, ..*guess };
        if heaters == Heaters::On {
            t.radiant_heater_k = self.heater_target_k;
        }
        for _ in 0..30 {
            let system = System::new(self, &t, heaters);
            let [heater, interior, inside, outside] = system.solve(self.surface_net_w(&t));
            t.radiant_heater_k += heater;
            t.interior_k += interior;
            t.shell_inside_k += inside;
            t.shell_outside_k += outside;
            let largest = heater.abs().max(interior.abs()).max(inside.abs()).max(outside.abs());
            // Convergence is quadratic: what a step below 1 µK leaves behind is below rounding.
            if largest < 1e-6 {
                let [radiant_heater, interior, shell_inside, shell_outside] =
                    system.solve([self.g_heater, self.g_interior, self.g_shell, 0.0]);
                return Some((t, Slopes { interior, shell_inside, shell_outside, radiant_heater }));
            }
        }
        None
    }

    /// Heat that the air unit has to bring in steady state in W (negative: take away), and its slope in W/K over the
    /// cabin temperature, which is positive.
    #[must_use]
    pub fn air_unit_heat_w(&self, t: &Temperatures, slopes: &Slopes, curtain: bool) -> (f64, f64) {
        let (door_w, door_slope) = self.door_w(t.cabin_k, curtain);
        let heat_w = self.g_shell * (t.cabin_k - t.shell_inside_k)
            + self.g_interior * (t.cabin_k - t.interior_k)
            + self.g_heater * (t.cabin_k - t.radiant_heater_k)
            + door_w
            - self.gains_w[0]
            - self.gains_w[1];
        let slope = self.g_shell * (1.0 - slopes.shell_inside)
            + self.g_interior * (1.0 - slopes.interior)
            + self.g_heater * (1.0 - slopes.radiant_heater)
            + door_slope;
        (heat_w, slope)
    }

    /// Electric power in W that holds the radiant heaters at their temperature; 0 to rounding while they are off.
    #[must_use]
    pub fn radiant_heater_power_w(&self, t: &Temperatures) -> f64 {
        let heater4 = pow4(t.radiant_heater_k);
        self.g_heater * (t.radiant_heater_k - t.cabin_k)
            + self.r_heater_interior * (heater4 - pow4(t.interior_k))
            + self.r_heater_shell * (heater4 - pow4(t.shell_inside_k))
    }

    /// Mean over the passengers of their predicted mean vote, and its slope in 1/K over the cabin temperature.
    ///
    /// By quadrature, unless some passengers stand on one side of the kink between forced and natural convection and
    /// some on the other: then over all of them. The two agree to 1e-8 where one turns into the other.
    #[must_use]
    pub fn mean_pmv(&self, t: &Temperatures, slopes: &Slopes) -> (f64, f64) {
        let [(view_a, weight_a), (view_b, weight_b)] = self.views.nodes;
        let (a, b) = (self.vote(t, slopes, view_a), self.vote(t, slopes, view_b));
        if self.kink_between_passengers([(view_a, a.2), (view_b, b.2)]) {
            let all = self.views.all();
            let (pmv, slope) = all.iter().fold((0.0, 0.0), |(pmv, slope), &view| {
                let one = self.vote(t, slopes, view);
                (pmv + one.0, slope + one.1)
            });
            return (pmv / all.len() as f64, slope / all.len() as f64);
        }
        (weight_a * a.0 + weight_b * b.0, weight_a * a.1 + weight_b * b.1)
    }

    /// Vote of a passenger, its slope in 1/K over the cabin temperature, and the excess of its clothing surface in K.
    fn vote(&self, t: &Temperatures, slopes: &Slopes, view: f64) -> (f64, f64, f64) {
        let radiant_k = self.mean_radiant_k(t, view);
        let point = self.pmv.at(t.cabin_k - ZERO_CELSIUS_K, radiant_k - ZERO_CELSIUS_K);
        let view_shell = 1.0 - self.view_interior - view;
        let cube = |k: f64| k * k * k;
        let radiant_slope = (view * cube(t.radiant_heater_k) * slopes.radiant_heater
            + view_shell * cube(t.shell_inside_k) * slopes.shell_inside
            + self.view_interior * cube(t.interior_k) * slopes.interior)
            / cube(radiant_k);
        (point.pmv, point.per_air_k + point.per_radiant_k * radiant_slope, point.surface_excess_k)
    }

    /// Whether natural convection starts between the least and the largest view factor, judged from the surface excess
    /// at two view factors along a straight line, with a tenth of the range to spare.
    fn kink_between_passengers(&self, [(view_a, excess_a), (view_b, excess_b)]: [(f64, f64); 2]) -> bool {
        let [least, largest] = self.views.range;
        let spare = 0.1 * (largest - least);
        if view_b <= view_a {
            return false;
        }
        let per_view = (excess_b - excess_a) / (view_b - view_a);
        let at = |view: f64| excess_a + per_view * (view - view_a);
        let (p, q) = (at(least - spare), at(largest + spare));
        let inside = |kink_k: f64| p.min(q) < kink_k && kink_k < p.max(q);
        inside(self.kink_k) || inside(-self.kink_k)
    }

    /// The vote of one passenger with the given view factor to the radiant heaters.
    #[must_use]
    pub fn passenger_pmv(&self, t: &Temperatures, view: f64) -> f64 {
        self.pmv.at(t.cabin_k - ZERO_CELSIUS_K, self.mean_radiant_k(t, view) - ZERO_CELSIUS_K).pmv
    }

    /// Mean radiant temperature of the average passenger in K (paper, section 2.2).
    #[must_use]
    pub fn mean_radiant_temperature_k(&self, t: &Temperatures) -> f64 {
        self.mean_radiant_k(t, self.views.mean())
    }

    /// Whether the average passenger's state lies in the range of use of ISO 7730.
    #[must_use]
    pub fn standard_range(&self, t: &Temperatures, pmv: f64) -> StandardRange {
        let radiant_k = self.mean_radiant_temperature_k(t);
        self.pmv.standard_range(t.cabin_k - ZERO_CELSIUS_K, radiant_k - ZERO_CELSIUS_K, pmv)
    }

    /// Every heat flow at the given temperatures, with the given air unit heat and heater power in W.
    #[must_use]
    pub fn flows(&self, t: &Temperatures, curtain: bool, air_unit_w: f64, radiant_heater_power_w: f64) -> HeatFlows {
        let [heater4, interior4, shell4] = [t.radiant_heater_k, t.interior_k, t.shell_inside_k].map(pow4);
        HeatFlows {
            convection_shell_inside_w: self.g_shell * (t.cabin_k - t.shell_inside_k),
            convection_interior_w: self.g_interior * (t.interior_k - t.cabin_k),
            convection_shell_outside_w: self.g_outside * (t.shell_outside_k - self.ambient_k),
            convection_radiant_heater_w: self.g_heater * (t.radiant_heater_k - t.cabin_k),
            conduction_shell_w: self.g_conduction * (t.shell_inside_k - t.shell_outside_k),
            radiation_shell_outside_w: self.r_outside * (pow4(t.shell_outside_k) - pow4(self.ambient_k)),
            radiation_heater_shell_w: self.r_heater_shell * (heater4 - shell4),
            radiation_heater_interior_w: self.r_heater_interior * (heater4 - interior4),
            radiation_interior_shell_w: self.r_interior_shell * (interior4 - shell4),
            door_w: self.door_w(t.cabin_k, curtain).0,
            passengers_w: self.gains_w[0],
            other_w: self.gains_w[1],
            air_unit_w,
            radiant_heater_power_w,
            solar: self.solar,
        }
    }

    /// Door loss in W (eq. qdoor, exact square root) and its slope in W/K.
    fn door_w(&self, cabin_k: f64, curtain: bool) -> (f64, f64) {
        let difference = cabin_k - self.ambient_k;
        let kept = if curtain { self.curtain_keeps } else { 1.0 };
        let conductance = self.door * kept * difference.abs().sqrt();
        (conductance * difference, 1.5 * conductance)
    }

    /// T_mr⁴ = F_rh T_rh⁴ + (1 − F_int − F_rh) T_s,i⁴ + F_int T_int⁴ (paper, section 2.2).
    fn mean_radiant_k(&self, t: &Temperatures, view: f64) -> f64 {
        let fourth = view * pow4(t.radiant_heater_k)
            + (1.0 - self.view_interior - view) * pow4(t.shell_inside_k)
            + self.view_interior * pow4(t.interior_k);
        fourth.sqrt().sqrt()
    }

    /// Net heat into heaters (without their power), interior, inside and outside of the shell in W.
    fn surface_net_w(&self, t: &Temperatures) -> [f64; 4] {
        let [heater4, interior4, shell4] = [t.radiant_heater_k, t.interior_k, t.shell_inside_k].map(pow4);
        let heater_interior = self.r_heater_interior * (heater4 - interior4);
        let heater_shell = self.r_heater_shell * (heater4 - shell4);
        let interior_shell = self.r_interior_shell * (interior4 - shell4);
        let conduction = self.g_conduction * (t.shell_inside_k - t.shell_outside_k);
        [
            self.g_heater * (t.cabin_k - t.radiant_heater_k) - heater_interior - heater_shell,
            self.solar.interior_w + heater_interior + self.g_interior * (t.cabin_k - t.interior_k) - interior_shell,
            self.g_shell * (t.cabin_k - t.shell_inside_k) + self.solar.shell_inside_w + heater_shell + interior_shell
                - conduction,
            conduction + self.solar.shell_outside_w
                - self.g_outside * (t.shell_outside_k - self.ambient_k)
                - self.r_outside * (pow4(t.shell_outside_k) - pow4(self.ambient_k)),
        ]
    }
}

fn pow4(k: f64) -> f64 {
    let square = k * k;
    square * square
}

/// The balances of the four surfaces, linearised: what change of the temperatures takes up given net heats?
struct System {
    /// Radiation slopes in W/K: how much more a flow becomes when its source, or less when its target, warms by 1 K.
    interior_from_heater: f64,
    interior_to_heater: f64,
    shell_from_heater: f64,
    shell_to_heater: f64,
    /// 1/total slope of the heaters; 0 while they are held at their target.
    heater_inverse: f64,
    g_conduction: f64,
    outside_inverse: f64,
    matrix: [f64; 4],
    determinant_inverse: f64,
}

impl System {
    fn new(cabin: &Cabin<'_>, t: &Temperatures, heaters: Heaters) -> Self {
        let slope = |r: f64, k: f64| 4.0 * r * k * k * k;
        let interior_from_heater = slope(cabin.r_heater_interior, t.radiant_heater_k);
        let interior_to_heater = slope(cabin.r_heater_interior, t.interior_k);
        let shell_from_heater = slope(cabin.r_heater_shell, t.radiant_heater_k);
        let shell_to_heater = slope(cabin.r_heater_shell, t.shell_inside_k);
        let shell_from_interior = slope(cabin.r_interior_shell, t.interior_k);
        let interior_from_shell = slope(cabin.r_interior_shell, t.shell_inside_k);
        let heater_inverse = match heaters {
            Heaters::On => 0.0,
            Heaters::Off => 1.0 / (cabin.g_heater + interior_from_heater + shell_from_heater),
        };
        let outside = cabin.g_conduction + cabin.g_outside + slope(cabin.r_outside, t.shell_outside_k);
        let outside_inverse = 1.0 / outside;
        let m11 = cabin.g_interior + interior_to_heater + shell_from_interior
            - interior_from_heater * interior_to_heater * heater_inverse;
        let m12 = -(interior_from_shell + interior_from_heater * shell_to_heater * heater_inverse);
        let m21 = -(shell_from_interior + shell_from_heater * interior_to_heater * heater_inverse);
        let m22 = cabin.g_shell + shell_to_heater + interior_from_shell + cabin.g_conduction
            - shell_from_heater * shell_to_heater * heater_inverse
            - cabin.g_conduction * cabin.g_conduction * outside_inverse;
        Self {
            interior_from_heater,
            interior_to_heater,
            shell_from_heater,
            shell_to_heater,
            heater_inverse,
            g_conduction: cabin.g_conduction,
            outside_inverse,
            matrix: [m11, m12, m21, m22],
            determinant_inverse: 1.0 / (m11 * m22 - m12 * m21),
        }
    }

    /// Changes of heaters, interior, inside and outside of the shell in K that take up the given heats in W.
    fn solve(&self, [heater, interior, inside, outside]: [f64; 4]) -> [f64; 4] {
        let [m11, m12, m21, m22] = self.matrix;
        let heater_step = heater * self.heater_inverse;
        let q1 = interior + self.interior_from_heater * heater_step;
        let q2 = inside + self.shell_from_heater * heater_step + self.g_conduction * outside * self.outside_inverse;
        let d_interior = (m22 * q1 - m12 * q2) * self.determinant_inverse;
        let d_inside = (m11 * q2 - m21 * q1) * self.determinant_inverse;
        let d_outside = (outside + self.g_conduction * d_inside) * self.outside_inverse;
        let d_heater =
            (heater + self.interior_to_heater * d_interior + self.shell_to_heater * d_inside) * self.heater_inverse;
        [d_heater, d_interior, d_inside, d_outside]
    }
}
