//! Plain rows, as they go into the tables. Times are RFC 3339 in UTC.

/// An input file and what was noticed in it.
#[derive(Debug, Clone, PartialEq)]
pub struct FileRow {
    /// Path as the study names it; unique.
    pub path: String,
    /// `mission`, `weather` or `shadow`.
    pub kind: String,
    /// BLAKE3 of the content, hexadecimal.
    pub blake3: String,
    /// Size in bytes.
    pub bytes: u64,
    /// Data rows, without the header.
    pub rows: u64,
    /// First and last time in the file.
    pub first_utc: Option<String>,
    /// Last time in the file.
    pub last_utc: Option<String>,
    /// Whether the file is used.
    pub accepted: bool,
    /// BLAKE3 of the content and of the settings that it was read with.
    pub reading_key: String,
    /// What was noticed.
    pub findings: Vec<FindingRow>,
}

/// Something noticed in an input file.
#[derive(Debug, Clone, PartialEq)]
pub struct FindingRow {
    /// Kind in snake case.
    pub kind: String,
    /// How often.
    pub count: u64,
    /// First line concerned; the header is line 1.
    pub line: Option<u64>,
    /// Column concerned.
    pub column: Option<String>,
    /// What it is and what to do.
    pub message: String,
}

/// A segment of a mission: what its telemetry says, or why it says nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct SegmentRow {
    /// Name of the mission.
    pub mission: String,
    /// Number of the bus.
    pub bus: u32,
    /// Number of the segment, from 0.
    pub segment: u32,
    /// Start.
    pub start_utc: String,
    /// Length in s.
    pub duration_s: u32,
    /// Mean passengers, mean door open fraction, and first and last line of the file; or why it is excluded.
    pub content: Result<(f64, f64, u64, u64), String>,
}

/// A segment without a sample.
#[derive(Debug, Clone, PartialEq)]
pub struct ExclusionRow {
    /// Name of the mission.
    pub mission: String,
    /// Number of the segment, from 0.
    pub segment: u32,
    /// Start.
    pub start_utc: String,
    /// Why.
    pub reason: String,
}

/// An hourly sample.
#[derive(Debug, Clone, PartialEq)]
pub struct SampleRow {
    /// Bus × 10¹⁰ + start in seconds since 1970.
    pub sample_id: i64,
    /// Name of the mission; its file must be in the store.
    pub mission: String,
    /// Path of the mission's file.
    pub source_path: String,
    /// Number of the bus.
    pub bus: u32,
    /// Number of the segment, from 0.
    pub segment: u32,
    /// First line of the file.
    pub first_line: u64,
    /// Last line of the file.
    pub last_line: u64,
    /// Start.
    pub start_utc: String,
    /// Length in s.
    pub duration_s: u32,
    /// Local month, 1 … 12.
    pub month: u8,
    /// Ambient temperature in K.
    pub ambient_temperature_k: f64,
    /// Direct normal irradiance in W/m².
    pub dni_w_m2: f64,
    /// Diffuse horizontal irradiance in W/m².
    pub dhi_w_m2: f64,
    /// Mean passengers.
    pub passengers: f64,
    /// Mean fraction of open doors.
    pub door_open_fraction: f64,
    /// Solar altitude in rad.
    pub solar_altitude_rad: f64,
    /// Solar azimuth in rad.
    pub solar_azimuth_rad: f64,
    /// Mean shadow fraction.
    pub shadow_fraction: f64,
    /// Seconds whose weather is interpolated.
    pub interpolated_s: f64,
}

/// A design of the study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DesignRow {
    /// Name, unique.
    pub name: String,
    /// `ptc` or `hp`.
    pub heating: String,
    /// Name or table of the heating COP.
    pub heating_cop: String,
    /// Name or table of the cooling COP.
    pub cooling_cop: String,
    /// Whether radiant heaters are on board.
    pub radiant_heaters: bool,
    /// Whether air curtains are on board.
    pub air_curtain: bool,
    /// How its optima are found.
    pub method: String,
    /// BLAKE3 of design, vehicle constants and version of the method.
    pub design_key: String,
}

/// A comfort window of the study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowRow {
    /// Lower limit.
    pub pmv_min: f64,
    /// Upper limit.
    pub pmv_max: f64,
    /// The larger distance from neutral.
    pub pmv_limit: f64,
}

/// A finding with the file it is about.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredFinding {
    /// Path of the file.
    pub path: String,
    /// Kind of the file.
    pub file_kind: String,
    /// The finding.
    pub finding: FindingRow,
}

/// An excluded segment as stored.
pub type StoredExclusion = ExclusionRow;
