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

fn earlier(folder: &Path) -> PathBuf {
    let migrations = folder.join("migrations");
    std::fs::create_dir(&migrations).unwrap();
    for name in EARLIER {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../migrations").join(name);
        std::fs::copy(from, migrations.join(name)).unwrap();
    }
    let path = folder.join("study.db");
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
    runtime.block_on(async {
        let url = format!("sqlite://{}?mode=rwc", path.display());
        let mut connection = SqliteConnection::connect(&url).await.unwrap();
        Migrator::new(migrations).await.unwrap().run(&mut connection).await.unwrap();
        sqlx::raw_sql(ROWS).execute(&mut connection).await.unwrap();
        connection.close().await.unwrap();
    });
    path
}

#[test]
fn prop_a_database_of_an_earlier_version_opens_and_keeps_its_optima() {
    let folder = tempfile::tempdir().unwrap();
    // For reading too, though it has to be written for that once.
    let mut store = Store::open_read_only(&earlier(folder.path())).unwrap();
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
