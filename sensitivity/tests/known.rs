//! Functions whose indices are known, and what indices and variations have to be whatever the function.

use cabin::{ComfortWindow, Vehicle};
use sensitivity::{
    Analysis, AnalysisError, Index, Input, Quantity, Resamples, Saltelli, Spread, Variation, VariationError, indices,
};
use solve::{Grid, YearSamples};
use std::f64::consts::PI;
use testing::{all_designs, paper_designs, year};

fn solved(design: &Saltelli, function: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    (0..design.sets()).map(|set| function(&design.set(set).collect::<Vec<_>>())).collect()
}

fn of(design: &Saltelli, function: impl Fn(&[f64]) -> f64) -> Vec<Index> {
    indices(design, &solved(design, function), &Resamples::new(design.points, 200, 1)).expect("it varies")
}

/// Ishigami and Homma 1990 with a = 7, b = 0.1: S = 0.3139, 0.4424, 0; S_T = 0.5576, 0.4424, 0.2437 (variances in closed form).
#[test]
fn xval_ishigami_has_its_known_indices() {
    let design = Saltelli { points: 1 << 14, inputs: 3, seed: 7 };
    let found = of(&design, |u| {
        let [x, y, z] = [0, 1, 2].map(|i| (2.0 * u[i] - 1.0) * PI);
        x.sin() + 7.0 * y.sin().powi(2) + 0.1 * z.powi(4) * x.sin()
    });
    let variance = 7.0_f64.powi(2) / 8.0 + 0.1 * PI.powi(4) / 5.0 + 0.01 * PI.powi(8) / 18.0 + 0.5;
    let first = [0.5 * (1.0 + 0.1 * PI.powi(4) / 5.0).powi(2), 7.0_f64.powi(2) / 8.0, 0.0].map(|v| v / variance);
    let mixed = 0.01 * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0) / variance;
    let total = [first[0] + mixed, first[1], mixed];
    for (i, index) in found.iter().enumerate() {
        assert!((index.first - first[i]).abs() < 3e-3, "{i}: {} {}", index.first, first[i]);
        assert!((index.total - total[i]).abs() < 3e-3, "{i}: {} {}", index.total, total[i]);
        let [low, high] = index.total_ends;
        assert!(low <= index.total && index.total <= high && high - low < 0.05, "{index:?}");
    }
}

/// Sobol's g-function with a = 0, 1, 4.5, 9, 99: V_i = (1/3)/(1 + a_i)², V = Π(1 + V_i) − 1 (Saltelli et al. 2010).
#[test]
fn xval_the_g_function_has_its_known_indices() {
    const A: [f64; 5] = [0.0, 1.0, 4.5, 9.0, 99.0];
    let design = Saltelli { points: 1 << 14, inputs: 5, seed: 3 };
    let found = of(&design, |u| u.iter().zip(A).map(|(u, a)| ((4.0 * u - 2.0).abs() + a) / (1.0 + a)).product());
    let parts = A.map(|a| 1.0 / 3.0 / (1.0 + a) / (1.0 + a));
    let all: f64 = parts.iter().map(|v| 1.0 + v).product();
    for ((index, part), i) in found.iter().zip(parts).zip(0..) {
        let (first, total) = (part / (all - 1.0), part * all / (1.0 + part) / (all - 1.0));
        assert!((index.first - first).abs() < 3e-3, "{i}: {} {first}", index.first);
        assert!((index.total - total).abs() < 3e-3, "{i}: {} {total}", index.total);
    }
}

#[test]
fn prop_indices_of_a_sum_add_up_to_one_and_equal_the_totals() {
    let design = Saltelli { points: 1 << 12, inputs: 4, seed: 1 };
    let found = of(&design, |u| 3.0 * u[0] + 2.0 * u[1] - u[2]);
    let sums = found.iter().fold([0.0, 0.0], |sum, i| [sum[0] + i.first, sum[1] + i.total]);
    assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 5e-3), "{sums:?}");
    assert!(found.iter().all(|i| (i.first - i.total).abs() < 5e-3), "{found:?}");
    // An input without an effect has none to the last bit.
    assert_eq!((found[3].first, found[3].total), (0.0, 0.0));
    assert_eq!(indices(&design, &vec![2.5; design.sets()], &Resamples::new(4, 3, 1)), None);
}

#[test]
fn prop_the_design_has_the_order_of_salib() {
    let design = Saltelli { points: 8, inputs: 3, seed: 5 };
    let row = |set: usize| design.set(set).collect::<Vec<_>>();
    for point in 0..8 {
        let from = point * design.sets_a_point();
        let (a, b) = (row(from), row(from + 4));
        for input in 0..3 {
            let mixed = row(from + 1 + input);
            assert!((0..3).all(|i| mixed[i] == if i == input { b[i] } else { a[i] }));
            assert!(a[input] != b[input] && (0.0..1.0).contains(&a[input]) && a[input] > 0.0);
        }
    }
    assert_ne!(row(0), Saltelli { seed: 6, ..design }.set(0).collect::<Vec<_>>());
}

#[test]
fn prop_quantiles_are_those_of_the_spread() {
    let normal = Spread::Normal { mean: 3.0, sd: 2.0 };
    // Tables of the standard normal distribution: 0.95 at 1.6449.
    assert!((normal.quantile(0.95) - (3.0 + 2.0 * 1.644_853_627)).abs() < 1e-8, "{}", normal.quantile(0.95));
    assert_eq!(Spread::Uniform { low: 1.0, high: 3.0 }.quantile(0.25), 1.5);
    let triangle = Spread::Triangular { low: 0.0, mode: 1.0, high: 4.0 };
    // A quarter of the area lies left of the mode.
    assert!((triangle.quantile(0.25) - 1.0).abs() < 1e-12 && triangle.quantile(0.0) == 0.0);
    assert!((triangle.quantile(1.0) - 4.0).abs() < 1e-12);
    let wrong = Input { name: "other_heat_w".to_owned(), spread: Spread::Uniform { low: 2.0, high: 1.0 } };
    assert!(matches!(wrong.check(), Err(VariationError::Spread { .. })));
}

fn samples() -> YearSamples {
    let mut samples = YearSamples::default();
    for (i, sample) in year().into_iter().step_by(29).enumerate() {
        samples.add((i % 12) as u8 + 1, sample);
    }
    samples
}

fn grid(limit: f64) -> Grid {
    Grid::new(all_designs(), vec![ComfortWindow::symmetric(limit).expect("valid")]).expect("valid")
}

#[test]
fn prop_a_variation_without_an_override_is_the_bus_bit_for_bit() {
    let (samples, grid, vehicle) = (samples(), grid(0.5), Vehicle::default());
    let analysis = Analysis::new(&samples, &vehicle, &grid, Some(0));
    let base = Variation::none(&vehicle);
    let same = base.with([("heating_cop_scale", 1.0), ("shell_area_m2", vehicle.shell_area_m2)]).expect("inputs");
    assert_eq!(same, base);
    assert_eq!(analysis.year(&same), analysis.year(&base));
    assert_eq!(analysis.year(&base.with([]).expect("nothing")), analysis.year(&base));
}

#[test]
fn prop_an_input_out_of_its_range_is_said_by_name() {
    let base = Variation::none(&Vehicle::default());
    let said = |values: [(&str, f64); 1]| base.with(values).expect_err("wrong").to_string();
    assert!(said([("heating_cop_scal", 1.0)]).contains("did you mean heating_cop_scale?"));
    assert!(said([("ambient_offset_k", 90.0)]).contains("must lie between -30 and 20"));
    assert!(said([("panel_rows", 2.5)]).contains("whole number"));
    assert!(said([("shell_area_m2", f64::NAN)]).contains("shell_area_m2 = NaN"));
    let (samples, grid, vehicle) = (samples(), grid(1.0), Vehicle::default());
    let analysis = Analysis::new(&samples, &vehicle, &grid, None);
    let spread = Spread::Uniform { low: -5.0, high: 1.0 };
    let input = Input { name: "relative_humidity".to_owned(), spread };
    let wrong = analysis.one_at_a_time(&[input]).expect_err("humidity below 0").to_string();
    assert!(wrong.starts_with("relative_humidity = -5: "), "{wrong}");
}

/// The earlier paper's findings: the heat pump's COP has the largest leverage of what can be chosen, cooling's far less; heating takes
/// several times the energy of cooling. (arXiv 2303.00571.)
#[test]
fn paper_heat_pumps_matter_most_and_cooling_far_less() {
    let (samples, vehicle) = (samples(), Vehicle::default());
    let grid = Grid::new(paper_designs(), vec![ComfortWindow::symmetric(1.0).expect("valid")]).expect("valid");
    let analysis = Analysis::new(&samples, &vehicle, &grid, Some(0));
    let names = ["heating_cop_scale", "cooling_cop_scale", "window_transmissivity", "shell_absorptivity"];
    let inputs = names.map(|name| Input::around(name, analysis.base().get(name).expect("an input"), 0.2));
    let (base, swings) = analysis.one_at_a_time(&inputs).expect("years");
    let place = |design: &str, quantity| {
        let design = grid.designs().iter().position(|d| d.name == design).expect("a design");
        analysis.results().iter().position(|r| r.design == design && r.quantity == quantity).expect("a result")
    };
    let hp = place("hp", Quantity::HvacPower);
    let width = |input: usize| {
        let swing = swings.iter().find(|s| s.result == hp && s.input == input).expect("a swing");
        (swing.results[1].expect("solved") - swing.results[0].expect("solved")).abs()
    };
    assert!((1..4).all(|other| width(0) > width(other)), "{:?}", [0, 1, 2, 3].map(width));
    assert!(width(0) > 4.0 * width(1), "{:?}", [0, 1].map(width));
    let of = |quantity| base[place("ptc", quantity)].expect("solved");
    assert!(of(Quantity::HeatingPower) > 4.0 * of(Quantity::CoolingPower));
}

#[test]
fn prop_sets_do_not_depend_on_threads_and_can_be_stopped() {
    let (samples, grid, vehicle) = (samples(), grid(1.0), Vehicle::default());
    let analysis = Analysis::new(&samples, &vehicle, &grid, Some(0));
    let inputs = ["heating_cop_scale", "door_open_scale"].map(|name| Input::around(name, 1.0, 0.2));
    let design = Saltelli { points: 4, inputs: 2, seed: 1 };
    let pool = |threads: usize| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let [one, three] = [1, 3].map(|n| pool(n).install(|| analysis.solve(&inputs, &design, |_| true)));
    assert_eq!(one, three);
    assert_eq!(analysis.solve(&inputs, &design, |_| false), Err(AnalysisError::Stopped));
    // The same set alone, without the design around it.
    let values: Vec<f64> = design.set(1).zip(&inputs).map(|(u, input)| input.spread.quantile(u)).collect();
    let alone = analysis.base().with(inputs.iter().map(|i| i.name.as_str()).zip(values)).expect("inputs");
    let alone: Option<Vec<f64>> = analysis.values(&analysis.year(&alone).expect("a year")).into_iter().collect();
    assert_eq!(alone, Some(one.expect("sets").values[1].clone()));
}
