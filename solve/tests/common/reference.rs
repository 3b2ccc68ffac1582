//! A slow, obvious solver: nested bisection on the model's own flows and single votes, a dense search over the cabin
//! temperature, every choice of devices. It shares with the fast one only the formulas of heat flows and of one vote.

use cabin::{Cabin, ComfortWindow, Design, Disturbances, PassengerViews, Temperatures, Vehicle};

/// The root of a rising function between two numbers.
fn bisect(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if function(middle) > 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// A sample in one state of the heaters and the curtain.
pub struct Reference<'a> {
    cabin: Cabin<'a>,
    views: &'a PassengerViews,
    heater_target_k: f64,
    pub heaters: bool,
    pub curtain: bool,
}

/// Temperatures with what they ask for.
#[derive(Debug, Clone, Copy)]
pub struct Slow {
    pub temperatures: Temperatures,
    pub pmv: f64,
    pub air_unit_heat_w: f64,
    pub radiant_heater_power_w: f64,
}

impl<'a> Reference<'a> {
    pub fn new(v: &Vehicle, views: &'a PassengerViews, d: &Disturbances, heaters: bool, curtain: bool) -> Self {
        let cabin = Cabin::new(v, views, d);
        Self { cabin, views, heater_target_k: v.radiant_heater_target_k, heaters, curtain }
    }

    /// The balances at a cabin temperature, one nested in the other: interior in shell in heaters in outside.
    pub fn at(&self, cabin_k: f64) -> Slow {
        let net = |t: &Temperatures| self.cabin.flows(t, self.curtain, 0.0, 0.0).net_w();
        let (low, high) = (100.0, 700.0);
        let mut t = Temperatures {
            cabin_k,
            interior_k: cabin_k,
            shell_inside_k: cabin_k,
            shell_outside_k: cabin_k,
            radiant_heater_k: self.heater_target_k,
        };
        // Each balance falls with its own temperature. Sweeps over all of them contract, since the coupling is weaker.
        for _ in 0..400 {
            let before = t;
            t.shell_outside_k = bisect(low, high, |k| -net(&Temperatures { shell_outside_k: k, ..t })[4]);
            t.shell_inside_k = bisect(low, high, |k| -net(&Temperatures { shell_inside_k: k, ..t })[3]);
            t.interior_k = bisect(low, high, |k| -net(&Temperatures { interior_k: k, ..t })[1]);
            if !self.heaters {
                t.radiant_heater_k = bisect(low, high, |k| -net(&Temperatures { radiant_heater_k: k, ..t })[0]);
            }
            if before == t {
                break;
            }
        }
        let net_w = net(&t);
        let all = self.views.all();
        let pmv = all.iter().map(|&view| self.cabin.passenger_pmv(&t, view)).sum::<f64>() / all.len() as f64;
        Slow {
            temperatures: t,
            pmv,
            air_unit_heat_w: -net_w[2],
            radiant_heater_power_w: if self.heaters { -net_w[0] } else { 0.0 },
        }
    }

    /// Total power of an operation in W.
    pub fn power_w(&self, design: &Design, slow: &Slow) -> f64 {
        let lift_k = slow.temperatures.cabin_k - self.cabin.ambient_k();
        let heat_w = slow.air_unit_heat_w;
        let air_unit_w = match heat_w {
            // What bisection leaves over.
            w if w.abs() < 1e-7 => 0.0,
            w if w > 0.0 => w / design.heating_cop.at(lift_k),
            w => -w / design.cooling_cop.at(-lift_k),
        };
        air_unit_w + slow.radiant_heater_power_w + if self.curtain { self.cabin.air_curtain_power_w() } else { 0.0 }
    }

    /// The least power over the window: its two ends, the passive state, and `points` temperatures between the ends.
    pub fn least_w(&self, design: &Design, window: &ComfortWindow, points: u32) -> f64 {
        let vote_at = |pmv: f64| bisect(200.0, 360.0, |k| self.at(k).pmv - pmv);
        let (low, high) = (vote_at(window.pmv_min()), vote_at(window.pmv_max()));
        let passive = bisect(150.0, 450.0, |k| self.at(k).air_unit_heat_w);
        let mut temperatures = vec![low, high];
        if (low..=high).contains(&passive) {
            temperatures.push(passive);
        }
        temperatures.extend((1..points).map(|i| low + (high - low) * f64::from(i) / f64::from(points)));
        temperatures.into_iter().map(|k| self.power_w(design, &self.at(k))).fold(f64::INFINITY, f64::min)
    }
}
