### Was an Dateien, Einstellungen und Projekten falsch ist: jeder Text hat einen stabilen Code.

## Text- und JSON-Dateien

file-not-regular = { $file }: erwartet wird eine gewöhnliche Datei, es ist ein Ordner, eine Pipe oder ein Gerät
file-grew = { $file }: erwartet werden höchstens { $limit } Byte, es sind mehr
file-large = { $file }: erwartet werden höchstens { $limit } Byte, erhalten: { $size }
text-nul-at = { $file }: Zeile { $line }: erwartet wird Text, erhalten: ein NUL-Byte an der Stelle { $offset }
text-not-utf8-at = { $file }: Zeile { $line }: erwartet wird Text in UTF-8, erhalten: Byte 0x{ $byte } an der Stelle { $offset }
text-line-long = { $file }: Zeile { $line }: erwartet werden höchstens { $limit } Byte, die Zeile ist länger
json-invalid = { $file }: erwartet wird JSON, erhalten: etwas anderes: { $why }
not-finite = erwartet wird eine endliche Zahl, erhalten: { $got }
json-deep = { $file }: erwartet wird JSON mit höchstens { $limit } Ebenen, es sind mehr
json-surrogate = { $file }: erwartet wird Text in Unicode, erhalten: ein einzelnes Surrogat: { $why }
text-not-utf8-behind = { $file }: nach Zeile { $line }: erwartet wird Text in UTF-8, erhalten: etwas anderes
text-nul = { $file }: Zeile { $line }: erwartet wird Text, erhalten: ein NUL-Byte
text-not-utf8 = { $file }: Zeile { $line }: erwartet wird Text in UTF-8, erhalten: Byte 0x{ $byte } in Spalte { $column }
text-utf16 = { $file }: erwartet wird Text in UTF-8, erhalten: UTF-16; als UTF-8 speichern

## Einstellungen

where-why = { $where }: { $why }
and-further = { $first }; { $further }
setting-form = erwartet wird gruppe.feld=wert, erhalten: { $got }
setting-group-unknown = keine Gruppe von Einstellungen { $group }; bekannt: { $known }
setting-renamed = die Einstellung { $setting } heißt jetzt { $name }
setting-retired = { $setting } ist keine Einstellung mehr: fest auf { $value }, nicht { $given } ({ $what })
setting-unknown = keine Einstellung { $setting }; bekannt in { $group }: { $known }
setting-choice = { $setting } muss eines sein von { $choices }, erhalten: { $got }
setting-true-false = { $setting } muss true oder false sein, erhalten: { $got }
setting-type = { $setting } muss { $type } sein, erhalten: { $got }
preset-unknown = keine Voreinstellung namens { $name }; es gibt: { $known }
setting-range = { $setting } muss { $low } bis { $high } sein, erhalten: { $got }
setting-geoid = heights = orthometric braucht geoid_separation_m, und nur das hat eine, erhalten: { $got }
setting-rate = rate_hz muss 0 oder mindestens 0.5 sein, erhalten: { $got }
setting-ranges = min_range_m muss kleiner als max_range_m sein, erhalten: { $got }
setting-surface = surface muss raw oder fitted sein, erhalten: { $got }
setting-tile = tile_m muss mindestens vier Zellen oder Voxel groß sein, erhalten: { $got }
setting-far-ratio = far_ratio muss 0 oder größer als 1 sein, erhalten: { $got }
setting-solver = solver muss planes, common_normal oder svd sein (einzelne Scans werden nur in der Odometrie ohne IMU registriert, mit solver = planes), erhalten: { $got }

## Tabellen in TOML-Dateien

table-expected = { $where }: erwartet wird eine Tabelle, erhalten: { $got }
table-unknown = { $where }: unbekannt: { $unknown }; bekannt: { $known }
table-number = { $where }: { $key } muss eine endliche Zahl sein, erhalten: { $got } (höchstens 4e9)
table-numbers = { $where }: { $key } müssen { $size } endliche Zahlen sein, erhalten: { $got } (höchstens 4e9)
table-place = { $where }: { $key } muss innerhalb von { $limit_m } m um den Ursprung des Körpers liegen, erhalten: { $got }: Meter angeben, nicht Millimeter
table-degrees = { $where }: { $key } muss in Grad angegeben sein, erhalten: { $got }: im Bogenmaß wären das { $degrees }
table-text = { $where }: { $key } muss ein Text mit höchstens { $limit } Zeichen sein, erhalten: { $got }
table-true-false = { $where }: { $key } muss true oder false sein, erhalten: { $got }
table-port = { $where }: port muss 0 bis 65535 sein, erhalten: { $got }
toml-large = { $where }: erwartet werden höchstens { $limit } Zeichen, erhalten: { $got }
toml-dots = { $where }: erwartet werden Schlüssel aus wenigen Teilen, einer hat { $got } Punkte
toml-invalid = { $where }: keine TOML-Datei: { $why }
toml-deep = { $where }: keine TOML-Datei: zu tief verschachtelt

## Rig-Dateien

rig-no-such = kein Rig namens { $name }; mitgeliefert: { $shipped }; oder den Pfad einer .toml-Datei angeben
rig-unreadable = die Rig-Datei ist nicht lesbar: { $why }
rig-sensors = { $where }: ein Rig braucht mindestens ein [[sensor]] und höchstens { $limit }, erhalten: { $got }
rig-names-same = { $where }: die Namen der Sensoren müssen verschieden sein, erhalten: { $got }
rig-imu-sensor = { $where }: sensor muss eines sein von { $names }, erhalten: { $got }
rig-date = { $where }: date muss wie 2026-11-22 sein, erhalten: { $got }
rig-model = { $where }: model muss für kind = { $kind } eines sein von { $models }, erhalten: { $got }
rig-head = { $where }: nur ein profiler hat head, dies ist: { $kind }
rig-lidar-only = { $where }: nur ein lidar hat { $what }, dies ist: { $kind }
rig-name = { $where }: name muss ein Text sein, erhalten: { $got }
rig-kind = { $where }: kind muss eines sein von { $kinds }, erhalten: { $got }
rig-within = { $where }: { $key } muss innerhalb von ±{ $limit } sein, erhalten: { $got }
rig-quaternion = { $where }: quat_xyzw muss die Länge 1 haben, erhalten: { $got }
rig-needs-name = das Rig braucht einen Namen
rig-name-taken = { $sensor }: ein anderer Sensor hat diesen Namen
rig-sensor-number = Sensor { $number }
rig-sensor-needs-name = { $sensor }: jeder Sensor braucht einen Namen
rig-imu-holder = muss der Name eines LiDARs sein ({ $names }) oder leer
rig-antenna = GNSS-Antenne
rig-model-of = { $sensor }: erwartet wird { $expected }, erhalten: { QUOTED($got) }
rig-profiler-head = { $sensor }: nur ein Profiler hat einen Drehkopf
rig-at-most = { $sensor }: erwartet wird höchstens { $limit }
rig-lidar-clock = { $sensor }: nur ein LiDAR hat einen Gang der Uhr
rig-lidar-beams = { $sensor }: nur ein LiDAR hat Korrekturen der Strahlen
rig-lidar-columns = { $sensor }: nur ein LiDAR hat Spalten von Punkten
rig-address = { $sensor }: erwartet wird eine Adresse wie 192.168.1.201, erhalten: { QUOTED($got) }
rig-angles = { $sensor }: erwartet werden Winkel innerhalb von ±{ $limit_deg }°, erhalten: { $got }
rig-position = { $sensor }: erwartet wird eine Position innerhalb von ±{ $limit_m } m, erhalten: { $got }
rig-port = { $sensor }: der Port muss 0 bis { $limit } sein, erhalten: { $got }
rig-port-shared = { $names } senden alle an Port { $port }: eine Live-Aufnahme braucht für jeden eine Adresse oder einen eigenen Port
rig-all-disabled = kein Sensor ist eingeschaltet: es gibt nichts zu kartieren
rig-same-pose = zwei Sensoren haben dieselbe Pose
beams-none = { $where }: erwartet wird etwas von { $known }, es ist nichts da
beams-number = { $where }: erwartet werden 1 bis { $limit } Strahlen in { $key }, erhalten: { $got }
beams-within = { $where }: { $key } muss innerhalb von ±{ $limit } sein, erhalten: { $got } bei Strahl { $beam }
recipe-form = { $where }: erwartet wird ROLLE=SPALTE mit einer Rolle von { $roles }, erhalten: { $got }
recipe-twice = { $where }: { $role } ist zweimal angegeben
recipe-two-roles = { $where }: die Spalte { $column } hat zwei Rollen
recipe-one-column = { $where }: { $role } muss eine Spalte sein (Zeiten können eine Summe von bis zu { $limit } Spalten mit Einheiten sein, wie sec:s+nsec:ns), erhalten: { $got }
recipe-column = { $where } muss SPALTE oder SPALTE:EINHEIT sein, erhalten: { $got }
recipe-negative = { $where } kann nicht negativ sein, erhalten: { $got }
recipe-places = { $where }: erwartet werden die Spalten einer dieser Listen: { $wanted }; erhalten: { $got }
recipe-unit = { $where }: erwartet wird eines von { $units }, oder eine Zahl in { $base }, erhalten: { $got }
recipe-no-unit = { $where }: erwartet wird keine Einheit, erhalten: { $got }
serial-form = gnss: serial: erwartet wird GERÄT:BAUD mit einem seriellen Gerät, zum Beispiel /dev/ttyUSB0:115200 oder /dev/serial/by-id/NAME:115200 (eine eigene Verknüpfung beginnt mit /dev/gps oder /dev/gnss), erhalten: { $got }

## Freigaben

approved-not-issued = { $file } wurde nicht mit Version { $version } ausgegeben
approved-unreadable = { $file } ist nicht lesbar: { $why }
approved-refused = { $what }: { $why }
approved-not-this = dies ist nicht, was { $who } als Version { $version } freigegeben hat
approved-no-row = versions/{ $folder } steht in keiner Zeile des Journals: die Zeile wurde entfernt, das Journal ist ein älteres, oder die Freigabe wurde unterbrochen; die Karte erneut freigeben
approved-named-no-row = summary.json nennt eine Freigabe, die in keiner Zeile des Journals steht: das Journal zurücklegen oder die Karte erneut freigeben
approved-statement-unreadable = versions/{ $folder }/approval.json ist nicht lesbar: { $why }
approved-other-statement = die Erklärung ist nicht die im Journal
approved-signature-invalid = die Signatur ist nicht gültig
approved-other-key = sie nennt den Schlüssel { $named }, ihre Signatur ist von { $key }
approved-other-journal = sie wurde über einem anderen Journal signiert
approved-row-differs = Version, Artefakte oder Unterzeichner im Journal sind nicht die, die signiert wurden
approved-journal-altered = das Journal wurde verändert: { $what }
approved-not-counted = Version { $version } zählt nicht: { $why }
approved-not-valid = die Freigabe von Version { $version } ist nicht gültig: { $why }
approved-no-hash = das Journal hat eine Freigabe ohne Version und Hash
approved-gone = die Freigabe ist nicht mehr da
approved-no-artifact = Version { $version } hat kein Artefakt der Stufe { $stage }
approved-older = dieses Projekt ist älter als das, was dieser Server freigegeben hat (Version { $version } vom { $time }Z): ein früherer Stand oder ein anderes Projekt ist an seiner Stelle; das neuere zurücklegen, die Karte erneut freigeben, oder es mit dem Befehl recon4 verify PROJECT --accept annehmen, wie es ist
approved-list-damaged = { $folder }/{ $file } in den Dateien des Servers ist beschädigt ({ $why }): das Projekt mit einer Sicherung vergleichen, dann mit dem Befehl recon4 verify PROJECT --accept annehmen, wie es ist
signer-removed = die Signatur ist vom Schlüssel { $key } ({ $name }), den { $who } am { $date } aus den vertrauten Schlüsseln entfernt hat

## Projekte

seal-unreadable = { $file } ist nicht lesbar: { $why }
seal-hash = sein eigener Hash passt nicht
seal-written = es ist nicht, wie es geschrieben wurde
seal-altered = { $file } ist nicht, was geschrieben wurde: { $why }
seal-entry = { $file }: der Eintrag { $name } ergibt keinen Sinn: { $why }
seal-no-manifest = { $file } ist kein Manifest: { $why }
seal-not-in-manifest = { $file } steht nicht im Manifest
seal-missing = { $file } fehlt
seal-surplus = { $file } gehört nicht hierher
seal-differs = { $file }: erwartet wird { $expected }, erhalten: { $got }
seal-block-differs = { $file }, Bytes { $start } bis { $stop }: erwartet wird { $expected }, erhalten: { $got }
file-size = { $file }: erwartet werden { $expected } Byte, erhalten: { $got } Byte
lock-failed = { $folder } kann nicht gesperrt werden: { $why }
project-file-unreadable = { $file } ist nicht lesbar: { $why }
project-missing = { $folder } gibt es nicht
project-none = { $folder } ist kein Projekt von recon4: dort ist keine project.json
project-format = { $file }: erwartet wird Format { $format }
project-no-artifact = es gibt kein Artefakt der Stufe { $stage }: es wurde gelöscht, oder die Stufe lief noch nicht. Die Aufzeichnung erneut verarbeiten
project-unusable = { $folder } ist nicht als Projekt nutzbar: { $why }
project-not-empty = { $folder } ist nicht leer und kein Projekt von recon4 (darin ist { $what }); einen neuen Ordner angeben
project-in-use = { $folder } wird von einem anderen Prozess von recon4 genutzt
ledger-cut = { $file } ist abgeschnitten: erwartet wird mindestens eine Seite, erhalten: { $size } Byte
ledger-version = { $file } hat Version { $version }, dieses recon4 liest Version { $known }
ledger-damaged = { $file } ist beschädigt oder nicht nutzbar ({ $why }); verschieben und neu beginnen: fertige Stufen werden an ihren Artefakten gefunden

## Live-Aufnahme

gnss-port = gnss: serial braucht einen Port, an den die Sätze aufgezeichnet werden
capture-port-shared = Rig { $rig }: { $names } senden alle an Port { $port }: jedem in der Rig-Datei seine address = "…" geben, oder einen eigenen Port
capture-kinds = Rig { $rig }: eine Live-Aufnahme kartiert LiDARs, oder einen 2-D-Laser mit oder ohne Profiler; erhalten: { $names }: ihre Topics in ein Bag aufzeichnen und das verarbeiten
capture-address = { $sensor }: address muss wie 192.168.1.201 sein, erhalten: { $got }
capture-port-taken = UDP-Port { $port } ({ $expected }) lässt sich auf { $address } nicht öffnen: { $why }{ $hint }
hint-port-in-use = ; läuft ein anderer Rekorder oder VeloView?
hint-port-low = ; Ports unter 1024 brauchen Administratorrechte: an andere Ports senden
hint-no-address = ; keine Netzwerkkarte dieses Computers hat diese Adresse jetzt
serial-failed = gnss: serial: { $path }: { $why }
serial-no-device = gnss: serial: { $path } ist kein Gerät: erwartet wird eine serielle Leitung
serial-console = gnss: serial: { $path } ist eine Konsole dieses Computers und wird nicht geöffnet; die Konsole von ihr nehmen (Kernel-Parameter console=) oder eine andere Leitung wählen

## Journal

journal-row-damaged = Zeile { $row } des Journals ist beschädigt: { $why }
journal-damaged = { $file } ist beschädigt oder nicht nutzbar: { $why }

## Bags und Ordner

topic-unread = { $topic } ist von einem LiDAR, aber { $type } wird nicht gelesen: das Bag durch den Treiber abspielen (komprimierte Wolken: point_cloud_transport) und die PointCloud2 aufzeichnen, die er veröffentlicht
topics-read = gelesen werden { $kinds }
topics-other-clouds = die Punktwolken sind von einer Tiefenkamera oder eine Karte (mit lidar_topic in ingest wird eine gelesen; Seite: Alle Einstellungen; Befehl: --set ingest.lidar_topic=TOPIC)
bag-no-lidar = { $file }: keine Daten eines LiDARs; Topics: { $topics }; { $why }
columns-needed = { $name } hat Listen von { $columns }: sie werden als Punkte eines LiDARs gelesen, wenn sie x, y, z und dazu time, ring oder intensity heißen, oder wenn eine Rig-Datei die Spalten nennt: fields = { $fields } (oder range, azimuth, elevation) in ihrem [[sensor]]
cloud-unknown = { $file }: erwartet wird eine Datei in einem dieser Formate: { $formats }
recordings-of-times = { $number } Aufzeichnungen verschiedener Zeiten, mehr als { $hours } Stunden auseinander: { $walks }; die eines Gangs angeben
name-long = { NAMED($what, of: "word-what") } hat höchstens { $most } Zeichen, erhalten: { $got }
name-invisible = { NAMED($what, of: "word-what") } darf keine unsichtbaren Zeichen haben, erhalten: { $character } an Stelle { $place }
word-what-a-name = ein Name
word-what-a-note = eine Notiz
word-what-the-id-of-a-point = der Name eines Punkts
word-what-the-name-of-a-file = der Name einer Datei
word-what-why = der Grund
