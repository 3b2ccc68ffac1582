//! Newton's method for the steady states: one iteration over everything at once, of one state or of several abreast.
//!
//! Unknowns are the temperatures of cabin and surfaces and the clothing temperature of the passengers. A step linearises
//! the balances and the clothing's heat balance, which makes everything follow the cabin temperature along a line; the
//! [`Target`] then says how far along it to go. No clothing iteration and no balance iteration is nested in another.

use crate::comfort::Nodes;
use crate::pmv::Line;
use crate::{Cabin, Real, State, Target};

/// Steps after which the iteration is given up; four are usual from a rough guess.
pub(crate) const MOST_STEPS: usize = 60;
/// What is settled. Convergence is quadratic: what a step of this leaves behind is below rounding, even where door loss bends
/// sharply, with the cabin as warm as ambient air.
pub(crate) const SETTLED_K: f64 = 1e-5;
/// The same for a vote, in which nothing bends while clothing does not change between natural and forced convection: 1e-10 K are
/// left.
const VOTE_SETTLED_K: f64 = 3e-4;
/// Longest step of the cabin temperature in K.
const LONGEST_STEP_K: f64 = 50.0;

/// An iteration of one state, or of several abreast, whose passengers are `N` nodes of a quadrature.
pub(crate) struct Newton<'a, R, const N: usize> {
    pub cabin: &'a Cabin<'a>,
    pub target: &'a Target<R>,
    /// 1 where the heaters are held at their temperature, 0 where they are off.
    pub held: R,
    pub nodes: &'a Nodes<N>,
    pub state: &'a mut State<R>,
    /// Clothing of the passengers of the nodes.
    pub clothes: &'a mut [Line<R>; N],
}

impl<R: Real, const N: usize> Newton<'_, R, N> {
    /// Runs until all is settled; 0 where it is, 1 where it does not settle. What is settled stays as it is while others go on,
    /// so that a state is the same in whatever company.
    #[inline(always)]
    pub fn run(mut self) -> R {
        let settled_k = R::splat(match self.target {
            Target::Vote(_) => VOTE_SETTLED_K,
            Target::CabinTemperature(_) | Target::Heat { .. } => SETTLED_K,
        });
        let mut moving = R::splat(1.0);
        for _ in 0..MOST_STEPS {
            let moved_k = self.step(moving);
            moving = settled_k.above(moved_k, R::splat(0.0), moving);
            if !moving.any() {
                break;
            }
        }
        moving
    }

    /// One step of those that are `moving`; returns by how many K all temperatures change together, and one more for each
    /// clothing that changes between natural and forced convection.
    #[inline(always)]
    fn step(&mut self, moving: R) -> R {
        let t = &self.state.temperatures;
        let cube = |k: R| k * k * k;
        let cubes = [cube(t.radiant_heater_k), cube(t.interior_k), cube(t.shell_inside_k), cube(t.shell_outside_k)];
        let (balanced, slopes) = self.cabin.balanced(t, cubes, self.held);
        let (vote, lines) = self.cabin.vote_line(t, cubes, (&balanced, &slopes), self.nodes, self.clothes);
        let cabin_step_k = match *self.target {
            Target::CabinTemperature(_) => R::splat(0.0),
            Target::Vote(pmv) => (pmv - vote.value) / vote.per_air_k,
            Target::Heat { door_loss_share, heat_w, per_k, at_k } => {
                let (taken_w, slope_w_k) = self.cabin.air_unit_heat_abreast_w(&balanced, &slopes, door_loss_share);
                let brought_w = per_k.mul_add(t.cabin_k - at_k, heat_w);
                (brought_w - taken_w) / (slope_w_k - per_k)
            }
        };
        let (longest, shortest) = (R::splat(LONGEST_STEP_K), R::splat(-LONGEST_STEP_K));
        let cabin_step_k = cabin_step_k.above(longest, longest, cabin_step_k);
        let cabin_step_k = shortest.above(cabin_step_k, shortest, cabin_step_k);

        let mut next = State {
            temperatures: *t,
            slopes,
            pmv: match *self.target {
                // As it is to rounding: a window of no width then has votes of 0, not of 1e-27.
                Target::Vote(pmv) => pmv,
                _ => vote.per_air_k.mul_add(cabin_step_k, vote.value),
            },
            pmv_slope: vote.per_air_k,
            clothes: self.state.clothes,
        };
        // A sum, not the largest: it is no number as soon as one of them is none.
        let mut moved_k = cabin_step_k.abs();
        let mut follow = |k: &mut R, balanced_k: R, slope: R| {
            let next_k = slope.mul_add(cabin_step_k, balanced_k);
            moved_k = moved_k + (next_k - *k).abs();
            *k = next_k;
        };
        let t = &mut next.temperatures;
        follow(&mut t.interior_k, balanced.interior_k, slopes.interior);
        follow(&mut t.shell_inside_k, balanced.shell_inside_k, slopes.shell_inside);
        follow(&mut t.shell_outside_k, balanced.shell_outside_k, slopes.shell_outside);
        follow(&mut t.radiant_heater_k, balanced.radiant_heater_k, slopes.radiant_heater);
        t.cabin_k = t.cabin_k + cabin_step_k;

        let of_moving = |old: R, new: R| moving.above(R::splat(0.0), new, old);
        let before_k = self.state.temperatures.cabin_k;
        let mut changed = R::splat(0.0);
        for (clothing, line) in self.clothes.iter_mut().zip(lines) {
            let mut surface_k = clothing.value;
            follow(&mut surface_k, line.value, line.per_air_k);
            let was = self.cabin.has_natural_convection(before_k, clothing.value);
            changed = changed + (self.cabin.has_natural_convection(t.cabin_k, surface_k) - was).abs();
            clothing.value = of_moving(clothing.value, surface_k);
            clothing.per_air_k = of_moving(clothing.per_air_k, line.per_air_k);
        }
        *self.state = self.state.zip(&next, |old, new| of_moving(*old, *new));
        moved_k + changed
    }
}
