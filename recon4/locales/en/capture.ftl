### Warnings for the operator of a live capture.

nothing-recorded = Nothing is recorded: { $problem }
disk-full = Disk full in { $minutes } min
mark-unsaved = A mark could not be saved: { $problem }
paused = Paused: nothing is recorded
none-sends = No { $what } of the rig sends: { $arrives }
none-sends-anything = No { $what } sends anything for { $time }: check power and cables, and that it sends to { $ports } of this computer
ports = port { $ports }
what-lidar = LiDAR
what-scanner = scanner
sensor-silent = { $sensor } silent for { $time }
sensor-silent-shared = { $sensor } silent at port { $own } for { $time }, but { $sources } send to port { $port }: give each LiDAR the port that the rig states, or correct the rig
sensor-elsewhere = { $sensor } sends from { $source }, not { $address }. It is used; correct the rig
title-laser2d = 2-D laser
title-profiler = Profiler
title-lidar = { $name } LiDAR
datagrams-elsewhere = { $sensor } is expected from { $address }, but datagrams for port { $port } come from { $sources }: correct the address in the rig or in the sender
packets-elsewhere = { $sensor } is expected from { $address }, but data packets for port { $port } come from { $sources }: correct the address in the rig or in the sensor
no-data-packets = datagrams for port { $port } ({ $sensor }) come from { $sources }, but they are not LiDAR data packets
imu-silent = IMU silent for { $time }: turn slowly
imu-none = No IMU: walk and turn slowly
gnss-receiver = GNSS receiver: { $problem }
foreign-traffic = Foreign traffic on port { $port } from { $sources }
packets-not-lidar = Packets on port { $port } that are not LiDAR data packets, from { $source }
packets-not-recorded = { $count ->
        [one] One packet is not in the recording
       *[other] { $count } packets are not in the recording
    }: the disk was full or too slow
tracking-lost = Tracking lost: stop, then go back a few steps
turn-slower = Turn slower
tracking-degraded = Tracking is degraded: walk slower, look at more walls
packets-lost = { $count ->
        [one] One packet was lost
       *[other] { $count } packets were lost
    }: this computer is too busy
packets-lost-late = { $count ->
        [one] One packet was lost
       *[other] { $count } packets were lost
    }: this computer is too busy; { $late }
preview-late = { $late }; the recording is complete
preview-behind = The preview is { DECIMAL($seconds, digits: 0) } s behind
frames-left-out = { $thinned } of the last { $frames } frames are left out of the preview ({ $all } in all)
gnss-jumped = GNSS jumped by { DECIMAL($m, digits: 0) } m: the map does not use it
gnss-none = GNSS has no position
gnss-no-rtk = GNSS without RTK fix
gnss-no-rtk-within = GNSS without RTK fix, ±{ SIGNIFICANT($m, digits: 2) } m
seconds = { DECIMAL($value, digits: 0) } s
minutes = { DECIMAL($value, digits: 0) } min
so-far-check = Map so far: check. { $text }
so-far-do-not-use = Map so far: do not use. { $text }
battery = The computer's battery has { PERCENT($charge, digits: 0) } left
battery-minutes = The computer's battery has { PERCENT($charge, digits: 0) }, { DECIMAL($minutes, digits: 0) } min left
unobserved-along = Nothing holds the map along this corridor: look at a corner or an open door
unobserved-across = Nothing holds the map across your way: keep near a wall
scans-unreadable = Nothing of what the 2-D laser sends can be read: { $damaged } datagrams
scans-damaged = { $damaged ->
    [one] { $damaged } datagram with scans cannot be read
   *[other] { $damaged } datagrams with scans cannot be read
 }
lines-damaged = { $damaged } datagrams with line scans cannot be read
laser-blind = The 2-D laser sees nothing: is it covered, or is everything beyond its range?
head-angles-missing = The angles of the profiler's head are missing: its lines cannot be placed

## Remarks of the mapper

remark-not-upright = The IMU does not measure gravity upward and is not used: is it mounted as in the rig file (upside down?)
remark-no-forces = The IMU has no accelerometer and is not used
remark-no-accelerometer = The IMU has no accelerometer ({ $why })
remark-gyroscope-bias = The gyroscope has a bias at rest, which is subtracted
remark-accelerometer-contradicts = The accelerometer contradicts the LiDARs and is not used: is its unit m/s²?
remark-no-gyroscope = The IMU contradicts the LiDARs and is not used: its gyroscope does not measure ({ $why })
remark-imu-contradicts = The IMU contradicts the LiDARs and is not used: is it mounted as in the rig file (upside down?), its clock the same?
remark-restarted = The local map started again: go back to a place seen before, until the loop closes
why-absent = it has no values, or is declared as not measured
why-zero = all its values are 0
why-constant = its values never change
