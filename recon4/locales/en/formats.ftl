### What is wrong with recordings, clouds, tables and models: each text has a code, which is stable.

## Bags

bag-magic = { $file }: expected { $expected }, got { $got }
bag-encrypted = { $file }: it is encrypted
bag-no-index = { $file }: it has no index, the recorder did not finish
bag-topics-many = { $file }: expected at most { $max_topics } topics, got { $connections }
bag-chunks-many = { $file }: expected at most { $most } chunks in an index of { $size } bytes, got { $chunks }
bag-chunk-twice = { $file }: the index of the file lists a chunk more than once
bag-connection-empty = { $file }: the connection before byte { $at } has no fields
bag-chunk-info-damaged = { $file }: the chunk info before byte { $at } is damaged
bag-chunk-long = { $file }: chunk at byte { $at }: expected at most { $index_at } bytes before the index, got { $length }
bag-record-kind = { $file }: expected { $expected } at byte { $at }, got { $kind }
bag-record-header = { $file }: record header before byte { $at }: expected { $size } bytes of { $name }, got { $count }
bag-metadata-large = { $metadata }: expected at most { $max_metadata_bytes } bytes, got { $size }
bag-folder-unreadable = { $folder }: no readable rosbag2: { $why }
bag-version = { $metadata }: expected version { $newest_version } or less and compression mode file, message or none, got version { $version }, mode { QUOTED($mode) }
bag-compression = { $metadata }: expected compression zstd, got { QUOTED($compression) }
bag-files-count = { $metadata }: expected 1 to { $max_files } files, got { $count }
bag-yaml = { $metadata }: no readable YAML: { $reason }
bag-yaml-reference = { $metadata }, line { $line }: expected no reference, got *{ $anchor }
bag-yaml-deep = { $metadata }, line { $line }: nested deeper than { $max_depth } levels or more than { $max_events } values
bag-description = { $metadata }: no description of a rosbag2: { $why }
bag-nothing-left = { $name }: damaged or cut off, not one message is left
bag-files-absent = no file of { $metadata } is there: { $names }
bag-files-unlisted = { $metadata } does not list { $names }
bag-empty = { $names }: a bag without messages
mcap-checksum = { $where }: expected checksum { $crc }, got { $raw }: its bytes changed
chunk-records-end = { $where }: expected records up to its end at { $count }, got { $at } bytes
chunk-index = { $name }: the index of the file lists a chunk at byte { $offset }: expected one between { $at } and { $end }, got { $length } bytes
db3-table = { $name }: expected a table { $table }, got { $kinds } of that name
db3-table-hides = { $name }: table { $table } hides the numbers of its rows
db3-unreadable = { $name }: no readable SQLite database: { $why }
db3-column = { $name }: expected a column { $column } in { $table }, got { $got }
db3-topics = { $name }: table topics: expected at most { $max_topics } topics, each with a number of its own, got { $number } after { $count }
db3-no-topics = { $name }: its table topics is empty: what the { $count } messages are is not known
mcap-summary = { $where }: expected schemas, chunks and statistics, not all are there
mcap-footer = { $file }: expected a footer at byte { $footer_at }, it is cut off
mcap-summary-place = { $file }: expected a summary of at most { $max_summary_bytes } bytes before byte { $footer_at }, got one from byte { $start }
mcap-record-ends = { $where }: it ends inside a record
mcap-record-long = { $where }: expected a record of at most { $left } bytes, got { $length }
mcap-chunk-place = { $file }: expected a chunk of { $length } bytes at byte { $offset }, got a record of kind { $op } of { $got } bytes
mcap-chunk-differs = { $file }: chunk at byte { $offset }: expected { $size } bytes from { $t_first_ns } ns on as in the summary, got { $got_size } from { $got_first_ns }
mcap-chunk-times = { $file }: chunk at byte { $offset }: its times make no sense
mcap-chunk-size = { $file }: chunk at byte { $at }: expected { $end } bytes, got { $data }
mcap-record-unreadable = { $where }: a record that cannot be read ({ $why })
mcap-channel = { $where }: statistics of a channel { $number } that is not there
message-large = a message { $kind }: expected at most { $most } bytes, got { $count }
message-fields-many = a cloud: expected at most { $max_fields } fields, got { $count }
message-field-place = a cloud: expected a field at byte { $end } of a point or behind, got { $offset }
message-header-cut = a cloud that ends inside its header: { $why }
schema-type-missing = a definition that leaves out the type { $kind }
schema-long = { $kind }: a definition of { $count } characters
schema-fields = a definition of { $count } fields
schema-wide-text = the field { $field } is a text of wide characters
schema-items = { $field }: { $count } items, expected at most { $max_items }
schema-structures = a list of { $count } structures in { $size } bytes
schema-line = a definition with the line { QUOTED($line) }
schema-cycle = a definition whose types contain each other, or too much: { $kind }
message-cut = a message of { $count } bytes that ends inside a field
message-no-field = a message of points without a field: { $why }
db3-tree = { $file }: no readable SQLite database: expected a tree of pages, got page { $number } twice or on level { $depth }; not one message is left
typestore-lacks = the bag defines { $kind } without { $missing }, by which its packets are read: play it back through its driver, and record the PointCloud2 that it publishes
urdf-large = expected at most { $max_urdf_bytes } bytes, got { $size }
urdf-numbers = { $what } of a joint: expected { $count } numbers, got { QUOTED($text) }
xml-unsound = no sound XML: { $why }
urdf-joints = more than { $max_joints } joints

## Captures

pcap-no-packet = { $file }: a capture file without any packet{ $why }
pcap-header-cut = { $name }: cut inside the file header, no packet is left
pcap-link-type = { $name }: expected a capture of Ethernet, Linux cooked or raw IP packets, got link type { $link_type }
pcap-magic = { $name }: expected a capture file (pcap or pcapng), got first bytes { $magic }
pcapng-order = { $where }: expected a byte order mark, got { $magic }
pcapng-cut = { $where }: expected 8 bytes, got { $count }: the file is cut off
pcapng-length = { $where }: expected a length of 12 to { $max_block_bytes } bytes in steps of 4, got { $length }
pcapng-block-cut = { $where }: expected { $length } bytes, got { $count }: the file is cut off
pcapng-length-twice = { $where }: expected the length { $length } at its end too, got { $again }
pcapng-interface = { $where }: expected an interface of at least 8 bytes, got { $count }
pcapng-packet = { $where }: expected a packet of at least { $size } bytes, got { $count }
pcapng-interface-number = { $where }: expected one of { $count } interfaces, got number { $number }
pcapng-packet-large = { $where }: expected at most { $most } bytes of a packet, got { $captured }
pcapng-interfaces = { $where }: expected at most { $max_interfaces } interfaces

## Packets of LiDARs

packets-none = { $paths }: no data packets of a LiDAR that is read; found: { $found }
hesai-angles-missing = there is no row channel,elevation,azimuth
hesai-angles-channel = row { $number }: is of channel { $channel }
hesai-angles-number = row { $number }: elevation { $elevation } or azimuth { $azimuth } is no angle
hesai-angles-row = row { $number }: expected channel,elevation,azimuth, got { $cells }
hesai-needs-angles = { $name }: a { $model } needs its angle correction file beside the recording or the rig file: a table Channel,Elevation,Azimuth with { $channels } rows
packets-no-decoder = { $name }: no packet decoder for model { QUOTED($model) }; decoded: { $known }
hesai-channels = { $name }: its packets hold { $got } channels ({ $got_model }), a { $model } has { $expected }
hesai-at128-angles = { $name }: an AT128 needs its angle correction file (.dat, version 1.5) beside the recording or the rig file; a table of text (.csv) has no positions of its mirrors
livox-no-packet = { $sensor }: no data packet of a Livox at the head of the recording: its data type is not known
livox-no-decoder = no packet decoder for Livox model { QUOTED($name) }; decoded: { $models }
livox-sdk = { $sensor }: its packets are of Livox SDK{ $sdk } ({ $sent }), the rig says { $name }
lvx-no-packet = { $file }: an LVX file without any packet
lvx-magic = { $name }: an LVX file begins with { $magic }
lvx-version = { $name }: LVX { $major }.{ $minor }; read are 1.0, 1.1 and 2.0
lvx-devices-cut = { $name }: { $count } devices expected, the file ends in their list
ouster-columns-unknown = { $metadata }: neither lidar_mode nor columns_per_frame, and the packets do not show how many columns a revolution has
ouster-object = { $name }: expected a JSON object, got { $kind }
ouster-angles-count = { $values }: { $angles }: expected 1 to { $max_beams } numbers, got { $beams }
ouster-azimuths = { $values }: beam_azimuth_angles: expected { $beams } numbers, got none
ouster-profile = { $values }: udp_profile_lidar { QUOTED($name) } is not known; decoded: { $profiles }
ouster-beams-differ = { $values }: { $beams } angles of beams, but { $stated } pixels per column
ouster-packet-size = { $values }: { $columns } columns of { $beams } pixels do not fit into a packet
ouster-value-kind = { $name }: a value of the wrong kind: { $why }
ouster-integer = { $name }: { $key }: expected a whole number from { $least } to { $most }, got { QUOTED($got) }
ouster-numbers = { $name }: { $key }: expected { $count } numbers of at most { SIGNIFICANT($limit, digits: 6) }
ouster-number = { $name }: { $key }: expected a number of at most { SIGNIFICANT($limit, digits: 6) }
ouster-rotation = { $name }: { $key }: its upper left 3 x 3 are no rotation
ouster-metadata-needed = { $sensor }: packets of an Ouster do not tell the angles of its beams: put the metadata json of the sensor beside the recording or the rig file (the driver and ouster-cli write it; http://SENSOR/api/v1/sensor/metadata; page: upload the folder with both, or for a live capture import it with the rig file on the page Rigs)
ouster-metadata-of-others = { $name } is of packets of { $bytes } bytes ({ $profile }, { $beams } beams, { $columns } columns), those here { $here ->
    [sizes] have { $sizes }
   *[contents] have that size and other contents
 }
ouster-metadata-choice = the packets of { $head } may be of the sensors of several metadata files: { $names }; leave the right one beside the recording, or put the address of the sensor into the name of its file
robosense-needs-angles = packets of a { $model } need the angles of its { $lasers } lasers: record its device packets (DIFOP, port 7788) too, or put a csv file with a row of elevation and azimuth [°] per laser beside the recording or the rig file, or into the rig as its description
robosense-no-decoder = no packet decoder for RoboSense model { QUOTED($name) }; decoded: { $known }
velodyne-no-decoder = no packet decoder for sensor model { QUOTED($name) }; decoded: { $known }
hdl64-needs-calibration = { $name }: packets of an HDL-64E need the calibration of the very sensor: put the YAML of the ROS driver (a row laser_id, rot_correction, vert_correction, … of each of 64 lasers) or the db.xml of VeloView beside the recording or the rig file

## Clouds and tables

kitti-bin-size = { $name }: a KITTI BIN file has 16 bytes a point (x y z intensity as float32), or 20 or 24 (also ring, time), got { $size } bytes, { $excess } too many for 16
carmen-none = { $file }: no scan of a laser; expected lines that begin with { $messages }
carmen-many = { $file }: expected at most { $max_scans } scans and { $max_values } ranges
cloud-cut = { $name }: cut: { $rows } points of { $row_bytes } bytes need { $needed } bytes behind the header, got { $left }
cloud-line-width = { $where }: { $width } numbers a line expected, got { $shape }
cloud-value-range = { $where }: expected { $min } to { $max }, got { SIGNIFICANT($bad, digits: 6) }
cloud-unpacked-size = { $name }: { $rows } points are { $expected } bytes, the compressed block of { $packed } bytes says { $unpacked }
cloud-block-large = { $name }: expected a compressed block of at most { $max_frame_bytes } bytes, got { $packed } bytes that unpack to { $unpacked }
cloud-block-damaged = { $name }: the compressed block is damaged
cloud-promised = { $name }: cut: { $count } bytes promised, got { $left }
cloud-promised-got = { $name }: cut: { $expected } bytes promised, got { $got }
cloud-frame-large = { $file }: expected at most { $max_frame_bytes } bytes of points in one frame, got { $rows } points of { $row_bytes } bytes
cloud-lines-cut = { $name }: cut: { $rows } points promised, got { $done } lines
cloud-line-long = { $name }: expected lines of at most { $line_bytes } bytes, got a longer one
cloud-no-numbers = { $where }: not a table of numbers: { $why }
pcd-size = { $name }: PCD header: WIDTH x HEIGHT is { $grid }, POINTS is { $rows }
pcd-data = { $name }: PCD DATA: expected ascii, binary or binary_compressed, got { QUOTED($encoding) }
ply-endless = { $name }: the PLY header does not end
ply-vertex-missing = { $name }: a PLY header needs a format and an element vertex
ply-vertex-first = { $name }: the first PLY element must be vertex: { QUOTED($element) }
ply-element-twice = { $name }: PLY header: expected one element { $element }, got two
ply-vertex-list = { $name }: PLY header: expected vertices with single values, got the list { QUOTED($words) }
cloud-fields-count = { $name }: expected 1 to { $max_fields } fields, got { $count }
cloud-values-count = { $name }: expected 1 to { $max_count } values a field and at most { $max_row_bytes } bytes a point, got { $counts } and { $row_bytes }
pcd-header = { $name }: the PCD header makes no sense: { $why }
pcd-no-data = { $name }: the PCD header ends before its DATA line
pcd-line-twice = { $name }: PCD header: expected one line { $line }, got two
ply-header = { $name }: the PLY header makes no sense: { $why }
message-cloud-size = a cloud of { $width } x { $height } points of { $step } bytes in rows of { $row_step } does not fit into { $count } bytes
message-cloud-large = a cloud of { $width } x { $height } points: expected at most { $max_cloud_points }
message-cloud-fields = the fields of a cloud do not fit into { $step } bytes: { $why }
columns-missing = { $file }: missing columns { $missing }; expected { $required }
columns-no-rows = { $file }: no rows under the names of the columns
npz-large = { $name }: expected at most { $max_npz_bytes } bytes, got { $size }
columns-expansion = { $file }: expected columns of at most { $most } bytes, { $expansion } times the file, got { $size }
array-version = { $where }: { $name }: expected an array of version 1 or 2, got { $version }
array-shape = { $where }: { $name }: expected { $what } of one row, got { $dtype } of { $shape }
array-size = { $where }: { $name }: { $count } values of { $dtype } need { $needed } bytes, got { $got }
array-cut = { $where }: { $column }: ends before its { $rows } values
column-time-range = { $where }: { $time } must be 0 to 2^63, got { $values }
column-twice = { $file }: line 1: expected each column once, got { $twice } twice
columns-unreadable = { $file }: expected columns as arrays: { $why }
columns-lengths = { $file }: expected columns of one length, got { $lengths }
row-cells = { $name }: line { $number }: expected { $width } cells, got { $count }
lines-damaged-many = { $first } ({ $number } of { $total } lines are damaged; up to { DECIMAL($max_ratio, digits: 0) } % are dropped)
e57-coordinates = { $name }: scan { $number }: expected Cartesian or spherical coordinates, got { $point_fields }
e57-more-points = { $name }: scan { $number } has more points than promised
xml-doctype = it has a document type (DOCTYPE), which a reader would fetch
xml-instruction = it has a processing instruction ({ QUOTED($target) })
e57-checksum = wrong checksum of page { $first }{ $count ->
    [0] {""}
   *[other] , and { $count } others
 }
xml-encoding = expected the encoding UTF-8, got { QUOTED($encoding) }
e57-xml = { $file }: XML section: { $why }
e57-xml-unsound = { $file }: the XML section is not sound XML: { $why }
e57-header-cut = expected a header of { $size } bytes, got { $count }
e57-page-size = expected pages of { $page } bytes, got { $page_size }
e57-xml-large = { $length } bytes, at most { $max_xml_bytes }
e57-xml-begin = it begins in a checksum, at byte { $offset }
e57-xml-end = it ends at byte { $first } of { $size }
xml-deep = elements nested deeper than { $max_depth }
xml-elements = more than { $max_elements } elements
xml-attributes = <{ $name }> has more than { $max_attributes } attributes
xml-utf8 = expected UTF-8: { $reason } at byte { $start }
xml-schema = it names a schema, which a reader would fetch
laz-no-record = { $name }: expected a LASzip record in a compressed file, got none
las-cut = { $name }: cut: a LAS header has 227 bytes or more, got { $count }
las-version = { $name }: expected LAS 1.0 to 1.4, got { $major }.{ $minor }
las-layout = { $name }: expected a header of at least { $least } bytes, then points, then the end at { $size }; got a header of { $header_bytes } bytes and points at { $data_at }
las-point-format = { $name }: expected a point format 0 to 10 and its length, got format { $point_format } of { $point_bytes } bytes
laz-record-short = { $name }: a LASzip record has 34 bytes or more, got { $count }
laz-compressor = { $name }: expected LASzip's compressor 2 or 3 and coder 0, got { $compressor }, { $coder }
laz-items = { $name }: expected 1 to { $max_items } LASzip items, got { $items } in { $size } bytes
laz-items-size = { $name }: points have { $point_bytes } bytes, the LASzip items { $items }
laz-chunk-points = { $name }: expected chunks of 1 to { $max_chunk_points } points, got { $chunk_points }
laz-layers = { $name }: expected LASzip items 10 to 14 in layers, got { $unknown }
laz-no-chunk = { $name }: cut: { $points } points promised, got no chunk
laz-table-place = { $name }: expected the chunk table between { $first } and { $size }, got { $table_at }
laz-table = { $name }: expected a chunk table of version 0 with the chunks of { $points } points, got version { $version } with { $chunks } chunks
laz-chunks-many = { $name }: { $chunks } chunks promised in { $table_at } bytes
laz-points-differ = { $name }: { $promised } points promised, got { $got } in the chunks
las-bytes-cut = cut: { $expected } bytes expected at { $at }, got { $got }
las-points-cut = { $name }: cut: { $points } points of { $point_bytes } bytes need { $needed } bytes, got { $size }
las-points-twice = { $name }: the LAS header has { $points } points and { $legacy } legacy points
las-records-cut = { $name }: { $count } variable length records promised, got { $number } before the points
las-record-long = { $name }: variable length record { $number } has { $length } bytes and reaches into the points by { $at }
laz-chunks-cut = { $name }: cut: { $chunks } chunks promised, got { $chunk }
laz-layers-long = { $name }: the layers of chunk { $chunk } reach beyond the chunks by { $at } bytes
points-cut = { $file }: cut: { $promised } points promised, got { $got }
las-points-many = { $name }: expected at most { $max_points } points, got { $points }
laz-expansion = { $file }: expected at most { $most } points in { $size } compressed bytes, got { $promised }
compression-unknown = { $where }: expected compression none, bz2, lz4 or zstd, got { QUOTED($how) }
unpacked-size = { $where }: expected { $expected } bytes when decompressed, got { $more }
unpacked-large = { $where }: expected { $compressed } compressed bytes to become at most { $most }, got a size of { $size }
unpacked-large-all = { $where }: expected { $compressed } compressed bytes to become at most { $most } in all, got more
offset-beyond = { $name }: expected an offset of at most { $size } bytes, got { $offset }
length-beyond = { $name }: { $what } at byte { $at }: expected at most { $most } bytes, got a length of { $length }
poses-none = { $file }: no poses
pose-quaternion = { $where }: a quaternion has length 1, got { SIGNIFICANT($norm, digits: 4) }
pose-not-finite = { $where }: expected finite numbers, got one that is not
pose-time = { $where }: expected a time within 292 years of 1970, got { $text } s
pose-numbers = { $where }: expected 8 numbers, got { $count }: { QUOTED($cells) }
ptx-not-finite = { $where }: its transformation has numbers that are not finite
ptx-no-rotation = { $where }: its transformation is no rotation
ptx-size = { $where }: expected a number of columns or rows, got { $line }
ptx-line-long = { $where }: a line has { $line_bytes } bytes or more
ptx-head = { $where }: expected { $width } numbers in its head, got { $line }
ptx-points = { $where }: expected { $count } points, got { $got }
ptx-lines = { $where }: expected { $want } lines of points, got { $count }
ptx-many = { $where }: more than { $max_points } million points are promised
ptx-no-numbers = { $where }: no line of numbers: { $why }
reference-large = { $file } has { $size } GiB, at most { $cloud_file_bytes }
reference-no-points = { $name } holds no points
reference-column = { $file }: no column { $missing }; it has { $fields }
reference-not-finite = { $name }: { $bad ->
    [one] { $bad } point has coordinates that are not numbers
   *[other] { $bad } points have coordinates that are not numbers
 }
reference-not-meters = { $name }: coordinates beyond 100 000 km are not meters
reference-many = { $name } has more than { $max_points } million points
reference-format = { $file }: expected a { $names }, XYZ or CSV cloud
scratch-no-room = { $base }: expected { SIZE($needed_bytes) } of free space for a temporary copy, got { SIZE($free_bytes) } (the variable TMPDIR names another place)
scratch-not-own = { $base } does not belong to this user alone: remove it
text-large = { $file }: expected at most { $most } bytes of text, got more
text-lines-many = { $file }: expected at most { $max_log_lines } lines, got more
three-dtk-pose = { $file }: expected a position and three angles, got { $words }
three-dtk-line = { $where }: expected three to six numbers, got { QUOTED($line) }
three-dtk-row = { $where }: expected { $width } numbers, got { QUOTED($line) }
pose-times = { $where }: times must increase
time-line = { $name }, line { $line }: expected seconds or a date, got { QUOTED($text) }
npz-cut = { $name }: expected an archive with a directory, got none: the file is cut off
npz-directory = { $name }: expected an archive with a directory of at most { $most } bytes, got { $got }
cloud-types = a cloud with fields of unknown types: { $fields }: expected 1 to { $most }
e57-unsound = { $name }: not a sound E57 file: { $why }
zstd-unreadable = { $file }: no readable zstd file: { $why }

## Tables of people

table-csv = { $file }: cannot be read as CSV: { $why }
table-cells = { $file }: line { $number }: expected { $width } cells, got { $count }: { QUOTED($row) }
table-columns = columns: expected x, y and z once each (or lat, lon and z), as in id,x,y,z; got { $columns }
table-column-word = columns: expected x, y, z, -x, -y, lat, lon, id, role, radius or -, got { QUOTED($word) }
table-question = { $name }: { $question } { $answer }; the first row is { $rows }
dxf-binary = { $name }: expected a DXF as text (ASCII), got a binary one: save it so
dxf-cut = { $name }: cut: expected EOF as its last line, got { $data }
dxf-unit = { $name }: expected meters, feet or another known unit, got unit { $code }
dxf-no-points = { $name }: expected points, or blocks with attributes, got a DXF without
dxf-unreadable = { $name }: cannot be read as DXF: { $said }
table-rows = { $name }: expected rows with three numbers or more, got { QUOTED($seen) }
table-row-wrong = { $name }: line { $line }: { QUOTED($cells) }: { $why }
line-wrong = { $name }: line { $line }: { $why }: { QUOTED($row) }
table-no-point = { $name }: behind line { $line }: expected x, y, z as numbers
cell-number = expected a number, got { QUOTED($cell) }
cell-degrees = expected degrees with decimals, as 49.0203, got { QUOTED($cell) }
cell-grouped = expected numbers without thousands separators, got { QUOTED($cell) }
cells-few = expected { $least } or more numbers

## IMU and GNSS

sbet-not-finite = { $file }: row { $bad }: expected finite numbers, got { $rows }
sbet-cut = { $file }: cut: expected rows of { $columns } bytes, got { $size } bytes
gnss-no-position = { $file }: no position under the names of its columns
gnss-time = { $file }: expected UTCTime in seconds since 1970, or with a date, got { DECIMAL($t_ns, digits: 3) }: export GPSTime with Week
gnss-height-column = { $name }: expected a column H-Ell or H-MSL, got { $got }
gnss-checksums = expected messages of a receiver, got { $most } with a wrong checksum up to byte { $begin }
rtklib-none = { $file }: no solution under the comments
rtklib-time-system = { $name }: expected times in GPST, UTC or JST, got { QUOTED($time) }
rtklib-no-base = { $name }: positions are east, north, up of a baseline; expected the position of the base in a comment 'ref pos', got none
rtklib-base = { $name }: expected a base on the earth in the comment 'ref pos', got { SIGNIFICANT($lat, digits: 6) }, { SIGNIFICANT($lon, digits: 6) }
samples-not-covering = { $what } samples cover { DECIMAL($first_s, digits: 3) } … { DECIMAL($last_s, digits: 3) } s, the points { DECIMAL($points_first_s, digits: 3) } … { DECIMAL($points_last_s, digits: 3) } s: are the clocks the same? If both begin together, they differ by { $ahead }: give [{ $table }] time_offset_s = { DECIMAL($offset_s, digits: 3) } in the rig file
samples-none = { $file }: no samples under the header
samples-header-empty = { $name }: line 1 is empty; expected header: { $known }
samples-columns = { $name }: missing columns { $missing }; expected header: { $known }; got { $line }
samples-cells = { $where }: expected { $expected } cells, got { $got }
samples-degrees = { $where }: latitude and longitude must be in degrees, got { SIGNIFICANT($lat, digits: 6) }, { SIGNIFICANT($lon, digits: 6) }
samples-whole-ns = { $where }: t_ns must be whole nanoseconds, got { QUOTED($text) }
samples-time-range = { $where }: t_ns must be 0 to 2^63, got { $digits }
samples-csv = { $where }: expected cells of a CSV: { $why }
samples-number = { $where }: expected a number, got { QUOTED($text) }

## Recordings

stamps-backward = { $topic }: the recording runs backward: each stamp is earlier than the one before. Give the original recording, or a copy in the order of its stamps
cloud-axes-missing = { $name }: a cloud needs x, y and z; it has { $table }
points-unit-known = { $sensor }: the fields say the unit of the points ({ $fields }): expected no ingest.points_unit_m, got { SIGNIFICANT($points_unit_m, digits: 6) }
time-field-type = { $name }: time field of type { $dtype }
frames-none = { $file }: no { $cloud_suffixes } file in the folder
frames-mixed = { $file }: frames of one kind expected, got { $kinds }
head-still = { $name }: expected a head that turns, got an angle of { DECIMAL($angle_deg, digits: 2) }° all the time: its encoder is stuck, or the head did not turn
laser-no-range = the scans have not one range above 0
carmen-one = one CARMEN log expected, got { $count } files
laser-table-one = one table of a 2-D laser expected, got { $count } files
lines-none = { $name }: no line scans of { $sensor }; topics: { $topics }
head-joint-none = { $sensor }: expected a joint in { $topic } that moves its frame { $frame }, got none
head-angles-none = { $sensor }: the angles of its head are missing: expected topic { $topic } of type { $type }, got { $there }; a head may also move by a joint of /tf or of the robot description, or at a constant rate: head_rate_deg_s in the rig file
head-joints = { $topic }: expected the angle of one joint, got { $count } ({ $names }): with the robot description in the bag, the rig file names that as head_topic
mandeye-no-lidar = { $folder }: no LiDAR of the rig { QUOTED($rig) } is in it; it has the LiDARs { $there }, by number and serial number
line-tables-count = expected one table of line scans and at most one of a 2-D laser, got { $lines } and { $lasers }
line-tables-rig = { $name }: line scans need a rig with a sensor of kind profiler (page: field Rig; command: --rig): tables do not say where the sensors are mounted
head-column-missing = { $sensor }: the angles of its head are missing: expected a column head_deg in { $name }; with a head of constant rate, head_rate_deg_s in the rig file
laser-no-return = the scans have not one return
laser-ranges-unit = expected ranges in meters, got a median range of { SIGNIFICANT($median, digits: 3) }
laser-no-datagrams = { $files }: no datagrams of a 2-D laser
laser-no-scan-read = { $files }: no scan of the 2-D laser can be read
laser-port-shared = rig { $rig }: { $laser } and { $profiler } both send to port { $port }: give each its address = "…" in the rig file, or its own port
scan-ranges = a scan: expected 1 to { $beams } ranges, got { $count }
scan-angles = a scan: expected a first angle and a step between beams, got { $first } and { $step } rad
scan-angles-wide = a scan: expected angles within { SIGNIFICANT($max_angle_rad, digits: 6) } rad, got { SIGNIFICANT($widest, digits: 3) } rad
replay-transforms = { $recording }: datagrams have angles of a head, no transforms: { $text }
replay-lines = { $recording }: only lines that are { $laser_scan } can be sent, those of { $lines_topic } are { $kinds }
sweep-shots = { $where }: expected sweeps of at most { $beams } shots, where { $how }; got { $count }
folder-exists = { $folder } exists already: name a new folder
convert-needs-packets = { $recordings }: expected packets or messages of LiDARs, got { $kind }: they have no points of single sensors
mandeye-no-points = { $folder }: none of { $count } files lidar*.laz has points
file-no-points = { $file }: no points
mandeye-columns = { $name }: expected the columns { $needed }, no { $missing }
convert-far = { $file }: expected points within { DECIMAL($limit_m, digits: 0) } m, got { SIGNIFICANT($farthest_m, digits: 4) } m
frames-one-folder = give the folder of the frames, not several files or folders
frames-line-scans = { $file }: line scans are read from bags, tables or captures, got frames
frames-one-lidar = a folder of frames is one LiDAR, the rig { QUOTED($rig) } has { $count }
mandeye-one-folder = give one folder of a MANDEYE device, not several files or folders
recipe-no-number = { $role }: { QUOTED($column) } is no number, but { $dtype }
recipe-several-topics = fields { $recipe }: { $having } have these columns: say in a rig file which topic is meant (topic and fields of its [[sensor]])
recipe-no-topic = sensor { $sensor } of the rig: fields need the topic they are for, got none
recipe-and-rig = command: --fields and --rig: expected one of them; write { $recipe } into the [[sensor]] of the rig file
recipe-no-rig = command: --fields { $fields }: no rig for it: { $missing }
no-lidar-data = { $name }: no LiDAR data; { $lacking }

## Meshes and models

mesh-expected = { $file }: expected a triangle mesh (PLY, OBJ or STL)
mesh-vertex-number = { $where }: expected a vertex from 1 on, or back to 1, got { $number }
mesh-cut = { $file }: cut: expected endsolid at the end, behind { $facets } facets
mesh-elements = { $file }: expected a triangle mesh with the elements vertex and face, in this order, got { $elements }
mesh-no-xyz = { $file }: the vertices have no x, y, z
mesh-behind = { $file }: expected nothing behind the faces, got { $elements }
mesh-face-lists = { $name }: PLY faces need one list of corners, got { $count } properties
mesh-triangulate = { $file }: faces that are not triangles: triangulate the mesh
mesh-faces-cut = { $file }: cut: { $count } faces promised, got { $faces }
mesh-corners = { $where }: expected 3 to { $max_sides } corners, got { $count }
mesh-vertex-numbers = { $where }: expected numbers of vertices, got { $corners }
mesh-many = { $where }: expected at most { $max_triangles } triangles, got { $triangles }
mesh-vertex-word = { $where }: expected a vertex's number, got { QUOTED($word) }
mesh-stl-cut = { $file }: { $triangles } triangles need { $needed } bytes behind the header, got { $got }
mesh-face-type = { $name }: PLY faces of unknown type: { QUOTED($words) }
mesh-ply-cut = { $file }: { $count } triangles need { $needed } bytes behind the vertices, got { $left } (cut, or faces that are not triangles: triangulate the mesh)
mesh-face-numbers = { $where }: a face of { $sides } corners has { $expected } numbers, got { $got }
mesh-numbers = { $where }: expected { $count } numbers, got { QUOTED($words) }
mesh-face = { $where }: expected a face, got { QUOTED($words) }
mesh-facet = { $where }: expected a facet of 3 vertices, got { $inside }
mesh-stl-line = { $where }: expected a line of an STL file, got { QUOTED($line) }
model-none = no model file { $file }
model-empty = { $file }: expected a triangle mesh, found 0 triangles
model-corners = { $file }: triangles name corners that do not exist: expected 0 to { $most }, got { $low } to { $high }
model-not-finite = { $file }: corners have coordinates that are not numbers

## What is quoted, and further problems

topic-not-there = { $setting }: { QUOTED($topic) } is not in the recording, which has { $there }
no-such-topic = no topic of this kind
gnss-no-fix = { $file }: no fix in this log; expected NAV-PVT, BESTPOS, INSPVA or GGA messages with a position; { $counted }
gnss-no-message = no message of these kinds
laser-no-scan-of = { $name }: no scan of { $topic } can be read{ $why }
laser-any = a 2-D laser
packets-unknown = { $source }: these are packets of no LiDAR that is decoded; state its model in the rig file, or play the recording back through the driver and record the PointCloud2 that it publishes; decoded: { $known }
packets-mixed = { $source }: packets of two sensors of one model are mixed, and nothing in them tells the sensors apart ({ $why }): record each of them in a topic of its own, or to a port of its own
packets-no-datagram = { $file }: no UDP datagram in it; found: { $found }
found-nothing = nothing
recipe-columns-missing = no column { $missing }; there are { $there }
found-none = none
bag-no-points = the bag has no points
table-spread-columns = { $name }: expected the columns id, sE, sN, sH or id, cEE, cEN, cEH, cNN, cNH, cHH, got { $got }
no-column-names = no names
laser-table-no-scan = { $file }: no scan of a 2-D laser can be read
laser-table-angles = { $where }: expected angles that change from beam to beam, got none
laser-table-beams = { $where }: expected at most { $limit } beams, got { $got }
no-usable-points = no usable points ({ $counted })
nothing-read = nothing read
rig-expects = the rig { QUOTED($rig) } expects { $sensors }{ $more ->
    [some] {" "}…
   *[none] {""}
 }; the recording has { $found }; correct the rig, or give none; recon4 writes a rig of what is in the recording (command: recon4 info RECORDING --rig-out rig.toml; page: the upload offers it)
rig-expects-topic = { $name }: { $model } in { $topic }
rig-expects-port = { $name }: { $model } from { $address ->
    [any] any address
   *[other] { $address }
 } to port { $port }
rig-no-packets = no packets of a LiDAR
rig-topic-packets = { $topic }: packets of a { $model }
clocks-differ = the clocks of the LiDARs differ: { $ahead }. In the rig file give { $remedy }
clock-ahead = { $name } is ahead of { $first } by { $offset }
clock-remedy = { $name } time_offset_s = { $exact ->
    [about] about { $offset }
   *[exact] { $offset }
 }
points-unnamed =
    { $name }: the columns of the points have no common names; proposed for a rig file:
    { "  " }{ $proposed }
    Look at what is uncertain, then use it (page: Make a rig of these sensors; command: recon4 info RECORDING --rig-out rig.toml, then --rig rig.toml; or --fields { $fields })
rig-not-recorded = no LiDAR of the rig is in the recording: { $why }
rig-no-sensor-known = { $file }: no sensor is known to write a rig file of
rig-file-exists = { $file } exists: give a new file
