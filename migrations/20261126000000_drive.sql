-- What the bus does in a segment besides carrying people: distance, electric power, route.
--
-- Serves: analysts who relate the power of heating and cooling to the distance, and to all power of the bus.
-- Cost: some 20 bytes a segment. Missions are read anew once, since the rows of earlier versions have nulls there.

DROP TRIGGER segment_gone;
CREATE TABLE mission_segment_new (
    source_file_id     INTEGER NOT NULL REFERENCES source_file ON DELETE CASCADE,
    segment            INTEGER NOT NULL,  -- counts from 0 at the start of the mission
    mission            TEXT NOT NULL,
    bus                INTEGER NOT NULL,
    start_utc          TEXT NOT NULL,
    duration_s         INTEGER NOT NULL,
    passengers         REAL,              -- mean; null where the segment is excluded
    door_open_fraction REAL,
    distance_m         REAL,              -- null where more than 1 % of the seconds have no speed
    vehicle_power_w    REAL,              -- mean; null where more than 1 % of the seconds have none
    route              TEXT,              -- of most seconds; null where the bus is on none
    first_line         INTEGER,
    last_line          INTEGER,
    excluded           TEXT,              -- why the telemetry gives no sample, null where it does
    row_check          INTEGER,
    PRIMARY KEY (source_file_id, segment)
) STRICT, WITHOUT ROWID;
INSERT INTO mission_segment_new
SELECT source_file_id, segment, mission, bus, start_utc, duration_s, passengers, door_open_fraction, NULL, NULL, NULL,
    first_line, last_line, excluded, NULL
FROM mission_segment;
DROP TABLE mission_segment;
ALTER TABLE mission_segment_new RENAME TO mission_segment;
CREATE INDEX mission_segment_unchecked ON mission_segment (source_file_id, segment) WHERE row_check IS NULL;
CREATE TRIGGER segment_gone AFTER DELETE ON mission_segment
BEGIN DELETE FROM excluded_segment WHERE mission = OLD.mission AND segment = OLD.segment; END;

DROP VIEW sample;
CREATE VIEW sample AS
SELECT
    s.sample_id,
    s.mission,
    s.bus,
    s.segment,
    s.start_utc,
    s.month,
    w.sample_weight AS weight,
    s.ambient_temperature_k - 273.15 AS ambient_temperature_c,
    s.dni_w_m2,
    s.dhi_w_m2,
    s.passengers,
    s.door_open_fraction,
    -- degrees() is an optional function of SQLite.
    s.solar_altitude_rad * 57.29577951308232 AS solar_altitude_deg,
    s.solar_azimuth_rad * 57.29577951308232 AS solar_azimuth_deg,
    s.shadow_fraction,
    s.interpolated_s,
    f.path AS source_path,
    s.first_line,
    s.last_line,
    g.distance_m,
    g.vehicle_power_w,
    g.route
FROM hourly_sample AS s
JOIN month_weight AS w USING (month)
JOIN source_file AS f USING (source_file_id)
LEFT JOIN mission_segment AS g ON g.source_file_id = s.source_file_id AND g.segment = s.segment;
