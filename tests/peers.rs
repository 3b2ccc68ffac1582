//! Other people's programs beside ours. Each test runs a script of `tests/peers/` and is skipped, with a line that says so,
//! where Python or the packages of `tests/peers/requirements.txt` are absent.
//!
//! `BUSCLIMATE_PEER_SAMPLES` says how many samples Ipopt solves, 100 otherwise.

use cabin::{
    ComfortWindow, Disturbances, Optimum, Outcome, PassengerViews, PmvModel, SolarGains, Vehicle, kelvin,
    place_passengers, predicted_percentage_dissatisfied,
};
use chrono::{DateTime, Datelike};
use ingest::irradiance::{closure, erbs};
use solve::nlp::{DoorLaw, Effort, NlpSolver, VoteForm};
use solve::{Grid, SampleSolver};
use std::time::Instant;
use testing::{paper_designs, peer};

fn numbers(row: &[String]) -> Vec<f64> {
    row.iter().map(|c| c.parse().unwrap_or_else(|_| panic!("{c:?} is no number"))).collect()
}

/// Annex D as the standard prints it, with its own tolerance of 0.00015 where `tolerance` says so: what other programs do.
fn annex_d(air_c: f64, radiant_c: f64, speed: f64, humidity_percent: f64, met: f64, clo: f64, tolerance: f64) -> f64 {
    let pa = humidity_percent * 10.0 * (16.6536 - 4030.183 / (air_c + 235.0)).exp();
    let (icl, m) = (0.155 * clo, 58.15 * met);
    let fcl = if icl <= 0.078 { 1.0 + 1.29 * icl } else { 1.05 + 0.645 * icl };
    let hcf = 12.1 * speed.sqrt();
    let (taa, tra) = (air_c + 273.0, radiant_c + 273.0);
    let p1 = icl * fcl;
    let (p2, p3, p4) = (3.96 * p1, 100.0 * p1, p1 * taa);
    let p5 = 308.7 - 0.028 * m + p2 * (tra / 100.0).powi(4);
    let mut xn = (taa + (35.5 - air_c) / (3.5 * (6.45 * icl + 0.1))) / 100.0;
    let mut xf = 2.0 * xn;
    let mut hc = hcf;
    for _ in 0..500 {
        if (xn - xf).abs() <= tolerance {
            break;
        }
        xf = 0.5 * (xf + xn);
        hc = hcf.max(2.38 * (100.0 * xf - taa).abs().powf(0.25));
        xn = (p5 + p4 * hc - p2 * xf.powi(4)) / (100.0 + p3 * hc);
    }
    let tcl = 100.0 * xn - 273.0;
    let sweat = if m > 58.15 { 0.42 * (m - 58.15) } else { 0.0 };
    let loss = 3.05e-3 * (5733.0 - 6.99 * m - pa)
        + sweat
        + 1.7e-5 * m * (5867.0 - pa)
        + 0.0014 * m * (34.0 - air_c)
        + 3.96 * fcl * (xn.powi(4) - (tra / 100.0).powi(4))
        + fcl * hc * (tcl - air_c);
    (0.303 * (-0.036 * m).exp() + 0.028) * (m - loss)
}

#[test]
fn xval_pythermalcomfort_pmv_and_ppd() {
    let Some(rows) = peer("pmv.py", "pythermalcomfort", &[]) else { return };
    assert!(rows.len() > 10_000, "{}", rows.len());
    let (mut largest_annex, mut largest_own) = (0.0_f64, 0.0_f64);
    for row in rows {
        let v = numbers(&row);
        let [air, radiant, speed, humidity, met, clo, pmv, ppd] = v[..] else { panic!("{row:?}") };
        // Its stop rule, the annex's, leaves up to some thousandths; with the same rule nothing is left.
        let annex = annex_d(air, radiant, speed, humidity, met, clo, 0.000_15);
        largest_annex = largest_annex.max((annex - pmv).abs());
        assert!((annex - pmv).abs() < 1e-3, "{row:?}: {annex}");
        assert!((predicted_percentage_dissatisfied(pmv) - ppd).abs() < 1e-3, "{row:?}");
        // Converged, the annex's own iteration gives our vote.
        let ours = PmvModel::new(clo, met, humidity / 100.0, speed).at(air, radiant).pmv;
        let converged = annex_d(air, radiant, speed, humidity, met, clo, 1e-13);
        assert!((ours - converged).abs() < 1e-8 * (1.0 + ours.abs()), "{row:?}: {ours} {converged}");
        largest_own = largest_own.max((ours - pmv).abs());
    }
    println!(
        "largest difference from pythermalcomfort: {largest_annex:.1e} with its stop rule, {largest_own:.1e} converged"
    );
}

#[test]
fn xval_thermalcomfort_pmv_and_ppd() {
    use thermalcomfort::models::pmv::{PmvPpdInputs, PmvPpdIsoOptions, pmv_ppd_iso};
    use thermalcomfort::{ClothingInsulation, Humidity, MetabolicRate, Speed, Temperature};
    let options = PmvPpdIsoOptions { limit_inputs: false, round_output: false, ..Default::default() };
    for air in [10.0, 16.0, 22.0, 30.0] {
        for radiant in [10.0, 20.0, 40.0] {
            for clo in [0.3, 0.5, 1.13, 2.0] {
                for met in [0.8, 1.2, 4.0] {
                    let inputs = PmvPpdInputs {
                        tdb: Temperature::from_celsius(air),
                        tr: Temperature::from_celsius(radiant),
                        vr: Speed::from_meters_per_second(0.1),
                        rh: Humidity::from_percent(40.0),
                        met: MetabolicRate::from_met(met),
                        clo: ClothingInsulation::from_clo(clo),
                    };
                    let theirs = pmv_ppd_iso(inputs, options);
                    let annex = annex_d(air, radiant, 0.1, 40.0, met, clo, 0.000_15);
                    assert!((annex - theirs.pmv).abs() < 1e-3, "{air} {radiant} {clo} {met}: {annex} {}", theirs.pmv);
                    assert!((predicted_percentage_dissatisfied(theirs.pmv) - theirs.ppd).abs() < 1e-3);
                }
            }
        }
    }
}

#[test]
fn xval_pvlib_sun_erbs_and_closure() {
    let (latitude, longitude) = (47.3779, 8.5657);
    let arguments = [latitude.to_string(), longitude.to_string(), "2021".to_owned()];
    let Some(rows) = peer("sun.py", "pvlib", &arguments) else { return };
    assert_eq!(rows.len(), 8760);
    let site = shading::Site::new(latitude, longitude).expect("on the globe");
    let (mut altitude_off, mut dni_off) = (0.0_f64, 0.0_f64);
    for row in rows {
        let time = DateTime::parse_from_rfc3339(&row[0]).expect("a time").to_utc();
        let v = numbers(&row[1..]);
        let [altitude_deg, _, ghi, dni, dhi, closed] = v[..] else { panic!("{row:?}") };
        if altitude_deg > -5.0 {
            let off = (site.sun(time).altitude_rad.to_degrees() - altitude_deg).abs();
            assert!(off < 0.02, "{row:?}: {off}°");
            altitude_off = altitude_off.max(off);
        }
        if altitude_deg > 3.0 {
            let split = erbs(ghi, altitude_deg.to_radians(), time.ordinal());
            assert!((split.dni_w_m2 - dni).abs() < 1.0 && (split.dhi_w_m2 - dhi).abs() < 1.0, "{row:?}: {split:?}");
            dni_off = dni_off.max((split.dni_w_m2 - dni).abs());
            let ours = closure(ghi, 0.4 * ghi, altitude_deg.to_radians(), time.ordinal());
            assert!((ours.dni_w_m2 - closed).abs() < 1.0, "{row:?}: {ours:?}");
        }
    }
    println!("largest difference from pvlib: altitude {altitude_off:.4}°, DNI {dni_off:.1e} W/m²");
}

/// A year-like spread: incommensurable cycles of season, day, clouds and load.
fn samples(count: usize) -> Vec<Disturbances> {
    let cycle = |i: usize, period: f64| 0.5 - 0.5 * (i as f64 * std::f64::consts::TAU / period).cos();
    (0..count)
        .map(|i| {
            let day = cycle(i, 7.3);
            Disturbances {
                ambient_temperature_k: kelvin(-9.0 + 28.0 * cycle(i, count as f64) + 10.0 * day + 5.0 * cycle(i, 31.7)),
                dni_w_m2: 850.0 * day * cycle(i, 11.3),
                dhi_w_m2: 250.0 * day,
                solar_altitude_rad: -0.2 + 1.2 * day,
                shadow_fraction: 1.0 - 0.7 * day,
                passengers: 45.0 * cycle(i, 9.1),
                door_open_fraction: 0.10 + 0.08 * cycle(i, 17.9),
            }
        })
        .collect()
}

#[test]
fn xval_casadi_ipopt_optima() {
    let vehicle = Vehicle::default();
    // Eight passengers over the whole range of view factors; both sides take the plain mean of their votes.
    let mut placed = place_passengers(&vehicle);
    placed.sort_by(f64::total_cmp);
    let few: Vec<f64> = (0..8).map(|i| placed[i * (placed.len() - 1) / 7]).collect();
    let views = PassengerViews::from_view_factors(&few);
    let limits = [0.0, 0.25, 0.5, 1.0, 1.5, 2.0];
    let windows = limits.iter().map(|&l| ComfortWindow::symmetric(l).expect("valid")).collect();
    let grid = Grid::new(paper_designs(), windows).expect("valid");
    let count =
        std::env::var("BUSCLIMATE_PEER_SAMPLES").map_or(100, |count| count.parse().expect("a number of samples"));
    let samples = samples(count);

    let mut cases = String::new();
    for d in &samples {
        let sun = SolarGains::new(&vehicle, d);
        for design in grid.designs() {
            for window in grid.windows() {
                cases += &format!(
                    "{},{},{},{},{},{},{},{},{}\n",
                    d.ambient_temperature_k,
                    sun.interior_w,
                    sun.shell_inside_w,
                    sun.shell_outside_w,
                    d.passengers,
                    d.door_open_fraction,
                    design.name,
                    window.pmv_min(),
                    window.pmv_max()
                );
            }
        }
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path().join("cases.csv");
    std::fs::write(&path, cases).expect("the cases are written");
    let mut arguments = vec![path.display().to_string()];
    arguments.extend(few.iter().map(f64::to_string));
    let Some(mut theirs) = peer("optima.py", "casadi", &arguments) else { return };
    let effort = numbers(&theirs.pop().expect("the script ends with its effort"));

    let mut optima = vec![Optimum::UNSOLVED; grid.points()];
    let (mut compared, mut lost, mut largest_w) = (0, 0, 0.0_f64);
    let mut fast = SampleSolver::new(&vehicle, &views, &grid);
    for (d, rows) in samples.iter().zip(theirs.chunks(grid.points())) {
        fast.solve(d, &mut optima);
        for (optimum, row) in optima.iter().zip(rows) {
            let Outcome::Solved(ours, _) = optimum.outcome else { panic!("{optimum:?}") };
            let theirs_w = numbers(row)[0];
            if theirs_w.is_nan() {
                lost += 1;
                continue;
            }
            compared += 1;
            let off_w = (ours.hvac_power_w() - theirs_w).abs();
            largest_w = largest_w.max(off_w);
            assert!(off_w < (1e-6 * theirs_w).max(0.05), "{d:?} {optimum:?}: Ipopt finds {row:?}");
        }
    }
    assert!(lost * 1000 <= compared, "Ipopt lost {lost} of {compared}");

    // How long each takes a point, on one core: told, not judged.
    let points = samples.len() * grid.points();
    let begin = Instant::now();
    let rounds = 20;
    for _ in 0..rounds {
        for d in &samples {
            fast.solve(d, &mut optima);
        }
    }
    let fast_s = begin.elapsed().as_secs_f64() / f64::from(rounds) / points as f64;
    let mut program = NlpSolver::new(&vehicle, &views, &grid, &VoteForm::Exact, DoorLaw::Exact);
    let mut results = vec![(Optimum::UNSOLVED, Effort::default()); grid.points()];
    let begin = Instant::now();
    let (mut programs, mut subproblems) = (0, 0);
    for d in samples.iter().step_by(10) {
        program.solve(d, &mut results);
        programs += results.iter().map(|(_, e)| e.programs).sum::<u32>();
        subproblems += results.iter().map(|(_, e)| e.subproblems).sum::<u32>();
    }
    let program_s = begin.elapsed().as_secs_f64() / f64::from(programs);
    let each = f64::from(subproblems) / f64::from(programs);
    let (ipopt_s, ipopt_point_s) = (effort[1] / effort[0], effort[1] / points as f64);
    println!("{compared} points compared, {lost} without a solution of Ipopt, largest difference {largest_w:.1e} W");
    println!("| program | time a problem | time a point |\n|---|---:|---:|");
    println!("| CasADi + Ipopt + MUMPS | {:.2} ms | {:.2} ms |", 1e3 * ipopt_s, 1e3 * ipopt_point_s);
    println!("| Clarabel SQP, {each:.1} subproblems each | {:.3} ms | |", 1e3 * program_s);
    println!("| fast method | | {:.0} ns |", 1e9 * fast_s);
    println!("ratios: Ipopt to SQP {:.1}, Ipopt to fast method {:.0}", ipopt_s / program_s, ipopt_point_s / fast_s);
}
