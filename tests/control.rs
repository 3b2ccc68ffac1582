//! Setpoints for a controller on board, from the program outside.

use crate::common::Scratch;

/// A study of some missions of the year, solved.
fn solved() -> Scratch {
    let scratch = Scratch::small(24, "[0.5, 1.0]", "[]");
    scratch.edit("study.toml", "coverage = 0.98", "coverage = 0.9");
    scratch.expect(0, &["run"]);
    scratch
}

fn file(scratch: &Scratch, name: &str) -> toml::Table {
    toml::from_str(&scratch.read(&format!("setpoints/{name}"))).expect("a file of setpoints")
}

fn number(table: &toml::Table, key: &str) -> f64 {
    table[key].as_float().expect("a number")
}

#[test]
fn cli_profiles_cover_the_hours_that_they_claim() {
    let scratch = solved();
    let run = scratch.expect(0, &["control"]);
    assert!(run.stdout.contains("hp+curtain within PMV ±1, heating: "), "{}", run.stdout);
    assert!(run.stdout.contains("20 files in "), "{}", run.stdout);
    let mut thresholds = 0;
    for limit in ["0.5", "1"] {
        let setup = file(&scratch, &format!("hp+curtain_pmv_-{limit}_{limit}.toml"));
        let heating = setup["heating"].as_table().expect("a profile");
        assert_eq!(heating["kind"].as_str(), Some("quadratic"));
        let c: Vec<f64> = heating["coefficients_c"]
            .as_array()
            .expect("three numbers")
            .iter()
            .filter_map(toml::Value::as_float)
            .collect();
        // Counted by the database, with its own weights.
        let count = |side: &str| {
            scratch.query(&format!(
                "SELECT sum(s.weight) FROM optimum AS o JOIN sample AS s USING (sample_id)
                 WHERE o.design = 'hp+curtain' AND o.pmv_limit = {limit} AND o.operating_mode = 1 AND {side}"
            ))[0][0]
                .parse::<f64>()
                .expect("a weight")
        };
        let setpoint = format!(
            "({} + {} * s.ambient_temperature_c + {} * s.ambient_temperature_c * s.ambient_temperature_c)",
            c[0], c[1], c[2]
        );
        let share = count(&format!("o.cabin_temperature_c <= {setpoint} + 2e-6")) / count("1");
        let claimed = number(heating, "coverage");
        assert!(claimed >= 0.9 && (share - claimed).abs() < 1e-6, "{limit}: {share} {claimed}");
        let curtains = setup["air_curtain"].as_array().expect("two modes");
        let heating = curtains[0].as_table().expect("a mode");
        assert_eq!(heating["mode"].as_str(), Some("heating"));
        // Where curtains run in every hour that heats, the optima show no threshold.
        if heating.contains_key("on_above_difference_k") {
            thresholds += 1;
            assert!((number(heating, "on_above_difference_k") - number(heating, "analytic_difference_k")).abs() < 1.5);
        }
    }
    assert!(thresholds > 0);
    // Every full degree, and a setpoint that does not fall.
    let csv = scratch.read("setpoints/hp_pmv_-1_1.csv");
    let setpoints: Vec<f64> = csv.lines().skip(1).filter_map(|l| l.split(',').nth(1)?.parse().ok()).collect();
    assert!(setpoints.len() > 10 && setpoints.is_sorted(), "{setpoints:?}");
    assert!(file(&scratch, "hp_pmv_-1_1.toml").get("air_curtain").is_none());
    assert!(file(&scratch, "ptc+rh_pmv_-1_1.toml").get("radiant_heaters").is_some());
    let published = scratch.read("setpoints/published.csv");
    assert!(published.contains("\nvbz-18,-16,13.50,,\"VBZ"), "{published}");
    // The same bytes again.
    let before = scratch.read("setpoints/hp_pmv_-1_1.toml");
    scratch.expect(0, &["control", "--threads", "1"]);
    assert_eq!(before, scratch.read("setpoints/hp_pmv_-1_1.toml"));
}

#[test]
fn cli_setpoints_are_those_of_fresh_optima() {
    let scratch = solved();
    scratch.edit("study.toml", "pmv_limits = [0.5, 1.0]", "pmv_limits = [0.5, 0.75]");
    let run = scratch.expect(3, &["control"]);
    assert!(
        run.stderr.contains("the optima are stale") && run.stderr.contains("run `busclimate solve` first"),
        "{}",
        run.stderr
    );
    assert!(!scratch.path("setpoints").exists());
    // A design that never cools has no cooling profile, and says so.
    scratch.edit("study.toml", "pmv_limits = [0.5, 0.75]", "pmv_limits = [3.0]");
    scratch.expect(0, &["run"]);
    let run = scratch.expect(0, &["control", "--to", "elsewhere"]);
    assert!(run.stdout.contains("no profile; "), "{}", run.stdout);
    assert!(scratch.path("elsewhere/hp_pmv_-3_3.csv").exists());
}

#[test]
fn cli_ones_own_setpoints_are_driven_like_published_ones() {
    let scratch = Scratch::small(6, "[0.5, 1.0]", "[]");
    let profiles = "profiles = { \"depot 7\" = \"own.csv\" }\ndesigns = [\"hp+rh\", \"hp+curtain\"]";
    scratch.edit("study.toml", "coverage = 0.98", &format!("coverage = 0.98\n{profiles}"));
    let header = "ambient_temperature_c,heating_setpoint_c,cooling_setpoint_c\n";
    scratch.write("own.csv", format!("{header}-10,20,20\n30,20,20\n"));
    scratch.expect(0, &["run"]);
    // Those of the constant that others have published, judged by both windows.
    let of = |controller: &str| {
        scratch.query(&format!(
            "SELECT mission, design, pmv_limit, mean_hvac_power_w, mean_abs_pmv, max_abs_pmv_15min,
                passenger_hours_outside, tracking_error_k
             FROM control WHERE controller = '{controller}' ORDER BY 1, 2, 3"
        ))
    };
    assert_eq!(of("depot 7").len(), 6 * 2 * 2);
    assert_eq!(of("depot 7"), of("constant-20"));
    // Another table is driven anew, and is not theirs.
    scratch.write("own.csv", format!("{header}-10,20,24\n30,20,24\n"));
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains("12 missions driven by causal controllers now"), "{}", run.stderr);
    assert!(of("depot 7") != of("constant-20"));
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains(" 0 missions driven by causal controllers now"), "{}", run.stderr);

    scratch.write("own.csv", format!("{header}-10,20,24\n30,20,19\n"));
    for command in ["check", "run", "control"] {
        let run = scratch.expect(3, &[command]);
        let both = format!("{}{}", run.stdout, run.stderr);
        assert!(both.contains("own.csv: line 3, column cooling_setpoint_c: 19 is below heating_setpoint_c"), "{both}");
    }
    std::fs::remove_file(scratch.path("own.csv")).unwrap();
    assert!(scratch.expect(3, &["control"]).stderr.contains("own.csv"));
    for (from, to, said) in [
        ("\"depot 7\"", "\"vecto\"", "\"vecto\" is the name of other setpoints"),
        (
            "\"hp+rh\", ",
            "\"hp+heaters\", ",
            "\"hp+heaters\" is not one of the study's: ptc, ptc+rh, hp, hp+rh, hp+curtain",
        ),
        ("coverage = 0.98", "coverage = 0.2", "[control] coverage = 0.2 must lie between 0.5 and 1"),
    ] {
        let before = scratch.read("study.toml");
        scratch.edit("study.toml", from, to);
        let run = scratch.expect(2, &["control"]);
        assert!(run.stderr.contains(said), "{}", run.stderr);
        scratch.write("study.toml", before);
    }
}

#[test]
fn prop_a_year_under_control_is_the_mean_of_its_missions() {
    let scratch = solved();
    let controllers = scratch.query("SELECT DISTINCT controller FROM control_annual ORDER BY 1");
    assert_eq!(controllers.len(), 10, "{controllers:?}");
    // Once more, by other means: the mean of each day's share, month by month.
    let rows = scratch.query(
        "WITH monthly AS (
            SELECT pmv_limit, controller, month, sum(mean_hvac_power_w * seconds) / sum(seconds) AS power_w,
                sum(passenger_hours_outside) / sum(passenger_hours) AS outside,
                sum(mean_abs_pmv * passenger_hours) / sum(passenger_hours) AS abs_pmv
            FROM control GROUP BY 1, 2, 3)
         SELECT a.controller, a.mean_hvac_power_w - sum(m.power_w * w.days) / sum(w.days),
            a.outside_fraction - sum(m.outside * w.days) / sum(w.days),
            a.mean_abs_pmv - sum(m.abs_pmv * w.days) / sum(w.days), a.outside_fraction, a.mean_abs_pmv, a.pmv_limit
         FROM control_annual AS a JOIN monthly AS m USING (pmv_limit, controller) JOIN month_weight AS w USING (month)
         GROUP BY a.pmv_limit, a.controller",
    );
    assert_eq!(rows.len(), 20);
    for row in &rows {
        let number = |i: usize| row[i].parse::<f64>().unwrap();
        assert!(number(1).abs() < 1e-8 && number(2).abs() < 1e-12 && number(3).abs() < 1e-12, "{row:?}");
        assert!((0.0..=1.0).contains(&number(4)) && (0.0..3.0).contains(&number(5)), "{row:?}");
    }
    // Who is judged by a wider window is outside it for less time.
    let wider = scratch.query(
        "SELECT count(*) FROM control_annual AS a JOIN control_annual AS b USING (controller)
         WHERE controller NOT LIKE 'extracted%' AND a.pmv_limit < b.pmv_limit AND a.outside_fraction < b.outside_fraction",
    );
    assert_eq!(wider, [["0"]]);
    // Classes hold every mission once.
    let sums = scratch
        .query("SELECT DISTINCT sum(mission_count) FROM control_class GROUP BY pmv_limit, controller, sorted_by");
    assert_eq!(sums, [["24"]]);
}

#[test]
fn cli_a_mission_that_no_controller_can_drive_is_a_row_with_a_reason() {
    let scratch = solved();
    scratch.tamper(
        "UPDATE optimum_point SET status = 2, row_check = NULL WHERE sample_id = (SELECT min(sample_id) FROM optimum_point)
            AND design_id = (SELECT design_id FROM hvac_design WHERE name = 'hp+curtain')
            AND window_id = (SELECT window_id FROM comfort_window WHERE pmv_limit = 1.0)",
    );
    // With another share to cover, all missions are driven anew.
    scratch.edit("study.toml", "coverage = 0.9", "coverage = 0.95");
    let run = scratch.expect(1, &["control"]);
    assert!(run.stderr.contains("1 missions cannot be driven, the first: B183_"), "{}", run.stderr);
    let failed = scratch.query("SELECT design, reason FROM control_failure");
    assert_eq!(failed, [["hp+curtain", "segment 0 has no optimum: infeasible: too cold"]]);
    assert_eq!(scratch.query("SELECT count(DISTINCT mission) FROM control"), [["23"]]);
    let status = scratch.expect(0, &["status"]).stdout;
    assert!(
        status.contains("1 missions cannot be driven by controllers; the view control_failure says why"),
        "{status}"
    );
}

#[test]
fn cli_driving_can_be_turned_off_and_setpoints_stay() {
    let scratch = Scratch::small(12, "[1.0]", "[]");
    scratch.edit("study.toml", "pmv_limits = [0.25, 0.5, 0.625, 0.75, 1.0, 1.25, 1.5, 2.0]", "pmv_limits = []");
    scratch.expect(0, &["run"]);
    assert_eq!(scratch.query("SELECT count(*) FROM control"), [["0"]]);
    assert_eq!(scratch.query("SELECT count(*) FROM setpoint_profile"), [["10"]]);
    assert_eq!(scratch.query("SELECT count(*) FROM curtain_threshold"), [["2"]]);
    let run = scratch.expect(0, &["control"]);
    assert!(run.stdout.contains("10 files in "), "{}", run.stdout);
}

#[test]
fn cli_the_report_compares_controllers_in_tables_and_figures() {
    let scratch = solved();
    let report = scratch.read("report/report.md");
    let table = |title: &str| -> Vec<String> {
        let after = report.split_once(title).unwrap_or_else(|| panic!("{title}\n{report}")).1;
        let rows = after.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
        rows.skip(2).map(str::to_owned).collect()
    };
    assert_eq!(table("## Setpoints for a controller on board").len(), 2);
    assert_eq!(table("## Causal controllers over the year: hp+curtain").len(), 2);
    let published = table("Published setpoints beside the extracted ones");
    assert_eq!(published.len(), 9);
    // Its numbers are those of the database.
    let [power, outside] = ["mean_hvac_power_w", "100.0 * outside_fraction"].map(|value| {
        let sql = format!("SELECT {value} FROM control_annual WHERE controller = 'vecto' AND pmv_limit = 1.0");
        scratch.query(&sql)[0][0].parse::<f64>().unwrap()
    });
    let row = published.iter().find(|row| row.starts_with("| vecto |")).unwrap();
    assert!(row.contains(&format!("| {power:.0} |")) && row.contains(&format!("| {outside:.1} % |")), "{row}");
    for figure in [
        "temperature_setpoints",
        "aircurtain_setpoint",
        "causal_time_resolved",
        "causal_pareto_front",
        "control_pareto",
    ] {
        let svg = scratch.read(&format!("report/{figure}.svg"));
        assert!(report.contains(&format!("({figure}.svg)")), "{figure}");
        assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"), "{figure}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{figure}");
    }
    let csv = scratch.read("report/control_outside.csv");
    // Each of two profiles and nine published setpoints judged by two windows.
    assert_eq!(csv.lines().count(), 1 + 2 * 2 + 9 * 2);
}
