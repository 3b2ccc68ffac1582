-- What a study says, value by value, and the text of its file.
--
-- Serves: analysts who ask what differs from the paper, and what results of two databases rest on.
-- Cost: some hundred and fifty short rows, and a text for each study file that was run.

-- As of the last time that the stage was done which is the first to use it.
CREATE TABLE study_setting (
    stage                TEXT NOT NULL,
    position             INTEGER NOT NULL,  -- by section and key
    name                 TEXT NOT NULL,     -- section, a dot, key
    value                TEXT NOT NULL,
    unit                 TEXT NOT NULL,     -- empty for what has none
    default_value        TEXT,              -- null where a study file has to say it, and for what the default study has not
    source               TEXT NOT NULL,
    differs_from_default INTEGER NOT NULL CHECK (differs_from_default IN (0, 1)),
    PRIMARY KEY (stage, position)
) STRICT, WITHOUT ROWID;

CREATE VIEW setting AS
SELECT name, value, unit, default_value, source, differs_from_default, stage
FROM study_setting
ORDER BY differs_from_default DESC, position;

CREATE TABLE study_text (
    study_hash TEXT PRIMARY KEY,  -- as in run
    text       TEXT NOT NULL      -- of the study file when it was last run with this hash
) STRICT, WITHOUT ROWID;
