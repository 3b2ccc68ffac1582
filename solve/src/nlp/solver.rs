//! The programs of one sample for all designs and windows, and the cheapest of each four.

use cabin::{
    Cabin, Devices, Disturbances, Infeasible, OperatingMode, Operation, Optimum, Outcome, PassengerViews, Temperatures,
    Vehicle,
};

use super::problem::{DoorLaw, N, Problem, SampleModel, Variable};
use super::quadratic::{Multipliers, Quadratic};
use super::sqp::{self, End, Ended};
use super::vote::VoteForm;
use crate::Grid;
use crate::blocks::{Block, in_blocks};

/// Heat below this in kW is none: the least that a KKT residual of 1e-8 can tell from zero, with room to spare.
const NO_HEAT_KW: f64 = 1e-6;

/// What a point has cost to solve.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Programs: one for each choice of heaters and curtain that the design has.
    pub programs: u32,
    /// Quadratic subproblems of all of them.
    pub subproblems: u32,
    /// Largest scaled KKT residual of the solved ones.
    pub kkt_residual: f64,
}

/// Solves points by the paper's method. One solver a thread.
pub struct NlpSolver<'a> {
    vehicle: &'a Vehicle,
    views: &'a PassengerViews,
    grid: &'a Grid,
    form: &'a VoteForm,
    door_law: DoorLaw,
    quadratic: Quadratic,
}

impl<'a> NlpSolver<'a> {
    /// A solver for a grid.
    #[must_use]
    pub fn new(
        vehicle: &'a Vehicle,
        views: &'a PassengerViews,
        grid: &'a Grid,
        form: &'a VoteForm,
        door_law: DoorLaw,
    ) -> Self {
        Self { vehicle, views, grid, form, door_law, quadratic: Quadratic::new() }
    }

    /// Solves every design and window for one sample, in the order of [`crate::SampleSolver::solve`]. A window starts from
    /// the one before it; the first from nothing.
    pub fn solve(&mut self, disturbances: &Disturbances, results: &mut [(Optimum, Effort)]) {
        let windows = self.grid.windows().len();
        for (design, results) in results.chunks_mut(windows).enumerate() {
            // A solver scales by the first numbers it sees; a new one keeps a design's results free of what came before.
            self.quadratic = Quadratic::new();
            self.solve_design(disturbances, design, results);
        }
    }

    /// Solves one point from a cold start.
    pub fn solve_point(&mut self, disturbances: &Disturbances, design: usize, window: usize) -> (Outcome, Effort) {
        self.quadratic = Quadratic::new();
        let model = SampleModel::new(self.vehicle, self.views, disturbances, self.form, self.door_law);
        let mut best = Best::default();
        for devices in self.choices(design) {
            let problem = self.problem(&model, design, window, devices);
            let end = sqp::solve(&problem, &mut self.quadratic, sqp::cold_start(&problem), Multipliers::default());
            best.take(&problem, &end);
        }
        (best.outcome(self.vehicle, self.views, disturbances), best.effort)
    }

    fn solve_design(&mut self, d: &Disturbances, design: usize, results: &mut [(Optimum, Effort)]) {
        let model = SampleModel::new(self.vehicle, self.views, d, self.form, self.door_law);
        let mut bests = vec![Best::default(); results.len()];
        for devices in self.choices(design) {
            let mut neighbour: Option<End> = None;
            for (window, best) in bests.iter_mut().enumerate() {
                let problem = self.problem(&model, design, window, devices);
                let (x, multipliers) = match &neighbour {
                    Some(end) if end.ended == Ended::Solved => (end.x, end.multipliers),
                    _ => (sqp::cold_start(&problem), Multipliers::default()),
                };
                let end = sqp::solve(&problem, &mut self.quadratic, x, multipliers);
                best.take(&problem, &end);
                neighbour = Some(end);
            }
        }
        for (window, (best, result)) in bests.iter().zip(results).enumerate() {
            let outcome = best.outcome(self.vehicle, self.views, d);
            *result = (Optimum { design, window, outcome }, best.effort);
        }
    }

    /// The choices that a design has. Curtain before heaters: among equally cheap programs the first one wins.
    fn choices(&self, design: usize) -> impl Iterator<Item = Devices> + use<> {
        let devices = self.grid.designs()[design].devices;
        Devices::CHOICES.into_iter().filter(move |&choice| devices.include(choice))
    }

    fn problem<'m>(&self, model: &'m SampleModel<'m>, design: usize, window: usize, devices: Devices) -> Problem<'m>
    where
        'a: 'm,
    {
        let grid: &'a Grid = self.grid;
        Problem { model, design: &grid.designs()[design], window: grid.windows()[window], devices }
    }
}

/// The cheapest of the programs so far.
#[derive(Debug, Clone, Copy, Default)]
struct Best {
    end: Option<(End, Devices)>,
    second_kw: Option<f64>,
    effort: Effort,
    lost: bool,
    infeasible: Option<Infeasible>,
}

impl Best {
    fn take(&mut self, problem: &Problem<'_>, end: &End) {
        self.effort.programs += 1;
        self.effort.subproblems += end.subproblems;
        match end.ended {
            Ended::NotConverged => self.lost = true,
            Ended::Infeasible => {
                let cold = end.vote < problem.window.pmv_min();
                self.infeasible = Some(if cold { Infeasible::TooCold } else { Infeasible::TooWarm });
            }
            // Panels that would have to be cooled cannot be held at their target.
            Ended::Solved if end.x[Variable::RadiantHeaterPower as usize] < -NO_HEAT_KW => {
                self.infeasible = Some(Infeasible::TooWarm);
            }
            Ended::Solved => {
                self.effort.kkt_residual = self.effort.kkt_residual.max(end.residual);
                let second_kw = match self.end {
                    Some((best, ..)) if best.power_kw <= end.power_kw => Some(end.power_kw),
                    before => {
                        self.end = Some((*end, problem.devices));
                        before.map(|(best, ..)| best.power_kw)
                    }
                };
                self.second_kw = match (self.second_kw, second_kw) {
                    (Some(a), Some(b)) => Some(a.min(b)),
                    (a, b) => a.or(b),
                };
            }
        }
    }

    fn outcome(&self, vehicle: &Vehicle, views: &PassengerViews, d: &Disturbances) -> Outcome {
        match (self.lost, self.end, self.infeasible) {
            (true, ..) => Outcome::NotConverged,
            (false, Some((end, devices)), _) => {
                let gap_w = self.second_kw.map(|second| 1e3 * (second - end.power_kw));
                Outcome::Solved(operation(&end, devices, vehicle, views, d), gap_w)
            }
            (false, None, Some(reason)) => Outcome::Infeasible(reason),
            (false, None, None) => Outcome::NotConverged,
        }
    }
}

/// The operation that a solved program stands for.
fn operation(end: &End, devices: Devices, vehicle: &Vehicle, views: &PassengerViews, d: &Disturbances) -> Operation {
    let x: &[f64; N] = &end.x;
    let at = |variable: Variable| x[variable as usize];
    let cabin = Cabin::new(vehicle, views, d);
    let temperatures = Temperatures {
        cabin_k: at(Variable::Cabin),
        interior_k: at(Variable::Interior),
        shell_inside_k: at(Variable::ShellInside),
        shell_outside_k: at(Variable::ShellOutside),
        radiant_heater_k: at(Variable::RadiantHeater),
    };
    let heat_kw = at(Variable::Heat) + at(Variable::Cool);
    let (mode, air_unit_heat_w) = match heat_kw {
        kw if kw > NO_HEAT_KW => (OperatingMode::Heating, 1e3 * kw),
        kw if kw < -NO_HEAT_KW => (OperatingMode::Cooling, 1e3 * kw),
        _ => (OperatingMode::Passive, 0.0),
    };
    let radiant_heater_power_w = if devices.radiant_heaters { 1e3 * at(Variable::RadiantHeaterPower) } else { 0.0 };
    let air_curtain_power_w = if devices.air_curtain { cabin.air_curtain_power_w() } else { 0.0 };
    let air_unit_power_w = match mode {
        OperatingMode::Passive => 0.0,
        _ => 1e3 * end.power_kw - radiant_heater_power_w - air_curtain_power_w,
    };
    let mean_radiant_temperature_k = cabin.mean_radiant_temperature_k(&temperatures);
    Operation {
        mode,
        devices,
        air_unit_power_w,
        radiant_heater_power_w,
        air_curtain_power_w,
        backup_heater_power_w: 0.0,
        air_unit_heat_w,
        unmet_heat_w: 0.0,
        temperatures,
        mean_radiant_temperature_k,
        pmv: end.vote,
        standard_range: cabin.standard_range(temperatures.cabin_k, mean_radiant_temperature_k, end.vote),
    }
}

/// Samples that one task solves: some hundredths of a second each, so that a wave of them ends soon after it is asked to.
const BLOCK: Block = Block { samples: 2, a_thread: 4 };

/// As [`crate::solve_blocks`], by the paper's method; `consume` also gets what each point has cost.
pub fn nlp_blocks(
    vehicle: &Vehicle,
    grid: &Grid,
    samples: &[Disturbances],
    form: &VoteForm,
    door_law: DoorLaw,
    consume: impl FnMut(usize, &[(Optimum, Effort)]) -> bool,
) -> bool {
    let views = PassengerViews::new(vehicle);
    let unsolved = (Optimum::UNSOLVED, Effort::default());
    let solver = || NlpSolver::new(vehicle, &views, grid, form, door_law);
    in_blocks(samples, grid.points(), BLOCK, unsolved, solver, NlpSolver::solve, consume)
}
