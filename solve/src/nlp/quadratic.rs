//! The quadratic subproblem, solved by Clarabel; built once, then only its numbers change.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};

use super::problem::{BALANCES, N, Variable};

/// Variables of the subproblem: the step, and by how much the linearised window is missed.
pub(crate) const SUB: usize = N + 1;
const ELASTIC: usize = N;
const EQUATIONS: usize = BALANCES + 1;
const ROWS: usize = EQUATIONS + 7;

/// Rows after the balances.
const VANISHING: usize = BALANCES;
const HEAT_SIGN: usize = EQUATIONS;
const COOL_SIGN: usize = EQUATIONS + 1;
const VOTE_UPPER: usize = EQUATIONS + 2;
const VOTE_LOWER: usize = EQUATIONS + 3;
const ELASTIC_SIGN: usize = EQUATIONS + 4;
const STEP_UPPER: usize = EQUATIONS + 5;
const STEP_LOWER: usize = EQUATIONS + 6;

/// The numbers of a subproblem: the least of `½ d·H d + g·d + penalty · e` over a step `d` and an elastic `e`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Numbers {
    pub hessian: [[f64; N]; N],
    pub gradient: [f64; N],
    pub penalty: f64,
    pub balance_rows: [[f64; N]; BALANCES],
    /// What the rows of the balances have to give.
    pub balances: [f64; BALANCES],
    /// The variable that the vanishing constraint fixes, and its step.
    pub vanishing: (usize, f64),
    /// Heat and cool may fall, respectively rise, by so much.
    pub heat_room: f64,
    pub cool_room: f64,
    pub vote_gradient: [f64; N],
    /// How far the vote may rise and fall.
    pub vote_rise: f64,
    pub vote_fall: f64,
    /// How far the cabin temperature may rise and fall in K.
    pub cabin_rise: f64,
    pub cabin_fall: f64,
}

/// Its solution.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub d: [f64; N],
    pub elastic: f64,
    pub multipliers: Multipliers,
}

/// Multipliers: of the balances and the vanishing constraint with any sign, of the inequalities not negative.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Multipliers {
    pub balances: [f64; BALANCES],
    pub vanishing: f64,
    pub heat_sign: f64,
    pub cool_sign: f64,
    pub vote_upper: f64,
    pub vote_lower: f64,
}

/// The solver with its buffers.
pub(crate) struct Quadratic {
    solver: Option<DefaultSolver<f64>>,
    p: Vec<f64>,
    q: Vec<f64>,
    a: Vec<f64>,
    b: Vec<f64>,
}

/// Which variables a row of the constraints can have; the first five are the balances.
const PATTERN: [&[usize]; ROWS] = {
    const C: usize = Variable::Cabin as usize;
    const I: usize = Variable::Interior as usize;
    const S: usize = Variable::ShellInside as usize;
    const O: usize = Variable::ShellOutside as usize;
    const H: usize = Variable::RadiantHeater as usize;
    const HEAT: usize = Variable::Heat as usize;
    const COOL: usize = Variable::Cool as usize;
    const P: usize = Variable::RadiantHeaterPower as usize;
    [
        &[C, I, S, H, P],
        &[C, I, S, H],
        &[C, I, S, H, HEAT, COOL],
        &[C, I, S, O, H],
        &[S, O],
        &[H, P],
        &[HEAT],
        &[COOL],
        &[C, I, S, H, ELASTIC],
        &[C, I, S, H, ELASTIC],
        &[ELASTIC],
        &[C],
        &[C],
    ]
};

impl Quadratic {
    pub fn new() -> Self {
        Self { solver: None, p: Vec::new(), q: Vec::new(), a: Vec::new(), b: Vec::new() }
    }

    /// Solves the subproblem; `None` where Clarabel does not. Where it stalls, which one in some million subproblems does,
    /// it is tried again from a new solver, whose scaling fits these very numbers, and then without curvature.
    pub fn solve(&mut self, numbers: &Numbers) -> Option<Step> {
        if let Some(step) = self.attempt(numbers) {
            return Some(step);
        }
        self.solver = None;
        if let Some(step) = self.attempt(numbers) {
            return Some(step);
        }
        let flat = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1e-3 } else { 0.0 }));
        self.solver = None;
        let step = self.attempt(&Numbers { hessian: flat, ..*numbers });
        self.solver = None;
        step
    }

    fn attempt(&mut self, numbers: &Numbers) -> Option<Step> {
        self.fill(numbers);
        if let Some(solver) = &mut self.solver {
            solver.update_P(&self.p).ok()?;
            solver.update_q(&self.q).ok()?;
            solver.update_A(&self.a).ok()?;
            solver.update_b(&self.b).ok()?;
        } else {
            let cones = [ZeroConeT(EQUATIONS), NonnegativeConeT(ROWS - EQUATIONS)];
            let (p, a) = (self.p_matrix(), self.a_matrix());
            self.solver = DefaultSolver::new(&p, &self.q, &a, &self.b, &cones, settings()).ok();
        }
        let solver = self.solver.as_mut()?;
        solver.solve();
        let solution = &solver.solution;
        if !matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved) {
            return None;
        }
        let (x, z) = (&solution.x, &solution.z);
        let multipliers = Multipliers {
            balances: std::array::from_fn(|i| z[i]),
            vanishing: z[VANISHING],
            heat_sign: z[HEAT_SIGN],
            cool_sign: z[COOL_SIGN],
            vote_upper: z[VOTE_UPPER],
            vote_lower: z[VOTE_LOWER],
        };
        Some(Step { d: std::array::from_fn(|i| x[i]), elastic: x[ELASTIC], multipliers })
    }

    /// Writes the numbers into the buffers, column by column.
    fn fill(&mut self, n: &Numbers) {
        self.p.clear();
        for j in 0..N {
            self.p.extend((0..=j).map(|i| n.hessian[i][j]));
        }
        self.q.clear();
        self.q.extend_from_slice(&n.gradient);
        self.q.push(n.penalty);
        self.a.clear();
        for j in 0..SUB {
            self.a.extend((0..ROWS).filter(|&i| PATTERN[i].contains(&j)).map(|i| coefficient(n, i, j)));
        }
        self.b.clear();
        self.b.extend_from_slice(&n.balances);
        self.b.extend([
            n.vanishing.1,
            n.heat_room,
            n.cool_room,
            n.vote_rise,
            n.vote_fall,
            0.0,
            n.cabin_rise,
            n.cabin_fall,
        ]);
    }

    fn p_matrix(&self) -> CscMatrix<f64> {
        let mut starts: Vec<usize> = (0..=N).map(|j| j * (j + 1) / 2).collect();
        starts.push(starts[N]);
        CscMatrix::new(SUB, SUB, starts, (0..N).flat_map(|j| 0..=j).collect(), self.p.clone())
    }

    fn a_matrix(&self) -> CscMatrix<f64> {
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for j in 0..SUB {
            rows.extend((0..ROWS).filter(|&i| PATTERN[i].contains(&j)));
            starts.push(rows.len());
        }
        CscMatrix::new(ROWS, SUB, starts, rows, self.a.clone())
    }
}

fn coefficient(n: &Numbers, row: usize, column: usize) -> f64 {
    match row {
        0..BALANCES => n.balance_rows[row][column],
        VANISHING => f64::from(u8::from(column == n.vanishing.0)),
        HEAT_SIGN | ELASTIC_SIGN | STEP_LOWER => -1.0,
        COOL_SIGN | STEP_UPPER => 1.0,
        VOTE_UPPER | VOTE_LOWER if column == ELASTIC => -1.0,
        VOTE_UPPER => n.vote_gradient[column],
        _ => -n.vote_gradient[column],
    }
}

fn settings() -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        // Ten are usual.
        max_iter: 60,
        max_threads: 1,
        // Presolving would change the shape, and then the numbers could not be updated.
        presolve_enable: false,
        tol_gap_abs: 1e-11,
        tol_gap_rel: 1e-11,
        tol_feas: 1e-11,
        ..DefaultSettings::default()
    }
}
