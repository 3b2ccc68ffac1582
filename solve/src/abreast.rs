//! States that are found abreast, as far as none waits for another.

use cabin::{Cabin, Heaters, Lanes, Real, State, Target};
use pulp::{Arch, Simd, WithSimd};

use crate::steady::{Seen, SteadyState};

/// States that are searched abreast: as many as the vector instructions of most machines take.
pub(crate) const LANES: usize = 4;

/// A number of each of them.
pub(crate) type Abreast = Lanes<LANES>;

/// A search for states. It is compiled once for each set of vector instructions, and runs with what the machine has; all of
/// them round alike, as a product and a sum are one operation where the code says so, and nowhere else.
pub(crate) struct Search<'a, 'c> {
    pub cabin: &'a Cabin<'c>,
    pub target: Target<Abreast>,
    pub heaters: [Heaters; LANES],
    pub guess: Guess<'a>,
}

/// Where a search starts.
pub(crate) enum Guess<'a> {
    /// At these states.
    Is(&'a State<Abreast>),
    /// Along the tangents of these, to the votes that are the target.
    Along(&'a State<Abreast>),
    /// On the cubic through these and others before them, to the votes that are the target.
    Beyond(&'a State<Abreast>, &'a State<Abreast>),
}

/// What a search finds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    pub state: State<Abreast>,
    pub settles: [bool; LANES],
    /// Heat that the air unit has to bring in W and its slope over the cabin temperature in W/K, without and with air curtain.
    pub air_unit_heat_w: [(Abreast, Abreast); 2],
    mean_radiant_k: Abreast,
    /// 0 while the heaters are off.
    radiant_heater_power_w: Abreast,
}

impl Search<'_, '_> {
    /// Runs it. Its lanes fill the registers of AVX2; with the wider ones of AVX-512 it takes 1.1 times the time.
    pub fn run(self) -> Found {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = pulp::x86::V3::try_new() {
            return Simd::vectorize(avx2, self);
        }
        Arch::new().dispatch(self)
    }
}

impl WithSimd for Search<'_, '_> {
    type Output = Found;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Found {
        let Self { cabin, target, heaters, guess } = self;
        let mut state = match (guess, target) {
            (Guess::Is(state), _) => *state,
            (Guess::Along(last), Target::Vote(votes)) => last.along(votes),
            (Guess::Beyond(last, before), Target::Vote(votes)) => last.beyond(votes, before),
            (Guess::Along(last) | Guess::Beyond(last, _), _) => *last,
        };
        let settles = cabin.settle_abreast(&target, heaters, &mut state);
        let (t, slopes) = (&state.temperatures, &state.slopes);
        let heat = |curtain| cabin.air_unit_heat_abreast_w(t, slopes, Lanes::splat(cabin.door_loss_share(curtain)));
        let mut radiant_heater_power_w = cabin.radiant_heater_power_w(t);
        for (power_w, heaters) in radiant_heater_power_w.0.iter_mut().zip(heaters) {
            if heaters == Heaters::Off {
                *power_w = 0.0;
            }
        }
        Found {
            settles,
            air_unit_heat_w: [heat(false), heat(true)],
            mean_radiant_k: cabin.mean_radiant_temperature_k(t),
            radiant_heater_power_w,
            state,
        }
    }
}

impl Found {
    /// The first or second pair of lanes, twice.
    #[inline]
    pub fn pair(&self, n: usize) -> Self {
        let twice = |x: &Abreast| Lanes(std::array::from_fn(|lane| x.0[2 * n + lane % 2]));
        Self {
            state: self.state.map(twice),
            settles: std::array::from_fn(|lane| self.settles[2 * n + lane % 2]),
            air_unit_heat_w: self.air_unit_heat_w.map(|(heat_w, slope_w_k)| (twice(&heat_w), twice(&slope_w_k))),
            mean_radiant_k: twice(&self.mean_radiant_k),
            radiant_heater_power_w: twice(&self.radiant_heater_power_w),
        }
    }

    /// The state of a lane.
    #[inline]
    pub fn seen(&self, cabin: &Cabin<'_>, lane: usize) -> Seen {
        if !self.settles[lane] {
            return Seen::Lost;
        }
        let State { temperatures, pmv, .. } = self.state.lane(lane);
        let mean_radiant_k = self.mean_radiant_k.0[lane];
        Seen::Settled(SteadyState {
            temperatures,
            mean_radiant_k,
            pmv,
            standard_range: cabin.standard_range(temperatures.cabin_k, mean_radiant_k, pmv),
            air_unit_heat_w: self.air_unit_heat_w.map(|(heat_w, _)| heat_w.0[lane]),
            radiant_heater_power_w: self.radiant_heater_power_w.0[lane],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Abreast, Found, Guess, LANES, Search};
    use cabin::{Cabin, Heaters, Lanes, PassengerViews, State, Target, Vehicle};
    use pulp::WithSimd;

    const HEATERS: [Heaters; LANES] = [Heaters::Off, Heaters::On, Heaters::Off, Heaters::On];

    fn found(cabin: &Cabin<'_>, votes: [f64; LANES], run: impl Fn(Search<'_, '_>) -> Found) -> Found {
        let guess = State::of(&[cabin.rough_state(295.0); LANES]);
        run(Search { cabin, target: Target::Vote(Lanes(votes)), heaters: HEATERS, guess: Guess::Is(&guess) })
    }

    /// Of some samples of a year.
    fn with_cabins(check: impl Fn(&Cabin<'_>)) {
        let vehicle = Vehicle::default();
        let views = PassengerViews::new(&vehicle);
        for sample in testing::year().iter().step_by(199) {
            check(&Cabin::new(&vehicle, &views, sample));
        }
    }

    fn bits(found: &Found, lane: usize) -> [u64; 4] {
        let t = &found.state.temperatures;
        [t.cabin_k, t.shell_outside_k, found.mean_radiant_k, found.air_unit_heat_w[1].0]
            .map(|x: Abreast| x.0[lane].to_bits())
    }

    #[test]
    fn prop_a_state_is_the_same_in_whatever_company() {
        with_cabins(|cabin| {
            let votes = [-2.0, -0.3, 0.5, 1.7];
            let abreast = found(cabin, votes, |search| search.run());
            for lane in 0..LANES {
                let alone = found(cabin, [votes[lane]; LANES], |search| search.run());
                assert_eq!(bits(&abreast, lane), bits(&alone, lane));
                let one =
                    cabin.state(Target::Vote(votes[lane]), HEATERS[lane], &cabin.rough_state(295.0)).expect("settles");
                let apart_k = one.temperatures.cabin_k - abreast.state.temperatures.cabin_k.0[lane];
                assert!(apart_k.abs() < 1e-9, "{apart_k}");
            }
        });
    }

    #[test]
    fn prop_all_vector_instructions_round_alike() {
        with_cabins(|cabin| {
            let votes = [-1.2, -0.1, 0.4, 2.0];
            let fastest = found(cabin, votes, |search| search.run());
            let scalar = found(cabin, votes, |search| search.with_simd(pulp::Scalar));
            for lane in 0..LANES {
                assert_eq!(bits(&fastest, lane), bits(&scalar, lane));
            }
        });
    }
}
