### What is wrong with files, settings and projects: each text has a code, which is stable.

## Text and JSON files

file-not-regular = { $file }: expected a regular file, got a folder, pipe or device
file-grew = { $file }: expected at most { $limit } bytes, got more
file-large = { $file }: expected at most { $limit } bytes, got { $size }
text-nul-at = { $file }: line { $line }: expected text, got a NUL byte at offset { $offset }
text-not-utf8-at = { $file }: line { $line }: expected UTF-8 text, got byte 0x{ $byte } at offset { $offset }
text-line-long = { $file }: line { $line }: expected at most { $limit } bytes, got a longer line
json-invalid = { $file }: expected JSON, got something else: { $why }
not-finite = expected a finite number, got { $got }
json-deep = { $file }: expected JSON of at most { $limit } levels, got more
json-surrogate = { $file }: expected Unicode text, got a lone surrogate: { $why }
text-not-utf8-behind = { $file }: behind line { $line }: expected UTF-8 text, got something else
text-nul = { $file }: line { $line }: expected text, got a NUL byte
text-not-utf8 = { $file }: line { $line }: expected UTF-8 text, got byte 0x{ $byte } in column { $column }
text-utf16 = { $file }: expected UTF-8 text, got UTF-16; save it as UTF-8

## Settings

where-why = { $where }: { $why }
and-further = { $first }; { $further }
setting-form = expected group.field=value, got { $got }
setting-group-unknown = no setting group { $group }; known: { $known }
setting-renamed = the setting { $setting } is now called { $name }
setting-retired = { $setting } is no setting anymore: fixed at { $value }, not { $given } ({ $what })
setting-unknown = no setting { $setting }; known in { $group }: { $known }
setting-choice = { $setting } must be one of { $choices }, got { $got }
setting-true-false = { $setting } must be true or false, got { $got }
setting-type = { $setting } must be { $type }, got { $got }
preset-unknown = no preset named { $name }; there are: { $known }
setting-range = { $setting } must be { $low } to { $high }, got { $got }
setting-geoid = heights = orthometric needs geoid_separation_m, and only it has one, got { $got }
setting-rate = rate_hz must be 0 or at least 0.5, got { $got }
setting-ranges = min_range_m must be below max_range_m, got { $got }
setting-surface = surface must be raw or fitted, got { $got }
setting-tile = tile_m must be at least four cells or voxels, got { $got }
setting-far-ratio = far_ratio must be 0 or above 1, got { $got }
setting-solver = solver must be planes, common_normal or svd (single scans are registered only inside odometry without an IMU, by solver planes), got { $got }

## Tables of TOML files

table-expected = { $where }: expected a table, got { $got }
table-unknown = { $where }: unknown { $unknown }; known: { $known }
table-number = { $where }: { $key } must be a finite number, got { $got } (at most 4e9)
table-numbers = { $where }: { $key } must be { $size } finite numbers, got { $got } (at most 4e9)
table-place = { $where }: { $key } must be within { $limit_m } m of the origin of the body, got { $got }: give meters, not millimeters
table-degrees = { $where }: { $key } must be in degrees, got { $got }: in radians these were { $degrees }
table-text = { $where }: { $key } must be a text of at most { $limit } characters, got { $got }
table-true-false = { $where }: { $key } must be true or false, got { $got }
table-port = { $where }: port must be 0 to 65535, got { $got }
toml-large = { $where }: expected at most { $limit } characters, got { $got }
toml-dots = { $where }: expected keys of few parts, got one with { $got } dots
toml-invalid = { $where }: not a TOML file: { $why }
toml-deep = { $where }: not a TOML file: nested too deeply

## Rig files

rig-no-such = no rig named { $name }; shipped: { $shipped }; or give the path of a .toml file
rig-unreadable = cannot read rig file { $why }
rig-sensors = { $where }: a rig needs at least one [[sensor]] and at most { $limit }, got { $got }
rig-names-same = { $where }: sensor names must differ, got { $got }
rig-imu-sensor = { $where }: sensor must be one of { $names }, got { $got }
rig-date = { $where }: date must be as 2026-11-22, got { $got }
rig-model = { $where }: model must be one of { $models } for a { $kind }, got { $got }
rig-head = { $where }: only a profiler has a head, this is a { $kind }
rig-lidar-only = { $where }: only a lidar has { $what }, this is a { $kind }
rig-name = { $where }: name must be a text, got { $got }
rig-kind = { $where }: kind must be one of { $kinds }, got { $got }
rig-within = { $where }: { $key } must be within ±{ $limit }, got { $got }
rig-quaternion = { $where }: quat_xyzw must have length 1, got { $got }
rig-needs-name = the rig needs a name
rig-name-taken = { $sensor }: another sensor has this name
rig-sensor-number = sensor { $number }
rig-sensor-needs-name = { $sensor }: each sensor needs a name
rig-imu-holder = must be the name of a LiDAR ({ $names }) or empty
rig-antenna = GNSS antenna
rig-model-of = { $sensor }: expected { $expected }, got { QUOTED($got) }
rig-profiler-head = { $sensor }: only a profiler has a head
rig-at-most = { $sensor }: expected at most { $limit }
rig-lidar-clock = { $sensor }: only a lidar has a rate of its clock
rig-lidar-beams = { $sensor }: only a lidar has corrections of beams
rig-lidar-columns = { $sensor }: only a lidar has columns of points
rig-address = { $sensor }: expected an address like 192.168.1.201, got { QUOTED($got) }
rig-angles = { $sensor }: expected angles within ±{ $limit_deg }°, got { $got }
rig-position = { $sensor }: expected a position within ±{ $limit_m } m, got { $got }
rig-port = { $sensor }: port must be 0 to { $limit }, got { $got }
rig-port-shared = { $names } all send to port { $port }: a live capture needs an address for each, or a port of its own
rig-all-disabled = no sensor is enabled: there is nothing to map
rig-same-pose = two sensors have the same pose
beams-none = { $where }: expected some of { $known }, got none
beams-number = { $where }: expected 1 to { $limit } beams in { $key }, got { $got }
beams-within = { $where }: { $key } must be within ±{ $limit }, got { $got } of beam { $beam }
recipe-form = { $where }: expected ROLE=COLUMN with a role of { $roles }, got { $got }
recipe-twice = { $where }: { $role } is given twice
recipe-two-roles = { $where }: the column { $column } has two roles
recipe-one-column = { $where }: { $role } must be one column (times may be a sum of up to { $limit } columns that have units, as sec:s+nsec:ns), got { $got }
recipe-column = { $where } must be COLUMN or COLUMN:UNIT, got { $got }
recipe-negative = { $where } cannot be negative, got { $got }
recipe-places = { $where }: expected the columns of one of these lists: { $wanted }; got { $got }
recipe-unit = { $where }: expected one of { $units }, or a number of { $base }, got { $got }
recipe-no-unit = { $where }: expected no unit, got { $got }
serial-form = gnss: serial: expected DEVICE:BAUD with a serial device, for example /dev/ttyUSB0:115200 or /dev/serial/by-id/NAME:115200 (a link of your own begins with /dev/gps or /dev/gnss), got { $got }

## Approvals

approved-not-issued = { $file } was not issued with version { $version }
approved-unreadable = { $file } cannot be read: { $why }
approved-refused = { $what }: { $why }
approved-not-this = this is not what { $who } approved as version { $version }
approved-no-row = versions/{ $folder } is in no row of the journal: the row was removed, the journal is an older one, or the approval was interrupted; approve the map again
approved-named-no-row = summary.json names an approval that is in no row of the journal: put the journal back, or approve the map again
approved-statement-unreadable = versions/{ $folder }/approval.json cannot be read: { $why }
approved-other-statement = the statement is not the one in the journal
approved-signature-invalid = the signature is not valid
approved-other-key = it names the key { $named }, its signature is by { $key }
approved-other-journal = it was signed over another journal
approved-row-differs = version, artifacts or signer in the journal are not those that were signed
approved-journal-altered = the journal was altered: { $what }
approved-not-counted = version { $version } is not counted: { $why }
approved-not-valid = the approval of version { $version } is not valid: { $why }
approved-no-hash = the journal has an approval without version and hash
approved-gone = the approval is gone
approved-no-artifact = version { $version } has no artifact of the stage { $stage }
approved-older = this project is older than what this server approved (version { $version } of { $time }Z): an earlier state, or another project, was put in its place; put the newer one back, approve the map again, or take it as it is with the command recon4 verify PROJECT --accept
approved-list-damaged = { $folder }/{ $file } in the server's own files is damaged ({ $why }): compare the project with a backup, then take it as it is with the command recon4 verify PROJECT --accept
signer-removed = the signature is by the key { $key } ({ $name }), which { $who } removed from the trusted keys on { $date }

## Projects

seal-unreadable = { $file } cannot be read: { $why }
seal-hash = its own hash does not fit
seal-written = it is not as it was written
seal-altered = { $file } is not what was written: { $why }
seal-entry = { $file }: the entry { $name } makes no sense: { $why }
seal-no-manifest = { $file } is not a manifest: { $why }
seal-not-in-manifest = { $file } is not in the manifest
seal-missing = { $file } is missing
seal-surplus = { $file } does not belong here
seal-differs = { $file }: expected { $expected }, got { $got }
seal-block-differs = { $file }, bytes { $start } to { $stop }: expected { $expected }, got { $got }
file-size = { $file }: expected { $expected } bytes, got { $got } bytes
lock-failed = cannot lock { $folder }: { $why }
project-file-unreadable = { $file } cannot be read: { $why }
project-missing = { $folder } does not exist
project-none = { $folder } is not a recon4 project: it has no project.json
project-format = { $file }: expected format { $format }
project-no-artifact = there is no artifact of the stage { $stage }: it was freed, or has not run yet. Process the recording again
project-unusable = cannot use { $folder } as a project: { $why }
project-not-empty = { $folder } is not empty and not a recon4 project (it contains { $what }); give a new folder
project-in-use = { $folder } is in use by another recon4 process
ledger-cut = { $file } is cut: expected a page or more, got { $size } bytes
ledger-version = { $file } has version { $version }, this recon4 reads version { $known }
ledger-damaged = { $file } is damaged or cannot be used ({ $why }); move it away and start again: finished stages are found by their artifacts

## Live capture

gnss-port = gnss: serial needs a port, to which its sentences are recorded
capture-port-shared = rig { $rig }: { $names } all send to port { $port }: give each its address = "…" in the rig file, or a port of its own
capture-kinds = rig { $rig }: live capture maps LiDARs, or one 2-D laser with or without one profiler; got { $names }: record their topics in a bag and process that
capture-address = { $sensor }: address must be like 192.168.1.201, got { $got }
capture-port-taken = UDP port { $port } ({ $expected }) cannot be opened on { $address }: { $why }{ $hint }
hint-port-in-use = ; is another recorder or VeloView running?
hint-port-low = ; ports below 1024 need administrator rights: send to other ports
hint-no-address = ; no network card of this computer has that address now
serial-failed = gnss: serial: { $path }: { $why }
serial-no-device = gnss: serial: { $path } is no device: expected a serial line
serial-console = gnss: serial: { $path } is a console of this computer: it is not opened; take the console away from it (kernel parameter console=), or use another line

## Journal

journal-row-damaged = row { $row } of the journal is damaged: { $why }
journal-damaged = { $file } is damaged or cannot be used: { $why }

## Bags and folders

topic-unread = { $topic } is of a LiDAR, but { $type } is not read: play the bag back through the driver (compressed clouds: point_cloud_transport) and record the PointCloud2 that it publishes
topics-read = read are { $kinds }
topics-other-clouds = the clouds are of a depth camera or a map (one is read with lidar_topic of ingest; page: All settings; command: --set ingest.lidar_topic=TOPIC)
bag-no-lidar = { $file }: no LiDAR data; topics: { $topics }; { $why }
columns-needed = { $name } has lists of { $columns }: it is read as points of a LiDAR if they are named x, y, z, and a time, ring or intensity, or if a rig file says which columns they are: fields = { $fields } (or range, azimuth, elevation) in its [[sensor]]
cloud-unknown = { $file }: expected a file of one of these formats: { $formats }
recordings-of-times = { $number } recordings of different times, more than { $hours } hours apart: { $walks }; give those of one walk
name-long = { NAMED($what, of: "word-what") } has at most { $most } characters, got { $got }
name-invisible = { NAMED($what, of: "word-what") } may not have invisible characters, got { $character } at place { $place }
word-what-a-name = a name
word-what-a-note = a note
word-what-the-id-of-a-point = the id of a point
word-what-the-name-of-a-file = the name of a file
word-what-why = why
