### What is in a recording, and what it lacks.

## Kinds of recordings

recording-pcap = packets of LiDARs (pcap)
recording-lvx = packets of Livox LiDARs (LVX)
recording-bag1 = rosbag1
recording-bag2 = rosbag2
recording-frames = frames ({ $formats })
recording-imu_csv = IMU samples (CSV)
recording-gnss_file = GNSS positions (CSV, RTKLIB, SBET, UBX, NovAtel, NMEA)
recording-poses = poses (TUM or KITTI)
recording-carmen = CARMEN log of a 2-D laser
recording-line_tables = line scans (CSV or NPZ)
recording-laser_table = scans of a 2-D laser (CSV or NPZ)
recording-mandeye = walk of a MANDEYE device (LAZ and CSV)
recording-lidar_file = description of a LiDAR (JSON, CSV, YAML, XML or DAT)
recording-scans = capture of scans (pcap)

## What sensors send

content-clouds = clouds
content-packet-scans = scans of packets
content-packets = packets
content-packets-mode = packets ({ WORDS($mode, of: "return") } return)
word-return-dual = dual
word-return-first = first
word-return-last = last
word-return-single = single
word-return-strongest = strongest
word-return-triple = triple
content-line-scans = line scans
content-scans = scans
content-layout = scans of { $most } beams over { DEGREES($field_rad, digits: 0) }
content-layout-varies = scans of { $fewest } to { $most } beams over { DEGREES($field_rad, digits: 0) }
content-files = { $kind } files
content-files-timed = { $kind } files, times from { $times }
content-points = points in { $files } files{ $lidars ->
    [one] {""}
   *[other] {" "}of all LiDARs
 }
content-transforms = transforms
content-description = description of the robot
content-angles = angles
remark-ranges = ranges up to { DECIMAL($farthest_m, digits: 2) } m, { PERCENT($returns, digits: 0) } of the beams return
remark-lines = { DECIMAL($shots, digits: 0) } shots a line, { PERCENT($returns, digits: 0) } of them return
remark-head = head from { DEGREES($low, digits: 0) } to { DEGREES($high, digits: 0) }, { DECIMAL($shots, digits: 0) } shots a line, { PERCENT($returns, digits: 0) } of them return
unread-packets = { $packets } packets from { $source } to port { $port } ({ $why })
refused-sizes = of { $sizes } bytes{ $more ->
    [yes] {" "}and others
   *[no] {""}
 }: not those of a known LiDAR
refused-model = { $name }, whose packets are not decoded
refused-airy = an Airy of variant { $variant } (48 or 192 lines), whose packets are not decoded
refused-count = { $number } of { $total } data packets: { $what }

## A recording in lines: what begins each, and its words

info-label-time = time
info-label-walk = walk
info-label-lidar = lidar
info-label-fields = fields
info-label-remark = remark
info-label-samples = samples
info-label-unread = not read
info-label-gap = gap
info-label-derived = derived
info-label-missing = missing
info-label-lost = lost
info-label-repaired = repaired
info-label-warning = warning
info-head = { $path }: { $kind }, { DECIMAL($megabytes, digits: 1) } MB
info-start = { $start } UTC
info-no-times = no absolute times
info-time = { $start }, { $estimated ->
    [yes] about{" "}
   *[no] {""}
 }{ DECIMAL($seconds, digits: 2) } s
info-time-back = { $start }, { $estimated ->
    [yes] about{" "}
   *[no] {""}
 }{ DECIMAL($seconds, digits: 2) } s, in reversed order: its times run backward
info-sensor = { $label } { $model }: { $estimated ->
    [yes] about{" "}
   *[no] {""}
 }{ $count } { $content }{ RATE($rate_hz) }{ TURNS($turns_hz) }
info-gap = { $sensor }: { DECIMAL($seconds, digits: 3) } s at { DECIMAL($since_s, digits: 2) } s
info-gap-back = { $sensor }: the clock goes back by { DECIMAL($seconds, digits: 3) } s at { DECIMAL($since_s, digits: 2) } s
info-gaps = … { $count } in all
word-turns = , { DECIMAL($hz, digits: 2) } revolutions a second

## Samples

samples-imu = { $count } IMU samples{ RATE($rate_hz) }
samples-gnss = { $count } GNSS positions ({ $format }){ RATE($rate_hz) }
samples-gnss-undated = { $count } GNSS positions ({ $format }), without a date{ RATE($rate_hz) }
samples-gnss-weekless = { $count } GNSS positions ({ $format }), without a GPS week{ RATE($rate_hz) }
samples-tum = { $count } poses (TUM){ RATE($rate_hz) }
samples-kitti = poses (KITTI)
samples-robot = poses by the robot's odometry
samples-in-packets = IMU in the packets of the LiDAR
samples-beside-lines = { $file }: { $count } IMU samples
samples-imu-files = IMU samples in { $files } files imu*.csv
samples-gnss-files = GNSS positions in { $files } files
samples-sender = { $sender }: { $count } { WORDS($what, of: "sender") }
samples-topic = { $topic }: { WORDS($what, of: "topic") }, { $messages }{ RATE($rate_hz) }
samples-topic-unread = { $topic }: { $type }, not read, { $messages }{ RATE($rate_hz) }
word-sender-samples = other packets of a LiDAR
word-sender-imu = IMU samples
word-sender-gnss = GNSS samples
word-topic-imu = IMU
word-topic-gnss = GNSS positions
word-topic-odometry = poses (kept for comparison)
word-topic-transforms = transforms between frames
word-topic-packets = other packets of a LiDAR
word-topic-describes = describes a LiDAR
word-rate = , { DECIMAL($hz, digits: 1) } a second

## What is missing

missing-odometry = odometry
missing-times = times of the poses
missing-field = field: { WORDS($field, of: "field") }
missing-imu = IMU (an IMU file can be given beside it)
missing-imu-given = IMU ({ $file } beside it has them: page: IMU and GNSS files; command: --imu FILE)
missing-imu-more = samples of { $file } beside it (page: IMU and GNSS files; command: --imu FILE)
missing-gnss = GNSS positions
missing-gnss-given = GNSS positions ({ $file } beside it has them: page: IMU and GNSS files; command: --gnss FILE)
missing-gnss-more = positions of { $file } beside it (page: IMU and GNSS files; command: --gnss FILE)
missing-rig = rig: { $error }
missing-contents = { $error }
missing-laser-table = 2-D laser (laser2d.csv or laser2d.npz)
missing-imu-table = IMU (imu.csv)
missing-head-column = angles of the head (column head_deg; or head_rate_deg_s in the rig file)
missing-profiler-rig = rig: one with a sensor of kind profiler (page: field Rig; command: --rig)
missing-topic = { WORDS($kind, of: "sensor-kind") } ({ $topic })
missing-head-topic = angles of the head ({ $topic }, { $type })
word-field-intensity = intensity
word-field-ring = ring
word-field-time = time per point
word-sensor-kind-profiler = profiler
word-sensor-kind-laser2d = 2-D laser

## What is no recording

no-path = { $path } does not exist
no-file = cannot read { $path }: there is no such file or folder
path-unreadable = { $path } cannot be read: { $reason }
file-empty = { $name }: the file is empty (0 bytes)
folder-empty = { $name }: the folder is empty
recording-not-given = no recording given
recording-is-mesh = { $name }: a mesh: a finished model, not a recording; { $known }
recording-is-part = { $name }: a part of a walk of a MANDEYE device: give its folder
recording-unrecognized = { $name }: no reader recognizes it ({ $looks }); { $known }
recording-of-kinds = { $name }: holds recordings of { $number } kinds: { $held }; give one
recording-of-several = { $name }: holds { $number } recordings: { $held }; give one
recording-none-inside = { $name }: no recording in this folder; it has { $held }; { $remedy }
recording-unpack = unpack its { $number } compressed files first
recording-no-sensor = { $name }: { $kind }: no reader knows the sensor that made it
recording-planar-alone = { $name }: { $kind }: it has no points of a LiDAR; process it alone
recording-without-points = { $name }: { $kind } alone is no recording: it has no points
recording-one-kind = recordings of one kind expected, got { $held }
recordings-known = known: { recording-pcap }, { recording-lvx }, { recording-bag1 }, { recording-bag2 }, { recording-frames }, { recording-imu_csv }, { recording-gnss_file }, { recording-poses }, { recording-carmen }, { recording-line_tables }, { recording-laser_table }, { recording-mandeye }, { recording-lidar_file }
held-one = { $file } ({ $kind })
held-more = { $first }, { $next }
looks-unknown = first bytes { $bytes }
looks-like = looks like { WORDS($what, of: "looks") }
word-looks-ptx = PTX scans: finished scans, not a recording
word-looks-jpeg = a JPEG image
word-looks-png = a PNG image
word-looks-zip = a zip archive: unpack it first
word-looks-gzip = gzip compressed: unpack it first
word-looks-xz = xz compressed: unpack it first
word-looks-zstd = zstd compressed: unpack it first
word-looks-bzip2 = bzip2 compressed: unpack it first
word-looks-7z = a 7z archive: unpack it first
word-looks-pdf = a PDF document
word-looks-las = a LAS/LAZ point cloud: a finished map, not a recording
word-looks-e57 = an E57 point cloud: a finished scan, not a recording
word-looks-elf = a program
word-looks-pcap = a capture of a patched libpcap: convert it first (editcap -F pcapng)
word-looks-snoop = a capture of snoop: convert it first (editcap -F pcapng)

## What is known of a count besides

detail-first = first: { $problem }
detail-of-files = of { $names }
detail-cut = to { $sizes } bytes
detail-cut-ports = to { $sizes } bytes, { $ports }
detail-port = to port { $ports }
detail-ports = to ports { $ports }
detail-protocols = { WORDS($names, of: "protocol") }
word-protocol-no-ipv4-header = no whole IPv4 header
word-protocol-link-type = another link type
detail-one-time = { $sensor }: all points of a cloud have one time: spread in their order
detail-times = { $sensor }, { $field }: { $why }
times-all-one = all points of a revolution have the time { $time }
times-within = the points of a revolution are within { $span_ms } ms
times-no-unit = from first to last point { $span }, no revolution in any unit
times-none = { $time } is no time in any unit
times-far = { $damaged } of { $total } points of a cloud are more than two revolutions from the others
times-coarse = steps of { $step_ms } ms are too coarse
times-missing = { $missing } of { $total } points of a cloud have no number
extent-map = { $axes }: coordinates of a map or of the earth, not a scan with the sensor at the origin. A finished map is no recording; give it as a reference
extent-unit = { $axes }: half of them are farther than { DECIMAL($usual_m, digits: 0) } m. If they are in millimeters, give ingest.points_unit_m=0.001; a map whose origin is no sensor is no recording
extent-range = { $axes }: half of them are farther than { DECIMAL($usual_m, digits: 0) } m. If the sensor measures that far, give a larger ingest.max_range_m

## Damaged bags

db3-rows-order = row { $row } comes after row { $before }
db3-cut-off = { $name }: cut off, not one message is left
db3-damaged = { $name }: damaged ({ $damage }), not one message is left
db3-too-short = { $name }: expected an SQLite database of at least one page of { $page } bytes, got { $size } bytes that start with { $bytes }; not one message is left
