### Was an Aufzeichnungen, Punktwolken, Tabellen und Modellen falsch ist: jeder Text hat einen stabilen Code.

## Bags

bag-magic = { $file }: erwartet wird { $expected }, erhalten: { $got }
bag-encrypted = { $file }: die Datei ist verschlüsselt
bag-no-index = { $file }: die Datei hat keinen Index, die Aufnahme wurde nicht beendet
bag-topics-many = { $file }: erwartet werden höchstens { $max_topics } Topics, erhalten: { $connections }
bag-chunks-many = { $file }: erwartet werden höchstens { $most } Blöcke in einem Index von { $size } Byte, erhalten: { $chunks }
bag-chunk-twice = { $file }: der Index der Datei führt einen Block mehrmals auf
bag-connection-empty = { $file }: die Verbindung vor Byte { $at } hat keine Felder
bag-chunk-info-damaged = { $file }: die Angaben zum Block vor Byte { $at } sind beschädigt
bag-chunk-long = { $file }: Block bei Byte { $at }: erwartet werden höchstens { $index_at } Byte vor dem Index, erhalten: { $length }
bag-record-kind = { $file }: erwartet wird { $expected } bei Byte { $at }, erhalten: { $kind }
bag-record-header = { $file }: Kopf des Datensatzes vor Byte { $at }: erwartet werden { $size } Byte für { $name }, erhalten: { $count }
bag-metadata-large = { $metadata }: erwartet werden höchstens { $max_metadata_bytes } Byte, erhalten: { $size }
bag-folder-unreadable = { $folder }: kein lesbares rosbag2: { $why }
bag-version = { $metadata }: erwartet wird Version { $newest_version } oder älter und die Kompression file, message oder none, erhalten: Version { $version }, Kompression { QUOTED($mode) }
bag-compression = { $metadata }: erwartet wird die Kompression zstd, erhalten: { QUOTED($compression) }
bag-files-count = { $metadata }: erwartet werden 1 bis { $max_files } Dateien, erhalten: { $count }
bag-yaml = { $metadata }: kein lesbares YAML: { $reason }
bag-yaml-reference = { $metadata }, Zeile { $line }: erwartet wird kein Verweis, erhalten: *{ $anchor }
bag-yaml-deep = { $metadata }, Zeile { $line }: mehr als { $max_depth } Ebenen tief oder mehr als { $max_events } Werte
bag-description = { $metadata }: keine Beschreibung eines rosbag2: { $why }
bag-nothing-left = { $name }: beschädigt oder abgeschnitten, keine einzige Nachricht ist übrig
bag-files-absent = keine Datei aus { $metadata } ist da: { $names }
bag-files-unlisted = { $metadata } nennt { $names } nicht
bag-empty = { $names }: ein Bag ohne Nachrichten
mcap-checksum = { $where }: erwartet wird die Prüfsumme { $crc }, erhalten: { $raw }: die Daten wurden verändert
chunk-records-end = { $where }: erwartet werden Datensätze bis zum Ende bei { $count }, erhalten: { $at } Byte
chunk-index = { $name }: der Index der Datei führt einen Block bei Byte { $offset } auf: erwartet wird einer zwischen { $at } und { $end }, erhalten: { $length } Byte
db3-table = { $name }: erwartet wird eine Tabelle { $table }, erhalten: { $kinds } mit diesem Namen
db3-table-hides = { $name }: die Tabelle { $table } verbirgt die Nummern ihrer Zeilen
db3-unreadable = { $name }: keine lesbare SQLite-Datenbank: { $why }
db3-column = { $name }: erwartet wird eine Spalte { $column } in { $table }, erhalten: { $got }
db3-topics = { $name }: Tabelle topics: erwartet werden höchstens { $max_topics } Topics, jedes mit eigener Nummer, erhalten: { $number } nach { $count }
db3-no-topics = { $name }: die Tabelle topics ist leer: was die { $count } Nachrichten sind, ist nicht bekannt
mcap-summary = { $where }: erwartet werden Schemas, Blöcke und Statistik, nicht alles davon ist da
mcap-footer = { $file }: erwartet wird ein Fuß bei Byte { $footer_at }, er ist abgeschnitten
mcap-summary-place = { $file }: erwartet wird eine Übersicht von höchstens { $max_summary_bytes } Byte vor Byte { $footer_at }, erhalten: eine ab Byte { $start }
mcap-record-ends = { $where }: die Datei endet in einem Datensatz
mcap-record-long = { $where }: erwartet wird ein Datensatz von höchstens { $left } Byte, erhalten: { $length }
mcap-chunk-place = { $file }: erwartet wird ein Block von { $length } Byte bei Byte { $offset }, erhalten: ein Datensatz der Art { $op } mit { $got } Byte
mcap-chunk-differs = { $file }: Block bei Byte { $offset }: erwartet werden { $size } Byte ab { $t_first_ns } ns wie in der Übersicht, erhalten: { $got_size } ab { $got_first_ns }
mcap-chunk-times = { $file }: Block bei Byte { $offset }: seine Zeiten ergeben keinen Sinn
mcap-chunk-size = { $file }: Block bei Byte { $at }: erwartet werden { $end } Byte, erhalten: { $data }
mcap-record-unreadable = { $where }: ein Datensatz, der nicht lesbar ist ({ $why })
mcap-channel = { $where }: Statistik eines Kanals { $number }, den es nicht gibt
message-large = eine Nachricht { $kind }: erwartet werden höchstens { $most } Byte, erhalten: { $count }
message-fields-many = eine Punktwolke: erwartet werden höchstens { $max_fields } Felder, erhalten: { $count }
message-field-place = eine Punktwolke: erwartet wird ein Feld bei Byte { $end } eines Punkts oder dahinter, erhalten: { $offset }
message-header-cut = eine Punktwolke, die in ihrem Kopf endet: { $why }
schema-type-missing = eine Definition, in der der Typ { $kind } fehlt
schema-long = { $kind }: eine Definition von { $count } Zeichen
schema-fields = eine Definition mit { $count } Feldern
schema-wide-text = das Feld { $field } ist ein Text aus breiten Zeichen
schema-items = { $field }: { $count } Einträge, erwartet werden höchstens { $max_items }
schema-structures = eine Liste von { $count } Strukturen in { $size } Byte
schema-line = eine Definition mit der Zeile { QUOTED($line) }
schema-cycle = eine Definition, deren Typen einander oder zu viel enthalten: { $kind }
message-cut = eine Nachricht von { $count } Byte, die in einem Feld endet
message-no-field = eine Nachricht mit Punkten, der ein Feld fehlt: { $why }
db3-tree = { $file }: keine lesbare SQLite-Datenbank: erwartet wird ein Baum von Seiten, erhalten: Seite { $number } zweimal oder auf Ebene { $depth }; keine einzige Nachricht ist übrig
typestore-lacks = das Bag definiert { $kind } ohne { $missing }, womit seine Pakete gelesen werden: mit seinem Treiber abspielen und das PointCloud2 aufnehmen, das dieser veröffentlicht
urdf-large = erwartet werden höchstens { $max_urdf_bytes } Byte, erhalten: { $size }
urdf-numbers = { $what } eines Gelenks: erwartet werden { $count } Zahlen, erhalten: { QUOTED($text) }
xml-unsound = kein gültiges XML: { $why }
urdf-joints = mehr als { $max_joints } Gelenke

## Mitschnitte

pcap-no-packet = { $file }: ein Mitschnitt ohne ein einziges Paket{ $why }
pcap-header-cut = { $name }: im Kopf der Datei abgeschnitten, kein Paket ist übrig
pcap-link-type = { $name }: erwartet wird ein Mitschnitt von Ethernet-, Linux-cooked- oder rohen IP-Paketen, erhalten: Typ { $link_type }
pcap-magic = { $name }: erwartet wird ein Mitschnitt (pcap oder pcapng), die ersten Byte sind { $magic }
pcapng-order = { $where }: erwartet wird eine Markierung der Bytefolge, erhalten: { $magic }
pcapng-cut = { $where }: erwartet werden 8 Byte, erhalten: { $count }: die Datei ist abgeschnitten
pcapng-length = { $where }: erwartet wird eine Länge von 12 bis { $max_block_bytes } Byte in Schritten von 4, erhalten: { $length }
pcapng-block-cut = { $where }: erwartet werden { $length } Byte, erhalten: { $count }: die Datei ist abgeschnitten
pcapng-length-twice = { $where }: erwartet wird die Länge { $length } auch am Ende, erhalten: { $again }
pcapng-interface = { $where }: erwartet wird eine Schnittstelle von mindestens 8 Byte, erhalten: { $count }
pcapng-packet = { $where }: erwartet wird ein Paket von mindestens { $size } Byte, erhalten: { $count }
pcapng-interface-number = { $where }: erwartet wird eine von { $count } Schnittstellen, erhalten: Nummer { $number }
pcapng-packet-large = { $where }: erwartet werden höchstens { $most } Byte eines Pakets, erhalten: { $captured }
pcapng-interfaces = { $where }: erwartet werden höchstens { $max_interfaces } Schnittstellen

## Pakete von LiDARs

packets-none = { $paths }: keine Datenpakete eines LiDARs, das gelesen wird; gefunden: { $found }
hesai-angles-missing = es gibt keine Zeile channel,elevation,azimuth
hesai-angles-channel = Zeile { $number }: gehört zu Kanal { $channel }
hesai-angles-number = Zeile { $number }: Höhenwinkel { $elevation } oder Azimut { $azimuth } ist kein Winkel
hesai-angles-row = Zeile { $number }: erwartet wird channel,elevation,azimuth, erhalten: { $cells }
hesai-needs-angles = { $name }: ein { $model } braucht seine Winkelkorrektur neben der Aufzeichnung oder der Rig-Datei: eine Tabelle Channel,Elevation,Azimuth mit { $channels } Zeilen
packets-no-decoder = { $name }: die Pakete des Modells { QUOTED($model) } werden nicht dekodiert; dekodiert werden: { $known }
hesai-channels = { $name }: die Pakete enthalten { $got } Kanäle ({ $got_model }), ein { $model } hat { $expected }
hesai-at128-angles = { $name }: ein AT128 braucht seine Winkelkorrektur (.dat, Version 1.5) neben der Aufzeichnung oder der Rig-Datei; eine Texttabelle (.csv) enthält keine Positionen seiner Spiegel
livox-no-packet = { $sensor }: kein Datenpaket eines Livox am Anfang der Aufzeichnung: die Art seiner Daten ist nicht bekannt
livox-no-decoder = die Pakete des Livox-Modells { QUOTED($name) } werden nicht dekodiert; dekodiert werden: { $models }
livox-sdk = { $sensor }: die Pakete sind von Livox SDK{ $sdk } ({ $sent }), im Rig steht { $name }
lvx-no-packet = { $file }: eine LVX-Datei ohne ein einziges Paket
lvx-magic = { $name }: eine LVX-Datei beginnt mit { $magic }
lvx-version = { $name }: LVX { $major }.{ $minor }; gelesen werden 1.0, 1.1 und 2.0
lvx-devices-cut = { $name }: { $count } Geräte erwartet, die Datei endet in ihrer Liste
ouster-columns-unknown = { $metadata }: weder lidar_mode noch columns_per_frame, und die Pakete zeigen nicht, wie viele Spalten eine Umdrehung hat
ouster-object = { $name }: erwartet wird ein JSON-Objekt, erhalten: { $kind }
ouster-angles-count = { $values }: { $angles }: erwartet werden 1 bis { $max_beams } Zahlen, erhalten: { $beams }
ouster-azimuths = { $values }: beam_azimuth_angles: erwartet werden { $beams } Zahlen, sie fehlen
ouster-profile = { $values }: udp_profile_lidar { QUOTED($name) } ist nicht bekannt; dekodiert werden: { $profiles }
ouster-beams-differ = { $values }: { $beams } Winkel von Strahlen, aber { $stated } Pixel je Spalte
ouster-packet-size = { $values }: { $columns } Spalten mit { $beams } Pixeln passen nicht in ein Paket
ouster-value-kind = { $name }: ein Wert der falschen Art: { $why }
ouster-integer = { $name }: { $key }: erwartet wird eine ganze Zahl von { $least } bis { $most }, erhalten: { QUOTED($got) }
ouster-numbers = { $name }: { $key }: erwartet werden { $count } Zahlen von höchstens { SIGNIFICANT($limit, digits: 6) }
ouster-number = { $name }: { $key }: erwartet wird eine Zahl von höchstens { SIGNIFICANT($limit, digits: 6) }
ouster-rotation = { $name }: { $key }: oben links stehen 3 x 3 Zahlen, die keine Drehung sind
ouster-metadata-needed = { $sensor }: Pakete eines Ouster enthalten die Winkel seiner Strahlen nicht: die Metadaten (json) des Sensors neben die Aufzeichnung oder die Rig-Datei legen (der Treiber und ouster-cli schreiben sie; http://SENSOR/api/v1/sensor/metadata; Seite: den Ordner mit beidem hochladen, oder für eine Live-Aufnahme auf der Seite Rigs mit der Rig-Datei importieren)
ouster-metadata-of-others = { $name } ist von Paketen mit { $bytes } Bytes ({ $profile }, { $beams } Strahlen, { $columns } Spalten), die Pakete hier { $here ->
    [sizes] haben { $sizes }
   *[contents] haben dieselbe Größe und anderen Inhalt
 }
ouster-metadata-choice = die Pakete von { $head } können von den Sensoren mehrerer Metadaten-Dateien sein: { $names }; nur die richtige neben der Aufzeichnung lassen, oder die Adresse des Sensors in den Namen seiner Datei schreiben
robosense-needs-angles = Pakete eines { $model } brauchen die Winkel seiner { $lasers } Laser: auch seine Gerätepakete aufnehmen (DIFOP, Port 7788), oder eine CSV-Datei mit einer Zeile aus Höhenwinkel und Azimut [°] je Laser neben die Aufzeichnung oder die Rig-Datei legen, oder als description in das Rig schreiben
robosense-no-decoder = die Pakete des RoboSense-Modells { QUOTED($name) } werden nicht dekodiert; dekodiert werden: { $known }
velodyne-no-decoder = die Pakete des Modells { QUOTED($name) } werden nicht dekodiert; dekodiert werden: { $known }
hdl64-needs-calibration = { $name }: Pakete eines HDL-64E brauchen die Kalibrierung genau dieses Sensors: die YAML-Datei des ROS-Treibers (eine Zeile laser_id, rot_correction, vert_correction, … für jeden der 64 Laser) oder die db.xml von VeloView neben die Aufzeichnung oder die Rig-Datei legen

## Punktwolken und Tabellen

kitti-bin-size = { $name }: eine KITTI-BIN-Datei hat 16 Byte je Punkt (x y z intensity als float32), oder 20 oder 24 (auch ring, time), erhalten: { $size } Byte, { $excess } zu viel für 16
carmen-none = { $file }: kein Scan eines Lasers; erwartet werden Zeilen, die mit { $messages } beginnen
carmen-many = { $file }: erwartet werden höchstens { $max_scans } Scans und { $max_values } Entfernungen
cloud-cut = { $name }: abgeschnitten: { $rows } Punkte zu je { $row_bytes } Byte brauchen { $needed } Byte nach dem Kopf, erhalten: { $left }
cloud-line-width = { $where }: erwartet werden { $width } Zahlen je Zeile, erhalten: { $shape }
cloud-value-range = { $where }: erwartet werden { $min } bis { $max }, erhalten: { SIGNIFICANT($bad, digits: 6) }
cloud-unpacked-size = { $name }: { $rows } Punkte sind { $expected } Byte, der komprimierte Block von { $packed } Byte nennt { $unpacked }
cloud-block-large = { $name }: erwartet wird ein komprimierter Block von höchstens { $max_frame_bytes } Byte, erhalten: { $packed } Byte, die { $unpacked } ergeben
cloud-block-damaged = { $name }: der komprimierte Block ist beschädigt
cloud-promised = { $name }: abgeschnitten: { $count } Byte angekündigt, erhalten: { $left }
cloud-promised-got = { $name }: abgeschnitten: { $expected } Byte angekündigt, erhalten: { $got }
cloud-frame-large = { $file }: erwartet werden höchstens { $max_frame_bytes } Byte Punkte in einem Scan, erhalten: { $rows } Punkte zu je { $row_bytes } Byte
cloud-lines-cut = { $name }: abgeschnitten: { $rows } Punkte angekündigt, erhalten: { $done } Zeilen
cloud-line-long = { $name }: erwartet werden Zeilen von höchstens { $line_bytes } Byte, eine ist länger
cloud-no-numbers = { $where }: keine Tabelle aus Zahlen: { $why }
pcd-size = { $name }: PCD-Kopf: WIDTH x HEIGHT ist { $grid }, POINTS ist { $rows }
pcd-data = { $name }: PCD DATA: erwartet wird ascii, binary oder binary_compressed, erhalten: { QUOTED($encoding) }
ply-endless = { $name }: der PLY-Kopf endet nicht
ply-vertex-missing = { $name }: ein PLY-Kopf braucht ein Format und ein Element vertex
ply-vertex-first = { $name }: das erste PLY-Element muss vertex sein: { QUOTED($element) }
ply-element-twice = { $name }: PLY-Kopf: erwartet wird ein Element { $element }, erhalten: zwei
ply-vertex-list = { $name }: PLY-Kopf: erwartet werden Vertices mit einzelnen Werten, erhalten: die Liste { QUOTED($words) }
cloud-fields-count = { $name }: erwartet werden 1 bis { $max_fields } Felder, erhalten: { $count }
cloud-values-count = { $name }: erwartet werden 1 bis { $max_count } Werte je Feld und höchstens { $max_row_bytes } Byte je Punkt, erhalten: { $counts } und { $row_bytes }
pcd-header = { $name }: der PCD-Kopf ergibt keinen Sinn: { $why }
pcd-no-data = { $name }: der PCD-Kopf endet vor seiner Zeile DATA
pcd-line-twice = { $name }: PCD-Kopf: erwartet wird eine Zeile { $line }, erhalten: zwei
ply-header = { $name }: der PLY-Kopf ergibt keinen Sinn: { $why }
message-cloud-size = eine Punktwolke von { $width } x { $height } Punkten zu { $step } Byte in Zeilen von { $row_step } passt nicht in { $count } Byte
message-cloud-large = eine Punktwolke von { $width } x { $height } Punkten: erwartet werden höchstens { $max_cloud_points }
message-cloud-fields = die Felder einer Punktwolke passen nicht in { $step } Byte: { $why }
columns-missing = { $file }: es fehlen die Spalten { $missing }; erwartet werden { $required }
columns-no-rows = { $file }: keine Zeilen unter den Namen der Spalten
npz-large = { $name }: erwartet werden höchstens { $max_npz_bytes } Byte, erhalten: { $size }
columns-expansion = { $file }: erwartet werden Spalten von höchstens { $most } Byte, dem { $expansion }-fachen der Datei, erhalten: { $size }
array-version = { $where }: { $name }: erwartet wird ein Array der Version 1 oder 2, erhalten: { $version }
array-shape = { $where }: { $name }: erwartet werden { $what } in einer Dimension, erhalten: { $dtype } der Form { $shape }
array-size = { $where }: { $name }: { $count } Werte vom Typ { $dtype } brauchen { $needed } Byte, erhalten: { $got }
array-cut = { $where }: { $column }: endet vor den angekündigten { $rows } Werten
column-time-range = { $where }: { $time } muss 0 bis 2^63 sein, erhalten: { $values }
column-twice = { $file }: Zeile 1: erwartet wird jede Spalte einmal, zweimal erhalten: { $twice }
columns-unreadable = { $file }: erwartet werden Spalten als Arrays: { $why }
columns-lengths = { $file }: erwartet werden gleich lange Spalten, erhalten: { $lengths }
row-cells = { $name }: Zeile { $number }: erwartet werden { $width } Zellen, erhalten: { $count }
lines-damaged-many = { $first } ({ $number } von { $total } Zeilen sind beschädigt; bis zu { DECIMAL($max_ratio, digits: 0) } % werden weggelassen)
e57-coordinates = { $name }: Scan { $number }: erwartet werden kartesische oder sphärische Koordinaten, erhalten: { $point_fields }
e57-more-points = { $name }: Scan { $number } hat mehr Punkte als angekündigt
xml-doctype = sie hat einen Dokumenttyp (DOCTYPE), den ein Leser aus dem Netz holen würde
xml-instruction = sie hat eine Verarbeitungsanweisung ({ QUOTED($target) })
e57-checksum = falsche Prüfsumme der Seite { $first }{ $count ->
    [0] {""}
   *[other] , und { $count } weitere
 }
xml-encoding = erwartet wird die Kodierung UTF-8, erhalten: { QUOTED($encoding) }
e57-xml = { $file }: XML-Teil: { $why }
e57-xml-unsound = { $file }: der XML-Teil ist kein gültiges XML: { $why }
e57-header-cut = erwartet wird ein Kopf von { $size } Byte, erhalten: { $count }
e57-page-size = erwartet werden Seiten von { $page } Byte, erhalten: { $page_size }
e57-xml-large = { $length } Byte, höchstens { $max_xml_bytes }
e57-xml-begin = er beginnt in einer Prüfsumme, bei Byte { $offset }
e57-xml-end = er endet bei Byte { $first } von { $size }
xml-deep = Elemente tiefer als { $max_depth } Ebenen
xml-elements = mehr als { $max_elements } Elemente
xml-attributes = <{ $name }> hat mehr als { $max_attributes } Attribute
xml-utf8 = erwartet wird UTF-8: { $reason } bei Byte { $start }
xml-schema = er nennt ein Schema, das ein Leser aus dem Netz holen würde
laz-no-record = { $name }: erwartet wird ein LASzip-Eintrag in einer komprimierten Datei, er fehlt
las-cut = { $name }: abgeschnitten: ein LAS-Kopf hat mindestens 227 Byte, erhalten: { $count }
las-version = { $name }: erwartet wird LAS 1.0 bis 1.4, erhalten: { $major }.{ $minor }
las-layout = { $name }: erwartet wird ein Kopf von mindestens { $least } Byte, dann Punkte, dann das Ende bei { $size }; erhalten: ein Kopf von { $header_bytes } Byte und Punkte bei { $data_at }
las-point-format = { $name }: erwartet wird ein Punktformat 0 bis 10 und seine Länge, erhalten: Format { $point_format } mit { $point_bytes } Byte
laz-record-short = { $name }: ein LASzip-Eintrag hat mindestens 34 Byte, erhalten: { $count }
laz-compressor = { $name }: erwartet wird der LASzip-Kompressor 2 oder 3 mit Kodierer 0, erhalten: { $compressor }, { $coder }
laz-items = { $name }: erwartet werden 1 bis { $max_items } LASzip-Felder, erhalten: { $items } in { $size } Byte
laz-items-size = { $name }: Punkte haben { $point_bytes } Byte, die LASzip-Felder { $items }
laz-chunk-points = { $name }: erwartet werden Blöcke von 1 bis { $max_chunk_points } Punkten, erhalten: { $chunk_points }
laz-layers = { $name }: erwartet werden LASzip-Felder 10 bis 14 in Schichten, erhalten: { $unknown }
laz-no-chunk = { $name }: abgeschnitten: { $points } Punkte angekündigt, kein Block erhalten
laz-table-place = { $name }: erwartet wird die Blocktabelle zwischen { $first } und { $size }, erhalten: { $table_at }
laz-table = { $name }: erwartet wird eine Blocktabelle der Version 0 mit den Blöcken von { $points } Punkten, erhalten: Version { $version } mit { $chunks } Blöcken
laz-chunks-many = { $name }: { $chunks } Blöcke angekündigt in { $table_at } Byte
laz-points-differ = { $name }: { $promised } Punkte angekündigt, in den Blöcken sind { $got }
las-bytes-cut = abgeschnitten: { $expected } Byte erwartet bei { $at }, erhalten: { $got }
las-points-cut = { $name }: abgeschnitten: { $points } Punkte zu { $point_bytes } Byte brauchen { $needed } Byte, erhalten: { $size }
las-points-twice = { $name }: der LAS-Kopf nennt { $points } Punkte und im alten Feld { $legacy }
las-records-cut = { $name }: { $count } VLR-Einträge (variable length records) angekündigt, vor den Punkten sind { $number }
las-record-long = { $name }: VLR-Eintrag { $number } hat { $length } Byte und reicht { $at } Byte in die Punkte
laz-chunks-cut = { $name }: abgeschnitten: { $chunks } Blöcke angekündigt, erhalten: { $chunk }
laz-layers-long = { $name }: die Schichten von Block { $chunk } reichen { $at } Byte über die Blöcke hinaus
points-cut = { $file }: abgeschnitten: { $promised } Punkte angekündigt, erhalten: { $got }
las-points-many = { $name }: erwartet werden höchstens { $max_points } Punkte, erhalten: { $points }
laz-expansion = { $file }: erwartet werden höchstens { $most } Punkte in { $size } komprimierten Byte, erhalten: { $promised }
compression-unknown = { $where }: erwartet wird die Kompression none, bz2, lz4 oder zstd, erhalten: { QUOTED($how) }
unpacked-size = { $where }: erwartet werden { $expected } Byte nach dem Entpacken, erhalten: { $more }
unpacked-large = { $where }: erwartet wird, dass { $compressed } komprimierte Byte höchstens { $most } ergeben, erhalten: eine Größe von { $size }
unpacked-large-all = { $where }: erwartet wird, dass { $compressed } komprimierte Byte zusammen höchstens { $most } ergeben, es sind mehr
offset-beyond = { $name }: erwartet wird eine Stelle von höchstens { $size } Byte, erhalten: { $offset }
length-beyond = { $name }: { $what } bei Byte { $at }: erwartet werden höchstens { $most } Byte, erhalten: eine Länge von { $length }
poses-none = { $file }: keine Posen
pose-quaternion = { $where }: ein Quaternion hat die Länge 1, erhalten: { SIGNIFICANT($norm, digits: 4) }
pose-not-finite = { $where }: erwartet werden endliche Zahlen, eine ist es nicht
pose-time = { $where }: erwartet wird eine Zeit innerhalb von 292 Jahren um 1970, erhalten: { $text } s
pose-numbers = { $where }: erwartet werden 8 Zahlen, erhalten: { $count }: { QUOTED($cells) }
ptx-not-finite = { $where }: die Transformation hat Zahlen, die nicht endlich sind
ptx-no-rotation = { $where }: die Transformation ist keine Drehung
ptx-size = { $where }: erwartet wird eine Zahl von Spalten oder Zeilen, erhalten: { $line }
ptx-line-long = { $where }: eine Zeile hat { $line_bytes } Byte oder mehr
ptx-head = { $where }: erwartet werden { $width } Zahlen im Kopf, erhalten: { $line }
ptx-points = { $where }: erwartet werden { $count } Punkte, erhalten: { $got }
ptx-lines = { $where }: erwartet werden { $want } Zeilen mit Punkten, erhalten: { $count }
ptx-many = { $where }: mehr als { $max_points } Millionen Punkte sind angekündigt
ptx-no-numbers = { $where }: keine Zeile aus Zahlen: { $why }
reference-large = { $file } hat { $size } GiB, höchstens { $cloud_file_bytes }
reference-no-points = { $name } enthält keine Punkte
reference-column = { $file }: keine Spalte { $missing }; vorhanden: { $fields }
reference-not-finite = { $name }: { $bad ->
    [one] { $bad } Punkt hat Koordinaten, die keine Zahlen sind
   *[other] { $bad } Punkte haben Koordinaten, die keine Zahlen sind
 }
reference-not-meters = { $name }: Koordinaten jenseits von 100 000 km sind keine Meter
reference-many = { $name } hat mehr als { $max_points } Millionen Punkte
reference-format = { $file }: erwartet wird eine Punktwolke in { $names }, XYZ oder CSV
scratch-no-room = { $base }: erwartet werden { SIZE($needed_bytes) } freier Speicher für eine vorübergehende Kopie, frei sind { SIZE($free_bytes) } (die Variable TMPDIR nennt einen anderen Ort)
scratch-not-own = { $base } gehört nicht nur diesem Konto: den Ordner entfernen
text-large = { $file }: erwartet werden höchstens { $most } Byte Text, es sind mehr
text-lines-many = { $file }: erwartet werden höchstens { $max_log_lines } Zeilen, es sind mehr
three-dtk-pose = { $file }: erwartet werden eine Position und drei Winkel, erhalten: { $words }
three-dtk-line = { $where }: erwartet werden drei bis sechs Zahlen, erhalten: { QUOTED($line) }
three-dtk-row = { $where }: erwartet werden { $width } Zahlen, erhalten: { QUOTED($line) }
pose-times = { $where }: die Zeiten müssen zunehmen
time-line = { $name }, Zeile { $line }: erwartet werden Sekunden oder ein Datum, erhalten: { QUOTED($text) }
npz-cut = { $name }: erwartet wird ein Archiv mit Verzeichnis, erhalten: keines, die Datei ist abgeschnitten
npz-directory = { $name }: erwartet wird ein Archiv mit einem Verzeichnis von höchstens { $most } Byte, erhalten: { $got }
cloud-types = eine Punktwolke mit Feldern unbekannter Typen: { $fields }: erwartet wird 1 bis { $most }
e57-unsound = { $name }: keine einwandfreie E57-Datei: { $why }
zstd-unreadable = { $file }: keine lesbare zstd-Datei: { $why }

## Tabellen von Personen

table-csv = { $file }: nicht als CSV lesbar: { $why }
table-cells = { $file }: Zeile { $number }: erwartet werden { $width } Zellen, erhalten: { $count }: { QUOTED($row) }
table-columns = Spalten: erwartet werden x, y und z je einmal (oder lat, lon und z), wie in id,x,y,z; erhalten: { $columns }
table-column-word = Spalten: erwartet wird x, y, z, -x, -y, lat, lon, id, role, radius oder -, erhalten: { QUOTED($word) }
table-question = { $name }: { $question } { $answer }; die erste Zeile ist { $rows }
dxf-binary = { $name }: erwartet wird eine DXF-Datei als Text (ASCII), erhalten: eine binäre: als Text speichern
dxf-cut = { $name }: abgeschnitten: erwartet wird EOF als letzte Zeile, erhalten: { $data }
dxf-unit = { $name }: erwartet werden Meter, Fuß oder eine andere bekannte Einheit, erhalten: Einheit { $code }
dxf-no-points = { $name }: erwartet werden Punkte oder Blöcke mit Attributen, die DXF-Datei hat keine
dxf-unreadable = { $name }: nicht als DXF lesbar: { $said }
table-rows = { $name }: erwartet werden Zeilen mit drei Zahlen oder mehr, erhalten: { QUOTED($seen) }
table-row-wrong = { $name }: Zeile { $line }: { QUOTED($cells) }: { $why }
line-wrong = { $name }: Zeile { $line }: { $why }: { QUOTED($row) }
table-no-point = { $name }: hinter Zeile { $line }: erwartet werden x, y, z als Zahlen
cell-number = erwartet wird eine Zahl, erhalten: { QUOTED($cell) }
cell-degrees = erwartet werden Grad mit Dezimalstellen, wie 49.0203, erhalten: { QUOTED($cell) }
cell-grouped = erwartet werden Zahlen ohne Tausendertrennzeichen, erhalten: { QUOTED($cell) }
cells-few = erwartet werden { $least } oder mehr Zahlen

## IMU und GNSS

sbet-not-finite = { $file }: Zeile { $bad }: erwartet werden endliche Zahlen, erhalten: { $rows }
sbet-cut = { $file }: abgeschnitten: erwartet werden Datensätze von { $columns } Byte, erhalten: { $size } Byte
gnss-no-position = { $file }: keine Position unter den Namen der Spalten
gnss-time = { $file }: erwartet wird UTCTime in Sekunden seit 1970 oder mit Datum, erhalten: { DECIMAL($t_ns, digits: 3) }: GPSTime mit Week exportieren
gnss-height-column = { $name }: erwartet wird eine Spalte H-Ell oder H-MSL, erhalten: { $got }
gnss-checksums = erwartet werden Meldungen eines Empfängers, erhalten: { $most } mit falscher Prüfsumme bis Byte { $begin }
rtklib-none = { $file }: keine Lösung unter den Kommentaren
rtklib-time-system = { $name }: erwartet werden Zeiten in GPST, UTC oder JST, erhalten: { QUOTED($time) }
rtklib-no-base = { $name }: die Positionen sind Ost, Nord, Höhe einer Basislinie; erwartet wird die Position der Basisstation in einem Kommentar 'ref pos', er fehlt
rtklib-base = { $name }: erwartet wird eine Basisstation auf der Erde im Kommentar 'ref pos', erhalten: { SIGNIFICANT($lat, digits: 6) }, { SIGNIFICANT($lon, digits: 6) }
samples-not-covering = Werte für { $what } decken { DECIMAL($first_s, digits: 3) } … { DECIMAL($last_s, digits: 3) } s ab, die Punkte { DECIMAL($points_first_s, digits: 3) } … { DECIMAL($points_last_s, digits: 3) } s: gehen die Uhren gleich? Wenn beide gleichzeitig beginnen, unterscheiden sie sich um { $ahead }: [{ $table }] time_offset_s = { DECIMAL($offset_s, digits: 3) } in die Rig-Datei schreiben
samples-none = { $file }: keine Werte unter der Kopfzeile
samples-header-empty = { $name }: Zeile 1 ist leer; erwartet wird die Kopfzeile: { $known }
samples-columns = { $name }: es fehlen die Spalten { $missing }; erwartet wird die Kopfzeile: { $known }; erhalten: { $line }
samples-cells = { $where }: erwartet werden { $expected } Zellen, erhalten: { $got }
samples-degrees = { $where }: Breite und Länge müssen in Grad angegeben sein, erhalten: { SIGNIFICANT($lat, digits: 6) }, { SIGNIFICANT($lon, digits: 6) }
samples-whole-ns = { $where }: t_ns müssen ganze Nanosekunden sein, erhalten: { QUOTED($text) }
samples-time-range = { $where }: t_ns muss 0 bis 2^63 sein, erhalten: { $digits }
samples-csv = { $where }: erwartet werden Zellen einer CSV-Datei: { $why }
samples-number = { $where }: erwartet wird eine Zahl, erhalten: { QUOTED($text) }

## Aufzeichnungen

stamps-backward = { $topic }: die Aufzeichnung läuft rückwärts: jeder Zeitstempel liegt vor dem vorigen. Die ursprüngliche Aufzeichnung angeben, oder eine Kopie in der Reihenfolge ihrer Zeitstempel
cloud-axes-missing = { $name }: eine Punktwolke braucht x, y und z; vorhanden: { $table }
points-unit-known = { $sensor }: die Felder nennen die Einheit der Punkte ({ $fields }): ingest.points_unit_m wird nicht erwartet, erhalten: { SIGNIFICANT($points_unit_m, digits: 6) }
time-field-type = { $name }: Zeitfeld vom Typ { $dtype }
frames-none = { $file }: keine Datei { $cloud_suffixes } im Ordner
frames-mixed = { $file }: erwartet werden Scans einer Art, erhalten: { $kinds }
head-still = { $name }: erwartet wird ein Kopf, der sich dreht, erhalten: durchgehend { DECIMAL($angle_deg, digits: 2) }°: sein Encoder hängt, oder der Kopf drehte sich nicht
laser-no-range = die Scans haben keine einzige Entfernung über 0
carmen-one = erwartet wird ein CARMEN-Protokoll, erhalten: { $count } Dateien
laser-table-one = erwartet wird eine Tabelle eines 2-D-Lasers, erhalten: { $count } Dateien
lines-none = { $name }: keine Linienscans von { $sensor }; Topics: { $topics }
head-joint-none = { $sensor }: erwartet wird in { $topic } ein Gelenk, das den Rahmen { $frame } bewegt, erhalten: keines
head-angles-none = { $sensor }: die Winkel des Kopfes fehlen: erwartet wird das Topic { $topic } vom Typ { $type }, erhalten: { $there }; ein Kopf kann sich auch mit einem Gelenk von /tf oder der Beschreibung des Roboters bewegen, oder gleichmäßig: head_rate_deg_s in der Rig-Datei
head-joints = { $topic }: erwartet wird der Winkel eines Gelenks, erhalten: { $count } ({ $names }); mit der Beschreibung des Roboters in der Bag nennt die Rig-Datei dieses als head_topic
mandeye-no-lidar = { $folder }: kein LiDAR des Rigs { QUOTED($rig) } ist darin; da sind, mit Nummer und Seriennummer, die LiDARs { $there }
line-tables-count = erwartet wird eine Tabelle mit Linienscans und höchstens eine eines 2-D-Lasers, erhalten: { $lines } und { $lasers }
line-tables-rig = { $name }: Linienscans brauchen ein Rig mit einem Sensor der Art profiler (Seite: Feld Rig; Kommando: --rig): Tabellen sagen nicht, wo die Sensoren montiert sind
head-column-missing = { $sensor }: die Winkel des Kopfes fehlen: erwartet wird eine Spalte head_deg in { $name }; bei einem Kopf mit konstanter Drehrate head_rate_deg_s in der Rig-Datei
laser-no-return = die Scans haben kein einziges Echo
laser-ranges-unit = erwartet werden Entfernungen in Metern, erhalten: ein Median von { SIGNIFICANT($median, digits: 3) }
laser-no-datagrams = { $files }: keine Datagramme eines 2-D-Lasers
laser-no-scan-read = { $files }: kein Scan des 2-D-Lasers ist lesbar
laser-port-shared = Rig { $rig }: { $laser } und { $profiler } senden beide an Port { $port }: jedem in der Rig-Datei seine address = "…" oder einen eigenen Port geben
scan-ranges = ein Scan: erwartet werden 1 bis { $beams } Entfernungen, erhalten: { $count }
scan-angles = ein Scan: erwartet werden ein erster Winkel und ein Schritt zwischen Strahlen, erhalten: { $first } und { $step } rad
scan-angles-wide = ein Scan: erwartet werden Winkel innerhalb von { SIGNIFICANT($max_angle_rad, digits: 6) } rad, erhalten: { SIGNIFICANT($widest, digits: 3) } rad
replay-transforms = { $recording }: Datagramme haben Winkel eines Kopfes, keine Transformationen: { $text }
replay-lines = { $recording }: nur Linien vom Typ { $laser_scan } können gesendet werden, die von { $lines_topic } sind { $kinds }
sweep-shots = { $where }: erwartet werden Umdrehungen von höchstens { $beams } Schüssen, wo { $how }; erhalten: { $count }
folder-exists = { $folder } gibt es schon: einen neuen Ordner nennen
convert-needs-packets = { $recordings }: erwartet werden Pakete oder Nachrichten von LiDARs, erhalten: { $kind }: darin gibt es keine Punkte einzelner Sensoren
mandeye-no-points = { $folder }: keine von { $count } Dateien lidar*.laz enthält Punkte
file-no-points = { $file }: keine Punkte
mandeye-columns = { $name }: erwartet werden die Spalten { $needed }, es fehlt { $missing }
convert-far = { $file }: erwartet werden Punkte innerhalb von { DECIMAL($limit_m, digits: 0) } m, erhalten: { SIGNIFICANT($farthest_m, digits: 4) } m
frames-one-folder = den Ordner der Scans angeben, nicht mehrere Dateien oder Ordner
frames-line-scans = { $file }: Linienscans werden aus Bags, Tabellen oder Mitschnitten gelesen, erhalten: Einzelscans
frames-one-lidar = ein Ordner mit Scans ist ein LiDAR, das Rig { QUOTED($rig) } hat { $count }
mandeye-one-folder = einen Ordner eines MANDEYE-Geräts angeben, nicht mehrere Dateien oder Ordner
recipe-no-number = { $role }: { QUOTED($column) } ist keine Zahl, sondern { $dtype }
recipe-several-topics = fields { $recipe }: { $having } haben diese Spalten: in einer Rig-Datei angeben, welches Topic gemeint ist (topic und fields seines [[sensor]])
recipe-no-topic = Sensor { $sensor } des Rigs: fields braucht das Topic, für das es gilt, es fehlt
recipe-and-rig = Kommando: --fields und --rig: erwartet wird eines davon; { $recipe } in das [[sensor]] der Rig-Datei schreiben
recipe-no-rig = Kommando: --fields { $fields }: kein Rig dafür: { $missing }
no-lidar-data = { $name }: keine Daten eines LiDARs; { $lacking }

## Netze und Modelle

mesh-expected = { $file }: erwartet wird ein Dreiecksnetz (PLY, OBJ oder STL)
mesh-vertex-number = { $where }: erwartet wird ein Vertex ab 1, oder rückwärts bis 1, erhalten: { $number }
mesh-cut = { $file }: abgeschnitten: erwartet wird endsolid am Ende, nach { $facets } Facetten
mesh-elements = { $file }: erwartet wird ein Dreiecksnetz mit den Elementen vertex und face, in dieser Reihenfolge, erhalten: { $elements }
mesh-no-xyz = { $file }: die Vertices haben kein x, y, z
mesh-behind = { $file }: nach den Flächen wird nichts erwartet, erhalten: { $elements }
mesh-face-lists = { $name }: PLY-Flächen brauchen eine Liste von Ecken, erhalten: { $count } Eigenschaften
mesh-triangulate = { $file }: Flächen, die keine Dreiecke sind: das Netz triangulieren
mesh-faces-cut = { $file }: abgeschnitten: { $count } Flächen angekündigt, erhalten: { $faces }
mesh-corners = { $where }: erwartet werden 3 bis { $max_sides } Ecken, erhalten: { $count }
mesh-vertex-numbers = { $where }: erwartet werden Nummern von Vertices, erhalten: { $corners }
mesh-many = { $where }: erwartet werden höchstens { $max_triangles } Dreiecke, erhalten: { $triangles }
mesh-vertex-word = { $where }: erwartet wird die Nummer eines Vertex, erhalten: { QUOTED($word) }
mesh-stl-cut = { $file }: { $triangles } Dreiecke brauchen { $needed } Byte nach dem Kopf, erhalten: { $got }
mesh-face-type = { $name }: PLY-Flächen unbekannten Typs: { QUOTED($words) }
mesh-ply-cut = { $file }: { $count } Dreiecke brauchen { $needed } Byte nach den Vertices, erhalten: { $left } (abgeschnitten, oder Flächen, die keine Dreiecke sind: das Netz triangulieren)
mesh-face-numbers = { $where }: eine Fläche mit { $sides } Ecken hat { $expected } Zahlen, erhalten: { $got }
mesh-numbers = { $where }: erwartet werden { $count } Zahlen, erhalten: { QUOTED($words) }
mesh-face = { $where }: erwartet wird eine Fläche, erhalten: { QUOTED($words) }
mesh-facet = { $where }: erwartet wird eine Facette mit 3 Vertices, erhalten: { $inside }
mesh-stl-line = { $where }: erwartet wird eine Zeile einer STL-Datei, erhalten: { QUOTED($line) }
model-none = keine Modelldatei { $file }
model-empty = { $file }: erwartet wird ein Dreiecksnetz, gefunden: 0 Dreiecke
model-corners = { $file }: Dreiecke nennen Ecken, die es nicht gibt: erwartet werden 0 bis { $most }, erhalten: { $low } bis { $high }
model-not-finite = { $file }: Ecken haben Koordinaten, die keine Zahlen sind

## Was zitiert wird, und Weiteres

topic-not-there = { $setting }: { QUOTED($topic) } ist nicht in der Aufzeichnung, in ihr gibt es: { $there }
no-such-topic = kein Topic dieser Art
gnss-no-fix = { $file }: keine Position in diesem Protokoll; erwartet werden NAV-PVT-, BESTPOS-, INSPVA- oder GGA-Meldungen mit einer Position; { $counted }
gnss-no-message = keine Meldung dieser Arten
laser-no-scan-of = { $name }: kein Scan von { $topic } ist lesbar{ $why }
laser-any = einem 2-D-Laser
packets-unknown = { $source }: das sind Pakete keines LiDARs, das dekodiert wird; sein Modell in der Rig-Datei angeben, oder die Aufzeichnung mit dem Treiber abspielen und das PointCloud2 aufnehmen, das er veröffentlicht; dekodiert werden: { $known }
packets-mixed = { $source }: die Pakete zweier Sensoren eines Modells sind gemischt, und nichts darin unterscheidet die Sensoren ({ $why }): jeden in einem eigenen Topic oder an einem eigenen Port aufnehmen
packets-no-datagram = { $file }: kein UDP-Datagramm darin; gefunden: { $found }
found-nothing = nichts
recipe-columns-missing = keine Spalte { $missing }; es gibt: { $there }
found-none = keine
bag-no-points = das Bag enthält keine Punkte
table-spread-columns = { $name }: erwartet werden die Spalten id, sE, sN, sH oder id, cEE, cEN, cEH, cNN, cNH, cHH, erhalten: { $got }
no-column-names = keine Namen
laser-table-no-scan = { $file }: kein Scan eines 2-D-Lasers ist lesbar
laser-table-angles = { $where }: erwartet werden Winkel, die sich von Strahl zu Strahl ändern, sie tun es nicht
laser-table-beams = { $where }: erwartet werden höchstens { $limit } Strahlen, erhalten: { $got }
no-usable-points = keine brauchbaren Punkte ({ $counted })
nothing-read = nichts gelesen
rig-expects = das Rig { QUOTED($rig) } erwartet { $sensors }{ $more ->
    [some] {" "}…
   *[none] {""}
 }; die Aufzeichnung hat { $found }; das Rig berichtigen oder keines angeben; recon4 schreibt ein Rig aus dem, was in der Aufzeichnung ist (Befehl: recon4 info RECORDING --rig-out rig.toml; Seite: das Hochladen bietet es an)
rig-expects-topic = { $name }: { $model } in { $topic }
rig-expects-port = { $name }: { $model } von { $address ->
    [any] beliebiger Adresse
   *[other] { $address }
 } an Port { $port }
rig-no-packets = keine Pakete eines LiDAR
rig-topic-packets = { $topic }: Pakete eines { $model }
clocks-differ = die Uhren der LiDARs gehen verschieden: { $ahead }. In der Rig-Datei angeben: { $remedy }
clock-ahead = { $name } geht gegen { $first } vor um { $offset }
clock-remedy = { $name } time_offset_s = { $exact ->
    [about] ungefähr { $offset }
   *[exact] { $offset }
 }
points-unnamed =
    { $name }: die Spalten der Punkte haben keine üblichen Namen; Vorschlag für eine Rig-Datei:
    { "  " }{ $proposed }
    Ansehen, was unsicher ist, dann verwenden (Seite: Rig aus diesen Sensoren erstellen; Befehl: recon4 info RECORDING --rig-out rig.toml, dann --rig rig.toml; oder --fields { $fields })
rig-not-recorded = kein LiDAR des Rigs ist in der Aufzeichnung: { $why }
rig-no-sensor-known = { $file }: es ist kein Sensor bekannt, für den eine Rig-Datei geschrieben werden könnte
rig-file-exists = { $file } gibt es schon: eine neue Datei angeben
