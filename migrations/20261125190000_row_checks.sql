-- Checks of rows and of tables of averages, against storage that changes a bit without saying so.
--
-- Serves: `run`, which refuses to build on a damaged row, and `verify`, which looks at all of them.
-- Cost: 9 bytes a row; a twentieth of the file.

-- First 63 bits of the BLAKE3 hash of all columns before it; null where a row of an earlier version has none yet. A check
-- stands last in its table.
ALTER TABLE source_file ADD COLUMN row_check INTEGER;
ALTER TABLE data_quality ADD COLUMN row_check INTEGER;
ALTER TABLE excluded_segment ADD COLUMN row_check INTEGER;
ALTER TABLE stage_record ADD COLUMN row_check INTEGER;
ALTER TABLE mission_segment ADD COLUMN row_check INTEGER;
ALTER TABLE mission_load ADD COLUMN row_check INTEGER;
ALTER TABLE hourly_sample ADD COLUMN row_check INTEGER;
ALTER TABLE hvac_design ADD COLUMN row_check INTEGER;
ALTER TABLE comfort_window ADD COLUMN row_check INTEGER;
ALTER TABLE optimum_point ADD COLUMN row_check INTEGER;
ALTER TABLE simulated_mission ADD COLUMN row_check INTEGER;
ALTER TABLE unsimulated_mission ADD COLUMN row_check INTEGER;
ALTER TABLE mission_trace ADD COLUMN row_check INTEGER;
ALTER TABLE trace_minute ADD COLUMN row_check INTEGER;

-- Rows without a check: few or none, found at once. Optima get theirs when they are inserted.
CREATE INDEX source_file_unchecked ON source_file (source_file_id) WHERE row_check IS NULL;
CREATE INDEX data_quality_unchecked ON data_quality (source_file_id) WHERE row_check IS NULL;
CREATE INDEX excluded_segment_unchecked ON excluded_segment (mission) WHERE row_check IS NULL;
CREATE INDEX stage_record_unchecked ON stage_record (stage) WHERE row_check IS NULL;
CREATE INDEX mission_segment_unchecked ON mission_segment (source_file_id, segment) WHERE row_check IS NULL;
CREATE INDEX mission_load_unchecked ON mission_load (source_file_id) WHERE row_check IS NULL;
CREATE INDEX hourly_sample_unchecked ON hourly_sample (sample_id) WHERE row_check IS NULL;
CREATE INDEX hvac_design_unchecked ON hvac_design (design_id) WHERE row_check IS NULL;
CREATE INDEX comfort_window_unchecked ON comfort_window (window_id) WHERE row_check IS NULL;
CREATE INDEX simulated_mission_unchecked ON simulated_mission (source_file_id) WHERE row_check IS NULL;
CREATE INDEX unsimulated_mission_unchecked ON unsimulated_mission (source_file_id) WHERE row_check IS NULL;
CREATE INDEX mission_trace_unchecked ON mission_trace (trace_id) WHERE row_check IS NULL;
CREATE INDEX trace_minute_unchecked ON trace_minute (trace_id) WHERE row_check IS NULL;

-- A row that is changed loses its check, and gets another in the same transaction.
CREATE TRIGGER source_file_changed
AFTER UPDATE OF path, kind, blake3, bytes, rows, first_utc, last_utc, outcome, reading_key ON source_file
BEGIN UPDATE source_file SET row_check = NULL WHERE source_file_id = NEW.source_file_id; END;
CREATE TRIGGER hourly_sample_changed AFTER UPDATE OF sample_key ON hourly_sample
BEGIN UPDATE hourly_sample SET row_check = NULL WHERE sample_id = NEW.sample_id; END;
CREATE TRIGGER hvac_design_changed AFTER UPDATE OF name, position ON hvac_design
BEGIN UPDATE hvac_design SET row_check = NULL WHERE design_id = NEW.design_id; END;
CREATE TRIGGER comfort_window_changed AFTER UPDATE OF position ON comfort_window
BEGIN UPDATE comfort_window SET row_check = NULL WHERE window_id = NEW.window_id; END;
CREATE TRIGGER simulated_mission_changed AFTER UPDATE OF simulation_key ON simulated_mission
BEGIN
    UPDATE simulated_mission SET row_check = NULL
    WHERE source_file_id = NEW.source_file_id AND design_id = NEW.design_id AND window_id = NEW.window_id
        AND controller = NEW.controller;
END;
CREATE TRIGGER unsimulated_mission_changed AFTER UPDATE OF simulation_key ON unsimulated_mission
BEGIN
    UPDATE unsimulated_mission SET row_check = NULL
    WHERE source_file_id = NEW.source_file_id AND design_id = NEW.design_id AND window_id = NEW.window_id;
END;

-- BLAKE3 over all rows of a table of averages, in the order of its key.
CREATE TABLE table_check (
    table_name TEXT PRIMARY KEY,  -- monthly_average, annual_average, simulation_annual, simulation_class
    blake3     TEXT NOT NULL
) STRICT, WITHOUT ROWID;

-- A year has some thousand samples: they are looked through faster than an index could go wrong.
DROP INDEX hourly_sample_by_month;
