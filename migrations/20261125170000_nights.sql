-- What a night's job came to, for whoever watches over it.
--
-- Serves: `status`, metrics and mails: why a run failed, and what each of its stages did and took.
-- Cost: five short rows a run.

ALTER TABLE run ADD COLUMN reason TEXT;  -- why it failed

CREATE TABLE run_stage (
    run_id          INTEGER NOT NULL REFERENCES run ON DELETE CASCADE,
    position        INTEGER NOT NULL,    -- order of the stages
    stage           TEXT NOT NULL,       -- ingest, shade, solve, simulate, report
    computed_count  INTEGER NOT NULL,    -- missions read, samples new or changed, points, simulations, files written
    withdrawn_count INTEGER NOT NULL,    -- missions, samples or simulations that are no longer valid
    total_count     INTEGER NOT NULL,    -- of all that the stage keeps
    duration_s      REAL NOT NULL,
    PRIMARY KEY (run_id, position)
) STRICT, WITHOUT ROWID;
