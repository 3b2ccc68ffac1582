//! A database of an earlier version: it opens, and what it holds stays.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use sqlx::migrate::Migrator;
use sqlx::{Connection, SqliteConnection};
use std::path::{Path, PathBuf};
use store::Store;

/// The schema of 0.1.0 before samples had keys.
const EARLIER: [&str; 3] =
    ["20261124000000_experiment.sql", "20261124010000_verification.sql", "20261125000000_simulation.sql"];

const ROWS: &str = "
    INSERT INTO source_file VALUES (1, 'm.csv', 'mission', 'b', 1, 1, NULL, NULL, 'accepted', 'k');
    INSERT INTO mission_segment VALUES
        (1, 0, 'B183_2022-01-05_05-00-00_2022-01-05_06-19-59', 183, '2022-01-05T05:00:00Z', 3600, 9.5, 0.15, 2, 3601, NULL),
        (1, 1, 'B183_2022-01-05_05-00-00_2022-01-05_06-19-59', 183, '2022-01-05T06:00:00Z', 0, NULL, NULL, NULL, NULL,
            'last part of the mission, shorter than 3600 s');
    INSERT INTO hourly_sample VALUES (1, 1, 'm', 183, 0, 2, 3601, '2022-01-05T05:00:00Z', 3600, 1, 270.5, 0.0, 0.0, 9.5,
        0.15, -0.5, 1.5, 1.0, 0.0);
    INSERT INTO hvac_design VALUES (1, 'ptc', 0, 'ptc', '1', 'linear', 0, 0, 'fast', 'd');
    INSERT INTO comfort_window VALUES (1, 0, -1.0, 1.0, 1.0);
    INSERT INTO optimum_point (sample_id, design_id, window_id, status) VALUES (1, 1, 1, 3);
";

/// What a complete study has in tables that later became others.
const AVERAGES: &str = "
    INSERT INTO run (run_id, started_utc, status, program_version, study_hash)
        VALUES (7, '2026-11-26T02:00:00Z', 'done', '0.1.0', 's');
    DELETE FROM stale_month;
    INSERT INTO stage_record VALUES ('solve', 'k', '[]', NULL);
    INSERT INTO monthly_average VALUES ('ptc', 1.0, -1.0, 1.0, 1, 2000.0, 2000.0, 0.0, 4, 0, 3, 1, 2, 1, 0, 7);
    INSERT INTO annual_average VALUES ('ptc', 1.0, -1.0, 1.0, 2000.0, 2000.0, 0.0, 4, 0, 0.0, 0.0, 7);
";

/// A database with the first of all migrations, the earliest rows, and more.
fn earlier(folder: &Path, is_there: impl Fn(&str) -> bool, more: &'static str) -> PathBuf {
    let migrations = folder.join("migrations");
    std::fs::create_dir(&migrations).unwrap();
    let mut later = Vec::new();
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../migrations")).unwrap() {
        let from = entry.unwrap().path();
        let name = from.file_name().unwrap().to_str().unwrap().to_owned();
        if EARLIER.contains(&name.as_str()) {
            std::fs::copy(&from, migrations.join(name)).unwrap();
        } else if is_there(&name) {
            later.push((from, migrations.join(name)));
        }
    }
    let path = folder.join("study.db");
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
    runtime.block_on(async {
        let url = format!("sqlite://{}?mode=rwc", path.display());
        let mut connection = SqliteConnection::connect(&url).await.unwrap();
        let migrate = async |connection: &mut SqliteConnection| {
            Migrator::new(migrations.as_path()).await.unwrap().run(connection).await.unwrap();
        };
        migrate(&mut connection).await;
        sqlx::raw_sql(ROWS).execute(&mut connection).await.unwrap();
        for (from, to) in &later {
            std::fs::copy(from, to).unwrap();
        }
        migrate(&mut connection).await;
        sqlx::raw_sql(more).execute(&mut connection).await.unwrap();
        connection.close().await.unwrap();
    });
    path
}

#[test]
fn prop_a_database_of_an_earlier_version_opens_and_keeps_its_optima() {
    let folder = tempfile::tempdir().unwrap();
    // For reading too, though it has to be written for that once.
    let mut store = Store::open_read_only(&earlier(folder.path(), |_| false, "")).unwrap();
    let samples = store.samples().unwrap();
    assert_eq!((samples.len(), samples[0].key.as_str()), (1, ""));
    assert_eq!(store.status_counts().unwrap().not_converged, 1);
    // An excluded segment gets the length that the mission's name leaves for it.
    let segments = store.segments().unwrap();
    assert_eq!(segments[1].1.as_ref().unwrap_err().duration_s, 1200);
    assert!(store.traces().unwrap().is_empty() && store.simulation_failures().unwrap().is_empty());
    store.close().unwrap();

    // The same values with a key are no other sample: its optimum stays.
    let mut store = Store::open(&folder.path().join("study.db")).unwrap();
    let mut samples = store.samples().unwrap();
    "key".clone_into(&mut samples[0].key);
    assert_eq!(store.put_samples(&samples, &[], &[]).unwrap(), (0, 0));
    assert_eq!((store.status_counts().unwrap().not_converged, store.samples().unwrap()), (1, samples));
}

#[test]
fn prop_a_database_of_the_version_before_keeps_what_analysts_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = earlier(folder.path(), |name| name < "20261126140000", AVERAGES);
    let mut store = Store::open(&path).unwrap();
    let mut answer = |sql: &str| store.query_text(sql).unwrap();
    assert_eq!(answer("SELECT hvac_power_w FROM annual_average"), [["2000.0"]]);
    // What was a view is a table with the same row; a number's history begins with what there is.
    assert_eq!(answer("SELECT solved_count, lower_weight, cooling_weight FROM limit_share"), [["4", "0.75", "0.25"]]);
    assert_eq!(answer("SELECT run_id, hvac_power_w FROM annual_history"), [["7", "2000.0"]]);
    // What is new is filled by the next run, which finds all months stale; nothing is wrong until then.
    assert_eq!(answer("SELECT count(*) FROM stale_month"), [["12"]]);
    assert_eq!(answer("SELECT count(*), count(local_hour) FROM sample"), [["1", "0"]]);
    assert_eq!(answer("SELECT count(*) FROM energy_class"), [["0"]]);
    assert!(
        answer("SELECT sql FROM sqlite_schema WHERE name = 'sample'")[0][0].contains("-- | weight: share in the year")
    );
    assert!(store.stage(store::RecordedStage::Solve).unwrap().is_none());
    store.check_averages().unwrap();
    store.close().unwrap();
}
