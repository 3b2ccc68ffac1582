//! The mean vote of the passengers, and its slope over the cabin temperature.

use crate::balance::{Linear, pow4};
use crate::{Cabin, Real, StandardRange, Temperatures, ZERO_CELSIUS_K};

/// A passenger who stands for a share of all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Passenger {
    /// View factor to the radiant heaters.
    view: f64,
    weight: f64,
    /// Surface temperature of the clothing in the standard's kelvin (0 °C = 273 K).
    pub surface_k: f64,
    /// Where its heat balance holds: so far away, and so much farther for each kelvin of the cabin.
    shift_k: f64,
    pub slope: f64,
}

impl Passenger {
    pub fn new(view: f64, weight: f64, surface_k: f64) -> Self {
        Self { view, weight, surface_k, shift_k: 0.0, slope: 0.0 }
    }

    /// Moves the clothing along its line; returns the length of the move in K.
    pub fn step(&mut self, cabin_step_k: f64) -> f64 {
        let step_k = self.shift_k + self.slope * cabin_step_k;
        self.surface_k += step_k;
        step_k.abs()
    }
}

/// Surface temperatures of the clothing of the two passengers of the quadrature, in the standard's kelvin, stepped through
/// time; in one bus, or in several abreast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clothes<R = f64>([R; 2]);

impl Cabin<'_> {
    /// Clothing that is settled at the given temperatures.
    #[must_use]
    pub fn clothes<R: Real>(&self, t: &Temperatures<R>) -> Clothes<R> {
        let mut clothes = Clothes([t.cabin_k + 5.0; 2]);
        for _ in 0..20 {
            self.step_vote(t, &mut clothes);
        }
        clothes
    }

    /// Mean vote of the passengers at temperatures that change slowly: one Newton step of each clothing from where it was,
    /// which is good to 1e-5 votes where the surfaces have moved by some hundredths of a kelvin.
    #[inline(always)]
    pub fn step_vote<R: Real>(&self, t: &Temperatures<R>, clothes: &mut Clothes<R>) -> R {
        let [heater4, interior4, shell4] = [t.radiant_heater_k, t.interior_k, t.shell_inside_k].map(pow4);
        let air_k = t.cabin_k - STANDARD_SHIFT_K;
        let mut dry_w_m2 = R::splat(0.0);
        for ((view, weight), surface_k) in self.views.nodes().into_iter().zip(&mut clothes.0) {
            let radiant_k = self.radiant_k([heater4, interior4, shell4], view);
            let (shift_k, dry) = self.pmv.step_surface(*surface_k, air_k, radiant_k - STANDARD_SHIFT_K);
            *surface_k = *surface_k + shift_k;
            dry_w_m2 = dry_w_m2 + dry * weight;
        }
        self.pmv.vote(dry_w_m2, R::splat(0.0), t.cabin_k - ZERO_CELSIUS_K).0
    }

    /// Mean vote of the passengers where balances and clothing hold to first order, and its slope in 1/K over the cabin
    /// temperature. Leaves in each passenger how its clothing follows.
    pub(crate) fn vote_line(&self, t: &Temperatures, linear: &Linear, passengers: &mut [Passenger]) -> (f64, f64) {
        let cube = |k: f64| k * k * k;
        let [heater3, interior3, shell3] = [t.radiant_heater_k, t.interior_k, t.shell_inside_k].map(cube);
        let rise = |steps: &[f64; 4], view: f64, view_shell: f64| {
            view * heater3 * steps[0] + self.view_interior * interior3 * steps[1] + view_shell * shell3 * steps[2]
        };
        let air_k = t.cabin_k - STANDARD_SHIFT_K;
        let (mut dry_w_m2, mut dry_slope) = (0.0, 0.0);
        for p in passengers {
            let view_shell = 1.0 - self.view_interior - p.view;
            // T_mr⁴ = F_rh T_rh⁴ + (1 − F_int − F_rh) T_s,i⁴ + F_int T_int⁴ (paper, section 2.2), and its slope.
            let fourth = p.view * heater3 * t.radiant_heater_k
                + self.view_interior * interior3 * t.interior_k
                + view_shell * shell3 * t.shell_inside_k;
            let radiant_k = fourth.sqrt().sqrt();
            let per_cube = radiant_k / fourth;
            let shift_k = rise(&linear.shift_k, p.view, view_shell) * per_cube;
            let slope = rise(&linear.slopes, p.view, view_shell) * per_cube;

            let clothing = self.pmv.clothing(p.surface_k, air_k, radiant_k - STANDARD_SHIFT_K);
            p.shift_k = clothing.surface.value + clothing.surface.per_radiant_k * shift_k;
            p.slope = clothing.surface.per_air_k + clothing.surface.per_radiant_k * slope;
            dry_w_m2 += p.weight * (clothing.dry_w_m2.value + clothing.dry_w_m2.per_radiant_k * shift_k);
            dry_slope += p.weight * (clothing.dry_w_m2.per_air_k + clothing.dry_w_m2.per_radiant_k * slope);
        }
        self.pmv.vote(dry_w_m2, dry_slope, t.cabin_k - ZERO_CELSIUS_K)
    }

    /// The view factor that parts passengers with natural from those with forced convection at their clothing: there the
    /// vote has a kink, over which no quadrature is good. `None` where it lies between no two passengers. `gauss` are the
    /// two passengers of the whole, settled.
    pub(crate) fn kink_view(&self, t: &Temperatures, [a, b]: &[Passenger; 2]) -> Option<f64> {
        let air_k = t.cabin_k - STANDARD_SHIFT_K;
        let kink_k = self.pmv.natural_convection_from_k();
        let [least, largest] = self.views.range();
        // What the surface varies over all passengers, half as much again, tells most states from those near a kink.
        let per_view_k = (b.surface_k - a.surface_k) / (b.view - a.view);
        let varies_k = 1.5 * (per_view_k * (largest - least)).abs();
        let excess_k = a.surface_k - air_k;
        // False as well where all passengers see the same and there is no number.
        let near = (excess_k.abs() - kink_k).abs() < varies_k;
        if !near {
            return None;
        }
        let [heater4, interior4, shell4] = [t.radiant_heater_k, t.interior_k, t.shell_inside_k].map(pow4);
        let radiant_k = self.pmv.radiant_of_surface_k(air_k + kink_k.copysign(excess_k), air_k)? + STANDARD_SHIFT_K;
        let lacking = pow4(radiant_k) - self.view_interior * interior4 - (1.0 - self.view_interior) * shell4;
        let view = lacking / (heater4 - shell4);
        (least..largest).contains(&view).then_some(view)
    }

    /// The passengers as two groups with a quadrature each, parted at a view factor, with clothing as warm as the straight
    /// line through two of them says.
    pub(crate) fn split(&self, view: f64, [a, b]: &[Passenger; 2]) -> [Passenger; 4] {
        let per_view_k = (b.surface_k - a.surface_k) / (b.view - a.view);
        let passenger = |(view, weight)| Passenger::new(view, weight, a.surface_k + per_view_k * (view - a.view));
        self.views.split_nodes(view).map(passenger)
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

    /// Whether the average passenger's state lies in the range of use of ISO 7730, at air and mean radiant temperature in K.
    #[must_use]
    pub fn standard_range(&self, cabin_k: f64, mean_radiant_k: f64, pmv: f64) -> StandardRange {
        self.pmv.standard_range(cabin_k - ZERO_CELSIUS_K, mean_radiant_k - ZERO_CELSIUS_K, pmv)
    }

    fn mean_radiant_k(&self, t: &Temperatures, view: f64) -> f64 {
        self.radiant_k([t.radiant_heater_k, t.interior_k, t.shell_inside_k].map(pow4), view)
    }

    /// Mean radiant temperature in K of who sees so much of the heaters, from the fourth powers of heaters, interior and inside
    /// of the shell: T_mr⁴ = F_rh T_rh⁴ + (1 − F_int − F_rh) T_s,i⁴ + F_int T_int⁴ (paper, section 2.2).
    #[inline(always)]
    fn radiant_k<R: Real>(&self, [heater4, interior4, shell4]: [R; 3], view: f64) -> R {
        let fourth = heater4 * view + shell4 * (1.0 - self.view_interior - view) + interior4 * self.view_interior;
        fourth.sqrt().sqrt()
    }
}

/// The annex writes 273 where physics has 273.15 K.
const STANDARD_SHIFT_K: f64 = ZERO_CELSIUS_K - 273.0;
