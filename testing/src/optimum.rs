//! Single optima.

use cabin::{ComfortWindow, Design, Disturbances, Operation, Optimum, Outcome, PassengerViews, Vehicle};
use solve::{Grid, SampleSolver};

/// The operation of a solved optimum.
///
/// # Panics
/// Where there is none.
#[must_use]
pub fn operation(optimum: &Optimum) -> Operation {
    match optimum.outcome {
        Outcome::Solved(operation, _) => operation,
        other => panic!("{other:?}"),
    }
}

/// The optimum of one design in one symmetric window.
///
/// # Panics
/// Where there is none.
#[must_use]
pub fn optimum(
    vehicle: &Vehicle,
    views: &PassengerViews,
    design: &Design,
    disturbances: &Disturbances,
    pmv_limit: f64,
) -> Operation {
    let window = ComfortWindow::symmetric(pmv_limit).expect("a limit on the scale");
    let grid = Grid::new(vec![design.clone()], vec![window]).expect("one design, one window");
    let mut optima = [Optimum::UNSOLVED];
    SampleSolver::new(vehicle, views, &grid).solve(disturbances, &mut optima);
    operation(&optima[0])
}
