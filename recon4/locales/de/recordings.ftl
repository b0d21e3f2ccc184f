### Was eine Aufzeichnung enthält, und was ihr fehlt.

## Arten von Aufzeichnungen

recording-pcap = Pakete von LiDARs (pcap)
recording-lvx = Pakete von Livox-LiDARs (LVX)
recording-bag1 = rosbag1
recording-bag2 = rosbag2
recording-frames = Einzelscans ({ $formats })
recording-imu_csv = Messwerte einer IMU (CSV)
recording-gnss_file = GNSS-Positionen (CSV, RTKLIB, SBET, UBX, NovAtel, NMEA)
recording-poses = Posen (TUM oder KITTI)
recording-carmen = CARMEN-Protokoll eines 2-D-Lasers
recording-line_tables = Linienscans (CSV oder NPZ)
recording-laser_table = Scans eines 2-D-Lasers (CSV oder NPZ)
recording-mandeye = Begehung mit einem MANDEYE-Gerät (LAZ und CSV)
recording-lidar_file = Beschreibung eines LiDARs (JSON, CSV, YAML, XML oder DAT)
recording-scans = Mitschnitt von Scans (pcap)

## What sensors send

content-clouds = Punktwolken
content-packet-scans = Scans aus Paketen
content-packets = Pakete
content-packets-mode = Pakete (Echo: { WORDS($mode, of: "return") })
word-return-dual = zwei
word-return-first = erstes
word-return-last = letztes
word-return-single = eines
word-return-strongest = stärkstes
word-return-triple = drei
content-line-scans = Linienscans
content-scans = Scans
content-layout = Scans mit { $most } Strahlen über { DEGREES($field_rad, digits: 0) }
content-layout-varies = Scans mit { $fewest } bis { $most } Strahlen über { DEGREES($field_rad, digits: 0) }
content-files = { $kind }-Dateien
content-files-timed = { $kind }-Dateien, Zeiten aus { $times }
content-points = Punkte in { $files } Dateien{ $lidars ->
    [one] {""}
   *[other] {" "}aller LiDARs
 }
content-transforms = Transformationen
content-description = Beschreibung des Roboters
content-angles = Winkel
remark-ranges = Entfernungen bis { DECIMAL($farthest_m, digits: 2) } m, { PERCENT($returns, digits: 0) } der Strahlen kommen zurück
remark-lines = { DECIMAL($shots, digits: 0) } Schüsse je Linie, { PERCENT($returns, digits: 0) } davon kommen zurück
remark-head = Kopf von { DEGREES($low, digits: 0) } bis { DEGREES($high, digits: 0) }, { DECIMAL($shots, digits: 0) } Schüsse je Linie, { PERCENT($returns, digits: 0) } davon kommen zurück
unread-packets = { $packets } Pakete von { $source } an Port { $port } ({ $why })
refused-sizes = von { $sizes } Bytes{ $more ->
    [yes] {" "}und anderen
   *[no] {""}
 }: nicht die eines bekannten LiDARs
refused-model = { $name }, dessen Pakete nicht dekodiert werden
refused-airy = ein Airy der Variante { $variant } (48 oder 192 Zeilen), dessen Pakete nicht dekodiert werden
refused-count = { $number } von { $total } Datenpaketen: { $what }

## A recording in lines: what begins each, and its words

info-label-time = Zeit
info-label-walk = Begehung
info-label-lidar = LiDAR
info-label-fields = Felder
info-label-remark = Hinweis
info-label-samples = Messwerte
info-label-unread = ungelesen
info-label-gap = Lücke
info-label-derived = gefolgert
info-label-missing = fehlt
info-label-lost = verloren
info-label-repaired = behoben
info-label-warning = Warnung
info-head = { $path }: { $kind }, { DECIMAL($megabytes, digits: 1) } MB
info-start = { $start } UTC
info-no-times = keine absoluten Zeiten
info-time = { $start }, { $estimated ->
    [yes] etwa{" "}
   *[no] {""}
 }{ DECIMAL($seconds, digits: 2) } s
info-time-back = { $start }, { $estimated ->
    [yes] etwa{" "}
   *[no] {""}
 }{ DECIMAL($seconds, digits: 2) } s, in umgekehrter Reihenfolge: die Zeiten laufen rückwärts
info-sensor = { $label } { $model }: { $estimated ->
    [yes] etwa{" "}
   *[no] {""}
 }{ $count } { $content }{ RATE($rate_hz) }{ TURNS($turns_hz) }
info-gap = { $sensor }: { DECIMAL($seconds, digits: 3) } s bei { DECIMAL($since_s, digits: 2) } s
info-gap-back = { $sensor }: die Uhr geht { DECIMAL($seconds, digits: 3) } s zurück, bei { DECIMAL($since_s, digits: 2) } s
info-gaps = … { $count } insgesamt
word-turns = , { DECIMAL($hz, digits: 2) } Umdrehungen je Sekunde

## Messwerte

samples-imu = { $count } IMU-Messwerte{ RATE($rate_hz) }
samples-gnss = { $count } GNSS-Positionen ({ $format }){ RATE($rate_hz) }
samples-gnss-undated = { $count } GNSS-Positionen ({ $format }), ohne Datum{ RATE($rate_hz) }
samples-gnss-weekless = { $count } GNSS-Positionen ({ $format }), ohne GPS-Woche{ RATE($rate_hz) }
samples-tum = { $count } Posen (TUM){ RATE($rate_hz) }
samples-kitti = Posen (KITTI)
samples-robot = Posen aus der Odometrie des Roboters
samples-in-packets = IMU in den Paketen des LiDARs
samples-beside-lines = { $file }: { $count } IMU-Messwerte
samples-imu-files = IMU-Messwerte in { $files } Dateien imu*.csv
samples-gnss-files = GNSS-Positionen in { $files } Dateien
samples-sender = { $sender }: { $count } { WORDS($what, of: "sender") }
samples-topic = { $topic }: { WORDS($what, of: "topic") }, { $messages }{ RATE($rate_hz) }
samples-topic-unread = { $topic }: { $type }, nicht gelesen, { $messages }{ RATE($rate_hz) }
word-sender-samples = andere Pakete eines LiDARs
word-sender-imu = IMU-Messwerte
word-sender-gnss = GNSS-Messwerte
word-topic-imu = IMU
word-topic-gnss = GNSS-Positionen
word-topic-odometry = Posen (zum Vergleich behalten)
word-topic-transforms = Transformationen zwischen Koordinatensystemen
word-topic-packets = andere Pakete eines LiDARs
word-topic-describes = beschreibt ein LiDAR
word-rate = , { DECIMAL($hz, digits: 1) } je Sekunde

## Was fehlt

missing-odometry = Odometrie
missing-times = Zeiten der Posen
missing-field = Feld: { WORDS($field, of: "field") }
missing-imu = IMU (eine IMU-Datei kann dazu angegeben werden)
missing-imu-given = IMU ({ $file } daneben enthält sie: Seite: IMU- und GNSS-Dateien; Befehl: --imu DATEI)
missing-imu-more = Messwerte von { $file } daneben (Seite: IMU- und GNSS-Dateien; Befehl: --imu DATEI)
missing-gnss = GNSS-Positionen
missing-gnss-given = GNSS-Positionen ({ $file } daneben enthält sie: Seite: IMU- und GNSS-Dateien; Befehl: --gnss DATEI)
missing-gnss-more = Positionen von { $file } daneben (Seite: IMU- und GNSS-Dateien; Befehl: --gnss DATEI)
missing-rig = Rig: { $error }
missing-contents = { $error }
missing-laser-table = 2-D-Laser (laser2d.csv oder laser2d.npz)
missing-imu-table = IMU (imu.csv)
missing-head-column = Winkel des Kopfes (Spalte head_deg; oder head_rate_deg_s in der Rig-Datei)
missing-profiler-rig = Rig: eines mit einem Sensor der Art profiler (Seite: Feld Rig; Befehl: --rig)
missing-topic = { WORDS($kind, of: "sensor-kind") } ({ $topic })
missing-head-topic = Winkel des Kopfes ({ $topic }, { $type })
word-field-intensity = Intensität
word-field-ring = Ring
word-field-time = Zeit je Punkt
word-sensor-kind-profiler = Profiler
word-sensor-kind-laser2d = 2-D-Laser

## What is no recording

no-path = { $path } gibt es nicht
no-file = { $path } ist nicht lesbar: Eine solche Datei oder einen solchen Ordner gibt es nicht
path-unreadable = { $path } ist nicht lesbar: { $reason }
file-empty = { $name }: Die Datei ist leer (0 Byte)
folder-empty = { $name }: Der Ordner ist leer
recording-not-given = keine Aufzeichnung angegeben
recording-is-mesh = { $name }: ein Dreiecksnetz: ein fertiges Modell, keine Aufzeichnung; { $known }
recording-is-part = { $name }: ein Teil einer Begehung mit einem MANDEYE-Gerät: geben Sie deren Ordner an
recording-unrecognized = { $name }: von keinem Leser erkannt ({ $looks }); { $known }
recording-of-kinds = { $name }: enthält Aufzeichnungen von { $number } Arten: { $held }; geben Sie eine davon an
recording-of-several = { $name }: enthält { $number } Aufzeichnungen: { $held }; geben Sie eine davon an
recording-none-inside = { $name }: keine Aufzeichnung in diesem Ordner; er enthält { $held }; { $remedy }
recording-unpack = entpacken Sie zuerst die { $number } komprimierten Dateien
recording-no-sensor = { $name }: { $kind }: Kein Leser kennt den Sensor, von dem sie ist
recording-planar-alone = { $name }: { $kind }: ohne Punkte eines LiDARs; verarbeiten Sie sie allein
recording-without-points = { $name }: { $kind } ist allein keine Aufzeichnung: Punkte fehlen
recording-one-kind = Aufzeichnungen einer Art erwartet, angegeben sind { $held }
recordings-known = bekannt: { recording-pcap }, { recording-lvx }, { recording-bag1 }, { recording-bag2 }, { recording-frames }, { recording-imu_csv }, { recording-gnss_file }, { recording-poses }, { recording-carmen }, { recording-line_tables }, { recording-laser_table }, { recording-mandeye }, { recording-lidar_file }
held-one = { $file } ({ $kind })
held-more = { $first }, { $next }
looks-unknown = erste Bytes { $bytes }
looks-like = sieht aus wie { WORDS($what, of: "looks") }
word-looks-ptx = Scans im Format PTX: fertige Scans, keine Aufzeichnung
word-looks-jpeg = ein JPEG-Bild
word-looks-png = ein PNG-Bild
word-looks-zip = ein ZIP-Archiv: zuerst entpacken
word-looks-gzip = mit gzip komprimiert: zuerst entpacken
word-looks-xz = mit xz komprimiert: zuerst entpacken
word-looks-zstd = mit zstd komprimiert: zuerst entpacken
word-looks-bzip2 = mit bzip2 komprimiert: zuerst entpacken
word-looks-7z = ein 7z-Archiv: zuerst entpacken
word-looks-pdf = ein PDF-Dokument
word-looks-las = eine Punktwolke im Format LAS/LAZ: eine fertige Karte, keine Aufzeichnung
word-looks-e57 = eine Punktwolke im Format E57: ein fertiger Scan, keine Aufzeichnung
word-looks-elf = ein Programm
word-looks-pcap = ein Mitschnitt einer veränderten libpcap: zuerst umwandeln (editcap -F pcapng)
word-looks-snoop = ein Mitschnitt von snoop: zuerst umwandeln (editcap -F pcapng)

## What is known of a count besides

detail-first = zuerst: { $problem }
detail-of-files = zu { $names }
detail-cut = auf { $sizes } Byte
detail-cut-ports = auf { $sizes } Byte, { $ports }
detail-port = an Port { $ports }
detail-ports = an die Ports { $ports }
detail-protocols = { WORDS($names, of: "protocol") }
word-protocol-no-ipv4-header = kein ganzer IPv4-Header
word-protocol-link-type = ein anderer Link-Typ
detail-one-time = { $sensor }: Alle Punkte einer Punktwolke haben eine Zeit: in ihrer Reihenfolge verteilt
detail-times = { $sensor }, { $field }: { $why }
times-all-one = Alle Punkte einer Umdrehung haben die Zeit { $time }
times-within = Die Punkte einer Umdrehung liegen innerhalb von { $span_ms } ms
times-no-unit = vom ersten zum letzten Punkt { $span }, in keiner Einheit eine Umdrehung
times-none = { $time } ist in keiner Einheit eine Zeit
times-far = { $damaged } von { $total } Punkten einer Punktwolke sind mehr als zwei Umdrehungen von den anderen entfernt
times-coarse = Schritte von { $step_ms } ms sind zu grob
times-missing = { $missing } von { $total } Punkten einer Punktwolke haben keine Zahl
extent-map = { $axes }: Koordinaten einer Karte oder der Erde, kein Scan mit dem Sensor im Ursprung. Eine fertige Karte ist keine Aufzeichnung; geben Sie sie als Referenz an
extent-unit = { $axes }: Die Hälfte von ihnen ist weiter als { DECIMAL($usual_m, digits: 0) } m entfernt. Sind es Millimeter, geben Sie ingest.points_unit_m=0.001 an; eine Karte, deren Ursprung kein Sensor ist, ist keine Aufzeichnung
extent-range = { $axes }: Die Hälfte von ihnen ist weiter als { DECIMAL($usual_m, digits: 0) } m entfernt. Misst der Sensor so weit, geben Sie ein größeres ingest.max_range_m an

## Damaged bags

db3-rows-order = Zeile { $row } steht nach Zeile { $before }
db3-cut-off = { $name }: abgeschnitten, keine einzige Nachricht ist übrig
db3-damaged = { $name }: beschädigt ({ $damage }), keine einzige Nachricht ist übrig
db3-too-short = { $name }: erwartet eine SQLite-Datenbank mit mindestens einer Seite von { $page } Byte; es sind { $size } Byte, die mit { $bytes } beginnen; keine einzige Nachricht ist übrig
