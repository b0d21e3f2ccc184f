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
missing-gnss = GNSS positions
missing-gnss-given = GNSS positions ({ $file } beside it has them: page: IMU and GNSS files; command: --gnss FILE)
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
