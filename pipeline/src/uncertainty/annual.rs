//! Intervals of the annual means and of what designs save, from drawn years.

use rayon::prelude::*;
use store::{AnnualEnds, DaySum, Ends, MonthDays, PairEnds};

use super::bootstrap::{Draws, MONTHS, interval};
use super::{Year, year_mean};

/// Samples, power, power in heating, energy with a distance, distance.
const QUANTITIES: usize = 5;
/// Power, power in heating, power in cooling, energy for a distance.
const OUTPUTS: usize = 4;
const J_PER_KWH_AND_M_PER_KM: f64 = 3600.0;

/// What is drawn for the designs of one window.
struct OfWindow {
    designs: usize,
    values: Vec<f64>,
}

impl OfWindow {
    fn new(year: &Year<'_>, draws: &Draws, window: usize) -> Self {
        let designs = year.points / year.windows;
        let quantities = |s: &DaySum| [s.samples, s.power_w, s.heating_power_w, s.driven_energy_j, s.distance_m];
        let of_day = |month: &MonthDays, n: usize| {
            (0..designs).flat_map(|design| quantities(&month.cells[design * year.windows + window][n])).collect()
        };
        let parts = year.parts(&of_day);
        let values = draws.each(&parts, designs * QUANTITIES, designs * OUTPUTS, |months, out| {
            for design in 0..designs {
                let of_design = |month: usize| &months[(month * designs + design) * QUANTITIES..][..QUANTITIES];
                out[design * OUTPUTS..][..OUTPUTS].copy_from_slice(&means(&of_design));
            }
        });
        Self { designs, values }
    }

    /// What a design takes in each drawn year, in W.
    fn powers(&self, design: usize) -> impl Iterator<Item = f64> + '_ {
        self.values.chunks_exact(self.designs * OUTPUTS).map(move |of| of[design * OUTPUTS])
    }

    fn ends(&self, value: impl Fn(&[f64]) -> f64) -> Ends {
        interval(self.values.chunks_exact(self.designs * OUTPUTS).map(value))
    }
}

/// What a design comes to; `of_month` gives its sums.
fn means<'m>(of_month: &dyn Fn(usize) -> &'m [f64]) -> [f64; OUTPUTS] {
    let months = (0..MONTHS).map(|month| match of_month(month) {
        &[samples, power_w, heating_w, energy_j, distance_m] => (samples, [power_w, heating_w, energy_j, distance_m]),
        _ => (0.0, [0.0; OUTPUTS]),
    });
    let [power_w, heating_w, energy_j, distance_m] = year_mean(months);
    [power_w, heating_w, power_w - heating_w, energy_j / distance_m / J_PER_KWH_AND_M_PER_KM]
}

/// Every design with every other one in each window.
fn pairs(year: &Year<'_>) -> impl Iterator<Item = ([usize; 2], usize)> {
    let (windows, designs) = (year.windows, year.points / year.windows.max(1));
    let of = move |window| (0..designs).flat_map(move |a| (0..designs).map(move |b| ([a, b], window)));
    (0..windows).flat_map(of).filter(|([a, b], _)| a != b)
}

/// Intervals of every design and window, and of every design against every other one in the same window; `pmv_1` is the place of
/// the window ±1.
pub fn intervals(
    year: &Year<'_>,
    draws: &Draws,
    ptc: Option<usize>,
    pmv_1: Option<usize>,
) -> (Vec<AnnualEnds>, Vec<PairEnds>) {
    let all: Vec<OfWindow> = (0..year.windows).map(|window| OfWindow::new(year, draws, window)).collect();
    let power_w = |of: &[f64], design: usize| of[design * OUTPUTS];
    let saving = |of: &[f64], design, other| 1.0 - power_w(of, design) / power_w(of, other);
    let annual = |point: usize| {
        let (design, drawn) = (point / year.windows, &all[point % year.windows]);
        let at = |output: usize| drawn.ends(|of| of[design * OUTPUTS + output]);
        AnnualEnds {
            hvac_power_w: at(0),
            heating_power_w: at(1),
            cooling_power_w: at(2),
            kwh_per_km: at(3),
            reduction_vs_ptc: ptc.and_then(|ptc| drawn.ends(|of| saving(of, design, ptc))),
            change_vs_pmv_1: pmv_1.and_then(|place| {
                let change = |(of, at_1): (f64, f64)| of / at_1 - 1.0;
                interval(drawn.powers(design).zip(all[place].powers(design)).map(change))
            }),
        }
    };
    let pair = |([design, other], window): ([usize; 2], usize)| PairEnds {
        designs: [design, other],
        window,
        other_takes_more_w: all[window].ends(|of| power_w(of, other) - power_w(of, design)),
        saving: all[window].ends(|of| saving(of, design, other)),
    };
    let wanted: Vec<_> = pairs(year).collect();
    ((0..year.points).into_par_iter().map(annual).collect(), wanted.into_par_iter().map(pair).collect())
}
