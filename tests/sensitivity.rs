//! Buses that differ, what the year depends on, what it costs, and the same bus in other places: from the outside.

use crate::common::Scratch;

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("{text:?} is no number"))
}

fn add(scratch: &Scratch, text: &str) {
    let study = scratch.read("study.toml");
    scratch.write("study.toml", format!("{study}\n{text}"));
}

fn small() -> Scratch {
    Scratch::small(24, "[0.5, 1.0]", "[]")
}

#[test]
fn cli_variants_stand_beside_the_study() {
    let scratch = small();
    scratch.edit("study.toml", "[control]\npmv_limits = [", "[control]\npmv_limits = [] # [");
    scratch.expect(0, &["run"]);
    let before = scratch.exact("SELECT * FROM annual_average").unwrap();
    add(
        &scratch,
        "[variants.\"none\"]\n[variants.\"insulated\"]\nconduction_shell_w_m2_k = 3.0\ndesigns = [\"hp\", \"ptc\"]\n\
         [variants.\"warmer\"]\nambient_offset_k = 3\n",
    );
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains("0 points computed now"), "{}", run.stderr);
    // The study itself is as it was, but for which run says so.
    let without_run = |rows: Vec<String>| -> Vec<String> {
        rows.into_iter().map(|row| row.split(' ').filter(|c| !c.starts_with("run_id=")).collect()).collect()
    };
    assert_eq!(without_run(scratch.exact("SELECT * FROM annual_average").unwrap()), without_run(before));
    assert_eq!(scratch.query("SELECT count(*) FROM variant_annual"), [["24"]]);
    // Without an override it is the bus, bit for bit; the bus is what is stored, to rounding.
    let same = "SELECT count(*) FROM variant_annual WHERE variant = 'none' AND hvac_power_w = base_hvac_power_w
        AND heating_power_w = base_heating_power_w AND cooling_power_w = base_cooling_power_w AND difference_w = 0.0";
    assert_eq!(scratch.query(same), [["10"]]);
    let stored = "SELECT max(abs(v.base_hvac_power_w / a.hvac_power_w - 1.0)) FROM variant_annual AS v
        JOIN annual_average AS a USING (design, pmv_min, pmv_max)";
    assert!(number(&scratch.query(stored)[0][0]) < 1e-12);
    let better = "SELECT count(*), count(*) FILTER (WHERE heating_power_w < base_heating_power_w) FROM variant_annual
        WHERE variant = 'insulated'";
    assert_eq!(scratch.query(better), [["4", "4"]]);
    let settings = "SELECT name, value, base_value FROM variant_setting ORDER BY variant, name";
    let settings = scratch.query(settings);
    assert_eq!(settings[0], ["conduction_shell_w_m2_k", "3.0", "6.86"]);
    assert_eq!(settings[1], ["ambient_offset_k", "3.0", "0.0"]);
    let report = scratch.read("report/report.md");
    assert!(report.contains("insulated: conduction_shell_w_m2_k = 3 instead of 6.86"), "{report}");
    assert!(scratch.path("report/variant_annual.csv").exists());

    // A study with that insulation has those averages.
    let variant = scratch.query(
        "SELECT hvac_power_w FROM variant_annual WHERE variant = 'insulated' AND pmv_limit = 1.0 ORDER BY design",
    );
    scratch.edit("study.toml", "# conduction_shell_w_m2_k = 6.86", "conduction_shell_w_m2_k = 3.0");
    scratch.expect(0, &["solve", "--quiet"]);
    let solved = "SELECT hvac_power_w FROM annual_average WHERE design IN ('hp', 'ptc') AND pmv_limit = 1.0
        ORDER BY design";
    for (own, solved) in variant.iter().zip(scratch.query(solved)) {
        assert!((number(&own[0]) / number(&solved[0]) - 1.0).abs() < 1e-12, "{own:?} {solved:?}");
    }
}

#[test]
fn cli_a_variant_or_an_input_that_cannot_be_is_named() {
    for (text, said) in [
        (
            "[variants.a]\nshell_aera_m2 = 3.0\n",
            "[variants.\"a\"] shell_aera_m2 is no input that can vary; did you mean shell_area_m2?",
        ),
        ("[variants.a]\ndesigns = [\"hq\"]\n", "[variants.\"a\"] designs: \"hq\" is not one of the study's: ptc, "),
        ("[variants.a]\nrelative_humidity = 2.0\n", "relative_humidity"),
        ("[variants.a]\nroof_area_m2 = \"large\"\n", "a number, or under `designs` a list of names"),
        ("[sensitivity.inputs]\nother_heat_w = [3.0, 2.0]\n", "other_heat_w varies as"),
        (
            "[sensitivity.inputs]\nother_heat_w = { mean = 3.0 }\n",
            "a spread is [low, high], { mean, sd } or { low, mode, high }",
        ),
        ("[sensitivity]\npoints = 1\n", "points = 1 must lie between 2 and 65536"),
        (
            "[economics]\ncurrency = \"CHF\"\nprice_per_kwh = 0.2\ninterest = 3.0\nlife_years = 12\n[economics.designs.hp]\ninvestment = 1\n",
            "[economics] interest = 3 must lie between 0 and 1",
        ),
    ] {
        let scratch = Scratch::demo(1);
        add(&scratch, text);
        let run = scratch.expect(2, &["check"]);
        assert!(run.stderr.contains(said), "{text}: {}", run.stderr);
    }
}

#[test]
fn cli_what_the_year_depends_on_is_stored_shown_and_never_stale() {
    let scratch = small();
    add(
        &scratch,
        "[sensitivity]\npmv_limit = 0.75\npoints = 16\n[sensitivity.inputs]\nheating_cop_scale = [0.8, 1.2]\n\
         ambient_offset_k = { mean = 0.0, sd = 1.0 }\ndoor_width_m = { low = 3.0, mode = 4.42, high = 5.0 }\n\
         panel_width_m = [0.5, 0.5001]\n",
    );
    let run = scratch.expect(3, &["sensitivity"]);
    assert!(run.stderr.contains("there are no samples yet; run `busclimate"), "{}", run.stderr);
    scratch.expect(0, &["run", "--quiet"]);
    let run = scratch.expect(0, &["sensitivity"]);
    assert!(run.stderr.contains("96 of 96 sets of 4 inputs solved now"), "{}", run.stderr);
    assert!(run.stdout.contains("heating_cop_scale 0.8 … 1.2: +"), "{}", run.stdout);
    assert_eq!(scratch.query("SELECT count(*), min(set_count) FROM sensitivity_result"), [["19", "96"]]);
    assert_eq!(scratch.query("SELECT count(*) FROM sensitivity_swing"), [["76"]]);
    // PTC heating has no COP to vary; of a heat pump it explains most.
    let index = |design: &str, input: &str| {
        let sql = format!(
            "SELECT total_order FROM sensitivity_index WHERE design = '{design}' AND input = '{input}'
             AND quantity = 'hvac_power_w'"
        );
        number(&scratch.query(&sql)[0][0])
    };
    assert_eq!(index("ptc", "heating_cop_scale"), 0.0);
    assert!(index("hp", "heating_cop_scale") > index("hp", "door_width_m"));
    // The middle of the swings is the bus of a window that the study does not have.
    let swing = "SELECT low_value, base_value, high_value, input_low, input_high FROM sensitivity_swing
        WHERE design = 'hp' AND input = 'heating_cop_scale' AND quantity = 'heating_power_w'";
    let swing: Vec<f64> = scratch.query(swing)[0].iter().map(|v| number(v)).collect();
    assert!(swing[0] > swing[1] && swing[1] > swing[2], "{swing:?}");
    assert!((swing[0] * 0.8 / swing[1] - 1.0).abs() < 1e-6 && swing[3..] == [0.8, 1.2], "{swing:?}");
    for file in ["tornado.svg", "sobol_indices.svg", "sensitivity_index.csv"] {
        assert!(scratch.path("report").join(file).exists(), "{file}");
    }
    let before = scratch.exact("SELECT * FROM sensitivity_index").unwrap();
    let again = scratch.expect(0, &["sensitivity", "--threads", "1"]);
    assert!(again.stderr.contains("0 of 96 sets"), "{}", again.stderr);
    assert_eq!(scratch.exact("SELECT * FROM sensitivity_index").unwrap(), before);

    // Of another bus it is not shown until somebody asks again.
    scratch.edit("study.toml", "# other_heat_w = 1000.0", "other_heat_w = 1500.0");
    scratch.expect(0, &["run", "--quiet"]);
    assert!(!scratch.path("report/tornado.svg").exists());
    scratch.expect(0, &["sensitivity", "--quiet"]);
    assert!(scratch.path("report/tornado.svg").exists());
    assert_ne!(scratch.exact("SELECT * FROM sensitivity_index").unwrap(), before);
}

/// An annuity by hand: 5 % over 10 years is worth 7.721735 payments.
#[test]
fn prop_costs_are_those_of_an_annuity() {
    let scratch = small();
    add(
        &scratch,
        "[economics]\ncurrency = \"CHF\"\nprice_per_kwh = 0.25\ncarbon_kg_per_kwh = 0.1\ninterest = 0.05\nlife_years = 10\n\
         [economics.designs.ptc]\ninvestment = 4000.0\n[economics.designs.hp]\ninvestment = 12000.0\n\
         maintenance_per_year = 200.0\n",
    );
    scratch.expect(0, &["run", "--quiet"]);
    let rows = scratch.query(
        "SELECT design, kwh_per_bus_year, energy_cost_per_year, annual_cost, net_present_cost, emissions_kg_per_year,
            saved_kwh_per_year, cost_per_saved_kwh, break_even_price_per_kwh FROM economics WHERE pmv_limit = 1.0
            ORDER BY design",
    );
    assert_eq!(rows.len(), 2);
    let of = |row: &[String]| row[1..8].iter().map(|v| v.parse().unwrap_or(f64::NAN)).collect::<Vec<f64>>();
    let (hp, ptc) = (of(&rows[0]), of(&rows[1]));
    const FACTOR: f64 = 7.721_734_929_184_812;
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9 * b.abs().max(1.0), "{a} {b}");
    close(hp[1], 0.25 * hp[0]);
    close(hp[2], 12_000.0 / FACTOR + 200.0 + 0.25 * hp[0]);
    close(hp[3], 12_000.0 + FACTOR * (200.0 + 0.25 * hp[0]));
    close(hp[4], 0.1 * hp[0]);
    close(hp[5], ptc[0] - hp[0]);
    close(hp[6], (8000.0 / FACTOR + 200.0) / hp[5]);
    // At that price both cost the same a year.
    let price = number(&rows[0][8]);
    close(hp[2] + (price - 0.25) * hp[0], ptc[2] + (price - 0.25) * ptc[0]);
    close(ptc[5], 0.0);
    assert!(scratch.read("report/report.md").contains("What comfort costs"));
    // Without the section there is nothing of it.
    let text = scratch.read("study.toml");
    scratch.write("study.toml", &text[..text.find("[economics]\n").unwrap()]);
    scratch.expect(0, &["run", "--quiet"]);
    assert_eq!(scratch.query("SELECT count(*) FROM economics"), [["0"]]);
    assert!(!scratch.path("report/economics.csv").exists());
}

#[test]
fn cli_the_same_bus_under_other_weather() {
    let scratch = small();
    scratch.expect(0, &["run", "--quiet"]);
    let weather = std::fs::read_dir(scratch.path("weather")).unwrap().map(|e| e.unwrap().path());
    let files: Vec<String> = weather.map(|path| path.display().to_string()).collect();
    assert_eq!(files.len(), 1, "{files:?}");
    // A place on the same meridian, always 12 °C, under an even grey sky, as an EnergyPlus file of a year.
    let site = shading::Site::new(40.0, 8.5).unwrap();
    let mut epw = String::from("LOCATION,Elsewhere,-,-,made up,0,40.0,8.5,1.0,100\n");
    epw.push_str(&"-\n".repeat(6));
    epw.push_str("DATA PERIODS,1,1,Data,Sunday,1/1,12/31\n");
    for day in 1..=365 {
        let date = chrono::NaiveDate::from_yo_opt(2023, day).unwrap();
        for hour in 1..=24 {
            let middle = date.and_hms_opt(0, 0, 0).unwrap().and_utc() + chrono::TimeDelta::minutes(60 * hour - 90);
            let grey = 600.0 * site.sun(middle).altitude_rad.sin().max(0.0);
            let day = date.format("%Y,%-m,%-d");
            epw.push_str(&format!("{day},{hour},60,x,12.0,5.0,60,95000,0,0,300,{grey:.1},0,{grey:.1}\n"));
        }
    }
    scratch.write("elsewhere.epw", epw);
    let run = scratch.expect(0, &["climates", ".", &files[0], "elsewhere.epw", "--to", "climates"]);
    assert!(run.stdout.contains("elsewhere") && run.stdout.contains(" 12.0 "), "{}", run.stdout);
    let rows: Vec<Vec<String>> = csv_rows(&scratch.read("climates/climates.csv"));
    assert_eq!(rows.len(), 1 + 3 * 10);
    // Its own weather again is the study, which has the annual averages to rounding.
    let (own, again, other) = (&rows[1..11], &rows[11..21], &rows[21..31]);
    for ((own, again), other) in own.iter().zip(again).zip(other) {
        assert_eq!(own[4..], again[4..]);
        let sql =
            format!("SELECT hvac_power_w FROM annual_average WHERE design = '{}' AND pmv_max = {}", own[4], own[6]);
        let stored = number(&scratch.query(&sql)[0][0]);
        assert!((number(&own[7]) / stored - 1.0).abs() < 1e-12, "{own:?} {stored}");
        assert_eq!((other[1].as_str(), other[3].as_str(), other[12].as_str()), ("40", "12", "0"));
        assert!(number(&other[7]) < number(&own[7]), "it is warmer there than in the mean of a year: {other:?}");
    }
    assert!(scratch.read("climates/climates.svg").starts_with("<svg"));
    scratch.write("broken.epw", "LOCATION,nowhere\n");
    assert!(scratch.expect(3, &["climates", ".", "broken.epw"]).stderr.contains("broken.epw"));
    assert!(scratch.expect(3, &["climates", ".", "absent.epw"]).stderr.contains("absent.epw"));
}

fn csv_rows(text: &str) -> Vec<Vec<String>> {
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn cli_a_limited_unit_comes_near_and_says_how_near() {
    let scratch = small();
    scratch.edit("study.toml", "[control]\npmv_limits = [", "[control]\npmv_limits = [] # [");
    scratch.expect(0, &["run", "--quiet"]);
    let free = "SELECT design, pmv_limit, hvac_power_w FROM annual_average WHERE design IN ('hp', 'ptc') ORDER BY 1, 2";
    let before = scratch.query(free);
    assert_eq!(scratch.query("SELECT count(*) FROM limited_annual"), [["0"]]);
    let small_pump = "heating = \"hp\"\nlimits_are = \"thermal\"\n\
        heating_limit_w = [[-20.0, 1500.0], [10.0, 3000.0]]\n";
    add(
        &scratch,
        &format!(
            "[designs.\"small hp\"]\n{small_pump}[designs.\"small hp+ptc\"]\n{small_pump}backup_heater_w = 30000\n\
             [designs.\"ample hp\"]\n{}",
            small_pump.replace("1500.0", "1e6").replace("3000.0", "1e6"),
        ),
    );
    scratch.expect(0, &["run", "--quiet"]);
    assert_eq!(scratch.query(free), before);
    let same = "SELECT count(*) FROM annual_average AS a JOIN annual_average AS b USING (pmv_min, pmv_max)
        WHERE a.design = 'hp' AND b.design = 'ample hp' AND a.hvac_power_w = b.hvac_power_w";
    assert_eq!(scratch.query(same), [["2"]]);

    let sql = "SELECT pmv_limit, limited_count, limited_weight, mean_unmet_heat_w, largest_unmet_heat_w, mean_pmv_miss,
        largest_pmv_miss, backup_heater_power_w FROM limited_annual WHERE design = 'small hp' ORDER BY pmv_limit";
    let rows: Vec<Vec<f64>> = scratch.query(sql).iter().map(|row| row.iter().map(|v| number(v)).collect()).collect();
    let [narrow, wide] = &rows[..] else { panic!("{rows:?}") };
    for row in [narrow, wide] {
        assert!(row[1] > 0.0 && 0.0 < row[2] && row[2] < 1.0, "{row:?}");
        assert!(0.0 < row[3] && row[3] <= row[4] && 0.0 < row[5] && row[5] <= row[6] && row[7] == 0.0, "{row:?}");
    }
    assert!(narrow[1] > wide[1] && narrow[4] > wide[4], "{rows:?}");
    let points = "SELECT count(*) FILTER (WHERE status = 'limited'), count(*) FILTER (WHERE status = 'limited'
        AND NOT (unmet_heat_w > 0.0 AND (pmv < pmv_min OR pmv > pmv_max))), count(*) FILTER (WHERE status = 'solved'
        AND (unmet_heat_w <> 0.0 OR pmv < pmv_min - 1e-6 OR pmv > pmv_max + 1e-6)) FROM optimum WHERE design = 'small hp'";
    assert_eq!(scratch.query(points), [[(narrow[1] + wide[1]).to_string(), "0".into(), "0".into()]]);
    // With the back-up heater every window is met, for more power than the small pump takes and less than heaters alone.
    let helped =
        "SELECT sum(limited_count), min(backup_heater_power_w) > 0.0 FROM limited_annual WHERE design = 'small hp+ptc'";
    assert_eq!(scratch.query(helped), [["0", "1"]]);
    let between = "SELECT count(*) FROM annual_average AS a JOIN annual_average AS b USING (pmv_min, pmv_max)
        JOIN annual_average AS c USING (pmv_min, pmv_max) WHERE a.design = 'small hp' AND b.design = 'small hp+ptc'
        AND c.design = 'ptc' AND a.hvac_power_w < b.hvac_power_w AND b.hvac_power_w < c.hvac_power_w";
    assert_eq!(scratch.query(between), [["2"]]);
    // A variant, and the bus of a variant, miss as many hours as the stored optima say; a colder one more.
    add(
        &scratch,
        "[variants.\"same\"]\n[variants.\"colder\"]\nambient_offset_k = -8\n[sensitivity]\npoints = 4\n\
         [sensitivity.inputs]\nambient_offset_k = [-8.0, 8.0]\nshell_area_m2 = [180.0, 220.0]\n",
    );
    scratch.expect(0, &["run", "--quiet"]);
    let counts = "SELECT count(*) FILTER (WHERE v.base_limited_count = l.limited_count),
        count(*) FILTER (WHERE v.variant = 'same' AND v.limited_count = l.limited_count),
        count(*) FILTER (WHERE v.variant = 'colder' AND v.limited_count > l.limited_count)
        FROM variant_annual AS v JOIN limited_annual AS l USING (design, pmv_min, pmv_max) WHERE design = 'small hp'";
    assert_eq!(scratch.query(counts), [["4", "2", "2"]]);
    let said = scratch.expect(0, &["sensitivity"]).stdout;
    let of_pump = said.split("small hp:").nth(1).unwrap().lines().nth(1).unwrap();
    assert!(of_pump.contains("misses the window for want of power in"), "{said}");
    let counts = "SELECT design, limited_count > 0 FROM sensitivity_result
        WHERE quantity = 'hvac_power_w' AND design LIKE '%hp' ORDER BY design";
    assert_eq!(scratch.query(counts), [["ample hp", "0"], ["hp", "0"], ["small hp", "1"]]);

    let report = scratch.read("report/report.md");
    assert!(report.contains("limited design"), "{report}");
    let answer = report.lines().find(|line| line.contains("the least electricity.")).unwrap();
    assert!(!answer.contains("small"), "{answer}");
    assert!(report.contains("“small hp”), too weak in some hours | "), "{report}");
    assert!(!report.contains("“small hp+ptc”), too weak"), "{report}");
    let csv = scratch.read("report/limited_annual.csv");
    assert_eq!(csv.lines().count(), 5, "{csv}");
    scratch.expect(0, &["verify", "--quiet"]);

    let run = scratch.expect(2, &["solve", "--method", "nlp"]);
    assert!(run.stderr.contains("which design \"small hp\" has; solve it by --method fast"), "{}", run.stderr);
    for (from, to, said) in [
        ("limits_are = \"thermal\"\n", "", "heating_limit_w needs limits_are = \"electric\" or \"thermal\" beside it"),
        ("[10.0, 3000.0]", "[-30.0, 3000.0]", "heating_limit_w: row 2: -30 °C is not above the row before"),
        ("1500.0]", "-1.0]", "heating_limit_w: row 1 is [-20, -1]"),
        ("[[-20.0, 1500.0], [10.0, 3000.0]]", "\"much\"", "expected a number of W, or a table of [ambient temperature"),
        ("backup_heater_w = 30000", "backup_heater_w = -1", "backup_heater_w = -1 must lie between 0 and 1000000"),
    ] {
        let text = scratch.read("study.toml");
        scratch.edit("study.toml", from, to);
        let run = scratch.expect(2, &["check"]);
        assert!(run.stderr.contains(said), "{to}: {}", run.stderr);
        scratch.write("study.toml", text);
    }
}
