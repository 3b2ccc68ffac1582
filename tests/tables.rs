//! Telemetry of operators without ZTBus files: tables with columns of their own names give the samples of the same missions.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use std::fmt::Write as _;

const SAMPLES: &str =
    "SELECT sample_id, bus, start_utc, passengers, door_open_fraction, ambient_temperature_c, dni_w_m2,
    distance_m, vehicle_power_w, route FROM sample ORDER BY 1";

/// Seconds, passengers, doors, speed, power and route of a mission of the demo.
fn rows(scratch: &Scratch, name: &str) -> Vec<[String; 6]> {
    let text = scratch.read(&format!("ztbus/{name}"));
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let columns = [
        "time_unix",
        "itcs_numberOfPassengers",
        "status_doorIsOpen",
        "odometry_vehicleSpeed",
        "electric_powerDemand",
        "itcs_busRoute",
    ];
    let places = columns.map(|name| header.iter().position(|h| h == name).unwrap());
    reader.records().map(|r| r.unwrap()).map(|r| places.map(|place| r[place].to_owned())).collect()
}

/// A study of the demo's missions, and the same with a table in their place.
fn study(missions: usize, keys: &str) -> Scratch {
    let scratch = Scratch::small(missions, "[1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    let text = scratch.read("study.toml");
    scratch.write("table.toml", text.replace("path = \"ztbus\"", keys).replace("study.db", "table.db"));
    scratch
}

const KEYS: &str = "format = \"csv\"\npath = \"telemetry\"\ntime_column = \"when\"\nvehicle_column = \"bus\"\n\
    passengers_column = \"load\"\ndoor_column = \"doors\"\nspeed_column = \"speed\"\npower_column = \"power\"\nroute_column = \"line\"\n";

fn equal(scratch: &Scratch) {
    scratch.expect(0, &["run", "table.toml"]);
    let rows = |database: &str| {
        let round = |cell: &String| cell.parse::<f64>().map_or(cell.clone(), |x| format!("{x:.9e}"));
        let rows = scratch.query_of(database, SAMPLES);
        rows.iter().map(|row| row.iter().map(round).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    let (meant, read) = (rows("study.db"), rows("table.db"));
    assert!(meant.len() > 3);
    assert_eq!(meant, read);
}

#[test]
fn prop_a_table_of_one_vehicle_and_day_gives_the_samples_of_its_mission() {
    let keys = format!(
        "{}time_zone = \"Europe/Zurich\"\nspeed_unit = \"km/h\"\npower_unit = \"kW\"\n",
        KEYS.replace("vehicle_column = \"bus\"", "vehicle = 183")
    );
    let scratch = study(2, &keys);
    std::fs::create_dir(scratch.path("telemetry")).unwrap();
    for (n, name) in scratch.missions().iter().enumerate() {
        // Local time, other units, semicolons, flags in words, empty fields.
        let mut text = "when;load;doors;speed;power;line\n".to_owned();
        for [time, load, door, speed, power, line] in rows(&scratch, name) {
            let at = chrono::DateTime::from_timestamp(time.parse().unwrap(), 0).unwrap();
            let local = at.with_timezone(&chrono_tz::Europe::Zurich).format("%d.%m.%Y %H:%M:%S");
            let door = match door.as_str() {
                "1" => "true",
                "0" => "false",
                _ => "",
            };
            let load = if load == "NaN" { "" } else { &load };
            let [speed, power] =
                [speed.parse::<f64>().map(|v| v * 3.6), power.parse::<f64>().map(|p| p / 1000.0)].map(Result::unwrap);
            let _ = writeln!(text, "{local};{load};{door};{speed};{power};{line}");
        }
        scratch.write(&format!("telemetry/day{n}.csv"), text);
    }
    equal(&scratch);
}

#[test]
fn prop_a_table_of_many_is_cut_by_vehicle_and_gap() {
    let scratch = study(3, KEYS);
    std::fs::create_dir(scratch.path("telemetry")).unwrap();
    // All in one, with another bus between that the study does not have, and a unit in front of the numbers.
    let mut text = "when,bus,load,doors,speed,power,line\n".to_owned();
    for name in scratch.missions() {
        for [time, load, door, speed, power, line] in rows(&scratch, &name) {
            let _ = writeln!(text, "{time},Bus 183,{load},{door},{speed},{power},{line}");
            let _ = writeln!(text, "{time},Bus 7,50,1,0,0,-");
        }
    }
    scratch.write("telemetry/all.csv", &text);
    equal(&scratch);
    // Known again, and a row more is another mission for what depends on it alone.
    let run = scratch.expect(0, &["run", "table.toml"]);
    assert!(run.stderr.contains("3 missions: 0 read now, 0 no longer there"), "{}", run.stderr);
    assert_eq!(
        scratch.query_of("table.db", "SELECT count(*) FROM source_file WHERE path LIKE 'telemetry/all.csv!B183_%'"),
        [["3"]]
    );
    // Lines are those of the file.
    let line = &scratch.query_of("table.db", "SELECT first_line FROM sample ORDER BY sample_id DESC LIMIT 1")[0][0];
    assert!(text.lines().nth(line.parse::<usize>().unwrap() - 1).unwrap().contains(",Bus 183,"));
    // What is wrong is said with file, line and column.
    scratch.write("telemetry/all.csv", text.replace(",Bus 7,", ",Bus 1-83,"));
    let run = scratch.expect(3, &["run", "table.toml"]);
    assert!(
        run.stderr.contains("line 3, column bus: \"Bus 183\" and \"Bus 1-83\" are both the vehicle number 183"),
        "{}",
        run.stderr
    );
    scratch.write("telemetry/all.csv", text.replacen("bus,load", "vehicle,load", 1));
    assert!(scratch.expect(3, &["run", "table.toml"]).stderr.contains("line 1, column bus: the column is missing"));
}

#[test]
fn prop_rows_hold_and_a_share_of_the_doors_counts_as_it_is() {
    let keys = KEYS
        .replace("door_column", "door_share_column")
        .replace("speed_column = \"speed\"\npower_column = \"power\"\n", "");
    let scratch = study(1, &keys);
    std::fs::create_dir(scratch.path("telemetry")).unwrap();
    let rows = rows(&scratch, &scratch.missions()[0]);
    let start: i64 = rows[0][0].parse().unwrap();
    // A row every ten seconds of two hours: 30 on board, a third of the doors open in every sixth of them; one gap of five
    // minutes in the second hour.
    let mut text = "when,bus,load,doors,line\n".to_owned();
    for n in (0..720).filter(|n| !(400..430).contains(n)) {
        let share = if n % 6 == 0 { "0.333" } else { "0" };
        let _ = writeln!(text, "{},183,30,{share},x", start + 10 * n);
    }
    let _ = writeln!(text, "{},183,30,0,x", start + 7199);
    scratch.write("telemetry/sparse.csv", text);
    scratch.expect(0, &["run", "table.toml"]);
    let samples =
        scratch.query_of("table.db", "SELECT passengers, round(door_open_fraction, 9), distance_m, route FROM sample");
    assert_eq!(samples, [["30.0", "0.055833333", "", "x"]]);
    let excluded = scratch.query_of("table.db", "SELECT segment, reason FROM excluded_segment");
    assert_eq!(excluded, [["1", "more than 1 % of the seconds have no telemetry"]]);
    // A longer gap ends a mission.
    scratch.edit("table.toml", "path = \"telemetry\"", "path = \"telemetry\"\ncut_gap_s = 200");
    scratch.run(&["run", "table.toml"]);
    assert_eq!(scratch.query_of("table.db", "SELECT count(*) FROM source_file WHERE kind = 'mission'"), [["2"]]);
}

#[test]
fn cli_keys_of_tables_are_checked() {
    let scratch = study(1, KEYS);
    let text = scratch.read("table.toml");
    for (from, to, said) in [
        ("door_column = \"doors\"\n", "", "[missions] format = \"csv\" needs door_column or door_share_column"),
        ("vehicle_column = \"bus\"", "vehicle = 3\nvehicle_column = \"bus\"", "has both vehicle_column and vehicle"),
        ("format = \"csv\"", "format = \"ztbus\"", "[missions] time_column belongs to format = \"csv\" only"),
        (
            "path = \"telemetry\"",
            "path = \"telemetry\"\nspeed_unit = \"mph\"",
            "speed_unit = \"mph\" is not known; known are: m/s, km/h",
        ),
        ("path = \"telemetry\"", "path = \"telemetry\"\nhold_s = 0", "hold_s = 0 must lie between 1 and 86400"),
    ] {
        scratch.write("table.toml", text.replace(from, to));
        let run = scratch.expect(2, &["check", "table.toml"]);
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
}
