-- What binds in which share of the year, as a table.
--
-- Serves: whoever reads its weights, the same to the last bit with every SQLite, whose sums of floating-point numbers differ
-- from version to version.
-- Cost: 100 bytes for each design and window.

CREATE TEMP TABLE limit_share_before AS SELECT * FROM limit_share;
DROP VIEW limit_share;
CREATE TABLE limit_share (
    design              TEXT NOT NULL,
    pmv_limit           REAL NOT NULL,
    pmv_min             REAL NOT NULL,
    pmv_max             REAL NOT NULL,
    solved_count        INTEGER NOT NULL,
    lower_count         INTEGER NOT NULL,
    upper_count         INTEGER NOT NULL,
    heating_count       INTEGER NOT NULL,
    cooling_count       INTEGER NOT NULL,
    lower_weight        REAL NOT NULL,
    cooling_weight      REAL NOT NULL,
    outside_range_count INTEGER NOT NULL,
    run_id              INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;
INSERT INTO limit_share SELECT *, coalesce((SELECT max(run_id) FROM run), 0) FROM limit_share_before;
DROP TABLE limit_share_before;
