//! Several states abreast, each in a lane of its own.

use crate::pmv::Line;
use crate::{Lanes, Real, Slopes, State, Target, Temperatures};

impl<R: Copy> State<R> {
    /// What a function makes of each number.
    #[inline(always)]
    #[must_use]
    pub fn map<S>(&self, f: impl Fn(&R) -> S) -> State<S> {
        self.zip(self, |x, _| f(x))
    }

    /// What a function makes of each number and that of another state.
    #[inline(always)]
    pub(crate) fn zip<S: Copy, T>(&self, other: &State<S>, f: impl Fn(&R, &S) -> T) -> State<T> {
        let ((t, slopes), (t2, slopes2)) = ((&self.temperatures, &self.slopes), (&other.temperatures, &other.slopes));
        let line =
            |a: &Line<R>, b: &Line<S>| Line { value: f(&a.value, &b.value), per_air_k: f(&a.per_air_k, &b.per_air_k) };
        State {
            temperatures: Temperatures {
                cabin_k: f(&t.cabin_k, &t2.cabin_k),
                interior_k: f(&t.interior_k, &t2.interior_k),
                shell_inside_k: f(&t.shell_inside_k, &t2.shell_inside_k),
                shell_outside_k: f(&t.shell_outside_k, &t2.shell_outside_k),
                radiant_heater_k: f(&t.radiant_heater_k, &t2.radiant_heater_k),
            },
            slopes: Slopes {
                interior: f(&slopes.interior, &slopes2.interior),
                shell_inside: f(&slopes.shell_inside, &slopes2.shell_inside),
                shell_outside: f(&slopes.shell_outside, &slopes2.shell_outside),
                radiant_heater: f(&slopes.radiant_heater, &slopes2.radiant_heater),
            },
            pmv: f(&self.pmv, &other.pmv),
            pmv_slope: f(&self.pmv_slope, &other.pmv_slope),
            clothes: [line(&self.clothes[0], &other.clothes[0]), line(&self.clothes[1], &other.clothes[1])],
        }
    }
}

impl<const W: usize> State<Lanes<W>> {
    /// States abreast.
    #[must_use]
    #[inline]
    pub fn of(states: &[State; W]) -> Self {
        let mut abreast = states[0].map(|x| Lanes::splat(*x));
        for (lane, state) in states.iter().enumerate().skip(1) {
            abreast.set_lane(lane, state);
        }
        abreast
    }

    /// The state of a lane.
    #[must_use]
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> State {
        self.map(|x| x.0[lane])
    }

    /// Puts a state into a lane.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, state: &State) {
        let (t, own_t) = (&mut self.temperatures, &state.temperatures);
        t.cabin_k.0[lane] = own_t.cabin_k;
        t.interior_k.0[lane] = own_t.interior_k;
        t.shell_inside_k.0[lane] = own_t.shell_inside_k;
        t.shell_outside_k.0[lane] = own_t.shell_outside_k;
        t.radiant_heater_k.0[lane] = own_t.radiant_heater_k;
        let (slopes, own_slopes) = (&mut self.slopes, &state.slopes);
        slopes.interior.0[lane] = own_slopes.interior;
        slopes.shell_inside.0[lane] = own_slopes.shell_inside;
        slopes.shell_outside.0[lane] = own_slopes.shell_outside;
        slopes.radiant_heater.0[lane] = own_slopes.radiant_heater;
        self.pmv.0[lane] = state.pmv;
        self.pmv_slope.0[lane] = state.pmv_slope;
        for (clothing, own) in self.clothes.iter_mut().zip(&state.clothes) {
            clothing.value.0[lane] = own.value;
            clothing.per_air_k.0[lane] = own.per_air_k;
        }
    }
}

impl<const W: usize> Target<Lanes<W>> {
    /// The target of a lane.
    pub(crate) fn lane(&self, lane: usize) -> Target {
        let of = |x: &Lanes<W>| x.0[lane];
        match self {
            Self::CabinTemperature(cabin_k) => Target::CabinTemperature(of(cabin_k)),
            Self::Vote(pmv) => Target::Vote(of(pmv)),
            Self::Heat { door_loss_share, heat_w, per_k, at_k } => Target::Heat {
                door_loss_share: of(door_loss_share),
                heat_w: of(heat_w),
                per_k: of(per_k),
                at_k: of(at_k),
            },
        }
    }
}
