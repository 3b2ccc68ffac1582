//! Studies in scratch folders, and the program run on them.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

pub mod world;

use assert_cmd::Command;
use sqlx::{Column, Connection, Row, SqliteConnection, TypeInfo, ValueRef};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::Duration;
use store::Store;
use tempfile::TempDir;

/// All that a database says of a study, but for when and by which run.
pub const CONTENT: [&str; 46] = [
    "SELECT * FROM sample",
    "SELECT * FROM optimum",
    "SELECT design, pmv_min, pmv_max, month, hvac_power_w, heating_power_w, cooling_power_w, sample_count, unsolved_count,
        lower_count, upper_count, heating_count, cooling_count, outside_range_count FROM monthly_average",
    "SELECT design, pmv_min, pmv_max, hvac_power_w, heating_power_w, cooling_power_w, sample_count, unsolved_count,
        unsolved_weight, reduction_vs_ptc FROM annual_average",
    "SELECT * FROM month_weight",
    "SELECT design, pmv_min, pmv_max, solved_count, lower_count, upper_count, heating_count, cooling_count, lower_weight,
        cooling_weight, outside_range_count FROM limit_share",
    "SELECT * FROM simulation",
    "SELECT design, pmv_min, pmv_max, controller, mean_hvac_power_w, static_mean_hvac_power_w, saturated_fraction,
        mission_count FROM simulation_annual",
    "SELECT design, pmv_min, pmv_max, class_order, class, mission_count, mean_hvac_power_w, static_mean_hvac_power_w,
        warm_start_power_w, mean_max_abs_pmv_15min, saturated_fraction FROM simulation_class",
    "SELECT * FROM simulation_failure",
    "SELECT * FROM simulation_trace",
    "SELECT * FROM control",
    "SELECT * FROM control_failure",
    "SELECT design, pmv_limit, pmv_min, pmv_max, mode, kind, parameters, valid_from_ambient_c, valid_to_ambient_c,
        coverage, hour_count, reason FROM setpoint_profile",
    "SELECT design, pmv_limit, pmv_min, pmv_max, mode, threshold_k, analytic_threshold_k, misclassified_weight
        FROM curtain_threshold",
    "SELECT design, pmv_limit, pmv_min, pmv_max, below_ambient_c, misclassified_weight, heater_temperature_c
        FROM heater_threshold",
    "SELECT design, pmv_limit, pmv_min, pmv_max, controller, mean_hvac_power_w, static_mean_hvac_power_w, mean_abs_pmv,
        static_mean_abs_pmv, passenger_hours, passenger_hours_outside, outside_fraction, saturated_fraction,
        mission_count FROM control_annual",
    "SELECT design, pmv_limit, pmv_min, pmv_max, controller, sorted_by, class, class_order, mean_hvac_power_w,
        static_mean_hvac_power_w, mean_abs_pmv, static_mean_abs_pmv, outside_fraction, mission_count FROM control_class",
    "SELECT design, pmv_min, pmv_max, controller, mission, minute, ambient_temperature_c, setpoint_c,
        cabin_temperature_c, pmv, pmv_15min, air_unit_power_w, hvac_power_w FROM control_trace",
    "SELECT design, pmv_min, pmv_max, sorted_by, class, class_order, weight, hvac_power_w, kwh_per_km,
        vehicle_power_share, sample_count FROM energy_class",
    "SELECT design, pmv_min, pmv_max, kwh_per_operating_hour, kwh_per_km, operating_hours_per_bus_year,
        kwh_per_bus_year, vehicle_power_share FROM annual_energy",
    "SELECT design, pmv_min, pmv_max, heating_limit_w, cooling_limit_w, over_limit_count, over_limit_weight,
        unmet_heat_w, infeasible_weight FROM unmet_demand",
    "SELECT design, pmv_min, pmv_max, month, sample_count, cabin_to_shell_w, door_w, air_unit_heat_w, solar_interior_w,
        heating_lift_k, heating_cop, cooling_lift_k, cooling_cop, over_limit_count, unmet_heat_w FROM heat_flow_monthly",
    "SELECT quantity, bin_from, bin_to, sample_count, weight FROM disturbance_histogram",
    "SELECT * FROM heat_flow",
    "SELECT month, classes FROM class_month",
    "SELECT month, days FROM day_month",
    "SELECT month, quote(sums) FROM day_sum JOIN hvac_design USING (design_id) JOIN comfort_window USING (window_id)
        ORDER BY month, name, pmv_min, pmv_max",
    "SELECT design, pmv_min, pmv_max, hvac_power_w, hvac_power_low_w, hvac_power_high_w, heating_power_low_w,
        heating_power_high_w, cooling_power_low_w, cooling_power_high_w, kwh_per_km_low, kwh_per_km_high,
        reduction_vs_ptc_low, reduction_vs_ptc_high, change_vs_pmv_1, change_vs_pmv_1_low, change_vs_pmv_1_high, day_count, single_day_month_count FROM annual_interval",
    "SELECT design, other_design, pmv_min, pmv_max, other_takes_more_w, other_takes_more_low_w, other_takes_more_high_w,
        saving, saving_low, saving_high FROM design_interval",
    "SELECT design, pmv_min, pmv_max, month, sample_count, day_count, standard_error_w, effective_sample_count
        FROM month_spread",
    "SELECT design, pmv_min, pmv_max, kind, name, sample_count, month_count, hvac_power_w, relative_change,
        reduction_vs_ptc FROM left_out",
    "SELECT design, pmv_min, pmv_max, controller, mean_hvac_power_low_w, mean_hvac_power_high_w, relative_difference_low,
        relative_difference_high FROM simulation_interval",
    "SELECT design, pmv_min, pmv_max, controller, mean_hvac_power_low_w, mean_hvac_power_high_w, relative_difference_low,
        relative_difference_high FROM control_interval",
    "SELECT variant, name, value, base_value FROM variant_setting",
    "SELECT variant, variant_order, design, pmv_min, pmv_max, hvac_power_w, heating_power_w, cooling_power_w,
        base_hvac_power_w, base_heating_power_w, base_cooling_power_w, difference_w, relative_change, sample_count,
        unsolved_count, limited_count, base_limited_count FROM variant_annual",
    "SELECT design, pmv_min, pmv_max, quantity, base_value, mean_value, sd_value, low_value, high_value, set_count,
        unsolved_count, limited_count, seed FROM sensitivity_result",
    "SELECT design, pmv_min, pmv_max, quantity, input, input_order, input_base, input_low, input_high, base_value,
        low_value, high_value FROM sensitivity_swing",
    "SELECT design, pmv_min, pmv_max, quantity, input, input_order, first_order, first_order_low, first_order_high,
        total_order, total_order_low, total_order_high FROM sensitivity_index",
    "SELECT design, pmv_min, pmv_max, limited_count, limited_weight, mean_unmet_heat_w, largest_unmet_heat_w, mean_pmv_miss,
        largest_pmv_miss, backup_heater_power_w FROM limited_annual",
    "SELECT design, design_order, currency, price_per_kwh, carbon_kg_per_kwh, interest, investment, maintenance_per_year,
        life_years, present_value_factor FROM economic_input",
    "SELECT design, pmv_min, pmv_max, currency, kwh_per_bus_year, energy_cost_per_year, annual_cost, net_present_cost,
        emissions_kg_per_year, reference_design, saved_kwh_per_year, saved_emissions_kg_per_year, extra_cost_per_year,
        cost_per_saved_kwh, break_even_price_per_kwh FROM economics",
    "SELECT * FROM excluded_segment",
    "SELECT path, kind, blake3, bytes, rows, first_utc, last_utc, outcome, reading_key FROM source_file",
    "SELECT f.path, q.kind, q.count, q.line, q.column_name, q.message, q.position
        FROM data_quality AS q JOIN source_file AS f USING (source_file_id)",
    "SELECT name, position, heating, heating_cop, cooling_cop, radiant_heaters, air_curtain, method, design_key
        FROM hvac_design",
];

/// A scratch folder with a study in it.
pub struct Scratch {
    pub folder: TempDir,
}

/// What a run of the program left behind.
pub struct Run {
    pub status: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Scratch {
    pub fn empty() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// The demo with a few missions.
    pub fn demo(missions: usize) -> Self {
        let scratch = Self::empty();
        let run = scratch.run(&["demo", ".", "--missions", &missions.to_string()]);
        assert_eq!(run.status, 0, "{}", run.stderr);
        scratch
    }

    /// The demo with a few missions, solved in few comfort windows and simulated in fewer, both as the study file lists them.
    pub fn small(missions: usize, pmv_limits: &str, simulated: &str) -> Self {
        let scratch = Self::demo(missions);
        scratch.edit("study.toml", "{ from = 0.0, to = 2.0, step = 0.125 }", pmv_limits);
        let limits = format!("pmv_limits = {simulated}");
        scratch.edit("study.toml", "pmv_limits = [0.0, 0.5, 1.0, 1.5, 2.0]", &limits);
        scratch
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs the program in the folder.
    pub fn run(&self, arguments: &[&str]) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_busclimate"))
            .current_dir(self.folder.path())
            .args(arguments)
            .output()
            .unwrap();
        Run {
            status: output.status.code().unwrap(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Starts the program in the folder.
    pub fn spawn(&self, arguments: &[&str]) -> Child {
        std::process::Command::new(env!("CARGO_BIN_EXE_busclimate"))
            .current_dir(self.folder.path())
            .args(arguments)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap()
    }

    /// Starts a run and kills it after a while, wherever it is.
    pub fn run_and_kill(&self, after: Duration) {
        let mut run = self.spawn(&["run", "--quiet"]);
        std::thread::sleep(after);
        let _ = run.kill();
        run.wait().unwrap();
    }

    /// Runs the program and expects an exit status.
    pub fn expect(&self, status: i32, arguments: &[&str]) -> Run {
        let run = self.run(arguments);
        assert_eq!(run.status, status, "{arguments:?}\n{}{}", run.stdout, run.stderr);
        run
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// Replaces the first occurrence in a file.
    pub fn edit(&self, name: &str, from: &str, to: &str) {
        let text = self.read(name);
        assert!(text.contains(from), "{name} has no {from:?}");
        self.write(name, text.replacen(from, to, 1));
    }

    /// Mission files by name.
    pub fn missions(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.path("ztbus")).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.retain(|n| n.starts_with('B'));
        names.sort();
        names
    }

    /// Packs the missions into an archive beside them, the last one first.
    pub fn zip_missions(&self, name: &str) {
        let mut zip = zip::ZipWriter::new(std::fs::File::create(self.path(name)).unwrap());
        for name in self.missions().iter().rev() {
            let deflated = zip::write::SimpleFileOptions::default();
            zip.start_file(format!("ZTBus/{name}"), deflated).unwrap();
            zip.write_all(&std::fs::read(self.path("ztbus").join(name)).unwrap()).unwrap();
        }
        zip.finish().unwrap();
    }

    pub fn query(&self, sql: &str) -> Vec<Vec<String>> {
        self.query_of("study.db", sql)
    }

    /// The same of another database.
    pub fn query_of(&self, database: &str, sql: &str) -> Vec<Vec<String>> {
        Store::open_read_only(&self.path(database)).unwrap().query_text(sql).unwrap()
    }

    /// The rows of a query to the last bit, in a sorted order of their own.
    pub fn exact(&self, sql: &str) -> Result<Vec<String>, sqlx::Error> {
        let url = format!("sqlite://{}?mode=ro", self.path("study.db").display());
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
        let rows = runtime.block_on(async {
            let mut connection = SqliteConnection::connect(&url).await?;
            sqlx::query(sqlx::AssertSqlSafe(sql.to_owned())).fetch_all(&mut connection).await
        })?;
        let value = |row: &sqlx::sqlite::SqliteRow, i: usize| {
            let raw = row.try_get_raw(i).unwrap();
            let name = row.column(i).name();
            match raw.type_info().name() {
                "REAL" => format!("{name}={:?}", row.get_unchecked::<f64, _>(i)),
                _ if raw.is_null() => format!("{name}=-"),
                _ => format!("{name}={}", row.get_unchecked::<Vec<u8>, _>(i).escape_ascii()),
            }
        };
        let mut lines: Vec<String> =
            rows.iter().map(|row| (0..row.len()).map(|i| value(row, i)).collect::<Vec<_>>().join(" ")).collect();
        lines.sort_unstable();
        Ok(lines)
    }

    /// Changes the database behind the program's back.
    pub fn tamper(&self, sql: &'static str) {
        let url = format!("sqlite://{}", self.path("study.db").display());
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
        runtime.block_on(async {
            let mut connection = SqliteConnection::connect(&url).await.unwrap();
            let done = sqlx::query(sql).execute(&mut connection).await.unwrap();
            assert!(done.rows_affected() > 0 || sql.starts_with("CREATE"), "{sql}");
            connection.close().await.unwrap();
        });
    }

    /// All files of the report.
    pub fn report(&self) -> Vec<(String, Vec<u8>)> {
        let entries = std::fs::read_dir(self.path("report")).unwrap();
        let mut files: Vec<(String, Vec<u8>)> = entries
            .map(|e| e.unwrap())
            .map(|e| (e.file_name().into_string().unwrap(), std::fs::read(e.path()).unwrap()))
            .collect();
        files.sort();
        files
    }
}

/// Where real data lies.
pub fn data() -> PathBuf {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    std::env::var_os("BUSCLIMATE_DATA").map_or_else(beside, PathBuf::from)
}
