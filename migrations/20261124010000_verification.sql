-- What `verify` has found.
--
-- Serves: whoever asks whether a database was ever checked against the other method, and how far off its rows were.
-- Cost: a dozen rows a verification.

CREATE TABLE verification (
    verification_id INTEGER PRIMARY KEY,
    finished_utc    TEXT NOT NULL,
    program_version TEXT NOT NULL,
    study_hash      TEXT NOT NULL,
    fraction        REAL NOT NULL,        -- share of the stored points that was solved again
    seed            INTEGER NOT NULL,
    point_count     INTEGER NOT NULL,     -- points that were solved again
    violation_count INTEGER NOT NULL
) STRICT;

CREATE TABLE verification_check (
    verification_id INTEGER NOT NULL REFERENCES verification ON DELETE CASCADE,
    position        INTEGER NOT NULL,
    name            TEXT NOT NULL,
    checked_count   INTEGER NOT NULL,
    violation_count INTEGER NOT NULL,
    largest         REAL NOT NULL,        -- largest deviation that was seen
    unit            TEXT NOT NULL,
    tolerance       TEXT NOT NULL,
    first_violation TEXT,                 -- where, and what is wrong
    PRIMARY KEY (verification_id, position)
) STRICT, WITHOUT ROWID;
