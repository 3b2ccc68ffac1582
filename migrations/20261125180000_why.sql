-- What a study said when a stage was last done.
--
-- Serves: `status --why`, which names the setting that has changed.
-- Cost: a hundred short rows.

CREATE TABLE stage_setting (
    stage TEXT NOT NULL,  -- ingest, shade, solve, simulate
    name  TEXT NOT NULL,  -- as in the study file
    value TEXT NOT NULL,
    PRIMARY KEY (stage, name)
) STRICT, WITHOUT ROWID;
