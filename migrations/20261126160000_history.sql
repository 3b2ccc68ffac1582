-- When a number moved, and why.
--
-- Serves: whoever asks a nightly job since which run an annual average is what it is, and what had changed by then.
-- Cost: 70 bytes for each design and window in a run that found optima, 2 MB in a year of nights; a row for each setting or input
-- that changed.

CREATE TABLE annual_history (
    run_id         INTEGER NOT NULL REFERENCES run ON DELETE CASCADE,
    design         TEXT NOT NULL,
    pmv_limit      REAL NOT NULL,
    pmv_min        REAL NOT NULL,
    pmv_max        REAL NOT NULL,
    hvac_power_w   REAL,
    sample_count   INTEGER NOT NULL,
    unsolved_count INTEGER NOT NULL,
    PRIMARY KEY (run_id, design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;

-- What a run found changed since the one before.
CREATE TABLE run_change (
    run_id       INTEGER NOT NULL REFERENCES run ON DELETE CASCADE,
    position     INTEGER NOT NULL,
    kind         TEXT NOT NULL CHECK (kind IN ('setting', 'input', 'samples')),
    name         TEXT NOT NULL,
    before_value TEXT,              -- null where there was none
    after_value  TEXT,              -- null where there is none
    PRIMARY KEY (run_id, position)
) STRICT, WITHOUT ROWID;

INSERT INTO annual_history
SELECT run_id, design, pmv_limit, pmv_min, pmv_max, hvac_power_w, sample_count, unsolved_count
FROM annual_average WHERE run_id IN (SELECT run_id FROM run);
