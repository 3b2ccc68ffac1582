-- What simulated missions come to in each month, of which the year's averages are made.
--
-- Serves: nights, which look only at the months whose simulations have changed.
-- Cost: some 30 rows for each design, window and month.

CREATE TABLE simulation_month (
    design_id          INTEGER NOT NULL REFERENCES hvac_design ON DELETE CASCADE,
    window_id          INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,
    controller         TEXT NOT NULL,
    month              INTEGER NOT NULL,
    power_w            REAL NOT NULL,    -- means over all seconds of the month
    static_power_w     REAL NOT NULL,
    saturated_fraction REAL NOT NULL,
    mission_count      INTEGER NOT NULL,
    PRIMARY KEY (design_id, window_id, controller, month)
) STRICT, WITHOUT ROWID;

-- The same by class of simulated missions, driven as in the paper: sums over their seconds.
CREATE TABLE simulation_class_month (
    design_id     INTEGER NOT NULL REFERENCES hvac_design ON DELETE CASCADE,
    window_id     INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,
    class_order   INTEGER NOT NULL,
    month         INTEGER NOT NULL,
    sorted_by     TEXT NOT NULL,
    class         TEXT NOT NULL,
    mission_count INTEGER NOT NULL,
    seconds       INTEGER NOT NULL,
    power_ws      REAL NOT NULL,
    static_ws     REAL NOT NULL,
    warm_ws       REAL NOT NULL,
    saturated_s   REAL NOT NULL,
    vote_sum      REAL,               -- over the missions of vote_count; null where there is none
    vote_count    INTEGER NOT NULL,   -- missions with somebody on board
    PRIMARY KEY (design_id, window_id, class_order, month)
) STRICT, WITHOUT ROWID;

-- Months whose simulations have changed.
CREATE TABLE stale_simulation_month (month INTEGER PRIMARY KEY) STRICT;
CREATE TRIGGER simulation_put AFTER INSERT ON simulated_mission
BEGIN INSERT OR IGNORE INTO stale_simulation_month VALUES (NEW.month); END;
CREATE TRIGGER simulation_gone AFTER DELETE ON simulated_mission
BEGIN INSERT OR IGNORE INTO stale_simulation_month VALUES (OLD.month); END;

-- Points without an optimum: few or none, counted at once.
CREATE INDEX optimum_point_unsolved ON optimum_point (status) WHERE status <> 0;

-- The next run of `simulate` fills the tables.
INSERT INTO stale_simulation_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12);
DELETE FROM stage_record WHERE stage = 'simulate';
