### What readers of recordings derived or chose, because the recording does not say it.
### docs/how-to/languages.md says how texts are written and translated.

## The whole recording

DEVICE =
    .text1 = Recorded by { $device }.

DEVICE-CLOCKS =
    .text1 = The device states that its LiDARs had no common source of time.

FILE-COPY =
    .text1 = { $name } has the same bytes as { $original }: left out.

FILE-PASSED-OVER =
    .text1 = { $name } is a mesh, not a recording: passed over.

FILE-UNNUMBERED =
    .text1 = { $name } has no number as the other { $files } files have: it is taken for a map, not for a scan, and left out.

FILES-AS-ONE =
    .text1 = { $folder }: no { $name }: all files in it are one recording.

FOLDERS-PASSED-OVER =
    .text1 = Recordings in subfolders are not read: { $folders }.

POSES-KEPT =
    .text1 = Poses of the recording are kept in poses.tum for comparison, not used.

RECORDED-BACKWARD =
    .text1 = Recorded backward: the stamps of all topics fall. Its { $messages } messages are read from the last to the first.

WALK-LIDAR =
    .text1 = LiDAR: frames of points in space, of { $sensors }

WALK-PROFILER =
    .text1 = profiler: every line of { $sensor } lies elsewhere in space, because { WORD($moved_by, of: "WALK-PROFILER") } moves it
    .word-head = its head
    .word-constant-head = a head of constant rate

WALK-PLANAR =
    .text1 = 2-D laser: a plan of what its plane meets, because no LiDAR or profiler is there

## The rig, and what is which sensor

RIG-CHOSEN =
    .text1-if-own_frame = No rig given: one { $model }, its frame is the body's.
    .text2 = No rig given: one { $model }, the body has its origin and the axes of { $axes_of }.
    .text3 = No rig given: { $lidars } LiDARs, the body is the frame { $frame }.
    .text4 = No rig given: { $sensors } match the preset { $preset }, its mounting is used.
    .text5-if-by_topics = No rig given: the topics match the preset { $preset }, its mounting is used.
    .text6-if-line_scans = No rig given: line scans, the mounting of the preset { $preset } is used.
    .text7-if-by_file = No rig given: { $sensors } are mounted as the file says.

SENSOR-TOPIC =
    .text1 = { $sensor } is topic { $topic }: the rig names none.

SENSOR-NUMBER =
    .text1 = { $sensor } is LiDAR { $number }: the rig has no serial number.

SENSOR-LATER =
    .text1 = { $sensor }: sends only later, from { $sender }.

SENSOR-ELSEWHERE =
    .text1 = { $sensor }: taken from { $sender }, the rig expects { $address } to port { $port }.
    .text2-if-anywhere = { $sensor }: taken from { $sender }, the rig expects any address to port { $port }.

MODEL-ALIKE =
    .text1 = { $sensor }: read as a { $model }. Packets of { $alike } have the same form, and nothing in them tells which it is: of one of these the map is wrong.

LASER-BY-SENDER =
    .text1 = The 2-D laser is what sends scans from { $address } to port { $port }.

LASER-OF-MOTION =
    .text1 = { $topic } is the 2-D laser that gives the first motion.

## Topics and columns that are read, and those that are not

TOPIC-SHARED =
    .text1 = { $topic } is of { $lidars } LiDARs: { $sources }.

TOPIC-LEFT-OUT =
    .text1 = { WORD($what, of: "TOPIC-LEFT-OUT") }: { $read } (frame { $frame }) is read, not { $topic }.
    .text2-if-frameless = { WORD($what, of: "TOPIC-LEFT-OUT") }: { $read } is read, not { $topic }.
    .text3-if-unreadable = It has no message in its first minute that can be read.
    .text4 = It covers only { PERCENT($covered, digits: 0) } of the recording.
    .text5-if-no_gyroscope = It has no gyroscope.
    .text6-if-unit_unknown = Its angular rates are not in rad/s.
    .text7-if-no_accelerometer = It has no accelerometer.
    .text8 = Its accelerations are { SIGNIFICANT($usual_m_s2, digits: 2) }, expected about 9.8 m/s².
    .text9 = It has { DECIMAL($rate_hz, digits: 0) } samples a second.
    .text10 = It has no fix in { $without_fix } messages.
    .text11-if-one_position = Its position never changes.
    .text12-if-filtered = By its name it is the output of a filter.
    .text13-if-no_poses = It has no poses that are numbers.
    .text14-if-still = Its poses never change.
    .text15-if-no_returns = It has no returns.
    .text16 = Its view has { DEGREES($view_rad, digits: 0) }.
    .text17-if-elsewhere = By frame and name it is not the IMU of the LiDAR.
    .text18-if-lower_status = Its fixes have a lower status.
    .text19-if-narrower = Its view is narrower.
    .text20-if-as_good = It is as good.
    .text21-if-fewer = It is as good, with fewer messages.
    .text22-if-no_points = It has no points in its first minute.
    .text23-if-camera = It is of a depth camera: a narrow view without rings and times of points.
    .text24 = It is in the fixed frame { $fixed_frame }: points that a program has placed.
    .text25 = It is in the frame of the robot, { $robot_frame }, with less detail than { $better }.
    .text26-if-lesser = It is a copy of { $copy_of } with less in it.
    .text27-if-whole = It is a copy of { $copy_of }.
    .word-odometry = Odometry

TOPIC-OF-DRIVER =
    .text1 = { $topic } is of a LiDAR, but { $type } is not read: play the bag back through the driver (compressed clouds: point_cloud_transport) and record the PointCloud2 that it publishes.

CLOUDS-OF-PACKETS =
    .text1 = Raw packets are read, not { $topics }.

COLUMNS-UNKNOWN =
    .text1 = Not read: { $topic }: { $recipe }.
    .text2 = Not read: { $topic } has lists of { $columns }.
    .text3-if-columns = It is read as points of a LiDAR if they are named x, y, z, and a time, ring or intensity. Else a rig file says which columns they are: fields = {"{"} x = "COLUMN", y = "COLUMN", z = "COLUMN", time = "COLUMN" {"}"} (or range, azimuth, elevation) in its [[sensor]].

COLUMNS-OVERLOOKED =
    .text1 = { $where }: columns look like more than is read: { $columns }.
    .text2 = They are read with { $recipe } in a rig file.

COLUMN-UNCERTAIN =
    .text1-if-doubtful = Uncertain: { $where }: { $role }: { $column } may be something else.
    .text2 = Uncertain: { $where }: { $role }: { $column }, or { $others }.
    .text3 = Uncertain: { $where }: { $role }: the unit of { $column } is { $unit } by its values.
    .text4-if-no_unit = Uncertain: { $where }: { $role }: the unit of { $column } is not known.
    .text5-if-untimed = Uncertain: { $where }: time: no column looks like the time of a point.
    .text6 = Uncertain: { $where }: { $detail }.

## Mounts

MOUNT-STATED =
    .text1 = Mount of the { WORD($what, of: "MOUNT-STATED") } from { $sources }: { $parent } -> { $child } { MOUNT($mount) }.
    .text2-if-placeholder = Mount of the { WORD($what, of: "MOUNT-STATED") } from { $sources }: { $parent } -> { $child } not turned, at one place: a placeholder?
    .text3 = Mount of the { WORD($what, of: "MOUNT-STATED") } from the rig file: { MOUNT($by_rig) }.

MOUNT-UNSTATED =
    .text1 = Mount of the { WORD($what, of: "MOUNT-UNSTATED") }: the transforms of the bag (tf) do not connect { WORD($parent, of: "MOUNT-UNSTATED") } and { WORD($child, of: "MOUNT-UNSTATED") }: it is taken as not turned against the LiDAR.
    .word-no-frame = no frame

MOUNT-PLACEHOLDER =
    .text1 = Mount of { $part } relative to { $other }: { MOUNT($by_rig) } in the rig, { MOUNT($by_bag) } in { $source } of the bag ({ $parent } -> { $child }): a placeholder?

MOUNT-MOVES =
    .text1 = { $sensor }: its mount moves, the rig has that of { $base }.
    .text2 = { $placed }: its mount moves, every point is placed in { $base } by the mount of its time.
    .text3 = { $profiler } is a profiler, not a 2-D laser that maps a plane: its mount moves by { $moved_by }, and every shot is placed by the mount of its time.
    .text4 = { $joints } turns by { DEGREES($turned_rad, digits: 0) } ({ $source }, { $poses } poses in { DECIMAL($seconds, digits: 1) } s).

MOUNT-TURNS-TOGETHER =
    .text1 = { $topic } and { $imu } turn together: the body is what the joint moves.

LASER-MOUNT-UNSTATED =
    .text1 = { $topic }: the transforms of the bag (tf) do not say how its frame { WORD($frame, of: "LASER-MOUNT-UNSTATED") } is mounted on the robot: it is taken as level and upright.
    .text2-if-of_odometry = How the laser is mounted is unknown: the odometry is taken as its own.
    .word-no-name = (no name)

LASER-UPSIDE-DOWN =
    .text1 = The laser is upside down, its scans are turned round.

HEAD-ANGLES =
    .text1 = { $sensor }: the head turns at { DEGREES($rate_rad_s, digits: 2) }/s, as the rig file says.
    .text2 = { $sensor }: the angles of its head are { $topic }.

JOINT-NONE =
    .text1 = { $parent } -> { $child } ({ $source }) is no joint.
    .text2-if-untimed = Its transforms have no times.
    .text3 = It moves by { DECIMAL($travel_m, digits: 1) } m, as a body in the world.
    .text4 = { PERCENT($off_axis, digits: 0) } of its turns are about other axes than its main one.

FRAME-NAMED =
    .text1 = { $topic }: its frame { $frame } is { $name } of the transforms.

FRAME-UNCERTAIN =
    .text1-if-several = { $topic }: which frame of the transforms its frame { $frame } is, is not certain: one of { $names }.
    .text2-if-shared = { $topic }: which frame of the transforms its frame { $frame } is, is not certain: also that of another sensor: { $names }.

FRAME-OF-POINTS =
    .text1-if-placed = { $topic }: the frame of its points is { $frame }: another program has placed them already, expected the points as the sensor measured them.
    .text2-if-on_robot = { $topic }: its points are in the frame of the robot, { $frame }: where the sensor is in it is not known.

TRANSFORM-LEFT-OUT =
    .text1 = { $topic }: transforms are left out: '{ $parent }' -> '{ $child }'.
    .text2 = Expected { WORD($expected, of: "TRANSFORM-LEFT-OUT") }.
    .text3 = Expected at most { SIGNIFICANT($longest_m, digits: 6) } m.
    .text4 = Got { $got }.
    .word-names = two names of frames
    .word-frames = two frames
    .word-numbers = numbers
    .word-quaternion = a quaternion of length 1

TRANSFORMS-CUT =
    .text1 = { $topic }: its first { $messages } messages are read.
    .text2 = { $topic }: its first { $transforms } transforms are read.
    .text3 = { $topic }: expected at most { $pairs } pairs of frames.

DESCRIPTION-UNREAD =
    .text1 = { $topic }: the robot description is not read: { $error }.
    .text2 = { $topic }: joint '{ $joint }': expected a name, an axis and a gear.

## Angles and metadata of LiDARs

ANGLES-FOUND =
    .text1 = { $sensor }: angles of { WORD($of, of: "ANGLES-FOUND") } from { WORD($source, of: "ANGLES-FOUND") }.
    .word-beams = its beams
    .word-mirrors = its mirrors and beams
    .word-lasers = its lasers
    .word-device-packets = its device packets (DIFOP)
    .word-factory = another sensor's factory table

HDL64-CALIBRATION =
    .text1 = { $sensor }: an HDL-64E { $model }, calibration from { WORD($source, of: "HDL64-CALIBRATION") }.
    .word-status-bytes = the status bytes of its packets

METADATA-BY-NAME =
    .text1 = { $sensor }: { $name } is its metadata by its name, not { $others }.

METADATA-ASSUMED =
    .text1 = { $sensor }: { $name } does not tell { $fields }: those of most sensors are taken.

CHECKSUM-FOREIGN =
    .text1 = { $sensor }: the CRC of its packets is not that of the protocol: not checked.

## Times and clocks

FRAMES-ABSENT =
    .text1 = The names of the files lack { $absent } numbers of { $first } to { $last }: their time stays empty.

FRAMES-RATE =
    .text1-if-assumed = No rotation found, cut into frames at { SIGNIFICANT($rate_hz, digits: 6) } Hz.
    .text2-if-by_rotation = Frames at { SIGNIFICANT($rate_hz, digits: 6) } Hz: one revolution of the slowest LiDAR.

CLOUDS-THINNED =
    .text1 = { $sensor }: all over the recording nothing for { DECIMAL($pause_s, digits: 3) } s of every { DECIMAL($every_s, digits: 3) } s, as where only some of the clouds are kept. The motion is bridged.

CLOCK-CORRECTED =
    .text1 = { $sensor }: its clock is corrected by { DECIMAL($rate_ppm, digits: 1, sign: 1) } µs a second since its first measurement, as the rig file says.

CLOCKS-SET =
    .text1 = All clocks were set ahead by { DECIMAL($jump_s, digits: 3) } s at { DECIMAL($at_s, digits: 1) } s. The carrier walked on meanwhile as before, so nothing is missing: the times go on without the jump.
    .text2 = That looks like: { WORD($looks) }.

CLOCK-PAST-HOUR =
    .text1 = { $sensor }: its timestamps run on past the full hour (3600 s): continued.

CLOCK-BY-GPS =
    .text1 = { $sensor }: the hour is from its GPS; the recorder's clock is { DECIMAL($off_s, digits: 3, sign: 1) } s off UTC.

CLOCK-SHIFTED =
    .text1-if-hours = { $sensor }: its clock is { DECIMAL($ahead_s, digits: 3, sign: 1) } s and whole hours off the recorder's and no GPS drives it: its times are shifted to the recorder's clock.
    .text2-if-past_hour = { $sensor }: its clock is { DECIMAL($ahead_s, digits: 3, sign: 1) } s off the recorder's and no GPS drives it: its times are shifted to the recorder's clock.

STAMPS-EVENED =
    .text1 = { $where }: its stamps scatter by { DECIMAL($scatter_ms, digits: 1) } ms, as those of a computer that stamps what arrives do. The clouds last equally long: they are put where even stamps would be.

CLOCK-OF-POINTS =
    .text1 = { $where }: the points' clock is not the stamps' clock, it is ahead by { DECIMAL($ahead_s, digits: 3, sign: 1) } s.
    .text2 = That looks like: { WORD($looks) }.
    .text3-if-each = Each stamp is taken as that of the first point.
    .text4-if-first = The first stamp is taken as that of the first point.

TIMES-OF-POINTS =
    .text1 = { $where }: times are those of the points.

TIMES-CONTINUED =
    .text1 = { $where }: times of points begin again every { SIGNIFICANT($cycle_s, digits: 6) } s: continued by the stamps.

TIMES-AS-PARTS =
    .text1 = { $where }: times of points are from 0 to 1: parts of the time from cloud to cloud.

TIMES-BY-AZIMUTH =
    .text1 = { $where }: no time per point, time from azimuth, { WORD($order, of: "POINTS-TIMED-BY-AZIMUTH") }.

LINES-UNTIMED =
    .text1 = Line scans without times of their shots: all shots at the stamp.

## Points

BYTES-ORDER =
    .text1 = { $where }: what the clouds state as the order of their bytes (is_bigendian) is wrong: in that order the coordinates are no lengths. They are read in the other order.

FIELDS-UNREAD =
    .text1 = { $where }: fields of types that are not known are not read: { $fields }.

INTENSITY-MISSING =
    .text1 = { $where }: no intensity field, 0 is stored.
    .text2-if-line_scans = Line scans without intensities: 0 is stored.

INTENSITY-CONSTANT =
    .text1 = { $where }: { $field } is { SIGNIFICANT($value, digits: 6) } in all points of a cloud: it was not measured.
    .text2-if-no_number = { $where }: { $field } is no number in all points of a cloud: it was not measured.

INTENSITY-SCALED =
    .text1 = { $where }: intensity 0..1 is stored times 255.

RINGS-RENUMBERED =
    .text1 = { $where }: { $field } renumbered, 0 = lowest elevation.

RINGS-BY-ELEVATION =
    .text1-if-fieldless = { $where }: no ring field.
    .text2 = { $where }: { $field } is { SIGNIFICANT($everywhere, digits: 6) } everywhere.
    .text3-if-outside = { $where }: { $field } is mostly outside 0..255.
    .text4-if-in_files = { $where }: no rings in the files.
    .text5-if-beams = The ring is taken from the elevation.
    .text6-if-bands = { $bands } bands of elevation are taken instead.

## 2-D lasers

RANGE-LARGEST =
    .text1 = Ranges of { DECIMAL($limit_m, digits: 2) } m and more, the largest: no return.

ODOMETRY-MISSING =
    .text1 = No odometry: motion is predicted from the scans before.

ODOMETRY-STILL =
    .text1 = The odometry never changes: it is not used.

ODOMETRY-OF-REAR =
    .text1 = The poses of the rear laser are those of the robot: it looks backward.

ODOMETRY-RAW =
    .text1 = The poses of the laser are corrected ones: the raw odometry is used instead.

ODOMETRY-MOVED =
    .text1 = The odometry is moved to the laser.

## IMU and GNSS

IMU-ABSENT =
    .text1 = No IMU: motion within a frame is estimated from the points alone.

SAMPLES-OF-FILE =
    .text1-if-imu = IMU samples are those of the CSV file, not the recording's.
    .text2-if-gnss = GNSS samples are those of the file given, not the recording's.

IMU-CHOSEN =
    .text1 = IMU: that in the packets of { $sensor } is read, as the rig says, not { $other }.
    .text2 = IMU: { $read } is read, not that of { $others } (another one: [imu] sensor = NAME in the rig file).
    .text3 = IMU: number { $number } is read, that of no LiDAR.

IMU-JOINED =
    .text1 = IMU: angular rates of { $turns } and accelerations of { $forces } are joined.

IMU-UNCALIBRATED =
    .text1 = { $sensor }: gyroscope and accelerometer from its position packets, in its own frame; the zero of these gyroscopes is not calibrated (tens of degrees a second).

TURNS-UNIT =
    .text1-if-kept = IMU: a tenth of its angular rates is above { DECIMAL($high, digits: 1) }: taken as rad/s ({ DECIMAL($high_deg_s, digits: 0) } deg/s).
    .text2-if-converted = IMU: angular rates are in deg/s, stored in rad/s.
    .text3-if-by_content = A tenth of them is above { DECIMAL($high, digits: 1) }; against it: ingest.imu_gyro_unit=rad_s.

FORCES-UNIT =
    .text1 = The accelerometer was in { $unit } (median length { SIGNIFICANT($usual, digits: 3) }), now in m/s².
    .text2 = IMU: accelerations of { SIGNIFICANT($usual, digits: 3) } in { $name } and others are m/s², not g.

POSITIONS-CHOSEN =
    .text1 = { $name }: positions are those of { $log }; not read: { $others }.
    .text2 = Positions are those of { $message }; not read beside them: { $others }.

POSITIONS-DATED =
    .text1-if-dateless = { $what }, without a date: the first is of { $day }, as the points say.
    .text2-if-weekless = { $what }, without a GPS week: the first is of { $day }, as the points say.
    .text3-if-dateless = GNSS positions ({ $format }), without a date: the first is of { $day }, as the points say.
    .text4-if-weekless = GNSS positions ({ $format }), without a GPS week: the first is of { $day }, as the points say.

POSITIONS-UNIT =
    .text1 = Positions were in radians (latitude { DECIMAL($lat_rad, digits: 6) }, longitude { DECIMAL($lon_rad, digits: 6) }), now in degrees.

POSITIONS-BY-ARRIVAL =
    .text1-if-nmea = NMEA: timed by arrival, its UTC is not the points' clock.
    .text2 = { $sensor }: positions are timed by when their packet came (up to 1 s late): GPS does not drive its clock.
    .text3-if-by_device = Positions have the times at which the device received them.

POSITIONS-ACCURACY =
    .text1 = Accuracies of { $name } are those of { $source }.
    .text2 = Accuracies of { $name } are not read: { $error }.
    .text3-if-absent = { $name }: no smrmsg file with its accuracies lies beside it; its positions count as single fixes.
    .text4-if-no_number = { $name }: no accuracy in it is a positive number.

HEIGHTS-MISSING =
    .text1 = No GNSS position has a height: they cannot place the map.

## Artifacts of earlier versions

EARLIER-SENTENCE =
    .text1 = { $text }
