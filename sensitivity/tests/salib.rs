//! SALib's indices beside ours, from the same values. Skipped where Python or SALib are absent.

use cabin::{ComfortWindow, Vehicle};
use sensitivity::{Analysis, Input, Resamples, Saltelli};
use solve::{Grid, YearSamples};
use testing::{paper_designs, peer, year};

#[test]
fn xval_salib_has_the_same_indices() {
    let mut samples = YearSamples::default();
    for (i, sample) in year().into_iter().step_by(97).enumerate() {
        samples.add((i % 12) as u8 + 1, sample);
    }
    let grid = Grid::new(paper_designs(), vec![ComfortWindow::symmetric(1.0).expect("valid")]).expect("valid");
    let vehicle = Vehicle::default();
    let analysis = Analysis::new(&samples, &vehicle, &grid, Some(0));
    let names = ["heating_cop_scale", "door_open_scale", "shell_absorptivity"];
    let inputs = names.map(|name| Input::around(name, analysis.base().get(name).expect("an input"), 0.3));
    let design = Saltelli { points: 64, inputs: 3, seed: 11 };
    let solved = analysis.solve(&inputs, &design, |_| true).expect("every set has a year");
    let spreadings = analysis.spreadings(&design, &solved, &Resamples::new(64, 10, 1));
    let file = std::env::temp_dir().join(format!("busclimate-salib-{}.txt", std::process::id()));
    let lines = solved.values.iter().map(|set| set.iter().map(f64::to_string).collect::<Vec<_>>().join(" "));
    std::fs::write(&file, lines.collect::<Vec<_>>().join("\n")).expect("written");
    let rows = peer("sobol.py", "SALib", &[file.display().to_string(), "3".to_owned()]);
    std::fs::remove_file(&file).expect("removed");
    let Some(rows) = rows else { return };
    let own: Vec<_> = spreadings.iter().map(|s| s.indices.as_ref().expect("every result varies")).collect();
    assert_eq!(rows.len(), 3 * own.len());
    for (row, own) in rows.iter().zip(own.into_iter().flatten()) {
        let [first, total] = [0, 1].map(|i| row[i].parse::<f64>().expect("a number"));
        assert!((own.first - first).abs() < 1e-9 && (own.total - total).abs() < 1e-9, "{own:?} {row:?}");
    }
}
