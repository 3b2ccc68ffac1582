//! The nonlinear program of one sample, design, window and choice of heaters and curtain.
//!
//! Temperatures in K, heat flows and powers in kW, so that all variables and residuals are of like size.

use cabin::{ComfortWindow, Cop, Design, Devices, Disturbances, PassengerViews, SolarGains, Vehicle};
use num_dual::{Dual2_64, DualNum};

use super::vote::{MeanVote, Vote, VoteForm};

/// How many variables the program has.
pub(crate) const N: usize = 8;
/// How many balances.
pub(crate) const BALANCES: usize = 5;

/// The variables in the order of the program (paper, section 3: all temperatures, Q_heat, Q_cool, P_rh).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum Variable {
    /// Cabin air in K.
    Cabin,
    /// Interior in K.
    Interior,
    /// Inside of the shell in K.
    ShellInside,
    /// Outside of the shell in K.
    ShellOutside,
    /// Radiant heaters in K.
    RadiantHeater,
    /// Q_heat ≥ 0 in kW.
    Heat,
    /// Q_cool ≤ 0 in kW.
    Cool,
    /// P_rh in kW.
    RadiantHeaterPower,
}

/// The square root in the door losses (eq. `qdoor`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DoorLaw {
    /// `sqrt(|T_cab − T_amb|)`.
    Exact,
    /// The paper's smooth approximation (eq. `sqrt-of-abs-approx`), with its 0.01 K².
    Smooth,
}

/// Constants of one sample that all its programs share.
#[derive(Debug, Clone)]
pub(crate) struct SampleModel<'a> {
    views: &'a PassengerViews,
    vote: Vote,
    door_law: DoorLaw,
    pub ambient_k: f64,
    solar_kw: [f64; 3],
    gains_kw: f64,
    /// Door loss in kW/K^1.5 without curtain.
    door: f64,
    curtain_keeps: f64,
    curtain_kw: f64,
    /// Convection and conduction in kW/K.
    g_shell: f64,
    g_interior: f64,
    g_heater: f64,
    g_outside: f64,
    g_conduction: f64,
    /// Radiation in kW/K⁴.
    r_heater_interior: f64,
    r_heater_shell: f64,
    r_interior_shell: f64,
    r_outside: f64,
    view_interior: f64,
    pub target_k: f64,
}

impl<'a> SampleModel<'a> {
    pub fn new(v: &Vehicle, views: &'a PassengerViews, d: &Disturbances, form: &VoteForm, door_law: DoorLaw) -> Self {
        let solar = SolarGains::new(v, d);
        let sigma_kw = v.stefan_boltzmann_w_m2_k4 / 1e3;
        let ambient_k = d.ambient_temperature_k;
        Self {
            views,
            vote: Vote::new(form, v, ambient_k),
            door_law,
            ambient_k,
            solar_kw: [solar.interior_w, solar.shell_inside_w, solar.shell_outside_w].map(|w| w / 1e3),
            gains_kw: (d.passengers * v.passenger_heat_w + v.other_heat_w) / 1e3,
            door: v.air_density_kg_m3
                * v.door_discharge_coefficient
                * (v.gravity_m_s2 * v.door_height_m.powi(3)).sqrt()
                * v.door_width_m
                / 3.0
                / ambient_k.sqrt()
                * v.air_heat_capacity_j_kg_k
                * d.door_open_fraction
                / 1e3,
            curtain_keeps: 1.0 - v.air_curtain_loss_reduction,
            curtain_kw: v.air_curtain_power_w * d.door_open_fraction / 1e3,
            g_shell: v.convection_inside_w_m2_k * v.shell_area_m2 / 1e3,
            g_interior: v.convection_inside_w_m2_k * v.interior_area_m2 / 1e3,
            g_heater: v.convection_radiant_heater_w_m2_k * v.radiant_heater_area_m2 / 1e3,
            g_outside: v.convection_outside_w_m2_k * v.shell_area_m2 / 1e3,
            g_conduction: v.conduction_shell_w_m2_k * v.shell_area_m2 / 1e3,
            r_heater_interior: sigma_kw * v.radiant_heater_area_m2 * v.view_factor_heater_interior,
            r_heater_shell: sigma_kw * v.radiant_heater_area_m2 * v.view_factor_heater_shell,
            r_interior_shell: sigma_kw * v.interior_area_m2 * v.view_factor_interior_shell,
            r_outside: sigma_kw * v.shell_area_m2,
            view_interior: v.view_factor_passenger_interior,
            target_k: v.radiant_heater_target_k,
        }
    }

    /// Door loss in kW with first and second derivative over the cabin temperature.
    fn door_kw(&self, cabin_k: f64, curtain: bool) -> Dual2_64 {
        let difference = Dual2_64::from(cabin_k).derivative() - self.ambient_k;
        let kept = self.door * if curtain { self.curtain_keeps } else { 1.0 };
        let root = match self.door_law {
            DoorLaw::Smooth => (difference * difference + 0.01).sqrt().sqrt(),
            // At no difference the law has a slope of 0 and no second derivative.
            DoorLaw::Exact if difference.re.abs() < 1e-9 => return difference * 0.0,
            DoorLaw::Exact if difference.re < 0.0 => (-difference).sqrt(),
            DoorLaw::Exact => difference.sqrt(),
        };
        root * difference * kept
    }
}

/// One program.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Problem<'a> {
    pub model: &'a SampleModel<'a>,
    pub design: &'a Design,
    pub window: ComfortWindow,
    pub devices: Devices,
}

/// Values and first derivatives at a point.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Values {
    /// Total power in kW and its gradient.
    pub power_kw: f64,
    pub power_gradient: [f64; N],
    /// Net heat into each reservoir in kW (eq. `odes`): heaters, interior, cabin, inside and outside of the shell.
    pub balances_kw: [f64; BALANCES],
    pub balance_rows: [[f64; N]; BALANCES],
    /// The mean vote and its gradient.
    pub vote: f64,
    pub vote_gradient: [f64; N],
    /// What the Hessian needs.
    mean: MeanVote,
    door_second: f64,
    per_heat: [f64; 3],
    per_cool: [f64; 3],
}

const CABIN: usize = Variable::Cabin as usize;
const INTERIOR: usize = Variable::Interior as usize;
const INSIDE: usize = Variable::ShellInside as usize;
const OUTSIDE: usize = Variable::ShellOutside as usize;
const HEATER: usize = Variable::RadiantHeater as usize;
const HEAT: usize = Variable::Heat as usize;
const COOL: usize = Variable::Cool as usize;
const POWER: usize = Variable::RadiantHeaterPower as usize;

impl Problem<'_> {
    /// The one equation that the choice of heaters adds: which variable has which value (eq. `rh-target`, `rh-req`).
    pub fn vanishing(&self) -> (usize, f64) {
        if self.devices.radiant_heaters { (HEATER, self.model.target_k) } else { (POWER, 0.0) }
    }

    pub fn values(&self, x: &[f64; N]) -> Values {
        let m = self.model;
        let mut v = Values::default();

        // Objective: eq. `relaxed-phvac`, with heaters and curtain.
        let lift = Dual2_64::from(x[CABIN]).derivative() - m.ambient_k;
        let (heat, cool) = (cop(&self.design.heating_cop, lift).recip(), cop(&self.design.cooling_cop, -lift).recip());
        v.per_heat = [heat.re, heat.v1, heat.v2];
        v.per_cool = [cool.re, cool.v1, cool.v2];
        v.power_kw = x[HEAT] * heat.re - x[COOL] * cool.re
            + x[POWER]
            + if self.devices.air_curtain { m.curtain_kw } else { 0.0 };
        v.power_gradient[CABIN] = x[HEAT] * heat.v1 - x[COOL] * cool.v1;
        v.power_gradient[HEAT] = heat.re;
        v.power_gradient[COOL] = -cool.re;
        v.power_gradient[POWER] = 1.0;

        let door = m.door_kw(x[CABIN], self.devices.air_curtain);
        v.door_second = door.v2;
        v.balances_kw[0] = x[POWER];
        v.balance_rows[0][POWER] = 1.0;
        v.balances_kw[1] = m.solar_kw[0];
        v.balances_kw[2] = m.gains_kw + x[HEAT] + x[COOL] - door.re;
        v.balance_rows[2][HEAT] = 1.0;
        v.balance_rows[2][COOL] = 1.0;
        v.balance_rows[2][CABIN] = -door.v1;
        v.balances_kw[3] = m.solar_kw[1];
        v.balances_kw[4] = m.solar_kw[2];
        for (from, to, g) in [
            ((0, HEATER), (2, CABIN), m.g_heater),
            ((1, INTERIOR), (2, CABIN), m.g_interior),
            ((2, CABIN), (3, INSIDE), m.g_shell),
            ((3, INSIDE), (4, OUTSIDE), m.g_conduction),
        ] {
            v.exchange(from, to, g * (x[from.1] - x[to.1]), g, g);
        }
        for (from, to, r) in m.radiation() {
            let (a3, b3) = (x[from.1].powi(3), x[to.1].powi(3));
            v.exchange(from, to, r * (a3 * x[from.1] - b3 * x[to.1]), 4.0 * r * a3, 4.0 * r * b3);
        }
        let outside3 = x[OUTSIDE].powi(3);
        v.balances_kw[4] -=
            m.g_outside * (x[OUTSIDE] - m.ambient_k) + m.r_outside * (outside3 * x[OUTSIDE] - m.ambient_k.powi(4));
        v.balance_rows[4][OUTSIDE] -= m.g_outside + 4.0 * m.r_outside * outside3;

        // Mean radiant temperature: T_mr⁴ = base + view · heater (paper, section 2.2).
        let fourth = |i: usize| x[i].powi(4);
        let base = (1.0 - m.view_interior) * fourth(INSIDE) + m.view_interior * fourth(INTERIOR);
        v.mean = MeanVote::new(&m.vote, m.views, x[CABIN], base, fourth(HEATER) - fourth(INSIDE));
        v.vote = v.mean.vote;
        v.vote_gradient[CABIN] = v.mean.gradient[0];
        for (i, parts) in m.vote_parts() {
            let slope = 4.0 * x[i].powi(3);
            v.vote_gradient[i] = slope * (parts[0] * v.mean.gradient[1] + parts[1] * v.mean.gradient[2]);
        }
        v
    }

    /// Hessian of the Lagrangian, with the multipliers of the balances and of the vote.
    pub fn hessian(&self, x: &[f64; N], v: &Values, balances: &[f64; BALANCES], vote: f64) -> [[f64; N]; N] {
        let m = self.model;
        let mut h = [[0.0; N]; N];
        h[CABIN][CABIN] = x[HEAT] * v.per_heat[2] - x[COOL] * v.per_cool[2] - balances[2] * v.door_second;
        (h[CABIN][HEAT], h[HEAT][CABIN]) = (v.per_heat[1], v.per_heat[1]);
        (h[CABIN][COOL], h[COOL][CABIN]) = (-v.per_cool[1], -v.per_cool[1]);
        for (from, to, r) in m.radiation() {
            let leaves = balances[to.0] - balances[from.0];
            h[from.1][from.1] += 12.0 * r * x[from.1].powi(2) * leaves;
            h[to.1][to.1] -= 12.0 * r * x[to.1].powi(2) * leaves;
        }
        h[OUTSIDE][OUTSIDE] -= 12.0 * m.r_outside * x[OUTSIDE].powi(2) * balances[4];

        let mean = &v.mean;
        h[CABIN][CABIN] += vote * mean.hessian[0][0];
        let parts = m.vote_parts();
        for (i, a) in parts {
            let slope_i = 4.0 * x[i].powi(3);
            let mixed = vote * slope_i * (a[0] * mean.hessian[0][1] + a[1] * mean.hessian[0][2]);
            h[CABIN][i] += mixed;
            h[i][CABIN] += mixed;
            h[i][i] += vote * 12.0 * x[i].powi(2) * (a[0] * mean.gradient[1] + a[1] * mean.gradient[2]);
            for (j, b) in parts {
                let slope_j = 4.0 * x[j].powi(3);
                let [[uu, uv], [vu, vv]] = mean.radiant_hessian();
                let curvature = a[0] * (b[0] * uu + b[1] * uv) + a[1] * (b[0] * vu + b[1] * vv);
                h[i][j] += vote * slope_i * slope_j * curvature;
            }
        }
        h
    }
}

/// One end of a heat flow: its balance and its variable.
type End = (usize, usize);

impl SampleModel<'_> {
    /// Radiation between two reservoirs: where it leaves, where it arrives, and its coefficient in kW/K⁴.
    fn radiation(&self) -> [(End, End, f64); 3] {
        [
            ((0, HEATER), (1, INTERIOR), self.r_heater_interior),
            ((0, HEATER), (3, INSIDE), self.r_heater_shell),
            ((1, INTERIOR), (3, INSIDE), self.r_interior_shell),
        ]
    }

    /// What the fourth power of a surface's temperature adds to base and heater part of the mean radiant temperature.
    fn vote_parts(&self) -> [(usize, [f64; 2]); 3] {
        [(INTERIOR, [self.view_interior, 0.0]), (INSIDE, [1.0 - self.view_interior, -1.0]), (HEATER, [0.0, 1.0])]
    }
}

impl Values {
    /// A heat flow from one reservoir to another, with its slopes over the two temperatures.
    fn exchange(&mut self, from: End, to: End, heat_kw: f64, per_from: f64, per_to: f64) {
        self.balances_kw[from.0] -= heat_kw;
        self.balance_rows[from.0][from.1] -= per_from;
        self.balance_rows[from.0][to.1] += per_to;
        self.balances_kw[to.0] += heat_kw;
        self.balance_rows[to.0][from.1] += per_from;
        self.balance_rows[to.0][to.1] -= per_to;
    }
}

/// A COP curve in dual numbers; where two pieces meet, the derivatives are those of the piece that holds.
fn cop(curve: &Cop, lift: Dual2_64) -> Dual2_64 {
    let limited = |value: Dual2_64, min: f64, max: f64| {
        if value.re < min {
            Dual2_64::from(min)
        } else if value.re > max {
            Dual2_64::from(max)
        } else {
            value
        }
    };
    let positive = if lift.re > 0.0 { lift } else { Dual2_64::from(0.0) };
    match curve {
        Cop::Constant(cop) => Dual2_64::from(*cop),
        Cop::Hyperbola { numerator_k, offset_k, min, max } => {
            limited((positive + *offset_k).recip() * *numerator_k, *min, *max)
        }
        Cop::Exponential { scale, rate_per_k, min, max } => {
            limited((positive * -*rate_per_k).exp() * *scale, *min, *max)
        }
        Cop::Linear { at_zero, slope_per_k, min, max } => limited(lift * -*slope_per_k + *at_zero, *min, *max),
        Cop::Table(rows) => {
            let after = rows.partition_point(|&(lift_k, _)| lift_k <= lift.re);
            match (after.checked_sub(1).map(|i| rows[i]), rows.get(after)) {
                (Some((x0, y0)), Some(&(x1, y1))) => (lift - x0) * ((y1 - y0) / (x1 - x0)) + y0,
                (Some((_, y)), None) => Dual2_64::from(y),
                (None, _) => Dual2_64::from(rows[0].1),
            }
        }
        Cop::Changed { of, scale, shift } => cop(of, lift) * *scale + *shift,
    }
}
