### What readers of recordings warn of.
### docs/how-to/languages.md says how texts are written and translated.

## The file

FILE-SALVAGED = File cut off or damaged
    .text1 = { $name } is cut off or damaged; what it still has is read.
    .text2 = { $error }.
    .text3-if-messages = { $messages } messages were salvaged.
    .remedy = Copy it again from where it was recorded, if it is whole there.
    .meaning = The recording ended before the file was closed, or bytes of it are damaged.

CAPTURE-SALVAGED = Capture cut off or damaged
    .text1 = { $name }: salvaged: it ends inside a packet; the last { $dropped } bytes are dropped.
    .text2 = { $name }: salvaged: packet at byte { $at }: expected a length of 1 to { $most } bytes, got { $captured }; what follows is not read.
    .text3 = { $name }: salvaged: { $error }; what follows is not read.
    .remedy = Copy it again from where it was recorded, if it is whole there.
    .meaning = Packets after that place are not in the map.

FRAME-LENGTH = Length of a frame of the file
    .text1 = { $name }: the frame at byte { $at } says that it reaches from { $begin } to { $end }: read up to there.
    .meaning = What follows in the file is not in the map.

FILE-REST-UNREAD = Rest of a compressed file
    .text1 = { $name }: what follows the compressed data is not compressed: not read.
    .meaning = Something else was appended to the file.

FILE-LEFT-OUT = File left out
    .text1-if-name = { $name }: a file is left out.
    .text2 = Left out: { $error }.
    .meaning = One file of the recording cannot be read; the others are.

FILES-MISSING = Files missing
    .text1 = { $name }: { $files } files of metadata.yaml are missing: { $missing }; the others are read.
    .remedy = Copy the whole folder.
    .meaning = The folder of a bag lacks parts that its description lists.

FOLDER-DESCRIPTION = Description of a bag
    .text1 = { $name }: { $error }; its files are read one by one.
    .meaning = The metadata.yaml of the bag is damaged: what is missing of the bag is not known.

CHUNK-LEFT-OUT = Part of a file left out
    .text1 = Left out: { $error }.
    .meaning = A compressed part of the file is damaged; its messages are not in the map.

MESSAGE-LEFT-OUT = Message left out
    .text1 = { $where }: left out: { $error }.
    .text2-if-undecoded = { $where }: messages that cannot be decoded are left out.
    .meaning = A message contradicts its type or itself. How many there are is counted.

MESSAGES-DAMAGED = Damaged messages
    .text1 = { $name }: messages without a known topic, a time, data or a sensible size are left out.
    .text2 = Row { $row } of table messages: { $error }.
    .meaning = Records of the bag are damaged. How many there are is counted.

MESSAGES-MISSING = Messages missing
    .text1 = { $name }: expected { $expected } messages as in metadata.yaml, got { $found }.
    .text2 = { $name }: { $missing } messages fewer than the { $indexed } in the index of the file.
    .meaning = The bag has less than it says of itself.

NO-POINTS = No usable point
    .text1 = No usable points ({ COUNTS($counts) }).
    .text2-if-nothing = No usable points (nothing read).
    .meaning = Nothing of the recording can be mapped; the counts say why.

DATA-LOST = Data lost
    .text1-if-total = { $number } of { $total } { COUNTED($count) }.
    .text2-if-alone = { $number } { COUNTED($count) }.
    .text3 = ({ $detail })
    .meaning = Data that was in the recording, or should have been, is not used.
    .detection = At least 1 % of the data of its kind, or a kind whose number is not known.

QUATERNION-ORDER = Order of a quaternion
    .text1 = The body rolls over and never turns: is qw the first number of the quaternion? Expected qx qy qz qw.
    .remedy = A head line '# timestamp tx ty tz qw qx qy qz' states the order.
    .meaning = The poses are read in the wrong order of numbers.

## Packets and models of sensors

PACKETS-MISSING = No packets of a sensor
    .text1-if-address = { $sensor }: no data packets from { $address } to port { $port }.
    .text2-if-anywhere = { $sensor }: no data packets from any address to port { $port }.
    .text3-if-found = Found: { $found }.
    .remedy = Correct model, address and port in the rig file, or capture again.
    .meaning = The map is made without this sensor of the rig.

PACKETS-UNREAD = Packets not read
    .text1 = Not read: { $packets } packets from { $sender } ({ $why }).
    .meaning = A sender of much is none of the sensors that are known or of the rig.
    .detection = It sends at least 1 % of what the busiest LiDAR sends.

PACKETS-UNASSIGNED = Packets without a sensor
    .text1 = { $sender }: the rig has no sensor for these packets; not read.
    .remedy = Add it to the rig file.
    .meaning = A LiDAR that was recorded is not in the map.

PACKETS-MIXED = Several sensors at one port
    .text1 = { $sensor }: packets of other sensors come from the same address to the same port ({ $others }): those of { $read } are read.
    .remedy = Capture each sensor at a port of its own.
    .meaning = The other sensors are not in the map.

SAMPLES-PORT = Samples at another port
    .text1 = Not read: { $packets } packets from { $sender } ({ $what } samples); the rig expects { $what } at port { $expected }.
    .remedy = Give [{ $table }] port = { $port } in the rig file.
    .meaning = The samples are in the recording and not used.

RETURN-MODE = Unknown return mode
    .text1 = { $sensor }: unknown return mode byte { BYTE($mode) }: read as single return.
    .meaning = The packets may have points that are read wrongly or not at all.

MODEL-CONTRADICTED = Packets of another model
    .text1 = { $sensor }: its packets are those of a { $says }; decoded as { $model }.
    .text2 = { $sensor }: its packets are those of a { $says }, not of the { $expected } in the rig file; they are not read.
    .remedy = Name the right model in the rig file.
    .meaning = Angles and times of the points are those of the model in the rig file. Packets of another make are not read.

MODEL-UNLIKELY = Packets as often as of another model
    .text1 = { $sensor }: a packet every { DECIMAL($interval_ms, digits: 3) } ms is what a { $likely } sends, but it is decoded as { $model }.
    .remedy = Name the right model in the rig file.
    .meaning = Angles and times of the points may be wrong.

MODEL-BY-INTERVAL = Model by the interval of packets
    .text1 = { $sensor }: its packets say { $says }, but they come every { DECIMAL($interval_ms, digits: 3) } ms as those of a { $model }: taken for a { $model }.
    .remedy = Give a rig that names the model.
    .meaning = What the packets say of their model contradicts how often they come.

MODEL-UNKNOWN = Model not known
    .text1 = { $sensor }: the model is not known: read as a { $model }.
    .text2 = { $sensor }: unknown product byte { BYTE($product) }.
    .remedy = Give a rig that names the model.
    .meaning = The packets do not tell the model of their sensor.

ANGLES-TYPICAL = Typical angles of beams
    .text1-if-fitting = { $sensor }: angles of a typical { $model } (off by up to 0.3°): { $fitting } fit.
    .text2-if-absent = { $sensor }: angles of a typical { $model } (off by up to 0.3°): no correction file with { $rows } rows (Channel,Elevation,Azimuth) is beside the recording or the rig file.
    .text3-if-difop = { $sensor }: the angles of its lasers are those of another { $model }, some 0.1° off, until a device packet (DIFOP) comes.
    .text4-if-fitting = Give the one of this sensor the name of the sensor.
    .text5-if-difop = Record its port 7788 too.
    .meaning = Each sensor has angles of its own, which the recording lacks: surfaces are thicker.

ANGLES-UNREADABLE = Table of angles not used
    .text1 = { $name }: not used as a table of angles: { $error }.
    .meaning = A file beside the recording has angles of beams that cannot be read.

METADATA-UNREADABLE = Metadata of a sensor not used
    .text1 = { $sensor }: { $error }.
    .meaning = A metadata file beside the recording is damaged.

METADATA-ELSEWHERE = Metadata of another sensor
    .text1 = { $sensor }: { $name } is of the sensor { $serial }, but the packets are of { $packets }: the angles of its beams are those of another sensor.
    .remedy = Give the metadata of the right one.
    .meaning = Each sensor has angles of its own: surfaces are thicker.

METADATA-NEEDED = Metadata of a sensor missing
    .text1-if-absent = { $sensor }: packets of an Ouster do not tell the angles of its beams: put the metadata json of the sensor beside the recording or the rig file. The driver and ouster-cli write it; http://SENSOR/api/v1/sensor/metadata shows it. On the page upload the folder with both. A live capture needs it in the rig, as its description (page: Rigs; command: a file beside the rig file).
    .text2-if-error = { $error }.
    .meaning = Without it the packets cannot be decoded.

METADATA-COLUMNS = Columns in a revolution
    .text1 = { $sensor }: { $name } says { $stated } columns in a revolution, its packets have { $columns }: read so.
    .meaning = The sensor was in another mode than when its metadata was written.

METADATA-MODEL = Model by the metadata
    .text1 = { $sensor }: the rig says { $model }, { $name } { $product }: decoded by this file.
    .remedy = Name the right model in the rig file.
    .meaning = Rig file and metadata name different models.

SERIALS-UNREADABLE = Serial numbers not read
    .text1 = Serial numbers: { $error }.
    .meaning = Whether all files are of one device is not known.

SERIALS-CHANGE = Another device
    .text1 = { $name }: LiDAR { $lidar } is { $serial }, { $before } in the files before: walks of two devices?
    .remedy = Process each walk by itself.
    .meaning = Files of two walks may lie in one folder.

## Sensors of the rig and topics

SENSOR-NOT-RECORDED = Sensor not recorded
    .text1 = Sensor { $sensor } of the rig is not in the recording.
    .text2 = The rig file names the topic { $topic }.
    .meaning = The map is made without it.
    .remedy = Correct its topic in the rig file.

TOPIC-UNASSIGNED = Topic without a sensor
    .text1 = Topic { $topic } belongs to no sensor of the rig and is not read.
    .remedy = Name the topic in the rig file.
    .meaning = Points that were recorded are not in the map.

TOPIC-NOT-RECORDED = Topic not recorded
    .text1-if-there = The topic { $topic } of [{ $table }] in the rig file is not in the recording, which has { $there }: no { $what } is read.
    .text2-if-none = The topic { $topic } of [{ $table }] in the rig file is not in the recording, which has none: no { $what } is read.
    .remedy = Name the topic in the rig file, or with { $setting }.
    .meaning = The map is made without these data: another topic has another mount.

TOPICS-EQUAL = Topics that are equally good
    .text1-if-frame = { $what }: { $read } (frame { $frame }) is read, not { $rivals }: they are equally good.
    .text2-if-frameless = { $what }: { $read } is read, not { $rivals }: they are equally good.
    .text3-if-table = { $setting } or topic of [{ $table }] in a rig file names the right one.
    .text4-if-settable = { $setting } names the right one.
    .meaning = The map depends on the choice, and nothing in the recording decides it.

DRIVER-UNREAD = Messages of a driver
    .text1 = { $topic } is of a LiDAR, but { $type } is not read.
    .remedy = Play the bag back through the driver (compressed clouds: point_cloud_transport) and record the PointCloud2 that it publishes.
    .meaning = Points that were recorded are not in the map.

LASER-NOT-IN-RIG = No 2-D laser in the rig
    .text1 = The rig has no 2-D laser: the first motion is from the IMU alone.
    .meaning = The first trajectory of the profiler drifts by meters; the refinement has to correct it.

LASER-TABLE-MISSING = No table of the 2-D laser
    .text1 = No table of the 2-D laser beside { $name }: expected laser2d.csv or .npz.
    .meaning = The first trajectory of the profiler is from the IMU alone.

## Times and clocks

TIME-GAP = Gap in the data of a sensor
    .text1 = { $sensor }: nothing for { DECIMAL($seconds, digits: 3) } s at { DECIMAL($start_s, digits: 1) } s.
    .meaning = Data is missing there; the motion is bridged.
    .detection = Longer than the gap of the tuning of the import.

CLOCK-BACK = Clock goes back
    .text1 = { $sensor }: the clock goes back for { DECIMAL($seconds, digits: 3) } s at { DECIMAL($start_s, digits: 1) } s.
    .meaning = Times go on evenly; how much time really passed there is not known. A note if an IMU fits the LiDARs over the whole walk without any correction.

CLOCK-JUMP = Clock jumped
    .text1 = { $sensor }: { WORD($whose, of: "CLOCK-JUMP") } jumped by { DECIMAL($jump_s, digits: 3, sign: 1) } s; { WORD($times, of: "CLOCK-JUMP") }.
    .text2 = That looks like: { WORD($looks) }.
    .word-sensor = its clock
    .word-recorder = the recorder's clock
    .word-points = the clock of its points, against that of the stamps,
    .word-without-it = times go on without it
    .word-by-stamps = times go on by the stamps
    .word-by-arrival = its scans are continued by their arrival
    .meaning = A clock was set while the recording ran. A note if an IMU fits the LiDARs over the whole walk without any correction.

CLOCK-FREE = Clock runs freely
    .text1 = { $sensor }: its clock is { DECIMAL($ahead_s, digits: 3, sign: 1) } s off the recorder's and no GPS drives it: its times are shifted to the recorder's clock.
    .text2-if-hours = Whole hours more are not known.
    .remedy = Give the sensors one clock (GPS with PPS, or PTP).
    .meaning = Several LiDARs are joined by times of arrival, which are known to milliseconds.

CLOCK-FREE-IMU = IMU on another clock?
    .text1-if-unknown = No GPS drives the clock of { $sensors }, whose times are those of the recorder: nothing says whether the IMU is on that clock.
    .text2 = No GPS drives the clock of { $sensors }, whose times are those of the recorder: the IMU's stamps are { DECIMAL($ahead_s, digits: 3, sign: 1) } s ahead of it.
    .text3 = That is as of { WORD($looks) }.
    .remedy = If they do not fit, give [imu] time_offset_s in the rig file.
    .meaning = Points and IMU may not fit in time.

CLOCK-LIDARS = Clocks of LiDARs differ
    .text1 = The clock of { $sensor } is ahead of that of { $other } by { DECIMAL($ahead_s, digits: 3, sign: 1) } s, by when both were recorded: their points do not fit in time.
    .text2 = That is as of { WORD($looks) }.
    .remedy = Give { $sensor } time_offset_s = about { EXACT($offset_s, digits: 3) } in the rig file.
    .meaning = One multiframe has points of two places.

CLOCK-FOREIGN = Samples on another clock
    .text1 = The clock of the { $what } is ahead of the LiDAR's by { DECIMAL($ahead_s, digits: 3, sign: 1) } s, by when both were recorded: its samples are not used.
    .text2 = That is as of { WORD($looks) }.
    .text3-if-exact = Give [{ $table }] time_offset_s = { EXACT($offset_s, digits: 3) } in the rig file.
    .text4-if-measured = Give [{ $table }] time_offset_s = about { EXACT($offset_s, digits: 3) } in the rig file.
    .meaning = The map is made without these samples.

SAMPLES-ELSEWHEN = Samples of another time
    .text1 = { $what } samples cover { DECIMAL($first_s, digits: 3) } … { DECIMAL($last_s, digits: 3) } s, the points { DECIMAL($points_first_s, digits: 3) } … { DECIMAL($points_last_s, digits: 3) } s: are the clocks the same?
    .text2 = If both begin together, they differ by { DECIMAL($ahead_s, digits: 3, sign: 1) } s.
    .text3 = That is as of { WORD($looks) }.
    .text4 = They are not used.
    .remedy = Give [{ $table }] time_offset_s = { EXACT($offset_s, digits: 3) } in the rig file.
    .meaning = The map is made without these samples.

SAMPLES-SHORT = Samples begin or end elsewhen
    .text1 = { $what } samples begin { DECIMAL($late_s, digits: 1, sign: 1) } s after and end { DECIMAL($early_s, digits: 1, sign: 1) } s before the points.
    .text2 = That is as if their clock were ahead by { WORD($looks) }.
    .remedy = Give [{ $table }] time_offset_s = { EXACT($offset_s, digits: 3) } in the rig file.
    .meaning = A part of the walk is mapped without them, or their clock is another one.

RATE-UNFIT = Rate of multiframes
    .text1 = rate_hz = { SIGNIFICANT($requested_hz, digits: 6) } does not fit the rotation of { SIGNIFICANT($rotation_hz, digits: 6) } Hz: frames are no whole revolutions.
    .remedy = Leave the setting at 0: then it is measured.
    .meaning = Multiframes see different parts of the surroundings; loop closures are harder to find.

FRAMES-UNTIMED = Frames without times
    .text1 = The frames have no times: { SIGNIFICANT($rate_hz, digits: 6) } Hz from 0 is assumed, and the map is wrong if that is.
    .remedy = Put a times.txt with one time a line [s] beside the files.
    .meaning = Speed and motion within a frame depend on it.

FRAMES-MIXED = Files of several sensors?
    .text1 = The names of the files begin in { $ways } ways ({ $some }), as of several sensors or clouds: they are read as what one sensor measured, one after the other.
    .remedy = Give a folder for each sensor, and process one of them.
    .meaning = If they are of several sensors, the map is wrong.

FRAMES-OVERLAP = Frames that overlap in time
    .text1 = Frames that do not follow each other in time are put one after the other.
    .meaning = Times of frames are not those of their points.

TIMES-UNREADABLE = Times of frames not read
    .text1 = Not used: { $error }.
    .meaning = The file with the times of the frames is damaged.

TIMES-NUMBER = Number of times
    .text1 = { $name } has { $times } times for { $files } files, not used.
    .meaning = Which time is that of which frame is not known.

TIMES-UNSORTED = Times out of order
    .text1 = { $name }: time { $first } is not later than the one before, { $damaged } of { $times } are not: not used.
    .meaning = The times of the frames are not used.

TIMES-DAMAGED = Damaged times
    .text1 = { $damaged } of { $times } times are damaged, the first is { $name }: time { $first }: times between those of their neighbors are used.
    .meaning = Single times of frames were repaired.

POINTS-UNTIMED = Points without times
    .text1 = { $where }: the points have no times: all of a cloud are taken as measured at its stamp, which is wrong while the sensor moves.
    .remedy = If the clouds are undistorted already or the sensor stood still, say so with ingest.deskewed=true.
    .meaning = What the sensor sees while it turns or walks is smeared.

POINTS-TIMED-BY-AZIMUTH = Times of points by azimuth
    .text1 = { $where }: no time per point, time from azimuth, { WORD($order, of: "POINTS-TIMED-BY-AZIMUTH") }.
    .word-firing = points are in firing order
    .word-from-rear = taken as one clockwise turn from the rear
    .remedy = If the clouds are undistorted already or the sensor stood still, say so with ingest.deskewed=true.
    .meaning = Times within a revolution are known to some milliseconds.

## Points

POINTS-FAR = Points too far away
    .text1 = Most points of a cloud are farther than { SIGNIFICANT($max_range_m, digits: 6) } m: { $extent }.
    .text2-if-map = These are coordinates of a map or of the earth, not a scan with the sensor at the origin. A finished map is no recording; give it as a reference.
    .text3-if-unit = Half of them are farther than { DECIMAL($usual_m, digits: 0) } m. If they are in millimeters, give ingest.points_unit_m=0.001; a map whose origin is no sensor is no recording.
    .text4-if-range = Half of them are farther than { DECIMAL($usual_m, digits: 0) } m. If the sensor measures that far, give a larger ingest.max_range_m.
    .meaning = Such points are left out.

POINTS-TURN-LEFT = Points turn to the left
    .text1 = fields of { $name }: the points turn to the left, seen from above; LiDARs turn to the right.
    .remedy = Exchange the columns, or turn an axis round (y=-COLUMN), unless the map would be mirrored then.
    .meaning = If two columns are exchanged or an axis points the other way, the map is mirrored.

INTENSITY-CLIPPED = Intensities clipped
    .text1 = { $where }: intensities outside 0..65535 are clipped.
    .meaning = Bright points have the same intensity.

## Scans and lines

RANGE-UNIT = Unit of ranges
    .text1 = { $sensor }: half of the ranges are above { DECIMAL($median, digits: 0) }: they are taken as { WORD($unit, of: "RANGE-UNIT") }, not meters.
    .word-mm = millimeters
    .word-cm = centimeters
    .meaning = The scale of the map depends on it.

RANGES-INVALID = Ranges that are no numbers
    .text1 = { $ranges } ranges are negative or no numbers: they are left out.
    .meaning = Single beams of scans are damaged.

SCAN-LEFT-OUT = Scan left out
    .text1 = { $where }: line { $line }: a damaged scan is left out: { $error }.
    .text2-if-alone = { $where }: left out: { $error }.
    .meaning = Damaged scans are not in the map; the first is named, all are counted.

SCANS-UNSORTED = Scans sorted by time
    .text1 = { $where }: { $scans } scans are earlier than the one before: sorted by time.
    .meaning = The file has scans out of order.

SCANS-LATE = Scans out of order
    .text1 = { $where }: { $scans } scans earlier than the one before are left out.
    .meaning = These scans are not in the map.

SCANS-OF-OTHERS = Scans of another message
    .text1 = { $name }: { $left_out } of { $scans } scans are left out: those of the message { $message } are read, { $read }, and these are of another one.
    .meaning = The log has scans of several lasers; one is mapped.

ODOMETRY-SHORT = Odometry does not cover the scans
    .text1 = The odometry does not cover all scans: it is not used.
    .meaning = Motion is predicted from the scans before.

LINES-MISSING = Line scans missing
    .text1 = { $sensor }: { PERCENT($ratio, digits: 0) } of the line scans are missing, { $missing } of { $lines }.
    .meaning = The profiler or its recording lost lines.

LINES-WITHOUT-ANGLE = Lines without an angle
    .text1 = { $sensor }: { $lines } lines without an angle of the head.
    .meaning = These lines are not in the map: where the head pointed is not known.

HEAD-STANDS = Head stands still
    .text1 = { $sensor }: the head stands at { DEGREES($angle_rad, digits: 1) } for { DECIMAL($seconds, digits: 1) } s.
    .meaning = The profiler sees one plane only in this time.

## IMU and GNSS

GYROSCOPE-MISSING = No gyroscope
    .text1 = The IMU has no gyroscope ({ WORD($why) }): it is not used.
    .text2 = Its values along { $axes } never change in { $samples } samples.
    .text3-if-forces = Its accelerations alone are not used either: without the turns of the body they do not tell gravity from the motion; the map is leveled by its floor.
    .meaning = The map is made without the IMU.

ACCELEROMETER-MISSING = No accelerometer
    .text1 = The IMU has no accelerometer ({ WORD($why) }): the map is leveled by its floor.
    .text2 = Its values along { $axes } never change in { $samples } samples.
    .meaning = Nothing but the floor tells where up is.

GYROSCOPE-UNIT = Unit of the gyroscope
    .text1 = IMU: a tenth of its angular rates is above { DECIMAL($high, digits: 1) }, too much for rad/s and for deg/s: they are in another unit, the IMU is not used.
    .meaning = The map is made without the IMU.

ACCELEROMETER-UNIT = Unit of the accelerometer
    .text1 = Accelerometer: median length { SIGNIFICANT($usual, digits: 3) }, expected about 9.8 m/s² (gravity included): it counts as not measured, the map is leveled by its floor.
    .meaning = Accelerations without gravity, or in an unknown unit, do not tell where up is.

ACCELEROMETER-SPARSE = Few accelerations
    .text1 = The accelerometer has { $samples } samples in { $gyroscope_samples } of the gyroscope, with holes: it counts as not measured, the map is leveled by its floor.
    .meaning = Between so few samples accelerations cannot be interpolated.

ACCELERATIONS-MISSING = Samples without acceleration
    .text1 = { $missing } of { $samples } samples of the IMU have no acceleration, first { DECIMAL($first_s, digits: 1) } s after its start: dropped.
    .meaning = The accelerometer was interrupted.

IMU-EMPTY = No usable IMU sample
    .text1 = No usable IMU sample.
    .meaning = The map is made without an IMU.

IMU-REPEATED = IMU repeats a sample
    .text1 = The IMU repeats a sample with new time stamps { $times ->
        [one] once
       *[other] { $times } times
     }, first { DECIMAL($first_s, digits: 1) } s after its start, for up to { DECIMAL($longest_s, digits: 1) } s: its driver hangs. { $samples } samples dropped.
    .meaning = The motion of that time was not recorded.

GNSS-EMPTY = No usable GNSS position
    .text1 = No usable GNSS position of { $fixes }:
    .text2-if-no_fix = { $no_fix } say that they are no fix.
    .text3-if-no_place = { $no_place } are no place on earth.
    .text4-if-at_zero = { $at_zero } are at latitude and longitude 0 or never change.
    .meaning = The map is not georeferenced.

GNSS-CONSTANT = Position that never changes
    .text1 = The position of all { $fixes } GNSS fixes is the same: they are not used.
    .meaning = The receiver had no position, or did not move.

GNSS-HEIGHTS-ZERO = Heights of 0
    .text1 = All GNSS heights are 0: they count as not measured.
    .meaning = The map is placed without heights.

INS-CONSTANT = Attitude that never changes
    .text1 = The attitude of the INS never changes: it counts as not measured.
    .meaning = Roll, pitch and heading of the receiver are not used.

HEIGHTS-DIFFER = Heights of file and recording
    .text1 = Heights of the GNSS file lie { DECIMAL($difference_m, digits: 1) } m (± { DECIMAL($spread_m, digits: 1) } m) { WORD($side, of: "HEIGHTS-DIFFER") } those in the recording, as a geoid does: one of both is above sea level (orthometric), not above the ellipsoid.
    .text2 = If it is the file, all heights of the map are off by as much.
    .word-above = above
    .word-below = below
    .remedy = Then name its column orthometric_height_m, with a column geoid_separation_m of { EXACT($separation_m, digits: 1) }.
    .meaning = All heights of the map may be shifted by tens of meters; its shape is not affected.

## Mounts

MOUNT-DISPUTED = Transform contradicts itself
    .text1 = { $source } contradicts itself; the last transform is used: { $used }.
    .remedy = Give a rig file with the right mount.
    .meaning = The mount of a sensor may be wrong.

MOUNT-LOOP = Transforms contradict each other
    .text1 = Transforms of the bag contradict each other; not used: { $transform }.
    .remedy = Give a rig file with the right mount.
    .meaning = The mount of a sensor may be wrong.

MOUNT-FAR = Mount too far away
    .text1 = Mount of the { $what }: the bag says { $parent } -> { $child } { MOUNT($mount) }: too far, not used.
    .remedy = Give a rig file with the right mount.
    .meaning = Nobody carries a sensor that far from another.

MOUNT-CONTRADICTED = Rig file and bag contradict each other
    .text1 = Mount of { $part } relative to { $other }: { MOUNT($by_rig) } in the rig, { MOUNT($by_bag) } in { $source } of the bag ({ $parent } -> { $child }): they differ by { DEGREES($angle_rad, digits: 1) } and { LENGTH($distance_m) }.
    .text2 = The rig '{ $rig }' is used.
    .meaning = One of both mounts is wrong.
    .detection = The difference is larger than what a stated or a calibrated mount is known to.

LASER-TILTED = 2-D laser tilted
    .text1 = The laser is tilted by { DEGREES($tilt_rad, digits: 1) }: distances in the map are up to { PERCENT($longer, digits: 1) } too long, and floor or ceiling may be in it.
    .text2 = The recording states its mount: { MOUNT($by_recording) } ({ $parent } -> { $child }, { $sources }).
    .text3 = The rig file states its mount: { MOUNT($by_rig) }.
    .text4 = { $mount }.
    .meaning = The plane of the laser is not level.
    .detection = Rig file or tf. *Do not use* from a tilt of 30° on.

LASER-ON-JOINT = 2-D laser on a joint that moves
    .text1 = The laser hangs on a joint that moves: { $parent } -> { $child } tilts by up to { DEGREES($tilt_rad, digits: 1) } ({ $source }), but a flat map takes its plane as level all the time: distances may be too long, and floor or ceiling in it.
    .meaning = The plane of the laser is not level all the time.
    .detection = *Do not use* from a tilt of 30° on.

LASER-CONTRADICTED = Mount of the laser contradicted
    .text1 = Rig file and bag contradict each other about the laser: the vertical in its axes differs by { DEGREES($angle_rad, digits: 1) }.
    .text2 = The rig file is used: { MOUNT($by_rig) }.
    .text3 = The recording says: { MOUNT($by_recording) }.
    .text4 = These are { $parent } -> { $child } of { $sources }.
    .meaning = One of both mounts is wrong.

JOINT-CLOCK = Joint on another clock
    .text1 = The times of the joint are ahead of the sensor's by { DECIMAL($ahead_s, digits: 3, sign: 1) } s, by when both were recorded: points may be placed by the pose of another time; { $joint }.
    .text2 = That is as of { WORD($looks) }.
    .meaning = Where the sensor pointed is known for other times only.

IMU-ON-JOINT = IMU on a joint that moves
    .text1 = { $topic } tilts with the laser: it does not say how the robot moves.
    .meaning = The recording is mapped in 2-D, without a profiler.
