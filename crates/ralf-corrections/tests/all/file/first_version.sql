-- The tables of the first version of a store, and what somebody did in it.
CREATE TABLE scan (
  id INTEGER PRIMARY KEY,
  sequence TEXT NOT NULL,
  radar TEXT NOT NULL,
  scan INTEGER NOT NULL,
  detections INTEGER NOT NULL,
  revision INTEGER NOT NULL DEFAULT 0,
  UNIQUE (sequence, radar, scan)
) STRICT;
CREATE TABLE event (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  at TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  kind TEXT NOT NULL,
  sequence TEXT NOT NULL,
  author TEXT NOT NULL,
  tab TEXT
) STRICT;
CREATE TABLE event_scan (
  event INTEGER NOT NULL REFERENCES event,
  scan INTEGER NOT NULL REFERENCES scan,
  revision INTEGER NOT NULL,
  PRIMARY KEY (scan, event)
) STRICT, WITHOUT ROWID;
CREATE INDEX event_scan_by_event ON event_scan (event);
CREATE TABLE stroke (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  made INTEGER NOT NULL REFERENCES event,
  sequence TEXT NOT NULL,
  author TEXT NOT NULL,
  tool TEXT NOT NULL,
  step TEXT,
  label INTEGER,
  applied INTEGER REFERENCES event,
  undone INTEGER REFERENCES event
) STRICT;
CREATE INDEX stroke_applied ON stroke (sequence, author, applied, id);
CREATE INDEX stroke_undone ON stroke (sequence, author, undone, id);
CREATE TABLE change (
  stroke INTEGER NOT NULL REFERENCES stroke,
  scan INTEGER NOT NULL REFERENCES scan,
  point INTEGER NOT NULL,
  before INTEGER,
  after INTEGER,
  PRIMARY KEY (stroke, scan, point)
) STRICT, WITHOUT ROWID;
CREATE INDEX change_by_point ON change (scan, point, stroke);
CREATE TABLE correction (
  scan INTEGER NOT NULL REFERENCES scan,
  point INTEGER NOT NULL,
  label INTEGER NOT NULL,
  PRIMARY KEY (scan, point)
) STRICT, WITHOUT ROWID;
CREATE TABLE review (
  scan INTEGER PRIMARY KEY REFERENCES scan,
  event INTEGER NOT NULL REFERENCES event,
  accepted BLOB NOT NULL
) STRICT;

PRAGMA application_id = 1380011078;
PRAGMA user_version = 1;
INSERT INTO scan (id, sequence, radar, scan, detections, revision) VALUES (1, '00', 'front', 3, 10, 3), (2, '00', 'front', 4, 10, 0);
INSERT INTO event (id, at, kind, sequence, author, tab) VALUES
  (1, '2026-01-31T12:00:00.000Z', 'stroke', '00', 'ada', 'tab'),
  (2, '2026-01-31T12:00:01.000Z', 'stroke', '00', 'ada', 'tab'),
  (3, '2026-01-31T12:00:02.000Z', 'undo', '00', 'ada', 'tab'),
  (4, '2026-01-31T12:00:03.000Z', 'reviewed', '00', 'ada', 'tab');
INSERT INTO event_scan (event, scan, revision) VALUES (1, 1, 1), (2, 1, 2), (3, 1, 3), (4, 2, 0);
INSERT INTO stroke (id, made, sequence, author, tool, step, label, applied, undone) VALUES
  (1, 1, '00', 'ada', 'lasso', NULL, 99, 1, NULL), (2, 2, '00', 'ada', 'box', NULL, 1, NULL, 3);
INSERT INTO change (stroke, scan, point, before, after) VALUES (1, 1, 1, NULL, 99), (1, 1, 2, NULL, 99), (2, 1, 5, NULL, 1);
INSERT INTO correction (scan, point, label) VALUES (1, 1, 99), (1, 2, 99);
INSERT INTO review (scan, event, accepted) VALUES (2, 4, x'6300630063006300630063006300630063006300');
