//! The mean vote of the passengers, and its slope over the cabin temperature.

use crate::balance::pow4;
use crate::pmv::Line;
use crate::{Cabin, Real, Slopes, StandardRange, State, Temperatures, ZERO_CELSIUS_K};

/// The passengers of a quadrature: view factor to the radiant heaters and weight of each.
pub(crate) type Nodes<const N: usize> = [(f64, f64); N];

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
            dry_w_m2 = dry.mul_add(weight, dry_w_m2);
        }
        self.pmv.vote(dry_w_m2, R::splat(0.0), t.cabin_k - ZERO_CELSIUS_K).0
    }

    /// Mean vote of the passengers where balances and clothing hold to first order about the given temperatures, and their
    /// clothing there in the standard's kelvin. `cubes` as in [`Cabin::balanced`], whose result is `balanced` and `slopes`.
    #[inline(always)]
    pub(crate) fn vote_line<R: Real, const N: usize>(
        &self,
        t: &Temperatures<R>,
        [heater3, interior3, inside3, _]: [R; 4],
        (balanced, slopes): (&Temperatures<R>, &Slopes<R>),
        nodes: &Nodes<N>,
        clothes: &[Line<R>; N],
    ) -> (Line<R>, [Line<R>; N]) {
        let interior3 = interior3 * self.view_interior;
        // T_mr⁴ = F_rh T_rh⁴ + (1 − F_int − F_rh) T_s,i⁴ + F_int T_int⁴ (paper, section 2.2): what is seen by all, and what more
        // for each unit of F_rh; now, where the balances hold, and for each kelvin of the cabin.
        let seen = |heater: R, interior: R, inside: R| {
            let inside = inside3 * inside;
            (inside.mul_add(1.0 - self.view_interior, interior3 * interior), heater3.mul_add(heater, -inside))
        };
        let now = seen(t.radiant_heater_k, t.interior_k, t.shell_inside_k);
        let then = seen(balanced.radiant_heater_k, balanced.interior_k, balanced.shell_inside_k);
        let slope = seen(slopes.radiant_heater, slopes.interior, slopes.shell_inside);
        let air_k = t.cabin_k - STANDARD_SHIFT_K;
        let (mut dry_w_m2, mut dry_slope) = (R::splat(0.0), R::splat(0.0));
        let mut lines = *clothes;
        for ((view, weight), clothing) in nodes.iter().zip(&mut lines) {
            let fourth = now.1.mul_add(*view, now.0);
            let radiant_k = fourth.sqrt().sqrt();
            // To first order the new T_mr is T_mr⁻³ times the cubes with the new temperatures.
            let per_cube = radiant_k / fourth;
            let radiant = Line {
                value: then.1.mul_add(*view, then.0).mul_add(per_cube, -STANDARD_SHIFT_K),
                per_air_k: slope.1.mul_add(*view, slope.0) * per_cube,
            };
            let (surface, dry) = self.pmv.clothing(clothing.value, air_k, radiant_k - STANDARD_SHIFT_K, radiant);
            *clothing = surface;
            dry_w_m2 = dry.value.mul_add(*weight, dry_w_m2);
            dry_slope = dry.per_air_k.mul_add(*weight, dry_slope);
        }
        let (value, per_air_k) = self.pmv.vote(dry_w_m2, dry_slope, t.cabin_k - ZERO_CELSIUS_K);
        (Line { value, per_air_k }, lines)
    }

    /// 1 where natural convection at clothing of a surface temperature in the standard's kelvin exceeds the forced one, 0 where it
    /// does not.
    #[inline(always)]
    pub(crate) fn has_natural_convection<R: Real>(&self, cabin_k: R, surface_k: R) -> R {
        let excess_k = (surface_k - (cabin_k - STANDARD_SHIFT_K)).abs();
        excess_k.above(R::splat(self.pmv.natural_convection_from_k()), R::splat(1.0), R::splat(0.0))
    }

    /// 1 where the kink of [`Cabin::kink_view`] may lie between passengers, 0 where it does not.
    #[inline(always)]
    pub(crate) fn near_kink<R: Real>(&self, state: &State<R>) -> R {
        let [least, largest] = self.views.range();
        // What the surface varies over all passengers, half as much again, tells most states from those near a kink.
        let varies_k = (self.clothing_per_view_k(&state.clothes) * (1.5 * (largest - least))).abs();
        let excess_k = (state.clothes[0].value - (state.temperatures.cabin_k - STANDARD_SHIFT_K)).abs();
        let beyond_k = (excess_k - self.pmv.natural_convection_from_k()).abs();
        // 0 as well where all passengers see the same and there is no number.
        varies_k.above(beyond_k, R::splat(1.0), R::splat(0.0))
    }

    /// The view factor that parts passengers with natural from those with forced convection at their clothing: there the
    /// vote has a kink, over which no quadrature is good. `None` where it lies between no two passengers. The state's clothes
    /// are those of the two passengers of the whole, settled.
    pub(crate) fn kink_view(&self, state: &State) -> Option<f64> {
        if !self.near_kink(state).any() {
            return None;
        }
        let t = &state.temperatures;
        let air_k = t.cabin_k - STANDARD_SHIFT_K;
        let kink_k = self.pmv.natural_convection_from_k();
        let [least, largest] = self.views.range();
        let excess_k = state.clothes[0].value - air_k;
        let [heater4, interior4, shell4] = [t.radiant_heater_k, t.interior_k, t.shell_inside_k].map(pow4);
        let radiant_k = self.pmv.radiant_of_surface_k(air_k + kink_k.copysign(excess_k), air_k)? + STANDARD_SHIFT_K;
        let lacking = pow4(radiant_k) - self.view_interior * interior4 - (1.0 - self.view_interior) * shell4;
        let view = lacking / (heater4 - shell4);
        (least..largest).contains(&view).then_some(view)
    }

    /// The passengers as two groups with a quadrature each, parted at a view factor, and their clothing, as warm as the straight
    /// line through that of the two of the whole says.
    pub(crate) fn split(&self, view: f64, clothes: &[Line; 2]) -> (Nodes<4>, [Line; 4]) {
        let nodes = self.views.split_nodes(view);
        let (from, _) = self.views.nodes()[0];
        let per_view_k = self.clothing_per_view_k(clothes);
        let clothing = |(view, _)| Line { value: clothes[0].value + per_view_k * (view - from), per_air_k: 0.0 };
        (nodes, nodes.map(clothing))
    }

    /// How much warmer clothing is for each unit of view factor; no number where all see the same.
    #[inline(always)]
    fn clothing_per_view_k<R: Real>(&self, [a, b]: &[Line<R>; 2]) -> R {
        let [(view_a, _), (view_b, _)] = self.views.nodes();
        (b.value - a.value) * (1.0 / (view_b - view_a))
    }

    /// The vote of one passenger with the given view factor to the radiant heaters.
    #[must_use]
    pub fn passenger_pmv(&self, t: &Temperatures, view: f64) -> f64 {
        self.pmv.at(t.cabin_k - ZERO_CELSIUS_K, self.mean_radiant_k(t, view) - ZERO_CELSIUS_K).pmv
    }

    /// Mean radiant temperature of the average passenger in K (paper, section 2.2).
    #[must_use]
    #[inline(always)]
    pub fn mean_radiant_temperature_k<R: Real>(&self, t: &Temperatures<R>) -> R {
        self.mean_radiant_k(t, self.views.mean())
    }

    /// Whether the average passenger's state lies in the range of use of ISO 7730, at air and mean radiant temperature in K.
    #[must_use]
    pub fn standard_range(&self, cabin_k: f64, mean_radiant_k: f64, pmv: f64) -> StandardRange {
        self.pmv.standard_range(cabin_k - ZERO_CELSIUS_K, mean_radiant_k - ZERO_CELSIUS_K, pmv)
    }

    #[inline(always)]
    fn mean_radiant_k<R: Real>(&self, t: &Temperatures<R>, view: f64) -> R {
        self.radiant_k([pow4(t.radiant_heater_k), pow4(t.interior_k), pow4(t.shell_inside_k)], view)
    }

    /// Mean radiant temperature in K of who sees so much of the heaters, from the fourth powers of heaters, interior and inside
    /// of the shell: T_mr⁴ = F_rh T_rh⁴ + (1 − F_int − F_rh) T_s,i⁴ + F_int T_int⁴ (paper, section 2.2).
    #[inline(always)]
    fn radiant_k<R: Real>(&self, [heater4, interior4, shell4]: [R; 3], view: f64) -> R {
        let fourth = shell4.mul_add(1.0 - self.view_interior - view, interior4 * self.view_interior);
        heater4.mul_add(view, fourth).sqrt().sqrt()
    }
}

/// The annex writes 273 where physics has 273.15 K.
const STANDARD_SHIFT_K: f64 = ZERO_CELSIUS_K - 273.0;
