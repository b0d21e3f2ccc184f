### Was Leser von Aufzeichnungen hergeleitet oder gewählt haben, weil die Aufzeichnung es nicht sagt.
### docs/how-to/languages.md sagt, wie Texte geschrieben und übersetzt werden.

## Die ganze Aufzeichnung

DEVICE =
    .text1 = Aufgezeichnet von { $device }.

DEVICE-CLOCKS =
    .text1 = Das Gerät gibt an, dass seine LiDARs keine gemeinsame Zeitquelle hatten.

FILE-COPY =
    .text1 = { $name } hat dieselben Bytes wie { $original }: ausgelassen.

FILE-PASSED-OVER =
    .text1 = { $name } ist ein Dreiecksnetz, keine Aufzeichnung: übergangen.

FILE-UNNUMBERED =
    .text1 = { $name } hat keine Nummer wie die anderen { $files } Dateien: es gilt als Karte, nicht als Scan, und wird ausgelassen.

FILES-AS-ONE =
    .text1 = { $folder }: keine { $name }: alle Dateien darin sind eine Aufzeichnung.

FOLDERS-PASSED-OVER =
    .text1 = Aufzeichnungen in Unterordnern werden nicht gelesen: { $folders }.

POSES-KEPT =
    .text1 = Posen der Aufzeichnung werden in poses.tum zum Vergleich behalten, nicht verwendet.

RECORDED-BACKWARD =
    .text1 = Rückwärts aufgezeichnet: die Zeitstempel aller Topics fallen. Die { $messages } Nachrichten werden von der letzten zur ersten gelesen.

WALK-LIDAR =
    .text1 = LiDAR: Scans von Punkten im Raum, von { $sensors }

WALK-PROFILER =
    .text1 = Profiler: jede Linie von { $sensor } liegt woanders im Raum, denn { WORD($moved_by, of: "WALK-PROFILER") } bewegt ihn
    .word-head = sein Kopf
    .word-constant-head = ein Kopf mit fester Drehrate

WALK-PLANAR =
    .text1 = 2-D-Laser: ein Plan dessen, was seine Ebene trifft, denn es gibt weder LiDAR noch Profiler

## Das Rig, und was welcher Sensor ist

RIG-CHOSEN =
    .text1-if-own_frame = Kein Rig angegeben: ein { $model }, sein Koordinatensystem ist das des Körpers.
    .text2 = Kein Rig angegeben: ein { $model }, der Körper hat seinen Ursprung und die Achsen von { $axes_of }.
    .text3 = Kein Rig angegeben: { $lidars } LiDARs, der Körper ist das Koordinatensystem { $frame }.
    .text4 = Kein Rig angegeben: { $sensors } passen zur Vorlage { $preset }, deren Einbaulagen verwendet werden.
    .text5-if-by_topics = Kein Rig angegeben: die Topics passen zur Vorlage { $preset }, deren Einbaulagen verwendet werden.
    .text6-if-line_scans = Kein Rig angegeben: Zeilenscans, die Einbaulagen der Vorlage { $preset } werden verwendet.
    .text7-if-by_file = Kein Rig angegeben: { $sensors } sind so eingebaut, wie die Datei es angibt.

SENSOR-TOPIC =
    .text1 = { $sensor } ist das Topic { $topic }: das Rig nennt keines.

SENSOR-NUMBER =
    .text1 = { $sensor } ist LiDAR { $number }: das Rig hat keine Seriennummer.

SENSOR-LATER =
    .text1 = { $sensor }: sendet erst später, von { $sender }.

SENSOR-ELSEWHERE =
    .text1 = { $sensor }: von { $sender } genommen, das Rig erwartet { $address } an Port { $port }.
    .text2-if-anywhere = { $sensor }: von { $sender } genommen, das Rig erwartet eine beliebige Adresse an Port { $port }.

MODEL-ALIKE =
    .text1 = { $sensor }: als { $model } gelesen. Pakete von { $alike } haben dieselbe Form, und nichts darin sagt, welcher es ist: mit einem von diesen ist die Karte falsch.

LASER-BY-SENDER =
    .text1 = Der 2-D-Laser ist, was Scans von { $address } an Port { $port } sendet.

LASER-OF-MOTION =
    .text1 = { $topic } ist der 2-D-Laser, der die erste Bewegung liefert.

## Topics und Spalten, die gelesen werden, und solche, die nicht gelesen werden

TOPIC-SHARED =
    .text1 = { $topic } ist von { $lidars } LiDARs: { $sources }.

TOPIC-LEFT-OUT =
    .text1 = { WORD($what, of: "TOPIC-LEFT-OUT") }: { $read } (Koordinatensystem { $frame }) wird gelesen, nicht { $topic }.
    .text2-if-frameless = { WORD($what, of: "TOPIC-LEFT-OUT") }: { $read } wird gelesen, nicht { $topic }.
    .text3-if-unreadable = Es hat in seiner ersten Minute keine lesbare Nachricht.
    .text4 = Es deckt nur { PERCENT($covered, digits: 0) } der Aufzeichnung ab.
    .text5-if-no_gyroscope = Es hat kein Gyroskop.
    .text6-if-unit_unknown = Seine Drehraten sind nicht in rad/s.
    .text7-if-no_accelerometer = Es hat keinen Beschleunigungssensor.
    .text8 = Seine Beschleunigungen sind { SIGNIFICANT($usual_m_s2, digits: 2) }, erwartet etwa 9,8 m/s².
    .text9 = Es hat { DECIMAL($rate_hz, digits: 0) } Messwerte in der Sekunde.
    .text10 = Es hat in { $without_fix } Nachrichten keine Position.
    .text11-if-one_position = Seine Position ändert sich nie.
    .text12-if-filtered = Seinem Namen nach ist es die Ausgabe eines Filters.
    .text13-if-no_poses = Es hat keine Posen, die Zahlen sind.
    .text14-if-still = Seine Posen ändern sich nie.
    .text15-if-no_returns = Es hat keine Echos.
    .text16 = Sein Blickfeld hat { DEGREES($view_rad, digits: 0) }.
    .text17-if-elsewhere = Nach Koordinatensystem und Namen ist es nicht die IMU des LiDARs.
    .text18-if-lower_status = Seine Positionen haben einen schlechteren Status.
    .text19-if-narrower = Sein Blickfeld ist schmaler.
    .text20-if-as_good = Es ist gleich gut.
    .text21-if-fewer = Es ist gleich gut, mit weniger Nachrichten.
    .text22-if-no_points = Es hat in seiner ersten Minute keine Punkte.
    .text23-if-camera = Es ist von einer Tiefenkamera: ein schmales Blickfeld ohne Ringe und Zeiten der Punkte.
    .text24 = Es ist im festen Koordinatensystem { $fixed_frame }: Punkte, die ein Programm platziert hat.
    .text25 = Es ist im Koordinatensystem des Roboters, { $robot_frame }, mit weniger Einzelheiten als { $better }.
    .text26-if-lesser = Es ist eine Kopie von { $copy_of }, in der weniger steht.
    .text27-if-whole = Es ist eine Kopie von { $copy_of }.
    .word-odometry = Odometrie
    .word-2-D-laser = 2-D-Laser

TOPIC-OF-DRIVER =
    .text1 = { $topic } ist von einem LiDAR, aber { $type } wird nicht gelesen: den Bag durch den Treiber abspielen (komprimierte Wolken: point_cloud_transport) und dessen PointCloud2 aufzeichnen.

CLOUDS-OF-PACKETS =
    .text1 = Rohe Pakete werden gelesen, nicht { $topics }.

COLUMNS-UNKNOWN =
    .text1 = Nicht gelesen: { $topic }: { $recipe }.
    .text2 = Nicht gelesen: { $topic } hat Listen von { $columns }.
    .text3-if-columns = Sie werden als Punkte eines LiDARs gelesen, wenn sie x, y, z und eine Zeit, ein Ring oder eine Intensität heißen. Sonst sagt eine Rig-Datei, welche Spalten es sind: fields = {"{"} x = "SPALTE", y = "SPALTE", z = "SPALTE", time = "SPALTE" {"}"} (oder range, azimuth, elevation) in ihrem [[sensor]].

COLUMNS-OVERLOOKED =
    .text1 = { $where }: Spalten sehen nach mehr aus, als gelesen wird: { $columns }.
    .text2 = Sie werden mit { $recipe } in einer Rig-Datei gelesen.

COLUMN-UNCERTAIN =
    .text1-if-doubtful = Unsicher: { $where }: { $role }: { $column } kann etwas anderes sein.
    .text2 = Unsicher: { $where }: { $role }: { $column }, oder { $others }.
    .text3 = Unsicher: { $where }: { $role }: die Einheit von { $column } ist nach ihren Werten { $unit }.
    .text4-if-no_unit = Unsicher: { $where }: { $role }: die Einheit von { $column } ist nicht bekannt.
    .text5-if-untimed = Unsicher: { $where }: time: keine Spalte sieht wie die Zeit eines Punkts aus.
    .text6 = Unsicher: { $where }: { $detail }.

## Einbaulagen

MOUNT-STATED =
    .text1 = Einbaulage ({ WORD($what, of: "MOUNT-STATED") }) aus { $sources }: { $parent } -> { $child } { MOUNT($mount) }.
    .text2-if-placeholder = Einbaulage ({ WORD($what, of: "MOUNT-STATED") }) aus { $sources }: { $parent } -> { $child } nicht gedreht, an einem Ort: ein Platzhalter?
    .text3 = Einbaulage ({ WORD($what, of: "MOUNT-STATED") }) aus der Rig-Datei: { MOUNT($by_rig) }.
    .word-laser = Laser
    .word-GNSS-antenna = GNSS-Antenne

MOUNT-UNSTATED =
    .text1 = Einbaulage ({ WORD($what, of: "MOUNT-STATED") }): die Transformationen des Bags (tf) verbinden { WORD($parent, of: "MOUNT-UNSTATED") } und { WORD($child, of: "MOUNT-UNSTATED") } nicht: der Sensor gilt als nicht gegen das LiDAR gedreht.
    .word-no-frame = kein Koordinatensystem

MOUNT-PLACEHOLDER =
    .text1 = Einbaulage von { $part } relativ zu { $other }: { MOUNT($by_rig) } im Rig, { MOUNT($by_bag) } in { $source } des Bags ({ $parent } -> { $child }): ein Platzhalter?

MOUNT-MOVES =
    .text1 = { $sensor }: seine Einbaulage bewegt sich, das Rig hat die von { $base }.
    .text2 = { $placed }: seine Einbaulage bewegt sich, jeder Punkt wird mit der Einbaulage zu seiner Zeit in { $base } platziert.
    .text3 = { $profiler } ist ein Profiler, kein 2-D-Laser, der eine Ebene kartiert: seine Einbaulage bewegt sich durch { $moved_by }, und jeder Schuss wird mit der Einbaulage zu seiner Zeit platziert.
    .text4 = { $joints } dreht sich um { DEGREES($turned_rad, digits: 0) } ({ $source }, { $poses } Posen in { DECIMAL($seconds, digits: 1) } s).

MOUNT-TURNS-TOGETHER =
    .text1 = { $topic } und { $imu } drehen sich zusammen: der Körper ist, was das Gelenk bewegt.

LASER-MOUNT-UNSTATED =
    .text1 = { $topic }: die Transformationen des Bags (tf) sagen nicht, wie sein Koordinatensystem { WORD($frame, of: "LASER-MOUNT-UNSTATED") } am Roboter eingebaut ist: es gilt als waagrecht und aufrecht.
    .text2-if-of_odometry = Wie der Laser eingebaut ist, ist unbekannt: die Odometrie gilt als seine eigene.
    .word-no-name = (ohne Namen)

LASER-UPSIDE-DOWN =
    .text1 = Der Laser hängt kopfüber, seine Scans werden umgedreht.

HEAD-ANGLES =
    .text1 = { $sensor }: der Kopf dreht sich mit { DEGREES($rate_rad_s, digits: 2) }/s, wie die Rig-Datei angibt.
    .text2 = { $sensor }: die Winkel seines Kopfes sind { $topic }.

JOINT-NONE =
    .text1 = { $parent } -> { $child } ({ $source }) ist kein Gelenk.
    .text2-if-untimed = Seine Transformationen haben keine Zeiten.
    .text3 = Es bewegt sich um { DECIMAL($travel_m, digits: 1) } m, wie ein Körper in der Welt.
    .text4 = { PERCENT($off_axis, digits: 0) } seiner Drehungen sind um andere Achsen als seine Hauptachse.

FRAME-NAMED =
    .text1 = { $topic }: sein Koordinatensystem { $frame } ist { $name } der Transformationen.

FRAME-UNCERTAIN =
    .text1-if-several = { $topic }: welches Koordinatensystem der Transformationen sein { $frame } ist, ist nicht sicher: eines von { $names }.
    .text2-if-shared = { $topic }: welches Koordinatensystem der Transformationen sein { $frame } ist, ist nicht sicher: auch das eines anderen Sensors: { $names }.

FRAME-OF-POINTS =
    .text1-if-placed = { $topic }: das Koordinatensystem seiner Punkte ist { $frame }: ein anderes Programm hat sie schon platziert, erwartet werden Punkte, wie der Sensor sie maß.
    .text2-if-on_robot = { $topic }: seine Punkte sind im Koordinatensystem des Roboters, { $frame }: wo darin der Sensor ist, ist nicht bekannt.

TRANSFORM-LEFT-OUT =
    .text1 = { $topic }: Transformationen werden ausgelassen: '{ $parent }' -> '{ $child }'.
    .text2 = Erwartet: { WORD($expected, of: "TRANSFORM-LEFT-OUT") }.
    .text3 = Erwartet: höchstens { SIGNIFICANT($longest_m, digits: 6) } m.
    .text4 = Erhalten: { $got }.
    .word-names = zwei Namen von Koordinatensystemen
    .word-frames = zwei Koordinatensysteme
    .word-numbers = Zahlen
    .word-quaternion = ein Quaternion der Länge 1

TRANSFORMS-CUT =
    .text1 = { $topic }: seine ersten { $messages } Nachrichten werden gelesen.
    .text2 = { $topic }: seine ersten { $transforms } Transformationen werden gelesen.
    .text3 = { $topic }: höchstens { $pairs } Paare von Koordinatensystemen erwartet.

DESCRIPTION-UNREAD =
    .text1 = { $topic }: die Beschreibung des Roboters wird nicht gelesen: { $error }.
    .text2 = { $topic }: Gelenk '{ $joint }': erwartet Name, Achse und Übersetzung.

## Winkel und Metadaten von LiDARs

ANGLES-FOUND =
    .text1 = { $sensor }: Winkel { WORD($of, of: "ANGLES-FOUND") } aus { WORD($source, of: "ANGLES-FOUND") }.
    .word-beams = seiner Strahlen
    .word-mirrors = seiner Spiegel und Strahlen
    .word-lasers = seiner Laser
    .word-device-packets = seinen Gerätepaketen (DIFOP)
    .word-factory = der Werkstabelle eines anderen Sensors

HDL64-CALIBRATION =
    .text1 = { $sensor }: ein HDL-64E { $model }, Kalibrierung aus { WORD($source, of: "HDL64-CALIBRATION") }.
    .word-status-bytes = den Statusbytes seiner Pakete

METADATA-BY-NAME =
    .text1 = { $sensor }: { $name } sind nach ihrem Namen seine Metadaten, nicht { $others }.

METADATA-ASSUMED =
    .text1 = { $sensor }: { $name } nennt nicht { $fields }: die Werte der meisten Sensoren werden genommen.

CHECKSUM-FOREIGN =
    .text1 = { $sensor }: die CRC seiner Pakete ist nicht die des Protokolls: nicht geprüft.

## Zeiten und Uhren

FRAMES-ABSENT =
    .text1 = In den Namen der Dateien fehlen { $absent } Nummern von { $first } bis { $last }: ihre Zeit bleibt leer.

FRAMES-RATE =
    .text1-if-assumed = Keine Umdrehung gefunden, in Frames mit { SIGNIFICANT($rate_hz, digits: 6) } Hz geteilt.
    .text2-if-by_rotation = Frames mit { SIGNIFICANT($rate_hz, digits: 6) } Hz: eine Umdrehung des langsamsten LiDARs.

CLOUDS-THINNED =
    .text1 = { $sensor }: in der ganzen Aufzeichnung fehlen { DECIMAL($pause_s, digits: 3) } s von je { DECIMAL($every_s, digits: 3) } s, wie wenn nur ein Teil der Punktwolken behalten wird. Die Bewegung wird überbrückt.

CLOCK-CORRECTED =
    .text1 = { $sensor }: seine Uhr wird seit seiner ersten Messung um { DECIMAL($rate_ppm, digits: 1, sign: 1) } µs je Sekunde korrigiert, wie die Rig-Datei angibt.

CLOCKS-SET =
    .text1 = Alle Uhren wurden bei { DECIMAL($at_s, digits: 1) } s um { DECIMAL($jump_s, digits: 3) } s vorgestellt. Der Träger ging dabei weiter wie zuvor, es fehlt also nichts: Die Zeiten laufen ohne den Sprung weiter.
    .text2 = Das sieht aus wie: { WORD($looks) }.

CLOCK-PAST-HOUR =
    .text1 = { $sensor }: seine Zeitstempel laufen über die volle Stunde (3600 s) hinaus: fortgesetzt.

CLOCK-BY-GPS =
    .text1 = { $sensor }: die Stunde ist von seinem GPS; die Uhr des Aufzeichnenden weicht um { DECIMAL($off_s, digits: 3, sign: 1) } s von UTC ab.

CLOCK-SHIFTED =
    .text1-if-hours = { $sensor }: seine Uhr weicht um { DECIMAL($ahead_s, digits: 3, sign: 1) } s und ganze Stunden von der des Aufzeichnenden ab, und kein GPS stellt sie: seine Zeiten werden auf die Uhr des Aufzeichnenden verschoben.
    .text2-if-past_hour = { $sensor }: seine Uhr weicht um { DECIMAL($ahead_s, digits: 3, sign: 1) } s von der des Aufzeichnenden ab, und kein GPS stellt sie: seine Zeiten werden auf die Uhr des Aufzeichnenden verschoben.

STAMPS-EVENED =
    .text1 = { $where }: die Zeitstempel streuen um { DECIMAL($scatter_ms, digits: 1) } ms, wie die eines Rechners, der beim Eintreffen stempelt. Die Wolken dauern gleich lang: sie werden auf gleichmäßige Zeiten gelegt.

CLOCK-OF-POINTS =
    .text1 = { $where }: die Uhr der Punkte ist nicht die der Zeitstempel, sie geht um { DECIMAL($ahead_s, digits: 3, sign: 1) } s vor.
    .text2 = Das sieht aus wie: { WORD($looks) }.
    .text3-if-each = Jeder Zeitstempel gilt als der des ersten Punktes.
    .text4-if-first = Der erste Zeitstempel gilt als der des ersten Punktes.

TIMES-OF-POINTS =
    .text1 = { $where }: die Zeiten sind die der Punkte.

TIMES-CONTINUED =
    .text1 = { $where }: Zeiten der Punkte beginnen alle { SIGNIFICANT($cycle_s, digits: 6) } s von vorn: nach den Zeitstempeln fortgesetzt.

TIMES-AS-PARTS =
    .text1 = { $where }: Zeiten der Punkte gehen von 0 bis 1: Teile der Zeit von Punktwolke zu Punktwolke.

TIMES-BY-AZIMUTH =
    .text1 = { $where }: keine Zeit je Punkt, Zeit aus dem Azimut, { WORD($order, of: "POINTS-TIMED-BY-AZIMUTH") }.

LINES-UNTIMED =
    .text1 = Zeilenscans ohne Zeiten ihrer Schüsse: alle Schüsse zur Zeit des Zeitstempels.

## Punkte

BYTES-ORDER =
    .text1 = { $where }: was die Punktwolken als Reihenfolge ihrer Bytes angeben (is_bigendian), ist falsch: so gelesen sind die Koordinaten keine Längen. Sie werden in der anderen Reihenfolge gelesen.

FIELDS-UNREAD =
    .text1 = { $where }: Felder unbekannter Typen werden nicht gelesen: { $fields }.

INTENSITY-MISSING =
    .text1 = { $where }: kein Feld für die Intensität, 0 wird gespeichert.
    .text2-if-line_scans = Zeilenscans ohne Intensitäten: 0 wird gespeichert.

INTENSITY-CONSTANT =
    .text1 = { $where }: { $field } ist { SIGNIFICANT($value, digits: 6) } in allen Punkten einer Punktwolke: sie wurde nicht gemessen.
    .text2-if-no_number = { $where }: { $field } ist in allen Punkten einer Punktwolke keine Zahl: sie wurde nicht gemessen.

INTENSITY-SCALED =
    .text1 = { $where }: Intensität 0..1 wird mal 255 gespeichert.

RINGS-RENUMBERED =
    .text1 = { $where }: { $field } neu nummeriert, 0 = niedrigste Elevation.

RINGS-BY-ELEVATION =
    .text1-if-fieldless = { $where }: kein Feld für den Ring.
    .text2 = { $where }: { $field } ist überall { SIGNIFICANT($everywhere, digits: 6) }.
    .text3-if-outside = { $where }: { $field } ist meist außerhalb von 0..255.
    .text4-if-in_files = { $where }: keine Ringe in den Dateien.
    .text5-if-beams = Der Ring folgt aus der Elevation.
    .text6-if-bands = { $bands } Bänder der Elevation werden stattdessen genommen.

## 2-D-Laser

RANGE-LARGEST =
    .text1 = Entfernungen von { DECIMAL($limit_m, digits: 2) } m und mehr, die größten: kein Echo.

ODOMETRY-MISSING =
    .text1 = Keine Odometrie: die Bewegung wird aus den Scans davor vorhergesagt.

ODOMETRY-STILL =
    .text1 = Die Odometrie ändert sich nie: sie wird nicht verwendet.

ODOMETRY-OF-REAR =
    .text1 = Die Posen des hinteren Lasers sind die des Roboters: er schaut nach hinten.

ODOMETRY-RAW =
    .text1 = Die Posen des Lasers sind korrigierte: stattdessen wird die rohe Odometrie verwendet.

ODOMETRY-MOVED =
    .text1 = Die Odometrie wird auf den Laser umgerechnet.

## IMU und GNSS

IMU-ABSENT =
    .text1 = Keine IMU: die Bewegung innerhalb eines Frames wird aus den Punkten allein geschätzt.

SAMPLES-OF-FILE =
    .text1-if-imu = IMU-Messwerte sind die der CSV-Datei, nicht die der Aufzeichnung.
    .text2-if-gnss = GNSS-Positionen sind die der angegebenen Datei, nicht die der Aufzeichnung.

IMU-CHOSEN =
    .text1 = IMU: die in den Paketen von { $sensor } wird gelesen, wie das Rig angibt, nicht { $other }.
    .text2 = IMU: { $read } wird gelesen, nicht die von { $others } (eine andere: [imu] sensor = NAME in der Rig-Datei).
    .text3 = IMU: Nummer { $number } wird gelesen, die keines LiDARs.

IMU-JOINED =
    .text1 = IMU: Drehraten von { $turns } und Beschleunigungen von { $forces } werden verbunden.

IMU-UNCALIBRATED =
    .text1 = { $sensor }: Gyroskop und Beschleunigungssensor aus seinen Positionspaketen, in seinem eigenen Koordinatensystem; der Nullpunkt dieser Gyroskope ist nicht kalibriert (einige zehn Grad je Sekunde).

TURNS-UNIT =
    .text1-if-kept = IMU: ein Zehntel ihrer Drehraten liegt über { DECIMAL($high, digits: 1) }: als rad/s angenommen ({ DECIMAL($high_deg_s, digits: 0) } Grad/s).
    .text2-if-converted = IMU: Drehraten sind in Grad/s, gespeichert in rad/s.
    .text3-if-by_content = Ein Zehntel liegt über { DECIMAL($high, digits: 1) }; dagegen: ingest.imu_gyro_unit=rad_s.

FORCES-UNIT =
    .text1 = Der Beschleunigungssensor war in { $unit } (mittlere Länge { SIGNIFICANT($usual, digits: 3) }), jetzt in m/s².
    .text2 = IMU: Beschleunigungen von { SIGNIFICANT($usual, digits: 3) } in { $name } und anderen sind m/s², nicht g.

POSITIONS-CHOSEN =
    .text1 = { $name }: Positionen sind die von { $log }; nicht gelesen: { $others }.
    .text2 = Positionen sind die von { $message }; daneben nicht gelesen: { $others }.

POSITIONS-DATED =
    .text1-if-dateless = { $what }, ohne Datum: die erste ist vom { $day }, wie die Punkte sagen.
    .text2-if-weekless = { $what }, ohne GPS-Woche: die erste ist vom { $day }, wie die Punkte sagen.
    .text3-if-dateless = GNSS-Positionen ({ $format }), ohne Datum: die erste ist vom { $day }, wie die Punkte sagen.
    .text4-if-weekless = GNSS-Positionen ({ $format }), ohne GPS-Woche: die erste ist vom { $day }, wie die Punkte sagen.

POSITIONS-UNIT =
    .text1 = Positionen waren in Radiant (Breite { DECIMAL($lat_rad, digits: 6) }, Länge { DECIMAL($lon_rad, digits: 6) }), jetzt in Grad.

POSITIONS-BY-ARRIVAL =
    .text1-if-nmea = NMEA: Zeit der Ankunft, die UTC darin ist nicht die Uhr der Punkte.
    .text2 = { $sensor }: Positionen haben die Zeit, zu der ihr Paket ankam (bis zu 1 s zu spät): kein GPS stellt seine Uhr.
    .text3-if-by_device = Positionen haben die Zeiten, zu denen das Gerät sie empfing.

POSITIONS-ACCURACY =
    .text1 = Genauigkeiten von { $name } sind die von { $source }.
    .text2 = Genauigkeiten von { $name } werden nicht gelesen: { $error }.
    .text3-if-absent = { $name }: keine smrmsg-Datei mit den Genauigkeiten liegt daneben; die Positionen zählen als einzelne.
    .text4-if-no_number = { $name }: keine Genauigkeit darin ist eine positive Zahl.

HEIGHTS-MISSING =
    .text1 = Keine GNSS-Position hat eine Höhe: sie können die Karte nicht platzieren.

## Artefakte früherer Versionen

EARLIER-SENTENCE =
    .text1 = { $text }
