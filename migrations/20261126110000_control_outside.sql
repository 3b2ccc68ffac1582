-- How long passengers ride outside each window, whichever window's profile the bus follows.
--
-- Serves: power against passenger-hours outside one window, for all extracted profiles and published setpoints alike.
-- Cost: 64 rows of 40 bytes a mission, with eight windows.

CREATE TABLE controlled_outside (
    source_file_id          INTEGER NOT NULL,
    design_id               INTEGER NOT NULL,
    profile_id              INTEGER NOT NULL REFERENCES comfort_window (window_id) ON DELETE CASCADE,  -- that is followed
    window_id               INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,  -- by which it is judged
    passenger_hours_outside REAL NOT NULL,
    row_check               INTEGER,
    PRIMARY KEY (source_file_id, design_id, profile_id, window_id),
    FOREIGN KEY (source_file_id, design_id) REFERENCES controlled_mission_key ON DELETE CASCADE
) STRICT, WITHOUT ROWID;
CREATE INDEX controlled_outside_unchecked ON controlled_outside (source_file_id) WHERE row_check IS NULL;

-- Annual power of every controller beside its passenger-hours outside each window, of the last time that all was driven.
CREATE TABLE control_outside (
    design            TEXT NOT NULL,
    controller        TEXT NOT NULL,  -- extracted, a published name, one's own
    profile_pmv_min   REAL,           -- of the profile that is followed; null for setpoints that no window belongs to
    profile_pmv_max   REAL,
    pmv_limit         REAL NOT NULL,  -- the window by which it is judged
    pmv_min           REAL NOT NULL,
    pmv_max           REAL NOT NULL,
    mean_hvac_power_w REAL NOT NULL,
    outside_fraction  REAL,           -- of the passenger-hours; null where nobody ever is on board
    run_id            INTEGER NOT NULL
) STRICT;
CREATE UNIQUE INDEX control_outside_key
ON control_outside (design, controller, profile_pmv_min, profile_pmv_max, pmv_min, pmv_max);

-- The next run of `control` fills them.
DELETE FROM controlled_mission_key;
DELETE FROM stage_record WHERE stage = 'control';
