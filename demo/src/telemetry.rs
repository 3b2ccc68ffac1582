//! Telemetry of one mission at 1 Hz, in the columns and the number style of ZTBus.

use chrono::{DateTime, Timelike, Utc};
use std::f64::consts::{PI, TAU};
use std::io::Write as _;

use crate::random::Random;
use crate::{LATITUDE_DEG, LONGITUDE_DEG, MissionPlan};

const HEADER: &str = "time_iso,time_unix,electric_powerDemand,gnss_altitude,gnss_course,gnss_latitude,gnss_longitude,\
itcs_busRoute,itcs_numberOfPassengers,itcs_stopName,odometry_articulationAngle,odometry_steeringAngle,\
odometry_vehicleSpeed,odometry_wheelSpeed_fl,odometry_wheelSpeed_fr,odometry_wheelSpeed_ml,odometry_wheelSpeed_mr,\
odometry_wheelSpeed_rl,odometry_wheelSpeed_rr,status_doorIsOpen,status_gridIsAvailable,status_haltBrakeIsActive,\
status_parkBrakeIsActive,temperature_ambient,traction_brakePressure,traction_tractionForce\r\n";
const META_HEADER: &str = "name,busNumber,startTime_iso,startTime_unix,endTime_iso,endTime_unix,drivenDistance,busRoute,\
energyConsumption,itcs_numberOfPassengers_mean,itcs_numberOfPassengers_min,itcs_numberOfPassengers_max,\
status_gridIsAvailable_mean,temperature_ambient_mean,temperature_ambient_min,temperature_ambient_max\r\n";

/// About the longest row.
const ROW_BYTES: usize = 190;
/// Stops of a line from one terminus to the other.
const STOPS: [&str; 14] = [
    "Zürich, Altstetten",
    "Zürich, Letzipark",
    "Zürich, Letzipark West",
    "Zürich, Flurstrasse",
    "Zürich, SBB-Werkstätte",
    "Zürich, Herdernstrasse",
    "Zürich, Albisriederplatz",
    "Zürich, Hardplatz",
    "Zürich, Bahnhof Hardbrücke",
    "Zürich, Schiffbau",
    "Zürich, Escher-Wyss-Platz",
    "Zürich, Rosengartenstrasse",
    "Zürich, Bucheggplatz",
    "Zürich, Milchbuck",
];
/// Demand by the hour of the day in UTC, relative.
const DEMAND: [f64; 24] = [
    0.3, 0.3, 0.3, 0.4, 0.6, 1.2, 1.7, 1.3, 0.9, 0.8, 0.9, 1.0, 1.0, 1.0, 1.2, 1.6, 1.8, 1.3, 0.9, 0.7, 0.6, 0.5, 0.4,
    0.3,
];
/// Share of stops that are a wait at the terminus.
const TERMINUS_SHARE: f64 = 0.045;
const ACCELERATION_M_S2: f64 = 1.1;
const MASS_KG: f64 = 19_000.0;
/// Temperature in the depot.
const DEPOT_K: f64 = 295.15;
const DEPOT_MEMORY_S: f64 = 400.0;
const LINE_M: f64 = 12_000.0;

/// What a mission's telemetry amounts to.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Written {
    pub(crate) rows: u64,
    pub(crate) bytes: u64,
    distance_m: f64,
    energy_j: f64,
    /// Mean, least and largest.
    passengers: [f64; 3],
    grid_share: f64,
    ambient_k: [f64; 3],
}

/// A stretch of time in which the bus does one thing.
#[derive(Debug, Clone, Copy)]
struct Phase {
    seconds: u32,
    door_open: bool,
    /// 0 where the bus stands.
    cruise_m_s: f64,
    on_grid: bool,
}

/// A passenger count, taken just after the doors have closed.
#[derive(Debug, Clone, Copy)]
struct Record {
    second: u32,
    stop: usize,
    load: f64,
}

/// Generates the file of a mission; the random numbers come from the seed's stream `index`.
pub(crate) fn generate(plan: &MissionPlan, seed: u64, index: u64, file: &mut Vec<u8>) -> Written {
    let mut random = Random::new(seed, index);
    let rows = (plan.end - plan.start).num_seconds() as u32 + 1;
    let (phases, mut records) = timetable(plan.start, rows, &mut random);
    scale_loads(&mut records, plan);
    file.clear();
    file.reserve(rows as usize * ROW_BYTES);
    emit(plan, rows, &phases, &records, &mut random, file)
}

/// Phases one after the other.
#[derive(Debug, Default)]
struct Timetable {
    phases: Vec<Phase>,
    now: u32,
}

impl Timetable {
    fn push(&mut self, seconds: f64, door_open: bool, cruise_m_s: f64, on_grid: bool) {
        let seconds = seconds.round().max(1.0) as u32;
        self.phases.push(Phase { seconds, door_open, cruise_m_s, on_grid });
        self.now += seconds;
    }

    fn stand(&mut self, seconds: f64, door_open: bool, on_grid: bool) {
        self.push(seconds, door_open, 0.0, on_grid);
    }
}

/// What the bus does, for at least `rows` seconds, and where passengers are counted.
fn timetable(start: DateTime<Utc>, rows: u32, random: &mut Random) -> (Vec<Phase>, Vec<Record>) {
    let mut table = Timetable::default();
    let mut records = Vec::new();
    // In the depot: doors open early, first movement after a minute.
    let open = random.between(20.0, 45.0);
    table.stand(open, true, true);
    table.stand(random.between(58.0, 64.0) - open, false, true);
    let first_close = random.between(610.0, 760.0);
    let mut dwell = random.between(10.0, 20.0);
    table.push(first_close - dwell - f64::from(table.now), false, 7.0, false);

    // The last count lies 12 to 15 minutes before the end: a leg that would pass it is cut.
    let [earliest, latest] = [880.0, 730.0].map(|s| f64::from(rows) - s);
    let (mut stop, mut forward, mut crowd) = (0_usize, true, random.normal());
    loop {
        table.stand(dwell, true, random.chance(0.7));
        crowd = 0.8 * crowd + 0.6 * random.normal();
        let along = (stop as f64 + 0.5) / STOPS.len() as f64;
        let hour = (start.num_seconds_from_midnight() + table.now) / 3600;
        let demand = DEMAND[hour as usize % DEMAND.len()];
        let load = demand * (0.35 + (PI * along).sin()) * (0.35 * crowd).exp();
        let second = table.now + u32::from(random.chance(0.5));
        if second < rows {
            records.push(Record { second, stop, load });
        }
        table.stand(3.0, false, true);
        if f64::from(table.now) >= earliest {
            break;
        }
        if forward && stop + 1 == STOPS.len() || !forward && stop == 0 {
            forward = !forward;
        }
        stop = if forward { stop + 1 } else { stop - 1 };

        dwell = if random.chance(TERMINUS_SHARE) {
            random.between(120.0, 400.0)
        } else {
            random.log_normal(14.0, 0.6).clamp(5.0, 90.0)
        };
        let cruise = random.between(7.0, 11.0);
        let left = latest - f64::from(table.now);
        dwell = dwell.min(left - 40.0);
        let travel = random.log_normal(58.5, 0.68).clamp(25.0, 400.0).min(left - dwell - 5.0);
        if travel > 45.0 && random.chance(0.45) {
            let red = random.between(8.0, 0.5 * travel);
            let before = (travel - red) * random.between(0.3, 0.7);
            table.push(before, false, cruise, random.chance(0.7));
            table.stand(red, false, random.chance(0.7));
            table.push(travel - red - before, false, cruise, random.chance(0.7));
        } else {
            table.push(travel, false, cruise, random.chance(0.7));
        }
    }
    // Back to the depot, doors open at the end.
    let left = f64::from(rows.saturating_sub(table.now));
    table.push((left - 120.0).max(1.0), false, 7.0, false);
    table.stand(100.0, false, false);
    table.stand(1e6, true, false);
    (table.phases, records)
}

/// Whole passengers whose mean is the plan's, within its largest load.
fn scale_loads(records: &mut [Record], plan: &MissionPlan) {
    if records.is_empty() {
        return;
    }
    let raw: Vec<f64> = records.iter().map(|r| r.load).collect();
    let count = raw.len() as f64;
    let mut scale = plan.passengers_mean * count / raw.iter().sum::<f64>();
    // What the cap cuts off is made up by the others.
    for _ in 0..20 {
        for (record, load) in records.iter_mut().zip(&raw) {
            record.load = (load * scale).round().min(plan.passengers_max.floor());
        }
        let mean = records.iter().map(|r| r.load).sum::<f64>() / count;
        if mean <= 0.0 || (mean - plan.passengers_mean).abs() < 0.05 {
            break;
        }
        scale *= plan.passengers_mean / mean;
    }
}

fn emit(
    plan: &MissionPlan,
    rows: u32,
    phases: &[Phase],
    records: &[Record],
    random: &mut Random,
    file: &mut Vec<u8>,
) -> Written {
    let gnss_from = random.between(480.0, 720.0) as u32;
    let line_bearing = random.between(0.0, TAU);
    let auxiliary_w = random.between(4000.0, 8000.0);
    let (mut distance_m, mut energy_j, mut ambient_sum, mut on_grid) = (0.0, 0.0, 0.0, 0_u64);
    let (mut coldest, mut hottest) = (f64::INFINITY, f64::NEG_INFINITY);
    let loads = || records.iter().map(|r| r.load);
    let mut counts = records.iter().peekable();
    let mut phases = phases.iter();
    let mut phase = phases.next().copied();
    let (mut into, mut speed) = (0_u32, 0.0_f64);
    let mut clock = Clock::new(plan.start);
    file.extend_from_slice(HEADER.as_bytes());

    for row in 0..rows {
        while phase.is_some_and(|p| into >= p.seconds) {
            phase = phases.next().copied();
            into = 0;
        }
        let now = phase.unwrap_or(Phase { seconds: 1, door_open: true, cruise_m_s: 0.0, on_grid: false });
        let before = speed;
        let ramp = (f64::from(into) + 0.5).min(f64::from(now.seconds - into) - 0.5) * ACCELERATION_M_S2;
        speed = now.cruise_m_s.min(ramp).max(0.0);
        into += 1;
        let acceleration = speed - before;
        let standing = speed == 0.0;
        distance_m += speed;

        let noise = random.between(-1.0, 1.0);
        let force_n =
            if standing { 0.0 } else { MASS_KG * acceleration + 1500.0 + 3.0 * speed * speed + 200.0 * noise };
        let efficiency = if force_n > 0.0 { 1.0 / 0.85 } else { 0.7 };
        let power_w = auxiliary_w + 400.0 * noise + force_n * speed * efficiency;
        energy_j += power_w;
        on_grid += u64::from(now.on_grid);
        let settle = (-f64::from(row) / DEPOT_MEMORY_S).exp();
        let [mean_k, least_k, largest_k] = plan.ambient_k;
        let day = 0.5 * (largest_k - least_k).clamp(0.0, 4.0) * ((clock.hour() - 14.0) / 24.0 * TAU).cos();
        let outside_k = mean_k + day;
        let ambient_k = (outside_k + (DEPOT_K - outside_k) * settle - 0.15).round() + 0.15;
        ambient_sum += ambient_k;
        coldest = coldest.min(ambient_k);
        hottest = hottest.max(ambient_k);

        clock.write(file);
        push_fixed(file, power_w, 2);
        if row < gnss_from {
            file.extend_from_slice(b",NaN,NaN,NaN,NaN,");
        } else {
            let turn = TAU * distance_m / (2.0 * LINE_M);
            let course = (line_bearing + 0.9 * turn.sin()).rem_euclid(TAU);
            let north = (0.5 * LINE_M) * turn.sin() / 6.371e6;
            let east = (0.25 * LINE_M) * (2.0 * turn).sin() / 6.371e6;
            comma_fixed(file, 425.0 + 25.0 * turn.cos() + noise, 3);
            comma_fixed(file, course, 6);
            comma_fixed(file, LATITUDE_DEG.to_radians() + north, 7);
            comma_fixed(file, LONGITUDE_DEG.to_radians() + east, 7);
            file.push(b',');
        }
        match counts.peek() {
            Some(record) if record.second == row => {
                // Writing to a vector cannot fail.
                let _ = write!(file, "\"{}\",{},\"{}\"", plan.route, record.load, STOPS[record.stop]);
                counts.next();
            }
            _ => file.extend_from_slice(b"\"-\",NaN,\"-\""),
        }
        let wobble = if standing { 0.0 } else { noise };
        file.extend_from_slice(if wobble > 0.3 { b",0.01745333" } else { b",0.008726667" });
        if standing {
            file.extend_from_slice(b",-0,0,0,0,0,0,0,0");
        } else {
            comma_fixed(file, 0.02 * wobble, 6);
            comma_fixed(file, speed, 6);
            for wheel in [0.01, -0.008, 0.006, -0.012, 0.004, -0.006] {
                comma_fixed(file, (speed + wheel * wobble).max(0.0), 6);
            }
        }
        let parked = row < 20 || row + 60 > rows;
        if row + 1 == rows {
            file.extend_from_slice(b",NaN,NaN,NaN,NaN,NaN");
        } else {
            for flag in [now.door_open, now.on_grid, standing, parked] {
                file.extend_from_slice(if flag { b",1" } else { b",0" });
            }
            comma_fixed(file, ambient_k, 2);
        }
        let brake_pa = if standing {
            250_000.0 + 5000.0 * noise
        } else if acceleration < -0.5 {
            40_000.0
        } else {
            0.0
        };
        comma_fixed(file, brake_pa, 1);
        comma_fixed(file, force_n, 3);
        file.extend_from_slice(b"\r\n");
        clock.tick();
    }
    Written {
        rows: u64::from(rows),
        bytes: file.len() as u64,
        distance_m,
        energy_j,
        passengers: [
            loads().sum::<f64>() / records.len() as f64,
            loads().fold(f64::NAN, f64::min),
            loads().fold(f64::NAN, f64::max),
        ],
        grid_share: on_grid as f64 / f64::from(rows),
        ambient_k: [ambient_sum / f64::from(rows), coldest, hottest],
    }
}

/// Writes seconds as `"2021-07-26T03:53:27Z",1627271607,` without asking a calendar every second.
struct Clock {
    second_of_day: u32,
    unix: i64,
    date: String,
}

impl Clock {
    fn new(start: DateTime<Utc>) -> Self {
        Self {
            second_of_day: start.num_seconds_from_midnight(),
            unix: start.timestamp(),
            date: start.format("%Y-%m-%d").to_string(),
        }
    }

    fn hour(&self) -> f64 {
        f64::from(self.second_of_day) / 3600.0
    }

    fn tick(&mut self) {
        self.unix += 1;
        self.second_of_day += 1;
        if self.second_of_day == 86_400 {
            self.second_of_day = 0;
            if let Some(day) = DateTime::from_timestamp(self.unix, 0) {
                self.date = day.format("%Y-%m-%d").to_string();
            }
        }
    }

    fn write(&self, file: &mut Vec<u8>) {
        file.push(b'"');
        file.extend_from_slice(self.date.as_bytes());
        for (mark, value) in
            [(b'T', self.second_of_day / 3600), (b':', self.second_of_day / 60 % 60), (b':', self.second_of_day % 60)]
        {
            file.extend_from_slice(&[mark, b'0' + (value / 10) as u8, b'0' + (value % 10) as u8]);
        }
        file.extend_from_slice(b"Z\",");
        push_fixed(file, self.unix as f64, 0);
        file.push(b',');
    }
}

fn comma_fixed(file: &mut Vec<u8>, value: f64, decimals: usize) {
    file.push(b',');
    push_fixed(file, value, decimals);
}

/// A number with at most so many decimals, without trailing zeros. The standard formatter takes five times as long,
/// which is a minute for a data set like the real one.
fn push_fixed(file: &mut Vec<u8>, value: f64, decimals: usize) {
    const SCALE: [f64; 8] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7];
    let mut units = (value.abs() * SCALE[decimals]).round() as u64;
    let mut decimals = decimals;
    while decimals > 0 && units.is_multiple_of(10) {
        units /= 10;
        decimals -= 1;
    }
    if value < 0.0 {
        file.push(b'-');
    }
    let mut digits = [0_u8; 24];
    let mut at = digits.len();
    let mut written = 0;
    while units > 0 || written <= decimals {
        if written == decimals && decimals > 0 {
            at -= 1;
            digits[at] = b'.';
        }
        at -= 1;
        digits[at] = b'0' + (units % 10) as u8;
        units /= 10;
        written += 1;
    }
    file.extend_from_slice(&digits[at..]);
}

/// The table of all missions.
pub(crate) fn meta_data(plans: &[MissionPlan], written: &[Written]) -> Vec<u8> {
    let mut rows: Vec<(String, String)> = plans
        .iter()
        .zip(written)
        .map(|(plan, w)| {
            let time = |t: DateTime<Utc>| t.format("%Y-%m-%dT%H:%M:%SZ").to_string();
            let numbers = [w.passengers[0], w.passengers[1], w.passengers[2], w.grid_share]
                .into_iter()
                .chain(w.ambient_k)
                .map(seven_digits)
                .collect::<Vec<_>>()
                .join(",");
            let row = format!(
                "\"{}\",{},\"{}\",{},\"{}\",{},{},\"{}\",{},{numbers}\r\n",
                plan.name(),
                plan.bus,
                time(plan.start),
                plan.start.timestamp(),
                time(plan.end),
                plan.end.timestamp(),
                seven_digits(w.distance_m),
                plan.route,
                seven_digits(w.energy_j),
            );
            (plan.name(), row)
        })
        .collect();
    rows.sort();
    let mut file = META_HEADER.as_bytes().to_vec();
    for (_, row) in rows {
        file.extend_from_slice(row.as_bytes());
    }
    file
}

/// Seven significant digits, with an exponent from 10⁷ on, as ZTBus writes them.
fn seven_digits(value: f64) -> String {
    if !value.is_finite() {
        return "NaN".to_owned();
    }
    if value.abs() >= 1e7 {
        let text = format!("{value:.6e}");
        return match text.split_once('e') {
            Some((mantissa, exponent)) => format!("{mantissa}e+{exponent:0>2}"),
            None => text,
        };
    }
    let whole_digits = if value.abs() < 1.0 { 0 } else { value.abs().log10() as usize + 1 };
    let text = format!("{value:.*}", 7_usize.saturating_sub(whole_digits));
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
