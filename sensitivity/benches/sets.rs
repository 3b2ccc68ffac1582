//! Time of a study of all inputs on all cores: `cargo bench -p busclimate-sensitivity`. 2,000 samples, five designs, one window,
//! 4,096 sets: 41 million optima.

use cabin::{ComfortWindow, Vehicle};
use divan::{Bencher, counter::ItemsCount};
use sensitivity::{Analysis, Input, Saltelli, Variation};
use solve::{Grid, YearSamples};
use testing::{paper_designs, year};

fn main() {
    divan::main();
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn forty_one_million_optima(bencher: Bencher) {
    let window = ComfortWindow::symmetric(1.0).expect("1 is a limit");
    let grid = Grid::new(paper_designs(), vec![window]).expect("the designs differ");
    let mut samples = YearSamples::default();
    let year = year();
    for i in 0..2000 {
        samples.add((i % 12) as u8 + 1, year[i * year.len() / 2000]);
    }
    let vehicle = Vehicle::default();
    let base = Variation::none(&vehicle);
    let names = [
        "heating_cop_scale",
        "cooling_cop_scale",
        "conduction_shell_w_m2_k",
        "door_open_scale",
        "passengers_scale",
        "shade_scale",
        "window_transmissivity",
        "shell_absorptivity",
        "other_heat_w",
        "convection_inside_w_m2_k",
        "convection_outside_w_m2_k",
        "air_curtain_loss_reduction",
        "relative_humidity",
        "air_velocity_m_s",
    ];
    let inputs = names.map(|name| Input::around(name, base.get(name).expect("an input"), 0.2));
    let design = Saltelli { points: 256, inputs: inputs.len(), seed: 1 };
    assert_eq!(design.sets(), 4096);
    bencher.counter(ItemsCount::new(design.sets() * 2000 * grid.points())).bench_local(|| {
        let analysis = Analysis::new(&samples, &vehicle, &grid, Some(0));
        analysis.solve(&inputs, &design, |_| true).expect("every set has a year")
    });
}
